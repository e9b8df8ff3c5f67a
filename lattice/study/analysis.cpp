#include "lattice/study/analysis.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "dynamics/methods/method.h"
#include "dynamics/quantile_bins.h"
#include "dynamics/runs.h"
#include "lattice/group_spread.h"
#include "markov/lumping.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

/// Means over the draws behind each count, as the chain's nonzeros stand.
std::vector<markov::Reward> rewards_of(const std::vector<std::int64_t>& counts,
                                       const std::vector<CostSums>& sums) {
  std::vector<markov::Reward> rewards(kCosts);
  for (std::size_t c = 0; c < kCosts; ++c)
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const auto n = static_cast<double>(counts[i]);
      rewards[c].mean.push_back(sums[i].sum[c] / n);
      rewards[c].square.push_back(sums[i].squares[c] / n);
    }
  return rewards;
}

}  // namespace

CostedChain costed_chain(const Kernel& kernel, const FieldGates& gates, const FieldParams& field,
                         const RunPool& pool, const StartTrials& start, TrialGroup group) {
  const auto first = first_row(gates, kernel.space, start, group);
  const auto first_sums = first_cost_sums(gates, kernel.space, start, group);
  const auto sums = cost_sums(kernel, gates, pool, group);
  markov::Rewards rewards;
  for (std::size_t type = 0; type < kernel.counts.size(); ++type) {
    const markov::Counts& k = kernel.counts[type];
    std::vector<std::int64_t> counts(k.valuePtr(), k.valuePtr() + k.nonZeros());
    std::vector<CostSums> costs = sums[type];
    if (static_cast<int>(type) == gates.type_of(field.start_column(), 0))
      for (std::size_t output = 0; output < first.size(); ++output)
        if (first[output] > 0) {
          counts.push_back(first[output]);
          costs.push_back(first_sums[output]);
        }
    rewards.push_back(rewards_of(counts, costs));
  }
  return {chain_of(kernel, gates, field, {first}),
          std::move(rewards),
          {field.start_column(), 0, kernel.space.size()}};
}

namespace {

/// Entries of the pool's runs by leaf, mirror images too.
std::vector<std::vector<Crossing>> entries_of_leaves(const Kernel& kernel, const FieldGates& gates,
                                                     const RunPool& pool) {
  std::vector<std::vector<Crossing>> entries(static_cast<std::size_t>(kernel.space.size()));
  each_entry(pool, [&](const Crossing& entry, int type) {
    const auto put = [&](const Crossing& c) {
      entries[static_cast<std::size_t>(kernel.space.index_of(c).state)].push_back(c);
    };
    put(entry);
    if (symmetric(gates.types()[static_cast<std::size_t>(type)])) put(mirrored(entry));
  });
  return entries;
}

}  // namespace

AnalysedChain analysed_chain(const Scene& scene, const RunPool& pool, const Crossing& start,
                             int per_leaf) {
  const std::size_t own = pool.place_of(start);
  if (own == pool.starts.size())
    throw std::invalid_argument("analysis: the start has no runs of its own");
  const FieldGates gates = gates_of(scene);
  const auto chain_of_group = [&](TrialGroup group) {
    return costed_chain(kernel_of(gates, pool, per_leaf, group), gates, scene.field, pool,
                        pool.starts[own], group);
  };
  const Kernel kernel = kernel_of(gates, pool, per_leaf);
  std::array<std::optional<CostedChain>, kTrialGroups> parts;
  tbb::parallel_for(0, kTrialGroups, [&](int g) {
    parts[static_cast<std::size_t>(g)] = chain_of_group({g, kTrialGroups});
  });
  std::vector<CostedChain> groups;
  for (auto& part : parts) groups.push_back(std::move(*part));
  auto entries = entries_of_leaves(kernel, gates, pool);
  entries.push_back({start});
  return {costed_chain(kernel, gates, scene.field, pool, pool.starts[own]), kernel.space,
          std::move(groups), [entries = std::move(entries)](int state, Random& random) {
            const auto& there = entries[static_cast<std::size_t>(state)];
            return there[static_cast<std::size_t>(random.below(std::ssize(there)))];
          }};
}

AnalysedChain analysed_chain(const Scene& scene, const std::vector<Transitions>& matrices,
                             const markov::Start& start) {
  markov::Rewards rewards;
  for (const Transitions& t : matrices) {
    std::vector<std::int64_t> counts;
    std::vector<CostSums> sums;
    CostSums unknown;
    unknown.sum.fill(std::nan(""));
    unknown.squares.fill(std::nan(""));
    for (std::size_t row = 0; row < t.rows.size(); ++row)
      for (const auto& [column, n] : t.rows[row]) {
        const auto known = t.costs[row].find(column);
        counts.push_back(n);
        sums.push_back(known == t.costs[row].end() ? unknown : known->second);
      }
    rewards.push_back(rewards_of(counts, sums));
  }
  const StateSpace& space = matrices.front().space;
  return {{make_chain(gates_of(scene), matrices), std::move(rewards), start},
          space,
          {},
          [space](int state, Random& random) { return space.sample(state, random); }};
}

namespace {

/// A random number of the analysis.
Random drawn(std::uint64_t seed, std::uint64_t row, std::int64_t i) {
  return {Purpose::sensitivity, {seed, row, static_cast<std::uint64_t>(i)}};
}

/// How often walks that end in the target pass each state of each cell at each draw (without limit:
/// at any draw): the share of the walks there, times their chance.
class Passages {
 public:
  /// `at_start`: the chance of the target there. Without limit of gates walks are followed until
  /// those left are few beside the ones that get there.
  Passages(const CostedChain& c, const FieldParams& field, const markov::EndingChance& chance,
           double at_start)
      : chance_(chance),
        limited_(field.max_gates > 0),
        inputs_(c.chain.inputs()),
        cells_(std::int64_t{field.columns} * field.rows) {
    totals_ = markov::walk_totals(
        c.chain, {field.columns, field.rows}, c.start, field.max_gates, c.rewards,
        [&](int draw, std::int64_t cell, int input, double share) {
          add(draw, cell, input, share * chance_(draw, cell, input));
        },
        at_start > 0.0 ? std::min(1e-12, 1e-6 * at_start) : 1e-12);
  }

  struct Place {
    int draw = 1;
    std::int64_t cell = 0;
    int input = 0;
  };
  [[nodiscard]] const markov::WalkTotals& totals() const { return totals_; }
  [[nodiscard]] double sum() const { return cumulative_.empty() ? 0.0 : cumulative_.back(); }
  /// Calls use(place, weight) for all places that are passed.
  template <class Use>
  void each(Use use) const {
    for (std::size_t i = 0; i < weights_.size(); ++i)
      if (weights_[i] > 0.0) use(place(i), weights_[i]);
  }
  /// To be called before draw() and sum().
  void add_up() {
    double sum = 0.0;
    for (const double w : weights_) cumulative_.push_back(sum += w);
  }
  /// A place drawn in proportion to its weight.
  [[nodiscard]] Place draw(double uniform) const {
    const auto at = std::upper_bound(cumulative_.begin(), cumulative_.end(), uniform * sum());
    return place(static_cast<std::size_t>(
        std::min<std::ptrdiff_t>(at - cumulative_.begin(), std::ssize(cumulative_) - 1)));
  }

 private:
  void add(int draw, std::int64_t cell, int input, double weight) {
    const std::int64_t layer = limited_ ? draw - 1 : 0;
    const auto at = static_cast<std::size_t>((layer * cells_ + cell) * inputs_ + input);
    if (at >= weights_.size())
      weights_.resize(static_cast<std::size_t>((layer + 1) * cells_ * inputs_), 0.0);
    weights_[at] += weight;
  }
  [[nodiscard]] Place place(std::size_t i) const {
    const auto at = static_cast<std::int64_t>(i);
    return {static_cast<int>(at / inputs_ / cells_) + 1, at / inputs_ % cells_,
            static_cast<int>(at % inputs_)};
  }

  const markov::EndingChance& chance_;
  bool limited_;
  std::int64_t inputs_, cells_;
  std::vector<double> weights_, cumulative_;  // (draws x cells x inputs)
  markov::WalkTotals totals_;
};

/// Share of a row's draws that are trapped.
double trapped_share(const markov::Chain& chain, int input) {
  double share = 0.0;
  for (markov::Probabilities::InnerIterator it(chain.matrix(), input); it; ++it)
    if (chain.exits()[static_cast<std::size_t>(it.col())].next_input == markov::Exit::kTrapped)
      share += it.value();
  return share;
}

/// What numbers of the scene do to the chance of the target, to first order: in the places that
/// bodies pass on their way there, gate runs with a little more and a little less of the number,
/// under the same noise, and what the chain says of where they lead.
class Parameters {
 public:
  /// `at_start`: the chance of the target there.
  Parameters(const Scene& scene, const AnalysedChain& chain, const markov::EndingChance& chance,
             double at_start, const Passages& passages, const AnalysisOptions& options)
      : field_(scene.field),
        gates_(gates_of(scene)),
        space_(chain.space),
        chance_(chance),
        options_(options),
        visits_(passages.sum() / at_start) {
    for (std::int64_t i = 0; i < options.runs; ++i) {
      Random random = drawn(options.seed, 0, i);
      const Passages::Place place = passages.draw(random.uniform());
      const auto column = static_cast<int>(place.cell % field_.columns),
                 row = static_cast<int>(place.cell / field_.columns);
      samples_.push_back({place, gates_.type_of(column, row), chain.entry(place.input, random),
                          chance(place.draw, place.cell, place.input)});
    }
  }

  /// None where the number is zero, or cannot be changed.
  [[nodiscard]] std::optional<ParameterEffect> effect(const ParamInfo& info) {
    if (base_.empty()) base_ = values(info, 1.0);
    double value = info.get(gates_.types().front());
    bool any = false;
    for (const GateParams& p : gates_.types()) {
      any = any || info.get(p) != 0.0;
      if (info.get(p) != value) value = std::nan("");
    }
    const double step = options_.relative_step;
    const bool up = allowed(info, 1.0 + step), down = allowed(info, 1.0 - step);
    if (!any || (!up && !down)) return {};
    const std::vector<double> above = up ? values(info, 1.0 + step) : base_,
                              below = down ? values(info, 1.0 - step) : base_;
    Terms both, more, less, bend;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const double unit = visits_ / (samples_[i].chance * step);
      if (!std::isfinite(above[i] + below[i] + base_[i])) continue;  // broken, which health says
      both.add(unit * (above[i] - below[i]) / (up && down ? 2.0 : 1.0));
      more.add(unit * (above[i] - base_[i]));
      less.add(unit * (base_[i] - below[i]));
      bend.add(unit * (above[i] + below[i] - 2.0 * base_[i]));
    }
    ParameterEffect e{info.key, value, both.mean_95()};
    e.more = up ? more.mean() : std::nan("");
    e.less = down ? less.mean() : std::nan("");
    const Mean95 difference = bend.mean_95();
    constexpr double kSure = 1.5;  // half widths of 95 %: 3 in 1000 by chance
    const double half = difference.mean - difference.interval[0];
    e.bends = up && down && std::abs(difference.mean) > kSure * half;
    return e;
  }
  [[nodiscard]] const Health& health() const { return health_; }

 private:
  /// A mean of independent terms.
  struct Terms {
    std::int64_t n = 0;
    double sum = 0.0, squares = 0.0, sizes = 0.0, largest = 0.0;
    void add(double x) {
      ++n;
      sum += x;
      squares += x * x;
      sizes += std::abs(x);
      largest = std::max(largest, std::abs(x));
    }
    [[nodiscard]] double mean() const { return sum / static_cast<double>(n); }
    /// Without interval where a single term makes a tenth of all: then there are larger ones that
    /// were not seen.
    [[nodiscard]] Mean95 mean_95() const {
      constexpr double kSigmas = 1.959964, kMostOfOne = 0.1;
      if (n < 2 || largest > kMostOfOne * sizes) return {mean(), {std::nan(""), std::nan("")}};
      const auto count = static_cast<double>(n);
      const double variance = std::max(0.0, squares / count - mean() * mean()),
                   half = kSigmas * std::sqrt(variance / (count - 1.0));
      return {mean(), {mean() - half, mean() + half}};
    }
  };
  struct Sample {
    Passages::Place place;
    int type;
    Crossing entry;
    double chance;  // that of the state
  };

  [[nodiscard]] std::int64_t cell_of(int column, int row) const {
    return std::int64_t{row} * field_.columns + column;
  }

  /// A gate with so many times the number; steps still fit into a hold of the random force.
  static GateParams changed(GateParams p, const ParamInfo& info, double factor) {
    info.ref(p) *= factor;
    if (info.key == "forces.random_rate_Hz") p.run.step /= factor;
    return p;
  }

  [[nodiscard]] bool allowed(const ParamInfo& info, double factor) const {
    return std::all_of(gates_.types().begin(), gates_.types().end(), [&](const GateParams& gate) {
      const GateParams p = changed(gate, info, factor);
      if (!info.permits(info.get(p))) return false;
      try {
        dynamics::validate(p);
        (void)make_method(p);
      } catch (const InvalidParameter&) {
        return false;
      }
      return true;
    });
  }

  /// The chance of the target behind a run of each sample, with that many times the number; NaN
  /// where it broke.
  [[nodiscard]] std::vector<double> values(const ParamInfo& info, double factor) {
    std::vector<double> out(samples_.size());
    tbb::enumerable_thread_specific<Health> health;  // sums and largest values: any order will do
    for (int type = 0; type < std::ssize(gates_.types()); ++type) {
      std::vector<std::size_t> here;
      for (std::size_t i = 0; i < samples_.size(); ++i)
        if (samples_[i].type == type) here.push_back(i);
      const GateParams p = changed(gates_.types()[static_cast<std::size_t>(type)], info, factor);
      const auto method = make_method(p);
      carry_out_trials(
          p, *method, std::ssize(here),
          [&](RunSlot& slot) {
            const std::size_t i = here[static_cast<std::size_t>(slot.trial)];
            slot.start = entry_state(p, samples_[i].entry);
            slot.force =
                RandomForce(p.forces, drawn(options_.seed, 1, static_cast<std::int64_t>(i)));
          },
          [&](RunSlot& slot, const GateRun& run) {
            const std::size_t i = here[static_cast<std::size_t>(slot.trial)];
            health.local().add(p, run);
            out[i] = value_of(p, samples_[i].place, run);
            return false;
          });
    }
    for (const Health& part : health) health_ += part;
    return out;
  }

  [[nodiscard]] double value_of(const GateParams& p, const Passages::Place& place,
                                const GateRun& run) const {
    const auto is = [&](markov::Ending e) { return chance_.ending() == e ? 1.0 : 0.0; };
    if (run.ending == Ending::broken) return std::nan("");
    if (run.ending == Ending::trapped) return is(markov::Ending::trapped);
    const Crossing crossing = crossing_of(p, run.ending, run.exit);
    const Move move = move_into(crossing.boundary);
    const auto column = static_cast<int>(place.cell % field_.columns) + move.di_x,
               row = static_cast<int>(place.cell / field_.columns) + move.di_y;
    if (!field_.contains(column, row))
      return is(markov::edge_before({field_.columns, field_.rows}, column, row));
    return chance_(place.draw + 1, cell_of(column, row), space_.index_of(crossing).state);
  }

  const FieldParams& field_;
  FieldGates gates_;
  const StateSpace& space_;
  const markov::EndingChance& chance_;
  const AnalysisOptions& options_;
  double visits_;  // of bodies that end in the target
  std::vector<Sample> samples_;
  std::vector<double> base_;  // values of the scene as it is
  Health health_;
};

// Numbers that are how a scene is computed, not what it is.
bool is_physical(std::string_view key) {
  return key != "run.step_s" && key != "run.event_tolerance_m" && key != "run.tolerance" &&
         key != "contact.impulse_threshold_Ns";
}

/// The chain with a state for each boundary, and the start's own.
std::optional<Analysis::Lumped> lumped_to_boundaries(const CostedChain& c, const StateSpace& space,
                                                     const FieldGates& gates,
                                                     const FieldParams& field) {
  const markov::Field cells{field.columns, field.rows};
  std::vector<int> group(static_cast<std::size_t>(c.chain.inputs()), kBoundaries);
  for (int state = 0; state < space.size(); ++state)
    if (state != c.start.input)
      group[static_cast<std::size_t>(state)] = static_cast<int>(space.boundary(state));
  try {
    const auto visits = markov::expected_visits(c.chain, cells, c.start, field.max_gates);
    std::vector<markov::Chain> chains;
    Analysis::Lumped lumped;
    for (const markov::Chain& chain : c.chain.chains()) {
      markov::Lumping of_type = markov::lump(chain, group, visits);
      lumped.largest = std::max(lumped.largest, of_type.largest);
      chains.push_back(std::move(of_type.chain));
    }
    const auto error = markov::lumping_error(c.chain, field_chain(gates, std::move(chains)), group,
                                             cells, c.start, {.max_cells = field.max_gates});
    lumped.endings = error.endings;
    lumped.final_gates = error.final_cells;
    return lumped;
  } catch (const std::runtime_error&) {  // walks without end
    return {};
  }
}

/// Throws where the states of all cells take too much memory: some waves of shares and totals, and
/// chances by draw.
void require_memory(const CostedChain& c, const FieldParams& field, std::size_t groups) {
  constexpr double kMostBytes = 8.0 * (1 << 30);
  const double states = static_cast<double>(field.columns) * field.rows * c.chain.inputs();
  const double numbers =
      2.0 * (1.0 + 2.0 * kCosts) * (groups == 0 ? 1.0 : 2.0) + 3.0 * std::max(1, field.max_gates);
  if (states * numbers * sizeof(double) > kMostBytes)
    throw std::invalid_argument(
        "analysis: the states of " + std::to_string(field.columns) + " x " +
        std::to_string(field.rows) +
        " gates take more than 8 GiB; ask for fewer states (--accuracy, build --states) or gates");
}

}  // namespace

Analysis analyze(const Scene& scene, const AnalysedChain& chain, const AnalysisOptions& options,
                 const Work& work) {
  const Stopwatch watch;
  const FieldGates gates = gates_of(scene);
  const FieldParams& field = scene.field;
  const CostedChain& c = chain.chain;
  const StateSpace& space = chain.space;
  const markov::Field cells{field.columns, field.rows};
  const auto tell = [&](std::int64_t done) { work.tell("analysis", done, 3); };

  require_memory(c, field, chain.groups.size());
  tell(0);
  const markov::EndingChance chance(c.chain, cells, options.target, field.max_gates);
  tell(1);
  const std::int64_t first_cell = std::int64_t{c.start.row} * field.columns + c.start.column;
  const double at_start = chance(1, first_cell, c.start.input);
  Passages passages(c, field, chance, at_start);
  passages.add_up();

  Analysis out{.target = options.target,
               .target_chance = at_start,
               .totals = passages.totals(),
               .gates = {},
               .costs = {},
               .walks = {},
               .endless = {},
               .why_not_endless = {},
               .endless_boundaries = {},
               .starts = {},
               .paths = {},
               .passed = markov::CellProbabilities::Zero(field.rows, field.columns),
               .trapping = {},
               .state_trapping = {},
               .space = space,
               .boundaries = {},
               .parameters = {},
               .parameter_health = {}};

  // Means, and the same of eight groups of the trials.
  tell(2);
  std::vector<markov::WalkTotals> groups(chain.groups.size());
  tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t g) {
    const CostedChain& part = chain.groups[g];
    groups[g] = markov::walk_totals(part.chain, cells, part.start, field.max_gates, part.rewards);
  });
  const auto mean_95 = [&](const auto& value) {
    std::vector<double> parts;
    for (const markov::WalkTotals& g : groups) parts.push_back(value(g));
    const double whole = value(out.totals),
                 half = parts.empty() ? std::nan("") : half_width_95(whole, parts);
    return Mean95{whole, {whole - half, whole + half}};
  };
  out.gates = mean_95([](const markov::WalkTotals& t) { return t.visits.sum(); });
  for (std::size_t k = 0; k < kCosts; ++k)
    out.costs[k] = mean_95(
        [k](const markov::WalkTotals& t) { return markov::WalkTotals::all(t.totals[k]).mean(); });
  if (std::isfinite(out.costs[0].mean))
    out.walks = markov::timed_walks(c.chain, cells, c.start, field.max_gates, c.rewards,
                                    options.timed_walks, options.seed);
  tell(3);

  std::vector<double> share(gates.types().size(), 0.0);
  for (int row = 0; row < field.rows; ++row)
    for (int column = 0; column < field.columns; ++column)
      share[static_cast<std::size_t>(gates.type_of(column, row))] +=
          1.0 / (static_cast<double>(field.rows) * field.columns);
  try {
    out.endless = markov::quasi_stationary(c.chain, share);
    out.endless_boundaries.assign(kBoundaries, 0.0);
    for (int state = 0; state < space.size(); ++state)
      out.endless_boundaries[static_cast<std::size_t>(space.boundary(state))] +=
          out.endless->states[static_cast<std::size_t>(state)];
  } catch (const std::runtime_error& e) {
    out.why_not_endless = e.what();
  }

  out.boundaries = lumped_to_boundaries(c, space, gates, field);
  const markov::Chain& first = c.chain.at(c.start.column, c.start.row);
  for (int state = 0; state < space.size(); ++state)
    if (space.boundary(state) == Boundary::enter)
      out.starts.push_back({space.cell(state),
                            first.is_sampled(state) ? chance(1, first_cell, state) : std::nan("")});
  out.paths =
      markov::most_frequent_paths(c.chain, cells, c.start, field.max_gates, chance, options.paths);

  if (out.target_chance > 0.0) {
    const bool of_trapped = options.target == markov::Ending::trapped;
    if (!of_trapped) {
      out.trapping = out.passed;
      out.state_trapping.resize(static_cast<std::size_t>(space.size()));
    }
    passages.each([&](const Passages::Place& place, double weight) {
      const double part = weight / out.target_chance;
      const auto column = place.cell % field.columns, row = place.cell / field.columns;
      out.passed.data()[place.cell] += part;
      const double trapped = trapped_share(c.chain.at(column, row), place.input);
      if (of_trapped || trapped >= 1.0) return;  // nobody goes on from there
      const double effect = part * trapped / (1.0 - trapped);
      out.trapping.data()[place.cell] += effect;
      if (place.input < space.size())
        out.state_trapping[static_cast<std::size_t>(place.input)] += effect;
    });
    if (options.runs > 0) {
      const Stopwatch of_parameters;
      Parameters parameters(scene, chain, chance, out.target_chance, passages, options);
      std::vector<const ParamInfo*> infos;
      for (const ParamInfo& info : gate_param_table())
        if (is_physical(info.key)) infos.push_back(&info);
      for (std::size_t k = 0; k < infos.size(); ++k) {
        work.tell("gate runs for parameters", static_cast<std::int64_t>(k), std::ssize(infos));
        if (auto effect = parameters.effect(*infos[k])) out.parameters.push_back(*effect);
      }
      out.parameter_health = parameters.health();
      out.parameter_seconds = of_parameters.seconds();
    }
  }
  out.seconds = watch.seconds();
  return out;
}

}  // namespace gatewalk::lattice
