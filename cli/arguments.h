// SPDX-License-Identifier: MIT
#pragma once
/// Options that several commands share, turned into arguments of the library. These functions warn
/// the user of what the result cannot be trusted for.

#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "dynamics/cells/words.h"
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

/// Declares --start; `by_default` is the help text for the start without this option.
TextsOption add_starts(Options& options,
                       const std::string& by_default =
                           "the scene's start; for the paper's field with the paper's start, in "
                           "any units, the four of Table IV");
/// The starts given by --start in a scene of gates; empty without --start. Throws
/// std::invalid_argument for a malformed start.
[[nodiscard]] std::vector<dynamics::Entry> given_starts(const TextsOption& given);
/// The starts given by --start. Without --start: the four of Table IV for the paper's field and
/// start, else the scene's own start. Throws std::invalid_argument for a malformed start.
[[nodiscard]] std::vector<dynamics::Entry> starts_of(const TextsOption& given,
                                                     const lattice::Scene& scene);

/// Declares --bins, the states of the chain.
TextOption add_bins(Options& options);
/// Declares --order-of, which says what --order counts.
TextOption add_order_of(Options& options);
/// What --order counts: turns by default. Throws UsageError.
[[nodiscard]] dynamics::LettersOf letters_of(const TextOption& order_of);
/// The states that --bins asks for, else the scene's table [bins]. Without both: a tree, or
/// lattice::usual_bins if the option `runs_per_state` is given. Throws UsageError for an unknown
/// value of --bins, and for --bins beside a table [bins].
[[nodiscard]] lattice::BinsChoice bins_choice(const TextOption& bins, const lattice::Scene& scene,
                                              const Option& runs_per_state);

/// The options --accuracy and --gate-runs.
struct AskedAccuracy {
  NumberOption accuracy;
  CountOption gate_runs;
};
/// Declares --accuracy and --gate-runs; `by_default` is the default accuracy on the help page.
AskedAccuracy add_accuracy(Options& options, const std::string& by_default = "0.02");
/// `how` with the values of --accuracy, --gate-runs and --seed where these are given. Throws
/// UsageError for an accuracy outside (0, 1).
[[nodiscard]] lattice::AccuracyOptions accuracy_of(const Options& options,
                                                   const AskedAccuracy& asked,
                                                   lattice::AccuracyOptions how = {});
/// Sets the number of trials of a tree from --trials, which then replaces --accuracy and
/// --gate-runs. Throws UsageError for --trials that `starts` does not divide, and for --shard
/// without --trials: a part must know how many trials there are in all.
void fix_trials(const Options& options, const AskedAccuracy& asked, lattice::AccuracyOptions& how,
                std::int64_t starts);
/// Warns if an assumption of the chain is wrong, or else if its prediction differs significantly
/// from the full trials that it was built from.
void warn_of(const Options& options, const std::optional<lattice::HausmanCheck>& own,
             const std::vector<lattice::AssumptionCheck>& assumptions, bool is_recorded = false);
/// Warns if the chain's prediction differs significantly from its own full trials, and if the
/// accuracy asked for was not reached.
void warn_of(const Options& options, const lattice::PooledPrediction& prediction, double accuracy,
             bool is_recorded = false);

/// Warns if starts lie outside the range of starts that the matrix was built for.
void warn_of_range(const Options& options, const lattice::MatrixFile& file, const std::string& path,
                   const std::vector<dynamics::Entry>& starts);

/// lattice::add_starts: simulates gate runs from starts that the matrix lacks. Remarks how many
/// runs were added, and warns as for any prediction.
void add_starts(const Options& options, lattice::SceneMatrix& m, const std::string& path,
                const std::vector<dynamics::Entry>& starts);

/// Warns of keys without effect. Unless --quiet, also warns of keys that get scaled values of the
/// paper, of numbers computed from a push that an option replaces, and of a scene unlike any
/// walking animal or robot.
void warn_of_keys(const Options& options, const lattice::Scene& scene, lattice::RunsFrom from);
/// Whether --set or an option that varies keys gives forces.propulsion_N.
[[nodiscard]] bool replaces_push(const Options& options);
/// The warning for an option that replaces the push: the numbers that were computed from the push
/// stay as they are. Empty if there are none.
[[nodiscard]] std::string push_alone_changes(const lattice::Scene& scene);
/// warn_of_keys, then lattice::settle_method. Warns if the chosen method does not meet the
/// tolerance.
[[nodiscard]] std::optional<lattice::Settled> settle_method(const Options& options,
                                                            lattice::Scene& scene,
                                                            lattice::RunsFrom from);
/// lattice::states_of. Warns if quantile bins (auto) replace Table III's bins, which are then too
/// coarse for the scene.
[[nodiscard]] lattice::States states_of(const Options& options, const lattice::Scene& scene,
                                        const lattice::BinsChoice& choice,
                                        const std::vector<dynamics::BodyState>& starts);
/// Warns if the runs that made a matrix showed numerical faults.
void warn_of_faults(const Options& options, const lattice::MatrixFile& file,
                    const std::string& path);
/// lattice::scene_matrix of the matrix file `path`. Warns of keys without effect in `scene`, if one
/// is given, and of faults in the runs that made the matrix.
[[nodiscard]] lattice::SceneMatrix read_matrix(const Options& options, const std::string& path,
                                               const lattice::TomlFile* scene,
                                               const std::vector<std::string>& overrides);
/// lattice::start_in_bins. Warns if the start lies beyond every entry that open bins were made
/// from.
lattice::ChainStart checked_start(const Options& options, const dynamics::StateSpace& space,
                                  const lattice::FieldParams& field, const dynamics::Entry& entry,
                                  const std::string& name);
/// checked_start for each start of a scene.
void require_inside_bins(const Options& options, const std::vector<dynamics::Entry>& starts,
                         const lattice::Scene& scene, const dynamics::StateSpace& space);
/// checked_start. Also warns if the start shares the row of a tree's leaf, and remarks if the start
/// lies on an edge of its bin, so that the neighbouring bin would serve as well.
[[nodiscard]] lattice::ChainStart ready_start(const Options& options,
                                              const std::vector<dynamics::Transitions>& matrices,
                                              const lattice::Problem& problem,
                                              const dynamics::Entry& entry,
                                              const std::string& name);
/// The exit_status of a result with this health. Warns of numerical faults; `where` is put in front
/// of the warning.
[[nodiscard]] int status_of(const Options& options, const dynamics::Health& health,
                            const std::string& where = "");

}  // namespace gatewalk::cli
