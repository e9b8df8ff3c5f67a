// SPDX-License-Identifier: MIT
#include "lattice/scene/study/sweep.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "dynamics/base/kept_pieces.h"
#include "dynamics/disc/study/accuracy.h"
#include "lattice/scene/scene_keys.h"
#include "lattice/scene/units.h"

namespace gatewalk::lattice {
namespace {

constexpr std::size_t kMostPoints = 100'000;

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  in.exceptions(std::ios_base::badbit);
  for (std::string part; std::getline(in, part, at);) parts.push_back(part);
  if (text.ends_with(at)) parts.emplace_back();
  return parts;
}

double number_in(const std::string& text, const Variation& v) {
  double x = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), x);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size() || !std::isfinite(x))
    throw SceneError(v.origin + ": '" + text + "' in '" + v.values + "' is not a number");
  return x;
}

/// The values of a variation: "4:1:9" is 4, 5, ... 9; "4:9" has steps of 1, as in MATLAB; or values
/// between commas.
SweepAxis axis_of(const Variation& v) {
  SweepAxis axis{v.key, {}};
  const auto ends = split(v.values, ':');
  if (ends.size() <= 1) {
    axis.values = split(v.values, ',');
    if (axis.values.empty() || std::any_of(axis.values.begin(), axis.values.end(),
                                           [](const std::string& s) { return s.empty(); }))
      throw SceneError(v.origin + ": '" + v.values +
                       "' lacks a value: from:step:to, or values between commas");
    return axis;
  }
  if (ends.size() > 3) throw SceneError(v.origin + ": '" + v.values + "' is not from:step:to");
  const double from = number_in(ends.front(), v), to = number_in(ends.back(), v);
  const double step = ends.size() == 3 ? number_in(ends[1], v) : 1.0;
  if (step == 0.0) throw SceneError(v.origin + ": the step in '" + v.values + "' is 0");
  const double count = std::floor((to - from) / step + 1e-9) + 1.0;
  if (!(count >= 1.0))
    throw SceneError(v.origin + ": '" + v.values +
                     "' holds no value: the step leads away from the end");
  if (count > static_cast<double>(kMostPoints))
    throw SceneError(v.origin + ": '" + v.values + "' holds more than " +
                     std::to_string(kMostPoints) + " values");
  for (int i = 0; i < static_cast<int>(count); ++i) {
    const double value = from + i * step;
    axis.values.push_back(  // so that 0.1 * 3 becomes 0.3
        fmt::format("{:.15g}", std::abs(value) < 1e-9 * std::abs(step) ? 0.0 : value));
  }
  return axis;
}

}  // namespace

std::vector<SweepAxis> sweep_axes(const std::vector<Variation>& own,
                                  const std::vector<std::string>& given) {
  std::vector<Variation> all = own;
  for (const std::string& text : given) {
    const std::size_t equals = text.find('=');
    const std::string origin = "--vary " + text;
    if (equals == text.npos)
      throw SceneError(origin + ": must be key=from:step:to or key=value,value");
    const Variation v{text.substr(0, equals), text.substr(equals + 1), origin};
    const std::string key = known_key(v.key, origin);
    const auto same = std::find_if(all.begin(), all.end(), [&](const Variation& a) {
      return known_key(a.key, a.origin) == key;
    });
    if (same == all.end()) {
      all.push_back(v);
    } else if (same->origin.starts_with("--vary")) {
      throw SceneError(origin + ": " + v.key + " is varied twice");
    } else {
      *same = v;
    }
  }
  if (all.empty())
    throw std::invalid_argument(
        "nothing to vary: give --vary KEY=from:step:to, or a scene with a table [sweep]");
  std::vector<SweepAxis> axes;
  std::size_t points = 1;
  for (const Variation& v : all) {
    axes.push_back(axis_of(v));
    axes.back().origin = v.origin;
    points *= axes.back().values.size();
    if (points > kMostPoints)
      throw SceneError(v.origin + ": the grid has more than " + std::to_string(kMostPoints) +
                       " points");
  }
  return axes;
}

std::vector<SweepPoint> sweep_points(const SweepPlan& plan) {
  std::vector<SweepPoint> points(1);
  for (const SweepAxis& axis : plan.axes) {
    std::vector<SweepPoint> longer;
    for (const SweepPoint& p : points)
      for (const std::string& value : axis.values) {
        longer.push_back(p);
        longer.back().values.push_back(value);
      }
    points = std::move(longer);
  }
  for (SweepPoint& p : points) {
    std::vector<std::string> overrides = plan.overrides;
    for (std::size_t i = 0; i < plan.axes.size(); ++i)
      overrides.push_back(plan.axes[i].key + "=" + p.values[i]);
    try {
      p.scene = read_scene(plan.file, overrides);
    } catch (const SceneError& e) {  // its message names overrides as --set gives them
      const std::string what = e.what();
      for (std::size_t i = 0; i < plan.axes.size(); ++i)
        if (const std::string set = "--set " + plan.axes[i].key + "=" + p.values[i] + ":";
            what.starts_with(set))
          throw SceneError(plan.axes[i].origin + what.substr(set.size() - 1));
      throw;
    }
    p.scene.sweep.clear();  // the scene is one point of the sweep
  }
  return points;
}

void run_sweep(std::vector<SweepPoint>& points, dynamics::TrialRange trials, std::uint64_t seed,
               const dynamics::Work& work, const std::function<void(const SweepPoint&)>& settled) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const dynamics::Work part = work.part("sweep", i, points.size());
    const auto before = static_cast<std::int64_t>(i) * trials.count;
    const dynamics::Stage stage{"gate runs", trials, before, std::ssize(points) * trials.count};
    if (!has_share(part, stage)) continue;
    points[i].settled = settle_method(points[i].scene, RunsFrom::start, seed, part);
    if (points[i].settled && settled) settled(points[i]);
    const Scene& scene = points[i].scene;
    points[i].tally = dynamics::run_checked_trials(scene.gate, scene.start, seed, stage, part);
  }
}

}  // namespace gatewalk::lattice
