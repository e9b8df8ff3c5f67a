// SPDX-License-Identifier: MIT
#include "lattice/gates/field_stepper.h"

#include <algorithm>

#include "dynamics/disc/disc_section.h"
#include "lattice/gates/complementarity.h"

namespace gatewalk::lattice {

using namespace dynamics;

namespace {

double length_of_gate(const GateParams& p) { return p.run.traverse_y; }
double width_of_gate(const GateParams& p) { return p.gate_width(); }

}  // namespace

FieldStepper::FieldStepper(const GateParams& p, const FieldParams& field, const BodyState& start)
    : p_(p), field_(field), usual_(p, p.run.step), body_(start) {
  current_ = last_ = find(field.start_column(), field.start_row);
  awake_.push_back(current_);
  lowest_ = energy();
}

BodyState FieldStepper::seen_from(const Gate& gate, BodyState body) const {
  body.x -= width_of_gate(p_) * (gate.column - gates_[current_].column);
  body.y -= length_of_gate(p_) * (gate.row - gates_[current_].row);
  return body;
}

bool FieldStepper::in_reach(const Gate& gate, double slack) const {
  const BodyState b = seen_from(gate, body_);
  const double px = std::abs(b.x) - p_.beams.joint_x;  // from the nearer of the two joints
  const double py = b.y - p_.beams.joint_y;
  const double reach = p_.beams.length + p_.body.radius + slack;
  return px * px + py * py <= reach * reach;
}

std::size_t FieldStepper::find(int column, int row) {
  for (std::size_t i = 0; i < gates_.size(); ++i)
    if (gates_[i].column == column && gates_[i].row == row) return i;
  gates_.push_back({column, row, {}, now_, 0.0});
  return gates_.size() - 1;
}

std::array<BeamState, 2> FieldStepper::beams_now(const Gate& gate) const {
  auto beams = gate.beams;
  const double inertia = p_.beams.inertia();
  for (const Side side : {kLeft, kRight})
    BeamFlow(p_.beams.stiffness(side) / inertia, p_.beams.damping / inertia, now_ - gate.time)
        .apply(beams[side], 0.0);
  return beams;
}

std::array<BeamState, 2> FieldStepper::beams(int column, int row) const {
  for (std::size_t i = 0; i < gates_.size(); ++i) {
    const Gate& gate = gates_[i];
    if (gate.column != column || gate.row != row) continue;
    const bool awake = std::find(awake_.begin(), awake_.end(), i) != awake_.end();
    return awake ? gate.beams : beams_now(gate);
  }
  return {};
}

void FieldStepper::set_beams(int column, int row, const std::array<BeamState, 2>& beams) {
  const std::size_t i = find(column, row);
  const bool awake = std::find(awake_.begin(), awake_.end(), i) != awake_.end();
  gates_[i].beams = beams;
  gates_[i].time = now_;
  if (!awake) {
    asleep_energy_ += beam_energy(beams) - gates_[i].energy;
    gates_[i].energy = beam_energy(beams);
  }
  lowest_ = energy() - work_;
}

double FieldStepper::beam_energy(const std::array<BeamState, 2>& beams) const {
  return dynamics::energy(p_, {BodyState{}, beams});
}

double FieldStepper::energy() const {
  double sum = dynamics::energy(p_, {body_, {}});
  for (std::size_t i = 0; i < gates_.size(); ++i) {
    const bool awake = std::find(awake_.begin(), awake_.end(), i) != awake_.end();
    sum += beam_energy(awake ? gates_[i].beams : beams_now(gates_[i]));
  }
  return sum;
}

GateRun FieldStepper::run_gate(RandomForce& force) {
  GateRun run;
  const BodyState start = body_;
  const double nearly_over = p_.run.time_limit - 1e-6 * p_.run.step;
  while (!outside(p_, body_) && run.seconds < nearly_over) {
    const double f = force.value();
    const double spell = std::min(force.left(), p_.run.time_limit - run.seconds);
    const double from = body_.x;
    const double passed = advance(f, spell, run.watch);
    run.random_work += f * (body_.x - from);
    force.pass(passed);
    run.seconds += passed;
    if (!finite()) break;
  }
  run.exit = body_;
  settle_energy(p_, start, run);
  if (finite()) run.outcome = outcome_of(p_, {body_, gates_[current_].beams}, run.watch);
  return run;
}

void FieldStepper::go_on(dynamics::Outcome outcome) {
  const Face& move = disc_section().faces[crossing_of(p_, outcome, body_).face];
  const std::size_t next = find(column() + move.di_x, row() + move.di_y);
  body_ = shifted_into_next(p_, outcome, body_);
  last_ = current_;
  current_ = next;
}

void FieldStepper::choose_awake(double h) {
  // The disc's longest way within the step; beams come no nearer than their length.
  const double slack = h * (std::abs(body_.vx) + std::abs(body_.vy));
  next_.assign(1, current_);
  const auto add = [&](std::size_t i) {
    if (std::find(next_.begin(), next_.end(), i) == next_.end() && in_reach(gates_[i], slack))
      next_.push_back(i);
  };
  if (field_.fidelity == Fidelity::all) {
    const double reach = p_.beams.length + p_.body.radius + slack;
    const double width = width_of_gate(p_), length = length_of_gate(p_);
    const auto within = [](double at, double low, double high) {
      return static_cast<int>(std::clamp(at, low, high));
    };
    // Gates whose joints lie within +-reach of the disc's centre in x and in y, as steps from this
    // gate.
    const Gate here = gates_[current_];
    const double left = -here.column, right = field_.columns - 1 - here.column;
    const double bottom = -here.row, top = field_.rows - 1 - here.row;
    const double wide = p_.beams.joint_x + reach, ahead = body_.y - p_.beams.joint_y;
    const int first_column = within(std::ceil((body_.x - wide) / width), left, right);
    const int last_column = within(std::floor((body_.x + wide) / width), left, right);
    const int first_row = within(std::ceil((ahead - reach) / length), bottom, top);
    const int last_row = within(std::floor((ahead + reach) / length), bottom, top);
    for (int dy = first_row; dy <= last_row; ++dy)
      for (int dx = first_column; dx <= last_column; ++dx) {
        const Gate there{here.column + dx, here.row + dy, {}, 0.0, 0.0};
        if (in_reach(there, slack)) add(find(there.column, there.row));
      }
  } else {
    add(last_);
  }
  if (next_ == awake_) return;

  for (const std::size_t i : awake_) {
    if (std::find(next_.begin(), next_.end(), i) != next_.end()) continue;
    gates_[i].time = now_;
    gates_[i].energy = beam_energy(gates_[i].beams);
  }
  for (const std::size_t i : next_)
    if (std::find(awake_.begin(), awake_.end(), i) == awake_.end())
      gates_[i].beams = beams_now(gates_[i]);
  awake_.swap(next_);
  asleep_energy_ = 0.0;
  for (std::size_t i = 0; i < gates_.size(); ++i)
    if (std::find(awake_.begin(), awake_.end(), i) == awake_.end())
      asleep_energy_ += gates_[i].energy;
}

double FieldStepper::advance(double force_x, double duration, Watch& watch) {
  // A duration that is not a whole number of steps (the rest of a hold) is cut into equal, shorter
  // steps.
  const double wanted = duration / p_.run.step;
  const auto steps = std::max<long>(1, std::lround(std::ceil(wanted - 1e-6)));
  const bool usual = std::abs(wanted - static_cast<double>(steps)) < 1e-6;
  const Step k = usual ? usual_ : Step(p_, duration / static_cast<double>(steps));
  for (long i = 0; i < steps; ++i) {
    choose_awake(k.h);
    const BodyState before = body_;
    before_.clear();
    for (const std::size_t gate : awake_) before_.push_back(gates_[gate].beams);
    step(k, force_x, watch);
    const bool left = finite() && outside(p_, body_);
    const double passed = left ? back_to_exit(before, k.h) : k.h;
    now_ += passed;
    watch_all(before, force_x, k.h, watch);
    if (left || !finite()) return static_cast<double>(i) * k.h + passed;
  }
  return duration;
}

void FieldStepper::step(const Step& k, double force_x, Watch& watch) {
  ++watch.evaluations;
  const double half = 0.5 * k.h;
  const BodyState middle{body_.x + half * body_.vx, body_.y + half * body_.vy, 0.0, 0.0};
  const double vx = k.v_to_v * body_.vx + k.v_per_N * force_x;
  const double vy = k.v_to_v * body_.vy + k.v_per_N * p_.forces.propulsion;

  contacts_.clear();
  for (const std::size_t gate : awake_) {
    const BodyState here = seen_from(gates_[gate], middle);
    for (const Side side : {kLeft, kRight}) {
      BeamState& beam = gates_[gate].beams[side];
      const double theta = beam.theta + half * beam.omega;
      const double omega = k.w_to_w[side] * beam.omega - k.w_per_rad[side] * beam.theta;
      if (!out_of_reach(p_, side, here, theta)) {
        ++watch.evaluations;
        const Touch t = nearest(p_, side, here, theta);
        if (t.gap <= 0.0)
          contacts_.push_back({gate, side, t, gap_rate(t, body_, beam),
                               gap_rate(t, {0.0, 0.0, vx, vy}, {0.0, omega}), 0.0});
      }
      beam.omega = omega;  // the code below updates the angle
    }
  }
  double after_vx = vx, after_vy = vy;
  if (!contacts_.empty()) resolve(k, after_vx, after_vy);
  body_.x += half * (body_.vx + after_vx);
  body_.y += half * (body_.vy + after_vy);
  body_.vx = after_vx;
  body_.vy = after_vy;
  for (const Contact& c : contacts_) {
    if (c.impulse == 0.0) continue;
    ++watch.impacts;
    gates_[c.gate].beams[c.side].omega -= c.impulse * c.touch.lever / k.inertia[c.side];
  }
  for (std::size_t i = 0; i < awake_.size(); ++i)
    for (const Side side : {kLeft, kRight}) {
      BeamState& beam = gates_[awake_[i]].beams[side];
      beam.theta += half * (before_[i][side].omega + beam.omega);
    }
}

void FieldStepper::resolve(const Step& k, double& vx, double& vy) {
  // W and b of solve_lcp: u+ + e u- = W J + b.
  const auto own = [&](const Contact& c) {
    return compliance(k.mass, k.inertia[c.side], c.touch.lever);
  };
  const auto cross = [&](const Contact& a, const Contact& b) {
    return (a.touch.nx * b.touch.nx + a.touch.ny * b.touch.ny) / k.mass;
  };
  const auto rate = [&](const Contact& c) {
    return c.free + (c.touch.kind == ContactKind::tip ? p_.contact.tip_restitution
                                                      : p_.contact.restitution) *
                        c.before;
  };
  const std::size_t n = contacts_.size();
  if (n <= 2) {  // one or two contacts by cases; two terms commute to the last bit
    Contact& a = contacts_.front();
    Contact& b = contacts_.back();
    const bool two = n == 2;
    const auto impulse = dynamics::unilateral_impulses({own(a), own(b), two ? cross(a, b) : 0.0},
                                                       {rate(a), two ? rate(b) : 0.0}, {true, two});
    b.impulse = impulse[1];
    a.impulse = impulse[0];  // last: without a second contact, a and b are the same
    vx += (impulse[0] * a.touch.nx + impulse[1] * b.touch.nx) / k.mass;
    vy += (impulse[0] * a.touch.ny + impulse[1] * b.touch.ny) / k.mass;
    return;
  }

  // Left to right or right to left, rows upwards in both: the mirror image has the other order.
  const auto in_order = [&](bool from_left) {
    std::sort(contacts_.begin(), contacts_.end(), [&](const Contact& a, const Contact& b) {
      const auto place = [&](const Contact& c) {
        const int across = 2 * gates_[c.gate].column + (c.side == kRight);
        return std::pair(from_left ? across : -across, gates_[c.gate].row);
      };
      return place(a) < place(b);
    });
  };
  const auto impulses = [&] {
    const auto size = static_cast<Eigen::Index>(n);
    Eigen::MatrixXd w(size, size);
    Eigen::VectorXd b(size);
    for (Eigen::Index i = 0; i < size; ++i) {
      b[i] = rate(contacts_[i]);
      w(i, i) = own(contacts_[i]);
      for (Eigen::Index j = 0; j < i; ++j) w(i, j) = w(j, i) = cross(contacts_[i], contacts_[j]);
    }
    return solve_lcp(w, b);
  };
  struct Sum {
    double x = 0.0, y = 0.0;
  };
  const auto sum = [&] {
    Sum s;
    for (const Contact& c : contacts_) {
      s.x += c.impulse * c.touch.nx;
      s.y += c.impulse * c.touch.ny;
    }
    return s;
  };
  // The mean over both orders has no preferred direction in its round-off. Sorting in the first
  // order again puts the contacts back in place.
  in_order(true);
  const Eigen::VectorXd forwards = impulses();
  in_order(false);
  const Eigen::VectorXd backwards = impulses();
  for (std::size_t i = 0; i < n; ++i) contacts_[i].impulse = backwards[i];
  in_order(true);
  for (std::size_t i = 0; i < n; ++i)
    contacts_[i].impulse = 0.5 * (contacts_[i].impulse + forwards[i]);
  const Sum one_way = sum();
  in_order(false);
  const Sum other_way = sum();
  vx += 0.5 * (one_way.x + other_way.x) / k.mass;
  vy += 0.5 * (one_way.y + other_way.y) / k.mass;
}

double FieldStepper::back_to_exit(const BodyState& before, double h) {
  GateState here{body_, gates_[current_].beams};
  const double passed = dynamics::back_to_exit(p_, {before, before_[0]}, here, h);
  for (std::size_t i = 0; i < awake_.size(); ++i) {
    auto& beams = gates_[awake_[i]].beams;
    beams = mixed(before_[i], beams, passed / h);
  }
  body_ = here.body;
  return passed;
}

void FieldStepper::watch_all(const BodyState& before, double force_x, double h, Watch& watch) {
  work_ += force_x * (body_.x - before.x) + p_.forces.propulsion * (body_.y - before.y);
  double now = dynamics::energy(p_, {body_, {}}) + asleep_energy_;
  const std::int64_t fast_before = watch.fast_steps;
  for (std::size_t i = 0; i < awake_.size(); ++i) {
    const Gate& gate = gates_[awake_[i]];
    const GateState s{seen_from(gate, body_), gate.beams};
    now += beam_energy(gate.beams);
    if (i == 0) {
      watch.state(p_, s, h);
      continue;
    }
    // Counts as part of the same step; max_theta is that of the body's gate.
    Watch other;
    other.state(p_, s, h);
    watch.max_penetration = std::fmax(watch.max_penetration, other.max_penetration);
    if (watch.fast_steps == fast_before) watch.fast_steps += other.fast_steps;
  }
  watch.energy_created = std::fmax(watch.energy_created, now - work_ - lowest_);
  lowest_ = std::fmin(lowest_, now - work_);
}

bool FieldStepper::finite() const {
  double sum = body_.x + body_.y + body_.vx + body_.vy;
  for (const std::size_t i : awake_)
    for (const BeamState& beam : gates_[i].beams) sum += beam.theta + beam.omega;
  return std::isfinite(sum);
}

}  // namespace gatewalk::lattice
