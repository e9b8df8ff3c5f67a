// SPDX-License-Identifier: MIT
#pragma once
/// The keys of scenes as a page of the documentation.

#include <string>

namespace gatewalk::cli {

/// Every key of a scene, in Markdown, a table for each section of the file: unit, permitted range,
/// default, the keys that it follows from where it is left out, and meaning. The text is the same
/// for each call.
[[nodiscard]] std::string scene_keys_in_markdown();

}  // namespace gatewalk::cli
