// SPDX-License-Identifier: MIT
#pragma once
/// Shares of trials by ending and by exit from the field, with intervals.

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "markov/ends.h"

namespace gatewalk::markov {
struct FinalDistribution;
}

namespace gatewalk::lattice {

class MatrixNoise;

/// The five endings of a gate chain, with their names in files (`key`) and in tables (`name`).
/// Ending::unsampled is not among them.
struct EndingName {
  markov::Ending ending;
  const char *key, *name;
};
inline constexpr std::array<EndingName, 5> kEndingNames{
    {{markov::Ending::far_edge, "crossed", "crossed"},
     {markov::Ending::left_edge, "left_side", "left side"},
     {markov::Ending::right_edge, "right_side", "right side"},
     {markov::Ending::trapped, "trapped", "trapped"},
     {markov::Ending::cut_off, "cut_off", "cut off"}}};

/// The ending of bodies that leave over the side by which they came in, where cells let bodies move
/// back.
inline constexpr EndingName kWentBack{markov::Ending::near_edge, "went_back", "went back"};
inline constexpr std::array<EndingName, 6> kAllEndingNames{
    kEndingNames[0], kEndingNames[1], kEndingNames[2], kEndingNames[3], kEndingNames[4], kWentBack};

/// The ending with this key or name, in upper or lower case; nullopt if there is none.
[[nodiscard]] std::optional<markov::Ending> ending_named(std::string_view name);

/// Shares of all trials by markov::Ending, with 95 % intervals (NaN: none).
struct EndingShares {
  std::array<double, markov::kEndings> share{};
  std::array<std::array<double, 2>, markov::kEndings> interval;

  /// Shares without intervals.
  explicit EndingShares(const std::array<double, markov::kEndings>& shares);
  /// Shares of counts, with Jeffreys intervals.
  EndingShares(const std::array<std::int64_t, markov::kEndings>& counts, std::int64_t trials);
  /// Shares of a prediction. The intervals include the sampling error of the matrix and walks that
  /// were not followed to their end.
  EndingShares(const markov::FinalDistribution& prediction, const MatrixNoise& noise,
               int max_gates);

  /// With max_gates 0 and no walk cut off, sets the interval of `cut_off` to [0, 0]: without a
  /// limit of gates this ending is impossible. Walks given up after very many gates count as cut
  /// off.
  [[nodiscard]] EndingShares with_limit(int max_gates) const;
  /// True if the interval of `ending` is [0, 0]; for `went_back`: if no body went back.
  [[nodiscard]] bool rules_out(markov::Ending ending) const;
};

/// The sides over which bodies leave the field. A place on the far side is a column of gates, on
/// the other sides a row.
inline constexpr std::array<markov::Ending, 3> kSides{
    markov::Ending::far_edge, markov::Ending::left_edge, markov::Ending::right_edge};
inline constexpr std::size_t kFarSide = 0;

/// Shares of all bodies that leave at each place of one side, with 95 % intervals (NaN: none).
struct SideExits {
  std::vector<double> share;
  std::vector<std::array<double, 2>> interval;
};
using FieldExits = std::array<SideExits, kSides.size()>;  // by kSides

}  // namespace gatewalk::lattice
