// SPDX-License-Identifier: MIT
#include "cli/arguments.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <utility>

#include "cli/loaded_matrix.h"
#include "cli/render/choice.h"
#include "cli/render/health.h"
#include "cli/render/matrix.h"
#include "cli/render/meaning.h"
#include "cli/render/start.h"
#include "cli/render/text.h"
#include "cli/subject.h"
#include "dynamics/base/work.h"
#include "lattice/pool/pool_runner.h"
#include "lattice/scene/units.h"
#include "lattice/text/digits.h"

namespace gatewalk::cli {
void add_starts(Options& options, const std::string& by_default) {
  const std::string help = fmt::format(
      "start at x = D m, y = 0 with this velocity in m/s (may be repeated; default: {})",
      by_default);
  options.add_texts("start", "D,VX,VY", help);
}

std::vector<lattice::PaperStart> given_starts(const Options& options) {
  std::vector<lattice::PaperStart> starts;
  for (const std::string& text : options.texts("start"))
    starts.push_back(
        lattice::start_at(*parse_start(text, dynamics::disc_section(), StartsFrom::first_face)));
  return starts;
}

std::vector<lattice::PaperStart> starts_of(const Options& options, const lattice::Scene& scene) {
  return options.has("start") ? given_starts(options) : lattice::usual_starts(scene);
}

void add_bins(Options& options) {
  options.add_text(
      "bins", "paper|FACTOR|auto|tree",
      "the chain's states: tree: grown over the entries that full trials make, until --accuracy is "
      "reached; paper: Table III's, in the scene's own units; FACTOR: these with so many times the "
      "bins per axis (2 makes 696 states, 0.5 makes 23); auto: bins at the quantiles of what "
      "bodies do in a pilot. Default: the scene's table [bins], else tree; with runs per state "
      "asked for: paper where the gate has the paper's proportions and these bins resolve what "
      "bodies do, else auto");
}

lattice::BinsChoice bins_choice(const Options& options, const lattice::Scene& scene,
                                bool runs_per_state) {
  using Kind = lattice::BinsChoice::Kind;
  if (!options.has("bins"))
    return scene.bins || runs_per_state ? lattice::usual_bins(scene)
                                        : lattice::BinsChoice{Kind::tree};
  const std::string text = options.text("bins");
  if (scene.bins)
    throw UsageError(
        fmt::format("--bins {}: the scene has a table [bins], which says what the bins are; leave "
                    "out one of both",
                    text));
  if (text == "auto") return {Kind::automatic};
  if (text == "paper") return {Kind::paper};
  if (text == "tree") return {Kind::tree};
  lattice::BinsChoice choice;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, choice.factor);
  if (read.ec != std::errc() || read.ptr != end)
    throw UsageError(
        fmt::format("--bins {}: must be paper, tree, auto, or a factor > 0 such as 2", text));
  (void)dynamics::refined(dynamics::table3_space(scene.gate),
                          choice.factor);  // refuses other factors
  return choice;
}

void add_accuracy(Options& options, const std::string& by_default) {
  options.add_number(
      "accuracy", "A",
      fmt::format(
          "trials are added until the final gates are right within a total variation of A, 95 "
          "times in 100 (0.02: of 100 bodies 2 end in another gate than said; default: {})",
          by_default));
  options.add_count("gate-runs", "N", "but not many more gate runs than N, whatever the accuracy");
}

lattice::AccuracyOptions accuracy_of(const Options& options) {
  lattice::AccuracyOptions how;
  if (options.has("accuracy")) how.accuracy = options.number("accuracy");
  if (!(how.accuracy > 0.0 && how.accuracy < 1.0))
    throw UsageError(
        fmt::format("--accuracy {}: must lie between 0 and 1, such as 0.01", digits(how.accuracy)));
  if (options.has("gate-runs")) how.most_runs = options.count("gate-runs");
  how.seed = options.seed();
  return how;
}

void fix_trials(const Options& options, lattice::AccuracyOptions& how, std::int64_t starts) {
  if (options.has("trials")) {
    refuse(options, {"gate-runs", "accuracy"}, "beside --trials");
    how.trials = options.count("trials", lattice::PoolRunner::kLeastTrials * starts);
    if (*how.trials % starts != 0)
      throw UsageError(fmt::format("--trials {}: must be so many for each of {} starts alike",
                                   *how.trials, starts));
  } else if (options.has("shard")) {
    throw UsageError(
        "--shard of trees needs --trials N: a part must know how many there are in all");
  }
}

void warn_of(const Options& options, const std::optional<lattice::HausmanCheck>& own) {
  if (own && own->differs())
    options.warn(fmt::format(
        "the full trials end otherwise than their chain says: {} in total variation of the final "
        "gates, where chance makes {} ({}). Bodies may remember more from gate to gate than the "
        "states hold: trust gatewalk lattice",
        fixed(own->total_variation, 4), fixed(own->chance_total_variation, 4), p_words(own->p)));
}

void warn_of(const Options& options, const lattice::PooledPrediction& prediction, double accuracy) {
  warn_of(options, prediction.hausman_check);
  if (prediction.reached) return;
  double worst = 0.0;
  for (const lattice::StartAnswer& a : prediction.starts)
    worst = std::max(worst, a.error.total_variation);
  options.warn(fmt::format("the accuracy asked for, {}, was not reached: the error bar is {}",
                           digits(accuracy), fixed(worst, 4)));
}

std::optional<lattice::StartRange> range_of(const Options& options, const lattice::Scene& scene) {
  if (!options.has("starts")) return std::nullopt;
  const std::string text = options.text("starts");
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

lattice::TreeOptions tree_options(const Options& options, const lattice::Scene& scene) {
  lattice::TreeOptions how{.accuracy = accuracy_of(options)};
  how.range = range_of(options, scene);
  if (options.has("states"))
    how.most_states = static_cast<int>(options.count("states", 1, dynamics::kMostStates));
  for (const lattice::PaperStart& s : given_starts(options)) how.starts.push_back(s.entry());
  lattice::require_inside(given_starts(options), scene);
  if (how.starts.empty() && !how.range) how.starts = {lattice::own_start(scene).entry()};
  if (scene.field.fidelity != lattice::Fidelity::active)
    options.warn(fmt::format(
        "field.fidelity = \"{}\" is of the full dynamics: a chain always has \"active\"",
        lattice::name_of(scene.field.fidelity)));
  return how;
}

namespace {

/// Of a matrix of trees; none of another one.
std::optional<TreeRecord> recorded_trees(const lattice::MatrixFile& file, const std::string& path) {
  const auto states = recorded_states(file, path);
  return states ? states->trees : std::nullopt;
}

}  // namespace

double accuracy_of(const lattice::MatrixFile& file, const std::string& path) {
  const auto trees = recorded_trees(file, path);
  if (!trees || !trees->accuracy) return lattice::AccuracyOptions{}.accuracy;
  return *trees->accuracy * (trees->range ? lattice::kPartForOne : 1.0);
}

void warn_of_range(const Options& options, const lattice::MatrixFile& file, const std::string& path,
                   const std::vector<dynamics::Entry>& starts) {
  const auto trees = recorded_trees(file, path);
  if (!trees || !trees->range) return;
  const auto& coordinates = file.transitions.space.section().coordinates;
  const auto& own = file.transitions.space.points();
  dynamics::StateRange built = trees->range->range;
  built.face = starts.empty() ? 0 : starts.front().face;
  const auto count = std::count_if(starts.begin(), starts.end(), [&](const dynamics::Entry& entry) {
    if (std::find(own.begin(), own.end(), entry) != own.end()) return false;
    for (std::size_t axis = 0; axis < coordinates.size(); ++axis)
      if (entry.at[axis] < built.at[axis][0] || entry.at[axis] > built.at[axis][1]) return true;
    return false;
  });
  if (count > 0)
    options.warn(fmt::format("{} outside the range that {} was built for: {}",
                             counted(count, "start lies", "starts lie"), path,
                             text_of(file.transitions.space.section(), built)));
}

int entries_per_leaf(const lattice::MatrixFile& file, const std::string& path) {
  return recorded_trees(file, path).value_or(TreeRecord()).entries_per_leaf;
}

void add_starts_to(lattice::SceneMatrix& m, const std::string& path, const Options& options,
                   const std::vector<dynamics::Entry>& starts) {
  if (!lattice::has_runs(*m.file)) return;
  warn_of_range(options, *m.file, path, starts);
  const lattice::Problem problem = lattice::problem_of(m.scene);
  lattice::RunPool pool = lattice::pool_of(*m.file, problem, path);
  std::vector<dynamics::Entry> unknown;
  for (const dynamics::Entry& entry : starts)
    if (pool.place_of(entry) == pool.starts.size()) unknown.push_back(entry);
  if (unknown.empty()) return;
  lattice::AccuracyOptions how;
  how.accuracy = accuracy_of(*m.file, path);
  how.most_runs = std::max<std::int64_t>(100'000, pool.gate_runs());
  how.per_leaf = entries_per_leaf(*m.file, path);
  how.seed = options.seed();
  const auto prediction = lattice::predict_pooled(problem, pool, unknown, how, options.work());
  options.remark(
      fmt::format("{} gate runs from starts that {} does not know", prediction.gate_runs, path));
  options.warn(complaint(prediction.health));
  warn_of(options, prediction, how.accuracy);
  std::vector<dynamics::Entry> all;
  for (const lattice::OwnRuns& s : pool.starts) all.push_back(s.start);
  lattice::MatrixFile file = *m.file;
  dynamics::Health health = file.transitions.health;
  health += prediction.health;
  lattice::put_matrices(file, m.scene, lattice::matrices_of(problem, pool, all, how.per_leaf));
  file.transitions.health = health;
  m.file = std::make_shared<const lattice::MatrixFile>(std::move(file));
}

void require_active(const Options& options, const lattice::Scene& scene) {
  if (scene.field.fidelity == lattice::Fidelity::active) return;
  const std::string key = "field.fidelity",
                    value = fmt::format(" = \"{}\"", lattice::name_of(scene.field.fidelity));
  const auto overrides = options.overrides();
  const bool is_set = std::any_of(overrides.begin(), overrides.end(), [&](const std::string& o) {
    const auto keys = lattice::keys_set_by(o);
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  });
  if (options.has("matrix") && options.file(options.text("matrix")).is_matrix() &&
      options.text("scene").empty() && !is_set) {
    options.warn(
        fmt::format("{} (its scene): {}{} is of the full dynamics: a chain always has \"active\"",
                    options.text("matrix"), key, value));
    return;
  }
  const auto given = scene.named.find(key);
  throw UsageError(fmt::format(
      "{}: {}{} is not permitted for a chain: it has \"active\", gatewalk lattice the others",
      given == scene.named.end() ? scene.source : given->second, key, value));
}

namespace {

/// Whether the scene is given a push, or compared with others of another push.
bool is_about_push(const Options& options, const lattice::Scene& scene) {
  const std::string push = "forces.propulsion_N";
  if (scene.named.contains(push)) return true;
  for (const char* option : {"free", "over", "versus"})
    if (options.has(option))
      for (const std::string& text : options.texts(option))
        if (lattice::known_key(text.substr(0, text.find('=')), "--" + std::string(option)) == push)
          return true;
  return false;
}

}  // namespace

std::optional<lattice::Settled> settle_method(const Options& options, lattice::Scene& scene,
                                              lattice::RunsFrom from) {
  for (const std::string& text : lattice::keys_without_effect(scene, from)) options.warn(text);
  if (options.talk()) {
    options.warn(lattice::derived_keys(scene));
    if (is_about_push(options, scene)) options.warn(lattice::push_is_followed(scene));
    options.warn(far_from_walkers_line(scene));
  }
  auto settled = lattice::settle_method(scene, from, options.seed(), options.work());
  if (settled) options.warn(complaint(*settled));
  return settled;
}

lattice::States states_of(const Options& options, const lattice::Scene& scene,
                          const lattice::BinsChoice& choice,
                          const std::vector<dynamics::BodyState>& starts) {
  lattice::States states =
      lattice::states_of(scene, choice, starts, options.seed(), options.work());
  if (states.replaced)
    options.warn(
        "Table III's bins do not resolve how bodies move in this scene; takes --bins auto");
  return states;
}

lattice::SceneMatrix read_matrix(const Options& options) {
  return read_matrix(options, options.text("matrix"), options.text("scene"), options.overrides());
}

lattice::SceneMatrix read_matrix(const Options& options, const std::string& matrix_path,
                                 const std::string& scene_path,
                                 const std::vector<std::string>& overrides) {
  const LoadedMatrix* const loaded = options.loaded(matrix_path);
  const lattice::TomlFile* const other = scene_path.empty() ? nullptr : &options.file(scene_path);
  lattice::SceneMatrix m =
      loaded && loaded->scene
          ? lattice::scene_matrix(loaded->file, *loaded->scene, matrix_path, other, overrides)
          : lattice::read_scene_matrix(matrix_path, other, overrides);
  if (!scene_path.empty())  // a matrix's own scene names every key
    for (const std::string& text :
         lattice::keys_without_effect(m.scene, lattice::RunsFrom::everywhere))
      options.warn(text);
  if (const std::string faults = faults_recorded(recorded_health(*m.file)); !faults.empty())
    options.warn(fmt::format("the runs that made {}: {}", matrix_path, faults));
  return m;
}

lattice::ChainStart checked_start(const Options& options, const dynamics::StateSpace& space,
                                  const lattice::FieldParams& field, const dynamics::Entry& entry,
                                  const std::string& name) {
  const lattice::ChainStart start = lattice::start_in_bins(space, field, entry, name);
  if (start.beyond)
    options.warn(
        fmt::format("{} lies beyond every entry that the bins were made from, {}; the prediction "
                    "is that of the outermost bin. A matrix of a scene with this start suits it",
                    name, lattice::entry_bins(space, entry.face)));
  return start;
}

void require_inside_bins(const Options& options, const std::vector<lattice::PaperStart>& starts,
                         const lattice::Scene& scene, const dynamics::StateSpace& space) {
  for (const lattice::PaperStart& s : starts)
    (void)checked_start(options, space, scene.field, s.entry(),
                        "start" + start_text(space.section(), s.entry()));
}

lattice::ChainStart ready_start(const Options& options,
                                const std::vector<dynamics::Transitions>& matrices,
                                const lattice::Problem& problem, const dynamics::Entry& entry,
                                const std::string& name) {
  const dynamics::StateSpace& space = matrices.front().space;
  const lattice::ChainStart start = checked_start(options, space, problem.field, entry, name);
  const dynamics::StateRange range = space.range(start.start.input);
  const bool own_state =
      start.start.input >= space.size() - static_cast<int>(space.points().size());
  if (space.has_trees() && !own_state) {
    const auto& runs = matrices[static_cast<std::size_t>(problem.start_type())].trials;
    options.warn(fmt::format(
        "{} is no state of its own: its row is that of its leaf, {}, {} runs in all, and as noisy "
        "as so few are",
        name, text_of(space.section(), range), runs[static_cast<std::size_t>(start.start.input)]));
  }
  const auto on_edge = [](const std::array<double, 2>& edges, double v) {
    return edges[0] < edges[1] && (v == edges[0] || v == edges[1]);
  };
  bool on_an_edge = false;
  for (std::size_t axis = 0; axis < space.section().coordinates.size(); ++axis)
    on_an_edge = on_an_edge || on_edge(range.at[axis], entry.at[axis]);
  if (on_an_edge)
    options.remark(
        fmt::format("{} lies on an edge of its bin, {}; its prediction is that of the whole bin",
                    name, text_of(space.section(), range)));
  return start;
}

int status_of(const Options& options, const dynamics::Health& health, const std::string& where) {
  if (const std::string said = complaint(health); !said.empty()) options.warn(where + said);
  return exit_status(options, health.clean());
}

double number_within(const Options& options, const char* name, double usual, double low,
                     double high) {
  if (!options.has(name)) return usual;
  const double value = options.number(name);
  if (!(value >= low && value <= high))
    throw UsageError(fmt::format("--{} {}: must lie in [{}, {}]", name, digits(value), digits(low),
                                 digits(high)));
  return value;
}

}  // namespace gatewalk::cli
