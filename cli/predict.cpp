#include <charconv>
#include <map>
#include <sstream>

#include "cli/matrix.h"
#include "cli/report.h"
#include "cli/starts.h"
#include "markov/sweep.h"

namespace gatewalk::cli {
namespace {

using markov::FinalDistribution;

/// --row 4-6=other.nc: rows whose gates are those of another matrix.
struct OtherRows {
  int first = 0, last = 0;
  std::string path;
};

OtherRows parse_rows(const std::string& text) {
  const auto wrong = [&] {
    return UsageError("--row " + text + ": must be rows i_y and a matrix, e.g. 4-6=other.nc or 4=other.nc");
  };
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals + 1 == text.size()) throw wrong();
  const char *at = text.data(), *const end = text.data() + equals;
  OtherRows rows{0, 0, text.substr(equals + 1)};
  const auto number = [&](int& value) {
    const auto read = std::from_chars(at, end, value);
    if (read.ec != std::errc() || value < 0) throw wrong();
    at = read.ptr;
  };
  number(rows.first);
  rows.last = rows.first;
  if (at != end) {
    if (*at++ != '-') throw wrong();
    number(rows.last);
  }
  if (at != end) throw wrong();
  return rows;
}

std::vector<OtherRows> rows_of(const Options& options) {
  std::vector<OtherRows> all;
  if (!options.has("row")) return all;
  for (const auto& text : options.get<std::vector<std::string>>("row")) all.push_back(parse_rows(text));
  return all;
}

/// The chain of each row. Throws UsageError when rows lie outside the field or are given twice, or have
/// another body, gates of another size or other bins than the base.
markov::RowChains chains_of(const Options& options, const MatrixAndScene& base,
                            const std::vector<OtherRows>& others, Json& told) {
  const auto name = [](const OtherRows& o) {
    return "--row " + std::to_string(o.first) +
           (o.last == o.first ? "" : "-" + std::to_string(o.last)) + "=" + o.path;
  };
  const int rows = base.scene.field.rows;
  std::vector<int> chain_of_row(static_cast<std::size_t>(rows), 0);
  std::vector<markov::Chain> chains{lattice::make_chain(base.file.transitions)};
  std::map<std::string, int> known;  // matrix files
  for (const OtherRows& o : others) {
    if (o.first > o.last) throw UsageError(name(o) + ": the lower row comes first");
    if (o.last >= rows)
      throw UsageError(name(o) + ": the rows of this field are 0 to " + std::to_string(rows - 1));
    for (int row = o.first; row <= o.last; ++row)
      if (chain_of_row[static_cast<std::size_t>(row)] != 0)
        throw UsageError(name(o) + ": row " + std::to_string(row) + " is given twice");
    const MatrixAndScene m = read_matrix_and_scene(o.path, "", {});
    const dynamics::GateParams &a = m.scene.gate, &b = base.scene.gate;
    if (a.body.mass != b.body.mass || a.body.radius != b.body.radius)
      throw UsageError(name(o) + ": it was built with another body than " + options.text("matrix"));
    if (a.beams.joint_x != b.beams.joint_x || a.run.traverse_y != b.run.traverse_y)
      throw UsageError(name(o) + ": its gates are " + fixed(2.0 * a.beams.joint_x, 3) + " m wide and " +
                       fixed(a.run.traverse_y, 3) + " m long, those of " + options.text("matrix") + " " +
                       fixed(2.0 * b.beams.joint_x, 3) + " and " + fixed(b.run.traverse_y, 3) +
                       " m: they make no field");
    if (m.file.transitions.space != base.file.transitions.space)
      throw UsageError(name(o) + ": its states are not those of " + options.text("matrix") +
                       " (other bins): what leaves one row could not enter the next");
    const auto [place, is_new] = known.emplace(o.path, static_cast<int>(chains.size()));
    if (is_new) chains.push_back(lattice::make_chain(m.file.transitions));
    std::fill(chain_of_row.begin() + o.first, chain_of_row.begin() + o.last + 1, place->second);
    told.push_back({{"first", o.first}, {"last", o.last}, {"matrix", o.path},
                    {"matrix_status", m.status}, {"scene", to_toml(m.scene)}});
  }
  return {std::move(chains), std::move(chain_of_row)};
}

std::vector<FinalDistribution> solve(const markov::RowChains& rows, const std::string& solver,
                                     const markov::Field& field,
                                     const std::vector<markov::Start>& starts, int max_gates) {
  if (solver == "klu") {
    std::vector<FinalDistribution> all;
    for (const markov::Start& s : starts) all.push_back(markov::solve_absorption(rows, field, s));
    return all;
  }
  const markov::Sweeper sweeper(rows);
  return solver == "march"       ? sweeper.march_all(field, starts)
         : solver == "propagate" ? sweeper.propagate_all(field, starts, max_gates)
                                 : sweeper.predict_all(field, starts, max_gates);
}

/// What is predicted for one start.
void add_to(Json& json, const FinalDistribution& f) {
  json["final_gates"] = grid(f.final_cells);
  json["trapped"] = f.trapped;
  json["left_field"] = f.left_field;
  json["cut_off"] = f.cut_off;
  json["never_sampled"] = f.unsampled;
  json["still_walking"] = f.remainder;
  json["rounding_at_most"] = f.rounding;
  json["error_at_most"] = f.remainder + f.rounding;
  json["steps"] = f.steps;
}

Json start_state(const ReadyStart& s) {
  return {{"input", s.start.start.input + 1}, {"bin", s.text}, {"clamped", s.start.clamped}};
}

std::string title_of(const PaperStart& s) {
  std::ostringstream title;
  title << "start d " << s.d << " m, vx " << s.vx << " m/s, vy " << s.vy << " m/s";
  return title.str();
}

std::string table_of(const FinalDistribution& f, const ReadyStart& start) {
  std::string table = map_of(f.final_cells) + "trapped " + percent(f.trapped, 1.0, 2) +
                      ", left the field " + percent(f.left_field, 1.0, 2) + ", cut off " +
                      percent(f.cut_off, 1.0, 2) + "\nstart: " + start.text + "\n";
  if (f.unsampled > 0.0)
    table += "reaches a row that was never sampled: " + percent(f.unsampled, 1.0, 4) + "\n";
  if (f.remainder > 1e-8)
    table += "still walking when the sum was stopped: " + percent(f.remainder, 1.0, 6) + "\n";
  std::ostringstream bound;
  bound.precision(2);
  bound << "numerical error of all shares together: at most " << f.remainder + f.rounding << " (" << f.remainder
        << " still walking, rounding " << f.rounding << ")\n";
  return table + bound.str();
}

}  // namespace

int run_predict(const std::vector<std::string>& arguments) {
  Options options("predict MATRIX.nc [SCENE] [options]",
                  "The exact distribution of the final gate: what infinitely many walks with this matrix\n"
                  "would give, with a bound on its numerical error. How far the matrix itself can be\n"
                  "trusted, gatewalk validate says.",
                  "gatewalk predict matrix.nc scenes/field.toml --start 0,0,15 --start 4,5,10 --json "
                  "prediction.json");
  options.positional("matrix", "matrix file written by gatewalk build", true);
  options.positional("scene", "scene file; without it the matrix's own scene", false);
  add_starts(options, "the scene's start");
  options.add()("row", po::value<std::vector<std::string>>()->composing()->value_name("A-B=FILE"),
                "gates of rows i_y = A to B as in another matrix of the same bins (may be repeated)");
  options.add()("solver", po::value<std::string>()->default_value("auto")->value_name("NAME"),
                "propagate: step by step; for field.max_gates = 0 also march: row by row, and klu: one "
                "sparse solve; auto: march without limit, else propagate");
  add_strict(options);
  options.reads("row", [](const std::string& rows) { return rows.substr(rows.find('=') + 1); });
  if (!options.parse(arguments)) return kFine;
  const std::string& solver = options.get<std::string>("solver");
  if (solver != "auto" && solver != "propagate" && solver != "march" && solver != "klu")
    throw UsageError("--solver " + solver + ": must be auto, propagate, march or klu");
  const std::vector<PaperStart> given = given_starts(options);
  const std::vector<OtherRows> others = rows_of(options);
  const auto m = read_matrix_and_scene(options.text("matrix"), options.text("scene"), options.overrides());
  require_inside(given, m.scene);
  Json other_rows;
  const markov::RowChains rows = chains_of(options, m, others, other_rows);
  std::vector<ReadyStart> starts;
  for (const PaperStart& s : given)
    starts.push_back(ready_start(options, m, s.body(), title_of(s)));
  if (given.empty()) starts.push_back(ready_start(options, m, m.scene.start, "the start"));
  std::vector<markov::Start> places;
  for (const ReadyStart& s : starts) places.push_back(s.start.start);
  const markov::Field field{m.scene.field.columns, m.scene.field.rows};
  const int max_gates = m.scene.field.max_gates;
  if ((solver == "klu" || solver == "march") && max_gates != 0)
    throw UsageError("--solver " + solver + " needs field.max_gates = 0 (no limit), it is " +
                     std::to_string(max_gates));

  const Stopwatch watch;
  const std::vector<FinalDistribution> found = solve(rows, solver, field, places, max_gates);
  const double seconds = watch.seconds();

  Json json;
  std::string table;
  if (given.empty()) {
    add_to(json, found.front());
    table = table_of(found.front(), starts.front());
  }
  for (std::size_t k = 0; k < given.size(); ++k) {
    Json one;
    one["start"] = {{"d_m", given[k].d}, {"vx_m_per_s", given[k].vx}, {"vy_m_per_s", given[k].vy}};
    add_to(one, found[k]);
    one["start_state"] = start_state(starts[k]);
    json["starts"].push_back(std::move(one));
    table += (k > 0 ? "\n" : "") + title_of(given[k]) + "\n" + table_of(found[k], starts[k]);
  }
  for (const OtherRows& o : others)
    table += "rows " + std::to_string(o.first) + " to " + std::to_string(o.last) + ": gates of " + o.path + "\n";
  json["solver"] = solver;
  if (given.empty()) json["start_state"] = start_state(starts.front());
  json["matrix_status"] = m.status;
  if (!other_rows.is_null()) json["rows"] = other_rows;
  json["made_by"] = manifest(options, m.scene);
  options.give_out(json, table);
  remark(options, fixed(1e3 * seconds, 3) + " ms");
  return exit_status(options, faults_recorded(m.status).empty());
}

}  // namespace gatewalk::cli
