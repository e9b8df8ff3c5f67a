#pragma once
/// The report of a reproduction as one page for a browser, with all that it needs inside.

#include <string>

#include "cli/render/json_fwd.h"

namespace gatewalk::cli {

// clang-format off
/// The page (HTML) for a report. Text, tables and claims are there without JavaScript; charts are drawn by
/// cli/web/report.js when they come into view. `report` (every field required, numbers plain or null):
///   title, paper, lead: [paragraph],
///   claims: [{id, where, claim, paper, ours, verdict: "reproduced" | "within noise" | "differs", why (may be
///     empty), see: a section's id}],
///   sections: [{id, heading: "Fig. 8: ...", text: [paragraph], alt, commands: [..], files: [..], chart, data}],
///   made_by: {program, command, seed, machine, seconds, date, scenes: [{name, text}]}.
/// Charts and their data; shares from 0 to 1, x and y in m, energies in J, `low` and `high` the 95 % interval,
/// [[z]] with a row per y:
///   outcomes       rows: [{damping, propulsion, random, traversed, low, high, exited, trapped, trials}]
///   right_share    rows: [{damping, propulsion, random, k_left, right | null, low, high, successes, trials}]
///   landscapes     panels: [{name (B is shown from above), title, x, y, z}], ceiling
///   barriers       rows: [{k_left, damping, above_start_J, above_basin_J | null, traversed, low, high}]
///   penetration    t, potential, landscape, landscape_right, x, y, surfaces: [{title, x, y, z}], ceiling
///   trajectories   panels: [{title, x, y, z, left, right: text, runs: [{side: "left" | "right", x, y, e}]}], ceiling
///   final_gates    starts: [{label, dynamics, chain: [[share]], a row per i_y from 0, columns about i_x = 0}]
///   table4         rows: [{start, corrcoef, rmse, each with paper_.., .._sd, .._floor, .._all; tv, tv_floor}]
///   rates          rows: [{label, group, value, low, high}], marks: [{label, value, group (for its colour)}],
///                  unit ("share" or a name)
///   speed          rows: [{label, seconds, group}]
///   histogram      rows: [{from, to, share}], marks: [{label, value}], axis: what is counted, with its unit
///   replay         film, see cli/film/replay.h
/// Throws std::invalid_argument for a chart, a verdict or a section that the page does not know,
/// nlohmann::json::exception for a missing field outside data.
// clang-format on
[[nodiscard]] std::string report_page(const Json& report);

}  // namespace gatewalk::cli
