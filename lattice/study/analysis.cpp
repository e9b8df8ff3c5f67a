// SPDX-License-Identifier: MIT
#include "lattice/study/analysis.h"

#include <fmt/core.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include "lattice/field/matrix_file.h"
#include "lattice/pool/reactive_visits.h"
#include "lattice/statistics/group_spread.h"
#include "lattice/statistics/share_95.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

/// The largest number of pairs of a draw and a cell that walks can reach, from the lengths of
/// moves.
double places_reached(const Section& section, const FieldParams& field) {
  std::int64_t side = 0, up = 0;
  bool chequered = true;
  for (const Face& f : section.faces) {
    side = std::max<std::int64_t>(side, std::abs(f.di_x));
    up = std::max<std::int64_t>(up, f.di_y);
    chequered = chequered && (f.di_x + f.di_y) % 2 != 0;
  }
  double places = 0.0;
  for (std::int64_t moves = 0; moves < field.max_gates; ++moves)
    places +=
        std::ceil(static_cast<double>(std::min<std::int64_t>(field.columns, 1 + 2 * side * moves)) *
                  static_cast<double>(std::min<std::int64_t>(field.rows, 1 + up * moves)) /
                  (chequered ? 2.0 : 1.0));
  return places;
}

/// Throws if the states of all cells take too much memory.
void require_memory(const Problem& problem, int states) {
  if (states > most_analysed_states(problem))
    throw std::invalid_argument(
        "analysis: the states of " + std::to_string(problem.field.columns) + " x " +
        std::to_string(problem.field.rows) +
        " gates take more than 8 GiB; ask for fewer states (--accuracy, build --states) or gates");
}

/// True if field and start are their own mirror image: the start cell is in the middle column, and
/// bodies enter it by a face that is its own image.
bool same_in_mirror(const CellMap& map, const FieldParams& field, int start_face) {
  const auto& face = map.section.faces[static_cast<std::size_t>(start_face)];
  if (face.mirror != start_face || 2 * field.start_column() + 1 != field.columns) return false;
  for (int row = 0; row < field.rows; ++row)
    for (int column = 0; column < field.columns; ++column)
      if (map.type_of(column, row) != map.type_of(field.columns - 1 - column, row)) return false;
  return std::all_of(map.types.begin(), map.types.end(),
                     [](const CellMap::Type& type) { return type.symmetric; });
}

markov::Ending mirrored(markov::Ending ending) {
  if (ending == markov::Ending::left_edge) return markov::Ending::right_edge;
  return ending == markov::Ending::right_edge ? markov::Ending::left_edge : ending;
}

/// The overlap of two ranges in the first `coordinates` coordinates; nullopt if it is empty.
std::optional<StateRange> common_part(const StateRange& a, const StateRange& b,
                                      std::size_t coordinates) {
  StateRange both = a;
  for (std::size_t axis = 0; axis < coordinates; ++axis) {
    both.at[axis] = {std::max(a.at[axis][0], b.at[axis][0]),
                     std::min(a.at[axis][1], b.at[axis][1])};
    if (!(both.at[axis][0] < both.at[axis][1])) return {};
  }
  return both;
}

/// Finds the states of one face that overlap a range.
class StatesMeeting {
 public:
  StatesMeeting(const StateSpace& space, int face) : space_(space), face_(face) {
    if (!space.has_trees()) return;
    above_.resize(nodes().size());
    (void)read(0);
  }

  /// The states, in ascending order. The time grows with the number found, not with all states.
  [[nodiscard]] std::vector<int> operator()(const StateRange& range) const {
    std::vector<int> states;
    if (space_.has_trees())
      add_leaves(0, range, states);
    else
      add_bins(0, 0, range, states);
    return states;
  }

 private:
  [[nodiscard]] const std::vector<Tree::Node>& nodes() const {
    return space_.trees()[static_cast<std::size_t>(face_)].nodes;
  }
  /// Reads the part of a tree that begins with this node. Returns where the next part begins.
  std::size_t read(std::size_t at) {
    if (nodes()[at].axis == Tree::kLeaf) {
      above_[at] = static_cast<std::size_t>(space_.first(face_) + leaves_++);
      return at + 1;
    }
    above_[at] = read(at + 1);
    return read(above_[at]);
  }
  void add_leaves(std::size_t at, const StateRange& range, std::vector<int>& states) const {
    const auto& [axis, cut] = nodes()[at];
    if (axis == Tree::kLeaf) {
      states.push_back(static_cast<int>(above_[at]));
      return;
    }
    const auto& [low, high] = range.at[static_cast<std::size_t>(axis)];
    if (low < cut) add_leaves(at + 1, range, states);
    if (high > cut) add_leaves(above_[at], range, states);
  }
  /// Adds bins by the first coordinate, then the next; `before` counts the states of the
  /// coordinates so far.
  void add_bins(std::size_t axis, int before, const StateRange& range,
                std::vector<int>& states) const {
    if (axis == space_.section().coordinates.size()) {
      states.push_back(space_.first(face_) + before);
      return;
    }
    const auto& edges = space_.bins()[static_cast<std::size_t>(face_)].edges[axis];
    const auto bins = static_cast<int>(edges.size()) - 1;
    for (int bin = 0; bin < bins; ++bin)
      if (edges[static_cast<std::size_t>(bin)] < range.at[axis][1] &&
          edges[static_cast<std::size_t>(bin) + 1] > range.at[axis][0])
        add_bins(axis + 1, before * bins + bin, range, states);
  }

  const StateSpace& space_;
  int face_, leaves_ = 0;
  // By node: where the part above its cut begins; of a leaf: its state.
  std::vector<std::size_t> above_;
};

/// The probability of the target by start. If field and start cell are their own mirror image, a
/// start ends in the target as often as its mirror image ends in the target's: the mean of both,
/// where their states overlap.
std::vector<StartChance> chances_of_starts(const AnalysedChain& chain, const CellMap& map,
                                           const FieldParams& field, int start_face,
                                           const ReactiveVisits& passages,
                                           const std::vector<ReactiveVisits>& groups) {
  const ChainWithRewards& c = chain.chain;
  const StateSpace& space = chain.space;
  const markov::Ending target = passages.chance().ending(), image = mirrored(target);
  const bool in_mirror = same_in_mirror(map, field, start_face);
  const markov::Field cells{field.columns, field.rows};
  const std::int64_t first_cell = std::int64_t{c.start.row} * field.columns + c.start.column;
  const markov::Chain& first = c.chain.at(c.start.column, c.start.row);

  struct Chances {
    const StateSpace& space;
    const markov::EndingChance& of_target;
    std::optional<markov::EndingChance> of_image{};  // if the mirror image's target is another one
  };
  std::vector<Chances> all{{space, passages.chance()}};
  for (std::size_t g = 0; g < groups.size(); ++g)
    all.push_back({chain.groups[g].space, groups[g].chance()});
  if (in_mirror && image != target)
    for (std::size_t k = 0; k < all.size(); ++k) {
      const ChainWithRewards& one = k == 0 ? c : chain.groups[k - 1].chain;
      all[k].of_image.emplace(one.chain, cells, image, field.max_gates, markov::kRowTolerance,
                              one.start);
    }
  const auto mean_of = [&](const Chances& s, const Entry& start) {
    const double own = s.of_target(1, first_cell, s.space.index_of(start).state);
    if (!in_mirror) return own;
    const int there = s.space.index_of(dynamics::mirrored(s.space.section(), start)).state;
    return std::midpoint(own, (s.of_image ? *s.of_image : s.of_target)(1, first_cell, there));
  };
  const auto runs_at = [&](int state) { return chain.runs[static_cast<std::size_t>(state)]; };
  const auto gate_runs =
      static_cast<double>(std::accumulate(chain.runs.begin(), chain.runs.end(), std::int64_t{0}));
  std::vector<StartChance> starts;
  constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();
  const auto add = [&](const StateRange& range, bool sampled, std::int64_t runs) {
    const double mean = sampled ? mean_of(all.front(), range.middle()) : kNotKnown;
    starts.push_back({range, {mean, {kNotKnown, kNotKnown}}, runs});
  };
  const StatesMeeting meeting(space, start_face);
  for (int state = 0; state < space.size(); ++state) {
    if (space.face(state) != start_face) continue;
    const StateRange range = space.range(state);
    if (!in_mirror) {
      add(range, first.is_sampled(state), runs_at(state));
      continue;
    }
    for (const int other : meeting(dynamics::mirrored(space.section(), range)))
      if (const auto both =
              common_part(range, dynamics::mirrored(space.section(), space.range(other)),
                          space.section().coordinates.size()))
        add(*both, first.is_sampled(state) && first.is_sampled(other),
            runs_at(state) + runs_at(other));
  }
  const auto told = std::min(std::ssize(starts), kToldStarts);
  if (told < std::ssize(starts)) {
    std::vector<std::size_t> order(starts.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return starts[a].runs > starts[b].runs; });
    std::sort(order.begin(), order.begin() + told);
    std::vector<StartChance> told_first;
    for (const std::size_t i : order) told_first.push_back(starts[i]);
    starts = std::move(told_first);
  }
  tbb::parallel_for(std::ptrdiff_t{0}, all.size() > 1 ? told : 0, [&](std::ptrdiff_t i) {
    StartChance& start = starts[static_cast<std::size_t>(i)];
    if (std::isnan(start.chance.mean)) return;
    const Entry middle = start.range.middle();
    std::vector<double> parts;
    for (std::size_t k = 1; k < all.size(); ++k) parts.push_back(mean_of(all[k], middle));
    start.chance.interval =
        share_95(start.chance.mean, parts,
                 {static_cast<double>(runs_at(space.index_of(middle).state)), gate_runs});
  });
  return starts;
}

}  // namespace

double most_analysed_states(const Problem& problem) {
  constexpr double kMostBytes = 8.0 * (1 << 30);
  const Section& section = problem.map().section;
  const FieldParams& field = problem.field;
  const double cells = static_cast<double>(field.columns) * field.rows;
  // Walks before and after a draw, with their costs and the squares of these.
  const double walks = 2.0 * cells * (1.0 + 2.0 * static_cast<double>(section.costs.size()));
  const bool by_steps =
      field.max_gates > 0 || std::any_of(section.faces.begin(), section.faces.end(),
                                         [](const Face& f) { return f.di_y < 0; });
  // Probabilities and passages, and those of all groups, which together have as many states.
  const double numbers =
      (field.max_gates > 0 ? 3.0 * places_reached(section, field) : 4.0 * cells) +
      (by_steps ? 2.0 * walks : 0.0);
  return kMostBytes / (sizeof(double) * numbers);
}

int leaf_of_analysis(const Problem& problem, const RunPool& pool, int per_leaf, int states) {
  constexpr double kOthers = 100.0;  // of the start, and of faces with few entries
  const double most = most_analysed_states(problem) - kOthers;
  if (states <= most) return per_leaf;
  const double runs = 2.0 * static_cast<double>(pool.gate_runs());  // with mirror images
  return std::max(per_leaf, static_cast<int>(std::ceil(runs / most)));
}

std::string Analysis::why_unfinished() const {
  constexpr double kHardlyAny = 1e-6;
  if (!(totals.remainder > kHardlyAny)) return "";
  return fmt::format("{:.2g} % of the walks are under way after all moves that are added up",
                     100.0 * totals.remainder);
}

namespace {

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

/// After sums that were stopped: the walks still under way may add any number.
markov::WalkTotals not_known(markov::WalkTotals t) {
  t.endings.fill(kNotKnown);
  t.visits.setConstant(kNotKnown);
  t.draws.fill({kNotKnown, kNotKnown, kNotKnown});
  for (auto& by_ending : t.totals) by_ending.fill({kNotKnown, kNotKnown, kNotKnown});
  return t;
}

}  // namespace

Analysis analyze(const Problem& problem, const AnalysedChain& chain, const AnalysisOptions& options,
                 const Work& work) {
  const Stopwatch watch;
  const CellMap& map = problem.map();
  const FieldParams& field = problem.field;
  const ChainWithRewards& c = chain.chain;
  const StateSpace& space = chain.space;
  const markov::Field cells{field.columns, field.rows};

  require_memory(problem, c.chain.inputs());
  // All groups together take as long as the whole.
  constexpr std::int64_t kParts = 1000;
  std::mutex telling;
  double done = 0.0;
  const auto tell = [&](double weight) {
    return [&, weight](double part) {
      const std::lock_guard lock(telling);
      done += weight * part / static_cast<double>(kTrialGroups + std::ssize(chain.groups));
      work.tell("analysis", std::llround(kParts * done), kParts);
    };
  };
  work.tell("analysis", 0, kParts);
  const auto all = all_reactive_visits(
      chain, field, options.target, {.told = tell(kTrialGroups)},
      {.places = false, .tolerance = kGroupTolerance, .told = tell(1.0)}, "analysis", {});
  const ReactiveVisits& passages = all.whole;
  const auto& groups = all.groups;
  markov::FrequentPaths paths;
  std::optional<LumpedChain> lumped;
  tbb::parallel_invoke(
      [&] {
        paths = markov::most_frequent_paths(c.chain, cells, c.start, field.max_gates,
                                            passages.chance(), options.paths);
      },
      [&] { lumped = lumped_chain(chain, map, field, passages, options.lumping); });

  Analysis out{.target = options.target,
               .target_chance = passages.at_start(),
               .by_groups = !groups.empty(),
               .totals = passages.totals(),
               .paths = std::move(paths),
               .passed = markov::CellProbabilities::Zero(field.rows, field.columns),
               .space = space,
               .lumping = options.lumping,
               .lumped = lumped};

  // Over the bodies with this ending, or over all bodies.
  const auto of_totals = [&](std::optional<std::size_t> ending, const auto& value) {
    const auto share = [&](const markov::WalkTotals& t) {
      return ending ? t.endings[*ending] : 1.0;
    };
    const auto bodies = static_cast<double>(chain.bodies);
    std::vector<double> parts;
    RunsBehind runs{bodies * share(out.totals), {}};
    for (const ReactiveVisits& g : groups) {
      parts.push_back(value(g.totals()));
      runs.groups.push_back(bodies / kTrialGroups * share(g.totals()));
    }
    return mean_95(value(out.totals), parts, runs);
  };
  const std::string unfinished = out.why_unfinished();
  if (!unfinished.empty()) out.totals = not_known(std::move(out.totals));
  out.gates = of_totals({}, [](const markov::WalkTotals& t) { return t.visits.sum(); });
  for (std::size_t k = 0; k < map.section.costs.size(); ++k) {
    out.costs.push_back(of_totals({}, [k](const markov::WalkTotals& t) {
      return markov::WalkTotals::all(t.totals[k]).mean();
    }));
    for (std::size_t e = 0; e < markov::kEndings; ++e)
      out.costs_of[e].push_back(
          of_totals(e, [k, e](const markov::WalkTotals& t) { return t.totals[k][e].mean(); }));
  }
  if (!unfinished.empty()) out.gates.why_none = unfinished;
  if (!out.costs.empty() && std::isfinite(out.costs[0].mean))
    out.walks = markov::timed_walks(c.chain, cells, c.start, field.max_gates, c.rewards,
                                    options.timed_walks, options.seed);

  std::vector<double> type_share(map.types.size(), 0.0);
  for (int row = 0; row < field.rows; ++row)
    for (int column = 0; column < field.columns; ++column)
      type_share[static_cast<std::size_t>(map.type_of(column, row))] +=
          1.0 / (static_cast<double>(field.rows) * field.columns);
  try {
    out.endless = markov::quasi_stationary(c.chain, type_share);
    out.endless_boundaries.assign(space.section().faces.size(), 0.0);
    for (int state = 0; state < space.size(); ++state)
      out.endless_boundaries[static_cast<std::size_t>(space.face(state))] +=
          out.endless->states[static_cast<std::size_t>(state)];
  } catch (const std::runtime_error& e) {
    out.why_not_endless = e.what();
  }

  out.starts = chances_of_starts(chain, map, field, problem.start.face, passages, groups);

  out.types.resize(map.types.size());
  const auto trapped_shares_of = trapped_shares(c.chain);
  const bool is_reached = out.target_chance > 0.0,
             of_trapped = options.target == markov::Ending::trapped;
  if (is_reached && !of_trapped) {
    out.trapping = out.passed;
    out.state_trapping.resize(static_cast<std::size_t>(space.size()));
    out.type_trapping.resize(map.types.size());
  }
  passages.each([&](const ReactiveVisits::Place& place, double visits) {
    const auto type =
        static_cast<std::size_t>(map.type_of(static_cast<int>(place.cell % field.columns),
                                             static_cast<int>(place.cell / field.columns)));
    const double trapped = trapped_shares_of[type][static_cast<std::size_t>(place.input)];
    out.types[type].visits += visits;
    out.types[type].trapped += visits * trapped;
    if (!is_reached) return;
    const double part = visits * passages.chance(place) / out.target_chance;
    out.passed.data()[place.cell] += part;
    if (of_trapped || trapped >= 1.0) return;  // no body continues from there
    const double effect = part * trapped / (1.0 - trapped);
    out.trapping.data()[place.cell] += effect;
    out.type_trapping[type] += effect;
    if (place.input < space.size())
      out.state_trapping[static_cast<std::size_t>(shown_number(space, place.input))] += effect;
  });
  if (!unfinished.empty()) {
    out.passed.setConstant(kNotKnown);
    out.trapping.setConstant(kNotKnown);
    std::fill(out.state_trapping.begin(), out.state_trapping.end(), kNotKnown);
    std::fill(out.type_trapping.begin(), out.type_trapping.end(), kNotKnown);
    for (auto& type : out.types) type.visits = type.trapped = kNotKnown;
  }
  out.endings = options.endings.value_or(out.totals.endings);
  if (options.endings) {
    out.target_chance = out.endings[static_cast<std::size_t>(options.target)];
    constexpr auto kTrapped = static_cast<std::size_t>(markov::Ending::trapped);
    for (Analysis::Type& type : out.types)
      if (out.totals.endings[kTrapped] > 0.0)
        type.trapped *= out.endings[kTrapped] / out.totals.endings[kTrapped];
  }
  out.seconds = watch.seconds();
  return out;
}

}  // namespace gatewalk::lattice
