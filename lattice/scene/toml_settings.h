// SPDX-License-Identifier: MIT
#pragma once
/// Keys of a TOML file and of overrides: where they stand, and what their numbers may be.

#include <toml++/toml.h>

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "lattice/scene/toml_file.h"

namespace gatewalk::lattice {

/// `origin(line)` is how a message begins: "scenes/x.toml:12" or "--set terrain.seed=6".
using Origin = std::function<std::string(std::size_t line)>;

/// Throws SceneError naming the line of a text that is no TOML, and what is wrong there.
[[nodiscard]] toml::table parse_toml(std::string_view text, const Origin& origin);
inline constexpr std::size_t kMostSceneBytes = 1 << 20;
/// What a file has, as TOML; `what` is one, such as "a scene". Throws SceneError for what is none,
/// cannot be read or is too large.
[[nodiscard]] const toml::table& document_of(const TomlFile& file, const std::string& what);

/// "KEY=VALUE" as TOML has it.
struct Override {
  std::string begin;  // of messages
  toml::table document;
};
/// `is_text(key)`: its value may stand without quotes. Throws SceneError.
[[nodiscard]] Override parse_override(const std::string& given,
                                      const std::function<bool(std::string_view key)>& is_text);

/// What a number may be. An open end is not itself permitted.
struct Interval {
  double low, high;
  bool low_open = false, high_open = false;

  [[nodiscard]] bool permits(double v) const {
    return (low_open ? v > low : v >= low) && (high_open ? v < high : v <= high);  // false for NaN
  }
  [[nodiscard]] std::string text() const;  // "(0, 1e+06]"
};

/// Rows and columns of a field, and gates that a body may visit in it.
inline constexpr Interval kFieldSizes{1, 10001}, kGateLimits{0, 1e9};

/// One key that a file or an override gives.
struct Setting {
  const toml::node* value;  // must outlive it
  std::string origin;
  std::string spelled;  // the key as it is written, perhaps in another unit

  /// The origin, with what stands there where that is another unit and not said by itself.
  [[nodiscard]] std::string where(std::string_view key) const;
};
using Settings = std::map<std::string, Setting, std::less<>>;

/// "x.toml:12: body.radius_cm = -3 is not permitted: must " and what is allowed, for a SceneError.
[[nodiscard]] std::string refusal_of(const Setting& setting, std::string_view shown,
                                     const std::string& allowed);

/// The number in the unit of `key`, of which `setting` is a spelling; `shown` is what a message
/// calls it. Throws SceneError for what is none, or not permitted.
[[nodiscard]] double number_of(const Setting& setting, std::string_view key,
                               const Interval& permitted, std::string_view shown);
[[nodiscard]] int whole_number_of(const Setting& setting, const Interval& permitted,
                                  std::string_view shown);

/// Row `line` (from 1) of `text`, for a message.
[[nodiscard]] std::string text_row(std::string_view text, std::size_t line);

/// Why `text` cannot be read, if the parser stopped in `line`, and what is allowed there: "a number
/// has a decimal point, as in 0.25".
[[nodiscard]] std::string toml_mistake(std::string_view text, std::size_t line);

}  // namespace gatewalk::lattice
