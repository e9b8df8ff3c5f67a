// SPDX-License-Identifier: MIT
#pragma once
/// The report of a reproduction as one page for a browser, with all that it needs inside.

#include <functional>
#include <string>

#include "cli/render/json_fwd.h"

namespace gatewalk::cli {

/// The text of an SVG by its name.
using FigureText = std::function<std::string(const std::string&)>;

// clang-format off
/// The page (HTML) for a report; only the replay and the switch between light and dark need JavaScript.
/// `report`, every field required:
///   title, paper, lead: [paragraph],
///   first: [{figure: "x.svg", alt, caption, command}], what the page begins with,
///   claims: [{id, where, claim, paper, ours, verdict: "reproduced" | "agrees" | "cannot tell" | "differs",
///     why (may be empty), see: a section's id}],
///   sections: [{id, heading: "Fig. 8: ...", text: [paragraph], alt, commands: [..], files: [..]}], each with its
///     picture ID.svg, or with `film` (cli/film/replay.h) instead,
///   made_by: {program, command, seed, machine, seconds, date, scenes: [{name, text}]}.
/// Throws std::invalid_argument for a verdict or a section that the page does not know,
/// nlohmann::json::exception for a missing field, and what figure_text throws.
// clang-format on
[[nodiscard]] std::string report_page(const Json& report, const FigureText& figure_text);

}  // namespace gatewalk::cli
