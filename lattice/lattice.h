// SPDX-License-Identifier: MIT
#pragma once
// clang-format off
/// gatewalk::lattice: a field of gates, walked both ways and compared.
///
///   field.h       the field's size and gates, where a trial starts, which beams act (fidelity)
///   reference.h   the full dynamics through the field, gate by gate
///   gate_chain.h  counts + state space -> markov::Chain, and the matrix file
///   statistics/   of shares, trials and chains, whatever the cells are:
///     compare.h       corrcoef, RMSE, total variation, noise floors, p-values
///     matrix_noise.h  what the sampling of a matrix does to its predictions
///     multiple_tests.h several statistics judged together
///     independence.h, gates_ahead.h  does a chain forget what matters?
///     ending_shares.h how trials, walks or a prediction end, with intervals
///     draws.h         binomial and multinomial counts
///     power.h         how many trials show a difference
///
/// Included by name: scene/ (scene files, bins, matrices of a scene), pool/ (gate runs kept one by
/// one, chains of trees, their predictions and error bars), study/ (what commands compute).
// clang-format on

#include "lattice/field/field_params.h"
#include "lattice/field/field_trials.h"
#include "lattice/field/gate_chain.h"
#include "lattice/statistics/compare.h"
#include "lattice/statistics/draws.h"
#include "lattice/statistics/ending_shares.h"
#include "lattice/statistics/gates_ahead.h"
#include "lattice/statistics/independence.h"
#include "lattice/statistics/matrix_noise.h"
#include "lattice/statistics/multiple_tests.h"
#include "lattice/statistics/power.h"
