// SPDX-License-Identifier: MIT
#include "lattice/scene/toml_settings.h"

#include <algorithm>

#include "lattice/scene/scene.h"
#include "lattice/scene/toml_mistake.h"
#include "lattice/scene/units.h"
#include "lattice/text/toml_text.h"

namespace gatewalk::lattice {
namespace {

// Every level of a dotted key costs a dot and, in the parser's destructors, stack. Brackets are
// limited by the parser itself (256 deep).
constexpr int kMaxDots = 2000;

void refuse_deep_nesting(std::string_view text, const Origin& origin) {
  int dots = 0;
  std::size_t line = 1;
  while (!text.empty()) {
    const std::string_view row = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), row.size() + 1));
    const std::size_t first = row.find_first_not_of(" \t");
    if (first != row.npos && row[first] != '#') {
      dots += static_cast<int>(std::count(row.begin(), row.end(), '.'));
    }
    if (dots > kMaxDots) {
      throw SceneError(origin(line) + ": nested too deeply: too many dotted keys");
    }
    ++line;
  }
}

std::string allowed_in(const Interval& permitted, const KeyUnit& unit) {
  return Interval{in_given_unit(permitted.low, unit), in_given_unit(permitted.high, unit),
                  permitted.low_open, permitted.high_open}
             .text() +
         (unit.shown.empty() ? "" : " " + unit.shown);
}

}  // namespace

toml::table parse_toml(std::string_view text, const Origin& origin) {
  refuse_deep_nesting(text, origin);
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    const std::size_t line = error.source().begin.line;
    throw SceneError(origin(line) + ": " + text_row(text, line) + ": " + toml_mistake(text, line));
  }
}

Override parse_override(const std::string& given,
                        const std::function<bool(std::string_view key)>& is_text) {
  const std::string begin = "--set " + printable(given);
  const std::size_t equals = given.find('=');
  if (equals == given.npos || given.find_first_of("\r\n") != given.npos) {
    throw SceneError(begin + ": must be KEY=VALUE, for example forces.random_N=20");
  }
  const std::string name(trimmed(std::string_view(given).substr(0, equals)));
  std::string value(trimmed(std::string_view(given).substr(equals + 1)));

  // A bare word for a text key: quotes seldom survive a shell.
  if (is_text(name) && value.find_first_of("\"'") == value.npos) value = "\"" + value + "\"";
  return {begin, parse_toml(name + " = " + value, [&](std::size_t) { return begin; })};
}

std::string Interval::text() const {
  return (low_open ? "(" : "[") + shortest(low) + ", " + shortest(high) + (high_open ? ")" : "]");
}

std::string Setting::where(std::string_view key) const {
  const std::string_view leaf = std::string_view(spelled).substr(spelled.find('.') + 1);
  return spelled == key || origin.starts_with("--set ")
             ? origin
             : origin + " (" + std::string(leaf) + shown_value(*value) + ")";
}

std::string refusal_of(const Setting& setting, std::string_view shown, const std::string& allowed) {
  return setting.origin + ": " + std::string(shown) + shown_value(*setting.value) +
         " is not permitted: must " + allowed;
}

double number_of(const Setting& setting, std::string_view key, const Interval& permitted,
                 std::string_view shown) {
  const KeyUnit unit = unit_of(setting.spelled, key).value();
  const auto* whole = setting.value->as_integer();
  const auto* floating = setting.value->as_floating_point();
  const std::string allowed = allowed_in(permitted, unit);
  if (!whole && !floating)
    throw SceneError(refusal_of(setting, shown, "be a number in " + allowed));
  const double number =
      in_own_unit(floating ? floating->get() : static_cast<double>(whole->get()), unit);
  if (!permitted.permits(number)) throw SceneError(refusal_of(setting, shown, "lie in " + allowed));
  return number;
}

int whole_number_of(const Setting& setting, const Interval& permitted, std::string_view shown) {
  const auto* whole = setting.value->as_integer();
  if (!whole)
    throw SceneError(refusal_of(setting, shown, "be a whole number in " + permitted.text()));
  if (!permitted.permits(static_cast<double>(whole->get())))
    throw SceneError(refusal_of(setting, shown, "lie in " + permitted.text()));
  return static_cast<int>(whole->get());
}

}  // namespace gatewalk::lattice
