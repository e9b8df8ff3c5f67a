// SPDX-License-Identifier: MIT
#include "dynamics/disc/study/accuracy.h"

#include <fmt/core.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "dynamics/base/kept_pieces.h"
#include "dynamics/disc/runs.h"

namespace gatewalk::dynamics {
namespace {

constexpr std::string_view kStep = "run.step_s";
constexpr std::string_view kTolerance = "run.event_tolerance_m";

const ParamInfo& info_of(std::string_view key) {
  const auto table = gate_param_table();
  return *std::find_if(table.begin(), table.end(),
                       [key](const ParamInfo& i) { return i.key == key; });
}

/// The median of the values and of `infinite` infinite ones; NaN if the median is infinite.
double median(std::vector<double> values, std::int64_t infinite) {
  // The upper of two middle values, so that the result is the distance of a real trial.
  const std::size_t rank = (values.size() + static_cast<std::size_t>(infinite)) / 2;
  if (rank >= values.size()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void require_pairs(std::span<const TrialEnd> a, std::span<const TrialEnd> b) {
  if (a.size() != b.size() || a.empty())
    throw std::invalid_argument("two runs of the same trials are compared, at least one");
}

template <class Column>
WeakError weak_error(std::span<const TrialEnd> a, std::span<const TrialEnd> b, int columns,
                     Column column) {
  require_pairs(a, b);
  const auto n = static_cast<double>(a.size());
  std::vector<std::int64_t> surplus(static_cast<std::size_t>(columns), 0), changed = surplus;
  WeakError e;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto from = static_cast<std::size_t>(column(b[i]));
    const auto to = static_cast<std::size_t>(column(a[i]));
    if (from == to) continue;
    ++surplus[to];
    --surplus[from];
    ++changed[to];
    ++changed[from];
    ++e.changed;
  }
  std::int64_t distance = 0;
  for (std::size_t c = 0; c < surplus.size(); ++c) {
    distance += std::abs(surplus[c]);
    // The mean absolute sum of `changed` steps of +-1 is sqrt(2/pi) sqrt(changed).
    e.chance += std::sqrt(static_cast<double>(changed[c]));
  }
  e.total_variation = 0.5 * static_cast<double>(distance) / n;
  e.chance *= 0.5 * std::sqrt(2.0 / std::numbers::pi) / n;

  // The standard error comes from the spread of (s[to] - s[from]) / 2 over the trials, s the sign
  // of a column's surplus; the mean of this quantity is the total variation.
  const auto sign = [](std::int64_t x) { return x > 0 ? 1.0 : x < 0 ? -1.0 : 0.0; };
  double squares = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d = 0.5 * (sign(surplus[static_cast<std::size_t>(column(a[i]))]) -
                            sign(surplus[static_cast<std::size_t>(column(b[i]))]));
    squares += (d - e.total_variation) * (d - e.total_variation);
  }
  if (a.size() > 1) e.standard_error = std::sqrt(squares / (n - 1.0) / n);
  return e;
}

}  // namespace

// ---- Settings ----

GateParams Setting::applied_to(GateParams p) const {
  p.run.method = method;
  info_of(key).ref(p) = value;
  return p;
}

const char* Setting::unit() const { return key == kStep ? "s" : "m"; }

std::string Setting::name() const { return fmt::format("{} {:.7g} {}", method, value, unit()); }

std::span<const std::string_view> chart_methods() {
  static constexpr std::array<std::string_view, 5> names{"paper", "stable", "moreau", "penalty",
                                                         "event"};
  return names;
}

std::vector<Setting> chart_settings(std::string_view method, const GateParams& p) {
  const auto known = chart_methods();
  if (std::find(known.begin(), known.end(), method) == known.end())
    throw std::invalid_argument("no settings for method '" + std::string(method) + "'");
  std::vector<Setting> settings;
  const auto add = [&](std::string_view key, double value) {
    GateParams own = p;
    own.run.method = method;
    const double usual = key == kStep ? default_step(own) : default_event_tolerance(p);
    settings.push_back({std::string(method), key, value, std::abs(value - usual) <= 1e-9 * usual});
  };
  if (method == "event")
    for (const double tolerance : {3e-1, 1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4})
      add(kTolerance, tolerance * scale_of(p).length);
  else
    for (const double n : {1, 2, 3, 4, 5, 8, 10, 20}) add(kStep, 1.0 / (p.forces.random_rate * n));
  if (method == "moreau")
    add(kStep, 1.0 / (p.forces.random_rate * 40));  // costs as much as others at n = 4
  return settings;
}

Setting reference_setting(const GateParams& p) {
  return {"event", kTolerance, 1e-7 * scale_of(p).length, false};
}
Setting second_reference_setting(const GateParams& p) {
  return {"event", kTolerance, 1e-6 * scale_of(p).length, false};
}

// ---- Trials ----

namespace {

TrialEnd end_without_column(const GateRun& run) {
  TrialEnd end{.outcome = run.outcome, .exit = run.exit, .seconds = run.seconds};
  if (end.outcome == Outcome::traversed_even) end.outcome = Outcome::traversed_right;
  return end;
}

}  // namespace

TrialEnd end_of(const GateParams& p, const StateSpace& space, const GateRun& run) {
  TrialEnd end = end_without_column(run);
  end.column = end.outcome == Outcome::broken ? space.trapped() + 1
               : end.outcome == Outcome::trapped
                   ? space.trapped()
                   : space.index_of(crossing_of(p, run.outcome, run.exit)).state;
  return end;
}

Verdict TrialEnds::verdict() const { return judge(health, out_of_work, kPermittedFaults); }

void add_trial_ends(TrialEnds& ends, const GateParams& p, const BodyState& start,
                    std::uint64_t seed, TrialRange range, std::int64_t most_work) {
  const auto method = make_method(p);
  // Without room ahead of the beams there is no next gate, so no column.
  std::optional<StateSpace> space;
  if (p.run.traverse_y > p.beams.joint_y + p.body.radius) space = table3_space(p);
  const std::size_t before = ends.trials.size();
  ends.trials.resize(before + static_cast<std::size_t>(range.count));
  struct Faults {
    Health health;
    std::int64_t out_of_work = 0;
  };
  tbb::enumerable_thread_specific<Faults> faults;  // the order does not matter
  carry_out_trials(
      p, *method, range.count,
      [&](RunSlot& slot) {
        slot.start = start;
        slot.force = gate_force(p, seed, range.first + slot.trial);
      },
      [&](RunSlot& slot, const GateRun& run) {
        Faults& f = faults.local();
        add_run(f.health, p, run);
        f.out_of_work += run.out_of_work;
        ends.trials[before + static_cast<std::size_t>(slot.trial)] =
            space ? end_of(p, *space, run) : end_without_column(run);
        return false;
      },
      most_work);
  for (const Faults& f : faults) {
    ends.health += f.health;
    ends.out_of_work += f.out_of_work;
  }
}

// ---- A check by a better method ----

GateParams checking_setting(const GateParams& p) {
  GateParams finer = p;
  if (p.run.method == "event") {
    finer.run.event_tolerance = std::max(0.1 * p.run.event_tolerance, 1e-13 * p.body.radius);
    return finer;
  }
  for (const char* method : {p.run.method == "stable" ? "event" : "stable", "event"}) {
    GateParams better = p;
    better.run.method = method;
    better.run.step = default_step(better);
    better.run.event_tolerance = default_event_tolerance(better);
    try {
      (void)make_method(better);
      return better;
    } catch (const InvalidParameter&) {
    }
  }
  finer.run.step *= 0.5;
  return finer;
}

TrialRange share_of(std::int64_t trials, std::size_t i, std::size_t starts) {
  const auto k = static_cast<std::int64_t>(i), n = static_cast<std::int64_t>(starts);
  return {trials * k / n, trials * (k + 1) / n - trials * k / n};
}

double uncertainty_of(const WeakError& e, std::int64_t trials) {
  return std::sqrt(static_cast<double>(e.changed) + 1.84 * 1.84) / static_cast<double>(trials);
}

void check_outcomes(Health& health, const GateParams& p, std::span<const BodyState> starts,
                    std::uint64_t seed, std::int64_t trials, const Work& work) {
  if (work.is_part()) return;  // a run with all trials makes this check
  const GateParams better = checking_setting(p);
  TrialEnds here, there;
  std::vector<TrialRange> parts;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    parts.push_back(share_of(trials, i, starts.size()));
    work.tell("check by a better method", parts.back().first, trials);
    add_trial_ends(here, p, starts[i], seed, parts.back());
    add_trial_ends(there, better, starts[i], seed, parts.back());
  }
  work.tell("check by a better method", trials, trials);
  const WeakError e = outcome_error(here.trials, there.trials, parts);
  health.checked_trials += trials;
  health.outcome_error =
      std::max(health.outcome_error, e.total_variation - 2.0 * uncertainty_of(e, trials));
}

GateTally run_checked_trials(const GateParams& p, const BodyState& start, std::uint64_t seed,
                             const Stage& stage, const Work& work) {
  GateTally tally;
  in_kept_pieces(
      work, stage, GateTally{},
      [&](TrialRange range) { return run_gate_trials(p, start, seed, range); },
      [&](const GateTally& piece) { tally += piece; });
  check_outcomes(tally.health, p, {&start, 1}, seed, check_sample(stage.items.count), work);
  return tally;
}

// ---- Errors ----

WeakError outcome_error(std::span<const TrialEnd> run, std::span<const TrialEnd> reference) {
  return weak_error(run, reference, kOutcomes,
                    [](const TrialEnd& e) { return static_cast<int>(e.outcome); });
}

WeakError outcome_error(std::span<const TrialEnd> run, std::span<const TrialEnd> reference,
                        std::span<const TrialRange> parts) {
  require_pairs(run, reference);
  WeakError mean{.total_variation = 0.0, .standard_error = 0.0};
  double variance = 0.0;
  for (const TrialRange& part : parts) {
    if (part.count == 0) continue;
    const auto first = static_cast<std::size_t>(part.first);
    const auto count = static_cast<std::size_t>(part.count);
    const WeakError e = outcome_error(run.subspan(first, count), reference.subspan(first, count));
    const double weight = static_cast<double>(count) / static_cast<double>(run.size());
    mean.total_variation += weight * e.total_variation;
    mean.chance += weight * e.chance;
    mean.changed += e.changed;
    variance += weight * weight * e.standard_error * e.standard_error;
  }
  mean.standard_error = std::sqrt(variance);
  return mean;
}

WeakError column_error(std::span<const TrialEnd> run, std::span<const TrialEnd> reference,
                       const StateSpace& space) {
  return weak_error(run, reference, space.size() + 2, [](const TrialEnd& e) { return e.column; });
}

double weak_limit(const WeakError& own, std::int64_t trials) {
  const double least =
      std::max({own.total_variation, own.chance, 1.0 / static_cast<double>(trials)});
  return std::min(1.0, kReferenceMargin * least);
}

StrongError strong_error(const GateParams& p, std::span<const TrialEnd> run,
                         std::span<const TrialEnd> reference) {
  require_pairs(run, reference);
  StrongError e;
  const Scale scale = scale_of(p);
  const double far = kPartedLength * scale.length, late = kPartedTime * scale.time;
  std::vector<double> position, velocity, time, energy;
  const auto way = [](Outcome o) {  // the larger deflection does not matter here
    return o == Outcome::traversed_right ? Outcome::traversed_left : o;
  };
  for (std::size_t i = 0; i < run.size(); ++i) {
    const TrialEnd &a = run[i], &b = reference[i];
    if (a.outcome == Outcome::trapped && b.outcome == Outcome::trapped) {
      ++e.trapped;
      continue;
    }
    const double dx = std::hypot(a.exit.x - b.exit.x, a.exit.y - b.exit.y);
    const double dt = std::abs(a.seconds - b.seconds);
    if (way(a.outcome) != way(b.outcome) || a.outcome == Outcome::broken ||
        !(dx <= far && dt <= late)) {
      ++e.parted;
      continue;
    }
    ++e.compared;
    position.push_back(dx);
    velocity.push_back(std::hypot(a.exit.vx - b.exit.vx, a.exit.vy - b.exit.vy));
    time.push_back(dt);
    const auto kinetic = [&](const BodyState& s) {
      return 0.5 * p.body.mass * (s.vx * s.vx + s.vy * s.vy);
    };
    energy.push_back(std::abs(kinetic(a.exit) - kinetic(b.exit)));
  }
  e.position = median(std::move(position), e.parted);
  e.velocity = median(std::move(velocity), e.parted);
  e.time = median(std::move(time), e.parted);
  e.energy = median(std::move(energy), e.parted);
  return e;
}

}  // namespace gatewalk::dynamics
