// SPDX-License-Identifier: MIT
#include "cli/render/states.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "cli/fields/json.h"
#include "cli/fields/json_value.h"
#include "cli/fields/text.h"
#include "cli/render/assumptions.h"
#include "cli/render/health.h"
#include "cli/render/pooled_prediction.h"
#include "cli/render/start.h"
#include "lattice/pool/predict_pooled.h"
#include "lattice/text/digits.h"

namespace gatewalk::cli {
namespace {

using namespace dynamics;

double clamped_share(const Resolution& r) {
  return static_cast<double>(r.clamped) / static_cast<double>(std::max<std::int64_t>(1, r.entries));
}

// ---- From what was made ----

void describe(Fields& out, const BinRecord& bins) {
  const Resolution& r = bins.resolution;
  out.object({"pilot", "full trials with which the bins are assessed"}, [&](Fields& pilot) {
    pilot.count({"trials", "1", "number of full trials"}, bins.pilot_trials);
    pilot.count({"entries", "1", "number of entries into gates after the first one"}, r.entries);
    describe_status(pilot, bins.pilot_health);
  });
  out.object({"resolution", "how well the bins separate the pilot's entries"}, [&](Fields& f) {
    f.number({"clamped_share", "1", "share of the pilot's entries that lie outside all bins"},
             clamped_share(r));
    f.count(
        {"states_entered", "1", "number of states that have at least one of the pilot's entries"},
        r.states_entered);
    f.count({"states_of_90_percent", "1",
             "smallest number of states that hold 90 % of the pilot's entries"},
            r.states_of_90);
    f.object(
        {"unresolved_variance",
         "variance of each coordinate within states divided by its variance within boundaries"},
        [&](Fields& unresolved) {
          unresolved.number({"d", "1", "unresolved variance of the place on the boundary"},
                            r.unresolved[kEntryD]);
          unresolved.number({"vx", "1", "unresolved variance of the lateral velocity"},
                            r.unresolved[kEntryVx]);
          unresolved.number({"vy", "1", "unresolved variance of the forward velocity"},
                            r.unresolved[kEntryVy]);
        });
    f.flag({"poor", "whether the bins resolve too little for the chain to be trusted"}, r.poor());
  });
}

/// Recorded runs have no accuracy that was asked for.
bool is_of_recorded_runs(const lattice::TreeInfo& trees) { return !trees.accuracy; }

void describe(Fields& out, const lattice::PooledRange& range, const Section& section) {
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis)
    out.range(Field(section.coordinates[axis].key, "its own", "range of this coordinate: from, to")
                  .varying("<coordinate>"),
              range.range.at[axis]);
  out.count({"tried_on_starts", "1",
             "number of starts in the range at which the chain's error was estimated"},
            range.tried_on);
  out.number(
      {"kernel_error_95", "1",
       "median over these starts of error_95 as it would be with infinitely many first runs"},
      range.kernel_error_95);
  out.number({"worst_kernel_error_95", "1",
              "largest of these starts' error_95 as it would be with infinitely many first runs"},
             range.worst_kernel_error_95);
}

// ---- From a file ----

Entry start_in(const Json& json, const Section& section) {
  Entry entry;
  if (json.contains("face")) {
    const auto face = std::find_if(section.faces.begin(), section.faces.end(),
                                   [&](const Face& f) { return json.at("face") == f.name; });
    if (face == section.faces.end()) throw std::invalid_argument("a start enters by no face");
    entry.face = static_cast<int>(face - section.faces.begin());
  }
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis)
    entry.at[axis] = number_in(json.at(section.coordinates[axis].key));
  return entry;
}

BinRecord bins_in(const Json& json) {
  const Json &pilot = json.at("pilot"), &found = json.at("resolution"),
             &unresolved = found.at("unresolved_variance");
  BinRecord bins{
      .pilot_trials = pilot.at("trials"),
      .pilot_health = health_from(pilot.at("status")),
      .resolution = {.entries = pilot.at("entries"),
                     .states_entered = found.at("states_entered"),
                     .states_of_90 = found.at("states_of_90_percent"),
                     .unresolved = {unresolved.at("d"), unresolved.at("vx"), unresolved.at("vy")}}};
  bins.resolution.clamped = std::llround(found.at("clamped_share").get<double>() *
                                         static_cast<double>(bins.resolution.entries));
  if (json.contains("factor")) bins.factor = json.at("factor");
  if (json.contains("rows_without_entries"))
    bins.rows_without_entries = json.at("rows_without_entries");
  return bins;
}

// ---- In words ----

/// A start as --start takes it: "4,5,10", "W:0.1,0".
std::string text_of_start(const Section& section, const Entry& start) {
  std::string text;
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis)
    text += (axis == 0 ? "" : ",") + digits(start.at[axis], 6);
  return start.face == 0 ? text
                         : section.faces[static_cast<std::size_t>(start.face)].name + ":" + text;
}

/// "Starts with a state of their own: 0,0,15; 4,5,10".
std::string starts_text(const StateRecord& s) {
  if (s.starts.empty()) return "";
  std::string text =
      s.starts.size() == 1 ? "Start with a state of its own:" : "Starts with a state of their own:";
  constexpr std::size_t kMost = 4;
  for (std::size_t i = 0; i < std::min(kMost, s.starts.size()); ++i)
    text += (i > 0 ? "; " : " ") + text_of_start(s.section, s.starts[i]);
  if (s.starts.size() > kMost) text += fmt::format("; ... {} in all", s.starts.size());
  return text + "\n";
}

std::string lines_of(const lattice::TreeInfo& trees, const StateRecord& s) {
  std::string text =
      fmt::format("States: {}, leaves of trees with {} entries or more, from {} gate runs.\n",
                  s.states - std::ssize(s.starts), trees.entries_per_leaf, trees.gate_runs);
  text += starts_text(s);
  if (trees.range) {
    const auto& at = trees.range->range.at;
    text += fmt::format("Good for starts with d {} m, vx {} m/s, vy {} m/s.\n",
                        dynamics::text_of(at[kEntryD]), dynamics::text_of(at[kEntryVx]),
                        dynamics::text_of(at[kEntryVy]));
  }
  if (trees.states_bias > 0.0)
    text += fmt::format("The limit of states changes the final gates by a total variation of {}.\n",
                        fixed(trees.states_bias, 4));
  return text + hausman_check_text(trees.hausman_check.value_or(std::nullopt)) +
         assumptions_text(trees.assumptions) +
         "A single row has few runs and is noisy; a prediction averages over all rows.\n";
}

std::string lines_of(const BinRecord& bins, const StateRecord& s) {
  const Resolution& r = bins.resolution;
  std::string kind = s.kind == "paper"  ? "Table III's bins"
                     : s.kind == "auto" ? "bins from a pilot"
                                        : "the scene's bins";
  if (bins.factor.value_or(1.0) != 1.0) kind += " x " + lattice::toml_float(*bins.factor);
  std::string text = fmt::format(
      "States: {} ({}). Of {} entries in {} pilot trials, {} lie outside the bins\nand 90 % lie in "
      "{} states. Variance that remains within states: d {}, vx {}, vy {}.\n",
      s.states, kind, r.entries, bins.pilot_trials, percent(clamped_share(r), 1.0), r.states_of_90,
      percent(r.unresolved[kEntryD], 1.0), percent(r.unresolved[kEntryVx], 1.0),
      percent(r.unresolved[kEntryVy], 1.0));
  if (bins.rows_without_entries.value_or(0) > 0)
    text += fmt::format(
        "States that no body was seen to enter: {}; their rows start anywhere in the "
        "bin.\n",
        *bins.rows_without_entries);
  return text;
}

}  // namespace

StateRecord record_of(const lattice::States& s) {
  BinRecord bins{
      .pilot_trials = s.pilot.trials, .pilot_health = s.pilot.health, .resolution = s.resolution};
  if (s.choice.kind == lattice::BinsChoice::Kind::paper) bins.factor = s.choice.factor;
  if (!s.entries.empty())
    bins.rows_without_entries =
        std::count_if(s.entries.begin(), s.entries.end() - std::ssize(s.space.points()),
                      [](const auto& seen) { return seen.empty(); });
  return {{.kind = s.choice.name()}, s.space.size(),   s.space.open(),
          s.space.section(),         s.space.points(), std::move(bins)};
}

StateRecord record_of(const lattice::TreeChain& c, double accuracy) {
  const StateSpace& space = c.transitions.front().space;
  return {{.kind = "tree", .trees = lattice::tree_info(c, accuracy)},
          space.size(),
          true,
          space.section(),
          space.points()};
}

StateRecord state_record(const std::string& attribute, const Section& section) {
  const Json json = parsed_json(attribute);
  StateRecord s{lattice::states_info(attribute, section)};
  s.states = json.at("states");
  s.are_open = json.value("outermost_bins", "") == "open";
  s.section = section;
  if (s.is_imported()) return s;
  for (const Json& start : json.at("starts_of_their_own"))
    s.starts.push_back(start_in(start, section));
  if (!s.trees) s.bins = bins_in(json);
  return s;
}

std::string attribute_of(const StateRecord& states) {
  return json_text([&](Fields& out) { describe(out, states); }, -1);
}

void describe(Fields& out, const StateRecord& s) {
  const BinRecord bins = s.bins.value_or(BinRecord());
  const lattice::TreeInfo trees = s.trees.value_or(lattice::TreeInfo());
  const bool recorded = s.trees && is_of_recorded_runs(trees);
  const auto put_states = [&](Fields& f) {
    f.count({"states", "1", "number of states of the chain, starts included"}, s.states);
  };
  out.text(Label("bins",
                 "origin of the states: bins of the paper's Table III, of a pilot (auto), of the "
                 "scene; tree leaves; import")
               .one_of({"paper", "auto", "scene", "tree", "imported"}),
           s.kind);
  out.if_any({"factor", "1", "bins per axis as a multiple of those in the paper's Table III"},
             bins.factor);
  if (!recorded) put_states(out);
  out.optional(s.bins || (s.trees && !recorded), [&](Fields& f) {
    f.text(Label("outermost_bins",
                 "open: outermost bins take all entries beyond them; closed: these lie outside and "
                 "count in the nearest bin")
               .one_of({"open", "closed"}),
           s.are_open ? "open" : "closed");
  });
  out.optional(s.bins.has_value(), [&](Fields& f) {
    f.text(Label("row_starts",
                 "where the runs of a row start: anywhere in its bin, or where bodies were seen to "
                 "enter")
               .one_of({"uniform", "visited"}),
           bins.rows_without_entries ? "visited" : "uniform");
    f.if_any(
        {"rows_without_entries", "1",
         "number of bins that no body was seen to enter; their runs start anywhere in the bin"},
        bins.rows_without_entries);
  });
  out.optional(s.trees.has_value(), [&](Fields& f) {
    f.count({"entries_per_leaf", "1", "smallest number of entries in a leaf"},
            trees.entries_per_leaf);
    f.count({"gate_runs", "1",
             "number of gate runs, or recorded passages, from which the chain is made"},
            trees.gate_runs);
    f.if_any({"accuracy", "1",
              "error_95 that was asked for; a chain for a range of starts is made for half of it"},
             trees.accuracy);
  });
  out.optional(s.bins || s.trees, [&](Fields& f) {
    f.list({"starts_of_their_own", "starts that have a state of their own"}, s.starts,
           [&](Fields& start, const Entry& entry) { describe(start, s.section, entry); });
  });
  out.optional(s.bins.has_value(), [&](Fields& f) { describe(f, bins); });
  out.optional(s.trees.has_value(), [&](Fields& f) {
    f.if_any({"error_95", "1",
              "by start: total variation of the final gates that 95 of 100 answers do not "
              "exceed; null: not known"},
             trees.error_95);
    f.maybe(
        {"range",
         "range of starts for which the chain is made; null: it is made for starts_of_their_own"},
        trees.range,
        [&](Fields& range, const lattice::PooledRange& r) { describe(range, r, s.section); });
    f.number({"states_bias", "1",
              "total variation of the final gates that a limit of states causes; 0: no limit"},
             trees.states_bias);
    f.optional(trees.hausman_check.has_value(), [&](Fields& own) {
      describe_hausman_check(own, trees.hausman_check.value_or(std::nullopt));
    });
    f.optional(!trees.assumptions.empty(),
               [&](Fields& all) { describe_assumptions(all, trees.assumptions); });
  });
  if (recorded) put_states(out);
  out.optional(s.are_probabilities, [&](Fields& f) {
    f.flag(
        {"probabilities", "whether the imported chain consists of probabilities, without counts"},
        s.are_probabilities);
  });
}

void describe_state_space(Fields& out, const StateRecord& states) {
  out.object(Label("state_space", "the states of the chain").shared(),
             [&](Fields& f) { describe(f, states); });
}

std::string states_line(const StateRecord& s) {
  if (s.trees) return lines_of(*s.trees, s);
  if (s.bins) return lines_of(*s.bins, s);
  return fmt::format(
      "States: {}, of an imported chain{}. --start takes the name of a state, or its number from "
      "0.\n",
      s.states, s.are_probabilities ? ", given as probabilities" : "");
}

std::vector<std::string> complaints(const lattice::States& s) {
  std::vector<std::string> all;
  if (!s.entries.empty() && !s.pilot.health.clean())
    all.push_back("the pilot: " + complaint(s.pilot.health));
  if (s.pilot.entries.empty())
    all.push_back(fmt::format(
        "no body entered a second gate in {} pilot trials: the bins could not be tested",
        s.pilot.trials));
  if (s.resolution.poor())
    all.push_back(fmt::format(
        "the bins are too coarse ({} of the entries lie outside, 90 % in {} states), and the chain "
        "may be far off: {}",
        percent(static_cast<double>(s.resolution.clamped),
                static_cast<double>(s.resolution.entries)),
        s.resolution.states_of_90,
        s.choice.kind == lattice::BinsChoice::Kind::automatic
            ? fmt::format("{} entries are too few for more states", s.resolution.entries)
            : "take --bins auto, without a table [bins]"));
  return all;
}

}  // namespace gatewalk::cli
