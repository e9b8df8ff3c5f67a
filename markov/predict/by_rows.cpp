#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>

#include "markov/predict/plan.h"

namespace gatewalk::markov {
namespace {

std::vector<Move> sideways_only(std::vector<Move> moves) {
  for (Move& m : moves) m.di_y = 0;
  return moves;
}

constexpr double kFewDigits = 1e-6;
constexpr double kRoundingOnly = 1e-14;  // another round makes it no better

[[noreturn]] void refuse() {
  throw std::runtime_error("march: fewer than 6 digits hold: walks can circle (almost) for ever");
}

/// A row of cells per start, without limit: what enters it from below, what visits it, what goes
/// up.
class Rows {
 public:
  Rows(const PredictionPlan& plan, const Field& field, const std::vector<Start>& starts,
       double tolerance, Sweeper::RowMethod method, int most_sums)
      : plan_(plan),
        field_(field),
        tolerance_(tolerance / (field.rows + 1)),
        most_sums_(most_sums),
        layout_(field.columns, 1, sideways_only(plan.moves), 1,
                std::vector<std::int64_t>(starts.size())),
        stride_(layout_.stride()),
        all_(plan.inputs * stride_),
        numbers_((5 + plan.highest) * all_ + (kTallyMoved + std::ssize(plan.moves)) * stride_) {
    double* next = numbers_.data();
    for (double** p : {&within_, &visits_, &now_, &next_}) *p = std::exchange(next, next + all_);
    for (int k = 0; k <= plan.highest; ++k) entering_.push_back(std::exchange(next, next + all_));
    tally_ = next;
    layout_.cover(0, field.columns - 1, 0, 0, whole_);
    first_ = field.rows;
    for (const Start& s : starts) {
      walks_.emplace_back(field, s);
      first_ = std::min<std::int64_t>(first_, s.row);
    }
    passed_.resize(starts.size());
    most_sums_taken_.resize(starts.size());
    choose(method);
  }

  std::vector<StartTally> run() {
    for (std::int64_t row = first_; row < field_.rows; ++row) {
      const PreparedChain& chain = plan_.at(row);
      clear(within_);
      apply_in_row(chain.first_sideways, entering_.front(), within_);
      if (!enter(row)) break;
      clear(visits_);
      const auto& columns = columns_[static_cast<std::size_t>(plan_.number_at(row))];
      if (columns.empty())
        sum(chain, row);
      else
        eliminate(chain, columns);
      add(entering_.front(), visits_);
      count(chain, row);
      // Rows move down by one; what goes up by k arrives in the k-th.
      clear(entering_.front());
      std::rotate(entering_.begin(), entering_.begin() + 1, entering_.end());
      for (std::size_t k = 0; k < chain.upwards.size(); ++k)
        apply_in_row(chain.upwards[k], visits_, entering_[k]);
    }
    return std::move(walks_);
  }

  /// Sums of visits, in the row that took most.
  [[nodiscard]] int most_sums_taken(std::size_t j) const { return most_sums_taken_[j]; }
  /// Mass that entered rows, over all rows.
  [[nodiscard]] double passed(std::size_t j) const { return passed_[j]; }

 private:
  [[nodiscard]] std::ptrdiff_t first_of(std::size_t j) const { return layout_.place(j, 0, 0).at; }
  void clear(double* mass) const { std::fill_n(mass, all_, 0.0); }

  void apply_in_row(const Stencil& stencil, const double* from, double* to) const {
    apply_stencil(stencil, layout_.shifts(0), stride_, nullptr, whole_, from, to, true);
  }
  void tally(const Stencil& stencil, const double* mass) {
    std::fill_n(tally_, (kTallyMoved + std::ssize(plan_.moves)) * stride_,
                0.0);  // not every chain ends in all ways
    apply_stencil(stencil, layout_.identity(0), stride_, nullptr, whole_, mass, tally_, false);
  }
  void add(const double* from, double* to) const {
    for (const Range& r : whole_) accumulate(from, to, plan_.inputs, stride_, r.first, r.last);
  }
  /// The tally's totals, per start.
  [[nodiscard]] std::vector<double> totals() const {
    std::vector<double> sums;
    for (std::size_t j = 0; j < walks_.size(); ++j) {
      CompensatedSum sum;
      for (std::ptrdiff_t c = 0; c < field_.columns; ++c)
        sum += tally_[kTallyTotal * stride_ + first_of(j) + c];
      sums.push_back(sum.value());
    }
    return sums;
  }
  [[nodiscard]] std::vector<double> totals(const Stencil& stencil, const double* mass) {
    tally(stencil, mass);
    return totals();
  }
  void erase(std::size_t j, double* mass) const {
    for (std::ptrdiff_t input = 0; input < plan_.inputs; ++input)
      std::fill_n(mass + input * stride_ + first_of(j), field_.columns, 0.0);
  }

  /// Starts in this row begin; those of which (almost) nothing is left are over. False when nothing
  /// is left at all.
  bool enter(std::int64_t row) {
    entered_ = totals(plan_.arriving, entering_.front());
    std::vector<double> left = entered_;
    for (std::size_t k = 1;
         k < entering_.size() && row + static_cast<std::int64_t>(k) < field_.rows; ++k) {
      const std::vector<double> above = totals(plan_.arriving, entering_[k]);
      std::transform(left.begin(), left.end(), above.begin(), left.begin(), std::plus<>());
    }
    bool any = false;
    for (std::size_t j = 0; j < walks_.size(); ++j) {
      StartTally& w = walks_[j];
      if (w.start.row == row) {
        w.draw_first(plan_.at(row).chain, field_, false,
                     [&](std::int64_t column, std::int64_t to_row, int input, double p) {
                       double* const to = to_row == row
                                              ? within_
                                              : entering_[static_cast<std::size_t>(to_row - row)];
                       to[input * stride_ + first_of(j) + column] += p;
                     });
        entered_[j] = 1.0;
      } else if (w.start.row < row && !w.over && left[j] <= std::max(tolerance_, kNothing)) {
        w.remainder += left[j];
        w.over = true;
        erase(j, within_);
        for (double* mass : entering_) erase(j, mass);
      }
      any = any || !w.over;
      passed_[j] += entered_[j];
    }
    return any;
  }

  /// visits = within + Q within + Q Q within + ...
  void sum(const PreparedChain& chain, std::int64_t row) {
    std::swap(now_, within_);
    std::vector<char> done(walks_.size());
    for (int sums = 0;; ++sums) {
      const std::vector<double> walking = totals(plan_.staying, now_);
      bool any = false;
      for (std::size_t j = 0; j < walks_.size(); ++j) {
        if (done[j]) continue;
        done[j] = walking[j] <= std::max(tolerance_ * entered_[j], kNothing);
        if (done[j]) {
          most_sums_taken_[j] = std::max(most_sums_taken_[j], sums);
          walks_[j].remainder += walking[j];
          erase(j, now_);
          continue;
        }
        if (sums == most_sums_)
          throw std::runtime_error("march: after " + std::to_string(sums) + " moves within row " +
                                   std::to_string(row + 1) + " a share of " +
                                   std::to_string(walking[j]) +
                                   " still walks there: it can circle (almost) for ever");
        ++walks_[j].steps;
        any = true;
      }
      if (!any) return;
      add(now_, visits_);
      clear(next_);
      apply_in_row(chain.sideways, now_, next_);
      std::swap(now_, next_);
    }
  }

  /// The same by elimination, as (I - Q)^-1 within. What is still missing then, within + Q visits -
  /// visits, bounds the error: were it to walk on, it would end somewhere.
  void eliminate(const PreparedChain& chain,
                 const std::vector<const RowElimination::Column*>& columns) {
    constexpr int kMostRounds = 4;
    workspace_.resize(chain.elimination->workspace(field_.columns));
    std::vector<char> wanted(walks_.size(), 1);
    std::vector<double> missing;
    const double* from = within_;
    for (int round = 0; round < kMostRounds; ++round) {
      for (std::size_t j = 0; j < walks_.size(); ++j)
        if (wanted[j] && !walks_[j].over)
          chain.elimination->solve(columns, from + first_of(j), visits_ + first_of(j), stride_,
                                   workspace_.data());
      std::copy_n(within_, all_, next_);
      apply_in_row(chain.sideways, visits_, next_);
      double* const total = tally_ + kTallyTotal * stride_;
      std::fill_n(total, stride_, 0.0);
      for (const int input : plan_.sideways) {
        double* const after = next_ + input * stride_;
        const double* const before = visits_ + input * stride_;
        for (std::ptrdiff_t c = whole_.front().first; c < whole_.front().last; ++c) {
          after[c] -= before[c];
          total[c] += std::abs(after[c]);
        }
      }
      from = next_;
      const std::vector<double> found = totals();
      bool any = false;
      for (std::size_t j = 0; j < walks_.size(); ++j) {
        const bool better = round == 0 || found[j] < 0.5 * missing[j];
        wanted[j] =
            wanted[j] && better && found[j] > std::max(tolerance_, kRoundingOnly) * entered_[j];
        any = any || wanted[j];
      }
      missing = found;
      if (!any) break;
    }
    for (std::size_t j = 0; j < walks_.size(); ++j) {
      if (!(missing[j] <= kFewDigits * entered_[j])) refuse();
      walks_[j].remainder += missing[j];
    }
  }

  void count(const PreparedChain& chain, std::int64_t row) {
    tally(chain.ends, visits_);
    for (std::size_t j = 0; j < walks_.size(); ++j)
      for (std::ptrdiff_t c = 0; c < field_.columns; ++c)
        walks_[j].count(field_, plan_.moves, c, row, false, tally_ + first_of(j) + c, stride_);
  }

  /// Columns to eliminate, per chain; none where sums are chosen.
  void choose(Sweeper::RowMethod method) {
    columns_.resize(plan_.chains.size());
    if (method == Sweeper::RowMethod::sums) return;
    for (std::size_t k = 0; k < plan_.chains.size(); ++k) {
      const PreparedChain& chain = plan_.chains[k];
      if (!chain.elimination) continue;
      const double width = field_.columns,
                   rows = field_.rows;  // whatever the starts: same bits in any company
      const double sums = std::log(std::clamp(tolerance_, 1e-280, 0.1)) /
                          std::log(std::clamp(chain.stays, 1e-6, 1.0 - 1e-9));
      const double by_sums = rows * sums * static_cast<double>(chain.sideways.terms.size()) *
                             std::ceil(width / kLanes);
      const double by_elimination = std::min(width, 0.5 * sums) * chain.elimination->column_cost() +
                                    rows * width * chain.elimination->solve_cost();
      if (method == Sweeper::RowMethod::elimination || by_elimination < by_sums)
        columns_[k] = chain.elimination->columns(field_.columns);
    }
  }

  const PredictionPlan& plan_;
  Field field_;
  double tolerance_;  // share of a row, and of all rows above together
  int most_sums_;
  Layout layout_;
  std::ptrdiff_t stride_, all_;
  Planes numbers_;
  // All planes of a row. Q: one move within the row.
  double *within_ = nullptr, *visits_ = nullptr, *now_ = nullptr, *next_ = nullptr;
  std::vector<double*> entering_;  // this row from below, the row above, ...
  double* tally_ = nullptr;
  std::vector<Range> whole_;
  std::int64_t first_ = 0;  // row
  std::vector<StartTally> walks_;
  std::vector<double> entered_, passed_;  // per start: this row, rows until now
  std::vector<int> most_sums_taken_;      // per start
  std::vector<std::vector<const RowElimination::Column*>> columns_;  // per chain
  std::vector<double> workspace_;
};

}  // namespace

std::vector<FinalDistribution> predict_by_rows(const PredictionPlan& plan, const Field& field,
                                               const std::vector<Start>& starts, double tolerance,
                                               Sweeper::RowMethod method, int most_sums) {
  Rows rows(plan, field, starts, tolerance, method, most_sums);
  const std::vector<StartTally> walks = rows.run();
  std::vector<FinalDistribution> results;
  // A move is rounded twice: into a row's equations, and in what they still miss.
  for (std::size_t j = 0; j < walks.size(); ++j) {
    results.push_back(walks[j].result(
        2.0 * (plan.most_terms + 4),
        (rows.most_sums_taken(j) + 1) * rows.passed(j) + plan.inputs + plan.outputs + 8));
    if (!(results.back().rounding >= 0.0 && results.back().rounding <= kFewDigits)) refuse();
  }
  return results;
}

}  // namespace gatewalk::markov
