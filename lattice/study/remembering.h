// SPDX-License-Identifier: MIT
#pragma once
/// Bodies whose entries show what they remember: the numbers of Cell::remembered as further
/// coordinates.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/base/work.h"
#include "lattice/field/problem.h"
#include "lattice/pool/run_pool.h"

namespace gatewalk::lattice {

/// Trials of a problem that can be simulated, each by a body of its own.
[[nodiscard]] RunPool simulated_bodies(const Problem& problem, std::int64_t trials,
                                       std::uint64_t seed, const dynamics::Work& work = {});

/// Simulated bodies, each with one trial. The last coordinates of entries are what the bodies
/// remember, each number as its rank among those of all passages; 0 at the start, where it is not
/// known.
struct Remembering {
  dynamics::CellMap map;
  RunPool pool;
  std::vector<std::string> keys;  // of the remembered numbers

  /// The same bodies as `plain`, the problem that they were simulated for, shows them.
  [[nodiscard]] RunPool seen_in(const Problem& plain) const;
};

/// Simulates trials, which are those of simulated_bodies; nullopt: the cells remember nothing.
/// Throws std::invalid_argument if types of cells remember different numbers, or if there are more
/// coordinates than kMostCoordinates together with them.
[[nodiscard]] std::optional<Remembering> remembering_bodies(const Problem& problem,
                                                            std::int64_t trials, std::uint64_t seed,
                                                            const dynamics::Work& work = {});

}  // namespace gatewalk::lattice
