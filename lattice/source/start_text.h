// SPDX-License-Identifier: MIT
#pragma once
/// Starts as text: as --start takes them, and as results name them.

#include <optional>
#include <string>

#include "dynamics/cells/section.h"

namespace gatewalk::lattice {

/// Which starts are permitted: by any face, or also "seen" (as recorded bodies entered).
enum class StartsBy { any_face, any_face_or_seen };

/// The start in a text such as "0.01,0,0.2" or "W:0.01,0,0.2"; nullopt for "seen", the observed
/// first entries. Throws std::invalid_argument.
[[nodiscard]] std::optional<dynamics::Entry> start_in(const std::string& text,
                                                      const dynamics::Section& section,
                                                      StartsBy by);

/// "start d 4 m, vx 5 m/s, vy 10 m/s"; names the face if it is not the first one.
[[nodiscard]] std::string title_of(const dynamics::Section& section,
                                   const std::optional<dynamics::Entry>& start);

}  // namespace gatewalk::lattice
