// SPDX-License-Identifier: MIT
#pragma once
/// The lowest path through a gate over its energy landscape, as a result, CSV, a table and a
/// figure.

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
  std::optional<dynamics::GateTally> measured{};  // trials to compare the landscape with
  std::optional<lattice::Settled> method{};       // of these trials
  Provenance made_by{};
};
void describe(Fields& out, const LandscapeResult& result);
/// CSV with a line for each point of the grid.
[[nodiscard]] std::string csv_of(const dynamics::Landscape& landscape);
/// The first screen: the pass, whether the start's own energy is enough, and the share that passed
/// if the gate was run; and what --details adds: a line for each grid. Lengths and energies are
/// rounded to what matters in the gate.
[[nodiscard]] std::string answer_text(const LandscapeResult& result, const dynamics::GateParams& p);
[[nodiscard]] std::string details_text(const LandscapeResult& result,
                                       const dynamics::GateParams& p);
/// The coarse grid as two maps, of elastic energy and with the propulsion. The second map shows the
/// lowest path on the fine grid; a curve shows the energy along it.
[[nodiscard]] Figure figure_of(const dynamics::Passes& passes);

/// The upper end of the energies (J) to draw: the energy in the middle, and some more. Beside the
/// joints the beams' energy exceeds any scale.
[[nodiscard]] double ceiling_of(const dynamics::Landscape& l);
/// Where a map has no colour, because the disc has no place there.
inline constexpr char kHole[] = "the disc would cover a joint";
/// "346 J": a short text for an energy.
[[nodiscard]] std::string short_energy(double joules, const Sized& unit);
/// Adds "x y elastic total" up to the ceiling, with a gap between two values of y.
void add_rows(Rows& rows, const dynamics::Landscape& l, const Sized& metre, const Sized& joule,
              double ceiling);

}  // namespace gatewalk::cli
