// SPDX-License-Identifier: MIT
#pragma once
/// Complete trials, of one gate or through the field: a table with one line per step, which CSV,
/// NetCDF, JSON and films show.

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

/// The state of the whole field at the end of a step. Work and losses count from the beginning of
/// the trial.
struct Moment {
  int i_x = 0, i_y = 0;          // the gate, with the paper's indices
  int type = 0;                  // index into the types of Recordings::gates
  double time = 0.0;             // s
  dynamics::TraceSample sample;  // in the frame of that gate
  dynamics::Energies energy;     // of the whole trial: beams left behind count as lost
};

/// A complete trial.
struct Recording {
  std::int64_t trial = 0;
  std::string ending;  // one of endings()
  double seconds = 0.0;
  int gates = 1;  // gates visited
  std::vector<Moment> moments;
  dynamics::Health health;
};

/// Complete trials of one scene.
struct Recordings {
  FieldGates gates;                    // the gates of the field, or the scene's own gate alone
  std::vector<std::string> actions{};  // of a policy: gates of type t are under action t % actions
  bool across_field = false;
  std::int64_t trials = 0;      // trials that were run; those with another ending are not kept
  std::vector<Recording> runs;  // in the order of their trials; at least one
  dynamics::Health health;      // of `runs`; a sample was run again by a better method
  /// The gate of a moment.
  [[nodiscard]] const dynamics::GateParams& of(const Moment& m) const {
    return gates.types()[static_cast<std::size_t>(m.type)];
  }
};

/// Gates whose type a body chooses on entry, as it takes the actions of a policy.
struct ChosenGates {
  FieldGates gates;
  CellChoice type;
  std::vector<std::string> actions;
  std::vector<Scene> taken;  // the scene during each action (with_action)
};
/// Makes gates whose type a body chooses on entry by `action`. The gates have all types under all
/// actions, numbered as in cells_of (study/plan.h). Throws std::invalid_argument unless there is
/// one scene per action, at least one, all with the same field and number of gate types; `type`
/// throws std::out_of_range for an unknown action.
[[nodiscard]] ChosenGates chosen_gates(std::vector<std::string> actions, std::vector<Scene> taken,
                                       CellChoice action);

/// Every ending that a recording may have, in the order of the codes.
[[nodiscard]] std::vector<std::string> endings(bool across_field);

/// True if `ending` matches `only`: equal, or beginning with its words. "traversed" also matches
/// left and right, "departed" crossed and both sides, "left_side" is "left side".
[[nodiscard]] bool ends_so(std::string_view ending, std::string_view only);

/// Throws std::invalid_argument, listing all endings, unless some ending matches `only`.
void require_ending(const std::string& only, bool across_field);

/// Records trial `trial` of run_gate_trials (across_field: of run_field; chosen: of policy_trials),
/// equal to the last bit. Throws dynamics::TraceTooLong if it has more than `most_moments`,
/// InvalidParameter as these functions do.
[[nodiscard]] Recording record(const Scene& scene, std::uint64_t seed, std::int64_t trial,
                               bool across_field,
                               std::size_t most_moments = std::numeric_limits<std::size_t>::max(),
                               const ChosenGates* chosen = nullptr);

inline constexpr std::int64_t kMostRecordings = 1000;
inline constexpr std::size_t kMostMoments =
    500'000;  // of all runs together: about 1 GB in all formats

struct RecordingOptions {
  std::uint64_t seed = 1;
  std::int64_t first = 0, trials = 1;  // trials first to first + trials - 1
  bool across_field = false;
  std::string only = {};                   // keeps trials with this ending (ends_so); empty: all
  std::optional<ChosenGates> chosen = {};  // across the field, instead of the scene's own gates
};
/// Records trials. Throws std::invalid_argument for an unknown ending and for more than
/// kMostRecordings runs or kMostMoments moments to keep, std::runtime_error if no trial ends as
/// asked, InvalidParameter as record.
[[nodiscard]] Recordings record_trials(const Scene& scene, const RecordingOptions& options,
                                       const dynamics::Work& work = {});

// ---- As a table

/// A moment, with its trial and gate.
struct Line {
  const dynamics::GateParams& p;
  std::int64_t trial;
  const Moment& m;
};

inline constexpr std::string_view kCounted = "1";  // the unit of columns that are no measurements

/// A column of the table of moments.
struct Column {
  std::string_view name;                     // "vx_m_per_s"
  std::string_view unit;                     // "m s-1" as in NetCDF, or kCounted
  std::string_view meaning;                  // one phrase
  std::function<double(const Line&)> value;  // NaN or infinite if there is no value
  std::vector<std::string_view> words = {};  // the meanings of codes 0, 1, ...
};

/// The columns of every recording: motion first, then contacts, then energies.
[[nodiscard]] const std::vector<Column>& columns();
/// The columns of these recordings, with the body's action if it chooses; valid while the
/// recordings are.
[[nodiscard]] std::vector<Column> columns_of(const Recordings& recordings);
/// The column of this name. Throws std::out_of_range.
[[nodiscard]] const Column& column(std::string_view name);

}  // namespace gatewalk::lattice
