#pragma once
/// A traced run, of one gate or through the field, as numbers in columns: what CSV, NetCDF, JSON
/// and the animation all show.

#include <limits>
#include <string>
#include <vector>

#include "cli/command.h"
#include "lattice/lattice.h"

namespace gatewalk::cli {

/// How things stood at the end of a step, in the whole field; work and losses since the trial
/// began.
struct Moment {
  int i_x = 0, i_y = 0;          // the gate, as the paper counts
  double time = 0.0;             // s
  dynamics::TraceSample sample;  // of that gate
  dynamics::Energies energy;     // of the whole trial: beams left behind count as lost
};

struct Recording {
  std::int64_t trial = 0;
  std::string ending;  // "traversed left", "crossed", ...
  double seconds = 0.0;
  int gates = 1;  // visited
  std::vector<Moment> moments;
  dynamics::Health health;
};

/// Trial `trial` of `gate` (across_field: of `lattice`), the same to the last bit. Throws
/// dynamics::TraceTooLong when it has more moments.
[[nodiscard]] Recording record(const lattice::Scene& scene, std::uint64_t seed, std::int64_t trial,
                               bool across_field,
                               std::size_t most_moments = std::numeric_limits<std::size_t>::max());

/// Every ending that a recording may have.
[[nodiscard]] std::vector<std::string> endings(bool across_field);

/// One line per moment; the first line names the columns with their units.
[[nodiscard]] std::string csv_of(const lattice::Scene& scene, const std::vector<Recording>& runs);

/// NetCDF-4: dimension sample, all runs one after the other, and run (trial, ending, samples of
/// each: a contiguous ragged array). `about` are text attributes.
[[nodiscard]] std::string netcdf_of(const lattice::Scene& scene, const std::vector<Recording>& runs,
                                    bool across_field,
                                    const std::vector<std::pair<std::string, std::string>>& about);

/// The runs as a film (replay.h), with seven digits in the scene's own units.
[[nodiscard]] Json film_of(const lattice::Scene& scene, const std::vector<Recording>& runs,
                           bool across_field);
/// Adds to each run of a film of `runs`: trial, hits, and the arrays potential_J, elastic_left_J,
/// elastic_right_J, landscape_J, landscape_left_J, landscape_right_J (null where there is no way to
/// stand).
void add_details(Json& film, const lattice::Scene& scene, const std::vector<Recording>& runs);

}  // namespace gatewalk::cli
