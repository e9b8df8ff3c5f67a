// SPDX-License-Identifier: MIT
#include "cli/render/states.h"

#include <algorithm>

#include "cli/render/health.h"
#include "cli/render/json.h"
#include "cli/render/pooled_prediction.h"
#include "cli/render/start.h"
#include "cli/render/text.h"

namespace gatewalk::cli {
namespace {

using namespace dynamics;

}  // namespace

Json to_json(const lattice::States& s) {
  const Resolution& r = s.resolution;
  const auto n = static_cast<double>(std::max<std::int64_t>(1, r.entries));
  Json j;
  j["bins"] = s.choice.name();
  if (s.choice.kind == lattice::BinsChoice::Kind::paper) j["factor"] = s.choice.factor;
  j["states"] = s.space.size();
  j["outermost_bins"] = s.space.open() ? "open" : "closed";
  j["row_starts"] = s.entries.empty() ? "uniform" : "visited";
  if (!s.entries.empty()) {
    const auto bins =
        s.entries.begin() + (s.space.size() - static_cast<int>(s.space.points().size()));
    j["rows_without_entries"] =
        std::count_if(s.entries.begin(), bins, [](const auto& e) { return e.empty(); });
  }
  j["starts_of_their_own"] = Json::array();
  for (const Entry& c : s.space.points())
    j["starts_of_their_own"].push_back(to_json(s.space.section(), c));
  j["pilot"] = {
      {"trials", s.pilot.trials}, {"entries", r.entries}, {"status", to_json(s.pilot.health)}};
  j["resolution"] = {{"clamped_share", static_cast<double>(r.clamped) / n},
                     {"states_entered", r.states_entered},
                     {"states_of_90_percent", r.states_of_90},
                     {"unresolved_variance",
                      {{"d", r.unresolved[kEntryD]},
                       {"vx", r.unresolved[kEntryVx]},
                       {"vy", r.unresolved[kEntryVy]}}},
                     {"poor", r.poor()}};
  return j;
}

namespace {

std::string text_of_range(const Json& r) {
  return dynamics::text_of(std::array<double, 2>{r.at(0).get<double>(), r.at(1).get<double>()});
}

/// "4,5,10", "W:0.1,0": as --start gives it. Numbers stand in the order of the coordinates.
std::string text_of_start(const Json& start) {
  std::string text;
  for (const auto& [key, value] : start.items())
    if (value.is_number()) text += (text.empty() ? "" : ",") + digits(value.get<double>());
  return (start.contains("face") ? start.at("face").get<std::string>() + ":" : "") + text;
}

/// ", for the starts 0,0,15; 4,5,10".
std::string starts_in(const Json& starts) {
  if (starts.empty()) return "";
  std::string text = starts.size() == 1 ? ", for the start" : ", for the starts";
  constexpr std::size_t kMost = 4;
  for (std::size_t i = 0; i < std::min(kMost, starts.size()); ++i)
    text += std::string(i > 0 ? ";" : "") + " " + text_of_start(starts[i]);
  if (starts.size() > kMost) text += "; ... " + std::to_string(starts.size()) + " in all";
  return text;
}

/// Of a file.
std::optional<lattice::OwnTrials> own_trials_of(const Json& j) {
  if (j.is_null()) return {};
  return lattice::OwnTrials{j.at("trials"), j.at("total_variation"), j.at("chance_total_variation"),
                            j.at("p")};
}

std::string tree_line(const Json& j) {
  std::string text = "states: " + j.at("states").dump() + " (leaves of trees with " +
                     j.at("entries_per_leaf").dump() + " entries or more" +
                     starts_in(j.at("starts_of_their_own")) + ") from " + j.at("gate_runs").dump() +
                     " gate runs\n";
  if (const auto& range = j.at("range"); !range.is_null())
    text += "for starts d " + text_of_range(range.at("d_m")) + " m, vx " +
            text_of_range(range.at("vx_m_per_s")) + " m/s, vy " +
            text_of_range(range.at("vy_m_per_s")) + " m/s\n";
  if (const double bias = j.at("states_bias").get<double>(); bias > 0.0)
    text += "fewer states than the runs allow: total variation " + fixed(bias, 4) +
            " of the final gates\n";
  return text + own_trials_text(own_trials_of(j.value("own_trials", Json()))) +
         "a row has few runs and is noisy by itself: a prediction averages over all of them\n";
}

}  // namespace

Json to_json(const lattice::TreeChain& c, double accuracy) {
  Json j;
  j["bins"] = "tree";
  j["states"] = c.transitions.front().space.size();
  j["outermost_bins"] = "open";
  j["entries_per_leaf"] = c.per_leaf;
  j["gate_runs"] = c.pool.gate_runs();
  j["accuracy"] = accuracy;
  j["starts_of_their_own"] = Json::array();
  for (const Entry& s : c.transitions.front().space.points())
    j["starts_of_their_own"].push_back(to_json(c.transitions.front().space.section(), s));
  if (c.prediction) {
    j["error_95"] = Json::array();
    for (const lattice::StartAnswer& a : c.prediction->starts)
      j["error_95"].push_back(a.error.total_variation);
  }
  j["range"] = nullptr;
  if (c.range) {
    Json& range = j["range"] = Json::object();
    const std::vector<Coordinate>& coordinates = c.transitions.front().space.section().coordinates;
    for (std::size_t axis = 0; axis < coordinates.size(); ++axis)
      range[coordinates[axis].key] = c.range->range.at[axis];
    range["tried_on_starts"] = c.range->tried_on;
    range["kernel_error_95"] = c.range->kernel_error_95;
    range["worst_kernel_error_95"] = c.range->worst_kernel_error_95;
  }
  j["states_bias"] = c.states_bias;
  j["own_trials"] = cli::to_json(c.own_trials);
  return j;
}

std::string states_line(const Json& j) {
  if (j.is_null()) return "";
  if (j.at("bins") == "tree") return tree_line(j);
  if (j.at("bins") == "imported")
    return "states: " + j.at("states").dump() + ", of a chain from elsewhere" +
           (j.value("probabilities", Json()) == true ? ", given as probabilities" : "") +
           "; --start takes a name, or a number from 0 (input less 1)\n";
  const Json &r = j.at("resolution"), &pilot = j.at("pilot"),
             &unresolved = r.at("unresolved_variance");
  const std::string kind = j.at("bins");
  std::string text = "states: " + j.at("states").dump() +
                     (kind == "paper"  ? " (Table III's bins"
                      : kind == "auto" ? " (bins from a pilot"
                                       : " (the scene's bins");
  if (kind == "paper" && j.at("factor") != 1.0) text += " x " + j.at("factor").dump();
  text += "); of " + pilot.at("entries").dump() + " entries in " + pilot.at("trials").dump() +
          " pilot trials " + percent(r.at("clamped_share").get<double>(), 1.0) +
          " lie outside, 90 % in " + r.at("states_of_90_percent").dump() +
          " states; variance within states: d " + percent(unresolved.at("d").get<double>(), 1.0) +
          ", vx " + percent(unresolved.at("vx").get<double>(), 1.0) + ", vy " +
          percent(unresolved.at("vy").get<double>(), 1.0) + "\n";
  if (const auto rows = j.find("rows_without_entries"); rows != j.end() && rows->get<int>() > 0)
    text += "states without an entry seen: " + rows->dump() +
            ", their rows start anywhere in the bin\n";
  return text;
}

std::vector<std::string> complaints(const lattice::States& s) {
  std::vector<std::string> all;
  if (!s.entries.empty() && !s.pilot.health.clean())
    all.push_back("the pilot: " + complaint(s.pilot.health));
  if (s.pilot.entries.empty())
    all.push_back("no body entered a second gate in " + std::to_string(s.pilot.trials) +
                  " pilot trials: bins could not be judged by what bodies do");
  if (s.resolution.poor())
    all.push_back(
        "the bins resolve too little of how bodies enter gates: " +
        percent(static_cast<double>(s.resolution.clamped),
                static_cast<double>(s.resolution.entries)) +
        " of the entries seen lie outside, 90 % of them in " +
        std::to_string(s.resolution.states_of_90) + " states; the chain may be far off. " +
        (s.choice.kind == lattice::BinsChoice::Kind::automatic
             ? "Only " + std::to_string(s.resolution.entries) +
                   " entries were seen, too few for more states"
             : "--bins auto, without a table [bins] in the scene, makes bins that suit it"));
  return all;
}

}  // namespace gatewalk::cli
