// SPDX-License-Identifier: MIT
#pragma once
/// A matrix file: counts of transitions, the state space, and everything that both came from.

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/cells/section.h"
#include "dynamics/cells/transitions.h"
#include "markov/formats/counts.h"

namespace gatewalk::lattice {

/// A matrix file in memory: counts, trials and clamped crossings of every row, the state space, and
/// `text` (scene, seed, version, command, ...).
struct MatrixFile {
  dynamics::Transitions transitions;
  std::map<std::string, std::string> text{};
  std::vector<markov::NamedArray> arrays{};  // other than those of the state space
  /// Matrices of the field's other gate types, by name.
  std::map<std::string, dynamics::Transitions> types{};
  std::vector<std::string> state_names{};  // (n + 1), of an imported chain; else empty
};

/// Names of the n + 1 outputs: face and number from 0, "EN_0"; the last one is "trapped".
[[nodiscard]] std::vector<std::string> state_names(const dynamics::StateSpace& space);
/// Names of a file's outputs: the file's own names if it has any, else by face and number.
[[nodiscard]] std::vector<std::string> state_names(const MatrixFile& file);
/// Gives a file's n + 1 outputs names of their own. If the file has an array kNumberOfState, this
/// array has the states' order in the table that the chain was imported from. Throws
/// std::invalid_argument if that array does not number the states from 0.
void name_states(MatrixFile& file, std::vector<std::string> names);
inline constexpr const char* kNumberOfState = "number_of_state";
/// The entry of a named state of the file, found by the state's name or its number in the imported
/// table; nullopt if no state matches.
[[nodiscard]] std::optional<dynamics::Entry> named_state(const MatrixFile& file,
                                                         const std::string& text);
/// By state, how many counts each run adds to the state's row (1, or 2 with its mirror image);
/// empty if the file does not say. In files that say so, equal neighbouring rows are the same runs,
/// as in matrices of trees.
[[nodiscard]] std::vector<std::int64_t> counts_per_run(const MatrixFile& file);
inline constexpr const char* kCountsPerRun = "counts_per_run";
/// A state's number in the order in which results list states: the order of an imported chain's
/// table; otherwise, and for "trapped", the state's own number.
[[nodiscard]] int shown_number(const dynamics::StateSpace& space, int state);
/// All states in the order in which results list them.
[[nodiscard]] std::vector<int> shown_order(const dynamics::StateSpace& space);

/// What readers of a file's counts must know if mirror images are counted (chains of trees in
/// symmetric gates); else empty.
[[nodiscard]] std::string comment_on_counts(const dynamics::CellMap& map,
                                            const dynamics::StateSpace& space);
/// The key of comment_on_counts() in a file's text.
inline constexpr const char* kCommentText = "comment";

/// Writes a matrix file, as markov::write_counts. The second form moves the file's arrays, which
/// may be large.
void write_matrix(const std::string& path, const MatrixFile& file);
void write_matrix(const std::string& path, MatrixFile&& file);

/// Returns the section of a file's cells, from the file's texts.
using SectionOf = std::function<dynamics::Section(const std::map<std::string, std::string>& text)>;
/// Reads a matrix file, as markov::read_counts. Also throws markov::BadFile if the bins or exits
/// are not those of the section's state space.
[[nodiscard]] MatrixFile read_matrix(const std::string& path, const SectionOf& section_of);

}  // namespace gatewalk::lattice
