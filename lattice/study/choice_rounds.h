// SPDX-License-Identifier: MIT
#pragma once
/// What plans, best starts and designs of fields have in common: rounds of choosing by a chain.
/// Trials in which the type of each cell is chosen when a body enters it fill a pool of runs. What
/// a chain of these runs thinks best is carried out in full beside the best so far, all with the
/// same trials. The trials of the winner are added to the pool, further trials try something else,
/// and so on until a round gains little or there are no more runs.

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/base/random.h"
#include "dynamics/base/work.h"
#include "lattice/field/field_trials.h"
#include "lattice/field/problem.h"
#include "lattice/pool/kernel.h"
#include "lattice/study/crossings.h"
#include "markov/decide.h"

namespace gatewalk::lattice {

/// Trials of `first` in cells of these types, and from these starts; with the noise that
/// field_trials of these numbers have.
[[nodiscard]] FieldTally chosen_trials(const dynamics::CellField& cells, const Problem& first,
                                       const TypeChoice& choice, std::uint64_t seed,
                                       dynamics::TrialRange range, FieldTrials& each);

/// Sizes of leaves to choose by, in those asked for: small ones tell ways to enter apart, large
/// ones know better what comes of each.
inline constexpr std::array<int, 3> kLeafSizes{1, 8, 64};
/// Bytes that decisions of all cells, states and gates may take.
inline constexpr double kMostDecisionBytes = 8.0e9;

/// What a trial is worth: 1 if it crosses the field (`rarely`: -1), less what it takes of a cost at
/// a price of each unit.
struct ChoiceAim {
  bool rarely = false;
  double price = 0.0;
  std::size_t cost = 0;  // by Section::costs

  /// Of all trials together.
  [[nodiscard]] double worth(const FieldTrials& trials) const;
  /// Sum of the squares of what each is worth.
  [[nodiscard]] double squares(const FieldTrials& trials) const;
};

/// The last round of choosing: what was carried out, all with the same trials.
template <class Candidate>
struct ChoiceRound {
  std::vector<Candidate> candidates;
  std::vector<RangeRuns> trials{};
  std::size_t winner = 0;
  bool settled = false;  // it gained little over the best before
};

/// The trials of a study one behind the other, with numbers that trials of a field do not have, and
/// the pool of those that it chooses by.
class ChoiceRounds {
 public:
  /// What is given outlives it. `study`: its name, for messages and kept pieces. `purpose`: of the
  /// stream that word() draws from. Other arguments as PlanOptions has them.
  ChoiceRounds(std::string study, dynamics::Purpose purpose, const dynamics::CellField& cells,
               const Problem& first, double accuracy, std::int64_t most_runs, std::uint64_t seed,
               const dynamics::Work& work);

  /// `choose()`: the candidates, by chains of the pool or without. `carry_out(candidate)`: the next
  /// count() trials of one. `explore(winner)`: trials that try something else beside it, for the
  /// next round. `known`: more candidates of the first round, the best before it last; without
  /// any, one round alone never settles. Of several that are worth the same the first wins.
  template <class Candidate>
  [[nodiscard]] ChoiceRound<Candidate> choose_best(const ChoiceAim& aim, const auto& choose,
                                                   const auto& carry_out, const auto& explore,
                                                   std::vector<Candidate> known = {}) {
    for (;;) {
      ChoiceRound<Candidate> round{choose()};
      const bool first_choice = known.empty();
      std::move(known.begin(), known.end(), std::back_inserter(round.candidates));
      ++summary_.rounds;
      std::vector<double> worth;
      const std::int64_t first = next_;
      for (const Candidate& candidate : round.candidates) {
        next_ = first;
        round.trials.push_back(carry_out(candidate));
        worth.push_back(aim.worth(round.trials.back().each));
      }
      const auto most = std::max_element(worth.begin(), worth.end());
      round.winner = static_cast<std::size_t>(most - worth.begin());
      const RangeRuns &winner = round.trials[round.winner], &before = round.trials.back();
      round.settled = !first_choice && is_little(*most - worth.back(),
                                                 aim.squares((aim.rarely ? before : winner).each));
      add(winner);
      if (round.settled || !has_runs_left()) return round;
      add(explore(round.candidates[round.winner]));
      known.clear();
      known.push_back(std::move(round.candidates[round.winner]));
    }
  }

  /// The next `count` trials. Throws std::runtime_error when a run broke.
  [[nodiscard]] RangeRuns run(const TypeChoice& choice, std::int64_t count);
  /// Trials of a candidate: so many that a chance of one half has an interval of twice the
  /// accuracy.
  [[nodiscard]] std::int64_t count() const { return count_; }
  [[nodiscard]] std::int64_t next() const { return next_; }
  /// The trials from that number on once more.
  void go_back_to(std::int64_t next) { next_ = next; }

  /// Into the pool. Of several runs of the same trials one only: a run that is twice in a leaf says
  /// nothing new.
  void add(const RangeRuns& trials);
  [[nodiscard]] const RunPool& pool() const { return pool_; }

  /// Chance that the noise of the trials knows nothing of.
  [[nodiscard]] std::uint64_t word(const Place& at, std::uint64_t what) const;
  /// Bodies do what is best, but something else in one of four cells.
  [[nodiscard]] CellChoice mostly(CellChoice best, CellChoice other) const;

  /// Whether a gain in count() trials is small beside the accuracy and beside chance, `squares` of
  /// an ChoiceAim. Rare crossings gain little of all trials, but much beside chance.
  [[nodiscard]] bool is_little(double gain, double squares) const;
  [[nodiscard]] bool has_runs_left() const { return summary_.gate_runs < most_runs_; }
  /// Of all trials and rounds so far.
  [[nodiscard]] ChoiceSummary summary(bool settled) const {
    return {summary_.rounds, settled, summary_.gate_runs, summary_.health};
  }

 private:
  std::string study_;
  dynamics::Purpose purpose_;
  const dynamics::CellField& cells_;
  const Problem& first_;
  double accuracy_;
  std::int64_t most_runs_;
  std::uint64_t seed_;
  const dynamics::Work& work_;
  std::int64_t count_;
  std::int64_t next_ = std::int64_t{1} << 50;
  RunPool pool_;
  ChoiceSummary summary_;
};

/// Of all trials together.
[[nodiscard]] double total_of(const FieldTrials& trials, std::size_t cost);
/// Numbers that values for each cell, state and number of cells passed take.
[[nodiscard]] double numbers_of(const FieldParams& field, const dynamics::StateSpace& space);
/// By type of cell.
[[nodiscard]] std::vector<markov::Chain> chains_of(const Kernel& kernel);
/// A walk that crosses the field gains 1.
[[nodiscard]] markov::Gains gain_of_crossing();
/// That what is named, such as "plan: values of", does not fit into memory.
[[nodiscard]] std::runtime_error too_large(const std::string& what);
/// Throws std::invalid_argument, whose message begins with the study's name.
void require_choice_options(const std::string& study, double accuracy, int per_leaf);

}  // namespace gatewalk::lattice
