// SPDX-License-Identifier: MIT
#include "dynamics/disc/stable_lanes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "dynamics/disc/methods/march.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dynamics/disc/stable_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "dynamics/disc/stable-inl.h"

#ifndef GATEWALK_DYNAMICS_STABLE_LANES_ONCE
#define GATEWALK_DYNAMICS_STABLE_LANES_ONCE

namespace gatewalk::dynamics {

constexpr int kMostLanes = 16;
constexpr int kMostRuns = 512;  // fewer runs leave lanes empty, more exceed the cache

/// A table of many runs: one row for each kind of number, one column for each run. Each row has
/// room for a load of all lanes behind the last run.
template <int kRows>
struct alignas(64) Table {
  double rows[kRows][kMostRuns + kMostLanes] = {};
  int run[kMostRuns + kMostLanes] = {};
  int size = 0;

  void copy(int to, int from) {
    for (auto& row : rows) row[to] = row[from];
    run[to] = run[from];
  }
};

// The rows of a state.
constexpr int kX = 0, kY = 1, kVx = 2, kVy = 3, kTheta = 4, kOmega = 6, kHeld = 8, kState = 10;

// The rows of a deck: the state now, the state after the piece, and what the run needs next
// (below);
constexpr int kNow = 0, kNext = kState, kNeed = 2 * kState;
// the force (N, along x), the step (s) and the steps left in the spell; StableMethod::Progress with
// the least number of halvings of the next piece;
constexpr int kForce = kNeed + 1, kStep = kForce + 1, kStepsLeft = kStep + 1;
constexpr int kUnit = kStepsLeft + 1, kPassed = kUnit + 1, kHalved = kPassed + 1;
// for the piece: its units and time (s), the overlap (m), evaluations and impacts;
constexpr int kUnits = kHalved + 1, kTime = kUnits + 1, kOverlap = kTime + 1;
constexpr int kNewEvaluations = kOverlap + 1, kNewImpacts = kNewEvaluations + 1;
// the numbers of EnergyLedger and of Watch.
constexpr int kLastX = kNewImpacts + 1, kFirstY = kLastX + 1, kWork = kFirstY + 1;
constexpr int kLowest = kWork + 1, kCreated = kLowest + 1, kMaxTheta = kCreated + 1;
constexpr int kPenetration = kMaxTheta + 2, kSpeed = kPenetration + 1, kSteps = kSpeed + 1;
constexpr int kEvaluations = kSteps + 1, kImpacts = kEvaluations + 1, kHolds = kImpacts + 1;
constexpr int kFast = kHolds + 1, kDeckRows = kFast + 1;

// The values of kNeed: what a run needs next.
constexpr double kNothing = 0.0;  // no run
constexpr double kPiece = 1.0;
constexpr double kWait = 2.0;    // it waits in a queue
constexpr double kCommit = 3.0;  // its piece is done
constexpr double kSpell = 4.0;   // the next draw of the random force
constexpr double kBroken = 5.0;  // a spell, but the state is not finite
constexpr double kGone = 6.0;    // the body has left or is not finite

using Deck = Table<kDeckRows>;

// The rows of a queue of pieces with a hit: the state from which the piece goes on, and its end
// without a hit; the force, the time of the piece and the time left (s); which beams are hit;
// evaluations and impacts so far; the number of hits.
constexpr int kFrom = 0, kTo = kState, kHitForce = 2 * kState, kPieceTime = kHitForce + 1;
constexpr int kLeftOver = kPieceTime + 1, kHit = kLeftOver + 1, kHitEvaluations = kHit + 2;
constexpr int kHitImpacts = kHitEvaluations + 1, kTimesHit = kHitImpacts + 1;
constexpr int kQueueRows = kTimesHit + 1;
using Queue = Table<kQueueRows>;

template <class Rows>
GateState get_state(const Rows& rows, int first, int i) {
  const auto at = [&](int k) { return rows[first + k][i]; };
  GateState s{{at(kX), at(kY), at(kVx), at(kVy)}, {}};
  for (const Side side : {kLeft, kRight})
    s.beams[side] = {at(kTheta + side), at(kOmega + side), at(kHeld + side) != 0.0};
  return s;
}
template <class Rows>
void put_state(const GateState& s, Rows& rows, int first, int i) {
  rows[first + kX][i] = s.body.x;
  rows[first + kY][i] = s.body.y;
  rows[first + kVx][i] = s.body.vx;
  rows[first + kVy][i] = s.body.vy;
  for (const Side side : {kLeft, kRight}) {
    rows[first + kTheta + side][i] = s.beams[side].theta;
    rows[first + kOmega + side][i] = s.beams[side].omega;
    rows[first + kHeld + side][i] = s.beams[side].held;
  }
}

/// The runs in flight, and all work that is done run by run.
class StableRuns {
 public:
  StableRuns(const GateParams& p, const StableMethod& method, const NextRun& next,
             std::int64_t most_work, std::int64_t at_once)
      : p_(p),
        method_(method),
        next_(next),
        most_work_(most_work),
        whole_hold_(p, 1.0 / p.forces.random_rate),
        nearly_over_(p.run.time_limit - 1e-6 * p.run.step),
        has_stiff_beams_(method.limits().halvings[kLeft] + method.limits().halvings[kRight] > 0) {
    const int n = static_cast<int>(std::clamp<std::int64_t>(at_once, 1, kMostRuns));
    runs_.reserve(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) {
      runs_.push_back({RunSlot{-1, {}, RandomForce(p.forces, Random(Purpose::gate, {}))},
                       whole_hold_, 0, decks[0].size});
      Deck& free = decks[0];
      free.run[free.size++] = i;
      if (!take(free, free.size - 1, nullptr)) {
        --free.size;
        break;
      }
    }
  }

  [[nodiscard]] int in_flight() const {
    int sum = 0;
    for (const Deck& deck : decks) sum += deck.size;
    return sum;
  }
  /// The number of runs that wait until enough others need the same work to fill all lanes.
  [[nodiscard]] int waiting() const {
    int sum = 0;
    for (int n = 0; n <= 2; ++n) sum += hits[n].size + rests[n].size + decks[kShort + n].size;
    return sum;
  }
  [[nodiscard]] bool has_stiff_beams() const { return has_stiff_beams_; }

  /// Takes the rest of the step by the plain method.
  void finish_plainly(Deck& deck, int i) {
    auto& row = deck.rows;
    GateState s = get_state(row, kNow, i);
    StableMethod::Progress done{static_cast<int>(row[kUnit][i]), static_cast<int>(row[kHalved][i]),
                                row[kPassed][i]};
    Watch w;
    for (const Side side : {kLeft, kRight}) w.max_theta[side] = row[kMaxTheta + side][i];
    method_.finish_step(s, row[kForce][i], row[kStep][i], done, w);
    put_state(s, row, kNext, i);
    for (const Side side : {kLeft, kRight}) row[kMaxTheta + side][i] = w.max_theta[side];
    row[kUnit][i] = StableMethod::kUnits;
    row[kPassed][i] = done.passed;
    row[kUnits][i] = row[kTime][i] = 0.0;
    row[kOverlap][i] = w.max_penetration;
    row[kNewEvaluations][i] = static_cast<double>(w.evaluations);
    row[kNewImpacts][i] = static_cast<double>(w.impacts);
    row[kHolds][i] += static_cast<double>(w.forced_holds);
    row[kFast][i] += done.fast;
    row[kNeed][i] = kCommit;
  }
  void finish_plainly(int run) { finish_plainly(deck_of(run), runs_[run].lane); }

  /// Ends the piece in column i of a queue, without further hits.
  void finish(const Queue& queue, int i, double overlap) {
    const Run& run = runs_[queue.run[i]];
    auto& row = deck_of(queue.run[i]).rows;
    for (int k = 0; k < kState; ++k) row[kNext + k][run.lane] = queue.rows[kTo + k][i];
    row[kOverlap][run.lane] = overlap;
    row[kNewEvaluations][run.lane] = queue.rows[kHitEvaluations][i];
    row[kNewImpacts][run.lane] = queue.rows[kHitImpacts][i];
    row[kNeed][run.lane] = kCommit;
  }

  /// Records the swing of the beams in a piece without hits that the lanes have finished.
  void watch_swing(Deck& deck, int i) {
    auto& row = deck.rows;
    const GateState before = get_state(row, kNow, i);
    Watch w;
    for (const Side side : {kLeft, kRight}) {
      w.max_theta[side] = row[kMaxTheta + side][i];
      method_.watch_swing(side, before.beams[side], row[kTime][i], w);
      row[kMaxTheta + side][i] = w.max_theta[side];
    }
  }

  /// Handles spells and runs that have ended.
  void look_after(Deck& deck) {
    for (int i = deck.size; i-- > 0;) {
      const double need = deck.rows[kNeed][i];
      if (need < kSpell) continue;
      deck.rows[kNeed][i] = kPiece;
      if (!spell_over(deck, i, need)) remove(deck, i);
    }
  }
  /// Moves every run into the right deck.
  void sort() {
    for (int n = 0; n < kDecks; ++n)
      for (int i = decks[n].size; i-- > 0;) {
        const int right = right_deck(decks[n], i);
        if (right != n && decks[n].rows[kNeed][i] == kPiece) move(n, i, right);
      }
  }

  // Indexed by the number of held contacts: `decks` hold runs between two pieces, whose next piece
  // is a usual step or, kShort decks later, of any other length; `hits` hold searches for a hit;
  // `rests` hold the rest of a piece after a hit.
  static constexpr int kShort = 3, kDecks = 6;
  Deck decks[kDecks];
  Queue hits[3], rests[3];

 private:
  struct Run {
    RunSlot slot;
    Spell spell;
    int deck, lane;
    double seconds = 0.0;
    bool out_of_work = false;
  };

  [[nodiscard]] int right_deck(const Deck& deck, int i) const {
    const auto& row = deck.rows;
    const bool usual =
        row[kHalved][i] == 0.0 && row[kUnit][i] == 0.0 && row[kStep][i] == p_.run.step;
    return static_cast<int>(row[kHeld][i] + row[kHeld + 1][i]) + (usual ? 0 : kShort);
  }
  Deck& deck_of(int run) { return decks[runs_[run].deck]; }

  void remove(Deck& deck, int i) {
    const int last = --deck.size;
    if (i != last) {
      deck.copy(i, last);
      runs_[deck.run[i]].lane = i;
    }
    deck.rows[kNeed][last] = kNothing;
  }
  void move(int from, int i, int to) {
    Deck& deck = decks[to];
    for (int k = 0; k < kDeckRows; ++k) deck.rows[k][deck.size] = decks[from].rows[k][i];
    deck.run[deck.size] = decks[from].run[i];
    Run& run = runs_[deck.run[deck.size]];
    run.deck = to;
    run.lane = deck.size++;
    remove(decks[from], i);
  }

  /// Ends a spell. Returns false if the run has ended and there is no other.
  bool spell_over(Deck& deck, int i, double need) {
    auto& row = deck.rows;
    Run& run = runs_[deck.run[i]];
    double passed = run.spell.duration;
    if (need == kGone) {
      const double gone = static_cast<double>(run.spell.steps - 1) - row[kStepsLeft][i];
      passed = gone * run.spell.step + row[kPassed][i];
    }
    run.slot.force.pass(passed);
    run.seconds += passed;
    return (need == kSpell && begin_spell(deck, i)) || end(deck, i);
  }

  /// Begins the next spell. Returns false if the run is over: no time left, or too much work.
  bool begin_spell(Deck& deck, int i) {
    auto& row = deck.rows;
    Run& run = runs_[deck.run[i]];
    if (run.seconds >= nearly_over_) return false;
    if (most_work_ < kAnyWork) {
      const double work = std::max(row[kSteps][i], row[kEvaluations][i]);
      run.out_of_work = work > static_cast<double>(most_work_);
      if (run.out_of_work) return false;
    }
    row[kForce][i] = run.slot.force.value();
    const double seconds = std::min(run.slot.force.left(), p_.run.time_limit - run.seconds);
    if (seconds != run.spell.duration)
      run.spell = seconds == whole_hold_.duration ? whole_hold_ : Spell(p_, seconds);
    row[kStep][i] = run.spell.step;
    row[kStepsLeft][i] = static_cast<double>(run.spell.steps);
    row[kUnit][i] = row[kPassed][i] = 0.0;
    return true;
  }

  /// Ends the run. Returns false if there is no other.
  bool end(Deck& deck, int i) {
    const GateRun ended = result(deck, i);
    return take(deck, i, &ended);
  }

  /// Puts the next run into lane i. Returns false if there is none.
  bool take(Deck& deck, int i, const GateRun* ended) {
    Run& run = runs_[deck.run[i]];
    GateRun at_once;
    while (next_(run.slot, ended)) {
      for (auto& row : deck.rows) row[i] = 0.0;
      const GateState s{run.slot.start, {}};
      put_state(s, deck.rows, kNow, i);
      deck.rows[kNeed][i] = kPiece;
      deck.rows[kLastX][i] = s.body.x;
      deck.rows[kFirstY][i] = s.body.y;
      deck.rows[kLowest][i] = energy(p_, s);
      run.seconds = 0.0;
      run.out_of_work = false;
      if (!outside(p_, s.body) && begin_spell(deck, i)) return true;
      at_once = result(deck, i);
      ended = &at_once;
    }
    return false;
  }

  [[nodiscard]] GateRun result(const Deck& deck, int i) const {
    const auto& row = deck.rows;
    const Run& run = runs_[deck.run[i]];
    const GateState s = get_state(row, kNow, i);
    const auto count = [&](int k) { return static_cast<std::int64_t>(row[k][i]); };
    GateRun r;
    r.exit = s.body;
    r.seconds = run.seconds;
    r.out_of_work = run.out_of_work;
    r.random_work = row[kWork][i];
    settle_energy(p_, run.slot.start, r);
    for (const Side side : {kLeft, kRight}) r.watch.max_theta[side] = row[kMaxTheta + side][i];
    if (!r.out_of_work) r.outcome = outcome_of(p_, s, r.watch);
    r.watch.max_penetration = row[kPenetration][i];
    r.watch.energy_created = row[kCreated][i];
    r.watch.max_speed = row[kSpeed][i];
    r.watch.steps = count(kSteps);
    r.watch.evaluations = count(kEvaluations);
    r.watch.impacts = count(kImpacts);
    r.watch.forced_holds = count(kHolds);
    r.watch.fast_steps = count(kFast);
    return r;
  }

  const GateParams& p_;
  const StableMethod& method_;
  const NextRun& next_;
  std::int64_t most_work_;
  Spell whole_hold_;
  double nearly_over_;
  bool has_stiff_beams_;
  std::vector<Run> runs_;
};

}  // namespace gatewalk::dynamics

#endif  // GATEWALK_DYNAMICS_STABLE_LANES_ONCE

HWY_BEFORE_NAMESPACE();
namespace gatewalk::dynamics {
namespace HWY_NAMESPACE {

template <class Rows>
HWY_INLINE WideState load_state(const Rows& rows, int first, int i) {
  const auto at = [&](int k) HWY_ATTR { return load(rows[first + k] + i); };
  WideState s;
  s.x = at(kX);
  s.y = at(kY);
  s.vx = at(kVx);
  s.vy = at(kVy);
  for (const Side side : {kLeft, kRight}) {
    s.theta[side] = at(kTheta + side);
    s.omega[side] = at(kOmega + side);
    s.held[side] = at(kHeld + side) > all(0.0);
  }
  return s;
}
HWY_INLINE Wide flag(WideMask m) { return or_zero(m, all(1.0)); }
/// Stores the state in the lanes of `m`; other lanes stay unchanged.
template <class Rows>
HWY_INLINE void store_state(const WideState& s, WideMask m, Rows& rows, int first, int i) {
  const auto put = [&](int k, Wide x) HWY_ATTR {
    double* to = rows[first + k] + i;
    store(choose(m, x, load(to)), to);
  };
  put(kX, s.x);
  put(kY, s.y);
  put(kVx, s.vx);
  put(kVy, s.vy);
  for (const Side side : {kLeft, kRight}) {
    put(kTheta + side, s.theta[side]);
    put(kOmega + side, s.omega[side]);
    put(kHeld + side, flag(s.held[side]));
  }
}

HWY_INLINE WideFlow same_in_all(const GateFlow& f) {
  const auto beam = [](const BeamFlow& b) HWY_ATTR {
    return BeamFlowOf<Wide>{all(b.tt), all(b.tw), all(b.wt), all(b.ww), all(b.ta), all(b.wa)};
  };
  return {{all(f.body.decay), all(f.body.rise), all(f.body.fall)}, {beam(f.left), beam(f.right)}};
}

/// A mask of the first k lanes.
HWY_INLINE WideMask first_lanes(int k) {
  alignas(64) double number[kMostLanes];
  for (int i = 0; i < kMostLanes; ++i) number[i] = i;
  return load(number) < all(k);
}

/// The work that all lanes do together.
class Rounds {
 public:
  Rounds(const GateParams& p, const StableMethod& method, StableRuns& runs)
      : rules_(p, method), runs_(runs) {}

  void run() {
    const int lanes = static_cast<int>(width());
    while (runs_.in_flight() > 0) {
      runs_.sort();
      // Work that few runs need waits until they fill all lanes, unless too many wait.
      const int least = 4 * runs_.waiting() > runs_.in_flight() ? 1 : lanes;
      try_deck<0>(least);
      try_deck<1>(least);
      try_deck<2>(least);
      while (work_off(least)) continue;
      for (Deck& deck : runs_.decks) {
        for (int i = 0; i < deck.size; i += lanes) commit(deck, i);
        runs_.look_after(deck);
      }
    }
  }

 private:
  template <int N>
  void try_deck(int least) {
    const int lanes = static_cast<int>(width());
    for (int i = 0; i < runs_.decks[N].size; i += lanes) try_pieces<N, true>(i);
    const int some = runs_.decks[StableRuns::kShort + N].size;
    for (int i = 0; i + least <= some; i += lanes) try_pieces<N, false>(i);
  }

  /// Tries a piece with N held contacts, as if there were no hits, in the lanes from i on.
  template <int N, bool kUsual>
  HWY_NOINLINE void try_pieces(int i) {
    Deck& deck = runs_.decks[kUsual ? N : StableRuns::kShort + N];
    auto& row = deck.rows;
    WideMask ready = load(row[kNeed] + i) == all(kPiece);
    if (!any(ready)) return;
    const WideState s = load_state(row, kNow, i);
    const Wide force = load(row[kForce] + i), step = load(row[kStep] + i);
    WideMask plain = nowhere();
    if constexpr (N > 0) {
      for (const Side side : {kLeft, kRight})
        plain = plain | ~(abs(s.theta[side]) < all(Direction::kMostAngle));
    }
    Wide level = level_of(rules_, s, step, load(row[kUnit] + i), plain);
    Wide time = step, units = all(StableMethod::kUnits);
    WideState end = s;
    Glided glided = no_contacts();
    WideMask series = in_series(rules_, step);
    if constexpr (kUsual) {
      const WideMask halved = ready & ~plain & (level > all(0.0));
      store(choose(halved, level, load(row[kHalved] + i)), row[kHalved] + i);
      ready = ready & ~halved;
      const WideFlow flow = same_in_all(rules_.method.flow(0));
      if constexpr (N > 0) {
        glided = glide<N>(rules_, force, flow, same_in_all(rules_.method.flow(1)), end);
      } else {
        const Wide none = all(0.0);
        fly(rules_.gate, flow, force, {none, none, {none, none}}, end);
      }
    } else {
      level = larger(level, load(row[kHalved] + i));
      const Wide share = halving(level);
      time = step * share;
      units = StableMethod::kUnits * share;
      series = in_series(rules_, time);
      const WideMask usual = step == all(rules_.step);
      plain = plain | ~series | (level > all(rules_.method.finest()));
      glided = glide<N>(rules_, force, time, usual, end);
    }
    const Arrival a = arrive<N>(rules_, end, glided);
    const WideMask hit = a.hit[kLeft] | a.hit[kRight];
    plain = ready & (plain | a.lost | (hit & ~series));
    const Wide evaluations = all(2.0 + 3.0 * N);
    if constexpr (N > 0) {  // only a short piece may cross the jump of the contact force
      const WideMask again =
          ready & ~plain & glided.handover & (level < all(rules_.method.finest()));
      store(choose(again, level + all(1.0), load(row[kHalved] + i)), row[kHalved] + i);
      store(load(row[kEvaluations] + i) + or_zero(again, evaluations), row[kEvaluations] + i);
      ready = ready & ~again;
    }
    const WideMask left = ready & ~plain & a.hit[kLeft], right = ready & ~plain & a.hit[kRight];
    store_state(end, ready, row, kNext, i);
    const auto put = [&](int k, Wide x)
                         HWY_ATTR { store(choose(ready, x, load(row[k] + i)), row[k] + i); };
    put(kUnits, units);
    put(kTime, time);
    put(kOverlap, a.overlap);
    put(kNewEvaluations, evaluations);
    put(kNewImpacts, all(0.0));
    put(kNeed, all(kCommit));
    if (any(plain | left | right)) send_off(deck, i, N, plain, left, right);
  }

  /// Calls act(k) for each lane k of `m`.
  template <class Do>
  static HWY_INLINE void each_lane(WideMask m, const Do& act) {
    if (!any(m)) return;
    alignas(64) double flags[kMostLanes];
    store(flag(m), flags);
    for (int k = 0; k < static_cast<int>(width()); ++k)
      if (flags[k] != 0.0) act(k);
  }

  /// Sends lanes with unfinished pieces to the plain method or to a queue.
  HWY_NOINLINE void send_off(Deck& deck, int i, int contacts, WideMask plain, WideMask left,
                             WideMask right) {
    each_lane(plain, [&](int k) { runs_.finish_plainly(deck, i + k); });
    alignas(64) double hit[2][kMostLanes];
    store(flag(left), hit[kLeft]);
    store(flag(right), hit[kRight]);
    each_lane(left | right, [&](int k) {
      const int lane = i + k;
      auto& row = deck.rows;
      row[kNeed][lane] = kWait;
      Queue& queue = runs_.hits[contacts];
      const int at = queue.size++;
      queue.run[at] = deck.run[lane];
      for (int n = 0; n < kState; ++n) {
        queue.rows[kFrom + n][at] = row[kNow + n][lane];
        queue.rows[kTo + n][at] = row[kNext + n][lane];
      }
      queue.rows[kHitForce][at] = row[kForce][lane];
      queue.rows[kPieceTime][at] = queue.rows[kLeftOver][at] = row[kTime][lane];
      for (const Side side : {kLeft, kRight}) queue.rows[kHit + side][at] = hit[side][k];
      queue.rows[kHitEvaluations][at] = row[kNewEvaluations][lane];
      queue.rows[kHitImpacts][at] = queue.rows[kTimesHit][at] = 0.0;
    });
  }

  /// Works off one batch of each queue with `least` entries or more. Returns false if there is
  /// none.
  bool work_off(int least) {
    bool worked = work_off<0>(least);
    worked |= work_off<1>(least);
    worked |= work_off<2>(least);
    return worked;
  }
  template <int N>
  bool work_off(int least) {
    const bool search = runs_.hits[N].size >= least;
    if (search) find_hits<N>();
    const bool glide = runs_.rests[N].size >= least;
    if (glide) glide_rests<N>();
    return search || glide;
  }

  /// The last entries of a queue, at most one for each lane.
  struct Batch {
    int first, size;
  };
  static Batch pop(Queue& queue) {
    const int n = std::min(queue.size, static_cast<int>(width()));
    queue.size -= n;
    return {queue.size, n};
  }
  static void hand_over(const Queue& from, int i, Queue& to) {
    for (int k = 0; k < kQueueRows; ++k) to.rows[k][to.size] = from.rows[k][i];
    to.run[to.size++] = from.run[i];
  }

  /// Finds the first hit in the rest of pieces and applies the impact.
  template <int N>
  HWY_NOINLINE void find_hits() {
    Queue& queue = runs_.hits[N];
    const auto [i, n] = pop(queue);
    auto& row = queue.rows;
    const WideMask lanes = first_lanes(n);
    const WideState s = load_state(row, kFrom, i), end = load_state(row, kTo, i);
    const Wide force = load(row[kHitForce] + i), left = load(row[kLeftOver] + i);
    const WideMask hit[2] = {load(row[kHit] + i) > all(0.0), load(row[kHit + 1] + i) > all(0.0)};
    Wide evaluations = load(row[kHitEvaluations] + i), impacts = load(row[kHitImpacts] + i);

    const Wide side = choose(hit[kLeft], all(1.0), all(-1.0));
    WideHit first = find_hit<N>(rules_, s, end, force, left, side, lanes, evaluations);
    const WideMask both = lanes & hit[kLeft] & hit[kRight];
    if (any(both)) {
      const WideHit right = find_hit<N>(rules_, s, end, force, left, all(-1.0), both, evaluations);
      const WideMask earlier = both & (right.when < first.when);
      first.when = choose(earlier, right.when, first.when);
      first.there = choose(earlier, right.there, first.there);
      first.failed = first.failed | right.failed;
    }
    WideState there = first.there;
    evaluations = evaluations + all(2.0);
    WideMask failed = first.failed | outside(rules_, there.x, there.y);
    failed = failed | resolve_hits(rules_, lanes & ~failed, there, impacts);
    const Wide rest = left - first.when;
    failed = failed | (rest <= 1e-15 * load(row[kPieceTime] + i)) | too_far(rules_, there, rest);

    store_state(there, lanes, row, kFrom, i);
    store(rest, row[kLeftOver] + i);
    store(evaluations, row[kHitEvaluations] + i);
    store(impacts, row[kHitImpacts] + i);
    alignas(64) double fails[kMostLanes], holds[kMostLanes];
    store(flag(failed), fails);
    store(flag(there.held[kLeft]) + flag(there.held[kRight]), holds);
    for (int k = 0; k < n; ++k) {
      if (fails[k] != 0.0)
        runs_.finish_plainly(queue.run[i + k]);
      else
        hand_over(queue, i + k, runs_.rests[static_cast<int>(holds[k])]);
    }
  }

  /// Takes the rest of pieces after a hit.
  template <int N>
  HWY_NOINLINE void glide_rests() {
    constexpr double kMostHits = 8;
    Queue& queue = runs_.rests[N];
    const auto [i, n] = pop(queue);
    auto& row = queue.rows;
    const WideMask lanes = first_lanes(n);
    const WideState s = load_state(row, kFrom, i);
    WideState end = s;
    const Glided glided =
        glide<N>(rules_, load(row[kHitForce] + i), load(row[kLeftOver] + i), nowhere(), end);
    const Arrival a = arrive<N>(rules_, end, glided);
    const Wide times_hit = load(row[kTimesHit] + i) + all(1.0);
    const Wide evaluations = load(row[kHitEvaluations] + i) + all(2.0 + 3.0 * N);
    store_state(end, lanes, row, kTo, i);
    store(evaluations, row[kHitEvaluations] + i);
    store(times_hit, row[kTimesHit] + i);
    for (const Side side : {kLeft, kRight}) store(flag(a.hit[side]), row[kHit + side] + i);
    alignas(64) double fails[kMostLanes], overlap[kMostLanes];
    store(flag(a.lost | (times_hit > all(kMostHits))), fails);
    store(a.overlap, overlap);
    for (int k = 0; k < n; ++k) {
      if (fails[k] != 0.0)
        runs_.finish_plainly(queue.run[i + k]);
      else if (row[kHit][i + k] != 0.0 || row[kHit + 1][i + k] != 0.0)
        hand_over(queue, i + k, runs_.hits[N]);
      else
        runs_.finish(queue, i + k, overlap[k]);
    }
  }

  /// Makes finished pieces the current state, with EnergyLedger::step and Watch::motion at the end
  /// of a step.
  HWY_NOINLINE void commit(Deck& deck, int i) {
    auto& row = deck.rows;
    const LaneGate& g = rules_.gate;
    const WideMask done = load(row[kNeed] + i) == all(kCommit);
    if (!any(done)) return;
    if (runs_.has_stiff_beams()) {
      // Only beams that may swing further than before need the exact swing.
      const WideMask free =
          done & (load(row[kNewImpacts] + i) == all(0.0)) & (load(row[kTime] + i) > all(0.0));
      WideMask wider = nowhere();
      for (const Side side : {kLeft, kRight}) {
        const Wide theta = load(row[kTheta + side] + i), omega = load(row[kOmega + side] + i);
        const Wide seen = load(row[kMaxTheta + side] + i);
        wider = wider | (rules_.limits.swing[side] * (seen * seen - theta * theta) <
                         1.01 * (omega * omega));
      }
      each_lane(free & wider, [&](int k) { runs_.watch_swing(deck, i + k); });
    }
    const WideState s = load_state(row, kNext, i);
    store_state(s, done, row, kNow, i);
    const auto put = [&](int k, WideMask where, Wide x)
                         HWY_ATTR { store(choose(where, x, load(row[k] + i)), row[k] + i); };
    const auto add = [&](int k, WideMask where, Wide x)
                         HWY_ATTR { put(k, where, load(row[k] + i) + x); };
    const auto raise = [&](int k, WideMask where, Wide x)
                           HWY_ATTR { put(k, where, larger(load(row[k] + i), x)); };
    put(kHalved, done, all(0.0));
    add(kUnit, done, load(row[kUnits] + i));
    add(kPassed, done, load(row[kTime] + i));
    raise(kPenetration, done, load(row[kOverlap] + i));
    add(kEvaluations, done, load(row[kNewEvaluations] + i));
    add(kImpacts, done, load(row[kNewImpacts] + i));
    const WideMask over = done & (load(row[kUnit] + i) >= all(StableMethod::kUnits));
    const WideMask gone = outside(rules_, s.x, s.y) | ~finite(s.vx + s.vy);
    const Wide left = load(row[kStepsLeft] + i) - all(1.0);
    put(kStepsLeft, over, left);
    const WideMask next = over & ~gone & (left > all(0.0));
    put(kUnit, next, all(0.0));
    put(kPassed, next, all(0.0));
    const Wide sum =
        (s.x + s.y) + (s.theta[kLeft] + s.theta[kRight]) + (s.omega[kLeft] + s.omega[kRight]);
    const Wide spell = choose(gone, all(kGone), choose(finite(sum), all(kSpell), all(kBroken)));
    put(kNeed, done, choose(over & ~next, spell, all(kPiece)));

    const Wide force = load(row[kForce] + i);
    const Wide work = load(row[kWork] + i) + force * (s.x - load(row[kLastX] + i));
    put(kWork, over, work);
    put(kLastX, over, s.x);
    const Wide body = g.mass * (s.vx * s.vx + s.vy * s.vy);
    const Wide beams =
        g.inertia * (s.omega[kLeft] * s.omega[kLeft] + s.omega[kRight] * s.omega[kRight]);
    const Wide joints = g.stiffness[kLeft] * s.theta[kLeft] * s.theta[kLeft] +
                        g.stiffness[kRight] * s.theta[kRight] * s.theta[kRight];
    const Wide energy = 0.5 * (body + beams + joints);
    const Wide balance = energy - g.propulsion * (s.y - load(row[kFirstY] + i)) - work;
    const Wide lowest = load(row[kLowest] + i);
    raise(kCreated, over, balance - lowest);
    put(kLowest, over, choose(balance < lowest, balance, lowest));
    add(kSteps, over, all(1.0));
    raise(kSpeed, over, sqrt(s.vx * s.vx + s.vy * s.vy));
    for (const Side side : {kLeft, kRight}) raise(kMaxTheta + side, over, abs(s.theta[side]));
  }

  const StableRules rules_;
  StableRuns& runs_;
};

void carry_out_stable(const GateParams& p, const StableMethod& method, StableRuns& runs) {
  Rounds(p, method, runs).run();
}
bool has_registers() { return HWY_TARGET != HWY_EMU128 && HWY_TARGET != HWY_SCALAR; }

}  // namespace HWY_NAMESPACE
}  // namespace gatewalk::dynamics
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gatewalk::dynamics {
HWY_EXPORT(carry_out_stable);
HWY_EXPORT(has_registers);

void carry_out_in_lanes(const GateParams& p, const StableMethod& method, const NextRun& next,
                        std::int64_t most_work, std::int64_t at_once) {
  const auto runs = std::make_unique<StableRuns>(p, method, next, most_work, at_once);
  HWY_DYNAMIC_DISPATCH(carry_out_stable)(p, method, *runs);
}

bool lanes_pay_for_stable() { return HWY_DYNAMIC_DISPATCH(has_registers)(); }

}  // namespace gatewalk::dynamics
#endif
