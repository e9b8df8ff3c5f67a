// SPDX-License-Identifier: MIT
#include "cli/render/sweep.h"

#include <algorithm>

#include "cli/render/choice.h"
#include "cli/render/csv.h"
#include "cli/render/gate_runs.h"
#include "cli/render/health.h"
#include "cli/render/json.h"
#include "cli/render/scene.h"
#include "dynamics/base/share.h"
#include "lattice/text/text_stream.h"

namespace gatewalk::cli {
namespace {

using dynamics::Outcome;
using dynamics::share_interval;
using lattice::SweepAxis;
using lattice::SweepPoint;

/// What a share is of, and how many of those. Right of those that pushed more past one beam than
/// past the other: the paper's Fig. 12.
struct Share {
  const char* name;
  std::int64_t part, whole;
};
std::vector<Share> shares_of(const dynamics::GateTally& t) {
  return {{"traversed", t.traversed(), t.trials},
          {"traversed_left", t[Outcome::traversed_left], t.trials},
          {"traversed_right", t[Outcome::traversed_right], t.trials},
          {"exited", t.exited(), t.trials},
          {"trapped", t[Outcome::trapped], t.trials},
          {"right_of_traversed", t[Outcome::traversed_right],
           t[Outcome::traversed_left] + t[Outcome::traversed_right]}};
}

}  // namespace

Json to_json(const std::vector<SweepAxis>& axes, const std::vector<SweepPoint>& points) {
  const auto value = [](const std::string& given) {
    const Json number = parsed_json(given);
    return number.is_number() ? number : Json(given);
  };
  Json json;
  json["vary"] = Json::array();
  for (const SweepAxis& axis : axes) {
    json["vary"].push_back({{"key", axis.key}, {"values", Json::array()}});
    for (const std::string& v : axis.values) json["vary"].back()["values"].push_back(value(v));
  }
  json["points"] = Json::array();
  for (const SweepPoint& p : points) {
    Json point;
    for (std::size_t i = 0; i < axes.size(); ++i) point["at"][axes[i].key] = value(p.values[i]);
    point.update(json_of([&](Fields& out) { describe(out, p.tally); }));
    const Share right = shares_of(p.tally).back();
    if (right.whole > 0)
      point["intervals_95"][right.name] = share_interval(right.part, right.whole);
    if (p.settled) point["method"] = to_json(*p.settled);
    point["status"] = to_json(p.tally.health);
    json["points"].push_back(std::move(point));
  }
  return json;
}

std::string csv_of(const std::vector<SweepAxis>& axes, const std::vector<SweepPoint>& points) {
  lattice::TextStream out;
  for (const SweepAxis& axis : axes) out << axis.key << ',';
  out << "method,trials";
  for (const auto& [outcome, key, words] : dynamics::kOutcomeNames) out << ',' << key << "_count";
  for (const Share& s : shares_of({}))
    out << ',' << s.name << ',' << s.name << "_low," << s.name << "_high";
  out << ",clean\n";
  for (const SweepPoint& p : points) {
    const dynamics::GateTally& t = p.tally;
    for (const std::string& value : p.values) out << csv_text(value) << ',';
    out << p.scene.gate.run.method << ',' << t.trials;
    for (const std::int64_t n : t.counts) out << ',' << n;
    for (const Share& s : shares_of(t)) {
      if (s.whole == 0) {
        out << ",,,";  // of none there is no share
        continue;
      }
      const auto [low, high] = share_interval(s.part, s.whole);
      for (const double x : {static_cast<double>(s.part) / static_cast<double>(s.whole), low, high})
        out << ',' << digits(x, 8);
    }
    out << ',' << t.health.clean() << '\n';
  }
  return out.str();
}

std::string table_of(const lattice::Scene& scene, const std::vector<SweepAxis>& axes,
                     const std::vector<SweepPoint>& points) {
  std::string text = scene_line(scene) + "but for the keys varied. " +
                     std::to_string(points.size()) + " points of " +
                     std::to_string(points.front().tally.trials) +
                     " trials, all under the same noise; % of them with 95 % intervals.\n\n";
  std::vector<int> widths;
  for (const SweepAxis& axis : axes) {
    std::size_t width = axis.key.size();
    for (const std::string& v : axis.values) width = std::max(width, v.size());
    widths.push_back(static_cast<int>(width) + 2);
    text += padded(axis.key, widths.back());
  }
  text += "   traversed             right of those        exited   trapped\n";
  for (const SweepPoint& p : points) {
    for (std::size_t i = 0; i < axes.size(); ++i) text += padded(p.values[i], widths[i]);
    const auto shares = shares_of(p.tally);
    const auto with_interval = [](const Share& s) {
      if (s.whole == 0) return padded("-", 6) + std::string(16, ' ');
      const auto [low, high] = share_interval(s.part, s.whole);
      return padded(fixed(100.0 * static_cast<double>(s.part) / static_cast<double>(s.whole), 1),
                    6) +
             padded(" [" + fixed(100.0 * low, 1) + ", " + fixed(100.0 * high, 1) + "]", -16);
    };
    text +=
        "    " + with_interval(shares[0]) + with_interval(shares[5]) +
        padded(percent(static_cast<double>(shares[3].part), static_cast<double>(shares[3].whole)),
               8) +
        padded(percent(static_cast<double>(shares[4].part), static_cast<double>(shares[4].whole)),
               10) +
        (p.tally.health.clean() ? "\n" : "  faults\n");
  }
  return text;
}

}  // namespace gatewalk::cli
