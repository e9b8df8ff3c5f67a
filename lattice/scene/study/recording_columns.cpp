// SPDX-License-Identifier: MIT
#include <algorithm>
#include <stdexcept>

#include "dynamics/disc/landscape.h"
#include "lattice/scene/study/recording.h"

namespace gatewalk::lattice {
namespace {

using dynamics::BeamState;
using dynamics::BodyState;
using dynamics::Energies;
using dynamics::kLeft;
using dynamics::kRight;
using dynamics::Side;
using Columns = std::vector<Column>;

auto body(double BodyState::*member) {
  return [=](const Line& l) { return l.m.sample.state.body.*member; };
}
auto beam(Side side, double BeamState::*member) {
  return [=](const Line& l) { return l.m.sample.state.beams[side].*member; };
}
auto energy(double Energies::*member) {
  return [=](const Line& l) { return l.m.energy.*member; };
}
auto elastic(Side side) {
  return [=](const Line& l) { return l.m.energy.elastic[side]; };
}
auto beam_force(std::size_t axis) {
  return [=](const Line& l) { return l.m.sample.beam_force[axis]; };
}
auto impulse(Side side) {
  return [=](const Line& l) { return l.m.sample.impulse[side]; };
}
auto gap(Side side) {
  return [=](const Line& l) { return l.m.sample.gap[side]; };
}
auto mode(Side side) {
  return [=](const Line& l) { return static_cast<double>(l.m.sample.contact[side]); };
}
auto part(Side side) {
  return [=](const Line& l) { return static_cast<double>(l.m.sample.nearest[side]); };
}
double landscape_beside(const Line& l, Side side) {
  return dynamics::beam_energy(l.p, l.m.sample.state.body.x, l.m.sample.state.body.y,
                               {side == kLeft, side == kRight});
}

/// Time, place and velocity.
Columns motion() {
  return {
      {"trial", kCounted, "number of the trial",
       [](const Line& l) { return static_cast<double>(l.trial); }},
      {"time_s", "s", "time since the trial began", [](const Line& l) { return l.m.time; }},
      {"gate_x", kCounted, "column i_x of the gate that the body is in",
       [](const Line& l) { return l.m.i_x; }},
      {"gate_y", kCounted, "row i_y of the gate that the body is in",
       [](const Line& l) { return l.m.i_y; }},
      {"x_m", "m", "body, in its gate's frame", body(&BodyState::x)},
      {"y_m", "m", "body, in its gate's frame", body(&BodyState::y)},
      {"field_x_m", "m", "body, in the field's frame",
       [](const Line& l) { return l.m.sample.state.body.x + 2.0 * l.p.beams.joint_x * l.m.i_x; }},
      {"field_y_m", "m", "body, in the field's frame",
       [](const Line& l) { return l.m.sample.state.body.y + l.p.run.traverse_y * l.m.i_y; }},
      {"vx_m_per_s", "m s-1", "velocity of the body", body(&BodyState::vx)},
      {"vy_m_per_s", "m s-1", "velocity of the body", body(&BodyState::vy)},
      {"theta_left_rad", "rad", "left beam's angle, positive deflected forward",
       beam(kLeft, &BeamState::theta)},
      {"theta_right_rad", "rad", "right beam's angle, positive deflected forward",
       beam(kRight, &BeamState::theta)},
      {"omega_left_rad_per_s", "rad s-1", "left beam's angular velocity",
       beam(kLeft, &BeamState::omega)},
      {"omega_right_rad_per_s", "rad s-1", "right beam's angular velocity",
       beam(kRight, &BeamState::omega)},
  };
}

/// Forces, and the contacts of the body.
Columns forces_and_contacts() {
  const std::vector<std::string_view> modes{"free", "hit", "held"}, parts{"side", "tip", "joint"};
  return {
      {"random_N", "N", "random force during the step that ends here",
       [](const Line& l) { return l.m.sample.random_force; }},
      {"beams_x_N", "N", "mean force of both beams on the body during the step, hits included",
       beam_force(0)},
      {"beams_y_N", "N", "mean force of both beams on the body during the step, hits included",
       beam_force(1)},
      {"hit_left_Ns", "N s", "impulse of the left beam's hits during the step", impulse(kLeft)},
      {"hit_right_Ns", "N s", "impulse of the right beam's hits during the step", impulse(kRight)},
      {"contact_left", kCounted,
       "left beam: free, hit during the step, or held at its end; method penalty: always free",
       mode(kLeft), modes},
      {"contact_right", kCounted,
       "right beam: free, hit during the step, or held at its end; method penalty: always free",
       mode(kRight), modes},
      {"nearest_left", kCounted, "part of the left beam nearest to the body", part(kLeft), parts},
      {"nearest_right", kCounted, "part of the right beam nearest to the body", part(kRight),
       parts},
      {"gap_left_m", "m", "distance of body and left beam", gap(kLeft)},
      {"gap_right_m", "m", "distance of body and right beam", gap(kRight)},
  };
}

/// Energies, and the landscape at the body's place.
Columns energies() {
  return {
      {"kinetic_body_J", "J", "kinetic energy of the body", energy(&Energies::body)},
      {"kinetic_beams_J", "J", "kinetic energy of both beams",
       [](const Line& l) { return l.m.energy.beams[kLeft] + l.m.energy.beams[kRight]; }},
      {"elastic_left_J", "J", "elastic energy of the left beam, Eq. (14)", elastic(kLeft)},
      {"elastic_right_J", "J", "elastic energy of the right beam, Eq. (14)", elastic(kRight)},
      {"propulsion_work_J", "J", "work of the propulsion since the trial began",
       energy(&Energies::propulsion_work)},
      {"random_work_J", "J", "work of the random force since the trial began",
       energy(&Energies::random_work)},
      {"hit_loss_J", "J", "energy that hits took since the trial began",
       energy(&Energies::hit_loss)},
      {"lost_J", "J", "energy lost since the trial began: hits, dampers, drag, beams left behind",
       energy(&Energies::lost)},
      {"potential_J", "J",
       "elastic energy and that of the propulsion, Eq. (15), zero at run.traverse_y_m",
       [](const Line& l) {
         return dynamics::propulsion_energy(l.p, l.m.sample.state.body.y) +
                l.m.energy.elastic[kLeft] + l.m.energy.elastic[kRight];
       }},
      {"landscape_J", "J",
       "the landscape here, Eq. (15): both beams deflected forward, zero at run.traverse_y_m",
       [](const Line& l) {
         return dynamics::propulsion_energy(l.p, l.m.sample.state.body.y) +
                landscape_beside(l, kLeft) + landscape_beside(l, kRight);
       }},
      {"landscape_left_J", "J", "the left beam's part of it",
       [](const Line& l) { return landscape_beside(l, kLeft); }},
      {"landscape_right_J", "J", "the right beam's part of it",
       [](const Line& l) { return landscape_beside(l, kRight); }},
  };
}

}  // namespace

const std::vector<Column>& columns() {
  static const Columns all = [] {
    Columns list;
    for (const Columns& some : {motion(), forces_and_contacts(), energies()})
      list.insert(list.end(), some.begin(), some.end());
    return list;
  }();
  return all;
}

std::vector<Column> columns_of(const Recordings& recordings) {
  std::vector<Column> all = columns();
  if (const auto n = static_cast<int>(recordings.actions.size()); n > 0)
    all.push_back({"action",
                   kCounted,
                   "what the body does",
                   [n](const Line& l) { return static_cast<double>(l.m.type % n); },
                   {recordings.actions.begin(), recordings.actions.end()}});
  return all;
}

const Column& column(std::string_view name) {
  const auto found = std::find_if(columns().begin(), columns().end(),
                                  [&](const Column& c) { return c.name == name; });
  if (found == columns().end()) throw std::out_of_range("no column " + std::string(name));
  return *found;
}

}  // namespace gatewalk::lattice
