// SPDX-License-Identifier: MIT
#pragma once
/// Keys of a TOML file and of overrides: where they are given, and which numbers they permit.

#include <toml++/toml.h>

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "lattice/scene/toml_file.h"

namespace gatewalk::lattice {

/// `origin(line)` returns how a message begins: "scenes/x.toml:12" or "--set terrain.seed=6".
using Origin = std::function<std::string(std::size_t line)>;

/// Parses `text`. Throws SceneError, naming the line and what is wrong there, if it is not TOML.
[[nodiscard]] toml::table parse_toml(std::string_view text, const Origin& origin);
inline constexpr std::size_t kMostSceneBytes = 1 << 20;
/// The TOML document of a file; `what` says what the file should be, such as "a scene". Throws
/// SceneError if the file is not TOML, cannot be read, or is too large.
[[nodiscard]] const toml::table& document_of(const TomlFile& file, const std::string& what);

/// An override "KEY=VALUE" as TOML.
struct Override {
  std::string begin;  // of messages
  toml::table document;
};
/// Parses an override; is_text(key): the key's value may stand without quotes. Throws SceneError.
[[nodiscard]] Override parse_override(const std::string& given,
                                      const std::function<bool(std::string_view key)>& is_text);

/// The permitted range of a number. An open end is not itself permitted.
struct Interval {
  double low, high;
  bool low_open = false, high_open = false;

  [[nodiscard]] bool permits(double v) const {
    return (low_open ? v > low : v >= low) && (high_open ? v < high : v <= high);  // false for NaN
  }
  [[nodiscard]] std::string text() const;  // "(0, 1e+06]"
};

/// Permitted numbers of rows and columns of a field, and of gates that a body may visit.
inline constexpr Interval kFieldSizes{1, 10001}, kGateLimits{0, 1e9};
/// Permitted numbers of one of `count` rows or columns, counted from 0.
[[nodiscard]] constexpr Interval below(int count) { return {0, count - 1.0}; }

/// One key that a file or an override gives.
struct Setting {
  const toml::node* value;  // must outlive it
  std::string origin;
  std::string spelled;  // the key as the user wrote it, perhaps in another unit

  /// The origin, followed by the user's spelling if it has another unit that the origin does not
  /// show.
  [[nodiscard]] std::string where(std::string_view key) const;
};
using Settings = std::map<std::string, Setting, std::less<>>;

/// The message of a SceneError about a value that is not permitted: "x.toml:12: body.radius_cm = -3
/// is not permitted: must ", followed by `allowed`.
[[nodiscard]] std::string refusal_of(const Setting& setting, std::string_view shown,
                                     const std::string& allowed);

/// The number of a setting, in the unit of `key`; `shown` names the key in messages. Throws
/// SceneError if the value is no number, or not permitted.
[[nodiscard]] double number_of(const Setting& setting, std::string_view key,
                               const Interval& permitted, std::string_view shown);
[[nodiscard]] int whole_number_of(const Setting& setting, const Interval& permitted,
                                  std::string_view shown);

/// Row `line` (from 1) of `text`, for a message.
[[nodiscard]] std::string text_row(std::string_view text, std::size_t line);

/// What is wrong with `text` if the parser stopped in `line`, and what is allowed there: "a number
/// has a decimal point, as in 0.25".
[[nodiscard]] std::string toml_mistake(std::string_view text, std::size_t line);

}  // namespace gatewalk::lattice
