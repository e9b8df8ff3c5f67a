// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "markov/predict/plan.h"
#include "markov/predict/row_sweeps.h"
#include "markov/staying.h"

namespace gatewalk::markov {
namespace {

std::vector<Move> sideways_only(std::vector<Move> moves) {
  for (Move& m : moves) m.di_y = 0;
  return moves;
}

constexpr double kFewDigits = 1e-6;
// A residual at rounding error, which refinement cannot reduce.
constexpr double kRoundingOnly = 1e-14;
// Time of sweeps / time of sums; measured: 0.2 to 0.8 in rows of 9 and 101 cells of 87 to 1793
// states.
constexpr double kSweepsBySums = 0.5;

[[noreturn]] void refuse() {
  throw std::runtime_error(
      "predict by rows: fewer than 6 digits hold: walks can circle (almost) for ever");
}

/// Prediction without a limit of cells, row by row, all starts side by side: the mass that enters a
/// row from below, its visits within the row, and the mass that goes up from there.
class PredictionRows {
 public:
  PredictionRows(const PredictionPlan& plan, const Field& field, const std::vector<Start>& starts,
                 const PredictOptions& options, bool may_stop)
      : plan_(plan),
        field_(field),
        may_stop_(may_stop),
        tolerance_(options.tolerance_of(PredictOptions::Solver::rows) / (field.rows + 1)),
        most_sums_(options.max_steps),
        layout_(field.columns, 1, sideways_only(plan.moves), 1,
                std::vector<std::int64_t>(starts.size())),
        stride_(layout_.stride()),
        tallies_(kTallyMoved + std::ssize(plan.moves)),
        masks_(plan.has_uniform_rows ? 0 : std::ssize(plan.chains)),
        buffer_((5 + plan.highest) * plan.inputs + tallies_ + masks_, stride_),
        within_(buffer_.take(plan.inputs)),
        visits_(buffer_.take(plan.inputs)),
        now_(buffer_.take(plan.inputs)),
        next_(buffer_.take(plan.inputs)) {
    for (int k = 0; k <= plan.highest; ++k) entering_.push_back(buffer_.take(plan.inputs));
    tally_ = buffer_.take(tallies_);
    type_masks_ = buffer_.take(masks_);
    layout_.cover(0, field.columns - 1, 0, 0, whole_);
    for (const int input : plan.sideways)
      if (!sideways_.empty() && sideways_.back().last == input)
        ++sideways_.back().last;
      else
        sideways_.push_back({input, input + 1});
    first_ = field.rows;
    for (const Start& s : starts) {
      starts_.emplace_back(field, s);
      first_ = std::min<std::int64_t>(first_, s.row);
    }
    passed_.resize(starts.size());
    most_sums_taken_.resize(starts.size());
    choose(options.row_method);
  }

  std::vector<StartTally> run() {
    for (std::int64_t row = first_; row < field_.rows; ++row) {
      look_at(row);
      clear_sideways(within_);
      apply_in_row(&RowStencils::first_sideways, entering_.front(), within_);
      if (!enter(row)) break;
      visits_.clear();
      const std::size_t type = types_.front().type;
      if (types_.size() > 1 || (ways_[type].columns.empty() && !ways_[type].sweeps))
        sum(row);
      else
        solve(plan_.chains[type], ways_[type]);
      add(entering_.front(), visits_, {0, plan_.inputs});
      count(row);
      // Go on to the next row: entering_[k] now belongs to the row k above the next one, which
      // receives the mass that goes up k + 1 rows from this row.
      entering_.front().clear();
      std::rotate(entering_.begin(), entering_.begin() + 1, entering_.end());
      for (const CellsOfType& cells : types_) {
        const std::vector<Stencil>& upwards = plan_.chains[cells.type].by_row->get().upwards;
        for (std::size_t k = 0; k < upwards.size(); ++k)
          apply(upwards[k], cells, layout_.shifts(0), visits_, entering_[k]);
      }
    }
    return std::move(starts_);
  }

  /// The number of sums in the row that took the most.
  [[nodiscard]] int most_sums_taken(std::size_t j) const { return most_sums_taken_[j]; }
  /// The mass that entered rows, summed over all rows.
  [[nodiscard]] double passed(std::size_t j) const { return passed_[j]; }

 private:
  /// The cells of one type in a row: a mask of their places (none: all), and the registers that
  /// hold some of them.
  struct CellsOfType {
    std::size_t type;
    const double* mask;
    std::vector<Range> ranges;
  };

  [[nodiscard]] std::ptrdiff_t first_of(std::size_t j) const { return layout_.place(j, 0, 0).at; }
  [[nodiscard]] std::size_t type_of(std::int64_t column, std::int64_t row) const {
    return static_cast<std::size_t>(plan_.field_chain.type_of(column, row));
  }

  /// Finds the types of a row's cells.
  void look_at(std::int64_t row) {
    types_.clear();
    bool is_uniform = true;
    if (masks_ > 0)
      for (std::int64_t c = 1; c < field_.columns && is_uniform; ++c)
        is_uniform = type_of(c, row) == type_of(0, row);
    if (is_uniform) {
      types_.push_back({type_of(0, row), nullptr, whole_});
      return;
    }
    type_masks_.clear();
    for (std::size_t j = 0; j < starts_.size(); ++j)
      for (std::ptrdiff_t c = 0; c < field_.columns; ++c)
        mask_of(type_of(c, row))[first_of(j) + c] = 1.0;
    for (std::size_t type = 0; type < plan_.chains.size(); ++type) {
      CellsOfType cells{type, mask_of(type), {}};
      for (const Range& all : whole_)
        for (std::ptrdiff_t at = all.first; at < all.last; at += kLanes) {
          if (std::all_of(cells.mask + at, cells.mask + at + kLanes,
                          [](double m) { return m == 0.0; }))
            continue;
          if (!cells.ranges.empty() && cells.ranges.back().last == at)
            cells.ranges.back().last += kLanes;
          else
            cells.ranges.push_back({at, at + kLanes});
        }
      if (!cells.ranges.empty()) types_.push_back(std::move(cells));
    }
  }
  [[nodiscard]] double* mask_of(std::size_t type) const {
    return type_masks_.data() + static_cast<std::ptrdiff_t>(type) * stride_;
  }

  /// Computes to += stencil from, for cells of one type.
  void apply(const Stencil& stencil, const CellsOfType& cells, const Shift* shifts, Planes from,
             Planes to) const {
    apply_stencil(stencil, shifts, stride_, cells.mask, cells.ranges, from.data(), to.data(), true);
  }
  /// Computes to += stencil from for all cells, each by the stencil of its type. All moves stay
  /// within one row of planes: mass that goes up arrives in the same column of `to`.
  void apply_in_row(Stencil RowStencils::*stencil, Planes from, Planes to) const {
    for (const CellsOfType& cells : types_)
      apply(plan_.chains[cells.type].by_row->get().*stencil, cells, layout_.shifts(0), from, to);
  }
  /// Adds the numbers of these inputs.
  void add(Planes from, Planes to, const Range& inputs) const {
    const std::ptrdiff_t at = inputs.first * stride_;
    for (const Range& r : whole_)
      accumulate(from.data() + at, to.data() + at, static_cast<int>(inputs.last - inputs.first),
                 stride_, r.first, r.last);
  }
  /// Clears the numbers of inputs entered within a row.
  void clear_sideways(Planes planes) const {
    for (const Range& inputs : sideways_)
      std::fill_n(planes.data() + inputs.first * stride_, (inputs.last - inputs.first) * stride_,
                  0.0);
  }
  /// The total of the tally for each start.
  [[nodiscard]] std::vector<double> totals() const {
    std::vector<double> sums;
    for (std::size_t j = 0; j < starts_.size(); ++j) {
      CompensatedSum sum;
      for (std::ptrdiff_t c = 0; c < field_.columns; ++c)
        sum += tally_.data()[kTallyTotal * stride_ + first_of(j) + c];
      sums.push_back(sum.value());
    }
    return sums;
  }
  [[nodiscard]] std::vector<double> totals(const Stencil& stencil, Planes mass) {
    tally_.clear();
    apply(stencil, {0, nullptr, whole_}, layout_.identity(0), mass, tally_);
    return totals();
  }
  void erase(std::size_t j, Planes mass) const {
    for (std::ptrdiff_t input = 0; input < plan_.inputs; ++input)
      std::fill_n(mass.data() + input * stride_ + first_of(j), field_.columns, 0.0);
  }

  /// Begins the starts in this row, and closes starts with (almost) no mass left. Returns false if
  /// no mass is left at all.
  bool enter(std::int64_t row) {
    entered_ = totals(plan_.arriving, entering_.front());
    std::vector<double> left = entered_;
    for (std::size_t k = 1;
         k < entering_.size() && row + static_cast<std::int64_t>(k) < field_.rows; ++k) {
      const std::vector<double> above = totals(plan_.arriving, entering_[k]);
      std::transform(left.begin(), left.end(), above.begin(), left.begin(), std::plus<>());
    }
    bool any = false;
    for (std::size_t j = 0; j < starts_.size(); ++j) {
      StartTally& w = starts_[j];
      if (w.start.row == row) {
        w.draw_first(plan_.field_chain.at(w.start.column, row), field_, false,
                     [&](std::int64_t column, std::int64_t to_row, int input, double p) {
                       const Planes to = to_row == row
                                             ? within_
                                             : entering_[static_cast<std::size_t>(to_row - row)];
                       to.data()[input * stride_ + first_of(j) + column] += p;
                     });
        entered_[j] = 1.0;
      } else if (w.start.row < row && !w.over && left[j] <= std::max(tolerance_, kNothing)) {
        w.remainder += left[j];
        w.over = true;
        erase(j, within_);
        for (Planes mass : entering_) erase(j, mass);
      }
      any = any || !w.over;
      passed_[j] += entered_[j];
    }
    return any;
  }

  /// Computes visits = within + Q within + Q Q within + ...
  void sum(std::int64_t row) {
    std::swap(now_, within_);
    std::vector<char> done(starts_.size());
    for (StartTally& w : starts_) w.pace = {};
    for (int sums = 0;; ++sums) {
      const std::vector<double> walking = totals(plan_.staying, now_);
      bool any = false;
      for (std::size_t j = 0; j < starts_.size(); ++j) {
        if (done[j]) continue;
        const double enough = std::max(tolerance_ * entered_[j], kNothing);
        done[j] = walking[j] <= enough;
        if (!done[j] && may_stop_ &&
            starts_[j].pace.is_too_slow(sums, walking[j], enough, kMostSums)) {
          done[j] = 1;
          stop(j);
        }
        if (done[j]) {
          most_sums_taken_[j] = std::max(most_sums_taken_[j], sums);
          starts_[j].remainder += walking[j];
          erase(j, now_);
          continue;
        }
        if (sums == most_sums_)
          throw std::runtime_error("predict by rows: after " + std::to_string(sums) +
                                   " moves within row " + std::to_string(row) +
                                   " (counted from 0) a share of " +
                                   fmt::format("{:f}", walking[j]) +
                                   " still walks there: it can circle (almost) for ever");
        ++starts_[j].steps;
        any = true;
      }
      if (!any) return;
      for (const Range& inputs : sideways_) add(now_, visits_, inputs);
      clear_sideways(next_);
      apply_in_row(&RowStencils::sideways, now_, next_);
      std::swap(now_, next_);
    }
  }

  /// The method for the visits in a row of one type: elimination of columns, sweeps, or (with
  /// neither) sums.
  struct RowWay {
    std::vector<const RowElimination::Column*> columns{};
    std::optional<RowSweeps> sweeps{};
  };

  /// Computes visits = (I - Q)^-1 within by elimination or sweeps. The residual, within + Q visits
  /// - visits, is mass whose visits are not counted; it would end once, so the sum of its
  /// magnitudes bounds the error. While the residual shrinks, it is solved for in turn (iterative
  /// refinement).
  void solve(const PreparedChain& chain, RowWay& way) {
    constexpr int kMostRounds = 4;
    const double enough = std::max(tolerance_, kRoundingOnly);
    std::vector<char> wanted(starts_.size(), 1);
    std::vector<double> missing = entered_;
    const double* from = within_.data();
    for (int round = 0; round < kMostRounds; ++round) {
      for (std::size_t j = 0; j < starts_.size(); ++j)
        if (wanted[j] && !starts_[j].over && entered_[j] > 0.0)
          add_visits(chain, way, j, from, 0.5 * enough * entered_[j] / missing[j]);
      std::copy_n(within_.data(), within_.size(), next_.data());
      apply_in_row(&RowStencils::sideways, visits_, next_);
      double* const total = tally_.data() + kTallyTotal * stride_;
      std::fill_n(total, stride_, 0.0);
      for (const int input : plan_.sideways) {
        double* const after = next_.data() + input * stride_;
        const double* const before = visits_.data() + input * stride_;
        for (std::ptrdiff_t c = whole_.front().first; c < whole_.front().last; ++c) {
          after[c] -= before[c];
          total[c] += std::abs(after[c]);
        }
      }
      from = next_.data();
      const std::vector<double> found = totals();
      bool any = false;
      for (std::size_t j = 0; j < starts_.size(); ++j) {
        const bool better = round == 0 || found[j] < 0.5 * missing[j];
        wanted[j] = wanted[j] && better && found[j] > enough * entered_[j];
        any = any || wanted[j];
      }
      missing = found;
      if (!any) break;
    }
    for (std::size_t j = 0; j < starts_.size(); ++j) {
      if (!(missing[j] <= kFewDigits * entered_[j])) {
        if (!may_stop_) refuse();
        stop(j);
        continue;
      }
      starts_[j].remainder += missing[j];
    }
  }
  /// Computes visits += (I - Q)^-1 from for one start; by sweeps to `accuracy` of the largest
  /// number.
  void add_visits(const PreparedChain& chain, RowWay& way, std::size_t j, const double* from,
                  double accuracy) {
    if (!way.sweeps) {
      workspace_.resize(chain.elimination->get().workspace(field_.columns));
      chain.elimination->get().solve(way.columns, from + first_of(j), visits_.data() + first_of(j),
                                     stride_, workspace_.data());
      return;
    }
    const auto inputs = static_cast<std::size_t>(plan_.inputs);
    workspace_.resize(static_cast<std::size_t>(field_.columns) * inputs);
    const auto each = [&](auto use) {  // use(place in the planes, place in the workspace)
      std::ptrdiff_t plane = first_of(j);
      for (std::size_t input = 0; input < inputs; ++input, plane += stride_)
        for (std::size_t c = 0; c < static_cast<std::size_t>(field_.columns); ++c)
          use(plane + static_cast<std::ptrdiff_t>(c), c * inputs + input);
    };
    each([&](std::ptrdiff_t plane, std::size_t at) { workspace_[at] = from[plane]; });
    way.sweeps->solve(workspace_.data(), RowSweeps::Of::largest, accuracy);
    each([&](std::ptrdiff_t plane, std::size_t at) { visits_.data()[plane] += workspace_[at]; });
  }
  /// Gives up a start.
  void stop(std::size_t j) {
    starts_[j].stopped = starts_[j].over = true;
    erase(j, visits_);
    for (Planes mass : entering_) erase(j, mass);
  }

  void count(std::int64_t row) {
    tally_.clear();
    for (const CellsOfType& cells : types_)
      apply(plan_.chains[cells.type].ends, cells, layout_.identity(0), visits_, tally_);
    for (std::size_t j = 0; j < starts_.size(); ++j)
      for (std::ptrdiff_t c = 0; c < field_.columns; ++c)
        starts_[j].count(field_, plan_.moves, c, row, false, tally_.data() + first_of(j) + c,
                         stride_);
  }

  /// Chooses the method for each chain. Rows of several types are always summed.
  void choose(PredictOptions::RowMethod method) {
    using RowMethod = PredictOptions::RowMethod;
    ways_.resize(plan_.chains.size());
    // Independent of the starts, for the same bits.
    const double width = field_.columns, rows = field_.rows;
    for (std::size_t k = 0; k < plan_.chains.size() && method != RowMethod::sums; ++k) {
      const PreparedChain& chain = plan_.chains[k];
      const RowStencils& by_row = chain.by_row->get();
      const double sums = std::log(std::clamp(tolerance_, 1e-280, 0.1)) /
                          std::log(std::clamp(by_row.stay, 1e-6, 1.0 - 1e-9)),
                   by_sums = rows * sums * static_cast<double>(by_row.sideways.terms.size()) *
                             std::ceil(width / kLanes);
      double by_elimination = std::numeric_limits<double>::infinity();
      if (chain.elimination && method != RowMethod::sweeps) {
        const RowElimination& elimination = chain.elimination->get();
        by_elimination = std::min(width, 0.5 * sums) * elimination.column_cost() +
                         rows * width * elimination.solve_cost();
        if (method == RowMethod::elimination || by_elimination < kSweepsBySums * by_sums)
          ways_[k].columns = elimination.columns(field_.columns);
      }
      if (!ways_[k].columns.empty() || method == RowMethod::elimination) continue;
      if (ways_[k]
              .sweeps
              .emplace(moves_within(by_row), RowSweeps::Sums::brought, field_.columns, plan_.inputs)
              .suits())
        continue;
      ways_[k].sweeps.reset();
      if (by_elimination < by_sums)
        ways_[k].columns = chain.elimination->get().columns(field_.columns);
    }
  }
  [[nodiscard]] std::vector<RowSweeps::Move> moves_within(const RowStencils& by_row) const {
    std::vector<RowSweeps::Move> moves;
    for (const auto& groups : by_row.sideways.passes)
      for (const Group& g : groups)
        for (int i = g.begin; i < g.end; ++i) {
          const Term& term = by_row.sideways.terms[static_cast<std::size_t>(i)];
          moves.push_back(
              {term.source, g.target, plan_.moves[static_cast<std::size_t>(g.shift)].di_x, term.p});
        }
    return moves;
  }

  const PredictionPlan& plan_;
  Field field_;
  bool may_stop_;
  // In a row: share of the mass that entered which may be left; in all rows not entered yet: share
  // of all walks.
  double tolerance_;
  int most_sums_;
  Layout layout_;                            // layout of one row
  std::ptrdiff_t stride_, tallies_, masks_;  // masks_: of types; 0 if rows are uniform
  PlaneBuffer buffer_;
  // Planes of a row, by input, where Q is one move within the row. within_: mass that enters the
  // row's states by its first move within the row. visits_ = within + Q within + Q Q within + ...
  // now_, next_: two successive terms of this sum.
  Planes within_, visits_, now_, next_;
  std::vector<Planes> entering_;  // mass from below: into this row, the row above, ...
  Planes tally_;                  // by Tally
  Planes type_masks_;             // by type: 1 in the present row's cells of the type
  std::vector<Range> whole_;
  std::vector<Range> sideways_;     // inputs entered within a row; the others are 0 in within_,
                                    // now_ and next_
  std::vector<CellsOfType> types_;  // types in the present row
  std::int64_t first_ = 0;          // first row with a start
  std::vector<StartTally> starts_;
  std::vector<double> entered_, passed_;  // per start: mass that entered this row, all rows so far
  std::vector<int> most_sums_taken_;      // per start
  std::vector<RowWay> ways_;              // per chain
  std::vector<double> workspace_;
};

}  // namespace

RowStencils LazyRowStencils::made() const {
  const auto is_in = [&](const std::vector<int>& inputs) {
    std::vector<char> in(static_cast<std::size_t>(plan_.inputs));
    for (const int input : inputs) in[static_cast<std::size_t>(input)] = 1;
    return in;
  };
  const std::vector<char> from_below = is_in(plan_.from_below), sideways = is_in(plan_.sideways);
  const std::vector<int> move_of = moves_of_exits(plan_.moves, chain_);
  std::vector<Entry> first, further;
  std::vector<std::vector<Entry>> upwards(static_cast<std::size_t>(plan_.highest));
  for (int input = 0; input < plan_.inputs; ++input) {
    const auto i = static_cast<std::size_t>(input);
    if (!from_below[i] && !sideways[i]) continue;
    for (Probabilities::InnerIterator it(chain_.matrix(), input); it; ++it) {
      const auto output = static_cast<std::size_t>(it.col());
      const Exit& exit = chain_.exits()[output];
      if (exit.next_input == Exit::kTrapped) continue;
      const Entry entry{exit.next_input, move_of[output], input, it.value()};
      if (exit.di_y > 0) upwards[static_cast<std::size_t>(exit.di_y) - 1].push_back(entry);
      if (exit.di_y == 0 && from_below[i]) first.push_back(entry);
      if (exit.di_y == 0 && sideways[i]) further.push_back(entry);
    }
  }
  RowStencils made{Stencil(first), Stencil(further), {}, 0.0};
  for (const auto& entries : upwards) made.upwards.emplace_back(entries);
  made.stay = staying_per_move(plan_.inputs, [&](auto use) {
    for (const auto& groups : made.sideways.passes)
      for (const Group& g : groups)
        for (int i = g.begin; i < g.end; ++i) {
          const Term& term = made.sideways.terms[static_cast<std::size_t>(i)];
          use(term.source, g.target, term.p);
        }
  });
  return made;
}

MaybePredicted predict_by_rows(const PredictionPlan& plan, const Field& field,
                               const std::vector<Start>& starts, const PredictOptions& options,
                               bool may_stop) {
  PredictionRows rows(plan, field, starts, options, may_stop);
  const std::vector<StartTally> tallies = rows.run();
  MaybePredicted results;
  // A move is rounded twice: in a row's equations and in their residual.
  for (std::size_t j = 0; j < tallies.size(); ++j) {
    std::optional<FinalDistribution>& result = results.emplace_back();
    if (tallies[j].stopped) continue;
    result = tallies[j].result(
        2.0 * (plan.most_terms + 4),
        (rows.most_sums_taken(j) + 1) * rows.passed(j) + plan.inputs + plan.outputs + 8);
    if (result->rounding >= 0.0 && result->rounding <= kFewDigits) continue;
    if (!may_stop) refuse();
    result.reset();
  }
  return results;
}

}  // namespace gatewalk::markov
