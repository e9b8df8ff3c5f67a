// SPDX-License-Identifier: MIT
#pragma once
/// What the studies behind the paper's figures and claims gave: their files, read and checked once.

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/paper/verdicts.h"
#include "cli/render/json.h"
#include "lattice/scene/table4.h"
#include "lattice/study/validation.h"

namespace gatewalk::cli {

// ---- sweep

/// What a key of a scene is at a point: a number, or words.
struct Setting {
  double number = std::nan("");
  std::string text;  // "7", "0.004", "stable"

  Setting(double x) : number(x) {}
  Setting(int x) : number(x) {}
  Setting(const char* words) : text(words) {}
  Setting(double x, std::string words) : number(x), text(std::move(words)) {}
  [[nodiscard]] bool is(const Setting& other) const {
    return std::isnan(other.number) ? text == other.text : number == other.number;
  }
};
using At = std::vector<std::pair<std::string_view, Setting>>;

/// Outcomes of single-gate trials.
struct Outcomes {
  std::int64_t trials = 0, traversed = 0, traversed_left = 0, traversed_right = 0;
  std::int64_t exited_left = 0, exited_right = 0, trapped = 0;
  double worst_penetration = 0.0;  // m

  [[nodiscard]] Share traversed_share() const { return share_of(traversed, trials); }
  /// Right of those that pushed more past one beam (Fig. 12).
  [[nodiscard]] Share right_share() const {
    return share_of(traversed_right, traversed_left + traversed_right);
  }
};

struct SweepPoint : Outcomes {
  std::vector<std::pair<std::string, Setting>> settings;
  /// Throws std::out_of_range for a key that is not varied.
  [[nodiscard]] const Setting& at(std::string_view key) const;
};

struct Sweep {
  std::vector<SweepPoint> points;  // at least one
  /// The point at which these keys have these values. Throws std::out_of_range if there is none.
  [[nodiscard]] const SweepPoint& at(const At& where) const;
  [[nodiscard]] std::vector<double> values(std::string_view key) const;  // ascending
};

// ---- trace

struct TracedRun {
  std::string label, ending;
  std::int64_t trial = 0, hits = 0;
  std::vector<double> t, x, y;  // s, m, m; an entry for every step, as in all that follow
  std::vector<double> potential, elastic_left, elastic_right;      // J
  std::vector<double> landscape, landscape_left, landscape_right;  // J; nan: no way to stand
};

struct Trace {
  std::int64_t trials = 0;
  std::vector<TracedRun> runs;  // that end as wanted, at least one
};

// ---- landscape

/// The way through whose highest point is lowest.
struct LowestWay {
  double above_start = 0.0;       // J, of its highest point
  double above_basin = 0.0;       // J, the same; 0 if it is downhill from the basin's place on
  bool downhill = false;          // there is no basin
  std::array<double, 2> basin{};  // m
};

struct LandscapeStudy {
  LowestWay coarse, fine;  // on the first grid (the paper's), on the last
  Outcomes measured;       // of its trials, if there are any
};

// ---- validate

struct MeanAndSd {
  double mean = 0.0, sd = 0.0;
};

/// As in Table IV: 100 trials against the exact chain, or against 100 walks.
struct Repeats {
  MeanAndSd corrcoef, rmse;  // rmse: trials per 100
  double corrcoef_floor = 0.0, rmse_floor = 0.0;
};

struct ValidatedStart {
  double d = 0.0, vx = 0.0, vy = 0.0;             // m, m/s, m/s
  double paper_corrcoef = 0.0, paper_rmse = 0.0;  // Table IV; nan: not one of its starts
  std::int64_t repeats = 0;                       // of 100 trials
  Repeats exact, walks;
  double corrcoef = 0.0, rmse = 0.0;  // all trials against the exact chain
  double total_variation = 0.0, total_variation_floor = 0.0;
  lattice::Finding finding = lattice::Finding::within_trials;
  std::vector<std::vector<double>> counts, chain;  // (rows x columns): trials; shares
  std::vector<std::vector<double>> departed_counts, departed_chain;  // of these: left the field
  double cut_off = 0.0;                                              // share of the trials
  double dynamics_seconds = 0.0, walks_seconds = 0.0, exact_seconds = 0.0;

  [[nodiscard]] std::string label() const;  // "d = 0 m, v = (0, 15) m/s"
};

/// A share of events of which a body may have several, alike or not: its interval is that of as
/// many trials as there are bodies (or events, if fewer), as if a body's were all alike.
[[nodiscard]] Share share_by_bodies(std::int64_t part, std::int64_t events, std::int64_t bodies);

struct Crossings {
  std::int64_t rt_and_lt = 0, clamped = 0, between_gates = 0;
  std::int64_t bodies = 0;  // whose crossings these are
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
  std::string markov;  // whether the chain forgets what counts, in words
  double matrix_seconds = 0.0;

  [[nodiscard]] double seconds_per_trial() const;
  [[nodiscard]] double seconds_per_walk() const;
};

// ---- All of them

/// Members as the studies are called (studies.cpp).
struct Findings {
  Sweep fig8, fig12, paper_method;
  /// With k_L = k_R = 500, what could make 13 % and 8 %.
  Sweep tried_method, tried_step, tried_restitution, tried_rate, tried_start, tried_random,
      tried_propulsion;
  Trace fig6, fig9_500, fig9_300, fig9_100, exits;
  Json crossing;  // a film (film/replay.h) with more
  LandscapeStudy fig5_symmetric, steep;
  std::map<int, LandscapeStudy> barriers;  // by k_L; fewer in a quick run
  Validation field, field_paper_method, field_no_drag;
  std::map<int, Crossings> field_random;  // by Rm: 10, 20, 40 N

  /// From the studies' JSON by their names. Throws std::runtime_error that names the file and the
  /// key which is missing or is of another kind.
  explicit Findings(const std::map<std::string, Json>& data);
  Findings() = default;  // nothing found, to be filled
};

/// A study's file. Throws as Findings.
[[nodiscard]] Sweep sweep_of(const Json& json, const std::string& file);
[[nodiscard]] Trace trace_of(const Json& json, const std::string& file);
[[nodiscard]] LandscapeStudy landscape_of(const Json& json, const std::string& file);
[[nodiscard]] Validation validation_of(const Json& json, const std::string& file);

}  // namespace gatewalk::cli
