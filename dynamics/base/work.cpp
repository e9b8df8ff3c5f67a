// SPDX-License-Identifier: MIT
#include "dynamics/base/work.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>

#include "dynamics/base/kept_pieces.h"

namespace gatewalk::dynamics {
namespace {

/// Does one piece on each rank, and returns the number of items done on all ranks.
std::int64_t on_all_ranks(const Work& work, TrialRange items, std::int64_t size,
                          const PieceSteps& steps) {
  Ranks* const ranks = work.ranks;
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
    if (work.kept) work.kept->keep(piece, bytes);
    steps.take_bytes(bytes);
    done += piece.count;
  }
  return done;
}

}  // namespace

void TrialSet::add(TrialRange range) {
  if (range.count <= 0) return;
  std::int64_t first = range.first, end = range.first + range.count;
  auto after = ends_.lower_bound(first);
  const bool follows = after != ends_.begin() && std::prev(after)->second > first;
  if (follows || (after != ends_.end() && after->first < end))
    throw std::invalid_argument("trial " +
                                std::to_string(follows ? first : std::max(first, after->first)) +
                                " is in the tally already");
  if (after != ends_.end() && after->first == end) {
    end = after->second;
    after = ends_.erase(after);
  }
  if (after != ends_.begin() && std::prev(after)->second == first)
    std::prev(after)->second = end;
  else
    ends_.emplace(first, end);
}

void TrialSet::add(const TrialSet& other) {
  TrialSet both = *this;
  for (const auto& [first, end] : other.ends_) both.add({first, end - first});
  *this = std::move(both);
}

std::int64_t TrialSet::count() const {
  std::int64_t n = 0;
  for (const auto& [first, end] : ends_) n += end - first;
  return n;
}

void PieceSize::measured(std::int64_t count, double seconds) {
  constexpr double kSeconds = 0.3;
  constexpr std::int64_t kMost = std::int64_t{1} << 40;
  const std::int64_t ceiling = std::min(kMost, 4 * size_);
  // Infinite if the time was too short to measure.
  const double wanted = static_cast<double>(count) * kSeconds / seconds;
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

void in_pieces_of(const Work& work, const Stage& stage, const PieceSteps& steps) {
  KeptPieces* const kept = work.kept;
  Ranks* const ranks = work.ranks;
  const std::int64_t total = stage.items.count, end = stage.items.first + total;
  if (kept) kept->begin(stage);
  PieceSize size(ranks ? 1 : stage.together);
  for (std::int64_t at = stage.items.first; at < end;) {
    work.tell(stage.what, at - stage.items.first, total);
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
      done = on_all_ranks(work, next->items, size.get(), steps);
    else
      steps.run_and_take({first, done});
    size.measured(ranks ? std::max<std::int64_t>(1, done / ranks->size()) : done, watch.seconds());
    at = first + done;
  }
  work.tell(stage.what, total, total);
}

bool has_share(const Work& work, const Stage& stage) {
  if (!work.kept || work.kept->has_share(stage)) return true;
  work.kept->begin(stage);
  return false;
}

bool Work::is_part() const { return kept && kept->is_part(); }
void Work::end_part() const {
  if (kept) kept->end_part();
}

Work Work::part(std::string what, std::size_t index, std::size_t count) const {
  constexpr double kEach = 1000.0;  // the resolution of a progress line
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
