// SPDX-License-Identifier: MIT
#include "lattice/field/field_trials.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "dynamics/cells/state_space.h"
#include "lattice/field/running_trial.h"

namespace gatewalk::lattice {

using namespace dynamics;

std::vector<Entry> FieldTrials::entries() const {
  std::vector<Entry> all;
  for (std::size_t i = 0; i < passed.size(); ++i) {
    const auto of = of_trial(i);
    for (std::size_t k = 0; k + 1 < of.size(); ++k) all.push_back(of[k].entry);
  }
  return all;
}

bool FieldTrials::keep_endings_with(const FieldTrials& more) {
  const auto knows = [](const FieldTrials& t) {
    return !t.keep_passages || t.endings.size() == t.passed.size();
  };
  if (knows(*this) && knows(more)) return true;
  final_gates.clear();
  endings.clear();
  costs.clear();
  return false;
}

void FieldTrials::append(const FieldTrials& more) {
  const auto add = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  if (keep_endings_with(more)) {
    add(final_gates, more.final_gates);
    add(endings, more.endings);
    add(costs, more.costs);
  }
  add(bodies, more.bodies);
  if (!keep_passages) return;
  const std::int64_t before = std::ssize(passages);
  for (const std::int64_t end : more.passed) passed.push_back(before + end);
  passages.append(more.passages);
}

void FieldTrials::append(const FieldTrials& from, std::size_t at) {
  if (keep_endings_with(from)) {
    final_gates.push_back(from.final_gates[at]);
    endings.push_back(from.endings[at]);
    costs.push_back(from.costs[at]);
  }
  if (!from.bodies.empty()) bodies.push_back(from.bodies[at]);
  if (!keep_passages) return;
  passages.append(from.passages, static_cast<std::size_t>(at == 0 ? 0 : from.passed[at - 1]),
                  static_cast<std::size_t>(from.passed[at]));
  passed.push_back(std::ssize(passages));
}

void require_whole(const RunTrials& piece, const std::vector<std::uint8_t>& endings,
                   std::uint8_t broken) {
  const FieldTrials& each = piece.each;
  bool is_whole = each.final_gates.size() == endings.size() &&
                  each.costs.size() == endings.size() &&
                  (each.passed.empty() ? each.passages.empty()
                                       : each.passed.size() == endings.size() &&
                                             each.passed.back() == std::ssize(each.passages));
  for (const std::int32_t gate : each.final_gates)
    is_whole = is_whole && gate >= 0 && gate < piece.tally.final_cells.size();
  for (const std::uint8_t ending : endings)
    is_whole = is_whole && (ending < markov::kEndings || ending == broken);
  std::int64_t before = 0;
  for (const std::int64_t passed : each.passed)
    is_whole = is_whole && passed >= std::exchange(before, passed);
  if (!is_whole) throw std::runtime_error("a kept piece has trials that there are not");
}

std::int64_t FieldTally::broken() const {
  return trials - std::accumulate(endings.begin(), endings.end(), std::int64_t{0});
}

void FieldTally::count(const std::vector<std::int32_t>& gates,
                       const std::vector<std::optional<markov::Ending>>& how) {
  markov::Ends<std::int64_t> these;
  these.final_cells = markov::CellCounts::Zero(final_cells.rows(), final_cells.cols());
  auto& mixed = these.mixed_cells;
  for (std::size_t i = 0; i < gates.size(); ++i) {
    ++these.final_cells.data()[gates[i]];
    if (how[i]) ++these.endings[static_cast<std::size_t>(*how[i])];
    if (how[i] != markov::Ending::trapped) mixed.push_back({gates[i]});
  }
  const auto before = [](const auto& a, const auto& b) { return a.cell < b.cell; };
  std::sort(mixed.begin(), mixed.end(), before);
  mixed.erase(std::unique(mixed.begin(), mixed.end()), mixed.end());
  for (std::size_t i = 0; i < gates.size(); ++i) {
    const markov::CellEndings<std::int64_t> here{gates[i]};
    const auto cell = std::lower_bound(mixed.begin(), mixed.end(), here, before);
    if (how[i] && cell != mixed.end() && cell->cell == here.cell) ++(*cell)[*how[i]];
  }
  Ends::operator+=(these);
  trials += std::ssize(gates);
}

FieldTally& FieldTally::operator+=(const FieldTally& o) {
  held.add(o.held);
  Ends::operator+=(o);
  trials += o.trials;
  for (std::size_t f = 0; f < entries.size(); ++f) {
    entries[f] += o.entries[f];
    clamped[f] += o.clamped[f];
  }
  health += o.health;
  return *this;
}

markov::Exit exit_of(const Section& section, Fate fate, const Entry& next) {
  if (fate == Fate::trapped) return {};
  const Face& move = section.faces[static_cast<std::size_t>(next.face)];
  return {next.face, move.di_x, move.di_y};
}

std::optional<Entry> RunningTrial::follow(const CellMap& map, const FieldParams& field,
                                          const Passage& passage, bool keep_passages, int type) {
  ++cells_;
  for (std::size_t c = 0; c < map.section.costs.size(); ++c) costs_[c] += passage.costs[c];
  if (keep_passages) {
    passages_.begin(map.section);
    passages_.push_back(
        {passage.fate, static_cast<std::uint8_t>(type), passage.next, passage.costs});
  }
  if (passage.fate == Fate::broken) return {};
  std::int64_t column = column_, row = row_;
  ending_ =
      markov::follow({field.columns, field.rows}, exit_of(map.section, passage.fate, passage.next),
                     cells_ == field.max_gates, column, row);
  if (ending_) return {};
  column_ = static_cast<std::int32_t>(column);
  row_ = static_cast<std::int32_t>(row);
  return passage.next;
}

void RunningTrial::add_to(FieldTrials& each, const FieldParams& field) const {
  each.final_gates.push_back(row_ * field.columns + column_);
  each.endings.push_back(ending_);
  each.costs.push_back(costs_);
  if (!each.keep_passages) return;
  each.passages.append(passages_);
  each.passed.push_back(std::ssize(each.passages));
}

FieldTally tally_of(const std::vector<RunningTrial>& trials, const CellMap& map,
                    const FieldParams& field, TrialRange range, FieldTrials* each) {
  FieldTally tally(field);
  tally.held.add(range);
  std::vector<std::int32_t> gates;
  std::vector<std::optional<markov::Ending>> how;
  for (const RunningTrial& t : trials) {
    gates.push_back(t.row() * field.columns + t.column());
    how.push_back(t.ending());
  }
  tally.count(gates, how);
  if (each == nullptr) return tally;
  if (each->keep_passages) each->passages.begin(map.section);
  for (const RunningTrial& t : trials) t.add_to(*each, field);
  return tally;
}

void begin_trial(const Cell& cell, const Entry& start, std::uint64_t seed, std::int64_t trial,
                 Body& body) {
  body.entry = start;
  body.random = Random(Purpose::field,
                       Stream{seed, cell.stream_of(start), static_cast<std::uint64_t>(trial)});
  cell.begin(body);
}

namespace {

/// Trials that wait for a passage through cells of one type.
struct Wave {
  std::vector<std::int64_t> trials;
  std::mutex mutex;  // several threads append trials
};

/// Moves from cell to cell inside the field, and those with an entry outside all bins.
struct Moves {
  FaceCounts entries{}, clamped{};
};

}  // namespace

void require_cells(const CellField& cells) {
  if (cells.cells.size() != cells.map.types.size())
    throw std::invalid_argument("field: there are no cells to run, only what was recorded");
}

FieldTally run_field(const CellField& cells, const FieldParams& field, const BeginTrial& begin,
                     TrialRange range, FieldTrials* each, const StateSpace* space, Memory memory,
                     const TypeChoice& choice) {
  const CellMap& map = cells.map;
  map.require_fits(field.columns, field.rows);
  const std::size_t types = map.types.size();
  require_cells(cells);
  const bool keep_passages = each != nullptr && each->keep_passages;
  std::vector<RunningTrial> trials;
  const auto start_of = [&](std::int64_t i) {
    return choice.from ? choice.from(range.first + i)
                       : TrialStart{field.start_column(), choice.start};
  };
  for (std::int64_t i = 0; i < range.count; ++i) {
    const std::int32_t column = start_of(i).column;
    if (!field.contains(column, field.start_row))
      throw std::invalid_argument("field: a trial is to begin in a cell that there is not");
    trials.emplace_back(column, field.start_row);
  }

  const auto type_at = [&](std::int64_t i, const Entry& entry) {
    const RunningTrial& t = trials[static_cast<std::size_t>(i)];
    if (!choice.type) return static_cast<std::size_t>(map.type_of(t.column(), t.row()));
    const int type = choice.type({t.column(), t.row(), t.passed(), range.first + i}, entry);
    if (type < 0 || type >= std::ssize(cells.cells))
      throw std::invalid_argument("field: a body is to meet a type of cell that there is not");
    return static_cast<std::size_t>(type);
  };
  // Trials run in waves, those in cells of one type together. A trial goes on while the type stays
  // the same; else it joins the next wave of the other type.
  std::vector<Wave> waves(types);
  for (std::int64_t i = 0; i < range.count; ++i)
    waves[type_at(i, start_of(i).entry)].trials.push_back(i);
  Health health;
  tbb::enumerable_thread_specific<Moves> moves;  // sums, so the order does not matter
  for (bool more = true; more;) {
    more = false;
    for (std::size_t type = 0; type < types; ++type) {
      const std::vector<std::int64_t> wave = std::exchange(waves[type].trials, {});
      if (wave.empty()) continue;
      more = true;
      const Cell& cell = *cells.cells[type];
      carry_out_trials(
          cell, std::ssize(wave),
          [&](Body& body) {
            const std::int64_t i = wave[static_cast<std::size_t>(body.trial)];
            const auto waiting = std::move(trials[static_cast<std::size_t>(i)].waiting);
            if (!waiting) return begin(i, body);
            body.entry = waiting->entry;
            body.random = waiting->random;
            body.carried = waiting->carried;
          },
          [&](Body& body, const Passage& passage) {
            const std::int64_t i = wave[static_cast<std::size_t>(body.trial)];
            RunningTrial& t = trials[static_cast<std::size_t>(i)];
            const auto entry = t.follow(map, field, passage, keep_passages, static_cast<int>(type));
            if (!entry) return false;
            Moves& here = moves.local();
            const auto face = static_cast<std::size_t>(entry->face);
            ++here.entries[face];
            if (space != nullptr) here.clamped[face] += space->index_of(*entry).clamped;
            if (memory == Memory::dropped) cell.forget(body);
            const std::size_t next = type_at(i, *entry);
            if (next == type) return true;
            t.waiting = std::make_unique<Body>(body);
            const std::lock_guard lock(waves[next].mutex);
            waves[next].trials.push_back(i);
            return false;
          },
          health);
    }
  }
  FieldTally tally = tally_of(trials, map, field, range, each);
  tally.health = health;
  for (const Moves& part : moves)
    for (std::size_t f = 0; f < part.entries.size(); ++f) {
      tally.entries[f] += part.entries[f];
      tally.clamped[f] += part.clamped[f];
    }
  return tally;
}

FieldTally run_field(const CellField& cells, const FieldParams& field, const Entry& start,
                     std::uint64_t seed, TrialRange range, FieldTrials* each,
                     const StateSpace* space, Memory memory) {
  return run_field(
      cells, field,
      [&](std::int64_t i, Body& body) {
        begin_trial(cells.at(field.start_column(), field.start_row), start, seed, range.first + i,
                    body);
      },
      range, each, space, memory);
}

}  // namespace gatewalk::lattice
