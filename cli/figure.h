#pragma once
/// Figures, drawn by a gnuplot process.

#include <string>

namespace gatewalk::cli {

/// Runs gnuplot on `script`; throws std::runtime_error when it fails or is missing.
void plot(const std::string& script);

}  // namespace gatewalk::cli
