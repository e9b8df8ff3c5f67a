// SPDX-License-Identifier: MIT
#pragma once
/// Fields of our own gates, for tests of what takes any cells.

#include "lattice/cells/cell_matrix.h"
#include "lattice/cells/source.h"
#include "lattice/scene/disc_field.h"
#include "lattice/scene/matrix.h"
#include "lattice/scene/row_matrices.h"
#include "lattice/scene/scene_problem.h"
#include "lattice/scene/scene_trials.h"
#include "lattice/scene/table4.h"
