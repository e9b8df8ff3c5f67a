#pragma once
/// The report of a reproduction as one page for a browser, with all that it needs inside.

#include <string>

#include "cli/command.h"

namespace gatewalk::cli {

/// The page (HTML) for `report`, whose layout README.md describes under "The report". Text, tables and claims
/// are there without JavaScript; charts are drawn by cli/web/report.js when they come into view.
/// Throws std::invalid_argument for a chart kind, a verdict or a section that the page does not know,
/// nlohmann::json::exception for a missing field.
[[nodiscard]] std::string report_page(const Json& report);

}  // namespace gatewalk::cli
