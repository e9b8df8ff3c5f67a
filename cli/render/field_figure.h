#pragma once
/// Pictures of where bodies end in a field.

#include <string>
#include <vector>

#include "cli/render/figure.h"
#include "cli/render/final_gates.h"
#include "lattice/ending_shares.h"
#include "lattice/lattice.h"
#include "lattice/reference.h"
#include "markov/predict.h"

namespace gatewalk::cli {

/// Where bodies end that began in one way: shares of all.
struct FieldPicture {
  std::string title;
  markov::CellProbabilities final_gates, trapped, departed;  // (rows x columns)
  lattice::EndingShares endings;

  FieldPicture(std::string title, const markov::FinalDistribution& final,
               const lattice::EndingShares& endings);
  FieldPicture(std::string title, const lattice::FieldTally& tally);
  FieldPicture(std::string title, const markov::WalkTally& tally);
};

/// The map of the final gates, those of the trapped and of the departed, and the endings; of
/// several starts one below the other. Throws std::invalid_argument for more than kMostPictures.
inline constexpr std::size_t kMostPictures = 8;
[[nodiscard]] Figure figure_of(const std::vector<FieldPicture>& pictures);

/// Tics of an axis over blocks of gates that is so many points long, named by the gates in the
/// blocks' middle, counted from `zero`; and its range.
[[nodiscard]] std::string tics_of(const FieldMap::Span& span, Eigen::Index zero, double length,
                                  double apart);
[[nodiscard]] std::string range_of(const FieldMap::Span& span);

}  // namespace gatewalk::cli
