// SPDX-License-Identifier: MIT
#pragma once
/// The lowest way through a gate over its energy landscape, as a result, CSV, a table and a figure.

#include <optional>
#include <string>

#include "cli/fields/fields.h"
#include "cli/render/panel.h"
#include "cli/render/provenance.h"
#include "cli/render/quantity.h"
#include "dynamics/disc/ensemble.h"
#include "dynamics/disc/landscape.h"
#include "lattice/scene/settle.h"

namespace gatewalk::cli {

/// The result of `landscape`.
struct LandscapeResult {
  dynamics::Passes passes;
  std::optional<dynamics::GateTally> measured{};  // whom the landscape is held against
  std::optional<lattice::Settled> method{};       // of these runs
  Provenance made_by{};
};
void describe(Fields& out, const LandscapeResult& result);
/// A line for each point of the grid.
[[nodiscard]] std::string csv_of(const dynamics::Landscape& landscape);
/// The first screen: the pass, and whether the start's own energy would do; lengths and energies to
/// what counts in such a gate. Then how many passed, if the gate was run. And what --details adds:
/// a line for each grid.
[[nodiscard]] std::string answer_text(const LandscapeResult& result, const dynamics::GateParams& p);
[[nodiscard]] std::string details_text(const LandscapeResult& result,
                                       const dynamics::GateParams& p);
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
/// Adds "x y elastic total" up to that ceiling, with a gap between two values of y.
void add_rows(Rows& rows, const dynamics::Landscape& l, const Sized& metre, const Sized& joule,
              double ceiling);

}  // namespace gatewalk::cli
