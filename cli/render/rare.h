// SPDX-License-Identifier: MIT
#pragma once
/// Chances of rare events as JSON, as a table and as a picture.

#include <cstdint>
#include <string>
#include <vector>

#include "cli/render/figure.h"
#include "cli/render/json_fwd.h"
#include "dynamics/base/share.h"
#include "lattice/study/rare.h"

namespace gatewalk::cli {

/// Direct simulation beside it: how many of the trials entered rows 1, 2, ...
struct DirectRows {
  std::int64_t trials = 0;  // 0: none were asked for
  std::vector<std::int64_t> entered;
  double seconds = 0.0;
};

[[nodiscard]] Json to_json(const lattice::RareEvent& event, const DirectRows& direct);
[[nodiscard]] std::string table_of(const lattice::RareEvent& event, const DirectRows& direct,
                                   const lattice::FieldParams& field);
[[nodiscard]] Figure figure_of(const lattice::RareEvent& event, const DirectRows& direct);

}  // namespace gatewalk::cli
