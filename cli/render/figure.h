#pragma once
/// What the figures of several commands share: text for gnuplot, one look.

#include <string>
#include <string_view>

namespace gatewalk::cli {

/// A figure as gnuplot draws it: its size in points of the screen, and the script without terminal.
struct Figure {
  int width = 0, height = 0;
  std::string commands;
  int font = 12;  // its size
};

/// Text for titles and labels of gnuplot, with nothing in it that gnuplot would understand.
[[nodiscard]] std::string literal(std::string_view text);

/// "name << EOD ... EOD", the rows of a table that `plot` can read as name.
[[nodiscard]] std::string data_block(std::string_view name, const std::string& rows);

/// Tics of a logarithmic axis from low to high: 1, 2 and 5 times the powers of ten, or these alone.
[[nodiscard]] std::string tics_1_2_5(double low, double high);

/// Colour and marker of a method, the same in every figure (Okabe and Ito's colours).
struct Look {
  const char* colour;
  int marker;  // gnuplot's number, filled
};
[[nodiscard]] Look look_of(std::string_view method);

}  // namespace gatewalk::cli
