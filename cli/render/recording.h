// SPDX-License-Identifier: MIT
#pragma once
/// Recordings as a table to read, as CSV, NetCDF and what results have of them.

#include <string>

#include "cli/fields/fields.h"
#include "cli/render/figure.h"
#include "cli/render/provenance.h"
#include "lattice/scene/study/recording.h"

namespace gatewalk::cli {

/// The first screen: how the runs ended, and a line each of the first six, in units that suit all
/// of them. And what --details adds: the first twenty, and the scene.
[[nodiscard]] std::string answer_text(const lattice::Scene& scene,
                                      const lattice::Recordings& recordings);
[[nodiscard]] std::string details_text(const lattice::Scene& scene,
                                       const lattice::Recordings& recordings);

/// One line per moment; the first line names the columns with their units.
[[nodiscard]] std::string csv_of(const lattice::Recordings& recordings);

/// NetCDF-4: dimension sample, all runs one after the other, and run (trial, ending, samples of
/// each: a contiguous ragged array). The entries of `made_by` are text attributes.
[[nodiscard]] std::string netcdf_of(const lattice::Recordings& recordings,
                                    const Provenance& made_by);

/// The ways of the runs, of at most kMostDrawn: over the landscape of their gate, Eq. (15), or
/// through the field.
inline constexpr std::size_t kMostDrawn = 20;
[[nodiscard]] Figure figure_of(const lattice::Scene& scene, const lattice::Recordings& recordings);

/// What a film does not show of one of these runs: the keys "trial", "hits", and arrays of energies
/// (null where there is no way to stand), with seven digits in units of `joule`.
void describe_details(Fields& out, const lattice::Recordings& recordings,
                      const lattice::Recording& run, double joule);

}  // namespace gatewalk::cli
