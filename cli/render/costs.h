// SPDX-License-Identifier: MIT
#pragma once
/// The costs of bodies on their way through a field (time, work, ...), as keys of results and as a
/// table.

#include <array>
#include <optional>
#include <string>

#include "cli/fields/fields.h"
#include "cli/fields/text_table.h"
#include "cli/render/shown_field.h"
#include "dynamics/disc/gate.h"
#include "lattice/field/field_costs.h"

namespace gatewalk::cli {

/// Costs of bodies with one ending, or of all bodies.
struct Spent {
  static constexpr std::array<double, 5> kLevels{0.05, 0.25, 0.5, 0.75, 0.95};

  double share = 0.0;                              // share of all bodies
  dynamics::Costs mean{}, sd{};                    // in the order of Section::costs
  std::vector<Interval> mean_95{};                 // of the means; empty: not known
  std::array<double, kLevels.size()> quantiles{};  // of the duration, s; NaN: not known

  [[nodiscard]] double of(dynamics::Cost c) const { return mean[static_cast<std::size_t>(c)]; }
  /// Cost of transport of a disc: work of both forces per mass and distance ahead, J / (kg m).
  [[nodiscard]] double cost_of_transport(double mass) const;
};
/// Describes the keys of `spent`.
void describe(Fields& out, const Spent& spent, const ShownField& shown);

/// "crossed      25.1   18 to 33    1490      35    1400    8.1": a table of costs with a line for
/// each ending. For cells other than a disc's gates: time and each further cost.
class CostTable {
 public:
  explicit CostTable(const ShownField& shown);
  void add(const std::string& name, const Spent& spent);
  [[nodiscard]] std::string text() const { return header_ + lines_.rows(); }

 private:
  std::size_t costs_;
  std::optional<double> mass_;
  std::string header_ = "            mean time/s     5 to 95 %/s";
  TextTable lines_;
};

/// The key "costs": costs of trials, of all and by ending.
void describe_costs(Fields& out, const lattice::FieldCosts& costs, const ShownField& shown);
[[nodiscard]] std::string table_of(const lattice::FieldCosts& costs, const ShownField& shown);

}  // namespace gatewalk::cli
