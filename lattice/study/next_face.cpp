// SPDX-License-Identifier: MIT
#include "lattice/study/next_face.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <utility>

#include "dynamics/cells/tree_space.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

/// The groups of some steps, and of any other step.
class Groups {
 public:
  Groups(const std::vector<const Step*>& steps, const Shown& shown, int per_leaf)
      : shown_(shown), group_(steps.size(), -1) {
    std::map<Standing, std::vector<std::size_t>> alike;
    for (std::size_t i = 0; i < steps.size(); ++i)
      if (auto place = shown.at(*steps[i])) alike[*std::move(place)].push_back(i);
    for (const auto& [place, members] : alike) {
      Trees trees{.first = size_};
      int leaves = 1;
      std::vector<int> leaf(members.size(), 0);
      if (per_leaf > 0 && std::ssize(members) >= 2 * per_leaf) {
        EntryTable entries(shown.section);
        for (const std::size_t i : members) entries.push_back({0, shown.of(*steps[i]).at});
        trees.space.emplace(tree_space(shown.section, entries, per_leaf, {}, &leaf));
        leaves = trees.space->size();
      }
      for (std::size_t k = 0; k < members.size(); ++k) group_[members[k]] = size_ + leaf[k];
      size_ += leaves;
      trees_.emplace(place, std::move(trees));
    }
  }
  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] const std::vector<int>& of_steps() const { return group_; }
  [[nodiscard]] int of(const Step& step) const {
    const Trees* const trees = trees_of(step);
    if (trees == nullptr) return -1;
    const auto& [first, space] = *trees;
    return first + (space ? space->index_of({0, shown_.of(step).at}).state : 0);
  }
  /// Whether there are several groups where the step stands.
  [[nodiscard]] bool is_divided(const Step& step) const {
    const Trees* const trees = trees_of(step);
    return trees != nullptr && trees->space && trees->space->size() > 1;
  }

 private:
  struct Trees {
    int first = 0;                      // group of the first leaf
    std::optional<StateSpace> space{};  // none: a single leaf
  };
  [[nodiscard]] const Trees* trees_of(const Step& step) const {
    const auto place = shown_.at(step);
    const auto found = place ? trees_.find(*place) : trees_.end();
    return found == trees_.end() ? nullptr : &found->second;
  }
  const Shown& shown_;
  std::map<Standing, Trees> trees_;
  std::vector<int> group_;
  int size_ = 0;
};

/// Numbers by group and outcome, with a row of zeros for steps without a group.
class ByGroup {
 public:
  ByGroup(int groups, std::size_t outcomes)
      : outcomes_(outcomes), numbers_(static_cast<std::size_t>(groups + 1) * outcomes, 0.0) {}
  [[nodiscard]] std::span<double> operator[](int group) {
    return {&numbers_[static_cast<std::size_t>(group + 1) * outcomes_], outcomes_};
  }

 private:
  std::size_t outcomes_;
  std::vector<double> numbers_;
};

/// The weight, a power of 2, with the largest sum of `log_likelihood`.
template <class LogLikelihood>
double best_weight(LogLikelihood log_likelihood) {
  double best = 0.0, most = -std::numeric_limits<double>::infinity();
  constexpr double kLeast = 0.5, kMost = 5000.0;
  for (double weight = kLeast; weight < kMost; weight *= 2.0)
    if (const double sum = log_likelihood(weight); sum > most) {
      most = sum;
      best = weight;
    }
  return best;
}

}  // namespace

Steps steps_of(const CellMap& map, const RunPool& pool, const Letters& letters, int most) {
  const Section& section = map.section;
  const auto faces = static_cast<int>(section.faces.size());
  const bool images = letters.of != LettersOf::states;
  Steps steps;
  const FieldTrials& trials = pool.scattered.each;
  for (std::size_t i = 0; i < trials.passed.size(); ++i) {
    std::vector<int> before;
    Entry entry = pool.scattered.starts[i];
    bool is_first = true;
    for (const CellPassage passage : trials.of_trial(i)) {
      if (passage.fate == Fate::broken) break;
      const bool left = passage.fate == Fate::left;
      const Step& step = steps.seen.emplace_back(
          Step{trials.bodies[i], passage.type, entry, left ? passage.entry.face : faces, before,
               steps.seen.size(), false, std::exchange(is_first, false)});
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

std::optional<Standing> standing(const Step& step, int order) {
  if (std::ssize(step.letters) < order) return {};
  Standing at{step.type, step.entry.face};
  at.insert(at.end(), step.letters.end() - order, step.letters.end());
  return at;
}
std::optional<Standing> standing(const Step& step, int order, int earliest) {
  auto at = standing(step, order);
  if (at) (*at)[2] = earliest;
  return at;
}

std::vector<int> groups_of(const std::vector<const Step*>& steps, const Shown& shown,
                           int per_leaf) {
  return Groups(steps, shown, per_leaf).of_steps();
}

Chances::Chances(std::vector<const Step*> own, std::vector<const Step*> others, int outcomes)
    : own_(std::move(own)),
      others_(std::move(others)),
      outcomes_(static_cast<std::size_t>(outcomes)),
      of_own_(own_.size() * outcomes_, 1.0 / outcomes),
      of_others_(others_.size() * outcomes_, 1.0 / outcomes) {}

void Chances::learn(const Shown& shown, int per_leaf) {
  const Groups groups(others_, shown, per_leaf);
  ByGroup counts(groups.size(), outcomes_);
  std::vector<double> all(static_cast<std::size_t>(groups.size()) + 1, 0.0);
  for (std::size_t i = 0; i < others_.size(); ++i)
    if (const int group = groups.of_steps()[i]; group >= 0) {
      ++counts[group][static_cast<std::size_t>(others_[i]->outcome)];
      ++all[static_cast<std::size_t>(group) + 1];
    }
  const auto smoothed = [](double count, double of_all, double weight, double before) {
    return (count + weight * before) / (of_all + weight);
  };
  // The chance of an outcome of one of the others, learned from the rest.
  const auto without_itself = [&](std::size_t i, std::size_t outcome, double weight) {
    const int group = groups.of_steps()[i];
    const bool is_own = static_cast<int>(outcome) == others_[i]->outcome && group >= 0;
    return smoothed(counts[group][outcome] - (is_own ? 1.0 : 0.0),
                    all[static_cast<std::size_t>(group + 1)] - (group >= 0 ? 1.0 : 0.0), weight,
                    of_others_[i * outcomes_ + outcome]);
  };
  const double weight = best_weight([&](double tried) {
    double sum = 0.0;
    for (std::size_t i = 0; i < others_.size(); ++i)
      sum += std::log(without_itself(i, static_cast<std::size_t>(others_[i]->outcome), tried));
    return sum;
  });
  for (std::size_t i = 0; i < others_.size(); ++i)
    for (std::size_t o = 0; o < outcomes_; ++o)
      of_others_[i * outcomes_ + o] = without_itself(i, o, weight);
  for (std::size_t i = 0; i < own_.size(); ++i) {
    const int group = groups.of(*own_[i]);
    for (std::size_t o = 0; o < outcomes_; ++o) {
      double& chance = of_own_[i * outcomes_ + o];
      chance = smoothed(counts[group][o], all[static_cast<std::size_t>(group + 1)], weight, chance);
    }
  }
}

std::int64_t Chances::learn_factors(const Shown& shown, int per_leaf) {
  const Groups groups(others_, shown, per_leaf);
  ByGroup seen(groups.size(), outcomes_), expected(groups.size(), outcomes_);
  for (std::size_t i = 0; i < others_.size(); ++i)
    if (const int group = groups.of_steps()[i]; group >= 0) {
      ++seen[group][static_cast<std::size_t>(others_[i]->outcome)];
      for (std::size_t o = 0; o < outcomes_; ++o)
        expected[group][o] += of_others_[i * outcomes_ + o];
    }
  std::vector<double> chances(outcomes_);
  // The chances of a step in a group; `itself`: the outcome of a step that the group holds.
  const auto changed = [&](int group, const double* before, std::optional<int> itself,
                           double weight) {
    double sum = 0.0;
    for (std::size_t o = 0; o < outcomes_; ++o) {
      const bool is_in = itself && group >= 0;
      const double more = is_in && *itself == static_cast<int>(o) ? 1.0 : 0.0;
      const double factor =
          (seen[group][o] - more + weight) /
          (std::max(0.0, expected[group][o] - (is_in ? before[o] : 0.0)) + weight);
      sum += chances[o] = before[o] * factor;
    }
    for (double& chance : chances) chance /= sum;
  };
  const double weight = best_weight([&](double tried) {
    double sum = 0.0;
    for (std::size_t i = 0; i < others_.size(); ++i) {
      changed(groups.of_steps()[i], &of_others_[i * outcomes_], others_[i]->outcome, tried);
      sum += std::log(chances[static_cast<std::size_t>(others_[i]->outcome)]);
    }
    return sum;
  });
  const auto change = [&](double* before, int group, std::optional<int> itself) {
    changed(group, before, itself, weight);
    std::copy(chances.begin(), chances.end(), before);
  };
  for (std::size_t i = 0; i < others_.size(); ++i)
    change(&of_others_[i * outcomes_], groups.of_steps()[i], others_[i]->outcome);
  std::int64_t divided = 0;
  for (std::size_t i = 0; i < own_.size(); ++i) {
    change(&of_own_[i * outcomes_], groups.of(*own_[i]), {});
    divided += groups.is_divided(*own_[i]);
  }
  return divided;
}

void Chances::add_to(std::vector<double>& scores) const {
  for (std::size_t i = 0; i < own_.size(); ++i)
    scores[static_cast<std::size_t>(own_[i]->body)] +=
        std::log(of_own_[i * outcomes_ + static_cast<std::size_t>(own_[i]->outcome)]);
}

}  // namespace gatewalk::lattice
