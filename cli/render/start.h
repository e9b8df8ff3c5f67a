#pragma once
/// Starts of trials and of chains, as JSON and in words.

#include <string>
#include <vector>

#include "cli/command.h"
#include "lattice/scene/table4.h"

namespace gatewalk::cli {

/// {"d_m", "vx_m_per_s", "vy_m_per_s"}
[[nodiscard]] Json to_json(const lattice::PaperStart& start);

/// "  23  -11   16": columns as wide as the numbers of all starts need, every digit of them.
struct StartTexts {
  std::string header;              // "   d   vx   vy"
  std::vector<std::string> texts;  // (starts)
  explicit StartTexts(const std::vector<lattice::PaperStart>& starts);
};
[[nodiscard]] std::string start_text(const lattice::PaperStart& start);

}  // namespace gatewalk::cli
