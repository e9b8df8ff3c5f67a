// SPDX-License-Identifier: MIT
#pragma once
/// The scene file, in TOML: everything that a run depends on. Every key is optional.

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
/// Gates of several types in one field: table [terrain] of the scene file.
struct Terrain {
  /// A key whose value in a gate type differs from the scene's.
  struct Key {
    std::string name;  // "forces.propulsion_N"
    double value = 0.0;
    std::string origin;  // where the value was given, for messages
  };
  struct Type {
    std::string name;  // letters, digits and _; begins with a letter
    std::vector<Key> keys;
  };
  std::string own{kOwnGate};  // name of the scene's own gate
  std::vector<Type> types;    // in the order of their names
  /// (rows x columns), the near row first. 0: the scene's own gate, i: types[i - 1].
  std::vector<int> type_of_cell;
  std::map<std::string, double> shares{};  // shares of a map drawn at random; empty for a given map
  std::uint64_t seed = 1;                  // of a map drawn at random
};

/// A key and the values of a sweep for that key: "4:1:9" (from:step:to) or "300,400,500".
struct Variation {
  std::string key, values;
  std::string origin;  // how a message about this variation begins
};

/// Bin edges of every face, as StateSpace takes them.
using SceneBins = std::vector<dynamics::Bins>;

/// All keys of a scene file, checked and in SI units.
struct Scene {
  dynamics::GateParams gate;
  FieldParams field;
  dynamics::BodyState start{0.0, 0.0, 0.0, 15.0};  // m, m, m/s, m/s; in the first gate's frame
  std::string source;                              // the file it came from, for messages
  std::map<std::string, std::string, std::less<>> named;  // keys that the user gave, and where
  std::set<std::string, std::less<>>
      derived;  // keys computed from `named`; all other keys have the paper's values
  std::vector<Variation> sweep;    // table [sweep], in the order of the file
  std::optional<SceneBins> bins;   // table [bins], the states of the chain
  std::optional<Terrain> terrain;  // table [terrain], gates of other types
  /// Table [actions]: each action of a body, as the gate keys that the action changes.
  std::vector<Terrain::Type> actions;
};

/// A scene that cannot be used. what() reads "scenes/x.toml:12: forces.random_N = -3 is not
/// permitted: must lie in [0, 1e+06] N"; it begins "--set forces.random_N=-3: " if the value came
/// from an override.
class SceneError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Reads the file `path` (-: standard input) and applies `overrides`. Each override is
/// "forces.random_N=20", with a TOML value after the first '=' (text may stand without quotes); the
/// last override of a key wins. Throws SceneError.
[[nodiscard]] Scene read_scene(const std::string& path, const std::vector<std::string>& overrides);
/// Reads a scene from text in memory; `name` stands for the file in messages. Throws SceneError.
[[nodiscard]] Scene parse_scene(std::string_view text, std::string name,
                                const std::vector<std::string>& overrides = {});

/// One key of a scene with its value, unit, permitted range and meaning, as text for a reader.
struct KeyInfo {
  std::string key, value;  // the value as TOML writes it
  std::string unit;        // "N m/rad", empty for a pure number
  std::string range, meaning;
  std::string source;  // "x.toml:12", "--set ...", "derived" or "paper"
};
/// Every key of the scene, in the order of to_toml; then the keys of [terrain], without its map,
/// and of [actions].
[[nodiscard]] std::vector<KeyInfo> describe(const Scene& scene);
/// The complete scene as TOML, every key in a fixed order, without [sweep]. Numbers have the digits
/// that read back as the same number.
[[nodiscard]] std::string to_toml(const Scene& scene);
}  // namespace gatewalk::lattice
