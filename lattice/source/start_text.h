// SPDX-License-Identifier: MIT
#pragma once
/// A start as text: as --start gives it, and as results name it.

#include <optional>
#include <string>

#include "dynamics/cells/section.h"

namespace gatewalk::lattice {

/// By which faces of the first cell trials may start, and whether as recorded bodies did ("seen").
enum class StartsBy { first_face, any_face, any_face_or_seen };

/// Of "0.01,0,0.2", of "W:0.01,0,0.2" or, as bodies were seen to enter first, of "seen" (none).
/// Throws std::invalid_argument.
[[nodiscard]] std::optional<dynamics::Entry> start_in(const std::string& text,
                                                      const dynamics::Section& section,
                                                      StartsBy by);

/// "start d 4 m, vx 5 m/s, vy 10 m/s"; with the face's name where it is not the first one.
[[nodiscard]] std::string title_of(const dynamics::Section& section,
                                   const std::optional<dynamics::Entry>& start);

}  // namespace gatewalk::lattice
