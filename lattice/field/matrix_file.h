// SPDX-License-Identifier: MIT
#pragma once
/// A matrix on disk with everything that it came from, and the names of its states.

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/cells/section.h"
#include "dynamics/cells/transitions.h"
#include "markov/formats/counts.h"

namespace gatewalk::lattice {

/// A matrix on disk: counts, trials and clamped crossings of every row, the state space, and `text`
/// (scene, seed, version, command, ...).
struct MatrixFile {
  dynamics::Transitions transitions;
  std::map<std::string, std::string> text{};
  std::vector<markov::NamedArray> arrays{};              // beside those of the state space
  std::map<std::string, dynamics::Transitions> types{};  // of other gates in the field, by name
  std::vector<std::string> state_names{};  // (n + 1), of a chain that was made elsewhere; else none
};

/// A name for each of the n + 1 outputs: face and number from 0, "EN_0"; the last one "trapped".
[[nodiscard]] std::vector<std::string> state_names(const dynamics::StateSpace& space);
/// Those of a file: its own ones, if it has any.
[[nodiscard]] std::vector<std::string> state_names(const MatrixFile& file);
/// Gives a file's states names of their own, (n + 1). Where its arrays have kNumberOfState, that is
/// their order in the table that they come from. Throws std::invalid_argument for another array of
/// that name.
void name_states(MatrixFile& file, std::vector<std::string> names);
inline constexpr const char* kNumberOfState = "number_of_state";
/// A state that the file names, by its name or its number in the table that names it; none where
/// there is none.
[[nodiscard]] std::optional<dynamics::Entry> named_state(const MatrixFile& file,
                                                         const std::string& text);
/// By state, how many counts a run of such a file makes in its row; empty where nothing says so.
/// Then neighbouring rows that are equal are the same runs, as in the matrices of trees that say
/// it.
[[nodiscard]] std::vector<std::int64_t> counts_per_run(const MatrixFile& file);
inline constexpr const char* kCountsPerRun = "counts_per_run";
/// A state's number in the order in which results show states: that of the table that a chain from
/// elsewhere was made of; else, and of "trapped", its own.
[[nodiscard]] int shown_number(const dynamics::StateSpace& space, int state);
/// The states in that order.
[[nodiscard]] std::vector<int> shown_order(const dynamics::StateSpace& space);

/// What readers of a file's counts must know of those of trees, where mirror images are counted;
/// empty where there is nothing.
[[nodiscard]] std::string comment_on_counts(const dynamics::CellMap& map,
                                            const dynamics::StateSpace& space);
/// The key of a file's text that has it.
inline constexpr const char* kCommentText = "comment";

/// As markov::write_counts. Of a file that is given away its arrays, which may be large, are moved.
void write_matrix(const std::string& path, const MatrixFile& file);
void write_matrix(const std::string& path, MatrixFile&& file);

/// The section of a file's cells, by its texts.
using SectionOf = std::function<dynamics::Section(const std::map<std::string, std::string>& text)>;
/// As markov::read_counts; throws markov::BadFile also when the bins or exits are not those of the
/// section's state space.
[[nodiscard]] MatrixFile read_matrix(const std::string& path, const SectionOf& section_of);

}  // namespace gatewalk::lattice
