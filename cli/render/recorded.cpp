// SPDX-License-Identifier: MIT
#include "cli/render/recorded.h"

#include <algorithm>
#include <cmath>

#include "cli/render/final_gates.h"
#include "cli/render/json.h"
#include "cli/render/text.h"
#include "lattice/pool/pooled_prediction.h"

namespace gatewalk::cli {
namespace {

struct Fates {
  std::int64_t left = 0, trapped = 0, lost = 0;
};

Fates fates_of(const lattice::RunPool& pool) {
  Fates fates;
  const auto add = [&](const lattice::PassageTable& passages) {
    for (std::size_t i = 0; i < passages.size(); ++i) {
      const dynamics::Fate fate = passages[i].fate;
      ++(fate == dynamics::Fate::left      ? fates.left
         : fate == dynamics::Fate::trapped ? fates.trapped
                                           : fates.lost);
    }
  };
  add(pool.scattered.each.passages);
  for (const lattice::StartTrials& s : pool.starts) {
    add(s.full.passages);
    add(s.first.passages);
  }
  return fates;
}

}  // namespace

Json to_json(const lattice::RunPool& pool) {
  const Fates fates = fates_of(pool);
  return {{"bodies", pool.bodies()}, {"trials", pool.trials()},  {"passages", pool.gate_runs()},
          {"left", fates.left},      {"trapped", fates.trapped}, {"lost", fates.lost}};
}

std::string table_of(const lattice::RunPool& pool) {
  const Fates fates = fates_of(pool);
  return std::to_string(pool.bodies()) + " bodies, " + std::to_string(pool.trials()) + " trials, " +
         std::to_string(pool.gate_runs()) + " passages: " + std::to_string(fates.left) + " left, " +
         std::to_string(fates.trapped) + " trapped, " + std::to_string(fates.lost) + " lost\n";
}

std::string far_from_faces(const lattice::RunPool& pool, const lattice::Problem& problem) {
  const dynamics::Coordinate& place = problem.map().section.coordinates.front();
  const double large = std::max(problem.width, problem.length);
  double farthest = 0.0;
  lattice::each_entry(pool, {}, [&](const dynamics::Entry& entry, int) {
    farthest = std::max(farthest, std::abs(entry.at[0]));
  });
  if (place.unit != "m" || farthest <= large) return "";
  return place.name + " is up to " + digits(farthest) + " m, and a cell is " + digits(large) +
         " m large: is it in metres, and measured on the face?";
}

std::vector<std::string> doubts(const lattice::RunPool& pool, const lattice::Problem& problem) {
  std::vector<std::string> said;
  if (pool.bodies() < lattice::kLeastBodies)
    said.push_back("no error bars: they need " + std::to_string(lattice::kLeastBodies) +
                   " bodies at least, these are " + std::to_string(pool.bodies()));
  std::vector<bool> entered(problem.map().section.faces.size(), false);
  lattice::each_entry(pool, {}, [&](const dynamics::Entry& entry, int) {
    entered[static_cast<std::size_t>(entry.face)] = true;
  });
  for (std::size_t f = 0; f < entered.size(); ++f)
    if (!entered[f])
      said.push_back("nobody was seen to enter by face " + problem.map().section.faces[f].name +
                     ": what would become of such a body is not known");
  return said;
}

Json to_json(const lattice::LostBounds& bounds) {
  return {{"lost_share", bounds.lost},
          {"if_trapped", endings(bounds.final[0].endings)},
          {"if_left", endings(bounds.final[1].endings)}};
}

std::string table_of(const lattice::LostBounds& bounds) {
  if (!(bounds.lost > 0.0)) return "";
  std::string text = percent(bounds.lost, 1.0, 2) +
                     " of the passages were lost from sight and are left out, which no interval "
                     "counts. If all of these bodies had been trapped, or all had left:\n";
  for (const EndingName& e : kEndingNames) {
    const auto at = static_cast<std::size_t>(e.ending);
    text += padded(e.name, -11) + padded(percents(bounds.final[0].endings[at]), 7) + " %, " +
            padded(percents(bounds.final[1].endings[at]), 7) + " %\n";
  }
  return text;
}

}  // namespace gatewalk::cli
