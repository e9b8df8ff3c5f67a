// SPDX-License-Identifier: MIT
#include "lattice/scene/toml_settings.h"

#include <algorithm>
#include <cctype>
#include <optional>

#include "lattice/scene/scene.h"
#include "lattice/scene/units.h"
#include "lattice/text/toml_text.h"

namespace gatewalk::lattice {
namespace {

// Every level of a dotted key costs a dot and, in the parser's destructors, stack space. The parser
// itself limits brackets (256 deep).
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

  // A bare word for a text key: shells often remove quotes.
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

namespace {

constexpr const char* kLine = "must be KEY = VALUE, as in body.mass_kg = 0.25";

/// The text before row `line`, and the row.
struct Split {
  std::string_view before, row;
};
Split split_at(std::string_view text, std::size_t line) {
  std::size_t begin = 0;
  for (std::size_t next = 0; line > 1 && (next = text.find('\n', begin)) != text.npos; --line)
    begin = next + 1;
  return {text.substr(0, begin), text.substr(begin, text.find('\n', begin) - begin)};
}

std::optional<toml::table> parsed(std::string_view text) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error&) {
    return {};
  }
}

/// The line in which `before` gives a key that `again` gives too; 0: none.
std::size_t first_given(const toml::table& before, const toml::table& again) {
  for (const auto& [key, node] : again) {
    const toml::node* const there = before.get(key.str());
    if (!there) continue;
    // Compares the last [[NAME]] of each.
    if (node.is_array_of_tables() && there->is_array_of_tables()) {
      const toml::node &last = there->as_array()->back(), &own = node.as_array()->back();
      if (const std::size_t line = first_given(*last.as_table(), *own.as_table())) return line;
      continue;
    }
    if (node.is_table() && there->is_table())
      if (const std::size_t line = first_given(*there->as_table(), *node.as_table())) return line;
    return there->source().begin.line;
  }
  return 0;
}

/// The message that a row gives a key twice; the row is valid TOML on its own.
std::string given_twice(const Split& split) {
  const std::size_t header = split.before.rfind("\n[");
  std::string_view table = split.before.starts_with('[') ? split.before : std::string_view();
  if (header != split.before.npos) table = split.before.substr(header + 1);
  const auto before = parsed(split.before),
             again = parsed(split.row.starts_with('[')
                                ? std::string(split.row)
                                : std::string(table.substr(0, table.find('\n'))) + "\n" +
                                      std::string(split.row));
  const std::size_t line = before && again ? first_given(*before, *again) : 0;
  return line > 0 ? "is given in line " + std::to_string(line) + " already"
                  : "does not fit what the lines before it give";
}

/// True if `text` ends inside an inline table { }, but not in an array in it, where lines may
/// break. Strings and comments may contain any brackets.
bool ends_in_inline_table(std::string_view text) {
  std::string open;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '#') {
      at = std::min(text.find('\n', at), text.size());
    } else if (c == '"' || c == '\'') {
      const std::string quotes(text.substr(at, 3) == std::string(3, c) ? 3 : 1, c);
      for (at += quotes.size(); at < text.size() && !text.substr(at).starts_with(quotes); ++at)
        if (c == '"' && text[at] == '\\') ++at;
      at += quotes.size() - 1;
    } else if (c == '{' || c == '[') {
      open += c;
    } else if ((c == '}' || c == ']') && !open.empty()) {
      open.pop_back();
    }
  }
  return open.ends_with('{');
}

std::string mistake_in_value(std::string_view value) {
  if (value.empty() || value[0] == '#') return "has no value";
  if (value[0] == '"' || value[0] == '\'')
    return "text must stand between two quotation marks, as in \"auto\"";
  constexpr std::ptrdiff_t kDeep = 256;  // the parser's limit of depth
  if (std::count(value.begin(), value.end(), value[0]) >= kDeep) return "is nested too deeply";
  if (value[0] == '{') return "a table must be [NAME] on a line of its own, its keys below it";
  if (value[0] == '[') return "an array must stand in brackets, with commas between, as in [1, 2]";
  const std::size_t end = value.find_first_not_of("0123456789+-.eE_");
  const std::string_view number = value.substr(0, end),
                         rest = trimmed(value.substr(std::min(end, value.size())));
  if (number.find_first_of("0123456789") == number.npos)
    return "text must stand between quotation marks, as in \"auto\"";
  if (rest.starts_with(',')) return "a number has a decimal point, as in 0.25";
  if (rest.starts_with(':'))
    return "a key has one value: run the command once for each value (sweep --vary does so for one "
           "gate)";
  if (!rest.empty() && rest[0] != '#')
    return "a number must stand alone: its unit is in the key's name";
  if (number.ends_with('.')) return "a number must have a digit behind its point, as in 1.0";
  if (number.size() > 1 && number[0] == '0' && number[1] != '.')
    return "a number must not begin with a 0 that it does not need, as in 40";
  return "is no number, or too large for one: must be as in 0.25 or 2.5e-1";
}

}  // namespace

std::string text_row(std::string_view text, std::size_t line) {
  return printable(trimmed(split_at(text, line).row));
}

std::string toml_mistake(std::string_view text, std::size_t line) {
  const Split split = split_at(text, line);
  const std::string_view row = trimmed(split.row);
  // A comment may contain any text except this.
  if (!parsed("# " + std::string(row)))
    return "has letters that are not UTF-8, or control characters";
  if (ends_in_inline_table(text.substr(0, split.before.size() + split.row.size())))
    return "an inline table { } must stand on one line: close it here, or write it as a table "
           "[NAME] with a line for each key";
  if (parsed(row)) return given_twice(split);
  if (row.starts_with('[')) return "a table must be its name in brackets, as in [body]";
  const std::size_t equals = row.find('=');
  if (equals == row.npos) return kLine;
  const std::string_view key = trimmed(row.substr(0, equals));
  const auto of_key = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("_-.\"'").find(c) != std::string_view::npos;
  };
  if (key.empty() || !std::all_of(key.begin(), key.end(), of_key)) return kLine;
  return mistake_in_value(trimmed(row.substr(equals + 1)));
}

}  // namespace gatewalk::lattice
