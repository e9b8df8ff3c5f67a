// SPDX-License-Identifier: MIT
#include "lattice/study/fit_data.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "dynamics/cells/tree_space.h"
#include "lattice/field/field_trials.h"
#include "lattice/field/running_trial.h"
#include "lattice/statistics/outcome_model.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

constexpr std::size_t kTimeParts = 8;       // of the observed times, by quantiles
constexpr double kLeastShare = 0.01;        // least share of all trials in a group
constexpr double kMostShare = 0.2;          // limit of that share, however much was observed
constexpr double kByChance = 4.0;           // see least_share
constexpr double kLastRound = 6.0;          // the last round has a sixth of all trials
constexpr double kGroupsOfBeginning = 6.0;  // per beginning of passages
constexpr double kWellInside = 0.01;        // of a face's length

/// The outcomes in an order in which neighbours are alike: by ending, with gates row by row, in
/// alternating directions; or by face.
std::vector<std::size_t> neighbours(const FittedOutcomes& of, const FieldParams& field) {
  std::vector<std::size_t> order;
  const auto columns = static_cast<std::size_t>(field.columns);
  for (std::size_t i = 0; i < of.size() / of.parts(); ++i) {
    std::size_t way = i;
    if (of.gates > 0) {
      const std::size_t row = i % of.gates / columns, column = i % columns;
      if (row % 2 == 1) way = i - column + (columns - 1 - column);
    }
    for (std::size_t part = 0; part < of.parts(); ++part)
      order.push_back(way * of.parts() + (i % 2 == 0 ? part : of.parts() - 1 - part));
  }
  return order;
}

/// Limits between parts with equal numbers of observed times, as far as the times differ.
std::vector<double> time_parts(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  std::vector<double> between;
  for (std::size_t part = 1; part < kTimeParts; ++part) {
    std::size_t at = std::max<std::size_t>(1, part * times.size() / kTimeParts);
    while (at < times.size() && times[at - 1] == times[at]) ++at;
    if (at >= times.size()) break;
    between.push_back(0.5 * (times[at - 1] + times[at]));
  }
  between.erase(std::unique(between.begin(), between.end()), between.end());
  return between;
}

std::size_t time_cost(const Section& section) {
  const auto at = std::find_if(section.costs.begin(), section.costs.end(),
                               [](const CostInfo& cost) { return cost.key == "time_s"; });
  return static_cast<std::size_t>(at - section.costs.begin());
}

/// The number of an outcome: `way`, and its part by time; `seconds`: of a body that left.
std::int32_t outcome(const FittedOutcomes& of, std::size_t way, bool left, double seconds) {
  const auto part =
      left ? std::upper_bound(of.times.begin(), of.times.end(), seconds) - of.times.begin() : 0;
  return static_cast<std::int32_t>(way * of.parts() + static_cast<std::size_t>(part));
}

std::int32_t of_trial(const FittedOutcomes& of, std::size_t ending, std::size_t gate,
                      double seconds) {
  const bool left = std::find(markov::kEdges.begin(), markov::kEdges.end(),
                              static_cast<markov::Ending>(ending)) != markov::kEdges.end();
  return outcome(of,
                 of.gates == 0 ? ending
                 : of.endings  ? ending * of.gates + gate
                               : gate,
                 left, seconds);
}

/// A passage that was seen to its end, with the index of its beginning.
struct Begun {
  Entry from;
  std::uint8_t type = 0;
  bool mirrored = false;  // its mirror image is used instead
  std::size_t begin = 0;
};

std::int32_t of_passage(const FittedOutcomes& of, const Section& section, const Begun& begun,
                        bool left, const Entry& next, double seconds) {
  std::size_t to = of.faces.size();
  if (left)
    to = static_cast<std::size_t>(begun.mirrored ? mirrored(section, next).face : next.face);
  return outcome(of, begun.begin * (of.faces.size() + 1) + to, left, seconds);
}

/// True for the one of an entry and its mirror image that is used.
bool is_told_of(const Section& section, const Entry& entry) {
  const Entry other = mirrored(section, entry);
  return std::pair(entry.face, other.at) <= std::pair(other.face, entry.at);
}

/// Groups beginnings that are alike: leaves of a tree over all entries into a type of cell.
void put_beginnings(std::vector<Begun>& begun, FittedOutcomes& of, const Problem& problem,
                    std::size_t beginnings) {
  const Section& section = problem.map().section;
  const std::size_t types = problem.cells.cells.size();
  const auto per_leaf = static_cast<int>((begun.size() + beginnings - 1) / beginnings);
  for (std::size_t type = 0; type < types; ++type) {
    EntryTable entries(section);
    std::vector<Begun*> these;
    for (Begun& b : begun) {
      if (b.type != type) continue;
      entries.push_back(b.mirrored ? mirrored(section, b.from) : b.from);
      these.push_back(&b);
    }
    std::vector<int> states;
    const StateSpace space = tree_space(section, entries, per_leaf, {}, &states);
    for (std::size_t i = 0; i < these.size(); ++i)
      these[i]->begin = of.begins.size() + static_cast<std::size_t>(states[i]);
    const bool both = std::any_of(these.begin(), these.end(), [](Begun* b) { return b->mirrored; });
    for (int state = 0; state < space.size(); ++state)
      of.begins.push_back((types > 1 ? problem.types[type] + ": " : "") +
                          text_of(section, space.range(state)) + (both ? " or mirrored" : ""));
  }
}

/// Runs passages with the beginnings of recorded ones, taken evenly from a random place in their
/// order, so that each beginning gets its share.
Health carry_out_again(
    const std::vector<Begun>& seen, const CellField& cells, std::uint64_t seed, TrialRange range,
    const std::function<void(std::size_t i, const Begun&, const Passage&)>& take) {
  Random chance(Purpose::fit, {seed, static_cast<std::uint64_t>(range.first), 0});
  const double from = chance.uniform();
  const auto begun_by = [&](std::size_t i) -> const Begun& {
    const double share = (static_cast<double>(i) + from) / static_cast<double>(range.count);
    const auto place = static_cast<std::size_t>(share * static_cast<double>(seen.size()));
    return seen[std::min(place, seen.size() - 1)];
  };
  std::vector<std::vector<std::size_t>> of_type(cells.cells.size());
  for (std::size_t i = 0; i < static_cast<std::size_t>(range.count); ++i)
    of_type[begun_by(i).type].push_back(i);
  Health health;
  for (std::size_t type = 0; type < of_type.size(); ++type) {
    const std::vector<std::size_t>& these = of_type[type];
    if (these.empty()) continue;
    const Cell& cell = *cells.cells[type];
    const auto number = [&](const Body& body) {
      return these[static_cast<std::size_t>(body.trial)];
    };
    carry_out_trials(
        cell, std::ssize(these),
        [&](Body& body) {
          const std::size_t i = number(body);
          begin_trial(cell, begun_by(i).from, seed, range.first + static_cast<std::int64_t>(i),
                      body);
        },
        [&](Body& body, const Passage& passage) {
          take(number(body), begun_by(number(body)), passage);
          return false;
        },
        health);
  }
  return health;
}

void require(bool holds, const std::string& what) {
  if (!holds) throw std::invalid_argument("fit: " + what);
}

}  // namespace

std::size_t FittedOutcomes::size() const {
  if (is_of_passages()) return begins.size() * together();
  return together() * (endings ? markov::kEndings : 1);
}

std::size_t FittedOutcomes::together() const {
  return parts() * (is_of_passages() ? faces.size() + 1 : std::max<std::size_t>(1, gates));
}

double least_share(int numbers, double trials, double observed) {
  return std::max({kLeastShare,
                   static_cast<double>(OutcomeModel::terms(numbers, 2)) / kMostParameters,
                   std::min(kMostShare, kByChance * observed / trials)});
}

FitData trials_to_fit(const Observed& observed, const Problem& problem) {
  const SeenEndings& seen = observed.seen;
  const FieldParams& field = problem.field;
  FitData data;
  FittedOutcomes& of = data.outcomes;
  const bool both = observed.gates_by_ending[0].size() > 0;
  require(both || !(seen.has_gates() && seen.has_endings()),
          "final gates and endings were counted, and not which belong together: give a line for "
          "each trial, or one of the two");
  require(seen.has_gates() || seen.has_endings(), "nothing was counted");
  of.endings = seen.has_endings();
  if (seen.has_gates()) {
    require(seen.final_gates.rows() == field.rows && seen.final_gates.cols() == field.columns,
            "counts are of a field of another size");
    of.gates = static_cast<std::size_t>(seen.final_gates.size());
  }
  const std::size_t time = time_cost(problem.map().section);
  const auto add = [&](const CellCounts& gates) {
    data.seen.insert(data.seen.end(), gates.data(), gates.data() + gates.size());
  };
  if (!observed.timed.empty()) {
    require(time < problem.map().section.costs.size(),
            "these cells do not say how long bodies take");
    std::vector<double> times;
    for (const Observed::Timed& trial : observed.timed)
      if (trial.seconds > 0.0) times.push_back(trial.seconds);
    of.times = time_parts(std::move(times));
    data.seen.assign(of.size(), 0);
    for (const Observed::Timed& trial : observed.timed)
      ++data.seen[static_cast<std::size_t>(of_trial(
          of, trial.ending, static_cast<std::size_t>(std::max<std::int64_t>(0, trial.gate)),
          trial.seconds))];
  } else if (both)
    for (const CellCounts& gates : observed.gates_by_ending) add(gates);
  else if (of.endings)
    data.seen.assign(seen.endings.begin(), seen.endings.end());
  else
    add(seen.final_gates);
  data.order = neighbours(of, field);
  data.run = [of, time](const Problem& at, std::uint64_t seed, TrialRange range,
                        std::span<std::int32_t> ended) {
    FieldTrials done;
    const FieldTally tally = run_field(at.cells, at.field, at.start, seed, range, &done);
    for (std::size_t t = 0; t < ended.size(); ++t)
      ended[t] = done.endings[t] ? of_trial(of, static_cast<std::size_t>(*done.endings[t]),
                                            static_cast<std::size_t>(done.final_gates[t]),
                                            of.times.empty() ? 0.0 : done.costs[t][time])
                                 : -1;
    return tally.health;
  };
  return data;
}

FitData passages_to_fit(const std::vector<EnteredPassage>& seen, int numbers,
                        const ProblemAt& problem_at, std::int64_t trials) {
  std::vector<double> point;  // a point where no symmetry is accidental
  for (int k = 1; k <= numbers; ++k) point.push_back(std::fmod(0.381966 * k, 1.0));
  const Problem problem = problem_at(point);
  const Section& section = problem.map().section;
  const std::size_t time = time_cost(section);
  const auto seconds = [time](const Costs& costs) {
    return time < costs.size() ? costs[time] : 0.0;
  };
  FitData data;
  FittedOutcomes& of = data.outcomes;
  for (const Face& face : section.faces) of.faces.push_back(face.name);
  std::vector<double> times;
  std::vector<Begun> begun;
  std::vector<std::size_t> whole;  // indices of those seen to their end
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const auto& [from, passage] = seen[i];
    if (passage.fate == Fate::broken) continue;
    const auto& usual = section.faces[static_cast<std::size_t>(from.face)].usual.front();
    const Cell& cell = *problem.cells.cells[passage.type];
    data.inside += cell.clearance(from) < -kWellInside * (usual[1] - usual[0]);
    if (passage.fate == Fate::left && time < section.costs.size()) {
      require(std::isfinite(passage.costs[time]), "a passage has no time");
      times.push_back(passage.costs[time]);
    }
    whole.push_back(i);
    begun.push_back({from, passage.type, cell.is_symmetric() && !is_told_of(section, from)});
  }
  require(!begun.empty(), "no passage was seen to its end");
  of.times = time_parts(std::move(times));
  // As many groups as the last round's trials permit, with a few per beginning.
  const double groups = 1.0 / least_share(numbers, static_cast<double>(trials) / kLastRound,
                                          static_cast<double>(begun.size()));
  put_beginnings(begun, of, problem,
                 static_cast<std::size_t>(std::max(1.0, groups / kGroupsOfBeginning)));
  data.seen.assign(of.size(), 0);
  for (std::size_t i = 0; i < begun.size(); ++i) {
    const CellPassage& passage = seen[whole[i]].passage;
    ++data.seen[static_cast<std::size_t>(of_passage(
        of, section, begun[i], passage.fate == Fate::left, passage.entry, seconds(passage.costs)))];
  }
  data.order = neighbours(of, problem.field);
  std::sort(begun.begin(), begun.end(), [](const Begun& a, const Begun& b) {
    return std::tie(a.begin, a.from.at, a.from.face) < std::tie(b.begin, b.from.at, b.from.face);
  });
  data.run =
      [of, section, seconds, begun = std::make_shared<const std::vector<Begun>>(std::move(begun))](
          const Problem& at, std::uint64_t seed, TrialRange range, std::span<std::int32_t> ended) {
        return carry_out_again(*begun, at.cells, seed, range,
                               [&](std::size_t i, const Begun& b, const Passage& passage) {
                                 ended[i] =
                                     passage.fate == Fate::broken
                                         ? -1
                                         : of_passage(of, section, b, passage.fate == Fate::left,
                                                      passage.next, seconds(passage.costs));
                               });
      };
  return data;
}

}  // namespace gatewalk::lattice
