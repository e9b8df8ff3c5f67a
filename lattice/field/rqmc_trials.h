// SPDX-License-Identifier: MIT
#pragma once
/// Trials whose noise comes from evenly spread points (randomised quasi-Monte Carlo): less sampling
/// error from the same number of runs.

#include <cstdint>
#include <functional>
#include <vector>

#include "dynamics/base/points.h"
#include "lattice/field/field_trials.h"

namespace gatewalk::lattice {

/// Number of arrays. Trial number i belongs to array i mod kArrays. Each array has its own
/// scramble, so arrays are independent replicates, from which error bars come.
inline constexpr int kArrays = 8;

/// Points for the first passages of trials from one start. Trial number i gets point number i /
/// kArrays of its array's scramble, so that trials of several rounds form one sequence.
class FirstPoints {
 public:
  /// `numbers`: offset of the trials' streams, as in RqmcTrials.
  FirstPoints(std::uint64_t seed, std::uint64_t stream, std::int64_t numbers);
  [[nodiscard]] dynamics::Point operator()(std::int64_t i) const;

 private:
  std::vector<dynamics::ScrambledPoints> arrays_;
};

/// True if points can set the noise of all cells (Cell::lay_noise).
[[nodiscard]] bool lays_noise(const dynamics::CellField& cells);

/// Several arrays of trials that run together.
struct RqmcTrials {
  std::int64_t first = 0;     // number of the first trial of all arrays
  std::int64_t of_array = 0;  // trials per array
  /// First array and number of arrays; trial first + kArrays j + a is the j-th of array a.
  int array = 0, arrays = kArrays;
  std::int64_t numbers = 0;             // added to a trial's number to name the trial's stream
  const FirstPoints* points = nullptr;  // for first passages, if all trials start alike
  std::function<dynamics::Entry(std::int64_t i)> start{};  // entry of trial number i

  [[nodiscard]] std::int64_t count() const { return of_array * arrays; }
};

/// Array-RQMC (L'Ecuyer, Lecot and Tuffin 2008). Trials advance gate by gate. At each step, the
/// trials of an array that enter cells of one type are sorted so that neighbours enter alike, and
/// the points of a scramble set the noise of their passages in this order. Each trial alone has the
/// distribution of run_field(); means over an array have less variance. `each` gets the trials
/// array by array; the tally numbers them so too, and does not count moves between gates. The
/// result is the same for any number of threads, and whatever arrays run together. `tick(trials
/// that have ended)` is called a few times a second, and may throw to stop.
[[nodiscard]] FieldTally run_even_field(const dynamics::CellField& cells, const FieldParams& field,
                                        const RqmcTrials& trials, std::uint64_t seed,
                                        FieldTrials* each,
                                        const std::function<void(std::int64_t)>& tick);

}  // namespace gatewalk::lattice
