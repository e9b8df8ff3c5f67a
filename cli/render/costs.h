// SPDX-License-Identifier: MIT
#pragma once
/// What bodies take on their way through a field (time, work, ...), as keys of results and as a
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

/// What bodies took that ended in one way, or all.
struct Spent {
  static constexpr std::array<double, 5> kLevels{0.05, 0.25, 0.5, 0.75, 0.95};

  double share = 0.0;                              // of all bodies
  dynamics::Costs mean{}, sd{};                    // by Section::costs
  std::vector<Interval> mean_95{};                 // of the means; empty: not known
  std::array<double, kLevels.size()> quantiles{};  // of the duration, s; NaN: not known

  [[nodiscard]] double of(dynamics::Cost c) const { return mean[static_cast<std::size_t>(c)]; }
  /// Of a disc: work of both forces per mass and way forward, J / (kg m).
  [[nodiscard]] double cost_of_transport(double mass) const;
};
/// Its keys.
void describe(Fields& out, const Spent& spent, const ShownField& shown);

/// A line for each way to end: "crossed      25.1   18 to 33    1490      35    1400    8.1"; of
/// other cells than a disc's, time and each further cost.
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

/// The key "costs": what trials took, of all and by how they ended.
void describe_costs(Fields& out, const lattice::FieldCosts& costs, const ShownField& shown);
[[nodiscard]] std::string table_of(const lattice::FieldCosts& costs, const ShownField& shown);

}  // namespace gatewalk::cli
