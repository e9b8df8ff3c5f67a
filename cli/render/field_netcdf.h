// SPDX-License-Identifier: MIT
#pragma once
/// Where bodies end, as a NetCDF-4 file, for fields too large for JSON.

#include <string>
#include <vector>

#include "cli/render/field_figure.h"
#include "cli/render/provenance.h"

namespace gatewalk::cli {

inline constexpr const char* kNetcdfHelp =
    "write for each gate the shares of bodies that end there, are trapped there or depart from it, "
    "as NetCDF-4, for fields of any size (JSON has maps of up to 100000 gates)";

/// The bytes of a file with final_gates, trapped_gates and departed_gates (start x i_y x i_x),
/// final_gates_low and _high if all starts have them, the endings, the starts (NaN: drawn from
/// first entries), and `made_by` as attributes.
[[nodiscard]] std::string netcdf_of(const std::vector<FieldPicture>& fields,
                                    const ShownField& shown, const Provenance& made_by);

}  // namespace gatewalk::cli
