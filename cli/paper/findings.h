// SPDX-License-Identifier: MIT
#pragma once
/// The results of the studies behind the paper's figures and claims, read from the studies' JSON.
/// An interrupted report therefore continues with the studies that are done.

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "cli/fields/json_value.h"
#include "cli/paper/verdicts.h"
#include "dynamics/disc/ensemble.h"
#include "dynamics/disc/landscape.h"
#include "lattice/study/validation.h"

namespace gatewalk::cli {

// ---- sweep

/// How the trials of one gate ended, with traversals and exits as the paper counts them.
struct Outcomes : dynamics::GateTally {
  [[nodiscard]] Share traversed_share() const { return share_of(traversed(), trials); }
  [[nodiscard]] Share left_share() const {
    return share_of((*this)[dynamics::Outcome::traversed_left], trials);
  }
  /// The share of right traversals among the left and right ones (Fig. 12).
  [[nodiscard]] Share right_share() const {
    const std::int64_t right = (*this)[dynamics::Outcome::traversed_right];
    return share_of(right, (*this)[dynamics::Outcome::traversed_left] + right);
  }
};

struct PaperPoint : Outcomes {
  Json place;  // the varied keys: {"run.method": "stable", "forces.random_N": 10}

  [[nodiscard]] double number(const char* key) const { return place.at(key).get<double>(); }
  [[nodiscard]] std::string text(const char* key) const;  // "7", "0.004", "stable"
};

struct Sweep {
  std::vector<PaperPoint> points;  // at least one
  /// The point at which these keys have these values. Throws std::out_of_range if there is none.
  [[nodiscard]] const PaperPoint& at(const Json& where) const;
  [[nodiscard]] std::vector<double> values(const char* key) const;  // ascending
};

// ---- trace

struct TracedRun {
  std::string label, ending;
  std::int64_t trial = 0, hits = 0;
  std::vector<double> t, x, y;  // s, m, m; like all lists below, an entry for every step
  std::vector<double> potential, elastic_left, elastic_right;      // J
  std::vector<double> landscape, landscape_left, landscape_right;  // J; NaN: no place for the disc
};

struct Trace {
  std::int64_t trials = 0;
  std::vector<TracedRun> runs;  // those with the ending asked for, at least one
};

// ---- landscape

/// The passes of a landscape, without the landscape's points. `coarse` is the paper's grid.
struct LandscapeStudy : dynamics::Passes {
  Outcomes measured;  // of trials, if the study has any
};

// ---- validate

struct MeanAndSd {
  double mean = 0.0, sd = 0.0;
};

/// Means over repeats of 100 trials, as in Table IV, against the exact chain or against 100 walks.
struct Repeats {
  MeanAndSd corrcoef, rmse;  // rmse: trials per 100
  double corrcoef_floor = 0.0, rmse_floor = 0.0;
};

struct ValidatedStart {
  double d = 0.0, vx = 0.0, vy = 0.0;                                 // m, m/s, m/s
  double paper_corrcoef = std::nan(""), paper_rmse = paper_corrcoef;  // of Table IV; NaN: none
  std::int64_t repeats = 0;                                           // repeats of 100 trials
  Repeats exact, walks;
  double corrcoef = 0.0, rmse = 0.0;  // all trials against the exact chain
  double total_variation = 0.0, total_variation_floor = 0.0;
  lattice::Finding finding = lattice::Finding::within_trials;
  std::vector<std::vector<double>> counts, chain;  // (rows x columns): trials; shares
  std::vector<std::vector<double>> departed_counts, departed_chain;  // that left the field
  double cut_off = 0.0;                                              // share of the trials
  double dynamics_seconds = 0.0, walks_seconds = 0.0, exact_seconds = 0.0;

  [[nodiscard]] std::string label() const;  // "d = 0 m, v = (0, 15) m/s"
};

/// A share of events when a body may have several events. The interval is that of as many trials as
/// there are bodies (or events, if fewer), as if all events of a body were alike.
[[nodiscard]] Share share_by_bodies(std::int64_t part, std::int64_t events, std::int64_t bodies);

struct Crossings {
  std::int64_t rt_and_lt = 0, clamped = 0, between_gates = 0;
  std::int64_t bodies = 0;  // bodies with these crossings
  [[nodiscard]] Share clamped_share() const {
    return share_by_bodies(clamped, between_gates, bodies);
  }
  [[nodiscard]] Share rt_and_lt_share() const {
    return share_by_bodies(rt_and_lt, between_gates, bodies);
  }
};

struct Validation {
  std::int64_t trials = 0, walks = 0;  // per start
  std::vector<ValidatedStart> starts;
  Crossings crossings;
  std::string markov;  // whether the chain loses relevant memory, in words
  double matrix_seconds = 0.0;

  [[nodiscard]] double seconds_per_trial() const;
  [[nodiscard]] double seconds_per_walk() const;
};

// ---- All of them

/// The results of all studies. Members have the names of the studies (studies.cpp).
struct Findings {
  Sweep fig8, fig12, paper_method;
  /// Studies with k_L = k_R = 500 of what could explain 13 % and 8 %.
  Sweep tried_method, tried_step, tried_restitution, tried_rate, tried_start, tried_random,
      tried_propulsion;
  Trace fig6, fig9_500, fig9_300, fig9_100, exits;
  Json crossing;  // a film (film/replay.h) and more keys
  LandscapeStudy fig5_symmetric, steep;
  std::map<int, LandscapeStudy> barriers;  // by k_L; a quick run has fewer
  Validation field, field_paper_method, field_no_drag;
  std::map<int, Validation> field_random;  // by Rm: 10, 20, 40 N
};

// Read the JSON of a study. They throw std::exception if it is not as expected.
void read(Sweep& sweep, const Json& json);
void read(Trace& trace, const Json& json);
void read(LandscapeStudy& study, const Json& json);
void read(Validation& validation, const Json& json);
template <class Finding>
[[nodiscard]] Finding found_in(const Json& json) {
  Finding finding;
  read(finding, json);
  return finding;
}

}  // namespace gatewalk::cli
