// SPDX-License-Identifier: MIT
#include "markov/walk.h"

#include <Random123/philox.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "markov/walk.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef GATEWALK_MARKOV_WALK_ONCE
#define GATEWALK_MARKOV_WALK_ONCE

namespace gatewalk::markov {

using Word = std::uint64_t;

/// A move packed into one word, so that a draw takes two look-ups. Bits 0 to 9: di_x + 512; 10 to
/// 31: the number of slots of the target row; 32 to 41: di_y + 512; 42 to 62: the first slot of the
/// target row; 63: the walk ends.
constexpr int kReach = 512;
constexpr Word kMostSlots = Word{1} << 21;
constexpr Word kStay = (Word{kReach} << 32) + kReach;
constexpr Word kShift = (Word{1} << 63) + (Word{0x3ff} << 32) + 0x3ff;  // bits that change the cell
constexpr Word kEndTrapped = (Word{1} << 63) + kStay;
constexpr Word kEndUnsampled = kEndTrapped + (Word{1} << 10);
constexpr Word kEndCutOff = kEndTrapped + (Word{2} << 10);

constexpr Word move_to(std::size_t first_slot, int slots, int di_x, int di_y) {
  return (Word{first_slot} << 42) + (static_cast<Word>(di_y + kReach) << 32) +
         (static_cast<Word>(slots) << 10) + static_cast<Word>(di_x + kReach);
}

/// A cell packed into one word: row in the upper half, column in the lower.
constexpr Word cell_at(int column, int row) {
  return (static_cast<Word>(row) << 32) + static_cast<Word>(column);
}

struct WalkRules {
  const Word* keep;    // (slots)
  const Word* moves;   // (slots x 2)
  Word corner;         // the last cell
  Word key[2], input;  // key and counter word of the stream
};

/// The numbers counted in a cell: by Ending, and 0 beyond the last.
constexpr int kEachBits = 3;
constexpr Word kEach = Word{1} << kEachBits;
static_assert(kEndings <= kEach);

constexpr int kMostLanes = 8;
// Registers of Philox blocks computed together, to hide the latency of products.
constexpr int kTogether = 4;
constexpr int kPool = 2048;  // walks

/// Walks that have made equally many draws. Walks under way are at the front of `on`; ended walks
/// are at the back of `ended`, with their last move.
struct alignas(64) Pool {
  static constexpr int kRoom = kPool + kTogether * kMostLanes;  // whole registers
  struct Walks {
    Word move[kRoom], cell[kRoom], number[kRoom];
  };
  Walks on, ended;
  Word words[4][kRoom];
  int walking, first_ended;
};

/// For each set of marked lanes: the marked lanes first, then the others, four bits each.
constexpr auto kMarkedFirst = [] {
  std::array<Word, 1 << kMostLanes> order{};
  for (Word marks = 0; marks < order.size(); ++marks) {
    int place = 0;
    for (const Word mark : {1, 0})
      for (Word lane = 0; lane < kMostLanes; ++lane)
        if ((marks >> lane & 1) == mark) order[marks] += lane << (4 * place++);
  }
  return order;
}();

}  // namespace gatewalk::markov

#endif  // GATEWALK_MARKOV_WALK_ONCE

HWY_BEFORE_NAMESPACE();
namespace gatewalk::markov {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<Word, kMostLanes>;
using V = hn::Vec<D>;

HWY_INLINE int lanes() { return static_cast<int>(hn::Lanes(D())); }
HWY_INLINE V all(Word word) { return hn::Set(D(), word); }
HWY_INLINE V low_half(V v) { return hn::And(v, all(0xffffffff)); }
HWY_INLINE V high_half(V v) { return hn::ShiftRight<32>(v); }

/// The product of the low halves.
HWY_INLINE V mul_low(V a, V b) {
#if HWY_TARGET == HWY_SCALAR  // has no registers with two halves
  return hn::Mul(low_half(a), low_half(b));
#else
  const hn::Repartition<std::uint32_t, D> halves;
  return hn::MulEven(hn::BitCast(halves, a), hn::BitCast(halves, b));
#endif
}

/// The high word of the product a b.
HWY_INLINE V mul_high(V a, Word b) {
  const V a1 = high_half(a), b0 = all(b & 0xffffffff), b1 = all(b >> 32);
  const V middle = hn::Add(mul_low(a1, b0), high_half(mul_low(a, b0)));
  const V carry = high_half(hn::Add(mul_low(a, b1), low_half(middle)));
  return hn::Add(hn::Add(mul_low(a1, b1), high_half(middle)), carry);
}

HWY_INLINE V look_up(const Word* table, V index) {
  return hn::GatherIndex(D(), table, hn::BitCast(hn::RebindToSigned<D>(), index));
}

/// Computes block `block` of every walk's Philox4x64-10 (Salmon et al. 2011).
void fill_words(const WalkRules& rules, Word block, Pool& pool) {
  constexpr Word kMultiplier[] = {0xd2e7470ee14c6c93, 0xca5a826395121157};
  constexpr Word kBump[] = {0x9e3779b97f4a7c15, 0xbb67ae8584caa73b};
  const D d;
  for (int i = 0; i < pool.walking; i += kTogether * lanes()) {
    V words[kTogether][4];
    for (int k = 0; k < kTogether; ++k) {
      words[k][0] = all(block);
      words[k][1] = hn::Load(d, pool.on.number + i + k * lanes());
      words[k][2] = all(rules.input);
      words[k][3] = hn::Zero(d);
    }
    for (Word round = 0; round < 10; ++round) {
      const V key[] = {all(rules.key[0] + round * kBump[0]), all(rules.key[1] + round * kBump[1])};
      for (auto& w : words) {
        const V high[] = {mul_high(w[0], kMultiplier[0]), mul_high(w[2], kMultiplier[1])};
        const V low[] = {hn::Mul(w[0], all(kMultiplier[0])), hn::Mul(w[2], all(kMultiplier[1]))};
        w[0] = hn::Xor(hn::Xor(high[1], w[1]), key[0]);
        w[1] = low[1];
        w[2] = hn::Xor(hn::Xor(high[0], w[3]), key[1]);
        w[3] = low[0];
      }
    }
    for (int k = 0; k < kTogether; ++k)
      for (int j = 0; j < 4; ++j) hn::Store(words[k][j], d, pool.words[j] + i + k * lanes());
  }
}

/// Draws a move for every walk, from the row to which its last move led (Walker::pick).
void draw_moves(const WalkRules& rules, const Word* words, Pool& pool) {
  const D d;
  for (int i = 0; i < pool.walking; i += lanes()) {
    const V last = hn::Load(d, pool.on.move + i), word = hn::Load(d, words + i);
    const V slots = hn::And(hn::ShiftRight<10>(last), all((1 << 22) - 1));
    const V first_slot = hn::And(hn::ShiftRight<42>(last), all(kMostSlots - 1));
    const V low = mul_low(word, slots);
    const V high = hn::Add(mul_low(high_half(word), slots), high_half(low));
    const V slot = hn::Add(first_slot, high_half(high));
    const V within = hn::Or(hn::ShiftLeft<32>(high), low_half(low));
    const V second = hn::IfThenElseZero(hn::Gt(within, look_up(rules.keep, slot)), all(1));
    hn::Store(look_up(rules.moves, hn::Add(hn::Add(slot, slot), second)), d, pool.on.move + i);
  }
}

/// Carries out the drawn move of every walk in the pool, or ends the walk; with `last_time` all
/// walks end. Walks that go on move to places 0, 1, ... of `on` in their order, with their unused
/// words (`next_word` to 3), so registers stay full. Ended walks go to the back of `ended`.
void carry_out_moves(const WalkRules& rules, int next_word, bool last_time, Pool& pool) {
  const D d;
  const V nibbles = hn::ShiftLeft<2>(hn::Iota(d, 0));
  int walking = 0, first_ended = pool.first_ended, i = 0;
  for (; i < pool.walking; i += lanes()) {
    V move = hn::Load(d, pool.on.move + i), cell = hn::Load(d, pool.on.cell + i);
    // Outside the field, or at an end, a half of `next` or of `corner - next` is negative.
    const V next = hn::Sub(hn::Add(cell, hn::And(move, all(kShift))), all(kStay));
    const V signs =
        hn::And(hn::Or(next, hn::Sub(all(rules.corner), next)), all(0x80000000'80000000));
    auto goes_on = hn::Eq(signs, hn::Zero(d));
    if (last_time) {
      move = hn::IfThenElse(goes_on, all(kEndCutOff), move);
      goes_on = hn::MaskFromVec(hn::Zero(d));
    }
    cell = hn::IfThenElse(goes_on, next, cell);

    // Lanes behind the last walk never end; they are cut off below.
    const auto walks = hn::FirstN(d, static_cast<std::size_t>(pool.walking - i));
    const auto kept = hn::Or(goes_on, hn::Not(walks));
    std::uint8_t marks[8];
    hn::StoreMaskBits(d, kept, marks);
    const V order = hn::And(hn::Shr(all(kMarkedFirst[marks[0]]), nibbles), all(kMostLanes - 1));
    const auto kept_first = [&, from = hn::IndicesFromVec(d, order)](V v)
                                HWY_ATTR { return hn::TableLookupLanes(v, from); };
    move = kept_first(move);
    cell = kept_first(cell);
    const V number = kept_first(hn::Load(d, pool.on.number + i));
    const auto put = [&](Pool::Walks& to, int at) HWY_ATTR {
      hn::StoreU(move, d, to.move + at);
      hn::StoreU(cell, d, to.cell + at);
      hn::StoreU(number, d, to.number + at);
    };
    put(pool.on, walking);
    put(pool.ended, first_ended - lanes());
    for (int j = next_word; j < 4; ++j)
      hn::StoreU(kept_first(hn::Load(d, pool.words[j] + i)), d, pool.words[j] + walking);
    const int keeps = static_cast<int>(hn::CountTrue(d, kept));
    walking += keeps;
    first_ended -= lanes() - keeps;
  }
  pool.walking -= i - walking;
  pool.first_ended = first_ended;
}

/// Finds the last cell, in order of rows, and the ending of each walk in `ended`, and writes cell *
/// kEach + Ending into the first word. The top bit of a negative number is set; so is that of a
/// last column or row minus a number beyond it.
void find_endings(const WalkRules& rules, Pool& pool) {
  const D d;
  const V last_column = low_half(all(rules.corner)), last_row = high_half(all(rules.corner));
  const V columns = hn::Add(last_column, all(1));
  const auto of = [](Ending e) HWY_ATTR { return all(static_cast<Word>(e)); };
  const auto is_negative = [&](V v) HWY_ATTR { return hn::Ne(hn::ShiftRight<63>(v), hn::Zero(d)); };
  for (int i = pool.first_ended; i < Pool::kRoom; i += lanes()) {
    const V move = hn::LoadU(d, pool.ended.move + i), cell = hn::LoadU(d, pool.ended.cell + i);
    const V column = hn::Sub(hn::Add(low_half(cell), hn::And(move, all(0x3ff))), all(kReach));
    const V row =
        hn::Sub(hn::Add(high_half(cell), hn::And(high_half(move), all(0x3ff))), all(kReach));
    V ending = hn::IfThenElse(is_negative(hn::Sub(last_column, column)), of(Ending::right_edge),
                              of(Ending::left_edge));
    ending = hn::IfThenElse(is_negative(row), of(Ending::near_edge), ending);
    ending = hn::IfThenElse(is_negative(hn::Sub(last_row, row)), of(Ending::far_edge), ending);
    const auto ends_so = [&](Word last_move, Ending e) HWY_ATTR {
      ending = hn::IfThenElse(hn::Eq(move, all(last_move)), of(e), ending);
    };
    ends_so(kEndTrapped, Ending::trapped);
    ends_so(kEndCutOff, Ending::cut_off);
    ends_so(kEndUnsampled, Ending::unsampled);
    const V place = hn::Add(mul_low(high_half(cell), columns), low_half(cell));
    hn::StoreU(hn::Add(hn::ShiftLeft<kEachBits>(place), ending), d, pool.words[0] + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace gatewalk::markov
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace gatewalk::markov {
HWY_EXPORT(fill_words);
HWY_EXPORT(draw_moves);
HWY_EXPORT(carry_out_moves);
HWY_EXPORT(find_endings);

namespace {

__extension__ using Wide = unsigned __int128;

}  // namespace

WalkTally& WalkTally::operator+=(const WalkTally& other) {
  Ends::operator+=(other);
  walks += other.walks;
  still_walking += other.still_walking;
  steps += other.steps;
  return *this;
}

namespace {

/// Combines the chains of all types into one: rows and outputs of the types follow each other.
Chain stacked(const FieldChain& field) {
  if (field.chains().size() == 1) return field.chains().front();
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<Exit> exits;
  int rows = 0;
  for (const Chain& chain : field.chains()) {
    for (int row = 0; row < chain.inputs(); ++row)
      for (Probabilities::InnerIterator it(chain.matrix(), row); it; ++it)
        entries.emplace_back(rows + row, std::ssize(exits) + it.col(), it.value());
    exits.insert(exits.end(), chain.exits().begin(), chain.exits().end());
    rows += chain.inputs();
  }
  Probabilities all(rows, std::ssize(exits));
  all.setFromTriplets(entries.begin(), entries.end());
  return Chain::from_probabilities(std::move(all), std::move(exits));
}

}  // namespace

// A row of n entries gets n slots of 2^64 units. Entry j owns p_j n 2^64 units, and together the
// entries fill the slots exactly: each slot takes one small entry as a whole and is filled up by
// one large entry.
Walker::Walker(const FieldChain& chain)
    : chain_(stacked(chain)),
      keep_(static_cast<std::size_t>(chain_.matrix().nonZeros()) + 1,
            std::numeric_limits<Word>::max()),
      outputs_(2 * keep_.size()) {
  constexpr Wide kSlotUnits = Wide{1} << 64;
  const Probabilities& p = chain_.matrix();
  std::vector<Wide> units;
  std::vector<int> small, large;
  for (int row = 0; row < chain_.inputs(); ++row) {
    const int begin = p.outerIndexPtr()[row];
    const int count = p.outerIndexPtr()[row + 1] - begin;
    if (count == 0) continue;
    const double* value = p.valuePtr() + begin;
    const int* output = p.innerIndexPtr() + begin;

    units.resize(static_cast<std::size_t>(count));
    Wide sum = 0;
    for (int j = 0; j < count; ++j) {
      // p in units of 2^-96, so that p n keeps 32 bits below the unit.
      const Wide scaled = static_cast<Wide>(std::ldexp(value[j], 96)) * static_cast<Wide>(count);
      units[j] = std::max(scaled >> 32, Wide{1});
      sum += units[j];
    }
    const auto largest = std::max_element(units.begin(), units.end());
    // Modulo 2^128, so it may be a decrease.
    *largest += static_cast<Wide>(count) * kSlotUnits - sum;

    const auto set = [&](int slot, Word keep, int first, int second) {
      const auto at = static_cast<std::size_t>(begin + slot);
      keep_[at] = keep;
      outputs_[2 * at] = output[first];
      outputs_[2 * at + 1] = output[second];
    };
    small.clear();
    large.clear();
    for (int j = 0; j < count; ++j) (units[j] < kSlotUnits ? small : large).push_back(j);
    while (!small.empty()) {
      const int s = small.back();
      const int l = large.back();
      small.pop_back();
      set(s, static_cast<Word>(units[s]) - 1, s, l);
      units[l] -= kSlotUnits - units[s];
      if (units[l] < kSlotUnits) {
        large.pop_back();
        small.push_back(l);
      }
    }
    for (const int l : large) set(l, std::numeric_limits<Word>::max(), l, l);
  }

  if (chain.chains().size() > 1) {
    types_ = chain;
    return;
  }
  const auto far = [](const Exit& exit) {
    return std::min(exit.di_x, exit.di_y) < -kReach || std::max(exit.di_x, exit.di_y) >= kReach;
  };
  const std::vector<Exit>& exits = chain_.exits();
  if (keep_.size() > kMostSlots || std::any_of(exits.begin(), exits.end(), far)) return;
  moves_.reserve(outputs_.size());
  for (const int output : outputs_)
    moves_.push_back(packed(exits[static_cast<std::size_t>(output)]));
  moves_.end()[-2] = kEndUnsampled;  // its slot keeps every word for the first output
}

Word Walker::packed(const Exit& exit) const {
  if (exit.next_input == Exit::kTrapped) return kEndTrapped;
  const int* const begin = chain_.matrix().outerIndexPtr() + exit.next_input;
  return chain_.is_sampled(exit.next_input) ? move_to(static_cast<std::size_t>(begin[0]),
                                                      begin[1] - begin[0], exit.di_x, exit.di_y)
                                            : move_to(keep_.size() - 1, 1, exit.di_x, exit.di_y);
}

std::int32_t Walker::pick(int row, Word word) const {
  const int* const begin = chain_.matrix().outerIndexPtr() + row;
  const Wide product = static_cast<Wide>(word) * static_cast<Wide>(begin[1] - begin[0]);
  const std::size_t slot =
      static_cast<std::size_t>(begin[0]) + static_cast<std::size_t>(product >> 64);
  return outputs_[2 * slot + (static_cast<Word>(product) > keep_[slot])];
}

int Walker::draw(int row, Word word) const {
  if (row < 0 || row >= chain_.inputs() || !chain_.is_sampled(row)) {
    throw std::invalid_argument("row " + std::to_string(row) +
                                " (counted from 0) cannot be drawn from: it does not exist or was "
                                "never sampled");
  }
  return pick(row, word);
}

/// The arguments of one call of walk(), or of a part of it.
struct Walker::Job {
  static constexpr std::int64_t kMostWalks = std::numeric_limits<std::int32_t>::max();

  Field field;
  Start start;
  int limit;
  bool limit_ends;  // true: the limit cuts walks off; false: they are still walking there
  Word seed;
  WalkRange range;                   // at most kMostWalks walks
  std::int32_t* final_cell_of_walk;  // may be null

  [[nodiscard]] std::int64_t cells() const { return std::int64_t{field.columns} * field.rows; }
};

/// The counts of one thread.
struct Walker::Counters {
  std::vector<std::int32_t> by_cell;  // (cells x kEach)
  std::int64_t still_walking = 0, steps = 0;

  explicit Counters(std::int64_t cells) : by_cell(static_cast<std::size_t>(cells) * kEach) {}

  /// Counts a walk that ended; `place` is cell * kEach + Ending.
  void count(const Job& job, Word place, std::int64_t number) {
    const bool stopped = !job.limit_ends && place % kEach == static_cast<Word>(Ending::cut_off);
    if (stopped)
      ++still_walking;
    else
      ++by_cell[place];
    if (job.final_cell_of_walk)
      job.final_cell_of_walk[number - job.range.first] = static_cast<std::int32_t>(place / kEach);
  }
};

void Walker::walk_plainly(const Job& job, std::int64_t first, std::int64_t last,
                          Counters& counters) const {
  for (std::int64_t number = first; number < last; ++number) {
    std::int64_t column = job.start.column;
    std::int64_t row = job.start.row;
    int input = job.start.input;
    std::optional<Ending> ending;
    r123::Philox4x64::ctr_type words;
    for (Word drawn = 0; !ending; ++drawn) {
      const int matrix_row = input + (types_ ? types_->type_of(column, row) * types_->inputs() : 0);
      if (!chain_.is_sampled(matrix_row)) {
        ending = Ending::unsampled;
        break;
      }
      if (drawn % 4 == 0) {
        words = r123::Philox4x64{}(
            {{drawn / 4, static_cast<Word>(number), static_cast<Word>(job.start.input), 0}},
            {{job.seed, kWalkStream}});
      }
      ++counters.steps;
      const int output = pick(matrix_row, words[static_cast<std::size_t>(drawn % 4)]);
      const Exit& exit = chain_.exits()[static_cast<std::size_t>(output)];
      ending = follow(job.field, exit, drawn + 1 == static_cast<Word>(job.limit), column, row);
      input = exit.next_input;
    }
    const std::int64_t cell = row * job.field.columns + column;
    counters.count(job, static_cast<Word>(cell) * kEach + static_cast<Word>(*ending), number);
  }
}

void Walker::walk_in_lanes(const Job& job, std::int64_t first, std::int64_t last,
                           Counters& counters) const {
  const WalkRules rules{keep_.data(),
                        moves_.data(),
                        cell_at(job.field.columns - 1, job.field.rows - 1),
                        {job.seed, kWalkStream},
                        static_cast<Word>(job.start.input)};
  const Word start_move = packed({job.start.input, 0, 0});
  const Word start_cell = cell_at(job.start.column, job.start.row);
  Pool pool;
  for (int walks; first < last; first += walks) {
    walks = static_cast<int>(std::min<std::int64_t>(kPool, last - first));
    // The lanes behind the last walk also need a row to draw from.
    for (int i = 0; i < walks + kMostLanes; ++i) {
      pool.on.move[i] = start_move;
      pool.on.cell[i] = start_cell;
      pool.on.number[i] = static_cast<Word>(first) + static_cast<Word>(i);
    }
    pool.walking = walks;
    pool.first_ended = Pool::kRoom;
    for (int drawn = 0; pool.walking > 0; ++drawn) {
      counters.steps += pool.walking;
      const int word = drawn % 4;
      if (word == 0) HWY_DYNAMIC_DISPATCH(fill_words)(rules, static_cast<Word>(drawn / 4), pool);
      HWY_DYNAMIC_DISPATCH(draw_moves)(rules, pool.words[word], pool);
      HWY_DYNAMIC_DISPATCH(carry_out_moves)(rules, word + 1, drawn + 1 == job.limit, pool);
    }

    HWY_DYNAMIC_DISPATCH(find_endings)(rules, pool);
    for (int i = pool.first_ended; i < Pool::kRoom; ++i) {
      const Word place = pool.words[0][i];
      // An unsampled row has nothing to draw from.
      counters.steps -= place % kEach == static_cast<Word>(Ending::unsampled);
      counters.count(job, place, static_cast<std::int64_t>(pool.ended.number[i]));
    }
  }
}

WalkTally Walker::run(bool in_lanes, const Field& field, const Start& start, int max_cells,
                      Word seed, WalkRange range,
                      std::vector<std::int32_t>* final_cell_of_walk) const {
  if (types_)
    validate(*types_, field, start, max_cells);
  else
    validate(chain_, field, start, max_cells);
  if (range.first < 0 || range.count < 0 ||
      range.first > std::numeric_limits<std::int64_t>::max() - range.count) {
    throw std::invalid_argument("walks: " + std::to_string(range.count) + " from number " +
                                std::to_string(range.first) + " on is not a range from 0 up");
  }
  if (final_cell_of_walk) final_cell_of_walk->resize(static_cast<std::size_t>(range.count));
  const bool limited = max_cells > 0;
  WalkTally total;
  std::int64_t done = 0;
  do {
    const std::int64_t count = std::min(range.count - done, Job::kMostWalks);
    total += run(in_lanes, {field,
                            start,
                            limited ? max_cells : kMostCells,
                            limited,
                            seed,
                            {range.first + done, count},
                            final_cell_of_walk ? final_cell_of_walk->data() + done : nullptr});
    done += count;
  } while (done < range.count);
  return total;
}

WalkTally Walker::run(bool in_lanes, const Job& job) const {
  const WalkRange& range = job.range;
  tbb::enumerable_thread_specific<Counters> counters(job.cells());
  const std::int64_t pools = range.count / kPool + (range.count % kPool > 0);
  tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, pools),
                    [&](const tbb::blocked_range<std::int64_t>& part) {
                      const std::int64_t first = range.first + part.begin() * kPool;
                      const std::int64_t last =
                          range.first + (part.end() < pools ? part.end() * kPool : range.count);
                      if (in_lanes)
                        walk_in_lanes(job, first, last, counters.local());
                      else
                        walk_plainly(job, first, last, counters.local());
                    });
  WalkTally tally;
  tally.walks = range.count;
  tally.final_cells = CellCounts::Zero(job.field.rows, job.field.columns);
  for (const Counters& of_thread : counters) {
    tally.still_walking += of_thread.still_walking;
    tally.steps += of_thread.steps;
  }
  for (std::int64_t at = 0; at < job.cells(); ++at) {
    CellEndings<std::int64_t> cell{at};
    for (const Counters& of_thread : counters)
      for (std::size_t e = 0; e < kEndings; ++e)
        cell.by_ending[e] += of_thread.by_cell[static_cast<std::size_t>(at) * kEach + e];
    std::int64_t& all = tally.final_cells.data()[at];
    for (std::size_t e = 0; e < kEndings; ++e) {
      all += cell.by_ending[e];
      tally.endings[e] += cell.by_ending[e];
    }
    if (all > cell[Ending::trapped]) tally.mixed_cells.push_back(cell);
  }
  return tally;
}

WalkTally Walker::walk(const Field& field, const Start& start, int max_cells, Word seed,
                       WalkRange range, std::vector<std::int32_t>* final_cell_of_walk) const {
  return run(walks_in_lanes(), field, start, max_cells, seed, range, final_cell_of_walk);
}

WalkTally Walker::walk_plainly(const Field& field, const Start& start, int max_cells, Word seed,
                               WalkRange range,
                               std::vector<std::int32_t>* final_cell_of_walk) const {
  return run(false, field, start, max_cells, seed, range, final_cell_of_walk);
}

}  // namespace gatewalk::markov
#endif
