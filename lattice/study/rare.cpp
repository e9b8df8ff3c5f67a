// SPDX-License-Identifier: MIT
#include "lattice/study/rare.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "dynamics/base/kept_pieces.h"
#include "dynamics/base/share.h"
#include "lattice/field/gate_chain.h"
#include "lattice/pool/kernel.h"
#include "lattice/pool/pool_runner.h"
#include "lattice/study/trials.h"
#include "markov/committor.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

// A body whose weight is within this factor of its intended weight stays as it is.
constexpr double kWindow = 2.0;
constexpr double kAbove95 = 0.025;  // probability beyond each end of a two-sided 95 % interval

constexpr int kMostCopies = 100;  // most bodies that one entry is split into
/// Most bodies per trial; beyond, none is split, which only costs accuracy.
constexpr std::uint64_t kMostOfTrial = std::uint64_t{1} << 20;

/// A body with its weight.
struct Weighted {
  std::int64_t trial = 0;  // index in the block
  int column = 0, row = 0;
  double weight = 1.0;
  Body body;
};

/// What all trials of a call share.
struct Aim {
  const CellField& cells;
  int columns, start_row, target;
  double start_value;
  const EntryValue& value;
  std::uint64_t seed, row;  // of the streams
};

/// The bodies of one trial.
class SplitTrial {
 public:
  SplitTrial(const Aim& aim, std::int64_t number)
      : aim_(aim),
        number_(static_cast<std::uint64_t>(number)),
        chance_(random()),
        entered_(static_cast<std::size_t>(aim.target - aim.start_row), 0.0) {}

  [[nodiscard]] Random random() {
    return {Purpose::rare, {aim_.seed, aim_.row, number_ * kMostOfTrial + streams_++}};
  }
  /// Weight that entered each row from the first one ahead of the start's to the target.
  [[nodiscard]] const std::vector<double>& entered() const { return entered_; }

  /// Takes a body's passage, and adds to `next` the bodies that continue from it.
  void take(const Weighted& before, const Passage& passage, std::vector<Weighted>& next) {
    if (passage.fate != Fate::left) return;
    const Entry& entry = passage.next;
    const Face& move = aim_.cells.map.section.faces[static_cast<std::size_t>(entry.face)];
    const int column = before.column + move.di_x, row = before.row + move.di_y;
    if (column < 0 || column >= aim_.columns) return;
    if (move.di_y > 0)
      entered_[static_cast<std::size_t>(row - aim_.start_row) - 1] += before.weight;
    if (row == aim_.target) return;
    Weighted body = before;
    body.column = column;
    body.row = row;
    const double worth = aim_.value(column, row, entry);
    if (!(worth > 0.0)) throw std::invalid_argument("splitting: a value is not positive");
    const double parts = body.weight * worth / aim_.start_value;
    const bool within = parts >= 1.0 / kWindow && parts <= kWindow;
    if (within || streams_ + kMostCopies >= kMostOfTrial) {
      next.push_back(body);
      return;
    }
    const double whole = std::floor(std::min(parts, double{kMostCopies}));
    const bool too_many = parts > kMostCopies;
    const int copies =
        static_cast<int>(whole) + (!too_many && chance_.uniform() < parts - whole ? 1 : 0);
    body.weight /= too_many ? whole : parts;
    const Cell& cell_before = aim_.cells.at(before.column, before.row);
    for (int copy = 0; copy < copies; ++copy) {
      next.push_back(body);
      if (copy > 0) cell_before.fork(next.back().body, random());
    }
  }

 private:
  const Aim& aim_;
  std::uint64_t number_, streams_ = 0;
  Random chance_;  // for rounding numbers of bodies
  std::vector<double> entered_;
};

/// The results of some trials, one trial after the other.
struct SplitPiece {
  std::vector<double> entered{};  // (trials x rows) weight that entered each row
  Health health{};
};
template <class Archive>
void each_part(Archive& archive, SplitPiece& piece) {
  archive(piece.entered, piece.health);
}

/// Sums over trials, in the order of the trials.
struct Sums {
  std::vector<double> sum, squares;
  std::int64_t trials = 0;

  explicit Sums(std::size_t rows) : sum(rows, 0.0), squares(rows, 0.0) {}
  void add(const std::vector<double>& entered) {
    ++trials;
    for (std::size_t r = 0; r < entered.size(); ++r) {
      sum[r] += entered[r];
      squares[r] += entered[r] * entered[r];
    }
  }
  [[nodiscard]] RowChance chance(std::size_t r) const {
    const auto n = static_cast<double>(trials);
    const double mean = sum[r] / n;
    if (!(mean > 0.0)) return {0.0, std::numeric_limits<double>::quiet_NaN(), none_seen(r), trials};
    const double variance = std::max(0.0, squares[r] / n / mean / mean - 1.0);
    return {.probability = mean,
            .relative_standard_error = std::sqrt(variance / (n - 1.0)),
            .trials = trials};
  }

 private:
  /// Upper bound on the probability of a row that no body entered; 2.5 % may lie above. If none of
  /// m independent trials shows an event of probability g, then g <= 1 - 0.025^(1/m). Rows are
  /// entered one after the other, so the probability is at most that of the last row seen times g.
  /// For m use the effective number of trials that reached that row, (sum w)^2 / sum w^2 (Kish,
  /// Survey Sampling, 1965), because the bodies of a trial are not independent. Each factor gets
  /// half of the 2.5 %.
  [[nodiscard]] double none_seen(std::size_t r) const {
    const auto at_most = [](double above, double m) { return -std::expm1(std::log(above) / m); };
    while (r > 0 && !(sum[r - 1] > 0.0)) --r;
    if (r == 0) return at_most(kAbove95, static_cast<double>(trials));
    constexpr double kNormalAboveHalf = 2.241402727604947;  // 1.25 % lie above
    const RowChance seen = chance(r - 1);
    const double factor = std::exp(kNormalAboveHalf * seen.relative_standard_error);
    return std::min(1.0, seen.probability * factor) *
           at_most(0.5 * kAbove95, sum[r - 1] * sum[r - 1] / squares[r - 1]);
  }
};

}  // namespace

std::array<double, 2> RowChance::interval_95() const {
  if (!(probability > 0.0)) return {0.0, at_most};
  const double factor = std::exp(dynamics::kNormal95 * relative_standard_error);
  const std::array of_logarithm{probability / factor, std::min(1.0, probability * factor)};
  if (probability <= 0.5) return of_logarithm;
  const auto [low, high] =
      dynamics::interval_of_share(std::min(1.0, probability), static_cast<double>(trials));
  return {std::min(low, of_logarithm[0]), std::max(high, of_logarithm[1])};
}

Problem up_to_row(const Problem& problem, int row) {
  Problem deep = problem;
  deep.field = up_to_row(problem.field, row);
  std::vector<int>& types = deep.cells.map.type_of_cell;
  if (types.empty()) return deep;
  if (row > problem.field.rows)
    throw std::invalid_argument(
        problem.source + ": the map has " + std::to_string(problem.field.rows) +
        " rows; the row to enter (--row) must be at most " + std::to_string(problem.field.rows));
  types.resize(static_cast<std::size_t>(deep.field.columns) *
               static_cast<std::size_t>(row));  // the near rows
  return deep;
}

namespace {

void require_splittable(const Problem& problem) {
  if (problem.is_recorded())
    throw std::invalid_argument(problem.source +
                                ": rare needs new runs, which recorded runs do not give");
  for (const Face& face : problem.map().section.faces)
    if (face.di_y < 0)
      throw std::invalid_argument(problem.source + ": bodies may move back by face " + face.name +
                                  ": a body that enters a row again would be counted twice, so "
                                  "rare cannot be asked of such cells");
}

}  // namespace

Splitting split(const Problem& problem, double start_value, const EntryValue& value,
                const SplittingOptions& options, const Work& work) {
  require_splittable(problem);
  const Problem deep = up_to_row(problem, options.row);
  const CellField& cells = deep.cells;
  if (!(start_value > 0.0)) throw std::invalid_argument("splitting: a value is not positive");
  const Cell& first = cells.at(deep.field.start_column(), deep.field.start_row);
  const int start_row = deep.field.start_row;
  const auto rows = static_cast<std::size_t>(options.row - start_row);
  Splitting result{.rows = {}, .first_row = start_row + 1, .health = {}};
  Sums sums(rows);
  const Aim aim{
      cells,        deep.field.columns,         start_row, options.row, start_value, value,
      options.seed, first.stream_of(deep.start)};
  /// Runs each body's passage through its cell, those in cells of one type together.
  const auto run_all = [&](std::vector<Weighted>& bodies, Health& health) {
    std::vector<Passage> passages(bodies.size());
    std::vector<std::vector<std::size_t>> of_type(cells.cells.size());
    for (std::size_t i = 0; i < bodies.size(); ++i)
      of_type[static_cast<std::size_t>(cells.map.type_of(bodies[i].column, bodies[i].row))]
          .push_back(i);
    for (std::size_t type = 0; type < of_type.size(); ++type) {
      const std::vector<std::size_t>& wave = of_type[type];
      carry_out_trials(
          *cells.cells[type], std::ssize(wave),
          [&](Body& body) {
            const Body& waiting = bodies[wave[static_cast<std::size_t>(body.trial)]].body;
            body.entry = waiting.entry;
            body.random = waiting.random;
            body.carried = waiting.carried;
          },
          [&](Body& body, const Passage& passage) {
            const std::size_t i = wave[static_cast<std::size_t>(body.trial)];
            passages[i] = passage;
            bodies[i].body = body;
            return false;
          },
          health);
    }
    return passages;
  };
  Stage stage{"split trials", {}};
  // All bodies of a block run through one gate at a time, so that many run together.
  const auto run_block = [&](TrialRange range) {
    SplitPiece piece;
    std::vector<SplitTrial> trials;
    std::vector<Weighted> bodies, next;
    for (std::int64_t i = 0; i < range.count; ++i) {
      SplitTrial& t = trials.emplace_back(aim, range.first + i);
      Body body{.entry = deep.start, .random = t.random()};
      first.begin(body);
      bodies.push_back({i, deep.field.start_column(), start_row, 1.0, body});
    }
    while (!bodies.empty()) {
      work.tell(stage.what, range.first - stage.items.first, stage.items.count);
      const std::vector<Passage> passages = run_all(bodies, piece.health);
      for (std::size_t i = 0; i < bodies.size(); ++i)
        trials[static_cast<std::size_t>(bodies[i].trial)].take(bodies[i], passages[i], next);
      bodies = std::exchange(next, {});
    }
    for (const SplitTrial& t : trials)
      piece.entered.insert(piece.entered.end(), t.entered().begin(), t.entered().end());
    return piece;
  };
  const auto take = [&](const SplitPiece& piece) {
    if (piece.entered.size() % rows != 0)
      throw std::runtime_error("a kept piece has trials to other rows");
    result.health += piece.health;
    for (auto at = piece.entered.begin(); at != piece.entered.end();
         at += static_cast<std::ptrdiff_t>(rows))
      sums.add({at, at + static_cast<std::ptrdiff_t>(rows)});
  };
  // Each round has as many trials as the rounds before suggest, at most eight times the trials so
  // far.
  for (std::int64_t more = options.trials.value_or(SplittingOptions::kFirst); more > 0;) {
    stage = {"split trials", {sums.trials, more}, 0, more};
    in_kept_pieces(work, stage, SplitPiece{}, run_block, take);
    if (options.trials) break;
    const double error = sums.chance(rows - 1).relative_standard_error;
    if (error <= options.accuracy) break;
    const auto n = static_cast<double>(sums.trials);
    const double wanted =
        std::isfinite(error) ? 1.1 * n * std::pow(error / options.accuracy, 2.0) - n : 8.0 * n;
    const double affordable = static_cast<double>(options.most_runs - result.health.runs) * n /
                              static_cast<double>(result.health.runs);
    const double in_vain =
        std::isfinite(error) ? affordable : static_cast<double>(options.most_in_vain) - n;
    more = static_cast<std::int64_t>(
        std::min({std::max(wanted, 0.1 * n), 8.0 * n, affordable, in_vain}));
  }
  result.trials = sums.trials;
  result.reached = sums.chance(rows - 1).relative_standard_error <= options.accuracy;
  result.gate_runs = result.health.runs;
  for (std::size_t r = 0; r < sums.sum.size(); ++r) result.rows.push_back(sums.chance(r));
  if (result.health.broken > 0)
    throw std::runtime_error("splitting: " + std::to_string(result.health.broken) +
                             " gate runs stopped being finite numbers; try method stable or a "
                             "smaller run.step_s");
  return result;
}

namespace {

// Entries per leaf for the values of entries: many, so that no leaf is far off by chance. (The
// chain's own answer has leaves of fewer entries.)
constexpr int kPerLeafOfValues = 40;
// The least value, relative to the largest of its row: bodies that the chain considers lost keep
// some chance.
constexpr double kLeastValue = 0.02;

/// Trials for the chain; fewer if kAtTarget of them reach the target: for a way that bodies often
/// take, an eighth of the trials suffices.
constexpr std::int64_t kPoolTrials = 60'000, kFewestPoolTrials = kPoolTrials / 8, kAtTarget = 200;

/// The pool of a field: full trials from its start, with about `most_runs` gate runs at most.
class Pool {
 public:
  Pool(const Problem& problem, std::int64_t most_runs, std::uint64_t seed, const Work& work)
      : seed_(seed), work_(work) {
    pool_.starts.push_back({.start = problem.start});
    const std::vector<int>& map = problem.map().type_of_cell;
    if (map.empty()) {
      run_until_known(problem, most_runs);
    } else {
      run_in(problem, kPoolTrials / 2, most_runs / 2);
      const std::set<int> types(map.begin(), map.end());
      const std::int64_t parts = 2 * std::ssize(types);
      for (const int type : types) {
        Problem plain = problem;
        std::vector<int>& cells = plain.cells.map.type_of_cell;
        std::fill(cells.begin(), cells.end(), type);
        const auto start = static_cast<std::size_t>(
            problem.field.start_row * problem.field.columns + problem.field.start_column());
        cells[start] = map[start];
        run_in(plain, kPoolTrials / parts, most_runs / parts);
      }
    }
    if (problem.check) problem.check(std::ssize(start().full.passed), seed, health_, work);
  }

  /// The kernel with at least `per_leaf` entries per leaf.
  [[nodiscard]] Kernel kernel(const CellMap& map, int per_leaf) const {
    return kernel_of(map, pool_, per_leaf);
  }
  /// The chain in the field of `problem`, which has the same types of cells.
  [[nodiscard]] markov::FieldChain chain(const Kernel& kernel, const Problem& problem) const {
    const CellMap& map = problem.map();
    return chain_of(kernel, map, problem.field,
                    first_rows(kernel, map, pool_, {&start()}, problem.start_type()));
  }
  [[nodiscard]] std::int64_t gate_runs() const { return gate_runs_; }
  [[nodiscard]] const Health& health() const { return health_; }

 private:
  [[nodiscard]] const OwnRuns& start() const { return pool_.starts.front(); }

  // Trials from which a runner knows the gates per trial.
  static constexpr std::int64_t kFirst = 100;

  void run_in(const Problem& problem, std::int64_t trials, std::int64_t most_runs) {
    PoolRunner runner(problem, seed_, most_runs, work_);
    runner.run_full(pool_.starts.front(), kFirst);
    if (runner.may_go_on()) runner.run_full(pool_.starts.front(), trials - kFirst);
    add(runner);
  }
  /// Doubles the number of trials until the way to the target is known; stops earlier if no body
  /// leaves the first gate.
  void run_until_known(const Problem& problem, std::int64_t most_runs) {
    PoolRunner runner(problem, seed_, most_runs, work_);
    const auto& endings = start().full.endings;
    runner.run_full(pool_.starts.front(), kFirst);
    for (std::int64_t trials = kFewestPoolTrials; trials <= kPoolTrials && runner.may_go_on();
         trials *= 2) {
      runner.run_full(pool_.starts.front(), trials - std::ssize(endings));
      if (std::count(endings.begin(), endings.end(), markov::Ending::far_edge) >= kAtTarget ||
          runner.gates_per_trial() == 1.0)
        break;
    }
    add(runner);
  }
  void add(const PoolRunner& runner) {
    gate_runs_ += runner.gate_runs;
    health_ += runner.health;
  }

  std::uint64_t seed_;
  const Work& work_;
  RunPool pool_;
  std::int64_t gate_runs_ = 0;
  Health health_;
};

}  // namespace

RareEvent rare_event(const Problem& problem, const SplittingOptions& options, const Work& work) {
  const Stopwatch watch;
  require_splittable(problem);
  const Problem deep = up_to_row(problem, options.row);
  const CellMap& map = deep.map();
  const Pool pool(deep, options.most_runs / 4, options.seed, work);
  RareEvent event{.splitting = {}, .chain = {}, .pool_runs = pool.gate_runs()};
  work.tell("chain", 0, 2);
  {
    const markov::FieldChain chain = pool.chain(pool.kernel(map, kEntriesPerLeaf), deep);
    event.chain =
        markov::row_chances(chain, {deep.field.columns, deep.field.rows},
                            {deep.field.start_column(), deep.field.start_row, chain.inputs() - 1});
  }
  event.chain_seconds = watch.seconds();
  work.tell("chain", 1, 2);

  // The values of entries come from a chain with larger leaves, which reaches every row that the
  // fine chain reaches. Entries into rows beyond all have the same value.
  const Kernel kernel = pool.kernel(map, kPerLeafOfValues);
  const auto first_unknown = std::find(event.chain.begin(), event.chain.end(), 0.0);
  const auto ahead = static_cast<int>(first_unknown - event.chain.begin());
  const int known = ahead > 0 ? deep.field.start_row + ahead : 0;  // rows whose values are known
  markov::Committor values;
  std::vector<double> least;  // by row
  if (known > 0) {
    const Problem part = up_to_row(deep, known);
    values = markov::committor(pool.chain(kernel, part), {part.field.columns, known});
    const std::ptrdiff_t of_row = std::ptrdiff_t{values.columns} * values.inputs;
    for (auto row = values.values.begin(); row != values.values.end(); row += of_row)
      least.push_back(kLeastValue * *std::max_element(row, row + of_row));
  }
  const auto worth = [&](int column, int row, int state) {
    return row < known ? std::max(values(column, row, state), least[static_cast<std::size_t>(row)])
                       : 1.0;
  };
  event.splitting = split(
      deep, worth(deep.field.start_column(), deep.field.start_row, values.inputs - 1),
      [&](int column, int row, const Entry& entry) {
        return worth(column, row, kernel.space.index_of(entry).state);
      },
      options, work);
  event.splitting.health += pool.health();
  event.seconds = watch.seconds();
  return event;
}

DirectRows direct_rows(const Problem& problem, std::int64_t trials, std::uint64_t seed,
                       const dynamics::Work& work) {
  const dynamics::Stopwatch watch;
  const FieldTally tally = field_trials(problem, {0, trials}, seed, work);
  DirectRows direct{.trials = trials, .entered = {}, .seconds = watch.seconds()};
  const int rows = problem.field.rows, first = problem.field.start_row + 1;
  direct.entered.assign(static_cast<std::size_t>(rows - first + 1),
                        tally.endings[static_cast<std::size_t>(markov::Ending::far_edge)]);
  // Final gates in later rows, including those of bodies that left over the far edge.
  std::int64_t behind = 0;
  for (int row = rows - 1; row >= first; --row) {
    behind += tally.final_cells.row(row).sum();
    direct.entered[static_cast<std::size_t>(row - first)] = behind;
  }
  return direct;
}

}  // namespace gatewalk::lattice
