// SPDX-License-Identifier: MIT
#include "lattice/pool/assumptions.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "dynamics/cells/words.h"
#include "lattice/pool/relabelled.h"
#include "lattice/statistics/multiple_tests.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

bool any_symmetric(const CellMap& map) {
  return std::any_of(map.types.begin(), map.types.end(),
                     [](const CellMap::Type& type) { return type.symmetric; });
}

/// Makes each face a pair: the face of an entry, and a label for the face of the entry before it.
/// The first `named_` faces have labels of their own and all others share one, so that there are at
/// most kMostFaces pairs. The last label is for starts, which have no entry before.
class FaceBefore {
 public:
  explicit FaceBefore(const Section& section)
      : faces_(static_cast<int>(section.faces.size())),
        named_(std::min(faces_, static_cast<int>(kMostFaces) / faces_ - 2)) {}

  [[nodiscard]] Entry begin(Entry start) {
    before_ = label_of(start.face);
    start.face = pair(start.face, named_ + 1);
    return start;
  }
  [[nodiscard]] CellPassage next(CellPassage passage) {
    if (passage.fate != Fate::left) return passage;
    const int face = std::exchange(passage.entry.face, pair(passage.entry.face, before_));
    before_ = label_of(face);
    return passage;
  }
  /// The section with these pairs; with mirror images only for symmetric cells.
  [[nodiscard]] Section section_of(const Section& section, bool symmetric) const {
    Section pairs = section;
    pairs.named.clear();
    pairs.faces.clear();
    for (int before = 0; before <= named_ + 1; ++before)
      for (int f = 0; f < faces_; ++f) {
        Face& face = pairs.faces.emplace_back(section.faces[f]);
        face.name += " " + std::to_string(before);
        face.usual.fill({0.0, 1.0});  // of a state that nobody was seen to enter
        if (face.mirror != kNoMirror)
          face.mirror = symmetric ? pair(face.mirror, mirror_of(section, before)) : kNoMirror;
      }
    return pairs;
  }
  /// Whether there are labels, and mirrored faces have labels that are mirrored too. What more a
  /// chain with words must remember is asked by study_order().
  [[nodiscard]] bool fits(const Section& section, bool symmetric) const {
    if (faces_ < 2 || named_ < 1 || section.words) return false;
    for (int f = 0; symmetric && f < named_; ++f)
      if (section.faces[f].mirror < 0 || section.faces[f].mirror >= named_) return false;
    return true;
  }

 private:
  [[nodiscard]] int label_of(int face) const { return std::min(face, named_); }
  [[nodiscard]] int pair(int face, int before) const { return before * faces_ + face; }
  [[nodiscard]] int mirror_of(const Section& section, int before) const {
    if (before >= named_) return before;
    return section.faces[before].mirror;
  }

  int faces_, named_, before_ = 0;
};

/// Types of cells by place: each type of the map in each part of the field.
class Places {
 public:
  static constexpr int kMostParts = 5;
  /// Parts of the field: the cells with most runs, each by itself, and all others together. With
  /// quarters that is one cell, often the start's, and the others are near or far and on the left
  /// or right, divided at the row and the column in the middle of the runs; else it is four cells.
  Places(bool quarters, const CellMap& map, const FieldParams& field, const RunPool& pool)
      : map_(map), field_(field) {
    std::vector<std::int64_t> runs = runs_by_cell(pool);
    std::vector<std::size_t> order(runs.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return runs[a] > runs[b]; });
    order.resize(std::min(order.size(), quarters ? std::size_t{1} : std::size_t{kMostParts - 1}));
    part_.assign(runs.size(), 0);
    if (quarters) {
      for (const std::size_t cell : order) runs[cell] = 0;
      divide(runs);
    }
    for (const std::size_t cell : order) part_[cell] = parts_++;
  }

  [[nodiscard]] Entry begin(const Entry& start) {
    column_ = field_.start_column();
    row_ = field_.start_row;
    return start;
  }
  [[nodiscard]] CellPassage next(CellPassage passage) {
    passage.type = static_cast<std::uint8_t>(passage.type * parts_ + part_[cell()]);
    move(passage);
    return passage;
  }
  /// Whether there are several parts, and their types fit into a passage.
  [[nodiscard]] bool fits() const {
    constexpr std::size_t kMostTypes = 256;
    return map_.types.size() * static_cast<std::size_t>(parts_) <= kMostTypes &&
           std::any_of(part_.begin(), part_.end(), [&](int p) { return p != part_.front(); });
  }
  [[nodiscard]] CellMap divided_map() const {
    CellMap divided{map_.section, {}, field_.columns, {}};
    std::vector<int> before;  // by divided type: the type
    for (int type = 0; type < std::ssize(map_.types); ++type)
      for (int part = 0; part < parts_; ++part) {
        divided.types.push_back(map_.types[static_cast<std::size_t>(type)]);
        before.push_back(type);
      }
    if (const auto& words = map_.section.words) divided.section.words = words->of_types(before);
    for (int row = 0; row < field_.rows; ++row)
      for (int column = 0; column < field_.columns; ++column)
        divided.type_of_cell.push_back(
            map_.type_of(column, row) * parts_ +
            part_[static_cast<std::size_t>(row * field_.columns + column)]);
    return divided;
  }

 private:
  void move(const CellPassage& passage) {
    if (passage.fate != Fate::left) return;
    const Face& face = map_.section.faces[static_cast<std::size_t>(passage.entry.face)];
    column_ += face.di_x;
    row_ += face.di_y;
  }
  /// The number of the cell, row by row; of recorded trials that left the field, the nearest.
  [[nodiscard]] std::size_t cell() const {
    return static_cast<std::size_t>(std::clamp(row_, 0, field_.rows - 1) * field_.columns +
                                    std::clamp(column_, 0, field_.columns - 1));
  }
  [[nodiscard]] std::vector<std::int64_t> runs_by_cell(const RunPool& pool) {
    std::vector<std::int64_t> runs(
        static_cast<std::size_t>(field_.rows) * static_cast<std::size_t>(field_.columns), 0);
    const auto count = [&](const FieldTrials& trials) {
      for (std::size_t i = 0; i < trials.passed.size(); ++i) {
        (void)begin({});
        for (const CellPassage passage : trials.of_trial(i)) {
          ++runs[cell()];
          move(passage);
        }
      }
    };
    for (const OwnRuns& s : pool.starts) count(s.full);
    count(pool.scattered.each);
    return runs;
  }
  /// Divides the field at a row and at a column.
  void divide(const std::vector<std::int64_t>& runs) {
    const auto columns = static_cast<std::size_t>(field_.columns);
    std::vector<std::int64_t> by_row(static_cast<std::size_t>(field_.rows), 0), by_column(columns);
    for (std::size_t cell = 0; cell < runs.size(); ++cell) {
      by_row[cell / columns] += runs[cell];
      by_column[cell % columns] += runs[cell];
    }
    const std::size_t first_far = half_of(by_row), first_right = half_of(by_column);
    for (std::size_t cell = 0; cell < runs.size(); ++cell)
      part_[cell] = 2 * (cell / columns >= first_far) + (cell % columns >= first_right);
    parts_ = 4;
  }
  /// The first row or column whose middle has at least half of the runs before it.
  [[nodiscard]] static std::size_t half_of(const std::vector<std::int64_t>& runs) {
    const auto all = std::accumulate(runs.begin(), runs.end(), std::int64_t{0});
    std::int64_t before = 0;
    std::size_t at = 0;
    for (; at < runs.size() && 2 * before + runs[at] < all; ++at) before += runs[at];
    return at;
  }

  const CellMap& map_;
  const FieldParams& field_;
  int parts_ = 1;
  std::vector<int> part_{};  // by cell, row by row
  int column_ = 0, row_ = 0;
};

/// Predictions of the chain of the runs with other labels.
template <class Label>
std::optional<GroupedMaps> maps_with(const Label& label, const CellMap& labelled,
                                     const FieldParams& field, const RunPool& pool,
                                     const std::vector<FirstRow>& starts, int per_leaf,
                                     std::optional<int> per_row = {}) {
  const RunPool runs = relabelled(pool, labelled.section, label);
  std::vector<FirstRow> same;
  for (const FirstRow& start : starts) {
    const auto* const own = std::get_if<const OwnRuns*>(&start);
    same.push_back(own ? &runs.starts[static_cast<std::size_t>(*own - pool.starts.data())] : start);
  }
  return mean_maps(labelled, field, runs, same, per_leaf, per_row);
}

/// Predictions of the relaxed chain; nullopt if the chain does not make the assumption.
std::optional<GroupedMaps> relaxed_maps(Assumption dropped, const CellMap& map,
                                        const FieldParams& field, const RunPool& pool,
                                        const std::vector<FirstRow>& starts, int per_leaf) {
  switch (dropped) {
    case Assumption::mirror: {
      CellMap one_sided = map;
      bool any = false;
      for (CellMap::Type& type : one_sided.types) any = std::exchange(type.symmetric, false) || any;
      if (!any) return {};
      return mean_maps(one_sided, field, pool, starts, per_leaf);
    }
    case Assumption::states:
      if (per_leaf < 2) return {};
      return mean_maps(map, field, pool, starts, per_leaf / 2);
    case Assumption::face_before: {
      const FaceBefore label(map.section);
      if (!label.fits(map.section, any_symmetric(map))) return {};
      CellMap pairs = map;
      pairs.section = label.section_of(map.section, any_symmetric(map));
      return maps_with(label, pairs, field, pool, starts, per_leaf);
    }
    case Assumption::quarters:
    case Assumption::cells: {
      // Recorded bodies may be seen first anywhere: their rows are not those of the field.
      if (!pool.scattered.each.bodies.empty()) return {};
      const Places label(dropped == Assumption::quarters, map, field, pool);
      if (!label.fits()) return {};
      return maps_with(label, label.divided_map(), field, pool, starts,
                       Places::kMostParts * per_leaf, per_leaf);
    }
  }
  return {};
}

}  // namespace

std::string_view key_of(Assumption assumption) {
  constexpr std::array<std::string_view, kAssumptions.size()> kKeys{
      "mirror", "states", "face_before", "quarters", "cells"};
  return kKeys[static_cast<std::size_t>(assumption)];
}

const AssumptionCheck* wrong_assumption(const std::vector<AssumptionCheck>& checks) {
  const AssumptionCheck* worst = nullptr;
  const auto times_chance = [](const AssumptionCheck& c) {
    return c.total_variation / c.chance_95;
  };
  for (const AssumptionCheck& check : checks)
    if (check.is_wrong() && (worst == nullptr || times_chance(check) > times_chance(*worst)))
      worst = &check;
  return worst;
}

std::vector<AssumptionCheck> check_assumptions(const CellMap& map, const FieldParams& field,
                                               const RunPool& pool,
                                               const std::vector<FirstRow>& starts, int per_leaf,
                                               int coordinates, std::uint64_t seed,
                                               std::optional<GroupedMaps> chain,
                                               const std::optional<GroupedMaps>& small_leaves) {
  std::vector<AssumptionCheck> checks;
  if (field.max_gates == 1 || starts.empty()) return checks;
  if (!chain) chain = mean_maps(map, field, pool, starts, per_leaf);
  // States larger than usual can make bodies seem to remember: whether they do is asked of usual
  // states.
  std::optional<GroupedMaps> usual = chain;
  if (per_leaf > kEntriesPerLeaf) usual = mean_maps(map, field, pool, starts, kEntriesPerLeaf);
  if (!chain || !usual) return checks;
  const int leaf = std::min(per_leaf, kEntriesPerLeaf);
  std::optional<GroupedMaps> large_states;
  for (const Assumption dropped : kAssumptions) {
    const bool of_states = dropped == Assumption::states,
               by_place = dropped == Assumption::quarters || dropped == Assumption::cells;
    const bool is_large = of_states && per_leaf > kEntriesPerLeaf;
    const auto relaxed = is_large ? usual
                         : of_states && small_leaves
                             ? small_leaves
                             : relaxed_maps(dropped, map, field, pool, starts, leaf);
    if (!relaxed) continue;
    // In a chain divided by place each row has the runs of one part of the field. Its states are
    // larger for that, and so are those of the chain that it is compared with.
    if (by_place && !large_states)
      large_states = mean_maps(map, field, pool, starts, Places::kMostParts * leaf, leaf);
    const GroupDifference d =
        group_difference(is_large   ? *chain
                         : by_place ? *large_states
                                    : *usual,
                         *relaxed, coordinates, seed, static_cast<std::uint64_t>(dropped));
    checks.push_back({dropped, d.total_variation, d.chance_95, d.p});
  }
  std::vector<double> p;
  for (const AssumptionCheck& check : checks) p.push_back(check.p);
  p = holm(p);
  for (std::size_t i = 0; i < checks.size(); ++i) checks[i].p_adjusted = p[i];
  return checks;
}

}  // namespace gatewalk::lattice
