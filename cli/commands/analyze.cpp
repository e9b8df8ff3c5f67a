// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <ranges>
#include <string>

#include "cli/arguments.h"
#include "cli/exchange/imported.h"
#include "cli/fields/text.h"
#include "cli/next.h"
#include "cli/number_ranges.h"
#include "cli/page.h"
#include "cli/render/analysis.h"
#include "cli/render/health.h"
#include "cli/render/matrix.h"
#include "cli/render/pooled_prediction.h"
#include "cli/source_options.h"
#include "lattice/field/matrix_file.h"
#include "lattice/pool/chain_with_rewards.h"
#include "lattice/pool/lumped_chain.h"
#include "lattice/scene/ranges.h"
#include "lattice/scene/scene_keys.h"
#include "lattice/scene/scene_problem.h"
#include "lattice/scene/units.h"
#include "lattice/statistics/ending_shares.h"
#include "lattice/study/prediction.h"
#include "lattice/study/trials.h"
#include "lattice/text/digits.h"

namespace gatewalk::cli {
namespace {

/// The ending that --target names, by its key in JSON. Throws UsageError for an unknown name.
markov::Ending target_of(const std::string& name) {
  if (const auto ending = lattice::ending_named(name)) return *ending;
  throw UsageError(fmt::format(
      "--target {}: must be one of {}", name,
      fmt::join(lattice::kEndingNames | std::views::transform(&lattice::EndingName::key), ", ")));
}

/// The values of --lump, parts of each coordinate; 1 each without --lump. Throws UsageError.
lattice::LumpingParts lumping_of(const TextOption& given, const dynamics::Section& section) {
  constexpr int kMost = 1000;
  lattice::LumpingParts parts(section.coordinates.size(), 1);
  if (!given) return parts;
  const std::string text = given.value();
  const char *at = text.data(), *const end = at + text.size();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto [next, error] = std::from_chars(at, end, parts[i]);
    const bool ends_well = i + 1 < parts.size() ? next != end && *next == ',' : next == end;
    if (error != std::errc() || !ends_well || parts[i] < 1 || parts[i] > kMost)
      throw UsageError(fmt::format("--lump {}: must be {} whole numbers from 1 to {}: parts of {}",
                                   text, parts.size(), kMost, names_of(section.coordinates, ",")));
    at = next + 1;
  }
  return parts;
}

/// The chain to analyse, and the prediction of how its bodies end.
struct AnalysedSubject {
  std::optional<lattice::AnalysedChain> chain;
  std::optional<lattice::PooledPrediction> of_runs{};  // for chains of gate runs; else of_bins
  std::optional<lattice::Prediction> of_bins{};
  AnalysedAnswer answer{};
  bool clean = true;
};

/// Throws UsageError, before any work, if a chain with so few states already needs too much memory.
void require_room(const lattice::Source& s, int states) {
  if (states <= lattice::most_analysed_states(s.problem)) return;
  const lattice::FieldParams& field = s.problem.field;
  throw UsageError(fmt::format(
      "the analysis of {} x {} cells would take more than 8 GiB with {} states: ask for fewer "
      "cells (--set field.columns=N, --set field.rows=N{}",
      field.columns, field.rows, states, field.max_gates > 0 ? ", --set field.max_gates=N)" : ")"));
}

/// The chain of gate runs. Runs are added until the prediction reaches the accuracy.
AnalysedSubject chain_of_runs(const Options& options, lattice::Source& s) {
  constexpr int kFewestStates = 100;
  require_room(s, kFewestStates);
  auto prediction = predict(options, s);
  const lattice::StartAnswer& answer = prediction.starts.front();
  const int per_leaf =
      lattice::leaf_of_analysis(s.problem, *s.pool, s.accuracy.per_leaf, prediction.states);
  AnalysedSubject c{.chain = lattice::analysed_chain(s.problem, *s.pool,
                                                     s.pool->first_row(s.starts.front()), per_leaf),
                    .answer = {.endings = answer.endings,
                               .rest = rest_of(answer.final),
                               .from_trials = answer.from_trials,
                               .reached = prediction.reached,
                               .gate_runs = prediction.gate_runs,
                               .states = prediction.states,
                               .seconds = prediction.seconds,
                               .health = prediction.health,
                               .method = lattice::settled_of(s)}};
  if (per_leaf != s.accuracy.per_leaf)
    options.warn(
        fmt::format("the analysis has {} states, not {}, so that it takes no more than 8 GiB: what "
                    "it says beside the endings is coarser than they are",
                    c.chain->space.size(), prediction.states));
  c.of_runs = std::move(prediction);
  return c;
}

/// The chain of a matrix of bins.
AnalysedSubject chain_of_bins(const Options& options, const AskedAccuracy& asked,
                              const lattice::Source& s) {
  refuse({asked.accuracy, asked.gate_runs},
         fmt::format("for {}: it has bins, and keeps no gate runs that could be added to", s.path));
  require_room(s, s.file->transitions.space.size());
  const std::vector<dynamics::Transitions> matrices = s.matrices();
  const auto start = ready_start(options, matrices, s.problem, *s.starts.front(), s.name_of(0));
  auto prediction = lattice::predict(lattice::counted_of(s), s.problem.field, {start}, {},
                                     options.seed(), options.work());
  const auto health = recorded_health(*s.file);
  AnalysedSubject c{.chain = lattice::analysed_chain(s.problem, matrices, start.start),
                    .answer = {.endings = prediction.starts.front().shares,
                               .rest = rest_of(prediction.starts.front().final),
                               .states = s.file->transitions.space.size(),
                               .seconds = prediction.seconds,
                               .health = health,
                               .method = recorded_method(*s.file, s.path)},
                    .clean = faults_recorded(health).empty()};
  c.of_bins = std::move(prediction);
  return c;
}

/// How the parameters of the cells change the target's probability; empty if the runs were
/// recorded.
lattice::ParameterEffects effects_of(const lattice::ParameterOptions& how, lattice::Source& s,
                                     const AnalysedSubject& c, const lattice::Analysis& analysis,
                                     const dynamics::Work& work) {
  if (how.runs == 0 || s.is_recorded()) return {};
  if (analysis.is_certain()) {
    lattice::ParameterEffects none;
    none.chance = analysis.target_chance;
    return none;
  }
  if (!s.pool) return lattice::parameter_effects(s.problem, *c.chain, analysis.target, how, work);
  return lattice::parameter_effects(s.problem, *s.pool, analysis.target, how, s.accuracy.per_leaf,
                                    s.accuracy.most_runs - c.answer.gate_runs, work);
}

/// The number of states in which bodies enter gates, without the states of starts.
int entered_states(const dynamics::StateSpace& space) {
  return space.size() - static_cast<int>(space.points().size());
}

/// The state of a matrix by its name or number; nullopt if there is none.
std::optional<int> state_named(const lattice::Source& s, const std::string& text) {
  if (!s.file) return {};
  const dynamics::StateSpace& space = s.file->transitions.space;
  if (s.is_imported) {
    const auto entry = lattice::named_state(*s.file, text);
    return entry ? std::optional(space.index_of(*entry).state) : std::nullopt;
  }
  const std::vector<std::string> names = lattice::state_names(*s.file);
  for (int state = 0; state < entered_states(space); ++state)
    if (text == names[static_cast<std::size_t>(state)] || text == std::to_string(state))
      return state;
  return {};
}

/// Reads the gate "IX,IY" at the beginning of a text; `rest` becomes what follows.
std::optional<std::int64_t> cell_named(const lattice::FieldParams& field, const std::string& text,
                                       std::string& rest) {
  int at[2];
  const char *from = text.data(), *const end = from + text.size();
  for (const int k : {0, 1}) {
    const auto [next, error] = std::from_chars(from, end, at[k]);
    if (error != std::errc() ||
        (k == 0 ? next == end || *next != ',' : next != end && *next != ','))
      return {};
    from = next == end ? next : next + 1;
    if (k == 1 && next != end && from == end) return {};  // a comma without a number
  }
  const int column = at[0] + field.start_column(), row = at[1];
  if (!field.contains(column, row)) return {};
  rest.assign(from, end);
  return std::int64_t{row} * field.columns + column;
}

/// What --first-passage asks for; nullopt without it. Throws UsageError naming what is allowed.
std::optional<PassageAsked> first_passage_asked(const TextOption& given, const lattice::Source& s) {
  if (!given) return {};
  const std::string text = given.value();
  const auto state = state_named(s, text);
  const bool capitals =
      std::any_of(text.begin(), text.end(), [](char c) { return c >= 'A' && c <= 'Z'; });
  if (const auto ending = lattice::ending_named(text); ending && !(state && capitals))
    return PassageAsked{text, {.ending = *ending}};
  if (state) return PassageAsked{text, {.input = *state}};
  const lattice::FieldParams& field = s.problem.field;
  std::string rest;
  if (const auto cell = cell_named(field, text, rest)) {
    if (rest.empty()) return PassageAsked{text, {.cell = *cell}};
    if (const auto entered = state_named(s, rest))
      return PassageAsked{text, {.cell = *cell, .input = *entered}};
  }
  if (s.file && !s.is_imported) {
    const std::vector<std::string> names = lattice::state_names(*s.file);
    for (std::size_t k = static_cast<std::size_t>(entered_states(s.file->transitions.space));
         k < names.size(); ++k)
      if (text == names[k] || text == std::to_string(k))
        throw UsageError(fmt::format(
            "--first-passage {}: is the start itself, in which every body begins", text));
  }
  const auto keys = lattice::kAllEndingNames | std::views::transform(&lattice::EndingName::key);
  const auto range = [](int first, int count) {
    return fmt::format("{} to {}", first, first + count - 1);
  };
  throw UsageError(fmt::format(
      "--first-passage {}: must be an ending ({}), a gate IX,IY (IX {}, IY {}){}", text,
      fmt::join(keys, ", "), range(-field.start_column(), field.columns), range(0, field.rows),
      s.file ? fmt::format(", a state by its name or number, or a state of one gate, "
                           "IX,IY,STATE (the states of {}: {}, ..., {} in all)",
                           s.path, lattice::state_names(*s.file).front(),
                           entered_states(s.file->transitions.space))
             : "; states are those of a matrix: gatewalk build"));
}

/// The chain's answer to --first-passage; nullopt without it. Warns if tables are left out. Throws
/// UsageError for a state of the file if the chain has other states now.
std::optional<PassageResult> first_passage_of(const Options& options,
                                              const std::optional<PassageAsked>& asked,
                                              const lattice::Source& s, const AnalysedSubject& c) {
  if (!asked) return {};
  const dynamics::StateSpace& space = c.chain->space;
  const bool same_states = !s.file || (space.trees() == s.file->transitions.space.trees() &&
                                       space.bins() == s.file->transitions.space.bins());
  if (asked->target.input && !same_states)
    throw UsageError(
        fmt::format("--first-passage {}: runs were added to keep the accuracy, and the states are "
                    "others now: build the matrix for this accuracy, field and start first",
                    asked->text));
  PassageResult result{*asked, lattice::first_passage(s.problem.field, *c.chain, asked->target),
                       s.is_imported ? lattice::state_names(*s.file) : lattice::state_names(space),
                       lattice::shown_order(s.is_imported ? s.file->transitions.space : space)};
  if (asked->target.ending) {  // the prediction's share and interval, so that there is only one
    const auto e = static_cast<std::size_t>(*asked->target.ending);
    if (c.of_runs && !c.answer.from_trials) result.found.chance.mean = c.answer.endings.share[e];
    result.found.chance.interval = c.answer.endings.interval[e];
  }
  if (!result.has_tables())
    options.warn(
        "--first-passage: the tables of all states are left out, they would have more "
        "than 2 million lines: ask for fewer gates");
  return result;
}

/// The ranges of --over; nullopt without it. Throws UsageError and SceneError.
std::optional<NumberRanges> over_of(const Options& options, const TextsOption& over,
                                    const CountOption& trials, const lattice::Source& s) {
  auto ranges = ranges_of(options, s, over, lattice::kMostVaried);
  if (!trials) return ranges;
  if (!ranges) throw UsageError("--over-trials: is for --over");
  (void)trials.value(lattice::least_trials_of_shares(static_cast<int>(ranges->each.size())));
  return ranges;
}

/// The share of each number of --over in the variance of the target's probability; nullopt without
/// --over.
std::optional<RangedShares> shares_of(const Options& options, const CountOption& trials,
                                      const std::optional<NumberRanges>& ranges,
                                      const lattice::Source& s, markov::Ending target) {
  if (!ranges) return {};
  lattice::VarianceSharesOptions how{.seed = options.seed()};
  if (trials) how.trials = trials.value();
  return RangedShares{
      ranges->each, target,
      lattice::variance_shares(static_cast<int>(ranges->each.size()), problem_at(*ranges, s),
                               target, how, options.work())};
}

/// The faults in all runs that the command simulated.
dynamics::Health health_of(const AnalysedSubject& subject, const AnalysedField& result) {
  dynamics::Health all = result.parameters.health;
  if (subject.of_runs) all += subject.of_runs->health;
  if (result.shares) all += result.shares->found.health;
  if (result.direct) all += result.direct->tally.health;
  return all;
}

/// Lines of the first screen about the answer on which the analysis builds; empty if there is
/// nothing to beware of.
std::string beware_of_answer(const lattice::Source& s, const AnalysedSubject& c) {
  if (c.of_runs) return beware_of(*c.of_runs, s.accuracy.accuracy, s.is_recorded());
  return s.is_imported ? "" : beware_of_recorded(c.answer.health);
}

constexpr std::size_t kShownEffects = 3;  // on the first screen

/// The key in the unit in which the scene gives its value: "beams.joint_x_cm" for
/// "beams.joint_x_m".
std::string spelled(const lattice::Scene& scene, const std::string& key) {
  const auto given = scene.named.find(key);
  if (given == scene.named.end()) return key;
  // "mine.toml:3 (joint_x_cm = 20)", "--set beams.joint_x_cm=20"
  std::string_view where = given->second;
  const auto is_of_key = [](char c) {
    return c == '_' || c == '.' || (std::isalnum(static_cast<unsigned char>(c)) != 0);
  };
  while (!where.empty()) {
    const auto end = std::ranges::find_if_not(where, is_of_key);
    const auto size = static_cast<std::size_t>(end - where.begin());
    const std::string word(where.substr(0, size));
    const std::string name =
        word.find('.') == word.npos ? key.substr(0, key.find('.') + 1) + word : word;
    if (lattice::unit_of(name, key)) return name;
    where.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return key;
}

/// The most influential number with 1 % more of it, as a value of --set: "beams.joint_x_cm=20.2";
/// empty if the scene permits none of the largest.
std::string one_percent_more(const Options& options, const lattice::Source& s,
                             const AnalysedField& result) {
  for (const auto& effect : sorted_effects(result) | std::views::take(kShownEffects)) {
    if (!std::isfinite(effect.value)) continue;
    const std::string key = spelled(*s.scene, effect.key);
    const double value =
        lattice::in_given_unit(1.01 * effect.value, *lattice::unit_of(key, effect.key));
    std::vector<std::string> overrides = options.overrides();
    overrides.push_back(fmt::format("{}={}", key, digits(value, 4)));
    try {
      (void)lattice::read_scene(options.file(s.path).toml(), overrides);
      return overrides.back();
    } catch (const std::exception&) {  // the scene does not permit this value
      continue;
    }
  }
  return "";
}

/// The most influential number that the scene permits to vary by 10 % to each side, as a value of
/// --vary for gatewalk sweep; empty if there is none.
std::string range_of_largest(const Options& options, const lattice::Source& s,
                             const AnalysedField& result) {
  for (const auto& effect : sorted_effects(result) | std::views::take(kShownEffects)) {
    if (!std::isfinite(effect.value)) continue;
    const std::string step = digits(0.05 * effect.value, 2);
    std::string_view words = step;
    const double by = *lattice::take_number(words);
    const std::string low = digits(effect.value - 2.0 * by), high = digits(effect.value + 2.0 * by);
    try {
      (void)lattice::RangedScene(options.file(s.path).toml(), options.overrides(),
                                 {fmt::format("{}={}:{}", effect.key, low, high)}, "--vary");
      return fmt::format("{}={}:{}:{}", effect.key, low, step, high);
    } catch (const std::exception&) {  // the scene does not permit the whole range
      continue;
    }
  }
  return "";
}

std::vector<std::string> next_of(const Options& options, const lattice::Source& s,
                                 const AnalysedField& result) {
  NextCommands next(options);
  const bool is_of_gates = s.scene && !s.file;
  const bool is_one_gate = s.problem.field.columns * std::int64_t{s.problem.field.rows} == 1;
  if (const std::string set =
          is_of_gates && !is_one_gate ? one_percent_more(options, s, result) : "";
      !set.empty())
    return next.keeping({"accuracy", "gate-runs", "seed"})
        .add("predict", "--set " + set, "with 1 % more of it")
        .lines();
  if (const std::string range = is_of_gates && is_one_gate && !s.starts_given  // sweep has no start
                                    ? range_of_largest(options, s, result)
                                    : "";
      !range.empty())
    return next.add("sweep", "--vary " + range, "varies it in one gate").lines();
  return next.again("figure", "analysis.svg", "draws visits, paths and influences").lines();
}

}  // namespace

int run_analyze(const Arguments& arguments) {
  Options options("analyze SCENE|MATRIX.nc [SCENE] [options]",
                  "Finds which numbers of the scene change the chance to cross most, and says how "
                  "long bodies take,\n"
                  "how much work that needs, which gates they visit, which paths lead across, and "
                  "how likely other\n"
                  "starts are to cross. The answers come from the chain of the field. analyze "
                  "simulates gate runs\n"
                  "until the error bar is as small as --accuracy. A matrix of trees brings its own "
                  "gate runs. A\n"
                  "matrix of bins is used as it is; it gives no intervals for times and work.",
                  "gatewalk analyze scenes/field.toml --target left_side --json analysis.json");
  const TextOption path = options.positional(
      "matrix", "a scene (-: standard input), or a matrix file written by gatewalk build", true);
  const TextOption scene = options.second_scene();
  const AskedAccuracy accuracy = add_accuracy(options, "0.02; that of a matrix");
  const TextsOption starts_given =
      options.add_texts("start", "D,VX,VY", "where a body starts (default: the scene's start)");
  const TextOption target =
      options.add_text("target", "ENDING",
                       "the ending that starts, paths and influences are about: crossed, "
                       "left_side, right_side, trapped or cut_off",
                       "crossed");
  const TextOption to_reach = options.add_text(
      "first-passage", "TARGET",
      "the chance and the mean time to reach TARGET: an ending, a gate IX,IY, or, of a matrix, a "
      "state (name or\nnumber) or IX,IY,STATE; --json and --csv list every state of every gate");
  const CountOption runs = options.add_count(
      "runs", "N",
      "for each number of the scene: N gate runs with a little more of it, N with a little less, "
      "and 2 N\nfor the intervals, on top of --gate-runs; 0: no influences (default: 20000, or 0 "
      "with --first-passage)");
  const NumberOption step = options.add_number(
      "step", "PART", "how much more and less, as a part of the number (default: 0.02)");
  const TextOption lump = options.add_text(
      "lump", "D,VX,VY",
      "merge the states of each boundary into this many parts by d, vx and vy (or by the "
      "coordinates of other\ncells), to see how much accuracy so few states lose (default: 1 "
      "each)");
  const CountOption paths =
      options.add_count("paths", "N", "how many of the most frequent paths to list", "5");
  const TextsOption over = options.add_varied(
      "over", "KEY=LOW:HIGH",
      fmt::format("vary a number of the scene, or of the program, over a range: says which part of "
                  "the variance of the target's\nchance comes from each number, all values alike "
                  "probable (Sobol's first and total indices; at most {};\nmay be repeated)",
                  lattice::kMostVaried));
  const CountOption over_trials = options.add_count(
      "over-trials", "N", "full trials for --over, at most, in all (default: 200000)");
  const CountOption trials = options.add_count(
      "trials", "N", "also run N trials of the full dynamics, to compare times and work");
  options.add_seed();
  options.add_kept();
  options.add_strict();
  const AskedProgram program = add_cell_program(options);
  const TextOption page = add_page(options);
  options.add_figure("visits and paths, durations, starts and influences");
  options.add_details("times and work by ending, visits, paths, and the influence of every number");
  options.most_used({"accuracy", "target", "set", "figure", "json"});
  if (!options.parse(arguments)) return kFine;
  if (starts_given.values().size() > 1) throw UsageError("--start: an analysis is of one start");
  const lattice::ParameterOptions parameters{.runs = runs       ? runs.value(0, 1'000'000)
                                                     : to_reach ? 0
                                                                : 20'000,
                                             .relative_step = step.within(0.02, 1e-6, 0.5),
                                             .seed = options.seed()};
  if (trials) (void)trials.value();  // checks the value now, because these trials run last
  if (parameters.runs > 0 && parameters.runs < 100)
    throw UsageError("--runs: must be 0, or 100 or more");
  lattice::AnalysisOptions how{.target = target_of(target.value()),
                               .paths = static_cast<std::size_t>(paths.value(0, 1000)),
                               .seed = options.seed()};
  lattice::Source s = open_source(options, {path, scene, program, starts_given, accuracy});
  check_page(page, s);
  if (s.is_recorded())
    refuse({trials, step}, "for " + s.path +
                               (s.is_imported ? ", a chain that was made elsewhere"
                                              : ", whose runs were recorded"));
  how.lumping = lumping_of(lump, s.problem.map().section);
  const auto ranges = over_of(options, over, over_trials, s);
  const auto passage = first_passage_asked(to_reach, s);
  choose_method(options, s);
  const auto of_file = runs_of_file(page, s);
  AnalysedSubject c = s.pool ? chain_of_runs(options, s) : chain_of_bins(options, accuracy, s);
  if (c.of_runs && !c.answer.from_trials) how.endings = c.answer.endings.share;
  const dynamics::Work work = options.work();
  AnalysedField result{.shown = ShownField(s),
                       .start = s.starts.front(),
                       .answer = c.answer,
                       .analysis = lattice::analyze(s.problem, *c.chain, how, work),
                       .step = parameters.relative_step};
  const lattice::Analysis& analysis = result.analysis;
  result.passage = first_passage_of(options, passage, s, c);
  if (s.pool) c.chain.reset();  // frees memory for the larger chain of the parameters
  result.parameters = effects_of(parameters, s, c, analysis, work);
  if (trials) {
    lattice::FieldCosts costs(lattice::bin_of_durations(s, options.seed()));
    auto tally = lattice::field_trials(s.problem, {0, trials.value()}, options.seed(), work,
                                       [&](const lattice::FieldTrials& each) { costs.add(each); });
    result.direct = DirectTrials{std::move(tally), std::move(costs)};
  }
  result.shares = shares_of(options, over_trials, ranges, s, how.target);
  result.made_by = options.provenance(s);
  const dynamics::Health health = health_of(c, result);
  const std::vector<std::string> next = next_of(options, s, result);
  std::int64_t lines_below = 1;  // on --details
  for (const std::string& command : next) lines_below += 1 + std::ranges::count(command, '\n');
  options.give_out(result,
                   {answer_text(result, lines_below) + beware_of_answer(s, c) + beware_of(health),
                    details_text(result), next});
  options.warn(rest_warning(c.answer.rest));
  if (const std::string why = analysis.why_unfinished(); !why.empty())
    options.warn("gates visited, visits, times and costs are not known: " + why);
  const bool clean = status_of(options, health) == kFine && c.clean;
  const std::vector<PageAnswer> starts =
      c.of_runs ? page_answers(*c.of_runs) : page_answers(*c.of_bins, s);
  write_page(options, page, s, of_file, starts, &result);
  options.draw([&] { return figure_of(result); });
  return exit_status(options, clean);
}

}  // namespace gatewalk::cli
