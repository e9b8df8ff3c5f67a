// SPDX-License-Identifier: MIT
#pragma once
/// Puts pages together.

#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace gatewalk::cli {

/// The text escaped for HTML, also inside attributes.
[[nodiscard]] std::string escaped(std::string_view text);

/// JSON text escaped for a <script> element, which no part of it can end.
[[nodiscard]] std::string script_json(std::string_view json);

/// `page` with each {{name}} replaced by its part. Inserted parts are not searched again. Throws
/// std::logic_error for a name without a part.
[[nodiscard]] std::string filled(std::string_view page,
                                 const std::map<std::string, std::string, std::less<>>& parts);

}  // namespace gatewalk::cli
