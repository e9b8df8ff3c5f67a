#include "markov/walk.h"

#include <Random123/philox.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace gatewalk::markov {
namespace {

__extension__ using Wide = unsigned __int128;

constexpr int kCellsWithoutLimit = 1'000'000;
constexpr std::int64_t kWalksPerTask = 4096;

}  // namespace

WalkTally& WalkTally::operator+=(const WalkTally& other) {
  if (final_cells.size() == 0) {
    final_cells = other.final_cells;
  } else if (other.final_cells.size() != 0) {
    if (final_cells.rows() != other.final_cells.rows() ||
        final_cells.cols() != other.final_cells.cols()) {
      throw std::invalid_argument("tallies of different fields cannot be added");
    }
    final_cells += other.final_cells;
  }
  walks += other.walks;
  trapped += other.trapped;
  left_field += other.left_field;
  cut_off += other.cut_off;
  unsampled += other.unsampled;
  steps += other.steps;
  return *this;
}

// A row of n entries gets n slots of 2^64 units. Entry j owns p_j n 2^64 units, and together they
// fill the slots exactly: each slot takes a small entry whole and is topped up from one large one.
Walker::Walker(const Chain& chain)
    : chain_(chain), slots_(static_cast<std::size_t>(chain.matrix().nonZeros())) {
  constexpr Wide kSlotUnits = Wide{1} << 64;
  const Probabilities& p = chain_.matrix();
  std::vector<Wide> units;
  std::vector<int> small, large;
  for (int row = 0; row < chain_.inputs(); ++row) {
    const int begin = p.outerIndexPtr()[row];
    const int count = p.outerIndexPtr()[row + 1] - begin;
    if (count == 0) continue;
    const double* value = p.valuePtr() + begin;
    const int* output = p.innerIndexPtr() + begin;
    Slot* slot = slots_.data() + begin;

    units.resize(static_cast<std::size_t>(count));
    Wide sum = 0;
    for (int j = 0; j < count; ++j) {
      // p in units of 2^-96, so that p n keeps 32 bits below the unit.
      const Wide scaled = static_cast<Wide>(std::ldexp(value[j], 96)) * static_cast<Wide>(count);
      units[j] = std::max(scaled >> 32, Wide{1});
      sum += units[j];
    }
    const auto largest = std::max_element(units.begin(), units.end());
    *largest += static_cast<Wide>(count) * kSlotUnits - sum;  // modulo 2^128: may be a decrease

    small.clear();
    large.clear();
    for (int j = 0; j < count; ++j) (units[j] < kSlotUnits ? small : large).push_back(j);
    while (!small.empty()) {
      const int s = small.back();
      const int l = large.back();
      small.pop_back();
      slot[s] = {static_cast<std::uint64_t>(units[s]) - 1, output[s], output[l]};
      units[l] -= kSlotUnits - units[s];
      if (units[l] < kSlotUnits) {
        large.pop_back();
        small.push_back(l);
      }
    }
    for (const int l : large) {
      slot[l] = {std::numeric_limits<std::uint64_t>::max(), output[l], output[l]};
    }
  }
}

std::int32_t Walker::pick(const Slot* slots, std::uint64_t count, std::uint64_t word) {
  const Wide product = static_cast<Wide>(word) * count;
  const Slot& slot = slots[static_cast<std::size_t>(product >> 64)];
  return static_cast<std::uint64_t>(product) <= slot.keep ? slot.here : slot.other;
}

int Walker::draw(int row, std::uint64_t word) const {
  if (row < 0 || row >= chain_.inputs() || !chain_.is_sampled(row)) {
    throw std::invalid_argument("row " + std::to_string(row + 1) +
                                " (counted from 1) cannot be drawn from: it does not exist or was "
                                "never sampled");
  }
  const int* row_begin = chain_.matrix().outerIndexPtr();
  return pick(slots_.data() + row_begin[row],
              static_cast<std::uint64_t>(row_begin[row + 1] - row_begin[row]), word);
}

WalkTally Walker::walk(const Field& field, const Start& start, int max_cells, std::uint64_t seed,
                       WalkRange range, std::vector<std::int32_t>* final_cell_of_walk) const {
  validate(chain_, field, start, max_cells);
  if (range.first < 0 || range.count < 0 ||
      range.first > std::numeric_limits<std::int64_t>::max() - range.count) {
    throw std::invalid_argument("walks: " + std::to_string(range.count) + " from number " +
                                std::to_string(range.first) + " on is not a range from 0 up");
  }
  if (final_cell_of_walk) final_cell_of_walk->resize(static_cast<std::size_t>(range.count));

  const int limit = max_cells == 0 ? kCellsWithoutLimit : max_cells;
  const int* const row_begin = chain_.matrix().outerIndexPtr();
  const Slot* const slots = slots_.data();
  const Exit* const exits = chain_.exits().data();
  const auto state = static_cast<std::uint64_t>(start.input);
  const r123::Philox4x64::key_type key = {{seed, kWalkStream}};

  const auto run = [&](std::int64_t first, std::int64_t last, WalkTally& tally) {
    WalkTally ends;  // local, so that the counters stay in registers
    std::int64_t* const final_cells = tally.final_cells.data();
    for (std::int64_t number = first; number < last; ++number) {
      std::int64_t column = start.column;
      std::int64_t row = start.row;
      int input = start.input;
      int cells = 1;
      r123::Philox4x64::ctr_type words;
      for (std::uint64_t drawn = 0;; ++drawn, ++cells) {
        const int begin = row_begin[input];
        const int count = row_begin[input + 1] - begin;
        if (count == 0) {
          ++ends.unsampled;
          break;
        }
        if (drawn % 4 == 0) {
          words = r123::Philox4x64{}({{drawn / 4, static_cast<std::uint64_t>(number), state, 0}}, key);
        }
        ++ends.steps;
        const Exit& exit = exits[pick(slots + begin, static_cast<std::uint64_t>(count),
                                      words[static_cast<std::size_t>(drawn % 4)])];
        if (exit.next_input == Exit::kTrapped) {
          ++ends.trapped;
          break;
        }
        const std::int64_t next_column = column + exit.di_x;
        const std::int64_t next_row = row + exit.di_y;
        if (next_column < 0 || next_column >= field.columns || next_row < 0 ||
            next_row >= field.rows) {
          ++ends.left_field;
          break;
        }
        if (cells == limit) {
          ++ends.cut_off;
          break;
        }
        column = next_column;
        row = next_row;
        input = exit.next_input;
      }
      const std::int64_t cell = row * field.columns + column;
      ++final_cells[cell];
      if (final_cell_of_walk) {
        (*final_cell_of_walk)[static_cast<std::size_t>(number - range.first)] =
            static_cast<std::int32_t>(cell);
      }
    }
    ends.walks = last - first;
    tally += ends;
  };

  WalkTally none;
  none.final_cells = CellCounts::Zero(field.rows, field.columns);
  tbb::enumerable_thread_specific<WalkTally> tallies(none);
  tbb::parallel_for(tbb::blocked_range<std::int64_t>(range.first, range.first + range.count,
                                                     kWalksPerTask),
                    [&](const tbb::blocked_range<std::int64_t>& part) {
                      run(part.begin(), part.end(), tallies.local());
                    });
  WalkTally total = none;
  for (const WalkTally& tally : tallies) total += tally;
  return total;
}

}  // namespace gatewalk::markov
