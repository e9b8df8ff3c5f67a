// SPDX-License-Identifier: MIT
#include "dynamics/base/work.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gatewalk::dynamics {

void PieceSize::measured(std::int64_t count, double seconds) {
  constexpr double kSeconds = 0.3;
  constexpr std::int64_t kMost = std::int64_t{1} << 40;
  const std::int64_t ceiling = std::min(kMost, 4 * size_);
  const double wanted = static_cast<double>(count) * kSeconds / seconds;  // inf if too quick to see
  size_ = wanted < static_cast<double>(ceiling)
              ? std::max<std::int64_t>(least_, std::llround(wanted))
              : ceiling;
  size_ -= size_ % least_;
}

void Work::in_pieces(std::string_view what, std::int64_t total,
                     const std::function<void(TrialRange)>& run, std::int64_t together) const {
  PieceSize size(together);
  for (std::int64_t done = 0; done < total;) {
    tell(what, done, total);
    const std::int64_t count = std::min(size.get(), total - done);
    const Stopwatch watch;
    run({done, count});
    size.measured(count, watch.seconds());
    done += count;
  }
  tell(what, total, total);
}

void Work::in_pieces_of(const Stage& stage, const Steps& steps) const {
  const std::int64_t total = stage.items.count, end = stage.items.first + total;
  if (kept) kept->begin(stage);
  PieceSize size(ranks ? 1 : stage.together);
  for (std::int64_t at = stage.items.first; at < end;) {
    tell(stage.what, at - stage.items.first, total);
    const auto next = kept ? kept->next(at) : KeptPieces::Next{{at, end - at}, {}};
    if (!next) break;
    const auto [first, count] = next->items;
    if (next->bytes) {
      steps.take_bytes(*next->bytes);
      at = first + count;
      continue;
    }
    const Stopwatch watch;
    std::int64_t done = std::min(size.get(), count);
    if (ranks)
      done = on_all_ranks(next->items, size.get(), steps);
    else
      steps.run_and_take({first, done});
    size.measured(ranks ? std::max<std::int64_t>(1, done / ranks->size()) : done, watch.seconds());
    at = first + done;
  }
  tell(stage.what, total, total);
}

std::int64_t Work::on_all_ranks(TrialRange items, std::int64_t size, const Steps& steps) const {
  ranks->stop_if_asked();
  const std::int64_t each = ranks->of_first(size);
  const auto piece_of = [&](int rank) {
    const std::int64_t before = std::min(items.count, rank * each);
    return TrialRange{items.first + before, std::min(each, items.count - before)};
  };
  const TrialRange own = piece_of(ranks->rank());
  const auto all = ranks->all(own.count > 0 ? steps.run_to_bytes(own) : "");
  std::int64_t done = 0;
  for (int rank = 0; rank < ranks->size(); ++rank) {
    const TrialRange piece = piece_of(rank);
    if (piece.count == 0) break;
    const std::string& bytes = all[static_cast<std::size_t>(rank)];
    if (kept) kept->keep(piece, bytes);
    steps.take_bytes(bytes);
    done += piece.count;
  }
  return done;
}

Work Work::part(std::string what, std::size_t index, std::size_t count) const {
  constexpr double kEach = 1000.0;  // as fine as a progress line shows
  return part(std::move(what), kEach * static_cast<double>(index), kEach,
              std::llround(kEach * static_cast<double>(count)));
}

Work Work::part(std::string what, double from, double size, std::int64_t total) const {
  if (!told) return {{}, kept, ranks};
  return {[whole = told, what = std::move(what), from, size, total](
              std::string_view, std::int64_t done, std::int64_t of) {
            const double share = of > 0 ? static_cast<double>(done) / static_cast<double>(of) : 1.0;
            whole(what, std::llround(from + size * share), total);
          },
          kept, ranks};
}

}  // namespace gatewalk::dynamics
