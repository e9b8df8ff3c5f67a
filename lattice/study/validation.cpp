// SPDX-License-Identifier: MIT
#include "lattice/study/validation.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <stdexcept>

#include "dynamics/base/kept_pieces.h"
#include "dynamics/cells/transitions.h"
#include "lattice/field/exits.h"
#include "lattice/field/gate_chain.h"
#include "lattice/field/running_trial.h"
#include "lattice/statistics/matrix_noise.h"
#include "lattice/study/memory.h"
#include "lattice/study/observed.h"

namespace gatewalk::lattice {
namespace {

using dynamics::Stopwatch;
using dynamics::TrialRange;

/// Fills a PaperSized from final gates in the order of the trials, which arrive in pieces of any
/// size; keeps at most one block.
class BlocksOf100 {
 public:
  /// `walks_of(first, count)` returns the final cells of these walks.
  using Walks = std::function<std::vector<std::int32_t>(std::int64_t first, std::int64_t count)>;
  BlocksOf100(const markov::CellProbabilities& exact, std::int64_t walks, Walks walks_of)
      : exact_(exact), walks_(walks), walks_of_(std::move(walks_of)) {}

  void add(const std::vector<std::int32_t>& dynamics) {
    for (const std::int32_t cell : dynamics) {
      waiting_.push_back(cell);
      if (waiting_.size() == kBlock) finish_block();
    }
  }
  [[nodiscard]] const PaperSized& result() const { return result_; }

 private:
  static constexpr std::size_t kBlock = 100;

  [[nodiscard]] markov::CellProbabilities shares(const std::vector<std::int32_t>& cells) const {
    markov::CellProbabilities p = markov::CellProbabilities::Zero(exact_.rows(), exact_.cols());
    for (const std::int32_t cell : cells) p.data()[cell] += 1.0 / kBlock;
    return p;
  }
  void finish_block() {
    const auto seen = shares(waiting_);
    const double corr = corrcoef(seen, exact_), rmse = rmse_per_100(seen, exact_);
    result_.exact_corrcoef.add(corr);
    result_.exact_rmse.add(rmse);
    result_.exact_products += corr * rmse;
    if (done_ + static_cast<std::int64_t>(kBlock) <= walks_) {
      const auto walked = shares(walks_of_(done_, kBlock));
      result_.walks_corrcoef.add(corrcoef(seen, walked));
      result_.walks_rmse.add(rmse_per_100(seen, walked));
    }
    done_ += kBlock;
    waiting_.clear();
  }

  const markov::CellProbabilities& exact_;
  std::int64_t walks_, done_ = 0;  // done_: number of trials in finished blocks
  Walks walks_of_;
  std::vector<std::int32_t> waiting_;
  PaperSized result_;
};

/// What all starts share.
struct Setup {
  const Problem& problem;
  const dynamics::StateSpace& space;
  const std::vector<int> same;  // by state of all types: the first state with the same runs
  const ValidationOptions& options;
  std::int64_t walks;
  CountedField gates;
  markov::Predictor predictor;
  markov::Walker walker;
  const dynamics::Work& work;

  [[nodiscard]] markov::Field field() const { return {problem.field.columns, problem.field.rows}; }
};

/// Predictions from resampled matrices, (starts x replicates); fewer for large fields, which take
/// time and memory.
Replicates resampled_predictions(const Setup& setup, const std::vector<markov::Start>& starts) {
  constexpr std::int64_t kMost = 999, kTogether = 8, kMostNumbers = 25'000'000;
  const markov::Field field = setup.field();
  const int max_gates = setup.problem.field.max_gates;
  const std::int64_t numbers = std::int64_t{field.columns} * field.rows * std::ssize(starts);
  const std::int64_t count =
      std::max(kLeastReplicates, affordable_replicates(setup.gates, field, max_gates,
                                                       std::min(kMost, kMostNumbers / numbers)));
  Replicates all{std::vector<std::vector<markov::FinalDistribution>>(starts.size()), {}};
  setup.work.in_pieces(
      "resampled matrices", (count + kTogether - 1) / kTogether, [&](TrialRange batches) {
        const std::int64_t begin = batches.first * kTogether;
        Replicates some =
            replicate_predictions(setup.gates, field, starts, max_gates, setup.options.seed, begin,
                                  std::min(batches.count * kTogether, count - begin));
        all.left_out += some.left_out;
        for (std::size_t k = 0; k < starts.size(); ++k)
          std::move(some.predictions[k].begin(), some.predictions[k].end(),
                    std::back_inserter(all.predictions[k]));
      });
  if (all.left_out.too_many())
    throw std::runtime_error(std::to_string(all.left_out.matrices) + " of " +
                             std::to_string(count) +
                             " resampled matrices fail: " + all.left_out.why);
  return all;
}

struct TimedWalks {
  markov::WalkTally tally;
  double seconds = 0.0;
};

TimedWalks walk(const Setup& setup, const markov::Start& start) {
  TimedWalks walked;
  const Stopwatch watch;
  setup.work.in_pieces("walks", setup.walks, [&](TrialRange range) {
    walked.tally += setup.walker.walk(setup.field(), start, setup.problem.field.max_gates,
                                      setup.options.seed, {range.first, range.count});
  });
  walked.seconds = watch.seconds();
  return walked;
}

struct TimedTrials {
  RunTrials trials;  // `each` only for the study of the force
  PaperSized paper_sized{};
  double seconds = 0.0;
};

/// Runs the full trials; adds their walks through the states to `remembered`.
TimedTrials run_trials(const Setup& setup, const dynamics::Entry& start, const markov::Start& place,
                       const markov::FinalDistribution& exact, StateWalks& remembered) {
  TimedTrials seen{{FieldTally(setup.problem.field), {}}};
  BlocksOf100 blocks(exact.final_cells, setup.walks, [&](std::int64_t first, std::int64_t n) {
    std::vector<std::int32_t> cells;
    (void)setup.walker.walk(setup.field(), place, setup.problem.field.max_gates, setup.options.seed,
                            {first, n}, &cells);
    return cells;
  });
  std::int64_t taken = 0;
  in_kept_pieces(
      setup.work, {"full dynamics", {0, setup.options.trials}},
      RunTrials{FieldTally(setup.problem.field), {}},
      [&](TrialRange range) {
        const Stopwatch watch;
        FieldTrials each;
        each.keep_passages = range.first < kMostRemembered;
        FieldTally tally = run_field(setup.problem.cells, setup.problem.field, start,
                                     setup.options.seed, range, &each, &setup.space);
        seen.seconds += watch.seconds();
        return RunTrials{std::move(tally), std::move(each)};
      },
      [&](RunTrials piece) {
        FieldTrials& each = piece.each;
        seen.trials.tally += piece.tally;
        blocks.add(each.final_gates);
        if (setup.options.force_memory) seen.trials.each.append(each);
        each.passed.resize(
            std::clamp<std::int64_t>(kMostRemembered - taken, 0, std::ssize(each.passed)));
        taken += std::ssize(each.final_gates);
        add_walks(remembered, setup.space, place.input, each, setup.same);
      });
  seen.paper_sized = blocks.result();
  return seen;
}

/// Runs the same trials with the force drawn anew at crossings, and compares.
ForceMemory run_anew(const Setup& setup, const dynamics::Entry& start, const RunTrials& held) {
  RunTrials anew{FieldTally(setup.problem.field), {}};
  in_kept_pieces(
      setup.work, {"force drawn anew", {0, setup.options.trials}},
      RunTrials{FieldTally(setup.problem.field), {}},
      [&](TrialRange range) {
        FieldTrials each;
        FieldTally tally =
            run_field(setup.problem.cells, setup.problem.field, start, setup.options.seed, range,
                      &each, &setup.space, Memory::dropped);
        return RunTrials{std::move(tally), std::move(each)};
      },
      [&](const RunTrials& piece) {
        anew.tally += piece.tally;
        anew.each.append(piece.each);
      });
  if (setup.work.is_part()) return {};
  return force_memory(held, anew, setup.options.seed);
}

/// As many draws as fit a fixed amount of work, 999 to 9999: each draw permutes the trials and
/// multiplies with a matrix of gates x gates.
std::int64_t null_draws_for(const Setup& setup) {
  const std::int64_t cells = std::int64_t{setup.problem.field.columns} * setup.problem.field.rows;
  const std::int64_t gates = std::min<std::int64_t>(cells, kMostEnergyGates);
  return setup.options.null_draws.value_or(std::clamp<std::int64_t>(
      100'000'000 / (setup.options.trials + setup.walks + gates * gates / 8), 999, 9999));
}

/// Runs only the trials that belong to a part of a run.
void run_part(const Setup& setup, const std::vector<dynamics::Entry>& starts,
              StateWalks& remembered) {
  for (const dynamics::Entry& start : starts) {
    const markov::Start place = chain_start(setup.space, setup.problem.field, start).start;
    const markov::FinalDistribution exact =
        setup.predictor.predict(setup.field(), place, {.max_cells = setup.problem.field.max_gates});
    const TimedTrials seen = run_trials(setup, start, place, exact, remembered);
    if (setup.options.force_memory) (void)run_anew(setup, start, seen.trials);
  }
  setup.work.end_part();
}

StartValidation validate_start(const Setup& setup, const dynamics::Entry& start,
                               const std::vector<markov::FinalDistribution>& resampled,
                               StateWalks& remembered) {
  const int max_gates = setup.problem.field.max_gates;
  const ChainStart chain_start = lattice::chain_start(setup.space, setup.problem.field, start);
  const Stopwatch exact_watch;
  const markov::FinalDistribution exact =
      setup.predictor.predict(setup.field(), chain_start.start, {.max_cells = max_gates});
  const double exact_seconds = exact_watch.seconds();
  const TimedWalks walked = walk(setup, chain_start.start);
  const TimedTrials seen = run_trials(setup, start, chain_start.start, exact, remembered);

  const std::int64_t may_miss = setup.gates.runs_at(chain_start.start);
  MatrixNoise noise(exact, setup.gates.evidence_at(chain_start.start, setup.field(), max_gates));
  std::vector<ExitShares> resampled_exits;
  for (const markov::FinalDistribution& other : resampled) {
    noise.add(other);
    resampled_exits.push_back(exit_shares(other));
  }
  const EndingShares exact_endings(exact, noise, max_gates);
  const FieldTally& tally = seen.trials.tally;
  const markov::CellCounts& final_gates = tally.final_cells;
  const std::int64_t draws = null_draws_for(setup);
  const std::uint64_t seed = setup.options.seed;
  const double s = concentration(final_gates);
  return {
      .start = start,
      .chain_start = chain_start,
      .dynamics = tally,
      .walks = walked.tally,
      .exact = exact,
      .walks_against = compare(final_gates, walked.tally.final_cells, draws, seed),
      .exact_against = compare(final_gates, exact.final_cells, draws, seed),
      .paper_sized = seen.paper_sized,
      .floor_100_exact = noise_floor(s, exact.final_cells.size(), 100, 0),
      .floor_100_walks = noise_floor(s, exact.final_cells.size(), 100, 100),
      .joint_test =
          joint_test({final_gates, tally.endings}, exact, resampled, may_miss, draws, seed),
      .resampled = noise.replicates(),
      .matrix_noise_mean = noise.mean_total_variation(),
      .matrix_noise_sd = noise.sd_total_variation(),
      .dynamics_endings = EndingShares(tally.endings, tally.trials).with_limit(max_gates),
      .walks_endings = EndingShares(walked.tally.endings, walked.tally.walks).with_limit(max_gates),
      .exact_endings = exact_endings,
      .dynamics_exits = exits_of(tally),
      .exact_exits =
          within_sides(exits_of(exit_shares(exact), resampled_exits, noise.from()), exact_endings),
      .dynamics_seconds = seen.seconds,
      .walks_seconds = walked.seconds,
      .exact_seconds = exact_seconds,
      .force = setup.options.force_memory
                   ? std::make_shared<const ForceMemory>(run_anew(setup, start, seen.trials))
                   : nullptr,
      .observed = setup.options.observed
                      ? std::make_shared<const ObservedComparison>(
                            compare_observed(*setup.options.observed, max_gates, tally, exact,
                                             resampled, may_miss, draws, seed))
                      : nullptr};
}

/// By state, with those of all types numbered consecutively: the first state with the same runs.
std::vector<int> same_states(const std::vector<dynamics::Transitions>& matrices) {
  std::vector<int> same;
  for (const dynamics::Transitions& t : matrices)
    for (int row = 0; row < t.space.size(); ++row)
      same.push_back(t.space.has_trees() && row > 0 && t.rows[row] == t.rows[row - 1]
                         ? same.back()
                         : static_cast<int>(same.size()));
  return same;
}

}  // namespace

Finding finding_of(bool differs, double total_variation, double floor_95) {
  if (differs) return Finding::own_error;
  return total_variation <= floor_95 ? Finding::within_trials : Finding::within_trials_and_matrix;
}

bool Validation::remembers() const { return memory && memory->remembers(); }

Validation validate_chain(const Problem& problem,
                          const std::vector<dynamics::Transitions>& matrices,
                          const std::vector<dynamics::Entry>& starts,
                          const ValidationOptions& options, const dynamics::Work& work) {
  if (options.trials < 1 || options.walks.value_or(1) < 1)
    throw std::invalid_argument("validate: needs a trial and a walk at least");
  if (options.observed && starts.size() != 1)
    throw std::invalid_argument("validate: an experiment belongs to one start");
  constexpr std::int64_t kMostGates = 100'000;
  if (std::int64_t{problem.field.columns} * problem.field.rows > kMostGates)
    throw std::invalid_argument("validate compares fields of up to " + std::to_string(kMostGates) +
                                " gates; field.columns = " + std::to_string(problem.field.columns) +
                                " and field.rows = " + std::to_string(problem.field.rows));
  const dynamics::CellMap& map = problem.map();
  if (matrices.size() != map.types.size())
    throw std::invalid_argument("validate: needs a matrix for each type of gate");
  const dynamics::StateSpace& space = matrices.front().space;
  const markov::FieldChain chain = make_chain(map, matrices);
  const Setup setup{problem,
                    space,
                    matrices.size() > 1 ? same_states(matrices) : std::vector<int>{},
                    options,
                    options.walks.value_or(options.trials),
                    counted_field(map, matrices),
                    markov::Predictor(chain),
                    markov::Walker(chain),
                    work};
  std::vector<markov::Start> places;
  for (const dynamics::Entry& start : starts)
    places.push_back(chain_start(space, problem.field, start).start);
  Validation v{.trials = options.trials, .walks = setup.walks, .starts = {}, .health = {}};
  for (const dynamics::Transitions& t : matrices) v.health += t.health;
  StateWalks remembered = no_walks(space, matrices.size());
  if (work.is_part()) run_part(setup, starts, remembered);
  Replicates resampled = resampled_predictions(setup, places);
  v.left_out = std::move(resampled.left_out);
  for (std::size_t k = 0; k < starts.size(); ++k) {
    v.starts.push_back(validate_start(setup, starts[k], resampled.predictions[k], remembered));
    const FieldTally& d = v.starts.back().dynamics;
    v.health += d.health;
    for (std::size_t f = 0; f < d.entries.size(); ++f) {
      v.entries += d.entries[f];
      v.clamped += d.clamped[f];
      v.entries_by[f] += d.entries[f];
    }
  }
  v.memory =
      std::make_shared<const MemoryStudy>(study_memory(remembered, space,
                                                       {.null_draws = options.null_draws,
                                                        .seed = options.seed,
                                                        .start_row = problem.field.start_row},
                                                       work));
  v.threads = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return v;
}

}  // namespace gatewalk::lattice
