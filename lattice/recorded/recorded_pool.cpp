// SPDX-License-Identifier: MIT
#include "lattice/recorded/recorded_pool.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "dynamics/cells/words.h"
#include "lattice/pool/kernel.h"
#include "lattice/pool/predict_pooled.h"

namespace gatewalk::lattice {

using namespace dynamics;

RunPool pool_of(RecordedRuns runs) {
  RunPool pool;
  FieldTrials& each = pool.scattered.each;
  each.passages = std::move(runs.passages);
  for (const RecordedTrial& trial : runs.trials) {
    pool.scattered.starts.push_back(trial.start);
    each.bodies.push_back(trial.body);
    each.passed.push_back(trial.first + trial.count);
  }
  return pool;
}

void add_trials(RecordedRuns& runs, const FieldTrials& each, const Entry& start) {
  for (std::size_t i = 0; i < each.passed.size(); ++i) {
    const PassageTable::Rows passages = each.of_trial(i);
    const auto body = static_cast<std::int32_t>(runs.bodies.size());
    runs.bodies.push_back(std::to_string(body + 1));
    runs.trials.push_back(
        {start, body, std::ssize(runs.passages), static_cast<std::int64_t>(passages.size())});
    for (const CellPassage& passage : passages) {
      runs.passages.push_back(passage);
      runs.trapped += passage.fate == Fate::trapped;
      runs.lost += passage.fate == Fate::broken;
    }
  }
}

CellFile cells_of(const Problem& problem) {
  CellFile cells;
  cells.source = problem.source;
  cells.map = problem.map();
  cells.types = problem.types;
  cells.has_scale.assign(problem.map().section.coordinates.size(), true);
  cells.width = problem.width;
  cells.length = problem.length;
  cells.field = problem.field;
  return cells;
}

Problem problem_of(const CellFile& cells, const RunPool& pool) {
  Problem problem{.cells = {cells.map, {}},
                  .field = cells.field,
                  .start = cells.start.value_or(Entry{}),
                  .width = cells.width,
                  .length = cells.length,
                  .types = cells.types,
                  .source = cells.source,
                  .check = {}};
  CellMap& map = problem.cells.map;
  if (map.types.size() > 1 && map.type_of_cell.empty()) {  // the first type everywhere
    map.columns = cells.field.columns;
    map.type_of_cell.assign(
        static_cast<std::size_t>(cells.field.columns) * static_cast<std::size_t>(cells.field.rows),
        0);
  }
  Section& section = map.section;
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::vector<std::array<std::array<double, 2>, kMostCoordinates>> seen(section.faces.size());
  for (auto& face : seen) face.fill({kNone, -kNone});
  each_entry(pool, {}, [&](const Entry& entry, int) {
    for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis) {
      auto& [low, high] = seen[static_cast<std::size_t>(entry.face)][axis];
      low = std::min(low, entry.at[axis]);
      high = std::max(high, entry.at[axis]);
    }
  });
  for (std::size_t f = 0; f < section.faces.size(); ++f)
    for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis) {
      auto& usual = section.faces[f].usual[axis];
      if (usual[0] < usual[1]) continue;
      const double half = 0.5 * section.coordinates[axis].scale;
      const auto& [low, high] = seen[f][axis];
      usual = low < high    ? std::array{low, high}
              : low <= high ? std::array{low - half, high + half}
                            : std::array{-half, half};
    }
  return problem;
}

std::string far_from_faces(const RunPool& pool, const Problem& problem) {
  const dynamics::Coordinate& place = problem.map().section.coordinates.front();
  const double large = std::max(problem.width, problem.length);
  double farthest = 0.0;
  each_entry(pool, {}, [&](const dynamics::Entry& entry, int) {
    farthest = std::max(farthest, std::abs(entry.at[0]));
  });
  if (place.unit != "m" || farthest <= large) return "";
  return fmt::format(
      "{} is up to {:.7g} m, and a cell is {:.7g} m large: is it in metres, and measured on the "
      "face?",
      place.name, farthest, large);
}

namespace {

/// The use of a face, with any word: whether a body was seen in a cell that it had entered by this
/// face, and the number of passages that lead to it.
struct FaceUse {
  bool entered = false;
  std::int64_t led_to = 0;
};

std::vector<FaceUse> uses_of_faces(const RunPool& pool, const Problem& problem) {
  const dynamics::Section& section = problem.map().section;
  const std::size_t faces = section.words ? static_cast<std::size_t>(section.words->letters().faces)
                                          : section.faces.size();
  std::vector<FaceUse> uses(faces);
  each_entry(pool, {}, [&](const dynamics::Entry& entry, int) {
    uses[static_cast<std::size_t>(entry.face) % faces].entered = true;
  });
  const PassageTable& passages = pool.scattered.each.passages;
  for (std::size_t i = 0; i < passages.size(); ++i)
    if (const CellPassage passage = passages[i]; passage.fate == Fate::left)
      ++uses[static_cast<std::size_t>(passage.entry.face) % faces].led_to;
  return uses;
}

}  // namespace

std::vector<std::string> doubts_of(const RunPool& pool, const Problem& problem) {
  std::vector<std::string> said;
  if (pool.bodies() < kLeastBodies)
    said.push_back(fmt::format("no error bars: they need {} bodies at least, these are {}",
                               kLeastBodies, pool.bodies()));
  const std::vector<FaceUse> uses = uses_of_faces(pool, problem);
  for (std::size_t f = 0; f < uses.size(); ++f)
    if (!uses[f].entered && uses[f].led_to > 0)
      said.push_back(fmt::format(
          "record more cells: {} lead to face {}, and no body was seen behind it; predictions "
          "count these bodies as never sampled",
          uses[f].led_to == 1 ? "1 passage" : fmt::format("{} passages", uses[f].led_to),
          problem.map().section.faces[f].name));
  return said;
}

std::string faces_without_use(const RunPool& pool, const Problem& problem) {
  const std::vector<FaceUse> uses = uses_of_faces(pool, problem);
  std::vector<std::string> names;
  for (std::size_t f = 0; f < uses.size(); ++f)
    if (!uses[f].entered && uses[f].led_to == 0)
      names.push_back(problem.map().section.faces[f].name);
  if (names.empty()) return "";
  return fmt::format(
      "no body went through face {}; you need not act, but a --start there is refused",
      fmt::join(names, " or "));
}

double lost_share(const RunPool& pool) {
  const PassageTable& passages = pool.scattered.each.passages;
  std::int64_t lost = 0;
  for (std::size_t i = 0; i < passages.size(); ++i) lost += passages[i].fate == Fate::broken;
  return static_cast<double>(lost) / static_cast<double>(passages.size());
}

RunPool with_lost(const RunPool& pool, const Problem& problem, LostFate fate, int per_leaf,
                  std::uint64_t seed) {
  const Kernel kernel = kernel_of(problem.map(), pool, per_leaf);
  const FieldTrials& from = pool.scattered.each;
  // By state and type: the passages that left.
  std::vector<std::vector<std::size_t>> left(static_cast<std::size_t>(kernel.space.size()) *
                                             problem.map().types.size());
  const auto place_of = [&](const Entry& entry, const CellPassage& passage) {
    return static_cast<std::size_t>(kernel.space.index_of(entry).state) *
               problem.map().types.size() +
           passage.type;
  };
  const auto each_passage = [&](auto use) {
    for (std::size_t i = 0; i < from.passed.size(); ++i) {
      Entry entry = pool.scattered.starts[i];
      const auto begin = static_cast<std::size_t>(i == 0 ? 0 : from.passed[i - 1]);
      for (std::size_t k = begin; k < static_cast<std::size_t>(from.passed[i]); ++k) {
        const CellPassage passage = from.passages[k];
        use(k, entry, passage);
        entry = passage.entry;
      }
    }
  };
  each_passage([&](std::size_t k, const Entry& entry, const CellPassage& passage) {
    if (passage.fate == Fate::left) left[place_of(entry, passage)].push_back(k);
  });
  RunPool told = pool;
  PassageTable passages(problem.map().section);
  passages.reserve(from.passages.size());
  each_passage([&](std::size_t k, const Entry& entry, CellPassage passage) {
    if (passage.fate == Fate::broken && fate == LostFate::trapped) passage.fate = Fate::trapped;
    if (passage.fate == Fate::broken) {
      const auto& others = left[place_of(entry, passage)];
      if (!others.empty()) {
        Random random(Purpose::resampling, {seed, 0, static_cast<std::uint64_t>(k)});
        passage = from.passages[others[static_cast<std::size_t>(
            random.below(static_cast<std::int64_t>(others.size())))]];
      }
    }
    passages.push_back(passage);
  });
  told.scattered.each.passages = std::move(passages);
  return told;
}

LostBounds lost_bounds(const Problem& problem, const RunPool& pool,
                       const std::optional<Entry>& start, int per_leaf, std::uint64_t seed) {
  LostBounds bounds{lost_share(pool), {}};
  if (bounds.lost > 0.0)
    for (const auto fate : {LostFate::trapped, LostFate::left})
      bounds.final[static_cast<std::size_t>(fate)] =
          predict_whole(problem, with_lost(pool, problem, fate, per_leaf, seed), {start}, per_leaf,
                        seed)
              .front();
  return bounds;
}

}  // namespace gatewalk::lattice
