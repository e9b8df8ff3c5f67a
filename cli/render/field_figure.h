// SPDX-License-Identifier: MIT
#pragma once
/// Figures of where bodies end in a field.

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/render/field_ends.h"
#include "cli/render/final_gates.h"
#include "cli/render/panel.h"
#include "cli/render/shown_field.h"
#include "cli/render/start.h"
#include "lattice/field/exits.h"
#include "lattice/statistics/ending_shares.h"
#include "markov/predict.h"

namespace gatewalk::cli {

/// Where bodies from one start end, as shares of all bodies.
struct FieldPicture {
  std::string title;
  markov::CellProbabilities final_gates, trapped, departed;  // (rows x columns)
  lattice::EndingShares endings;
  std::optional<lattice::FieldExits> exits;
  std::optional<dynamics::Entry> start;
  std::optional<std::array<markov::CellProbabilities, 2>> gates_95;  // of final_gates: low, high

  template <class Number>
  FieldPicture(std::string name, const FieldEnds<Number>& ends,
               std::optional<lattice::FieldExits> by_place, std::optional<dynamics::Entry> began,
               std::optional<std::array<markov::CellProbabilities, 2>> intervals = {})
      : title(std::move(name)),
        final_gates(ends.share_of(ends.final_cells)),
        trapped(ends.share_of(trapped_cells(ends))),
        departed(ends.share_of(departed_cells(ends))),
        endings(ends.shares),
        exits(std::move(by_place)),
        start(std::move(began)),
        gates_95(std::move(intervals)) {}
};

/// The maps of final gates, trapped and departed bodies, the endings, and where along the sides
/// bodies left; several starts one below the other. In a field with several types of gates, marks
/// show the types. Throws std::invalid_argument for more than kMostPictures.
inline constexpr std::size_t kMostPictures = 8;
[[nodiscard]] Figure figure_of(const std::vector<FieldPicture>& pictures, const ShownField& shown);

/// A map of a field at the top left of a sheet, and its place.
struct SmallMap {
  FieldMap map;
  Box box{};

  SmallMap(const markov::CellProbabilities& shown, const lattice::FieldParams& field);
};

/// Adds a panel with a map's blocks of gates on its axes; the x axis has a tic every `apart`
/// points.
[[nodiscard]] Panel& add_map(Panels& out, const FieldMap& map, const Box& box, double apart = 30);
/// Adds "column row root_of_share" in % for each block, with the share as a short text if asked
/// for.
void add_shares(Rows& rows, const FieldMap& map, const markov::CellProbabilities& shares,
                bool as_text = false);
/// Adds "column row value" for each block.
void add_values(Rows& rows, const markov::CellProbabilities& values);
/// The numbers of a field's gates, row by row, that a block of a map holds.
[[nodiscard]] std::vector<std::size_t> gates_in(const FieldMap& map, Eigen::Index row,
                                                Eigen::Index column,
                                                const lattice::FieldParams& field);
/// Whether numbers fit into the cells of a map in that box.
[[nodiscard]] bool numbers_fit(const FieldMap& map, const Box& box);

}  // namespace gatewalk::cli
