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
#include "cli/next.h"
#include "cli/render/health.h"
#include "cli/render/recording.h"
#include "cli/web/embedded.h"
#include "lattice/scene/table4.h"

namespace gatewalk::cli {
namespace {

struct TraceCommand : Options {
  using Options::Options;
  TextOption path = scene();
  Option seed_given = add_seed();
  Option strict = add_strict();
  CountOption trial = add_count("trial", "I", "number of the first trial", "0");
  CountOption trials = add_count("trials", "N", "record trials I to I + N - 1", "1");
  TextOption only = add_text(
      "only", "ENDING",
      "keep only the runs with this ending, e.g. traversed, 'traversed left', trapped; with "
      "--field crossed, 'left side', 'right side', departed (any of these), trapped, 'cut off'");
  Option across_field = add_flag("field", "cross the field, gate after gate, instead of one gate");
  TextOption policy = input_file(
      "policy", "cross the field and follow the policy in this file of gatewalk plan (FILE.json)");
  TextOption csv = output_file("csv", "FILE", "write all samples as CSV; - is standard output");
  TextOption netcdf =
      output_file("netcdf", "FILE", "write all samples as NetCDF-4", Options::Content::binary);
  TextOption replay = output_file("replay", "FILE.html", "write a page that plays the runs");
  TextOption video =
      output_file("video", "FILE.mp4|gif", "write a film of the first run (needs ffmpeg)",
                  Options::Content::binary);
  TextOption figure = add_figure(fmt::format("the paths of up to {} runs", kMostDrawn));
  NumberOption video_speed = add_number(
      "video-speed", "X",
      "play X times as fast as real time (default: the scene's own pace, 1 in the paper's "
      "scenes)");
};

std::optional<double> video_speed(const TraceCommand& options, const lattice::Scene& scene) {
  if (!options.video_speed) return std::nullopt;
  const double speed = options.video_speed.value();
  const double pace = dynamics::scale_of(scene.gate).time;
  if (!(speed >= 0.01 * pace && speed <= 100.0 * pace))
    throw UsageError(fmt::format("--video-speed: must lie in [{}, {}]", digits(0.01 * pace),
                                 digits(100.0 * pace)));
  return speed;
}

constexpr double kLongFilm = 30;  // s

/// How long a film of the first run plays (s).
double length_of(const Film& film, const std::optional<double>& speed) {
  const std::vector<FilmStep>& steps = film.runs.front().steps;
  return (steps.back().time - steps.front().time) /
         speed.value_or(dynamics::scale_of(film.gate).time);
}

/// Calls `check` and throws UsageError naming the option if its value is refused.
template <class Check>
void check_option(const TextOption& option, Check check) try {
  if (option) check(option.value());
} catch (const std::invalid_argument& e) {
  throw UsageError(fmt::format("--{} {}", option.name(), e.what()));
}

/// The options of the recording. Throws UsageError for values that fit no scene.
lattice::RecordingOptions recording_options(const TraceCommand& options) {
  const lattice::RecordingOptions wanted{.seed = options.seed(),
                                         .first = options.trial.value(0),
                                         .trials = options.trials.value(),
                                         .across_field = options.across_field || options.policy,
                                         .only = options.only.value(),
                                         .chosen = {}};
  check_option(options.only, [&](const std::string& only) {
    lattice::require_ending(only, wanted.across_field);
  });
  if (!options.only && wanted.trials > lattice::kMostRecordings)
    throw UsageError(fmt::format("--trials {}: at most {} runs are recorded; pick some with --only",
                                 wanted.trials, lattice::kMostRecordings));
  check_option(options.replay, [](const std::string&) {
    if (!has_pages())
      throw std::invalid_argument(
          "needs pages: this gatewalk was built without (GATEWALK_PAGES=OFF)");
  });
  check_option(options.video, [](const std::string& path) { (void)video_format(path); });
  return wanted;
}

std::vector<std::string> next_of(const TraceCommand& options, bool across_field) {
  NextCommands next(options);
  if (!options.replay)
    return next.again("replay", "runs.html", "plays the runs in a browser").lines();
  const std::string policy =
      options.policy ? " --policy " + shell_quoted(options.policy.value()) : "";
  return next.add(across_field ? "lattice" : "gate", "--trials 1000" + policy, "counts the endings")
      .lines();
}

}  // namespace

int run_trace(const Arguments& arguments) {
  TraceCommand options("trace SCENE [options]",
                       "Shows single runs: trace records every step with positions, velocities, "
                       "beams, forces, contacts\n"
                       "and energies. A run is the same as in gatewalk gate with this seed and "
                       "number (with --field or\n"
                       "--policy: as in gatewalk lattice). --replay writes a page that plays the "
                       "runs, --video a film of\n"
                       "the first run. CSV and NetCDF keep all steps.",
                       "gatewalk trace scenes/soft_left.toml --trials 20 --only 'traversed left' "
                       "--replay runs.html");
  options.add_details("more runs, what the columns mean, and the numbers of the scene");
  options.most_used({"field", "trials", "replay", "video", "csv"});
  if (!options.parse(arguments)) return kFine;
  lattice::RecordingOptions wanted = recording_options(options);
  lattice::Scene scene = options.read_scene();
  const std::optional<double> speed = video_speed(options, scene);
  std::optional<lattice::Settled> settled;
  ActionMethods may_do;
  if (options.policy) {
    Actions all = actions_of(options, scene, lattice::own_start(scene));
    std::vector<std::string> names = all.names();
    wanted.chosen =
        lattice::chosen_gates(names, std::move(all.scenes),
                              [policy = read_policy(options.policy.value(), all.made_for)](
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

  if (options.csv) options.write(options.csv.value(), csv_of(recordings));
  if (options.netcdf) options.write(options.netcdf.value(), netcdf_of(recordings, result.made_by));
  if (options.replay || options.video || options.json) result.film = film_of(scene, recordings);
  if (options.replay) options.write(options.replay.value(), replay_page(result.film));
  std::string film_line;
  if (options.video) {
    const std::string file = options.video.value();
    options.keep_old(file);
    if (const double seconds = length_of(result.film, speed); options.talk() && seconds > kLongFilm)
      options.warn(fmt::format(
          "{}: drawing a film of {} s takes long; a larger --video-speed makes a shorter film",
          file, fixed(seconds, 0)));
    write_video(file, result.film, {.speed = speed}, options.work());
    result.film_speed = speed.value_or(dynamics::scale_of(scene.gate).time);
    film_line = fmt::format("{}: film of run {}{}, plays {}\n", file, recordings.runs.front().trial,
                            recordings.runs.size() > 1 ? " (--trial N films run N)" : "",
                            speed_words(*result.film_speed));
  }
  const bool to_stdout = options.csv.value() == "-" || options.replay.value() == "-";
  options.give_out(
      result,
      to_stdout ? Screen(std::string())
                : Screen(answer_text(scene, recordings) + film_line + beware_of(recordings.health),
                         details_text(scene, recordings) + method_line(result.method) +
                             method_lines(result.may_do),
                         next_of(options, wanted.across_field)),
      -1);
  const int exit = status_of(options, recordings.health);
  options.draw([&] { return figure_of(scene, recordings); });
  return exit;
}

}  // namespace gatewalk::cli
