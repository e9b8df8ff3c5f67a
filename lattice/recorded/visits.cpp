// SPDX-License-Identifier: MIT
#include "lattice/recorded/visits.h"

#include <cstdint>
#include <map>
#include <tuple>

#include "lattice/text/digits.h"

namespace gatewalk::lattice {
namespace {

/// How a passage ended: the face of the next cell, trapped or lost.
std::string way_out(const CutPassage& p, const CellFile& cell) {
  if (p.end == CutEnd::left)
    return cell.map.section.faces[static_cast<std::size_t>(p.out.face)].name;
  return p.end == CutEnd::trapped ? "trapped" : "lost";
}

}  // namespace

std::string visits_csv(const CutTracks& cut, const TrackFile& file, const CellFile& cell) {
  const bool has_types = cell.types.size() > 1;
  std::string text = std::string("body,trial,column,row,") + (has_types ? "type," : "") +
                     "in,entered_s,out,time_s\n";
  for (const CutPassage& p : cut.passages) {
    text += body_field(file.tracks[p.track].body) + "," + std::to_string(p.trial) + "," +
            std::to_string(p.column) + "," + std::to_string(p.row) + ",";
    if (has_types) text += cell.types[static_cast<std::size_t>(p.type)] + ",";
    text += cell.map.section.faces[static_cast<std::size_t>(p.in.face)].name + "," +
            shortest(p.entered) + "," + way_out(p, cell) + "," + shortest(p.time) + "\n";
  }
  return text;
}

std::string transitions_csv(const CutTracks& cut, const CellFile& cell) {
  struct Sum {
    std::int64_t count = 0;
    double time = 0.0;
  };
  std::map<std::tuple<int, int, CutEnd, int>, Sum> sums;  // by row, column, end and face
  std::map<std::tuple<int, int>, std::int64_t> seen;      // passages that were not lost
  for (const CutPassage& p : cut.passages) {
    Sum& sum = sums[{p.row, p.column, p.end, p.end == CutEnd::left ? p.out.face : 0}];
    ++sum.count;
    sum.time += p.time;
    seen[{p.row, p.column}] += p.end != CutEnd::lost;
  }
  std::string text = "column,row,out,to_column,to_row,count,mean_s,share\n";
  for (const auto& [key, sum] : sums) {
    const auto [row, column, end, number] = key;
    const dynamics::Face& face = cell.map.section.faces[static_cast<std::size_t>(number)];
    const double count = static_cast<double>(sum.count);
    text += std::to_string(column) + "," + std::to_string(row) + ",";
    text += end == CutEnd::left ? face.name + "," + std::to_string(column + face.di_x) + "," +
                                      std::to_string(row + face.di_y)
                                : std::string(end == CutEnd::trapped ? "trapped,," : "lost,,");
    text += "," + std::to_string(sum.count) + "," + shortest(sum.time / count) + ",";
    if (end != CutEnd::lost) text += shortest(count / static_cast<double>(seen.at({row, column})));
    text += "\n";
  }
  return text;
}

}  // namespace gatewalk::lattice
