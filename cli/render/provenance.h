// SPDX-License-Identifier: MIT
#pragma once
/// Where a result came from.

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cli/fields/fields.h"

namespace gatewalk::cli {

/// What gives the same result again: the program adds its version and commit.
struct Provenance {
  std::string command;
  std::optional<std::uint64_t> seed;
  std::optional<std::string> scene;            // the whole scene as TOML
  std::set<std::string, std::less<>> derived;  // keys that the scene left out
  /// The files of a run's parts, with which part each is; none of a run in one.
  std::vector<std::pair<std::string, std::string>> parts{};
  std::optional<std::string> cell{};  // what describes the cells of a recorded run, as TOML
};

/// The keys of "made_by".
void describe(Fields& out, const Provenance& provenance);
/// The key "made_by", which all results have.
void describe_made_by(Fields& out, const Provenance& provenance);
/// The same keys with their values as text: attributes of NetCDF files.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> attributes_of(
    const Provenance& provenance);

/// "AMD EPYC, 2 cores": what times were measured on.
[[nodiscard]] std::string machine();

}  // namespace gatewalk::cli
