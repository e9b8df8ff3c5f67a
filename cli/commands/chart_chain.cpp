// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>

#include "cli/arguments.h"
#include "cli/render/chain_error.h"
#include "cli/render/health.h"
#include "lattice/text/digits.h"

namespace gatewalk::cli {
namespace {

constexpr std::int64_t kMostPilotTrials =
    1'000'000;  // per start; all entries that the trials saw are in memory

/// The values of --bins in ascending order.
std::vector<double> factors_of(const NumbersOption& given, lattice::BinsChoice::Kind kind) {
  std::vector<double> factors = given ? given.values() : lattice::ChainErrorOptions{}.factors;
  std::sort(factors.begin(), factors.end());
  if (std::adjacent_find(factors.begin(), factors.end()) != factors.end())
    throw UsageError("--bins: the same factor twice");
  for (const double factor : factors) {
    try {
      if (kind == lattice::BinsChoice::Kind::automatic) (void)lattice::states_for(factor);
    } catch (const std::invalid_argument& e) {
      throw UsageError(fmt::format("--bins {}: {}", lattice::toml_float(factor), e.what()));
    }
  }
  return factors;
}

}  // namespace

int run_chart_chain(const Arguments& arguments) {
  Options options(
      "chart chain SCENE -o DIR [options]",
      "Shows how large the chain's error is for its cost, and when direct simulation is better. "
      "chart\n"
      "chain compares matrices of coarser and finer bins with 10 to 10000 trials a row, and trees\n"
      "(predict --accuracy), with the full dynamics and with direct simulation at the same cost. "
      "It\n"
      "writes chain.csv, chain.json and chain.svg into DIR.",
      "gatewalk chart chain scenes/field.toml -o results/chain --truth-trials 1e5");
  options.scene();
  const std::vector<std::string> files{"chain.csv", "chain.json", "chain.svg"};
  options.output_folder("folder to write to, made if missing", files);
  const CountOption truth_trials = options.add_count(
      "truth-trials", "N", "trials of the full dynamics per start, from which errors are measured",
      "1e5");
  const CountOption runs_limit =
      options.add_count("runs-limit", "N", "most gate runs of one matrix or tree", "1e6");
  const NumbersOption factors = options.add_numbers(
      "bins", "FACTOR",
      "bins per axis, as a multiple of the bins that build takes without --bins (may be repeated; "
      "default: 0.5, 1, 2, 4)");
  const CountOption visited = options.add_count(
      "visited", "N",
      "also chart matrices whose rows start where N full trials per start were seen to enter; "
      "these "
      "trials count as cost. Without it rows start anywhere in their bins. Bins made from pilot "
      "trials always start where bodies enter, by default from 2000 trials per start");
  const TextsOption given = add_starts(options);
  options.add_seed();
  options.add_strict();
  options.add_figure("the figure of the folder");
  options.add_details("tables of all matrices, and what limits the best one");
  options.most_used({"output", "start", "truth-trials", "runs-limit", "bins"});
  if (!options.parse(arguments)) return kFine;
  lattice::Scene scene = options.read_scene();
  const std::vector<dynamics::Entry> starts = starts_of(given, scene);
  for (const dynamics::Entry& start : starts)
    if (start.face != dynamics::Boundary::enter)
      throw UsageError("chart chain: starts are entries from below, d_m of its table is their x");
  lattice::require_inside(starts, scene);
  const auto bins = lattice::usual_bins(scene).kind;
  if (bins != lattice::BinsChoice::Kind::automatic)
    require_inside_bins(options, starts, scene, lattice::fixed_space(scene));
  auto settled = settle_method(options, scene, lattice::RunsFrom::everywhere);
  lattice::ChainErrorOptions chosen{.starts = starts,
                                    .truth_trials = truth_trials.value(100),
                                    .runs_limit = runs_limit.value(),
                                    .seed = options.seed()};
  if (visited) chosen.visited = visited.value(1, kMostPilotTrials);
  chosen.factors = factors_of(factors, bins);
  lattice::ChainErrorPlan plan = lattice::plan_chain_error(scene, chosen, options.work());
  if (plan.empty())
    throw UsageError(
        fmt::format("--runs-limit {}: too few for {} trials a row of any of these bins",
                    chosen.runs_limit, lattice::kChainTrials.front()));
  const ResultFolder folder(options, files);

  options.remark("measuring the cost of a trial and of a gate run");
  const ChainErrorResult result{lattice::chart_chain_error(scene, std::move(plan), options.work()),
                                std::move(settled), options.provenance(scene)};
  const auto& chart = result.chart;
  folder.write("chain.csv", csv_of(chart), "chain.json", result);
  options.give_out(result, {answer_text(chart) + beware_of(chart.health), details_text(chart)});
  folder.draw("chain.svg", figure_of(chart));
  const int exit = status_of(options, chart.health);
  options.draw([&] { return figure_of(chart); });
  return exit;
}

}  // namespace gatewalk::cli
