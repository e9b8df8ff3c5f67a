// SPDX-License-Identifier: MIT
#pragma once
/// How trials through the field ended, and where they left it, as shares with intervals.

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

/// The five that a gate chain has, with their names in files and in tables. (States never sampled
/// are told apart.)
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

/// Where cells let bodies move back: those who leave over the side that they came in by.
inline constexpr EndingName kWentBack{markov::Ending::near_edge, "went_back", "went back"};
inline constexpr std::array<EndingName, 6> kAllEndingNames{
    kEndingNames[0], kEndingNames[1], kEndingNames[2], kEndingNames[3], kEndingNames[4], kWentBack};

/// By either of its names, in capitals or not; none for any other.
[[nodiscard]] std::optional<markov::Ending> ending_named(std::string_view name);

/// Shares of all, with 95 % intervals (NaN: none), by markov::Ending.
struct EndingShares {
  std::array<double, markov::kEndings> share{};
  std::array<std::array<double, 2>, markov::kEndings> interval;

  /// Without intervals.
  explicit EndingShares(const std::array<double, markov::kEndings>& shares);
  /// Jeffreys' intervals of these counts.
  EndingShares(const std::array<std::int64_t, markov::kEndings>& counts, std::int64_t trials);
  /// A prediction's, with what the sampling of its matrix makes, and walks not followed to their
  /// end.
  EndingShares(const markov::FinalDistribution& prediction, const MatrixNoise& noise,
               int max_gates);

  /// Without a limit of gates (max_gates 0) nothing is cut off, and that is certain; but walks that
  /// were given up after very many gates are.
  [[nodiscard]] EndingShares with_limit(int max_gates) const;
  /// Whether nobody can end so, as its interval says; of those who went back, whether none did.
  [[nodiscard]] bool rules_out(markov::Ending ending) const;
};

/// The sides that bodies leave over. A place along the far one is a column of gates, along the
/// others a row.
inline constexpr std::array<markov::Ending, 3> kSides{
    markov::Ending::far_edge, markov::Ending::left_edge, markov::Ending::right_edge};
inline constexpr std::size_t kFarSide = 0;

/// Shares of all bodies that leave at each place of a side, with 95 % intervals (NaN: none).
struct SideExits {
  std::vector<double> share;
  std::vector<std::array<double, 2>> interval;
};
using FieldExits = std::array<SideExits, kSides.size()>;  // by kSides

}  // namespace gatewalk::lattice
