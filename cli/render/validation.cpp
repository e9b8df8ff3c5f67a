// SPDX-License-Identifier: MIT
#include "cli/render/validation.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include "cli/fields/text.h"
#include "cli/render/choice.h"
#include "cli/render/exits.h"
#include "cli/render/field_ends.h"
#include "cli/render/final_gates.h"
#include "cli/render/health.h"
#include "cli/render/start.h"
#include "cli/render/tested_shares.h"

namespace gatewalk::cli {

std::string verdict(const lattice::StartValidation& r) {
  const lattice::JointTest& j = r.joint_test;
  if (r.finding() != lattice::Finding::own_error)
    return fmt::format(
        "the chain agrees with the dynamics as far as these trials and this matrix can tell ({})",
        p_words(j.p));
  std::vector<std::string> said;
  for (const EndingName& e : kEndingNames) {
    if (!j.differs(e.ending)) continue;
    const auto at = static_cast<std::size_t>(e.ending);
    said.push_back(
        fmt::format("{} {} % in the dynamics, {} % by the chain", e.name,
                    with_interval(r.dynamics_endings.share[at], r.dynamics_endings.interval[at]),
                    with_interval(r.exact_endings.share[at], r.exact_endings.interval[at])));
  }
  if (j.differs(markov::Ending::unsampled))
    said.push_back(
        fmt::format("states never sampled, {} by the chain", percent(r.exact.unsampled(), 1.0, 2)));
  if (p_of_gates(j) <= lattice::JointTest::kLevel)
    said.push_back(fmt::format("final gates, total variation {} (chance: {})",
                               fixed(j.total_variation.seen, 3),
                               fixed(j.chance_total_variation, 3)));
  return fmt::format(
      "the chain differs from the dynamics by more than chance in trials and matrix makes "
      "({}):{}{}",
      p_words(j.p), said.empty() ? "" : " ", fmt::join(said, "; "));
}

double trial_over_walk(const lattice::StartValidation& r) {
  return r.dynamics_seconds / static_cast<double>(r.dynamics.trials) /
         (r.walks_seconds / static_cast<double>(r.walks.walks));
}

dynamics::Transitions::Totals totals_of(const ValidatedMatrix& matrix) {
  dynamics::Transitions::Totals total;
  for (const dynamics::Transitions& t : matrix.matrices) total += t.totals();
  if (matrix.states && matrix.states->trees) total.runs = matrix.states->trees->gate_runs;
  return total;
}

std::int64_t traverse_sides(const lattice::Validation& v) {
  return v.entries_by[dynamics::Boundary::right_traverse] +
         v.entries_by[dynamics::Boundary::left_traverse];
}

namespace {

double share(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

/// Mean and standard deviation.
void describe_spread(Fields& out, const Field& of, std::string_view over, double mean, double sd) {
  out.object(Label(of.key, of.meaning), [&](Fields& f) {
    f.number({"mean", of.unit, fmt::format("mean over the {}", over)}, mean);
    f.number({"sd", of.unit, fmt::format("standard deviation over the {}", over)}, sd);
  });
}

/// The paper's procedure: repeats of 100 trials of the full dynamics.
void describe_paper_sized(Fields& out, const lattice::StartValidation& r) {
  const lattice::PaperSized& p = r.paper_sized;
  const auto with_floor = [&](const Field& of, const lattice::MeanAndSd& m, std::string_view key,
                              double floor) {
    describe_spread(out, of, "parts of 100 trials", m.mean(), m.sd());
    out.number(
        {key, of.unit, "floor: mean that sampling noise alone would give for a perfect chain"},
        floor);
  };
  out.count({"repeats", "1", "number of parts of 100 trials"}, p.exact_rmse.n);
  with_floor({"exact_corrcoef", "1",
              "correlation of the final gates of 100 trials with the exact chain's"},
             p.exact_corrcoef, "exact_corrcoef_floor", r.floor_100_exact.corrcoef);
  with_floor({"exact_rmse_per_100", "trials per 100",
              "RMSE of the final gates of 100 trials from the exact chain's"},
             p.exact_rmse, "exact_rmse_per_100_floor", r.floor_100_exact.rmse_per_100);
  out.number({"exact_corrcoef_rmse_correlation", "1",
              "correlation of exact_corrcoef with exact_rmse_per_100 over the parts"},
             p.exact_correlation());
  with_floor({"walks_corrcoef", "1",
              "correlation of the final gates of 100 trials with those of 100 walks"},
             p.walks_corrcoef, "walks_corrcoef_floor", r.floor_100_walks.corrcoef);
  with_floor({"walks_rmse_per_100", "trials per 100",
              "RMSE of the final gates of 100 trials from those of 100 walks"},
             p.walks_rmse, "walks_rmse_per_100_floor", r.floor_100_walks.rmse_per_100);
}

/// The maps of the dynamics, the walks and the exact chain.
void describe_maps(Fields& out, const Label& label, const markov::CellCounts& dynamics,
                   const markov::CellCounts& walks, const markov::CellProbabilities& exact) {
  out.object(label, [&](Fields& f) {
    f.grid({"dynamics", "1", "number of trials of the full dynamics, by gate"}, dynamics);
    f.grid({"walks", "1", "number of walks through the chain, by gate"}, walks);
    f.grid({"exact", "1", "share of all bodies by the exact chain, by gate"}, exact);
  });
}

void describe(Fields& out, const lattice::StartValidation& r,
              const std::optional<lattice::PaperStart>& paper, const ShownField& shown) {
  out.text({"verdict",
            "sentence: whether the chain differs from the dynamics by more than sampling noise"},
           verdict(r));
  out.object(
      {"trials_and_matrix",
       "test of chain against dynamics, with the sampling noise of trials and matrix"},
      [&](Fields& f) {
        describe(f, r.joint_test);
        f.count({"resampled_matrices", "1", "resampled matrices behind the test"}, r.resampled);
      });
  out.object({"start", "how bodies enter the field"}, [&](Fields& f) {
    describe(f, shown.map.section, r.start);
    f.flag({"clamped",
            "whether the start lies outside all bins, so that the chain starts in the nearest one"},
           r.chain_start.clamped);
  });
  out.if_any(
      {"paper", "values that the paper prints for this start in Table IV"}, paper,
      [](Fields& printed, const lattice::PaperStart& p) {
        printed.number({"corrcoef", "1", "correlation of the final gates as printed"}, p.corrcoef);
        printed.number({"rmse_per_100", "trials per 100", "RMSE of the final gates as printed"},
                       p.rmse);
      });
  out.object({"exact", "final gates of the dynamics compared with the exact chain's"},
             [&](Fields& f) {
               describe(f, r.exact_against);
               describe_spread(f,
                               {"total_variation_of_matrix_sampling", "1",
                                "total variation that sampling noise of the matrix alone makes"},
                               "resampled matrices", r.matrix_noise_mean, r.matrix_noise_sd);
             });
  out.object(
      {"walks", "final gates of the dynamics compared with those of walks through the chain"},
      [&](Fields& f) { describe(f, r.walks_against); });
  out.object(
      {"at_100_trials", "as in the paper: parts of 100 trials, each compared with the chain"},
      [&](Fields& f) { describe_paper_sized(f, r); });
  out.object({"seconds", "wall-clock time"}, [&](Fields& f) {
    f.number({"dynamics", "s", "time of all trials, on the number of threads in threads"},
             r.dynamics_seconds);
    f.number({"walks", "s", "time of all walks, on the number of threads in threads"},
             r.walks_seconds);
    f.number({"exact", "s", "time of one exact prediction, on one thread"}, r.exact_seconds);
  });
  out.object({"speed_ratio", "how many times faster the chain is"}, [&](Fields& f) {
    f.number({"dynamics_trial_over_walk", "1", "time of a trial divided by the time of a walk"},
             trial_over_walk(r));
    f.number({"dynamics_over_exact", "1",
              "time of all trials divided by the time of one exact prediction"},
             r.dynamics_seconds / r.exact_seconds);
  });
  out.object(
      {"endings", "how bodies end: by trials and walks (numbers) and by the exact chain (shares)"},
      [&](Fields& f) {
        describe_endings(f, {"dynamics", "number of trials by ending"}, r.dynamics.endings,
                         static_cast<double>(r.dynamics.trials), r.dynamics_endings);
        describe_endings(
            f,
            Label("walks", "number of walks by ending")
                .bounded_by(
                    "95 % intervals of walks: sampling error of the walks, not of the matrix"),
            r.walks.endings, static_cast<double>(r.walks.walks), r.walks_endings);
        describe_endings(f,
                         Label("exact", "share of all bodies by ending")
                             .bounded_by("95 % intervals of exact: sampling error of the matrix; "
                                         "null: no resampled matrices"),
                         r.exact_endings);
      });
  out.object({"fates", "shares of all bodies by fate"}, [&](Fields& f) {
    f.object({"dynamics", "shares in the trials of the full dynamics"},
             [&](Fields& of) { describe_fates(of, r.dynamics); });
    f.object({"exact", "shares by the exact chain"},
             [&](Fields& of) { describe_fates(of, r.exact); });
  });
  describe_maps(out, {"final_gates", "bodies by the gate in which they end"},
                r.dynamics.final_cells, r.walks.final_cells, r.exact.final_cells);
  describe_maps(out, {"trapped_gates", "trapped bodies by the gate in which they end"},
                trapped_cells(r.dynamics), trapped_cells(r.walks), trapped_cells(r.exact));
  describe_maps(out,
                {"departed_gates", "bodies that leave the field, by the gate that they leave from"},
                departed_cells(r.dynamics), departed_cells(r.walks), departed_cells(r.exact));
  describe_exits(out, r.dynamics_exits, r.exact_exits, shown);
  const FieldEnds<double> ends = ends_of(r.exact, r.exact_endings);
  ends.describe_never_sampled(out);
  ends.describe_still_walking(out);
  out.if_any(
      {"force_memory",
       "test: the same trials with the random force drawn anew at each crossing between gates"},
      r.force ? std::optional(*r.force) : std::nullopt,
      [&](Fields& force, const auto& value) { describe(force, value); });
}

}  // namespace

void describe(Fields& out, const ValidateResult& result) {
  const lattice::Validation& v = result.validation;
  const ValidatedMatrix& matrix = result.matrix;
  out.count({"trials", "1", "trials of the full dynamics from each start"}, v.trials);
  out.count({"walks", "1", "walks through the chain from each start"}, v.walks);
  out.count({"left_out_matrices", "1",
             "resampled matrices left out of the intervals because bodies circle too long in them"},
            v.left_out.matrices);
  out.list_of({"starts", "results of each start"}, v.starts.size(), [&](Fields& f, std::size_t k) {
    describe(f, v.starts[k], result.papers.empty() ? std::nullopt : std::optional(result.papers[k]),
             result.shown);
  });
  out.object(
      {"crossings", "crossings from gate to gate in the trials of all starts"}, [&](Fields& f) {
        f.count({"between_gates", "1", "number of crossings"}, v.entries);
        f.optional(result.shown.mass.has_value(), [&](Fields& of) {
          of.number(
              {"RT_and_LT_share", "1",
               "share of the crossings through a side above the joint (right or left traverse)"},
              share(traverse_sides(v), v.entries));
        });
        f.optional(!result.shown.mass.has_value(), [&](Fields& of) {
          of.object(
              {"by_face", "number of crossings by face, for cells other than the paper's gate"},
              [&](Fields& faces) {
                const auto& names = result.shown.map.section.faces;
                for (std::size_t i = 0; i < names.size(); ++i)
                  faces.count(
                      Field(names[i].name, "1", "number of crossings into a cell by this face")
                          .varying("<face>"),
                      v.entries_by[i]);
              });
        });
        f.number({"clamped_share", "1", "share of the crossings that lie outside all bins"},
                 share(v.clamped, v.entries));
      });
  out.object({"matrix", "the transition matrix of the chain"}, [&](Fields& f) {
    const dynamics::Transitions::Totals total = totals_of(matrix);
    f.count({"gate_runs", "1", "gate runs behind the matrix"}, total.runs);
    f.number(
        {"clamped_share", "1", "share of the crossings of these runs that lie outside all bins"},
        total.clamped_share());
    f.count({"rows_never_sampled", "1", "rows without any run"}, total.empty_rows);
    f.maybe(Label("status", "numerical faults of the runs behind the matrix; null: not on record")
                .shared(),
            matrix.health, [](Fields& of, const dynamics::Health& h) { describe(of, h); });
    f.number({"seconds", "s", "time to make the matrix, or to read it"}, matrix.seconds);
  });
  out.optional(matrix.states.has_value(),
               [&](Fields& f) { describe_state_space(f, matrix.states.value_or(StateRecord())); });
  out.object(
      {"markov", "tests of the Markov property: what trials remember beyond the chain's states"},
      [&](Fields& f) { describe(f, *v.memory); });
  out.count({"threads", "1", "threads of the timed trials and walks"}, v.threads);
  describe_status(out, v.health);
  describe_method(out, matrix.method);
  out.optional(!v.starts.empty() && v.starts.front().observed, [&](Fields& f) {
    const lattice::StartValidation& first = v.starts.front();
    describe_observed(f, first.observed ? *first.observed : lattice::ObservedComparison(), first,
                      result.observed);
  });
  describe_made_by(out, result.made_by);
}

}  // namespace gatewalk::cli
