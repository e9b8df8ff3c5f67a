// SPDX-License-Identifier: MIT
#pragma once
/// Probabilities of rare events as JSON, a table and a figure.

#include <cstdint>
#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "cli/render/figure.h"
#include "cli/render/provenance.h"
#include "dynamics/base/share.h"
#include "lattice/scene/settle.h"
#include "lattice/study/rare.h"

namespace gatewalk::cli {

/// The result of `rare`.
struct RareResult {
  lattice::RareEvent event;
  lattice::DirectRows direct;  // direct simulation, for comparison; zero trials: none
  std::optional<lattice::Settled> method;
  Provenance made_by;
};
void describe(Fields& out, const RareResult& result);
[[nodiscard]] std::string answer_text(const RareResult& result);
[[nodiscard]] std::string details_text(const RareResult& result, const lattice::FieldParams& field);
[[nodiscard]] Figure figure_of(const RareResult& result);

}  // namespace gatewalk::cli
