// SPDX-License-Identifier: MIT
#include "cli/render/fit.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "cli/arguments.h"
#include "cli/next.h"
#include "cli/number_ranges.h"
#include "cli/render/health.h"
#include "cli/render/observed.h"
#include "cli/source_options.h"
#include "lattice/recorded/recorded_pool.h"
#include "lattice/scene/scene_keys.h"
#include "lattice/study/fit_data.h"

namespace gatewalk::cli {
namespace {

struct FitCommand : Options {
  using Options::Options;
  TextOption path = scene();
  TextsOption counts = positional_list(
      "counts",
      "the experiment (CSV): gate_x,gate_y,count; or ending,count; or a line per trial, "
      "trial,ending,gate_x,gate_y, also with time_s; or passages, runs.csv. Files with the same "
      "columns are added up");
  TextsOption free = add_varied(
      "free", "KEY=LOW:HIGH",
      fmt::format(
          "a number to find, of the scene or of the program, and its range (at most {}; may be "
          "repeated)",
          lattice::kMostFitted));
  CountOption trials =
      add_count("trials", "N",
                fmt::format("simulate N trials, or passages, in all; {} or more for each number",
                            lattice::least_trials_of_fit(1)),
                "400000");
  TextsOption start =
      add_texts("start", "D,VX,VY", "where bodies started (default: the scene's start)");
  Option seed_given = add_seed();
  AskedProgram program = add_cell_program(*this);
  TextOption output =
      output_file("output", "FILE.toml", "write the scene in which the counts are likeliest");
  CountOption scenes = add_count(
      "scenes", "N",
      "with -o FILE.toml, also write N scenes drawn from the posterior, FILE-1.toml, ...");
  TextOption draws =
      output_file("draws", "FILE.csv", "write the draws from the posterior, a line each");
  TextOption inference_data =
      output_file("inference-data", "FILE.nc", "write the posterior as InferenceData, for ArviZ",
                  Options::Content::binary);
  TextOption checkpoint = add_kept();
  Option strict = add_strict();
  TextOption figure = add_figure("the posterior of each number and of each pair");
};

constexpr int kMostScenes = 1000;

/// The file of a draw beside the file of -o: draw 3 beside "best.toml" is "best-3.toml".
std::string file_of_draw(const std::string& path, std::int64_t draw) {
  const std::size_t dot = path.rfind('.'), slash = path.rfind('/');
  const std::size_t at =
      dot == path.npos || (slash != path.npos && dot < slash) ? path.size() : dot;
  return fmt::format("{}-{}{}", path.substr(0, at), draw, path.substr(at));
}

/// The files of `count` scenes beside the file of -o: "best-1.toml", ... Throws UsageError if one
/// of them is an input or another output of the command.
std::vector<std::string> files_of_draws(const FitCommand& options, std::int64_t count) {
  std::vector<std::string> files, taken = options.files_read();
  const std::string path = options.output.value();
  if (path == "-" || std::filesystem::is_other(path))
    throw UsageError("--scenes: needs -o FILE.toml, beside which they are written");
  for (const TextOption& output : {options.json, options.csv, options.draws, options.inference_data,
                                   options.figure, options.checkpoint})
    if (output) taken.push_back(output.value());
  for (std::int64_t draw = 1; draw <= count; ++draw) {
    files.push_back(file_of_draw(path, draw));
    for (const std::string& other : taken)
      if (std::filesystem::weakly_canonical(other) ==
          std::filesystem::weakly_canonical(files.back()))
        throw UsageError(fmt::format("--scenes: would write {}, which is read, or another output",
                                     files.back()));
  }
  return files;
}

bool is_of_passages(const std::string& path) { return lattice::has_columns(path, {"in", "out"}); }

/// The types of cells that a table of passages names; else those of the map.
CellTypes types_in(const std::vector<std::string>& paths) {
  return is_of_passages(paths.front()) && lattice::has_columns(paths.front(), {"type"})
             ? CellTypes::all
             : CellTypes::of_the_map;
}

/// Throws UsageError if a number has no effect in the scene.
void require_effect(const NumberRanges& ranges, lattice::RunsFrom from) {
  if (!ranges.scene) return;
  const std::vector<double> middle(ranges.each.size(), 0.5);
  for (const std::string& text : lattice::keys_without_effect(ranges.scene->at(middle), from))
    for (const lattice::NumberRange& r : ranges.each)
      if (text.starts_with(r.key + " ")) throw UsageError("--free " + text);
}

lattice::FitData of_passages(const FitCommand& options, const lattice::Source& s,
                             const NumberRanges& ranges, const lattice::ProblemAt& at,
                             const std::string& path, std::int64_t trials) {
  for (const lattice::NumberRange& r : ranges.each)
    if (r.key.starts_with("start.") || r.key.starts_with("field."))
      throw UsageError(
          fmt::format("--free {}: says nothing of passages, which begin as they were seen to, each "
                      "through one cell",
                      r.key));
  if (!s.cells || s.cells->start)
    refuse({options.start}, "for passages, which begin as they were seen to");
  const auto numbers = static_cast<int>(ranges.each.size());
  lattice::CellFile cells =
      s.cells ? *s.cells : lattice::cells_of(at(std::vector<double>(ranges.each.size(), 0.5)));
  if (s.scene) cells.trapped_after = s.scene->gate.run.time_limit;
  const lattice::RecordedRuns runs =
      lattice::read_runs(path, cells, lattice::CostColumns::as_there_are);
  for (const std::string& text : runs.remarks) options.warn(path + ": " + text);
  const auto of_all = [&](std::int64_t some) {
    return fmt::format("{} of {} passages ", some, runs.passages.size());
  };
  if (runs.lost > 0)
    options.warn(of_all(runs.lost) +
                 "were lost and are left out; this biases nothing if losses are independent of the "
                 "motion");
  lattice::FitData data =
      lattice::passages_to_fit(lattice::entered_passages(runs), numbers, at, trials);
  if (data.inside > 0)
    options.warn(of_all(data.inside) +
                 "begin with the body deep inside an obstacle: check the places and the scene");
  return data;
}

/// A remark on the endings that the table does not list, which count as 0; empty if it lists all.
std::string not_listed(const lattice::Observed& observed, const lattice::FieldParams& field) {
  std::string names;
  if (!observed.seen.has_endings()) return names;
  for (const lattice::EndingName& e : lattice::kEndingNames)
    if (!observed.listed[static_cast<std::size_t>(e.ending)] &&
        (e.ending != markov::Ending::cut_off || field.max_gates > 0))
      names += (names.empty() ? "" : ", ") + std::string(e.name);
  return names.empty() ? names : fmt::format("the counts do not list {}: taken as 0", names);
}

lattice::FitData of_trials(const FitCommand& options, const lattice::Problem& problem,
                           const std::vector<std::string>& paths) {
  lattice::Observed observed = lattice::read_observed(paths, problem.field);
  for (const std::string& text : observed.remarks) options.warn(text);
  if (observed.seen.has_gates() && observed.seen.has_endings() &&
      observed.gates_by_ending[0].size() == 0) {
    options.warn(
        "the endings are left out: nothing says which of them belong to which final gates; give "
        "lines of trials (trial,ending,gate_x,gate_y)");
    observed.seen.endings = {};
  }
  options.warn(who_went_back(observed));
  options.warn(not_listed(observed, problem.field));
  lattice::FitData data = lattice::trials_to_fit(observed, problem);
  if (!observed.timed.empty() && data.outcomes.times.empty())
    options.warn("the times are all equal, or missing, and tell nothing");
  return data;
}

/// The observations in tables of counts or trials (lattice::read_observed), or in a table of
/// passages. Warns of what is left out. `at` needs the cell types of types_in(paths). Throws
/// UsageError and std::invalid_argument.
lattice::FitData data_to_fit(const FitCommand& options, const lattice::Source& s,
                             const NumberRanges& ranges, const lattice::ProblemAt& at,
                             const std::vector<std::string>& paths, std::int64_t trials) {
  const auto found = std::find_if(paths.begin(), paths.end(), is_of_passages);
  const bool passages = found != paths.end();
  if (passages && paths.size() > 1)
    throw UsageError(*found +
                     ": has passages, of which fit takes one file: gatewalk passages cuts "
                     "the tracks of several recordings into one");
  require_effect(ranges, passages ? lattice::RunsFrom::all_types : lattice::RunsFrom::everywhere);
  if (passages) return of_passages(options, s, ranges, at, *found, trials);
  return of_trials(options, at(std::vector<double>(ranges.each.size(), 0.5)), paths);
}

std::vector<double> point_of(const Eigen::MatrixXd& draws, Eigen::Index draw) {
  return {draws.row(draw).begin(), draws.row(draw).end()};
}

std::vector<std::string> next_of(const FitCommand& options, const FittedScene& fitted) {
  NextCommands next(options);
  const std::string output = options.output.value();
  if (!output.empty() && output != "-")
    return {"gatewalk predict " + shell_quoted(output) + "  # predicts with the fitted numbers"};
  if (fitted.fit.p >= 0.01 && !options.program.command && !options.cell())
    next.again("output", "best.toml", "writes the best scene");
  return next.again("figure", "fit.svg", "draws the posterior").lines();
}

}  // namespace

int run_fit(const Arguments& arguments) {
  FitCommand options(
      "fit SCENE SEEN.csv [MORE.csv ...] --free KEY=LOW:HIGH [options]",
      "Finds which values of a scene's numbers explain an experiment. fit gives the posterior "
      "of each\n"
      "number, if all values of its range are equally likely before. It simulates full trials at "
      "points\n"
      "of the ranges, with more points where the counts are likely.\n"
      "The counts have the columns of validate --observed, and belong to one start. Lines of "
      "trials may\n"
      "have time_s, the time at which a body left the field. Recorded passages (runs.csv) are "
      "simulated\n"
      "from where each one began. Of cells of a program, fit finds numbers of the program:\n"
      "parameters.KEY.",
      "gatewalk sample observed -o counts.csv\n"
      "  gatewalk fit scenes/field.toml counts.csv --free forces.propulsion_N=5:9");
  options.add_details("the search, the checks of the posterior, and the time-stepping method");
  options.most_used({"free", "output", "trials", "figure", "json"});
  if (!options.parse(arguments)) return kFine;
  lattice::Source s = field_to_run(
      options, {.path = options.path, .program = options.program, .starts = options.start},
      "what was seen is");
  const auto ranges = ranges_of(options, s, options.free, lattice::kMostFitted);
  if (!ranges) throw UsageError("--free KEY=LOW:HIGH says which numbers are to be found: give one");
  const auto numbers = static_cast<int>(ranges->each.size());
  const std::vector<std::string> seen = options.counts.values();
  if (!ranges->scene && options.output)
    throw UsageError("-o: writes scenes of gates; a program's numbers are given by --set");
  const lattice::FitOptions how{
      .trials = options.trials.value(lattice::least_trials_of_fit(numbers)),
      .seed = options.seed()};
  if (options.scenes && !options.output)
    throw UsageError("--scenes: needs -o FILE.toml, beside which they are written");
  std::vector<std::string> scenes;
  if (options.scenes) scenes = files_of_draws(options, options.scenes.value(1, kMostScenes));
  const lattice::ProblemAt at = problem_at(*ranges, s, types_in(seen));
  const lattice::FitData data = data_to_fit(options, s, *ranges, at, seen, how.trials);
  choose_method(options, s);
  const FittedScene fitted{ranges->each, s.problem.field, lattice::settled_of(s),
                           lattice::fit(numbers, at, data, how, options.work()),
                           options.provenance(s)};
  const lattice::Fit& fit = fitted.fit;
  options.give_out(fitted, {answer_text(fitted) + beware_of(fit.health), details_text(fitted),
                            next_of(options, fitted)});
  if (options.draws) options.write(options.draws.value(), draws_csv(fitted));
  if (options.inference_data) options.write(options.inference_data.value(), inference_data(fitted));
  if (const std::string path = options.output.value(); !path.empty()) {
    options.write(path, lattice::scene_file(scene_at(*ranges, s, point_of(fit.draws, fit.best))));
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      const auto draw =
          (2 * static_cast<Eigen::Index>(i) + 1) * fit.draws.rows() / (2 * std::ssize(scenes));
      options.write(scenes[i],
                    lattice::scene_file(scene_at(*ranges, s, point_of(fit.draws, draw))));
    }
  }
  for (const std::string& warning : warnings_of(fitted)) options.warn(warning);
  (void)status_of(options, fit.health);
  options.draw([&] { return figure_of(fitted); });
  return exit_status(options, is_clean(fitted));
}

}  // namespace gatewalk::cli
