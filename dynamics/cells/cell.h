// SPDX-License-Identifier: MIT
#pragma once
/// A cell that bodies are carried through: what is derived from to simulate any kind of obstacle.
/// Pools, chains and predictions need only what the cells look like (CellMap); a Cell makes new
/// passages.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "dynamics/base/random.h"
#include "dynamics/cells/health.h"
#include "dynamics/cells/section.h"

namespace gatewalk::dynamics {

/// What becomes of a body in a cell. `broken`: nothing is known, by a fault or because the body was
/// lost from sight.
enum class Fate : std::uint8_t { left, trapped, broken };

/// A body's way through one cell.
struct Passage {
  Fate fate = Fate::broken;
  Entry next{};   // into the neighbour, if it left
  Costs costs{};  // by Section::costs
};

/// Memory that a body carries from cell to cell and that no entry shows, such as the random force
/// that is acting just now: one object of a type that the cell chooses, copied as bytes. The chain
/// forgets it.
class Carried {
 public:
  static constexpr std::size_t kMostBytes = 768;
  template <class T>
  T& put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
    static_assert(sizeof(T) <= kMostBytes && alignof(T) <= alignof(std::max_align_t));
    return *new (bytes_) T(value);
  }
  /// What was put there; of the same type.
  template <class T>
  [[nodiscard]] T& as() {
    return *std::launder(reinterpret_cast<T*>(bytes_));
  }

 private:
  alignas(std::max_align_t) std::byte bytes_[kMostBytes];
};

/// A body that is to enter a cell, of some trial.
struct Body {
  std::int64_t trial = -1;
  Entry entry;
  Random random;      // noise not used yet
  Carried carried{};  // see Cell::begin
};

/// Called with a body and what became of its last passage (null before the first): the owner takes
/// the result, puts the next body there and returns true, or returns false: there are no more.
using NextPassage = std::function<bool(Body& body, const Passage* ended)>;

/// One type of cell. Called by several threads at once, for different bodies: it must not change
/// itself. What becomes of a body depends on that body alone.
class Cell {
 public:
  virtual ~Cell() = default;

  [[nodiscard]] virtual const Section& section() const = 0;
  /// Mirror images (left for right) of passages are passages.
  [[nodiscard]] virtual bool is_symmetric() const { return false; }

  /// Carries the body through. If it left, the body is then as it enters the neighbour, and
  /// body.entry is the passage's `next`.
  [[nodiscard]] virtual Passage pass(Body& body) const = 0;
  /// Until `next` has no more; by default pass() after pass(). For cells that carry many bodies at
  /// once, but no more than `at_once`. Adds what went wrong to `health`.
  virtual void carry_out(const NextPassage& next, Health& health, std::int64_t at_once) const;
  /// Whether carry_out_trials() carries out some passages once more, to see whether they are the
  /// same: not of a cell whose own tests show it.
  [[nodiscard]] virtual bool has_to_show_itself() const { return true; }
  /// carry_out() of those passages, of which there are at least `at_once`: where a cell has
  /// processes, by another one.
  virtual void carry_out_once_more(const NextPassage& next, Health& health,
                                   std::int64_t at_once) const {
    carry_out(next, health, at_once);
  }

  /// The memory of a body that begins a trial at its entry is put in place: with noise of
  /// body.random.
  virtual void begin(Body&) const {}
  /// Memory is dropped as if the body began here, with the noise not used yet.
  virtual void forget(Body& body) const { begin(body); }
  /// Memory is kept; the noise from now on is another one.
  virtual void fork(Body& body, const Random& random) const { body.random = random; }
  /// Whether lay_noise() does anything.
  [[nodiscard]] virtual bool lays_noise() const { return false; }
  /// The noise of the passage to come is laid by this point: uniform points make the noise that
  /// there is without them, points that are evenly spread spread it evenly. Memory is kept.
  virtual void lay_noise(Body&, const Point&) const {}
  /// The number that names a start in its trials' streams: other starts, other noise. By default
  /// from its face and numbers, each in its scale.
  [[nodiscard]] virtual std::uint64_t stream_of(const Entry& start) const;

  /// What a passage depends on and may be changed to ask what difference it makes.
  struct Number {
    std::string key;
    double value = 0.0;
  };
  [[nodiscard]] virtual std::vector<Number> numbers() const { return {}; }
  /// The cell with so many times that number; null where it is not permitted.
  [[nodiscard]] virtual std::unique_ptr<Cell> with(std::size_t /*number*/, double /*times*/) const {
    return nullptr;
  }
  /// How much room there is about an entry, in a unit of the cell's own; negative: none, a body
  /// cannot enter so.
  [[nodiscard]] virtual double clearance(const Entry&) const { return 0.0; }

 private:
  friend class TrialsOfCell;
  /// Passages that carry_out_trials() has had from this object; a copy begins anew.
  struct Passed {
    Passed() = default;
    Passed(const Passed&) {}
    Passed& operator=(const Passed&) { return *this; }
    std::atomic<std::int64_t> count{0};
  };
  mutable Passed passed_;
};

/// A cell of a function, which carries a body through as Cell::pass does.
class FunctionCell : public Cell {
 public:
  using Pass = std::function<Passage(Body&)>;
  FunctionCell(Section section, Pass pass, bool symmetric = false)
      : section_(std::move(section)), pass_(std::move(pass)), symmetric_(symmetric) {}
  [[nodiscard]] const Section& section() const override { return section_; }
  [[nodiscard]] bool is_symmetric() const override { return symmetric_; }
  [[nodiscard]] Passage pass(Body& body) const override { return pass_(body); }

 private:
  Section section_;
  Pass pass_;
  bool symmetric_;
};

/// Throws std::invalid_argument for a section that is not valid, and for a face of a symmetric cell
/// without a mirror image.
void require_valid(const Cell& cell);

/// What stands where, and the cells to run, by type; none where runs were recorded.
struct CellField {
  CellMap map;
  std::vector<std::shared_ptr<const Cell>> cells;

  /// The same cell everywhere. Throws std::invalid_argument as require_valid.
  [[nodiscard]] static CellField uniform(std::shared_ptr<const Cell> cell);
  [[nodiscard]] const Cell& at(int column, int row) const {
    return *cells[static_cast<std::size_t>(map.type_of(column, row))];
  }
};

/// Puts a trial's first body there.
using BeginBody = std::function<void(Body& body)>;
/// Takes a passage; true when the same trial goes on with the body that is there now.
using TakePassage = std::function<bool(Body& body, const Passage& passage)>;

/// Carries out all passages of trials 0 .. count - 1 through one cell on all threads of the current
/// TBB arena. Both functions are called by several threads at once, for different trials. What went
/// wrong is added to `health`.
///
/// Some of the passages, of a new cell the first few, then one of twenty and ever fewer, are
/// carried out once more, in another order and company. Throws std::runtime_error with both answers
/// where one differs: such a cell depends on more than its body, and nothing can be told by it.
void carry_out_trials(const Cell& cell, std::int64_t count, const BeginBody& begin,
                      const TakePassage& take, Health& health);
/// The same, each passage once.
void carry_out_trials_once(const Cell& cell, std::int64_t count, const BeginBody& begin,
                           const TakePassage& take, Health& health);

}  // namespace gatewalk::dynamics
