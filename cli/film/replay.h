// SPDX-License-Identifier: MIT
#pragma once
/// The result of `trace`; and runs to be watched: a page with an animation, made of a film.

#include <optional>
#include <string>

#include "cli/fields/fields.h"
#include "cli/film/film.h"
#include "cli/render/choice.h"
#include "cli/render/provenance.h"

namespace gatewalk::cli {

/// The result of `trace`.
struct TraceResult {
  lattice::Recordings recordings;
  Film film{};                         // of the recordings
  std::optional<double> film_speed{};  // of a video: seconds of a run in one of it
  std::optional<lattice::Settled> method{};
  ActionMethods may_do{};  // under a policy
  Provenance made_by{};
};
void describe(Fields& out, const TraceResult& result);

/// Its keys, which are those that the page reads; `gatewalk help trace --result` says what they
/// mean.
void describe(Fields& out, const Film& film);

/// A whole page with the animation of all runs of a film; it loads nothing from anywhere. Where
/// data are missing, the page says which.
[[nodiscard]] std::string replay_page(const Film& film);

}  // namespace gatewalk::cli
