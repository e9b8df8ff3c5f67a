// SPDX-License-Identifier: MIT
#pragma once
/// Numbers that sit on a step: 1 % more or less of one turns a gate that bodies cross into one that
/// keeps them. Little noise makes such steps; a measured number is seldom known to 1 %.

#include <cstdint>
#include <string_view>
#include <vector>

#include "dynamics/disc/params.h"

namespace gatewalk::dynamics {

/// What becomes of a body, whichever side it takes.
enum class GateFate : std::uint8_t { crosses, leaves, trapped };

struct Deciding {
  std::string_view words;  // "the stiffness", of both beams
  GateFate less, more;     // of every run with 1 % less, 1 % more of it
};
/// Runs the gate from `start` with 1 % less and 1 % more of each number by itself: once without a
/// random force, else up to 20 times. Numbers with which runs end differently among themselves
/// decide nothing.
[[nodiscard]] std::vector<Deciding> deciding_numbers(const GateParams& p, const BodyState& start);

}  // namespace gatewalk::dynamics
