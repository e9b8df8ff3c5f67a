#include "lattice/study/rare.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "dynamics/runs.h"
#include "lattice/gate_chain.h"
#include "lattice/scene/settle.h"
#include "lattice/study/pool_runner.h"
#include "markov/committor.h"

namespace gatewalk::lattice {
namespace {

using namespace dynamics;

// A body whose weight is within this factor of what it should be goes on as it is.
constexpr double kWindow = 2.0;
// Of one entry; and of one trial's: then bodies are no longer split, which costs accuracy only.
constexpr int kMostCopies = 100;
constexpr std::uint64_t kMostOfTrial = std::uint64_t{1} << 20;

struct Body {
  std::int64_t trial = 0;  // of the block
  int column = 0, row = 0;
  double weight = 1.0;
  BodyState from;
  RandomForce force;
};

/// What all trials of a call share.
struct Aim {
  const GateParams& p;
  int columns, target;
  double start_value;
  const EntryValue& value;
  std::uint64_t seed, row;  // of the streams
};

/// What becomes of one trial's bodies.
class Trial {
 public:
  Trial(const Aim& aim, std::int64_t number)
      : aim_(aim),
        number_(static_cast<std::uint64_t>(number)),
        chance_(random()),
        entered_(static_cast<std::size_t>(aim.target), 0.0) {}

  [[nodiscard]] Random random() {
    return {Purpose::rare, {aim_.seed, aim_.row, number_ * kMostOfTrial + streams_++}};
  }
  /// Weight that entered rows 1, 2, ..., (target).
  [[nodiscard]] const std::vector<double>& entered() const { return entered_; }

  /// Takes a body's run, and adds to `next` the bodies that go on from it.
  void take(Body body, const GateRun& run, std::vector<Body>& next) {
    if (run.ending == Ending::trapped || run.ending == Ending::broken) return;
    const Crossing entry = crossing_of(aim_.p, run.ending, run.exit);
    const Move move = move_into(entry.boundary);
    body.column += move.di_x;
    body.row += move.di_y;
    if (body.column < 0 || body.column >= aim_.columns) return;
    if (move.di_y > 0) entered_[static_cast<std::size_t>(body.row) - 1] += body.weight;
    if (body.row == aim_.target) return;
    body.from = shifted_into_next(aim_.p, run.ending, run.exit);
    const double worth = aim_.value(body.column, body.row, entry);
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
    for (int copy = 0; copy < copies; ++copy) {
      next.push_back(body);
      if (copy > 0) next.back().force.go_on_with(random());
    }
  }

 private:
  const Aim& aim_;
  std::uint64_t number_, streams_ = 0;
  Random chance_;  // of rounding numbers of bodies
  std::vector<double> entered_;
};

/// Sums over trials, in their order.
struct Sums {
  std::vector<double> sum, squares;
  std::int64_t trials = 0;

  explicit Sums(int rows)
      : sum(static_cast<std::size_t>(rows), 0.0), squares(static_cast<std::size_t>(rows), 0.0) {}
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
    if (!(mean > 0.0)) return {0.0, std::numeric_limits<double>::quiet_NaN()};
    const double variance = std::max(0.0, squares[r] / n / mean / mean - 1.0);
    return {mean, std::sqrt(variance / (n - 1.0))};
  }
};

}  // namespace

std::array<double, 2> RowChance::interval_95() const {
  constexpr double kSigmas = 1.959964;
  return {std::max(0.0, probability * (1.0 - kSigmas * relative_standard_error)),
          std::min(1.0, probability * (1.0 + kSigmas * relative_standard_error))};
}

Splitting split(const Scene& scene, double start_value, const EntryValue& value,
                const SplittingOptions& options, const Work& work) {
  if (options.row < 1) throw std::invalid_argument("splitting: the row must be 1 or more");
  if (!(start_value > 0.0)) throw std::invalid_argument("splitting: a value is not positive");
  if (scene.field.fidelity != Fidelity::active)
    throw InvalidParameter("field.fidelity", "field.fidelity must be \"active\" for splitting");
  require_no_terrain(scene, "splitting");
  const auto method = make_method(scene.gate);
  Splitting result;
  Sums sums(options.row);
  const Aim aim{scene.gate,
                scene.field.columns,
                options.row,
                start_value,
                value,
                options.seed,
                stream_row(scene.gate, scene.start)};
  // Gate by gate: all bodies of a block run through one gate, so that many are in flight at a time.
  const auto run_block = [&](TrialRange range) {
    std::vector<Trial> trials;
    std::vector<Body> bodies, next;
    for (std::int64_t i = 0; i < range.count; ++i) {
      Trial& t = trials.emplace_back(aim, range.first + i);
      bodies.push_back({i, scene.field.start_column(), 0, 1.0, scene.start,
                        RandomForce(scene.gate.forces, t.random())});
    }
    while (!bodies.empty()) {
      work.tell("split trials", range.first, range.first + range.count);
      std::vector<GateRun> runs(bodies.size());
      carry_out_trials(
          scene.gate, *method, std::ssize(bodies),
          [&](RunSlot& slot) {
            const Body& body = bodies[static_cast<std::size_t>(slot.trial)];
            slot.start = body.from;
            slot.force = body.force;
          },
          [&](RunSlot& slot, const GateRun& run) {
            const auto i = static_cast<std::size_t>(slot.trial);
            runs[i] = run;
            bodies[i].force = slot.force;
            return false;
          });
      for (std::size_t i = 0; i < bodies.size(); ++i) {
        result.health.add(scene.gate, runs[i]);
        trials[static_cast<std::size_t>(bodies[i].trial)].take(bodies[i], runs[i], next);
      }
      bodies = std::exchange(next, {});
    }
    for (const Trial& t : trials) sums.add(t.entered());
  };
  // Rounds: each as many trials as the last ones say are wanted, at most eight times those so far.
  constexpr std::int64_t kFirst = 1000;
  for (std::int64_t more = kFirst; more > 0;) {
    constexpr std::int64_t kBlock = 4096;
    for (const std::int64_t end = sums.trials + more; sums.trials < end;)
      run_block({sums.trials, std::min(kBlock, end - sums.trials)});
    const double error = sums.chance(sums.sum.size() - 1).relative_standard_error;
    result.reached = error <= options.accuracy;
    if (result.reached) break;
    const auto n = static_cast<double>(sums.trials);
    const double wanted =
        std::isfinite(error) ? 1.1 * n * std::pow(error / options.accuracy, 2.0) - n : 8.0 * n;
    const double affordable = static_cast<double>(options.most_runs - result.health.runs) * n /
                              static_cast<double>(result.health.runs);
    more = static_cast<std::int64_t>(std::min({std::max(wanted, 0.1 * n), 8.0 * n, affordable}));
  }
  result.trials = sums.trials;
  result.gate_runs = result.health.runs;
  for (std::size_t r = 0; r < sums.sum.size(); ++r) result.rows.push_back(sums.chance(r));
  if (result.health.broken > 0)
    throw std::runtime_error("splitting: " + std::to_string(result.health.broken) +
                             " gate runs stopped being finite numbers; try method stable or a "
                             "smaller run.step_s");
  return result;
}

namespace {

// Entries in a leaf: few enough for the chain's answer; many, so that no leaf is far off by chance,
// for the value of entries.
constexpr int kPerLeafOfValues = 40;
// A value is at least this part of the largest of its row: bodies that the chain thinks lost are
// given some chance.
constexpr double kLeastValue = 0.02;

/// The committor for each target row 1 .. rows, of bodies from the start: first rows of a kernel.
std::vector<double> chances(const Kernel& kernel, const FieldGates& gates,
                            const std::vector<std::int64_t>& first, const FieldParams& field) {
  const markov::FieldChain chain = chain_of(kernel, gates, field, {first});
  const int start = chain.inputs() - 1;
  std::vector<double> out;
  // The chance to enter row r of a field is that to leave one of r rows; these are solved from
  // the far edge, so the answer for r rows is row `rows - r` of the largest one.
  const markov::Committor all = markov::committor(chain, {field.columns, field.rows});
  for (int r = 1; r <= field.rows; ++r)
    out.push_back(all(field.start_column(), field.rows - r, start));
  return out;
}

}  // namespace

RareEvent rare_event(const Scene& scene, const SplittingOptions& options, const Work& work) {
  const Stopwatch watch;
  require_no_terrain(scene, "splitting");
  Scene deep = scene;
  deep.field.rows = options.row;
  deep.field.max_gates = 0;
  constexpr std::int64_t kPoolRuns = 60'000;
  const std::int64_t pool_runs = std::min(kPoolRuns, options.most_runs / 4);
  PoolRunner runner(deep, options.seed, pool_runs, work);
  RunPool pool;
  pool.starts.push_back({.start = entry_of(scene.start)});
  StartTrials& start = pool.starts.front();
  while (runner.may_go_on())
    runner.run_full(start,
                    static_cast<std::int64_t>(static_cast<double>(pool_runs - runner.gate_runs) /
                                              runner.gates_per_trial()));
  runner.finish();

  const FieldGates gates(deep.gate);
  RareEvent event{.splitting = {}, .chain = {}, .pool_runs = runner.gate_runs};
  const Kernel fine = kernel_of(gates, pool);
  event.chain = chances(fine, gates, first_row(gates, fine.space, start), deep.field);
  const Kernel coarse = kernel_of(gates, pool, kPerLeafOfValues);
  markov::Committor values = markov::committor(
      chain_of(coarse, gates, deep.field, {first_row(gates, coarse.space, start)}),
      {deep.field.columns, options.row});
  const auto of_row =
      static_cast<std::size_t>(values.columns) * static_cast<std::size_t>(values.inputs);
  for (std::size_t row = 0; row < values.values.size(); row += of_row) {
    const auto begin = values.values.begin() + static_cast<std::ptrdiff_t>(row),
               end = begin + static_cast<std::ptrdiff_t>(of_row);
    double least = kLeastValue * *std::max_element(begin, end);
    if (least == 0.0) least = 1.0;  // the chain knows no way: every entry is worth the same
    std::for_each(begin, end, [&](double& v) { v = std::max(v, least); });
  }
  const double at_start = values(deep.field.start_column(), 0, values.inputs - 1);
  event.splitting = split(
      deep, at_start,
      [&](int column, int row, const Crossing& entry) {
        return values(column, row, coarse.space.index_of(entry).state);
      },
      options, work);
  event.splitting.health += runner.health;
  event.seconds = watch.seconds();
  return event;
}

}  // namespace gatewalk::lattice
