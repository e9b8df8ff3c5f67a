// SPDX-License-Identifier: MIT
#include "lattice/study/halves.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/base/share.h"
#include "lattice/gate_chain.h"
#include "lattice/pool/pooled_prediction.h"
#include "lattice/statistics/draws.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;
using markov::Ending;
using markov::kEndings;

constexpr std::uint64_t kDealing = 0x68616c76'65730001, kSigns = 0x68616c76'65730002;  // "halves"

/// Bodies that are about to walk from here, in the field's cell `cell`.
struct Entering {
  std::int64_t cell = 0;
  Entry entry{};
  int gates = 0;  // visited before
};

/// What a trial was seen to do in the field.
struct SeenTrial {
  std::int32_t body = 0;
  Entering start{};
  std::optional<Ending> ending{};  // none: not seen
  Entering last{};                 // without an ending: where watching ended; else its cell alone
};

/// The trials of some bodies, which are numbered anew; those without a number are left out.
RunPool pool_of_bodies(const RunPool& pool, const Section& section,
                       const std::vector<std::int32_t>& number) {
  RunPool half;
  const FieldTrials& from = pool.scattered.each;
  FieldTrials& to = half.scattered.each;
  to.passages.begin(section);
  for (std::size_t i = 0; i < from.passed.size(); ++i) {
    const std::int32_t body = number[static_cast<std::size_t>(from.bodies[i])];
    if (body < 0) continue;
    half.scattered.starts.push_back(pool.scattered.starts[i]);
    to.bodies.push_back(body);
    for (const CellPassage passage : from.of_trial(i)) to.passages.push_back(passage);
    to.passed.push_back(std::ssize(to.passages));
  }
  return half;
}

/// As far as they were seen, from the field's start cell.
std::vector<SeenTrial> seen_trials(const Problem& problem, const RunPool& half, SeenSoFar& so_far) {
  const FieldParams& field = problem.field;
  const FieldTrials& trials = half.scattered.each;
  std::vector<SeenTrial> all;
  for (std::size_t i = 0; i < trials.passed.size(); ++i) {
    std::int64_t column = field.start_column(), row = 0;
    const auto cell = [&] { return row * field.columns + column; };
    SeenTrial seen{trials.bodies[i], {cell(), half.scattered.starts[i], 0}, {}, {}};
    Entering at = seen.start;
    std::int64_t* why = &so_far.unwatched;
    for (const CellPassage passage : trials.of_trial(i)) {
      if (passage.fate == Fate::broken) why = &so_far.lost;
      if (passage.type != problem.map().type_of(static_cast<int>(column), static_cast<int>(row)))
        why = &so_far.other_type;
      if (why != &so_far.unwatched) break;
      ++at.gates;
      seen.ending = markov::follow({field.columns, field.rows},
                                   exit_of(problem.map().section, passage.fate, passage.entry),
                                   at.gates == field.max_gates, column, row);
      at.cell = cell();
      if (seen.ending) break;
      at.entry = passage.entry;
    }
    if (at.gates == 0) {
      ++so_far.left_out;
      continue;
    }
    ++so_far.trials;
    ++(seen.ending ? so_far.to_end : *why);
    seen.last = at;
    all.push_back(seen);
  }
  return all;
}

/// Where bodies end: final gates, then endings.
using Ends = Eigen::VectorXd;

struct Walked {
  Ends ends;
  double gates = 0.0, remainder = 0.0;  // visited; left walking
};

/// Many bodies at once by the chain, each from where it enters, until they end in the field.
class FieldWalk {
 public:
  FieldWalk(const FieldParams& field, const StateSpace& space) : field_(field), space_(space) {
    constexpr std::int64_t kMostNumbers = 100'000'000;
    if (cells() * space.size() > kMostNumbers)
      throw std::invalid_argument("validate: " + std::to_string(cells()) + " cells times " +
                                  std::to_string(space.size()) + " states are more than " +
                                  std::to_string(kMostNumbers));
  }

  [[nodiscard]] std::int64_t cells() const { return std::int64_t{field_.columns} * field_.rows; }
  [[nodiscard]] Ends no_ends() const {
    return Ends::Zero(cells() + static_cast<Eigen::Index>(kEndings));
  }
  void end(Ends& ends, std::int64_t cell, Ending ending, double mass) const {
    ends[cell] += mass;
    ends[cells() + static_cast<Eigen::Index>(ending)] += mass;
  }

  /// `weights`: of each.
  [[nodiscard]] Walked walk(const markov::FieldChain& chain, const std::vector<Entering>& entering,
                            const std::vector<double>& weights) const {
    const std::int64_t inputs = space_.size();
    const bool limited = field_.max_gates > 0;
    std::vector<std::size_t> order(entering.size());
    std::iota(order.begin(), order.end(), 0);
    if (limited)  // without a limit it does not matter how many were visited
      std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return entering[a].gates < entering[b].gates;
      });
    Walked walked{no_ends()};
    std::vector<double> here(static_cast<std::size_t>(cells() * inputs), 0.0), next(here);
    std::size_t begun = 0;
    constexpr int kMostSteps = 1'000'000;
    for (int step = 0; limited ? step < field_.max_gates : step < kMostSteps; ++step) {
      for (; begun < order.size() && (!limited || entering[order[begun]].gates == step); ++begun) {
        const Entering& e = entering[order[begun]];
        here[static_cast<std::size_t>(e.cell * inputs + space_.index_of(e.entry).state)] +=
            weights[order[begun]];
      }
      walked.remainder = 0.0;
      for (const double mass : here) walked.remainder += std::abs(mass);
      if (walked.remainder < kNobody && begun == order.size()) break;
      for (std::int64_t cell = 0; cell < cells(); ++cell)
        draw(chain, cell, step, here, next, walked);
      std::swap(here, next);
      std::fill(next.begin(), next.end(), 0.0);
      walked.remainder = 0.0;
    }
    return walked;
  }

 private:
  static constexpr double kNobody = 1e-12;

  void draw(const markov::FieldChain& chain, std::int64_t cell, int step,
            const std::vector<double>& here, std::vector<double>& next, Walked& walked) const {
    const std::int64_t inputs = space_.size();
    const std::int64_t column = cell % field_.columns, row = cell / field_.columns;
    const markov::Chain& of_cell = chain.at(column, row);
    for (std::int64_t input = 0; input < inputs; ++input) {
      const double mass = here[static_cast<std::size_t>(cell * inputs + input)];
      if (mass == 0.0) continue;
      walked.gates += mass;
      if (!of_cell.is_sampled(static_cast<int>(input))) {
        end(walked.ends, cell, Ending::unsampled, mass);
        continue;
      }
      for (markov::Probabilities::InnerIterator it(of_cell.matrix(), input); it; ++it) {
        const markov::Exit& exit = of_cell.exits()[static_cast<std::size_t>(it.col())];
        std::int64_t to_column = column, to_row = row;
        const auto ending = markov::follow({field_.columns, field_.rows}, exit,
                                           step + 1 == field_.max_gates, to_column, to_row);
        if (ending)
          end(walked.ends, cell, *ending, mass * it.value());
        else
          next[static_cast<std::size_t>((to_row * field_.columns + to_column) * inputs +
                                        exit.next_input)] += mass * it.value();
      }
    }
  }

  const FieldParams& field_;
  const StateSpace& space_;
};

/// The runs of each body of a half, by type, row and column of its chain.
struct BodyCounts {
  struct Count {
    int type, row, column;
  };
  std::vector<std::vector<Count>> of_body;
  std::vector<Eigen::VectorXd> runs;  // by type: of each row
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
      for (const bool mirror : {false, true}) {
        if (mirror && !map.types[passage.type].symmetric) continue;
        const auto state_of = [&](const Entry& e) {
          return kernel.space.index_of(mirror ? mirrored(map.section, e) : e).state;
        };
        int row = state_of(entry);
        if (!kernel.shared_by.empty())
          row = kernel.shared_by[passage.type][static_cast<std::size_t>(row)];
        counts.of_body[static_cast<std::size_t>(trials.bodies[i])].push_back(
            {passage.type, row,
             passage.fate == Fate::trapped ? kernel.space.trapped() : state_of(passage.entry)});
        counts.runs[passage.type][row] += 1.0;
      }
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

/// The chain of both halves with the states of one.
struct BothHalves {
  markov::FieldChain chain;
  std::vector<Eigen::VectorXd> runs;  // by type: of each row
  double fitted = 0.0;                // rows over runs: so much of a run's own chance is in its row
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

/// The chain of both halves, moved as the chain of one half moves with the weight of one of its
/// bodies: each row by kStep of what the body did less what all did, over the half's runs. More
/// where the body has a large part in the row, as that was fitted to it too (HC2 of MacKinnon and
/// White, J. Econometrics 29, 1985).
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
    const auto step = [&](Eigen::Index row) {  // none where all runs are its own: nothing changes
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

/// One half as the bodies behind a chain, and as those who are predicted.
struct Half {
  RunPool pool;
  SeenSoFar so_far{};
  std::vector<SeenTrial> trials{};
  int parts = 0;  // bodies that share a sign
  [[nodiscard]] std::size_t part_of(std::int32_t body) const {
    return static_cast<std::size_t>(body % parts);
  }
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
    halves[h].trials = seen_trials(problem, halves[h].pool, halves[h].so_far);
    halves[h].parts = static_cast<int>(std::min<std::size_t>(kMostParts, end - begin));
    if (halves[h].trials.empty())
      throw std::invalid_argument(
          "validate: one half of the bodies has no passage that the field could have");
  }
  return halves;
}

/// Of the difference.
struct Parts {
  Ends seen_less_chain;
  Eigen::MatrixXd seen;   // (numbers x parts of the half as seen) that half's, less the chain's
  Eigen::MatrixXd chain;  // (numbers x parts of the chain's half)
};

markov::FinalDistribution distribution_of(const Walked& walked, const FieldParams& field) {
  markov::FinalDistribution d;
  const std::int64_t cells = std::int64_t{field.columns} * field.rows;
  d.final_cells =
      Eigen::Map<const CellProbabilities>(walked.ends.data(), field.rows, field.columns);
  for (std::size_t e = 0; e < kEndings; ++e)
    d.endings[e] = walked.ends[cells + static_cast<Eigen::Index>(e)];
  d.mean_steps = walked.gates;
  d.remainder = walked.remainder;
  return d;
}

/// Shares of all trials with what chance in the bodies makes, as those of so many independent ones.
EndingShares shares_by_bodies(const Eigen::MatrixXd& by_body, const Eigen::VectorXd& trials,
                              std::int64_t passages) {
  const auto bodies = static_cast<double>(by_body.cols());
  const Eigen::VectorXd mean = by_body.rowwise().sum() / trials.sum();
  std::array<double, kEndings> shares{};
  for (std::size_t e = 0; e < kEndings; ++e)
    shares[e] = std::clamp(mean[static_cast<Eigen::Index>(e)], 0.0, 1.0);
  EndingShares said(shares);
  for (std::size_t e = 0; e < kEndings; ++e) {
    const double share = shares[e];
    const Eigen::VectorXd off =
        by_body.row(static_cast<Eigen::Index>(e)).transpose() - share * trials;
    const double variance =
        off.squaredNorm() / (trials.sum() * trials.sum()) * bodies / (bodies - 1.0);
    const double like =
        variance > kShareRounding * kShareRounding ? share * (1.0 - share) / variance : bodies;
    said.interval[e] = interval_of_share(share, std::min(like, static_cast<double>(passages)));
  }
  return said;
}

/// `half` as seen against the chain of `other`.
Parts compare_way(const Problem& problem, const Half& half, const Half& other,
                  const HalvesOptions& options, HalfAgainstHalf& way) {
  const FieldParams& field = problem.field;
  const Kernel kernel = kernel_of(problem.map(), other.pool, options.per_leaf);
  const markov::FieldChain chain = chain_of(kernel, problem.map(), field, {});
  const FieldWalk walk(field, kernel.space);
  const std::int64_t cells = walk.cells();
  const auto numbers = cells + static_cast<std::int64_t>(kEndings);
  const double share = 1.0 / static_cast<double>(half.trials.size());

  // The half as seen, body by body, and what the chain says of the same starts.
  const auto bodies = static_cast<std::size_t>(half.pool.bodies());
  struct OfBody {
    std::vector<Entering> starts, last;
    Ends ended;
  };
  std::vector<OfBody> of_body(bodies, {{}, {}, walk.no_ends()});
  for (const SeenTrial& t : half.trials) {
    OfBody& b = of_body[static_cast<std::size_t>(t.body)];
    b.starts.push_back(t.start);
    if (t.ending)
      walk.end(b.ended, t.last.cell, *t.ending, share);
    else
      b.last.push_back(t.last);
  }
  const BodyCounts counts = body_counts(problem, other.pool, kernel);
  const BothHalves both =
      both_halves(problem, kernel, counts, body_counts(problem, half.pool, kernel));
  // What was seen less what a chain says of the same starts: seen by the chain, and by both
  // halves'.
  Eigen::MatrixXd seen(numbers, bodies), predicted(numbers, bodies), off(numbers, bodies);
  std::vector<double> gates(bodies);
  tbb::parallel_for(std::size_t{0}, bodies, [&](std::size_t b) {
    const auto by = [&](const markov::FieldChain& chain_to_go, const std::vector<Entering>& from) {
      return walk.walk(chain_to_go, from, std::vector<double>(from.size(), share));
    };
    const auto at = static_cast<Eigen::Index>(b);
    const OfBody& body = of_body[b];
    const Walked from_start = by(chain, body.starts);
    predicted.col(at) = from_start.ends;
    gates[b] = from_start.gates;
    seen.col(at) = body.ended + by(chain, body.last).ends;
    off.col(at) = body.ended + by(both.chain, body.last).ends - by(both.chain, body.starts).ends;
  });
  Walked whole{predicted.rowwise().sum()};
  whole.gates = std::accumulate(gates.begin(), gates.end(), 0.0);
  const Ends as_seen = seen.rowwise().sum();

  Parts parts{as_seen - whole.ends, Eigen::MatrixXd::Zero(numbers, half.parts),
              Eigen::MatrixXd(numbers, other.parts)};
  for (std::size_t b = 0; b < bodies; ++b)
    parts.seen.col(static_cast<Eigen::Index>(half.part_of(static_cast<std::int32_t>(b)))) +=
        off.col(static_cast<Eigen::Index>(b)) / std::sqrt(1.0 - both.fitted);

  std::vector<Entering> entering;
  std::vector<double> weights;
  for (const OfBody& b : of_body)
    for (const auto* from : {&b.last, &b.starts}) {
      entering.insert(entering.end(), from->begin(), from->end());
      weights.resize(entering.size(), from == &b.last ? share : -share);
    }
  std::vector<std::vector<BodyCounts::Count>> of_part(static_cast<std::size_t>(other.parts));
  for (std::size_t b = 0; b < counts.of_body.size(); ++b) {
    auto& part = of_part[other.part_of(static_cast<std::int32_t>(b))];
    part.insert(part.end(), counts.of_body[b].begin(), counts.of_body[b].end());
  }
  const Ends as_it_is = walk.walk(both.chain, entering, weights).ends;
  tbb::parallel_for(std::size_t{0}, of_part.size(), [&](std::size_t part) {
    const auto more = with_more_of(of_part[part], counts, kernel, both);
    parts.chain.col(static_cast<Eigen::Index>(part)) =
        (walk.walk(more, entering, weights).ends - as_it_is) / kStep;
  });

  // The chain's own error bars, as any prediction's.
  std::vector<Entering> starts;
  for (const SeenTrial& t : half.trials) starts.push_back(t.start);
  std::vector<markov::FinalDistribution> groups(kTrialGroups);
  tbb::parallel_for(0, kTrialGroups, [&](int g) {
    const Kernel of_group =
        kernel_of(problem.map(), other.pool, options.per_leaf, {g, kTrialGroups});
    groups[static_cast<std::size_t>(g)] =
        distribution_of(FieldWalk(field, of_group.space)
                            .walk(chain_of(of_group, problem.map(), field, {}), starts,
                                  std::vector<double>(starts.size(), share)),
                        field);
  });
  way.bodies = half.pool.bodies();
  way.chain_bodies = other.pool.bodies();
  way.states = kernel.space.size();
  way.seen_so_far = half.so_far;
  way.chain = distribution_of(whole, field);
  const GroupSpread spread(way.chain, groups);
  way.chain_error = spread.error(way.chain_bodies, options.seed);
  way.chain_endings = spread.endings_95(way.chain_bodies).with_limit(field.max_gates);
  way.seen_gates = Eigen::Map<const CellProbabilities>(as_seen.data(), field.rows, field.columns);
  Eigen::VectorXd trials = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(bodies));
  for (const SeenTrial& t : half.trials) trials[t.body] += share;
  way.seen = shares_by_bodies(seen.bottomRows(kEndings), trials, half.pool.gate_runs())
                 .with_limit(field.max_gates);
  way.corrcoef = corrcoef(way.seen_gates, way.chain.final_cells);
  way.rmse_per_100 = rmse_per_100(way.seen_gates, way.chain.final_cells);
  return parts;
}

constexpr std::size_t kOfOneWay = 1 + kEndings;  // of one way

/// Total variation of the final gates, then each ending's difference.
void add_statistics(std::vector<double>& all, const Eigen::VectorXd& difference) {
  const auto exact = [](double x) { return x > kShareRounding ? x : 0.0; };
  const auto endings = static_cast<Eigen::Index>(kEndings);
  all.push_back(exact(0.5 * difference.head(difference.size() - endings).cwiseAbs().sum()));
  for (Eigen::Index e = 0; e < endings; ++e)
    all.push_back(exact(std::abs(difference[difference.size() - endings + e])));
}

/// Endings of which a half has, by what was seen and by the chain, hardly any trial, or all but a
/// few: bodies that end so are too few to tell what chance makes. Counts of both halves are drawn
/// instead, as if every trial were independent.
class RareEndings {
 public:
  RareEndings(const std::array<Half, 2>& halves, const HalvesValidation& v) {
    constexpr double kFewTrials = 5.0;  // trials of a half
    for (std::size_t h = 0; h < 2; ++h) trials_[h] = std::ssize(halves[h].trials);
    const auto n = static_cast<double>(trials_[0] + trials_[1]);
    for (std::size_t e = 0; e < kEndings; ++e) {
      double count = 0.0;
      for (std::size_t h = 0; h < 2; ++h)  // way w is of half 1 - w as seen
        count += 0.5 * (v.ways[1 - h].seen.share[e] + v.ways[1 - h].chain.endings[e]) *
                 static_cast<double>(trials_[h]);
      if (count > kShareRounding && n - count > kShareRounding &&
          0.5 * std::min(count, n - count) < kFewTrials)
        rare_.push_back({static_cast<Eigen::Index>(e), (count + 0.5) / (n + 1.0)});
    }
  }
  /// Puts them into the difference by chance of each way.
  void draw(Random& random, std::array<Eigen::VectorXd, 2>& by_chance) const {
    for (const auto& [ending, share] : rare_) {
      std::array<double, 2> seen{};
      for (std::size_t h = 0; h < 2; ++h)
        seen[h] = static_cast<double>(binomial(trials_[h], share, random)) /
                  static_cast<double>(trials_[h]);
      for (std::size_t w = 0; w < 2; ++w)
        by_chance[w][by_chance[w].size() - static_cast<Eigen::Index>(kEndings) + ending] =
            seen[1 - w] - seen[w];
    }
  }

 private:
  struct Rare {
    Eigen::Index ending;
    double share;
  };
  std::array<std::int64_t, 2> trials_{};
  std::vector<Rare> rare_;
};

}  // namespace

HalvesValidation validate_halves(const Problem& problem, const RunPool& pool,
                                 const HalvesOptions& options, const Work& work) {
  if (pool.bodies() < 2 * kLeastBodies)
    throw std::invalid_argument("validate: two halves need " + std::to_string(2 * kLeastBodies) +
                                " bodies at least, these are " + std::to_string(pool.bodies()));
  HalvesValidation v;
  const std::array<Half, 2> halves = dealt_out(problem, pool, options.seed);
  std::array<Parts, 2> parts;
  for (std::size_t w = 0; w < 2; ++w) {
    work.tell("halves", static_cast<std::int64_t>(w), 2);
    parts[w] = compare_way(problem, halves[1 - w], halves[w], options, v.ways[w]);
  }

  const std::int64_t numbers = parts[0].seen.rows(),
                     signs = halves[0].parts + std::int64_t{halves[1].parts};
  v.null_draws = options.null_draws.value_or(
      std::clamp<std::int64_t>(1'000'000'000 / (2 * numbers * signs), 999, 1999));
  std::vector<double> all;
  std::array<std::vector<double>, 2> correlations, rmses;
  const RareEndings rare(halves, v);
  for (std::int64_t k = 0; k < v.null_draws; ++k) {
    Random random(Purpose::comparison, {options.seed, kSigns, static_cast<std::uint64_t>(k)});
    std::array<Eigen::VectorXd, 2> sign;
    for (std::size_t h = 0; h < 2; ++h) {
      sign[h].resize(halves[h].parts);
      for (double& s : sign[h]) s = random.uniform() < 0.5 ? -1.0 : 1.0;
    }
    std::array<Eigen::VectorXd, 2> of_way;
    for (std::size_t w = 0; w < 2; ++w)
      of_way[w] = parts[w].seen * sign[1 - w] + parts[w].chain * sign[w];
    rare.draw(random, of_way);
    for (std::size_t w = 0; w < 2; ++w) {
      const Eigen::VectorXd& by_chance = of_way[w];
      add_statistics(all, by_chance);
      const CellProbabilities& chain = v.ways[w].chain.final_cells;
      const CellProbabilities seen =
          chain + Eigen::Map<const CellProbabilities>(by_chance.data(), chain.rows(), chain.cols());
      if (const double c = corrcoef(seen, chain); std::isfinite(c)) correlations[w].push_back(c);
      rmses[w].push_back(rmse_per_100(seen, chain));
    }
  }
  for (std::size_t w = 0; w < 2; ++w) add_statistics(all, parts[w].seen_less_chain);

  const MultipleTests looked(all, 2 * kOfOneWay);
  v.p = looked.p;
  for (std::size_t w = 0; w < 2; ++w) {
    HalfAgainstHalf& way = v.ways[w];
    const auto drawn = [&](std::size_t statistic) {
      std::vector<double> values;
      for (std::int64_t k = 0; k < v.null_draws; ++k)
        values.push_back(
            all[static_cast<std::size_t>(k) * 2 * kOfOneWay + w * kOfOneWay + statistic]);
      return mean_and_95(std::move(values));
    };
    way.total_variation = looked.tests[w * kOfOneWay];
    std::tie(way.chance_total_variation, way.chance_total_variation_95) = drawn(0);
    for (std::size_t e = 0; e < kEndings; ++e) {
      way.endings[e] = looked.tests[w * kOfOneWay + 1 + e];
      way.chance_95[e] = drawn(1 + e).second;
    }
    way.chance_corrcoef =
        correlations[w].empty() ? std::nan("") : mean_and_95(correlations[w]).first;
    way.chance_rmse_per_100 = mean_and_95(rmses[w]).first;
  }
  return v;
}

}  // namespace gatewalk::lattice
