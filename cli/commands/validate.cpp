#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <sstream>

#include "cli/arguments.h"
#include "cli/render/choice.h"
#include "cli/render/matrix.h"
#include "cli/render/report.h"
#include "cli/render/start.h"
#include "cli/render/states.h"
#include "cli/terminal/progress.h"
#include "markov/predict.h"

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
    return std::sqrt(
        std::max(0.0, (squares - static_cast<double>(n) * m * m) / static_cast<double>(n - 1)));
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

/// Fills a PaperSized from final gates in the order of the trials, handed over in any pieces; keeps
/// no more than a block.
class BlocksOf100 {
 public:
  /// `walks_of(first, count)`: final cells of those walks.
  using Walks = std::function<std::vector<std::int32_t>(std::int64_t first, std::int64_t count)>;
  BlocksOf100(const markov::CellProbabilities& exact, std::int64_t walks, Walks walks_of)
      : exact_(exact), walks_(walks), walks_of_(std::move(walks_of)) {}

  void add(const std::vector<std::int32_t>& dynamics) {
    for (const std::int32_t cell : dynamics) {
      waiting_.push_back(cell);
      if (waiting_.size() == kBlock) finish_block();
    }
  }
  [[nodiscard]] const PaperSized& result() const { return result_; }

 private:
  static constexpr std::size_t kBlock = 100;

  [[nodiscard]] markov::CellProbabilities shares(const std::vector<std::int32_t>& cells) const {
    markov::CellProbabilities p = markov::CellProbabilities::Zero(exact_.rows(), exact_.cols());
    for (const std::int32_t cell : cells) p.data()[cell] += 1.0 / kBlock;
    return p;
  }
  void finish_block() {
    const auto seen = shares(waiting_);
    const double corr = lattice::corrcoef(seen, exact_), rmse = lattice::rmse_per_100(seen, exact_);
    result_.exact_corrcoef.add(corr);
    result_.exact_rmse.add(rmse);
    result_.exact_products += corr * rmse;
    if (done_ + static_cast<std::int64_t>(kBlock) <= walks_) {
      const auto walked = shares(walks_of_(done_, kBlock));
      result_.walks_corrcoef.add(lattice::corrcoef(seen, walked));
      result_.walks_rmse.add(lattice::rmse_per_100(seen, walked));
    }
    done_ += kBlock;
    waiting_.clear();
  }

  const markov::CellProbabilities& exact_;
  std::int64_t walks_, done_ = 0;  // done_: trials in finished blocks
  Walks walks_of_;
  std::vector<std::int32_t> waiting_;
  PaperSized result_;
};

Json to_json(const MeanAndSd& m) { return {{"mean", m.mean()}, {"sd", m.sd()}}; }

/// Everything about one start.
struct StartReport {
  lattice::PaperStart start;
  lattice::ChainStart chain_start;
  lattice::FieldTally dynamics;
  markov::WalkTally walks;
  markov::FinalDistribution exact;
  lattice::Comparison walks_against, exact_against;
  PaperSized paper_sized;
  lattice::NoiseFloor floor_100_exact, floor_100_walks;
  lattice::Judgement judgement;
  double matrix_noise_mean = 0.0,
         matrix_noise_sd = 0.0;  // total variation of resampled matrices' predictions
  std::int64_t resampled = 0;    // so many matrices
  EndingShares dynamics_endings, walks_endings, exact_endings;
  double dynamics_seconds = 0.0, walks_seconds = 0.0, exact_seconds = 0.0;
};

StartReport run_start(const Options& options, const lattice::Scene& scene,
                      const dynamics::Transitions& matrix, const markov::Predictor& predictor,
                      const markov::Walker& walker,
                      const std::vector<markov::FinalDistribution>& resampled,
                      const lattice::PaperStart& start, std::int64_t trials, std::int64_t walks) {
  const dynamics::BodyState body = start.body();
  const markov::Field field{scene.field.columns, scene.field.rows};
  const int max_gates = scene.field.max_gates;
  const lattice::ChainStart chain_start = lattice::chain_start(matrix.space, scene.field, body);

  const Stopwatch exact_watch;
  const markov::FinalDistribution exact =
      predictor.predict(field, chain_start.start, {.max_cells = max_gates});
  const double exact_seconds = exact_watch.seconds();

  markov::WalkTally walked;
  const Stopwatch walks_watch;
  run_in_batches("walks", walks, options.talk(), [&](std::int64_t first, std::int64_t n) {
    walked += walker.walk(field, chain_start.start, max_gates, options.seed(), {first, n});
  });
  const double walks_seconds = walks_watch.seconds();

  lattice::FieldTally seen(scene.field);
  BlocksOf100 blocks(exact.final_cells, walks, [&](std::int64_t first, std::int64_t n) {
    std::vector<std::int32_t> cells;
    (void)walker.walk(field, chain_start.start, max_gates, options.seed(), {first, n}, &cells);
    return cells;
  });
  double dynamics_seconds = 0.0;
  run_in_batches("full dynamics", trials, options.talk(), [&](std::int64_t first, std::int64_t n) {
    const Stopwatch dynamics_watch;
    seen +=
        lattice::run_field(scene.gate, scene.field, body, matrix.space, options.seed(), {first, n});
    dynamics_seconds += dynamics_watch.seconds();
    blocks.add(seen.final_gate_of_trial);
    seen.final_gate_of_trial.clear();
  });

  // As many null draws as fit a fixed amount of work, 999 to 9999: each deals out the trials and
  // multiplies with a matrix of gates x gates.
  const std::int64_t gates =
      std::min<std::int64_t>(exact.final_cells.size(), lattice::kMostEnergyGates);
  const std::int64_t null_draws =
      options.has("null-draws")
          ? options.count("null-draws")
          : std::clamp<std::int64_t>(100'000'000 / (trials + walks + gates * gates / 8), 999, 9999);
  lattice::MatrixNoise noise(exact,
                             matrix.trials[static_cast<std::size_t>(chain_start.start.input)]);
  for (const markov::FinalDistribution& other : resampled) noise.add(other);
  const double s = lattice::concentration(seen.final_gates);
  return {.start = start,
          .chain_start = chain_start,
          .dynamics = seen,
          .walks = walked,
          .exact = exact,
          .walks_against =
              lattice::compare(seen.final_gates, walked.final_cells, null_draws, options.seed()),
          .exact_against =
              lattice::compare(seen.final_gates, exact.final_cells, null_draws, options.seed()),
          .paper_sized = blocks.result(),
          .floor_100_exact = lattice::noise_floor(s, exact.final_cells.size(), 100, 0),
          .floor_100_walks = lattice::noise_floor(s, exact.final_cells.size(), 100, 100),
          .judgement = lattice::judge({seen.final_gates, seen.endings}, exact, resampled,
                                      null_draws, options.seed()),
          .matrix_noise_mean = noise.mean_total_variation(),
          .matrix_noise_sd = noise.sd_total_variation(),
          .resampled = noise.replicates(),
          .dynamics_endings = EndingShares(seen.endings, trials),
          .walks_endings = EndingShares(walked.endings, walks),
          .exact_endings = EndingShares(exact, noise, max_gates),
          .dynamics_seconds = dynamics_seconds,
          .walks_seconds = walks_seconds,
          .exact_seconds = exact_seconds};
}

/// Predictions from resampled matrices, (starts x replicates): fewer for large fields, which cost
/// time and memory.
std::vector<std::vector<markov::FinalDistribution>> resampled_predictions(
    const Options& options, const dynamics::Transitions& matrix, const markov::Field& field,
    const std::vector<markov::Start>& starts, int max_gates) {
  constexpr std::int64_t kMost = 999, kAtLeast = 50, kTogether = 8, kMostNumbers = 25'000'000;
  const std::int64_t numbers = std::int64_t{field.columns} * field.rows * std::ssize(starts);
  const std::int64_t count = std::max(
      kAtLeast,
      lattice::affordable_replicates(field, max_gates, std::min(kMost, kMostNumbers / numbers)));
  const lattice::FieldMatrices rows{{&matrix},
                                    std::vector<int>(static_cast<std::size_t>(field.rows))};
  std::vector<std::vector<markov::FinalDistribution>> all(starts.size());
  run_in_batches("resampled matrices", (count + kTogether - 1) / kTogether, options.talk(),
                 [&](std::int64_t first, std::int64_t n) {
                   const std::int64_t begin = first * kTogether;
                   auto found = lattice::replicate_predictions(
                       rows, field, starts, max_gates, options.seed(), begin,
                       std::min(n * kTogether, count - begin));
                   for (std::size_t k = 0; k < starts.size(); ++k)
                     std::move(found[k].begin(), found[k].end(), std::back_inserter(all[k]));
                 });
  return all;
}

/// Body, beams, drag and field of the paper's Table IV, whatever the forces (it does not print
/// them): only then do its numbers belong beside these.
bool like_the_papers(const lattice::Scene& scene) {
  const dynamics::GateParams paper;
  for (const dynamics::ParamInfo& info : dynamics::gate_param_table()) {
    const bool free = info.key == "forces.propulsion_N" || info.key == "forces.random_N" ||
                      info.key.substr(0, 4) == "run.";
    if (!free && info.get(scene.gate) != info.get(paper)) return false;
  }
  const lattice::FieldParams field;
  return scene.gate.run.time_limit == paper.run.time_limit &&
         scene.gate.run.traverse_y == paper.run.traverse_y &&
         scene.field.columns == field.columns && scene.field.rows == field.rows &&
         scene.field.max_gates == field.max_gates;
}

/// What the one test says (lattice::judge), with what differs.
std::string verdict(const StartReport& r) {
  const lattice::Judgement& j = r.judgement;
  const std::string p = j.p < 0.001 ? "p < 0.001" : "p = " + fixed(j.p, 3);
  if (!j.differs())
    return "the chain agrees with the dynamics as far as these trials and this matrix can tell (" +
           p + ")";
  std::string text =
      "the chain differs from the dynamics by more than chance in trials and matrix makes (" + p +
      "):";
  const char* separator = " ";
  const auto say = [&](const std::string& what) {
    text += separator + what;
    separator = "; ";
  };
  for (const EndingName& e : kEndingNames) {
    if (!j.differs(e.ending)) continue;
    const auto at = static_cast<std::size_t>(e.ending);
    say(std::string(e.name) + " " +
        with_interval(r.dynamics_endings.share[at], r.dynamics_endings.interval[at]) +
        " % in the dynamics, " +
        with_interval(r.exact_endings.share[at], r.exact_endings.interval[at]) + " % by the chain");
  }
  if (j.differs(markov::Ending::unsampled))
    say("states never sampled, " + percent(r.exact.unsampled, 1.0, 2) + " by the chain");
  const auto gates = {j.total_variation.p_adjusted, j.energy.p_adjusted, j.chi_squared.p_adjusted};
  if (std::any_of(gates.begin(), gates.end(),
                  [](double x) { return x <= lattice::Judgement::kLevel; }))
    say("final gates, total variation " + fixed(j.total_variation.seen, 3) +
        " (chance: " + fixed(j.chance_total_variation, 3) + ")");
  return text;
}

/// What the one test counted.
Json to_json(const lattice::Judgement& j, std::int64_t resampled) {
  Json adjusted = {{"total_variation", j.total_variation.p_adjusted},
                   {"energy_distance", j.energy.p_adjusted},
                   {"chi_squared", j.chi_squared.p_adjusted}};
  for (const EndingName& e : kEndingNames)
    adjusted["endings"][e.key] = j.endings[static_cast<std::size_t>(e.ending)].p_adjusted;
  adjusted["endings"]["never_sampled"] =
      j.endings[static_cast<std::size_t>(markov::Ending::unsampled)].p_adjusted;
  return {{"differs", j.differs()},
          {"p", j.p},
          {"level", lattice::Judgement::kLevel},
          {"p_adjusted", adjusted},
          {"total_variation_by_chance",
           {{"mean", j.chance_total_variation}, {"at_95", j.chance_total_variation_95}}},
          {"null_draws", j.null_draws},
          {"resampled_matrices", resampled}};
}

Json to_json(const StartReport& r) {
  Json j;
  j["verdict"] = verdict(r);
  j["trials_and_matrix"] = to_json(r.judgement, r.resampled);
  j["start"] = {{"d_m", r.start.d},
                {"vx_m_per_s", r.start.vx},
                {"vy_m_per_s", r.start.vy},
                {"clamped", r.chain_start.clamped}};
  if (r.start.corrcoef)
    j["paper"] = {{"corrcoef", *r.start.corrcoef}, {"rmse_per_100", *r.start.rmse}};
  j["exact"] = to_json(r.exact_against);
  j["exact"]["total_variation_of_matrix_sampling"] = {{"mean", r.matrix_noise_mean},
                                                      {"sd", r.matrix_noise_sd}};
  j["walks"] = to_json(r.walks_against);
  const PaperSized& p = r.paper_sized;
  j["at_100_trials"] = {{"repeats", p.exact_rmse.n},
                        {"exact_corrcoef", to_json(p.exact_corrcoef)},
                        {"exact_corrcoef_floor", r.floor_100_exact.corrcoef},
                        {"exact_rmse_per_100", to_json(p.exact_rmse)},
                        {"exact_rmse_per_100_floor", r.floor_100_exact.rmse_per_100},
                        {"exact_corrcoef_rmse_correlation", p.exact_correlation()},
                        {"walks_corrcoef", to_json(p.walks_corrcoef)},
                        {"walks_corrcoef_floor", r.floor_100_walks.corrcoef},
                        {"walks_rmse_per_100", to_json(p.walks_rmse)},
                        {"walks_rmse_per_100_floor", r.floor_100_walks.rmse_per_100}};
  j["seconds"] = {
      {"dynamics", r.dynamics_seconds}, {"walks", r.walks_seconds}, {"exact", r.exact_seconds}};
  const double per_trial = r.dynamics_seconds / static_cast<double>(r.dynamics.trials);
  const double per_walk = r.walks_seconds / static_cast<double>(r.walks.walks);
  j["speed_ratio"] = {{"dynamics_trial_over_walk", per_trial / per_walk},
                      {"dynamics_over_exact", r.dynamics_seconds / r.exact_seconds}};
  j["endings"] = {{"dynamics", endings(r.dynamics.endings)},
                  {"walks", endings(r.walks.endings)},
                  {"exact", endings(r.exact.endings)}};
  j["endings_95"] = {{"dynamics", endings_95(r.dynamics_endings)},
                     {"walks", endings_95(r.walks_endings)},
                     {"exact", endings_95(r.exact_endings)}};
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
  j["trapped_gates"] = {{"dynamics", grid(r.dynamics.trapped_gates)},
                        {"walks", grid(r.walks.trapped_cells)},
                        {"exact", grid(markov::trapped_cells(r.exact))}};
  j["departed_gates"] = {{"dynamics", grid(r.dynamics.departed_gates)},
                         {"walks", grid(r.walks.departed_cells)},
                         {"exact", grid(markov::departed_cells(r.exact))}};
  j["never_sampled"] = r.exact.unsampled;
  return j;
}

std::string with_sd(const MeanAndSd& m) {
  return fixed(m.mean(), 3) + " (" + fixed(m.sd(), 3) + ")";
}

std::string table_of(const std::vector<StartReport>& reports, bool papers, std::int64_t trials,
                     std::int64_t walks, std::size_t threads) {
  std::vector<lattice::PaperStart> starts;
  for (const StartReport& r : reports) starts.push_back(r.start);
  const StartTexts labels(starts);
  std::ostringstream out;
  // Each column as wide as its widest cell: "17.61 [16.87, 18.37]*".
  std::array<std::size_t, kEndingNames.size()> width{};
  const auto cell = [](const StartReport& r, const EndingShares& shares, const EndingName& e) {
    const auto at = static_cast<std::size_t>(e.ending);
    const bool marked = &shares == &r.exact_endings && r.judgement.differs(e.ending);
    return with_interval(shares.share[at], shares.interval[at]) + (marked ? "*" : " ");
  };
  for (const StartReport& r : reports)
    for (std::size_t e = 0; e < width.size(); ++e)
      width[e] = std::max({width[e], cell(r, r.dynamics_endings, kEndingNames[e]).size(),
                           cell(r, r.exact_endings, kEndingNames[e]).size()});
  const auto line = [&](const auto& text_of) {
    std::string text;
    for (std::size_t e = 0; e < width.size(); ++e)
      text += "  " + padded(text_of(kEndingNames[e]), static_cast<int>(width[e]));
    return text;
  };
  out << "Endings, % of " << trials
      << " trials of the full dynamics and by the exact chain, with 95 % intervals: chance in the\n"
         "trials, in the sampling of the matrix. p: how often chance in both together would make "
         "any ending\n"
         "or the final gates look as different; *: this ending differs.\n\n"
      << labels.header << "  |         ";
  out << line([](const EndingName& e) { return std::string(e.name) + " "; }) << "       p\n";
  for (std::size_t k = 0; k < reports.size(); ++k) {
    const StartReport& r = reports[k];
    out << labels.texts[k] << "  | dynamics"
        << line([&](const EndingName& e) { return cell(r, r.dynamics_endings, e); }) << "\n"
        << labels.texts[k] << "  | chain   "
        << line([&](const EndingName& e) { return cell(r, r.exact_endings, e); })
        << padded(p_text(r.judgement.p), 8) << "\n";
  }
  out << "\n";
  for (std::size_t k = 0; k < reports.size(); ++k)
    out << labels.texts[k] << "  | " << verdict(reports[k]) << "\n";
  const std::string blank(labels.header.size(), ' ');
  out << "\nAs in the paper's Table IV: 100 trials of the full dynamics against the chain, mean "
         "(sd) over\n"
         "repeats. Floor: what chance alone gives if the chain were perfect.\n\n"
      << blank << "  |            corrcoef                      |        RMSE, trials per 100\n"
      << labels.header
      << "  | paper  exact chain    floor  100 walks   | paper  exact chain    floor  100 walks\n";
  for (std::size_t k = 0; k < reports.size(); ++k) {
    const StartReport& r = reports[k];
    const PaperSized& p = r.paper_sized;
    const auto printed = [&](const std::optional<double>& x) {
      return padded(papers && x ? fixed(*x, 3) : "-", 6);
    };
    out << labels.texts[k] << "  |" << printed(r.start.corrcoef) << "  "
        << padded(with_sd(p.exact_corrcoef), -15) << padded(fixed(r.floor_100_exact.corrcoef, 3), 5)
        << "  " << padded(with_sd(p.walks_corrcoef), -15) << "|" << printed(r.start.rmse) << "  "
        << padded(with_sd(p.exact_rmse), -15) << padded(fixed(r.floor_100_exact.rmse_per_100, 3), 5)
        << "  " << with_sd(p.walks_rmse) << "\n";
  }
  out << "\nFinal gates of all " << trials
      << " trials per start. Floor: chance in these trials (and walks) alone; matrix:\n"
         "total variation (TV) that the sampling of the matrix alone makes; chance: that both "
         "together make.\n\n"
      << labels.header
      << "  | against         corrcoef  floor    RMSE   floor      TV   floor  matrix  chance\n";
  for (std::size_t k = 0; k < reports.size(); ++k) {
    const StartReport& r = reports[k];
    const auto compared = [&](const std::string& name, const lattice::Comparison& c,
                              const std::string& chance) {
      out << labels.texts[k] << "  | " << padded(name, -15) << padded(fixed(c.corrcoef, 4), 9)
          << padded(fixed(c.floor.corrcoef, 4), 8) << padded(fixed(c.rmse_per_100, 3), 8)
          << padded(fixed(c.floor.rmse_per_100, 3), 8) << padded(fixed(c.total_variation, 3), 8)
          << padded(fixed(c.floor_total_variation, 3), 8)
          << padded(fixed(r.matrix_noise_mean, 3), 8) << padded(chance, 8) << "\n";
    };
    compared("exact chain", r.exact_against, fixed(r.judgement.chance_total_variation, 3));
    compared(std::to_string(walks) + " walks", r.walks_against, "-");
  }
  out << "\nSeconds: " << trials << " trials and " << walks << " walks on " << threads
      << (threads == 1 ? " thread" : " threads") << ", one exact prediction on one.\n"
      << "\n"
      << labels.header
      << "  |           dynamics      walks      exact | dynamics/exact  trial/walk\n";
  for (std::size_t k = 0; k < reports.size(); ++k) {
    const StartReport& r = reports[k];
    const double per_trial = r.dynamics_seconds / static_cast<double>(r.dynamics.trials);
    const double per_walk = r.walks_seconds / static_cast<double>(r.walks.walks);
    out << labels.texts[k] << "  |" << padded(fixed(r.dynamics_seconds, 2), 19)
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
  Options options(
      "validate SCENE [options]",
      "Compares the chain with the full dynamics: for the scene's start (in the paper's field the\n"
      "four of Table IV), or those given, the endings with 95 % intervals and one verdict on "
      "endings\n"
      "and final gates that counts chance in trials and matrix together; corrcoef, RMSE and total\n"
      "variation of walks and of the exact chain, each beside its noise floor; the time each "
      "takes.\n"
      "In JSON, trials_and_matrix is that verdict; p_values count chance in the trials (and "
      "walks)\n"
      "alone.",
      "gatewalk validate scenes/field.toml --trials 10000 --json validation.json");
  options.positional("scene", "scene file (TOML)", true);
  add_trials_and_seed(options, "trials of the full dynamics per start");
  add_strict(options);
  options.input_file("matrix", "matrix to validate; without it one is built from the scene");
  options.add()("matrix-trials", po::value<Count>()->value_name("N"),
                "runs per input state of the matrix that is built (default: 100)")(
      "walks", po::value<Count>()->value_name("N"), "walks per start (default: as many as trials)")(
      "null-draws", po::value<Count>()->value_name("N"),
      "draws behind each p-value (default: 999 to 9999, by the size of the work)");
  add_starts(options);
  add_bins(options);
  if (!options.parse(arguments)) return kFine;
  constexpr std::int64_t kMostNullDraws = 100'000;  // some 20 MB
  const std::int64_t trials = options.count("trials");
  const std::int64_t walks = options.has("walks") ? options.count("walks") : trials;
  if (options.has("null-draws")) (void)options.count("null-draws", 1, kMostNullDraws);
  const std::int64_t matrix_trials =
      options.has("matrix-trials") ? options.count("matrix-trials") : 100;
  std::vector<lattice::PaperStart> starts = given_starts(options);

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
      return read_matrix_and_scene(options.text("matrix"), options.text("scene"),
                                   options.overrides());
    lattice::Scene scene = lattice::read_scene(options.text("scene"), options.overrides());
    const lattice::BinsChoice choice = bins_choice(options, scene);
    starts = starts_of(options, scene);
    lattice::require_inside(starts, scene);
    const auto bodies = lattice::entries_at(starts);
    if (choice.kind != lattice::BinsChoice::Kind::automatic)
      require_inside_bins(starts, scene, lattice::fixed_space(scene));
    settled = settle_method(options, scene, lattice::RunsFrom::everywhere);
    const lattice::States made = states_of(options, scene, choice, bodies);
    states = gatewalk::cli::to_json(made);
    warn_if_poor(made);
    auto built = lattice::build_matrix(scene, made, matrix_trials, options.seed(), options.work());
    lattice::check_outcomes(scene, lattice::RunsFrom::everywhere, options.seed(),
                            built.totals().runs, built.health, options.work());
    Json status = gatewalk::cli::to_json(built.health);
    return MatrixAndScene{{std::move(built), {}}, scene, std::move(status)};
  }();
  const double matrix_seconds = matrix_watch.seconds();
  if (const auto chosen = m.file.text.find("method"); chosen != m.file.text.end()) {
    settled = Json::parse(chosen->second, nullptr, false);
    if (settled.is_discarded())
      throw markov::BadFile(options.text("matrix") +
                            ": its record of the chosen method is damaged");
  }
  const lattice::Scene& scene = m.scene;
  // Some 50 predictions of every gate are kept.
  constexpr std::int64_t kMostGates = 100'000;
  if (std::int64_t{scene.field.columns} * scene.field.rows > kMostGates)
    throw UsageError("validate compares fields of up to " + std::to_string(kMostGates) +
                     " gates; field.columns = " + std::to_string(scene.field.columns) +
                     " and field.rows = " + std::to_string(scene.field.rows));
  const dynamics::Transitions& t = m.file.transitions;
  if (options.has("matrix")) {
    starts = starts_of(options, scene);
    lattice::require_inside(starts, scene);
    (void)lattice::entries_at(starts);
    if (const auto stored = m.file.text.find("state_space"); stored != m.file.text.end()) {
      states = Json::parse(stored->second, nullptr, false);
      if (states.is_discarded())
        throw markov::BadFile(options.text("matrix") +
                              ": its record of the state space is damaged");
    }
    require_inside_bins(starts, scene, t.space);
  }
  const markov::Chain chain = lattice::make_chain(t);
  const markov::Predictor predictor(chain);
  const markov::Walker walker(chain);
  const markov::Field field{scene.field.columns, scene.field.rows};
  std::vector<markov::Start> places;
  for (const lattice::PaperStart& start : starts)
    places.push_back(lattice::chain_start(t.space, scene.field, start.body()).start);
  const auto resampled = resampled_predictions(options, t, field, places, scene.field.max_gates);

  std::vector<StartReport> reports;
  EntryShares shares;
  dynamics::Health health = t.health;
  for (std::size_t k = 0; k < starts.size(); ++k) {
    reports.push_back(
        run_start(options, scene, t, predictor, walker, resampled[k], starts[k], trials, walks));
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
  table +=
      "\nMatrix: " + std::to_string(total.runs) + " gate runs, " + matrix_time +
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
