#pragma once
// clang-format off
/// The public face of gatewalk::markov: a Markov chain that walks over a lattice of cells.
///
/// A walker enters a cell in one of n_in input states and ends the visit with one of n_out outputs:
/// it is trapped there, or enters a neighbouring cell in that cell's input state (`Exit`).
///   counts on disk (formats/counts.h)  ->  Chain, rows that sum to 1 (chain.h)
///   Chain  ->  Monte Carlo walks (walk.h): one draw per cell, a walk is named by its number
///   Chain  ->  exact distribution: whole rows of the field at a time (predict/predictor.h), the visits of a row by
///              elimination (predict/row_elimination.h); plain references: forward propagation and one sparse solve,
///              also of rows that differ (predict/reference.h)
/// Walks and exact results tell the same four ends apart: trapped, left the field, cut off at the
/// cell limit, entered a state that was never sampled. The final cell is the last one inside.
/// What a state means, and how large a cell is, this module does not know.
// clang-format on

#include "markov/chain.h"
#include "markov/formats/counts.h"
#include "markov/predict/predictor.h"
#include "markov/predict/reference.h"
#include "markov/walk.h"
