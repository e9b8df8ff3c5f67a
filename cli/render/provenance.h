// SPDX-License-Identifier: MIT
#pragma once
/// Where a result comes from.

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cli/fields/fields.h"

namespace gatewalk::cli {

/// What is needed to compute the result again. The output adds the program's version and commit.
struct Provenance {
  std::string command;
  std::optional<std::uint64_t> seed;
  std::optional<std::string> scene;            // the whole scene as TOML
  std::set<std::string, std::less<>> derived;  // keys that the scene left out
  /// The files of a divided run, each with its part; empty for an undivided run.
  std::vector<std::pair<std::string, std::string>> parts{};
  std::optional<std::string> cell{};  // the cells of a recorded run, as TOML
};

/// The keys of "made_by".
void describe(Fields& out, const Provenance& provenance);
/// The key "made_by", which all results have.
void describe_made_by(Fields& out, const Provenance& provenance);
/// The keys of "made_by" with their values as text, for attributes of NetCDF files.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> attributes_of(
    const Provenance& provenance);

/// The machine on which times were measured: "AMD EPYC, 2 cores".
[[nodiscard]] std::string machine();

}  // namespace gatewalk::cli
