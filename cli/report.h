#pragma once
/// Results as JSON and as tables to read.

#include <array>
#include <chrono>
#include <cstdint>
#include <string>

#include "cli/command.h"
#include "lattice/lattice.h"

namespace gatewalk::cli {

/// Where a result came from: program version and commit, command, seed, the whole scene.
[[nodiscard]] Json manifest(const Options& options, const Scene& scene);

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

/// The field seen from above, farthest row on top, in percent. Of fields too large to print: where all
/// but next to nothing lies, in blocks if need be.
[[nodiscard]] std::string map_of(const markov::CellProbabilities& shares);

/// Fixed-point text of x with `digits` decimals; "-" for a value that is not a number.
[[nodiscard]] std::string fixed(double x, int digits);
/// "12.3 %"
[[nodiscard]] std::string percent(double part, double whole, int digits = 1);
/// What share of all trials a count of some stands for, with 95 %: Jeffreys' interval.
[[nodiscard]] std::array<double, 2> share_interval(std::int64_t part, std::int64_t whole);
/// What is run, in one line: start, body, forces, beams, method.
[[nodiscard]] std::string scene_line(const Scene& scene);
/// A p-value with 3 decimals, or "<0.001".
[[nodiscard]] std::string p_text(double p);
/// A field of a CSV file (RFC 4180): in quotation marks where it needs them.
[[nodiscard]] std::string csv_text(const std::string& text);
/// Text padded on the left or (negative width) on the right.
[[nodiscard]] std::string padded(const std::string& text, int width);

/// A state's bin: "EN d [-5, 5] m, vx [-5, 5] m/s, vy [10, 20] m/s"
[[nodiscard]] std::string text_of(const dynamics::Cell& cell);
/// "[-5, 5]", or "15" for a single value.
[[nodiscard]] std::string text_of(const std::array<double, 2>& range);

/// Seconds since construction.
class Stopwatch {
 public:
  [[nodiscard]] double seconds() const;

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace gatewalk::cli
