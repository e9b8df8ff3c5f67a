// SPDX-License-Identifier: MIT
#pragma once
// clang-format off
/// gatewalk::dynamics: what becomes of a body in one cell; and one kind of cell: a gate of two
/// hinged, springy beams that a disc pushes through.
///
///   base/          random streams, shares with intervals, sets of trials, long work that can be watched
///   cells/         what a chain knows of any cell (health.h alone still speaks of a disc's faults):
///     section.h        faces, the coordinates of an entry, costs (costs.h)
///     cell.h           what is derived from to simulate a kind of cell
///     cell_map.h       which type of cell stands where
///     state_space.h    how a body enters, as a number: bins, or trees
///     quantile_bins.h  bins from entries that were seen, and how well bins resolve them
///     tree_space.h     trees grown over entries that were seen
///     transitions.h    counts from state to state
///     health.h         how far runs can be trusted
///   disc/          the disc in its gate:
///     params.h       the scene: body, beams, forces, contact, run
///     contact.h      where disc and beam touch, impact laws Eqs. (4)-(9), constraints Eqs. (10)-(13)
///     flow.h         free motion in closed form
///     methods/       time stepping, one file per method behind methods/method.h
///     random_force.h the held lateral force of Eq. (1)
///     gate.h         one run of one gate
///     runs.h         runs by the thousand on all threads; in vector registers those of stable
///                    (stable_lanes.h) and moreau (lanes.h)
///     ensemble.h     many runs and their outcomes
///     disc_section.h how a disc enters a gate: its section, and Table III's bins
///     disc_cell.h    the gate as a Cell
///     trace.h        one run in full, step by step
///     landscape.h    potential energy Eqs. (14), (15), the lowest way through
///     row_trials.h   runs -> counts, the matrix of Eq. (16)
///     study/verdict.h      one word for how far a method can be trusted
///     study/accuracy.h     a method's errors against a reference under the same noise
///     study/limits.h       where each method breaks near a scene
///     study/work_precision.h  every method's time against its error
///     study/choice.h       the cheapest method and setting that a scene can do with
// clang-format on

#include "dynamics/base/random.h"
#include "dynamics/cells/quantile_bins.h"
#include "dynamics/cells/section.h"
#include "dynamics/cells/state_space.h"
#include "dynamics/cells/transitions.h"
#include "dynamics/cells/tree_space.h"
#include "dynamics/disc/disc_section.h"
#include "dynamics/disc/ensemble.h"
#include "dynamics/disc/flow.h"
#include "dynamics/disc/gate.h"
#include "dynamics/disc/landscape.h"
#include "dynamics/disc/params.h"
#include "dynamics/disc/row_trials.h"
#include "dynamics/disc/study/accuracy.h"
#include "dynamics/disc/study/choice.h"
#include "dynamics/disc/study/limits.h"
#include "dynamics/disc/study/verdict.h"
#include "dynamics/disc/study/work_precision.h"
#include "dynamics/disc/trace.h"
