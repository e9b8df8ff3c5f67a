// SPDX-License-Identifier: MIT
#include "cli/ranged.h"

#include "lattice/scene/scene_problem.h"

namespace gatewalk::cli {

std::optional<lattice::RangedScene> ranges_of(const Options& options, const Subject& s,
                                              const std::string& option, int most) {
  const auto given = options.texts(option);
  const std::string shown = "--" + option;
  if (given.empty()) return {};
  if (!s.scene || s.file)
    throw UsageError(shown + ": is for a scene of gates, whose numbers vary; " + s.path +
                     " is none");
  if (std::ssize(given) > most)
    throw UsageError(shown + ": at most " + std::to_string(most) + " numbers can vary");
  lattice::RangedScene ranged(lattice::scene_text(s.path), s.path, options.overrides(), given,
                              shown);
  for (const lattice::NumberRange& r : ranged.ranges()) {
    if (s.given && r.key.starts_with("start."))
      throw UsageError(shown + " " + r.key +
                       ": varies the scene's start, and --start gives another");
    if (s.scene->gate.run.method == "auto" && r.key.starts_with("run."))
      throw UsageError(shown + " " + r.key +
                       ": varies what run.method = \"auto\" chooses; name a method");
  }
  return ranged;
}

lattice::Scene scene_at(const lattice::RangedScene& ranged, const Subject& s,
                        const std::vector<double>& point) {
  lattice::Scene scene = ranged.at(point);
  if (s.settled) {
    const dynamics::RunParams& chosen = s.scene->gate.run;
    scene.gate.run.method = chosen.method;
    scene.gate.run.step = chosen.step;
    scene.gate.run.event_tolerance = chosen.event_tolerance;
  }
  if (s.given) {
    const auto& at = (*s.starts.front()).at;
    scene.start = {at[0], 0.0, at[1], at[2]};
  }
  return scene;
}

lattice::ProblemAt problem_at(const lattice::RangedScene& ranged, const Subject& s) {
  return [&ranged, &s](const std::vector<double>& point) {
    return lattice::problem_of(scene_at(ranged, s, point));
  };
}

}  // namespace gatewalk::cli
