#pragma once
/// Figures, drawn by gnuplot.

#include <string>

namespace gatewalk::cli {

/// Runs gnuplot on `script` (plain text). Throws std::runtime_error with gnuplot's words when it
/// fails or is missing.
void plot(const std::string& script);

/// As plot, and returns what gnuplot wrote to its standard output: the figure itself when the
/// script sets a terminal and no output, to be handed to write_text_atomically.
[[nodiscard]] std::string drawn(const std::string& script);

}  // namespace gatewalk::cli
