// SPDX-License-Identifier: MIT
#pragma once
/// Fields of gates, for tests of functions that take any cells.

#include "lattice/gates/disc_field.h"
#include "lattice/scene/matrix.h"
#include "lattice/scene/scene_problem.h"
#include "lattice/scene/scene_trials.h"
#include "lattice/scene/table4.h"
#include "lattice/source/cell_matrix.h"
#include "lattice/source/source.h"
