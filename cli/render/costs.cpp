// SPDX-License-Identifier: MIT
#include "cli/render/costs.h"

#include <fmt/core.h>

#include <cmath>
#include <vector>

#include "cli/fields/text.h"
#include "cli/render/final_gates.h"

namespace gatewalk::cli {
namespace {

using dynamics::Cost;
using lattice::FieldCosts;

const std::vector<dynamics::CostInfo>& costs_of(const ShownField& shown) {
  return shown.map.section.costs;
}

/// Costs of trials with this ending, or of all trials without one.
struct SpentByTrials : Spent {
  std::int64_t trials;

  SpentByTrials(const FieldCosts& costs, std::optional<markov::Ending> ending) {
    const FieldCosts::Sums sums = ending ? costs.of(*ending) : costs.all();
    const auto steps = ending ? costs.durations(*ending) : costs.durations();
    trials = sums.trials;
    share = static_cast<double>(trials) / static_cast<double>(costs.all().trials);
    for (std::size_t c = 0; c < mean.size(); ++c) {
      mean[c] = sums.mean(c);
      sd[c] = sums.sd(c);
    }
    for (std::size_t q = 0; q < quantiles.size(); ++q)
      quantiles[q] = lattice::quantile(steps, kLevels[q]);
  }
};

}  // namespace

double Spent::cost_of_transport(double mass) const {
  return of(Cost::forward) > 0.0
             ? (of(Cost::propulsion_work) + of(Cost::random_work)) / (mass * of(Cost::forward))
             : kUnknown;
}

void describe(Fields& out, const Spent& s, const ShownField& shown) {
  for (std::size_t c = 0; c < costs_of(shown).size(); ++c) {
    const std::string &key = costs_of(shown)[c].key, mean = "mean_" + key, sd = "sd_" + key;
    const Field of_mean =
        Field(mean, "its own",
              "mean of this cost over the bodies of the group; null: nobody measured it")
            .varying("mean_<cost>");
    if (s.mean_95.empty())
      out.number(of_mean, s.mean[c]);
    else
      out.estimate(of_mean, s.mean[c], s.mean_95[c]);
    out.number(Field(sd, "its own",
                     "standard deviation of this cost over the bodies of the group; null: nobody "
                     "measured it")
                   .varying("sd_<cost>"),
               s.sd[c]);
  }
  out.numbers(
      {"quantiles_time_s", "s", "5, 25, 50, 75 and 95 % quantiles of time; null: too few bodies"},
      {s.quantiles.begin(), s.quantiles.end()});
  out.optional(shown.mass.has_value(), [&](Fields& f) {
    f.number({"cost_of_transport_J_per_kg_m", "J/(kg m)",
              "mean work of both forces / (body mass * mean distance forward); null: no distance "
              "forward"},
             s.cost_of_transport(shown.mass.value_or(kUnknown)));
  });
}

CostTable::CostTable(const ShownField& shown)
    : costs_(costs_of(shown).size()), mass_(shown.mass), lines_([&] {
        std::vector<TextColumn> columns = {{"", -11}, {"", 11}, {"", 18}};
        if (shown.mass)
          columns.resize(7, {"", 11});
        else
          columns.resize(2 + costs_of(shown).size(), {"", 11, 0, "", " "});
        return columns;
      }()) {
  if (mass_) header_ += "   work/J of: push     noise   lost/J   J/(kg m)";
  for (std::size_t c = 1; c < costs_ && !mass_; ++c)
    header_ += fmt::format(" {:>11}", costs_of(shown)[c].key);
  header_ += "\n";
}

void CostTable::add(const std::string& name, const Spent& s) {
  const auto number = [](double x) {
    return std::isfinite(x) ? fixed(x, std::abs(x) < 10 ? 3 : std::abs(x) < 1000 ? 1 : 0) : "-";
  };
  const double low = s.quantiles.front(), high = s.quantiles.back();
  std::vector<TextCell> cells = {
      name, number(s.mean.front()),
      std::isfinite(low) ? fmt::format("{} to {}", fixed(low, 2), fixed(high, 2)) : "-"};
  if (mass_)
    for (const double x : {s.of(Cost::propulsion_work), s.of(Cost::random_work), s.of(Cost::lost),
                           s.cost_of_transport(*mass_)})
      cells.emplace_back(number(x));
  for (std::size_t c = 1; c < costs_ && !mass_; ++c) cells.emplace_back(number(s.mean[c]));
  lines_.row(cells);
}

void describe_costs(Fields& out, const FieldCosts& costs, const ShownField& shown) {
  out.object({"costs", "times and costs of trials: of all trials, and by their ending"},
             [&](Fields& endings) {
               const auto add = [&](std::string_view key, std::string_view who,
                                    std::optional<markov::Ending> ending) {
                 const SpentByTrials spent(costs, ending);
                 endings.optional(spent.trials > 0, [&](Fields& f) {
                   f.object(Label(key, who).shared("costs_of_trials"), [&](Fields& one) {
                     describe(one, spent, shown);
                     one.count({"trials", "1", "number of trials in the group"}, spent.trials);
                   });
                 });
               };
               add("all", "times and costs of all trials", {});
               for (const EndingName& e : kAllEndingNames)
                 add(e.key, fmt::format("times and costs of trials whose bodies {}", meaning_of(e)),
                     e.ending);
             });
}

std::string table_of(const FieldCosts& costs, const ShownField& shown) {
  CostTable table(shown);
  const auto add = [&](const char* name, std::optional<markov::Ending> ending) {
    if (const SpentByTrials spent(costs, ending); spent.trials > 0) table.add(name, spent);
  };
  add("all", {});
  for (const EndingName& e : kAllEndingNames) add(e.name, e.ending);
  return "Times and costs of a trial, by ending\n" + table.text();
}

}  // namespace gatewalk::cli
