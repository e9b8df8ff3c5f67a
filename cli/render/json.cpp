// SPDX-License-Identifier: MIT
#include "cli/render/json.h"

#include <locale.h>

namespace gatewalk::cli {
namespace {

/// While it lives, this thread has no other locale than C.
class PlainLocale {
 public:
  PlainLocale() : before_(::uselocale(plain())) {}
  ~PlainLocale() { ::uselocale(before_); }
  PlainLocale(const PlainLocale&) = delete;
  PlainLocale& operator=(const PlainLocale&) = delete;

 private:
  static locale_t plain() {
    static const locale_t c = ::newlocale(LC_ALL_MASK, "C", nullptr);
    return c;
  }
  locale_t before_;
};

}  // namespace

Json parsed_json(std::string_view text) {
  const PlainLocale guard;  // nlohmann reads by strtod, and takes decimal points for one byte
  return Json::parse(text, nullptr, false);
}

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
