// SPDX-License-Identifier: MIT
#include "cli/render/first_passage.h"

#include <fmt/core.h>

#include <cmath>

#include "cli/render/final_gates.h"
#include "cli/render/text.h"

namespace gatewalk::cli {
namespace {

/// Numbers of all states of all gates, states in the result's order. A start's own row, behind
/// these, is not of any gate.
GateNumbers of_states(const std::vector<double>& values, const PassageResult& result) {
  const markov::FirstPassages& all = result.found.all;
  GateNumbers table{static_cast<std::size_t>(all.rows), static_cast<std::size_t>(all.columns), {}};
  table.numbers.reserve(table.rows * table.columns * result.order.size());
  for (std::size_t gate = 0; gate < table.rows * table.columns; ++gate)
    for (const int s : result.order)
      table.numbers.push_back(
          values[gate * static_cast<std::size_t>(all.inputs) + static_cast<std::size_t>(s)]);
  return table;
}

}  // namespace

bool PassageResult::has_tables() const {
  constexpr double kMostNumbers = 2e6;
  return static_cast<double>(found.all.columns) * found.all.rows *
             static_cast<double>(order.size()) <=
         kMostNumbers;
}

void describe(Fields& out, const PassageResult& result) {
  const auto& [asked, f, names, order] = result;
  out.text({"target", "what bodies are to reach, as it was asked for"}, asked.text);
  out.estimate({"probability", "1", "share of bodies that get there, or start there"},
               f.chance.mean, known(f.chance.interval));
  out.estimate({"mean_gates", "1", "gates visited before, of bodies that get there"}, f.gates.mean,
               known(f.gates.interval));
  out.estimate({"mean_time_s", "s", "time until then, of the same; null: nobody measured it"},
               f.time.mean, known(f.time.interval));
  std::optional<std::vector<std::string>> states;
  if (result.has_tables()) states.emplace();
  for (std::size_t k = 0; states && k < order.size(); ++k)
    states->push_back(names[static_cast<std::size_t>(order[k])]);
  out.texts({"states", "names of the states; null: tables would have more than 2 million numbers"},
            states);
  out.maybe({"of_states",
             "of bodies that enter a gate in a state, with all of field.max_gates "
             "before them: rows x columns x states"},
            states ? &f.all : nullptr, [&](Fields& of, const markov::FirstPassages& all) {
              const auto table = [&](const Field& field, const std::vector<double>& values) {
                of.gate_numbers(field, of_states(values, result));
              };
              table({"probability", "1", "share that gets there: the committor"}, all.chance);
              table({"never_sampled", "1", "share that reaches a state without any run instead"},
                    all.never_sampled);
              table({"mean_gates", "1",
                     "mean first passage time in gates, of those that get there; null: nobody "
                     "does"},
                    all.draws);
              of.gate_numbers({"mean_time_s", "s", "the same in seconds; null: nobody measured it"},
                              all.totals.empty()
                                  ? std::nullopt
                                  : std::optional(of_states(all.totals.front(), result)));
            });
  out.optional(!f.gates.why_none.empty(), [&](Fields& o) {
    o.text({"why_no_interval", "why the means have none, though there are groups of trials"},
           f.gates.why_none);
  });
}

std::string text_of(const PassageResult& result) {
  const lattice::FirstPassage& f = result.found;
  std::string text =
      fmt::format("first passage to {}: {} %", result.asked.text, percents(f.chance.mean));
  if (const auto& [low, high] = f.chance.interval; std::isfinite(low))
    text += fmt::format(" [{}, {}]", percents(low), percents(high));
  text += " of all bodies get there";
  if (std::isfinite(f.gates.mean)) {
    text += "; those that do take " + with_limits(f.gates.mean, f.gates.interval, 3, " gates");
    if (std::isfinite(f.time.mean))
      text += " and " + with_limits(f.time.mean, f.time.interval, 3, " s");
    text += " on average";
    if (!f.gates.why_none.empty()) text += fmt::format(" (no interval: {})", f.gates.why_none);
  }
  return text + "\n\n";
}

}  // namespace gatewalk::cli
