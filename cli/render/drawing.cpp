#include "cli/render/drawing.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <thread>

#include "cli/render/gnuplot.h"
#include "cli/terminal/output.h"

namespace gatewalk::cli {

std::string literal(std::string_view text) {
  std::string out = "'";  // single quotes: taken as it stands
  for (const char c : text) {
    if (c == '\'') out += c;  // doubled
    out += c == '\n' ? ' ' : c;
  }
  return out + "' noenhanced";
}

std::string data_block(std::string_view name, const std::string& rows) {
  return std::string(name) + " << EOD\n" + rows + "EOD\n";
}

std::string digits(double x) {
  std::array<char, 32> buffer;
  std::snprintf(buffer.data(), buffer.size(), "%.7g", x);
  return buffer.data();
}

std::string tics_1_2_5(double low, double high) {
  std::string list;
  for (double decade = std::pow(10.0, std::floor(std::log10(low))); decade <= high; decade *= 10)
    for (const int digit : {1, 2, 5}) {
      if (digit > 1 && high > 1000.0 * low) break;  // they would touch
      list += (list.empty() ? "'" : ", '") + digits(digit * decade) + "' " + digits(digit * decade);
    }
  return list;
}

Look look_of(std::string_view method) {
  if (method == "paper") return {"#d55e00", 5};
  if (method == "stable") return {"#0072b2", 7};
  if (method == "moreau") return {"#009e73", 9};
  if (method == "penalty") return {"#e69f00", 13};
  return {"#cc79a7", 15};
}

void draw_svg(const std::string& path, int width, int height, const std::string& commands) {
  write_text_atomically(
      path, drawn("set terminal svg size " + std::to_string(width) + "," + std::to_string(height) +
                  " font 'sans,12' background '#ffffff' enhanced\n" + commands + "\n"));
}

std::string machine() {
  std::ifstream info("/proc/cpuinfo");
  std::string model = "unknown processor";
  for (std::string line; std::getline(info, line);) {
    if (line.rfind("model name", 0) != 0) continue;
    model = line.substr(line.find(':') + 2);
    break;
  }
  return model + ", " + std::to_string(std::thread::hardware_concurrency()) + " cores";
}

}  // namespace gatewalk::cli
