// SPDX-License-Identifier: MIT
#pragma once
// clang-format off
/// gatewalk::markov: a Markov chain that walks over a lattice of cells.
///
/// A walker enters a cell in one of n_in input states. Its visit ends with one of n_out outputs: the
/// walker is trapped, or enters a neighbouring cell in an input state (`Exit`).
///   counts on disk (formats/counts.h)  ->  Chain, rows that sum to 1 (chain.h)
///   Chain  ->  Monte Carlo walks (walk.h): one draw per cell; its number names a walk
///   Chain, or one per row or cell (FieldChain)  ->  exact distribution (predict.h)
/// Walks and exact results are Ends (ends.h): trapped, left the field, cut off at the limit of cells,
/// or in an unsampled state. The final cell is the last cell inside the field.
/// This module does not know what a state means or how large a cell is.
// clang-format on

#include "markov/chain.h"
#include "markov/ends.h"
#include "markov/formats/counts.h"
#include "markov/predict.h"
#include "markov/walk.h"
