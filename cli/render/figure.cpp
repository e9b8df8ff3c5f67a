#include "cli/render/figure.h"

#include <cmath>

#include "cli/render/text.h"

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

}  // namespace gatewalk::cli
