// SPDX-License-Identifier: MIT
#include "dynamics/cells/check_cell.h"

#include <fmt/core.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "dynamics/cells/seen_passage.h"

namespace gatewalk::dynamics {
namespace {

using CheckedTrials = std::vector<std::vector<SeenPassage>>;

class CellChecker {
 public:
  CellChecker(const Cell& cell, const std::vector<Entry>& starts, const CheckOptions& options)
      : cell_(cell), section_(cell.section()), starts_(starts), options_(options) {}

  std::vector<std::string> run() {
    try {
      require_valid(cell_);
      check_starts();
      if (complaints_.empty()) check_passages();
    } catch (const std::exception& e) {
      complain(std::string("it threw: ") + e.what());
    }
    return std::move(complaints_);
  }

 private:
  void complain(std::string what) { complaints_.push_back(std::move(what)); }

  void check_starts() {
    for (const Entry& start : starts_) {
      if (start.face < 0 || start.face >= std::ssize(section_.faces))
        complain("a start is on face number " + std::to_string(start.face) + ", there are " +
                 std::to_string(section_.faces.size()));
      else if (cell_.is_symmetric() && mirrored(section_, mirrored(section_, start)) != start)
        complain("a start is not the mirror image of its mirror image");
    }
  }

  void check_passages() {
    const CheckedTrials trials = on_threads(cell_, 1);
    check_content(trials);
    compare(trials, on_threads(cell_, 1), "carried out once more");
    compare(trials, on_threads(cell_, 4), "on four threads");
    for (const std::int64_t at_once : {1, 7})
      compare(trials, in_batches(at_once), "with at most " + std::to_string(at_once) + " at once");
    compare(trials, alone_in_reverse(), "one by one in reverse order");
    const std::vector<Cell::Number> numbers = cell_.numbers();
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      const auto copy = cell_.with(k, 1.0);
      if (copy == nullptr || copy->section() != section_)
        complain("it cannot be had with once its own " + numbers[k].key);
      else
        compare(trials, on_threads(*copy, 1), "by a copy with the same " + numbers[k].key);
    }
    if (cell_.is_symmetric() && complaints_.empty()) check_symmetry(trials);
  }

  void begin(Body& body, std::int64_t trial, bool mirror = false) const {
    const Entry& start = starts_[static_cast<std::size_t>(trial) % starts_.size()];
    body.trial = trial;
    body.entry = mirror ? mirrored(section_, start) : start;
    // Mirror images get other noise, so that the two samples are independent.
    const Stream stream{options_.seed, cell_.stream_of(start),
                        static_cast<std::uint64_t>(trial + (mirror ? options_.trials : 0))};
    body.random = Random(Purpose::field, stream);
    cell_.begin(body);
  }
  /// Records a passage and returns whether the trial goes on.
  bool take(CheckedTrials& trials, const Body& body, const Passage& passage) const {
    std::vector<SeenPassage>& trial = trials[static_cast<std::size_t>(body.trial)];
    trial.push_back({passage, body.entry});
    return passage.fate == Fate::left && std::ssize(trial) < options_.cells &&
           body.entry.face >= 0 && body.entry.face < std::ssize(section_.faces);
  }
  [[nodiscard]] CheckedTrials no_trials() const {
    return CheckedTrials(static_cast<std::size_t>(options_.trials));
  }

  [[nodiscard]] CheckedTrials on_threads(const Cell& cell, int threads, bool mirror = false) const {
    CheckedTrials trials = no_trials();
    const tbb::global_control allow(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    arena.execute([&] {
      Health health;
      carry_out_trials_once(
          cell, options_.trials, [&](Body& body) { begin(body, body.trial, mirror); },
          [&](Body& body, const Passage& passage) { return take(trials, body, passage); }, health);
    });
    return trials;
  }

  [[nodiscard]] CheckedTrials in_batches(std::int64_t at_once) {
    CheckedTrials trials = no_trials();
    std::int64_t next_trial = 0, under_way = 0, most = 0, passages = 0;
    Health health;
    cell_.carry_out(
        [&](Body& body, const Passage* ended) {
          if (ended != nullptr) {
            ++passages;
            if (take(trials, body, *ended)) return true;
            --under_way;
          }
          if (next_trial == options_.trials) return false;
          most = std::max(most, ++under_way);
          begin(body, next_trial++);
          return true;
        },
        health, at_once);
    if (most > at_once)
      complain("carry_out had " + std::to_string(most) + " bodies at once, allowed were " +
               std::to_string(at_once));
    if (health.runs != passages)
      complain("carry_out counted " + std::to_string(health.runs) + " passages of " +
               std::to_string(passages));
    return trials;
  }

  [[nodiscard]] CheckedTrials alone_in_reverse() const {
    CheckedTrials trials = no_trials();
    for (std::int64_t trial = options_.trials; trial-- > 0;) {
      Body body{.entry = {}, .random = Random(Purpose::field, {})};
      begin(body, trial);
      while (take(trials, body, cell_.pass(body))) {
      }
    }
    return trials;
  }

  void compare(const CheckedTrials& a, const CheckedTrials& b, const std::string& how) {
    for (std::size_t trial = 0; trial < a.size(); ++trial)
      for (std::size_t k = 0; k < std::max(a[trial].size(), b[trial].size()); ++k)
        if (k >= a[trial].size() || k >= b[trial].size() || !a[trial][k].same_as(b[trial][k]))
          return complain("passage " + std::to_string(k) + " of trial " + std::to_string(trial) +
                          " is another one " + how);
  }

  void check_content(const CheckedTrials& trials) {
    std::int64_t broken = 0, passages = 0;
    for (std::size_t trial = 0; trial < trials.size(); ++trial)
      for (std::size_t k = 0; k < trials[trial].size(); ++k) {
        const SeenPassage& seen = trials[trial][k];
        ++passages;
        broken += seen.passage.fate == Fate::broken;
        if (seen.passage.fate == Fate::broken) continue;
        if (const std::string wrong = wrong_with(seen); !wrong.empty())
          return complain("passage " + std::to_string(k) + " of trial " + std::to_string(trial) +
                          ": " + wrong);
      }
    if (broken > 0)
      complain(std::to_string(broken) + " of " + std::to_string(passages) + " passages broke");
  }

  [[nodiscard]] std::string wrong_with(const SeenPassage& seen) const {
    const Costs& costs = seen.passage.costs;
    for (std::size_t c = 0; c < costs.size(); ++c) {
      if (c >= section_.costs.size() && costs[c] != 0.0) return "a cost that the section lacks";
      if (!std::isfinite(costs[c])) return section_.costs[c].key + " is not finite";
    }
    if (!section_.costs.empty() && !(costs[0] > 0.0)) return section_.costs[0].key + " is not > 0";
    if (seen.passage.fate != Fate::left) return {};
    const Entry& next = seen.passage.next;
    if (next.face < 0 || next.face >= std::ssize(section_.faces))
      return "it left by face number " + std::to_string(next.face) + ", there are " +
             std::to_string(section_.faces.size());
    for (std::size_t k = 0; k < next.at.size(); ++k) {
      if (k >= section_.coordinates.size() && next.at[k] != 0.0)
        return "a coordinate that the section lacks";
      if (!std::isfinite(next.at[k])) return section_.coordinates[k].name + " is not finite";
    }
    if (next != seen.body) return "the body is not where the passage says that it left";
    if (cell_.is_symmetric() && mirrored(section_, mirrored(section_, next)) != next)
      return "its entry is not the mirror image of its mirror image";
    return {};
  }

  /// Compares the first passages from each start, by face or fate, with those from the mirrored
  /// start.
  void check_symmetry(const CheckedTrials& trials) {
    const std::size_t faces = section_.faces.size(), kinds = faces + 2;
    std::vector<double> here(starts_.size() * kinds), there(here);
    const auto count = [&](const CheckedTrials& all, std::vector<double>& counts, bool mirror) {
      for (std::size_t trial = 0; trial < all.size(); ++trial) {
        const Passage& p = all[trial].front().passage;
        std::size_t kind = faces + (p.fate == Fate::trapped);
        if (p.fate == Fate::left)
          kind =
              static_cast<std::size_t>(mirror ? section_.faces[p.next.face].mirror : p.next.face);
        ++counts[trial % starts_.size() * kinds + kind];
      }
    };
    count(trials, here, false);
    count(on_threads(cell_, 1, true), there, true);
    double chi_squared = 0.0, free = 0.0;
    for (std::size_t k = 0; k < here.size(); ++k) {
      const double both = here[k] + there[k], apart = here[k] - there[k];
      if (both == 0.0) continue;
      chi_squared += apart * apart / both;
      free += 1.0;
    }
    free -= static_cast<double>(starts_.size());
    // A symmetric cell exceeds this bound in fewer than one of a million checks.
    if (chi_squared > free + 6.0 * std::sqrt(2.0 * std::max(free, 0.0)) + 20.0)
      complain(
          "it says that it is symmetric, but sends bodies from mirrored starts elsewhere "
          "(chi-squared " +
          fmt::format("{:f}", chi_squared) + " with " + std::to_string(std::lround(free)) +
          " degrees of freedom)");
  }

  const Cell& cell_;
  const Section& section_;
  const std::vector<Entry>& starts_;
  const CheckOptions options_;
  std::vector<std::string> complaints_;
};

}  // namespace

std::vector<std::string> check_cell(const Cell& cell, const std::vector<Entry>& starts,
                                    const CheckOptions& options) {
  if (starts.empty()) throw std::invalid_argument("a cell is checked from at least one start");
  return CellChecker(cell, starts, options).run();
}

}  // namespace gatewalk::dynamics
