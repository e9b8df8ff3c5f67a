// SPDX-License-Identifier: MIT
#include "cli/fitted.h"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "cli/render/observed.h"
#include "lattice/cells/recorded_pool.h"

namespace gatewalk::cli {
namespace {

/// "best.toml" of draw 3 is "best-3.toml".
std::string file_of_draw(const std::string& path, std::int64_t draw) {
  const std::size_t dot = path.rfind('.'), slash = path.rfind('/');
  const std::size_t at =
      dot == path.npos || (slash != path.npos && dot < slash) ? path.size() : dot;
  return fmt::format("{}-{}{}", path.substr(0, at), draw, path.substr(at));
}

/// Endings that the table has no row of count as 0; empty if it has all.
std::string not_listed(const lattice::Observed& observed, const lattice::FieldParams& field) {
  std::string names;
  if (!observed.seen.has_endings()) return names;
  for (const lattice::EndingName& e : lattice::kEndingNames)
    if (!observed.listed[static_cast<std::size_t>(e.ending)] &&
        (e.ending != markov::Ending::cut_off || field.max_gates > 0))
      names += (names.empty() ? "" : ", ") + std::string(e.name);
  return names.empty() ? names : fmt::format("the counts do not list {}: taken as 0", names);
}

/// Throws UsageError for a number of a scene that changes nothing there.
void require_effect(const Ranged& ranged, lattice::RunsFrom from) {
  if (!ranged.scene) return;
  const std::vector<double> middle(ranged.ranges.size(), 0.5);
  for (const std::string& text : lattice::keys_without_effect(ranged.scene->at(middle), from))
    for (const lattice::NumberRange& r : ranged.ranges)
      if (text.starts_with(r.key + " ")) throw UsageError("--free " + text);
}

bool is_of_passages(const std::string& path) { return lattice::has_columns(path, {"in", "out"}); }

lattice::FitData of_passages(const Options& options, const Subject& s, const Ranged& ranged,
                             const lattice::ProblemAt& at, const std::string& path,
                             std::int64_t trials) {
  for (const lattice::NumberRange& r : ranged.ranges)
    if (r.key.starts_with("start.") || r.key.starts_with("field."))
      throw UsageError(
          fmt::format("--free {}: says nothing of passages, which begin as they were seen to, each "
                      "through one cell",
                      r.key));
  if (!s.cells || s.cells->start)
    refuse(options, {"start"}, "for passages, which begin as they were seen to");
  const auto numbers = static_cast<int>(ranged.ranges.size());
  lattice::CellFile cells =
      s.cells ? *s.cells : lattice::cells_of(at(std::vector<double>(ranged.ranges.size(), 0.5)));
  if (s.scene) cells.trapped_after = s.scene->gate.run.time_limit;
  const lattice::RecordedRuns runs =
      lattice::read_runs(path, cells, lattice::CostColumns::as_there_are);
  for (const std::string& text : runs.remarks) options.warn(path + ": " + text);
  const auto of_all = [&](std::int64_t some) {
    return fmt::format("{} of {} passages ", some, runs.passages.size());
  };
  if (runs.lost > 0)
    options.warn(of_all(runs.lost) +
                 "were lost and are left out: that is right if losing bodies has nothing to do "
                 "with how they get on");
  lattice::FitData data =
      lattice::passages_to_fit(lattice::entered_passages(runs), numbers, at, trials);
  if (data.inside > 0)
    options.warn(of_all(data.inside) +
                 "begin with the body well inside an obstacle of the scene: places in the table "
                 "are off, or obstacles in the scene");
  return data;
}

lattice::FitData of_trials(const Options& options, const lattice::Problem& problem,
                           const std::vector<std::string>& paths) {
  lattice::Observed observed = lattice::read_observed(paths, problem.field);
  for (const std::string& text : observed.remarks) options.warn(text);
  if (observed.seen.has_gates() && observed.seen.has_endings() &&
      observed.gates_by_ending[0].size() == 0) {
    options.warn(
        "the endings are left out: nothing says which of them belong to which final gates; "
        "lines of trials (trial,ending,gate_x,gate_y) tell both");
    observed.seen.endings = {};
  }
  options.warn(who_went_back(observed));
  options.warn(not_listed(observed, problem.field));
  lattice::FitData data = lattice::trials_to_fit(observed, problem);
  if (!observed.timed.empty() && data.outcomes.times.empty())
    options.warn("the times are all alike, or there are none: they tell nothing");
  return data;
}

}  // namespace

std::vector<std::string> files_of_draws(const Options& options, std::int64_t count) {
  std::vector<std::string> files, taken = options.files_read();
  const std::string path = options.text("output");
  if (path == "-" || std::filesystem::is_other(path))
    throw UsageError("--scenes: needs -o FILE.toml, beside which they are written");
  for (const char* output : {"json", "csv", "draws", "inference-data", "figure", "checkpoint"})
    if (options.has(output)) taken.push_back(options.text(output));
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

CellTypes types_in(const std::vector<std::string>& paths) {
  return is_of_passages(paths.front()) && lattice::has_columns(paths.front(), {"type"})
             ? CellTypes::all
             : CellTypes::of_the_map;
}

lattice::FitData data_to_fit(const Options& options, const Subject& s, const Ranged& ranged,
                             const lattice::ProblemAt& at, const std::vector<std::string>& paths,
                             std::int64_t trials) {
  const auto found = std::find_if(paths.begin(), paths.end(), is_of_passages);
  const bool passages = found != paths.end();
  if (passages && paths.size() > 1)
    throw UsageError(*found +
                     ": has passages, of which fit takes one file: gatewalk passages cuts "
                     "the tracks of several recordings into one");
  require_effect(ranged, passages ? lattice::RunsFrom::all_types : lattice::RunsFrom::everywhere);
  if (passages) return of_passages(options, s, ranged, at, *found, trials);
  return of_trials(options, at(std::vector<double>(ranged.ranges.size(), 0.5)), paths);
}

}  // namespace gatewalk::cli
