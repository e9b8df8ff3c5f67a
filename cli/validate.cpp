#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <sstream>

#include "cli/auto.h"
#include "cli/matrix.h"
#include "cli/progress.h"
#include "cli/report.h"
#include "markov/sweep.h"
#include "cli/starts.h"

namespace gatewalk::cli {
namespace {

using gatewalk::cli::to_json;

struct MeanAndSd {
  double sum = 0.0, squares = 0.0;
  std::int64_t n = 0;
  void add(double x) {
    if (!std::isfinite(x)) return;
    sum += x;
    squares += x * x;
    ++n;
  }
  [[nodiscard]] double mean() const { return n > 0 ? sum / static_cast<double>(n) : std::nan(""); }
  [[nodiscard]] double sd() const {
    if (n < 2) return std::nan("");
    const double m = mean();
    return std::sqrt(std::max(0.0, (squares - static_cast<double>(n) * m * m) / static_cast<double>(n - 1)));
  }
};

/// What the paper did: 100 trials of each, over and over, from the trials at hand in blocks of 100.
struct PaperSized {
  MeanAndSd exact_corrcoef, exact_rmse, walks_corrcoef, walks_rmse;
  double exact_products = 0.0;  // sum of corrcoef * rmse over the blocks

  /// Correlation, over the blocks, of the exact chain's corrcoef with its RMSE.
  [[nodiscard]] double exact_correlation() const {
    const auto n = static_cast<double>(exact_corrcoef.n);
    return (exact_products - n * exact_corrcoef.mean() * exact_rmse.mean()) /
           ((n - 1) * exact_corrcoef.sd() * exact_rmse.sd());
  }
};

PaperSized in_blocks_of_100(const std::vector<std::int32_t>& dynamics,
                            const std::vector<std::int32_t>& walks,
                            const markov::CellProbabilities& exact) {
  constexpr std::size_t kBlock = 100;
  const auto block = [&](const std::vector<std::int32_t>& cells, std::size_t k) {
    markov::CellProbabilities p = markov::CellProbabilities::Zero(exact.rows(), exact.cols());
    for (std::size_t i = k * kBlock; i < (k + 1) * kBlock; ++i) p.data()[cells[i]] += 1.0 / kBlock;
    return p;
  };
  PaperSized r;
  for (std::size_t k = 0; (k + 1) * kBlock <= dynamics.size(); ++k) {
    const auto seen = block(dynamics, k);
    const double corr = lattice::corrcoef(seen, exact), rmse = lattice::rmse_per_100(seen, exact);
    r.exact_corrcoef.add(corr);
    r.exact_rmse.add(rmse);
    r.exact_products += corr * rmse;
    if ((k + 1) * kBlock > walks.size()) continue;
    const auto walked = block(walks, k);
    r.walks_corrcoef.add(lattice::corrcoef(seen, walked));
    r.walks_rmse.add(lattice::rmse_per_100(seen, walked));
  }
  return r;
}

Json to_json(const MeanAndSd& m) { return {{"mean", m.mean()}, {"sd", m.sd()}}; }

/// Everything about one start.
struct StartReport {
  PaperStart start;
  lattice::ChainStart chain_start;
  lattice::FieldTally dynamics;
  markov::WalkTally walks;
  markov::FinalDistribution exact;
  lattice::Comparison walks_against, exact_against;
  PaperSized paper_sized;
  lattice::NoiseFloor floor_100_exact, floor_100_walks;
  MeanAndSd matrix_noise;  // total variation of predictions from resampled matrices to the exact one
  double dynamics_seconds = 0.0, walks_seconds = 0.0, exact_seconds = 0.0;
};

StartReport run_start(const Options& options, const Scene& scene, const dynamics::StateSpace& space,
                      const markov::Sweeper& sweeper, const markov::Walker& walker,
                      const std::deque<markov::Sweeper>& resampled,
                      const PaperStart& start, std::int64_t trials, std::int64_t walks) {
  const dynamics::BodyState body = start.body();
  const markov::Field field{scene.field.columns, scene.field.rows};
  const int max_gates = scene.field.max_gates;
  StartReport r{start, lattice::chain_start(space, scene.field, body), lattice::FieldTally(scene.field),
                {}, {}, {}, {}, {}, {}, {}, {}};

  const Stopwatch exact_watch;
  r.exact = sweeper.predict(field, r.chain_start.start, max_gates);
  r.exact_seconds = exact_watch.seconds();

  std::vector<std::int32_t> walk_cells;
  r.walks.final_cells = markov::CellCounts::Zero(field.rows, field.columns);
  const Stopwatch walks_watch;
  run_in_batches("walks", walks, options.talk(), [&](std::int64_t first, std::int64_t n) {
    std::vector<std::int32_t> cells;
    r.walks += walker.walk(field, r.chain_start.start, max_gates, options.seed(), {first, n}, &cells);
    walk_cells.insert(walk_cells.end(), cells.begin(), cells.end());
  });
  r.walks_seconds = walks_watch.seconds();

  const Stopwatch dynamics_watch;
  run_in_batches("full dynamics", trials, options.talk(), [&](std::int64_t first, std::int64_t n) {
    r.dynamics += lattice::run_field(scene.gate, scene.field, body, space, options.seed(), {first, n});
  });
  r.dynamics_seconds = dynamics_watch.seconds();

  // As many null draws as fit a fixed amount of work, 999 to 9999: each deals out the trials and
  // multiplies with a matrix of gates x gates.
  const std::int64_t gates =
      std::min<std::int64_t>(r.exact.final_cells.size(), lattice::kMostEnergyGates);
  const std::int64_t null_draws =
      options.has("null-draws")
          ? options.count("null-draws")
          : std::clamp<std::int64_t>(100'000'000 / (trials + walks + gates * gates / 8), 999, 9999);
  r.walks_against = lattice::compare(r.dynamics.final_gates, r.walks.final_cells, null_draws, options.seed());
  r.exact_against = lattice::compare(r.dynamics.final_gates, r.exact.final_cells, null_draws, options.seed());
  r.paper_sized = in_blocks_of_100(r.dynamics.final_gate_of_trial, walk_cells, r.exact.final_cells);
  for (const markov::Sweeper& other : resampled)
    r.matrix_noise.add(lattice::total_variation(
        r.exact.final_cells,
        other.predict(field, r.chain_start.start, max_gates).final_cells));
  const double s = lattice::concentration(r.dynamics.final_gates);
  r.floor_100_exact = lattice::noise_floor(s, r.exact.final_cells.size(), 100, 0);
  r.floor_100_walks = lattice::noise_floor(s, r.exact.final_cells.size(), 100, 100);
  return r;
}

/// Body, beams, drag and field of the paper's Table IV, whatever the forces (it does not print
/// them): only then do its numbers belong beside these.
bool like_the_papers(const Scene& scene) {
  const dynamics::GateParams paper;
  for (const dynamics::ParamInfo& info : dynamics::gate_param_table()) {
    const bool free = info.key == "forces.propulsion_N" || info.key == "forces.random_N" ||
                      info.key.substr(0, 4) == "run.";
    if (!free && info.get(scene.gate) != info.get(paper)) return false;
  }
  const lattice::FieldParams field;
  return scene.gate.run.time_limit == paper.run.time_limit &&
         scene.gate.run.traverse_y == paper.run.traverse_y && scene.field.columns == field.columns &&
         scene.field.rows == field.rows && scene.field.max_gates == field.max_gates;
}

/// What the difference comes from, as far as it can be told.
std::string verdict(const StartReport& r) {
  const lattice::Comparison& c = r.exact_against;
  const double sampling = r.matrix_noise.mean() + 2.0 * r.matrix_noise.sd();
  const std::string off = "the chain is off by a total variation of " + fixed(c.total_variation, 3);
  if (c.total_variation <= c.floor_total_variation_95)
    return off + ", no more than chance in these trials makes";
  // Independent: their squares add up.
  if (c.total_variation <= std::hypot(c.floor_total_variation_95, sampling))
    return off + ", no more than chance in these trials and in the matrix can make";
  return off + ", more than chance in trials (" + fixed(c.floor_total_variation, 3) +
         ") and matrix (" + fixed(r.matrix_noise.mean(), 3) + ") makes: its own error";
}

Json to_json(const StartReport& r) {
  Json j;
  j["verdict"] = verdict(r);
  j["start"] = {{"d_m", r.start.d}, {"vx_m_per_s", r.start.vx}, {"vy_m_per_s", r.start.vy},
                {"clamped", r.chain_start.clamped}};
  if (r.start.corrcoef) j["paper"] = {{"corrcoef", *r.start.corrcoef}, {"rmse_per_100", *r.start.rmse}};
  j["exact"] = to_json(r.exact_against);
  j["exact"]["total_variation_of_matrix_sampling"] = to_json(r.matrix_noise);
  j["walks"] = to_json(r.walks_against);
  const PaperSized& p = r.paper_sized;
  j["at_100_trials"] = {
      {"repeats", p.exact_rmse.n},
      {"exact_corrcoef", to_json(p.exact_corrcoef)},
      {"exact_corrcoef_floor", r.floor_100_exact.corrcoef},
      {"exact_rmse_per_100", to_json(p.exact_rmse)},
      {"exact_rmse_per_100_floor", r.floor_100_exact.rmse_per_100},
      {"exact_corrcoef_rmse_correlation", p.exact_correlation()},
      {"walks_corrcoef", to_json(p.walks_corrcoef)},
      {"walks_corrcoef_floor", r.floor_100_walks.corrcoef},
      {"walks_rmse_per_100", to_json(p.walks_rmse)},
      {"walks_rmse_per_100_floor", r.floor_100_walks.rmse_per_100}};
  j["seconds"] = {{"dynamics", r.dynamics_seconds}, {"walks", r.walks_seconds}, {"exact", r.exact_seconds}};
  const double per_trial = r.dynamics_seconds / static_cast<double>(r.dynamics.trials);
  const double per_walk = r.walks_seconds / static_cast<double>(r.walks.walks);
  j["speed_ratio"] = {{"dynamics_trial_over_walk", per_trial / per_walk},
                      {"dynamics_over_exact", r.dynamics_seconds / r.exact_seconds}};
  const auto fates = [](double trapped, double left, double cut) {
    return Json{{"trapped", trapped}, {"left_field", left}, {"cut_off", cut}};
  };
  const auto n = static_cast<double>(r.dynamics.trials);
  j["fates"] = {{"dynamics", fates(static_cast<double>(r.dynamics.trapped) / n,
                                   static_cast<double>(r.dynamics.left_field) / n,
                                   static_cast<double>(r.dynamics.cut_off) / n)},
                {"exact", fates(r.exact.trapped, r.exact.left_field, r.exact.cut_off)}};
  j["final_gates"] = {{"dynamics", grid(r.dynamics.final_gates)},
                      {"walks", grid(r.walks.final_cells)},
                      {"exact", grid(r.exact.final_cells)}};
  j["never_sampled"] = r.exact.unsampled;
  return j;
}

std::string with_sd(const MeanAndSd& m) { return fixed(m.mean(), 3) + " (" + fixed(m.sd(), 3) + ")"; }

std::string table_of(const std::vector<StartReport>& reports, bool papers, std::int64_t trials,
                     std::int64_t walks, std::size_t threads) {
  std::ostringstream out;
  out << "As in the paper's Table IV: 100 trials of the full dynamics against the chain, mean (sd) over\n"
         "repeats. Floor: what chance alone gives if the chain were perfect.\n\n"
         "                |            corrcoef                      |        RMSE, trials per 100\n"
         "   d   vx   vy  | paper  exact chain    floor  100 walks   | paper  exact chain    floor  100 walks\n";
  for (const StartReport& r : reports) {
    const PaperSized& p = r.paper_sized;
    const auto printed = [&](const std::optional<double>& x) {
      return padded(papers && x ? fixed(*x, 3) : "-", 6);
    };
    out << start_text(r.start) << "  |" << printed(r.start.corrcoef) << "  "
        << padded(with_sd(p.exact_corrcoef), -15) << padded(fixed(r.floor_100_exact.corrcoef, 3), 5)
        << "  " << padded(with_sd(p.walks_corrcoef), -15) << "|" << printed(r.start.rmse) << "  "
        << padded(with_sd(p.exact_rmse), -15) << padded(fixed(r.floor_100_exact.rmse_per_100, 3), 5)
        << "  " << with_sd(p.walks_rmse) << "\n";
  }
  out << "\nAll " << trials << " trials of the full dynamics per start. Floor: chance in these trials (and walks)\n"
         "alone; matrix: total variation (TV) that the sampling of the matrix alone makes; p: how often\n"
         "chance in the trials would look as different (total variation / energy distance).\n\n"
         "   d   vx   vy  | against         corrcoef  floor    RMSE   floor      TV   floor  matrix     p TV  p energy\n";
  for (const StartReport& r : reports) {
    const auto line = [&](const std::string& name, const lattice::Comparison& c) {
      out << start_text(r.start) << "  | " << padded(name, -15) << padded(fixed(c.corrcoef, 4), 9)
          << padded(fixed(c.floor.corrcoef, 4), 8) << padded(fixed(c.rmse_per_100, 3), 8)
          << padded(fixed(c.floor.rmse_per_100, 3), 8) << padded(fixed(c.total_variation, 3), 8)
          << padded(fixed(c.floor_total_variation, 3), 8)
          << padded(fixed(r.matrix_noise.mean(), 3), 8) << padded(p_text(c.p_total_variation), 9)
          << padded(p_text(c.p_energy), 10) << "\n";
    };
    line("exact chain", r.exact_against);
    line(std::to_string(walks) + " walks", r.walks_against);
  }
  out << "\n";
  for (const StartReport& r : reports) out << start_text(r.start) << "  | " << verdict(r) << "\n";
  out << "\nSeconds: " << trials << " trials and " << walks << " walks on " << threads
      << (threads == 1 ? " thread" : " threads") << ", one exact prediction on one.\n"
      << "\n   d   vx   vy  |           dynamics      walks      exact | dynamics/exact  trial/walk\n";
  for (const StartReport& r : reports) {
    const double per_trial = r.dynamics_seconds / static_cast<double>(r.dynamics.trials);
    const double per_walk = r.walks_seconds / static_cast<double>(r.walks.walks);
    out << start_text(r.start) << "  |" << padded(fixed(r.dynamics_seconds, 2), 19)
        << padded(fixed(r.walks_seconds, 4), 11) << padded(fixed(r.exact_seconds, 6), 11) << " |"
        << padded(fixed(r.dynamics_seconds / r.exact_seconds, 0), 15)
        << padded(fixed(per_trial / per_walk, 0), 12) << "\n";
  }
  return out.str();
}

/// Shares over all crossings between gates of the dynamics.
struct EntryShares {
  std::int64_t entries = 0, traverse_sides = 0, clamped = 0;
};

}  // namespace

int run_validate(const std::vector<std::string>& arguments) {
  Options options("validate SCENE [options]",
                  "Compares the chain with the full dynamics: for the scene's start (in the paper's field\n"
                  "the four of Table IV), or those given, corrcoef, RMSE and total variation of walks and of the\n"
                  "exact chain, each beside its noise floor and p-values, and the time each takes.",
                  "gatewalk validate scenes/field.toml --trials 10000 --json validation.json");
  options.positional("scene", "scene file (TOML)", true);
  add_trials_and_seed(options, "trials of the full dynamics per start");
  add_strict(options);
  options.input_file("matrix", "matrix to validate; without it one is built from the scene");
  options.add()
      ("matrix-trials", po::value<Count>()->value_name("N"),
       "runs per input state of the matrix that is built (default: 100)")
      ("walks", po::value<Count>()->value_name("N"), "walks per start (default: as many as trials)")
      ("null-draws", po::value<Count>()->value_name("N"),
       "draws behind each p-value (default: 999 to 9999, by the size of the work)");
  add_starts(options);
  add_bins(options);
  if (!options.parse(arguments)) return kFine;
  const std::int64_t trials = options.count("trials");
  const std::int64_t walks = options.has("walks") ? options.count("walks") : trials;
  std::vector<PaperStart> starts = given_starts(options);

  if (options.has("matrix")) {
    if (options.has("bins"))
      throw UsageError("--bins has no meaning beside --matrix: that one has its bins already");
    if (options.has("matrix-trials"))
      throw UsageError("--matrix-trials has no meaning beside --matrix: that one is built already");
  }
  const Stopwatch matrix_watch;
  Json settled, states;
  MatrixAndScene m = [&] {
    if (options.has("matrix"))
      return read_matrix_and_scene(options.text("matrix"), options.text("scene"), options.overrides());
    Scene scene = read_scene(options.text("scene"), options.overrides());
    const BinsChoice choice = bins_choice(options, scene);
    starts = starts_of(options, scene);
    require_inside(starts, scene);
    const auto bodies = entries_at(starts);
    if (choice.kind != BinsChoice::Kind::automatic)
      require_inside_bins(starts, scene, fixed_space(scene));
    const std::int64_t matrix_trials = options.has("matrix-trials") ? options.count("matrix-trials") : 100;
    settled = settle_method(options, scene, RunsFrom::everywhere);
    const States made = states_of(options, scene, choice, bodies);
    states = gatewalk::cli::to_json(made);
    warn_if_poor(made);
    auto built = build_matrix(scene, made, matrix_trials, options.seed(), options.talk());
    Json status = gatewalk::cli::to_json(built.health);
    return MatrixAndScene{{std::move(built), {}}, scene, std::move(status)};
  }();
  const double matrix_seconds = matrix_watch.seconds();
  if (const auto chosen = m.file.text.find("method"); chosen != m.file.text.end()) {
    settled = Json::parse(chosen->second, nullptr, false);
    if (settled.is_discarded())
      throw markov::BadFile(options.text("matrix") + ": its record of the chosen method is damaged");
  }
  const Scene& scene = m.scene;
  const dynamics::Transitions& t = m.file.transitions;
  if (options.has("matrix")) {
    starts = starts_of(options, scene);
    require_inside(starts, scene);
    (void)entries_at(starts);
    if (const auto stored = m.file.text.find("state_space"); stored != m.file.text.end()) {
      states = Json::parse(stored->second, nullptr, false);
      if (states.is_discarded())
        throw markov::BadFile(options.text("matrix") + ": its record of the state space is damaged");
    }
    require_inside_bins(starts, scene, t.space);
  }
  const markov::Chain chain = lattice::make_chain(t);
  const markov::Sweeper sweeper(chain);
  const markov::Walker walker(chain);
  constexpr std::uint64_t kReplicates = 50;
  std::deque<markov::Sweeper> resampled;
  for (std::uint64_t k = 0; k < kReplicates; ++k)
    resampled.emplace_back(lattice::make_chain(lattice::resampled(t, options.seed(), k)));

  std::vector<StartReport> reports;
  EntryShares shares;
  dynamics::Health health = t.health;
  for (const PaperStart& start : starts) {
    reports.push_back(run_start(options, scene, t.space, sweeper, walker, resampled, start, trials, walks));
    const lattice::FieldTally& d = reports.back().dynamics;
    health += d.health;
    for (int b = 0; b < dynamics::kBoundaries; ++b) {
      shares.entries += d.entries[b];
      shares.clamped += d.clamped[b];
    }
    shares.traverse_sides += d.entries[static_cast<int>(dynamics::Boundary::right_traverse)] +
                             d.entries[static_cast<int>(dynamics::Boundary::left_traverse)];
  }

  const auto total = t.totals();
  const auto share = [](std::int64_t part, std::int64_t whole) {
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
  };
  const std::size_t threads =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  Json json;
  json["trials"] = trials;
  json["walks"] = walks;
  json["starts"] = Json::array();
  for (const StartReport& r : reports) json["starts"].push_back(to_json(r));
  json["crossings"] = {{"between_gates", shares.entries},
                       {"RT_and_LT_share", share(shares.traverse_sides, shares.entries)},
                       {"clamped_share", share(shares.clamped, shares.entries)}};
  json["matrix"] = {{"gate_runs", total.runs},
                    {"clamped_share", total.clamped_share()},
                    {"rows_never_sampled", chain.unsampled_rows()},
                    {"status", m.status},
                    {"seconds", matrix_seconds}};
  if (!states.is_null()) json["state_space"] = states;
  json["threads"] = threads;
  json["status"] = to_json(health);
  if (!settled.is_null()) json["method"] = settled;
  json["made_by"] = manifest(options, scene);

  const std::string matrix_time = options.has("matrix") ? "read from " + options.text("matrix")
                                                        : fixed(matrix_seconds, 2) + " s";
  const bool papers = like_the_papers(scene);
  std::string table = table_of(reports, papers, trials, walks, threads);
  table += "\nMatrix: " + std::to_string(total.runs) + " gate runs, " + matrix_time +
           ". Crossings between gates in the dynamics: " +
           percent(static_cast<double>(shares.traverse_sides), static_cast<double>(shares.entries)) +
           " through RT or LT" + (papers ? " (paper: fewer than 4 %), " : ", ") +
           percent(static_cast<double>(shares.clamped), static_cast<double>(shares.entries)) +
           " outside the bins.\n" + states_line(states);
  if (shares.entries == 0) table += "No trial ever reached a second gate.\n";
  options.give_out(json, table);
  if (!health.clean()) warn(complaint(health));
  return exit_status(options, health.clean());
}

}  // namespace gatewalk::cli
