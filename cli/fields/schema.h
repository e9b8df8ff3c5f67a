// SPDX-License-Identifier: MIT
#pragma once
/// What the results of commands may hold, as JSON Schema (draft 2020-12) and as help pages.

#include <string>
#include <string_view>
#include <vector>

#include "cli/fields/fields.h"

namespace gatewalk::cli {

/// A command whose result is described.
struct ResultOf {
  const char* command;
  Description result;  // describes every key that results may have
};
/// The results of all commands, by the command's name.
[[nodiscard]] const std::vector<ResultOf>& results();
/// The command's name as used in names of files: "chart-field".
[[nodiscard]] std::string file_name_of(std::string_view command);

/// The schema of the command's results, as the text of a file. For each key: its type, whether it
/// is always there, its unit ("unit") and its meaning ("description").
[[nodiscard]] std::string schema_of(const ResultOf& of);

/// A key of results. "rows[].chain" is the key "chain" of each item of the list "rows".
struct KeyLine {
  std::string path, type, unit, meaning;
  bool is_always_there;
};
/// Keys under a heading: a command, or the key of an object that several commands' results have.
struct KeyList {
  std::string name;
  std::vector<KeyLine> keys;
};
/// The keys of a command's results, followed by those of each shared object in these results.
[[nodiscard]] std::vector<KeyList> keys_of(const ResultOf& of);

/// The page of `gatewalk help COMMAND --result`.
[[nodiscard]] std::string result_page(const ResultOf& of);
/// The keys of all results as tables in Markdown.
[[nodiscard]] std::string results_in_markdown();

}  // namespace gatewalk::cli
