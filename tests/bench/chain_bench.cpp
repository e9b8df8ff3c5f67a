// SPDX-License-Identifier: MIT
/// chain_bench MATRIX FOLDER [Google Benchmark's options]
/// The chain of a matrix file, one thread: walks, exact prediction of 13 gates, and without limit.
/// Writes to FOLDER what chain_scipy.py and chain.R need to do the same: the kernel and its exits,
/// the global chains of a 9 x 9 and a 3 x 3 field, and our answers.

#include <benchmark/benchmark.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <iomanip>
#include <iostream>
#include <string>
#include <vector>

#include "dynamics/disc/disc_section.h"
#include "lattice/source/cell_matrix.h"
#include "markov/markov.h"
#include "markov/solvers.h"
#include "scenes.h"
#include "tests/support/propagation.h"

namespace {

using namespace gatewalk;
using markov::Chain;
using markov::Exit;
using markov::Field;
using markov::FinalDistribution;
using markov::Start;

constexpr int kGates = 13;
constexpr std::int64_t kWalks = 100'000;

std::ofstream file(const std::string& path) {
  std::ofstream out(path);
  out.exceptions(std::ios::failbit | std::ios::badbit);
  out << std::setprecision(17);
  return out;
}

using Entries = std::vector<Eigen::Triplet<double, std::int64_t>>;

void write_mtx(const std::string& path, std::int64_t rows, std::int64_t columns,
               const Entries& entries) {
  auto out = file(path);
  out << "%%MatrixMarket matrix coordinate real general\n"
      << rows << ' ' << columns << ' ' << entries.size() << '\n';
  for (const auto& e : entries)
    out << e.row() + 1 << ' ' << e.col() + 1 << ' ' << e.value() << '\n';
}

/// Writes the chain over a whole field as one matrix. States: (cell, input), then "trapped" in each
/// cell, then "left the field" from each cell; the last two kinds are absorbing.
void write_global(const std::string& path, const Chain& chain, const Field& field) {
  const std::int64_t n = chain.inputs(), cells = std::int64_t{field.columns} * field.rows;
  Entries entries;
  for (std::int64_t cell = 0; cell < cells; ++cell)
    for (int input = 0; input < n; ++input)
      for (markov::Probabilities::InnerIterator it(chain.matrix(), input); it; ++it) {
        const Exit& exit = chain.exits()[static_cast<std::size_t>(it.col())];
        const auto column = cell % field.columns + exit.di_x,
                   row = cell / field.columns + exit.di_y;
        const bool inside = column >= 0 && column < field.columns && row >= 0 && row < field.rows;
        const std::int64_t to = exit.next_input == Exit::kTrapped ? n * cells + cell
                                : !inside                         ? n * cells + cells + cell
                                          : (row * field.columns + column) * n + exit.next_input;
        entries.emplace_back(cell * n + input, to, it.value());
      }
  const std::int64_t states = (n + 2) * cells;
  for (std::int64_t s = n * cells; s < states; ++s) entries.emplace_back(s, s, 1.0);
  write_mtx(path, states, states, entries);
}

/// Writes the final cells, then the shares trapped, left the field and cut off.
void write_answer(const std::string& path, const FinalDistribution& d) {
  auto out = file(path);
  for (const double p : d.final_cells.reshaped<Eigen::RowMajor>()) out << p << '\n';
  out << d.trapped() << '\n' << d.left_field() << '\n' << d.cut_off() << '\n';
}

double difference(const FinalDistribution& a, const FinalDistribution& b) {
  return std::max({(a.final_cells - b.final_cells).abs().maxCoeff(),
                   std::abs(a.trapped() - b.trapped()), std::abs(a.left_field() - b.left_field()),
                   std::abs(a.cut_off() - b.cut_off())});
}

/// `difference` from the plain answer is measured once, outside the timing.
void add_exact(const std::string& name, const FinalDistribution& plain,
               const std::function<FinalDistribution()>& predict) {
  const double worst = difference(predict(), plain);
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(predict());
    state.counters["difference"] = worst;
  })->UseRealTime();
}

void add_walks(const std::string& name, const Chain& chain, const Field& field, const Start& start,
               const FinalDistribution& exact) {
  benchmark::RegisterBenchmark(
      name.c_str(),
      [=, &chain](benchmark::State& state) {
        const markov::Walker walker(chain);
        markov::WalkTally tally;
        for (auto _ : state)
          tbb::task_arena(1).execute([&] {
            tally = walker.walk(field, start, kGates, bench::kSeed, {0, kWalks});
          });
        const markov::CellProbabilities seen = tally.final_cells.cast<double>() / kWalks;
        state.counters["walks"] = kWalks;
        state.counters["difference"] = lattice::total_variation(seen, exact.final_cells);
        state.counters["floor"] = lattice::expected_total_variation(exact.final_cells, kWalks);
      })
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}

int run(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc != 3) {
    std::cerr << "chain_bench MATRIX FOLDER [--benchmark_...]\n";
    return 2;
  }
  const std::string folder = std::string(argv[2]) + "/";
  const dynamics::Transitions transitions = lattice::read_matrix(argv[1]).transitions;
  const Chain chain = lattice::make_chain(transitions);
  if (chain.unsampled_rows() > 0)
    throw std::runtime_error("a row was never sampled: the peers have no word for it");
  const int input =
      lattice::chain_start(transitions.space, bench::kField, dynamics::entry_of(bench::kFieldStart))
          .start.input;

  Entries kernel;
  for (int row = 0; row < chain.inputs(); ++row)
    for (markov::Probabilities::InnerIterator it(chain.matrix(), row); it; ++it)
      kernel.emplace_back(row, it.col(), it.value());
  write_mtx(folder + "kernel.mtx", chain.inputs(), chain.outputs(), kernel);
  auto exits = file(folder + "exits.csv");
  for (const Exit& e : chain.exits())
    exits << e.next_input << ',' << e.di_x << ',' << e.di_y << '\n';
  file(folder + "start.txt") << input << '\n';

  const markov::Predictor predictor(chain);
  for (const int side : {9, 3}) {
    const Field field{side, side};
    const Start start{side / 2, 0, input};
    const std::string at = "/" + std::to_string(side) + "x" + std::to_string(side);
    const FinalDistribution limited =
        markov::test::propagate(chain, field, start, {.max_cells = kGates});
    const FinalDistribution unlimited = markov::test::propagate(chain, field, start);
    write_global(folder + "chain_" + std::to_string(side) + ".mtx", chain, field);
    write_answer(folder + "limited_" + std::to_string(side) + ".txt", limited);
    write_answer(folder + "unlimited_" + std::to_string(side) + ".txt", unlimited);
    add_walks("walks/gatewalk walk" + at, chain, field, start, limited);
    if (side == 3) continue;
    add_exact("13 gates/gatewalk predict" + at, limited,
              [&, field, start] { return predictor.predict(field, start, {.max_cells = kGates}); });
    add_exact("no limit/gatewalk predict" + at, unlimited,
              [&, field, start] { return predictor.predict(field, start); });
    add_exact("no limit/gatewalk KLU" + at, unlimited,
              [&, field, start] { return markov::solve_absorption(chain, field, start); });
  }
  benchmark::RegisterBenchmark("prepare/gatewalk Predictor/9x9", [&](benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(markov::Predictor(chain).can_go_by_rows());
  })->UseRealTime();
  benchmark::RegisterBenchmark("prepare/gatewalk Walker/9x9", [&](benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(markov::Walker(chain).draw(0, 0));
  })->UseRealTime();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& e) {
    std::cerr << "chain_bench: " << e.what() << '\n';
    return 1;
  }
}
