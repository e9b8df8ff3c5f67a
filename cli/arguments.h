// SPDX-License-Identifier: MIT
#pragma once
/// Options that several commands have, as what the libraries take; what is wrong with it is said.

#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "lattice/pool/tree_chain.h"
#include "lattice/scene/bins.h"
#include "lattice/scene/matrix.h"
#include "lattice/scene/scene_problem.h"
#include "lattice/scene/settle.h"
#include "lattice/scene/table4.h"

namespace gatewalk::lattice {
class TomlFile;
}

namespace gatewalk::cli {

/// Declares --start; `by_default` says where to start without it.
TextsOption add_starts(Options& options,
                       const std::string& by_default =
                           "the scene's start; in the paper's field, in whatever units, with "
                           "the paper's start, the four of Table IV");
/// Those given of a scene's; none without any. Throws std::invalid_argument for a malformed
/// one.
[[nodiscard]] std::vector<dynamics::Entry> given_starts(const TextsOption& given);
/// The starts given, else in the paper's field with the paper's start those of Table IV, else the
/// scene's own. Throws std::invalid_argument for a malformed one.
[[nodiscard]] std::vector<dynamics::Entry> starts_of(const TextsOption& given,
                                                     const lattice::Scene& scene);

/// Declares --bins.
TextOption add_bins(Options& options);
/// --bins if given; else the scene's table [bins]; else a tree, or lattice::usual_bins where
/// `runs_per_state` of them are asked for. Throws UsageError for anything else, and for --bins
/// beside a table [bins].
[[nodiscard]] lattice::BinsChoice bins_choice(const TextOption& bins, const lattice::Scene& scene,
                                              const Option& runs_per_state);

/// --accuracy and --gate-runs.
struct AskedAccuracy {
  NumberOption accuracy;
  CountOption gate_runs;
};
/// Declares them.
AskedAccuracy add_accuracy(Options& options, const std::string& by_default = "0.02");
/// Of these and --seed, else as in `how`. Throws UsageError for an accuracy outside (0, 1).
[[nodiscard]] lattice::AccuracyOptions accuracy_of(const Options& options,
                                                   const AskedAccuracy& asked,
                                                   lattice::AccuracyOptions how = {});
/// Of trees: --trials, if it is given, instead of an accuracy; parts need it.
void fix_trials(const Options& options, const AskedAccuracy& asked, lattice::AccuracyOptions& how,
                std::int64_t starts);
/// Warns where a chain errs by its own full trials.
void warn_of(const Options& options, const std::optional<lattice::HausmanCheck>& own);
/// The same, and where the accuracy was not reached.
void warn_of(const Options& options, const lattice::PooledPrediction& prediction, double accuracy);

/// Says so where starts that a matrix does not know lie outside the range that it was built for.
void warn_of_range(const Options& options, const lattice::MatrixFile& file, const std::string& path,
                   const std::vector<dynamics::Entry>& starts);

/// lattice::add_starts; says what it added, and warns as of any prediction.
void add_starts(const Options& options, lattice::SceneMatrix& m, const std::string& path,
                const std::vector<dynamics::Entry>& starts);

/// Warns of keys without effect, and says what the scene leaves out.
void warn_of_keys(const Options& options, const lattice::Scene& scene, lattice::RunsFrom from);
/// lattice::settle_method behind warn_of_keys; warns of a choice that did not meet the tolerance.
[[nodiscard]] std::optional<lattice::Settled> settle_method(const Options& options,
                                                            lattice::Scene& scene,
                                                            lattice::RunsFrom from);
/// lattice::states_of; warns when auto takes Table III's place.
[[nodiscard]] lattice::States states_of(const Options& options, const lattice::Scene& scene,
                                        const lattice::BinsChoice& choice,
                                        const std::vector<dynamics::BodyState>& starts);
/// Warns when a matrix was made by runs that showed faults.
void warn_of_faults(const Options& options, const lattice::MatrixFile& file,
                    const std::string& path);
/// lattice::scene_matrix of a file; warns of keys without effect in another scene, and of faults.
[[nodiscard]] lattice::SceneMatrix read_matrix(const Options& options, const std::string& path,
                                               const lattice::TomlFile* scene,
                                               const std::vector<std::string>& overrides);
/// lattice::start_in_bins; warns when the start lies beyond every entry that open bins were made
/// from.
lattice::ChainStart checked_start(const Options& options, const dynamics::StateSpace& space,
                                  const lattice::FieldParams& field, const dynamics::Entry& entry,
                                  const std::string& name);
/// The same for each of them.
void require_inside_bins(const Options& options, const std::vector<dynamics::Entry>& starts,
                         const lattice::Scene& scene, const dynamics::StateSpace& space);
/// As checked_start. Remarks when the start lies on an edge of its bin: then another bin would
/// serve it as well.
[[nodiscard]] lattice::ChainStart ready_start(const Options& options,
                                              const std::vector<dynamics::Transitions>& matrices,
                                              const lattice::Problem& problem,
                                              const dynamics::Entry& entry,
                                              const std::string& name);
/// exit_status of a result with this health; warns of the faults seen, `where` first.
[[nodiscard]] int status_of(const Options& options, const dynamics::Health& health,
                            const std::string& where = "");

}  // namespace gatewalk::cli
