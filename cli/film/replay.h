// SPDX-License-Identifier: MIT
#pragma once
/// The result of `trace`, and a page that plays runs as an animation.

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
  Film film{};                         // made from the recordings
  std::optional<double> film_speed{};  // of a video: seconds of a run in a second
  std::optional<lattice::Settled> method{};
  ActionMethods may_do{};  // under a policy
  Provenance made_by{};
};
void describe(Fields& out, const TraceResult& result);

/// Describes the keys of a film, which the replay page reads. `gatewalk help trace --result`
/// explains them.
void describe(Fields& out, const Film& film);

/// A complete page with the animation of all runs of a film, which loads nothing from elsewhere. If
/// data are missing, the page says which.
[[nodiscard]] std::string replay_page(const Film& film);

}  // namespace gatewalk::cli
