// SPDX-License-Identifier: MIT
#include "cli/render/first_passage.h"

#include <fmt/core.h>

#include <cmath>

#include "cli/fields/text.h"
#include "cli/render/final_gates.h"

namespace gatewalk::cli {
namespace {

/// Numbers for all states of all gates, in the order of the result's states. A start's own row
/// follows them and belongs to no gate.
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
  out.text({"target", "what bodies are to reach, as --first-passage gives it"}, asked.text);
  out.estimate({"probability", "1",
                "share of bodies that reach the target; a body that starts there has reached it"},
               f.chance.mean, f.chance.interval);
  out.estimate(
      {"mean_gates", "1",
       "mean number of gates visited before the target is reached, of bodies that reach it"},
      f.gates.mean, f.gates.interval);
  out.estimate({"mean_time_s", "s",
                "mean time until the target is reached, of bodies that reach it; null: none does, "
                "or times were not measured"},
               f.time.mean, f.time.interval);
  std::optional<std::vector<std::string>> states;
  if (result.has_tables()) states.emplace();
  for (std::size_t k = 0; states && k < order.size(); ++k)
    states->push_back(names[static_cast<std::size_t>(order[k])]);
  out.texts({"states",
             "names of the states, in the order of of_states; null: there would be over 2 million "
             "numbers"},
            states);
  out.maybe(
      {"of_states",
       "first passages from each state of each gate, with all of field.max_gates ahead: row, "
       "column, state"},
      states ? &f.all : nullptr, [&](Fields& of, const markov::FirstPassages& all) {
        const auto table = [&](const Field& field, const std::vector<double>& values) {
          of.gate_numbers(field, of_states(values, result));
        };
        table({"probability", "1",
               "committor: share of bodies from this state that reach the target"},
              all.chance);
        table({"never_sampled", "1",
               "share of bodies that instead reach a state from which there is no gate run"},
              all.never_sampled);
        table(
            {"mean_gates", "1",
             "mean first passage time in gates, of bodies that reach the target; null: none does"},
            all.draws);
        of.gate_numbers({"mean_time_s", "s",
                         "mean first passage time in seconds, of bodies that reach the target; "
                         "null: none does, or not measured"},
                        all.totals.empty() ? std::nullopt
                                           : std::optional(of_states(all.totals.front(), result)));
      });
  out.optional(!f.gates.why_none.empty(), [&](Fields& o) {
    o.text({"why_no_interval", "why mean_gates and mean_time_s have no 95 % interval"},
           f.gates.why_none);
  });
}

std::string text_of(const PassageResult& result) {
  const lattice::FirstPassage& f = result.found;
  const auto& [ending, cell, input] = result.asked.target;
  std::string target = result.asked.text;
  if (input && !cell) {  // a state by its number or its name
    const std::string& name = result.names[static_cast<std::size_t>(*input)];
    target = "state " + target + (name == target ? "" : fmt::format(" ({})", name));
  }
  std::string text = fmt::format("First passage to {}: {} %", target, percents(f.chance.mean));
  if (const auto& [low, high] = f.chance.interval; std::isfinite(low))
    text += fmt::format(" [{}, {}]", percents(low), percents(high));
  text += " of all bodies reach it";
  if (std::isfinite(f.gates.mean)) {
    text += ", on average after " + with_limits(f.gates.mean, f.gates.interval, 3, " gates");
    if (std::isfinite(f.time.mean))
      text += " and " + with_limits(f.time.mean, f.time.interval, 3, " s");
    if (!f.gates.why_none.empty()) text += fmt::format(" (no interval: {})", f.gates.why_none);
  }
  return wrapped(text + ".");
}

}  // namespace gatewalk::cli
