#include "cli/starts.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "cli/matrix.h"
#include "cli/render/report.h"

namespace gatewalk::cli {
namespace {

/// Table IV's starts, in the scene's own units.
std::vector<PaperStart> table_iv(const dynamics::GateParams& p) {
  std::vector<PaperStart> starts{{0, 0, 15, 0.914, 1.018},
                                 {23, -11, 16, 0.9097, 1.133},
                                 {4, 5, 10, 0.8929, 1.252},
                                 {-17, 13, 12, 0.9026, 0.9813}};
  const dynamics::Scale unit = dynamics::scale_of(p);
  for (PaperStart& s : starts) {
    s.d *= unit.length;
    s.vx *= unit.speed();
    s.vy *= unit.speed();
  }
  return starts;
}

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
  const std::string help =
      "start at x = D m, y = 0 with this velocity in m/s (may be repeated; "
      "default: " +
      by_default + ")";
  options.add()("start", po::value<std::vector<std::string>>()->composing()->value_name("D,VX,VY"),
                help.c_str());
}

std::vector<PaperStart> given_starts(const Options& options) {
  std::vector<PaperStart> starts;
  if (!options.has("start")) return starts;
  for (const auto& text : options.get<std::vector<std::string>>("start"))
    starts.push_back(parse_start(text));
  return starts;
}

std::vector<PaperStart> starts_of(const Options& options, const lattice::Scene& scene) {
  if (options.has("start")) return given_starts(options);
  const std::vector<PaperStart> papers = table_iv(scene.gate);
  const dynamics::BodyState &own = scene.start, first = papers.front().body();
  const bool the_papers = own.x == 0.0 && own.y == 0.0 && own.vx == 0.0 &&
                          std::abs(own.vy - first.vy) <= 1e-12 * first.vy;
  if (the_papers && papers_field(scene)) return papers;
  return {{own.x, own.vx, own.vy, {}, {}, own.y}};
}

std::vector<dynamics::BodyState> entries_at(const std::vector<PaperStart>& starts) {
  std::vector<dynamics::BodyState> bodies;
  for (const PaperStart& s : starts) {
    if (s.y != 0.0)
      throw UsageError(
          "start.y_m = " + Json(s.y).dump() +
          " is not permitted for a chain: its states are entries from below, start.y_m must be 0");
    bodies.push_back(s.body());
  }
  return bodies;
}

void require_inside(const std::vector<PaperStart>& starts, const lattice::Scene& scene) {
  const double side = scene.gate.beams.joint_x;
  for (const PaperStart& s : starts)
    if (!(std::abs(s.d) < side))
      throw UsageError("--start: d = " + Json(s.d).dump() + " m must lie inside the gate, (-" +
                       Json(side).dump() + ", " + Json(side).dump() + ")");
}

void require_inside_bins(const std::vector<PaperStart>& starts, const lattice::Scene& scene,
                         const dynamics::StateSpace& space) {
  for (const PaperStart& s : starts)
    (void)start_in_bins(space, scene.field, s.body(), "start" + start_text(s));
}

StartTexts::StartTexts(const std::vector<PaperStart>& starts) : texts(starts.size()) {
  struct Column {
    const char* name;
    double PaperStart::*value;
    int width;  // at least
  };
  for (const auto& [name, value, least] :
       {Column{"d", &PaperStart::d, 4}, Column{"vx", &PaperStart::vx, 5},
        Column{"vy", &PaperStart::vy, 5}}) {
    std::vector<std::string> numbers;
    int width = least;
    for (const PaperStart& s : starts) {
      char digits[32];
      const auto end =
          std::to_chars(digits, digits + sizeof digits, s.*value + 0.0).ptr;  // -0 is 0
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
