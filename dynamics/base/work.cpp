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
  size_ = wanted < static_cast<double>(ceiling) ? std::max<std::int64_t>(1, std::llround(wanted))
                                                : ceiling;
}

void Work::in_pieces(std::string_view what, std::int64_t total,
                     const std::function<void(TrialRange)>& run) const {
  PieceSize size;
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

void Work::in_pieces_of(const Stage& stage, const std::function<void(TrialRange)>& run,
                        const std::function<void(std::string_view)>& take_kept) const {
  const std::int64_t total = stage.items.count, end = stage.items.first + total;
  kept->begin(stage);
  PieceSize size;
  for (std::int64_t at = stage.items.first; at < end;) {
    tell(stage.what, at - stage.items.first, total);
    const auto next = kept->next(at);
    if (!next) break;
    const auto [first, count] = next->items;
    if (next->bytes) {
      take_kept(*next->bytes);
      at = first + count;
      continue;
    }
    const TrialRange range{first, std::min(size.get(), count)};
    const Stopwatch watch;
    run(range);
    size.measured(range.count, watch.seconds());
    at = first + range.count;
  }
  tell(stage.what, total, total);
}

Work Work::part(std::string what, std::size_t index, std::size_t count) const {
  constexpr double kEach = 1000.0;  // as fine as a progress line shows
  return part(std::move(what), kEach * static_cast<double>(index), kEach,
              std::llround(kEach * static_cast<double>(count)));
}

Work Work::part(std::string what, double from, double size, std::int64_t total) const {
  if (!told) return {{}, kept};
  return {[whole = told, what = std::move(what), from, size, total](
              std::string_view, std::int64_t done, std::int64_t of) {
            const double share = of > 0 ? static_cast<double>(done) / static_cast<double>(of) : 1.0;
            whole(what, std::llround(from + size * share), total);
          },
          kept};
}

}  // namespace gatewalk::dynamics
