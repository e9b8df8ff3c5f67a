// SPDX-License-Identifier: MIT
#pragma once
/// The keys of scenes as a page of the documentation.

#include <string>

namespace gatewalk::cli {

/// Every key of a scene as Markdown tables, one for each section of the file: unit, permitted
/// range, default, the keys from which the key follows if it is left out, and meaning.
[[nodiscard]] std::string scene_keys_in_markdown();

}  // namespace gatewalk::cli
