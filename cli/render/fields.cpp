// SPDX-License-Identifier: MIT
#include "cli/render/fields.h"

namespace gatewalk::cli {

void Fields::limits_of(const Field& f, const std::optional<Interval>& limits, std::string_view bar,
                       std::string_view what) {
  const auto behind = [](std::string_view name) {
    return name.empty() ? std::string() : std::string(name) + "_95";
  };
  const std::string meaning = std::string(what) + std::string(f.varies.empty() ? f.key : f.varies);
  if (!intervals_.empty()) {
    intervals_.back().push_back(
        {std::string(f.key), std::string(f.unit), meaning, std::string(f.varies), limits});
    return;
  }
  const std::string key = bar.empty() ? behind(f.key) : std::string(bar), varies = behind(f.varies);
  interval(Field(key, f.unit, meaning).varying(bar.empty() ? varies : ""), limits);
}

void Fields::put_intervals(const Label& l, const Description& more) {
  const std::vector<Limits> all = std::move(intervals_.back());
  intervals_.pop_back();
  object(l, [&](Fields& out) {
    for (const Limits& i : all)
      out.interval(Field(i.key, i.unit, i.meaning).varying(i.varies), i.limits);
    if (more) more(out);
  });
}

}  // namespace gatewalk::cli
