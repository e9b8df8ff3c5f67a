// SPDX-License-Identifier: MIT
#include "lattice/pool/tree_chain.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lattice/field/running_trial.h"
#include "lattice/pool/assumptions.h"
#include "lattice/pool/hausman_check.h"
#include "lattice/pool/pool_answers.h"
#include "lattice/statistics/compare.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

/// Answers for the starts, or, without starts, for bodies from anywhere in the range.
std::vector<markov::FinalDistribution> answers(const Problem& problem, const RunPool& pool,
                                               const Kernel& kernel, std::uint64_t seed) {
  const CellMap& map = problem.map();
  std::vector<FirstRow> starts;
  for (const OwnRuns& s : pool.starts) starts.emplace_back(&s);
  if (starts.empty()) starts.emplace_back();
  return answers_of(kernel, map, first_rows(kernel, map, pool, starts, problem.start_type()),
                    problem.field, seed)
      .final;
}

/// Makes leaves larger, until there are at most `most` states.
void limit_states(TreeChain& chain, const Problem& problem, int most, std::uint64_t seed) {
  const auto faces = std::ssize(chain.kernel.space.trees());
  if (most < faces)
    throw std::invalid_argument("a chain has " + std::to_string(faces) +
                                " states at least, one for each way to enter a gate; " +
                                std::to_string(most) + " are too few");
  const Kernel full = chain.kernel;
  while (chain.kernel.space.size() > most) {
    const double times = static_cast<double>(chain.kernel.space.size()) / most;
    chain.per_leaf = std::max(chain.per_leaf + 1,
                              static_cast<int>(std::ceil(chain.per_leaf * std::sqrt(times))));
    chain.kernel = kernel_of(problem.map(), chain.pool, chain.per_leaf);
  }
  if (chain.kernel.space.size() == full.space.size()) return;
  const auto before = answers(problem, chain.pool, full, seed),
             after = answers(problem, chain.pool, chain.kernel, seed);
  for (std::size_t i = 0; i < before.size(); ++i)
    chain.states_bias =
        std::max(chain.states_bias, total_variation(before[i].final_cells, after[i].final_cells));
}

/// The matrices with the starts of these trials as states of their own.
std::vector<Transitions> transitions_with(const Problem& problem, const RunPool& pool,
                                          const Kernel& kernel,
                                          const std::vector<const OwnRuns*>& own) {
  std::vector<Entry> starts;
  for (const OwnRuns* s : own) starts.push_back(s->start);
  const CellMap& map = problem.map();
  return transitions_of(
      kernel, map, problem.field, starts,
      first_rows(kernel, map, pool, {own.begin(), own.end()}, problem.start_type()));
}

/// Checks the final chain: against all full trials of the pool, and its assumptions.
void check(TreeChain& chain, const Problem& problem, std::uint64_t seed) {
  const RunPool& pool = chain.pool;
  std::vector<const FieldTrials*> trials;
  std::vector<FirstRow> starts;
  const auto add = [&](const FieldTrials& of, const FirstRow& start) {
    if (of.endings.empty()) return;
    trials.push_back(&of);
    starts.push_back(start);
  };
  add(pool.scattered.each, {});
  for (const OwnRuns& s : pool.starts) add(s.full, &s);
  const CellMap& map = problem.map();
  const KernelAnswers said = answers_of(
      chain.kernel, map, first_rows(chain.kernel, map, pool, starts, problem.start_type()),
      problem.field, seed);
  if (said.walks > 0) return;
  std::vector<TrialsAndChain> all;
  for (std::size_t i = 0; i < trials.size(); ++i) all.push_back({*trials[i], said.final[i]});
  chain.hausman_check = hausman_check(all, problem.field, seed);
  const bool is_the_predictions = chain.prediction && !chain.range && chain.states_bias == 0.0 &&
                                  chain.prediction->starts.size() == 1 &&
                                  !chain.prediction->starts.front().from_trials;
  chain.assumptions = is_the_predictions
                          ? chain.prediction->assumptions
                          : check_assumptions(map, problem.field, pool, starts, chain.per_leaf,
                                              coordinates_cut(chain.kernel.space), seed);
}

}  // namespace

TreeChain make_tree_chain(const Problem& problem, const TreeOptions& options, const Work& work) {
  if (options.starts.empty() && !options.range)
    throw std::invalid_argument("a chain needs a start, or a range of starts");
  RunPool pool;
  std::optional<PooledRange> range;
  std::optional<PooledPrediction> prediction;
  if (options.range) {
    AccuracyOptions part = options.accuracy;
    part.accuracy *= 1.2 * kPartForOne;
    range = pool_range(problem, pool, *options.range, part, work);
  }
  if (!options.starts.empty()) {
    AccuracyOptions rest = options.accuracy;
    if (range) rest.most_runs = std::max<std::int64_t>(1, rest.most_runs - range->gate_runs);
    prediction = predict_pooled(problem, pool, options.starts, rest, work);
  }
  Kernel kernel = kernel_of(problem.map(), pool, options.accuracy.per_leaf);
  TreeChain chain{.pool = std::move(pool),
                  .kernel = kernel,
                  .transitions = {},
                  .per_leaf = options.accuracy.per_leaf,
                  .prediction = std::move(prediction),
                  .range = std::move(range)};
  if (options.most_states)
    limit_states(chain, problem, *options.most_states, options.accuracy.seed);
  check(chain, problem, options.accuracy.seed);
  if (chain.prediction) {  // these belong to the chain before states were limited
    chain.prediction->hausman_check = {};
    chain.prediction->assumptions = {};
  }
  std::vector<const OwnRuns*> own;
  for (const OwnRuns& s : chain.pool.starts) own.push_back(&s);
  chain.transitions = transitions_with(problem, chain.pool, chain.kernel, own);
  if (chain.range) chain.transitions.front().health += chain.range->health;
  if (chain.prediction) chain.transitions.front().health += chain.prediction->health;
  return chain;
}

// ---- Runs in a file ----

namespace {

struct RunArray {
  std::string name, unit, meaning;
  bool whole = false;
  std::vector<std::string> codes{};
};
const RunArray kTrialRuns{"trial_runs", "1",
                          "gate runs of each trial, one after the other in run_*", true},
    kTrialKind{"trial_kind",
               "1",
               "where each trial started: anywhere, or a start of its own (point_*); through the "
               "field, or one gate only",
               true,
               {"from_anywhere", "from_its_start_through_the_field", "from_its_start_one_gate"}},
    // Only if there are several types.
    kRunType{kRunTypes, "1",
             "type of the gate of each run: 0 the scene's own, then those of its terrain that are "
             "not like one before, by name",
             true},
    // Only if trials start by other faces than the first.
    kTrialFace{"trial_face", "1", "by which face each trial started, numbered as run_boundary",
               true},
    // Only if a body made several trials.
    kTrialBody{"trial_body", "1", "number of the body that made each trial", true};

/// How a run ended, by number: its fate, or the move to the next cell. Files made before other
/// cells than gates were supported have only the first four.
const std::vector<std::string> kRunEndings{"traversed", "exited_left", "exited_right",
                                           "trapped",   "moved_back",  "lost_from_sight"};
constexpr int kTrapped = 3, kBroken = 5;

int ending_of(const Section& section, const CellPassage& passage) {
  if (passage.fate != Fate::left) return passage.fate == Fate::trapped ? kTrapped : kBroken;
  const Face& move = section.faces[static_cast<std::size_t>(passage.entry.face)];
  if (move.di_y != 0) return move.di_y > 0 ? 0 : 4;
  return move.di_x < 0 ? 1 : 2;
}

/// `others`: some runs ended in a way that gate runs do not have.
RunArray ending_array(bool others) {
  return {"run_ending",
          "1",
          "how each gate run ended",
          true,
          {kRunEndings.begin(), others ? kRunEndings.end() : kRunEndings.begin() + kTrapped + 1}};
}

RunArray face_array(const Section& section) {
  RunArray array{"run_boundary", "1", "how it entered the next gate (of no meaning if trapped)",
                 true};
  for (const Face& face : section.faces) array.codes.push_back(face.name);
  return array;
}
/// Arrays of where each trial started, by coordinate.
std::vector<RunArray> start_arrays(const Section& section) {
  std::vector<RunArray> arrays;
  for (const Coordinate& c : section.coordinates)
    arrays.push_back({"trial_" + c.name, c.unit,
                      arrays.empty() ? "where each trial started, on the lower edge of a gate"
                                     : c.words + " there"});
  return arrays;
}
/// Arrays of where each run entered the next gate, by coordinate.
std::vector<RunArray> entry_arrays(const Section& section) {
  std::vector<RunArray> arrays;
  for (const Coordinate& c : section.coordinates)
    arrays.push_back(
        {"run_" + c.name, c.unit,
         (arrays.empty() ? "where on that boundary" : c.words + " there") + " (trapped: 0)"});
  return arrays;
}
/// Arrays of each run's costs; older files have none.
std::vector<RunArray> cost_arrays(const Section& section) {
  std::vector<RunArray> arrays;
  for (const CostInfo& c : section.costs)
    arrays.push_back({"run_" + c.key, c.unit, c.words + ", of each gate run"});
  return arrays;
}

enum Kind : int { kScattered, kFullTrial, kFirstRun };

/// The arrays of runs in a file, filled trial by trial.
struct RunTables {
  const Section& section;
  std::vector<double> trial_runs, trial_kind, trial_face, trial_body;
  std::vector<double> ending, type, face;
  std::vector<std::vector<double>> start, entry;  // by coordinate
  std::vector<std::vector<double>> costs;         // by cost

  explicit RunTables(const Section& of)
      : section(of),
        start(section.coordinates.size()),
        entry(section.coordinates.size()),
        costs(section.costs.size()) {}

  void add(int kind, const Entry& from, const PassageTable::Rows& passages) {
    trial_kind.push_back(kind);
    trial_runs.push_back(static_cast<double>(passages.size()));
    trial_face.push_back(from.face);
    for (std::size_t axis = 0; axis < start.size(); ++axis) start[axis].push_back(from.at[axis]);
    for (const CellPassage p : passages) {
      ending.push_back(ending_of(section, p));
      type.push_back(p.type);
      face.push_back(p.entry.face);
      for (std::size_t axis = 0; axis < entry.size(); ++axis)
        entry[axis].push_back(p.entry.at[axis]);
      for (std::size_t c = 0; c < costs.size(); ++c) costs[c].push_back(p.costs[c]);
    }
  }
};

}  // namespace

std::vector<markov::NamedArray> arrays_of(const RunPool& pool, const Section& section) {
  RunTables t(section);
  for (const OwnRuns& s : pool.starts)
    for (const int kind : {kFullTrial, kFirstRun}) {
      const FieldTrials& trials = kind == kFullTrial ? s.full : s.first;
      for (std::size_t i = 0; i < trials.passed.size(); ++i)
        t.add(kind, s.start, trials.of_trial(i));
    }
  for (std::size_t i = 0; i < pool.scattered.starts.size(); ++i)
    t.add(kScattered, pool.scattered.starts[i], pool.scattered.each.of_trial(i));
  if (!pool.scattered.each.bodies.empty()) {
    t.trial_body.assign(t.trial_runs.size() - pool.scattered.starts.size(), 0.0);
    t.trial_body.insert(t.trial_body.end(), pool.scattered.each.bodies.begin(),
                        pool.scattered.each.bodies.end());
  }
  const auto any = [](const std::vector<double>& values, double above) {
    return std::any_of(values.begin(), values.end(), [=](double x) { return x > above; });
  };
  std::vector<markov::NamedArray> arrays;
  const auto add = [&](const RunArray& array, std::vector<double>& values) {
    const bool of_trial = array.name.starts_with("trial_");
    arrays.push_back({array.name, array.unit, array.meaning, std::move(values),
                      of_trial ? "trial" : "run", array.whole, array.codes});
  };
  const auto add_all = [&](const std::vector<RunArray>& all,
                           std::vector<std::vector<double>>& values) {
    for (std::size_t i = 0; i < all.size(); ++i) add(all[i], values[i]);
  };
  add(kTrialRuns, t.trial_runs);
  add(kTrialKind, t.trial_kind);
  add_all(start_arrays(section), t.start);
  add(ending_array(any(t.ending, kTrapped)), t.ending);
  add(face_array(section), t.face);
  add_all(entry_arrays(section), t.entry);
  add_all(cost_arrays(section), t.costs);
  if (any(t.type, 0.0)) add(kRunType, t.type);
  if (any(t.trial_face, 0.0)) add(kTrialFace, t.trial_face);
  if (!t.trial_body.empty()) add(kTrialBody, t.trial_body);
  return arrays;
}

bool has_runs(const MatrixFile& file) {
  return std::any_of(file.arrays.begin(), file.arrays.end(),
                     [](const markov::NamedArray& a) { return a.name == kTrialRuns.name; });
}

namespace {

const std::vector<double>* find(const MatrixFile& file, const std::string& name) {
  for (const markov::NamedArray& a : file.arrays)
    if (a.name == name) return &a.values;
  return nullptr;
}

/// Reads the arrays of runs in a file, and checks them.
class RunReader {
 public:
  RunReader(const MatrixFile& file, std::size_t types, const std::string& path)
      : file_(file),
        types_(types),
        section_(file.transitions.space.section()),
        path_(path),
        runs_(table(kTrialRuns)),
        kind_(table(kTrialKind)),
        start_(tables(start_arrays(section_))),
        start_face_(find(file, kTrialFace.name)),
        body_(find(file, kTrialBody.name)),
        ending_(table(ending_array(false))),
        type_(find(file, kRunType.name)),
        face_(table(face_array(section_))),
        entry_(tables(entry_arrays(section_))) {
    if (kind_.size() != runs_.size()) refuse("trials");
    for (const auto* t : {start_face_, body_})
      if (t != nullptr && t->size() != runs_.size()) refuse("trials");
    for (const auto* t : start_)
      if (t->size() != runs_.size()) refuse("trials");
    if (face_.size() != ending_.size()) refuse("runs");
    for (const auto* t : entry_)
      if (t->size() != ending_.size()) refuse("runs");
    if (type_ != nullptr && type_->size() != ending_.size()) refuse("runs");
    for (const RunArray& array : cost_arrays(section_)) {
      costs_.push_back(find(file, array.name));
      if (costs_.back() != nullptr && costs_.back()->size() != ending_.size()) refuse("runs");
    }
  }

  [[nodiscard]] RunPool read() {
    RunPool pool;
    for (const Entry& start : file_.transitions.space.points())
      pool.starts.emplace_back().start = start;
    for (std::size_t i = 0; i < runs_.size(); ++i) read_trial(i, pool);
    if (at_ != ending_.size()) refuse("runs of no trial");
    for (const OwnRuns& s : pool.starts)
      if (s.first_runs() == 0) refuse("a start of its own without runs");
    return pool;
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw markov::BadFile(path_ + ": its gate runs do not add up: " + what);
  }
  [[nodiscard]] const std::vector<double>& table(const RunArray& array) const {
    if (const auto* values = find(file_, array.name)) return *values;
    throw markov::BadFile(path_ + ": no table " + array.name);
  }
  using Columns = std::vector<const std::vector<double>*>;
  [[nodiscard]] Columns tables(const std::vector<RunArray>& arrays) const {
    Columns columns;
    for (const RunArray& array : arrays) columns.push_back(&table(array));
    return columns;
  }
  /// `x` as a whole number in [0, end); refuses the file if it is none.
  [[nodiscard]] int whole(double x, double end, const std::string& what) const {
    if (!(x >= 0.0 && x < end && x == std::floor(x))) refuse(what);
    return static_cast<int>(x);
  }
  [[nodiscard]] Entry entry(int face, const Columns& columns, std::size_t i,
                            const std::string& what) const {
    Entry entry{face};
    for (std::size_t axis = 0; axis < columns.size(); ++axis) {
      entry.at[axis] = (*columns[axis])[i];
      if (!std::isfinite(entry.at[axis])) refuse(what);
    }
    return entry;
  }

  void read_trial(std::size_t i, RunPool& pool) {
    const std::string what = "trial " + std::to_string(i + 1);
    const auto faces = static_cast<double>(section_.faces.size());
    const Entry start =
        entry(start_face_ == nullptr ? 0 : whole((*start_face_)[i], faces, what), start_, i, what);
    const int kind = whole(kind_[i], 3, what);
    const int count = whole(runs_[i], static_cast<double>(ending_.size() - at_) + 1.0, what);
    if (count == 0) refuse(what);
    const std::size_t own = pool.place_of(start);
    if (kind != kScattered && own == pool.starts.size()) refuse(what);
    if (kind == kScattered) {
      pool.scattered.starts.push_back(start);
      constexpr double kMostBodies = 1 << 30;
      if (body_ != nullptr)
        pool.scattered.each.bodies.push_back(whole((*body_)[i], kMostBodies, what));
    }
    FieldTrials& trials = kind == kScattered   ? pool.scattered.each
                          : kind == kFullTrial ? pool.starts[own].full
                                               : pool.starts[own].first;
    trials.passages.begin(section_);
    for (int k = 0; k < count; ++k, ++at_) {
      const std::string run = "run " + std::to_string(at_ + 1);
      const int ending = whole(ending_[at_], static_cast<double>(kRunEndings.size()), run);
      const Fate fate = ending == kTrapped  ? Fate::trapped
                        : ending == kBroken ? Fate::broken
                                            : Fate::left;
      if (fate != Fate::left && k + 1 < count) refuse(run);
      const int face = whole(face_[at_], faces, run);
      const int type =
          type_ == nullptr ? 0 : whole((*type_)[at_], static_cast<double>(types_), run);
      Costs costs{};
      for (std::size_t c = 0; c < costs_.size(); ++c)
        costs[c] = costs_[c] == nullptr ? std::nan("") : (*costs_[c])[at_];
      trials.passages.push_back(
          {fate, static_cast<std::uint8_t>(type), entry(face, entry_, at_, run), costs});
      if (ending_of(section_, trials.passages[trials.passages.size() - 1]) != ending) refuse(run);
    }
    trials.passed.push_back(std::ssize(trials.passages));
  }

  const MatrixFile& file_;
  std::size_t types_;  // number of gate types
  const Section& section_;
  const std::string& path_;
  const std::vector<double>&runs_, &kind_;
  Columns start_;
  // null: all by the first face; each trial has its own body
  const std::vector<double>*start_face_, *body_;
  const std::vector<double>& ending_;
  const std::vector<double>* type_;  // null: all runs in gates of the first type
  const std::vector<double>& face_;
  Columns entry_;
  Columns costs_;       // null: an older file, without costs
  std::size_t at_ = 0;  // index of the current run
};

/// Follows trials through a field by their passages, to find where and how they end. Trials that
/// did not run in such a field get no endings.
void find_endings(const CellMap& map, const FieldParams& field, FieldTrials& trials) {
  FieldTrials ended;
  for (std::size_t i = 0; i < trials.passed.size(); ++i) {
    RunningTrial trial(field);
    bool goes_on = true;
    for (const CellPassage p : trials.of_trial(i)) {
      if (!goes_on || p.fate == Fate::broken || p.type != map.type_of(trial.column(), trial.row()))
        return;  // the trial went on where this field ends, or in another gate type
      goes_on = trial.follow(map, field, {p.fate, p.entry, p.costs}, false).has_value();
    }
    if (goes_on) return;
    trial.add_to(ended, field);
  }
  trials.final_gates = std::move(ended.final_gates);
  trials.endings = std::move(ended.endings);
  trials.costs = std::move(ended.costs);
}

/// Moves the trials of starts whose first gate has another type than the start's gate here to the
/// scattered trials.
void scatter_others(RunPool& pool, const CellMap& map, int type) {
  const auto is_other = [&](const OwnRuns& s) {
    const FieldTrials& any = s.full.passages.empty() ? s.first : s.full;
    return any.passages[0].type != type;
  };
  FieldTrials& each = pool.scattered.each;
  each.passages.begin(map.section);
  for (const OwnRuns& s : pool.starts)
    for (const FieldTrials* trials : {&s.full, &s.first})
      for (std::size_t i = 0; i < trials->passed.size() && is_other(s); ++i) {
        for (const CellPassage p : trials->of_trial(i)) each.passages.push_back(p);
        each.passed.push_back(std::ssize(each.passages));
        pool.scattered.starts.push_back(s.start);
      }
  std::erase_if(pool.starts, is_other);
}

}  // namespace

RunPool pool_of(const MatrixFile& file, const Problem& problem, const std::string& path) {
  const CellMap& map = problem.map();
  RunPool pool = RunReader(file, map.types.size(), path).read();
  scatter_others(pool, map, problem.start_type());
  for (OwnRuns& s : pool.starts) find_endings(map, problem.field, s.full);
  return pool;
}

std::vector<Transitions> matrices_of(const Problem& problem, const RunPool& pool,
                                     const std::vector<Entry>& starts, int per_leaf) {
  std::vector<const OwnRuns*> own;
  for (const Entry& entry : starts) {
    const std::size_t place = pool.place_of(entry);
    if (place == pool.starts.size())
      throw std::invalid_argument("matrix: a start has no runs of its own");
    if (std::find(own.begin(), own.end(), &pool.starts[place]) == own.end())
      own.push_back(&pool.starts[place]);
  }
  return transitions_with(problem, pool, kernel_of(problem.map(), pool, per_leaf), own);
}

}  // namespace gatewalk::lattice
