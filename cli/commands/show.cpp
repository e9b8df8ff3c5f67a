#include <sstream>

#include "cli/arguments.h"
#include "cli/render/matrix.h"
#include "cli/render/report.h"
#include "cli/render/states.h"

namespace gatewalk::cli {
namespace {

using namespace dynamics;

/// Share of a row's trials that came out at each boundary of the next gate, and trapped.
std::array<double, kBoundaries + 1> outcome_shares(const Transitions& t, int row) {
  std::array<double, kBoundaries + 1> share{};
  if (t.trials[row] == 0) return share;
  for (const auto& [column, n] : t.rows[row]) {
    const int b =
        column == t.space.trapped() ? kBoundaries : static_cast<int>(t.space.boundary(column));
    share[b] += static_cast<double>(n) / static_cast<double>(t.trials[row]);
  }
  return share;
}

}  // namespace

int run_show(const std::vector<std::string>& arguments) {
  Options options(
      "show MATRIX.nc [options]",
      "Shows what a matrix file holds: size, counts, sparsity, clamped share, where it\n"
      "came from; with --rows every row, with --row I one row with all its outputs.",
      "gatewalk show matrix.nc --rows");
  options.positional("matrix", "matrix file written by gatewalk build", true);
  options.add()("rows", "a line per input state")("row", po::value<int>()->value_name("I"),
                                                  "all outputs of input state I (from 1)");
  options.without_scene("a matrix keeps its scene");
  if (!options.parse(arguments)) return kFine;
  const lattice::MatrixFile file = lattice::read_matrix(options.text("matrix"));
  const Transitions& t = file.transitions;
  const int n = t.space.size();
  if (options.has("row") && (options.get<int>("row") < 1 || options.get<int>("row") > n))
    throw UsageError("--row " + std::to_string(options.get<int>("row")) + ": must lie in [1, " +
                     std::to_string(n) + "]");

  const auto total = t.totals();
  const double cells = static_cast<double>(n) * (n + 1);

  Json json;
  json["inputs"] = n;
  json["outputs"] = n + 1;
  json["gate_runs"] = total.runs;
  json["nonzeros"] = total.nonzeros;
  json["density"] = static_cast<double>(total.nonzeros) / cells;
  json["clamped_share"] = total.clamped_share();
  json["rows_never_sampled"] = total.empty_rows;
  json["rows"] = Json::array();
  for (int row = 0; row < n; ++row) {
    const Cell cell = t.space.cell(row);
    Json outputs = Json::array();
    for (const auto& [column, count] : t.rows[row])
      outputs.push_back({{"output", column + 1}, {"count", count}});
    json["rows"].push_back({{"input", row + 1},
                            {"boundary", kBoundaryNames[static_cast<int>(cell.boundary)]},
                            {"d_m", cell.d},
                            {"vx_m_per_s", cell.vx},
                            {"vy_m_per_s", cell.vy},
                            {"trials", t.trials[row]},
                            {"clamped", t.clamped[row]},
                            {"outputs", std::move(outputs)}});
  }
  const auto stored = file.text.find("state_space");
  const Json states =
      stored == file.text.end() ? Json() : Json::parse(stored->second, nullptr, false);
  if (states.is_discarded())
    throw markov::BadFile(options.text("matrix") + ": its record of the state space is damaged");
  if (!states.is_null()) json["state_space"] = states;
  json["text"] = Json::object();
  for (const auto& [key, value] : file.text) json["text"][key] = value;

  std::ostringstream out;
  out << options.text("matrix") << "\n"
      << "  size                " << n << " inputs x " << n + 1 << " outputs (the last: trapped)\n"
      << "  gate runs           " << total.runs << "\n"
      << "  nonzeros            " << total.nonzeros << " of " << std::int64_t{n} * (n + 1) << " ("
      << percent(static_cast<double>(total.nonzeros), cells) << ")\n"
      << "  clamped crossings   " << percent(total.clamped_share(), 1.0) << "\n"
      << "  rows never sampled  " << total.empty_rows << "\n";
  for (const char* key : {"program", "commit", "command", "seed", "trials_per_row", "bins"})
    if (const auto it = file.text.find(key); it != file.text.end())
      out << "  " << padded(key, -20) << it->second << "\n";
  const auto status = file.text.find("status");
  const std::string faults = faults_recorded(
      status == file.text.end() ? Json() : Json::parse(status->second, nullptr, false));
  if (!states.is_null()) out << "  " << states_line(states);
  out << "  numerical faults    " << (faults.empty() ? "none seen" : faults) << "\n";
  if (options.has("rows")) {
    out << "\n  in  from d (m)       vx (m/s)    vy (m/s)    trials clamped |   EN    RD    LD    "
           "RT    LT  trap (%)\n";
    for (int row = 0; row < n; ++row) {
      const Cell cell = t.space.cell(row);
      const auto share = outcome_shares(t, row);
      out << padded(std::to_string(row + 1), 4) << "  "
          << kBoundaryNames[static_cast<int>(cell.boundary)] << " " << padded(text_of(cell.d), -12)
          << padded(text_of(cell.vx), -12) << padded(text_of(cell.vy), -12)
          << padded(std::to_string(t.trials[row]), 7) << padded(std::to_string(t.clamped[row]), 8)
          << " |";
      for (const double s : share) out << padded(fixed(100.0 * s, 1), 6);
      out << "\n";
    }
  }
  if (options.has("row")) {
    const int row = options.get<int>("row") - 1;
    out << "\n  outputs of input " << row + 1 << "\n";
    for (const auto& [column, count] : t.rows[row]) {
      out << padded(std::to_string(column + 1), 6) << padded(std::to_string(count), 9) << "  ";
      if (column == t.space.trapped()) {
        out << "trapped\n";
        continue;
      }
      out << text_of(t.space.cell(column)) << "\n";
    }
  }
  if (file.text.count("scene") > 0) out << "\n" << file.text.at("scene");
  options.give_out(json, out.str());
  return kFine;
}

}  // namespace gatewalk::cli
