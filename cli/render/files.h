// SPDX-License-Identifier: MIT
#pragma once
/// Results of the commands that write files for others: `export` and `sample`.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/fields/fields.h"
#include "cli/render/provenance.h"

namespace gatewalk::cli {

/// Labels of the absorbing states of an exported chain, in their order after all other states.
inline constexpr std::array kEndingLabels{"trapped",   "crossed", "left_side",    "right_side",
                                          "went_back", "cut_off", "never_sampled"};

/// The result of `export`.
struct ExportResult {
  std::int64_t states = 0;
  std::optional<std::int64_t> transitions{};   // of a matrix
  std::optional<std::int64_t> first_ending{};  // of a whole field: its number
  std::optional<std::int64_t> trajectories{};  // of trials
  Provenance made_by{};
};
void describe(Fields& out, const ExportResult& result);

struct Sample {
  std::string name, file, about;
};
/// The result of `sample`: all samples, or one of them.
struct SampleResult {
  std::vector<Sample> samples{};
  std::optional<std::string> text{};  // content of the one sample
};
void describe(Fields& out, const SampleResult& result);
[[nodiscard]] std::string table_of(const std::vector<Sample>& samples);

}  // namespace gatewalk::cli
