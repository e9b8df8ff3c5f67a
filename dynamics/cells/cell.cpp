// SPDX-License-Identifier: MIT
#include "dynamics/cells/cell.h"

#include <Random123/philox.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <stdexcept>

#include "dynamics/cells/seen_passage.h"

namespace gatewalk::dynamics {

void Cell::carry_out(const NextPassage& next, Health& health, std::int64_t) const {
  Body body{.entry = {}, .random = Random(Purpose::gate, {})};
  for (bool more = next(body, nullptr); more;) {
    const Passage passage = pass(body);
    ++health.runs;
    health.broken += passage.fate == Fate::broken;
    more = next(body, &passage);
  }
}

std::uint64_t Cell::stream_of(const Entry& start) const {
  // A hash of the bits of the start's numbers, made by the random generator.
  const std::vector<Coordinate>& coordinates = section().coordinates;
  r123::Philox4x64::ctr_type hash = {{static_cast<std::uint64_t>(start.face), 0, 0, 0}};
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    // -0 becomes 0
    hash[1] = std::bit_cast<std::uint64_t>(start.at[k] / coordinates[k].scale + 0.0);
    hash = r123::Philox4x64()(hash, {{0, 0}});
  }
  return hash[0] >> 8;  // the top byte of a key holds the purpose
}

void require_valid(const Cell& cell) {
  const Section& section = cell.section();
  section.validate();
  for (const Face& face : section.faces)
    if (cell.is_symmetric() && face.mirror == kNoMirror)
      throw std::invalid_argument("section: face " + face.name +
                                  " of a symmetric cell has no mirror image: set_mirrors gives it");
}

CellField CellField::uniform(std::shared_ptr<const Cell> cell) {
  require_valid(*cell);
  CellMap map{.section = cell->section(), .types = {{cell->is_symmetric()}}, .type_of_cell = {}};
  return {std::move(map), {std::move(cell)}};
}

/// Runs trials on several threads: a free thread takes the next trial, so no thread waits for the
/// end of a block.
class TrialsOfCell {
 public:
  TrialsOfCell(const Cell& cell, std::int64_t count, const BeginBody& begin,
               const TakePassage& take, bool once_more)
      : cell_(cell),
        count_(count),
        begin_(begin),
        take_(take),
        once_more_(once_more && cell.has_to_show_itself()),
        passed_before_(cell.passed_.count),
        first_ones_(passed_before_ == 0 ? kFirstOnes : 0) {}

  void carry_out(Health& health) {
    // A thread holds no more than its share.
    const std::int64_t each = (count_ + threads_ - 1) / threads_;
    tbb::enumerable_thread_specific<Health> parts;  // sums and maxima do not depend on the order
    tbb::parallel_for(0, threads_, [&](int) {
      try {
        Share share(*this);
        share.carry_out(parts.local(), each);
      } catch (...) {
        next_trial_ = count_;  // no thread takes another trial
        throw;
      }
    });
    for (const Health& part : parts) health += part;
  }

 private:
  /// Which passages are repeated: the first `kFirstOnes` of a new cell, then one in `kOneOf`. At
  /// most `kMostKept` passages wait for their repetition. A cell repeats them after `kFirstTime`
  /// passages and whenever that number has doubled, but not before `kEnough` passages wait. A run
  /// of fewer than `kFew` passages repeats all of its own at its end.
  static constexpr std::int64_t kFirstOnes = 4, kOneOf = 20, kMostKept = 64, kFirstTime = 128,
                                kEnough = 8, kFew = 2 * kMostKept * kOneOf;

  /// The part of the trials that one thread runs.
  class Share {
   public:
    explicit Share(TrialsOfCell& all) : all_(all) {
      while (next_time_ <= all.passed_before_) next_time_ *= 2;
    }
    ~Share() { all_.cell_.passed_.count += begun_; }
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;

    void carry_out(Health& health, std::int64_t at_once) {
      const NextPassage next = [this](Body& body, const Passage* ended) {
        return this->next(body, ended);
      };
      do {
        is_time_ = false;
        all_.cell_.carry_out(next, health, at_once);
        if (!is_time_ && passed() >= kFew) break;
        see_once_more(at_once);
      } while (is_time_);
    }

   private:
    /// A finished passage and the body before it.
    struct Seen {
      Body before;
      SeenPassage once;
    };

    bool next(Body& body, const Passage* ended) {
      if (ended != nullptr) {
        if (!watched_.empty()) keep(body, *ended);
        if (all_.take_(body, *ended)) return begin(body);
      }
      if (is_time_) return false;
      if (!waiting_.empty()) {
        body = waiting_.back();
        waiting_.pop_back();
        return begin(body);
      }
      body.trial = all_.next_trial_.fetch_add(1, std::memory_order_relaxed);
      if (body.trial >= all_.count_) return false;
      all_.begin_(body);
      return begin(body);
    }
    /// Returns false if the body must wait until the kept passages have been repeated.
    bool begin(const Body& body) {
      if (!all_.once_more_) return true;
      if (passed() >= next_time_ && std::ssize(watched_) + std::ssize(seen_) >= kEnough)
        is_time_ = true;
      if (is_time_) {
        waiting_.push_back(body);
        return false;
      }
      ++begun_;
      if (is_wanted(body.trial)) watched_.push_back(body);
      return true;
    }
    /// Estimated number of passages, as if all threads had begun as many as this one.
    [[nodiscard]] std::int64_t passed() const {
      return all_.passed_before_ + begun_ * all_.threads_;
    }
    [[nodiscard]] bool is_wanted(std::int64_t trial) {
      if (std::ssize(watched_) + std::ssize(seen_) >= kMostKept) return false;
      const bool is_first = all_.first_ones_ > 0 && all_.first_ones_-- > 0;
      if (!is_first && begun_ % kOneOf != 0) return false;
      return std::none_of(seen_.begin(), seen_.end(),  // the trial's number identifies a passage
                          [&](const Seen& seen) { return seen.before.trial == trial; });
    }
    void keep(const Body& body, const Passage& passage) {
      const auto found = std::find_if(watched_.begin(), watched_.end(),
                                      [&](const Body& w) { return w.trial == body.trial; });
      if (found == watched_.end()) return;
      seen_.push_back({*found, {passage, body.entry}});
      watched_.erase(found);
    }

    void see_once_more(std::int64_t at_once) {
      while (next_time_ <= passed()) next_time_ *= 2;
      if (seen_.empty()) return;
      const auto seen = std::exchange(seen_, {});
      auto next_one = seen.rbegin();
      Health uncounted;
      all_.cell_.carry_out_once_more(
          [&](Body& body, const Passage* ended) {
            if (ended != nullptr) compare(seen, body, *ended);
            if (next_one == seen.rend()) return false;
            body = (next_one++)->before;
            return true;
          },
          uncounted, std::min(at_once, std::ssize(seen)));
    }
    void compare(const std::vector<Seen>& seen, const Body& body, const Passage& passage) const {
      const auto was = std::find_if(seen.begin(), seen.end(),
                                    [&](const Seen& s) { return s.before.trial == body.trial; });
      const SeenPassage again{passage, body.entry};
      if (was == seen.end() || was->once.same_as(again)) return;
      const Section& section = all_.cell_.section();
      throw std::runtime_error(
          "the cell answers the same passage in two ways: a body that entered by " +
          words_of(section, was->before.entry) + " " + was->once.words(section) +
          "; sent once more, with the same noise and seed, in another order, it " +
          again.words(section) +
          ". What becomes of a body must depend on its entry, its noise (or its seed) and what it "
          "carries alone: never on the clock, on what came before, or on the process. Seed the "
          "generator with the seed of each passage, and keep nothing from one to the next");
    }

    TrialsOfCell& all_;
    std::int64_t begun_ = 0, next_time_ = kFirstTime;
    bool is_time_ = false;
    // Bodies under way whose passage is to be repeated; bodies that wait for the repetition.
    std::vector<Body> watched_, waiting_;
    std::vector<Seen> seen_;
  };

  const Cell& cell_;
  const std::int64_t count_;
  const BeginBody& begin_;
  const TakePassage& take_;
  const bool once_more_;
  const int threads_ = tbb::this_task_arena::max_concurrency();
  const std::int64_t passed_before_;
  std::atomic<std::int64_t> first_ones_, next_trial_{0};
};

void carry_out_trials(const Cell& cell, std::int64_t count, const BeginBody& begin,
                      const TakePassage& take, Health& health) {
  TrialsOfCell(cell, count, begin, take, true).carry_out(health);
}

void carry_out_trials_once(const Cell& cell, std::int64_t count, const BeginBody& begin,
                           const TakePassage& take, Health& health) {
  TrialsOfCell(cell, count, begin, take, false).carry_out(health);
}

}  // namespace gatewalk::dynamics
