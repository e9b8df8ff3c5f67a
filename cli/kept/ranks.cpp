// SPDX-License-Identifier: MIT
#include "cli/kept/ranks.h"

namespace gatewalk::cli {

// One process, without MPI. Builds with MPI link ranks_mpi.cpp, which takes precedence.
RanksScope::RanksScope() = default;
RanksScope::~RanksScope() = default;
dynamics::Ranks* ranks() { return nullptr; }
bool is_first_rank() { return true; }
void set_ranks_stop(std::function<bool()>) {}
void abort_ranks(int) {}

}  // namespace gatewalk::cli
