// SPDX-License-Identifier: MIT
#include "cli/render/json.h"

namespace gatewalk::cli {

std::string text_of(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

Json with_format_version(const Json& result) {
  Json all{{"format_version", kFormatVersion}};
  all.update(result);
  return all;
}

std::string json_text(const Json& result, int indent) {
  return text_of(with_format_version(result), indent) + "\n";
}

}  // namespace gatewalk::cli
