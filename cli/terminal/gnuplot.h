#pragma once
/// Figures, drawn by gnuplot.

#include <string>

#include "cli/render/figure.h"

namespace gatewalk::cli {

/// What gnuplot writes to its standard output when it runs `script` (plain text): the figure itself
/// when the script sets a terminal and no output, to be handed to write_text_atomically. Throws
/// std::runtime_error with gnuplot's words when it fails or is missing.
[[nodiscard]] std::string drawn(const std::string& script);

/// Draws into the SVG file `path`, which is replaced as a whole or left as it was.
void draw_svg(const std::string& path, const Figure& figure);

}  // namespace gatewalk::cli
