// SPDX-License-Identifier: MIT
#include <utility>

#include "cli/render/chain_error.h"
#include "cli/render/cut_tracks.h"
#include "cli/render/fidelity.h"
#include "cli/render/field_runs.h"
#include "cli/render/files.h"
#include "cli/render/gate_runs.h"
#include "cli/render/matrix.h"
#include "cli/render/prediction.h"
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

/// With a gate of another type.
lattice::MatrixFile matrix_file() {
  const dynamics::Transitions t(dynamics::StateSpace(
      dynamics::disc_section(), std::vector<dynamics::Tree>(dynamics::kBoundaries), {}));
  return {.transitions = t,
          .text = {{"title", ""}},
          .arrays = {},
          .types = {{"", t}},
          .state_names = {}};
}
ShownMatrix shown_matrix() { return {"", matrix_file()}; }

/// Of gates, or of cells that are not ours.
void describe_build(Fields& out) {
  out.either(
      true, [](Fields& f) { describe(f, MadeMatrix{.file = matrix_file(), .states = {}}); },
      [](Fields& f) {
        describe(f, CellMatrixResult{shown_matrix(), {}, {}});
      });
}

CutResult cut_tracks() {
  CutResult example{{}, {}};
  example.cell.map.section = dynamics::disc_section();
  return example;
}

FieldRun trials() {
  const lattice::Scene scene;
  return {ShownField(scene),
          dynamics::Entry(),
          Provenance(),
          lattice::FieldCosts(1.0),
          lattice::ExitCounts(scene.field),
          std::nullopt,
          lattice::FieldTally(scene.field)};
}

PredictResult prediction() {
  const lattice::EndingShares shares{std::array<double, markov::kEndings>{}};
  PredictResult example{.shown = ShownField(lattice::Scene()), .given = {Start()}};
  example.of_matrix = {.prediction = {.starts = {{.shares = shares}}}, .states = {{}}};
  example.of_runs = {.prediction = {.starts = {{}}}};
  return example;
}

RareResult rare() {
  RareResult example;
  example.event = {.splitting = {.rows = {{}}, .health = {}}, .chain = {0.0}};
  return example;
}

lattice::FieldTally no_trials() { return lattice::FieldTally(lattice::FieldParams()); }

/// With one point, the best of its start.
ChainErrorResult chain_error() {
  ChainErrorResult example;
  example.chart.curves.push_back({.space = matrix_file().transitions.space});
  example.chart.truths.push_back({.tally = no_trials()});
  example.chart.points.resize(1);
  example.chart.points[0].answers = {{.exact = {.total_variation = 1.0}}};
  example.chart.trees.resize(1);
  example.chart.direct.resize(1);
  return example;
}

FidelityResult fidelity() {
  const lattice::FidelityRun run{
      .tally = no_trials(), .final_gates = {}, .change = lattice::PairedChange()};
  FidelityResult example;
  example.study.variants.resize(3);
  example.study.starts = {{.start = {}, .runs = {run, run, run}}};
  return example;
}

}  // namespace

const std::vector<ResultOf>& results() {
  static const std::vector<ResultOf> all{
      // One in each line.
      {"build", describe_build},
      of("chart", ChartResult{{{}}, {{}}}),
      of("chart-chain", chain_error()),
      of("chart-field", fidelity()),
      of<ExportResult>("export"),
      of<GateResult>("gate"),
      of("import", ImportedMatrix{shown_matrix(), {}, {}}),
      of("lattice", trials()),
      of("passages", cut_tracks()),
      of("predict", prediction()),
      of("rare", rare()),
      of("sample", SampleResult{}),
      of("show", shown_matrix()),
      of<StabilityResult>("stability"),
      of("walk", WalkResult{.shown = ShownField(lattice::Scene())}),
  };
  return all;
}

}  // namespace gatewalk::cli
