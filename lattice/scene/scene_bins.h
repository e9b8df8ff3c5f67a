// SPDX-License-Identifier: MIT
#pragma once
/// Table [bins] of a scene: the user's own bin edges for the states of the chain: EN_d_m = [-0.2,
/// 0, 0.2], EN_vx_m_per_s, EN_vy_m_per_s, RD_d_m, ...

#include <toml++/toml.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lattice/scene/scene.h"

namespace gatewalk::lattice {

inline constexpr std::string_view kBinsTable = "bins";

/// The edges for one face and coordinate, as a file or an override gives them.
struct GivenEdges {
  int boundary = 0;
  std::size_t axis = 0;  // index of the coordinate
  std::string name;      // "bins.EN_d_m"
  std::string origin;    // how a message about these edges begins
  std::vector<double> edges;
};

/// The edges in the table [bins] of `document`; empty without that table. `origin(line)` begins
/// messages. Throws SceneError unless every key is known and has at least two numbers, finite and
/// ascending.
[[nodiscard]] std::vector<GivenEdges> edges_in(
    const toml::table& document, const std::function<std::string(std::size_t)>& origin);

/// The bins of these edges in this gate; the last edges of a key win, and axes without edges get
/// those of Table III in the scene's own units. nullopt without any edges. Throws SceneError if
/// distances lie outside their face or there are too many states, InvalidParameter as table3_space.
[[nodiscard]] std::optional<SceneBins> bins_of(const dynamics::GateParams& gate,
                                               const std::vector<GivenEdges>& given);

/// The table as TOML, with every key: "[bins]\nEN_d_m = [-0.2, 0.0, 0.2]\n...".
[[nodiscard]] std::string bins_toml(const SceneBins& bins);

}  // namespace gatewalk::lattice
