// SPDX-License-Identifier: MIT
#include "lattice/study/memory.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/base/share.h"
#include "dynamics/cells/words.h"
#include "lattice/field/running_trial.h"
#include "lattice/pool/kernel.h"
#include "lattice/statistics/multiple_tests.h"

namespace gatewalk::lattice {
namespace {

using dynamics::Section;
using dynamics::StateSpace;

/// The origin of bodies that enter by this face, in its right half or not.
std::string origin_name(const Section& section, int face, bool right) {
  const dynamics::Face& f = section.faces[face];
  if (f.mirror != face || !f.is_odd(0)) return f.origin;
  return f.origin + (right ? " in the right half" : " in the left half");
}

/// The index of a state's origin in `origins`.
int origin_of(const StateSpace& space, int state, const std::vector<std::string>& origins) {
  const dynamics::StateRange range = space.range(state);
  const auto& [from, to] = range.at[0];
  const std::string name = origin_name(space.section(), range.face, !(from + to < 0.0));
  return static_cast<int>(std::find(origins.begin(), origins.end(), name) - origins.begin());
}

/// The runs with each kind of label. Runs of a walk's first gate have no gate before.
struct Labelled {
  std::vector<LabelledRun> gate_before, visit, row;
};

Labelled labelled(const StateWalks& w, const StateSpace& space, int start_row) {
  const std::vector<std::string> all_origins = origins_of(space.section());
  std::vector<int> origins;
  for (int s = 0; s < std::ssize(w.way); ++s)
    origins.push_back(origin_of(space, s % space.size(), all_origins));
  Labelled all;
  for (std::int64_t walk = 0; walk < w.walks(); ++walk) {
    int row = start_row;
    for (std::int64_t i = w.begin(walk); i < w.passed[walk]; ++i) {
      const std::int32_t state = w.state[i], next = w.next[i];
      const std::int32_t outcome = next == StateWalks::kTrapped ? w.ways : w.way[next];
      const std::int64_t visit = i - w.begin(walk);
      if (visit > 0) {
        row += space.section().faces[space.face(state % space.size())].di_y;
        all.gate_before.push_back({state, origins[w.state[i - 1]], outcome});
      }
      all.visit.push_back(
          {state, static_cast<std::int32_t>(std::min<std::int64_t>(visit, kVisits - 1)), outcome});
      all.row.push_back({state, std::clamp(row, 0, kRows - 1), outcome});
    }
  }
  return all;
}

}  // namespace

std::vector<std::string> origins_of(const Section& section) {
  std::vector<std::string> all;
  for (int face = 0; face < std::ssize(section.faces); ++face)
    for (const bool right : {false, true}) {
      std::string name = origin_name(section, face, right);
      if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(std::move(name));
    }
  return all;
}

StateWalks no_walks(const StateSpace& space, std::size_t types) {
  StateWalks walks;
  walks.ways = static_cast<int>(space.section().faces.size());
  for (std::size_t type = 0; type < types; ++type)
    for (int s = 0; s < space.size(); ++s) walks.way.push_back(space.face(s));
  return walks;
}

void add_walks(StateWalks& walks, const StateSpace& space, int first, const FieldTrials& each,
               const std::vector<int>& same) {
  const auto in_gate = [&](std::uint8_t type, std::int32_t state) {
    const std::int32_t own = type * space.size() + state;
    return same.empty() ? own : same[static_cast<std::size_t>(own)];
  };
  std::vector<std::int32_t> states;
  for (std::size_t trial = 0; trial < each.passed.size(); ++trial) {
    states.clear();
    std::int32_t at = first;
    for (const CellPassage passage : each.of_trial(trial)) {
      if (passage.fate == dynamics::Fate::broken) break;
      states.push_back(in_gate(passage.type, at));
      at = passage.fate == dynamics::Fate::trapped ? StateWalks::kTrapped
                                                   : space.index_of(passage.entry).state;
    }
    walks.add(states, at);
  }
}

double MemoryStudy::p_adjusted(Question q) const {
  std::vector<double> all;
  for (int k = 0; k < kQuestions; ++k) all.push_back(p(static_cast<Question>(k)));
  return holm(all)[static_cast<std::size_t>(q)];
}

bool MemoryStudy::remembers() const {
  for (int q = 0; q < kQuestions; ++q)
    if (remembers(static_cast<Question>(q))) return true;
  return false;
}

MemoryStudy study_memory(const StateWalks& walks, const StateSpace& space,
                         const MemoryOptions& options, const dynamics::Work& work) {
  walks.validate();
  if (walks.walks() == 0) throw std::invalid_argument("memory: no walks");
  const auto runs = std::ssize(walks.state);
  const std::int64_t draws =
      options.null_draws.value_or(std::clamp<std::int64_t>(100'000'000 / runs, 399, 999));
  const auto begin = [&](Question q) { work.tell("memory", static_cast<int>(q), kQuestions); };
  const Labelled runs_with = labelled(walks, space, options.start_row);
  const auto independence = [&](Question q, const std::vector<LabelledRun>& labelled_runs) {
    begin(q);
    return test_independence(labelled_runs, {.level = MemoryStudy::kLevel / kQuestions,
                                             .null_draws = draws,
                                             .seed = options.seed,
                                             .number = static_cast<std::uint64_t>(q)});
  };
  begin(Question::gates_ahead);
  MemoryStudy study{.walks = walks.walks(),
                    .runs = runs,
                    .ahead = std::ssize(walks.way) == space.size()
                                 ? gates_ahead(walks, kMostGatesAhead, draws, options.seed)
                                 : GatesAhead{.steps = {}, .null_draws = draws},
                    .gate_before = independence(Question::gate_before, runs_with.gate_before),
                    .visit = independence(Question::visit, runs_with.visit),
                    .row = independence(Question::row, runs_with.row),
                    .origins = origins_of(space.section()),
                    .outcomes = {}};
  for (const dynamics::Face& face : space.section().faces) study.outcomes.push_back(face.name);
  study.outcomes.emplace_back("trapped");
  work.tell("memory", kQuestions, kQuestions);
  return study;
}

Independence body_memory(const Problem& problem, const RunPool& pool, int per_leaf,
                         std::int64_t null_draws, std::uint64_t seed) {
  constexpr std::uint64_t kBodySigns = 0x626f6479'00000001;  // "body"
  const StateSpace space = kernel_of(problem.map(), pool, per_leaf).space;
  const FieldTrials& trials = pool.scattered.each;
  const dynamics::Section& section = problem.map().section;
  const auto& words = section.words;
  const int faces = words ? words->letters().faces : static_cast<int>(section.faces.size());
  const auto face_of = [&](const dynamics::Entry& entry) { return entry.face % faces; };
  std::vector<LabelledRun> runs;  // without those in the trials' first cells
  for (std::size_t i = 0; i < trials.passed.size(); ++i) {
    int before = -1;
    dynamics::Entry entry = pool.scattered.starts[i];
    for (const CellPassage passage : trials.of_trial(i)) {
      if (passage.fate == dynamics::Fate::broken) break;
      if (before >= 0)
        runs.push_back({passage.type * space.size() + space.index_of(entry).state, before,
                        passage.fate == dynamics::Fate::trapped ? faces : face_of(passage.entry),
                        trials.bodies[i]});
      before = face_of(entry);
      entry = passage.entry;
    }
  }
  return test_independence(runs, {.null_draws = null_draws,
                                  .seed = seed,
                                  .number = kBodySigns,
                                  .clusters = static_cast<int>(pool.bodies()),
                                  .labels = faces,
                                  .outcomes = faces + 1});
}

PairedDifference paired_difference(std::int64_t only_first, std::int64_t only_second,
                                   std::int64_t trials) {
  const double n = static_cast<double>(trials) + 2.0;
  const auto more = static_cast<double>(only_second - only_first);
  const auto unlike = static_cast<double>(only_first + only_second) + 1.0;
  const double half = dynamics::kNormal95 * std::sqrt(unlike - more * more / n) / n;
  return {more / static_cast<double>(trials), more / n - half, more / n + half};
}

ForceMemory force_memory(const RunTrials& held, const RunTrials& anew, std::uint64_t seed) {
  const std::size_t trials = held.each.endings.size();
  if (trials == 0 || anew.each.endings.size() != trials)
    throw std::invalid_argument("force_memory: the same trials are needed in both");
  std::array<std::int64_t, markov::kEndings> only_held{}, only_anew{};
  for (std::size_t i = 0; i < trials; ++i) {
    const auto a = held.each.endings[i], b = anew.each.endings[i];
    if (a == b) continue;
    if (a) ++only_held[static_cast<std::size_t>(*a)];
    if (b) ++only_anew[static_cast<std::size_t>(*b)];
  }
  ForceMemory memory{paired_change({anew.each.final_gates, anew.tally.final_cells},
                                   {held.each.final_gates, held.tally.final_cells}, seed),
                     {}};
  for (std::size_t e = 0; e < markov::kEndings; ++e)
    memory.endings[e] =
        paired_difference(only_held[e], only_anew[e], std::ssize(held.each.endings));
  return memory;
}

}  // namespace gatewalk::lattice
