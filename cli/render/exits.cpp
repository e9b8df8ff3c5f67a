// SPDX-License-Identifier: MIT
#include "cli/render/exits.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cli/render/final_gates.h"
#include "cli/render/json.h"
#include "cli/render/quantity.h"
#include "cli/render/text.h"

namespace gatewalk::cli {
namespace {

using lattice::FieldExits;
using lattice::kSides;
using lattice::SideExits;

const EndingName& name_of_side(std::size_t side) {
  return *std::find_if(kEndingNames.begin(), kEndingNames.end(),
                       [&](const EndingName& e) { return e.ending == kSides[side]; });
}

std::vector<double> place_bounds(const ShownField& shown, std::size_t side) {
  return lattice::exit_bounds(shown.width, shown.length, shown.field, side);
}

/// A place with its bounds, to which the caller adds its shares.
template <class Add>
Json json_by_place(const ShownField& shown, Add add) {
  Json json;
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    const std::vector<double> bounds = place_bounds(shown, side);
    Json& places = json[name_of_side(side).key] = Json::array();
    for (std::size_t i = 0; i + 1 < bounds.size(); ++i) {
      Json place = {{"from_m", bounds[i]}, {"to_m", bounds[i + 1]}};
      add(place, side, i);
      places.push_back(std::move(place));
    }
  }
  return json;
}

double largest_share(const SideExits& side) {
  const double largest = *std::max_element(side.share.begin(), side.share.end());
  return largest > lattice::kShareRounding ? largest : 0.0;
}

}  // namespace

FieldExits shown_exits(FieldExits exits, const markov::FinalDistribution& f) {
  for (SideExits& side : exits)
    for (std::size_t i = 0; i < side.share.size(); ++i) {
      if (side.share[i] > f.rounding + f.remainder) continue;
      side.share[i] = 0.0;
      if (!std::isnan(side.interval[i][0])) side.interval[i][0] = 0.0;
    }
  return exits;
}

Json to_json(const FieldExits& exits, const ShownField& shown) {
  return json_by_place(shown, [&](Json& place, std::size_t side, std::size_t i) {
    place["share"] = exits[side].share[i];
    place["interval_95"] = exits[side].interval[i];
  });
}

Json to_json(const FieldExits& dynamics, const FieldExits& chain, const ShownField& shown) {
  return json_by_place(shown, [&](Json& place, std::size_t side, std::size_t i) {
    place["dynamics"] = dynamics[side].share[i];
    place["dynamics_95"] = dynamics[side].interval[i];
    place["exact"] = chain[side].share[i];
    place["exact_95"] = chain[side].interval[i];
  });
}

std::string table_of(const FieldExits& exits, const ShownField& shown) {
  constexpr std::size_t kMost = 15;
  std::string text;
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    const SideExits& e = exits[side];
    if (e.share.size() > kMost) return "";
    const std::vector<double> bounds = place_bounds(shown, side);
    const Sized metre = readable_unit("m", std::max(-bounds.front(), bounds.back()));
    for (std::size_t i = 0; i < e.share.size(); ++i) {
      if (e.share[i] == 0.0) continue;
      text += padded(name_of_side(side).name, -11) + (side == lattice::kFarSide ? "x " : "y ") +
              padded(digits(bounds[i] / metre.size) + " to " + digits(bounds[i + 1] / metre.size) +
                         " " + metre.name,
                     -18) +
              " " + with_interval(e.share[i], e.interval[i]) + "\n";
    }
  }
  return text.empty() ? "" : "where they leave along each side, % of all\n" + text;
}

std::string places_outside(const FieldExits& dynamics, const FieldExits& chain) {
  std::size_t outside = 0, places = 0;
  for (std::size_t side = 0; side < kSides.size(); ++side)
    for (std::size_t i = 0; i < dynamics[side].share.size(); ++i) {
      const auto& [low, high] = dynamics[side].interval[i];
      outside += chain[side].share[i] < low || chain[side].share[i] > high;
      ++places;
    }
  return std::to_string(outside) + " of " + std::to_string(places);
}

double height_of_exits() { return 214.0; }

std::string panels_of(const FieldExits& exits, const ShownField& shown, const Sheet& sheet,
                      double top, const std::string& tag) {
  constexpr double kHead = 40, kTall = 116;
  const std::array<Box, kSides.size()> boxes{{{374, 480, top + kHead, top + kHead + kTall},
                                              {80, 174, top + kHead, top + kHead + kTall},
                                              {212, 306, top + kHead, top + kHead + kTall}}};
  const double sides = std::max(largest_share(exits[1]), largest_share(exits[2]));
  std::string out =
      sheet.text("where bodies leave along each side, % of all, 95 %", 8, top + 12) + kFrame;
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    const bool far = side == lattice::kFarSide;
    const SideExits& e = exits[side];
    std::vector<double> bounds = place_bounds(shown, side);
    const Sized metre = readable_unit("m", std::max(-bounds.front(), bounds.back()));
    for (double& b : bounds) b /= metre.size;
    double most = far ? largest_share(e) : sides;
    std::string rows;
    for (std::size_t i = 0; i < e.share.size(); ++i) {
      // Nothing where nobody is expected: in large fields its bars would be all that is seen.
      if (e.share[i] <= lattice::kShareRounding) continue;
      const bool known = std::isfinite(e.interval[i][0]);
      const double high = known ? e.interval[i][1] : e.share[i];
      most = std::max(most, high);
      rows += digits(std::midpoint(bounds[i], bounds[i + 1])) + " " + digits(100.0 * e.share[i]) +
              " " + digits(100.0 * (known ? e.interval[i][0] : e.share[i])) + " " +
              digits(100.0 * high) + " " + digits(0.4 * (bounds[i + 1] - bounds[i])) + "\n";
    }
    if (!(most > 0.0)) most = 0.01;
    if (rows.empty()) rows = "0 0 0 0 0\n";
    const std::string name = "$exits" + tag + "_" + std::to_string(side);
    const std::string along = "[" + digits(bounds.front()) + ":" + digits(bounds.back()) + "]",
                      percents = "[0:" + digits(105.0 * most) + "]",
                      step_along = digits(tic_step(bounds.back() - bounds.front(), far ? 2 : 4)),
                      step = digits(tic_step(100.0 * most, 2));
    out += data_block(name, rows) + sheet.margins(boxes[side]) +
           sheet.text(name_of_side(side).name, boxes[side].left, boxes[side].top - 10, kSmallFont) +
           "set style fill solid noborder\n" +
           (far ? "set xrange " + along + "\nset yrange " + percents + "\nset xtics " + step_along +
                      "\nset ytics " + step + "\n"
                : "set xrange " + percents + "\nset yrange " + along + "\nset xtics " + step +
                      "\nset ytics " + step_along + "\n") +
           (far ? Sheet::axes("'x (" + metre.name + ")'", "'%'")
                : Sheet::axes("'%'", side == 1 ? "'y (" + metre.name + ")'" : "''")) +
           (side == 2 ? "set format y ''\n" : "set format y '%g'\n") + "plot " + name +
           (far ? " using 1:($2/2):5:($2/2)" : " using ($2/2):1:($2/2):5") +
           " with boxxyerror lc rgb '" + kFirstColour + "', " + name +
           (far ? " using 1:3:(0):($4-$3)" : " using 3:1:($4-$3):(0)") + kInterval +
           "\nunset label\n";
  }
  return out + "set format y '%g'\n";
}

}  // namespace gatewalk::cli
