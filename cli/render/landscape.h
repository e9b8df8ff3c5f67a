// SPDX-License-Identifier: MIT
#pragma once
/// The lowest way through a gate over its energy landscape, as JSON, CSV, a table and a figure.

#include <string>

#include "cli/render/figure.h"
#include "cli/render/json_fwd.h"
#include "cli/render/quantity.h"
#include "dynamics/disc/ensemble.h"
#include "dynamics/disc/landscape.h"

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
/// The coarse grid as two maps, elastic energy and with the propulsion, the latter with the lowest
/// way through of the fine one; and the energy along it.
[[nodiscard]] Figure figure_of(const dynamics::Passes& passes);

/// What matters of a landscape as it is drawn: beside the joints the beams' energy leaves every
/// scale, so the ceiling (J) is what lies in the middle, and some more.
[[nodiscard]] double ceiling_of(const dynamics::Landscape& l);
/// Of such a map: where no colour is drawn.
inline constexpr char kHole[] = "the disc would cover a joint";
/// "346 J": an energy as a note gives it.
[[nodiscard]] std::string short_energy(double joules, const Sized& unit);
/// Rows of "x y elastic total" up to that ceiling, an empty one between two values of y.
[[nodiscard]] std::string rows_of(const dynamics::Landscape& l, const Sized& metre,
                                  const Sized& joule, double ceiling);

}  // namespace gatewalk::cli
