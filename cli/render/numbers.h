// SPDX-License-Identifier: MIT
#pragma once
/// A result as one table of numbers, for R, MATLAB and spreadsheets.

#include <string>

#include "cli/render/json_fwd.h"

namespace gatewalk::cli {

/// CSV with a line for each number of `result`: quantity,i,j,value,low_95,high_95. The quantity is
/// the way of keys to it ("endings.crossed"; elements of lists that are no numbers by their key or
/// name, else by their number from 0), i and j where in a list (row and column of a table) it
/// stands, from 0. The 95 % limits are those that the result has of it: of key k in k_95, or in
/// intervals_95; of probability and share in interval_95; those of a count are its share's, times
/// how many were counted. Yes is 1, no 0, null and what is no finite number nothing; words are left
/// out, and so is made_by.
[[nodiscard]] std::string table_of_numbers(const Json& result);

}  // namespace gatewalk::cli
