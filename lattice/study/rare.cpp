#include "lattice/study/rare.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
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
  int column = 0, row = 0;
  double weight = 1.0;
  BodyState from;
  RandomForce force;
};

/// One trial: a tree of bodies, walked depth first.
class Trial {
 public:
  Trial(const Scene& scene, int target, double start_value, const EntryValue& value,
        std::uint64_t seed, std::int64_t number)
      : p_(scene.gate),
        columns_(scene.field.columns),
        target_(target),
        start_value_(start_value),
        value_(value),
        seed_(seed),
        row_(stream_row(scene.gate, scene.start)),
        number_(static_cast<std::uint64_t>(number)),
        chance_(random()),
        body_{scene.field.start_column(), 0, 1.0, scene.start,
              RandomForce(scene.gate.forces, random())},
        entered_(static_cast<std::size_t>(target), 0.0) {}

  /// The body that runs now.
  [[nodiscard]] const Body& body() const { return body_; }
  [[nodiscard]] const std::vector<double>& entered() const { return entered_; }
  [[nodiscard]] const Health& health() const { return health_; }

  /// Takes the run of that body, under `force` at its end. False when no body is left.
  bool take(const GateRun& run, const RandomForce& force) {
    health_.add(p_, run);
    body_.force = force;
    if (run.ending != Ending::trapped && run.ending != Ending::broken) go_on(run);
    if (waiting_.empty()) return false;
    body_ = std::move(waiting_.back());
    waiting_.pop_back();
    return true;
  }

 private:
  Random random() { return {Purpose::rare, {seed_, row_, number_ * kMostOfTrial + streams_++}}; }

  void go_on(const GateRun& run) {
    const Crossing entry = crossing_of(p_, run.ending, run.exit);
    const Move move = move_into(entry.boundary);
    body_.column += move.di_x;
    body_.row += move.di_y;
    if (body_.column < 0 || body_.column >= columns_) return;
    if (move.di_y > 0) entered_[static_cast<std::size_t>(body_.row) - 1] += body_.weight;
    if (body_.row == target_) return;
    body_.from = shifted_into_next(p_, run.ending, run.exit);
    const double worth = value_(body_.column, body_.row, entry);
    if (!(worth > 0.0)) throw std::invalid_argument("splitting: a value is not positive");
    const double parts = body_.weight * worth / start_value_;
    if (parts >= 1.0 / kWindow && parts <= kWindow) {
      waiting_.push_back(body_);
      return;
    }
    const double whole = std::floor(std::min(parts, double{kMostCopies}));
    const double each = parts > kMostCopies ? body_.weight / whole : body_.weight / parts;
    int copies = static_cast<int>(whole);
    if (parts <= kMostCopies) copies += chance_.uniform() < parts - whole;
    if (copies > 1 && streams_ + kMostCopies >= kMostOfTrial) {
      waiting_.push_back(body_);
      return;
    }
    body_.weight = each;
    for (int copy = 0; copy < copies; ++copy) {
      waiting_.push_back(body_);
      if (copy > 0) waiting_.back().force.go_on_with(random());
    }
  }

  const GateParams& p_;
  int columns_, target_;
  double start_value_;
  const EntryValue& value_;
  std::uint64_t seed_, row_, number_, streams_ = 0;
  Random chance_;  // of rounding numbers of bodies
  Body body_;
  std::vector<Body> waiting_;
  std::vector<double> entered_;  // (target) weight that entered rows 1, 2, ...
  Health health_;
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
  const auto run = [&](TrialRange range) {
    std::vector<std::optional<Trial>> trials(static_cast<std::size_t>(range.count));
    carry_out_trials(
        scene.gate, *method, range.count,
        [&](RunSlot& slot) {
          const Trial& t = trials[static_cast<std::size_t>(slot.trial)].emplace(
              scene, options.row, start_value, value, options.seed, range.first + slot.trial);
          slot.start = t.body().from;
          slot.force = t.body().force;
        },
        [&](RunSlot& slot, const GateRun& run) {
          Trial& t = *trials[static_cast<std::size_t>(slot.trial)];
          if (!t.take(run, slot.force)) return false;
          slot.start = t.body().from;
          slot.force = t.body().force;
          return true;
        });
    for (const auto& t : trials) {
      sums.add(t->entered());
      result.health += t->health();
    }
  };
  // Rounds: each as many trials as the last ones say are wanted, at most eight times those so far.
  constexpr std::int64_t kFirst = 1000;
  for (std::int64_t more = kFirst; more > 0;) {
    const std::int64_t done = sums.trials;
    work.in_pieces("split trials", more, [&](TrialRange range) {
      run({done + range.first, range.count});
    });
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
