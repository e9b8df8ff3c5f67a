// SPDX-License-Identifier: MIT
#include "tests/fuzz/large_field.h"

#include <toml++/toml.h>

namespace gatewalk::fuzz {
namespace {

bool is_large(std::string_view text) {
  if (text.find("rows") == text.npos && text.find("columns") == text.npos) return false;
  try {
    const toml::table document = toml::parse(text);
    for (const char* key : {"rows", "columns"})
      if (document["field"][key].value_or(std::int64_t{1}) > 1000) return true;
  } catch (const toml::parse_error&) {
    return false;  // a text that readers refuse
  }
  return false;
}

}  // namespace

bool has_large_field(std::string_view text, const std::vector<std::string>& overrides) {
  for (const std::string& given : overrides)
    if (is_large(given)) return true;
  return is_large(text);
}

}  // namespace gatewalk::fuzz
