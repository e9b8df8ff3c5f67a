// SPDX-License-Identifier: MIT
#pragma once
/// Rounds of choosing by a chain, which plans, best starts and designs of fields share. Trials in
/// which each cell's type is chosen on entry fill a pool of runs. The best candidates by a chain of
/// these runs are run as full trials beside the best so far, all with the same trial numbers. The
/// winner's trials join the pool, further trials explore alternatives, and so on until a round
/// gains little or the runs are used up.

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

/// Runs trials of the problem `first` in cells of these types, from these starts; trials have the
/// noise that field_trials gives to their numbers.
[[nodiscard]] FieldTally chosen_trials(const dynamics::CellField& cells, const Problem& first,
                                       const TypeChoice& choice, std::uint64_t seed,
                                       dynamics::TrialRange range, FieldTrials& each);

/// Leaf sizes of the chains, in multiples of the size asked for: small leaves separate ways of
/// entering, large leaves have less sampling error.
inline constexpr std::array<int, 3> kLeafSizes{1, 8, 64};
/// Limit of memory for the decisions of all cells, states and gates, in bytes.
inline constexpr double kMostDecisionBytes = 8.0e9;

/// The worth of a trial: 1 if it crosses the field (`rarely`: -1), minus `price` times its cost.
struct ChoiceAim {
  bool rarely = false;
  double price = 0.0;
  std::size_t cost = 0;  // by Section::costs

  /// Sum over all trials.
  [[nodiscard]] double worth(const FieldTrials& trials) const;
  /// Sum of the squares over all trials.
  [[nodiscard]] double squares(const FieldTrials& trials) const;
};

/// The last round of choosing: the candidates, all run with the same trial numbers.
template <class Candidate>
struct ChoiceRound {
  std::vector<Candidate> candidates;
  std::vector<RangeRuns> trials{};
  std::size_t winner = 0;
  bool settled = false;  // the gain over the best before was small
};

/// Runs the trials of a study in sequence, with numbers that trials of a field do not have, and
/// keeps the pool that the study chooses with.
class ChoiceRounds {
 public:
  /// All references must outlive the object. `study`: name for messages and kept pieces; `purpose`:
  /// of the stream of word(). Other arguments are as in PlanOptions.
  ChoiceRounds(std::string study, dynamics::Purpose purpose, const dynamics::CellField& cells,
               const Problem& first, double accuracy, std::int64_t most_runs, std::uint64_t seed,
               const dynamics::Work& work);

  /// Runs rounds until one gains little or the runs are used up. `choose()` returns candidates,
  /// from chains of the pool or without; `carry_out(candidate)` runs its next count() trials;
  /// `explore(winner)` runs trials of alternatives for the next round. `known`: more candidates for
  /// the first round, the best before in last place; without any, a single round never settles.
  /// Among equals the first candidate wins.
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

  /// Runs the next `count` trials. Throws std::runtime_error if a run broke.
  [[nodiscard]] RangeRuns run(const TypeChoice& choice, std::int64_t count);
  /// Number of trials per candidate, so that a probability of 1/2 has an interval of twice the
  /// accuracy.
  [[nodiscard]] std::int64_t count() const { return count_; }
  [[nodiscard]] std::int64_t next() const { return next_; }
  /// Repeats the trial numbers from `next` on.
  void go_back_to(std::int64_t next) { next_ = next; }

  /// Adds trials to the pool. Of runs that several candidates share, only one is added: a run that
  /// is twice in a leaf adds no information.
  void add(const RangeRuns& trials);
  [[nodiscard]] const RunPool& pool() const { return pool_; }

  /// Random word that is independent of the trials' noise.
  [[nodiscard]] std::uint64_t word(const Place& at, std::uint64_t what) const;
  /// The best choice, except in one of four cells, where bodies choose otherwise.
  [[nodiscard]] CellChoice mostly(CellChoice best, CellChoice other) const;

  /// True if a gain in count() trials is small compared with the accuracy and with sampling error;
  /// `squares` as in ChoiceAim. Gains of rare crossings are small in number, but large compared
  /// with sampling error.
  [[nodiscard]] bool is_little(double gain, double squares) const;
  [[nodiscard]] bool has_runs_left() const { return summary_.gate_runs < most_runs_; }
  /// Summary of all trials and rounds so far.
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

/// A cost summed over all trials.
[[nodiscard]] double total_of(const FieldTrials& trials, std::size_t cost);
/// Number of values for each cell, state and number of cells passed.
[[nodiscard]] double numbers_of(const FieldParams& field, const dynamics::StateSpace& space);
/// The kernel's chains, by type of cell.
[[nodiscard]] std::vector<markov::Chain> chains_of(const Kernel& kernel);
/// Gains of walks: crossing the field gains 1.
[[nodiscard]] markov::Gains gain_of_crossing();
/// The error that something, such as "plan: values of", does not fit into memory.
[[nodiscard]] std::runtime_error too_large(const std::string& what);
/// Throws std::invalid_argument for invalid options; the message begins with the study's name.
void require_choice_options(const std::string& study, double accuracy, int per_leaf);

}  // namespace gatewalk::lattice
