// SPDX-License-Identifier: MIT
#include "cli/web/html.h"

#include <stdexcept>

namespace gatewalk::cli {

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string script_json(std::string_view json) {
  std::string out;
  for (const char c : json) {
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  }
  return out;
}

std::string filled(std::string_view page,
                   const std::map<std::string, std::string, std::less<>>& parts) {
  std::string out;
  for (std::size_t at = 0;;) {
    const std::size_t open = page.find("{{", at);
    if (open == page.npos) return out.append(page.substr(at));
    const std::size_t close = page.find("}}", open);
    if (close == page.npos) throw std::logic_error("a page with {{ and no }}");
    const auto part = parts.find(page.substr(open + 2, close - open - 2));
    if (part == parts.end())
      throw std::logic_error("a page with an unknown " +
                             std::string(page.substr(open, close + 2 - open)));
    out.append(page.substr(at, open - at)).append(part->second);
    at = close + 2;
  }
}

}  // namespace gatewalk::cli
