// SPDX-License-Identifier: MIT
#include <utility>

#include "cli/render/gate_runs.h"
#include "cli/render/rare.h"
#include "cli/render/schema.h"
#include "cli/render/stability.h"
#include "cli/render/work_precision.h"

namespace gatewalk::cli {
namespace {

/// `example`: a result whose lists have an item wherever this cannot be one made by default.
template <class Result>
ResultOf of(const char* command, Result example = {}) {
  return {command, [example = std::move(example)](Fields& out) { describe(out, example); }};
}

RareResult rare() {
  RareResult example;
  example.event = {.splitting = {.rows = {{}}, .health = {}}, .chain = {0.0}};
  return example;
}

}  // namespace

const std::vector<ResultOf>& results() {
  static const std::vector<ResultOf> all{of("chart", ChartResult{{{}}, {{}}}),
                                         of<GateResult>("gate"), of("rare", rare()),
                                         of<StabilityResult>("stability")};
  return all;
}

}  // namespace gatewalk::cli
