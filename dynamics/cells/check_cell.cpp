#include "dynamics/cells/check_cell.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <stdexcept>
#include <string>

namespace gatewalk::dynamics {
namespace {

using Trials = std::vector<std::vector<Passage>>;

[[noreturn]] void fail(std::size_t trial, std::size_t passage, const std::string& what) {
  throw std::logic_error("cell: trial " + std::to_string(trial) + ", passage " +
                         std::to_string(passage) + ": " + what);
}

Body body_at(const Cell& cell, const Entry& start, std::size_t trial, std::uint64_t seed) {
  Body body{.trial = static_cast<std::int64_t>(trial),
            .entry = start,
            .random = Random(Purpose::field, {seed, cell.stream_of(start), trial})};
  cell.begin(body);
  return body;
}

/// By carry_out, many at a time.
Trials carried_out(const Cell& cell, const std::vector<Entry>& starts, std::size_t passages,
                   std::uint64_t seed) {
  Trials trials(starts.size());
  Health health;
  carry_out_trials(
      cell, std::ssize(starts),
      [&](Body& body) {
        const auto trial = static_cast<std::size_t>(body.trial);
        body = body_at(cell, starts[trial], trial, seed);
      },
      [&](Body& body, const Passage& passage) {
        const auto trial = static_cast<std::size_t>(body.trial);
        auto& own = trials[trial];
        if (passage.fate == Fate::left && body.entry != passage.next)
          fail(trial, own.size(), "the body's entry is not the passage's next one");
        own.push_back(passage);
        return passage.fate == Fate::left && own.size() < passages;
      },
      health);
  std::int64_t runs = 0, broken = 0;
  for (const auto& own : trials)
    for (const Passage& passage : own) {
      ++runs;
      broken += passage.fate == Fate::broken;
    }
  if (health.runs != runs || health.broken != broken)
    throw std::logic_error("cell: " + std::to_string(runs) + " passages, " +
                           std::to_string(broken) + " broken, are counted as " +
                           std::to_string(health.runs) + " and " + std::to_string(health.broken));
  return trials;
}

/// By pass(), body after body.
Trials passed(const Cell& cell, const std::vector<Entry>& starts, std::size_t passages,
              std::uint64_t seed) {
  Trials trials(starts.size());
  for (std::size_t trial = 0; trial < starts.size(); ++trial) {
    Body body = body_at(cell, starts[trial], trial, seed);
    auto& own = trials[trial];
    do own.push_back(cell.pass(body));
    while (own.back().fate == Fate::left && own.size() < passages);
  }
  return trials;
}

template <std::size_t n>
bool same_bits(const std::array<double, n>& a, const std::array<double, n>& b) {
  for (std::size_t k = 0; k < n; ++k)
    if (std::bit_cast<std::uint64_t>(a[k]) != std::bit_cast<std::uint64_t>(b[k])) return false;
  return true;
}

void expect_same(const Trials& a, const Trials& b, const std::string& why) {
  for (std::size_t trial = 0; trial < a.size(); ++trial)
    for (std::size_t k = 0; k < std::max(a[trial].size(), b[trial].size()); ++k) {
      const bool both = k < a[trial].size() && k < b[trial].size();
      if (!both || a[trial][k].fate != b[trial][k].fate ||
          a[trial][k].next.face != b[trial][k].next.face ||
          !same_bits(a[trial][k].next.at, b[trial][k].next.at) ||
          !same_bits(a[trial][k].costs, b[trial][k].costs))
        fail(trial, k, "not the same bits " + why);
    }
}

void check_passage(const Section& section, const Passage& passage, std::size_t trial,
                   std::size_t k) {
  if (!section.costs.empty() && passage.costs[0] < 0.0) fail(trial, k, "takes less than no time");
  for (std::size_t c = section.costs.size(); c < kMostCosts; ++c)
    if (passage.costs[c] != 0.0) fail(trial, k, "has a cost that the section does not have");
  if (passage.fate != Fate::left) return;
  if (passage.next.face < 0 || passage.next.face >= std::ssize(section.faces))
    fail(trial, k, "leaves through face " + std::to_string(passage.next.face) + ", which is none");
  for (std::size_t axis = 0; axis < kMostCoordinates; ++axis) {
    if (axis < section.coordinates.size() && !std::isfinite(passage.next.at[axis]))
      fail(trial, k, section.coordinates[axis].name + " is not finite");
    if (axis >= section.coordinates.size() && passage.next.at[axis] != 0.0)
      fail(trial, k, "has a coordinate that the section does not have");
  }
}

bool is_mirrored(const Section& section, const Passage& passage, const Passage& image) {
  constexpr double kRounding = 1e-6;
  if (passage.fate != image.fate) return false;
  if (passage.fate != Fate::left) return true;
  const Entry wanted = mirrored(section, passage.next);
  if (wanted.face != image.next.face) return false;
  for (std::size_t axis = 0; axis < section.coordinates.size(); ++axis)
    if (!(std::abs(wanted.at[axis] - image.next.at[axis]) <=
          kRounding * section.coordinates[axis].scale))
      return false;
  return true;
}

void check_mirror(const Cell& cell, const std::vector<Entry>& starts, std::uint64_t seed) {
  constexpr double kMostDifferent = 0.01;
  std::size_t different = 0, first = 0;
  for (std::size_t trial = 0; trial < starts.size(); ++trial) {
    Body body = body_at(cell, starts[trial], trial, seed), as_it_was = body;
    const Passage passage = cell.pass(body);
    if (body.random.word() != as_it_was.random.word()) return;  // noise is not mirrored
    Body image = body_at(cell, mirrored(cell.section(), starts[trial]), trial, seed);
    if (is_mirrored(cell.section(), passage, cell.pass(image))) continue;
    if (different++ == 0) first = trial;
  }
  if (static_cast<double>(different) > kMostDifferent * static_cast<double>(starts.size()))
    fail(first, 0,
         "the mirror image is no passage, in " + std::to_string(different) + " of " +
             std::to_string(starts.size()) + " trials");
}

}  // namespace

void check_cell(const Cell& cell, const std::vector<Entry>& starts, int passages,
                std::uint64_t seed) {
  const Section& section = cell.section();
  section.validate();
  const auto most = static_cast<std::size_t>(std::max(1, passages));
  const Trials trials = carried_out(cell, starts, most, seed);
  for (std::size_t trial = 0; trial < trials.size(); ++trial)
    for (std::size_t k = 0; k < trials[trial].size(); ++k)
      check_passage(section, trials[trial][k], trial, k);
  expect_same(trials, passed(cell, starts, most, seed), "by pass() alone");
  tbb::task_arena(1).execute(
      [&] { expect_same(trials, carried_out(cell, starts, most, seed), "on one thread"); });
  const std::vector<Cell::Number> numbers = cell.numbers();
  for (std::size_t number = 0; number < numbers.size(); ++number) {
    const auto same = cell.with(number, numbers[number].value);
    if (!same) throw std::logic_error("cell: " + numbers[number].key + " may not be what it is");
    expect_same(trials, carried_out(*same, starts, most, seed),
                "with " + numbers[number].key + " as it is");
  }
  if (cell.is_symmetric()) check_mirror(cell, starts, seed);
}

}  // namespace gatewalk::dynamics
