// SPDX-License-Identifier: MIT
#include "dynamics/cells/cell.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <bit>

namespace gatewalk::dynamics {

void Cell::carry_out(const NextPassage& next, Health& health, std::int64_t) const {
  Body body{.entry = {}, .random = Random(Purpose::gate, {})};
  for (bool more = next(body, nullptr); more;) {
    const Passage passage = pass(body);
    ++health.runs;
    health.broken += passage.fate == Fate::broken;
    more = next(body, &passage);
  }
}

std::uint64_t Cell::stream_of(const Entry& start) const {
  // From the bits of its numbers; the random generator serves as the hash.
  const std::vector<Coordinate>& coordinates = section().coordinates;
  r123::Philox4x64::ctr_type hash = {{static_cast<std::uint64_t>(start.face), 0, 0, 0}};
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    hash[1] = std::bit_cast<std::uint64_t>(start.at[k] / coordinates[k].scale + 0.0);  // -0 is 0
    hash = r123::Philox4x64()(hash, {{0, 0}});
  }
  return hash[0] >> 8;  // the top byte of a key is its purpose
}

CellField CellField::uniform(std::shared_ptr<const Cell> cell) {
  cell->section().validate();
  CellMap map{.section = cell->section(), .types = {{cell->is_symmetric()}}, .type_of_cell = {}};
  return {std::move(map), {std::move(cell)}};
}

void carry_out_trials(const Cell& cell, std::int64_t count, const BeginBody& begin,
                      const TakePassage& take, Health& health) {
  // Whoever is free takes the next trial: nobody waits for the end of a block.
  std::atomic<std::int64_t> next_trial{0};
  const NextPassage next = [&](Body& body, const Passage* ended) {
    if (ended != nullptr && take(body, *ended)) return true;
    body.trial = next_trial.fetch_add(1, std::memory_order_relaxed);
    if (body.trial >= count) return false;
    begin(body);
    return true;
  };
  const int threads = tbb::this_task_arena::max_concurrency();
  const std::int64_t each = (count + threads - 1) / threads;  // nobody takes what others could do
  tbb::enumerable_thread_specific<Health> parts;  // sums and largest values: any order will do
  tbb::parallel_for(0, threads, [&](int) {
    try {
      cell.carry_out(next, parts.local(), each);
    } catch (...) {
      next_trial = count;  // nobody takes another one
      throw;
    }
  });
  for (const Health& part : parts) health += part;
}

}  // namespace gatewalk::dynamics
