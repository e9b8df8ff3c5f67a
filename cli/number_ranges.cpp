// SPDX-License-Identifier: MIT
#include "cli/number_ranges.h"

#include <fmt/core.h>

#include <memory>
#include <stdexcept>
#include <utility>

#include "cli/cells/program.h"
#include "lattice/scene/scene_problem.h"
#include "lattice/scene/table4.h"
#include "lattice/scene/terrain.h"
#include "lattice/source/source_file.h"

namespace gatewalk::cli {
namespace {

std::string parameter_of(const lattice::NumberRange& range) {
  return range.key.substr(lattice::kParameters.size());
}

/// The ranges given for parameters of a program. Throws UsageError for a parameter or value that
/// the program does not permit.
std::vector<lattice::NumberRange> ranges_in_program(const Options& options,
                                                    const lattice::Source& s,
                                                    const std::vector<std::string>& given,
                                                    const std::string& option) {
  const auto* const program = dynamic_cast<const ProgramCell*>(s.problem.cells.cells.front().get());
  if (program == nullptr)
    throw UsageError(option +
                     ": a cell is given, and numbers are those of a program, --cell-program");
  std::vector<lattice::NumberRange> ranges;
  for (const std::string& text : given) {
    const lattice::NumberRange range = lattice::range_in(text, option);
    const std::string origin = option + " " + text;
    if (!range.key.starts_with(lattice::kParameters))
      throw UsageError(
          fmt::format("{}: numbers of a program are {}KEY", origin, lattice::kParameters));
    for (const lattice::NumberRange& other : ranges)
      if (other.key == range.key)
        throw UsageError(fmt::format("{}: {} is varied already", origin, range.key));
    for (const std::string& set : options.overrides())
      if (set.starts_with(range.key + "="))
        throw UsageError(
            fmt::format("--set {} has no effect: {} is varied ({})", set, range.key, origin));
    for (const double end : {range.low, range.high}) try {
        (void)program->with({{parameter_of(range), end}});
      } catch (const std::invalid_argument& e) {
        throw UsageError(origin + ": " + e.what());
      }
    ranges.push_back(range);
  }
  return ranges;
}

/// The problem whose cells have the program's parameters at a point of the ranges.
lattice::Problem program_at(const NumberRanges& ranges, const lattice::Source& s,
                            const std::vector<double>& point) {
  std::vector<dynamics::Cell::Number> numbers;
  for (std::size_t k = 0; k < point.size(); ++k)
    numbers.push_back({parameter_of(ranges.each[k]), ranges.each[k].at(point[k])});
  lattice::Problem problem = s.problem;
  problem.cells.cells = {
      dynamic_cast<const ProgramCell&>(*s.problem.cells.cells.front()).with(numbers)};
  return problem;
}

}  // namespace

std::optional<NumberRanges> ranges_of(const Options& options, const lattice::Source& s,
                                      const TextsOption& option, int most) {
  const auto given = option.values();
  const std::string shown = "--" + option.name();
  if (given.empty()) return {};
  if (s.file || s.is_recorded())
    throw UsageError(
        fmt::format("{}: is for a scene, or a program's cells, whose numbers vary; {} is a matrix",
                    shown, s.path));
  if (std::ssize(given) > most)
    throw UsageError(fmt::format("{}: at most {} numbers can vary", shown, most));
  if (!s.scene) return NumberRanges{ranges_in_program(options, s, given, shown)};
  lattice::RangedScene scene(options.file(s.path).toml(), options.overrides(), given, shown);
  for (const lattice::NumberRange& r : scene.ranges()) {
    if (s.starts_given && r.key.starts_with("start."))
      throw UsageError(
          fmt::format("{} {}: varies the scene's start, and --start gives another", shown, r.key));
    if (s.scene->gate.run.method == "auto" && r.key.starts_with("run."))
      throw UsageError(fmt::format(
          "{} {}: varies what run.method = \"auto\" chooses; name a method", shown, r.key));
  }
  return NumberRanges{scene.ranges(), std::move(scene)};
}

lattice::Scene scene_at(const NumberRanges& ranges, const lattice::Source& s,
                        const std::vector<double>& point) {
  lattice::Scene scene = ranges.scene->at(point);
  if (s.pilot) {
    const dynamics::RunParams& chosen = s.scene->gate.run;
    scene.gate.run.method = chosen.method;
    scene.gate.run.step = chosen.step;
    scene.gate.run.event_tolerance = chosen.event_tolerance;
  }
  if (s.starts_given) {
    scene.start = dynamics::entry_state(scene.gate, *s.starts.front());
  }
  return scene;
}

lattice::ProblemAt problem_at(const NumberRanges& ranges, const lattice::Source& s,
                              CellTypes types) {
  return [&ranges, &s, types](const std::vector<double>& point) {
    if (!ranges.scene) return program_at(ranges, s, point);
    lattice::Scene scene = scene_at(ranges, s, point);
    const auto from =
        types == CellTypes::all ? lattice::RunsFrom::all_types : lattice::RunsFrom::everywhere;
    lattice::Problem problem = lattice::problem_without_cells(scene, from);
    if (scene.gate.run.method != "auto") lattice::put_cells(problem, scene, from);
    return problem;  // has no cells while the method is still to be chosen
  };
}

}  // namespace gatewalk::cli
