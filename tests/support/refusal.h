// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "lattice/scene/scene.h"

namespace gatewalk::test {

/// The message with which a scene of this text is refused, "bad.toml:2: ..."; "(accepted)" if it is
/// not.
inline std::string scene_refusal(const std::string& text,
                                 const std::vector<std::string>& overrides = {}) {
  try {
    (void)lattice::parse_scene(text, "bad.toml", overrides);
  } catch (const lattice::SceneError& error) {
    return error.what();
  }
  return "(accepted)";
}

}  // namespace gatewalk::test
