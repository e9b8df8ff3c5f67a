// SPDX-License-Identifier: MIT
#include "lattice/scene/study/recording.h"

#include <algorithm>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "lattice/gates/disc_field.h"
#include "lattice/scene/settle.h"
#include "lattice/scene/terrain.h"
#include "lattice/statistics/ending_shares.h"

namespace gatewalk::lattice {
namespace {

/// The least size of the sample that is run again by a better method: the few recorded trials alone
/// would show nothing of it.
constexpr std::int64_t kCheckedAs = 500;

/// The word for all endings outside the field.
constexpr std::string_view kDeparted = "departed";

/// The name of an ending; a trial that became non-finite has none in the tables.
std::string field_ending(std::optional<markov::Ending> ending) {
  if (!ending) return "not finite";
  for (const EndingName& e : kEndingNames)
    if (e.ending == *ending) return e.name;
  throw std::logic_error("no trial of the dynamics ends so");
}

bool has_departed(std::string_view ending) {
  return ending == "crossed" || ending == "left side" || ending == "right side";
}

/// The energies of the whole trial, from those of the current gate, `now`, and those of the gates
/// before, `before`.
dynamics::Energies together(const dynamics::Energies& before, dynamics::Energies now) {
  now.propulsion_work += before.propulsion_work;
  now.random_work += before.random_work;
  now.hit_loss += before.hit_loss;
  now.lost += before.lost;
  return now;
}

void append(Recording& r, const dynamics::GateTrace& trace, int i_x, int i_y, int type) {
  dynamics::Energies before;
  double clock = 0.0;
  if (!r.moments.empty()) {
    const Moment& last = r.moments.back();
    before = last.energy;
    clock = last.time;
    // The beams of the old gate stay behind with their energy; the beams of the new gate are at
    // rest.
    before.lost += last.energy.mechanical() - trace.samples.front().energy.mechanical();
  }
  for (const dynamics::TraceSample& s : trace.samples)
    r.moments.push_back({i_x, i_y, type, clock + s.time, s, together(before, s.energy)});
}

std::string named(std::int64_t first, std::int64_t last) {
  return "trials " + std::to_string(first) + " to " + std::to_string(last);
}

/// `fit`: number of trials that can be recorded together; 0: not even the first one.
std::invalid_argument too_long(const std::string& what, const Scene& scene, bool across_field,
                               std::int64_t fit) {
  std::vector<std::string> ways;
  if (fit > 0) ways = {"--trials " + std::to_string(fit), "--only ENDING"};
  if (across_field) ways.emplace_back("a smaller field.max_gates");
  if (scene.gate.run.method != "event") ways.emplace_back("a longer run.step_s");
  ways.emplace_back("a shorter run.time_limit_s");
  std::string all;
  for (std::size_t i = 0; i < ways.size(); ++i)
    all += (i == 0 ? "" : i + 1 == ways.size() ? " or " : ", ") + ways[i];
  return std::invalid_argument(what + " more than " + std::to_string(kMostMoments) +
                               " steps, the most that are recorded: give " + all);
}

}  // namespace

ChosenGates chosen_gates(std::vector<std::string> actions, std::vector<Scene> taken,
                         CellChoice action) {
  if (taken.empty() || actions.size() != taken.size())
    throw std::invalid_argument("a scene for each action, at least one");
  const auto n = static_cast<int>(taken.size());
  std::vector<FieldGates> each;
  for (const Scene& scene : taken) each.push_back(all_gates_of(scene));
  const FieldGates& first = each.front();
  for (std::size_t a = 0; a < taken.size(); ++a)
    if (taken[a].field.columns != taken[0].field.columns ||
        taken[a].field.rows != taken[0].field.rows ||
        taken[a].field.max_gates != taken[0].field.max_gates ||
        each[a].types().size() != first.types().size())
      throw std::invalid_argument("action " + actions[a] + " has another field");
  std::vector<dynamics::GateParams> types;
  for (std::size_t t = 0; t < first.types().size(); ++t)
    for (const FieldGates& gates : each) types.push_back(gates.types()[t]);
  const FieldParams field = taken.front().field;
  std::vector<int> type_of_cell;
  for (int row = 0; row < field.rows; ++row)
    for (int column = 0; column < field.columns; ++column)
      type_of_cell.push_back(first.type_of(column, row) * n);
  return {FieldGates::by_cell(std::move(types), field.columns, type_of_cell),
          [type_of_cell, columns = field.columns, n, action = std::move(action)](
              const Place& at, const dynamics::Entry& entry) {
            const int chosen = action(at, entry);
            if (chosen < 0 || chosen >= n)
              throw std::out_of_range("there is no action number " + std::to_string(chosen));
            return type_of_cell[static_cast<std::size_t>(at.row * columns + at.column)] + chosen;
          },
          std::move(actions), std::move(taken)};
}

std::vector<std::string> endings(bool across_field) {
  std::vector<std::string> names;
  if (!across_field) {
    for (std::size_t k = 0; k < dynamics::kOutcomes; ++k)
      names.emplace_back(name_of(static_cast<dynamics::Outcome>(k)));
    return names;
  }
  for (const EndingName& e : kEndingNames) names.emplace_back(e.name);
  names.push_back(field_ending({}));
  return names;
}

bool ends_so(std::string_view ending, std::string_view only) {
  if (only == kDeparted) return has_departed(ending);
  if (const auto named = ending_named(only)) return ending == field_ending(named);
  return ending.starts_with(only) && (ending.size() == only.size() || ending[only.size()] == ' ');
}

void require_ending(const std::string& only, bool across_field) {
  std::string known;
  for (const std::string& ending : endings(across_field)) {
    if (ends_so(ending, only)) return;
    known += (known.empty() ? "" : ", ") + ending;
  }
  throw std::invalid_argument("'" + only + "': a run ends as one of: " + known +
                              (across_field ? "; departed is each of the first three" : ""));
}

Recording record(const Scene& scene, std::uint64_t seed, std::int64_t trial, bool across_field,
                 std::size_t most_moments, const ChosenGates* chosen) {
  Recording r;
  r.trial = trial;
  if (across_field) {
    const FieldGates gates = chosen ? chosen->gates : gates_of(scene);
    const FieldTrace t = trace_field(gates, scene.field, scene.start, seed, trial, most_moments,
                                     chosen ? chosen->type : CellChoice{});
    for (const auto& visit : t.visits) {
      append(r, visit.trace, visit.column - scene.field.start_column(), visit.row, visit.type);
      add_run(r.health, gates.types()[static_cast<std::size_t>(visit.type)], visit.trace.run);
    }
    r.gates = static_cast<int>(t.visits.size());
    r.ending = field_ending(t.ending);
  } else {
    const auto method = dynamics::make_method(scene.gate);
    dynamics::RandomForce force = dynamics::gate_force(scene.gate, seed, trial);
    const auto t = dynamics::trace_gate(scene.gate, *method, scene.start, force, most_moments);
    append(r, t, 0, 0, 0);
    add_run(r.health, scene.gate, t.run);
    r.ending = dynamics::name_of(t.run.outcome);
  }
  r.seconds = r.moments.back().time;
  return r;
}

Recordings record_trials(const Scene& scene, const RecordingOptions& options,
                         const dynamics::Work& work) {
  if (!options.only.empty()) require_ending(options.only, options.across_field);
  const ChosenGates* const chosen = options.chosen ? &*options.chosen : nullptr;
  Recordings kept{.gates = chosen                 ? chosen->gates
                           : options.across_field ? gates_of(scene)
                                                  : FieldGates(scene.gate),
                  .actions = chosen ? chosen->actions : std::vector<std::string>{},
                  .across_field = options.across_field,
                  .trials = options.trials,
                  .runs = {},
                  .health = {}};
  std::size_t moments = 0;
  const auto take = [&](std::int64_t trial) {
    Recording r;
    try {
      r = record(scene, options.seed, trial, options.across_field, kMostMoments, chosen);
    } catch (const dynamics::TraceTooLong&) {
      throw too_long("trial " + std::to_string(trial) + " alone has", scene, options.across_field,
                     trial - options.first);
    }
    if (!options.only.empty() && !ends_so(r.ending, options.only)) return;
    if (static_cast<std::int64_t>(kept.runs.size()) == kMostRecordings)
      throw std::invalid_argument("more than " + std::to_string(kMostRecordings) +
                                  " runs end so; ask for fewer --trials");
    moments += r.moments.size();
    if (moments > kMostMoments)
      throw too_long(named(options.first, trial) + " have together", scene, options.across_field,
                     trial - options.first);
    kept.health += r.health;
    kept.runs.push_back(std::move(r));
  };
  work.in_pieces("runs", options.trials, [&](dynamics::TrialRange range) {
    for (std::int64_t i = 0; i < range.count; ++i) take(options.first + range.first + i);
  });
  if (kept.runs.empty())
    throw std::runtime_error("none of " + named(options.first, options.first + options.trials - 1) +
                             " ends '" + options.only + "': nothing was written");
  const std::int64_t checked = std::max(options.trials, kCheckedAs);
  if (chosen) {
    std::set<std::size_t> taken;
    for (const Recording& run : kept.runs)
      for (const Moment& m : run.moments)
        taken.insert(static_cast<std::size_t>(m.type) % chosen->actions.size());
    for (const std::size_t action : taken)
      check_outcomes(chosen->taken[action], RunsFrom::all_types, options.seed,
                     checked / std::ssize(taken) + 1, kept.health, work);
  } else {
    check_outcomes(scene, options.across_field ? RunsFrom::everywhere : RunsFrom::start,
                   options.seed, checked, kept.health, work);
  }
  return kept;
}

}  // namespace gatewalk::lattice
