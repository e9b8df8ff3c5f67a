// SPDX-License-Identifier: MIT
#include "lattice/study/cross_validation.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/base/share.h"
#include "lattice/field/gate_chain.h"
#include "lattice/field/running_trial.h"
#include "lattice/pool/kernel.h"
#include "lattice/pool/pooled_prediction.h"
#include "lattice/statistics/draws.h"
#include "lattice/study/field_walk.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;
using markov::Ending;
using markov::kEndings;

constexpr std::uint64_t kDealing = 0x68616c76'65730001, kSigns = 0x68616c76'65730002;  // "halves"

/// The observed part of a trial in the field.
struct SeenTrial {
  std::int32_t body = 0;
  Entering start{};
  std::optional<Ending> ending{};  // nullopt: not seen
  Entering last{};  // without an ending: the last entry seen; with one: only the cell counts
};

/// The trials of some bodies, which get new numbers; bodies without a number are left out.
RunPool pool_of_bodies(const RunPool& pool, const Section& section,
                       const std::vector<std::int32_t>& number) {
  RunPool half;
  const auto& [starts, trials] = pool.scattered;
  half.scattered.each.passages.begin(section);
  for (std::size_t i = 0; i < trials.passed.size(); ++i) {
    const std::int32_t body = number[static_cast<std::size_t>(trials.bodies[i])];
    if (body < 0) continue;
    half.scattered.starts.push_back(starts[i]);
    half.scattered.each.append(trials, i);
    half.scattered.each.bodies.back() = body;
  }
  return half;
}

/// The observed trials of a half, from the field's start cell.
std::vector<SeenTrial> seen_trials(const Problem& problem, const RunPool& half, Watched& watched) {
  const FieldParams& field = problem.field;
  const FieldTrials& trials = half.scattered.each;
  std::vector<SeenTrial> all;
  for (std::size_t i = 0; i < trials.passed.size(); ++i) {
    RunningTrial trial(field);
    const auto place = [&](const Entry& entry) {
      return Entering{std::int64_t{trial.row()} * field.columns + trial.column(), entry,
                      trial.passed()};
    };
    SeenTrial seen{trials.bodies[i], place(half.scattered.starts[i]), {}, {}};
    std::int64_t* why = &watched.unwatched;
    for (const CellPassage passage : trials.of_trial(i)) {
      if (passage.fate == Fate::broken) why = &watched.lost;
      if (passage.type != problem.map().type_of(trial.column(), trial.row()))
        why = &watched.other_type;
      if (why != &watched.unwatched) break;
      const auto next =
          trial.follow(problem.map(), field, {passage.fate, passage.entry, {}}, false);
      seen.last = place(next.value_or(Entry{}));
      if (!next) break;
    }
    seen.ending = trial.ending();
    if (trial.passed() == 0) {
      ++watched.left_out;
      continue;
    }
    ++watched.trials;
    ++(seen.ending ? watched.to_end : *why);
    all.push_back(seen);
  }
  return all;
}

/// The runs of each body of a half, by type, row and column of its chain.
struct BodyCounts {
  struct Count {
    int type, row, column;
  };
  std::vector<std::vector<Count>> of_body;
  std::vector<Eigen::VectorXd> runs;  // by type: number in each row
};

BodyCounts body_counts(const Problem& problem, const RunPool& half, const Kernel& kernel) {
  const FieldTrials& trials = half.scattered.each;
  const CellMap& map = problem.map();
  BodyCounts counts;
  counts.of_body.resize(static_cast<std::size_t>(half.bodies()));
  counts.runs.assign(map.types.size(), Eigen::VectorXd::Zero(kernel.space.size()));
  for (std::size_t i = 0; i < trials.passed.size(); ++i) {
    Entry entry = half.scattered.starts[i];
    for (const CellPassage passage : trials.of_trial(i)) {
      if (passage.fate == Fate::broken) break;
      kernel.each_count(map, entry, passage, [&](int row, int column) {
        counts.of_body[static_cast<std::size_t>(trials.bodies[i])].push_back(
            {passage.type, row, column});
        counts.runs[passage.type][row] += 1.0;
      });
      entry = passage.entry;
    }
  }
  return counts;
}

/// Calls use(leaf) for all leaves that share this row.
template <class Use>
void each_leaf(const Kernel& kernel, int type, int row, Use use) {
  use(row);
  if (kernel.shared_by.empty()) return;
  const std::vector<int>& first = kernel.shared_by[static_cast<std::size_t>(type)];
  for (int leaf = row + 1; leaf < std::ssize(first) && first[static_cast<std::size_t>(leaf)] == row;
       ++leaf)
    use(leaf);
}

/// The chain of the runs of both halves, with the states of one half's chain.
struct BothHalves {
  markov::FieldChain chain;
  std::vector<Eigen::VectorXd> runs;  // by type: number in each row
  double fitted = 0.0;  // rows / runs: the part of a run's own sampling error that its row contains
};

BothHalves both_halves(const Problem& problem, const Kernel& kernel, const BodyCounts& a,
                       const BodyCounts& b) {
  std::vector<markov::Chain> chains;
  std::vector<Eigen::VectorXd> runs;
  double rows = 0.0, all = 0.0;
  for (int type = 0; type < std::ssize(problem.map().types); ++type) {
    std::vector<Eigen::Triplet<std::int64_t>> entries;
    for (const BodyCounts* half : {&a, &b})
      for (const auto& body : half->of_body)
        for (const BodyCounts::Count& c : body)
          if (c.type == type)
            each_leaf(kernel, type, c.row,
                      [&](int leaf) { entries.emplace_back(leaf, c.column, 1); });
    markov::Counts counts(kernel.space.size(), kernel.space.size() + 1);
    counts.setFromTriplets(entries.begin(), entries.end());
    chains.push_back(markov::Chain::from_counts(counts, exits_of(kernel.space)));
    runs.push_back(a.runs[static_cast<std::size_t>(type)] + b.runs[static_cast<std::size_t>(type)]);
    rows += static_cast<double>((runs.back().array() > 0.0).count());
    all += runs.back().sum();
  }
  return {field_chain(problem.map(), std::move(chains)), std::move(runs), rows / all};
}

/// The chain of both halves, changed as one half's chain changes with the weight of one body: each
/// row moves by kStep times the body's runs minus the mean of all, over the half's runs. The step
/// is larger if the body has a large part in the row, because the row was fitted to the body too
/// (HC2 of MacKinnon and White, J. Econometrics 29, 1985).
constexpr double kStep = 1e-5;
markov::FieldChain with_more_of(const std::vector<BodyCounts::Count>& body, const BodyCounts& half,
                                const Kernel& kernel, const BothHalves& both) {
  std::vector<markov::Chain> chains;
  for (int type = 0; type < std::ssize(both.runs); ++type) {
    const auto& all = both.runs[static_cast<std::size_t>(type)];
    const auto& runs = half.runs[static_cast<std::size_t>(type)];
    Eigen::VectorXd own = Eigen::VectorXd::Zero(all.size());
    for (const auto& c : body)
      if (c.type == type) own[c.row] += 1.0;
    const auto step = [&](Eigen::Index row) {  // 0 if the body made all runs: then nothing changes
      return own[row] < all[row] ? kStep / (runs[row] * std::sqrt(1.0 - own[row] / all[row])) : 0.0;
    };
    const markov::Chain& chain = both.chain.chains()[static_cast<std::size_t>(type)];
    markov::Probabilities p = chain.matrix();
    for (int row = 0; row < p.rows(); ++row)
      if (own[row] > 0.0)
        each_leaf(kernel, type, row, [&](int leaf) {
          for (markov::Probabilities::InnerIterator it(p, leaf); it; ++it)
            it.valueRef() *= 1.0 - step(row) * own[row];
        });
    for (const auto& c : body)
      if (c.type == type)
        each_leaf(kernel, type, c.row,
                  [&](int leaf) { p.coeffRef(leaf, c.column) += step(c.row); });
    chains.push_back(markov::Chain::from_probabilities(std::move(p), chain.exits()));
  }
  return both.chain.with(std::move(chains));
}

/// One half: the bodies behind a chain, and the bodies to predict.
struct Half {
  RunPool pool;
  Watched watched{};
  std::vector<SeenTrial> trials{};
  int parts = 0;  // number of sets of bodies that share a sign
  [[nodiscard]] std::size_t part_of(std::size_t body) const {
    return body % static_cast<std::size_t>(parts);
  }
  [[nodiscard]] double share() const { return 1.0 / static_cast<double>(trials.size()); }
};

std::array<Half, 2> dealt_out(const Problem& problem, const RunPool& pool, std::uint64_t seed) {
  const auto bodies = static_cast<std::size_t>(pool.bodies());
  std::vector<std::size_t> order(bodies);
  std::iota(order.begin(), order.end(), 0);
  Random random(Purpose::comparison, {seed, kDealing, 0});
  for (std::size_t i = bodies; i > 1; --i)
    std::swap(order[i - 1],
              order[static_cast<std::size_t>(random.below(static_cast<std::int64_t>(i)))]);
  std::array<Half, 2> halves;
  for (std::size_t h = 0; h < 2; ++h) {
    const std::size_t begin = h == 0 ? 0 : bodies / 2, end = h == 0 ? bodies / 2 : bodies;
    std::vector<std::int32_t> number(bodies, -1);
    for (std::size_t i = begin; i < end; ++i)
      number[order[i]] = static_cast<std::int32_t>(i - begin);
    halves[h].pool = pool_of_bodies(pool, problem.map().section, number);
    halves[h].trials = seen_trials(problem, halves[h].pool, halves[h].watched);
    halves[h].parts = static_cast<int>(std::min<std::size_t>(kMostParts, end - begin));
    if (halves[h].trials.empty())
      throw std::invalid_argument(
          "validate: one half of the bodies has no passage that the field could have");
  }
  return halves;
}

/// Shares of all trials, with the sampling error over bodies, as an effective number of trials.
EndingShares shares_by_bodies(const Eigen::MatrixXd& by_body, const Eigen::VectorXd& trials,
                              std::int64_t passages) {
  const auto bodies = static_cast<double>(by_body.cols());
  const Eigen::VectorXd mean = by_body.rowwise().sum() / trials.sum();
  std::array<double, kEndings> shares{};
  for (std::size_t e = 0; e < kEndings; ++e)
    shares[e] = std::clamp(mean[static_cast<Eigen::Index>(e)], 0.0, 1.0);
  EndingShares result(shares);
  for (std::size_t e = 0; e < kEndings; ++e) {
    const double share = shares[e];
    const Eigen::VectorXd off =
        by_body.row(static_cast<Eigen::Index>(e)).transpose() - share * trials;
    const double variance =
        off.squaredNorm() / (trials.sum() * trials.sum()) * bodies / (bodies - 1.0);
    const double like =
        variance > kShareRounding * kShareRounding ? share * (1.0 - share) / variance : bodies;
    result.interval[e] = interval_of_share(share, std::min(like, static_cast<double>(passages)));
  }
  return result;
}

/// The observations of a body: starts of its trials, last entries of the trials that were not seen
/// to end, and for all others where and how they ended, as shares of the half's trials.
struct SeenBody {
  std::vector<Entering> starts, last;
  Eigen::VectorXd ended;
};

std::vector<SeenBody> seen_bodies(const Half& half, const FieldWalk& walk) {
  std::vector<SeenBody> bodies(static_cast<std::size_t>(half.pool.bodies()),
                               {{}, {}, walk.no_ends()});
  for (const SeenTrial& t : half.trials) {
    SeenBody& body = bodies[static_cast<std::size_t>(t.body)];
    body.starts.push_back(t.start);
    if (t.ending)
      walk.end(body.ended, t.last.cell, *t.ending, half.share());
    else
      body.last.push_back(t.last);
  }
  return bodies;
}

/// Where and how the bodies of a half end: (numbers x bodies).
struct EndsByBody {
  Eigen::MatrixXd seen;       // observed, continued by the chain of the other half
  Eigen::MatrixXd predicted;  // by that chain, from the same starts
  Eigen::MatrixXd excess;     // observed minus predicted, both by the chain of both halves
  std::vector<double> gates;  // visited, as predicted
};

EndsByBody ends_by_body(const std::vector<SeenBody>& bodies, double share, const FieldWalk& walk,
                        const markov::FieldChain& chain, const markov::FieldChain& both) {
  const Eigen::MatrixXd none(walk.no_ends().size(), std::ssize(bodies));
  EndsByBody ends{none, none, none, std::vector<double>(bodies.size())};
  tbb::parallel_for(std::size_t{0}, bodies.size(), [&](std::size_t b) {
    const auto column = static_cast<Eigen::Index>(b);
    const SeenBody& body = bodies[b];
    const Walked from_start = walk.walk(chain, body.starts, share);
    ends.predicted.col(column) = from_start.ends;
    ends.gates[b] = from_start.gates;
    ends.seen.col(column) = body.ended + walk.walk(chain, body.last, share).ends;
    ends.excess.col(column) = body.ended + walk.walk(both, body.last, share).ends -
                              walk.walk(both, body.starts, share).ends;
  });
  return ends;
}

/// The contributions of the bodies of both halves to the difference of a fold: (numbers x parts).
struct Difference {
  Eigen::VectorXd seen_less_chain;
  Eigen::MatrixXd seen;   // of the observed half: observed minus predicted
  Eigen::MatrixXd chain;  // of the chain's half
};

Eigen::MatrixXd parts_of_seen(const Eigen::MatrixXd& excess, const Half& half, double fitted) {
  Eigen::MatrixXd parts = Eigen::MatrixXd::Zero(excess.rows(), half.parts);
  for (Eigen::Index b = 0; b < excess.cols(); ++b)
    parts.col(static_cast<Eigen::Index>(half.part_of(static_cast<std::size_t>(b)))) +=
        excess.col(b) / std::sqrt(1.0 - fitted);
  return parts;
}

/// Change of the difference with the weight of each part of the chain's half, `counts`.
Eigen::MatrixXd parts_of_chain(const std::vector<SeenBody>& bodies, double share,
                               const FieldWalk& walk, const Half& chain_half,
                               const BodyCounts& counts, const Kernel& kernel,
                               const BothHalves& both) {
  std::vector<Entering> entering;
  std::vector<double> weights;
  for (const SeenBody& body : bodies)
    for (const auto* places : {&body.last, &body.starts}) {
      entering.insert(entering.end(), places->begin(), places->end());
      weights.resize(entering.size(), places == &body.last ? share : -share);
    }
  std::vector<std::vector<BodyCounts::Count>> of_part(static_cast<std::size_t>(chain_half.parts));
  for (std::size_t b = 0; b < counts.of_body.size(); ++b) {
    auto& part = of_part[chain_half.part_of(b)];
    part.insert(part.end(), counts.of_body[b].begin(), counts.of_body[b].end());
  }
  const Eigen::VectorXd as_it_is = walk.walk(both.chain, entering, weights).ends;
  Eigen::MatrixXd parts(as_it_is.size(), chain_half.parts);
  tbb::parallel_for(std::size_t{0}, of_part.size(), [&](std::size_t part) {
    const auto more = with_more_of(of_part[part], counts, kernel, both);
    parts.col(static_cast<Eigen::Index>(part)) =
        (walk.walk(more, entering, weights).ends - as_it_is) / kStep;
  });
  return parts;
}

/// Predictions of the groups of the chain's half, from the starts of the observed half.
std::vector<markov::FinalDistribution> group_predictions(const Problem& problem, const Half& half,
                                                         const Half& chain_half, int per_leaf) {
  std::vector<Entering> starts;
  for (const SeenTrial& t : half.trials) starts.push_back(t.start);
  std::vector<markov::FinalDistribution> groups(kTrialGroups);
  tbb::parallel_for(0, kTrialGroups, [&](int g) {
    const Kernel kernel = kernel_of(problem.map(), chain_half.pool, per_leaf, {g, kTrialGroups});
    const FieldWalk walk(problem.field, kernel.space);
    groups[static_cast<std::size_t>(g)] = distribution_of(
        walk.walk(chain_of(kernel, problem.map(), problem.field, {}), starts, half.share()),
        problem.field);
  });
  return groups;
}

/// Adds the observations of a half; intervals include the sampling error over its bodies.
void add_seen(Fold& fold, const Half& half, const Eigen::MatrixXd& seen, const FieldParams& field) {
  const Eigen::VectorXd all = seen.rowwise().sum();
  Eigen::VectorXd trials = Eigen::VectorXd::Zero(seen.cols());
  for (const SeenTrial& t : half.trials) trials[t.body] += half.share();
  fold.seen_gates = Eigen::Map<const CellProbabilities>(all.data(), field.rows, field.columns);
  fold.seen = shares_by_bodies(seen.bottomRows(kEndings), trials, half.pool.gate_runs())
                  .with_limit(field.max_gates);
}

/// Adds the chain's prediction from the same starts, with its own error bars.
void add_prediction(Fold& fold, const EndsByBody& ends,
                    const std::vector<markov::FinalDistribution>& groups, int coordinates,
                    std::uint64_t seed, const FieldParams& field) {
  Walked all{ends.predicted.rowwise().sum()};
  all.gates = std::accumulate(ends.gates.begin(), ends.gates.end(), 0.0);
  fold.chain = distribution_of(all, field);
  const GroupSpread spread(fold.chain, groups, coordinates);
  fold.chain_error = spread.error(fold.chain_bodies, seed);
  fold.chain_endings = spread.endings_95(fold.chain_bodies).with_limit(field.max_gates);
}

/// `half` as observed, against the chain of `chain_half`.
Fold fold_of(const Problem& problem, const Half& half, const Half& chain_half,
             const CrossValidationOptions& options, Difference& difference) {
  const Kernel kernel = kernel_of(problem.map(), chain_half.pool, options.per_leaf);
  const markov::FieldChain chain = chain_of(kernel, problem.map(), problem.field, {});
  const FieldWalk walk(problem.field, kernel.space);
  const BodyCounts counts = body_counts(problem, chain_half.pool, kernel);
  const BothHalves both =
      both_halves(problem, kernel, counts, body_counts(problem, half.pool, kernel));
  const std::vector<SeenBody> bodies = seen_bodies(half, walk);
  const EndsByBody ends = ends_by_body(bodies, half.share(), walk, chain, both.chain);
  difference = {
      Eigen::VectorXd(ends.seen.rowwise().sum()) - Eigen::VectorXd(ends.predicted.rowwise().sum()),
      parts_of_seen(ends.excess, half, both.fitted),
      parts_of_chain(bodies, half.share(), walk, chain_half, counts, kernel, both)};
  Fold fold;
  fold.bodies = half.pool.bodies();
  fold.chain_bodies = chain_half.pool.bodies();
  fold.states = kernel.space.size();
  fold.watched = half.watched;
  add_seen(fold, half, ends.seen, problem.field);
  add_prediction(fold, ends, group_predictions(problem, half, chain_half, options.per_leaf),
                 dynamics::coordinates_cut(kernel.space), options.seed, problem.field);
  fold.corrcoef = corrcoef(fold.seen_gates, fold.chain.final_cells);
  fold.rmse_per_100 = rmse_per_100(fold.seen_gates, fold.chain.final_cells);
  return fold;
}

constexpr std::size_t kOfOneFold = 1 + kEndings;  // number of statistics

/// Total variation of the final gates, then the difference of each ending.
void add_statistics(std::vector<double>& all, const Eigen::VectorXd& difference) {
  const auto exact = [](double x) { return x > kShareRounding ? x : 0.0; };
  const auto endings = static_cast<Eigen::Index>(kEndings);
  all.push_back(exact(0.5 * difference.head(difference.size() - endings).cwiseAbs().sum()));
  for (Eigen::Index e = 0; e < endings; ++e)
    all.push_back(exact(std::abs(difference[difference.size() - endings + e])));
}

/// Endings that hardly any trial of a half has, or nearly all, both in the observations and by the
/// chain: too few bodies show their sampling error. The null draws counts of both halves instead,
/// as if all trials were independent.
struct RareEnding {
  Eigen::Index ending;
  double share;
};

std::vector<RareEnding> rare_endings(const std::array<Half, 2>& halves, const CrossValidation& v) {
  constexpr double kFewTrials = 5.0;  // trials per half
  const auto n = static_cast<double>(halves[0].trials.size() + halves[1].trials.size());
  std::vector<RareEnding> rare;
  for (std::size_t e = 0; e < kEndings; ++e) {
    double count = 0.0;
    for (std::size_t h = 0; h < 2; ++h)  // fold f has half 1 - f as observed
      count += 0.5 * (v.folds[1 - h].seen.share[e] + v.folds[1 - h].chain.endings[e]) *
               static_cast<double>(halves[h].trials.size());
    if (count > kShareRounding && n - count > kShareRounding &&
        0.5 * std::min(count, n - count) < kFewTrials)
      rare.push_back({static_cast<Eigen::Index>(e), (count + 0.5) / (n + 1.0)});
  }
  return rare;
}

/// A null draw of the difference of an ending's shares in fold 0, which is minus that in fold 1.
double drawn_difference(const RareEnding& rare, const std::array<Half, 2>& halves, Random& random) {
  std::array<double, 2> seen{};
  for (std::size_t h = 0; h < 2; ++h) {
    const auto trials = std::ssize(halves[h].trials);
    seen[h] =
        static_cast<double>(binomial(trials, rare.share, random)) / static_cast<double>(trials);
  }
  return seen[1] - seen[0];
}

/// Null draws: statistics of both folds for each draw, and each fold's comparisons.
struct Chance {
  std::vector<double> statistics{};  // (draws x 2 kOfOneFold)
  std::array<std::vector<double>, 2> corrcoefs{}, rmses{};
};

/// Draws the null: multiplies each part by +1 or -1 at random.
Chance chance_in(const CrossValidation& v, const std::array<Half, 2>& halves,
                 const std::array<Difference, 2>& differences, std::uint64_t seed) {
  Chance chance;
  const std::vector<RareEnding> rare = rare_endings(halves, v);
  for (std::int64_t k = 0; k < v.null_draws; ++k) {
    Random random(Purpose::comparison, {seed, kSigns, static_cast<std::uint64_t>(k)});
    const std::array<Eigen::VectorXd, 2> signs{random_signs(halves[0].parts, random),
                                               random_signs(halves[1].parts, random)};
    std::array<Eigen::VectorXd, 2> drawn;
    for (std::size_t f = 0; f < 2; ++f)
      drawn[f] = differences[f].seen * signs[1 - f] + differences[f].chain * signs[f];
    for (const RareEnding& r : rare) {
      const double difference = drawn_difference(r, halves, random);
      const Eigen::Index at = drawn[0].size() - static_cast<Eigen::Index>(kEndings) + r.ending;
      drawn[0][at] = difference;
      drawn[1][at] = -difference;
    }
    for (std::size_t f = 0; f < 2; ++f) {
      add_statistics(chance.statistics, drawn[f]);
      const CellProbabilities& chain = v.folds[f].chain.final_cells;
      const CellProbabilities seen =
          chain + Eigen::Map<const CellProbabilities>(drawn[f].data(), chain.rows(), chain.cols());
      if (const double c = corrcoef(seen, chain); std::isfinite(c))
        chance.corrcoefs[f].push_back(c);
      chance.rmses[f].push_back(rmse_per_100(seen, chain));
    }
  }
  return chance;
}

void judge(CrossValidation& v, const std::array<Difference, 2>& differences, Chance chance) {
  for (const Difference& d : differences) add_statistics(chance.statistics, d.seen_less_chain);
  const MultipleTests judged(chance.statistics, 2 * kOfOneFold);
  v.p = judged.p;
  for (std::size_t f = 0; f < 2; ++f) {
    Fold& fold = v.folds[f];
    const auto drawn = [&](std::size_t statistic) {
      std::vector<double> values;
      for (std::int64_t k = 0; k < v.null_draws; ++k)
        values.push_back(
            chance.statistics[(static_cast<std::size_t>(k) * 2 + f) * kOfOneFold + statistic]);
      return mean_and_95(std::move(values));
    };
    fold.total_variation = judged.tests[f * kOfOneFold];
    std::tie(fold.chance_total_variation, fold.chance_total_variation_95) = drawn(0);
    for (std::size_t e = 0; e < kEndings; ++e) {
      fold.endings[e] = judged.tests[f * kOfOneFold + 1 + e];
      fold.chance_95[e] = drawn(1 + e).second;
    }
    fold.chance_corrcoef =
        chance.corrcoefs[f].empty() ? std::nan("") : mean_and_95(chance.corrcoefs[f]).first;
    fold.chance_rmse_per_100 = mean_and_95(chance.rmses[f]).first;
  }
}

}  // namespace

CrossValidation cross_validate(const Problem& problem, const RunPool& pool,
                               const CrossValidationOptions& options, const Work& work) {
  if (pool.bodies() < 2 * kLeastBodies)
    throw std::invalid_argument("validate: two halves need " + std::to_string(2 * kLeastBodies) +
                                " bodies at least, these are " + std::to_string(pool.bodies()));
  CrossValidation v;
  const std::array<Half, 2> halves = dealt_out(problem, pool, options.seed);
  std::array<Difference, 2> differences;
  for (std::size_t f = 0; f < 2; ++f) {
    work.tell("halves", static_cast<std::int64_t>(f), 2);
    v.folds[f] = fold_of(problem, halves[1 - f], halves[f], options, differences[f]);
  }
  const std::int64_t numbers = differences[0].seen.rows(),
                     signs = halves[0].parts + std::int64_t{halves[1].parts};
  v.null_draws = options.null_draws.value_or(
      std::clamp<std::int64_t>(1'000'000'000 / (2 * numbers * signs), 999, 1999));
  judge(v, differences, chance_in(v, halves, differences, options.seed));
  return v;
}

}  // namespace gatewalk::lattice
