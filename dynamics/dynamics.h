#pragma once
// clang-format off
/// gatewalk::dynamics: a disc pushing through one gate of two hinged, springy beams.
///
///   params.h       the scene: body, beams, forces, contact, run
///   contact.h      where disc and beam touch, impact laws Eqs. (4)-(9), constraints Eqs. (10)-(13)
///   flow.h         free motion in closed form
///   methods/       time stepping, one file per method behind methods/method.h
///   random_force.h the held lateral force of Eq. (1)
///   base/          random streams, shares with intervals, sets of trials, long work that can be watched
///   gate.h         one run of one gate
///   runs.h         runs by the thousand on all threads; in vector registers those of stable
///                  (stable_lanes.h) and moreau (lanes.h)
///   ensemble.h     many runs and their outcomes
///   health.h       how far runs can be trusted
///   section.h      what a chain knows of a gate: faces, coordinates of an entry, costs
///   state_space.h  how a body enters, as a number: bins, or trees
///   disc_section.h how a disc enters a gate: its section, and Table III's bins
///   quantile_bins.h  bins from entries that were seen, and how well bins resolve them
///   tree_space.h   trees grown over entries that were seen
///   trace.h        one run in full, step by step
///   landscape.h    potential energy Eqs. (14), (15), the lowest way through
///   transitions.h  runs -> counts, the matrix of Eq. (16)
///   study/verdict.h      one word for how far a method can be trusted
///   study/accuracy.h     a method's errors against a reference under the same noise
///   study/stability.h    maps of where each method breaks
///   study/work_precision.h  every method's time against its error
///   study/choice.h       the cheapest method and setting that a scene can do with
// clang-format on

#include "dynamics/base/random.h"
#include "dynamics/disc_section.h"
#include "dynamics/ensemble.h"
#include "dynamics/flow.h"
#include "dynamics/gate.h"
#include "dynamics/landscape.h"
#include "dynamics/params.h"
#include "dynamics/quantile_bins.h"
#include "dynamics/section.h"
#include "dynamics/state_space.h"
#include "dynamics/study/accuracy.h"
#include "dynamics/study/choice.h"
#include "dynamics/study/stability.h"
#include "dynamics/study/verdict.h"
#include "dynamics/study/work_precision.h"
#include "dynamics/trace.h"
#include "dynamics/transitions.h"
#include "dynamics/tree_space.h"
