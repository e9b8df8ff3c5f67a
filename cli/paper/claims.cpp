// SPDX-License-Identifier: MIT
#include "cli/paper/claims.h"

#include "cli/paper/studies.h"
#include "cli/render/csv.h"
#include "cli/render/json.h"
#include "cli/render/text.h"

namespace gatewalk::cli {

std::string number(double x, int digits) { return fixed(x, digits); }
std::string of(std::int64_t part, std::int64_t whole) {
  return std::to_string(part) + " of " + std::to_string(whole);
}

Share fig8_at(const Findings& f, double damping, double force, double random) {
  return f.fig8.at({{kDamping, damping}, {kPropulsion, force}, {kRandom, random}})
      .traversed_share();
}
const SweepPoint& fig12_at(const Findings& f, double damping, double force, double random,
                           double k_left) {
  return f.fig12.at(
      {{kDamping, damping}, {kPropulsion, force}, {kRandom, random}, {kLeftStiffness, k_left}});
}

std::vector<Claim> claims_of(const Findings& f) {
  return {rises_with_propulsion(f),
          rises_then_falls(f),
          peak_at_20(f),
          exits_grow(f),
          softer_side(f),
          accord(f),
          thirteen_and_eight(f),
          alike(f),
          percentage(f, "fifty_two_50", "Sec. III-B, Fig. 9B", 300, 50, 52),
          percentage(f, "fifty_two_10", "Sec. III-B, Fig. 9B", 300, 10, 52),
          percentage(f, "ninety_eight_50", "Sec. III-B, Fig. 9C", 100, 50, 98),
          percentage(f, "ninety_eight_10", "Sec. III-B, Fig. 9C", 100, 10, 98),
          right_share_falls(f, false),
          right_share_falls(f, true),
          fig12_propulsion(f),
          accuracy(f),
          table4_row(f, 0, "table4_1"),
          table4_row(f, 1, "table4_2"),
          table4_row(f, 2, "table4_3"),
          table4_row(f, 3, "table4_4"),
          speed_up(f),
          side_entries(f),
          side_entries_free(),
          velocities(f),
          drag(f),
          states(),
          thirteen_steps(f),
          landscape_sides(),
          basin(f),
          escape(f),
          steep(f),
          above_landscape(f),
          many_hits(f),
          euler_step(f),
          run_time(f),
          inertia()};
}

Json to_json(const std::vector<Claim>& claims) {
  Json list = Json::array();
  for (const Claim& c : claims)
    list.push_back({{"id", c.id},
                    {"where", c.where},
                    {"claim", c.claim},
                    {"paper", c.paper},
                    {"ours", c.ours},
                    {"verdict", name_of(c.verdict)},
                    {"why", c.why},
                    {"see", c.see}});
  return list;
}

std::string csv_of(const std::vector<Claim>& claims) {
  std::string text = "id,where,claim,paper,ours,verdict,why,see\n";
  for (const Claim& c : claims)
    text += csv_text(c.id) + "," + csv_text(c.where) + "," + csv_text(c.claim) + "," +
            csv_text(c.paper) + "," + csv_text(c.ours) + "," +
            csv_text(std::string(name_of(c.verdict))) + "," + csv_text(c.why) + "," +
            csv_text(c.see) + "\n";
  return text;
}

std::string table_of(const std::vector<Claim>& claims) {
  std::string text;
  for (const Claim& c : claims)
    text += padded(std::string(name_of(c.verdict)), -13) + c.claim + " (" + c.where + ")\n" +
            padded("", -13) + "paper: " + c.paper + "; here: " + c.ours + "\n";
  return text;
}

}  // namespace gatewalk::cli
