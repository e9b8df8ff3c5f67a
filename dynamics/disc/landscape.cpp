// SPDX-License-Identifier: MIT
#include "dynamics/disc/landscape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <stdexcept>
#include <tuple>

#include "dynamics/disc/contact.h"

namespace gatewalk::dynamics {

// d, phi: polar coordinates of the disc's centre from the joint, in the beam's own frame. A beam
// turned forward by theta > phi has the disc behind it. The beam's side touches where the tangent
// from the joint touches, at the distance sqrt(d^2 - R^2): theta = phi + asin(R/d). If that point
// is beyond the tip, the tip touches: R^2 = d^2 + L^2 - 2 d L cos(theta - phi).
double forward_deflection(const GateParams& p, Side side, double x, double y) {
  const double length = p.beams.length, radius = p.body.radius;
  const double px = from_joint(p, side, x), py = y - p.beams.joint_y;
  const double d = std::hypot(px, py), phi = std::atan2(py, px);
  if (d >= length + radius) return 0.0;
  if (d < radius) return std::numeric_limits<double>::infinity();
  const bool on_side = d * d - radius * radius <= length * length;
  const double opening =
      on_side ? std::asin(radius / d)
              : std::acos((d * d + length * length - radius * radius) / (2.0 * d * length));
  return std::max(0.0, phi + opening);
}

double beam_energy(const GateParams& p, double x, double y, BeamsThatPush beams) {
  double energy = 0.0;
  for (const Side side : {kLeft, kRight}) {
    const double theta = beams[side] ? forward_deflection(p, side, x, y) : 0.0;
    if (theta > 0.0) energy += 0.5 * p.beams.stiffness(side) * theta * theta;  // Eq. (14)
  }
  return energy;
}

double propulsion_energy(const GateParams& p, double y) {
  return p.forces.propulsion * (p.run.traverse_y - y);  // Eq. (15)
}

namespace {

std::vector<double> points(double low, double high, double spacing) {
  const double steps = std::max(1.0, std::ceil((high - low) / spacing - 1e-9));
  std::vector<double> v;
  for (int i = 0; i <= static_cast<int>(steps); ++i) v.push_back(low + (high - low) * i / steps);
  return v;
}

std::size_t nearest_point(const std::vector<double>& v, double x) {
  const double spacing = v[1] - v[0];
  if (!(x >= v.front() - 0.5 * spacing && x <= v.back() + 0.5 * spacing))
    throw std::invalid_argument("the start lies outside the landscape");
  return static_cast<std::size_t>(
      std::lround((std::clamp(x, v.front(), v.back()) - v.front()) / spacing));
}

}  // namespace

Landscape landscape(const GateParams& p, double y_low, double spacing, BeamsThatPush beams) {
  validate(p);
  const double width = p.gate_width(), depth = p.run.traverse_y - y_low;
  if (!(spacing > 0.0) || !(depth > 0.0))
    throw std::invalid_argument("landscape: spacing must be positive and y_low below traverse_y");
  if (!((width / spacing + 2.0) * (depth / spacing + 2.0) <= 1e8))
    throw std::invalid_argument("landscape: more than 1e8 grid points");
  Landscape l{points(-p.beams.joint_x, p.beams.joint_x, spacing),
              points(y_low, p.run.traverse_y, spacing),
              {},
              {}};
  const auto rows = static_cast<Eigen::Index>(l.y.size()),
             columns = static_cast<Eigen::Index>(l.x.size());
  l.elastic.resize(rows, columns);
  l.total.resize(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i)
    for (Eigen::Index j = 0; j < columns; ++j) {
      l.elastic(i, j) = beam_energy(p, l.x[j], l.y[i], beams);
      l.total(i, j) = l.elastic(i, j) + propulsion_energy(p, l.y[i]);
    }
  return l;
}

std::array<double, 2> basin_below(const Landscape& l, double x, double y) {
  const double dx = l.x[1] - l.x[0], dy = l.y[1] - l.y[0];
  auto row = static_cast<Eigen::Index>(nearest_point(l.y, y)),
       column = static_cast<Eigen::Index>(nearest_point(l.x, x));
  for (;;) {
    double steepest = 0.0;  // J/m
    Eigen::Index down = 0, right = 0;
    for (const Eigen::Index i : {1, 0, -1})
      for (const Eigen::Index j : {0, -1, 1}) {  // straight moves before diagonal ones
        if (row + i < 0 || row + i >= l.total.rows() || column + j < 0 ||
            column + j >= l.total.cols())
          continue;
        const double drop = l.total(row, column) - l.total(row + i, column + j);
        if (i == 0 && j == 0) continue;
        const double slope =
            drop / std::hypot(static_cast<double>(i) * dy, static_cast<double>(j) * dx);
        if (slope > steepest * (1 + 1e-9)) {
          steepest = slope;
          down = i;
          right = j;
        }
      }
    if (down == 0 && right == 0)
      return {l.x[static_cast<std::size_t>(column)], l.y[static_cast<std::size_t>(row)]};
    row += down;
    column += right;
  }
}

// Dijkstra's algorithm with the highest energy on the path as the distance; the length breaks ties.
Pass lowest_pass(const Landscape& l, double x, double y) {
  const std::size_t columns = l.x.size(), rows = l.y.size();
  const double dx = l.x[1] - l.x[0], dy = l.y[1] - l.y[0];
  const auto energy = [&](std::size_t cell) {
    return l.total(static_cast<Eigen::Index>(cell / columns),
                   static_cast<Eigen::Index>(cell % columns));
  };
  const std::size_t start = nearest_point(l.y, y) * columns + nearest_point(l.x, x);
  using Reached =
      std::tuple<double, double, std::size_t, std::size_t>;  // highest, length, cell, from
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> next;
  constexpr std::size_t kNotYet = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> from(columns * rows, kNotYet);
  next.push({energy(start), 0.0, start, start});
  std::size_t end = kNotYet;
  while (!next.empty() && end == kNotYet) {
    const auto [highest, length, cell, before] = next.top();
    next.pop();
    if (from[cell] != kNotYet) continue;
    from[cell] = before;
    const auto row = static_cast<std::ptrdiff_t>(cell / columns),
               column = static_cast<std::ptrdiff_t>(cell % columns);
    if (row + 1 == static_cast<std::ptrdiff_t>(rows)) end = cell;
    for (const std::ptrdiff_t up : {-1, 0, 1})
      for (const std::ptrdiff_t right : {-1, 0, 1}) {
        const std::ptrdiff_t r = row + up, c = column + right;
        if (r < 0 || c < 0 || r >= static_cast<std::ptrdiff_t>(rows) ||
            c >= static_cast<std::ptrdiff_t>(columns))
          continue;
        const std::size_t to = static_cast<std::size_t>(r) * columns + static_cast<std::size_t>(c);
        if (from[to] != kNotYet || !std::isfinite(energy(to))) continue;
        next.push(
            {std::max(highest, energy(to)),
             length + std::hypot(static_cast<double>(right) * dx, static_cast<double>(up) * dy), to,
             cell});
      }
  }
  if (end == kNotYet)
    throw std::runtime_error("no way through the gate: the disc covers a joint all over its width");

  Pass pass;
  pass.start_energy = energy(start);
  std::size_t highest = start;
  for (std::size_t cell = end;; cell = from[cell]) {
    pass.way.push_back({l.x[cell % columns], l.y[cell / columns]});
    if (energy(cell) > energy(highest)) highest = cell;
    if (cell == start) break;
  }
  std::reverse(pass.way.begin(), pass.way.end());
  pass.x = l.x[highest % columns];
  pass.y = l.y[highest / columns];
  pass.energy = energy(highest);
  return pass;
}

namespace {

double lowest_y(const BodyState& start) { return std::min(0.0, start.y); }

GridPasses grid_passes(const GateParams& p, const BodyState& start, double spacing,
                       BeamsThatPush beams) {
  GridPasses found{spacing, landscape(p, lowest_y(start), spacing, beams), {}, {}};
  found.from_start = lowest_pass(found.landscape, start.x, start.y);
  const auto [x, y] = basin_below(found.landscape, start.x, start.y);
  found.from_basin = lowest_pass(found.landscape, x, y);
  return found;
}

}  // namespace

Spacings spacings_for(const GateParams& p, const BodyState& start) {
  constexpr double kUsual = 0.5;  // units of length
  constexpr double kMostAlongASide = 2000;
  const double most = p.beams.joint_x;
  const double least = std::max(p.run.traverse_y - lowest_y(start), 2.0 * most) / kMostAlongASide;
  return {least, std::clamp(kUsual * scale_of(p).length, least, std::max(least, most)), most};
}

Passes passes(const GateParams& p, const BodyState& start, double spacing, BeamsThatPush beams) {
  constexpr double kFiner = 10.0;
  const Spacings permitted = spacings_for(p, start);
  if (!(spacing >= permitted.least && spacing <= permitted.most))
    throw std::invalid_argument("passes: no grid can have this spacing");
  Passes found;
  found.beams = beams;
  found.kinetic_energy = 0.5 * p.body.mass * (start.vx * start.vx + start.vy * start.vy);
  found.coarse = grid_passes(p, start, spacing, beams);
  found.fine = grid_passes(p, start, std::max(spacing / kFiner, permitted.least), beams);
  return found;
}

}  // namespace gatewalk::dynamics
