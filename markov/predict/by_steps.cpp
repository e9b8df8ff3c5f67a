// SPDX-License-Identifier: MIT
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

/// The mass in each cell and input, for several starts, moved one step at a time.
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
      starts_.emplace_back(field, s);
      window_.include({s.column, s.column, s.row, s.row});
      parities.push_back((std::int64_t{s.column} + s.row) % 2);
    }
    box_ = reached(window_, most_moves);
    layout_.emplace(box_.right - box_.left + 1, box_.top - box_.bottom + 1, plan.moves,
                    plan.is_chequered ? 2 : 1, parities);
    stride_ = layout_->stride();
    const std::ptrdiff_t colours = layout_->colours(),
                         tallies = kTallyMoved + std::ssize(plan.moves),
                         types = plan.chains.size() > 1 ? std::ssize(plan.chains) : 0;
    buffer_.emplace(2 * plan.inputs + (1 + colours) * tallies + types * colours, stride_);
    now_ = buffer_->take(plan.inputs), next_ = buffer_->take(plan.inputs);
    tally_ = buffer_->take(tallies);
    for (int colour = 0; colour < colours; ++colour) ended_.push_back(buffer_->take(tallies));
    if (types > 0) mark_types(buffer_->take(types * colours));
    colour_ = place(0, starts.front().column, starts.front().row).colour;
  }

  std::vector<StartTally> run(const PredictOptions& options, bool may_stop) {
    const int max_cells = options.max_cells, max_steps = options.max_steps;
    may_stop_ = may_stop;
    const double tolerance = options.tolerance_of(PredictOptions::Solver::steps);
    if (layout_->colours() == 2) colour_ = 1 - colour_;
    std::vector<std::ptrdiff_t> first_draws;  // places where first draws put mass
    for (std::size_t j = 0; j < starts_.size(); ++j) {
      StartTally& w = starts_[j];
      if (max_cells == 0 && (max_steps == 0 || tolerance >= 1.0) &&
          plan_.field_chain.at(w.start.column, w.start.row).is_sampled(w.start.input)) {
        w.remainder += 1.0;
        w.over = true;
        continue;
      }
      w.draw_first(plan_.field_chain.at(w.start.column, w.start.row), field_, max_cells == 1,
                   [&](std::int64_t column, std::int64_t row, int input, double p) {
                     first_draws.push_back(input * stride_ + place(j, column, row).at);
                     now_.data()[first_draws.back()] += p;
                   });
      w.steps = w.draws.value() > 0.0 ? 1 : 0;
    }
    grow();
    for (int steps = 1; any_left(max_cells, tolerance, steps, steps == max_steps); ++steps) {
      for (StartTally& w : starts_) w.steps += w.over ? 0 : 1;
      if (steps + 1 == max_cells) {
        apply_by_type(&PreparedChain::ends, layout_->identity(colour_), now_.data(), tally_, false);
        count(tally_, true);
        break;
      }
      apply_by_type(&PreparedChain::ends, layout_->identity(colour_), now_.data(), ended(), true);
      step();
      // A step overwrites every plane to which some move leads. The first draws may have put mass
      // into other planes (an exit of the start's input alone), which are emptied here.
      for (const std::ptrdiff_t at : std::exchange(first_draws, {})) next_.data()[at] = 0.0;
    }
    for (colour_ = 0; colour_ < layout_->colours(); ++colour_) count(ended(), false);
    return std::move(starts_);
  }

 private:
  [[nodiscard]] Layout::Place place(std::size_t start, std::int64_t column,
                                    std::int64_t row) const {
    return layout_->place(start, column - box_.left, row - box_.bottom);
  }
  /// The mass that ended in cells of the present colour.
  [[nodiscard]] Planes ended() const { return ended_[static_cast<std::size_t>(colour_)]; }
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
  /// Applies one stencil of each chain in the cells of its type. `add`: to what the planes hold.
  void apply_by_type(Stencil PreparedChain::*stencil, const Shift* shifts, const double* from,
                     const Planes& planes, bool add) {
    const Stencil& first = plan_.chains.front().*stencil;
    const bool single = plan_.chains.size() == 1;
    double* const to = planes.data();
    // The first pass may not overwrite all planes.
    if (!add && (!single || first.passes.size() > 1)) {
      planes.clear();
      add = true;
    }
    if (single) {
      apply_stencil(first, shifts, stride_, nullptr, window(), from, to, add);
      return;
    }
    for (std::size_t type = 0; type < plan_.chains.size(); ++type) {
      std::vector<Range> ranges;
      for (std::int64_t row = window_.bottom; row <= window_.top;) {
        const std::int64_t begin = row;
        while (row <= window_.top && is_in_row(type, row)) ++row;
        if (row > begin)
          cover(begin, row - 1, ranges);
        else
          ++row;
      }
      const double* const source_mask =
          type_masks_.data() +
          (static_cast<std::ptrdiff_t>(type) * layout_->colours() + colour_) * stride_;
      apply_stencil(plan_.chains[type].*stencil, shifts, stride_, source_mask, ranges, from, to,
                    true);
    }
  }

  void step() {
    apply_by_type(&PreparedChain::moves, layout_->shifts(colour_), now_.data(), next_, false);
    std::swap(now_, next_);
    if (layout_->colours() == 2) colour_ = 1 - colour_;
    grow();
  }

  /// Calls act for a start's cells of the present colour, with their places.
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

  /// Counts the draws in cells of the present colour from the planes of a tally.
  void count(const Planes& tally, bool is_last) {
    for (std::size_t j = 0; j < starts_.size(); ++j) {
      if (is_last && starts_[j].over) continue;
      each_cell(j, [&](std::int64_t column, std::int64_t row, std::ptrdiff_t at) {
        starts_[j].count(field_, plan_.moves, column, row, is_last, tally.data() + at, stride_);
      });
    }
  }

  /// Whether any walks go on; starts without such walks are closed.
  bool any_left(int max_cells, double tolerance, int steps, bool stop) {
    bool any = false;
    if (max_cells == 0)
      apply_by_type(&PreparedChain::walking, layout_->identity(colour_), now_.data(), tally_,
                    false);
    for (std::size_t j = 0; j < starts_.size(); ++j) {
      StartTally& w = starts_[j];
      if (w.over) continue;
      if (max_cells > 0) {
        w.over = !walks_on(j);
      } else {
        CompensatedSum left;
        each_cell(j, [&](std::int64_t, std::int64_t, std::ptrdiff_t at) {
          left += tally_.data()[kTallyTotal * stride_ + at];
        });
        const double enough = std::max(tolerance, kNothing);
        w.over = stop || left.value() <= enough;
        w.stopped =
            may_stop_ && !w.over && w.pace.is_too_slow(steps, left.value(), enough, kMostSums);
        w.over = w.over || w.stopped;
      }
      if (w.over) close(j);
      any = any || !w.over;
    }
    return any;
  }

  [[nodiscard]] bool walks_on(std::size_t j) const {
    // Share of all walks in a state of a cell, far below rounding.
    constexpr double kNobody = 1e-30;
    const double* const now = now_.data();
    bool any = false;
    each_cell(j, [&](std::int64_t column, std::int64_t row, std::ptrdiff_t at) {
      const auto& inputs = plan_.at(column, row).walking_inputs;
      any = any || std::any_of(inputs.begin(), inputs.end(),
                               [&](int input) { return now[input * stride_ + at] > kNobody; });
    });
    return any;
  }

  /// Mass in unsampled states has ended; the rest remains.
  void close(std::size_t j) {
    double* const now = now_.data();
    each_cell(j, [&](std::int64_t column, std::int64_t row, std::ptrdiff_t at) {
      const PreparedChain& chain = plan_.at(column, row);
      for (const int input : chain.unsampled)
        ended().data()[kTallyUnsampled * stride_ + at] += now[input * stride_ + at];
      for (const int input : chain.walking_inputs)
        starts_[j].remainder += now[input * stride_ + at];
      for (std::ptrdiff_t input = 0; input < plan_.inputs; ++input) now[input * stride_ + at] = 0.0;
    });
  }

  /// Marks the places and the rows that have cells of each type.
  void mark_types(Planes masks) {
    type_masks_ = masks;
    const std::ptrdiff_t types = std::ssize(plan_.chains), colours = layout_->colours();
    is_in_row_.resize(static_cast<std::size_t>(types * field_.rows));
    for (std::size_t j = 0; j < starts_.size(); ++j)
      for (std::int64_t row = box_.bottom; row <= box_.top; ++row)
        for (std::int64_t column = box_.left; column <= box_.right; ++column) {
          const Layout::Place p = place(j, column, row);
          const std::ptrdiff_t type = plan_.field_chain.type_of(column, row);
          type_masks_.data()[(type * colours + p.colour) * stride_ + p.at] = 1.0;
          is_in_row_[static_cast<std::size_t>(type * field_.rows + row)] = 1;
        }
  }
  [[nodiscard]] bool is_in_row(std::size_t type, std::int64_t row) const {
    return is_in_row_[type * static_cast<std::size_t>(field_.rows) + static_cast<std::size_t>(row)];
  }

  const PredictionPlan& plan_;
  Field field_;
  std::vector<StartTally> starts_;
  bool may_stop_ = false;
  Window box_{}, window_{};  // cells that can be reached at all; so far
  std::optional<Layout> layout_;
  int colour_ = 0;  // colour of the cells with mass
  std::ptrdiff_t stride_ = 0;
  std::optional<PlaneBuffer> buffer_;
  Planes now_, next_;            // by input: mass now and after the next step
  Planes tally_;                 // by Tally, of the present mass
  std::vector<Planes> ended_{};  // by colour: by Tally, of all steps
  // The next members are for fields with several types of cell.
  Planes type_masks_;            // (types x colours): 1 in cells of the type, else 0
  std::vector<char> is_in_row_;  // (types x rows)
};

}  // namespace

MaybePredicted predict_by_steps(const PredictionPlan& plan, const Field& field,
                                const std::vector<Start>& starts, const PredictOptions& options,
                                bool may_stop) {
  const int most_moves = options.max_cells > 0 ? options.max_cells - 1 : options.max_steps;
  Steps steps(plan, field, starts, most_moves);
  MaybePredicted results;
  for (const StartTally& w : steps.run(options, may_stop && options.max_cells == 0)) {
    results.emplace_back();
    if (!w.stopped)
      results.back() = w.result(plan.most_terms + 3, w.steps + plan.inputs + plan.outputs + 8);
  }
  return results;
}

}  // namespace gatewalk::markov
