// SPDX-License-Identifier: MIT
#include "lattice/pool/pool_runner.h"

#include <stdexcept>
#include <string>

#include "dynamics/base/kept_pieces.h"
#include "lattice/field/running_trial.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

static_assert(kArrays == kTrialGroups);  // error bars come from independent arrays

// Numbers of the first trials, which no other command uses: full trials, trials through one gate,
// scattered trials.
constexpr std::int64_t kFullOwn = std::int64_t{1} << 41, kFirstOwn = std::int64_t{1} << 42,
                       kScatteredOwn = std::int64_t{1} << 43;

}  // namespace

PoolRunner::PoolRunner(const Problem& problem, std::uint64_t seed, std::int64_t most_runs,
                       const Work& work)
    : problem_(problem),
      seed_(seed),
      most_runs_(most_runs),
      work_(work),
      lays_noise_(lays_noise(problem.cells)) {}

void PoolRunner::run_full(OwnRuns& s, std::int64_t count) {
  run({"full trials", true, kFullOwn, [&s](std::int64_t) { return s.start; }, true}, count, s.full);
}

void PoolRunner::run_first(OwnRuns& s, std::int64_t count) {
  run({"first runs", false, kFirstOwn, [&s](std::int64_t) { return s.start; }, true}, count,
      s.first);
}

void PoolRunner::run_scattered(RangeRuns& s, const StartRange& starts, std::int64_t count) {
  run({"scattered trials", true, kScatteredOwn, [&](std::int64_t i) { return drawn(starts, i); },
       false},
      count, s.each);
  for (std::int64_t i = std::ssize(s.starts); i < std::ssize(s.each.passed); ++i)
    s.starts.push_back(drawn(starts, i));
}

Entry PoolRunner::drawn(const StartRange& starts, std::int64_t i) const {
  Random random(Purpose::resampling,
                {seed_, static_cast<std::uint64_t>(kScatteredOwn), static_cast<std::uint64_t>(i)});
  Entry entry{starts.face};
  for (std::size_t axis = 0; axis < problem_.map().section.coordinates.size(); ++axis) {
    const auto& [from, to] = starts.at[axis];
    entry.at[axis] = from + (to - from) * random.uniform();
  }
  return entry;
}

void PoolRunner::finish() {
  if (gate_runs > 0 && problem_.check)
    problem_.check(std::max(trials_, gate_runs / 10), seed_, health, work_);
}

std::optional<FirstPoints> PoolRunner::points_of(const Begun& begun) const {
  if (!lays_noise_ || !begun.alike) return {};
  const Cell& cell = problem_.cells.at(problem_.field.start_column(), problem_.field.start_row);
  return FirstPoints(seed_, cell.stream_of(begun.start(0)), begun.numbers);
}

void PoolRunner::run(const Begun& begun, std::int64_t count, FieldTrials& all) {
  const Stopwatch watch;
  const auto most = static_cast<double>(runs_left());
  count = std::max<std::int64_t>(
      kLeastTrials, static_cast<std::int64_t>(
                        std::min(static_cast<double>(count),
                                 most / (begun.through_field ? gates_per_trial() : 1.0) + 1.0)));
  if (lays_noise_ && begun.through_field && count >= kLeastEven)
    run_even(begun, count, all);
  else
    run_plain(begun, count, all);
  seconds += watch.seconds();
  if (health.broken > 0)
    throw std::runtime_error("prediction: " + std::to_string(health.broken) +
                             " gate runs stopped being finite numbers; try method stable or a "
                             "smaller run.step_s");
}

void PoolRunner::run_plain(const Begun& begun, std::int64_t count, FieldTrials& all) {
  FieldParams field = problem_.field;
  if (!begun.through_field) field.max_gates = 1;
  const auto points = points_of(begun);
  const Cell& cell = problem_.cells.at(field.start_column(), field.start_row);
  const std::int64_t done = std::ssize(all.passed);
  in_kept_pieces(
      work_, {begun.what, {0, count}},
      RunTrials{FieldTally(problem_.field), {.final_gates = {}, .keep_passages = true}},
      [&](TrialRange range) {
        FieldTrials each{.final_gates = {}, .keep_passages = true};
        const std::int64_t first = done + range.first;
        FieldTally tally = run_field(
            problem_.cells, field,
            [&](std::int64_t i, Body& body) {
              begin_trial(cell, begun.start(first + i), seed_, begun.numbers + first + i, body);
              if (points) cell.lay_noise(body, (*points)(first + i));
            },
            {begun.numbers + first, range.count}, &each);
        return RunTrials{std::move(tally), std::move(each)};
      },
      [&](const RunTrials& piece) {
        all.append(piece.each);
        this->count(begun, piece.tally);
      });
}

void PoolRunner::run_even(const Begun& begun, std::int64_t count, FieldTrials& all) {
  const std::int64_t batches = 1 + (count - 1) / (kArrays * most_of_array),
                     of_array = 1 + (count - 1) / (kArrays * batches),
                     done = std::ssize(all.passed);
  const auto points = points_of(begun);
  FieldTrials got{.final_gates = {}, .keep_passages = true};  // array by array
  std::size_t ordered = 0;  // how many trials of `got` are already in `all`
  in_kept_pieces(
      work_, {begun.what, {0, kArrays * batches}, 0, kArrays * batches, kArrays},
      RunTrials{FieldTally(problem_.field), {.final_gates = {}, .keep_passages = true}},
      [&](TrialRange items) {
        RunTrials piece{FieldTally(problem_.field), {.final_gates = {}, .keep_passages = true}};
        for (std::int64_t at = items.first; at < items.first + items.count;) {
          const std::int64_t batch = at / kArrays, array = at % kArrays,
                             some = std::min(kArrays - array, items.first + items.count - at);
          const RqmcTrials trials{done + batch * kArrays * of_array,
                                  of_array,
                                  static_cast<int>(array),
                                  static_cast<int>(some),
                                  begun.numbers,
                                  points ? &*points : nullptr,
                                  begun.start};
          piece.tally += run_even_field(
              problem_.cells, problem_.field, trials, seed_, &piece.each, [&](std::int64_t ended) {
                work_.tell(begun.what, at + ended / of_array, kArrays * batches);
              });
          at += some;
        }
        return piece;
      },
      [&](const RunTrials& piece) {
        this->count(begun, piece.tally);
        got.append(piece.each);
        const auto each = static_cast<std::size_t>(of_array), of_batch = kArrays * each;
        for (; got.passed.size() - ordered >= of_batch; ordered += of_batch)
          for (std::size_t i = 0; i < of_batch; ++i)  // in the order of their numbers
            all.append(got, ordered + i % kArrays * each + i / kArrays);
        if (ordered < got.passed.size()) return;
        got = {.final_gates = {}, .keep_passages = true};
        ordered = 0;
      });
}

void PoolRunner::count(const Begun& begun, const FieldTally& tally) {
  const Health& of = tally.health;
  health += of;
  gate_runs += of.runs;
  if (!begun.through_field) return;
  trials_ += tally.trials;
  trial_runs_ += of.runs;
}

}  // namespace gatewalk::lattice
