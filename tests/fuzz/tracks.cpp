// SPDX-License-Identifier: MIT
// Tracks: a line of columns (empty for a table of DeepLabCut), then the table. What was read is cut
// into passages.
#include "lattice/recorded/tracks.h"

#include <cmath>

#include "lattice/recorded/cut_tracks.h"
#include "tests/fuzz/fuzz.h"

namespace gatewalk::fuzz {
namespace {

constexpr const char* kCell = R"([cell]
width_m = 0.1
length_m = 0.1
symmetric = false
trapped_after_s = 10.0
[[cell.faces]]
name = "S"
move = [0, 1]
[[cell.faces]]
name = "N"
move = [0, -1]
[[cell.faces]]
name = "W"
move = [1, 0]
[[cell.faces]]
name = "E"
move = [-1, 0]
[[cell.coordinates]]
name = "s"
unit = "m"
[[cell.coordinates]]
name = "vy"
unit = "m/s"
)";

}  // namespace

void tracks(std::string_view bytes) {
  // NetCDF is left out: it has no checksum here, and its library is not safe with damaged bytes.
  std::string_view table = bytes;
  lattice::TrackOptions options;
  options.columns = take_line(table);
  if (table.starts_with("\x89HDF") || table.starts_with("CDF")) return;
  options.metres_per_unit = 0.001;
  if (options.columns.find("time=") == std::string::npos) options.fps = 50.0;
  if (options.columns.find("confidence=") != std::string::npos ||
      table.find("likelihood") != table.npos)
    options.confidence = 0.5;
  if (options.columns.empty()) options.key_point = "nose";
  const auto file = accepted([&] { return lattice::read_tracks(file_of(table, ".csv"), options); });
  if (!file) return;
  for (const lattice::Track& track : file->tracks)
    for (std::size_t i = 0; i < track.time.size(); ++i)
      require(std::isfinite(track.x[i]) && std::isfinite(track.y[i]) &&
                  std::isfinite(track.time[i]) && (i == 0 || track.time[i] > track.time[i - 1]),
              "places and times are numbers, and times rise");
  static const lattice::CellFile cell = lattice::parse_cell_file(kCell, "x.toml");
  lattice::CutOptions how;
  how.fastest = 1.0;
  how.endless = true;
  const auto cut = accepted([&] { return lattice::cut_tracks(*file, cell, how); });
  if (!cut) return;
  const lattice::RecordedRuns runs = lattice::recorded_runs(*cut, *file, cell);
  const std::string path = file_of("", ".runs.csv");
  const bool written = accepted([&] {
                         lattice::write_runs(path, cell, runs);
                         return true;
                       }).has_value();
  if (!written) return;
  lattice::CellFile others = cell;
  require(lattice::read_runs(path, others).passages.size() == cut->passages.size(),
          "passages that were written and read are as many");
}

}  // namespace gatewalk::fuzz
