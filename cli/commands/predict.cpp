#include <charconv>
#include <cmath>
#include <deque>
#include <map>
#include <sstream>

#include "cli/arguments.h"
#include "cli/render/matrix.h"
#include "cli/render/report.h"
#include "cli/render/start.h"
#include "cli/render/states.h"
#include "cli/terminal/progress.h"
#include "markov/predict.h"

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
    return UsageError("--row " + text +
                      ": must be rows i_y and a matrix, e.g. 4-6=other.nc or 4=other.nc");
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
  for (const auto& text : options.get<std::vector<std::string>>("row"))
    all.push_back(parse_rows(text));
  return all;
}

/// What the rows of the field draw from.
struct FieldRows {
  std::deque<dynamics::Transitions> other_matrices;
  lattice::FieldMatrices matrices;
  markov::FieldChain chains;
};

/// Matrix and chain of each row. Throws UsageError when rows lie outside the field or are given
/// twice, or have another body, gates of another size or other bins than the base.
FieldRows rows_of_field(const Options& options, const MatrixAndScene& base,
                        const std::vector<OtherRows>& others, Json& told) {
  const auto name = [](const OtherRows& o) {
    return "--row " + std::to_string(o.first) +
           (o.last == o.first ? "" : "-" + std::to_string(o.last)) + "=" + o.path;
  };
  const int rows = base.scene.field.rows;
  std::vector<int> chain_of_row(static_cast<std::size_t>(rows), 0);
  std::deque<dynamics::Transitions> matrices;
  std::vector<markov::Chain> chains{lattice::make_chain(base.file.transitions)};
  std::map<std::string, int> known;  // matrix files
  for (const OtherRows& o : others) {
    if (o.first > o.last) throw UsageError(name(o) + ": the lower row comes first");
    if (o.last >= rows)
      throw UsageError(name(o) + ": the rows of this field are 0 to " + std::to_string(rows - 1));
    for (int row = o.first; row <= o.last; ++row)
      if (chain_of_row[static_cast<std::size_t>(row)] != 0)
        throw UsageError(name(o) + ": row " + std::to_string(row) + " is given twice");
    MatrixAndScene m = read_matrix_and_scene(o.path, "", {});
    const dynamics::GateParams &a = m.scene.gate, &b = base.scene.gate;
    if (a.body.mass != b.body.mass || a.body.radius != b.body.radius)
      throw UsageError(name(o) + ": it was built with another body than " + options.text("matrix"));
    if (a.beams.joint_x != b.beams.joint_x || a.run.traverse_y != b.run.traverse_y)
      throw UsageError(name(o) + ": its gates are " + fixed(2.0 * a.beams.joint_x, 3) +
                       " m wide and " + fixed(a.run.traverse_y, 3) + " m long, those of " +
                       options.text("matrix") + " " + fixed(2.0 * b.beams.joint_x, 3) + " and " +
                       fixed(b.run.traverse_y, 3) + " m: they make no field");
    if (m.file.transitions.space != base.file.transitions.space)
      throw UsageError(name(o) + ": its states are not those of " + options.text("matrix") +
                       " (other bins): what leaves one row could not enter the next");
    const auto [place, is_new] = known.emplace(o.path, static_cast<int>(chains.size()));
    if (is_new) {
      chains.push_back(lattice::make_chain(m.file.transitions));
      matrices.push_back(std::move(m.file.transitions));
    }
    std::fill(chain_of_row.begin() + o.first, chain_of_row.begin() + o.last + 1, place->second);
    told.push_back({{"first", o.first},
                    {"last", o.last},
                    {"matrix", o.path},
                    {"matrix_status", m.status},
                    {"scene", lattice::to_toml(m.scene)}});
  }
  lattice::FieldMatrices all{{&base.file.transitions}, chain_of_row};
  for (const dynamics::Transitions& t : matrices)
    all.matrices.push_back(&t);  // a deque's stay in place
  return {std::move(matrices), std::move(all),
          markov::FieldChain::by_row(std::move(chains), std::move(chain_of_row))};
}

/// By the names of --solver. Throws UsageError for any other.
markov::PredictOptions::Solver solver_of(const std::string& name) {
  using Solver = markov::PredictOptions::Solver;
  if (name == "auto") return Solver::automatic;
  if (name == "propagate") return Solver::steps;
  if (name == "march") return Solver::rows;
  if (name == "klu") return Solver::klu;
  throw UsageError("--solver " + name + ": must be auto, propagate, march or klu");
}

/// What the sampling of the matrices does to each start's prediction; no replicates in fields that
/// are too large for many predictions, and none at all, with a warning, if one of them cannot be
/// made.
std::deque<lattice::MatrixNoise> noise_of(const Options& options, const FieldRows& rows,
                                          const markov::Field& field,
                                          const std::vector<markov::Start>& starts, int max_gates,
                                          const std::vector<FinalDistribution>& predictions) {
  constexpr std::int64_t kMost = 200, kTogether = 8;
  const auto none = [&] {
    std::deque<lattice::MatrixNoise> noise;
    for (std::size_t k = 0; k < starts.size(); ++k) {
      const auto row = static_cast<std::size_t>(starts[k].row);
      const auto matrix = static_cast<std::size_t>(rows.matrices.matrix_of_row[row]);
      noise.emplace_back(
          predictions[k],
          rows.matrices.matrices[matrix]->trials[static_cast<std::size_t>(starts[k].input)]);
    }
    return noise;
  };
  std::deque<lattice::MatrixNoise> noise = none();
  const std::int64_t replicates = lattice::affordable_replicates(field, max_gates, kMost);
  try {
    run_in_batches("resampled matrices", (replicates + kTogether - 1) / kTogether, options.talk(),
                   [&](std::int64_t first, std::int64_t n) {
                     for (std::int64_t batch = first; batch < first + n; ++batch) {
                       const std::int64_t begin = batch * kTogether;
                       const auto found = lattice::replicate_predictions(
                           rows.matrices, field, starts, max_gates, options.seed(), begin,
                           std::min(kTogether, replicates - begin));
                       for (std::size_t k = 0; k < starts.size(); ++k)
                         for (const FinalDistribution& f : found[k]) noise[k].add(f);
                     }
                   });
  } catch (const std::runtime_error& e) {
    warn(std::string("no interval counts the sampling of the matrix: a resampled one fails: ") +
         e.what());
    return none();
  }
  return noise;
}

/// What is predicted for one start.
void add_to(Json& json, const FinalDistribution& f, const EndingShares& shares,
            const lattice::MatrixNoise& noise) {
  json["endings"] = endings(f.endings);
  json["endings_95"] = endings_95(shares);
  json["matrix_sampling"] = {{"replicates", noise.replicates()},
                             {"total_variation_mean", noise.mean_total_variation()},
                             {"total_variation_95", noise.total_variation_95()}};
  json["final_gates"] = grid(f.final_cells);
  json["trapped_gates"] = grid(markov::trapped_cells(f));
  json["departed_gates"] = grid(markov::departed_cells(f));
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

std::string title_of(const lattice::PaperStart& s) {
  std::ostringstream title;
  title << "start d " << s.d << " m, vx " << s.vx << " m/s, vy " << s.vy << " m/s";
  return title.str();
}

std::string table_of(const FinalDistribution& f, const EndingShares& shares,
                     const ReadyStart& start, const lattice::Scene& scene) {
  const bool intervals = !std::isnan(shares.interval.front().front());
  std::string table =
      endings_text(shares,
                   intervals
                       ? "of all walks, 95 % intervals for the sampling of the matrix"
                       : "of all walks; no intervals: the field is too large for many predictions, "
                         "or a resampled matrix failed") +
      limits_text(scene) + map_of(f.final_cells) + map_of_trapped(markov::trapped_cells(f)) +
      "left the field " + percent(f.left_field, 1.0, 2) + "\nstart: " + start.text + "\n";
  if (f.unsampled > 0.0)
    table += "reaches a row that was never sampled: " + percent(f.unsampled, 1.0, 4) + "\n";
  if (f.remainder > 1e-8)
    table += "still walking when the sum was stopped: " + percent(f.remainder, 1.0, 6) + "\n";
  std::ostringstream bound;
  bound.precision(2);
  bound << "The chain's own error (bins, memory, and with bins from a pilot where its rows start) "
           "is not in the intervals:\n"
        << "gatewalk validate measures it.\n"
        << "Rounding and walks not finished, which are not the error of the prediction: at most "
        << f.remainder + f.rounding << " in all shares together\n";
  return table + bound.str();
}

}  // namespace

int run_predict(const std::vector<std::string>& arguments) {
  Options options(
      "predict MATRIX.nc [SCENE] [options]",
      "The exact distribution of endings and final gate: what infinitely many walks with this\n"
      "matrix would give. The 95 % intervals count that the matrix is a sample of gate runs;\n"
      "how far the chain itself (bins, memory) is off, gatewalk validate measures.",
      "gatewalk predict matrix.nc scenes/field.toml --start 0,0,15 --start 4,5,10 --json "
      "prediction.json");
  options.positional("matrix", "matrix file written by gatewalk build", true);
  options.positional("scene", "scene file; without it the matrix's own scene", false);
  add_starts(options, "the scene's start");
  options.add()(
      "row", po::value<std::vector<std::string>>()->composing()->value_name("A-B=FILE"),
      "gates of rows i_y = A to B as in another matrix of the same bins (may be repeated)");
  options.add()(
      "solver", po::value<std::string>()->default_value("auto")->value_name("NAME"),
      "propagate: step by step; for field.max_gates = 0 also march: row by row, and klu: one "
      "sparse solve; auto: march without limit, else propagate");
  add_strict(options);
  options.reads("row", [](const std::string& rows) { return rows.substr(rows.find('=') + 1); });
  options.add()("seed", po::value<Seed>()->default_value(Seed{1}, "1")->value_name("S"),
                "seed of the resampled matrices behind the intervals");
  if (!options.parse(arguments)) return kFine;
  const std::string& solver = options.get<std::string>("solver");
  markov::PredictOptions how{.solver = solver_of(solver)};
  const std::vector<lattice::PaperStart> given = given_starts(options);
  const std::vector<OtherRows> others = rows_of(options);
  const auto m =
      read_matrix_and_scene(options.text("matrix"), options.text("scene"), options.overrides());
  lattice::require_inside(given, m.scene);
  Json other_rows;
  const FieldRows rows = rows_of_field(options, m, others, other_rows);
  std::vector<ReadyStart> starts;
  for (const lattice::PaperStart& s : given)
    starts.push_back(ready_start(options, m, s.body(), title_of(s)));
  if (given.empty()) starts.push_back(ready_start(options, m, m.scene.start, "the start"));
  std::vector<markov::Start> places;
  for (const ReadyStart& s : starts) places.push_back(s.start.start);
  const markov::Field field{m.scene.field.columns, m.scene.field.rows};
  const int max_gates = m.scene.field.max_gates;
  how.max_cells = max_gates;
  if ((solver == "klu" || solver == "march") && max_gates != 0)
    throw UsageError("--solver " + solver + " needs field.max_gates = 0 (no limit), it is " +
                     std::to_string(max_gates));

  const Stopwatch watch;
  const std::vector<FinalDistribution> found = markov::predict(rows.chains, field, places, how);
  const double seconds = watch.seconds();
  const std::deque<lattice::MatrixNoise> noise =
      noise_of(options, rows, field, places, max_gates, found);

  Json json;
  std::string table;
  const auto shares_of = [&](std::size_t k) { return EndingShares(found[k], noise[k], max_gates); };
  if (given.empty()) {
    add_to(json, found.front(), shares_of(0), noise.front());
    table = table_of(found.front(), shares_of(0), starts.front(), m.scene);
  }
  for (std::size_t k = 0; k < given.size(); ++k) {
    Json one;
    one["start"] = {{"d_m", given[k].d}, {"vx_m_per_s", given[k].vx}, {"vy_m_per_s", given[k].vy}};
    add_to(one, found[k], shares_of(k), noise[k]);
    one["start_state"] = start_state(starts[k]);
    json["starts"].push_back(std::move(one));
    table += (k > 0 ? "\n" : "") + title_of(given[k]) + "\n" +
             table_of(found[k], shares_of(k), starts[k], m.scene);
  }
  for (const OtherRows& o : others)
    table += "rows " + std::to_string(o.first) + " to " + std::to_string(o.last) + ": gates of " +
             o.path + "\n";
  json["solver"] = solver;
  if (given.empty()) json["start_state"] = start_state(starts.front());
  json["matrix_status"] = m.status;
  if (!other_rows.is_null()) json["rows"] = other_rows;
  json["made_by"] = manifest(options, m.scene);
  options.give_out(json, table);
  warn_if_too_few_gates(m.scene);
  remark(options, fixed(1e3 * seconds, 3) + " ms");
  return exit_status(options, faults_recorded(m.status).empty());
}

}  // namespace gatewalk::cli
