// SPDX-License-Identifier: MIT
#include <utility>

#include "cli/fields/schema.h"
#include "cli/film/replay.h"
#include "cli/paper/report.h"
#include "cli/render/analysis.h"
#include "cli/render/best_start.h"
#include "cli/render/chain_error.h"
#include "cli/render/cross_validation.h"
#include "cli/render/cut_tracks.h"
#include "cli/render/design.h"
#include "cli/render/fidelity.h"
#include "cli/render/field_runs.h"
#include "cli/render/files.h"
#include "cli/render/fit.h"
#include "cli/render/gate_runs.h"
#include "cli/render/landscape.h"
#include "cli/render/limits.h"
#include "cli/render/matrix.h"
#include "cli/render/meaning.h"
#include "cli/render/order.h"
#include "cli/render/plan.h"
#include "cli/render/power.h"
#include "cli/render/prediction.h"
#include "cli/render/rare.h"
#include "cli/render/sweep.h"
#include "cli/render/validation.h"
#include "cli/render/work_precision.h"
#include "dynamics/disc/disc_section.h"

namespace gatewalk::cli {
namespace {

/// `example`: a result whose lists have an item wherever an item cannot be made by default.
template <class Result>
ResultOf of(const char* command, Result example = {}) {
  return {command, [example = std::move(example)](Fields& out) { describe(out, example); }};
}

dynamics::StateSpace states() {
  const dynamics::Section& section = dynamics::disc_section();
  return {section, std::vector<dynamics::Tree>(section.faces.size())};
}

/// An example file with a second type of gate.
lattice::MatrixFile matrix_file() {
  const dynamics::Transitions t(states());
  return {.transitions = t, .text = {{"title", ""}}, .types = {{"", t}}};
}
ShownMatrix shown_matrix() { return {"", matrix_file()}; }

/// The result for gates, or for cells of recorded runs and programs.
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
  return {.shown = ShownField(scene),
          .costs = lattice::FieldCosts(1.0),
          .tally = lattice::FieldTally(scene.field)};
}

PredictResult prediction() {
  const lattice::EndingShares shares{std::array<double, markov::kEndings>{}};
  PredictResult example{.shown = ShownField(lattice::Scene()),
                        .given = {std::optional<dynamics::Entry>()}};
  example.of_matrix.emplace().states.resize(1);
  example.of_matrix->prediction.starts.resize(1, {.shares = shares});
  example.of_runs.emplace().prediction.starts.resize(1);
  return example;
}

std::size_t gates_in(const lattice::FieldParams& field) {
  return static_cast<std::size_t>(field.columns * field.rows);
}

lattice::Scene mixed() {
  lattice::Scene example;
  example.terrain.emplace().type_of_cell.resize(gates_in(example.field));
  return example;
}

DesignedScene design() {
  DesignedScene example;
  example.before = example.after = mixed();
  return example;
}

FittedScene fit() {
  FittedScene example;
  example.ranges.resize(1);
  example.fit.numbers.resize(1);
  example.fit.outcomes.endings = true;
  example.fit.groups.resize(1);
  example.fit.groups[0].outcomes = {0};
  return example;
}

PlannedField plan() {
  const lattice::Policy policy{states(), {.field = {0, 0}}};
  PlannedField example{.shown = lattice::Scene(),
                       .actions = {""},
                       .methods = {{}},
                       .plan = {{}, policy},
                       .thrift = lattice::ThriftOptions()};
  example.plan.alone.resize(1);
  example.plan.gains.resize(1);
  example.plan.usage.resize(gates_in(example.shown.field));
  example.plan.by_cell = lattice::Plan::ByCell{.policy = policy};
  example.plan.front.push_back({.policy = policy});
  return example;
}

FoundStart found_start() {
  FoundStart example{.shown = lattice::Scene(),
                     .own = {},
                     .ranges = {{0, 0.0, 1.0}},
                     .columns = {0},
                     .found = {{}, {states(), {.field = {1, 1}}}, {}}};
  example.found.chances.inputs = example.found.space.size();
  example.found.chances.value.resize(static_cast<std::size_t>(example.found.space.size()));
  return example;
}

/// The result for a scene with actions, or without.
void describe_plan(Fields& out) {
  out.either(
      true, [](Fields& f) { describe(f, plan()); }, [](Fields& f) { describe(f, found_start()); });
}

RareResult rare() {
  RareResult example;
  example.event = {.splitting = {.rows = {{}}, .health = {}}, .chain = {0.0}};
  return example;
}

Report report() {
  Report example;
  example.sections.resize(1);
  return example;
}

AnalysedField analyze() {
  const lattice::Scene scene;
  const dynamics::StateSpace space = dynamics::table3_space(scene.gate);
  AnalysedField example{.shown = ShownField(scene), .analysis = {.space = space}};
  example.shown.types = {"s"};
  lattice::Analysis& a = example.analysis;
  a.costs.resize(space.section().costs.size());
  a.costs_of.fill(a.costs);
  a.endless.emplace().states.resize(static_cast<std::size_t>(space.size()));
  a.endless_boundaries.resize(space.section().faces.size());
  a.type_trapping.resize(1);
  a.types.resize(1);
  example.parameters.effects.resize(1);
  example.parameters.effects.front().of_type.resize(1);
  example.direct = DirectTrials{lattice::FieldTally(scene.field), lattice::FieldCosts(1.0)};
  example.passage.emplace();
  RangedShares& shares = example.shares.emplace();
  shares.ranges.resize(1);
  shares.found.indices.first.resize(1);
  shares.found.indices.total.resize(1);
  return example;
}

SweepResult sweep() {
  SweepResult example;
  example.axes.push_back({"", {""}});
  example.points.emplace_back().values = {""};
  return example;
}

TraceResult trace() {
  TraceResult example{.recordings = {.gates = dynamics::GateParams(), .runs = {{}}, .health = {}}};
  example.film.runs.resize(1);
  return example;
}

lattice::FieldTally no_trials() { return lattice::FieldTally(lattice::FieldParams()); }

/// An example with one point, the best of its start.
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
  const lattice::FidelityRun run{.tally = no_trials(), .change = lattice::PairedChange()};
  FidelityResult example;
  example.study.variants.resize(3);
  example.study.starts = {{.start = {}, .runs = {run, run, run}}};
  return example;
}

/// The result for a scene, for recorded runs, or with --order.
void describe_validate(Fields& out) {
  const lattice::EndingShares none{std::array<double, markov::kEndings>{}};
  ValidateResult of_scene{.shown = lattice::Scene()};
  of_scene.validation.starts.push_back({.dynamics = no_trials(),
                                        .dynamics_endings = none,
                                        .walks_endings = none,
                                        .exact_endings = none});
  lattice::MemoryStudy memory;
  memory.outcomes = {"way", "trapped"};
  lattice::GatesAhead::Step& step = memory.ahead.steps.emplace_back();
  step.seen = step.predicted = {0.0, 0.0};
  step.excess_95.resize(2);
  of_scene.validation.memory = std::make_shared<const lattice::MemoryStudy>(std::move(memory));
  CrossValidationResult of_runs;
  of_runs.section = dynamics::disc_section();
  OrderResult of_order;
  of_order.study.orders.emplace_back();
  out.either(
      true, [&](Fields& f) { describe(f, of_scene); },
      [&](Fields& f) {
        f.optional(true, [&](Fields& halves) { describe_halves(halves, of_runs); });
        f.optional(true, [&](Fields& order) { describe_order(order, of_order); });
        describe_recorded(f, of_runs.recorded);
        describe_made_by(f, of_runs.made_by);
      });
}

}  // namespace

const std::vector<ResultOf>& results() {
  static const std::vector<ResultOf> all{
      // One result in each line.
      of("analyze", analyze()),
      {"build", describe_build},
      of("chart chain", chain_error()),
      of("chart field", fidelity()),
      of<LimitsResult>("chart limits"),
      of("chart methods", ChartResult{{{}}, {{}}}),
      of("design", design()),
      of<ExportResult>("export"),
      of("fit", fit()),
      of<GateResult>("gate"),
      of("import", ImportedMatrix{shown_matrix(), {}, {}}),
      of<LandscapeResult>("landscape"),
      of("lattice", trials()),
      of("passages", cut_tracks()),
      {"plan", describe_plan},
      of<PowerResult>("power"),
      of("predict", prediction()),
      of("rare", rare()),
      of("reproduce", report()),
      of("sample", SampleResult{}),
      of("scene", SceneResult{mixed(), {}, {}}),
      of("show", shown_matrix()),
      of("sweep", sweep()),
      of("trace", trace()),
      {"validate", describe_validate},
      of("walk", WalkResult{.shown = ShownField(lattice::Scene())}),
  };
  return all;
}

}  // namespace gatewalk::cli
