#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "cli/command.h"
#include "cli/film/replay.h"
#include "cli/film/video.h"
#include "cli/render/choice.h"
#include "cli/render/drawing.h"
#include "cli/render/quantity.h"
#include "cli/render/recording.h"
#include "cli/render/report.h"
#include "cli/terminal/interrupt.h"
#include "cli/terminal/output.h"
#include "cli/terminal/progress.h"

namespace gatewalk::cli {
namespace {

constexpr std::int64_t kMostRuns = 1000;       // kept
constexpr std::size_t kMostMoments = 500'000;  // of all runs together: with every output some 1 GB
constexpr std::size_t kMostLines = 20;         // of the table
constexpr std::int64_t kCheckedAs =
    500;  // trials: the few that are recorded would show nothing of a method

std::string table_of(const lattice::Scene& scene, const std::vector<Recording>& runs,
                     bool across_field) {
  const std::size_t shown = std::min(runs.size(), kMostLines);
  std::size_t longest_ending = 14;
  for (std::size_t i = 0; i < shown; ++i)
    longest_ending = std::max(longest_ending, runs[i].ending.size());
  const int ending_width = static_cast<int>(longest_ending) + 2;
  std::string text = scene_line(scene) + "   trial  " + padded("ending", -ending_width) +
                     "      time  steps   hits" + (across_field ? "  gates" : "") +
                     "        work        lost  of it in hits   left over\n";
  // One unit for all lines, so that they can be compared.
  const dynamics::Scale scale = dynamics::scale_of(scene.gate);
  double longest = 0.0, most = 0.0;
  for (const Recording& r : runs) {
    const dynamics::Energies& e = r.moments.back().energy;
    longest = std::max(longest, r.seconds);
    for (const double energy :
         {e.propulsion_work + e.random_work, e.lost, e.hit_loss, e.mechanical()})
      most = std::max(most, std::abs(energy));
  }
  const auto seconds = [&](double time) {
    return reading(time, "s", step_of(0.01 * scale.time, longest));
  };
  const auto joules = [&](double energy) {
    return reading(energy, "J", step_of(0.1 * scale.energy(), most));
  };
  for (std::size_t i = 0; i < shown; ++i) {
    const Recording& r = runs[i];
    const dynamics::Energies& e = r.moments.back().energy;
    text += padded(std::to_string(r.trial), 8) + "  " + padded(r.ending, -ending_width) +
            padded(seconds(r.seconds), 10) + padded(std::to_string(r.health.steps), 7) +
            padded(std::to_string(r.health.impacts), 7) +
            (across_field ? padded(std::to_string(r.gates), 7) : "") +
            padded(joules(e.propulsion_work + e.random_work), 12) + padded(joules(e.lost), 12) +
            padded(joules(e.hit_loss), 15) + padded(joules(e.mechanical()), 12) + "\n";
  }
  if (runs.size() > kMostLines)
    text += "   ... and " + std::to_string(runs.size() - kMostLines) + " more\n";
  return text;
}

/// `only` names one ending, or several by the words they begin with. Who has crossed has left the
/// field too.
bool fits(const std::string& ending, const std::string& only) {
  if (ending == "crossed" && fits("left field", only)) return true;
  return ending.starts_with(only) && (ending.size() == only.size() || ending[only.size()] == ' ');
}

}  // namespace

int run_trace(const std::vector<std::string>& arguments) {
  Options options("trace SCENE [options]",
                  "Records runs in full: every step of the method with positions, velocities, "
                  "beams, forces, contacts\n"
                  "and energies. A trial is the very same one as in `gatewalk gate` (with --field: "
                  "in `gatewalk lattice`)\n"
                  "of that seed and number. CSV and NetCDF have all of it; --replay makes a page "
                  "that plays the runs,\n"
                  "--video a film of the first one.",
                  "gatewalk trace scenes/soft_left.toml --trials 20 --only 'traversed left' "
                  "--replay runs.html --csv runs.csv");
  options.positional("scene", "scene file (TOML)", true);
  add_seed(options);
  add_strict(options);
  options.add()("trial", po::value<Count>()->default_value(Count{0}, "0")->value_name("I"),
                "number of the first trial")(
      "trials", po::value<Count>()->default_value(Count{1}, "1")->value_name("N"),
      "record trials I to I + N - 1")(
      "only", po::value<std::string>()->value_name("ENDING"),
      "keep the runs that end so, e.g. traversed, 'traversed left', trapped; with --field crossed, "
      "'left field' (over any side), trapped, 'cut off'")(
      "field", "cross the field, gate after gate, instead of one gate");
  options.output_file("csv", "FILE", "write all samples as CSV; - is standard output");
  options.output_file("netcdf", "FILE", "write all samples as NetCDF-4", Options::Content::binary);
  options.output_file("replay", "FILE.html", "write a page that plays the runs");
  options.output_file("video", "FILE.mp4|gif", "write a film of the first run (needs ffmpeg)",
                      Options::Content::binary);
  options.add()("video-speed", po::value<double>()->value_name("X"),
                "times as fast as real (default: the scene's own pace, 1 in the paper's scenes)");
  if (!options.parse(arguments)) return kFine;
  const bool to_stdout = options.text("csv") == "-" || options.text("replay") == "-";
  const bool across_field = options.has("field");
  const std::int64_t first = options.count("trial", 0), trials = options.count("trials");
  const std::string only = options.text("only");
  if (options.has("only")) {
    std::string known;
    bool found = false;
    for (const std::string& ending : endings(across_field)) {
      known += (known.empty() ? "" : ", ") + ending;
      found |= fits(ending, only);
    }
    if (!found) throw UsageError("--only '" + only + "': a run ends as one of: " + known);
  } else if (trials > kMostRuns) {
    throw UsageError("--trials " + std::to_string(trials) + ": at most " +
                     std::to_string(kMostRuns) + " runs are recorded; pick some with --only");
  }
  if (options.has("video")) {
    try {
      (void)video_format(options.text("video"));
    } catch (const std::invalid_argument& e) {
      throw UsageError(std::string("--video ") + e.what());
    }
  }
  lattice::Scene scene = lattice::read_scene(options.text("scene"), options.overrides());
  std::optional<double> speed;
  if (options.has("video-speed")) {
    speed = options.get<double>("video-speed");
    const double pace = dynamics::scale_of(scene.gate).time;
    if (!(*speed >= 0.01 * pace && *speed <= 100.0 * pace))
      throw UsageError("--video-speed: must lie in [" + digits(0.01 * pace) + ", " +
                       digits(100.0 * pace) + "]");
  }
  const Json settled = settle_method(
      options, scene, across_field ? lattice::RunsFrom::everywhere : lattice::RunsFrom::start);
  std::vector<Recording> runs;
  std::size_t moments = 0;
  dynamics::Health health;
  const auto too_long = [&](const std::string& what) {
    return UsageError(what + " more than " + std::to_string(kMostMoments) +
                      " steps, the most that are recorded; "
                      "give a longer run.step_s or a shorter run.time_limit_s" +
                      (across_field ? ", or fewer gates by field.max_gates" : ""));
  };
  run_in_batches("runs", trials, options.talk(), [&](std::int64_t from, std::int64_t n) {
    for (std::int64_t i = from; i < from + n; ++i) {
      if (interrupted()) throw Interrupted{};
      Recording r;
      try {
        r = record(scene, options.seed(), first + i, across_field, kMostMoments);
      } catch (const dynamics::TraceTooLong&) {
        throw too_long("trial " + std::to_string(first + i) + " alone has");
      }
      if (!only.empty() && !fits(r.ending, only)) continue;
      if (static_cast<std::int64_t>(runs.size()) == kMostRuns)
        throw UsageError("more than " + std::to_string(kMostRuns) +
                         " runs end so; ask for fewer --trials");
      moments += r.moments.size();
      if (moments > kMostMoments)
        throw too_long("trials " + std::to_string(first) + " to " + std::to_string(first + i) +
                       " have together");
      health += r.health;
      runs.push_back(std::move(r));
    }
  });
  if (runs.empty())
    throw std::runtime_error("none of trials " + std::to_string(first) + " to " +
                             std::to_string(first + trials - 1) + " ends '" + only +
                             "': nothing was written");

  lattice::check_outcomes(scene,
                          across_field ? lattice::RunsFrom::everywhere : lattice::RunsFrom::start,
                          options.seed(), std::max(trials, kCheckedAs), health, options.work());

  const bool wanted = options.has("replay") || options.has("video") || options.has("json");
  Json film = wanted ? film_of(scene, runs, across_field) : Json::object();
  const Json made_by = manifest(options, scene);
  if (options.has("csv")) write_text_atomically(options.text("csv"), csv_of(scene, runs));
  if (options.has("netcdf")) {
    std::vector<std::pair<std::string, std::string>> about;
    for (const auto& [key, value] : made_by.items())
      about.emplace_back(key, value.is_string() ? value.get<std::string>() : text_of(value, -1));
    write_text_atomically(options.text("netcdf"), netcdf_of(scene, runs, across_field, about));
  }
  if (options.has("replay")) write_text_atomically(options.text("replay"), replay_page(film));
  if (options.has("video"))
    write_video(options.text("video"), film, 0, {.speed = speed, .show_progress = options.talk()});
  if (options.has("json")) add_details(film, scene, runs);
  film["recorded"] = runs.size();
  film["trials"] = trials;
  if (!settled.is_null()) film["method"] = settled;
  film["status"] = to_json(health);
  film["made_by"] = made_by;
  options.give_out(film,
                   to_stdout ? "" : table_of(scene, runs, across_field) + method_line(settled), -1);
  if (!health.clean()) warn(complaint(health));
  return exit_status(options, health.clean());
}

}  // namespace gatewalk::cli
