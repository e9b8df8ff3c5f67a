// SPDX-License-Identifier: MIT
// Recorded runs: a cell file, a line "---", the table.
#include "lattice/recorded/recorded.h"

#include <cmath>

#include "lattice/recorded/recorded_pool.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/large_field.h"

namespace gatewalk::fuzz {
namespace {

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

bool same(const lattice::CellPassage& a, const lattice::CellPassage& b) {
  if (a.fate != b.fate || a.type != b.type || !(a.entry == b.entry)) return false;
  for (std::size_t c = 0; c < a.costs.size(); ++c)
    if (!same(a.costs[c], b.costs[c])) return false;
  return true;
}

}  // namespace

void runs(std::string_view bytes) {
  const std::string_view text = parted(bytes).first, table = parted(bytes).second;
  if (has_large_field(text, {})) return;
  auto cells = accepted([&] { return lattice::parse_cell_file(text, "x.toml"); });
  if (!cells) return;
  const auto runs = accepted([&] { return lattice::read_runs(file_of(table, ".csv"), *cells); });
  if (!runs) return;
  std::int64_t passages = 0;
  for (const lattice::RecordedTrial& trial : runs->trials) passages += trial.count;
  require(passages == std::ssize(runs->passages), "every passage is of a trial");
  const std::string path = file_of("", ".again.csv");
  lattice::CellFile others = *cells;
  lattice::write_runs(path, *cells, *runs);
  const lattice::RecordedRuns again = lattice::read_runs(path, others);
  require(again.bodies == runs->bodies && again.trials.size() == runs->trials.size() &&
              again.passages.size() == runs->passages.size() && again.unknown == runs->unknown,
          "runs that were written and read are as many");
  for (std::size_t i = 0; i < runs->passages.size(); ++i)
    require(same(runs->passages[i], again.passages[i]), "and the same");
  (void)accepted([&] { return lattice::problem_of(*cells, lattice::pool_of(*runs)).field.rows; });
}

}  // namespace gatewalk::fuzz
