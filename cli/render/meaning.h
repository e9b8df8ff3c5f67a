// SPDX-License-Identifier: MIT
#pragma once
/// The meaning of a scene's numbers in words, and where they are unlike any walker's.

#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "dynamics/disc/study/meaning.h"
#include "lattice/scene/scene.h"

namespace gatewalk::cli {

/// A property of a scene that is unusual for walking animals and robots.
struct FarFromWalkers {
  std::string name;    // "random_per_weight"
  std::string what;    // "a random force of 5.7 times its weight"
  std::string reason;  // a sentence
};
[[nodiscard]] std::vector<FarFromWalkers> far_from_walkers(const dynamics::Meaning& meaning,
                                                           const lattice::Scene& scene);
/// A line on the properties of far_from_walkers(), for a scene that leaves out keys with a unit;
/// empty otherwise.
[[nodiscard]] std::string far_from_walkers_line(const lattice::Scene& scene);

/// The result of `scene`.
struct SceneResult {
  lattice::Scene scene;
  dynamics::Meaning meaning;
  std::vector<dynamics::Deciding> deciding;
};
void describe(Fields& out, const SceneResult& result);
/// The meaning of the numbers; then the map and the actions, if the scene has them; then every key.
[[nodiscard]] std::string table_of(const SceneResult& result);

}  // namespace gatewalk::cli
