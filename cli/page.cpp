// SPDX-License-Identifier: MIT
#include "cli/page.h"

#include <fmt/core.h>

#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "cli/arguments.h"
#include "cli/fields/json.h"
#include "cli/fields/text.h"
#include "cli/render/analysis.h"
#include "cli/render/final_gates.h"
#include "cli/render/version.h"
#include "cli/web/embedded.h"
#include "cli/web/html.h"
#include "lattice/source/start_text.h"

namespace gatewalk::cli {
namespace {

constexpr std::size_t kMostBytes = 2'000'000;
constexpr std::int64_t kMostGates = 441, kMostNumbers = 400'000;

/// The prediction for every state in which a body may start.
struct PageStates {
  dynamics::StateSpace space;
  lattice::StartStates states;
  std::int64_t gate_runs = 0;
};

/// The faces through which a body may enter the first gate.
std::vector<int> start_faces(const lattice::Source& s) {
  if (s.scene) return {s.problem.start.face};
  std::vector<int> all(s.problem.map().section.faces.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// Every state of a matrix of bins, with the answers of gatewalk predict.
PageStates states_of_bins(const Options& options, const lattice::Source& s) {
  const dynamics::Transitions& own = s.file->transitions;
  const dynamics::StateSpace& space = own.space;
  const lattice::FieldParams& field = s.problem.field;
  PageStates out{space, {}, 0};
  out.states.of_leaf.assign(static_cast<std::size_t>(space.size()), -1);
  for (const std::int64_t trials : own.trials) out.gate_runs += trials;
  std::vector<lattice::ChainStart> starts;
  for (const int face : start_faces(s))
    for (int state = space.first(face); state < space.first(face + 1); ++state) {
      const std::int64_t runs = own.trials[static_cast<std::size_t>(state)];
      if (runs == 0) continue;
      out.states.of_leaf[static_cast<std::size_t>(state)] = static_cast<int>(starts.size());
      starts.push_back({{field.start_column(), field.start_row, state}});
      out.states.states.push_back({.first_leaf = state, .runs = runs, .gates = {}, .gates_95 = {}});
    }
  auto prediction =
      lattice::predict(lattice::counted_of(s), field, starts, {}, options.seed(), options.work());
  for (std::size_t i = 0; i < starts.size(); ++i) {
    out.states.states[i].endings =
        shown_endings(prediction.starts[i].shares, prediction.starts[i].final);
    out.states.states[i].gates = std::move(prediction.starts[i].final.final_cells);
  }
  return out;
}

PageStates states_of_trees(const lattice::Source& s, const lattice::RunPool& pool,
                           const lattice::AnalysedChain& chain,
                           const lattice::ChainOutcomes& outcomes) {
  return {chain.space,
          lattice::start_states(s.problem, pool, chain, outcomes, start_faces(s),
                                s.accuracy.per_leaf, kMostNumbers),
          pool.gate_runs()};
}

/// The chain from the source's first start. A chain of trees has groups, for its intervals.
lattice::AnalysedChain chain_from(const lattice::Source& s, const lattice::RunPool& pool) {
  return lattice::analysed_chain(s.problem, pool, pool.first_row(s.starts.front()),
                                 s.accuracy.per_leaf);
}
lattice::AnalysedChain chain_from(const lattice::Source& s) {
  if (s.pool) return chain_from(s, *s.pool);
  return lattice::analysed_chain(
      s.problem, s.matrices(),
      lattice::chain_start(s.file->transitions.space, s.problem.field, *s.starts.front()).start);
}

/// The states of the source's file, if it has one. `chain` is the chain of the source's pool, which
/// may have grown since the file was read.
PageStates states_of(const Options& options, const lattice::Source& s,
                     const std::optional<lattice::RunPool>& of_file,
                     const lattice::AnalysedChain& chain, const lattice::ChainOutcomes& outcomes) {
  if (!s.pool) return states_of_bins(options, s);
  // The first runs of a new start change no other state.
  if (!of_file || of_file->trials() == s.pool->trials())
    return states_of_trees(s, *s.pool, chain, outcomes);
  const lattice::AnalysedChain before = chain_from(s, *of_file);
  return states_of_trees(s, *of_file, before,
                         lattice::chain_outcomes(before, s.problem.field, options.work()));
}

/// The analysis of this chain, as gatewalk analyze makes it.
AnalysedField analysis_of(const Options& options, const lattice::Source& s,
                          const lattice::AnalysedChain& chain) {
  return {.shown = ShownField(s),
          .analysis = lattice::analyze(
              s.problem, chain,
              {.lumping = lattice::LumpingParts(s.problem.map().section.coordinates.size(), 1),
               .seed = options.seed()},
              options.work())};
}

std::string name_of_field(const lattice::Source& s) {
  const lattice::FieldParams field = ShownField(s).field;
  return fmt::format("Through {} x {} {}", field.columns, field.rows, s.scene ? "gates" : "cells");
}

}  // namespace

TextOption add_page(Options& options) {
  return options.output_file(
      "page", "FILE.html",
      "write a page to play with, for any browser: endings and final gates of any "
      "start, what becomes of bodies from each gate, times and work",
      Options::Content::binary);
}

void check_page(const TextOption& page, const lattice::Source& s) {
  if (!page) return;
  if (!has_pages())
    throw UsageError("--page: needs pages: this gatewalk was built without (GATEWALK_PAGES=OFF)");
  if (s.is_imported)
    throw UsageError(fmt::format(
        "--page: {} was made elsewhere: a page is of a scene, or of a matrix of gatewalk build",
        s.path));
  const lattice::FieldParams& field = s.problem.field;
  if (std::int64_t{field.columns} * field.rows > kMostGates)
    throw UsageError(
        fmt::format("--page: shows fields of up to {} gates, this one has {} x {} (--set "
                    "field.columns=N, --set field.rows=N make it smaller)",
                    kMostGates, field.columns, field.rows));
}

std::optional<lattice::RunPool> runs_of_file(const TextOption& page, const lattice::Source& s) {
  if (!page || !s.file || !s.pool) return {};
  return *s.pool;
}

std::vector<PageAnswer> page_answers(const lattice::PooledPrediction& prediction) {
  std::vector<PageAnswer> starts;
  for (const lattice::StartAnswer& a : prediction.starts)
    starts.push_back({.start = a.as_seen ? std::optional<dynamics::Entry>()
                                         : std::optional<dynamics::Entry>(a.start),
                      .final = a.final,
                      .endings = a.endings,
                      .gates_95 = a.gates_95,
                      .from = a.from_trials ? "trials" : "chain",
                      .error_95 = a.error.total_variation,
                      .first_runs = a.first_runs});
  return starts;
}

std::vector<PageAnswer> page_answers(const lattice::Prediction& prediction,
                                     const lattice::Source& s) {
  std::vector<PageAnswer> starts;
  for (std::size_t k = 0; k < s.starts.size(); ++k) {
    const lattice::StartPrediction& p = prediction.starts[k];
    const auto row = static_cast<std::size_t>(p.start.start.input);
    starts.push_back({.start = s.starts[k],
                      .final = p.final,
                      .endings = p.shares,
                      .from = "matrix",
                      .error_95 = std::nan(""),
                      .first_runs = s.file->transitions.trials[row]});
  }
  return starts;
}

void write_page(const Options& options, const TextOption& file, const lattice::Source& s,
                const std::optional<lattice::RunPool>& of_file,
                const std::vector<PageAnswer>& starts, const AnalysedField* analysis) {
  if (!file) return;
  const lattice::AnalysedChain chain = chain_from(s);
  const lattice::ChainOutcomes outcomes =
      lattice::chain_outcomes(chain, s.problem.field, options.work());
  const PageStates states = states_of(options, s, of_file, chain, outcomes);
  const std::int64_t bodies = s.pool ? s.pool->bodies() : 0,
                     gate_runs = s.pool ? s.pool->gate_runs() : states.gate_runs;
  const ShownField shown = ShownField(s);
  std::optional<AnalysedField> made_here;
  if (!analysis) analysis = &made_here.emplace(analysis_of(options, s, chain));
  const AnswerPage page{.title = name_of_field(s),
                        .shown = shown,
                        .scene = s.scene ? &*s.scene : nullptr,
                        .starts = starts,
                        .space = states.space,
                        .faces = start_faces(s),
                        .states = states.states,
                        .cells = lattice::cells_ahead(outcomes, s.problem.field, bodies, gate_runs),
                        .moves = outcomes.whole.moves,
                        .chain = {.has_trees = s.pool != nullptr,
                                  .states = chain.space.size(),
                                  .gate_runs = states.gate_runs,
                                  .asked = s.path,
                                  .is_matrix = s.file != nullptr,
                                  .can_run = !s.is_recorded() && s.pool != nullptr},
                        .analysis = *analysis};
  const Provenance made_by = options.provenance(s);
  const std::string words =
      endings_text(shown_endings(starts.front().endings, starts.front().final),
                   "of bodies from " + lattice::title_of(shown.map.section, starts.front().start)) +
      rest_text(rest_of(starts.front().final));
  const auto text_of_page = [&](bool gates_95) {
    return filled(carried_file("answer.html"),
                  {{"title", escaped(page.title)},
                   {"cell", s.scene ? "gate" : "cell"},
                   {"words", escaped(words)},
                   {"css", std::string(carried_file("report.css"))},
                   {"answer_css", std::string(carried_file("answer.css"))},
                   {"theme", std::string(carried_file("theme.js"))},
                   {"script", std::string(carried_file("answer.js"))},
                   {"command", escaped(made_by.command)},
                   {"version", escaped(fmt::format("{} {}", kVersion, kCommit))},
                   {"scene", escaped((s.scene ? made_by.scene : made_by.cell).value_or(""))},
                   {"answer", script_json(json_text(
                                  [&](Fields& out) { describe(out, page, gates_95); }, -1))}});
  };
  std::string text = text_of_page(true);
  if (text.size() > kMostBytes) text = text_of_page(false);
  if (text.size() > kMostBytes)
    throw std::runtime_error(fmt::format(
        "no page: it would have {} MB, at most 2 MB are written; the numbers are written",
        fixed(1e-6 * static_cast<double>(text.size()), 1)));
  options.write(file.value(), text);
}

}  // namespace gatewalk::cli
