#pragma once
/// Starts of trials and of chains, as JSON and in words.

#include <string>
#include <vector>

#include "cli/render/json_fwd.h"
#include "lattice/gate_chain.h"
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
/// {"input": from 1, "bin": its edges in words, "clamped"}
[[nodiscard]] Json to_json(const lattice::ChainStart& start, const dynamics::StateSpace& space);

}  // namespace gatewalk::cli
