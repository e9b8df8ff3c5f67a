// SPDX-License-Identifier: MIT
#include "lattice/study/order.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "dynamics/base/random.h"
#include "lattice/pool/kernel.h"
#include "lattice/pool/remembered.h"
#include "lattice/statistics/group_spread.h"
#include "lattice/study/trials.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

constexpr std::uint64_t kFolding = 0x6f726465'72000001, kDrawing = 0x6f726465'72000002,
                        kShuffling = 0x6f726465'72000003;  // "order"
constexpr std::size_t kFolds = 10;

/// A passage with a known outcome: a face, or the number of faces for being trapped.
struct Step {
  std::int32_t body = 0;
  int type = 0;
  Entry entry{};
  int outcome = 0;
  std::vector<int> letters{};  // of the passages before, the latest at the end; at most `most`
  std::size_t number = 0;      // of the passage; that of its mirror image too
  bool is_image = false;
};

/// The passages of all bodies, and the mirror images of those through symmetric cells.
struct Steps {
  std::vector<Step> seen, images;
};

Steps steps_of(const CellMap& map, const RunPool& pool, const Letters& letters, int most) {
  const Section& section = map.section;
  const auto faces = static_cast<int>(section.faces.size());
  const bool images = letters.of != LettersOf::states;
  Steps steps;
  const FieldTrials& trials = pool.scattered.each;
  for (std::size_t i = 0; i < trials.passed.size(); ++i) {
    std::vector<int> before;
    Entry entry = pool.scattered.starts[i];
    for (const CellPassage passage : trials.of_trial(i)) {
      if (passage.fate == Fate::broken) break;
      const bool left = passage.fate == Fate::left;
      const Step& step = steps.seen.emplace_back(Step{trials.bodies[i], passage.type, entry,
                                                      left ? passage.entry.face : faces, before,
                                                      steps.seen.size()});
      if (images && map.types[passage.type].symmetric) {
        Step image = step;
        image.is_image = true;
        image.entry = mirrored(section, entry);
        if (left) image.outcome = section.faces[static_cast<std::size_t>(step.outcome)].mirror;
        for (int& letter : image.letters)
          letter = letters.mirrors[static_cast<std::size_t>(letter)];
        steps.images.push_back(std::move(image));
      }
      if (!left) break;
      if (const int letter = letters.of_passage(passage.type, entry, passage.entry.face);
          letter != kNoLetter)
        before.push_back(letter);
      if (std::ssize(before) > most) before.erase(before.begin());
      entry = passage.entry;
    }
  }
  return steps;
}

/// Where a step stands at one order: type, face, then the last letters. A body that has fewer
/// letters stands nowhere.
using Standing = std::vector<int>;
std::optional<Standing> standing(const Step& step, int order) {
  if (std::ssize(step.letters) < order) return {};
  Standing at{step.type, step.entry.face};
  at.insert(at.end(), step.letters.end() - order, step.letters.end());
  return at;
}
/// The same with another letter as the earliest of them.
std::optional<Standing> standing(const Step& step, int order, int earliest) {
  auto at = standing(step, order);
  if (at) (*at)[2] = earliest;
  return at;
}

/// By passage: the earliest of its last `order` letters, shuffled among the passages that stand
/// alike without it; kNoLetter for passages with fewer letters.
std::vector<int> shuffled_letters(const std::vector<Step>& seen, int order, Random random) {
  std::vector<int> letters(seen.size(), kNoLetter);
  std::map<Standing, std::vector<std::size_t>> alike;
  for (const Step& step : seen)
    if (std::ssize(step.letters) >= order) {
      letters[step.number] = step.letters[step.letters.size() - static_cast<std::size_t>(order)];
      alike[*standing(step, order - 1)].push_back(step.number);
    }
  for (const auto& [place, numbers] : alike)
    for (std::size_t i = numbers.size(); i > 1; --i)
      std::swap(
          letters[numbers[i - 1]],
          letters[numbers[static_cast<std::size_t>(random.below(static_cast<std::int64_t>(i)))]]);
  return letters;
}

/// Outcomes of the steps of one standing, by leaf of a tree of their entries.
class OutcomesSeen {
 public:
  OutcomesSeen(const Section& one_face, const std::vector<const Step*>& steps, int outcomes,
               int per_leaf)
      : outcomes_(outcomes) {
    std::vector<int> leaf(steps.size(), 0);
    if (std::ssize(steps) >= 2 * per_leaf) {
      EntryTable entries(one_face);
      for (const Step* step : steps) entries.push_back({0, step->entry.at});
      space_.emplace(tree_space(one_face, entries, per_leaf, {}, &leaf));
    }
    counts_.assign(static_cast<std::size_t>((space_ ? space_->size() : 1) * outcomes), 0);
    for (std::size_t i = 0; i < steps.size(); ++i)
      ++counts_[static_cast<std::size_t>(leaf[i] * outcomes + steps[i]->outcome)];
  }

  /// How often the step's outcome was seen in its leaf, and how many outcomes were.
  struct Seen {
    int outcome = 0, all = 0;
    /// The probability of the outcome, smoothed with what is known without this leaf.
    [[nodiscard]] double smoothed(double weight, double before) const {
      return (outcome + weight * before) / (all + weight);
    }
  };
  [[nodiscard]] Seen in_leaf(const Step& step) const {
    const int leaf = space_ ? space_->index_of({0, step.entry.at}).state : 0;
    return seen(counts_.data() + static_cast<std::size_t>(leaf * outcomes_), step.outcome);
  }
  [[nodiscard]] Seen in_all_leaves(const Step& step) const {
    Seen sum;
    for (std::size_t leaf = 0; leaf < counts_.size(); leaf += static_cast<std::size_t>(outcomes_)) {
      const Seen one = seen(counts_.data() + leaf, step.outcome);
      sum.outcome += one.outcome;
      sum.all += one.all;
    }
    return sum;
  }

 private:
  [[nodiscard]] Seen seen(const int* counts, int outcome) const {
    return {counts[outcome], std::accumulate(counts, counts + outcomes_, 0)};
  }

  int outcomes_;
  std::optional<StateSpace> space_{};  // none: a single leaf
  std::vector<int> counts_;            // (leaves x outcomes)
};

/// By order: log likelihoods of a body's passages, by the chain of other bodies.
using Scores = std::vector<std::vector<double>>;  // (orders x bodies)
constexpr std::size_t kShuffles = 7;
/// By order from 1, and shuffle: shuffled_letters().
using Shuffled = std::vector<std::array<std::vector<int>, kShuffles>>;

/// The weight of what is known without a leaf that predicts each training passage best from the
/// others (leaving one out); `p` has the probabilities of the level before, and gets those of this.
double best_weight(const std::vector<OutcomesSeen::Seen>& seen, std::vector<double>& p) {
  double best = 0.0, most = -std::numeric_limits<double>::infinity();
  const auto without_itself = [](OutcomesSeen::Seen s) {
    return s.all > 0 ? OutcomesSeen::Seen{s.outcome - 1, s.all - 1} : s;
  };
  constexpr double kLeast = 0.5, kMost = 5000.0;
  for (double weight = kLeast; weight < kMost; weight *= 2.0) {
    double sum = 0.0;
    for (std::size_t i = 0; i < seen.size(); ++i)
      sum += std::log(without_itself(seen[i]).smoothed(weight, p[i]));
    if (sum > most) {
      most = sum;
      best = weight;
    }
  }
  for (std::size_t i = 0; i < seen.size(); ++i) p[i] = without_itself(seen[i]).smoothed(best, p[i]);
  return best;
}

/// The chances of the outcomes of some passages, and of those that they are learned from.
struct Chances {
  std::vector<const Step*> others, own;
  std::vector<double> of_others, of_own;

  /// Smooths the outcomes seen at each standing (nullopt: nowhere) with what was known before.
  template <class StandingOf>
  void learn(StandingOf standing_of, bool in_all_leaves, const Section& one_face, int outcomes,
             int per_leaf) {
    using Seen = OutcomesSeen::Seen;
    std::map<Standing, std::vector<const Step*>> at;
    for (const Step* step : others)
      if (auto place = standing_of(*step)) at[*std::move(place)].push_back(step);
    std::map<Standing, OutcomesSeen> seen;
    for (const auto& [place, steps] : at)
      seen.emplace(place, OutcomesSeen(one_face, steps, outcomes, per_leaf));
    const auto of = [&](const Step& step) {
      const auto place = standing_of(step);
      const auto found = place ? seen.find(*place) : seen.end();
      return found == seen.end() ? Seen{}
             : in_all_leaves     ? found->second.in_all_leaves(step)
                                 : found->second.in_leaf(step);
    };
    std::vector<Seen> of_each;
    for (const Step* step : others) of_each.push_back(of(*step));
    const double weight = best_weight(of_each, of_others);
    for (std::size_t i = 0; i < own.size(); ++i)
      of_own[i] = of(*own[i]).smoothed(weight, of_own[i]);
  }
  void add_to(std::vector<double>& scores) const {
    for (std::size_t i = 0; i < own.size(); ++i)
      scores[static_cast<std::size_t>(own[i]->body)] += std::log(of_own[i]);
  }
};

/// Adds the scores of the bodies of one fold; `by_chance` (orders x shuffles x bodies): of the same
/// with the earliest letter shuffled. The levels are: all entries of a type and face, then the
/// leaves of order 0, 1, ...
void score_fold(const Steps& steps, const Shuffled& shuffled, const Letters& letters,
                const std::vector<std::size_t>& fold_of, std::size_t fold, const Section& one_face,
                int faces, const OrderOptions& options, Scores& scores, Scores& by_chance) {
  const int outcomes = faces + 1;
  Chances chances;
  for (const std::vector<Step>* all : {&steps.seen, &steps.images})
    for (const Step& step : *all)
      if (fold_of[static_cast<std::size_t>(step.body)] != fold)
        chances.others.push_back(&step);
      else if (!step.is_image)
        chances.own.push_back(&step);
  chances.of_others.assign(chances.others.size(), 1.0 / outcomes);
  chances.of_own.assign(chances.own.size(), 1.0 / outcomes);
  for (int order = 0; order <= options.most; ++order) {
    const auto k = static_cast<std::size_t>(order);
    const auto learn = [&](Chances& of, const auto& standing_of, bool in_all_leaves = false) {
      of.learn(standing_of, in_all_leaves, one_face, outcomes, options.per_leaf);
    };
    const auto as_seen = [&](const Step& step) { return standing(step, order); };
    if (order == 0) learn(chances, as_seen, true);
    for (std::size_t shuffle = 0; order > 0 && shuffle < kShuffles; ++shuffle) {
      const std::vector<int>& earliest = shuffled[k - 1][shuffle];
      Chances chance = chances;
      learn(chance, [&](const Step& step) {
        const int letter = earliest[step.number];
        return standing(step, order,
                        step.is_image && letter != kNoLetter
                            ? letters.mirrors[static_cast<std::size_t>(letter)]
                            : letter);
      });
      chance.add_to(by_chance[k * kShuffles + shuffle]);
    }
    learn(chances, as_seen);
    chances.add_to(scores[k]);
  }
}

/// Numbers 0 to 9 for the bodies, in random order.
std::vector<std::size_t> dealt_folds(std::size_t bodies, std::uint64_t seed) {
  std::vector<std::size_t> order(bodies), fold(bodies);
  std::iota(order.begin(), order.end(), 0);
  Random random(Purpose::comparison, {seed, kFolding, 0});
  for (std::size_t i = bodies; i > 1; --i)
    std::swap(order[i - 1],
              order[static_cast<std::size_t>(random.below(static_cast<std::int64_t>(i)))]);
  for (std::size_t i = 0; i < bodies; ++i) fold[order[i]] = i % kFolds;
  return fold;
}

/// Simultaneous 95 % intervals of the sums of each row of `gains` (orders x bodies), by draws of
/// bodies with replacement: the largest deviation of any row, in its own standard errors.
/// `variance`: that of each sum beside the bodies', by what the chains learned by chance.
std::vector<std::array<double, 2>> simultaneous_95(const Scores& gains,
                                                   const std::vector<double>& variance,
                                                   std::uint64_t seed) {
  constexpr std::int64_t kDraws = 1999;
  const std::size_t rows = gains.size(), bodies = gains.front().size();
  std::vector<double> sum(rows), error(rows);
  for (std::size_t r = 0; r < rows; ++r) {
    const auto n = static_cast<double>(bodies);
    sum[r] = std::accumulate(gains[r].begin(), gains[r].end(), 0.0);
    double squares = 0.0;
    for (const double gain : gains[r]) squares += (gain - sum[r] / n) * (gain - sum[r] / n);
    error[r] = std::sqrt(squares * n / (n - 1.0));
  }
  std::vector<double> largest;
  for (std::int64_t k = 0; k < kDraws; ++k) {
    Random random(Purpose::resampling, {seed, kDrawing, static_cast<std::uint64_t>(k)});
    std::vector<int> times(bodies, 0);
    for (std::size_t i = 0; i < bodies; ++i)
      ++times[static_cast<std::size_t>(random.below(static_cast<std::int64_t>(bodies)))];
    double most = 0.0;
    for (std::size_t r = 0; r < rows; ++r) {
      double drawn = 0.0;
      for (std::size_t b = 0; b < bodies; ++b) drawn += times[b] * gains[r][b];
      if (error[r] > 0.0) most = std::max(most, std::abs(drawn - sum[r]) / error[r]);
    }
    largest.push_back(most);
  }
  std::sort(largest.begin(), largest.end());
  const double times = largest[static_cast<std::size_t>(0.95 * static_cast<double>(kDraws))];
  std::vector<std::array<double, 2>> intervals;
  for (std::size_t r = 0; r < rows; ++r) {
    const double half = times * std::sqrt(error[r] * error[r] + variance[r]);
    intervals.push_back({sum[r] - half, sum[r] + half});
  }
  return intervals;
}

/// The number of cells that nine of ten trials pass.
int cells_of_most(const FieldTrials& trials) {
  std::vector<std::size_t> cells;
  for (std::size_t i = 0; i < trials.passed.size(); ++i) cells.push_back(trials.of_trial(i).size());
  const auto tenth = cells.begin() + std::ssize(cells) / 10;
  std::nth_element(cells.begin(), tenth, cells.end());
  return static_cast<int>(std::max<std::size_t>(1, *tenth));
}

}  // namespace

OrderStudy study_order(const Problem& problem, const RunPool& pool, const OrderOptions& options,
                       const Work& work) {
  if (pool.bodies() < 2 * kLeastBodies)
    throw std::invalid_argument("validate: orders are compared with " +
                                std::to_string(2 * kLeastBodies) + " bodies at least, these are " +
                                std::to_string(pool.bodies()));
  const CellMap& map = problem.map();
  OrderStudy study{.of = options.of, .orders = {}, .bodies = pool.bodies()};
  const Letters letters = letters_of(
      options.of, map, pool,
      options.of == LettersOf::states
          ? std::make_shared<const StateSpace>(kernel_of(map, pool, options.per_leaf).space)
          : nullptr);
  const Steps steps = steps_of(map, pool, letters, options.most);
  study.passages = std::ssize(steps.seen);
  Section one_face = map.section;
  one_face.faces.resize(1);
  one_face.faces.front().mirror = kNoMirror;
  one_face.faces.front().usual.fill({0.0, 1.0});  // not used: every standing has entries
  const auto bodies = static_cast<std::size_t>(pool.bodies());
  const std::vector<std::size_t> fold_of = dealt_folds(bodies, options.seed);
  Shuffled shuffled(static_cast<std::size_t>(options.most));
  for (std::size_t k = 0; k < shuffled.size(); ++k)
    for (std::size_t shuffle = 0; shuffle < kShuffles; ++shuffle)
      shuffled[k][shuffle] = shuffled_letters(
          steps.seen, static_cast<int>(k) + 1,
          Random(Purpose::comparison, {options.seed, kShuffling, k * kShuffles + shuffle}));
  Scores scores(static_cast<std::size_t>(options.most) + 1, std::vector<double>(bodies, 0.0)),
      by_chance(scores.size() * kShuffles, scores.front());
  tbb::parallel_for(std::size_t{0}, kFolds, [&](std::size_t fold) {  // each has bodies of its own
    score_fold(steps, shuffled, letters, fold_of, fold, one_face,
               static_cast<int>(map.section.faces.size()), options, scores, by_chance);
  });
  // What each letter adds beyond a shuffled one, and the variance of that sum between shuffles.
  std::vector<double> variance(scores.size(), 0.0);
  for (std::size_t k = 1; k < scores.size(); ++k) {
    std::array<double, kShuffles> sum{};
    double mean = 0.0;
    for (std::size_t shuffle = 0; shuffle < kShuffles; ++shuffle)
      for (std::size_t b = 0; b < bodies; ++b) {
        const double chance = by_chance[k * kShuffles + shuffle][b];
        sum[shuffle] += chance;
        mean += chance / kShuffles;
        scores[k][b] -= chance / kShuffles;
      }
    for (std::size_t b = 0; b < bodies; ++b) scores[k][b] += scores[k - 1][b];
    for (const double x : sum)
      variance[k] += (x - mean) * (x - mean) / (kShuffles - 1) * (1.0 + 1.0 / kShuffles);
  }
  scores.erase(scores.begin(), scores.begin() + options.least);
  variance.erase(variance.begin(), variance.begin() + options.least);
  const auto n = static_cast<double>(study.passages);
  std::vector<double> sums;
  for (const std::vector<double>& of_order : scores)
    sums.push_back(std::accumulate(of_order.begin(), of_order.end(), 0.0));
  study.best = static_cast<std::size_t>(std::max_element(sums.begin(), sums.end()) - sums.begin());
  Scores gains;
  std::vector<double> of_gains;
  for (std::size_t k = 0; k < scores.size(); ++k) {
    auto& gain = gains.emplace_back(scores[study.best]);
    for (std::size_t b = 0; b < bodies; ++b) gain[b] -= scores[k][b];
    const auto [low, high] = std::minmax(k, study.best);
    of_gains.push_back(std::accumulate(variance.begin() + static_cast<std::ptrdiff_t>(low) + 1,
                                       variance.begin() + static_cast<std::ptrdiff_t>(high) + 1,
                                       0.0));
  }
  const auto intervals = simultaneous_95(gains, of_gains, options.seed);
  Problem compared = problem;
  if (compared.field.max_gates == 0) compared.field.max_gates = cells_of_most(pool.scattered.each);
  study.max_gates = compared.field.max_gates;
  study.chosen = study.best;
  for (std::size_t k = 0; k < scores.size(); ++k) {
    work.tell("orders", static_cast<std::int64_t>(k), std::ssize(scores));
    OrderAnswer& a = study.orders.emplace_back();
    a.order = options.least + static_cast<int>(k);
    a.likelihood = std::exp(sums[k] / n);
    a.gain_to_best = std::expm1((sums[study.best] - sums[k]) / n);
    for (std::size_t side : {0, 1}) a.interval[side] = std::expm1(intervals[k][side] / n);
    if (a.is_enough() && k < study.chosen) study.chosen = k;
    const CrossValidationOptions how{
        .null_draws = {}, .seed = options.seed, .per_leaf = options.per_leaf};
    if (a.order == 0) {
      a.words = 1;
      if (options.with_halves) a.halves = cross_validate(compared, pool, how);
      continue;
    }
    Problem remembering = compared;
    const ChosenWords chosen = words_of(letters, pool, a.order, options.per_leaf);
    remembering.cells.map = with_words(map, chosen.words);
    a.words = chosen.words->size();
    a.left_out = chosen.left_out;
    if (options.with_halves)
      a.halves = cross_validate(remembering, with_words(pool, remembering.map()), how);
  }
  return study;
}

RunPool simulated_bodies(const Problem& problem, std::int64_t trials, std::uint64_t seed,
                         const Work& work) {
  RunPool pool;
  static_cast<void>(field_trials(
      problem, {0, trials}, seed, work,
      [&](const FieldTrials& each) { pool.scattered.each.append(each); }, true));
  pool.scattered.starts.assign(pool.scattered.each.passed.size(), problem.start);
  for (std::int32_t body = 0; body < std::ssize(pool.scattered.starts); ++body)
    pool.scattered.each.bodies.push_back(body);
  return pool;
}

}  // namespace gatewalk::lattice
