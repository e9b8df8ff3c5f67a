// SPDX-License-Identifier: MIT
#pragma once
/// Pictures of where bodies end in a field.

#include <optional>
#include <string>
#include <vector>

#include "cli/render/figure.h"
#include "cli/render/final_gates.h"
#include "cli/render/shown_field.h"
#include "lattice/exits.h"
#include "lattice/lattice.h"
#include "lattice/reference.h"
#include "lattice/statistics/ending_shares.h"
#include "markov/predict.h"

namespace gatewalk::cli {

/// Where bodies end that began in one way: shares of all.
struct FieldPicture {
  std::string title;
  markov::CellProbabilities final_gates, trapped, departed;  // (rows x columns)
  lattice::EndingShares endings;
  std::optional<lattice::FieldExits> exits;

  FieldPicture(std::string title, const markov::FinalDistribution& final,
               const lattice::EndingShares& endings, const lattice::FieldExits& exits);
  FieldPicture(std::string title, const lattice::FieldTally& tally,
               const lattice::FieldExits& exits);
  FieldPicture(std::string title, const markov::WalkTally& tally);
};

/// The map of the final gates, those of the trapped and of the departed, the endings, and where
/// along its sides they left; of several starts one below the other. Of a field with several types
/// of gates, which is which. Throws std::invalid_argument for more than kMostPictures.
inline constexpr std::size_t kMostPictures = 8;
[[nodiscard]] Figure figure_of(const std::vector<FieldPicture>& pictures, const ShownField& shown);

/// A map of a field at the top left of a sheet, and where it is drawn.
struct SmallMap {
  FieldMap map;
  double columns, rows;  // of blocks
  Box box{};

  explicit SmallMap(const markov::CellProbabilities& shown);
  [[nodiscard]] double width() const { return box.right - box.left; }
  [[nodiscard]] double height() const { return box.bottom - box.top; }
};

/// Tics of an axis over blocks of gates that is so many points long, named by the gates in the
/// blocks' middle, counted from `zero`; and its range.
[[nodiscard]] std::string tics_of(const FieldMap::Span& span, Eigen::Index zero, double length,
                                  double apart);
[[nodiscard]] std::string range_of(const FieldMap::Span& span);

}  // namespace gatewalk::cli
