// SPDX-License-Identifier: MIT
#include "lattice/pool/states_info.h"

#include <algorithm>
#include <stdexcept>

#include "lattice/pool/assumptions.h"
#include "lattice/text/json_text.h"

namespace gatewalk::lattice {
namespace {

PooledRange range_in(std::string_view text, const dynamics::Section& section) {
  const JsonObject json(text);
  PooledRange range;
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis) {
    const auto ends = json_elements(json.at(section.coordinates[axis].key));
    if (ends.size() != 2) throw std::invalid_argument("a range has two ends");
    range.range.at[axis] = {json_number(ends[0]), json_number(ends[1])};
  }
  range.tried_on = json.count<int>("tried_on_starts");
  range.kernel_error_95 = json.number("kernel_error_95");
  range.worst_kernel_error_95 = json.number("worst_kernel_error_95");
  return range;
}

std::vector<AssumptionCheck> assumptions_in(const JsonObject& json) {
  std::vector<AssumptionCheck> checks;
  for (const Assumption assumption : kAssumptions) {
    const std::string key(key_of(assumption));
    if (!json.has(key) || json.at(key) == "null") continue;
    const JsonObject of(json.at(key));
    checks.push_back({assumption, of.number("total_variation"),
                      of.number("chance_total_variation_limit"), of.number("p"),
                      of.number("p_adjusted")});
  }
  return checks;
}

TreeInfo trees_in(const JsonObject& json, const dynamics::Section& section) {
  TreeInfo trees{.entries_per_leaf = json.count<int>("entries_per_leaf"),
                 .gate_runs = json.count<std::int64_t>("gate_runs"),
                 .states_bias = json.number("states_bias")};
  if (json.has("accuracy")) {
    trees.accuracy = json.number("accuracy");
    if (!(*trees.accuracy > 0.0 && *trees.accuracy < 1.0))
      throw std::invalid_argument("accuracy is not between 0 and 1");
  }
  if (json.has("error_95")) {
    trees.error_95.emplace();
    for (const std::string_view error : json_elements(json.at("error_95")))
      trees.error_95->push_back(json_number(error));
  }
  if (json.at("range") != "null") trees.range = range_in(json.at("range"), section);
  if (json.has("assumptions"))
    trees.assumptions = assumptions_in(JsonObject(json.at("assumptions")));
  if (!json.has("own_trials")) return trees;
  trees.hausman_check.emplace();
  if (json.at("own_trials") == "null") return trees;
  const JsonObject own(json.at("own_trials"));
  *trees.hausman_check =
      HausmanCheck{own.count<std::int64_t>("trials"), own.number("total_variation"),
                   own.number("chance_total_variation"), own.number("p")};
  return trees;
}

}  // namespace

double TreeInfo::accuracy_of_one() const {
  return accuracy ? *accuracy * (range ? kPartForOne : 1.0) : AccuracyOptions{}.accuracy;
}

std::int64_t TreeInfo::outside(const dynamics::StateSpace& space,
                               const std::vector<dynamics::Entry>& starts) const {
  if (!range) return 0;
  const std::vector<dynamics::Entry>& own = space.points();
  return std::count_if(starts.begin(), starts.end(), [&](const dynamics::Entry& entry) {
    if (std::find(own.begin(), own.end(), entry) != own.end()) return false;
    for (std::size_t axis = 0; axis < space.section().coordinates.size(); ++axis)
      if (entry.at[axis] < range->range.at[axis][0] || entry.at[axis] > range->range.at[axis][1])
        return true;
    return false;
  });
}

TreeInfo tree_info(const TreeChain& c, double accuracy) {
  TreeInfo trees{.entries_per_leaf = c.per_leaf,
                 .gate_runs = c.pool.gate_runs(),
                 .accuracy = accuracy,
                 .range = c.range,
                 .states_bias = c.states_bias,
                 .hausman_check = c.hausman_check,
                 .assumptions = c.assumptions};
  if (c.prediction) {
    trees.error_95.emplace();
    for (const StartAnswer& a : c.prediction->starts)
      trees.error_95->push_back(a.error.total_variation);
  }
  return trees;
}

StatesInfo states_info(std::string_view record, const dynamics::Section& section) {
  const JsonObject json(record);
  StatesInfo states{
      .kind = json_text(json.at("bins")),
      .are_probabilities = json.has("probabilities") && json.at("probabilities") == "true"};
  if (states.kind == "tree") states.trees = trees_in(json, section);
  return states;
}

std::optional<StatesInfo> states_info(const MatrixFile& file, const std::string& path) {
  const auto record = file.text.find(kStatesText);
  if (record == file.text.end() || record->second == "null") return {};
  try {
    return states_info(record->second, file.transitions.space.section());
  } catch (const std::invalid_argument&) {
    throw markov::BadFile(path + ": its record of the state space is damaged");
  }
}

TreeInfo tree_info(const MatrixFile& file, const std::string& path) {
  const auto states = states_info(file, path);
  return states && states->trees ? *states->trees : TreeInfo();
}

}  // namespace gatewalk::lattice
