// SPDX-License-Identifier: MIT
#include "lattice/scene/bins.h"

#include <algorithm>
#include <cmath>

#include "lattice/gates/disc_field.h"
#include "lattice/scene/terrain.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

constexpr int kAutoStates = 348;              // four times as many as Table III
constexpr std::int64_t kJudgingTrials = 200;  // of a pilot that only judges bins
constexpr int kPilotGates = 30;               // most gates that a pilot's trial visits
constexpr std::int64_t kPilotsOwn = std::int64_t{1} << 40;  // number of the pilot's first trial

}  // namespace

bool papers_field(const Scene& scene) {
  const GateParams paper;
  const GateParams& p = scene.gate;
  const Scale unit = scale_of(p);
  // Within rounding; no other scene has these numbers by chance.
  const auto is = [](double own, double papers) {
    return std::abs(own - papers) <= 1e-12 * papers;
  };
  return is(p.beams.length / unit.length, paper.beams.length) &&
         is(p.beams.joint_x / unit.length, paper.beams.joint_x) &&
         is(p.beams.joint_y / unit.length, paper.beams.joint_y) &&
         is(p.forces.random_rate * unit.time, paper.forces.random_rate);
}

std::string BinsChoice::name() const {
  return kind == Kind::paper       ? "paper"
         : kind == Kind::automatic ? "auto"
         : kind == Kind::tree      ? "tree"
                                   : "scene";
}

BinsChoice usual_bins(const Scene& scene) {
  using Kind = BinsChoice::Kind;
  BinsChoice choice{scene.bins ? Kind::scene : papers_field(scene) ? Kind::paper : Kind::automatic};
  choice.by_default = true;
  return choice;
}

StateSpace fixed_space(const Scene& scene) {
  return scene.bins ? StateSpace(disc_section(scene.gate), *scene.bins) : table3_space(scene.gate);
}

Pilot run_pilot(const Scene& scene, const std::vector<BodyState>& starts, std::int64_t trials,
                std::uint64_t seed, const Work& work) {
  Pilot pilot;
  FieldParams field = scene.field;
  field.fidelity = Fidelity::active;
  field.max_gates = field.max_gates == 0 ? kPilotGates : std::min(field.max_gates, kPilotGates);
  const FieldGates gates = gates_of(scene);
  for (const BodyState& start : starts) {
    const Entry entry = entry_of(scene.gate, start);
    if (on_boundary(scene.gate, start) &&
        std::find(pilot.starts.begin(), pilot.starts.end(), entry) == pilot.starts.end())
      pilot.starts.push_back(entry);
    work.in_pieces("pilot", trials, [&](TrialRange range) {
      FieldTrials each{.final_gates = {}, .keep_passages = true};
      pilot.health +=
          run_field(gates, field, start, seed, {kPilotsOwn + range.first, range.count}, &each)
              .health;
      const std::vector<Entry> entries = each.entries();
      pilot.entries.insert(pilot.entries.end(), entries.begin(), entries.end());
    });
    pilot.trials += trials;
  }
  return pilot;
}

int states_for(double scale) {
  double states = kAutoStates;
  for (std::size_t axis = 0; axis < disc_section().coordinates.size(); ++axis) states *= scale;
  states = std::round(states);
  if (!(states >= 1.0 && states <= kMostStates))
    throw std::invalid_argument("makes fewer than 1 or more than " + std::to_string(kMostStates) +
                                " states");
  return static_cast<int>(states);
}

SeenStates seen_states(const Scene& scene, const Pilot& pilot, double scale) {
  std::vector<Entry> entries = pilot.entries;
  const std::vector<GateParams> types = gates_of(scene).types();
  const Section section = disc_section(scene.gate);
  if (std::all_of(types.begin(), types.end(), symmetric)) add_mirror_images(section, entries);
  StateSpace space = quantile_space(section, entries, states_for(scale), pilot.starts);
  Entries of_rows = entries_of(space, entries);
  return {std::move(space), std::move(of_rows)};
}

States states_of(const Scene& scene, const BinsChoice& choice, const std::vector<BodyState>& starts,
                 std::uint64_t seed, const Work& work) {
  using Kind = BinsChoice::Kind;
  (void)table3_space(scene.gate);  // throws for gates too short for their beams
  if (choice.kind == Kind::tree)
    throw std::invalid_argument("bins: a tree is grown from runs (make_tree_chain)");
  Pilot pilot = run_pilot(scene, starts, choice.kind == Kind::paper ? kJudgingTrials : kPilotTrials,
                          seed, work);
  SeenStates seen{fixed_space(scene), {}};
  if (choice.kind == Kind::automatic) {
    seen = seen_states(scene, pilot);
  } else if (choice.kind == Kind::scene) {
    std::vector<Entry> entries = pilot.entries;
    for (const Entry& start : pilot.starts) entries.insert(entries.end(), kPilotTrials, start);
    seen.entries = entries_of(seen.space, entries);
  } else {
    seen.space = refined(table3_space(scene.gate), choice.factor);
  }
  const Resolution resolution = resolution_of(seen.space, pilot.entries);
  if (choice.by_default && choice.kind == Kind::paper && resolution.poor()) {
    States instead = states_of(scene, {Kind::automatic}, starts, seed, work);
    instead.replaced = true;
    return instead;
  }
  return {choice,           false,     std::move(seen.space), std::move(seen.entries),
          std::move(pilot), resolution};
}

}  // namespace gatewalk::lattice
