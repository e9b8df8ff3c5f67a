#include "cli/starts.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "cli/report.h"
#include "lattice/gate_chain.h"

namespace gatewalk::cli {
namespace {

const std::vector<PaperStart> kTableIV{{0, 0, 15, 0.914, 1.018},
                                       {23, -11, 16, 0.9097, 1.133},
                                       {4, 5, 10, 0.8929, 1.252},
                                       {-17, 13, 12, 0.9026, 0.9813}};

PaperStart parse_start(const std::string& text) {
  std::istringstream in(text);
  PaperStart s{};
  char first = 0, second = 0;
  if (!(in >> s.d >> first >> s.vx >> second >> s.vy) || first != ',' || second != ',' ||
      in.peek() != std::char_traits<char>::eof() || !std::isfinite(s.d + s.vx + s.vy))
    throw UsageError("--start " + text +
                     ": must be three numbers d,vx,vy in m and m/s, e.g. 4,5,10");
  return s;
}

}  // namespace

void add_starts(Options& options, const std::string& by_default) {
  const std::string help = "start at x = D m, y = 0 with this velocity in m/s (may be repeated; "
                           "default: " + by_default + ")";
  options.add()("start", po::value<std::vector<std::string>>()->composing()->value_name("D,VX,VY"),
                help.c_str());
}

std::vector<PaperStart> starts_of(const Options& options) {
  if (!options.has("start")) return kTableIV;
  std::vector<PaperStart> starts;
  for (const auto& text : options.get<std::vector<std::string>>("start"))
    starts.push_back(parse_start(text));
  return starts;
}

void require_inside(const std::vector<PaperStart>& starts, const Scene& scene) {
  const double side = scene.gate.beams.joint_x;
  for (const PaperStart& s : starts)
    if (!(std::abs(s.d) < side))
      throw UsageError("--start: d = " + fixed(s.d, 3) + " m must lie inside the gate, (-" +
                       fixed(side, 3) + ", " + fixed(side, 3) + ")");
}

void warn_outside_bins(const std::vector<PaperStart>& starts, const Scene& scene,
                       const dynamics::StateSpace& space) {
  for (const PaperStart& s : starts) {
    const lattice::ChainStart chain = lattice::chain_start(space, scene.field, s.body());
    if (chain.clamped)
      warn("start" + start_text(s) + " lies outside the chain's bins; the chain starts in the " +
           "nearest one, " + text_of(space.cell(chain.start.input)));
  }
}

StartTexts::StartTexts(const std::vector<PaperStart>& starts) : texts(starts.size()) {
  struct Column {
    const char* name;
    double PaperStart::*value;
    int width;  // at least
  };
  for (const auto& [name, value, least] : {Column{"d", &PaperStart::d, 4}, Column{"vx", &PaperStart::vx, 5},
                                           Column{"vy", &PaperStart::vy, 5}}) {
    std::vector<std::string> numbers;
    int width = least;
    for (const PaperStart& s : starts) {
      char digits[32];
      const auto end = std::to_chars(digits, digits + sizeof digits, s.*value + 0.0).ptr;  // -0 is 0
      numbers.emplace_back(digits, end);
      const int gap = least > 4 ? 2 : 1;
      width = std::max(width, static_cast<int>(numbers.back().size()) + gap);
    }
    header += padded(name, width);
    for (std::size_t k = 0; k < starts.size(); ++k) texts[k] += padded(numbers[k], width);
  }
}

std::string start_text(const PaperStart& s) { return StartTexts({s}).texts.front(); }

}  // namespace gatewalk::cli
