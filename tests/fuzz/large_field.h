// SPDX-License-Identifier: MIT
#pragma once
/// Fields whose map alone takes more memory than a target may have.

#include <string>
#include <string_view>
#include <vector>

namespace gatewalk::fuzz {

/// Whether a scene, a cell file or an override names more than 1000 rows or columns.
[[nodiscard]] bool has_large_field(std::string_view text,
                                   const std::vector<std::string>& overrides);

}  // namespace gatewalk::fuzz
