// SPDX-License-Identifier: MIT
#pragma once
/// A scene whose numbers vary, each over a range.

#include <string>
#include <vector>

#include "lattice/scene/scene.h"
#include "lattice/scene/toml_file.h"

namespace gatewalk::lattice {

/// Of one key, in the unit that it is spelled with.
struct NumberRange {
  std::string key;
  double low = 0.0, high = 0.0;

  /// 0 the low end, 1 the high one.
  [[nodiscard]] double at(double share) const { return low + share * (high - low); }
};

/// Of "KEY=LOW:HIGH"; `option` begins the message. Throws SceneError.
[[nodiscard]] NumberRange range_in(const std::string& given, const std::string& option);

class RangedScene {
 public:
  /// A scene's file, its overrides, and the ranges, each "KEY=LOW:HIGH".
  /// Throws SceneError for what cannot be read, a key that is varied twice or overridden, and
  /// ranges in which the scene is not permitted everywhere, as far as all ends and one point within
  /// tell. `option` begins messages about ranges ("--over").
  RangedScene(TomlFile file, std::vector<std::string> overrides,
              const std::vector<std::string>& ranges, std::string option);
  [[nodiscard]] const std::vector<NumberRange>& ranges() const { return ranges_; }
  /// At a point of the unit cube: 0 the low end of a range, 1 the high one. Throws SceneError.
  [[nodiscard]] Scene at(const std::vector<double>& point) const;

 private:
  void add(const std::string& given);

  TomlFile file_;
  std::vector<std::string> overrides_;
  std::vector<NumberRange> ranges_;
  std::string option_;
};

}  // namespace gatewalk::lattice
