#include "cli/render/json.h"

namespace gatewalk::cli {

std::string text_of(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace gatewalk::cli
