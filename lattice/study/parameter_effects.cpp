#include "lattice/study/parameter_effects.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "dynamics/disc/contact.h"
#include "dynamics/disc/methods/method.h"
#include "dynamics/disc/runs.h"
#include "lattice/pool/pool_runner.h"
#include "lattice/statistics/group_spread.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

/// A mean.
struct Terms {
  std::int64_t n = 0;
  double sum = 0.0, sizes = 0.0, largest = 0.0;
  void add(double x) {
    ++n;
    sum += x;
    sizes += std::abs(x);
    largest = std::max(largest, std::abs(x));
  }
  [[nodiscard]] double mean() const { return sum / static_cast<double>(n); }
  /// One of them makes a tenth of the sum: rarer ones may be larger still, and the mean is not to
  /// be trusted.
  [[nodiscard]] bool few_make_it() const {
    constexpr double kMostOfOne = 0.1;
    return !(largest < kMostOfOne * sizes);
  }
};

/// A gate with so many times the number; steps still fit into a hold of the random force.
GateParams changed(GateParams p, const ParamInfo& info, double factor) {
  info.ref(p) *= factor;
  if (info.key == "forces.random_rate_Hz") p.run.step /= factor;
  return p;
}

// Numbers that are how a scene is computed, not what it is.
bool is_physical(std::string_view key) {
  return key != "run.step_s" && key != "run.event_tolerance_m" && key != "run.tolerance" &&
         key != "contact.impulse_threshold_Ns";
}

/// Of what passages take for a chain and for its groups, 8 GiB hold so many states.
double most_states(const FieldParams& field) {
  constexpr double kMostBytes = 8.0 * (1 << 30), kNumbers = 2.0 * 4.0;
  return kMostBytes /
         (kNumbers * sizeof(double) * field.columns * field.rows * std::max(1, field.max_gates));
}

/// From a body that enters so to the nearer of the beams at rest (m); negative: there is no room.
double room(const GateParams& p, const Entry& entry) {
  const BodyState body = entry_state(p, entry);
  return std::min(nearest(p, kLeft, body, 0.0).gap, nearest(p, kRight, body, 0.0).gap);
}

class Parameters {
 public:
  Parameters(const Scene& scene, const AnalysedChain& chain, const Passages& passages,
             const std::vector<Passages>& groups, const ParameterOptions& options)
      : field_(scene.field), gates_(gates_of(scene)), options_(options) {
    add_samples(chain, passages, options.runs);
    for (std::size_t g = 0; g < groups.size(); ++g)
      add_samples(chain.groups[g], groups[g], options.runs / std::ssize(groups));
    as_it_is_ = values([](const GateParams& p) { return p; });
  }

  /// None where the number is zero, or cannot be changed.
  [[nodiscard]] std::optional<ParameterEffect> effect(const ParamInfo& info) {
    double value = info.get(gates_.types().front());
    bool any = false;
    for (const GateParams& p : gates_.types()) {
      any = any || info.get(p) != 0.0;
      if (info.get(p) != value) value = std::nan("");
    }
    const double step = options_.relative_step;
    const bool up = allowed(info, 1.0 + step), down = allowed(info, 1.0 - step);
    if (!any || (!up && !down)) return {};
    const auto with = [&](double factor) {
      return values([&](const GateParams& p) { return changed(p, info, factor); });
    };
    const std::vector<double> above = up ? with(1.0 + step) : as_it_is_,
                              below = down ? with(1.0 - step) : as_it_is_;
    const auto used = [&](std::size_t i) {
      return std::isfinite(above[i] + below[i] + as_it_is_[i]);
    };
    const auto sides = [&](auto counted) {
      return Sides{terms(used, counted, [&](std::size_t i) { return above[i] - as_it_is_[i]; }),
                   terms(used, counted, [&](std::size_t i) { return as_it_is_[i] - below[i]; }),
                   terms(used, counted, [&](std::size_t i) { return above[i] - below[i]; })};
    };
    const auto all = [](std::size_t) { return true; };
    const Sides changes = sides(all);
    const auto more = [&](const Sides& s, std::size_t part) {
      return compounded(s.more[part].mean(), part) / step;
    };
    const auto less = [&](const Sides& s, std::size_t part) {
      return -compounded(-s.less[part].mean(), part) / step;
    };
    const auto both = [&](const Sides& s, std::size_t part) {
      return (more(s, part) + less(s, part)) / (up && down ? 2.0 : 1.0);
    };
    ParameterEffect e{info.key, value, {}, {}};
    e.left_out =
        1.0 - static_cast<double>(changes.both.front().n) / static_cast<double>(options_.runs);
    constexpr double kMostLeftOut = 0.05;
    const auto central = [&](const Sides& s) {
      const bool few = s.both.front().few_make_it() || e.left_out > kMostLeftOut;
      return of_parts(few, [&](std::size_t part) { return both(s, part); });
    };
    e.elasticity = central(changes);
    for (int type = 0; type < std::ssize(gates_.types()) && gates_.types().size() > 1; ++type)
      e.of_type.push_back(central(sides([&](std::size_t i) { return samples_[i].type == type; })));
    e.more = up ? more(changes, 0) : std::nan("");
    e.less = down ? less(changes, 0) : std::nan("");
    const Mean95 bend = of_parts(changes.both.front().few_make_it(), [&](std::size_t part) {
      return more(changes, part) - less(changes, part);
    });
    constexpr double kSure = 1.5;  // half widths of 95 %: 9 in 1000 by chance
    e.bends = up && down && std::abs(bend.mean) > kSure * (bend.mean - bend.interval[0]);
    return e;
  }
  [[nodiscard]] const Health& health() const { return health_; }

 private:
  /// Samples of one chain: that of all trials, or of a group of them.
  struct Part {
    const StateSpace& space;
    const Passages& passages;
  };
  struct Sample {
    std::size_t part;
    Passages::Place place;
    int type;
    Entry entry;
    double weight;  // of walks there
    double room;    // in the gate as it is
  };

  /// A random number of the analysis: of the samples' places and of their runs' noise.
  enum class Draw : std::uint64_t { place, noise };
  [[nodiscard]] Random drawn(Draw what, std::size_t sample) const {
    return {Purpose::sensitivity,
            {options_.seed, static_cast<std::uint64_t>(what), static_cast<std::uint64_t>(sample)}};
  }

  void add_samples(const AnalysedChain& chain, const Passages& passages, std::int64_t count) {
    parts_.push_back({chain.space, passages});
    if (!(passages.at_start() > 0.0)) return;  // of a group: nothing is known
    const Passages::Draws draws(passages);
    for (std::int64_t i = 0; i < count; ++i) {  // one from each of so many equal parts
      Random random = drawn(Draw::place, samples_.size());
      const Passages::Place place =
          draws.place((static_cast<double>(i) + random.uniform()) / static_cast<double>(count));
      const auto column = static_cast<int>(place.cell % field_.columns),
                 row = static_cast<int>(place.cell / field_.columns);
      const int type = gates_.type_of(column, row);
      const Entry entry = chain.entry(place.input, random);
      samples_.push_back({parts_.size() - 1, place, type, entry, draws.weight(place),
                          room(gates_.types()[static_cast<std::size_t>(type)], entry)});
    }
  }

  /// By part: relative changes of the chance, to first order, of which these are the terms.
  struct Sides {
    std::vector<Terms> more, less, both;
  };
  /// Of the samples in question, the others being zero.
  template <class Used, class Counted, class Change>
  [[nodiscard]] std::vector<Terms> terms(Used used, Counted counted, Change change) const {
    std::vector<Terms> terms(parts_.size());
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const Sample& s = samples_[i];
      if (used(i))
        terms[s.part].add(counted(i) ? s.weight * change(i) / parts_[s.part].passages.at_start()
                                     : 0.0);
    }
    return terms;
  }

  /// Changes of the gates on the way multiply: of the sum of n small ones, what n equal ones do
  /// together.
  [[nodiscard]] double compounded(double sum, std::size_t part) const {
    const double gates = parts_[part].passages.draws_to_target();
    return std::pow(std::max(0.0, 1.0 + sum / gates), gates) - 1.0;
  }

  /// `value(part)`: of the whole, 0, and of each group. The groups' spread has the chance of as
  /// many runs in it as the whole has.
  template <class Value>
  [[nodiscard]] Mean95 of_parts(bool few_make_it, Value value) const {
    std::vector<double> groups;
    for (std::size_t part = 1; part < parts_.size() && !few_make_it; ++part)
      groups.push_back(value(part));
    return mean_95(value(0), groups);
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

  /// The chance of the target behind a run of each sample, in gates changed so; NaN where it broke,
  /// and where the changed gate's beams are in the way of the entry, which bodies then make
  /// otherwise.
  template <class Change>
  [[nodiscard]] std::vector<double> values(Change change) {
    std::vector<double> out(samples_.size());
    tbb::enumerable_thread_specific<Health> health;  // sums and largest values: any order will do
    for (int type = 0; type < std::ssize(gates_.types()); ++type) {
      const GateParams p = change(gates_.types()[static_cast<std::size_t>(type)]);
      std::vector<std::size_t> here;
      for (std::size_t i = 0; i < samples_.size(); ++i) {
        if (samples_[i].type != type) continue;
        if (room(p, samples_[i].entry) < std::min(0.0, samples_[i].room))
          out[i] = std::nan("");
        else
          here.push_back(i);
      }
      const auto method = make_method(p);
      carry_out_trials(
          p, *method, std::ssize(here),
          [&](RunSlot& slot) {
            const std::size_t i = here[static_cast<std::size_t>(slot.trial)];
            slot.start = entry_state(p, samples_[i].entry);
            slot.force = RandomForce(p.forces, drawn(Draw::noise, i));
          },
          [&](RunSlot& slot, const GateRun& run) {
            const std::size_t i = here[static_cast<std::size_t>(slot.trial)];
            add_run(health.local(), p, run);
            out[i] = value_of(p, samples_[i], run);
            return false;
          });
    }
    for (const Health& part : health) health_ += part;
    return out;
  }

  [[nodiscard]] double value_of(const GateParams& p, const Sample& s, const GateRun& run) const {
    const Part& part = parts_[s.part];
    const markov::EndingChance& chance = part.passages.chance();
    const auto is = [&](markov::Ending e) { return chance.ending() == e ? 1.0 : 0.0; };
    if (run.ending == Ending::broken) return std::nan("");
    if (run.ending == Ending::trapped) return is(markov::Ending::trapped);
    const Entry crossing = crossing_of(p, run.ending, run.exit);
    const Face& move = part.space.section().faces[crossing.face];
    const auto column = static_cast<int>(s.place.cell % field_.columns) + move.di_x,
               row = static_cast<int>(s.place.cell / field_.columns) + move.di_y;
    if (!field_.contains(column, row))
      return is(markov::edge_before({field_.columns, field_.rows}, column, row));
    return chance(s.place.draw + 1, std::int64_t{row} * field_.columns + column,
                  part.space.index_of(crossing).state);
  }

  const FieldParams& field_;
  FieldGates gates_;
  const ParameterOptions& options_;
  std::vector<Part> parts_;  // that of all trials, and of the groups
  std::vector<Sample> samples_;
  std::vector<double> as_it_is_;  // values of the scene
  Health health_;
};

}  // namespace

ParameterEffects parameter_effects(const Scene& scene, const AnalysedChain& chain,
                                   markov::Ending target, const ParameterOptions& options,
                                   const Work& work) {
  const Stopwatch watch;
  const char* const kRuns = "gate runs for parameters";
  std::vector<const ParamInfo*> infos;
  for (const ParamInfo& info : gate_param_table())
    if (is_physical(info.key)) infos.push_back(&info);
  const auto [passages, groups] =
      all_passages(chain, scene.field, target, false, "chain for parameters", work);
  ParameterEffects out{.chance = passages.at_start(), .effects = {}, .health = {}};
  if (passages.at_start() > 0.0) {
    Parameters parameters(scene, chain, passages, groups, options);
    for (std::size_t k = 0; k < infos.size(); ++k) {
      work.tell(kRuns, static_cast<std::int64_t>(k), std::ssize(infos));
      if (auto effect = parameters.effect(*infos[k])) out.effects.push_back(std::move(*effect));
    }
    out.health = parameters.health();
  }
  out.seconds = watch.seconds();
  return out;
}

ParameterEffects parameter_effects(const Scene& scene, RunPool& pool, markov::Ending target,
                                   const ParameterOptions& options, int per_leaf,
                                   std::int64_t most_runs, const Work& work) {
  const Stopwatch watch;
  constexpr std::int64_t kPoolOfRuns = 25;
  const Entry start = entry_of(scene.start);
  const std::size_t own = pool.place_of(start);
  if (own == pool.starts.size())
    throw std::invalid_argument("parameters: the start has no runs of its own");
  const std::int64_t had = pool.gate_runs();
  PoolRunner runner(scene, options.seed, most_runs, work);
  const auto lacking = [&] {
    return static_cast<double>(std::min(kPoolOfRuns * options.runs - pool.gate_runs(),
                                        most_runs - runner.gate_runs)) /
           runner.gates_per_trial();  // of which the first trials tell
  };
  if (lacking() > 0.0) {
    do
      runner.run_full(pool.starts[own], runner.gate_runs == 0
                                            ? PoolRunner::kLeastTrials
                                            : static_cast<std::int64_t>(lacking()));
    while (lacking() > PoolRunner::kLeastTrials);
    runner.finish();
  }
  const auto runs = static_cast<double>(pool.gate_runs());
  const double leaf = std::max(per_leaf * std::sqrt(runs / static_cast<double>(had)),
                               2.0 * runs / most_states(scene.field));  // with mirror images
  const auto chain = analysed_chain(scene, pool, start, static_cast<int>(std::ceil(leaf)));
  ParameterEffects out = parameter_effects(scene, chain, target, options, work);
  out.health += runner.health;
  out.added_runs = runner.gate_runs;
  out.pool_runs = pool.gate_runs();
  out.seconds = watch.seconds();
  return out;
}

}  // namespace gatewalk::lattice
