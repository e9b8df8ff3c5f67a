#pragma once
/// Results as JSON and as tables to read.

#include <array>
#include <cstdint>
#include <string>

#include "cli/command.h"
#include "dynamics/share.h"
#include "dynamics/work.h"
#include "lattice/lattice.h"

namespace gatewalk::cli {

using dynamics::interval_of_share;
using dynamics::share_interval;
using dynamics::Stopwatch;

/// Where a result came from: program version and commit, command, seed, the whole scene.
[[nodiscard]] Json manifest(const Options& options, const lattice::Scene& scene);

/// The record of numerical faults: {"clean": bool, counts, worst values, remarks}.
[[nodiscard]] Json to_json(const dynamics::Health& health);
/// Its inverse. Throws nlohmann::json::exception when a count is missing.
[[nodiscard]] dynamics::Health health_from(const Json& j);
/// One sentence if something was seen, else empty.
[[nodiscard]] std::string complaint(const dynamics::Health& health);

/// How runs of one gate ended: counts, and 95 % intervals of their shares.
[[nodiscard]] Json to_json(const dynamics::GateTally& tally);
[[nodiscard]] Json to_json(const lattice::Comparison& c);
[[nodiscard]] Json grid(const markov::CellCounts& cells);
[[nodiscard]] Json grid(const markov::CellProbabilities& cells);

/// The field seen from above, farthest row on top, in percent. Of fields too large to print: where
/// all but next to nothing lies, in blocks if need be.
[[nodiscard]] std::string map_of(const markov::CellProbabilities& shares,
                                 const std::string& what = "final gate");
/// The map of the trapped, below the first one; empty for fields too large to print and where none
/// is.
[[nodiscard]] std::string map_of_trapped(const markov::CellProbabilities& shares);

/// Fixed-point text of x with `digits` decimals; "-" for a value that is not a number.
[[nodiscard]] std::string fixed(double x, int digits);
/// "12.3 %"
[[nodiscard]] std::string percent(double part, double whole, int digits = 1);
/// How trials through the field ended: shares of all, with 95 % intervals (NaN: none), by
/// markov::Ending.
struct EndingShares {
  std::array<double, markov::kEndings> share{};
  std::array<std::array<double, 2>, markov::kEndings> interval;

  /// Without intervals.
  explicit EndingShares(const std::array<double, markov::kEndings>& shares);
  /// Jeffreys' intervals of these counts.
  EndingShares(const std::array<std::int64_t, markov::kEndings>& counts, std::int64_t trials);
  /// A prediction's, with what the sampling of its matrix makes. Without a limit of gates nothing
  /// is cut off.
  EndingShares(const markov::FinalDistribution& prediction, const lattice::MatrixNoise& noise,
               int max_gates);
};
/// The five that a gate chain has, with their names in JSON and in tables. (It has no way out
/// backwards; states never sampled are told apart.)
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
/// {"crossed": ..., "left_side": ..., ...}: counts, shares, or [low, high] (null: no interval).
[[nodiscard]] Json endings(const std::array<std::int64_t, markov::kEndings>& counts);
[[nodiscard]] Json endings(const std::array<double, markov::kEndings>& shares);
[[nodiscard]] Json endings_95(const EndingShares& shares);
/// A line each: "crossed      0.02 %  [0.00, 0.05]"; `of` ends the first one.
[[nodiscard]] std::string endings_text(const EndingShares& shares, const std::string& of);
/// What two of the endings mean in this scene, below them.
[[nodiscard]] std::string limits_text(const lattice::Scene& scene);
/// Warns when no body can cross the field within the gates it may visit.
void warn_if_too_few_gates(const lattice::Scene& scene);
/// "17.61 [16.87, 18.37]", in %; "17.61" without an interval.
[[nodiscard]] std::string with_interval(double share, const std::array<double, 2>& interval);

/// What is run, in one line: start, body, forces, beams, method.
[[nodiscard]] std::string scene_line(const lattice::Scene& scene);
/// A p-value with 3 decimals, or "<0.001".
[[nodiscard]] std::string p_text(double p);
/// A field of a CSV file (RFC 4180): in quotation marks where it needs them.
[[nodiscard]] std::string csv_text(const std::string& text);
/// Text padded on the left or (negative width) on the right.
[[nodiscard]] std::string padded(const std::string& text, int width);

}  // namespace gatewalk::cli
