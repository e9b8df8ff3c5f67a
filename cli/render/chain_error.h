// SPDX-License-Identifier: MIT
#pragma once
/// The chain's error against its cost, as a result, CSV, a table and a figure.

#include <optional>
#include <string>

#include "cli/fields/fields.h"
#include "cli/render/figure.h"
#include "cli/render/provenance.h"
#include "lattice/scene/settle.h"
#include "lattice/scene/study/chain_error.h"

namespace gatewalk::cli {

/// The result of `chart chain`.
struct ChainErrorResult {
  lattice::ChainErrorChart chart;
  std::optional<lattice::Settled> method;
  Provenance made_by;
};
void describe(Fields& out, const ChainErrorResult& result);
/// CSV: for each start, a line for each point (exact and walks), then lines for direct simulation.
[[nodiscard]] std::string csv_of(const lattice::ChainErrorChart& chart);
/// The first screen: the answer for each start; and what --details adds: for each start a table of
/// points (trials per row by bins), and what limits them.
[[nodiscard]] std::string answer_text(const lattice::ChainErrorChart& chart);
[[nodiscard]] std::string details_text(const lattice::ChainErrorChart& chart);
/// For each start two panels: total variation, and 1 - corrcoef, over seconds.
[[nodiscard]] Figure figure_of(const lattice::ChainErrorChart& chart);

/// "start d = 4 m, v = (5, 10) m/s"
[[nodiscard]] std::string name_of(const lattice::FieldTruth& truth);
/// "bins x 0.5, visited"
[[nodiscard]] std::string name_of(const lattice::ChainCurve& curve);

}  // namespace gatewalk::cli
