#pragma once
/// The studies behind the paper's figures and claims: which commands are run, and what they gave.

#include <map>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/paper/verdicts.h"

namespace gatewalk::cli {

/// One command of this program. Its result goes to data/NAME.json.
struct Study {
  std::string name;
  int (*run)(const std::vector<std::string>& arguments) = nullptr;
  std::string command;                 // "sweep"
  std::vector<std::string> arguments;  // without --json and --quiet
  std::int64_t cost = 1;               // expected seconds times 100, for the time that is left

  [[nodiscard]] std::string text() const;  // "gatewalk sweep scenes/fig8.toml ..."
};

/// All of them, in the order in which they are run.
[[nodiscard]] std::vector<Study> paper_studies(bool quick);

/// What they gave.
struct Findings {
  std::map<std::string, Json> data;             // by the study's name
  std::map<std::string, std::string> commands;  // the same

  [[nodiscard]] const Json& operator[](const std::string& name) const { return data.at(name); }
};

/// The point of a sweep at which the keys have these values. Throws std::out_of_range if there is
/// none.
using At = std::vector<std::pair<std::string, Json>>;
[[nodiscard]] const Json& point_at(const Json& sweep, const At& at);
[[nodiscard]] Share traversed_at(const Json& sweep, const At& at);
/// Right of those that pushed more past one beam (Fig. 12).
[[nodiscard]] Share right_at(const Json& sweep, const At& at);

/// KEY=VALUE for --set; whole values without a fraction.
[[nodiscard]] std::string set(const char* key, double value);
/// The scene's physics, from a scene that the program carries.
[[nodiscard]] dynamics::GateParams gate_of(const char* scene,
                                           const std::vector<std::string>& overrides = {});
/// "d = 0 m, v = (0, 15) m/s": a start of `validate`.
[[nodiscard]] std::string start_label(const Json& start);
/// Seconds that `validate` took for one of what it counts ("dynamics" by "trials", "walks" by
/// "walks").
[[nodiscard]] double seconds_per(const Json& validation, const char* what, const char* count);

inline constexpr char kDamping[] = "beams.damping_Nms_per_rad";
inline constexpr char kPropulsion[] = "forces.propulsion_N";
inline constexpr char kRandom[] = "forces.random_N";
inline constexpr char kLeftStiffness[] = "beams.stiffness_left_Nm_per_rad";
inline constexpr char kRightStiffness[] = "beams.stiffness_right_Nm_per_rad";

/// The claims of the paper's abstract and of Secs. II and III beside what was found: objects with
/// id, where, claim, paper, ours, verdict ("reproduced", "within noise", "differs"), why, see (a
/// section).
[[nodiscard]] Json claims_of(const Findings& f);

/// Draws the figures into the current folder (fig8.svg, fig8.pdf, fig8.csv, ...) and returns the
/// sections of the page about them.
[[nodiscard]] Json sections_of(const Findings& f);

}  // namespace gatewalk::cli
