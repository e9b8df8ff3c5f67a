// SPDX-License-Identifier: MIT
#pragma once
/// A scene whose numbers vary, each over a range.

#include <string>
#include <vector>

#include "lattice/scene/scene.h"
#include "lattice/scene/toml_file.h"

namespace gatewalk::lattice {

/// The range of one key, in the unit of the key's spelling.
struct NumberRange {
  std::string key;
  double low = 0.0, high = 0.0;

  /// The value at a share of the range: 0 the low end, 1 the high end.
  [[nodiscard]] double at(double share) const { return low + share * (high - low); }
};

/// Reads "KEY=LOW:HIGH"; `option` begins messages. Throws SceneError.
[[nodiscard]] NumberRange range_in(const std::string& given, const std::string& option);

/// A scene file with ranges of values for some of its keys.
class RangedScene {
 public:
  /// `file` with its overrides, and `ranges`, each "KEY=LOW:HIGH"; `option` begins messages about
  /// ranges ("--over"). Throws SceneError for what cannot be read, a key that is varied twice or
  /// overridden, and ranges in which the scene is not permitted at some end or at one point within.
  RangedScene(TomlFile file, std::vector<std::string> overrides,
              const std::vector<std::string>& ranges, std::string option);
  [[nodiscard]] const std::vector<NumberRange>& ranges() const { return ranges_; }
  /// The scene at a point of the unit cube: 0 the low end of a range, 1 the high end. Throws
  /// SceneError.
  [[nodiscard]] Scene at(const std::vector<double>& point) const;

 private:
  void add(const std::string& given);

  TomlFile file_;
  std::vector<std::string> overrides_;
  std::vector<NumberRange> ranges_;
  std::string option_;
};

}  // namespace gatewalk::lattice
