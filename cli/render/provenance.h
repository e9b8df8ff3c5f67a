#pragma once
/// Where a result came from.

#include <cstdint>
#include <optional>
#include <set>
#include <string>

#include "cli/render/json_fwd.h"

namespace gatewalk::cli {

/// What gives the same result again: the program adds its version and commit.
struct Provenance {
  std::string command;
  std::optional<std::uint64_t> seed;
  std::optional<std::string> scene;            // the whole scene as TOML
  std::set<std::string, std::less<>> derived;  // keys that the scene left out
};

/// {"program", "version", "commit", "command", ...}
[[nodiscard]] Json to_json(const Provenance& provenance);

/// "AMD EPYC, 2 cores": what times were measured on.
[[nodiscard]] std::string machine();

}  // namespace gatewalk::cli
