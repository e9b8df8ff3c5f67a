// SPDX-License-Identifier: MIT
#pragma once
/// What the numbers of a scene mean, in words, and where they are far from what walks.

#include <string>
#include <vector>

#include "cli/render/json_fwd.h"
#include "dynamics/disc/study/deciding.h"
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

/// Numbers in the units of the scene, null for what is infinite or is not; with the remarks.
[[nodiscard]] Json to_json(const dynamics::Meaning& meaning, const lattice::Scene& scene);
/// A paragraph below the table of keys.
[[nodiscard]] std::string meaning_text(const dynamics::Meaning& meaning,
                                       const std::vector<dynamics::Deciding>& deciding,
                                       const lattice::Scene& scene);
/// Its sentences, each behind what it is about: "sideways: noise shakes the body by ...".
[[nodiscard]] std::vector<std::string> remarks(const dynamics::Meaning& meaning,
                                               const std::vector<dynamics::Deciding>& deciding,
                                               const lattice::Scene& scene);

}  // namespace gatewalk::cli
