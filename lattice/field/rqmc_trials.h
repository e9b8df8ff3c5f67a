// SPDX-License-Identifier: MIT
#pragma once
/// Trials whose noise is laid by points that are evenly spread: less chance in the same runs
/// (randomised quasi-Monte Carlo).

#include <cstdint>
#include <functional>
#include <vector>

#include "dynamics/base/points.h"
#include "lattice/field/field_trials.h"

namespace gatewalk::lattice {

/// Trial number i belongs to array i mod kArrays. Arrays have scrambles of their own: they are
/// independent replicates, from which error bars come.
inline constexpr int kArrays = 8;

/// The points of passages through the first cell, of trials from one start: trial number i has the
/// point number i / kArrays of its array's scramble, so that trials of several rounds make one
/// sequence.
class FirstPoints {
 public:
  /// `numbers`: of the trials' streams, as RqmcTrials has them.
  FirstPoints(std::uint64_t seed, std::uint64_t stream, std::int64_t numbers);
  [[nodiscard]] dynamics::Point operator()(std::int64_t i) const;

 private:
  std::vector<dynamics::ScrambledPoints> arrays_;
};

/// Whether all cells' noise can be laid by points.
[[nodiscard]] bool lays_noise(const dynamics::CellField& cells);

/// Some arrays of trials that are run together.
struct RqmcTrials {
  std::int64_t first = 0;               // number of the first trial of all arrays
  std::int64_t of_array = 0;            // trials
  int array = 0, arrays = kArrays;      // which; trial first + kArrays j + a is the j-th of array a
  std::int64_t numbers = 0;             // added to a trial's number it names the trial's stream
  const FirstPoints* points = nullptr;  // of the first passages, where all start alike
  std::function<dynamics::Entry(std::int64_t i)> start{};  // of trial number i

  [[nodiscard]] std::int64_t count() const { return of_array * arrays; }
};

/// Array-RQMC (L'Ecuyer, Lecot and Tuffin 2008). Trials go gate by gate. Those of an array that
/// enter cells of one type at the same step are put in an order in which neighbours enter alike,
/// and the noise of their passages is laid by the points of a scramble in this order. Each trial
/// alone is as those of run_field are; means over an array have less variance. `each` gets them
/// array by array. Same result for any number of threads, whatever arrays are run
/// together. The tally numbers trials
/// array by array, and does not count moves between gates. `tick(trials that have ended)` is called
/// a few times a second; it may throw to stop.
[[nodiscard]] FieldTally run_even_field(const dynamics::CellField& cells, const FieldParams& field,
                                        const RqmcTrials& trials, std::uint64_t seed,
                                        FieldTrials* each,
                                        const std::function<void(std::int64_t)>& tick);

}  // namespace gatewalk::lattice
