// SPDX-License-Identifier: MIT
#include "cli/render/rare.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/choice.h"
#include "cli/render/health.h"
#include "cli/render/panel.h"

namespace gatewalk::cli {
namespace {

/// The row whose chance is s.rows[r].
std::int64_t row_of(const lattice::Splitting& s, std::size_t r) {
  return s.first_row + static_cast<std::int64_t>(r);
}

/// "1.23e-12"
std::string chance(double x) { return digits(x, 3); }

std::string interval_text(const std::array<double, 2>& i) {
  return "[" + chance(i[0]) + ", " + chance(i[1]) + "]";
}

bool has_error(const lattice::RowChance& c) {
  return c.probability > 0.0 && c.probability < 1.0 && c.relative_standard_error > 0.0;
}

/// The number of independent trials with the same relative standard error.
double trials_needed(const lattice::RowChance& c) {
  return (1.0 - c.probability) /
         (c.probability * c.relative_standard_error * c.relative_standard_error);
}

/// "53000", "1.2e+15"
std::string rounded(double n) {
  const double unit = std::pow(10.0, std::floor(std::log10(n)) - 1.0);
  const double two_digits = unit * std::round(n / unit);
  return n < 1e9 ? fixed(two_digits, 0) : chance(two_digits);
}

void describe(Fields& out, const lattice::RowChance& c) {
  out.estimate({"probability", "1",
                "chance that a body enters the row, from split trials of the full dynamics"},
               c.probability, c.interval_95());
  out.number({"relative_standard_error", "1",
              "standard error of probability, as a share of it; null: no body came"},
             c.probability > 0.0 ? c.relative_standard_error : kUnknown);
}

}  // namespace

void describe(Fields& out, const RareResult& result) {
  const auto& [event, direct, method, made_by] = result;
  const lattice::Splitting& s = event.splitting;
  const lattice::RowChance last = s.rows.empty() ? lattice::RowChance() : s.rows.back();
  describe(out, last);
  out.count({"row", "1", "row to enter, i_y; bodies start in a row before"},
            s.rows.empty() ? 0 : row_of(s, s.rows.size() - 1));
  out.number({"chain", "1", "chance to enter the row by the Markov chain alone"},
             event.chain.empty() ? kUnknown : event.chain.back());
  out.number({"direct_trials_needed", "1",
              "trials of direct simulation for the same relative standard error; null: unknown"},
             has_error(last) ? trials_needed(last) : kUnknown);
  out.flag(
      {"reached", "whether relative_standard_error is at most the accuracy that was asked for"},
      s.reached);
  out.count({"gate_runs", "1", "gate runs of the chain and of the split trials together"},
            s.gate_runs + event.pool_runs);
  out.count({"split_trials", "1", "independent trials before splitting"}, s.trials);
  out.number({"chain_seconds", "s", "wall-clock time of the chain and its runs"},
             event.chain_seconds);
  out.number({"seconds", "s", "wall-clock time of chain and split trials"}, event.seconds);
  out.list_of(
      {"rows", "each row ahead of the start's, up to the target"}, s.rows.size(),
      [&](Fields& row, std::size_t r) {
        describe(row, s.rows[r]);
        row.count({"row", "1", "row of gates, i_y; bodies start in a row before"}, row_of(s, r));
        row.number({"chain", "1", "chance to enter the row by the Markov chain alone"},
                   event.chain[r]);
        row.optional(direct.trials > 0, [&](Fields& f) {
          const std::int64_t entered = direct.trials > 0 ? direct.entered[r] : 0;
          f.counted({"direct_entered", "1", "trials of direct simulation that entered the row"},
                    entered, static_cast<double>(direct.trials),
                    dynamics::share_interval(entered, direct.trials));
        });
      });
  out.optional(direct.trials > 0, [&](Fields& f) {
    f.object({"direct", "direct simulation for comparison"}, [&](Fields& d) {
      d.count({"trials", "1", "trials of direct simulation"}, direct.trials);
      d.number({"seconds", "s", "wall-clock time of the direct trials"}, direct.seconds);
    });
  });
  describe_status(out, s.health);
  describe_method(out, method);
  describe_made_by(out, made_by);
}

std::string answer_text(const RareResult& result) {
  const auto& [event, direct, method, made_by] = result;
  const lattice::Splitting& s = event.splitting;
  const lattice::RowChance& last = s.rows.back();
  std::string text = fmt::format("Chance to enter row {}: ", row_of(s, s.rows.size() - 1));
  text += last.probability > 0.0
              ? fmt::format("{}, 95 % interval {} (relative standard error {} %).\n",
                            chance(last.probability), interval_text(last.interval_95()),
                            fixed(100 * last.relative_standard_error, 1))
              : fmt::format("at most {} (two-sided 95 %): none of {} trials did.\n",
                            chance(last.at_most), s.trials);
  text += fmt::format(
      "From {} trials of the full dynamics that were split on their way, {} gate runs in "
      "all.\n",
      s.trials, s.gate_runs + event.pool_runs);
  if (has_error(last))
    text += fmt::format("Direct simulation would need about {} trials for the same error.\n",
                        rounded(trials_needed(last)));
  return text + fmt::format("The chain alone predicts {}.\n", chance(event.chain.back()));
}

std::string details_text(const RareResult& result, const lattice::FieldParams& field) {
  const auto& [event, direct, method, made_by] = result;
  const lattice::Splitting& s = event.splitting;
  std::string text = fmt::format(
      "\nThe field has {} columns: a body that leaves it by a side does not come back.\n",
      field.columns);
  if (field.max_gates > 0)
    text += fmt::format(
        "Bodies visit as many gates as they need: field.max_gates = {}, which predict and lattice "
        "keep,\ndoes not count here.\n",
        field.max_gates);
  std::vector<TextColumn> columns{{"row", 6}, {"chance", 12}, {"95 %", 24}, {"chain", 12}};
  if (direct.trials > 0) columns.insert(columns.end(), {{"direct", 12}, {"direct, 95 %", 24}});
  TextTable table(std::move(columns));
  for (std::size_t r = 0; r < s.rows.size(); ++r) {
    const lattice::RowChance& c = s.rows[r];
    std::vector<TextCell> cells = {row_of(s, r), chance(c.probability),
                                   interval_text(c.interval_95()), chance(event.chain[r])};
    if (direct.trials > 0) {
      cells.emplace_back(
          chance(static_cast<double>(direct.entered[r]) / static_cast<double>(direct.trials)));
      cells.emplace_back(interval_text(dynamics::share_interval(direct.entered[r], direct.trials)));
    }
    table.row(cells);
  }
  text += fmt::format("\n{}\nTime: {} s", table.text(), fixed(event.seconds, 1));
  if (direct.trials > 0)
    text += fmt::format("; {} direct trials took {} s", direct.trials, fixed(direct.seconds, 1));
  return text + ".\n" + method_line(method);
}

Figure figure_of(const RareResult& result) {
  const auto& [event, direct, method, made_by] = result;
  const lattice::Splitting& s = event.splitting;
  Panels out;
  Rows &chain = out.data("$chain"), &split = out.data("$split"), &trials = out.data("$direct");
  double least = 1.0;
  for (std::size_t r = 0; r < s.rows.size(); ++r) {
    if (event.chain[r] > 0.0) {
      chain.add(row_of(s, r), event.chain[r]);
      least = std::min(least, event.chain[r]);
    }
    if (const lattice::RowChance& c = s.rows[r]; c.probability > 0.0) {
      split.add(row_of(s, r), c.probability, c.interval_95());
      least = std::min(least, c.probability);
    }
    if (const std::int64_t n = direct.trials; n > 0 && direct.entered[r] > 0)
      trials.add(row_of(s, r), static_cast<double>(direct.entered[r]) / static_cast<double>(n),
                 dynamics::share_interval(direct.entered[r], n));
  }
  Panel& p = out.add({84, 490, 44, 272});
  p.say("How likely a body gets so far", 8, 18);
  p.x = {"row entered", static_cast<double>(s.first_row) - 1.0,
         static_cast<double>(row_of(s, s.rows.size()))};
  p.y = {"chance", std::pow(10.0, std::floor(std::log10(least)) - 0.2), 2, "", "10^{%T}"};
  p.y.logarithmic = true;
  p.key = {"on bottom left Left reverse samplen 1.5 width -4"};
  p.draw(chain, "1:2", "lines", {.colour = kSecondColour, .width = 2}, "chain");
  p.draw(trials, "($1+0.25):2:3:4", "yerrorbars",  // shifted, so that the marks stand side by side
         {.colour = kThirdColour, .mark = 4, .size = 0.5},
         fmt::format("{} direct trials, 95 %", direct.trials));
  p.draw(split, "1:2:3:4", "yerrorbars", {.colour = kFirstColour, .mark = 7, .size = 0.5},
         "splitting, 95 %");
  return out.figure(330);
}

}  // namespace gatewalk::cli
