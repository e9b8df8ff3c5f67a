// SPDX-License-Identifier: MIT
#pragma once
// clang-format off
/// The public face of gatewalk::markov: a Markov chain that walks over a lattice of cells.
///
/// A walker enters a cell in one of n_in input states and ends the visit with one of n_out outputs:
/// it is trapped there, or enters a neighbouring cell in that cell's input state (`Exit`).
///   counts on disk (formats/counts.h)  ->  Chain, rows that sum to 1 (chain.h)
///   Chain  ->  Monte Carlo walks (walk.h): one draw per cell, a walk is named by its number
///   Chain, or one per row or cell (FieldChain)  ->  exact distribution (predict.h): Predictor and
///              predict() by the solver asked for. Step by step: all planes of the field at a time; by
///              rows: the visits of a row by elimination, sweeps or sums, then the next row. A plain
///              reference is one sparse solve (solve_absorption)
///   Chain -> the chance of an ending from everywhere (committor.h), of any cell, state or ending with the mean
///              time till then (first_passage.h), of all ends by first draw and by cell
///              visited (outcomes.h), times and works of walks (totals.h),
///              the most frequent paths (paths.h), what survives for ever (quasi_stationary.h)
///   A chain for each action -> which to take in each cell and state, so that walks end best (decide.h)
///   A chain for each type of cell -> which cells to change (design.h)
///   States taken together (lumping.h)
/// Walks and exact results are Ends (ends.h), which tell apart: trapped, left the field, cut off at the
/// cell limit, entered a state that was never sampled. The final cell is the last one inside.
/// What a state means, and how large a cell is, this module does not know.
// clang-format on

#include "markov/chain.h"
#include "markov/committor.h"
#include "markov/decide.h"
#include "markov/design.h"
#include "markov/ends.h"
#include "markov/first_passage.h"
#include "markov/formats/counts.h"
#include "markov/lumping.h"
#include "markov/outcomes.h"
#include "markov/paths.h"
#include "markov/predict.h"
#include "markov/quasi_stationary.h"
#include "markov/totals.h"
#include "markov/walk.h"
