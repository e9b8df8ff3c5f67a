// SPDX-License-Identifier: MIT
#pragma once
// clang-format off
/// gatewalk::lattice: a field of cells, simulated and as a Markov chain, and both compared. Most
/// programs include only this header:
///
///   source/source.h             a problem from a scene, a matrix or the caller's own cells; predict()
///   pool/pooled_prediction.h    the results of predict() for each start, with error bars
///   scene/scene.h               the scene file: read_scene()
///   field/problem.h             cells, the field's size, where trials start
///   field/field_trials.h        trials of the full dynamics: run_field()
///   field/gate_chain.h          a matrix as a markov::Chain, a start as one of its states
///   study/validation.h          the chain against the full dynamics: validate_chain()
///   statistics/ending_shares.h  shares of endings of trials, walks or a prediction, with intervals
///   statistics/compare.h        corrcoef, RMSE, total variation, noise floors, p-values
// clang-format on

#include "lattice/field/field_trials.h"
#include "lattice/field/gate_chain.h"
#include "lattice/source/source.h"
#include "lattice/statistics/compare.h"
#include "lattice/statistics/ending_shares.h"
#include "lattice/study/validation.h"
