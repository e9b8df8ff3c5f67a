#pragma once
/// What a Cell promises, held against one: for the tests of whoever derives from it.

#include <cstdint>
#include <vector>

#include "dynamics/cells/cell.h"

namespace gatewalk::dynamics {

/// Carries trials through cells that are all like this one, one from each of `starts`, through
/// `passages` of them each at most, on the threads of the current TBB arena. Throws
/// std::logic_error naming the trial and the passage, both counted from 0, unless
///   the section is valid;
///   the same trials give the same bits again on one thread, and body after body by pass();
///   who left is at an entry through one of the faces, which is the passage's `next`, with finite
///   coordinates and 0 behind the last;
///   all passages are counted in Health, and those that broke;
///   the first cost is not negative, and costs behind the section's last are 0;
///   with() the value that a number has the bits are the same;
///   mirror images of passages are passages, if the cell says so and draws no noise: within 1e-6 of
///   each coordinate's scale in 99 of 100 (where a rounding decides they may differ).
void check_cell(const Cell& cell, const std::vector<Entry>& starts, int passages = 10,
                std::uint64_t seed = 1);

}  // namespace gatewalk::dynamics
