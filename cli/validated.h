// SPDX-License-Identifier: MIT
#pragma once
/// What gatewalk validate compares with trials: a chain that is read or built, and an experiment.

#include <optional>
#include <vector>

#include "cli/command.h"
#include "cli/render/json.h"
#include "cli/render/shown_field.h"
#include "cli/render/states.h"
#include "dynamics/cells/transitions.h"
#include "lattice/problem.h"
#include "lattice/scene/scene.h"
#include "lattice/scene/table4.h"
#include "lattice/study/observed.h"

namespace gatewalk::cli {

/// Matrices to validate, by type of cell, and what their file or their making says of them.
struct Validated {
  lattice::Problem problem;
  std::vector<dynamics::Transitions> matrices{};
  std::vector<dynamics::Entry> starts{};
  std::optional<lattice::Observed> observed{};
  Json status{}, settled{};
  std::optional<StateRecord> states{};
  std::optional<lattice::Scene> scene{};      // of gates, and ...
  std::vector<lattice::PaperStart> papers{};  // ... the starts with what the paper prints of them
  std::optional<ShownField> shown{};
  Json made_by{};
};

/// Of --matrix, of the cells of --cell-program, or built from the scene. Throws UsageError and as
/// what reads or builds it.
[[nodiscard]] Validated validated(const Options& options);

/// So many trials of the dynamics an experiment's are held against, unless --trials says otherwise.
[[nodiscard]] std::int64_t trials_beside(const lattice::Observed& observed);

}  // namespace gatewalk::cli
