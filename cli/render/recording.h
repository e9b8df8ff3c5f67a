// SPDX-License-Identifier: MIT
#pragma once
/// Recordings as a table, as CSV and NetCDF, and as keys of results.

#include <string>

#include "cli/fields/fields.h"
#include "cli/render/figure.h"
#include "cli/render/provenance.h"
#include "lattice/scene/study/recording.h"

namespace gatewalk::cli {

/// The first screen: how the runs ended, and a line for each of the first six, in units that suit
/// all runs; and what --details adds: the first twenty runs, and the scene.
[[nodiscard]] std::string answer_text(const lattice::Scene& scene,
                                      const lattice::Recordings& recordings);
[[nodiscard]] std::string details_text(const lattice::Scene& scene,
                                       const lattice::Recordings& recordings);

/// CSV with a line for each moment; the first line names the columns with their units.
[[nodiscard]] std::string csv_of(const lattice::Recordings& recordings);

/// A NetCDF-4 file: dimension sample, all runs one after the other, and dimension run (trial,
/// ending, number of samples: a contiguous ragged array). The entries of `made_by` are text
/// attributes.
[[nodiscard]] std::string netcdf_of(const lattice::Recordings& recordings,
                                    const Provenance& made_by);

/// The tracks of at most kMostDrawn runs: over the landscape of their gate, Eq. (15), or through
/// the field.
inline constexpr std::size_t kMostDrawn = 20;
[[nodiscard]] Figure figure_of(const lattice::Scene& scene, const lattice::Recordings& recordings);

/// The keys of a run that a film does not show: "trial", "hits", and arrays of energies with seven
/// digits in units of `joule`, null where the disc has no place.
void describe_details(Fields& out, const lattice::Recordings& recordings,
                      const lattice::Recording& run, double joule);

}  // namespace gatewalk::cli
