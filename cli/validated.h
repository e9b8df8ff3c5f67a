// SPDX-License-Identifier: MIT
#pragma once
/// What gatewalk validate compares with trials: a chain that is read or built, and an experiment.

#include <optional>
#include <vector>

#include "cli/command.h"
#include "cli/render/validation.h"
#include "lattice/problem.h"
#include "lattice/scene/scene.h"
#include "lattice/study/observed.h"

namespace gatewalk::cli {

/// Matrices to validate, by type of cell, in a result that is complete but for the validation.
struct Validated {
  lattice::Problem problem;
  std::vector<dynamics::Entry> starts{};
  std::optional<lattice::Observed> observed{};
  std::optional<lattice::Scene> scene{};  // of gates
  ValidateResult result;
};

/// Of --matrix, of the cells of --cell-program, or built from the scene. Throws UsageError and as
/// what reads or builds it.
[[nodiscard]] Validated validated(const Options& options);

/// So many trials of the dynamics an experiment's are held against, unless --trials says otherwise.
[[nodiscard]] std::int64_t trials_beside(const lattice::Observed& observed);

}  // namespace gatewalk::cli
