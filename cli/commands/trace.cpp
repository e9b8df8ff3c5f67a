// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "cli/actions.h"
#include "cli/arguments.h"
#include "cli/exchange/policy_file.h"
#include "cli/fields/text.h"
#include "cli/film/replay.h"
#include "cli/film/video.h"
#include "cli/render/health.h"
#include "cli/render/recording.h"
#include "cli/web/embedded.h"
#include "lattice/scene/table4.h"

namespace gatewalk::cli {
namespace {

std::optional<double> video_speed(const Options& options, const lattice::Scene& scene) {
  if (!options.has("video-speed")) return std::nullopt;
  const double speed = options.number("video-speed");
  const double pace = dynamics::scale_of(scene.gate).time;
  if (!(speed >= 0.01 * pace && speed <= 100.0 * pace))
    throw UsageError(fmt::format("--video-speed: must lie in [{}, {}]", digits(0.01 * pace),
                                 digits(100.0 * pace)));
  return speed;
}

/// Throws UsageError that names the option where `check` refuses its value.
template <class Check>
void check_option(const Options& options, const char* name, Check check) try {
  if (options.has(name)) check(options.text(name));
} catch (const std::invalid_argument& e) {
  throw UsageError(fmt::format("--{} {}", name, e.what()));
}

/// What to record. Throws UsageError for values that no scene makes sense of.
lattice::RecordingOptions recording_options(const Options& options) {
  const lattice::RecordingOptions wanted{
      .seed = options.seed(),
      .first = options.count("trial", 0),
      .trials = options.trials(),
      .across_field = options.has("field") || options.has("policy"),
      .only = options.text("only"),
      .chosen = {}};
  check_option(options, "only", [&](const std::string& only) {
    lattice::require_ending(only, wanted.across_field);
  });
  if (!options.has("only") && wanted.trials > lattice::kMostRecordings)
    throw UsageError(fmt::format("--trials {}: at most {} runs are recorded; pick some with --only",
                                 wanted.trials, lattice::kMostRecordings));
  check_option(options, "replay", [](const std::string&) {
    if (!has_pages())
      throw std::invalid_argument(
          "needs pages: this gatewalk was built without (GATEWALK_PAGES=OFF)");
  });
  check_option(options, "video", [](const std::string& path) { (void)video_format(path); });
  return wanted;
}

}  // namespace

int run_trace(const Arguments& arguments) {
  Options options("trace SCENE [options]",
                  "Records runs in full: every step of the method with positions, velocities, "
                  "beams, forces, contacts\n"
                  "and energies. A trial is the very same one as in `gatewalk gate` (with --field: "
                  "in `gatewalk lattice`)\n"
                  "of that seed and number; with --policy as in `gatewalk lattice --policy`. CSV "
                  "and NetCDF have all of\n"
                  "it; --replay makes a page that plays the runs, --video a film of the first one.",
                  "gatewalk trace scenes/soft_left.toml --trials 20 --only 'traversed left' "
                  "--replay runs.html --csv runs.csv");
  options.scene();
  options.add_seed();
  options.add_strict();
  options.add_count("trial", "I", "number of the first trial", "0");
  options.add_count("trials", "N", "record trials I to I + N - 1", "1");
  options.add_text(
      "only", "ENDING",
      "keep the runs that end so, e.g. traversed, 'traversed left', trapped; with "
      "--field crossed, 'left side', 'right side', departed (any of these), trapped, 'cut off'");
  options.add_flag("field", "cross the field, gate after gate, instead of one gate");
  options.input_file("policy",
                     "cross the field and do what this file of gatewalk plan says (FILE.json)");
  options.output_file("csv", "FILE", "write all samples as CSV; - is standard output");
  options.output_file("netcdf", "FILE", "write all samples as NetCDF-4", Options::Content::binary);
  options.output_file("replay", "FILE.html", "write a page that plays the runs");
  options.output_file("video", "FILE.mp4|gif", "write a film of the first run (needs ffmpeg)",
                      Options::Content::binary);
  options.add_figure(fmt::format("the ways of up to {} runs", kMostDrawn));
  options.add_number(
      "video-speed", "X",
      "times as fast as real (default: the scene's own pace, 1 in the paper's scenes)");
  if (!options.parse(arguments)) return kFine;
  lattice::RecordingOptions wanted = recording_options(options);
  lattice::Scene scene = options.read_scene();
  const std::optional<double> speed = video_speed(options, scene);
  std::optional<lattice::Settled> settled;
  ActionMethods may_do;
  if (options.has("policy")) {
    Actions all = actions_of(options, scene, lattice::own_start(scene));
    std::vector<std::string> names = all.names();
    wanted.chosen =
        lattice::chosen_gates(names, std::move(all.scenes),
                              [policy = read_policy(options.text("policy"), all.made_for)](
                                  const lattice::Place& at, const dynamics::Entry& entry) {
                                return policy.action(at, entry);
                              });
    may_do = {std::move(names), std::move(all.methods)};
  } else {
    settled = settle_method(
        options, scene,
        wanted.across_field ? lattice::RunsFrom::everywhere : lattice::RunsFrom::start);
  }
  TraceResult result{.recordings = lattice::record_trials(scene, wanted, options.work()),
                     .method = settled,
                     .may_do = std::move(may_do),
                     .made_by = options.provenance(scene)};
  const lattice::Recordings& recordings = result.recordings;

  if (options.has("csv")) options.write(options.text("csv"), csv_of(recordings));
  if (options.has("netcdf"))
    options.write(options.text("netcdf"), netcdf_of(recordings, result.made_by));
  if (options.has("replay") || options.has("video") || options.has("json"))
    result.film = film_of(scene, recordings);
  if (options.has("replay")) options.write(options.text("replay"), replay_page(result.film));
  std::string film_line;
  if (options.has("video")) {
    const std::string file = options.text("video");
    options.keep_old(file);
    write_video(file, result.film, {.speed = speed}, options.work());
    result.film_speed = speed.value_or(dynamics::scale_of(scene.gate).time);
    film_line = fmt::format("{}: plays {}\n", file, speed_words(*result.film_speed));
  }
  const bool to_stdout = options.text("csv") == "-" || options.text("replay") == "-";
  options.give_out(result,
                   to_stdout ? ""
                             : table_of(scene, recordings) + method_line(result.method) +
                                   method_lines(result.may_do) + film_line,
                   -1);
  const int exit = status_of(options, recordings.health);
  options.draw([&] { return figure_of(scene, recordings); });
  return exit;
}

}  // namespace gatewalk::cli
