// SPDX-License-Identifier: MIT
#pragma once
/// plan of a scene without actions: the start from which bodies cross most often.

#include "cli/arguments.h"
#include "cli/subject.h"

namespace gatewalk::cli {

/// `s`: as scene_to_run gives it. Returns the exit status. Throws UsageError.
[[nodiscard]] int plan_start(const Options& options, Subject s);

}  // namespace gatewalk::cli
