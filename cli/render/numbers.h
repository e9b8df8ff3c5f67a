// SPDX-License-Identifier: MIT
#pragma once
/// A result as one table of numbers, for R, MATLAB and spreadsheets.

#include <string>

#include "cli/render/fields.h"

namespace gatewalk::cli {

/// CSV with a line for each number of the result: quantity,i,j,value,low_95,high_95. The quantity
/// is the way of keys to it ("endings.crossed"; items of lists by their key or name, else by their
/// number from 0), i and j where in a list (row and column of a table) it stands, from 0, and
/// low_95 and high_95 its 95 % interval. Yes is 1, no 0; null and what is no finite number is
/// empty; words are left out, and so is made_by.
[[nodiscard]] std::string table_of_numbers(const Description& describe);

}  // namespace gatewalk::cli
