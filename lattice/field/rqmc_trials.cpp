// SPDX-License-Identifier: MIT
#include "lattice/field/rqmc_trials.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <span>
#include <utility>

#include "dynamics/base/kept_pieces.h"
#include "dynamics/base/work.h"
#include "lattice/field/running_trial.h"

namespace gatewalk::lattice {

using namespace dynamics;

FirstPoints::FirstPoints(std::uint64_t seed, std::uint64_t stream, std::int64_t numbers) {
  for (std::int64_t a = 0; a < kArrays; ++a) {
    Random random(Purpose::first_points, {seed, stream, static_cast<std::uint64_t>(numbers + a)});
    arrays_.emplace_back(random);
  }
}

Point FirstPoints::operator()(std::int64_t i) const {
  return arrays_[static_cast<std::size_t>(i % kArrays)](static_cast<std::uint32_t>(i / kArrays));
}

bool lays_noise(const CellField& cells) {
  return !cells.cells.empty() && std::all_of(cells.cells.begin(), cells.cells.end(),
                                             [](const auto& cell) { return cell->lays_noise(); });
}

namespace {

/// A body that is about to enter a cell.
struct Entering {
  std::size_t place;  // index of its trial
  Entry entry;
};

/// The axis along which the entries spread most, in the section's scales.
std::size_t longest_axis(const Section& section, std::span<const Entering> part) {
  std::size_t longest = 0;
  double most = -1.0;
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis) {
    double sum = 0.0, squares = 0.0;
    for (const Entering& e : part) {
      const double x = e.entry.at[axis] - part.front().entry.at[axis];
      sum += x;
      squares += x * x;
    }
    const double scale = section.coordinates[axis].scale;
    const double spread =
        (squares - sum * sum / static_cast<double>(part.size())) / (scale * scale);
    if (spread > most) {
      most = spread;
      longest = axis;
    }
  }
  return longest;
}

/// Sorts entries so that neighbours enter alike. The range is halved again and again: first by
/// face, then across the longest axis, always where the point numbers split into nets.
void put_in_order(const Section& section, std::span<Entering> part) {
  if (part.size() < 2) return;
  const auto cut = std::bit_floor(part.size() - 1);
  const bool faces = std::any_of(part.begin(), part.end(), [&](const Entering& e) {
    return e.entry.face != part.front().entry.face;
  });
  const std::size_t axis = faces ? 0 : longest_axis(section, part);
  const auto middle = part.begin() + static_cast<std::ptrdiff_t>(cut);
  std::nth_element(part.begin(), middle, part.end(), [&](const Entering& a, const Entering& b) {
    if (a.entry.face != b.entry.face) return a.entry.face < b.entry.face;
    if (a.entry.at[axis] != b.entry.at[axis]) return a.entry.at[axis] < b.entry.at[axis];
    return a.place < b.place;
  });
  put_in_order(section, part.first(cut));
  put_in_order(section, part.subspan(cut));
}

/// All trials of the arrays under way, all at the same step.
class Arrays {
 public:
  Arrays(const CellField& cells, const FieldParams& field, const RqmcTrials& trials,
         std::uint64_t seed)
      : cells_(cells), field_(field), trials_(trials) {
    const auto count = static_cast<std::size_t>(trials.count());
    for (std::size_t place = 0; place < count; ++place) running_.emplace_back(field);
    bodies_.assign(count, Body{.entry = {}, .random = Random(Purpose::field, {})});
    const Cell& first = cells.at(field.start_column(), field.start_row);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t place) {
      const std::int64_t i = number(place);
      begin_trial(first, trials.start(i), seed, trials.numbers + i, bodies_[place]);
    });
    const std::uint64_t stream = first.stream_of(trials.start(trials.first));
    for (int a = 0; a < trials.arrays; ++a)
      scrambles_.emplace_back(
          Purpose::points,
          Stream{seed, stream,
                 static_cast<std::uint64_t>(trials.numbers + trials.first + trials.array + a)});
    for (std::size_t place = 0; place < count; ++place) live_.push_back(place);
  }

  [[nodiscard]] bool any() const { return !live_.empty(); }
  [[nodiscard]] std::int64_t ended() const { return trials_.count() - std::ssize(live_); }

  /// Sets the noise of every body's next passage.
  void lay() {
    const std::size_t types = cells_.cells.size(),
                      arrays = static_cast<std::size_t>(trials_.arrays);
    std::vector<std::vector<Entering>> parts(types * arrays);
    waves_.assign(types, {});
    for (const std::size_t place : live_) {
      const auto type = type_of(place);
      waves_[type].push_back(place);
      parts[type * arrays + array_of(place)].push_back({place, bodies_[place].entry});
    }
    const bool first = std::exchange(first_, false);
    tbb::parallel_for(std::size_t{0}, arrays, [&](std::size_t a) {
      for (std::size_t type = 0; type < types; ++type) {
        std::vector<Entering>& part = parts[type * arrays + a];
        const Cell& cell = *cells_.cells[type];
        if (first && trials_.points != nullptr) {
          for (const Entering& e : part)
            cell.lay_noise(bodies_[e.place], (*trials_.points)(number(e.place)));
        } else if (!part.empty()) {
          put_in_order(cells_.map.section, part);
          const ScrambledPoints points(scrambles_[a]);
          for (std::size_t j = 0; j < part.size(); ++j)
            cell.lay_noise(bodies_[part[j].place], points(static_cast<std::uint32_t>(j)));
        }
      }
    });
  }

  /// Carries every body through the cell where the body is.
  void pass(bool keep_passages, PieceSize& size, const std::function<void(std::int64_t)>& tick) {
    std::vector<std::uint8_t> goes_on(bodies_.size(), 0);
    for (std::size_t type = 0; type < waves_.size(); ++type)
      for (std::size_t at = 0; at < waves_[type].size();) {
        tick(ended());
        const std::size_t* const piece = waves_[type].data() + at;
        const std::int64_t count =
            std::min<std::int64_t>(size.get(), static_cast<std::int64_t>(waves_[type].size() - at));
        const Stopwatch watch;
        carry_out_trials(
            *cells_.cells[type], count,
            [&](Body& body) {
              const std::int64_t trial = body.trial;
              body = bodies_[piece[trial]];
              body.trial = trial;
            },
            [&](Body& body, const Passage& passage) {
              const std::size_t place = piece[body.trial];
              if (!running_[place].follow(cells_.map, field_, passage, keep_passages)) return false;
              bodies_[place] = body;
              goes_on[place] = 1;
              return false;
            },
            health);
        size.measured(count, watch.seconds());
        at += static_cast<std::size_t>(count);
      }
    std::erase_if(live_, [&](std::size_t place) { return goes_on[place] == 0; });
  }

  [[nodiscard]] const std::vector<RunningTrial>& trials() const { return running_; }

  Health health;

 private:
  [[nodiscard]] std::int64_t number(std::size_t place) const {
    const auto at = static_cast<std::int64_t>(place % static_cast<std::size_t>(trials_.of_array));
    return trials_.first + kArrays * at + trials_.array +
           static_cast<std::int64_t>(array_of(place));
  }
  [[nodiscard]] std::size_t array_of(std::size_t place) const {
    return place / static_cast<std::size_t>(trials_.of_array);
  }
  [[nodiscard]] std::size_t type_of(std::size_t place) const {
    const RunningTrial& t = running_[place];
    return static_cast<std::size_t>(cells_.map.type_of(t.column(), t.row()));
  }

  const CellField& cells_;
  const FieldParams& field_;
  const RqmcTrials& trials_;
  std::vector<RunningTrial> running_;
  std::vector<Body> bodies_;
  std::vector<Random> scrambles_;  // by array
  std::vector<std::size_t> live_;  // indices of trials that go on
  // Indices of trials that go on, by the type of their cell.
  std::vector<std::vector<std::size_t>> waves_;
  bool first_ = true;
};

}  // namespace

FieldTally run_even_field(const CellField& cells, const FieldParams& field,
                          const RqmcTrials& trials, std::uint64_t seed, FieldTrials* each,
                          const std::function<void(std::int64_t)>& tick) {
  constexpr std::int64_t kFew = 1024;  // fewer at once would leave vector lanes idle
  cells.map.require_fits(field.columns, field.rows);
  require_cells(cells);
  Arrays arrays(cells, field, trials, seed);
  PieceSize size(kFew);
  while (arrays.any()) {
    arrays.lay();
    arrays.pass(each != nullptr && each->keep_passages, size, tick);
  }
  FieldTally tally =
      tally_of(arrays.trials(), cells.map, field,
               {trials.first + trials.array * trials.of_array, trials.count()}, each);
  tally.health = arrays.health;
  return tally;
}

}  // namespace gatewalk::lattice
