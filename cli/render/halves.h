// SPDX-License-Identifier: MIT
#pragma once
/// One half of recorded bodies against the other.

#include <string>
#include <vector>

#include "cli/render/figure.h"
#include "cli/render/json_fwd.h"
#include "cli/render/shown_field.h"
#include "lattice/study/body_memory.h"
#include "lattice/study/halves.h"

namespace gatewalk::cli {

/// One sentence each.
[[nodiscard]] std::string verdict(const lattice::HalvesValidation& v);
[[nodiscard]] std::string verdict(const lattice::BodyMemory& m, const dynamics::Section& section);

[[nodiscard]] Json to_json(const lattice::HalvesValidation& v);
[[nodiscard]] Json to_json(const lattice::BodyMemory& m, const dynamics::Section& section);
/// Of each chain whose endings leave something out (rest_warning).
[[nodiscard]] std::vector<std::string> rest_warnings(const lattice::HalvesValidation& v);
[[nodiscard]] std::string table_of(const lattice::HalvesValidation& v);
[[nodiscard]] Figure figure_of(const lattice::HalvesValidation& v, const ShownField& shown);

}  // namespace gatewalk::cli
