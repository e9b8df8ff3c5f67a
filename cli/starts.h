#pragma once
/// Where trials through the field start: the four of the paper's Table IV, or those given.

#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "dynamics/state_space.h"

namespace gatewalk::cli {

/// d, vx, vy (m, m/s) of a start at y = 0; corrcoef and RMSE as Table IV prints them.
struct PaperStart {
  double d = 0.0, vx = 0.0, vy = 0.0;
  std::optional<double> corrcoef, rmse;

  [[nodiscard]] dynamics::BodyState body() const { return {d, 0.0, vx, vy}; }
};

/// Declares --start; `by_default` says where to start without it.
void add_starts(Options& options, const std::string& by_default = "the four of Table IV");
/// The starts given, else those of Table IV. Throws UsageError for a malformed one.
[[nodiscard]] std::vector<PaperStart> starts_of(const Options& options);
/// Throws UsageError unless all of them lie between the sides of the scene's gates.
void require_inside(const std::vector<PaperStart>& starts, const Scene& scene);
/// Warns of each start that lies outside the chain's bins: the chain starts in the nearest one.
void warn_outside_bins(const std::vector<PaperStart>& starts, const Scene& scene,
                       const dynamics::StateSpace& space);
/// "  23  -11   16": columns as wide as the numbers of all starts need, every digit of them.
struct StartTexts {
  std::string header;              // "   d   vx   vy"
  std::vector<std::string> texts;  // (starts)
  explicit StartTexts(const std::vector<PaperStart>& starts);
};
[[nodiscard]] std::string start_text(const PaperStart& start);

}  // namespace gatewalk::cli
