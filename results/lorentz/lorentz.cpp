// SPDX-License-Identifier: MIT
// What must a chain remember? The diffusion coefficient of the periodic Lorentz gas by chains of
// trees, beside direct simulation, hops without memory, and hops with one step of it.
//   lorentz DIR     writes lorentz.csv, leaves.csv and seconds.csv; see results/lorentz/README.md
#include <algorithm>
#include <ctime>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "results/lorentz/diffusion.h"
#include "tests/support/lorentz.h"

using namespace gatewalk;

namespace {

constexpr double kGaps[] = {0.05, 0.10, 0.15, 0.20, 0.25, 0.30};
constexpr double kGapsOfLeaves[] = {0.05, 0.20, 0.30};
constexpr int kPassages = 20;  // of a trial
constexpr std::int64_t kTrials = 100'000, kTrajectories = 400'000, kTrianglePassages = 10'000'000;
constexpr int kSteps = 10;  // of a trajectory
constexpr double kStep = 20.0;

struct Gas {
  std::shared_ptr<lorentz::LorentzCell> cell;
  explicit Gas(double gap) : cell(std::make_shared<lorentz::LorentzCell>(gap)) {}

  [[nodiscard]] lattice::RunPool pool(std::int64_t trials, std::uint64_t seed) const {
    dynamics::Health health;
    lattice::RunPool pool;
    pool.scattered = lorentz::endless_trials(
        *cell, [&](dynamics::Random& random) { return cell->anywhere(random); }, trials, kPassages,
        seed, health);
    if (!health.clean()) throw std::runtime_error("a passage broke");
    return pool;
  }
  [[nodiscard]] dynamics::CellMap map() const { return dynamics::CellField::uniform(cell).map; }
};

template <class Of>
test::Estimate of_groups(const lorentz::PooledDiffusion& d, Of of) {
  std::vector<double> all;
  for (const lorentz::TreeDiffusion& group : d.groups) all.push_back(of(group));
  return test::estimate(all);
}

/// Seconds of CPU, of all threads together, since the last call.
double lap() {
  static std::clock_t last = 0;
  const std::clock_t now = std::clock();
  return static_cast<double>(now - std::exchange(last, now)) / CLOCKS_PER_SEC;
}

/// A line a gap: D by all routes, and how well the chain keeps what is known exactly; what that
/// took, in seconds of CPU.
void all_routes(std::ostream& out, std::ostream& seconds) {
  seconds << "gap,triangle,direct,trials,chain\n";
  out << "gap,no_memory,back,back_error,one_step,one_step_error,direct,direct_error,"
         "chain,chain_low,chain_high,chain_error,states,stay,stay_error,stay_exact,"
         "off_invariant,off_by_sampling,apart,apart_by_sampling\n";
  for (const double gap : kGaps) {
    const Gas gas(gap);
    lap();
    const test::Estimate back = test::triangle(gap, kTrianglePassages, 1).back;
    seconds << gap << ',' << lap();
    const double one = test::one_step(gap, back.mean);
    const double one_error = std::abs(test::one_step(gap, back.mean + back.error) - one);
    const test::Estimate direct = test::direct_diffusion(gap, kTrajectories, kSteps, kStep, 1);
    seconds << ',' << lap();
    const lattice::RunPool pool = gas.pool(kTrials, 1);
    seconds << ',' << lap();
    const auto chain = lorentz::pooled_diffusion(gas.map(), pool, gas.cell->lattice);
    seconds << ',' << lap() << std::endl;
    const auto spread = of_groups(chain, [](const auto& g) { return g.walk.coefficient(); });
    const auto stay = of_groups(chain, [](const auto& g) { return g.walk.mean_time; });
    const auto off = of_groups(chain, [&](const auto& g) { return test::off_invariant(g, gap); });
    // From direct simulation, in standard errors of the difference.
    const double bar = (chain.coefficient.interval[1] - chain.coefficient.interval[0]) / 2.0 / 1.96;
    const auto apart = [&](double error) {
      return (chain.coefficient.mean - direct.mean) / std::hypot(error, direct.error);
    };
    out << gap << ',' << test::machta_zwanzig(gap) << ',' << back.mean << ',' << back.error << ','
        << one << ',' << one_error << ',' << direct.mean << ',' << direct.error << ','
        << chain.coefficient.mean << ',' << chain.coefficient.interval[0] << ','
        << chain.coefficient.interval[1] << ',' << spread.error << ',' << chain.whole.space.size()
        << ',' << chain.whole.walk.mean_time << ',' << stay.error << ','
        << test::mean_stay_in_cell(gap) << ',' << test::off_invariant(chain.whole, gap) << ','
        << off.mean / std::sqrt(8.0) << ',' << apart(bar) << ',' << apart(spread.error)
        << std::endl;
  }
}

/// What leaves of finite size cost: the mean over some seeds, not those of lorentz.csv, for more
/// and more trials with the usual leaves, and for larger and larger leaves of the same trials. At
/// all gaps for the trials of lorentz.csv.
void leaves(std::ostream& out) {
  out << "gap,trials,per_leaf,states,seeds,chain,error,half_width\n";
  const auto line = [&](double gap, std::int64_t trials, int per_leaf, int seeds) {
    const Gas gas(gap);
    std::vector<double> d;
    double half = 0.0;
    int states = 0;
    for (int seed = 0; seed < seeds; ++seed) {
      const auto chain = lorentz::pooled_diffusion(
          gas.map(), gas.pool(trials, static_cast<std::uint64_t>(100 + seed)), gas.cell->lattice,
          per_leaf);
      d.push_back(chain.coefficient.mean);
      half += 0.5 * (chain.coefficient.interval[1] - chain.coefficient.interval[0]) / seeds;
      states = chain.whole.space.size();
    }
    const test::Estimate mean = test::estimate(d);
    out << gap << ',' << trials << ',' << per_leaf << ',' << states << ',' << seeds << ','
        << mean.mean << ',' << mean.error << ',' << half << std::endl;
  };
  for (const double gap : kGaps) line(gap, kTrials, dynamics::kEntriesPerLeaf, 4);
  for (const double gap : kGapsOfLeaves) {
    for (const std::int64_t trials : {312, 1250, 5000, 20'000})
      line(gap, trials, dynamics::kEntriesPerLeaf, static_cast<int>(80'000 / trials));
    for (const int per_leaf : {28, 112, 448, 1792, 7168, 28'672, 100'000})
      line(gap, 20'000, per_leaf, 4);
  }
}

}  // namespace

int main(int count, char** words) try {
  if (count != 2) throw std::invalid_argument("usage: lorentz DIR");
  std::vector<std::ofstream> files;
  for (const char* name : {"lorentz.csv", "seconds.csv", "leaves.csv"})
    files.emplace_back(std::string(words[1]) + "/" + name) << std::setprecision(7);
  all_routes(files[0], files[1]);
  leaves(files[2]);
  for (std::ofstream& file : files)
    if (!file.flush()) throw std::runtime_error(std::string("cannot write into ") + words[1]);
} catch (const std::exception& e) {
  std::cerr << "lorentz: " << e.what() << '\n';
  return 1;
}
