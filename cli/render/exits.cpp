// SPDX-License-Identifier: MIT
#include "cli/render/exits.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/final_gates.h"
#include "cli/render/quantity.h"

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

Label exits_label() {
  return {"exits", "places where bodies leave the field, along each of its sides"};
}

/// A place along a side, with the shares of one or two answers.
struct Place {
  double from = 0.0, to = 0.0;  // m
  std::array<double, 2> share{};
  std::array<Interval, 2> interval{};
};

/// Describes all places; `describe_shares` adds the shares of a place.
template <class Describe>
void describe_places(Fields& out, const Label& l, const std::vector<const FieldExits*>& exits,
                     const ShownField& shown, Describe describe_shares) {
  out.object(l, [&](Fields& sides) {
    for (std::size_t side = 0; side < kSides.size(); ++side) {
      const std::vector<double> bounds = place_bounds(shown, side);
      std::vector<Place> places(bounds.size() - 1);
      for (std::size_t i = 0; i < places.size(); ++i) {
        places[i] = {bounds[i], bounds[i + 1]};
        for (std::size_t k = 0; k < exits.size() && !out.is_schema(); ++k) {
          places[i].share[k] = (*exits[k])[side].share[i];
          places[i].interval[k] = (*exits[k])[side].interval[i];
        }
      }
      sides.list(
          {name_of_side(side).key,
           side == lattice::kFarSide
               ? "one place for each column of gates, along x; x = 0: middle of the start's column"
               : "one place for each row of gates, along y; y = 0: near end of the field"},
          places, [&](Fields& f, const Place& place) {
            f.number({"from_m", "m", "lower end of the place"}, place.from);
            f.number({"to_m", "m", "upper end of the place"}, place.to);
            describe_shares(f, place);
          });
    }
  });
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

void describe_exits(Fields& out, const FieldExits& exits, const ShownField& shown) {
  describe_places(out, exits_label().shared(), {&exits}, shown, [](Fields& f, const Place& p) {
    f.estimate({"share", "1", "share of all bodies that leave the field at this place"}, p.share[0],
               p.interval[0]);
  });
}

void describe_exits(Fields& out, const FieldExits& dynamics, const FieldExits& chain,
                    const ShownField& shown) {
  describe_places(out, exits_label(), {&dynamics, &chain}, shown, [](Fields& f, const Place& p) {
    f.estimate({"dynamics", "1", "share of all trials that leave the field at this place"},
               p.share[0], p.interval[0]);
    f.estimate({"exact", "1",
                "share of all bodies that leave the field at this place, by the exact chain"},
               p.share[1], p.interval[1]);
  });
}

std::string table_of(const FieldExits& exits, const ShownField& shown) {
  constexpr std::size_t kMost = 15;
  TextTable table({{"", -11}, {"", -2}, {"", -18}, {"", 0, 0, "", " "}});
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    const SideExits& e = exits[side];
    if (e.share.size() > kMost) return "";
    const std::vector<double> bounds = place_bounds(shown, side);
    const Sized metre = readable_unit("m", std::max(-bounds.front(), bounds.back()));
    for (std::size_t i = 0; i < e.share.size(); ++i) {
      if (e.share[i] == 0.0) continue;
      table.row({name_of_side(side).name, side == lattice::kFarSide ? "x" : "y",
                 fmt::format("{} to {} {}", digits(bounds[i] / metre.size),
                             digits(bounds[i + 1] / metre.size), metre.name),
                 with_interval(e.share[i], e.interval[i])});
    }
  }
  const std::string rows = table.text();
  return rows.empty() ? "" : "Where bodies leave along each side, % of all bodies\n" + rows;
}

std::string places_outside(const FieldExits& dynamics, const FieldExits& chain) {
  std::size_t outside = 0, places = 0;
  for (std::size_t side = 0; side < kSides.size(); ++side)
    for (std::size_t i = 0; i < dynamics[side].share.size(); ++i) {
      const auto& [low, high] = dynamics[side].interval[i];
      outside += chain[side].share[i] < low || chain[side].share[i] > high;
      ++places;
    }
  return fmt::format("{} of {}", outside, places);
}

double height_of_exits() { return 214.0; }

void add_exits(Panels& out, const FieldExits& exits, const ShownField& shown, double top,
               const std::string& tag) {
  constexpr double kHead = 40, kTall = 116;
  const std::array<std::array<double, 2>, kSides.size()> ends{{{374, 480}, {80, 174}, {212, 306}}};
  const double sides = std::max(largest_share(exits[1]), largest_share(exits[2]));
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    const bool far = side == lattice::kFarSide;
    const SideExits& e = exits[side];
    std::vector<double> bounds = place_bounds(shown, side);
    const Sized metre = readable_unit("m", std::max(-bounds.front(), bounds.back()));
    for (double& b : bounds) b /= metre.size;
    double most = far ? largest_share(e) : sides;
    Rows& rows = out.data(fmt::format("$exits{}_{}", tag, side));
    for (std::size_t i = 0; i < e.share.size(); ++i) {
      // Places without bodies are left out: in large fields their bars would hide the others.
      if (e.share[i] <= lattice::kShareRounding) continue;
      const bool known = std::isfinite(e.interval[i][0]);
      const double high = known ? e.interval[i][1] : e.share[i];
      most = std::max(most, high);
      rows.add(std::midpoint(bounds[i], bounds[i + 1]), 100.0 * e.share[i],
               100.0 * (known ? e.interval[i][0] : e.share[i]), 100.0 * high,
               0.4 * (bounds[i + 1] - bounds[i]));
    }
    if (!(most > 0.0)) most = 0.01;
    if (rows.empty()) rows.add(0, 0, 0, 0, 0);
    Panel& panel = out.add({ends[side][0], ends[side][1], top + kHead, top + kHead + kTall});
    if (far) panel.say("where bodies leave along each side, % of all, 95 %", 8, top + 12);
    panel.say(name_of_side(side).name, panel.box.left, panel.box.top - 10, kSmallFont);
    const Axis along{(far ? "x (" : "y (") + metre.name + ")", bounds.front(), bounds.back(),
                     digits(tic_step(bounds.back() - bounds.front(), far ? 2 : 4))};
    const Axis percents{"%", 0, 105.0 * most, digits(tic_step(100.0 * most, 2))};
    panel.x = far ? along : percents;
    panel.y = far ? percents : along;
    panel.y.format = "%g";
    panel.y.numbers = side != 2;
    if (side == 2) panel.y.name = "";
    panel.draw(rows, far ? "1:($2/2):5:($2/2)" : "($2/2):1:($2/2):5", kBars, {kFirstColour});
    panel.draw(rows, far ? "1:3:(0):($4-$3)" : "3:1:($4-$3):(0)", kIntervals, kIntervalPen);
  }
}

}  // namespace gatewalk::cli
