// SPDX-License-Identifier: MIT
#pragma once
/// What pages are put together with.

#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace gatewalk::cli {

/// Text as it stands in HTML, in an attribute too.
[[nodiscard]] std::string escaped(std::string_view text);

/// JSON, as text, as it stands in a <script>: nothing in it can end the element.
[[nodiscard]] std::string script_json(std::string_view json);

/// `page` with each {{name}} replaced; what is put in is not looked at again. Throws
/// std::logic_error for a name without a part.
[[nodiscard]] std::string filled(std::string_view page,
                                 const std::map<std::string, std::string, std::less<>>& parts);

}  // namespace gatewalk::cli
