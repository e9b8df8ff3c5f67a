#pragma once
/// Pictures of where bodies end in a field.

#include <string>
#include <vector>

#include "cli/render/figure.h"
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

/// The map of the final gates, those of the trapped and of those who left, and the endings; of
/// several starts one below the other. Throws std::invalid_argument for more than kMostPictures.
inline constexpr std::size_t kMostPictures = 8;
[[nodiscard]] Figure figure_of(const std::vector<FieldPicture>& pictures);

}  // namespace gatewalk::cli
