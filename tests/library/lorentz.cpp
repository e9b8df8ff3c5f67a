// SPDX-License-Identifier: MIT
#include <cstdio>

#include "diffusion.h"
#include "lorentz_cell.h"

using namespace gatewalk;

// lorentz GAP: the diffusion coefficient of the Lorentz gas, from a chain of trees.
int main(int, char** words) {
  const auto cell = std::make_shared<lorentz::LorentzCell>(std::stod(words[1]));
  const auto start = [&](dynamics::Random& random) { return cell->anywhere(random); };
  dynamics::Health health;
  lattice::RunPool pool;
  pool.scattered = lorentz::endless_trials(*cell, start, 10'000, 20, 1, health);
  const auto map = dynamics::CellField::uniform(cell).map;
  const auto d = lorentz::pooled_diffusion(map, pool, cell->lattice).coefficient;
  std::printf("%.4f [%.4f, %.4f]\n", d.mean, d.interval[0], d.interval[1]);
}
