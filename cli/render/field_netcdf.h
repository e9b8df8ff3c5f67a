// SPDX-License-Identifier: MIT
#pragma once
/// Where bodies end, as a NetCDF-4 file: for fields too large for JSON.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "cli/render/field_figure.h"
#include "cli/render/json_fwd.h"
#include "cli/render/start.h"

namespace gatewalk::cli {

inline constexpr const char* kNetcdfHelp =
    "write the shares of all that end, are trapped and depart in each gate as NetCDF-4, of fields "
    "of any size (JSON has maps of up to 100000 gates)";

/// Shares of all that began in one way, and low and high of the final gates where they are known.
struct FieldArrays {
  FieldPicture shares;
  Start start;  // of the picture
  std::optional<std::array<markov::CellProbabilities, 2>> gates_95 = std::nullopt;
};

/// The bytes of a file with final_gates, trapped_gates and departed_gates (start x i_y x i_x),
/// final_gates_low and _high where all have them, the endings, the starts (NaN: as bodies were seen
/// to enter first), and `made_by` as attributes.
[[nodiscard]] std::string netcdf_of(const std::vector<FieldArrays>& fields,
                                    const dynamics::Section& section, const Json& made_by);

}  // namespace gatewalk::cli
