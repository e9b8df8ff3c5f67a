// SPDX-License-Identifier: MIT
#pragma once
/// Long work whose finished pieces are kept in files or shared by several processes.

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

/// The number of items of the next piece: about 0.3 s of work, estimated from the pieces so far.
/// The number is a multiple of `least`, starts there, and grows at most fourfold at a time.
class PieceSize {
 public:
  explicit PieceSize(std::int64_t least = 1) : least_(least), size_(least) {}
  [[nodiscard]] std::int64_t get() const { return size_; }
  void measured(std::int64_t count, double seconds);

 private:
  std::int64_t least_, size_;
};

/// A stage of work: items with numbers (trials) that are done in pieces. If several stages are
/// divided together, `before` counts the items of earlier stages and `of` the items of all stages.
struct Stage {
  std::string_view what;
  TrialRange items;
  std::int64_t before = 0, of = items.count;
  std::int64_t together = 1;  // fewest items of a piece in a single process
};

/// A store of finished pieces, so that a stopped run can continue, and runs on several machines can
/// be combined. Every run of a command must have the same stages in the same order.
class KeptPieces {
 public:
  virtual ~KeptPieces() = default;
  /// Begins a stage: all following pieces belong to this stage.
  virtual void begin(const Stage& stage) = 0;
  /// The next piece from item `at` on: either a kept piece with its bytes, or items still to be
  /// done. nullopt: no further items of the stage are for this run. May throw if an item is
  /// missing.
  struct Next {
    TrialRange items;
    std::optional<std::string> bytes;
  };
  [[nodiscard]] virtual std::optional<Next> next(std::int64_t at) = 0;
  virtual void keep(TrialRange items, std::string bytes) = 0;
  /// Whether this run does only a part of each stage.
  [[nodiscard]] virtual bool is_part() const = 0;
  /// Whether any item of the stage is for this run.
  [[nodiscard]] virtual bool has_share(const Stage& stage) const = 0;
  /// Called where all pieces are needed. In a part, it throws the exception that ends the run.
  virtual void end_part() = 0;
};

/// Processes that run the same command and share its pieces. Each process receives the pieces of
/// all processes in the same order. All processes must make the same calls.
class Ranks {
 public:
  virtual ~Ranks() = default;
  [[nodiscard]] virtual int rank() const = 0;
  [[nodiscard]] virtual int size() const = 0;
  /// Broadcasts the first rank's number.
  [[nodiscard]] virtual std::int64_t of_first(std::int64_t number) = 0;
  /// Gathers the bytes of all ranks, by rank.
  [[nodiscard]] virtual std::vector<std::string> all(const std::string& own) = 0;
  /// Throws on all ranks if one of them has been asked to stop.
  virtual void stop_if_asked() = 0;
};

/// The three ways of doing a piece: run it and use the result here; run it and return the result as
/// bytes for other processes; use the bytes of a piece done before.
struct PieceSteps {
  std::function<void(TrialRange)> run_and_take;
  std::function<std::string(TrialRange)> run_to_bytes;
  std::function<void(std::string_view)> take_bytes;
};
void in_pieces_of(const Work& work, const Stage& stage, const PieceSteps& steps);

/// Runs a stage whose pieces can be kept. take() receives the result of run(range), or the kept
/// result, in the order of the ranges. `none` is a T of no items. A part of a run handles only its
/// own items, perhaps none.
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

/// Whether this run does any items of the stage. If not, the stage counts as done and need not be
/// prepared.
[[nodiscard]] bool has_share(const Work& work, const Stage& stage);

}  // namespace gatewalk::dynamics
