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

/// By the coordinates' keys; with "face" where it is not the first one.
[[nodiscard]] Json to_json(const dynamics::Section& section, const dynamics::Entry& entry);
/// "start d 4 m, vx 5 m/s, vy 10 m/s"; with the face's name where it is not the first one.
[[nodiscard]] std::string title_of(const dynamics::Section& section, const dynamics::Entry& entry);

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
