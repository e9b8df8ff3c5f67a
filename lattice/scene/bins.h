// SPDX-License-Identifier: MIT
#pragma once
/// The states of a scene's chain: those of Table III, those of the scene's table [bins], or states
/// made from the full dynamics of bodies.

#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/cells/quantile_bins.h"
#include "dynamics/cells/transitions.h"
#include "dynamics/disc/ensemble.h"
#include "lattice/scene/scene.h"

namespace gatewalk::lattice {

/// True for the field of the paper in any units. Such a field has the paper's proportions of body,
/// beam length, joints and rate of the random force (50 per unit of dynamics::Scale's time), and
/// forces that move the body at the paper's speeds. Other forces, stiffness, damping and run keys
/// are studies of the same field.
[[nodiscard]] bool papers_field(const Scene& scene);

/// The choice of a chain's states.
struct BinsChoice {
  enum class Kind { paper, automatic, scene, tree };
  Kind kind = Kind::paper;
  double factor = 1.0;  // bins per axis as a multiple of Table III's, for kind paper
  bool by_default =
      false;  // nobody asked for this kind: auto replaces it if it does not resolve the scene

  [[nodiscard]] std::string name() const;  // "paper", "auto", "scene", "tree"
};

/// The default for chains of bins: the scene's own table [bins]; else Table III in the paper's
/// field, and auto in any other field.
[[nodiscard]] BinsChoice usual_bins(const Scene& scene);
/// States that need no pilot, for counting: the scene's table [bins], else Table III in the scene's
/// own units.
[[nodiscard]] dynamics::StateSpace fixed_space(const Scene& scene);

/// Entries of bodies in the full dynamics (beams at rest on entry, as in the chain).
struct Pilot {
  std::int64_t trials = 0;
  std::vector<dynamics::Entry> starts;  // starts on the lower edge of the gate; all different
  /// Entries into gates after the first, in the order of the trials.
  std::vector<dynamics::Entry> entries;
  dynamics::Health health;
};
/// Runs `trials` trials from each start, with trial numbers that no other command uses.
[[nodiscard]] Pilot run_pilot(const Scene& scene, const std::vector<dynamics::BodyState>& starts,
                              std::int64_t trials, std::uint64_t seed,
                              const dynamics::Work& work = {});
/// Number of trials per start from which bins are made.
inline constexpr std::int64_t kPilotTrials = 2000;

/// The number of states for `scale` times the usual number of bins per axis. Throws
/// std::invalid_argument for fewer than 1 or too many.
[[nodiscard]] int states_for(double scale);

/// States from a pilot, with about `scale` times the usual number of bins per axis. `entries`:
/// where the runs of the rows start; entries seen, with their mirror images if the gate is
/// symmetric.
struct SeenStates {
  dynamics::StateSpace space;
  dynamics::Entries entries;
};
[[nodiscard]] SeenStates seen_states(const Scene& scene, const Pilot& pilot, double scale = 1.0);

/// The states of a scene's chain, and how well they resolve the entries of its bodies.
struct States {
  BinsChoice choice;
  /// `auto` replaced Table III, which nobody asked for and which does not resolve the scene.
  bool replaced = false;
  dynamics::StateSpace space;
  dynamics::Entries entries;  // where the runs of the rows start; empty: uniform in the bins
  Pilot pilot;
  dynamics::Resolution resolution;  // of the pilot's entries
};
/// Makes the states of `choice` for walks from `starts`; auto if Table III is only the default and
/// does not resolve the scene. Throws InvalidParameter as dynamics::table3_space.
[[nodiscard]] States states_of(const Scene& scene, const BinsChoice& choice,
                               const std::vector<dynamics::BodyState>& starts, std::uint64_t seed,
                               const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
