// SPDX-License-Identifier: MIT
#pragma once
/// Processes of MPI that carry out one command together (mpirun -n 4 gatewalk ...), in builds with
/// -DGATEWALK_MPI=ON.

#include <functional>

#include "dynamics/base/work.h"

namespace gatewalk::cli {

/// While it lives, MPI is up, if mpirun or the like started this process.
class RanksScope {
 public:
  RanksScope();
  ~RanksScope();
  RanksScope(const RanksScope&) = delete;
  RanksScope& operator=(const RanksScope&) = delete;
};

/// Null where there is one process.
[[nodiscard]] dynamics::Ranks* ranks();
/// Of one process too.
[[nodiscard]] bool is_first_rank();
/// What each rank is asked at a safe point: whether to stop.
void set_ranks_stop(std::function<bool()> asked);
/// Ends all processes, where this one failed alone; nothing where it is the only one.
void abort_ranks(int status);

}  // namespace gatewalk::cli
