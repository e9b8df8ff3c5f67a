// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include "cli/arguments.h"
#include "cli/commands/recorded.h"
#include "cli/render/final_gates.h"
#include "cli/render/prediction.h"
#include "cli/subject.h"
#include "cli/validated.h"
#include "dynamics/base/work.h"
#include "lattice/cells/cell_matrix.h"

namespace gatewalk::cli {

int run_validate(const Arguments& arguments) {
  Options options(
      "validate SCENE [options]",
      "Compares the chain with the full dynamics: for the scene's start (in the paper's field the\n"
      "four of Table IV), or those given, the endings with 95 % intervals and one verdict on "
      "endings\n"
      "and final gates that counts chance in trials and matrix together; corrcoef, RMSE and total\n"
      "variation of walks and of the exact chain, each beside its noise floor; the time each "
      "takes.\n"
      "In JSON, trials_and_matrix is that verdict; p_values count chance in the trials (and\n"
      "walks) alone. Last it asks whether the gate before, the visit or the row tell more than\n"
      "the state. With --observed, counts of an experiment are held against both, and the\n"
      "smallest differences are said that so many trials could have shown. Of a matrix of\n"
      "recorded runs (in SCENE's place): does one half of the bodies predict the other?",
      "gatewalk validate scenes/field.toml --trials 10000 --json validation.json");
  options.scene();
  options.add_count("trials", "N",
                    "trials of the full dynamics per start (default: 100; with --observed 10000, "
                    "or 20 times as many as were observed)");
  options.add_seed();
  options.add_kept({"full dynamics", "force drawn anew"});
  options.add_strict();
  options.add_texts("observed", "FILE.csv",
                    "an experiment from this start, to hold against both: a line per trial, "
                    "trial,ending (crossed, left side, right side, trapped, cut off, or went back, "
                    "which the model does not have: left out) with or without gate_x,gate_y (the "
                    "final gate's i_x and i_y); or counts, gate_x,gate_y,count or ending,count, or "
                    "both; files with the same columns are added up");
  options.reads("observed", [](const std::string& file) { return file; });
  options.input_file("matrix", "matrix to validate; without it one is built from the scene");
  options.add_count("matrix-trials", "N",
                    "bins: runs per input state of the matrix that is built (default: 100)");
  add_accuracy(options);
  options.add_count("walks", "N", "walks per start (default: as many as trials)");
  options.add_count("null-draws", "N",
                    "draws behind each p-value (default: 999 to 9999, by the size of the work)");
  options.add_flag("memory",
                   "also run the trials with the random force drawn anew at every crossing");
  add_starts(options);
  add_bins(options);
  add_cell_program(options);
  options.add_figure(
      "final gates of dynamics and chain, and their difference; below them where bodies are 2 to 8 "
      "gates later (Chapman-Kolmogorov), and implied time scales; with --observed instead what was "
      "counted, with intervals, beside both");
  if (!options.parse(arguments)) return kFine;
  if (!has_cell(options) && lattice::is_of_cells(options.text("scene")))
    return validate_recorded(options);
  constexpr std::int64_t kMostNullDraws = 100'000;  // some 20 MB
  lattice::ValidationOptions how{.trials = options.has("trials") ? options.trials() : 100,
                                 .walks = {},
                                 .null_draws = {},
                                 .seed = options.seed(),
                                 .force_memory = options.has("memory"),
                                 .observed = {}};
  if (options.has("walks")) how.walks = options.count("walks");
  if (options.has("null-draws")) how.null_draws = options.count("null-draws", 1, kMostNullDraws);
  if (const auto starts = options.texts("start").size();
      options.has("figure") && starts > kMostValidated)
    throw UsageError(
        fmt::format("--figure: shows at most {} starts, these are {}", kMostValidated, starts));
  if (options.has("matrix")) {
    refuse(options, {"bins"}, "beside --matrix: that one has its states already");
    refuse(options, {"matrix-trials", "accuracy", "gate-runs"},
           "beside --matrix: that one is built already");
  }
  const dynamics::Stopwatch watch;
  Validated subject = validated(options);
  ValidateResult& result = subject.result;
  result.matrix.seconds = watch.seconds();
  if (const auto& observed = subject.observed) {
    how.observed = observed->seen;
    if (!options.has("trials")) how.trials = trials_beside(*observed);
  }
  result.validation = lattice::validate_chain(subject.problem, result.matrix.matrices,
                                              subject.starts, how, options.work());
  const lattice::Validation& v = result.validation;
  options.give_out(result, table_of(result));
  options.warn(text_of(v.left_out));
  for (const lattice::StartValidation& start : v.starts)
    options.warn(rest_warning(rest_of(start.exact), "by the chain "));
  if (subject.observed) options.warn(endings_not_listed(*subject.observed, v.starts.front()));
  const int exit = status_of(options, v.health);
  options.draw([&] {
    const lattice::StartValidation& first = v.starts.front();
    return first.observed ? figure_of(*first.observed, first, result.shown.field)
                          : figure_of(v, result.shown);
  });
  return exit;
}

}  // namespace gatewalk::cli
