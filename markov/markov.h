// SPDX-License-Identifier: MIT
#pragma once
// clang-format off
/// gatewalk::markov: a Markov chain that walks over a lattice of cells.
///
/// A walker enters a cell in one of n_in input states and ends the visit with one of n_out outputs:
/// it is trapped there, or enters a neighbouring cell in that cell's input state (`Exit`).
///   counts on disk (formats/counts.h)  ->  Chain, rows that sum to 1 (chain.h)
///   Chain  ->  Monte Carlo walks (walk.h): one draw per cell, a walk is named by its number
///   Chain, or one per row or cell (FieldChain)  ->  exact distribution (predict.h)
/// Walks and exact results are Ends (ends.h), which tell apart: trapped, left the field, cut off at the
/// cell limit, entered a state that was never sampled. The final cell is the last one inside.
/// What a state means, and how large a cell is, this module does not know.
// clang-format on

#include "markov/chain.h"
#include "markov/ends.h"
#include "markov/formats/counts.h"
#include "markov/predict.h"
#include "markov/walk.h"
