// SPDX-License-Identifier: MIT
#pragma once
/// The scene file: everything a run depends on, in TOML, every key optional.

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "dynamics/cells/state_space.h"
#include "dynamics/disc/params.h"
#include "lattice/field/field_params.h"

namespace gatewalk::lattice {

inline constexpr std::string_view kOwnGate = ".";
/// Gates of several types in one field: table [terrain].
struct Terrain {
  /// A key that a type has otherwise than the scene.
  struct Key {
    std::string name;  // "forces.propulsion_N"
    double value = 0.0;
    std::string origin;  // where it was given
  };
  struct Type {
    std::string name;  // letters, digits and _, a letter first
    std::vector<Key> keys;
  };
  std::string own{kOwnGate};  // name of the scene's own gate
  std::vector<Type> types;    // by name
  /// (rows x columns), the near row first. 0: the scene's own gate, i: types[i - 1].
  std::vector<int> type_of_cell;
  std::map<std::string, double> shares{};  // of a map that is drawn; empty for one that is given
  std::uint64_t seed = 1;                  // of that map
};

/// A key and the values that a sweep gives it: "4:1:9" (from:step:to) or "300,400,500".
struct Variation {
  std::string key, values;
  std::string origin;  // how a message about it begins
};

/// Bin edges of every boundary, as StateSpace takes them.
using SceneBins = std::vector<dynamics::Bins>;

struct Scene {
  dynamics::GateParams gate;
  FieldParams field;
  dynamics::BodyState start{0.0, 0.0, 0.0, 15.0};  // m, m, m/s, m/s; in the first gate's frame
  std::string source;                              // the file it came from
  std::map<std::string, std::string, std::less<>> named;  // keys the user gave, and where
  std::set<std::string, std::less<>>
      derived;                     // keys that follow from those; the rest are the paper's
  std::vector<Variation> sweep;    // table [sweep], in the order of the file
  std::optional<SceneBins> bins;   // table [bins], the chain's states
  std::optional<Terrain> terrain;  // table [terrain], gates of other types
  /// Table [actions]: what a body may do, the gates as they are then.
  std::vector<Terrain::Type> actions;
};

/// A scene that cannot be used. what() reads
/// "scenes/x.toml:12: forces.random_N = -3 is not permitted: must lie in [0, 1e+06] N",
/// or begins "--set forces.random_N=-3: " when the value came from an override.
class SceneError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Reads `path` (-: standard input) and applies `overrides`, each "forces.random_N=20" with a TOML
/// value behind the first '=' (text may stand without quotes); the last one of a key wins. Throws
/// SceneError.
[[nodiscard]] Scene read_scene(const std::string& path, const std::vector<std::string>& overrides);
/// The same of text already in memory; `name` stands for the file in messages.
[[nodiscard]] Scene parse_scene(std::string_view text, std::string name,
                                const std::vector<std::string>& overrides = {});

/// One key as a reader sees it.
struct KeyInfo {
  std::string key, value;  // the value as TOML has it
  std::string unit;        // "N m/rad", empty for a pure number
  std::string range, meaning;
  std::string source;  // "x.toml:12", "--set ...", "derived" or "paper"
};
/// Every key of the scene, in the order of to_toml; then those of [terrain], but no map, and of
/// [actions].
[[nodiscard]] std::vector<KeyInfo> describe(const Scene& scene);
/// The complete scene, every key in a fixed order, but no sweep; numbers with the digits that read
/// back the same.
[[nodiscard]] std::string to_toml(const Scene& scene);
}  // namespace gatewalk::lattice
