// SPDX-License-Identifier: MIT
#include "cli/render/stability.h"

#include <algorithm>

#include "cli/render/csv.h"
#include "cli/render/json.h"
#include "cli/render/text.h"
#include "lattice/text/text_stream.h"

namespace gatewalk::cli {

using dynamics::FinishedMap;
using dynamics::Verdict;

namespace {

Json to_json(const FinishedMap& m) {
  Json j;
  j["map"] = m.map.name;
  j["method"] = m.map.method;
  j["x"] = {{"name", m.map.x.name}, {"values", m.map.x.values}};
  j["y"] = {{"name", m.map.y.name}, {"values", m.map.y.values}};
  j["status"] = Json::array();
  for (std::size_t iy = 0; iy < m.map.y.values.size(); ++iy) {
    Json row = Json::array();
    for (std::size_t ix = 0; ix < m.map.x.values.size(); ++ix)
      row.push_back(dynamics::name_of(m.at(ix, iy).verdict));
    j["status"].push_back(std::move(row));
  }
  j["borders"] = Json::array();
  for (const auto& b : dynamics::borders(m.map))
    j["borders"].push_back({{"label", b.label}, {"x", b.x}, {"y", b.y}});
  return j;
}

}  // namespace

Json to_json(const std::vector<FinishedMap>& maps) {
  Json json;
  json["trials_per_point"] = dynamics::kTrialsPerPoint;
  json["work_granted_per_point"] = dynamics::kMostWorkPerPoint;
  json["holds_share"] = dynamics::Health::kPermittedHolds;
  json["maps"] = Json::array();
  for (const FinishedMap& m : maps) json["maps"].push_back(to_json(m));
  return json;
}

std::string csv_of(const std::vector<FinishedMap>& maps) {
  Csv csv(
      "map,method,x_name,x,y_name,y,status,trials,not_finite,cut_short,penetrating,creating_energy,"
      "too_fast,beyond_bound,contacts_without_formula,forced_holds,steps,evaluations,"
      "worst_penetration_m,worst_energy_created_J,worst_speed_m_per_s");
  for (const FinishedMap& m : maps) {
    const std::string map(m.map.name), x(m.map.x.name), y(m.map.y.name);
    for (std::size_t iy = 0; iy < m.map.y.values.size(); ++iy)
      for (std::size_t ix = 0; ix < m.map.x.values.size(); ++ix) {
        const dynamics::MapPoint& p = m.at(ix, iy);
        const dynamics::Health& h = p.health;
        csv.row(map, m.map.method, x, m.map.x.values[ix], y, m.map.y.values[iy],
                std::string(dynamics::name_of(p.verdict)), h.runs, h.broken, p.out_of_work,
                h.penetrating, h.creating_energy, h.fast, h.unstable, h.undefined_contacts,
                h.forced_holds, h.steps, h.evaluations, h.worst_penetration, h.worst_energy_created,
                h.worst_speed);
      }
  }
  return csv.text();
}

std::string table_of(const std::vector<FinishedMap>& maps) {
  std::vector<Verdict> seen;
  for (std::size_t v = 0; v < dynamics::kVerdictNames.size(); ++v)
    if (std::any_of(maps.begin(), maps.end(),
                    [v](const FinishedMap& m) { return m.count(static_cast<Verdict>(v)) > 0; }))
      seen.push_back(static_cast<Verdict>(v));
  lattice::TextStream out;
  out << "Points of each map by the worst that their " << dynamics::kTrialsPerPoint
      << " trials showed\n\n"
      << padded("", -35);
  for (const Verdict v : seen) out << padded(std::string(dynamics::name_of(v)), 13);
  out << "\n";
  for (const FinishedMap& m : maps) {
    out << padded(std::string(m.map.name), -24) << padded(m.map.method, -11);
    for (const Verdict v : seen) {
      const std::int64_t n = m.count(v);
      out << padded(n > 0 ? std::to_string(n) : ".", 13);
    }
    out << "\n";
  }
  return out.str();
}

std::string figure_name(const dynamics::StabilityMap& map) {
  return std::string(map.name) + ".svg";
}

}  // namespace gatewalk::cli
