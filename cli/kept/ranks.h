// SPDX-License-Identifier: MIT
#pragma once
/// MPI processes that compute one command together (mpirun -n 4 gatewalk ...), in builds with
/// -DGATEWALK_MPI=ON.

#include <functional>

#include "dynamics/base/work.h"

namespace gatewalk::cli {

/// Keeps MPI running during its life, if mpirun or the like started this process.
class RanksScope {
 public:
  RanksScope();
  ~RanksScope();
  RanksScope(const RanksScope&) = delete;
  RanksScope& operator=(const RanksScope&) = delete;
};

/// The MPI processes; null if there is only one process.
[[nodiscard]] dynamics::Ranks* ranks();
/// Whether this is the first process; true if there is only one.
[[nodiscard]] bool is_first_rank();
/// Sets the function that each process asks at a safe point whether to stop. If one stops, all do.
void set_ranks_stop(std::function<bool()> asked);
/// Ends all processes after a failure of this one; does nothing if it is the only one.
void abort_ranks(int status);

}  // namespace gatewalk::cli
