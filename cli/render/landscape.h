#pragma once
/// The lowest way through a gate over its energy landscape, as JSON, CSV, a table and a figure.

#include <string>

#include "cli/render/figure.h"
#include "cli/render/json_fwd.h"
#include "dynamics/ensemble.h"
#include "dynamics/landscape.h"

namespace gatewalk::cli {

/// Without "made_by": {"spacing_m", "beams", "start_kinetic_energy_J", "passes": one for each grid}
[[nodiscard]] Json to_json(const dynamics::Passes& passes);
/// A line for each point of the grid.
[[nodiscard]] std::string csv_of(const dynamics::Landscape& landscape);
/// A line for each grid, and whether the start's own energy would do; lengths and energies to what
/// counts in such a gate.
[[nodiscard]] std::string table_of(const dynamics::Passes& passes, const dynamics::GateParams& p);
/// Whom the landscape is held against: "measured: 5.1 % of 1000 trials traverse, 95 % [3.9, 6.6]".
[[nodiscard]] std::string measured_line(const dynamics::GateTally& tally);
/// The paper's Fig. 5, on the coarse grid: elastic energy as a surface
/// and from above, with the propulsion as a surface, and, from above, the lowest way through.
[[nodiscard]] Figure figure_of(const dynamics::Passes& passes, const dynamics::GateParams& p);

}  // namespace gatewalk::cli
