// SPDX-License-Identifier: MIT
#include "lattice/study/order.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
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
#include "lattice/study/next_face.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

constexpr std::uint64_t kFolding = 0x6f726465'72000001, kDrawing = 0x6f726465'72000002,
                        kShuffling = 0x6f726465'72000003,
                        kLending = 0x6f726465'72000004;  // "order"
constexpr std::size_t kFolds = 10;

/// Subtracts the part of `vector` along a column of unit length.
void take_out(const std::vector<double>& column, std::vector<double>& vector) {
  const double along = std::inner_product(column.begin(), column.end(), vector.begin(), 0.0);
  for (std::size_t i = 0; i < vector.size(); ++i) vector[i] -= along * column[i];
}
/// Makes columns orthonormal (modified Gram-Schmidt); those that depend on earlier ones become 0.
void orthonormalise(std::vector<std::vector<double>>& columns) {
  constexpr double kDependent = 1e-9;  // length of the rest, relative to the column's
  const auto length = [](const std::vector<double>& column) {
    return std::sqrt(std::inner_product(column.begin(), column.end(), column.begin(), 0.0));
  };
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const double before = length(columns[k]);
    for (std::size_t j = 0; j < k; ++j) take_out(columns[j], columns[k]);
    const double rest = length(columns[k]);
    for (double& x : columns[k]) x = rest > kDependent * before ? x / rest : 0.0;
  }
}

template <class T>
void shuffle(std::vector<T>& all, Random& random) {
  for (std::size_t i = all.size(); i > 1; --i)
    std::swap(all[i - 1],
              all[static_cast<std::size_t>(random.below(static_cast<std::int64_t>(i)))]);
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
  for (const auto& [place, numbers] : alike) {
    std::vector<int> of_these;
    for (const std::size_t number : numbers) of_these.push_back(letters[number]);
    shuffle(of_these, random);
    for (std::size_t i = 0; i < numbers.size(); ++i) letters[numbers[i]] = of_these[i];
  }
  return letters;
}

/// By order: log likelihoods of a body's passages, by the chain of other bodies.
using Scores = std::vector<std::vector<double>>;  // (orders x bodies)
constexpr std::size_t kShuffles = 7;
/// By order from 1, and shuffle: shuffled_letters().
using Shuffled = std::vector<std::array<std::vector<int>, kShuffles>>;

/// Cross-validation: the bodies are dealt into ten folds, and chains of nine folds predict the
/// passages of the tenth.
class Folds {
 public:
  /// `section`: shows the entries of `steps`; its coordinates from `remembered` on are numbers that
  /// bodies remember and do not show.
  Folds(const Steps& steps, const Letters& letters, const Section& section, std::size_t remembered,
        std::vector<std::size_t> fold_of, int per_leaf)
      : steps_(steps),
        letters_(letters),
        section_(section),
        entry_(section),
        numbers_(section),
        fold_of_(std::move(fold_of)),
        per_leaf_(per_leaf) {
    for (Section* shown : {&entry_, &numbers_}) {
      shown->faces.resize(1);
      shown->faces.front().mirror = kNoMirror;
      shown->faces.front().odd = 0;
      shown->faces.front().usual.fill({0.0, 1.0});  // not used: every tree has entries
    }
    const auto first = numbers_.coordinates.begin() + static_cast<std::ptrdiff_t>(remembered);
    numbers_.coordinates.erase(numbers_.coordinates.begin(), first);
    entry_.coordinates.resize(remembered);
  }

  /// Adds the scores of one fold's bodies, by order from 0; `by_chance` (orders x shuffles x
  /// bodies): of the same with the earliest letter shuffled. Each order smooths the leaves of its
  /// trees with the order before, and order 0 with all entries of a type and face.
  void score(std::size_t fold, const Shuffled& shuffled, Scores& scores, Scores& by_chance) const {
    Chances chances = without_knowledge(fold);
    for (std::size_t k = 0; k < scores.size(); ++k) {
      const int order = static_cast<int>(k);
      for (std::size_t shuffle = 0; order > 0 && shuffle < kShuffles; ++shuffle) {
        const std::vector<int>& earliest = shuffled[k - 1][shuffle];
        Chances chance = chances;
        chance.learn(entries_at([&](const Step& step) {
                       const int letter = earliest[step.number];
                       return standing(step, order,
                                       step.is_image && letter != kNoLetter
                                           ? letters_.mirrors[static_cast<std::size_t>(letter)]
                                           : letter);
                     }),
                     per_leaf_);
        chance.add_to(by_chance[k * kShuffles + shuffle]);
      }
      learn(chances, order);
      chances.add_to(scores[k]);
    }
  }

  /// By shuffle and passage: the passage's entry with remembered numbers of others. In each leaf of
  /// a chain of this order the numbers are a linear function of the entry, and rests; the rests are
  /// shuffled. So lent numbers say as much of the entry, as far as that is linear in a leaf.
  [[nodiscard]] std::vector<std::vector<Entry>> lent(int order, std::uint64_t seed) const {
    const std::vector<Step>& seen = steps_.seen;
    std::vector<const Step*> steps;
    std::vector<Entry> own;
    std::map<Standing, std::int64_t> sizes;
    for (const Step& step : seen) {
      steps.push_back(&step);
      own.push_back(step.entry);
      for (int k = 0; !step.is_first && k <= order_of(step, order); ++k)
        ++sizes[*standing(step, k)];
    }
    const std::size_t shown = entry_.coordinates.size(), numbers = numbers_.coordinates.size();
    const int per_leaf = std::max(per_leaf_, 4 * static_cast<int>(shown + 1));
    const auto where_enough = [&](const Step& step) -> std::optional<Standing> {
      if (step.is_first) return {};
      int k = order_of(step, order);
      while (k > 0 && sizes.at(*standing(step, k)) < 2 * per_leaf) --k;
      return standing(step, k);
    };
    const std::vector<int> group = groups_of(steps, shown_at(entry_, where_enough), per_leaf);
    std::map<int, std::vector<std::size_t>> alike;
    for (std::size_t i = 0; i < seen.size(); ++i)
      if (group[i] >= 0) alike[group[i]].push_back(i);
    std::vector<std::vector<Entry>> lent(kShuffles, own);
    std::vector<Random> random;
    for (std::size_t shuffled = 0; shuffled < kShuffles; ++shuffled)
      random.emplace_back(Purpose::comparison, Stream{seed, kLending, shuffled});
    std::vector<std::vector<double>> columns;
    for (auto& [_, members] : alike) {
      const auto number_of = [&](std::size_t member, std::size_t k) {
        return seen[member].entry.at[k];
      };
      columns.assign(1, std::vector<double>(members.size(), 1.0));
      for (std::size_t k = 0; k < shown; ++k)
        for (auto& column = columns.emplace_back(); const std::size_t member : members)
          column.push_back(number_of(member, k));
      orthonormalise(columns);
      std::vector<std::vector<double>> rests(numbers);
      for (std::size_t k = 0; k < numbers; ++k) {
        for (const std::size_t member : members) rests[k].push_back(number_of(member, shown + k));
        for (const auto& column : columns) take_out(column, rests[k]);
      }
      for (std::size_t shuffled = 0; shuffled < kShuffles; ++shuffled) {
        std::vector<std::size_t> lender(members.size());
        std::iota(lender.begin(), lender.end(), 0);
        shuffle(lender, random[shuffled]);
        for (std::size_t i = 0; i < members.size(); ++i)
          for (std::size_t k = 0; k < numbers; ++k)
            lent[shuffled][members[i]].at[shown + k] += rests[k][lender[i]] - rests[k][i];
      }
    }
    return lent;
  }

  /// Adds the scores of one fold's bodies by a chain of this order and the numbers that they
  /// remember; `by_chance` (shuffles x bodies): with lent numbers. Returns the number of passages
  /// whose numbers can have told something.
  std::int64_t score_remembered(std::size_t fold, int order,
                                const std::vector<std::vector<Entry>>& lent,
                                std::vector<double>& scores, Scores& by_chance) const {
    Chances chances = without_knowledge(fold);
    for (int k = 0; k <= order; ++k) learn(chances, k);
    const auto add = [&](const std::vector<Entry>* entries, std::vector<double>& to) {
      const auto entry_of = [&](const Step& step) {
        if (entries == nullptr) return step.entry;
        const Entry& entry = (*entries)[step.number];
        return step.is_image ? mirrored(section_, entry) : entry;
      };
      const auto numbers_of = [&](const Step& step) {
        const Entry entry = entry_of(step);
        Entry numbers;
        std::copy(entry.at.begin() + std::ssize(entry_.coordinates), entry.at.end(),
                  numbers.at.begin());
        return numbers;
      };
      Chances with = chances;
      std::int64_t told = 0;
      // Numbers that matter everywhere alike, at each face and then for each word; and those that
      // matter together with one coordinate.
      for (const int per_group : {400, 100, 25, 7})
        told = with.learn_factors({numbers_, numbers_of, knowing(0)}, per_group);
      for (const int per_group : {100, 25})
        if (order > 0) with.learn_factors({numbers_, numbers_of, knowing(order)}, per_group);
      for (std::size_t k = 0; k < entry_.coordinates.size(); ++k) {
        Section both = numbers_;
        both.coordinates.insert(both.coordinates.begin(), entry_.coordinates[k]);
        const auto both_of = [&](const Step& step) {
          const Entry numbers = numbers_of(step);
          Entry entry;
          entry.at[0] = step.entry.at[k];
          std::copy_n(numbers.at.begin(), numbers_.coordinates.size(), entry.at.begin() + 1);
          return entry;
        };
        for (const int per_group : {100, 25})
          with.learn_factors({both, both_of, knowing(order)}, per_group);
      }
      with.add_to(to);
      return told;
    };
    for (std::size_t shuffle = 0; shuffle < kShuffles; ++shuffle)
      add(&lent[shuffle], by_chance[shuffle]);
    return add(nullptr, scores);
  }

 private:
  [[nodiscard]] Chances without_knowledge(std::size_t fold) const {
    std::vector<const Step*> own, others;
    for (const std::vector<Step>* all : {&steps_.seen, &steps_.images})
      for (const Step& step : *all)
        if (fold_of_[static_cast<std::size_t>(step.body)] != fold)
          others.push_back(&step);
        else if (!step.is_image)
          own.push_back(&step);
    return {std::move(own), std::move(others), static_cast<int>(section_.faces.size()) + 1};
  }
  [[nodiscard]] static Shown shown_at(const Section& shown, StandingOf at) {
    return {shown, [](const Step& step) { return step.entry; }, std::move(at)};
  }
  [[nodiscard]] Shown entries_at(StandingOf at) const { return shown_at(entry_, std::move(at)); }
  /// The largest order, up to this one, at which a step has enough letters.
  [[nodiscard]] static int order_of(const Step& step, int order) {
    return std::min(order, static_cast<int>(step.letters.size()));
  }
  /// Where steps with remembered numbers stand, that is, all but the first of a trial.
  [[nodiscard]] static StandingOf knowing(int order) {
    return [order](const Step& step) {
      return step.is_first ? std::nullopt : standing(step, order_of(step, order));
    };
  }
  void learn(Chances& chances, int order) const {
    const Shown shown = entries_at([order](const Step& step) { return standing(step, order); });
    if (order == 0) chances.learn(shown, 0);
    chances.learn(shown, per_leaf_);
  }
  const Steps& steps_;
  const Letters& letters_;
  const Section& section_;
  Section entry_, numbers_;           // of one face: what an entry shows, what a body remembers
  std::vector<std::size_t> fold_of_;  // by body
  int per_leaf_;
};

/// Subtracts from the scores (bodies) the mean of those by chance (kShuffles x bodies). Returns the
/// variance of the sum over all bodies between shuffles.
double beyond_chance(std::vector<double>& scores, const std::vector<double>* by_chance) {
  std::array<double, kShuffles> sum{};
  double mean = 0.0, variance = 0.0;
  for (std::size_t shuffle = 0; shuffle < kShuffles; ++shuffle)
    for (std::size_t b = 0; b < scores.size(); ++b) {
      const double chance = by_chance[shuffle][b];
      sum[shuffle] += chance;
      mean += chance / kShuffles;
      scores[b] -= chance / kShuffles;
    }
  for (const double x : sum)
    variance += (x - mean) * (x - mean) / (kShuffles - 1) * (1.0 + 1.0 / kShuffles);
  return variance;
}

/// Numbers 0 to 9 for the bodies, in random order.
std::vector<std::size_t> dealt_folds(std::size_t bodies, std::uint64_t seed) {
  std::vector<std::size_t> order(bodies), fold(bodies);
  std::iota(order.begin(), order.end(), 0);
  Random random(Purpose::comparison, {seed, kFolding, 0});
  shuffle(order, random);
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
                       const Work& work, const Remembering* remembering) {
  if (remembering && remembering->pool.scattered.each.passed != pool.scattered.each.passed)
    throw std::invalid_argument("validate: what is remembered must be of the same bodies");
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
  const Steps steps = remembering
                          ? steps_of(remembering->map, remembering->pool, letters, options.most)
                          : steps_of(map, pool, letters, options.most);
  study.passages = std::ssize(steps.seen);
  const auto bodies = static_cast<std::size_t>(pool.bodies());
  const Section& shown = remembering ? remembering->map.section : map.section;
  const Folds folds(steps, letters, shown, map.section.coordinates.size(),
                    dealt_folds(bodies, options.seed), options.per_leaf);
  Shuffled shuffled(static_cast<std::size_t>(options.most));
  for (std::size_t k = 0; k < shuffled.size(); ++k)
    for (std::size_t shuffle = 0; shuffle < kShuffles; ++shuffle)
      shuffled[k][shuffle] = shuffled_letters(
          steps.seen, static_cast<int>(k) + 1,
          Random(Purpose::comparison, {options.seed, kShuffling, k * kShuffles + shuffle}));
  Scores scores(static_cast<std::size_t>(options.most) + 1, std::vector<double>(bodies, 0.0)),
      by_chance(scores.size() * kShuffles, scores.front());
  tbb::parallel_for(std::size_t{0}, kFolds, [&](std::size_t fold) {  // each has bodies of its own
    folds.score(fold, shuffled, scores, by_chance);
  });
  // What each letter adds beyond a shuffled one, and the variance of that sum between shuffles.
  std::vector<double> variance(scores.size(), 0.0);
  for (std::size_t k = 1; k < scores.size(); ++k) {
    variance[k] = beyond_chance(scores[k], &by_chance[k * kShuffles]);
    for (std::size_t b = 0; b < bodies; ++b) scores[k][b] += scores[k - 1][b];
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
  study.max_gates = problem.field.max_gates;
  if (const FieldTrials& each = pool.scattered.each;
      study.max_gates == 0 && each.endings.size() < each.passed.size())  // not seen to their ends
    study.max_gates = cells_of_most(each);
  const CrossValidationOptions how{
      .null_draws = {}, .seed = options.seed, .per_leaf = options.per_leaf};
  Problem compared = problem;
  compared.field.max_gates = study.max_gates;
  study.chosen = study.best;
  for (std::size_t k = 0; k < scores.size(); ++k) {
    work.tell("orders", static_cast<std::int64_t>(k), std::ssize(scores));
    OrderAnswer& a = study.orders.emplace_back();
    a.order = options.least + static_cast<int>(k);
    a.likelihood = std::exp(sums[k] / n);
    a.gain_to_best = std::expm1((sums[study.best] - sums[k]) / n);
    for (std::size_t side : {0, 1}) a.interval[side] = std::expm1(intervals[k][side] / n);
    if (a.is_enough() && k < study.chosen) study.chosen = k;
    if (a.order == 0) {
      a.words = 1;
      if (options.with_halves) a.halves = cross_validate(compared, pool, how);
      continue;
    }
    Problem with = compared;
    const ChosenWords chosen = words_of(letters, pool, a.order, options.per_leaf);
    with.cells.map = with_words(map, chosen.words);
    a.words = chosen.words->size();
    a.left_out = chosen.left_out;
    if (options.with_halves) a.halves = cross_validate(with, with_words(pool, with.map()), how);
  }
  if (!remembering) return study;
  const int order = study.answer().order;
  const std::vector<std::vector<Entry>> lent = folds.lent(order, options.seed);
  Scores knowing(1, std::vector<double>(bodies, 0.0)), by_lent(kShuffles, knowing.front());
  std::array<std::int64_t, kFolds> told{};
  tbb::parallel_for(std::size_t{0}, kFolds, [&](std::size_t fold) {
    told[fold] = folds.score_remembered(fold, order, lent, knowing.front(), by_lent);
  });
  RememberedAnswer& numbers = study.remembered.emplace();
  numbers.keys = remembering->keys;
  numbers.passages = std::accumulate(told.begin(), told.end(), std::int64_t{0});
  if (numbers.passages == 0) return study;
  const double between = beyond_chance(knowing.front(), by_lent.data());
  const double gained = std::accumulate(knowing.front().begin(), knowing.front().end(), 0.0);
  const auto interval = simultaneous_95(knowing, {between}, options.seed).front();
  const auto passages = static_cast<double>(numbers.passages);
  numbers.gain = std::expm1(gained / passages);
  for (std::size_t side : {0, 1}) numbers.interval[side] = std::expm1(interval[side] / passages);
  return study;
}

}  // namespace gatewalk::lattice
