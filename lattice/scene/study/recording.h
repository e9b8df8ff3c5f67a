// SPDX-License-Identifier: MIT
#pragma once
/// Trials in full, of one gate or through the field: a table with a line for every step, which CSV,
/// NetCDF, JSON and films all show.

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/base/work.h"
#include "dynamics/disc/ensemble.h"
#include "dynamics/disc/trace.h"
#include "lattice/field/field_trials.h"
#include "lattice/gates/gates.h"
#include "lattice/scene/scene.h"

namespace gatewalk::lattice {

/// How things stood at the end of a step, in the whole field; work and losses since the trial
/// began.
struct Moment {
  int i_x = 0, i_y = 0;          // the gate, as the paper counts
  int type = 0;                  // of Recordings::gates
  double time = 0.0;             // s
  dynamics::TraceSample sample;  // of that gate
  dynamics::Energies energy;     // of the whole trial: beams left behind count as lost
};

/// One trial.
struct Recording {
  std::int64_t trial = 0;
  std::string ending;  // one of endings()
  double seconds = 0.0;
  int gates = 1;  // visited
  std::vector<Moment> moments;
  dynamics::Health health;
};

/// Trials of one scene.
struct Recordings {
  FieldGates gates;  // that they run through: those of the field, or the scene's own alone
  std::vector<std::string> actions{};  // of a policy: type t of the gates is with t % actions
  bool across_field = false;
  std::int64_t trials = 0;      // that were run; those that end otherwise are not kept
  std::vector<Recording> runs;  // in the order of their trials, at least one
  dynamics::Health health;      // of `runs`; a sample was run again by a better method
  /// The gate of a moment.
  [[nodiscard]] const dynamics::GateParams& of(const Moment& m) const {
    return gates.types()[static_cast<std::size_t>(m.type)];
  }
};

/// Gates of which a body that enters one chooses the type, as it does what a policy says.
struct ChosenGates {
  FieldGates gates;
  CellChoice type;
  std::vector<std::string> actions;
  std::vector<Scene> taken;  // the scene while each action is taken (with_action)
};
/// `action`: which of the actions a body takes where it enters. The gates have all types with all
/// actions, numbered as cells_of (study/plan.h) does. Throws std::invalid_argument unless there is
/// a scene for each action, at least one, all with the same field and as many types of gates;
/// `type` throws std::out_of_range for an action of others.
[[nodiscard]] ChosenGates chosen_gates(std::vector<std::string> actions, std::vector<Scene> taken,
                                       CellChoice action);

/// Every ending that a recording may have, in the order of their codes.
[[nodiscard]] std::vector<std::string> endings(bool across_field);

/// Whether `ending` is what `only` says, or begins with its words: "traversed" is left and right,
/// "departed" crossed and both sides, "left_side" is "left side".
[[nodiscard]] bool ends_so(std::string_view ending, std::string_view only);

/// Throws std::invalid_argument, with all of them, unless an ending is what `only` says.
void require_ending(const std::string& only, bool across_field);

/// Trial `trial` of run_gate_trials (across_field: of run_field; chosen: of policy_trials), the
/// same to the last bit. Throws dynamics::TraceTooLong when it has more moments, InvalidParameter
/// as these do.
[[nodiscard]] Recording record(const Scene& scene, std::uint64_t seed, std::int64_t trial,
                               bool across_field,
                               std::size_t most_moments = std::numeric_limits<std::size_t>::max(),
                               const ChosenGates* chosen = nullptr);

inline constexpr std::int64_t kMostRecordings = 1000;
inline constexpr std::size_t kMostMoments =
    500'000;  // of all runs together: some 1 GB in all forms

struct RecordingOptions {
  std::uint64_t seed = 1;
  std::int64_t first = 0, trials = 1;  // trials first to first + trials - 1
  bool across_field = false;
  std::string only = {};                   // keep those that end so (ends_so); empty: all
  std::optional<ChosenGates> chosen = {};  // across the field, in place of the scene's own gates
};
/// Throws std::invalid_argument for an ending that there is not, more than kMostRecordings runs or
/// kMostMoments moments to keep, std::runtime_error when no trial ends as wanted, InvalidParameter
/// as record.
[[nodiscard]] Recordings record_trials(const Scene& scene, const RecordingOptions& options,
                                       const dynamics::Work& work = {});

// ---- As a table

/// A moment with the trial and the scene it belongs to.
struct Line {
  const dynamics::GateParams& p;
  std::int64_t trial;
  const Moment& m;
};

inline constexpr std::string_view kCounted = "1";  // the unit of what is not measured

struct Column {
  std::string_view name;                     // "vx_m_per_s"
  std::string_view unit;                     // "m s-1" as NetCDF has it, or kCounted
  std::string_view meaning;                  // one phrase
  std::function<double(const Line&)> value;  // nan or infinite where there is none
  std::vector<std::string_view> words = {};  // what codes 0, 1, ... stand for
};

/// All of every recording; the place first, then contacts, then energies.
[[nodiscard]] const std::vector<Column>& columns();
/// The same, and what the body does where it chooses; valid as long as the recordings are.
[[nodiscard]] std::vector<Column> columns_of(const Recordings& recordings);
/// The column of that name. Throws std::out_of_range.
[[nodiscard]] const Column& column(std::string_view name);

}  // namespace gatewalk::lattice
