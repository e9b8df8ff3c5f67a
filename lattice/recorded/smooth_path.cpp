// SPDX-License-Identifier: MIT
#include "lattice/recorded/smooth_path.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace gatewalk::lattice {
namespace {

/// How place and velocity change in a step of an Ornstein-Uhlenbeck velocity: the velocity is
/// multiplied by `kept` and goes `far` times as far; and the covariances of what is added.
struct Step {
  double kept, far;
  double xx, xv, vv;

  /// `q`: spectral density of the accelerations; `rate` (1/s) at which velocities are forgotten.
  Step(double dt, double q, double rate) {
    const double part = rate * dt;
    kept = std::exp(-part);
    if (part < 1e-3) {  // where the differences below would cancel
      far = dt * (1.0 - 0.5 * part);
      xx = q * dt * dt * dt / 3.0;
      xv = 0.5 * q * dt * dt;
      vv = q * dt;
      return;
    }
    far = (1.0 - kept) / rate;
    vv = q * (1.0 - kept * kept) / (2.0 * rate);
    xv = 0.5 * q * far * far;
    xx = (q * (dt - 2.0 * far) + vv) / (rate * rate);
  }
};

/// Place and velocity along one axis: means and covariances.
struct Belief {
  double x = 0.0, v = 0.0;
  double xx = 0.0, xv = 0.0, vv = 0.0;

  [[nodiscard]] Belief after(const Step& s) const {
    return {x + s.far * v, s.kept * v, xx + 2.0 * s.far * xv + s.far * s.far * vv + s.xx,
            s.kept * (xv + s.far * vv) + s.xv, s.kept * s.kept * vv + s.vv};
  }
  /// After a place was measured, with the variance `noise`.
  [[nodiscard]] Belief given(double place, double noise) const {
    const double gain_x = xx / (xx + noise), gain_v = xv / (xx + noise), off = place - x;
    const double left = noise / (xx + noise);
    return {x + gain_x * off, v + gain_v * off, left * xx, left * xv, vv - gain_v * xv};
  }
  /// A place and velocity drawn from this belief.
  [[nodiscard]] Belief drawn(dynamics::Random& random) const {
    const double a = std::sqrt(std::max(xx, 0.0)), b = a > 0.0 ? xv / a : 0.0;
    const double c = std::sqrt(std::max(vv - b * b, 0.0));
    const double first = random.normal(), second = random.normal();
    return {x + a * first, v + b * first + c * second};
  }
};

/// A stretch of measured places along one axis.
struct Stretch {
  const double* time;
  const double* place;
  std::size_t size;
};

/// The likelihood of a stretch for a noise of variance 1 and accelerations of density q, both in
/// the unit of the noise: sums over frames of the squared prediction errors over their variances,
/// and of the logarithms of these variances.
struct Likelihood {
  double squares = 0.0, logarithms = 0.0;
  std::size_t count = 0;
};
void add_likelihood(const Stretch& s, double q, Likelihood& sum) {
  constexpr double kWide = 1e8;  // little is known of the first velocity
  const double first = s.time[1] - s.time[0];
  Belief belief{s.place[0], (s.place[1] - s.place[0]) / first, 1.0, 0.0,
                kWide * (1.0 / (first * first) + q * first)};
  for (std::size_t i = 1; i < s.size; ++i) {
    belief = belief.after({s.time[i] - s.time[i - 1], q, 0.0});
    if (i > 1) {  // the first two places determine place and velocity
      const double off = s.place[i] - belief.x, variance = belief.xx + 1.0;
      sum.squares += off * off / variance;
      sum.logarithms += std::log(variance);
      ++sum.count;
    }
    belief = belief.given(s.place[i], 1.0);
  }
}

/// Noise and accelerations of one stretch, by maximum likelihood.
TrackNoise most_likely(const Stretch& x, const Stretch& y) {
  // Accelerations in the unit noise^2 / step^3. Within these limits lie bodies that hardly turn in
  // a hundred frames, and bodies whose noise is hardly seen.
  constexpr double kLeast = 1e-9, kMost = 1e6, kFactor = 1.6;
  const double step = (x.time[x.size - 1] - x.time[0]) / static_cast<double>(x.size - 1);
  TrackNoise best;
  double most = -HUGE_VAL;
  for (double relative = kLeast; relative < kMost; relative *= kFactor) {
    const double q = relative / (step * step * step);
    Likelihood sum;
    add_likelihood(x, q, sum);
    add_likelihood(y, q, sum);
    const double count = static_cast<double>(sum.count), variance = sum.squares / count;
    if (!(variance > 0.0)) return {};
    const double logarithm = -0.5 * (count * std::log(variance) + sum.logarithms);
    if (!(logarithm > most)) continue;
    most = logarithm;
    best = {std::sqrt(variance), variance * q, 0.0};
  }
  return best;
}

/// True for a body at rest, or one that the tracker has lost: its places show no noise.
bool is_one_place(const Track& track, std::size_t begin, std::size_t count) {
  for (std::size_t i = begin + 1; i < begin + count; ++i)
    if (track.x[i] != track.x[begin] || track.y[i] != track.y[begin]) return false;
  return true;
}

struct Weighted {
  double value, weight;
};
/// Sorted, so that sums do not depend on the order of bodies.
std::vector<Weighted> sorted(std::vector<Weighted> all) {
  std::sort(all.begin(), all.end(), [](const Weighted& a, const Weighted& b) {
    return a.value != b.value ? a.value < b.value : a.weight < b.weight;
  });
  return all;
}
/// The mean of the lower part of all weights.
double mean(std::vector<Weighted> all, double part = 1.0) {
  all = sorted(std::move(all));
  double left = 0.0, sum = 0.0, weights = 0.0;
  for (const Weighted& w : all) left += part * w.weight;
  for (const Weighted& w : all) {
    const double weight = std::clamp(w.weight, 0.0, left);
    sum += weight * w.value;
    weights += weight;
    left -= weight;
  }
  return weights > 0.0 ? sum / weights : 0.0;
}
double median(std::vector<Weighted> all) {
  all = sorted(std::move(all));
  double half = 0.0;
  for (const Weighted& w : all) half += 0.5 * w.weight;
  for (const Weighted& w : all)
    if ((half -= w.weight) <= 0.0) return w.value;
  return 0.0;
}

/// The process of a piece: the variance of measured places, and by frame the acceleration in the
/// step to it.
struct Process {
  double noise, square_speed, rate;
  bool is_exact;  // places have no noise: the path is where the body was measured
  std::vector<double> acceleration;

  [[nodiscard]] Step step(std::size_t i, double dt) const { return {dt, acceleration[i], rate}; }
};

/// Both directions of the smoother along one axis.
class Smoother {
 public:
  /// Goes forwards; times and places by frame.
  Smoother(const double* time, const double* places, const Process& process)
      : time_(time),
        process_(process),
        known_(process.acceleration.size()),
        ahead_(process.acceleration.size()) {
    known_[0] = {places[0], 0.0, process.noise, 0.0, process.square_speed};
    for (std::size_t i = 1; i < known_.size(); ++i) {
      ahead_[i] = known_[i - 1].after(process.step(i, duration(i)));
      known_[i] = ahead_[i].given(places[i], process.noise);
    }
  }
  [[nodiscard]] std::size_t size() const { return known_.size(); }
  /// Of the step to frame i.
  [[nodiscard]] double duration(std::size_t i) const { return time_[i] - time_[i - 1]; }
  /// What all places tell of the last frame.
  [[nodiscard]] const Belief& last() const { return known_.back(); }
  /// What all places tell of frame i - 1; `next`: of frame i, or drawn there.
  /// `shared`: the covariance of both velocities, if asked for.
  [[nodiscard]] Belief before(std::size_t i, const Belief& next, double* shared = nullptr) const {
    const Belief &own = known_[i - 1], &ahead = ahead_[i];
    const Step s = process_.step(i, duration(i));
    const double determinant = ahead.xx * ahead.vv - ahead.xv * ahead.xv;
    // The gain J: the covariance of this state and the next, over that of the next.
    const double xx = own.xx + s.far * own.xv, xv = s.kept * own.xv, vx = own.xv + s.far * own.vv,
                 vv = s.kept * own.vv;
    const double j_xx = (xx * ahead.vv - xv * ahead.xv) / determinant,
                 j_xv = (xv * ahead.xx - xx * ahead.xv) / determinant,
                 j_vx = (vx * ahead.vv - vv * ahead.xv) / determinant,
                 j_vv = (vv * ahead.xx - vx * ahead.xv) / determinant;
    const double off_x = next.x - ahead.x, off_v = next.v - ahead.v;
    const double d_xx = next.xx - ahead.xx, d_xv = next.xv - ahead.xv, d_vv = next.vv - ahead.vv;
    const double x_x = j_xx * d_xx + j_xv * d_xv, x_v = j_xx * d_xv + j_xv * d_vv,
                 v_x = j_vx * d_xx + j_vv * d_xv, v_v = j_vx * d_xv + j_vv * d_vv;
    if (shared) *shared = j_vx * next.xv + j_vv * next.vv;
    return {own.x + j_xx * off_x + j_xv * off_v, own.v + j_vx * off_x + j_vv * off_v,
            own.xx + x_x * j_xx + x_v * j_xv, own.xv + x_x * j_vx + x_v * j_vv,
            own.vv + v_x * j_vx + v_v * j_vv};
  }

 private:
  const double* time_;
  const Process& process_;
  std::vector<Belief> known_, ahead_;  // by frame: with and without the frame's own place
};

/// What the expected squares of velocities and of their changes show of the step to a frame.
struct Change {
  double acceleration = 0.0;  // m^2/s^3
  double square_speed = 0.0;  // m^2/s^2
};
using Changes = std::vector<Change>;

/// Adds the changes along one axis.
void add_changes(const Smoother& smoother, const Process& process, Changes& changes) {
  Belief next = smoother.last();
  for (std::size_t i = smoother.size() - 1; i > 0; --i) {
    double shared = 0.0;
    const Belief own = smoother.before(i, next, &shared);
    const Step s = process.step(i, smoother.duration(i));
    const double change = next.v - s.kept * own.v;
    const double square =
        change * change + next.vv + s.kept * s.kept * own.vv - 2.0 * s.kept * shared;
    changes[i].acceleration += process.acceleration[i] * square / s.vv;
    changes[i].square_speed += next.v * next.v;
    next = own;
  }
}

/// The mean square of the velocity from frame to frame along an axis, noise included.
double square_of_steps(const TrackPiece& piece) {
  const Track& t = *piece.track;
  double sum = 0.0;
  for (std::size_t i = piece.begin + 1; i < piece.end; ++i)
    sum += 0.5 * (std::pow(t.x[i] - t.x[i - 1], 2) + std::pow(t.y[i] - t.y[i - 1], 2)) /
           std::pow(t.time[i] - t.time[i - 1], 2);
  return sum / static_cast<double>(piece.size() - 1);
}

/// From frame to frame, s.
double interval_of(const TrackPiece& piece) {
  const Track& t = *piece.track;
  return (t.time[piece.end - 1] - t.time[piece.begin]) / static_cast<double>(piece.size() - 1);
}

/// The process of a piece with this noise, if nothing is known of velocities and accelerations.
/// Places without noise get that of a millionth of a step, which numbers of double precision still
/// hold.
Process process_with(const TrackPiece& piece, const TrackNoise& noise) {
  const double step = interval_of(piece) * std::sqrt(square_of_steps(piece));
  const double least = 1e-6 * step;
  return {std::pow(std::max(noise.place, least), 2), 0.0, 0.0, noise.place <= least, {}};
}

/// The process along a piece; without accelerations for a body that stays at one place.
Process process_of(const TrackPiece& piece, const TrackNoise& noise) {
  constexpr int kRounds = 20;
  // The least acceleration, as a part of that of all tracks. Where a moving body had less, the
  // smoother would look so far ahead that its velocity tells of a stop to come. A body rests if its
  // mean square speed is less than this part of that of all tracks.
  constexpr double kLeastOfMoving = 0.1, kLeastOfResting = 1e-6, kResting = 0.1;
  const std::size_t n = piece.size();
  const double *const time = &piece.track->time[piece.begin],
                      *const x = &piece.track->x[piece.begin],
                      *const y = &piece.track->y[piece.begin];
  Process process = process_with(piece, noise);
  if (square_of_steps(piece) == 0.0) return process;
  const double interval = interval_of(piece);
  // Of a body that hardly moves: as if noise moved it, from the piece's first frame to its last.
  process.square_speed =
      std::max(noise.square_speed, process.noise / std::pow(time[n - 1] - time[0], 2));
  const double usual = std::max(noise.acceleration, 1e-9 * process.noise / std::pow(interval, 3));
  process.rate = std::min(0.5 * usual / process.square_speed, 1.0 / interval);
  // The smoother sees the path over this time to each side; accelerations are averages over twice
  // that.
  const double memory = std::pow(process.noise * interval / usual, 0.25);
  const auto reach = static_cast<std::size_t>(
      std::max(6.0, std::min(2.0 * memory / interval, static_cast<double>(n))));
  process.acceleration.assign(n, usual);
  Changes found(n), sums(n + 1);
  for (int round = 0; round < kRounds; ++round) {
    std::fill(found.begin(), found.end(), Change{});
    for (const double* places : {x, y})
      add_changes(Smoother(time, places, process), process, found);
    for (std::size_t i = 0; i < n; ++i)
      sums[i + 1] = {sums[i].acceleration + 0.5 * found[i].acceleration,
                     sums[i].square_speed + 0.5 * found[i].square_speed};
    for (std::size_t i = 1; i < n; ++i) {
      const std::size_t from = std::max<std::size_t>(1, i - std::min(i, reach)),
                        to = std::min(n, i + reach + 1);
      const auto mean = [&](double Change::*of) {
        return (sums[to].*of - sums[from].*of) / static_cast<double>(to - from);
      };
      const double moving =
          std::min(1.0, mean(&Change::square_speed) / (kResting * process.square_speed));
      double& q = process.acceleration[i];
      const double factor = mean(&Change::acceleration) / q;
      // The algorithm is slow where a body rests, so there it takes four steps at once.
      const double more = moving < 1.0 ? std::pow(std::min(factor, 1.0), 3) : 1.0;
      q = std::max(std::max(kLeastOfMoving * moving, kLeastOfResting) * usual, q * factor * more);
    }
  }
  return process;
}

/// A path by the smoother; drawn if there are random numbers and noise.
SmoothPath path_of(const TrackPiece& piece, Process process, dynamics::Random* random) {
  const std::size_t n = piece.size();
  const double* const time = &piece.track->time[piece.begin];
  SmoothPath path;
  path.time.assign(time, time + n);
  for (auto* values :
       {&path.x, &path.y, &path.vx, &path.vy, &path.place_variance, &path.velocity_variance})
    values->resize(n);
  const auto fill = [&](const double* places, std::vector<double>& place,
                        std::vector<double>& velocity) {
    if (process.acceleration.empty()) {  // at one place
      std::copy(places, places + n, place.begin());
      return;
    }
    const Smoother smoother(time, places, process);
    Belief belief = smoother.last();
    for (std::size_t i = n; i-- > 0;) {
      if (i + 1 < n) belief = smoother.before(i + 1, belief);
      path.place_variance[i] = std::max(0.0, belief.xx);
      path.velocity_variance[i] = std::max(0.0, belief.vv);
      if (random && !process.is_exact) belief = belief.drawn(*random);
      place[i] = process.is_exact ? places[i] : belief.x;
      velocity[i] = belief.v;
    }
  };
  fill(&piece.track->x[piece.begin], path.x, path.vx);
  fill(&piece.track->y[piece.begin], path.y, path.vy);
  path.acceleration = std::move(process.acceleration);
  path.square_speed = process.square_speed;
  path.rate = process.rate;
  return path;
}

/// The mean square of the velocity along an axis in the middle half of a stretch.
double square_speed_of(const TrackPiece& stretch, const TrackNoise& found) {
  constexpr double kUnknown = 100.0;  // nothing is known of the first velocity
  Process process = process_with(stretch, found);
  process.square_speed = kUnknown * square_of_steps(stretch);
  process.acceleration.assign(stretch.size(), found.acceleration);
  const SmoothPath path = path_of(stretch, std::move(process), nullptr);
  const std::size_t from = stretch.size() / 4, to = stretch.size() - from;
  double sum = 0.0;
  for (std::size_t i = from; i < to; ++i)
    sum += 0.5 * (path.vx[i] * path.vx[i] + path.vy[i] * path.vy[i]) - path.velocity_variance[i];
  return sum / static_cast<double>(to - from);
}

}  // namespace

TrackNoise noise_of(const std::vector<TrackPiece>& pieces) {
  constexpr std::size_t kLength = 100, kEnough = 400;  // frames; stretches
  std::size_t all = 0;
  for (const TrackPiece& p : pieces) all += (p.size() + kLength - 1) / kLength;
  if (all == 0)
    throw std::invalid_argument("no body was seen in " + std::to_string(kLeastFrames) +
                                " frames in a row, without a gap or a jump");
  const std::size_t stride = (all + kEnough - 1) / kEnough;
  std::vector<Weighted> places, accelerations, speeds;
  for (const TrackPiece& p : pieces) {
    const Track& t = *p.track;
    for (std::size_t at = p.begin; at < p.end; at += kLength) {
      const std::size_t size = std::min(kLength, p.end - at);
      // Which stretches are taken does not depend on the order of bodies.
      const bool is_taken = (number_of_name(t.body) + at / kLength) % stride == 0;
      if (!is_taken || size < kLeastFrames || is_one_place(t, at, size)) continue;
      const TrackNoise found =
          most_likely({&t.time[at], &t.x[at], size}, {&t.time[at], &t.y[at], size});
      const double weight = static_cast<double>(size);
      places.push_back({found.place, weight});
      accelerations.push_back({found.acceleration, weight});
      speeds.push_back({square_speed_of({&t, at, at + size}, found), weight});
    }
  }
  return {median(places), mean(accelerations, 0.95), std::max(0.0, mean(speeds))};
}

SmoothPath smoothed(const TrackPiece& piece, const TrackNoise& noise) {
  return path_of(piece, process_of(piece, noise), nullptr);
}

SmoothPath drawn_path(const TrackPiece& piece, const TrackNoise& noise, const SmoothPath& expected,
                      dynamics::Random& random) {
  Process process = process_with(piece, noise);
  process.square_speed = expected.square_speed;
  process.rate = expected.rate;
  process.acceleration = expected.acceleration;
  return path_of(piece, std::move(process), &random);
}

}  // namespace gatewalk::lattice
