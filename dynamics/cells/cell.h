// SPDX-License-Identifier: MIT
#pragma once
/// The base class of all cells: derive from Cell to simulate any kind of obstacle that bodies pass.
/// Pools, chains and predictions need only the description of the cells (CellMap); a Cell simulates
/// new passages.

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

/// How a passage ends. `broken`: the outcome is unknown, because the simulation failed or the body
/// was lost from sight.
enum class Fate : std::uint8_t { left, trapped, broken };

/// The outcome of one body's passage through one cell.
struct Passage {
  Fate fate = Fate::broken;
  Entry next{};   // the entry into the neighbouring cell, if fate is `left`
  Costs costs{};  // by cost, as Section::costs lists them
};

/// State that a body carries from cell to cell and that its entry does not show, such as the random
/// force acting at the moment. A Carried holds one object of a trivially copyable type that the
/// cell chooses. The chain ignores this state.
class Carried {
 public:
  static constexpr std::size_t kMostBytes = 768;
  template <class T>
  T& put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
    static_assert(sizeof(T) <= kMostBytes && alignof(T) <= alignof(std::max_align_t));
    return *new (bytes_) T(value);
  }
  /// The object that put() stored. T must be the type that was put.
  template <class T>
  [[nodiscard]] T& as() {
    return *std::launder(reinterpret_cast<T*>(bytes_));
  }
  template <class T>
  [[nodiscard]] const T& as() const {
    return *std::launder(reinterpret_cast<const T*>(bytes_));
  }

 private:
  alignas(std::max_align_t) std::byte bytes_[kMostBytes];
};

/// A body about to enter a cell.
struct Body {
  std::int64_t trial = -1;
  Entry entry;
  Random random;      // source of the noise still to come
  Carried carried{};  // set by Cell::begin
};

/// A source of bodies. A cell calls the function with a body and the outcome of that body's last
/// passage (null before the first one). The function stores the outcome and either replaces the
/// body by the next one and returns true, or returns false: no bodies are left.
using NextPassage = std::function<bool(Body& body, const Passage* ended)>;

/// One type of cell. Several threads call the same object at once for different bodies, so a cell
/// must not change itself. The outcome of a passage must depend on the body alone.
class Cell {
 public:
  virtual ~Cell() = default;

  /// The section that the cell shares with its field.
  [[nodiscard]] virtual const Section& section() const = 0;
  /// Whether the mirror image (left for right) of every passage is a passage too, equally likely.
  [[nodiscard]] virtual bool is_symmetric() const { return false; }

  /// Carries the body through the cell. If the body leaves, body.entry becomes its entry into the
  /// neighbouring cell, equal to Passage::next.
  [[nodiscard]] virtual Passage pass(Body& body) const = 0;
  /// Carries out passages until `next` returns false. By default it calls pass() for one body after
  /// the other. A cell that carries many bodies at once overrides the function and holds at most
  /// `at_once` bodies. Numerical problems are added to `health`.
  virtual void carry_out(const NextPassage& next, Health& health, std::int64_t at_once) const;
  /// Whether carry_out_trials() repeats some passages to check that the outcomes are the same. A
  /// cell whose own tests show this returns false.
  [[nodiscard]] virtual bool has_to_show_itself() const { return true; }
  /// Repeats passages for the check of carry_out_trials(); there are at least `at_once` of them. A
  /// cell that runs in several processes overrides this function to use another process.
  virtual void carry_out_once_more(const NextPassage& next, Health& health,
                                   std::int64_t at_once) const {
    carry_out(next, health, at_once);
  }

  /// Sets up the carried state of a body that begins a trial at its entry, with noise of
  /// body.random.
  virtual void begin(Body&) const {}
  /// Replaces the carried state as if the body began a trial here, with noise not used yet.
  virtual void forget(Body& body) const { begin(body); }
  /// A number in the carried state.
  struct Remembered {
    std::string key;  // "held_for_s"
    double value = 0.0;
    bool odd = false;  // whether it changes its sign in the mirror
  };
  static constexpr std::size_t kMostRemembered = 4;
  /// Numbers that the body carries into a cell and that its entry does not show: always the same
  /// keys in the same order, at most kMostRemembered. A body that begins a trial may have NaN.
  /// study_order tests whether a chain should know them. By default none.
  [[nodiscard]] virtual std::vector<Remembered> remembered(const Body&) const { return {}; }
  /// Continues the body with other noise from now on. The carried state stays.
  virtual void fork(Body& body, const Random& random) const { body.random = random; }
  /// Whether lay_noise() has an effect.
  [[nodiscard]] virtual bool lays_noise() const { return false; }
  /// Determines the noise of the next passage by a point. Uniformly distributed points give the
  /// cell's usual noise; evenly spread points (quasi-Monte Carlo) spread the noise evenly. The
  /// carried state stays.
  virtual void lay_noise(Body&, const Point&) const {}
  /// The number that names a start in the random streams of its trials, so that different starts
  /// have different noise. By default a hash of the start's face and its coordinates, each divided
  /// by its scale.
  [[nodiscard]] virtual std::uint64_t stream_of(const Entry& start) const;

  /// A parameter of the cell that sensitivity studies may change.
  struct Number {
    std::string key;
    double value = 0.0;
  };
  /// The parameters of the cell, which with() can change.
  [[nodiscard]] virtual std::vector<Number> numbers() const { return {}; }
  /// A copy of the cell in which parameter `number` is multiplied by `times`; null where such a
  /// cell is not permitted.
  [[nodiscard]] virtual std::unique_ptr<Cell> with(std::size_t /*number*/, double /*times*/) const {
    return nullptr;
  }
  /// The clearance of an entry, in a unit that the cell chooses. Negative: a body cannot enter
  /// there.
  [[nodiscard]] virtual double clearance(const Entry&) const { return 0.0; }

 private:
  friend class TrialsOfCell;
  /// How many passages carry_out_trials() has carried out with this object. A copy starts at 0.
  struct Passed {
    Passed() = default;
    Passed(const Passed&) {}
    Passed& operator=(const Passed&) { return *this; }
    std::atomic<std::int64_t> count{0};
  };
  mutable Passed passed_;
};

/// A cell made from a function that carries a body through, as Cell::pass does.
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

/// Throws std::invalid_argument for an invalid section, and for a symmetric cell with a face that
/// has no mirror image.
void require_valid(const Cell& cell);

/// The layout of a field together with the cells to simulate, by type. `cells` is empty where
/// passages were recorded, not simulated.
struct CellField {
  CellMap map;
  std::vector<std::shared_ptr<const Cell>> cells;

  /// A field with the same cell everywhere. Throws std::invalid_argument as require_valid does.
  [[nodiscard]] static CellField uniform(std::shared_ptr<const Cell> cell);
  [[nodiscard]] const Cell& at(int column, int row) const {
    return *cells[static_cast<std::size_t>(map.type_of(column, row))];
  }
};

/// Sets up the first body of the trial body.trial.
using BeginBody = std::function<void(Body& body)>;
/// Receives a passage. Returns true if the trial goes on with the body as it is now.
using TakePassage = std::function<bool(Body& body, const Passage& passage)>;

/// Carries out all passages of trials 0 .. count - 1 through one cell, on all threads of the
/// current TBB arena. Several threads call both functions at once, for different trials. Numerical
/// problems are added to `health`.
///
/// Some passages are repeated in another order and in other company: the first few of a new cell,
/// then one in twenty, and ever fewer as the run goes on. Throws std::runtime_error with both
/// outcomes if a repeated passage ends differently: the cell then depends on more than the body,
/// and its results mean nothing.
void carry_out_trials(const Cell& cell, std::int64_t count, const BeginBody& begin,
                      const TakePassage& take, Health& health);
/// As carry_out_trials, but without repeating passages as a check.
void carry_out_trials_once(const Cell& cell, std::int64_t count, const BeginBody& begin,
                           const TakePassage& take, Health& health);

}  // namespace gatewalk::dynamics
