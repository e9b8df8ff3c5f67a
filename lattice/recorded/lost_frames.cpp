// SPDX-License-Identifier: MIT
// Frames in which a tracker lost its body and wrote the last place again, or (0, 0).
#include <algorithm>
#include <cmath>

#include "lattice/recorded/smooth_path.h"
#include "lattice/recorded/track_source.h"

namespace gatewalk::lattice {
namespace {

constexpr double kSeldom = 1e-3;            // expected number of chance runs of one place per file
constexpr std::size_t kEnough = 1'000'000;  // number of values that suffice for a quantile

double quantile(std::vector<double>& values, double share) {
  if (values.empty()) return 0.0;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// Along one axis: the resolution of written places, and their scatter.
struct Grain {
  std::vector<double> places, bends;  // bends: |second differences|

  void add(double before, double middle, double behind) {
    places.push_back(middle);
    bends.push_back(std::abs(before - 2.0 * middle + behind));
  }
  /// Upper bound on the probability that a body at rest is seen twice at the same coordinate. The
  /// low quantile of the bends comes from bodies that hardly speed up or turn, so that only noise
  /// remains.
  [[nodiscard]] double chance_of_same() {
    constexpr double kTenth = 0.1256613;  // 10 % quantile of |x| for standard normal x
    const double noise = quantile(bends, 0.1) / (kTenth * std::sqrt(6.0));
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    std::vector<double> apart;
    for (std::size_t i = 1; i < places.size(); ++i) apart.push_back(places[i] - places[i - 1]);
    const double resolution = quantile(apart, 0.01);
    return noise > 0.0 ? std::erf(resolution / (2.0 * std::sqrt(2.0) * noise)) : 1.0;
  }
};

/// The longest run of one place that noise produces occasionally.
double longest_by_chance(const TrackFile& file) {
  std::size_t places = 0;
  for (const Track& track : file.tracks) places += track.time.size();
  const std::size_t stride = places / kEnough + 1;
  Grain x, y;
  std::size_t number = 0;
  for (const Track& t : file.tracks)
    for (std::size_t i = 2; i < t.time.size(); ++i) {
      const bool is_even = t.time[i] - t.time[i - 2] < 2.5 * file.interval;
      const bool is_one_place = t.x[i] == t.x[i - 1] && t.x[i] == t.x[i - 2] &&
                                t.y[i] == t.y[i - 1] && t.y[i] == t.y[i - 2];
      if (!is_even || is_one_place || number++ % stride != 0) continue;
      x.add(t.x[i - 2], t.x[i - 1], t.x[i]);
      y.add(t.y[i - 2], t.y[i - 1], t.y[i]);
    }
  const double same = x.chance_of_same() * y.chance_of_same();
  if (!(same < 1.0)) return HUGE_VAL;
  const double by_chance =
      1.0 + std::log(kSeldom / static_cast<double>(places)) / std::log(std::max(same, 1e-300));
  return std::max<double>(kLeastFrames - 1, by_chance);  // shorter runs do not fill a fit
}

/// The 90 % quantile of the steps of moving bodies, m.
double usual_step(const TrackFile& file) {
  std::vector<double> steps;
  for (const Track& t : file.tracks)
    for (std::size_t i = 1; i < t.time.size(); ++i)
      if (t.x[i] != t.x[i - 1] || t.y[i] != t.y[i - 1])
        steps.push_back(std::hypot(t.x[i] - t.x[i - 1], t.y[i] - t.y[i - 1]));
  return quantile(steps, 0.9);
}

}  // namespace

void leave_out_lost(TrackFile& file, const TrackOptions& options) {
  constexpr double kAway = 2.0, kFar = 10.0;  // in usual steps
  const double longest = longest_by_chance(file), usual = usual_step(file);
  std::int64_t at_rest = 0;
  const double zero_x = file.metres_per_unit * (0.0 - options.origin_x);
  const double zero_y =
      file.metres_per_unit * (options.y_down ? options.origin_y - 0.0 : 0.0 - options.origin_y);
  for (Track& t : file.tracks) {
    Track kept{t.body, {}, {}, {}};
    const auto distance = [&](std::size_t a, std::size_t b) {
      return std::hypot(t.x[a] - t.x[b], t.y[a] - t.y[b]);
    };
    for (std::size_t begin = 0, end = 0; begin < t.time.size(); begin = end) {
      for (end = begin + 1;
           end < t.time.size() && t.x[end] == t.x[begin] && t.y[end] == t.y[begin];)
        ++end;
      const bool is_long = static_cast<double>(end - begin) > longest;
      const auto goes_further = [&](double steps) {
        return end < t.time.size() && distance(begin, end) > steps * usual;
      };
      const bool is_zero = t.x[begin] == zero_x && t.y[begin] == zero_y;
      const bool is_far = (begin > 0 || end < t.time.size()) &&
                          (begin == 0 || distance(begin, begin - 1) > kFar * usual) &&
                          (end == t.time.size() || goes_further(kFar));
      // A body at rest continues from its place; a body that was lost is elsewhere by then.
      const bool is_held = is_long && goes_further(kAway);
      const std::size_t stays = is_zero && (is_long || is_far) ? 0 : is_held ? 1 : end - begin;
      (is_zero ? file.at_zero : file.repeated) += static_cast<std::int64_t>(end - begin - stays);
      if (is_long && stays == end - begin) at_rest += static_cast<std::int64_t>(stays - 1);
      for (std::size_t i = begin; i < begin + stays; ++i) {
        kept.time.push_back(t.time[i]);
        kept.x.push_back(t.x[i]);
        kept.y.push_back(t.y[i]);
      }
    }
    if (kept.time.size() < t.time.size()) t = std::move(kept);
  }
  const auto warn = [&](std::int64_t places, const char* what) {
    if (places == 0) return;
    file.warnings.push_back(file.source + ": " + std::to_string(places) +
                            (places == 1 ? " place " : " places ") + what +
                            ": a tracker writes so where it lost its body; taken as not seen");
  };
  warn(file.repeated,
       "stand still exactly, for more frames than their noise allows, and their body goes on "
       "elsewhere");
  if (at_rest > 0)
    file.remarks.push_back(std::to_string(at_rest) +
                           " places stand still exactly, for more frames than their noise allows, "
                           "until their body goes on from there or its track ends: at rest");
  warn(file.at_zero,
       "are exactly (0, 0), far from those before and behind, or for more frames "
       "than their noise allows");
}

}  // namespace gatewalk::lattice
