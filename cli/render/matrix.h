// SPDX-License-Identifier: MIT
#pragma once
/// A matrix file: what it keeps beside its counts, and all of it as JSON and as a table.

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "cli/render/figure.h"
#include "cli/render/json_fwd.h"
#include "cli/render/provenance.h"
#include "lattice/gate_chain.h"
#include "lattice/scene/bins.h"
#include "lattice/scene/settle.h"

namespace gatewalk::cli {

/// Its record "status", "state_space" or "method"; null where it has none. Throws markov::BadFile
/// naming `path` when one is damaged; a damaged status is discarded JSON.
[[nodiscard]] Json recorded(const lattice::MatrixFile& file, const std::string& path,
                            const std::string& key);
[[nodiscard]] Json recorded_status(const lattice::MatrixFile& file);
/// The faults of the runs behind a recorded status, in one sentence; empty when none were seen.
[[nodiscard]] std::string faults_recorded(const Json& status);

/// What is said of matrices that were made, one for each type of gate: "bins" is the factor on
/// Table III's or their name, and `states` the state space as JSON. A tree has no number of trials
/// per row.
struct MadeMatrix {
  const std::vector<dynamics::Transitions>& matrices;  // the first has the health of all
  const Json &bins, &states;
  const std::optional<lattice::Settled>& settled;
  std::optional<std::int64_t> trials_per_row;
};
/// The factor on Table III's bins, or the bins' name.
[[nodiscard]] Json bins_json(const lattice::BinsChoice& choice);
/// Throws std::invalid_argument where a scene is larger than what a matrix file keeps of it.
void require_keepable(const lattice::Scene& scene);
/// All that a file of this matrix keeps beside its counts, by key.
[[nodiscard]] std::map<std::string, std::string> record_of(const MadeMatrix& made,
                                                           const lattice::Scene& scene,
                                                           const Provenance& provenance);
/// The matrix written to `path`, without its counts and without "made_by".
[[nodiscard]] Json summary_json(const MadeMatrix& made, const lattice::MatrixFile& file,
                                const std::string& path);
[[nodiscard]] std::string summary_table(const lattice::MatrixFile& file, const std::string& path);

[[nodiscard]] Json to_json(const lattice::MatrixFile& file, const std::string& path);
/// What is shown besides the summary: a line per row, all outputs of one row (from 0, in the order
/// of lattice::shown_order, as all of them).
struct ShownRows {
  bool all = false;
  std::optional<int> one;
};
[[nodiscard]] std::string table_of(const lattice::MatrixFile& file, const std::string& path,
                                   const ShownRows& shown);

/// The matrix as a picture: states grouped by boundary, in blocks if they are many.
[[nodiscard]] Figure figure_of(const dynamics::Transitions& t);

}  // namespace gatewalk::cli
