// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>

#include "cli/command.h"
#include "cli/render/work_precision.h"
#include "cli/terminal/interrupt.h"
#include "dynamics/base/work.h"
#include "lattice/scene/scene.h"
#include "lattice/scene/scene_keys.h"
#include "lattice/scene/settle.h"
#include "lattice/source/source.h"
#include "lattice/source/source_file.h"

namespace gatewalk::cli {
namespace {

constexpr std::int64_t kMostTrials =
    10'000'000;  // needs 2 GB, because the ends of four settings' trials are in memory at a time

std::string label_of(const std::string& path) {
  return std::filesystem::path(path).stem().string();
}

/// Throws for scenes that cannot be charted. To be called before long work.
void require_chartable(const Options& options, const std::vector<std::string>& paths) {
  std::set<std::string> labels;
  for (const std::string& path : paths) {
    const lattice::Scene scene =
        lattice::read_scene(options.file(path).toml(), options.overrides());
    try {
      dynamics::require_reference(scene.gate);
    } catch (const dynamics::InvalidParameter& e) {
      throw lattice::SceneError(path + ": no reference for a chart: " + e.what());
    }
    options.warn(lattice::terrain_without_effect(scene));
    if (!labels.insert(label_of(path)).second)
      throw UsageError("two scenes are called " + label_of(path));
  }
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  stream.exceptions(std::ios_base::badbit);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

/// The methods that --methods names; all charted methods without it. Throws UsageError.
std::vector<std::string> chosen_methods(const TextOption& given) {
  const auto known = dynamics::chart_methods();
  if (!given) return {known.begin(), known.end()};
  std::vector<std::string> methods = split(given.value());
  const std::string names = fmt::format("{}", fmt::join(known, ", "));
  if (methods.empty()) throw UsageError("--methods needs at least one of " + names);
  for (std::size_t i = 0; i < methods.size(); ++i) {
    if (std::find(known.begin(), known.end(), methods[i]) == known.end())
      throw UsageError(fmt::format("--methods: no method '{}'; there are {}", methods[i], names));
    if (std::find(methods.begin(), methods.begin() + static_cast<std::ptrdiff_t>(i), methods[i]) !=
        methods.begin() + static_cast<std::ptrdiff_t>(i))
      throw UsageError(fmt::format("--methods: {} stands there twice", methods[i]));
  }
  return methods;
}

}  // namespace

int run_chart_methods(const Arguments& arguments) {
  Options options(
      "chart methods SCENE... -o DIR [options]",
      "Shows which time-stepping method is fastest for an accuracy.\n"
      "chart methods measures the time per trial on one thread, and the error against a reference "
      "with\n"
      "the same noise, for several settings of each method. It writes chart.csv and chart.json "
      "after each\n"
      "scene, and chart.svg in the end. With 1e5 trials a scene takes about ten minutes; --trials "
      "2000\n"
      "--repeats 3 gives a first look in one.",
      "gatewalk chart methods scenes/field.toml scenes/stiff.toml -o results/chart --trials 1e4");
  const TextsOption scenes =
      options.positional_list("scene", "scene files (TOML); a scene is called by its file's name");
  const std::vector<std::string> files{"chart.csv", "chart.json", "chart.svg"};
  options.output_folder("folder to write to", files);
  const CountOption trials = options.add_count("trials", "N", "trials per setting", "1e5");
  const CountOption repeats =
      options.add_count("repeats", "N", "rounds of timing, after one round that warms up", "10");
  const TextOption methods =
      options.add_text("methods", "A,B,...", "methods to chart (default: all)");
  options.add_seed();
  options.add_strict();
  options.add_figure("the figure of the folder");
  options.add_details("every setting of each method, with its errors and times");
  options.most_used({"output", "trials", "repeats", "methods", "set"});
  if (!options.parse(arguments)) return kFine;
  dynamics::WorkPrecisionOptions how{.label = {},
                                     .methods = chosen_methods(methods),
                                     .trials = trials.value(1, kMostTrials),
                                     .rounds = repeats.value(),
                                     .seed = options.seed()};
  const std::vector<std::string> paths = scenes.values();
  require_chartable(options, paths);
  const ResultFolder folder(options, files);

  ChartResult result;
  const auto& charts = result.charts;
  try {
    for (const std::string& path : paths) {
      const lattice::Scene scene =
          lattice::read_scene(options.file(path).toml(), options.overrides());
      how.label = label_of(path);
      result.charts.push_back(
          dynamics::work_precision(scene.gate, scene.start, how, options.work()));
      result.made_by.push_back(options.provenance(scene));
      folder.write("chart.csv", csv_of(charts), "chart.json", result);
    }
  } catch (const Interrupted&) {
    if (charts.empty()) throw;
    folder.draw("chart.svg", figure_of(charts));
    options.warn(
        fmt::format("stopped before the end; {}, chart.json and chart.svg hold the {} of {} scenes "
                    "that were finished",
                    folder.path("chart.csv"), charts.size(), paths.size()));
    return kStopped;
  }
  options.give_out(result, {answer_text(charts), details_text(charts, how.rounds)});
  folder.draw("chart.svg", figure_of(charts));
  bool clean = true;
  for (const auto& chart : charts) {
    const auto verdict = chart.reference.verdict;
    if (verdict == dynamics::Verdict::fine) continue;
    clean = false;
    options.warn(chart.label +
                 ": the reference itself shows faults: " + std::string(dynamics::name_of(verdict)));
  }
  const int exit = exit_status(options, clean);
  options.draw([&] { return figure_of(charts); });
  return exit;
}

}  // namespace gatewalk::cli
