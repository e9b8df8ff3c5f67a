// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <charconv>
#include <ranges>

#include "cli/analysed.h"
#include "cli/answered.h"
#include "cli/arguments.h"
#include "cli/render/text.h"
#include "cli/subject.h"
#include "lattice/pool/lumped_chain.h"
#include "lattice/statistics/ending_shares.h"
#include "lattice/study/trials.h"

namespace gatewalk::cli {
namespace {

/// By the names of JSON. Throws UsageError for any other.
markov::Ending target_of(const Options& options) {
  const std::string name = options.text("target");
  if (const auto ending = lattice::ending_named(name)) return *ending;
  throw UsageError(fmt::format(
      "--target {}: must be one of {}", name,
      fmt::join(lattice::kEndingNames | std::views::transform(&lattice::EndingName::key), ", ")));
}

/// --lump: parts of each coordinate; 1 each without it. Throws UsageError.
lattice::LumpingParts lumping_of(const Options& options, const dynamics::Section& section) {
  constexpr int kMost = 1000;
  lattice::LumpingParts parts(section.coordinates.size(), 1);
  if (!options.has("lump")) return parts;
  const std::string text = options.text("lump");
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

}  // namespace

int run_analyze(const Arguments& arguments) {
  Options options(
      "analyze SCENE|MATRIX.nc [SCENE] [options]",
      "What the chain of a field says beside its final gates: how long bodies take to cross, what "
      "work that is,\n"
      "how often they visit each gate, which ways lead across, how likely other starts are to get "
      "there, what\n"
      "becomes of those who go on for ever, and which numbers of the scene change that most. From "
      "a scene, or from\n"
      "the gate runs that a matrix of trees keeps; runs are added until the error bar keeps "
      "--accuracy. From a matrix\n"
      "of bins as it is, without error bars on times and works.",
      "gatewalk analyze scenes/field.toml --target left_side --json analysis.json");
  options.positional(
      "matrix", "a scene (-: standard input), or a matrix file written by gatewalk build", true);
  options.positional("scene", "of a matrix: another scene; without it the matrix's own", false);
  add_accuracy(options, "0.02; that of a matrix");
  options.add_texts("start", "D,VX,VY", "where a body starts (default: the scene's start)");
  options.add_text("target", "ENDING",
                   "what starts, paths and influences are of: crossed, left_side, right_side, "
                   "trapped or cut_off",
                   "crossed");
  options.add_text("first-passage", "TARGET",
                   "how likely bodies get there and how long that takes, from every state of every "
                   "gate: an ending, a gate\nIX,IY, of a matrix a state (name or number), or "
                   "IX,IY,STATE; --json and --csv have all states");
  options.add_count(
      "runs", "N",
      "gate runs with a little more, and as many with a little less of each number "
      "of the scene,\nand as many again for the intervals, on top of --gate-runs; 0: none",
      "20000");
  options.add_number("step", "PART", "how much more and less, as a part of it (default: 0.02)");
  options.add_text(
      "lump", "D,VX,VY",
      "into how many parts the states of each boundary are cut by d, vx and vy (or what other "
      "cells have), to\nsee what so few states would cost (default: 1 each)");
  options.add_count("paths", "N", "the most frequent ways through the field", "5");
  add_ranges(options);
  options.add_count("trials", "N", "also run N trials of the full dynamics, to compare");
  options.add_seed();
  options.add_kept();
  options.add_strict();
  add_cell_program(options);
  add_page(options);
  options.add_figure("visits and paths, durations, starts and influences");
  if (!options.parse(arguments)) return kFine;
  if (options.texts("start").size() > 1) throw UsageError("--start: an analysis is of one start");
  const lattice::ParameterOptions parameters{
      .runs = options.count("runs", 0, 1'000'000),
      .relative_step = number_within(options, "step", 0.02, 1e-6, 0.5),
      .seed = options.seed()};
  if (options.has("trials")) (void)options.trials();  // they are run last
  if (parameters.runs > 0 && parameters.runs < 100)
    throw UsageError("--runs: must be 0, or 100 or more");
  lattice::AnalysisOptions how{.target = target_of(options),
                               .paths = static_cast<std::size_t>(options.count("paths", 0, 1000)),
                               .seed = options.seed()};
  Subject s = open_subject(options, "matrix");
  check_page(options, s);
  if (s.is_recorded())
    refuse(options, {"trials", "step"},
           "for " + s.path +
               (s.foreign ? ", a chain that was made elsewhere" : ", whose runs were recorded"));
  how.lumping = lumping_of(options, s.problem.map().section);
  const auto ranged = over_of(options, s);
  const auto passage = first_passage_asked(options, s);
  s.settle(options);
  const auto of_file = runs_of_file(options, s);
  AnalysedSubject c = analysed(options, s);
  const dynamics::Work work = options.work();
  AnalysedField result{.shown = s.shown(),
                       .start = s.starts.front(),
                       .answer = c.answer,
                       .analysis = lattice::analyze(s.problem, *c.chain, how, work),
                       .step = parameters.relative_step};
  const lattice::Analysis& analysis = result.analysis;
  result.passage = first_passage_of(options, passage, s, c);
  if (s.pool) c.chain.reset();  // that for parameters is larger
  result.parameters = effects_of(parameters, s, c, analysis, work);
  if (options.has("trials")) {
    lattice::FieldCosts costs(s.bin_of_durations(options));
    auto tally = lattice::field_trials(s.problem, {0, options.trials()}, options.seed(), work,
                                       [&](const lattice::FieldTrials& each) { costs.add(each); });
    result.direct = DirectTrials{std::move(tally), std::move(costs)};
  }
  result.shares = shares_of(options, ranged, s, how.target);
  bool clean = c.clean;
  const auto look_at = [&](const dynamics::Health& health, const std::string& where) {
    clean = status_of(options, health, where) == kFine && clean;
  };
  if (result.shares) look_at(result.shares->found.health, "at the points of --over ");
  result.made_by = s.provenance(options);
  options.give_out(result, table_of(result));
  options.warn(rest_warning(c.answer.rest));
  if (const std::string why = analysis.why_unfinished(); !why.empty())
    options.warn("gates visited, visits, times and costs are not known: " + why);
  look_at(result.parameters.health, "in gates with changed numbers ");
  if (result.direct) look_at(result.direct->tally.health, "");
  write_page(options, s, of_file, page_starts(c, s), &result);
  options.draw([&] { return figure_of(result); });
  return exit_status(options, clean);
}

}  // namespace gatewalk::cli
