// SPDX-License-Identifier: MIT
#include "cli/fields/fields.h"

namespace gatewalk::cli {
namespace {

std::string key_95(std::string_view key) { return key.empty() ? "" : std::string(key) + "_95"; }
std::string meaning_95(const ResultKey& key, const char* what) {
  if (!key.interval.empty()) return std::string(key.interval);
  return what + std::string(key.varies.empty() ? key.key : key.varies);
}

}  // namespace

void Fields::bounded(const Field& f, ValueKind kind, const Value& value, ValueKind limits_kind,
                     const Value& limits) {
  const bool may_be_null = kind == ValueKind::grid;
  leaf(f, kind, may_be_null, value);
  const std::string meaning = meaning_95(f, "95 % interval of ");
  if (auto& object = opened_.back(); object) {
    object->all.push_back({std::string(f.key), std::string(f.unit), meaning, std::string(f.varies),
                           optional_ > object->optional, limits_kind, limits});
    return;
  }
  const std::string key = key_95(f.key), varies = key_95(f.varies);
  leaf(Field(key, f.unit, meaning).varying(varies), limits_kind, true, limits);
}

void Fields::put_limits(const Label& l, const std::optional<LimitsOfObject>& limits) {
  if (!limits || limits->all.empty()) return;
  const std::string key = key_95(l.key), varies = key_95(l.varies),
                    meaning = meaning_95(l, "95 % intervals of ");
  object(Label(key, meaning).varying(varies), [&](Fields& out) {
    for (const Limits& of : limits->all) {
      if (of.is_optional) out.begin_optional();
      out.leaf(Field(of.key, of.unit, of.meaning).varying(of.varies), of.kind, true, of.value);
      if (of.is_optional) out.end_optional();
    }
  });
}

}  // namespace gatewalk::cli
