// SPDX-License-Identifier: MIT
#pragma once
/// What the results of commands may hold, as JSON Schema (draft 2020-12) and as pages of help.

#include <string>
#include <string_view>
#include <vector>

#include "cli/fields/fields.h"

namespace gatewalk::cli {

/// A command whose result is described.
struct ResultOf {
  const char* command;
  Description result;  // of a schema: every key that results may have
};
/// By name.
[[nodiscard]] const std::vector<ResultOf>& results();
/// The command's name in names of files: "chart-field".
[[nodiscard]] std::string file_name_of(std::string_view command);

/// The schema of the command's results as the text of a file: the type of each key, whether it is
/// always there, its unit ("unit") and its meaning ("description").
[[nodiscard]] std::string schema_of(const ResultOf& of);

/// A key of results: "rows[].chain" is that of each item of the list "rows".
struct KeyLine {
  std::string path, type, unit, meaning;
  bool is_always_there;
};
/// Keys under a name: the command, or the key of an object that the results of many commands have.
struct KeyList {
  std::string name;
  std::vector<KeyLine> keys;
};
/// The keys of a command's results, and behind them those of each shared object that they have.
[[nodiscard]] std::vector<KeyList> keys_of(const ResultOf& of);

/// The page of `gatewalk help COMMAND --result`.
[[nodiscard]] std::string result_page(const ResultOf& of);
/// The keys of all results as tables in Markdown.
[[nodiscard]] std::string results_in_markdown();

}  // namespace gatewalk::cli
