// SPDX-License-Identifier: MIT
// Counts of an experiment: a table, or two with a line "---" between.
#include "lattice/study/observed.h"

#include "tests/fuzz/fuzz.h"

namespace gatewalk::fuzz {

void observed(std::string_view bytes) {
  const auto [first, second] = parted(bytes);
  std::vector<std::string> paths{file_of(first, ".csv")};
  if (!second.empty()) paths.push_back(file_of(second, ".second.csv"));
  lattice::FieldParams field;
  field.columns = 5;
  field.rows = 4;
  const auto observed = accepted([&] { return lattice::read_observed(paths, field); });
  if (!observed) return;
  const lattice::SeenEndings& seen = observed->seen;
  require(seen.trials() > 0, "there are trials");
  std::string table;
  if (seen.has_gates()) {
    require((seen.final_gates >= 0).all(), "counts are not negative");
    table = "gate_x,gate_y,count\n";
    for (int y = 0; y < field.rows; ++y)
      for (int c = 0; c < field.columns; ++c)
        table += std::to_string(c - field.start_column()) + "," + std::to_string(y) + "," +
                 std::to_string(seen.final_gates(y, c)) + "\n";
    const auto again =
        accepted([&] { return lattice::read_observed({file_of(table, ".again.csv")}, field); });
    // A count in a line is at most 1e9; so is the sum over lines of single trials.
    require(again && (again->seen.final_gates == seen.final_gates).all(),
            "counts that were written and read are the same");
  }
}

}  // namespace gatewalk::fuzz
