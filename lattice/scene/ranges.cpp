// SPDX-License-Identifier: MIT
#include "lattice/scene/ranges.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "lattice/scene/scene_keys.h"
#include "lattice/scene/units.h"
#include "lattice/text/digits.h"

namespace gatewalk::lattice {
namespace {

std::optional<double> number_in(std::string_view text) {
  double x = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), x);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size() || !std::isfinite(x))
    return {};
  return x;
}

}  // namespace

RangedScene::RangedScene(TomlFile file, std::vector<std::string> overrides,
                         const std::vector<std::string>& ranges, std::string option)
    : file_(std::move(file)), overrides_(std::move(overrides)), option_(std::move(option)) {
  for (const std::string& given : ranges) add(given);
  // A key may be permitted at both ends, but not in between: whole numbers.
  constexpr double kWithin = 0.381966;
  (void)at(std::vector<double>(ranges_.size(), kWithin));
  for (std::size_t corner = 0; corner < std::size_t{1} << ranges_.size(); ++corner) {
    std::vector<double> point;
    for (std::size_t k = 0; k < ranges_.size(); ++k)
      point.push_back(static_cast<double>(corner >> k & 1));
    (void)at(point);
  }
}

NumberRange range_in(const std::string& given, const std::string& option) {
  const std::size_t equals = given.find('='),
                    colon = given.find(':', std::min(equals, given.size()));
  const auto low = colon == given.npos
                       ? std::nullopt
                       : number_in(std::string_view(given).substr(equals + 1, colon - equals - 1));
  const auto high =
      colon == given.npos ? std::nullopt : number_in(std::string_view(given).substr(colon + 1));
  if (!low || !high || !(*low < *high))
    throw SceneError(option + " " + given +
                     ": must be KEY=LOW:HIGH, two numbers, the low one first");
  return {given.substr(0, equals), *low, *high};
}

void RangedScene::add(const std::string& given) {
  const std::string origin = option_ + " " + given;
  const NumberRange range = range_in(given, option_);
  const std::string key = known_key(range.key, origin);
  for (const NumberRange& other : ranges_)
    if (known_key(other.key, origin) == key)
      throw SceneError(origin + ": " + key + " is varied already");
  for (const std::string& set : overrides_)
    for (const std::string& fixed : keys_set_by(set))
      if (fixed == key)
        throw SceneError("--set " + set + " has no effect: " + key + " is varied (" + origin + ")");
  ranges_.push_back(range);
}

Scene RangedScene::at(const std::vector<double>& point) const {
  std::vector<std::string> all = overrides_;
  for (std::size_t k = 0; k < ranges_.size(); ++k) {
    const NumberRange& r = ranges_[k];
    all.push_back(r.key + "=" + shortest(r.at(point[k])));
  }
  try {
    return read_scene(file_, all);
  } catch (const SceneError& e) {  // its message names overrides as --set gives them
    const std::string what = e.what();
    for (const NumberRange& r : ranges_)
      if (what.starts_with("--set " + r.key + "="))
        throw SceneError(option_ + " " + r.key + "=" + shortest(r.low) + ":" + shortest(r.high) +
                         what.substr(what.find(": ")));
    throw;
  }
}

}  // namespace gatewalk::lattice
