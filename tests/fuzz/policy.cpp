// SPDX-License-Identifier: MIT
// What a body does in each gate, or each cell of a program: a file of gatewalk plan.
#include "cli/exchange/policy_file.h"

#include "tests/fuzz/fuzz.h"

namespace gatewalk::fuzz {
namespace {

void policy_for(const cli::PolicyField& made_for, std::string_view bytes) {
  const auto read = accepted([&] { return cli::read_policy(file_of(bytes, ".json"), made_for); });
  if (!read) return;
  for (int state = 0; state < read->space.size(); ++state) {
    const int action = read->action({1, 1, 1}, read->space.range(state).middle());
    require(action == 0 || action == 1, "a decision is one of the actions");
  }
  const std::string text = cli::policy_text(*read, made_for);
  const auto again =
      accepted([&] { return cli::read_policy(file_of(text, ".again.json"), made_for); });
  require(again && again->space == read->space && again->always == read->always &&
              again->decisions.action == read->decisions.action,
          "a policy that was written and read is the same");
}

}  // namespace

void policy(std::string_view bytes) {
  static const cli::PolicyField
      of_gates = cli::policy_field(lattice::parse_scene(
          "field = { columns = 3, rows = 2, max_gates = 2 }\nrun.method = \"moreau\"\n"
          "[actions.a]\n[actions.b]\nforces.propulsion_N = 9.0\n",
          "x.toml")),
      of_cells = cli::policy_field(
          lattice::parse_cell_file("[cell]\nwidth_m = 1\nlength_m = 1\n[[cell.faces]]\n"
                                   "name = \"S\"\nmove = [0, 1]\nusual.s = [-0.5, 0.5]\n"
                                   "[[cell.coordinates]]\nname = \"s\"\nunit = \"m\"\n"
                                   "[field]\ncolumns = 3\nrows = 2\nmax_gates = 2\n"
                                   "[actions.a]\n[actions.b]\nparameters.p = 9\n",
                                   "x.toml"),
          "# a: cell program: S; s; time_s; p = 1\n# b: cell program: S; s; time_s; p = 9\n");
  policy_for(of_gates, bytes);
  policy_for(of_cells, bytes);
}

}  // namespace gatewalk::fuzz
