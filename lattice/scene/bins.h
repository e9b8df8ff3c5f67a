// SPDX-License-Identifier: MIT
#pragma once
/// The states of a scene's chain: Table III's, those of the scene's table [bins], or made from what
/// bodies do in the full dynamics.

#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/cells/quantile_bins.h"
#include "dynamics/cells/transitions.h"
#include "dynamics/disc/ensemble.h"
#include "lattice/scene/scene.h"

namespace gatewalk::lattice {

/// The field of the paper, in whatever units: its proportions of body, beams' length, joints and
/// rate of the random force, and forces that move the body at the paper's speeds (the rate is 50
/// per unit of dynamics::Scale's time). Other forces, stiffness, damping and run keys are studies
/// of the same field.
[[nodiscard]] bool papers_field(const Scene& scene);

/// Which states a chain has.
struct BinsChoice {
  enum class Kind { paper, automatic, scene, tree };
  Kind kind = Kind::paper;
  double factor = 1.0;  // bins per axis as a multiple of Table III's, kind paper
  bool by_default =
      false;  // nobody asked for it: auto takes its place where it does not resolve the scene

  [[nodiscard]] std::string name() const;  // "paper", "auto", "scene", "tree"
};

/// For chains of bins: the scene's own table [bins]; else Table III in the paper's field, and auto
/// in any other.
[[nodiscard]] BinsChoice usual_bins(const Scene& scene);
/// The scene's table [bins], else Table III in the scene's own units: for counting, no pilot is
/// run.
[[nodiscard]] dynamics::StateSpace fixed_space(const Scene& scene);

/// What bodies do in the full dynamics (beams at rest on entry, as the chain has it).
struct Pilot {
  std::int64_t trials = 0;
  std::vector<dynamics::Entry> starts;   // those on the lower edge of the gate; different
  std::vector<dynamics::Entry> entries;  // between gates, in the order of the trials
  dynamics::Health health;
};
/// `trials` from each start. Their noise is theirs alone: no other command runs these trials.
[[nodiscard]] Pilot run_pilot(const Scene& scene, const std::vector<dynamics::BodyState>& starts,
                              std::int64_t trials, std::uint64_t seed,
                              const dynamics::Work& work = {});
/// Trials per start that bins are made of.
inline constexpr std::int64_t kPilotTrials = 2000;

/// How many states so many times the usual bins per axis make. Throws std::invalid_argument for
/// fewer than 1 or too many.
[[nodiscard]] int states_for(double scale);

/// States of about `scale` times as many bins per axis as usual, from a pilot; and where its rows
/// start: entries seen, with their mirror images where the gate is symmetric.
struct SeenStates {
  dynamics::StateSpace space;
  dynamics::Entries entries;
};
[[nodiscard]] SeenStates seen_states(const Scene& scene, const Pilot& pilot, double scale = 1.0);

/// The states of a scene's chain, and how well they resolve what its bodies do.
struct States {
  BinsChoice choice;
  bool replaced = false;  // nobody asked for Table III, which does not resolve the scene
  dynamics::StateSpace space;
  dynamics::Entries entries;  // where rows start; empty: uniform in the bins
  Pilot pilot;
  dynamics::Resolution resolution;  // of the pilot's entries
};
/// The states that `choice` says for walks from `starts`; auto where Table III by default does not
/// resolve the scene. Throws InvalidParameter as
/// dynamics::table3_space.
[[nodiscard]] States states_of(const Scene& scene, const BinsChoice& choice,
                               const std::vector<dynamics::BodyState>& starts, std::uint64_t seed,
                               const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
