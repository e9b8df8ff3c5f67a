// SPDX-License-Identifier: MIT
#include "markov/predict/large_totals.h"

#include <Random123/philox.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "markov/committor.h"
#include "markov/predict/moves.h"
#include "markov/predict/row_sweeps.h"

namespace gatewalk::markov {

std::size_t quantities_of(const FieldChain& chain, const Rewards& rewards) {
  if (rewards.empty()) return 0;
  bool fits = rewards.size() == chain.chains().size();
  for (std::size_t c = 0; fits && c < rewards.size(); ++c) {
    const auto nonzeros = static_cast<std::size_t>(chain.chains()[c].matrix().nonZeros());
    fits = rewards[c].size() == rewards.front().size();
    for (const Reward& r : rewards[c])
      fits = fits && r.mean.size() == nonzeros && r.square.size() == nonzeros;
  }
  if (!fits) throw std::invalid_argument("walk totals: rewards are not those of the chain");
  return rewards.front().size();
}

namespace {

/// Visits and endings in large fields without a limit of cells, whose rows have one type each: the
/// mass that enters a row is summed over all moves within the row at once.
class VisitsByRows {
 public:
  VisitsByRows(const FieldChain& chain, const Field& field) : chain_(chain), field_(field) {
    for (const Chain& c : chain.chains()) {
      const Moves& m = moves_.emplace_back(c, Ending::trapped);
      for (const Moves::Entry& e : m.entries) highest_ = std::max(highest_, e.di_y);
      sums_.emplace_back(m.within_row(), RowSweeps::Sums::brought, field.columns, c.inputs());
    }
  }

  [[nodiscard]] bool suits() const {
    return chain_.has_uniform_rows() &&
           std::all_of(sums_.begin(), sums_.end(), [](const RowSweeps& s) { return s.suits(); });
  }

  /// Adds visits and endings to `out` and calls `each` for states whose share is not
  /// `is_little(share, cell, input)`. Returns the means over all walks: of draws, then of each
  /// quantity.
  template <class Little>
  std::vector<double> run(const Start& start, const Rewards& rewards, const EachState& each,
                          const Little& is_little, double tolerance, WalkTotals& out) {
    const std::int64_t inputs = chain_.inputs(), states = inputs * field_.columns;
    std::vector<std::vector<double>> of_states(  // visits by type and state, summed over cells
        sums_.size(), std::vector<double>(static_cast<std::size_t>(inputs), 0.0));
    std::vector<std::vector<double>> entering(static_cast<std::size_t>(highest_) + 1);
    for (auto& row : entering) row.assign(static_cast<std::size_t>(states), 0.0);
    entering.front()[static_cast<std::size_t>(start.column * inputs + start.input)] = 1.0;
    for (int row = start.row; row < field_.rows; ++row) {
      const auto type = static_cast<std::size_t>(chain_.type_of(0, row));
      const Moves& moves = moves_[type];
      std::vector<double>& visits = entering.front();
      sums_[type].solve(visits.data(), RowSweeps::Of::largest, tolerance);
      for (int column = 0; column < field_.columns; ++column) {
        const bool at_a_side = column < moves.widest || column + moves.widest >= field_.columns;
        const std::int64_t cell = std::int64_t{row} * field_.columns + column;
        for (int input = 0; input < inputs; ++input) {
          const double share = visits[static_cast<std::size_t>(column * inputs + input)];
          if (share == 0.0) continue;
          of_states[type][static_cast<std::size_t>(input)] += share;
          if (!chain_.chains()[type].is_sampled(input)) continue;
          out.visits.data()[cell] += share;
          if (each && !is_little(share, cell, input)) each(1, cell, input, share);
          for (std::size_t i = moves.up[input];
               i < (at_a_side ? moves.up[input + 1] : moves.side[input]); ++i) {
            const auto& [p, di_x, di_y, next] = moves.entries[i];
            const int to = column + di_x;
            if (to < 0 || to >= field_.columns || row + di_y >= field_.rows)
              out.endings[static_cast<std::size_t>(edge_before(field_, to, row + di_y))] +=
                  share * p;
            else if (di_y > 0)
              entering[static_cast<std::size_t>(di_y)]
                      [static_cast<std::size_t>(to * inputs + next)] += share * p;
          }
        }
      }
      std::fill(visits.begin(), visits.end(), 0.0);
      std::rotate(entering.begin(), entering.begin() + 1, entering.end());
    }
    return add_up(of_states, rewards, out);
  }

 private:
  /// Adds up the sums that do not depend on the cell.
  std::vector<double> add_up(const std::vector<std::vector<double>>& of_states,
                             const Rewards& rewards, WalkTotals& out) const {
    std::vector<double> means(1 + quantities_of(chain_, rewards), 0.0);
    for (std::size_t type = 0; type < of_states.size(); ++type) {
      const Chain& here = chain_.chains()[type];
      std::size_t nonzero = 0;
      for (int input = 0; input < here.inputs(); ++input) {
        const auto i = static_cast<std::size_t>(input);
        const double share = of_states[type][i];
        if (!here.is_sampled(input)) {
          out.endings[static_cast<std::size_t>(Ending::unsampled)] += share;
          continue;
        }
        means[0] += share;
        out.endings[static_cast<std::size_t>(Ending::trapped)] += share * moves_[type].ends[i];
        for (Probabilities::InnerIterator it(here.matrix(), input); it; ++it, ++nonzero)
          for (std::size_t q = 1; q < means.size(); ++q)
            means[q] += share * it.value() * rewards[type][q - 1].mean[nonzero];
      }
    }
    return means;
  }

  const FieldChain& chain_;
  const Field field_;
  int highest_ = 0;           // di_y
  std::vector<Moves> moves_;  // by type
  std::vector<RowSweeps> sums_;
};

/// The second key word of these walks' streams: "mom", version 1.
constexpr std::uint64_t kMomentsStream = 0x006d6f6d'00000001;

/// The sums of drawn walks by ending, draws first.
struct DrawnMoments {
  std::vector<std::array<Moments, kEndings>> all;

  explicit DrawnMoments(std::size_t quantities) : all(1 + quantities) {}
  /// Adds a walk whose totals have these means and variances, draws first.
  void add(Ending ending, const std::vector<double>& mean, const std::vector<double>& variance) {
    for (std::size_t q = 0; q < all.size(); ++q) {
      Moments& m = all[q][static_cast<std::size_t>(ending)];
      m.share += 1.0;
      m.sum += mean[q];
      m.square += mean[q] * mean[q] + variance[q];
    }
  }
  DrawnMoments& operator+=(const DrawnMoments& other) {
    for (std::size_t q = 0; q < all.size(); ++q)
      for (std::size_t e = 0; e < kEndings; ++e) {
        all[q][e].share += other.all[q][e].share;
        all[q][e].sum += other.all[q][e].sum;
        all[q][e].square += other.all[q][e].square;
      }
    return *this;
  }
};

/// Draws walks without a limit of cells and sums the mean and the variance of each draw's
/// quantities. With `chance`, all walks have its ending: the probability of a draw is multiplied by
/// the probability of the ending from its target (Doob's transform).
DrawnMoments drawn_moments(const FieldChain& chain, const Field& field, const Start& start,
                           const Rewards& rewards, const EndingChance* chance, std::int64_t count,
                           std::uint64_t seed) {
  constexpr std::int64_t kTogether = 1024;
  const std::size_t quantities = quantities_of(chain, rewards);
  const std::int64_t parts = (count + kTogether - 1) / kTogether;
  std::vector<DrawnMoments> moments(static_cast<std::size_t>(parts), DrawnMoments(quantities));
  tbb::parallel_for(std::int64_t{0}, parts, [&](std::int64_t part) {
    std::vector<double> mean(1 + quantities), variance(1 + quantities, 0.0);
    for (std::int64_t number = part * kTogether; number < std::min(count, (part + 1) * kTogether);
         ++number) {
      std::fill(mean.begin(), mean.end(), 0.0);
      std::fill(variance.begin(), variance.end(), 0.0);
      std::int64_t column = start.column, row = start.row;
      int input = start.input;
      std::optional<Ending> ending;
      for (int draw = 1; !ending && draw <= kMostSteps; ++draw) {
        const auto type = static_cast<std::size_t>(chain.type_of(column, row));
        const Chain& here = chain.chains()[type];
        if (!here.is_sampled(input)) {
          ending = Ending::unsampled;
          break;
        }
        const std::int64_t cell = row * field.columns + column;
        const auto weight = [&](const Exit& exit) {
          if (!chance) return 1.0;
          std::int64_t to_column = column, to_row = row;
          if (const auto e = follow(field, exit, false, to_column, to_row))
            return *e == chance->ending() ? 1.0 : 0.0;
          return (*chance)(1, to_row * field.columns + to_column, exit.next_input);
        };
        const auto words =
            r123::Philox4x64()({{static_cast<std::uint64_t>(draw),
                                 static_cast<std::uint64_t>(number), chance != nullptr, 0}},
                               {{seed, kMomentsStream}});
        double rest = uniform(words[0]) * (chance ? (*chance)(1, cell, input) : 1.0);
        auto nonzero = static_cast<std::size_t>(here.matrix().outerIndexPtr()[input]),
             taken = nonzero;
        const Exit* exit = nullptr;
        for (Probabilities::InnerIterator it(here.matrix(), input); it; ++it, ++nonzero) {
          const Exit& possible = here.exits()[static_cast<std::size_t>(it.col())];
          const double p = it.value() * weight(possible);
          if (p == 0.0) continue;
          exit = &possible;
          taken = nonzero;
          if ((rest -= p) < 0.0) break;
        }
        if (!exit) break;  // no walk from here has this ending
        mean[0] += 1.0;
        for (std::size_t q = 0; q < quantities; ++q) {
          const Reward& r = rewards[type][q];
          mean[1 + q] += r.mean[taken];
          variance[1 + q] += r.square[taken] - r.mean[taken] * r.mean[taken];
        }
        ending = follow(field, *exit, false, column, row);
        input = exit->next_input;
      }
      if (ending) moments[static_cast<std::size_t>(part)].add(*ending, mean, variance);
    }
  });
  DrawnMoments all(quantities);
  for (const DrawnMoments& m : moments) all += m;
  return all;
}

}  // namespace

std::optional<WalkTotals> totals_of_large(const FieldChain& chain, const Field& field,
                                          const Start& start, const Rewards& rewards,
                                          const EachState& each, const WalkTolerance& tolerance,
                                          std::uint64_t seed) {
  VisitsByRows rows(chain, field);
  if (!rows.suits()) return {};
  constexpr std::int64_t kWalks = 1 << 16, kThatEndSo = 1 << 12;
  const std::size_t quantities = quantities_of(chain, rewards);
  const double states = static_cast<double>(field.rows) * field.columns * chain.inputs();
  const EndingChance* const chance = tolerance.chance;
  const double at_start =
      chance ? (*chance)(1, std::int64_t{start.row} * field.columns + start.column, start.input)
             : 0.0;
  WalkTotals out;
  out.visits = CellProbabilities::Zero(field.rows, field.columns);
  const std::vector<double> means = rows.run(
      start, rewards, each,
      [&](double share, std::int64_t cell, int input) {
        return share * states <= tolerance.all &&
               (!chance ||
                share * (*chance)(1, cell, input) * states <= tolerance.of_target * at_start);
      },
      tolerance.of_row, out);
  const double ended = std::accumulate(out.endings.begin(), out.endings.end(), 0.0);
  out.remainder = std::max(0.0, 1.0 - ended);
  if (quantities == 0) {  // no more is asked for
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t e = 0; e < kEndings; ++e) out.draws[e] = {out.endings[e], kUnknown, kUnknown};
    return out;
  }
  out.drawn_walks = kWalks;
  out.totals.resize(quantities);
  DrawnMoments drawn = drawn_moments(chain, field, start, rewards, nullptr, kWalks, seed);
  std::size_t target = kEndings;  // none: enough of the walks have the ending
  if (at_start > 0.0 && at_start * kWalks < kThatEndSo) {
    target = static_cast<std::size_t>(chance->ending());
    const DrawnMoments so = drawn_moments(chain, field, start, rewards, chance, kThatEndSo, seed);
    for (std::size_t q = 0; q <= quantities; ++q) drawn.all[q][target] = so.all[q][target];
  }
  for (std::size_t q = 0; q <= quantities; ++q) {
    auto& moments = q == 0 ? out.draws : out.totals[q - 1];
    double others = 0.0;
    for (std::size_t e = 0; e < kEndings; ++e) {
      Moments m = drawn.all[q][e];
      if (m.share > 0.0)
        m = {out.endings[e], m.sum / m.share * out.endings[e], m.square / m.share * out.endings[e]};
      moments[e] = m;
      if (e != target) others += m.sum;
    }
    // The mean over all walks is known, so the walks drawn together are scaled to it.
    const double known = means[q] - (target < kEndings ? moments[target].sum : 0.0);
    if (!(others > 0.0 && known > 0.0)) continue;
    const double scale = known / others;
    for (std::size_t e = 0; e < kEndings; ++e)
      if (Moments& m = moments[e]; e != target)
        m = {m.share, m.sum * scale, m.square * scale * scale};
  }
  return out;
}

}  // namespace gatewalk::markov
