#pragma once
/// Options that several commands have, as what the libraries take.

#include <string>
#include <vector>

#include "cli/command.h"
#include "lattice/scene/bins.h"
#include "lattice/scene/table4.h"

namespace gatewalk::cli {

/// Declares --start; `by_default` says where to start without it.
void add_starts(Options& options,
                const std::string& by_default =
                    "the scene's start; in the paper's field with the paper's start "
                    "(0,0,15), the four of Table IV");
/// The starts given; none without --start. Throws UsageError for a malformed one.
[[nodiscard]] std::vector<lattice::PaperStart> given_starts(const Options& options);
/// The starts given, else lattice::usual_starts. Throws UsageError for a malformed one.
[[nodiscard]] std::vector<lattice::PaperStart> starts_of(const Options& options,
                                                         const lattice::Scene& scene);

/// Declares --bins.
void add_bins(Options& options);
/// --bins if given, else lattice::usual_bins. Throws UsageError for anything else, and for --bins
/// beside a table [bins].
[[nodiscard]] lattice::BinsChoice bins_choice(const Options& options, const lattice::Scene& scene);

}  // namespace gatewalk::cli
