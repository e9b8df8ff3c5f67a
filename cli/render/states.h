// SPDX-License-Identifier: MIT
#pragma once
/// The states of a chain and how well they resolve a scene: as a matrix file records them, as part
/// of results, and in words.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "dynamics/disc/disc_section.h"
#include "lattice/pool/states_info.h"
#include "lattice/scene/bins.h"

namespace gatewalk::cli {

/// The record of states that are bins.
struct BinRecord {
  std::optional<double> factor{};  // bins per axis as a multiple of Table III's
  /// Number of states without an observed entry, if rows start from observed entries; nullopt if
  /// rows start anywhere in their bins.
  std::optional<std::int64_t> rows_without_entries{};
  std::int64_t pilot_trials = 0;
  dynamics::Health pilot_health{};
  dynamics::Resolution resolution{};
};

/// The states of a chain, as the attribute "state_space" of a matrix file records them.
struct StateRecord : lattice::StatesInfo {
  int states = 0;
  bool are_open = false;                                 // the outermost bins
  dynamics::Section section = dynamics::disc_section();  // of the starts
  std::vector<dynamics::Entry> starts{};                 // starts that are states of their own
  std::optional<BinRecord> bins{};
};
[[nodiscard]] StateRecord record_of(const lattice::States& states);
[[nodiscard]] StateRecord record_of(const lattice::TreeChain& chain, double accuracy);
/// Reads the attribute of a file of cells with this section. Throws Json::exception and
/// std::invalid_argument for a damaged attribute.
[[nodiscard]] StateRecord state_record(const std::string& attribute,
                                       const dynamics::Section& section);
/// The states as an attribute.
[[nodiscard]] std::string attribute_of(const StateRecord& states);

/// The keys of "state_space".
void describe(Fields& out, const StateRecord& states);
/// The key "state_space", in results about one chain.
void describe_state_space(Fields& out, const StateRecord& states);
/// A line of a table, or several.
[[nodiscard]] std::string states_line(const StateRecord& states);
/// Sentences on what is wrong with states: too little of what was observed is resolved, or a pilot
/// from which rows start showed faults.
[[nodiscard]] std::vector<std::string> complaints(const lattice::States& states);

}  // namespace gatewalk::cli
