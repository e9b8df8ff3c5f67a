// SPDX-License-Identifier: MIT
#include "cli/analysed.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <ranges>
#include <utility>

#include "cli/arguments.h"
#include "cli/exchange/imported.h"
#include "cli/ranged.h"
#include "cli/render/matrix.h"
#include "lattice/gate_chain.h"
#include "lattice/scene/scene_problem.h"
#include "lattice/study/prediction.h"

namespace gatewalk::cli {
namespace {

/// Throws UsageError, before any work, where even so few states take too much memory.
void require_room(const Subject& s, int states) {
  if (states <= lattice::most_analysed_states(s.problem)) return;
  const lattice::FieldParams& field = s.problem.field;
  throw UsageError(fmt::format(
      "the analysis of {} x {} cells would take more than 8 GiB with {} states: ask for fewer "
      "cells (--set field.columns=N, --set field.rows=N{}",
      field.columns, field.rows, states, field.max_gates > 0 ? ", --set field.max_gates=N)" : ")"));
}

/// From gate runs, to which more are added until the error bar says enough.
AnalysedSubject chain_of_runs(const Options& options, Subject& s) {
  constexpr int kFewestStates = 100;
  require_room(s, kFewestStates);
  auto prediction = predict(options, s);
  const lattice::StartAnswer& answer = prediction.starts.front();
  const int per_leaf =
      lattice::leaf_of_analysis(s.problem, *s.pool, s.how.per_leaf, prediction.states);
  AnalysedSubject c{.chain = lattice::analysed_chain(s.problem, *s.pool,
                                                     s.pool->begin(s.starts.front()), per_leaf),
                    .answer = {.endings = answer.endings,
                               .rest = rest_of(answer.final),
                               .from_trials = answer.from_trials,
                               .reached = prediction.reached,
                               .gate_runs = prediction.gate_runs,
                               .states = prediction.states,
                               .seconds = prediction.seconds,
                               .health = prediction.health,
                               .method = s.settled},
                    .clean = status_of(options, prediction.health) == kFine};
  if (per_leaf != s.how.per_leaf)
    options.warn(
        fmt::format("the analysis has {} states, not {}, so that it takes no more than 8 GiB: what "
                    "it says beside the endings is coarser than they are",
                    c.chain->space.size(), prediction.states));
  c.of_runs = std::move(prediction);
  return c;
}

/// From a matrix of bins.
AnalysedSubject chain_of_bins(const Options& options, const Subject& s) {
  refuse(options, {"accuracy", "gate-runs"},
         fmt::format("for {}: it has bins, and keeps no gate runs that could be added to", s.path));
  require_room(s, s.file->transitions.space.size());
  const std::vector<dynamics::Transitions> matrices = s.matrices();
  const auto start = ready_start(options, matrices, s.problem, *s.starts.front(), s.name_of(0));
  auto prediction =
      lattice::predict(s.counted(), s.problem.field, {start}, {}, options.seed(), options.work());
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

}  // namespace

AnalysedSubject analysed(const Options& options, Subject& s) {
  return s.pool ? chain_of_runs(options, s) : chain_of_bins(options, s);
}

lattice::ParameterEffects effects_of(const lattice::ParameterOptions& how, Subject& s,
                                     const AnalysedSubject& c, const lattice::Analysis& analysis,
                                     const dynamics::Work& work) {
  if (how.runs == 0 || s.is_recorded()) return {};
  if (analysis.is_certain()) {
    lattice::ParameterEffects none;
    none.chance = analysis.target_chance;
    return none;
  }
  if (!s.pool) return lattice::parameter_effects(s.problem, *c.chain, analysis.target, how, work);
  return lattice::parameter_effects(s.problem, *s.pool, analysis.target, how, s.how.per_leaf,
                                    s.how.most_runs - c.answer.gate_runs, work);
}

namespace {

/// States of a matrix that bodies enter: without those of its starts.
int entered_states(const dynamics::StateSpace& space) {
  return space.size() - static_cast<int>(space.points().size());
}

/// The state of that name or number; none if there is none.
std::optional<int> state_named(const Subject& s, const std::string& text) {
  if (!s.file) return {};
  const dynamics::StateSpace& space = s.file->transitions.space;
  if (s.foreign) {
    const auto entry = foreign_start(*s.file, text);
    return entry ? std::optional(space.index_of(*entry).state) : std::nullopt;
  }
  const std::vector<std::string> names = lattice::state_names(*s.file);
  for (int state = 0; state < entered_states(space); ++state)
    if (text == names[static_cast<std::size_t>(state)] || text == std::to_string(state))
      return state;
  return {};
}

/// "IX,IY" at the beginning of a text, of a gate in the field; `rest` is what follows.
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
    if (k == 1 && next != end && from == end) return {};  // a comma and nothing
  }
  const int column = at[0] + field.start_column(), row = at[1];
  if (!field.contains(column, row)) return {};
  rest.assign(from, end);
  return std::int64_t{row} * field.columns + column;
}

}  // namespace

std::optional<PassageAsked> first_passage_asked(const Options& options, const Subject& s) {
  if (!options.has("first-passage")) return {};
  const std::string text = options.text("first-passage");
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

std::optional<PassageResult> first_passage_of(const Options& options,
                                              const std::optional<PassageAsked>& asked,
                                              const Subject& s, const AnalysedSubject& c) {
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
                       s.foreign ? lattice::state_names(*s.file) : lattice::state_names(space),
                       lattice::shown_order(s.foreign ? s.file->transitions.space : space)};
  if (asked->target.ending)  // one number has one interval
    result.found.chance.interval =
        c.answer.endings.interval[static_cast<std::size_t>(*asked->target.ending)];
  if (!result.has_tables())
    options.warn(
        "--first-passage: the tables of all states are left out, they would have more "
        "than 2 million lines: ask for fewer gates");
  return result;
}

void add_ranges(Options& options) {
  options.add_texts(
      "over", "KEY=LOW:HIGH",
      fmt::format("a number of the scene, or of the program, and a range: how much of the variance "
                  "of the target's chance each of these\nmakes, all of them anywhere in their "
                  "ranges alike (Sobol's first and total indices; at most {};\nmay be repeated)",
                  lattice::kMostVaried));
  options.add_count("over-trials", "N",
                    "full trials for that, at most, all together (default: 200000)");
}

std::optional<Ranged> over_of(const Options& options, const Subject& s) {
  auto ranged = ranges_of(options, s, "over", lattice::kMostVaried);
  if (!options.has("over-trials")) return ranged;
  if (!ranged) throw UsageError("--over-trials: is for --over");
  (void)options.count("over-trials",
                      lattice::least_trials_of_shares(static_cast<int>(ranged->ranges.size())));
  return ranged;
}

std::optional<RangedShares> shares_of(const Options& options, const std::optional<Ranged>& ranged,
                                      const Subject& s, markov::Ending target) {
  if (!ranged) return {};
  lattice::VarianceSharesOptions how{.seed = options.seed()};
  if (options.has("over-trials")) how.trials = options.count("over-trials");
  return RangedShares{
      ranged->ranges, target,
      lattice::variance_shares(static_cast<int>(ranged->ranges.size()), problem_at(*ranged, s),
                               target, how, options.work())};
}

}  // namespace gatewalk::cli
