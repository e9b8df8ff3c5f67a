// SPDX-License-Identifier: MIT
#include "lattice/study/analysis.h"
#include "lattice/scene/terrain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "dynamics/disc/ensemble.h"
#include "dynamics/disc/row_trials.h"
#include "dynamics/disc/runs.h"
#include "lattice/field/field_costs.h"
#include "lattice/pool/lumped_chain.h"
#include "lattice/pool/pooled_prediction.h"
#include "lattice/pool/reactive_visits.h"
#include "lattice/pool/tree_chain.h"
#include "lattice/study/parameter_effects.h"
#include "lattice/study/trials.h"
#include "tests/support/disc_fields.h"
#include "tests/support/threads.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;
using markov::Ending;

/// About 3 of 10 bodies cross the three rows of this field.
Scene open_scene() {
  Scene scene;
  scene.gate.forces.propulsion = 9.0;
  scene.gate.forces.random = 30.0;
  scene.field = {5, 3, 8};
  scene.gate.run.method = "moreau";
  scene.gate.run.step = 0.02;
  scene.start = {4, 0, 1, 15};
  return scene;
}

OwnRuns some_trials(const Scene& scene, std::int64_t n) {
  OwnRuns s;
  s.start = entry_of(scene.start);
  (void)run_field(gates_of(scene), scene.field, scene.start, 9, {0, n}, &s.full);
  return s;
}

RunPool pool_of_trials(const Scene& scene, std::int64_t n) {
  RunPool pool;
  pool.starts.push_back(some_trials(scene, n));
  return pool;
}

// ---- Costs of runs and trials ----

TEST(Costs, OfARunAreThoseOfItsTrace) {
  for (const char* method : {"stable", "moreau", "event", "paper"}) {
    Scene scene = open_scene();
    scene.gate.run.method = method;
    scene.gate.run.step = default_step(scene.gate);
    const auto made = make_method(scene.gate);
    const GateTally lanes = run_gate_trials(scene.gate, scene.start, 3, {0, 1});
    EXPECT_EQ(lanes.trials, 1);
    RandomForce force = gate_force(scene.gate, 3, 0);
    const GateTrace trace = trace_gate(scene.gate, *made, scene.start, force);
    const Energies& end = trace.samples.back().energy;
    const double left = end.mechanical() - end.body;  // in the beams; a run counts it as lost
    EXPECT_EQ(trace.run.forward, trace.run.exit.y - scene.start.y) << method;
    EXPECT_NEAR(trace.run.propulsion_work, end.propulsion_work, 1e-9) << method;
    EXPECT_NEAR(trace.run.random_work, end.random_work, 1e-9) << method;
    EXPECT_NEAR(trace.run.lost, end.lost + left, 1e-9) << method;
    EXPECT_NEAR(trace.run.seconds, trace.samples.back().time, 1e-9) << method;
  }
}

// Equal to the last bit for stable, to the last digits for moreau.
TEST(Costs, OfLanesAreThoseOfThePlainMethod) {
  for (const char* method : {"stable", "moreau"}) {
    Scene scene = open_scene();
    scene.gate.run.method = method;
    scene.gate.run.step = default_step(scene.gate);
    const auto made = make_method(scene.gate);
    std::vector<GateRun> in_lanes(300);
    carry_out_trials(
        scene.gate, *made, std::ssize(in_lanes),
        [&](RunSlot& slot) {
          slot.start = scene.start;
          slot.force = gate_force(scene.gate, 3, slot.trial);
        },
        [&](RunSlot& slot, const GateRun& run) {
          in_lanes[static_cast<std::size_t>(slot.trial)] = run;
          return false;
        });
    for (std::size_t i = 0; i < in_lanes.size(); ++i) {
      const GateRun plain =
          run_gate_trial(scene.gate, *made, scene.start, 3, static_cast<std::int64_t>(i));
      if (std::string_view(method) == "stable") {
        EXPECT_EQ(costs_of(in_lanes[i]), costs_of(plain)) << i;
      } else if (in_lanes[i].outcome == plain.outcome) {
        EXPECT_NEAR(in_lanes[i].random_work, plain.random_work,
                    1e-6 * (1.0 + std::abs(plain.random_work)))
            << i;
      }
    }
  }
}

TEST(Costs, OfTrialsDoNotDependOnPiecesOrThreads) {
  const Scene scene = open_scene();
  const auto run = [&](const std::vector<TrialRange>& ranges) {
    FieldCosts costs(bin_of_durations(scene.gate));
    for (const TrialRange& range : ranges) {
      FieldTrials each;
      (void)run_field(scene.gate, scene.field, scene.start, 9, range, &each);
      costs.add(each);
    }
    return costs;
  };
  const FieldCosts whole = test::on_threads(1,
                                            [&] {
                                              return run({{0, 500}});
                                            }),
                   parts = test::on_threads(3, [&] {
                     return run({{0, 1}, {1, 320}, {321, 179}});
                   });
  for (std::size_t e = 0; e < markov::kEndings; ++e) {
    const auto ending = static_cast<Ending>(e);
    EXPECT_EQ(whole.of(ending).trials, parts.of(ending).trials);
    EXPECT_EQ(whole.of(ending).sum, parts.of(ending).sum);
    EXPECT_EQ(whole.of(ending).squares, parts.of(ending).squares);
  }
  EXPECT_EQ(whole.all().trials, 500);
  EXPECT_EQ(quantile(whole.durations(), 1.0), whole.durations().back().seconds);
  EXPECT_LE(quantile(whole.durations(), 0.25), quantile(whole.durations(), 0.5));
}

// ---- The chain ----

// With one run per leaf nothing is pooled: the chain repeats the trials, with their costs.
TEST(Analysis, LeavesOfOneRunTakeWhatTheTrialsTook) {
  Scene scene = open_scene();
  scene.gate.beams.stiffness_left = 300.0;  // so that there are no mirror images
  const RunPool pool = pool_of_trials(scene, 300);
  const FieldGates gates = gates_of(scene);
  const Kernel kernel = kernel_of(gates.map(), pool, 1);
  const ChainWithRewards c =
      chain_with_rewards(kernel, gates.map(), scene.field, pool, &pool.starts[0]);
  const auto totals = markov::walk_totals(c.chain, {5, 3}, c.start, 8, c.rewards);
  FieldCosts own(bin_of_durations(scene.gate));
  own.add(pool.starts[0].full);
  for (std::size_t e = 0; e < markov::kEndings; ++e) {
    const auto& sums = own.of(static_cast<Ending>(e));
    EXPECT_NEAR(totals.endings[e], static_cast<double>(sums.trials) / 300.0, 1e-12);
    if (sums.trials == 0) continue;
    for (std::size_t k = 0; k < kCosts; ++k) {
      const double mean = sums.mean(k);
      EXPECT_NEAR(totals.totals[k][e].mean(), mean, 1e-9 * (1.0 + std::abs(mean))) << e << " " << k;
      EXPECT_NEAR(totals.totals[k][e].sd(), sums.sd(k), 1e-5 * (1.0 + std::abs(mean)))
          << e << " " << k;
    }
  }
}

// Mirror images count twice, and with several types leaves share rows.
TEST(Analysis, CostsAreThoseOfAllRunsBehindACount) {
  for (const bool mixed : {false, true}) {
    Scene scene = open_scene();
    if (mixed) {
      scene = parse_scene(
          "[field]\ncolumns = 5\nrows = 3\nmax_gates = 8\n[run]\nmethod = 'moreau'\nstep_s = "
          "0.02\n[terrain]\nmap = ['.s.s.', 's.s.s', '.s.s.']\n[terrain.types.s]\n"
          "beams.stiffness_left_Nm_per_rad = 200.0\n",
          "mixed");
      scene.start = {4, 0, 1, 15};
    }
    const FieldGates gates = gates_of(scene);
    const RunPool pool = pool_of_trials(scene, 200);
    const Kernel kernel = kernel_of(gates.map(), pool);
    const auto sums = cost_sums(kernel, gates.map(), pool);
    ASSERT_EQ(sums.size(), gates.types().size());
    for (std::size_t type = 0; type < sums.size(); ++type) {
      const markov::Counts& counts = kernel.counts[type];
      ASSERT_EQ(std::ssize(sums[type]), counts.nonZeros());
      for (Eigen::Index i = 0; i < counts.nonZeros(); ++i) {
        // A trapped run lasts for the time limit; no body stays longer in a gate.
        const bool trapped = counts.innerIndexPtr()[i] == kernel.space.trapped();
        const auto n = static_cast<double>(counts.valuePtr()[i]);
        const double seconds = sums[type][static_cast<std::size_t>(i)].sum[0] / n;
        EXPECT_GT(seconds, 0.0);
        EXPECT_LE(seconds, scene.gate.run.time_limit * (1.0 + 1e-9));
        if (trapped) {
          EXPECT_NEAR(seconds, scene.gate.run.time_limit, 1e-6);
        }
      }
    }
  }
}

TEST(Analysis, CostsComeBackFromAFile) {
  const Scene scene = open_scene();
  const RunPool pool = pool_of_trials(scene, 100);
  MatrixFile file{Transitions(StateSpace(
                      disc_section(), kernel_of(FieldGates(scene.gate).map(), pool).space.trees(),
                      {entry_of(scene.start)})),
                  {}};
  file.arrays = arrays_of(pool, disc_section());
  const RunPool back = pool_of(file, problem_of(scene), "file");
  ASSERT_EQ(back.starts[0].full.passages.size(), pool.starts[0].full.passages.size());
  for (std::size_t i = 0; i < pool.starts[0].full.passages.size(); ++i)
    EXPECT_EQ(back.starts[0].full.passages[i].costs, pool.starts[0].full.passages[i].costs);
  EXPECT_EQ(back.starts[0].full.costs, pool.starts[0].full.costs);
  // Older files have no costs: they become NaN, and give no answer.
  std::erase_if(file.arrays, [](const auto& a) { return a.name == "run_time_s"; });
  const RunPool older = pool_of(file, problem_of(scene), "file");
  EXPECT_TRUE(std::isnan(older.starts[0].full.passages[0].costs[0]));
}

TEST(Analysis, BinsKeepWhatTheirRunsTook) {
  const Scene scene = open_scene();
  const StateSpace space = table3_space(scene.gate);
  Transitions whole(space), pieces(space);
  add_trials(whole, scene.gate, 1, {0, 60});
  for (const TrialRange& range : {TrialRange{0, 7}, TrialRange{7, 53}})
    add_trials(pieces, scene.gate, 1, range);
  EXPECT_EQ(whole.costs, pieces.costs);
  for (int row = 0; row < space.size(); ++row) {
    ASSERT_EQ(whole.costs[row].size(), whole.rows[row].size());
    const auto trapped = whole.rows[row].find(space.trapped());
    if (trapped == whole.rows[row].end()) continue;
    EXPECT_NEAR(whole.costs[row].at(space.trapped()).sum[0],
                static_cast<double>(trapped->second) * scene.gate.run.time_limit, 1e-6);
  }
  const std::string path = std::filesystem::temp_directory_path() / "analysis_test.nc";
  write_matrix(path, {whole, {}});
  const MatrixFile back = read_matrix(path);
  std::filesystem::remove(path);
  EXPECT_EQ(back.transitions.costs, whole.costs);
  EXPECT_TRUE(back.arrays.empty());

  const ChainStart start = chain_start(space, scene.field, entry_of(scene.start));
  const Analysis a =
      analyze(problem_of(scene), analysed_chain(problem_of(scene), {whole}, start.start), {});
  FieldCosts costs(bin_of_durations(scene.gate));
  FieldTrials each;
  (void)run_field(scene.gate, scene.field, scene.start, 777, {0, 4000}, &each, &space);
  costs.add(each);
  EXPECT_NEAR(a.costs[0].mean / costs.all().mean(0), 1.0, 0.25);  // error of the bins
  EXPECT_TRUE(std::isnan(a.costs[0].interval[0]));
  // Without the runs' costs, the analysis gives no answer instead of a wrong one.
  whole.costs.assign(whole.costs.size(), {});
  const Analysis b =
      analyze(problem_of(scene), analysed_chain(problem_of(scene), {whole}, start.start), {});
  EXPECT_TRUE(std::isnan(b.costs[0].mean));
  EXPECT_TRUE(b.walks.empty());
  EXPECT_EQ(a.target_chance, b.target_chance);
}

TEST(Analysis, AgreesWithTheFullDynamics) {
  const Scene scene = open_scene();
  const RunPool pool = pool_of_trials(scene, 20'000);
  const Analysis a =
      analyze(problem_of(scene), analysed_chain(problem_of(scene), pool, &pool.starts.front()), {});
  FieldCosts costs(bin_of_durations(scene.gate));
  FieldTrials each;
  (void)run_field(scene.gate, scene.field, scene.start, 777, {0, 20'000}, &each);
  costs.add(each);
  for (std::size_t k = 0; k < kCosts; ++k) {
    const auto cost = k;
    EXPECT_NEAR(a.costs[k].mean / costs.all().mean(cost), 1.0, 0.02) << kCostNames[k].key;
  }
  EXPECT_NEAR(a.totals.visits.sum(), a.gates.mean, 1e-9);
  EXPECT_LT(a.gates.interval[0], a.gates.mean);
  EXPECT_NEAR(a.target_chance, a.totals.endings[static_cast<std::size_t>(Ending::far_edge)], 1e-12);
  double sum = 0.0;
  for (const markov::CellPath& path : a.paths.paths) sum += path.share;
  EXPECT_GT(sum, 0.3 * a.target_chance);
  EXPECT_LT(sum, a.target_chance);
  // A body that crosses passes each row.
  for (Eigen::Index row = 0; row < 3; ++row) EXPECT_GE(a.passed.row(row).sum(), 1.0 - 1e-9);
  ASSERT_TRUE(a.endless);
  EXPECT_GT(a.endless->survival, a.endless->second);
}

// Only in a field that is its own mirror image do a start and its mirror image have the same
// probabilities, of the target and of the target's mirror image.
TEST(Analysis, ChancesOfStartsAreThoseOfTheMirror) {
  Scene scene = open_scene();
  RunPool pool = pool_of_trials(scene, 200);  // so few that all starts are listed
  const auto starts_of = [&](Ending target) {
    return analyze(problem_of(scene), analysed_chain(problem_of(scene), pool, &pool.starts.front()),
                   {.target = target})
        .starts;
  };
  const auto crossed = starts_of(Ending::far_edge), left = starts_of(Ending::left_edge),
             right = starts_of(Ending::right_edge);
  const auto image_of = [](const StartChance& s, const std::vector<StartChance>& among) {
    return std::find_if(among.begin(), among.end(), [&](const StartChance& other) {
      const auto turned = [&](std::size_t axis) {
        return std::array{-s.range.at[axis][1], -s.range.at[axis][0]};
      };
      return other.range.at ==
             decltype(other.range.at){turned(kEntryD), turned(kEntryVx), s.range.at[kEntryVy]};
    });
  };
  ASSERT_GT(crossed.size(), 20U);
  ASSERT_LE(std::ssize(crossed), kToldStarts);
  ASSERT_EQ(left.size(), crossed.size());
  bool sides_differ = false;
  int with_intervals = 0;
  for (std::size_t i = 0; i < crossed.size(); ++i) {
    const auto same = image_of(crossed[i], crossed), other = image_of(left[i], right);
    ASSERT_TRUE(same != crossed.end() && other != right.end()) << i;
    EXPECT_EQ(same->chance.mean, crossed[i].chance.mean) << i;
    EXPECT_EQ(other->chance.mean, left[i].chance.mean) << i;
    if (std::isfinite(other->chance.interval[0]) && std::isfinite(left[i].chance.interval[0])) {
      EXPECT_EQ(other->chance.interval, left[i].chance.interval) << i;
      ++with_intervals;
    }
    sides_differ = sides_differ || left[i].chance.mean != right[i].chance.mean;
  }
  EXPECT_TRUE(sides_differ);
  EXPECT_GT(with_intervals, 20);
  pool = pool_of_trials(scene, 2000);
  const auto even = starts_of(Ending::far_edge);
  scene.field.columns = 4;
  const auto uneven = starts_of(Ending::far_edge);
  EXPECT_LT(uneven.size(), even.size());  // one start per leaf
}

// In a field that is its own mirror image, a start is the overlap of a state with the mirror image
// of a state: checks all pairs. Starts with most entries come first, and have intervals.
TEST(Analysis, StartsAreThePartsOfStatesAndImages) {
  const Scene scene = open_scene();
  const RunPool pool = pool_of_trials(scene, 2000);
  const AnalysedChain chain = analysed_chain(problem_of(scene), pool, &pool.starts.front());
  const Analysis a = analyze(problem_of(scene), chain, {});
  const StateSpace& space = chain.space;
  using Key = std::pair<decltype(StateRange::at), std::int64_t>;  // range, runs
  std::vector<Key> tried, found;
  for (int state = space.first(0); state < space.first(1); ++state)
    for (int other = space.first(0); other < space.first(1); ++other) {
      StateRange both = space.range(state);
      const StateRange image = dynamics::mirrored(space.section(), space.range(other));
      bool any = true;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        auto& [low, high] = both.at[axis];
        low = std::max(low, image.at[axis][0]);
        high = std::min(high, image.at[axis][1]);
        any = any && low < high;
      }
      if (any)
        tried.emplace_back(both.at, chain.runs[static_cast<std::size_t>(state)] +
                                        chain.runs[static_cast<std::size_t>(other)]);
    }
  for (const StartChance& s : a.starts) found.emplace_back(s.range.at, s.runs);
  ASSERT_GT(std::ssize(found), kToldStarts);
  ASSERT_EQ(a.told_starts(), kToldStarts);
  std::int64_t least = std::numeric_limits<std::int64_t>::max(), most = 0;
  for (std::ptrdiff_t i = 0; i < std::ssize(a.starts); ++i) {
    const StartChance& s = a.starts[static_cast<std::size_t>(i)];
    if (i < kToldStarts)
      least = std::min(least, s.runs);
    else
      most = std::max(most, s.runs);
    EXPECT_EQ(std::isfinite(s.chance.interval[0]), i < kToldStarts) << i;
  }
  EXPECT_GE(least, most);
  std::sort(tried.begin(), tried.end());
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, tried);
}

// The same check for bins, whose states are numbered by coordinate.
TEST(Analysis, StartsOfBinsAreThePartsOfBinsAndImages) {
  const Scene scene = open_scene();
  const StateSpace space(
      disc_section(),
      std::vector<Bins>(kBoundaries,
                        Bins{{{{-3.0, -1.0, 2.0}, {-2.0, 1.0, 2.0}, {0.0, 10.0, 20.0}}}}));
  Transitions counted(space);
  add_trials(counted, scene.gate, 1, {0, 20});
  const ChainStart start = chain_start(space, scene.field, entry_of(scene.start));
  const Analysis a =
      analyze(problem_of(scene), analysed_chain(problem_of(scene), {counted}, start.start), {});
  // d: [-3, -1], [-1, 2] and mirror images [1, 3], [-2, 1]; vx: [-2, 1], [1, 2] and [-1, 2], [-2,
  // -1]. Overlaps along d: (0, 1), (1, 0), (1, 1); along vx: (0, 0), (0, 1), (1, 0); along vy: 2.
  EXPECT_EQ(a.starts.size(), 18U);
}

// d ln(crossed) / d ln(value), compared with trials with 5 % more and less of the value.
TEST(Analysis, ParametersDoWhatTheFullDynamicsSays) {
  const Scene scene = open_scene();
  RunPool pool = pool_of_trials(scene, 10'000);
  const ParameterEffects a = parameter_effects(problem_of(scene), pool, Ending::far_edge,
                                               {.runs = 10'000, .relative_step = 0.05});
  constexpr std::int64_t kTrials = 20'000;
  const auto endings = [&](const char* key, double factor) {
    Scene other = scene;
    for (const ParamInfo& info : gate_param_table())
      if (info.key == key) info.ref(other.gate) *= factor;
    FieldTrials each;
    (void)run_field(other.gate, other.field, other.start, 5, {0, kTrials}, &each);
    return each.endings;
  };
  int seen = 0;
  for (const ParameterEffect& e : a.effects) {
    const bool asked = e.key == "forces.propulsion_N" || e.key == "forces.random_N" ||
                       e.key == "beams.stiffness_left_Nm_per_rad" || e.key == "body.mass_kg";
    if (!asked) continue;
    ++seen;
    const std::string key(e.key);
    // Both runs have the same noise: only bodies that cross in one of them count.
    const auto up = endings(key.c_str(), 1.05), down = endings(key.c_str(), 0.95);
    std::int64_t more = 0, fewer = 0;
    for (std::size_t i = 0; i < up.size(); ++i) {
      more += up[i] == Ending::far_edge && down[i] != Ending::far_edge;
      fewer += up[i] != Ending::far_edge && down[i] == Ending::far_edge;
    }
    const double mean = static_cast<double>(more - fewer) / kTrials,
                 square = static_cast<double>(more + fewer) / kTrials;
    const double central = mean / 0.1 / a.chance;
    const double chance = std::sqrt((square - mean * mean) / kTrials) / 0.1 / a.chance;
    const double half = 0.5 * (e.elasticity.interval[1] - e.elasticity.interval[0]);
    EXPECT_NEAR(e.elasticity.mean, central, 1.5 * std::hypot(half, 2.0 * chance)) << key;
  }
  EXPECT_EQ(seen, 4);
  EXPECT_GE(a.effects.size(), 12u);
}

// For a small change, the effects of the number in gates of one type add up to its effect in all.
TEST(Analysis, PartsOfTypesAddUp) {
  Scene scene = parse_scene(
      "[field]\ncolumns = 5\nrows = 3\nmax_gates = 8\n[forces]\npropulsion_N = 9.0\nrandom_N = "
      "30.0\n[run]\nmethod = 'moreau'\nstep_s = 0.02\n[terrain]\nmap = ['.s.s.', 's.s.s', "
      "'.s.s.']\n[terrain.types.s]\nbeams.stiffness_left_Nm_per_rad = 200.0\n",
      "mixed");
  scene.start = {4, 0, 1, 15};
  RunPool pool = pool_of_trials(scene, 2000);
  const auto effects = parameter_effects(problem_of(scene), pool, Ending::far_edge,
                                         {.runs = 2000, .relative_step = 1e-4})
                           .effects;
  ASSERT_GE(effects.size(), 12u);
  for (const ParameterEffect& e : effects) {
    ASSERT_EQ(e.of_type.size(), 2u) << e.key;
    EXPECT_NEAR(e.of_type[0].mean + e.of_type[1].mean, e.elasticity.mean,
                0.01 + 0.05 * std::abs(e.elasticity.mean))
        << e.key;
  }
}

// Changes multiply over several gates: a much smaller number never takes away more than everything.
TEST(Analysis, ALargeChangeTakesNoMoreThanThereIs) {
  const Scene scene = open_scene();
  RunPool pool = pool_of_trials(scene, 2000);
  constexpr double kStep = 0.45;
  bool takes_most = false;
  for (const ParameterEffect& e : parameter_effects(problem_of(scene), pool, Ending::far_edge,
                                                    {.runs = 1000, .relative_step = kStep})
                                      .effects) {
    if (std::isnan(e.less)) continue;
    EXPECT_LE(e.less * kStep, 1.0) << e.key;
    takes_most = takes_most || (e.key == "forces.propulsion_N" && e.less * kStep > 0.8);
  }
  EXPECT_TRUE(takes_most);
}

TEST(Analysis, TellsOfEachChainThatItHasWalked) {
  const Scene scene = open_scene();
  const RunPool pool = pool_of_trials(scene, 500);
  const AnalysedChain chain = analysed_chain(problem_of(scene), pool, &pool.starts.front());
  std::vector<std::int64_t> told;
  const Work work{[&](std::string_view, std::int64_t done, std::int64_t total) {
    EXPECT_EQ(total, kTrialGroups + 1);
    told.push_back(done);
  }};
  const auto all = all_reactive_visits(chain, scene.field, Ending::far_edge, {.costs = false},
                                       {.costs = false}, "chains", work);
  ASSERT_EQ(std::ssize(told), kTrialGroups + 2);
  for (std::int64_t i = 0; i < std::ssize(told); ++i)
    EXPECT_EQ(told[static_cast<std::size_t>(i)], i);
  EXPECT_EQ(std::ssize(all.groups), kTrialGroups);
  EXPECT_EQ(
      all.whole.at_start(),
      ReactiveVisits(chain.chain, scene.field, Ending::far_edge, {.costs = false}).at_start());
}

TEST(Analysis, DrawnPlacesStandForAllThatArePassed) {
  const Scene scene = open_scene();
  const RunPool pool = pool_of_trials(scene, 2000);
  const AnalysedChain chain = analysed_chain(problem_of(scene), pool, &pool.starts.front());
  const ReactiveVisits passages(chain.chain, scene.field, Ending::far_edge, {});
  double draws = 0.0, to_target = 0.0;
  passages.each([&](const ReactiveVisits::Place& place, double share) {
    draws += share;
    to_target += share * passages.chance(place);
  });
  EXPECT_NEAR(draws, passages.totals().visits.sum(), 1e-9);
  const ReactiveVisits::Draws drawn(passages);
  constexpr int kDraws = 20'000;
  double mean = 0.0, of_target = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const ReactiveVisits::Place place = drawn.place((i + 0.5) / kDraws);
    mean += drawn.weight(place) / kDraws;
    of_target += drawn.weight(place) * passages.chance(place) / kDraws;
  }
  EXPECT_NEAR(mean / draws, 1.0, 0.02);
  EXPECT_NEAR(of_target / to_target, 1.0, 0.02);
}

TEST(Analysis, PlacesTellWhereWalksEnd) {
  Scene scene = open_scene();
  const RunPool pool = pool_of_trials(scene, 2000);
  for (const int max_gates : {0, 4}) {
    scene.field.max_gates = max_gates;
    const ChainWithRewards c = analysed_chain(problem_of(scene), pool, &pool.starts.front()).chain;
    const auto ends = final_cells(c, scene.field, {c, scene.field, Ending::far_edge, {}});
    const auto exact = markov::predict(c.chain, {scene.field.columns, scene.field.rows}, {c.start},
                                       {.max_cells = max_gates});
    EXPECT_LT((ends - exact.front().final_cells).abs().maxCoeff(), 1e-11);
  }
}

// With about one part per state, nothing is lost.
TEST(Analysis, MorePartsLoseLess) {
  const Scene scene = open_scene();
  const RunPool pool = pool_of_trials(scene, 2000);
  const AnalysedChain chain = analysed_chain(problem_of(scene), pool, &pool.starts.front());
  const ReactiveVisits passages(chain.chain, scene.field, Ending::far_edge, {});
  const auto lumped = [&](const LumpingParts& parts) {
    return lumped_chain(chain, gates_of(scene).map(), scene.field, passages, parts).value();
  };
  const LumpedChain boundaries = lumped({}), some = lumped({2, 1, 3}), all = lumped({99, 99, 99});
  EXPECT_EQ(boundaries.states, kBoundaries + 1);
  EXPECT_EQ(some.states, 6 * kBoundaries + 1);
  EXPECT_LT(some.final_gates, boundaries.final_gates);
  EXPECT_GT(all.states, chain.space.size() - 20);  // states that no body visits stay together
  EXPECT_LT(all.final_gates, 0.01 * some.final_gates);
}

TEST(Analysis, IsTheSameOnAnyNumberOfThreads) {
  const Scene scene = open_scene();
  const RunPool pool = pool_of_trials(scene, 500);
  const auto effects = [&] {
    RunPool own = pool;
    return parameter_effects(problem_of(scene), own, Ending::far_edge, {.runs = 300}).effects;
  };
  const auto few = test::on_threads(1, effects), many = test::on_threads(3, effects);
  ASSERT_EQ(few.size(), many.size());
  for (std::size_t i = 0; i < few.size(); ++i)
    EXPECT_EQ(few[i].elasticity.mean, many[i].elasticity.mean);
  const auto run = [&] {
    return analyze(problem_of(scene), analysed_chain(problem_of(scene), pool, &pool.starts.front()),
                   {});
  };
  const Analysis one = test::on_threads(1, run), three = test::on_threads(3, run);
  EXPECT_EQ(one.costs[0].mean, three.costs[0].mean);
  EXPECT_EQ(one.costs[0].interval, three.costs[0].interval);
}

}  // namespace
}  // namespace gatewalk::lattice
