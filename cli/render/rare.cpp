// SPDX-License-Identifier: MIT
#include "cli/render/rare.h"

#include <cmath>

#include "cli/render/health.h"
#include "cli/render/json.h"
#include "cli/render/text.h"

namespace gatewalk::cli {
namespace {

/// "1.23e-12"
std::string chance(double x) { return digits(x, 3); }

std::string interval_text(const std::array<double, 2>& i) {
  return "[" + chance(i[0]) + ", " + chance(i[1]) + "]";
}

Json to_json(const lattice::RowChance& c) {
  const bool known = c.probability > 0.0;
  return {{"probability", c.probability},
          {"interval_95", c.interval_95()},
          {"relative_standard_error", known ? Json(c.relative_standard_error) : Json()}};
}

bool has_error(const lattice::RowChance& c) {
  return c.probability > 0.0 && c.probability < 1.0 && c.relative_standard_error > 0.0;
}

/// Independent trials whose share has the same relative standard error.
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

}  // namespace

Json to_json(const lattice::RareEvent& event, const DirectRows& direct) {
  const lattice::Splitting& s = event.splitting;
  Json json = to_json(s.rows.back());
  json["row"] = s.rows.size();
  json["chain"] = event.chain.back();
  json["direct_trials_needed"] =
      has_error(s.rows.back()) ? Json(trials_needed(s.rows.back())) : Json();
  json["reached"] = s.reached;
  json["gate_runs"] = s.gate_runs + event.pool_runs;
  json["split_trials"] = s.trials;
  json["chain_seconds"] = event.chain_seconds;
  json["seconds"] = event.seconds;
  for (std::size_t r = 0; r < s.rows.size(); ++r) {
    Json row = to_json(s.rows[r]);
    row["row"] = r + 1;
    row["chain"] = event.chain[r];
    if (direct.trials > 0) {
      row["direct_entered"] = direct.entered[r];
      row["direct_interval_95"] = dynamics::share_interval(direct.entered[r], direct.trials);
    }
    json["rows"].push_back(std::move(row));
  }
  if (direct.trials > 0) json["direct"] = {{"trials", direct.trials}, {"seconds", direct.seconds}};
  json["status"] = to_json(s.health);
  return json;
}

std::string table_of(const lattice::RareEvent& event, const DirectRows& direct,
                     const lattice::FieldParams& field) {
  const lattice::Splitting& s = event.splitting;
  const lattice::RowChance& last = s.rows.back();
  std::string table = "chance to enter row " + std::to_string(s.rows.size()) + ": ";
  if (last.probability > 0.0)
    table += chance(last.probability) + " " + interval_text(last.interval_95()) +
             ", relative standard error " + fixed(100 * last.relative_standard_error, 1) + " %";
  else
    table += "none of " + std::to_string(s.trials) + " trials did: at most " +
             chance(last.at_most) + " (two-sided 95 %)";
  table += "\nthe chain alone says " + chance(event.chain.back());
  if (has_error(last))
    table += "; direct simulation would need " + rounded(trials_needed(last)) +
             " trials for the same error";
  table += "\nof a field of " + std::to_string(field.columns) +
           " columns: who leaves it by a side does not come back";
  if (field.max_gates > 0)
    table += "; bodies go on for as long as it takes:\nfield.max_gates = " +
             std::to_string(field.max_gates) +
             ", which predict and lattice keep, does not count here";
  table += "\n\n   row      chance              95 %            chain";
  if (direct.trials > 0) table += "      direct simulation, 95 %";
  table += "\n";
  for (std::size_t r = 0; r < s.rows.size(); ++r) {
    const lattice::RowChance& c = s.rows[r];
    table += padded(std::to_string(r + 1), 6) + padded(chance(c.probability), 12) +
             padded(interval_text(c.interval_95()), 24) + padded(chance(event.chain[r]), 12);
    if (direct.trials > 0) {
      const auto [low, high] = dynamics::share_interval(direct.entered[r], direct.trials);
      table += padded(chance(static_cast<double>(direct.entered[r]) /
                             static_cast<double>(direct.trials)),
                      12) +
               padded(interval_text({low, high}), 24);
    }
    table += "\n";
  }
  return table + std::to_string(s.trials) + " trials that were split, " +
         std::to_string(s.gate_runs + event.pool_runs) + " gate runs, " + fixed(event.seconds, 1) +
         " s" +
         (direct.trials > 0 ? "; " + std::to_string(direct.trials) + " direct trials, " +
                                  fixed(direct.seconds, 1) + " s"
                            : "") +
         "\n";
}

}  // namespace gatewalk::cli
