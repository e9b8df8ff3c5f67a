// SPDX-License-Identifier: MIT
#pragma once
/// What the results of commands may hold, as JSON Schema (draft 2020-12) and as pages of help.

#include <string>
#include <vector>

#include "cli/render/fields.h"

namespace gatewalk::cli {

/// A command whose result is described.
struct ResultOf {
  const char* command;
  Description result;  // of a schema: every key that results may have
};
/// By name.
[[nodiscard]] const std::vector<ResultOf>& results();

/// The schema of the command's results as the text of a file: the type of each key, whether it is
/// always there, its unit ("unit") and its meaning ("description").
[[nodiscard]] std::string schema_of(const ResultOf& of);

/// A key of results: "rows[].chain" is that of each item of the list "rows".
struct KeyLine {
  std::string path, type, unit, meaning;
  bool is_always_there;
};
[[nodiscard]] std::vector<KeyLine> keys_of(const ResultOf& of);

}  // namespace gatewalk::cli
