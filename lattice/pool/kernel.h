// SPDX-License-Identifier: MIT
#pragma once
/// The chain of pooled gate runs: counts between the leaves of trees grown over their entries, and
/// the first rows of starts.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "dynamics/cells/state_space.h"
#include "dynamics/cells/tree_space.h"
#include "dynamics/cells/words.h"
#include "lattice/field/gate_chain.h"
#include "lattice/pool/run_pool.h"

namespace gatewalk::lattice {

/// The mirror image of a passage.
[[nodiscard]] CellPassage mirrored(const dynamics::Section& section, CellPassage passage);

/// Calls use(entry, type of the gate) for all runs of the group's trials, except the starts' own
/// first runs and runs that broke.
void each_entry(const RunPool& pool, TrialGroup group,
                const std::function<void(const dynamics::Entry& entry, int type)>& use);

/// Where entries were seen: the smallest box around the entries of each set of neighbouring leaves
/// of a face. A box may include places between its leaves where no entry was seen.
struct SeenEntries {
  struct Box {
    std::array<double, dynamics::kMostCoordinates> low{}, high{};  // 0 after the last coordinate
    std::int64_t entries = 0;
  };
  std::vector<Box> boxes{};
  std::size_t coordinates = 0;

  SeenEntries() = default;
  /// Builds the boxes; state[i] is the state of entries[i].
  SeenEntries(const dynamics::StateSpace& space, const dynamics::EntryTable& entries,
              const std::vector<int>& state);
  [[nodiscard]] bool holds(std::size_t box, const dynamics::Entry& entry) const;
  /// Index in `boxes` of the box that a state belongs to.
  [[nodiscard]] static std::size_t place_of(const dynamics::StateSpace& space, int state);
};

/// Which labels of a chain with words (dynamics/cells/words.h) also count the runs of other words.
/// A label with fewer than 2 per_leaf runs in cells of a type takes those of all words with the
/// longest end of its own word that has enough.
class Borrowers {
 public:
  Borrowers() = default;  // without words: nobody borrows
  /// `runs`: by type and label.
  Borrowers(const dynamics::Section& section, const std::vector<std::vector<std::int64_t>>& runs,
            std::int64_t least);

  /// Calls use(from, passage) with the labels of each further word that counts this run.
  template <class Use>
  void each(const dynamics::Section& section, const dynamics::Entry& entry, const CellPassage& run,
            Use use) const {
    if (takers_.empty()) return;
    const dynamics::Words& words = *section.words;
    const int own = words.word_of(entry.face), face = words.face_of(entry.face);
    for (int end = own; end != dynamics::Words::kNone; end = words.shorter(end))
      for (const int word : takers_[run.type][static_cast<std::size_t>(words.label(face, end))]) {
        if (word == own) continue;
        dynamics::Entry from = entry;
        from.face = words.label(face, word);
        CellPassage passage = run;
        if (run.fate == dynamics::Fate::left)
          passage.entry.face = words.next_label(run.type, from, words.face_of(passage.entry.face));
        use(from, passage);
      }
  }

 private:
  std::vector<std::vector<std::vector<int>>>
      takers_;  // by type and label: words that take its runs
};

/// Transition counts between the leaves of trees; chain_of() adds the rows of starts. A leaf with
/// too few runs in gates of a type shares the row of all leaves in the smallest part of the tree
/// that has enough.
struct Kernel {
  dynamics::StateSpace space;
  std::vector<markov::Counts> counts;  // by gate type: (n x n+1), last column: trapped
  std::vector<SeenEntries> seen{};     // by gate type, for the kernel of all trials
  /// By gate type, if there are several: for each leaf (n), the first of the leaves that share its
  /// row.
  std::vector<std::vector<int>> shared_by{};
  Borrowers borrowers{};

  [[nodiscard]] std::int64_t nonzeros() const;  // over all types

  /// Calls use(row, column) for each count that a run through a cell makes, with its mirror image.
  template <class Use>
  void each_count(const dynamics::CellMap& map, const dynamics::Entry& entry,
                  const CellPassage& run, Use use) const {
    const auto count = [&](const dynamics::Entry& from, const CellPassage& passage) {
      const auto state = static_cast<std::size_t>(space.index_of(from).state);
      use(shared_by.empty() ? static_cast<int>(state) : shared_by[run.type][state],
          passage.fate == dynamics::Fate::trapped ? space.trapped()
                                                  : space.index_of(passage.entry).state);
    };
    const auto count_all = [&](const dynamics::Entry& from, const CellPassage& passage) {
      count(from, passage);
      borrowers.each(map.section, from, passage, count);
    };
    count_all(entry, run);
    if (map.types[run.type].symmetric)
      count_all(mirrored(map.section, entry), mirrored(map.section, run));
  }
};

/// Number of runs behind the rows of kernels.
[[nodiscard]] std::int64_t kernel_runs(const RunPool& pool);

/// Counts the runs of one group of the trials, except the starts' own first runs and runs that
/// broke. In symmetric cells a run counts twice, with its mirror image. Leaves are larger than
/// `per_leaf` if there would be more than kMostStates. With several types of cells, leaves with
/// fewer than `per_row` runs of a type (default: as many as a leaf has) share their row of that
/// type, and words with fewer than twice as many borrow runs.
[[nodiscard]] Kernel kernel_of(const dynamics::CellMap& map, const RunPool& pool,
                               int per_leaf = dynamics::kEntriesPerLeaf, TrialGroup group = {},
                               std::optional<int> per_row = {});

/// Sums of the costs of the runs behind each of the kernel's counts: by type, in the order of the
/// nonzeros.
[[nodiscard]] std::vector<std::vector<dynamics::CostSums>> cost_sums(const Kernel& kernel,
                                                                     const dynamics::CellMap& map,
                                                                     const RunPool& pool,
                                                                     TrialGroup group = {});

/// Counts the runs of all trials through cells of one type, from the states of one space (rows) to
/// the outputs of another, with mirror images in symmetric cells.
[[nodiscard]] markov::Counts counts_between(const dynamics::StateSpace& rows,
                                            const dynamics::StateSpace& outputs,
                                            const dynamics::CellMap& map, const RunPool& pool,
                                            int type);

/// Joins leaves into the smallest parts of the trees with at least `least` runs each; runs[i]
/// belongs to leaf i. Returns for each leaf the first leaf of its part.
[[nodiscard]] std::vector<int> joined_leaves(const dynamics::StateSpace& space,
                                             const std::vector<std::int64_t>& runs,
                                             std::int64_t least);

/// Counts how the first runs from each start, in a cell of this type, ended (starts x n+1 outputs).
/// The runs are those of one group of the trials, or of several groups, one after the other with a
/// row per start. A start in the middle of a symmetric cell also counts mirror images.
[[nodiscard]] markov::Counts first_rows(const Kernel& kernel, const dynamics::CellMap& map,
                                        const RunPool& pool, const std::vector<FirstRow>& starts,
                                        int type,
                                        const std::vector<TrialGroup>& groups = {TrialGroup{}});

/// Sums of the costs of one start's first runs, in the order of its row's nonzeros; `sums`:
/// cost_sums of the kernel.
[[nodiscard]] std::vector<dynamics::CostSums> first_cost_sums(
    const Kernel& kernel, const std::vector<std::vector<dynamics::CostSums>>& sums,
    const dynamics::CellMap& map, const RunPool& pool, const FirstRow& start, int type,
    TrialGroup group = {});

/// Missing mass: the share of the start's first runs that enter the next gate of the field where no
/// run of the kernel did, minus the share expected by chance. For these runs the kernel's rows are
/// a guess.
[[nodiscard]] double missing_mass(const Kernel& kernel, const dynamics::CellMap& map,
                                  const FieldParams& field, const OwnRuns& start);

/// The chain of the kernel's rows, followed by `first_rows`, which no state leads to: rows of the
/// gate in which trials start.
[[nodiscard]] markov::FieldChain chain_of(const Kernel& kernel, const dynamics::CellMap& map,
                                          const FieldParams& field,
                                          const markov::Counts& first_rows);

/// The kernel and the first rows as one matrix per cell type, with the starts as states of their
/// own.
[[nodiscard]] std::vector<dynamics::Transitions> transitions_of(
    const Kernel& kernel, const dynamics::CellMap& map, const FieldParams& field,
    const std::vector<dynamics::Entry>& starts, const markov::Counts& first_rows);

}  // namespace gatewalk::lattice
