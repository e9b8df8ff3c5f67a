#include <optional>

#include "markov/predict/plan.h"

namespace gatewalk::markov {
namespace {

struct Window {
  std::int64_t left, right, bottom, top;
  void include(const Window& w) {
    left = std::min(left, w.left), right = std::max(right, w.right);
    bottom = std::min(bottom, w.bottom), top = std::max(top, w.top);
  }
};

/// Mass per cell and input of several starts, moved one step at a time.
class Steps {
 public:
  Steps(const PredictionPlan& plan, const Field& field, const std::vector<Start>& starts,
        std::int64_t most_moves)
      : plan_(plan), field_(field) {
    const auto reached = [&](const Window& from, std::int64_t moves) {
      return Window{std::max<std::int64_t>(0, from.left - plan.widest * moves),
                    std::min<std::int64_t>(field.columns - 1, from.right + plan.widest * moves),
                    std::max<std::int64_t>(0, from.bottom + plan.lowest * moves),
                    std::min<std::int64_t>(field.rows - 1, from.top + plan.highest * moves)};
    };
    std::vector<std::int64_t> parities;
    window_ = {starts.front().column, starts.front().column, starts.front().row,
               starts.front().row};
    for (const Start& s : starts) {
      walks_.emplace_back(field, s);
      window_.include({s.column, s.column, s.row, s.row});
      parities.push_back((std::int64_t{s.column} + s.row) % 2);
    }
    box_ = reached(window_, most_moves);
    layout_.emplace(box_.right - box_.left + 1, box_.top - box_.bottom + 1, plan.moves,
                    plan.is_chequered ? 2 : 1, parities);
    stride_ = layout_->stride();
    const std::ptrdiff_t all = plan.inputs * stride_,
                         tallies = kTallyMoved + std::ssize(plan.moves),
                         chains = plan.chains.size() > 1 ? std::ssize(plan.chains) : 0;
    numbers_.emplace((2 + layout_->colours()) * all +
                     (tallies + chains * layout_->colours()) * stride_);
    now_ = numbers_->data(), next_ = now_ + all, visits_ = next_ + all;
    tally_ = visits_ + layout_->colours() * all, rows_ = tally_ + tallies * stride_;
    if (chains > 0) mark_rows();
    colour_ = place(0, starts.front().column, starts.front().row).colour;
  }

  std::vector<StartTally> run(int max_cells, double tolerance, int max_steps) {
    if (layout_->colours() == 2) colour_ = 1 - colour_;
    std::vector<std::ptrdiff_t> first_draws;  // where they put mass
    for (std::size_t j = 0; j < walks_.size(); ++j) {
      StartTally& w = walks_[j];
      if (max_cells == 0 && (max_steps == 0 || tolerance >= 1.0) &&
          plan_.at(w.start.row).chain.is_sampled(w.start.input)) {
        w.remainder += 1.0;
        w.over = true;
        continue;
      }
      w.draw_first(plan_.at(w.start.row).chain, field_, max_cells == 1,
                   [&](std::int64_t column, std::int64_t row, int input, double p) {
                     first_draws.push_back(input * stride_ + place(j, column, row).at);
                     now_[first_draws.back()] += p;
                   });
      w.steps = w.draws.value() > 0.0 ? 1 : 0;
    }
    grow();
    for (int steps = 1; any_left(max_cells, tolerance, steps == max_steps); ++steps) {
      for (StartTally& w : walks_) w.steps += w.over ? 0 : 1;
      if (steps + 1 == max_cells) {
        count(now_, true);
        break;
      }
      for (const Range& r : window())
        accumulate(now_, visits(), plan_.inputs, stride_, r.first, r.last);
      step();
      // Groups overwrite what groups have written, but the first draw may lead where no group does.
      for (const std::ptrdiff_t at : std::exchange(first_draws, {})) next_[at] = 0.0;
    }
    for (colour_ = 0; colour_ < layout_->colours(); ++colour_) count(visits(), false);
    return std::move(walks_);
  }

 private:
  [[nodiscard]] Layout::Place place(std::size_t start, std::int64_t column,
                                    std::int64_t row) const {
    return layout_->place(start, column - box_.left, row - box_.bottom);
  }
  /// Of the present colour.
  [[nodiscard]] double* visits() const { return visits_ + colour_ * plan_.inputs * stride_; }
  void grow() {
    Window w = window_;
    for (const Move& m : plan_.moves)
      w.include({window_.left + m.di_x, window_.right + m.di_x, window_.bottom + m.di_y,
                 window_.top + m.di_y});
    window_ = {std::max(w.left, box_.left), std::min(w.right, box_.right),
               std::max(w.bottom, box_.bottom), std::min(w.top, box_.top)};
  }
  void cover(std::int64_t bottom, std::int64_t top, std::vector<Range>& ranges) const {
    layout_->cover(window_.left - box_.left, window_.right - box_.left, bottom - box_.bottom,
                   top - box_.bottom, ranges);
  }
  [[nodiscard]] std::vector<Range> window() const {
    std::vector<Range> ranges;
    cover(window_.bottom, window_.top, ranges);
    return ranges;
  }
  /// Each chain's stencil (one of its stencils) in its own rows, to so many planes.
  void apply_by_type(Stencil PreparedChain::*stencil, const Shift* shifts, const double* from,
                     double* to, std::ptrdiff_t planes) {
    const Stencil& first = plan_.chains.front().*stencil;
    const bool single = plan_.chains.size() == 1;
    const bool add = !single || first.passes.size() > 1;  // the first pass need not overwrite all
    if (add) std::fill_n(to, planes * stride_, 0.0);
    if (single) {
      apply_stencil(first, shifts, stride_, nullptr, window(), from, to, add);
      return;
    }
    for (std::size_t k = 0; k < plan_.chains.size(); ++k) {
      std::vector<Range> ranges;
      for (std::int64_t row = window_.bottom; row <= window_.top;) {
        const std::int64_t begin = row;
        while (row <= window_.top && plan_.number_at(row) == static_cast<int>(k)) ++row;
        if (row > begin)
          cover(begin, row - 1, ranges);
        else
          ++row;
      }
      const double* const source_mask =
          rows_ + (static_cast<std::ptrdiff_t>(k) * layout_->colours() + colour_) * stride_;
      apply_stencil(plan_.chains[k].*stencil, shifts, stride_, source_mask, ranges, from, to, true);
    }
  }

  void step() {
    apply_by_type(&PreparedChain::moves, layout_->shifts(colour_), now_, next_, plan_.inputs);
    std::swap(now_, next_);
    if (layout_->colours() == 2) colour_ = 1 - colour_;
    grow();
  }

  /// A start's cells of the present colour, each given its place.
  template <class Do>
  void each_cell(std::size_t j, Do act) const {
    for (std::int64_t row = window_.bottom; row <= window_.top; ++row) {
      const std::int64_t other = place(j, window_.left, row).colour == colour_ ? 0 : 1;
      std::ptrdiff_t at = place(j, window_.left + other, row).at;
      for (std::int64_t column = window_.left + other; column <= window_.right;
           column += layout_->colours(), ++at)
        act(column, row, at);
    }
  }

  void tally(Stencil PreparedChain::*stencil, const double* visitors) {
    apply_by_type(stencil, layout_->identity(colour_), visitors, tally_,
                  kTallyMoved + std::ssize(plan_.moves));
  }

  /// Counts what visitors draw that are in cells of the present colour.
  void count(const double* visitors, bool is_last) {
    tally(&PreparedChain::ends, visitors);
    for (std::size_t j = 0; j < walks_.size(); ++j) {
      if (is_last && walks_[j].over) continue;
      each_cell(j, [&](std::int64_t column, std::int64_t row, std::ptrdiff_t at) {
        walks_[j].count(field_, plan_.moves, column, row, is_last, tally_ + at, stride_);
      });
    }
  }

  /// Whether anybody walks on; starts from which nobody does are closed.
  bool any_left(int max_cells, double tolerance, bool stop) {
    bool any = false;
    if (max_cells == 0) tally(&PreparedChain::walking, now_);
    for (std::size_t j = 0; j < walks_.size(); ++j) {
      StartTally& w = walks_[j];
      if (w.over) continue;
      if (max_cells > 0) {
        w.over = !walks_on(j);
      } else {
        CompensatedSum left;
        each_cell(j, [&](std::int64_t, std::int64_t, std::ptrdiff_t at) {
          left += tally_[kTallyTotal * stride_ + at];
        });
        w.over = stop || left.value() <= std::max(tolerance, kNothing);
      }
      if (w.over) close(j);
      any = any || !w.over;
    }
    return any;
  }

  [[nodiscard]] bool walks_on(std::size_t j) const {
    constexpr double kNobody = 1e-30;  // of all walks, in a state of a cell: far below rounding
    bool any = false;
    each_cell(j, [&](std::int64_t, std::int64_t row, std::ptrdiff_t at) {
      const auto& inputs = plan_.at(row).walking_inputs;
      any = any || std::any_of(inputs.begin(), inputs.end(),
                               [&](int input) { return now_[input * stride_ + at] > kNobody; });
    });
    return any;
  }

  /// What came into states never sampled has ended; what walks remains.
  void close(std::size_t j) {
    each_cell(j, [&](std::int64_t, std::int64_t row, std::ptrdiff_t at) {
      for (const int input : plan_.at(row).unsampled)
        visits()[input * stride_ + at] += now_[input * stride_ + at];
      for (const int input : plan_.at(row).walking_inputs)
        walks_[j].remainder += now_[input * stride_ + at];
      for (std::ptrdiff_t input = 0; input < plan_.inputs; ++input)
        now_[input * stride_ + at] = 0.0;
    });
  }

  /// Which places lie in a chain's rows.
  void mark_rows() {
    for (std::size_t j = 0; j < walks_.size(); ++j)
      for (std::int64_t row = box_.bottom; row <= box_.top; ++row)
        for (std::int64_t column = box_.left; column <= box_.right; ++column) {
          const Layout::Place p = place(j, column, row);
          rows_[(plan_.number_at(row) * layout_->colours() + p.colour) * stride_ + p.at] = 1.0;
        }
  }

  const PredictionPlan& plan_;
  Field field_;
  std::vector<StartTally> walks_;
  Window box_{}, window_{};  // cells that can be reached at all, until now
  std::optional<Layout> layout_;
  int colour_ = 0;  // of the cells with mass
  std::ptrdiff_t stride_ = 0;
  std::optional<Planes> numbers_;
  double *now_ = nullptr, *next_ = nullptr, *visits_ = nullptr;  // visits of each colour
  double* tally_ = nullptr;
  double* rows_ = nullptr;  // (chains x colours) planes, 1 in the chain's rows
};

}  // namespace

std::vector<FinalDistribution> predict_by_steps(const PredictionPlan& plan, const Field& field,
                                                const std::vector<Start>& starts, int max_cells,
                                                double tolerance, int max_steps_without_limit) {
  const int most_moves = max_cells > 0 ? max_cells - 1 : max_steps_without_limit;
  Steps steps(plan, field, starts, most_moves);
  std::vector<FinalDistribution> results;
  for (const StartTally& w : steps.run(max_cells, tolerance, max_steps_without_limit))
    results.push_back(w.result(plan.most_terms + 3, w.steps + plan.inputs + plan.outputs + 8));
  return results;
}

}  // namespace gatewalk::markov
