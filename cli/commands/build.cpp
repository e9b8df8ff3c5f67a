// SPDX-License-Identifier: MIT
#include "cli/arguments.h"
#include "cli/commands/recorded.h"
#include "cli/render/choice.h"
#include "cli/render/matrix.h"
#include "cli/render/text.h"
#include "cli/subject.h"
#include "dynamics/base/work.h"

namespace gatewalk::cli {
namespace {

using Settled = std::optional<lattice::Settled>;

/// Writes the file of matrices, one for each type of gate, and says what was made.
int give_out(const Options& options, const lattice::Scene& scene, MadeMatrix made,
             const std::vector<dynamics::Transitions>& matrices) {
  made.path = options.text("output");
  made.made_by = options.provenance(scene);
  made.file.text = texts_of(made, scene, matrices.front().health);
  lattice::put_matrices(made.file, scene, matrices);
  options.keep_old(made.path);
  lattice::write_matrix(made.path, made.file);
  options.give_out(made, summary_table(made.file, made.path) + states_line(made.states) +
                             method_line(made.method));
  return status_of(options, matrices.front().health);
}

int build_bins(const Options& options, const lattice::Scene& scene,
               const lattice::BinsChoice& choice, const Settled& settled) {
  refuse(options, {"accuracy", "gate-runs", "starts", "start", "states"},
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

int build_tree(const Options& options, const lattice::Scene& scene, const Settled& settled) {
  refuse(options, {"first-trial"}, "for trees: --shard divides their trials");
  lattice::TreeOptions how = tree_options(options, scene);
  fix_trials(options, how.accuracy, std::max<std::int64_t>(1, std::ssize(how.starts)));
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
  warn_of(options, chain.own_trials);
  if (how.accuracy.trials) return status;
  if (chain.prediction) warn_of(options, *chain.prediction, how.accuracy.accuracy);
  if (chain.range && !chain.range->reached)
    options.warn("starts of the range need more runs than these for the accuracy asked for, " +
                 digits(how.accuracy.accuracy) + ": predict adds trials of their own");
  return status;
}

}  // namespace

int run_build(const Arguments& arguments) {
  Options options(
      "build SCENE|RUNS.csv -o MATRIX.nc [options]",
      "Makes the transition matrix of one gate. By default its states are the leaves of trees,\n"
      "grown over the gate runs of full trials from the scene's start (or --start, --starts)\n"
      "until predictions are as accurate as --accuracy says. With --bins paper it is the\n"
      "paper's: N short runs from each of Table III's 87 bins, counted by where they come out.",
      "gatewalk build scenes/field.toml --accuracy 0.02 --starts all -o chain.nc");
  options.scene();
  add_accuracy(options);
  options.add_count("trials", "N",
                    "bins: runs per input state (default: 100); tree: exactly so many full trials");
  options.add_first_trial();
  options.add_seed();
  options.add_kept({"building matrix", "full trials", "scattered trials"});
  options.add_strict();
  options.main_output_file("MATRIX.nc", "matrix file (NetCDF-4)", Options::Content::binary);
  add_bins(options);
  add_cell(options);
  add_cell_program(options);
  add_starts(options,
             "the scene's start; gatewalk validate takes those of Table IV in the paper's field; "
             "tree only: each is a state of its own");
  options.add_text(
      "starts", "all|D,VX,VY",
      "tree: good for any start of a range, LOW:HIGH each; all: Table III's from below");
  options.add_count("states", "S", "tree: at most S states beside the starts");
  if (!options.parse(arguments)) return kFine;
  if (has_cell(options)) return build_program(options);
  if (options.has("cell")) return build_recorded(options);
  lattice::Scene scene = options.read_scene();
  require_keepable(scene);
  const lattice::BinsChoice choice = bins_choice(options, scene, options.has("trials"));
  const bool tree = choice.kind == lattice::BinsChoice::Kind::tree;
  const auto settled = settle_method(options, scene, lattice::RunsFrom::everywhere);
  return tree ? build_tree(options, scene, settled) : build_bins(options, scene, choice, settled);
}

}  // namespace gatewalk::cli
