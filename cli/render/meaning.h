// SPDX-License-Identifier: MIT
#pragma once
/// What the numbers of a scene mean, in words, and where they are far from what walks.

#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "dynamics/disc/study/meaning.h"
#include "lattice/scene/scene.h"

namespace gatewalk::cli {

/// Something about a scene that no animal and no robot that walks has.
struct FarFromWalkers {
  std::string name;    // "random_per_weight"
  std::string what;    // "a random force of 5.7 times its weight"
  std::string reason;  // a sentence
};
[[nodiscard]] std::vector<FarFromWalkers> far_from_walkers(const dynamics::Meaning& meaning,
                                                           const lattice::Scene& scene);
/// The same in a line, for a scene that leaves out keys which have a unit; else empty.
[[nodiscard]] std::string far_from_walkers_line(const lattice::Scene& scene);

/// The result of `scene`.
struct SceneResult {
  lattice::Scene scene;
  dynamics::Meaning meaning;
  std::vector<dynamics::Deciding> deciding;
};
void describe(Fields& out, const SceneResult& result);
/// What the numbers mean; below it the map and the actions, if there are, and every key.
[[nodiscard]] std::string table_of(const SceneResult& result);

}  // namespace gatewalk::cli
