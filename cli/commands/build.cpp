// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <string>

#include "cli/arguments.h"
#include "cli/fields/text.h"
#include "cli/next.h"
#include "cli/render/choice.h"
#include "cli/render/health.h"
#include "cli/render/matrix.h"
#include "cli/render/recorded.h"
#include "cli/render/states.h"
#include "cli/render/version.h"
#include "cli/source_options.h"
#include "dynamics/base/work.h"
#include "lattice/pool/predict_pooled.h"
#include "lattice/pool/remembered.h"
#include "lattice/source/cell_matrix.h"
#include "lattice/text/digits.h"

namespace gatewalk::cli {
namespace {

struct BuildCommand : Options {
  using Options::Options;
  TextOption path = scene();
  AskedAccuracy accuracy = add_accuracy(*this);
  CountOption trials = add_count(
      "trials", "N",
      "bins: runs from each state (default: 100); tree: number of full trials, instead of "
      "--accuracy");
  CountOption first_trial = add_first_trial();
  Option seed_given = add_seed();
  TextOption checkpoint = add_kept({"building matrix", "full trials", "scattered trials"});
  Option strict = add_strict();
  TextOption output =
      main_output_file("MATRIX.nc", "matrix file (NetCDF-4)", Options::Content::binary);
  TextOption bins = add_bins(*this);
  TextOption cell_file =
      input_file("cell",
                 "SCENE is a table of recorded runs (runs.csv), and this file (cell.toml) "
                 "describes the cells (cli/site/reference/files.md)");
  AskedProgram program = add_cell_program(*this);
  TextsOption start =
      add_starts(*this, "the scene's start; for trees only: each start becomes a state of its own");
  TextOption starts =
      add_text("starts", "all|D,VX,VY",
               "tree: make the matrix good for any start in this range, LOW:HIGH each; all: the "
               "entries from below of Table III");
  CountOption states = add_count("states", "S", "tree: at most S states besides the starts");
  CountOption order = add_count(
      "order", "K",
      "recorded runs: the chain remembers the last K turns (default: 0; gatewalk validate "
      "RUNS.csv --order 0:4 says how many it needs)");
  TextOption order_of = add_order_of(*this);
};

/// What the chain shall remember; nullopt: nothing.
std::optional<dynamics::LettersOf> remembered(const BuildCommand& options) {
  if (options.order_of && !options.order)
    throw UsageError("--order-of: says what --order counts, and there is no --order");
  const dynamics::LettersOf of = letters_of(options.order_of);
  if (!options.order || options.order.value(0, lattice::kMostOrder) == 0) return {};
  if (of == dynamics::LettersOf::states)
    throw UsageError(
        "--order-of states: only validate --order takes it; build takes turns or faces");
  return of;
}

using Settled = std::optional<lattice::Settled>;

constexpr const char* kOnlyRecorded =
    "for recorded runs only; simulated ones: gatewalk lattice SCENE --passages runs.csv "
    "--cell-file cell.toml";

/// Commands to propose next. Only the chain of a scene can be validated against its dynamics.
std::vector<std::string> next_of(const BuildCommand& options, const std::string& matrix,
                                 bool is_of_scene) {
  NextCommands next(options);
  next.run("predict " + shell_quoted(matrix), "how bodies cross the field");
  if (is_of_scene)
    next.add("validate", "--matrix " + shell_quoted(matrix),
             "does the chain agree with the dynamics?");
  return next.lines();
}

/// Warns if the matrix file has another ending than .nc: the file is NetCDF in any case.
void warn_of_ending(const BuildCommand& options) {
  const std::string path = options.output.value();
  const std::string ending = std::filesystem::path(path).extension().string();
  if (!ending.empty() && ending != ".nc")
    options.warn(path + ": a matrix is written as NetCDF, whatever the name; .nc tells others so");
}

/// Writes the file with a matrix for each type of gate, and gives out the result.
int give_out(const BuildCommand& options, const lattice::Scene& scene, MadeMatrix made,
             const std::vector<dynamics::Transitions>& matrices) {
  made.path = options.output.value();
  made.made_by = options.provenance(scene);
  made.file.text = texts_of(made, scene, matrices.front().health);
  lattice::put_matrices(made.file, scene, matrices);
  options.keep_old(made.path);
  lattice::write_matrix(made.path, made.file);
  options.give_out(made, {summary_table(made.file, made.path) + beware_of(matrices.front().health),
                          "\n" + states_line(made.states) + method_line(made.method),
                          next_of(options, made.path, true)});
  return status_of(options, matrices.front().health);
}

int build_bins(const BuildCommand& options, const lattice::Scene& scene,
               const lattice::BinsChoice& choice, const Settled& settled) {
  refuse({options.accuracy.accuracy, options.accuracy.gate_runs, options.starts, options.start,
          options.states},
         "for bins: it is for --bins tree");
  const dynamics::TrialRange trials = options.trial_range();
  const dynamics::Stopwatch watch;
  const lattice::States states = states_of(options, scene, choice, {scene.start});
  const auto matrices =
      lattice::build_matrices(scene, states, trials, options.seed(), options.work());
  options.work().end_part();
  const int status = give_out(options, scene,
                              {.file = {matrices.front(), {}},
                               .states = record_of(states),
                               .method = settled,
                               .trials_per_row = trials.count},
                              matrices);
  options.remark("built in " + fixed(watch.seconds(), 2) + " s");
  for (const std::string& text : complaints(states)) options.warn(text);
  return status;
}

/// The range of starts that --starts gives; nullopt without it. Throws UsageError for a malformed
/// one.
std::optional<lattice::StartRange> range_of(const TextOption& starts, const lattice::Scene& scene) {
  if (!starts) return std::nullopt;
  const std::string text = starts.value();
  if (text == "all") return lattice::usual_range(lattice::problem_of(scene));
  lattice::StartRange range;
  std::string_view rest = text;
  for (std::size_t axis = 0; axis < dynamics::disc_section().coordinates.size(); ++axis) {
    const bool follows = axis == 0 || lattice::take_mark(rest, ',');
    const auto low = lattice::take_number(rest);
    const bool has_colon = lattice::take_mark(rest, ':');
    const auto high = lattice::take_number(rest);
    if (!follows || !low || !has_colon || !high || !(*low <= *high) || !std::isfinite(*high - *low))
      throw UsageError(
          fmt::format("--starts {}: must be all, or three ranges of d, vx, vy in m and m/s, e.g. "
                      "-5:5,-10:10,10:20",
                      text));
    range.at[axis] = {*low, *high};
  }
  if (!lattice::behind_blanks(rest).empty())
    throw UsageError(fmt::format("--starts {}: has more than three ranges", text));
  const double side = scene.gate.beams.joint_x;
  const auto& d = range.at[dynamics::kEntryD];
  if (!(d[0] >= -side && d[1] <= side))
    throw UsageError(fmt::format("--starts {}: d must lie inside the gate, [{}, {}]", text,
                                 digits(-side), digits(side)));
  return range;
}

/// The options of the chain of trees to build. Throws UsageError.
lattice::TreeOptions tree_options(const BuildCommand& options, const lattice::Scene& scene) {
  lattice::TreeOptions how{.accuracy = accuracy_of(options, options.accuracy)};
  how.range = range_of(options.starts, scene);
  if (options.states)
    how.most_states = static_cast<int>(options.states.value(1, dynamics::kMostStates));
  how.starts = given_starts(options.start);
  lattice::require_inside(how.starts, scene);
  if (how.starts.empty() && !how.range) how.starts = {lattice::own_start(scene)};
  if (scene.field.fidelity != lattice::Fidelity::active)
    options.warn(fmt::format(
        "field.fidelity = \"{}\" is for the full dynamics; a chain always has \"active\"",
        lattice::name_of(scene.field.fidelity)));
  return how;
}

int build_tree(const BuildCommand& options, const lattice::Scene& scene, const Settled& settled) {
  refuse({options.first_trial}, "for trees: --shard divides their trials");
  lattice::TreeOptions how = tree_options(options, scene);
  fix_trials(options, options.accuracy, how.accuracy,
             std::max<std::int64_t>(1, std::ssize(how.starts)));
  const dynamics::Stopwatch watch;
  const lattice::TreeChain chain =
      lattice::make_tree_chain(lattice::problem_of(scene), how, options.work());
  const int status =
      give_out(options, scene,
               {.file = {.transitions = chain.transitions.front(),
                         .text = {},
                         .arrays = lattice::arrays_of(chain.pool, chain.kernel.space.section())},
                .states = record_of(chain, how.accuracy.accuracy),
                .method = settled},
               chain.transitions);
  options.remark("built in " + fixed(watch.seconds(), 2) + " s");
  warn_of(options, chain.hausman_check, chain.assumptions);
  if (how.accuracy.trials) return status;
  if (chain.prediction) warn_of(options, *chain.prediction, how.accuracy.accuracy);
  if (chain.range && !chain.range->reached)
    options.warn("some starts of the range need more runs for an accuracy of " +
                 digits(how.accuracy.accuracy) + "; predict adds them");
  return status;
}

/// Writes the matrices of cells, with the runs behind them, to --output, and gives out the result.
void give_out_cells(const BuildCommand& options, std::vector<dynamics::Transitions> matrices,
                    const lattice::CellFile& cells, const lattice::RunPool& pool,
                    const StateRecord& states, const std::optional<dynamics::Health>& health,
                    const char* title) {
  std::map<std::string, std::string> text{{"title", title},
                                          {"state_space", attribute_of(states)},
                                          {"program", std::string("gatewalk ") + kVersion},
                                          {"commit", kCommit},
                                          {"command", options.canonical()}};
  if (health) text["status"] = attribute_of(*health);
  const std::string path = options.output.value();
  CellMatrixResult built{
      {path, lattice::cell_matrix_file(std::move(matrices), cells, pool, std::move(text))},
      counts_of(pool),
      options.provenance()};
  built.made_by.cell = lattice::to_toml(cells);
  options.keep_old(path);
  lattice::MatrixFile& file = built.matrix.file;
  std::vector<markov::NamedArray> shown;
  for (const markov::NamedArray& array : file.arrays)
    if (array.name == lattice::kRunTypes) shown.push_back(array);
  lattice::write_matrix(path, std::move(file));  // takes the arrays, which may be large
  file.arrays = std::move(shown);
  options.give_out(built, {summary_table(built.matrix.file, path) + table_of(pool) +
                               beware_of(health.value_or(dynamics::Health())),
                           "\n" + states_line(states), next_of(options, path, false)});
}

/// gatewalk build RUNS.csv --cell CELL.toml: builds from recorded runs.
int build_recorded(const BuildCommand& options) {
  refuse({options.accuracy.accuracy, options.accuracy.gate_runs, options.starts, options.start,
          options.states, options.trials, options.first_trial, options.bins, options.strict,
          options.shard, options.part, options.checkpoint, options.resume, options.max_time},
         "for recorded runs");
  auto [cells, pool, problem] = read_recorded(options, options.path.value(), options.cell_file);
  if (const std::optional<dynamics::LettersOf> of = remembered(options)) {
    const dynamics::CellMap& map = problem.map();
    const lattice::ChosenWords chosen = lattice::words_of(
        lattice::letters_of(*of, map, pool), pool,
        static_cast<int>(options.order.value(0, lattice::kMostOrder)), dynamics::kEntriesPerLeaf);
    if (chosen.left_out > 0)
      options.warn(
          fmt::format("a chain has no room for {} of {} memories: the rarest are forgotten",
                      chosen.left_out, chosen.left_out + chosen.words->size()));
    cells.map = lattice::with_words(map, chosen.words);
    pool = lattice::with_words(pool, cells.map);
    problem = lattice::problem_of(cells, pool);
  }
  auto matrices = lattice::cell_matrices(problem, pool, dynamics::kEntriesPerLeaf);
  const StateRecord states{
      {.kind = "tree", .trees = lattice::TreeInfo{.gate_runs = pool.gate_runs()}},
      matrices.front().space.size()};
  give_out_cells(options, std::move(matrices), cells, pool, states, {},
                 "gatewalk counts of passages through recorded cells");
  return kFine;
}

/// gatewalk build CELL.toml --cell-program COMMAND: builds from runs of the program.
int build_program(const BuildCommand& options) {
  refuse({options.cell_file, options.first_trial, options.bins, options.starts},
         "for cells that another program carries out");
  refuse({options.order, options.order_of}, kOnlyRecorded);
  const lattice::Source s = open_source(options, {.path = options.path,
                                                  .program = options.program,
                                                  .starts = options.start,
                                                  .accuracy = options.accuracy});
  if (s.file) throw UsageError(s.path + ": is a matrix already");
  lattice::TreeOptions how{.accuracy = s.accuracy, .starts = s.entries()};
  if (options.states)
    how.most_states = static_cast<int>(options.states.value(1, dynamics::kMostStates));
  fix_trials(options, options.accuracy, how.accuracy, std::ssize(how.starts));
  lattice::TreeChain chain = lattice::make_tree_chain(s.problem, how, options.work());
  const dynamics::Health health = chain.transitions.front().health;
  const StateRecord states = record_of(chain, s.accuracy.accuracy);
  give_out_cells(options, std::move(chain.transitions), *s.cells, chain.pool, states, health,
                 "gatewalk counts of passages through cells that another program carries out");
  warn_of(options, chain.hausman_check, chain.assumptions);
  if (!how.accuracy.trials) warn_of(options, *chain.prediction, s.accuracy.accuracy);
  return status_of(options, health);
}

}  // namespace

int run_build(const Arguments& arguments) {
  BuildCommand options(
      "build SCENE|RUNS.csv -o MATRIX.nc [options]",
      "Makes the transition matrix of one gate and writes it to a file, from which predict, walk,\n"
      "analyze and export answer without new runs.\n\n"
      "By default the states are the leaves of trees. build simulates trials from the scene's "
      "start\n"
      "(or those of --start, --starts) and grows trees over their gate runs, until predictions "
      "are\n"
      "as accurate as --accuracy says. With --bins paper the states are the paper's 87 bins of\n"
      "Table III: build simulates N runs through one gate from each bin and counts their outcomes.",
      "gatewalk build scenes/field.toml --accuracy 0.02 --starts all -o chain.nc");
  options.add_details("how the states were made and tested");
  options.most_used({"output", "accuracy", "starts", "bins", "set"});
  if (!options.parse(arguments)) return kFine;
  warn_of_ending(options);
  if (has_cell(options, options.program)) return build_program(options);
  if (options.cell_file) return build_recorded(options);
  refuse({options.order, options.order_of}, kOnlyRecorded);
  lattice::Scene scene = options.read_scene();
  require_keepable(scene);
  const lattice::BinsChoice choice = bins_choice(options.bins, scene, options.trials);
  const bool tree = choice.kind == lattice::BinsChoice::Kind::tree;
  const auto settled = settle_method(options, scene, lattice::RunsFrom::everywhere);
  return tree ? build_tree(options, scene, settled) : build_bins(options, scene, choice, settled);
}

}  // namespace gatewalk::cli
