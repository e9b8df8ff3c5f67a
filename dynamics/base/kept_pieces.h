// SPDX-License-Identifier: MIT
#pragma once
/// Long work whose finished pieces are kept in files, or shared by several processes.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "dynamics/base/bytes.h"
#include "dynamics/base/work.h"

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

/// Items of work that are done in one go, or in pieces: trials, by their numbers. Where several
/// stages are divided together, `before` counts the items of the stages before this one, and `of`
/// the items of all stages.
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

/// How a stage's items are done: in this process, for other processes, and as bytes of a piece that
/// was done before.
struct PieceSteps {
  std::function<void(TrialRange)> run_and_take;
  std::function<std::string(TrialRange)> run_to_bytes;
  std::function<void(std::string_view)> take_bytes;
};
void in_pieces_of(const Work& work, const Stage& stage, const PieceSteps& steps);

/// The same of work whose pieces can be kept: what run(range) returns goes to take(T), in the
/// order of the ranges, and so do the pieces that are kept already. `none`: a T of no items. A
/// part of a run takes its own items only, and may take none.
template <class T>
void in_kept_pieces(const Work& work, const Stage& stage, const T& none,
                    const std::type_identity_t<std::function<T(TrialRange)>>& run,
                    const std::type_identity_t<std::function<void(T)>>& take) {
  if (!work.kept && !work.ranks) {
    work.in_pieces(
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
    work.kept->keep(range, bytes_of(done));
    take(std::move(done));
  };
  in_pieces_of(work, stage, {run_and_take, run_to_bytes, take_bytes});
}

/// Whether this part of a divided run does any items of the stage. If it does none, the stage need
/// not be prepared, and counts as done.
[[nodiscard]] bool has_share(const Work& work, const Stage& stage);

}  // namespace gatewalk::dynamics
