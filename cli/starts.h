#pragma once
/// Where trials through the field start: the four of the paper's Table IV, or those given.

#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "dynamics/state_space.h"

namespace gatewalk::cli {

/// d, vx, vy (m, m/s) of a start, at y = 0 but for a scene's own; corrcoef and RMSE as Table IV
/// prints them.
struct PaperStart {
  double d = 0.0, vx = 0.0, vy = 0.0;
  std::optional<double> corrcoef, rmse;
  double y = 0.0;  // m

  [[nodiscard]] dynamics::BodyState body() const { return {d, y, vx, vy}; }
};

/// Declares --start; `by_default` says where to start without it.
void add_starts(Options& options,
                const std::string& by_default =
                    "the scene's start; in the paper's field with the paper's start "
                    "(0,0,15), the four of Table IV");
/// The starts given; none without --start. Throws UsageError for a malformed one.
[[nodiscard]] std::vector<PaperStart> given_starts(const Options& options);
/// The starts given, else the scene's, or those of Table IV in the paper's field with the paper's
/// start. Throws UsageError for a malformed one.
[[nodiscard]] std::vector<PaperStart> starts_of(const Options& options,
                                                const lattice::Scene& scene);
/// Their bodies. Throws UsageError when one does not start on the lower edge of its gate: a chain's
/// states are entries.
[[nodiscard]] std::vector<dynamics::BodyState> entries_at(const std::vector<PaperStart>& starts);
/// Throws UsageError unless all of them lie between the sides of the scene's gates.
void require_inside(const std::vector<PaperStart>& starts, const lattice::Scene& scene);
/// As start_in_bins for each of them.
void require_inside_bins(const std::vector<PaperStart>& starts, const lattice::Scene& scene,
                         const dynamics::StateSpace& space);
/// "  23  -11   16": columns as wide as the numbers of all starts need, every digit of them.
struct StartTexts {
  std::string header;              // "   d   vx   vy"
  std::vector<std::string> texts;  // (starts)
  explicit StartTexts(const std::vector<PaperStart>& starts);
};
[[nodiscard]] std::string start_text(const PaperStart& start);

}  // namespace gatewalk::cli
