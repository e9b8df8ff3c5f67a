#include "cli/render/report.h"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "cli/render/quantity.h"
#include "cli/version.h"

namespace gatewalk::cli {

Json manifest(const Options& options, const lattice::Scene& scene) {
  Json m;
  m["program"] = "gatewalk";
  m["version"] = kVersion;
  m["commit"] = kCommit;
  m["command"] = options.canonical();
  if (options.has("seed")) m["seed"] = options.seed();
  m["scene"] = lattice::to_toml(scene);
  if (!scene.derived.empty()) m["derived"] = scene.derived;  // keys that the scene left out
  return m;
}

Json to_json(const dynamics::Health& h) {
  Json j;
  j["clean"] = h.clean();
  j["runs"] = h.runs;
  j["runs_penetrating_over_1_percent"] = h.penetrating;
  j["runs_creating_energy"] = h.creating_energy;
  j["runs_too_fast_for_the_step"] = h.fast;
  j["runs_beyond_the_stability_bound"] = h.unstable;
  j["runs_not_finite"] = h.broken;
  j["contacts_without_a_formula"] = h.undefined_contacts;
  j["steps_forced_to_hold"] = h.forced_holds;
  j["worst_penetration_m"] = h.worst_penetration;
  j["worst_energy_created_J"] = h.worst_energy_created;
  j["worst_speed_m_per_s"] = h.worst_speed;
  j["steps"] = h.steps;
  j["evaluations"] = h.evaluations;
  j["impacts"] = h.impacts;
  j["trials_checked"] = h.checked_trials;  // by a better method
  j["outcome_error_seen"] = h.outcome_error;
  return j;
}

dynamics::Health health_from(const Json& j) {
  dynamics::Health h;
  h.runs = j.at("runs");
  h.penetrating = j.at("runs_penetrating_over_1_percent");
  h.creating_energy = j.at("runs_creating_energy");
  h.fast = j.at("runs_too_fast_for_the_step");
  h.unstable = j.at("runs_beyond_the_stability_bound");
  h.broken = j.at("runs_not_finite");
  h.undefined_contacts = j.at("contacts_without_a_formula");
  h.forced_holds = j.at("steps_forced_to_hold");
  h.worst_penetration = j.at("worst_penetration_m");
  h.worst_energy_created = j.at("worst_energy_created_J");
  h.worst_speed = j.at("worst_speed_m_per_s");
  h.steps = j.at("steps");
  h.evaluations = j.at("evaluations");
  h.impacts = j.at("impacts");
  h.checked_trials = j.value("trials_checked", std::int64_t{0});  // older files have none
  h.outcome_error = j.value("outcome_error_seen", 0.0);
  return h;
}

std::string complaint(const dynamics::Health& h) {
  if (h.clean()) return "";
  const auto of_runs = [&](std::int64_t n) {
    return std::to_string(n) + " of " + std::to_string(h.runs) + " gate runs";
  };
  std::string text = "the method showed faults:";
  if (h.penetrating > 0)
    text += " the disc sank into a beam in " + of_runs(h.penetrating) + " (worst " +
            quantity(h.worst_penetration, "m") + ");";
  if (h.creating_energy > 0)
    text += " energy appeared from nothing in " + of_runs(h.creating_energy) + " (worst " +
            quantity(h.worst_energy_created, "J") + ");";
  if (h.fast > 0)
    text += " disc or beam moved over half a radius in one step in " + of_runs(h.fast) +
            ", hits may have been missed: take a smaller run.step_s;";
  if (h.unstable > 0)
    text += " the step is longer than the method's stability bound for these beams in " +
            of_runs(h.unstable) + ": take a smaller run.step_s or another run.method;";
  if (h.outcomes_off())
    text += " a better method gives other outcomes for at least " + percent(h.outcome_error, 1.0) +
            " of " + std::to_string(h.checked_trials) +
            " trials that were run again: take a smaller run.step_s, or run.method = \"auto\";";
  if (h.undefined_contacts > 0)
    text += " " + std::to_string(h.undefined_contacts) +
            " steps overlapped a joint, for which it has no formula;";
  if (h.piled_up())
    text += " hits piled up and were forced to end in " + std::to_string(h.forced_holds) + " of " +
            std::to_string(h.steps) + " steps;";
  if (h.broken > 0) text += " " + std::to_string(h.broken) + " runs stopped being finite numbers;";
  text.back() = '.';
  return text;
}

Json to_json(const lattice::Comparison& c) {
  Json j;
  j["corrcoef"] = c.corrcoef;
  j["corrcoef_floor"] = c.floor.corrcoef;
  j["rmse_per_100"] = c.rmse_per_100;
  j["rmse_per_100_floor"] = c.floor.rmse_per_100;
  j["total_variation"] = c.total_variation;
  j["total_variation_floor"] = c.floor_total_variation;
  j["total_variation_floor_95"] = c.floor_total_variation_95;
  j["p_values"] = {{"chi_squared", c.p_chi_squared},
                   {"total_variation", c.p_total_variation},
                   {"energy_distance", c.p_energy},
                   {"null_draws", c.null_draws}};
  return j;
}

namespace {

template <class Cells>
Json rows_of(const Cells& cells) {
  Json rows = Json::array();
  for (Eigen::Index r = 0; r < cells.rows(); ++r) {
    Json row = Json::array();
    for (Eigen::Index c = 0; c < cells.cols(); ++c) row.push_back(cells(r, c));
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

Json grid(const markov::CellCounts& cells) { return rows_of(cells); }
Json grid(const markov::CellProbabilities& cells) { return rows_of(cells); }

namespace {

/// Places from `first` on, `count` of them, printed in blocks of `block`.
struct Span {
  Eigen::Index first, count, block;
};

/// All of them if they can be printed; else those between ends that hold next to nothing, in blocks
/// if they are still too many.
Span span_of(const Eigen::ArrayXd& shares, Eigen::Index most) {
  constexpr double kNextToNothing = 5e-5;  // prints as 0.00 %
  Span span{0, shares.size(), 1};
  if (span.count <= most) return span;
  const double small = kNextToNothing * shares.sum();
  Eigen::Index low = 0, high = shares.size() - 1;
  for (double left = shares(low); left < small && low < high; left += shares(low)) ++low;
  for (double left = shares(high); left < small && high > low; left += shares(high)) --high;
  span = {low, high - low + 1, (high - low) / most + 1};
  return span;
}

}  // namespace

std::string map_of(const markov::CellProbabilities& shares, const std::string& what) {
  const Span rows = span_of(shares.rowwise().sum(), 40);
  Span columns = span_of(shares.colwise().sum().transpose(), 15);
  const Eigen::Index half = shares.cols() / 2;
  std::string text = what + ", % of trials (i_y upwards, i_x to the right";
  if (rows.block > 1 || columns.block > 1) {
    // The start's column in the middle of a block, so that left and right can be compared.
    columns.block |= 1;
    const Eigen::Index end = columns.first + columns.count;
    const Eigen::Index to_left = half - columns.block / 2 - columns.first;  // from the middle block
    columns.first +=
        to_left - (to_left + (to_left > 0 ? columns.block - 1 : 0)) / columns.block * columns.block;
    columns.count = end - columns.first;
    text += "; blocks of " + std::to_string(columns.block) + " x " + std::to_string(rows.block) +
            " gates: i_x in their middle, i_y at their lower end";
  }
  text += ")\n";
  double shown = 0.0;
  for (Eigen::Index r = (rows.count - 1) / rows.block * rows.block; r >= 0; r -= rows.block) {
    text += padded(std::to_string(rows.first + r), 4) + " |";
    for (Eigen::Index c = columns.first; c < columns.first + columns.count; c += columns.block) {
      const Eigen::Index left = std::max<Eigen::Index>(0, c),
                         right = std::min(shares.cols(), c + columns.block);
      const double share =
          shares.block(rows.first + r, left, std::min(rows.block, rows.count - r), right - left)
              .sum();
      shown += share;
      text += share == 0.0 ? padded(".", 7) : padded(fixed(100.0 * share, 2), 7);
    }
    text += "\n";
  }
  text += "  i_x ";
  for (Eigen::Index c = columns.first; c < columns.first + columns.count; c += columns.block)
    text += padded(std::to_string(c + columns.block / 2 - half), 7);
  text += "\n";
  if (rows.count < shares.rows() || columns.count < shares.cols())
    text += "elsewhere in the " + std::to_string(shares.cols()) + " x " +
            std::to_string(shares.rows()) +
            " gates: " + percent(std::max(0.0, shares.sum() - shown), 1.0, 4) + "\n";
  return text;
}

std::string fixed(double x, int digits) {
  if (!std::isfinite(x)) return "-";
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*f", digits, x);
  return buffer;
}

std::string percent(double part, double whole, int digits) {
  return fixed(whole > 0.0 ? 100.0 * part / whole : std::nan(""), digits) + " %";
}

EndingShares::EndingShares(const std::array<double, markov::kEndings>& shares) : share(shares) {
  interval.fill({std::nan(""), std::nan("")});
}

EndingShares::EndingShares(const std::array<std::int64_t, markov::kEndings>& counts,
                           std::int64_t trials) {
  for (std::size_t e = 0; e < markov::kEndings; ++e) {
    share[e] = static_cast<double>(counts[e]) / static_cast<double>(trials);
    interval[e] = share_interval(counts[e], trials);
  }
}

EndingShares::EndingShares(const markov::FinalDistribution& prediction,
                           const lattice::MatrixNoise& noise, int max_gates)
    : EndingShares(prediction.endings) {
  if (noise.replicates() == 0) return;
  constexpr double kRounding = 1e-12;
  for (std::size_t e = 0; e < markov::kEndings; ++e) {
    interval[e] = noise.interval_95(static_cast<markov::Ending>(e));
    // Where no resampled matrix shows a spread: what the runs of the row that all walks begin in
    // can rule out.
    if (interval[e][1] - interval[e][0] <= kRounding)
      interval[e] =
          interval_of_share(std::clamp(share[e], 0.0, 1.0), static_cast<double>(noise.runs()));
  }
  if (max_gates == 0) interval[static_cast<std::size_t>(markov::Ending::cut_off)] = {0.0, 0.0};
}

namespace {

template <class Values>
Json by_name(const Values& values) {
  Json j;
  for (const EndingName& e : kEndingNames) j[e.key] = values[static_cast<std::size_t>(e.ending)];
  return j;
}

/// A share in % with two decimals, or two digits if that would be 0.
std::string percents(double share) {
  if (!(share > 0.0 && share < 5e-5)) return fixed(100.0 * share, 2);
  std::ostringstream text;
  text.precision(2);
  text << 100.0 * share;
  return text.str();
}

}  // namespace

Json endings(const std::array<std::int64_t, markov::kEndings>& counts) { return by_name(counts); }
Json endings(const std::array<double, markov::kEndings>& shares) { return by_name(shares); }
Json endings_95(const EndingShares& shares) { return by_name(shares.interval); }

std::string with_interval(double share, const std::array<double, 2>& interval) {
  if (std::isnan(interval[0])) return percents(share);
  return percents(share) + " [" + percents(interval[0]) + ", " + percents(interval[1]) + "]";
}

std::string endings_text(const EndingShares& shares, const std::string& of) {
  std::string text;
  for (const EndingName& e : kEndingNames) {
    const auto at = static_cast<std::size_t>(e.ending);
    text += padded(e.name, -11) + padded(percents(shares.share[at]), 7) + " %";
    if (!std::isnan(shares.interval[at][0]))
      text +=
          "  [" + percents(shares.interval[at][0]) + ", " + percents(shares.interval[at][1]) + "]";
    if (at == static_cast<std::size_t>(kEndingNames.front().ending)) text += "  " + of;
    text += "\n";
  }
  return text;
}

std::string limits_text(const lattice::Scene& scene) {
  std::string text = "(trapped: still in a gate after " + quantity(scene.gate.run.time_limit, "s");
  if (scene.field.max_gates > 0)
    text += "; cut off: would go on from gate number " + std::to_string(scene.field.max_gates) +
            ", the limit field.max_gates, 0 for none";
  return text + ")\n";
}

void warn_if_too_few_gates(const lattice::Scene& scene) {
  if (scene.field.max_gates > 0 && scene.field.max_gates < scene.field.rows)
    warn("nobody can cross: field.max_gates = " + std::to_string(scene.field.max_gates) +
         " is less than field.rows = " + std::to_string(scene.field.rows));
}

std::string map_of_trapped(const markov::CellProbabilities& shares) {
  constexpr Eigen::Index kMost = 15;
  if (shares.rows() > kMost || shares.cols() > kMost || shares.sum() == 0.0) return "";
  return map_of(shares, "of these trapped");
}

Json to_json(const dynamics::GateTally& tally) {
  Json json;
  json["trials"] = tally.trials;
  json["traversed"] = tally.traversed();
  json["traversed_left"] = tally.traversed_left;
  json["traversed_right"] = tally.traversed_right;
  json["traversed_even"] = tally.traversed_even;
  json["exited_left"] = tally.exited_left;
  json["exited_right"] = tally.exited_right;
  json["trapped"] = tally.trapped;
  json["not_finite"] = tally.broken;
  json["intervals_95"] = Json::object();
  for (const char* outcome :
       {"traversed", "traversed_left", "traversed_right", "exited_left", "exited_right", "trapped"})
    json["intervals_95"][outcome] = share_interval(json[outcome].get<std::int64_t>(), tally.trials);
  return json;
}

std::string scene_line(const lattice::Scene& scene) {
  const auto& gate = scene.gate;
  const auto& start = scene.start;
  const auto number = [](double x) {
    std::ostringstream text;
    text << x;
    return text.str();
  };
  // Two numbers with one unit, that of the larger.
  const Sized place = readable_unit("m", std::max(std::abs(start.x), std::abs(start.y)));
  const Sized speed = readable_unit("m/s", std::max(std::abs(start.vx), std::abs(start.vy)));
  return scene.source + ": start x " + number(start.x / place.size) + ", y " +
         number(start.y / place.size) + " " + place.name + ", v (" + number(start.vx / speed.size) +
         ", " + number(start.vy / speed.size) + ") " + speed.name + "; disc " +
         quantity(gate.body.mass, "kg", 6) + ", R " + quantity(gate.body.radius, "m", 6) + "; F " +
         quantity(gate.forces.propulsion, "N", 6) + ", Rm " + quantity(gate.forces.random, "N", 6) +
         "; beams k " + number(gate.beams.stiffness_left) + " / " +
         number(gate.beams.stiffness_right) + ", d " + number(gate.beams.damping) + "; " +
         gate.run.method + " " +
         (gate.run.method == "event" ? quantity(gate.run.event_tolerance, "m", 6)
                                     : quantity(gate.run.step, "s", 6)) +
         "\n";
}

std::string p_text(double p) { return p < 0.001 ? "<0.001" : fixed(p, 3); }

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string padded(const std::string& text, int width) {
  const auto wanted = static_cast<std::size_t>(std::abs(width));
  // A character of UTF-8 is as wide as its first byte alone.
  const auto size = static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
  if (size >= wanted) return text;
  const std::string space(wanted - size, ' ');
  return width > 0 ? space + text : text + space;
}

}  // namespace gatewalk::cli
