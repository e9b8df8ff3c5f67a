// SPDX-License-Identifier: MIT
#include "dynamics/disc/disc_cell.h"

#include <Random123/philox.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "dynamics/disc/contact.h"
#include "dynamics/disc/runs.h"

namespace gatewalk::dynamics {
namespace {

/// What a body carries from gate to gate.
struct Memory {
  BodyState from;  // start in the new gate, in that gate's frame
  RandomForce force;
};

bool is_physical(std::string_view key) {
  return key != "run.step_s" && key != "run.event_tolerance_m" && key != "run.tolerance" &&
         key != "contact.impulse_threshold_Ns";
}

std::vector<const ParamInfo*> physical_params() {
  std::vector<const ParamInfo*> infos;
  for (const ParamInfo& info : gate_param_table())
    if (is_physical(info.key)) infos.push_back(&info);
  return infos;
}

/// The number of draws in a block: the least power of 2 for which kSlowBlocks blocks last as long
/// as a body takes from rest through a gate without beams. That time is estimated as the sum of a
/// passage without drag and one with drag alone.
int block_of(const GateParams& p) {
  const double way = p.run.traverse_y;
  const double seconds =
      std::min(p.run.time_limit, std::sqrt(2.0 * way * p.body.mass / p.forces.propulsion) +
                                     way * p.forces.drag / p.forces.propulsion);
  constexpr auto kMost = static_cast<int>(kSlowBlocks);  // a block must fit into one batch of draws
  int block = 1;
  while (block < kMost && block * kMost < seconds * p.forces.random_rate) block *= 2;
  return block;
}

}  // namespace

std::uint64_t stream_row(const GateParams& p, const BodyState& b) {
  // A hash of the bits of the state, made by the random generator.
  const Scale scale = scale_of(p);
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x + 0.0); };  // -0 becomes 0
  const r123::Philox4x64::ctr_type state = {{bits(b.x / scale.length), bits(b.y / scale.length),
                                             bits(b.vx / scale.speed()),
                                             bits(b.vy / scale.speed())}};
  return r123::Philox4x64()(state, {{0, 0}})[0] >> 8;  // the top byte of a key holds the purpose
}

Passage passage_of(const GateParams& p, const GateRun& run) {
  Passage passage{.fate = Fate::left, .next = {}, .costs = costs_of(run)};
  if (run.outcome == Outcome::trapped || run.outcome == Outcome::broken)
    passage.fate = run.outcome == Outcome::trapped ? Fate::trapped : Fate::broken;
  else
    passage.next = crossing_of(p, run.outcome, run.exit);
  return passage;
}

DiscCell::DiscCell(const GateParams& p)
    : p_(p), section_(disc_section(p_)), method_(make_method(p_)), block_(block_of(p_)) {}

void DiscCell::begin(Body& body) const { begin_at(body, entry_state(p_, body.entry)); }

void DiscCell::begin_at(Body& body, const BodyState& start) const {
  body.carried.put(Memory{start, RandomForce(p_.forces, body.random)});
}

void DiscCell::forget(Body& body) const { body.carried.as<Memory>().force.drop_hold(); }

std::vector<Cell::Remembered> DiscCell::remembered(const Body& body) const {
  const RandomForce& force = body.carried.as<Memory>().force;
  return {{.key = "held_draw", .value = force.last_draw(), .odd = true},
          {.key = "held_for_s", .value = std::max(0.0, force.left())}};
}

void DiscCell::fork(Body& body, const Random& random) const {
  body.carried.as<Memory>().force.go_on_with(random);
}

void DiscCell::lay_noise(Body& body, const Point& point) const {
  body.carried.as<Memory>().force.lay(point, block_);
}

Passage DiscCell::pass(Body& body) const {
  auto& memory = body.carried.as<Memory>();
  memory.force.enter(p_.forces);
  const GateRun run = run_gate(p_, *method_, memory.from, memory.force);
  const Passage passage = passage_of(p_, run);
  body.entry = passage.next;
  if (passage.fate == Fate::left) memory.from = shifted_into_next(p_, run.outcome, run.exit);
  return passage;
}

void DiscCell::carry_out(const NextPassage& next, Health& health, std::int64_t at_once) const {
  Body body{.entry = {}, .random = Random(Purpose::gate, {})};
  const NextRun next_run = [&](RunSlot& slot, const GateRun* ended) {
    body.trial = slot.trial;
    Passage passage;
    if (ended != nullptr) {
      add_run(health, p_, *ended);
      passage = passage_of(p_, *ended);
      body.entry = passage.next;
      body.carried.put(Memory{passage.fate == Fate::left
                                  ? shifted_into_next(p_, ended->outcome, ended->exit)
                                  : ended->exit,
                              slot.force});
    }
    if (!next(body, ended != nullptr ? &passage : nullptr)) return false;
    const auto& memory = body.carried.as<Memory>();
    slot.trial = body.trial;
    slot.start = memory.from;
    slot.force = memory.force;
    slot.force.enter(p_.forces);
    return true;
  };
  dynamics::carry_out(p_, *method_, next_run, kAnyWork, at_once);
}

std::uint64_t DiscCell::stream_of(const Entry& start) const {
  return stream_row(p_, entry_state(p_, start));
}

std::vector<Cell::Number> DiscCell::numbers() const {
  std::vector<Number> numbers;
  for (const ParamInfo* info : physical_params())
    numbers.push_back({std::string(info->key), info->get(p_)});
  return numbers;
}

std::unique_ptr<Cell> DiscCell::with(std::size_t number, double times) const {
  const ParamInfo& info = *physical_params()[number];
  GateParams p = p_;
  info.ref(p) *= times;
  if (info.key == "forces.random_rate_Hz") p.run.step /= times;  // steps still fit into a hold
  if (!info.permits(info.get(p))) return nullptr;
  try {
    validate(p);
    return std::make_unique<DiscCell>(p);
  } catch (const InvalidParameter&) {
    return nullptr;
  }
}

double DiscCell::clearance(const Entry& entry) const {
  const BodyState body = entry_state(p_, entry);
  return std::min(nearest(p_, kLeft, body, 0.0).gap, nearest(p_, kRight, body, 0.0).gap);
}

}  // namespace gatewalk::dynamics
