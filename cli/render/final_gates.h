// SPDX-License-Identifier: MIT
#pragma once
/// Where and how trials, walks and predictions end in a field, as keys of results and as tables.

#include <array>
#include <cstdint>
#include <string>

#include "cli/fields/fields.h"
#include "lattice/statistics/ending_shares.h"
#include "markov/predict.h"
#include "markov/walk.h"

namespace gatewalk::lattice {
struct Comparison;
struct JointTest;
struct PairedChange;
}  // namespace gatewalk::lattice

namespace gatewalk::cli {

/// The keys of a comparison of two maps of final gates.
void describe(Fields& out, const lattice::Comparison& c);
/// The keys of a change's effect on the final gates of the same trials.
void describe_change(Fields& out, const lattice::PairedChange& change);
/// The keys of a joint test of all statistics.
void describe(Fields& out, const lattice::JointTest& j);

/// A map in the result of a command with --netcdf; null for fields with more than kMostGatesInJson
/// gates.
inline constexpr Eigen::Index kMostGatesInJson = 100'000;
template <class Cells>
void describe_map(Fields& out, const Field& f, const Cells& cells) {
  if (cells.size() > kMostGatesInJson)
    out.no_grid(f);
  else
    out.grid(f, cells);
}
/// A map with its 95 % intervals.
void describe_map(Fields& out, const Field& f, const markov::CellProbabilities& cells,
                  const GateLimits& limits);
/// The key "total_variation_by_chance", between two maps of final gates.
void describe_by_chance(Fields& out, double mean, double q95);
/// The key "left_out", in fields with so many gates that maps are null.
void describe_left_out(Fields& out, int columns, int rows);

/// The part of a field that a map shows: the whole field, or in large fields the part that holds
/// all but next to nothing, in blocks if necessary.
struct FieldMap {
  /// `count` gates from `first` on, in blocks of `block`; `first` may lie before the field.
  struct Span {
    Eigen::Index first, count, block;
    [[nodiscard]] Eigen::Index blocks() const { return (count + block - 1) / block; }
    /// The gate in the middle of block i; and the block that holds a gate.
    [[nodiscard]] Eigen::Index middle(Eigen::Index i) const {
      return first + i * block + block / 2;
    }
    [[nodiscard]] Eigen::Index block_of(Eigen::Index gate) const { return (gate - first) / block; }
  };
  Span rows, columns;
  Eigen::Index start_column;  // i_x = 0

  FieldMap(const markov::CellProbabilities& shares, Eigen::Index start, Eigen::Index most_rows,
           Eigen::Index most_columns);
  /// Shares of the same field, summed by block.
  [[nodiscard]] markov::CellProbabilities blocks_of(const markov::CellProbabilities& shares) const;
};
/// The share in gates that the map leaves out, as text: "elsewhere in the 301 x 301 gates: 0.01 %".
/// Empty if there is none.
[[nodiscard]] std::string elsewhere_text(const FieldMap& map,
                                         const markov::CellProbabilities& shares);
/// A share in %, short enough for a gate of a figure: "17", "1.2", "<.1"; empty for 0.
[[nodiscard]] std::string short_percent(double share);

/// The field seen from above in percent, farthest row on top, under the title "WHAT, UNIT"; columns
/// count from `start`. Of a field too large to print, the part that holds all but next to nothing,
/// in blocks if necessary.
[[nodiscard]] std::string map_of(const markov::CellProbabilities& shares, Eigen::Index start,
                                 const std::string& what, const std::string& unit);
/// The map of trapped bodies; empty for fields too large to print and if no body is trapped.
[[nodiscard]] std::string map_of_trapped(const markov::CellProbabilities& shares,
                                         Eigen::Index start, const std::string& unit);

using lattice::EndingName;
using lattice::kAllEndingNames;
using lattice::kEndingNames;
/// What bodies with this ending do: "are trapped in a gate".
[[nodiscard]] std::string_view meaning_of(const EndingName& ending);
using EndingCounts = std::array<std::int64_t, markov::kEndings>;
using EndingChances = std::array<double, markov::kEndings>;
[[nodiscard]] const EndingName& ending_name(markov::Ending ending);
/// The keys of all endings.
[[nodiscard]] std::vector<std::string> ending_keys();
/// The key "answer_from".
void describe_answer_from(Fields& out, bool from_trials);
/// An object with a key for each ending: counts, or shares of all bodies.
void describe_endings(Fields& out, const Label& l, const EndingCounts& counts);
void describe_endings(Fields& out, const Label& l, const EndingChances& shares);
/// Counts of endings among `bodies`, followed by an object with their 95 % intervals: the limits of
/// `shares` times `bodies`.
void describe_endings(Fields& out, const Label& l, const EndingCounts& counts, double bodies,
                      const lattice::EndingShares& shares);
void describe_endings(Fields& out, const Label& l, const lattice::EndingShares& shares);
/// The keys "endings" and "endings_95".
void describe_endings(Fields& out, const EndingCounts& counts, double bodies,
                      const lattice::EndingShares& shares);
void describe_endings(Fields& out, const lattice::EndingShares& shares);
/// The endings of a prediction as shown: a share is 0 if rounding and unfinished walks may explain
/// it.
[[nodiscard]] lattice::EndingShares shown_endings(lattice::EndingShares shares,
                                                  const markov::FinalDistribution& f);
/// Shares of bodies whose ending is unknown, so that the endings leave them out.
struct Rest {
  double never_sampled = 0.0;  // reach a state whose row has no runs
  double still_walking = 0.0;  // under way when the sum or the walks stopped
  std::string stopped = "when the sum was stopped";
};
[[nodiscard]] Rest rest_of(const markov::FinalDistribution& f);
/// The keys "never_sampled" and "still_walking".
void describe(Fields& out, const Rest& rest);
/// A line for each of these shares; empty if nothing is left out.
[[nodiscard]] std::string rest_text(const Rest& rest);
/// A warning if a notable share is left out: "the endings add up to 25.00 %: ..."; else empty.
/// `where` is put in front.
[[nodiscard]] std::string rest_warning(const Rest& rest, const std::string& where = "");

/// A share in % with two decimals, or with two digits if these would be 0.
[[nodiscard]] std::string percents(double share);
/// A line for each possible ending: "crossed      0.02 %  [0.00, 0.05]"; `of` stands at the end of
/// the first line. Of the endings in `impossible`, those with a share of 0 have "-" as interval,
/// and a line below explains this mark.
[[nodiscard]] std::string endings_text(const lattice::EndingShares& shares,
                                       const std::string& of = "",
                                       const std::vector<markov::Ending>& impossible = {});
/// "17.61 [16.87, 18.37]", in %; "17.61" without an interval.
[[nodiscard]] std::string with_interval(double share, const std::array<double, 2>& interval);

}  // namespace gatewalk::cli
