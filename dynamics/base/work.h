// SPDX-License-Identifier: MIT
#pragma once
/// Long work in pieces that somebody may watch and stop.

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "dynamics/base/bytes.h"
#include "dynamics/base/trial_set.h"

namespace gatewalk::dynamics {

/// How many items to do before looking up again: about 0.3 s of work, learnt from the pieces so
/// far. A multiple of `least`, with which it starts; grows at most fourfold at a time.
class PieceSize {
 public:
  explicit PieceSize(std::int64_t least = 1) : least_(least), size_(least) {}
  [[nodiscard]] std::int64_t get() const { return size_; }
  void measured(std::int64_t count, double seconds);

 private:
  std::int64_t least_, size_;
};

/// Items of work that are done in one go, or in pieces: trials, by their numbers. Several stages
/// that are divided as one have so many items `before` this one, `of` all of them.
struct Stage {
  std::string_view what;
  TrialRange items;
  std::int64_t before = 0, of = items.count;
  std::int64_t together = 1;  // fewest of a piece, where one process does them all
};

/// Finished pieces that are kept: a run that was stopped goes on where it was, and runs on several
/// machines make one. Every run of a command has the same stages in the same order.
class KeptPieces {
 public:
  virtual ~KeptPieces() = default;
  /// From now on pieces are of this stage.
  virtual void begin(const Stage& stage) = 0;
  /// What comes first from item `at` on: a piece that is kept, with its bytes; or items that are to
  /// be done. None: what is left is not for this run. May throw where an item is missing.
  struct Next {
    TrialRange items;
    std::optional<std::string> bytes;
  };
  [[nodiscard]] virtual std::optional<Next> next(std::int64_t at) = 0;
  virtual void keep(TrialRange items, std::string bytes) = 0;
  /// This run does a part of each stage only.
  [[nodiscard]] virtual bool is_part() const = 0;
  /// Whether any item of the stage is for this run.
  [[nodiscard]] virtual bool has_share(const Stage& stage) const = 0;
  /// From here on all pieces are needed: a part ends. Throws what ends it.
  virtual void end_part() = 0;
};

/// Processes that carry out the same command and share its pieces among them: each gets those of
/// all, in the same order. All of them make the same calls.
class Ranks {
 public:
  virtual ~Ranks() = default;
  [[nodiscard]] virtual int rank() const = 0;
  [[nodiscard]] virtual int size() const = 0;
  /// The first rank's number.
  [[nodiscard]] virtual std::int64_t of_first(std::int64_t number) = 0;
  /// Each rank's bytes, by rank.
  [[nodiscard]] virtual std::vector<std::string> all(const std::string& own) = 0;
  /// Throws on all of them where one is to stop.
  virtual void stop_if_asked() = 0;
};

/// Whoever starts long work says here who is told how far it is, who keeps what is done, and who
/// shares it. Nobody by default.
struct Work {
  /// Told before each piece, and when all is done: `done` of `total` of what. May throw to stop.
  std::function<void(std::string_view what, std::int64_t done, std::int64_t total)> told;
  KeptPieces* kept = nullptr;
  Ranks* ranks = nullptr;

  /// Calls run(range) for consecutive ranges that cover [0, total) exactly once, as long as
  /// PieceSize says, of `together` at least. The ranges depend on the machine's speed, so results
  /// must not depend on how [0, total) is cut.
  void in_pieces(std::string_view what, std::int64_t total,
                 const std::function<void(TrialRange)>& run, std::int64_t together = 1) const;

  /// The same of work whose pieces can be kept: what run(range) returns goes to take(T), in the
  /// order of the ranges, and so do the pieces that are kept already. `none`: a T of no items. A
  /// part of a run takes its own items only, and may take none.
  template <class T>
  void in_kept_pieces(const Stage& stage, const T& none,
                      const std::type_identity_t<std::function<T(TrialRange)>>& run,
                      const std::type_identity_t<std::function<void(T)>>& take) const {
    if (!kept && !ranks) {
      in_pieces(
          stage.what, stage.items.count,
          [&](TrialRange range) {
            take(run({stage.items.first + range.first, range.count}));
          },
          stage.together);
      return;
    }
    const auto take_bytes = [&](std::string_view bytes) {
      T done = none;
      read_bytes(bytes, done);
      take(std::move(done));
    };
    const auto run_to_bytes = [&](TrialRange range) { return bytes_of(run(range)); };
    const auto run_and_take = [&](TrialRange range) {
      T done = run(range);
      kept->keep(range, bytes_of(done));
      take(std::move(done));
    };
    in_pieces_of(stage, {run_and_take, run_to_bytes, take_bytes});
  }
  /// A part of a run knows some of its trials only, and has no result.
  [[nodiscard]] bool is_part() const { return kept && kept->is_part(); }
  /// Whether to prepare a stage, of which a part may do nothing. It is done with where not.
  [[nodiscard]] bool has_share(const Stage& stage) const {
    if (!kept || kept->has_share(stage)) return true;
    kept->begin(stage);
    return false;
  }
  /// Where all trials are needed from here on: ends a part.
  void end_part() const {
    if (kept) kept->end_part();
  }

  /// Part number `index` of `count` of equal size, all under one name: what is told of it is told
  /// as that share of the whole.
  [[nodiscard]] Work part(std::string what, std::size_t index, std::size_t count) const;
  /// The same for parts of any size: from `from` to `from + size` of `total`.
  [[nodiscard]] Work part(std::string what, double from, double size, std::int64_t total) const;

  /// Tells it, if there is somebody.
  void tell(std::string_view what, std::int64_t done, std::int64_t total) const {
    if (told) told(what, done, total);
  }

 private:
  struct Steps {
    std::function<void(TrialRange)> run_and_take;
    std::function<std::string(TrialRange)> run_to_bytes;
    std::function<void(std::string_view)> take_bytes;
  };
  void in_pieces_of(const Stage& stage, const Steps& steps) const;
  /// One piece on each rank.
  [[nodiscard]] std::int64_t on_all_ranks(TrialRange items, std::int64_t size,
                                          const Steps& steps) const;
};

/// Seconds since construction.
class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace gatewalk::dynamics
