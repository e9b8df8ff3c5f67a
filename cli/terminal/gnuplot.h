// SPDX-License-Identifier: MIT
#pragma once
/// Figures, drawn by gnuplot.

#include <string>

#include "cli/render/figure.h"

namespace gatewalk::cli {

/// What gnuplot writes to its standard output when it runs `script` (plain text): the figure itself
/// when the script sets a terminal and no output, to be handed to write_text_atomically. Throws
/// std::runtime_error with gnuplot's words when it fails or is missing.
[[nodiscard]] std::string drawn(const std::string& script);

/// Throws std::runtime_error when gnuplot is missing: before minutes of work, not after.
void require_gnuplot();

/// Draws into `path`, which is replaced as a whole or left as it was: SVG; PDF, a sheet 3.5
/// inches wide; or PNG of 300 dots to the inch at that width. Throws std::invalid_argument for
/// another end of its name.
void draw(const std::string& path, const Figure& figure, const AboutFigure& about);
/// Whether that name has an end that draw() knows.
[[nodiscard]] bool can_be_drawn(const std::string& path);

}  // namespace gatewalk::cli
