// SPDX-License-Identifier: MIT
#include "cli/arguments.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "cli/fields/text.h"
#include "cli/render/assumptions.h"
#include "cli/render/choice.h"
#include "cli/render/health.h"
#include "cli/render/matrix.h"
#include "cli/render/meaning.h"
#include "cli/render/pooled_prediction.h"
#include "cli/render/start.h"
#include "cli/source_options.h"
#include "dynamics/base/work.h"
#include "lattice/pool/pool_runner.h"
#include "lattice/pool/remembered.h"
#include "lattice/pool/states_info.h"
#include "lattice/scene/scene_keys.h"
#include "lattice/scene/units.h"
#include "lattice/source/start_text.h"
#include "lattice/text/digits.h"

namespace gatewalk::cli {
TextsOption add_starts(Options& options, const std::string& by_default) {
  const std::string help = fmt::format(
      "a start at x = D m, y = 0 with the velocity (VX, VY) in m/s, or by another face, as in "
      "LD:D,VX,VY; may be repeated (default: {})",
      by_default);
  return options.add_texts("start", "D,VX,VY", help);
}

std::vector<dynamics::Entry> given_starts(const TextsOption& given) {
  std::vector<dynamics::Entry> starts;
  for (const std::string& text : given.values())
    starts.push_back(
        *lattice::start_in(text, lattice::scene_section(), lattice::StartsBy::any_face));
  return starts;
}

std::vector<dynamics::Entry> starts_of(const TextsOption& given, const lattice::Scene& scene) {
  if (given) return given_starts(given);
  std::vector<dynamics::Entry> starts;
  for (const lattice::PaperStart& s : lattice::table_iv_starts(scene)) starts.push_back(s.start);
  if (starts.empty()) starts.push_back(lattice::own_start(scene));
  return starts;
}

TextOption add_bins(Options& options) {
  return options.add_text(
      "bins", "paper|FACTOR|auto|tree",
      "states of the chain. tree: trees over the entries of full trials, grown until --accuracy is "
      "reached; paper: the bins of Table III, in the scene's own units; FACTOR: those bins, FACTOR "
      "times as many per axis (2 makes 696 states, 0.5 makes 23); auto: bins at the quantiles of "
      "entries in pilot trials. Default: the scene's table [bins], else tree. If runs per state "
      "are "
      "asked for: paper, or auto where the paper's bins do not suit the gate or its bodies");
}

TextOption add_order_of(Options& options) {
  return options.add_text(
      "order-of", "turns|faces|states",
      "what --order counts. turns: left, straight, right and back, where a cell has three or more "
      "open sides, and back everywhere; faces: those by which the cells before were entered; "
      "states: those of the chain without memory. Default: turns");
}

dynamics::LettersOf letters_of(const TextOption& order_of) {
  using dynamics::LettersOf;
  if (!order_of) return LettersOf::turns;
  for (const LettersOf of : {LettersOf::turns, LettersOf::faces, LettersOf::states})
    if (order_of.value() == lattice::name_of(of)) return of;
  throw UsageError(fmt::format("--order-of {}: must be turns, faces or states", order_of.value()));
}

lattice::BinsChoice bins_choice(const TextOption& bins, const lattice::Scene& scene,
                                const Option& runs_per_state) {
  using Kind = lattice::BinsChoice::Kind;
  if (!bins)
    return scene.bins || runs_per_state ? lattice::usual_bins(scene)
                                        : lattice::BinsChoice{Kind::tree};
  const std::string text = bins.value();
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
                          choice.factor);  // throws for other factors
  return choice;
}

AskedAccuracy add_accuracy(Options& options, const std::string& by_default) {
  const NumberOption accuracy = options.add_number(
      "accuracy", "A",
      fmt::format(
          "error bar to reach: trials are added until the final gates are within a total variation "
          "of A of the truth, 95 times in 100; with 0.02, 2 of 100 bodies end in another gate than "
          "predicted (default: {})",
          by_default));
  return {accuracy, options.add_count("gate-runs", "N",
                                      "stop soon after N gate runs, whatever the accuracy")};
}

lattice::AccuracyOptions accuracy_of(const Options& options, const AskedAccuracy& asked,
                                     lattice::AccuracyOptions how) {
  if (asked.accuracy) {
    how.accuracy = asked.accuracy.value();
    if (!(how.accuracy > 0.0 && how.accuracy < 1.0))
      throw UsageError(fmt::format("--accuracy {}: must lie between 0 and 1, such as 0.01",
                                   digits(how.accuracy)));
  }
  if (asked.gate_runs) how.most_runs = asked.gate_runs.value();
  how.seed = options.seed();
  return how;
}

void fix_trials(const Options& options, const AskedAccuracy& asked, lattice::AccuracyOptions& how,
                std::int64_t starts) {
  if (options.trials) {
    refuse({asked.gate_runs, asked.accuracy}, "beside --trials");
    how.trials = options.trials.value(lattice::PoolRunner::kLeastTrials * starts);
    if (*how.trials % starts != 0)
      throw UsageError(fmt::format("--trials {}: must be so many for each of {} starts alike",
                                   *how.trials, starts));
  } else if (options.shard) {
    throw UsageError(
        "--shard of trees needs --trials N (for a scene with --bins tree): a part must know how "
        "many "
        "there are in all");
  }
}

void warn_of(const Options& options, const std::optional<lattice::HausmanCheck>& own,
             const std::vector<lattice::AssumptionCheck>& assumptions, bool is_recorded) {
  if (const std::string wrong = wrong_assumption_text(assumptions, is_recorded); !wrong.empty())
    options.warn(wrong);
  else if (own && own->differs())
    options.warn(fmt::format(
        "the chain differs from its own full trials (total variation {}, chance {}, {}): trust "
        "gatewalk lattice",
        fixed(own->total_variation, 4), fixed(own->chance_total_variation, 4), p_words(own->p)));
}

void warn_of(const Options& options, const lattice::PooledPrediction& prediction, double accuracy,
             bool is_recorded) {
  warn_of(options, prediction.hausman_check, prediction.assumptions, is_recorded);
  options.warn(not_reached(prediction, accuracy, is_recorded));
}

void warn_of_range(const Options& options, const lattice::MatrixFile& file, const std::string& path,
                   const std::vector<dynamics::Entry>& starts) {
  const lattice::TreeInfo trees = lattice::tree_info(file, path);
  const dynamics::StateSpace& space = file.transitions.space;
  const std::int64_t outside = trees.outside(space, starts);
  if (outside == 0) return;
  dynamics::StateRange built = trees.range->range;
  built.face = starts.front().face;
  options.warn(fmt::format("{} outside the range that {} was built for: {}",
                           counted(outside, "start lies", "starts lie"), path,
                           text_of(space.section(), built)));
}

void add_starts(const Options& options, lattice::SceneMatrix& m, const std::string& path,
                const std::vector<dynamics::Entry>& starts) {
  warn_of_range(options, *m.file, path, starts);
  const auto prediction = lattice::add_starts(m, path, starts, options.seed(), options.work());
  if (!prediction) return;
  options.remark(
      fmt::format("{} gate runs from starts that {} does not know", prediction->gate_runs, path));
  options.warn(complaint(prediction->health));
  warn_of(options, *prediction, lattice::tree_info(*m.file, path).accuracy_of_one());
}

bool replaces_push(const Options& options) {
  const std::string push = "forces.propulsion_N";
  for (const std::string& set : options.overrides())
    if (std::ranges::count(lattice::keys_set_by(set), push) > 0) return true;
  for (const TextsOption& option : options.varied())
    for (const std::string& text : option.values())
      if (lattice::known_key(text.substr(0, text.find('=')), "--" + option.name()) == push)
        return true;
  return false;
}

std::string push_alone_changes(const lattice::Scene& scene) {
  const std::string numbers = lattice::numbers_from_the_push(scene);
  if (numbers.empty()) return "";
  return fmt::format("your options change the push, but not {}, which {} leaves out", numbers,
                     scene.source);
}

void warn_of_keys(const Options& options, const lattice::Scene& scene, lattice::RunsFrom from) {
  for (const std::string& text : lattice::keys_without_effect(scene, from)) options.warn(text);
  if (!options.talk()) return;
  options.warn(lattice::derived_keys(scene));
  if (replaces_push(options)) options.warn(push_alone_changes(scene));
  options.warn(far_from_walkers_line(scene));
}

std::optional<lattice::Settled> settle_method(const Options& options, lattice::Scene& scene,
                                              lattice::RunsFrom from) {
  warn_of_keys(options, scene, from);
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
        "the bins of Table III are too coarse for this scene: --bins auto is used instead");
  return states;
}

void warn_of_faults(const Options& options, const lattice::MatrixFile& file,
                    const std::string& path) {
  if (const std::string faults = faults_recorded(recorded_health(file)); !faults.empty())
    options.warn(fmt::format("the runs that made {}: {}", path, faults));
}

lattice::SceneMatrix read_matrix(const Options& options, const std::string& path,
                                 const lattice::TomlFile* scene,
                                 const std::vector<std::string>& overrides) {
  const lattice::SourceFile& file = options.file(path);
  lattice::SceneMatrix m =
      lattice::scene_matrix(file.matrix(), file.own_scene(), path, scene, overrides);
  if (scene)  // a matrix's own scene names every key, so none is a mistake
    for (const std::string& text :
         lattice::keys_without_effect(m.scene, lattice::RunsFrom::everywhere))
      options.warn(text);
  warn_of_faults(options, *m.file, path);
  return m;
}

lattice::ChainStart checked_start(const Options& options, const dynamics::StateSpace& space,
                                  const lattice::FieldParams& field, const dynamics::Entry& entry,
                                  const std::string& name) {
  const lattice::ChainStart start = lattice::start_in_bins(space, field, entry, name);
  if (start.beyond)
    options.warn(
        fmt::format("{} lies beyond every entry that the bins were made from, {}: build a matrix "
                    "from a scene with this start",
                    name, lattice::entry_bins(space, entry.face)));
  return start;
}

void require_inside_bins(const Options& options, const std::vector<dynamics::Entry>& starts,
                         const lattice::Scene& scene, const dynamics::StateSpace& space) {
  for (const dynamics::Entry& s : starts)
    (void)checked_start(options, space, scene.field, s, "start" + start_text(space.section(), s));
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
        "{} is no state of its own: its row is that of the leaf {}, with {} runs only", name,
        text_of(space.section(), range), runs[static_cast<std::size_t>(start.start.input)]));
  }
  const auto on_edge = [](const std::array<double, 2>& edges, double v) {
    return edges[0] < edges[1] && (v == edges[0] || v == edges[1]);
  };
  bool on_an_edge = false;
  for (std::size_t axis = 0; axis < space.section().coordinates.size(); ++axis)
    on_an_edge = on_an_edge || on_edge(range.at[axis], entry.at[axis]);
  if (on_an_edge)
    options.remark(fmt::format("{} lies on an edge of its bin, {}; the whole bin is predicted",
                               name, text_of(space.section(), range)));
  return start;
}

int status_of(const Options& options, const dynamics::Health& health, const std::string& where) {
  if (const std::string said = complaint(health); !said.empty()) options.warn(where + said);
  return exit_status(options, health.clean());
}

}  // namespace gatewalk::cli
