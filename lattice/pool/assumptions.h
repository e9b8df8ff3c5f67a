// SPDX-License-Identifier: MIT
#pragma once
/// Which assumption of a chain is wrong? Each assumption is dropped in another chain of the same
/// runs, a relaxed chain, and both predictions are compared (Hausman, Econometrica 46, 1978).
/// The runs are the same, so the difference has little noise. It shows errors that the shares of
/// the full trials are too noisy to show.

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "lattice/field/field_params.h"
#include "lattice/pool/pool_answers.h"
#include "lattice/pool/pooled_prediction.h"
#include "lattice/pool/run_pool.h"

namespace gatewalk::lattice {

/// The key of an assumption in results and files: "face_before".
[[nodiscard]] std::string_view key_of(Assumption assumption);

/// Checks every assumption of the chain of these runs. There are no checks where answers come from
/// Monte Carlo walks, or where bodies pass one cell only. `starts`: each with runs of its own, or
/// all scattered trials (monostate); predictions are means over the starts. `per_leaf`: of the
/// chain. `coordinates`: number by which its states differ. `chain`, `small_leaves`: predictions of
/// the chain and of a chain with smaller leaves, if they are known already.
[[nodiscard]] std::vector<AssumptionCheck> check_assumptions(
    const dynamics::CellMap& map, const FieldParams& field, const RunPool& pool,
    const std::vector<FirstRow>& starts, int per_leaf, int coordinates, std::uint64_t seed,
    std::optional<GroupedMaps> chain = {}, const std::optional<GroupedMaps>& small_leaves = {});

}  // namespace gatewalk::lattice
