// SPDX-License-Identifier: MIT
#pragma once
/// The report of a reproduction as one page for a browser, with all that it needs inside.

#include <functional>
#include <string>

#include "cli/paper/report.h"

namespace gatewalk::cli {

/// The text of an SVG by its name.
using FigureText = std::function<std::string(const std::string&)>;

/// The page (HTML); only the replay and the switch between light and dark need JavaScript. Throws
/// std::invalid_argument for a claim that names no section, for two sections of one name, and what
/// figure_text throws.
[[nodiscard]] std::string report_page(const Report& report, const FigureText& figure_text);

}  // namespace gatewalk::cli
