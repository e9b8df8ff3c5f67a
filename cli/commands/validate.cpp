// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "cli/arguments.h"
#include "cli/next.h"
#include "cli/render/cross_validation.h"
#include "cli/render/final_gates.h"
#include "cli/render/health.h"
#include "cli/render/matrix.h"
#include "cli/render/order.h"
#include "cli/render/prediction.h"
#include "cli/render/validation.h"
#include "cli/source_options.h"
#include "dynamics/base/work.h"
#include "lattice/field/problem.h"
#include "lattice/pool/remembered.h"
#include "lattice/scene/scene.h"
#include "lattice/source/cell_matrix.h"
#include "lattice/study/observed.h"
#include "lattice/study/order.h"
#include "lattice/text/digits.h"

namespace gatewalk::cli {
namespace {

struct ValidateCommand : Options {
  using Options::Options;
  TextOption path = scene();
  CountOption trials =
      add_count("trials", "N",
                "trials of the full dynamics per start (default: 100; with --observed 10000, "
                "or 20 times as many as were observed)");
  Option seed_given = add_seed();
  TextOption checkpoint = add_kept({"full dynamics", "force drawn anew"});
  Option strict = add_strict();
  TextsOption observed =
      add_texts("observed", "FILE.csv",
                "counts of an experiment from this start, compared with dynamics and chain. A line "
                "for each trial: trial,ending (crossed, left side, right side, trapped, cut off; "
                "went back is left out, since no body of the model does) and, if known, the final "
                "gate's gate_x,gate_y. Or counts: gate_x,gate_y,count or ending,count, or both. "
                "Files with the same columns are added up");
  TextOption matrix =
      input_file("matrix", "the matrix to test; without it, validate builds one from the scene");
  CountOption matrix_trials =
      add_count("matrix-trials", "N",
                "for a matrix of bins that is built: runs from each state (default: 100)");
  AskedAccuracy accuracy = add_accuracy(*this);
  CountOption walks = add_count("walks", "N", "walks per start (default: as many as trials)");
  CountOption null_draws =
      add_count("null-draws", "N",
                "draws behind each p-value (default: 999 to 9999, by the size of the work)");
  Option memory =
      add_flag("memory",
               "also simulate the trials with the random force drawn anew at every crossing, and "
               "compare");
  TextOption order = add_text(
      "order", "LOW:HIGH",
      "what must the chain remember? Compares chains that remember LOW to HIGH turns (or what "
      "--order-of says), by how well they predict other bodies; of a scene, 1000 trials or "
      "--trials, and whether the chain should know the numbers that bodies carry");
  TextOption order_of = add_order_of(*this);
  TextOption cell_file =
      input_file("cell",
                 "SCENE is a table of recorded runs (runs.csv), and this file (cell.toml) "
                 "describes the cells");
  TextsOption start = add_starts(*this);
  TextOption bins = add_bins(*this);
  AskedProgram program = add_cell_program(*this);
  TextOption figure = add_figure(
      "the final gates of dynamics and chain and their difference, the Chapman-Kolmogorov test for "
      "2 "
      "to 8 gates, and implied time scales; with --observed the counts with intervals, beside "
      "both");
  Asked asked{.path = path, .program = program, .starts = start, .accuracy = accuracy};
};

/// Simulated trials for each observed trial, so that the simulation's sampling error is small
/// beside the experiment's; and the least number of simulated trials.
constexpr std::int64_t kTrialsPerObserved = 20, kLeastBesideObserved = 10'000;

constexpr std::int64_t kMostNullDraws = 100'000;  // about 20 MB

/// The matrices to validate, by type of cell, with a result in which only the validation is
/// missing.
struct ChainUnderTest {
  lattice::Problem problem;
  std::vector<dynamics::Entry> starts{};
  std::optional<lattice::Observed> observed{};
  std::optional<lattice::Scene> scene{};  // for scenes of gates
  ValidateResult result;
};

ChainUnderTest of_scene(const ValidateCommand& options, lattice::Scene scene,
                        std::vector<dynamics::Entry> starts) {
  ChainUnderTest tested{.problem = lattice::problem_of(scene),
                        .starts = std::move(starts),
                        .result = {.shown = scene,
                                   .like_table4 = lattice::like_table4(scene),
                                   .made_by = options.provenance(scene)}};
  if (!options.observed && !options.start) tested.result.papers = lattice::table_iv_starts(scene);
  tested.scene = std::move(scene);
  return tested;
}

/// The starts. With --observed: the one start that is given, else the scene's own.
std::vector<dynamics::Entry> starts_for(const ValidateCommand& options,
                                        const lattice::Scene& scene) {
  if (!options.observed) return starts_of(options.start, scene);
  auto starts = options.start ? given_starts(options.start)
                              : std::vector<dynamics::Entry>{lattice::own_start(scene)};
  if (starts.size() > 1)
    throw UsageError(
        fmt::format("--observed: the counts belong to one start, --start gives {}", starts.size()));
  return starts;
}

/// Warns, before any run, of what so few trials cannot show, and of trials that are left out.
void warn_of_trials(const ValidateCommand& options, const lattice::Observed& observed) {
  const std::int64_t n = observed.seen.trials();
  for (const std::string& text : observed.remarks) options.warn(text);
  options.warn(who_went_back(observed));
  options.warn(too_few_observed(observed));
  if (!observed.timed.empty())
    options.warn("--observed: validate does not test the times; gatewalk fit uses them");
  if (options.trials && options.trials.value() < kTrialsPerObserved * n)
    options.warn(fmt::format(
        "--trials {}: take {} or more for {} observed, or their noise hides differences",
        options.trials.value(), kTrialsPerObserved * n, n));
}

std::optional<lattice::Observed> experiment_of(const ValidateCommand& options,
                                               const lattice::FieldParams& field) {
  if (!options.observed) return {};
  auto observed = lattice::read_observed(options.observed.values(), field);
  warn_of_trials(options, observed);
  return observed;
}

void put_observed(ChainUnderTest& tested, const ValidateCommand& options,
                  std::optional<lattice::Observed> observed) {
  if (observed) tested.result.observed = {options.observed.values(), observed->went_back};
  tested.observed = std::move(observed);
}

/// The chain in the file of --matrix.
ChainUnderTest read_chain(const ValidateCommand& options) {
  const std::string path = options.matrix.value();
  lattice::SceneMatrix m =
      read_matrix(options, path, &options.file(options.path.value()).toml(), options.overrides());
  auto starts = starts_for(options, m.scene);
  lattice::require_inside(starts, m.scene);
  auto observed = experiment_of(options, m.scene.field);
  add_starts(options, m, path, starts);
  require_inside_bins(options, starts, m.scene, m.file->transitions.space);
  ChainUnderTest tested = of_scene(options, m.scene, std::move(starts));
  put_observed(tested, options, std::move(observed));
  tested.result.matrix = {.matrices = lattice::matrices_of(*m.file, m.scene),
                          .path = path,
                          .health = recorded_health(*m.file),
                          .method = recorded_method(*m.file, path),
                          .states = recorded_states(*m.file, path)};
  return tested;
}

/// Builds a chain of trees for this validation.
void put_tree(ChainUnderTest& tested, const ValidateCommand& options) {
  const lattice::TreeOptions how{.accuracy = accuracy_of(options, options.accuracy),
                                 .starts = tested.starts};
  lattice::TreeChain chain = lattice::make_tree_chain(tested.problem, how, options.work());
  warn_of(options, *chain.prediction, how.accuracy.accuracy);
  ValidatedMatrix& matrix = tested.result.matrix;
  matrix.health = chain.transitions.front().health;
  matrix.states = record_of(chain, how.accuracy.accuracy);
  matrix.matrices = std::move(chain.transitions);
}

/// The chain of bins or trees, built from the scene.
ChainUnderTest build_chain(const ValidateCommand& options) {
  const std::int64_t trials = options.matrix_trials ? options.matrix_trials.value() : 100;
  lattice::Scene scene = options.read_scene();
  const lattice::BinsChoice choice = bins_choice(options.bins, scene, options.matrix_trials);
  auto starts = starts_for(options, scene);
  lattice::require_inside(starts, scene);
  auto observed = experiment_of(options, scene.field);
  const bool tree = choice.kind == lattice::BinsChoice::Kind::tree;
  if (tree && options.matrix_trials)
    throw UsageError("--matrix-trials is of runs per state of bins: --bins tree takes --accuracy");
  if (!tree)
    refuse({options.accuracy.accuracy, options.accuracy.gate_runs},
           "for bins: it is for --bins tree");
  if (!tree && choice.kind != lattice::BinsChoice::Kind::automatic)
    require_inside_bins(options, starts, scene, lattice::fixed_space(scene));
  auto settled = settle_method(options, scene, lattice::RunsFrom::everywhere);
  ChainUnderTest tested = of_scene(options, std::move(scene), std::move(starts));
  put_observed(tested, options, std::move(observed));
  ValidatedMatrix& matrix = tested.result.matrix;
  matrix.method = std::move(settled);
  if (tree) {
    put_tree(tested, options);
    return tested;
  }
  const lattice::States states =
      states_of(options, *tested.scene, choice, lattice::bodies_at(*tested.scene, tested.starts));
  for (const std::string& text : complaints(states)) options.warn(text);
  matrix.matrices =
      lattice::build_matrices(*tested.scene, states, {0, trials}, options.seed(), options.work());
  matrix.health = matrix.matrices.front().health;
  matrix.states = record_of(states);
  return tested;
}

/// The chain of trees of a program's cells.
ChainUnderTest program_chain(const ValidateCommand& options) {
  refuse({options.bins, options.matrix, options.matrix_trials},
         "for cells that another program carries out");
  lattice::Source s = open_source(options, options.asked);
  ChainUnderTest tested{.problem = s.problem,
                        .starts = s.entries(),
                        .result = {.shown = ShownField(s), .made_by = options.provenance(s)}};
  if (options.observed && tested.starts.size() > 1)
    throw UsageError("--observed: the counts belong to one start");
  put_observed(tested, options, experiment_of(options, tested.problem.field));
  put_tree(tested, options);
  return tested;
}

/// The chain of --matrix, of the cells of --cell-program, or built from the scene. Throws
/// UsageError and what reading or building it throws.
ChainUnderTest chain_under_test(const ValidateCommand& options) {
  if (has_cell(options, options.program)) return program_chain(options);
  return options.matrix ? read_chain(options) : build_chain(options);
}

/// Bodies that were recorded, or simulated for --order.
struct Bodies {
  lattice::Problem problem;
  std::shared_ptr<const lattice::RunPool> pool;
  ShownField shown;
  Provenance made_by;
  int per_leaf = dynamics::kEntriesPerLeaf;
  std::optional<lattice::Remembering> remembering{};  // the same bodies, if they remember numbers
};

/// The recorded bodies of a table or of a matrix; nullopt: nothing was recorded.
std::optional<Bodies> recorded_bodies(const ValidateCommand& options) {
  const std::string path = options.path.value();
  if (options.cell_file) {
    RecordedCells runs = read_recorded(options, path, options.cell_file);
    Bodies bodies{std::move(runs.problem), std::make_shared<lattice::RunPool>(std::move(runs.pool)),
                  ShownField(runs.cells), options.provenance()};
    bodies.shown.is_simulated = false;
    bodies.made_by.cell = lattice::to_toml(runs.cells);
    return bodies;
  }
  if (const lattice::SourceFile& file = options.file(path);
      has_cell(options, options.program) || !file.is_matrix() || !file.is_of_cells())
    return {};
  lattice::Source s = open_source(options, options.asked);
  if (s.is_imported)
    throw UsageError(path +
                     ": holds an imported chain, without trials or bodies to test it with. Make "
                     "the chain from recorded runs instead: gatewalk build runs.csv --cell "
                     "cell.toml");
  if (s.pool->scattered.each.bodies.empty())
    throw UsageError(path + ": its runs were not recorded: --cell-program says who makes more");
  return Bodies{s.problem, s.pool, ShownField(s), options.provenance(s), s.accuracy.per_leaf};
}

/// The orders LOW to HIGH of --order. Throws UsageError.
std::array<int, 2> orders_of(const ValidateCommand& options) {
  const std::string text = options.order.value();
  std::string_view rest = text;
  std::array<std::optional<double>, 2> ends{lattice::take_number(rest), {}};
  if (lattice::take_mark(rest, ':')) ends[1] = lattice::take_number(rest);
  const auto is_order = [](const std::optional<double>& x) {
    return x && *x >= 0.0 && *x <= lattice::kMostOrder && *x == std::floor(*x);
  };
  if (!is_order(ends[0]) || !is_order(ends[1]) || !(*ends[0] < *ends[1]) ||
      !lattice::behind_blanks(rest).empty())
    throw UsageError(fmt::format(
        "--order {}: must be two whole numbers from 0 to {}, the first one smaller, such as 0:4",
        text, lattice::kMostOrder));
  return {static_cast<int>(*ends[0]), static_cast<int>(*ends[1])};
}

/// Bodies simulated for --order.
Bodies simulated_bodies(const ValidateCommand& options) {
  constexpr std::int64_t kTrials = 1000;
  lattice::Source s = open_source(options, options.asked);
  if (s.starts.size() != 1)
    throw UsageError(fmt::format("--order: takes one --start, these are {}", s.starts.size()));
  s.problem.start = s.entries().front();
  choose_method(options, s);
  const std::int64_t trials = options.trials ? options.trials.value() : kTrials;
  Bodies bodies{s.problem, nullptr, ShownField(s), options.provenance(s)};
  bodies.remembering =
      lattice::remembering_bodies(s.problem, trials, options.seed(), options.work());
  bodies.pool = std::make_shared<lattice::RunPool>(
      bodies.remembering
          ? bodies.remembering->seen_in(s.problem)
          : lattice::simulated_bodies(s.problem, trials, options.seed(), options.work()));
  return bodies;
}

/// validate --order: what must the chain remember?
int validate_order(const ValidateCommand& options) {
  const auto [least, most] = orders_of(options);
  const lattice::OrderOptions how{
      .of = letters_of(options.order_of), .least = least, .most = most, .seed = options.seed()};
  refuse({options.matrix, options.matrix_trials, options.walks, options.null_draws,
          options.accuracy.accuracy, options.accuracy.gate_runs, options.bins, options.memory,
          options.strict, options.observed, options.shard, options.part, options.checkpoint,
          options.resume, options.max_time},
         "beside --order");
  std::optional<Bodies> bodies = recorded_bodies(options);
  const bool is_recorded = bodies.has_value();
  if (is_recorded) refuse({options.trials, options.start}, "for recorded bodies");
  if (!bodies) bodies = simulated_bodies(options);
  if (const dynamics::Section labelled = bodies->problem.map().section; labelled.words) {
    bodies->pool =
        std::make_shared<lattice::RunPool>(lattice::without_words(*bodies->pool, labelled));
    bodies->problem.cells.map.section = dynamics::Words::plain(labelled);
  }
  const OrderResult result{
      .study = lattice::study_order(bodies->problem, *bodies->pool, how, options.work(),
                                    bodies->remembering ? &*bodies->remembering : nullptr),
      .recorded = counts_of(*bodies->pool),
      .is_recorded = is_recorded,
      .made_by = bodies->made_by};
  NextCommands next(options);
  if (const int order = result.study.answer().order; options.cell_file && order > 0)
    next.run(
        fmt::format("build {} --cell {} --order {}{} -o chain.nc",
                    shell_quoted(options.path.value()), shell_quoted(options.cell_file.value()),
                    order, options.order_of ? " --order-of " + options.order_of.value() : ""),
        "makes that chain");
  options.give_out(result, {answer_text(result), details_text(result), next.lines(),
                            "the endings of both halves by order"});
  options.draw([&] { return figure_of(result); });
  return kFine;
}

/// Validates recorded runs: does one half of the bodies predict the other?
int validate_recorded(const ValidateCommand& options, const Bodies& bodies) {
  const std::string path = options.path.value();
  if (options.observed)
    throw UsageError(fmt::format(
        "--observed: counts are compared with a scene: gatewalk validate SCENE --observed {}. "
        "Without --observed, validate tests whether one half of the recorded bodies of {} predicts "
        "the other",
        options.observed.values().front(), path));
  refuse({options.matrix, options.matrix_trials, options.trials, options.walks,
          options.accuracy.accuracy, options.accuracy.gate_runs, options.start, options.bins,
          options.memory, options.strict, options.shard, options.part, options.checkpoint,
          options.resume, options.max_time},
         fmt::format("for {}: validate predicts one half of its bodies from the other half", path));
  const auto& [problem, pool, shown, made_by, per_leaf, remembering] = bodies;
  lattice::CrossValidationOptions how{
      .null_draws = {}, .seed = options.seed(), .per_leaf = per_leaf};
  if (options.null_draws) how.null_draws = options.null_draws.value(1, kMostNullDraws);
  const CrossValidationResult result{
      .validation = lattice::cross_validate(problem, *pool, how, options.work()),
      .memory = lattice::body_memory(problem, *pool, how.per_leaf, how.null_draws.value_or(999),
                                     how.seed),
      .section = problem.map().section,
      .recorded = counts_of(*pool),
      .made_by = made_by};
  if (pool->bodies() < kBodiesForP)
    options.warn(fmt::format("with {} bodies p may be too small: it was checked with {} or more",
                             pool->bodies(), kBodiesForP));
  NextCommands next(options);
  if (options.cell_file)
    next.run(fmt::format("build {} --cell {} -o chain.nc", shell_quoted(path),
                         shell_quoted(options.cell_file.value())),
             "makes the chain of all bodies");
  else
    next.keeping({"seed"}).add("predict", "", "what all bodies together predict");
  options.give_out(result,
                   {answer_text(result) + unequal_sides(shown), details_text(result), next.lines(),
                    "every ending of both halves, how far bodies were watched, final gates"});
  for (const std::string& rest : rest_warnings(result.validation)) options.warn(rest);
  options.draw([&] { return figure_of(result.validation, bodies.shown); });
  return kFine;
}

/// What --details shows, in words.
std::string details_of(const ValidateResult& result) {
  if (result.validation.starts.front().observed)
    return "p of every ending, the final gates, and whether the chain agrees with the dynamics";
  return result.like_table4 ? "every ending and measure by start, Table IV, times, tests of memory"
                            : "";
}

/// Commands to propose next.
std::vector<std::string> next_of(const ValidateCommand& options, const lattice::Validation& v) {
  NextCommands next(options);
  if (options.observed) {
    const std::int64_t n = v.starts.front().observed->seen.trials();
    return next.add("power", fmt::format("--trials {}", n), "what so many trials detect").lines();
  }
  const bool differs = std::any_of(v.starts.begin(), v.starts.end(), [](const auto& start) {
    return start.finding() == lattice::Finding::own_error;
  });
  if (differs && v.starts.size() == 1 && !options.start)
    return next.add("lattice", "--trials 10000", "the full dynamics alone").lines();
  if (v.trials < 1000)
    next.again("trials", std::to_string(10 * v.trials), "reveals smaller differences");
  const std::string why = "the chain's answer alone";
  if (options.matrix) return next.of(options.matrix.value(), "predict", why).lines();
  if (options.matrix_trials || (options.bins && options.bins.value() != "tree")) {
    const std::int64_t trials = options.matrix_trials ? options.matrix_trials.value() : 100;
    if (!options.start)  // whose states build makes for trees only
      next.keeping({"bins", "seed"})
          .add("build", fmt::format("--trials {} --output matrix.nc", trials),
               "keeps this chain in a file, for predict");
    return next.lines();
  }
  return next.keeping({"accuracy", "gate-runs", "seed"}).add("predict", "", why).lines();
}

}  // namespace

int run_validate(const Arguments& arguments) {
  ValidateCommand options(
      "validate SCENE|RUNS.csv [options]",
      "Tests whether the chain agrees with trials of the full dynamics, and whether it is "
      "Markov.\n\n"
      "The verdict is one p-value for endings and final gates. It counts chance in the trials and "
      "in\n"
      "the sampling of the matrix together, and is corrected for all that is tested. In JSON it "
      "is\n"
      "trials_and_matrix; the keys p_values count chance in the trials (and walks) alone. In the\n"
      "paper's field the starts are the four of Table IV.\n"
      "With --observed, validate compares the counts of an experiment with the full dynamics and\n"
      "with the chain, and says which shifts so many trials would detect.\n"
      "For recorded runs (a table with --cell, or their matrix) validate is a cross-validation: "
      "does\n"
      "one half of the bodies predict the other? With --order: what must their chain remember?",
      "gatewalk validate scenes/field.toml --trials 10000 --json validation.json");
  options.reads(options.observed, [](const std::string& file) { return file; });
  options.add_details("every ending and measure by start, times, each test of memory");
  options.most_used({"observed", "matrix", "trials", "set", "json"});
  if (!options.parse(arguments)) return kFine;
  if (options.order) return validate_order(options);
  refuse({options.order_of}, "without --order");
  if (const std::optional<Bodies> bodies = recorded_bodies(options))
    return validate_recorded(options, *bodies);
  lattice::ValidationOptions how{.trials = options.trials ? options.trials.value() : 100,
                                 .walks = {},
                                 .null_draws = {},
                                 .seed = options.seed(),
                                 .force_memory = static_cast<bool>(options.memory),
                                 .observed = {}};
  if (options.walks) how.walks = options.walks.value();
  if (options.null_draws) how.null_draws = options.null_draws.value(1, kMostNullDraws);
  if (const auto starts = options.start.values().size(); options.figure && starts > kMostValidated)
    throw UsageError(
        fmt::format("--figure: shows at most {} starts, these are {}", kMostValidated, starts));
  if (options.matrix) {
    refuse({options.bins}, "beside --matrix: that one has its states already");
    refuse({options.matrix_trials, options.accuracy.accuracy, options.accuracy.gate_runs},
           "beside --matrix: that one is built already");
  }
  const dynamics::Stopwatch watch;
  ChainUnderTest tested = chain_under_test(options);
  ValidateResult& result = tested.result;
  result.matrix.seconds = watch.seconds();
  if (const auto& observed = tested.observed) {
    how.observed = observed->seen;
    if (!options.trials)
      how.trials = std::max(kLeastBesideObserved, kTrialsPerObserved * observed->seen.trials());
  }
  result.validation = lattice::validate_chain(tested.problem, result.matrix.matrices, tested.starts,
                                              how, options.work());
  const lattice::Validation& v = result.validation;
  options.give_out(result, {answer_text(result) + unequal_sides(result.shown) + beware_of(v.health),
                            details_text(result), next_of(options, v), details_of(result)});
  options.warn(text_of(v.left_out));
  for (const lattice::StartValidation& start : v.starts)
    options.warn(rest_warning(rest_of(start.exact), "by the chain "));
  if (tested.observed) options.warn(endings_not_listed(*tested.observed, v.starts.front()));
  const int exit = status_of(options, v.health);
  options.draw([&] {
    const lattice::StartValidation& first = v.starts.front();
    return first.observed ? figure_of(*first.observed, first, result.shown.field)
                          : figure_of(v, result.shown);
  });
  return exit;
}

}  // namespace gatewalk::cli
