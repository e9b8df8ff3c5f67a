// SPDX-License-Identifier: MIT
// Chains that were made elsewhere: tables of states, and matrices and trajectories of three states.
#include "cli/exchange/imported.h"

#include <algorithm>

#include "tests/fuzz/fuzz.h"

namespace gatewalk::fuzz {
namespace {

constexpr const char* kStates = "state,move_x,move_y,name\n0,0,1,up\n1,1,0,right\n2,-1,0,left\n";

bool same(const cli::SparseTable& a, const cli::SparseTable& b) {
  return a.rows == b.rows && a.columns == b.columns &&
         std::equal(a.entries.begin(), a.entries.end(), b.entries.begin(), b.entries.end(),
                    [](const auto& x, const auto& y) {
                      return x.row == y.row && x.column == y.column && x.value == y.value;
                    });
}

void read_as(std::string_view bytes, const std::string& ending) {
  static const std::vector<cli::ForeignState> states =
      cli::read_states(file_of(kStates, ".states"));
  static const lattice::CellFile cells =
      lattice::parse_cell_file(cli::cell_text(states, 0.1, 0.1), "x.toml");
  const auto matrix = accepted([&] { return cli::read_foreign(file_of(bytes, ending), states); });
  if (!matrix) return;
  const auto t = accepted([&] { return cli::transitions_of(*matrix, states, cells); });
  if (!t) return;
  for (std::size_t row = 0; row < t->rows.size(); ++row) {
    std::int64_t sum = 0;
    for (const auto& [column, n] : t->rows[row]) {
      require(n > 0, "a count is positive");
      sum += n;
    }
    require(sum == t->trials[row], "counts of a row add up to its trials");
    require(!matrix->probabilities || sum == 0 || sum >= std::int64_t{1} << 20,
            "probabilities are counts of a fine step");
  }
  if (matrix->probabilities) return;  // in steps, whose number exceeds that of counts
  cli::SparseTable table = matrix->table;
  std::erase_if(table.entries, [](const auto& e) { return e.value == 0.0; });
  const std::string market = cli::matrix_market_of(table, "again");
  require(same(cli::read_foreign(file_of(market, ".again.mtx"), states).table, table),
          "a matrix that was written and read is the same");
  require(same(cli::read_foreign(file_of(cli::npz_of(table), ".again.npz"), states).table, table),
          "in numpy's format too");
}

}  // namespace

void states(std::string_view bytes) {
  const auto states = accepted([&] { return cli::read_states(file_of(bytes, ".csv")); });
  if (!states) return;
  const lattice::CellFile cells =
      lattice::parse_cell_file(cli::cell_text(*states, 0.1, 0.1), "x.toml");
  for (std::size_t s = 0; s < states->size(); ++s) {
    const dynamics::Entry entry = cli::entry_of(*states, s, cells.map.section);
    const dynamics::Face& face = cells.map.section.faces[static_cast<std::size_t>(entry.face)];
    require(face.name == (*states)[s].face && face.di_x == (*states)[s].move_x &&
                face.di_y == (*states)[s].move_y,
            "a state's face makes its move");
  }
}

void matrix_market(std::string_view bytes) { read_as(bytes, ".mtx"); }
void chain_csv(std::string_view bytes) { read_as(bytes, ".csv"); }
void trajectories(std::string_view bytes) { read_as(bytes, ".dtrajs"); }

void npz(std::string_view bytes) {
  const auto arrays = accepted([&] { return cli::read_npz(file_of(bytes, ".npz")); });
  if (!arrays) return;
  // Zero bytes in names or texts, and equal names, may be refused the second time.
  const auto again =
      accepted([&] { return cli::read_npz(file_of(cli::npz_of(*arrays), ".again.npz")); });
  if (again) require(again->size() == arrays->size(), "arrays written and read are as many");
  read_as(bytes, ".npz");
}

}  // namespace gatewalk::fuzz
