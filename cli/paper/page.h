// SPDX-License-Identifier: MIT
#pragma once
/// The report of a reproduction as a single page for a browser, without other files.

#include <functional>
#include <string>

#include "cli/paper/report.h"

namespace gatewalk::cli {

/// Returns the text of an SVG by its name.
using FigureText = std::function<std::string(const std::string&)>;

/// The page (HTML). Only the replay and the switch between light and dark need JavaScript. Throws
/// std::invalid_argument for a claim whose section is missing and for two sections of one name, and
/// what figure_text throws.
[[nodiscard]] std::string report_page(const Report& report, const FigureText& figure_text);

}  // namespace gatewalk::cli
