// SPDX-License-Identifier: MIT
#pragma once
/// Draws figures with gnuplot.

#include <string>

#include "cli/render/figure.h"

namespace gatewalk::cli {

/// Runs gnuplot on `script` (plain text) and returns its standard output. A script that sets a
/// terminal and no output gives the figure itself, for write_text_atomically. Throws
/// std::runtime_error with gnuplot's messages when it fails or is missing.
[[nodiscard]] std::string drawn(const std::string& script);

/// Throws std::runtime_error when gnuplot is missing. To be called before long work.
void require_gnuplot();

/// Draws a figure into `path`: an SVG, a PDF 3.5 inches wide, or a PNG of 300 dots per inch at that
/// width, by the ending of the name. The file is replaced as a whole or left as it was. Throws
/// std::invalid_argument for another ending.
void draw(const std::string& path, const Figure& figure, const AboutFigure& about);
/// Whether draw() knows the ending of this name.
[[nodiscard]] bool can_be_drawn(const std::string& path);

}  // namespace gatewalk::cli
