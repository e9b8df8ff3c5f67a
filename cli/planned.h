// SPDX-License-Identifier: MIT
#pragma once
/// What `gatewalk plan` is asked for.

#include <optional>

#include "cli/arguments.h"
#include "cli/subject.h"
#include "lattice/study/plan.h"

namespace gatewalk::cli {

/// --least, --points and --chance; none without --least. Throws UsageError.
[[nodiscard]] std::optional<lattice::ThriftOptions> thrift_of(const Options& options,
                                                              const ShownField& shown);

[[nodiscard]] bool has_actions(const Subject& s);
/// Of a scene without actions: the start from which bodies cross most often. `s`: as scene_to_run
/// gives it. Returns the exit status. Throws UsageError.
[[nodiscard]] int plan_start(const Options& options, Subject s);

}  // namespace gatewalk::cli
