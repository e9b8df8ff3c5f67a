// SPDX-License-Identifier: MIT
#include "lattice/scene/study/chain_answers.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "lattice/field/gate_chain.h"
#include "lattice/statistics/matrix_noise.h"
#include "markov/predict.h"
#include "markov/walk.h"

namespace gatewalk::lattice {
namespace {

using dynamics::Transitions;
using dynamics::Work;

double square(double x) { return x * x; }

/// What every matrix has to predict.
struct Questions {
  markov::Field field;
  int max_gates = 0;
  std::vector<markov::Start> starts;
  const std::vector<FieldTruth>& truths;  // by start
  std::uint64_t seed = 1;

  [[nodiscard]] CellProbabilities prediction(const markov::Predictor& p, std::size_t start) const {
    return p.predict(field, starts[start], {.max_cells = max_gates}).final_cells;
  }
};

/// The prediction of one matrix from one start.
struct Said {
  CellProbabilities exact;
  ChainAnswer answer;
};

/// A matrix made ready for predictions, and the time that took.
class Asked {
 public:
  explicit Asked(const Transitions& matrix) {
    std::optional<markov::Chain> chain;
    freezing_seconds_ = one_thread_seconds([&] {
      chain = make_chain(matrix);
      predictor_.emplace(*chain);
    });
    table_seconds_ = one_thread_seconds([&] { walker_.emplace(*chain); });
  }
  [[nodiscard]] double freezing_seconds() const { return freezing_seconds_; }

  [[nodiscard]] Said about(const Questions& q, std::size_t start) const {
    const CellProbabilities& truth = q.truths[start].p;
    ChainAnswer a;
    markov::FinalDistribution f;
    a.exact_seconds = one_thread_seconds(
        [&] { f = predictor_->predict(q.field, q.starts[start], {.max_cells = q.max_gates}); });
    a.exact = error_of(f.final_cells, truth);
    a.never_sampled = f.unsampled();
    for (std::size_t w = 0; w < kChainWalks.size(); ++w) {
      markov::WalkTally walked;
      a.walk_seconds[w] = table_seconds_ + one_thread_seconds([&] {
                            walked = walker_->walk(q.field, q.starts[start], q.max_gates, q.seed,
                                                   {0, kChainWalks[w]});
                          });
      a.walks[w] = error_of(shares(walked.final_cells), truth);
    }
    return {std::move(f.final_cells), a};
  }

 private:
  std::optional<markov::Predictor> predictor_;
  std::optional<markov::Walker> walker_;
  double freezing_seconds_ = 0.0, table_seconds_ = 0.0;
};

/// By start: the mean total variation between predictions of resampled matrices and of the matrices
/// that they are resampled from. `said`: by matrix, then start.
std::vector<double> sampling_of(const std::vector<Transitions>& matrices, const Questions& q,
                                const std::vector<std::vector<Said>>& said, const Work& work) {
  std::vector<std::optional<markov::Predictor>> others(kMatricesDrawnAnew);
  tbb::parallel_for(std::int64_t{0}, kMatricesDrawnAnew, [&](std::int64_t k) {
    const Transitions& t = matrices[k % matrices.size()];
    others[k].emplace(markov::Chain::from_counts(
        resampled(t.counts(), q.seed, static_cast<std::uint64_t>(k)), exits_of(t.space)));
  });
  std::vector<double> sampling(q.starts.size(), 0.0), moved(kMatricesDrawnAnew);
  for (std::size_t s = 0; s < q.starts.size(); ++s) {
    work.tell("matrices drawn anew", static_cast<std::int64_t>(s), std::ssize(q.starts));
    tbb::parallel_for(std::int64_t{0}, kMatricesDrawnAnew, [&](std::int64_t k) {
      moved[k] = total_variation(q.prediction(*others[k], s), said[k % matrices.size()][s].exact);
    });
    for (const double tv : moved) sampling[s] += tv / static_cast<double>(kMatricesDrawnAnew);
  }
  return sampling;
}

/// The mean of the matrices' predictions from one start; times are those of the first matrix.
ChainAnswer mean_answer(const std::vector<std::vector<Said>>& said, std::size_t start,
                        const FieldTruth& truth, double sampling) {
  const auto n = static_cast<double>(said.size());
  ChainAnswer a{.exact_seconds = said[0][start].answer.exact_seconds,
                .walk_seconds = said[0][start].answer.walk_seconds,
                .sampling = sampling};
  CellProbabilities mean = CellProbabilities::Zero(truth.p.rows(), truth.p.cols());
  for (const auto& by_matrix : said) {
    const Said& one = by_matrix[start];
    mean += one.exact / n;
    add_to_mean(a.exact, one.answer.exact, n);
    a.never_sampled += one.answer.never_sampled / n;
    for (std::size_t w = 0; w < kChainWalks.size(); ++w)
      add_to_mean(a.walks[w], one.answer.walks[w], n);
  }
  double squares = 0.0;
  for (const auto& by_matrix : said)
    squares += square(by_matrix[start].answer.exact.total_variation - a.exact.total_variation);
  a.exact_sd = std::sqrt(squares / (n - 1.0));  // 0/0 for one matrix
  // Squares of independent errors add up: those of the matrices, of the truth, and the systematic
  // rest.
  a.bins = std::sqrt(std::max(0.0, square(total_variation(mean, truth.p)) - square(sampling) / n -
                                       square(truth.floor.total_variation)));
  return a;
}

}  // namespace

FinalGateError error_of(const CellProbabilities& p, const CellProbabilities& truth) {
  return {total_variation(p, truth), corrcoef(p, truth)};
}

void add_to_mean(FinalGateError& mean, const FinalGateError& e, double n) {
  mean.total_variation += e.total_variation / n;
  mean.corrcoef += e.corrcoef / n;
}

std::int64_t FieldTruth::as_against_exact(std::int64_t trials) const {
  const auto n = static_cast<double>(trials), all = static_cast<double>(tally.trials);
  return std::max<std::int64_t>(1, std::llround(n * all / (n + all)));
}

double FieldTruth::seconds_for(double total_variation) const {
  const std::int64_t alone = trials_for(p, total_variation);
  if (alone >= tally.trials) return std::numeric_limits<double>::infinity();
  const auto n = static_cast<double>(alone), all = static_cast<double>(tally.trials);
  return seconds_per_trial * n * all / (all - n);
}

FieldTruth field_truth(const dynamics::Entry& start, FieldTally tally, double seconds_per_trial) {
  if (tally.broken() > 0)
    throw std::runtime_error(std::to_string(tally.broken()) +
                             " trials of the full dynamics stopped being finite numbers: they are "
                             "no truth to compare with");
  FieldTruth t{start, std::move(tally)};
  t.p = shares(t.tally.final_cells);
  t.seconds_per_trial = seconds_per_trial;
  t.floor = {
      expected_total_variation(t.p, t.tally.trials),
      noise_floor(concentration(t.tally.final_cells), t.p.size(), t.tally.trials, 0).corrcoef};
  return t;
}

ChainAnswers ask_matrices(const std::vector<Transitions>& matrices, const FieldParams& field,
                          const std::vector<FieldTruth>& truths, std::uint64_t seed,
                          const Work& work) {
  Questions q{{field.columns, field.rows}, field.max_gates, {}, truths, seed};
  for (const FieldTruth& t : truths)
    q.starts.push_back(chain_start(matrices[0].space, field, t.start).start);

  // The first matrix runs alone, so that its times are undisturbed.
  const std::int64_t count = std::ssize(matrices);
  std::vector<std::optional<Asked>> asked(count);
  asked[0].emplace(matrices[0]);
  tbb::parallel_for(std::int64_t{1}, count, [&](std::int64_t k) { asked[k].emplace(matrices[k]); });
  std::vector<std::vector<Said>> said(count, std::vector<Said>(truths.size()));
  for (std::size_t s = 0; s < truths.size(); ++s) {
    work.tell("asking matrices", static_cast<std::int64_t>(s), std::ssize(truths));
    said[0][s] = asked[0]->about(q, s);
    tbb::parallel_for(std::int64_t{1}, count,
                      [&](std::int64_t k) { said[k][s] = asked[k]->about(q, s); });
  }
  const std::vector<double> sampling = sampling_of(matrices, q, said, work);

  ChainAnswers all{.matrices = count, .freezing_seconds = asked[0]->freezing_seconds()};
  for (const Transitions& t : matrices) {
    const Transitions::Totals total = t.totals();
    all.runs = total.runs;
    all.clamped_share += total.clamped_share() / static_cast<double>(count);
    all.rows_never_sampled += static_cast<double>(total.empty_rows) / static_cast<double>(count);
  }
  for (std::size_t s = 0; s < truths.size(); ++s)
    all.answers.push_back(mean_answer(said, s, truths[s], sampling[s]));
  return all;
}

}  // namespace gatewalk::lattice
