// SPDX-License-Identifier: MIT
#pragma once
/// Table [bins] of a scene: edges of one's own for the states of the chain,
/// EN_d_m = [-0.2, 0, 0.2], EN_vx_m_per_s, EN_vy_m_per_s, RD_d_m, ...

#include <toml++/toml.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lattice/scene/scene.h"

namespace gatewalk::lattice {

inline constexpr std::string_view kBinsTable = "bins";

/// The edges of one boundary and coordinate, as a file or an override gives them.
struct GivenEdges {
  int boundary = 0;
  std::size_t axis = 0;  // number of the coordinate
  std::string name;      // "bins.EN_d_m"
  std::string origin;    // how a message about it begins
  std::vector<double> edges;
};

/// Those in the table [bins] of `document`, none without it. `origin(line)` is how a message
/// begins. Throws SceneError unless every key is known and holds at least two numbers, finite and
/// ascending.
[[nodiscard]] std::vector<GivenEdges> edges_in(
    const toml::table& document, const std::function<std::string(std::size_t)>& origin);

/// The bins of these edges in this gate, the last ones of a key; axes without any have Table III's
/// in the scene's own units. None without edges. Throws SceneError when distances lie outside their
/// boundary or there are too many states, InvalidParameter as table3_space.
[[nodiscard]] std::optional<SceneBins> bins_of(const dynamics::GateParams& gate,
                                               const std::vector<GivenEdges>& given);

/// "[bins]\nEN_d_m = [-0.2, 0.0, 0.2]\n...", every key.
[[nodiscard]] std::string bins_toml(const SceneBins& bins);

}  // namespace gatewalk::lattice
