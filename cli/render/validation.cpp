// SPDX-License-Identifier: MIT
#include "cli/render/validation.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/choice.h"
#include "cli/render/exits.h"
#include "cli/render/field_ends.h"
#include "cli/render/field_figure.h"
#include "cli/render/figure.h"
#include "cli/render/final_gates.h"
#include "cli/render/health.h"
#include "cli/render/start.h"
#include "cli/render/type_marks.h"
#include "lattice/source/start_text.h"

namespace gatewalk::cli {

std::string p_of(const lattice::JointTest& j) {
  return j.p < 0.001 ? "p < 0.001" : "p = " + fixed(j.p, 3);
}

std::string verdict(const lattice::StartValidation& r) {
  const lattice::JointTest& j = r.joint_test;
  if (r.finding() != lattice::Finding::own_error)
    return fmt::format(
        "the chain agrees with the dynamics as far as these trials and this matrix can tell ({})",
        p_of(j));
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
  const auto gates = {j.total_variation.p_adjusted, j.energy.p_adjusted, j.chi_squared.p_adjusted};
  if (std::any_of(gates.begin(), gates.end(),
                  [](double x) { return x <= lattice::JointTest::kLevel; }))
    said.push_back(fmt::format("final gates, total variation {} (chance: {})",
                               fixed(j.total_variation.seen, 3),
                               fixed(j.chance_total_variation, 3)));
  return fmt::format(
      "the chain differs from the dynamics by more than chance in trials and matrix makes "
      "({}):{}{}",
      p_of(j), said.empty() ? "" : " ", fmt::join(said, "; "));
}

namespace {

// ---- The result ----

double share(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

double seconds_per_trial(const lattice::StartValidation& r) {
  return r.dynamics_seconds / static_cast<double>(r.dynamics.trials);
}
double seconds_per_walk(const lattice::StartValidation& r) {
  return r.walks_seconds / static_cast<double>(r.walks.walks);
}

/// The totals of all types. For trees the record gives the runs, because leaves share runs and hold
/// mirror images.
dynamics::Transitions::Totals totals_of(const ValidatedMatrix& matrix) {
  dynamics::Transitions::Totals total;
  for (const dynamics::Transitions& t : matrix.matrices) total += t.totals();
  if (matrix.states && matrix.states->trees) total.runs = matrix.states->trees->gate_runs;
  return total;
}

/// For a disc: crossings through the sides above the joints.
std::int64_t traverse_sides(const lattice::Validation& v) {
  return v.entries_by[dynamics::Boundary::right_traverse] +
         v.entries_by[dynamics::Boundary::left_traverse];
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
             seconds_per_trial(r) / seconds_per_walk(r));
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

// ---- Tables ----

std::string with_sd(const lattice::MeanAndSd& m) {
  return fmt::format("{} ({})", fixed(m.mean(), 3), fixed(m.sd(), 3));
}

/// The ending whose share differs most between trials and chain.
const EndingName& differs_most(const lattice::StartValidation& r) {
  const auto difference = [&](const EndingName& e) {
    const auto at = static_cast<std::size_t>(e.ending);
    return std::abs(r.dynamics_endings.share[at] - r.exact_endings.share[at]);
  };
  return *std::max_element(
      kAllEndingNames.begin(), kAllEndingNames.end(),
      [&](const EndingName& a, const EndingName& b) { return difference(a) < difference(b); });
}

/// A line for each start: p, the ending that differs most, and the final gates.
std::string starts_table(const lattice::Validation& v, const StartTexts& labels) {
  TextTable table({{labels.header},
                   {"p", 9},
                   {"differs most", -14, 0, "", "   "},
                   {"trials, %", 9},
                   {"chain, %", 10},
                   {"final gates: TV", 17, 3},
                   {"by chance", 11, 3}});
  for (std::size_t k = 0; k < v.starts.size(); ++k) {
    const lattice::StartValidation& r = v.starts[k];
    const EndingName& most = differs_most(r);
    const auto at = static_cast<std::size_t>(most.ending);
    table.row({labels.texts[k], p_text(r.joint_test.p), most.name,
               percents(r.dynamics_endings.share[at]), percents(r.exact_endings.share[at]),
               r.joint_test.total_variation.seen, r.joint_test.chance_total_variation});
  }
  return table.text();
}

/// The endings of one start, by the dynamics and by the chain.
std::string endings_table(const lattice::StartValidation& r) {
  TextTable table({{"", -10},
                   {"trials, %", -24, 0, "", "  "},
                   {"exact chain, %", -24, 0, "", "  "},
                   {"p", 7, 0, "", "  "}});
  for (const EndingName& e : kAllEndingNames) {
    if (r.dynamics_endings.rules_out(e.ending) && r.exact_endings.rules_out(e.ending)) continue;
    const auto at = static_cast<std::size_t>(e.ending);
    const auto cell = [&](const lattice::EndingShares& shares) {
      return with_interval(shares.share[at], shares.interval[at]);
    };
    table.row({e.name, cell(r.dynamics_endings), cell(r.exact_endings),
               p_text(r.joint_test.endings[at].p_adjusted) +
                   (r.joint_test.differs(e.ending) ? " *" : "")});
  }
  return table.text();
}

std::string endings_tables(const lattice::Validation& v, const dynamics::Section& section) {
  std::string text =
      "\nEndings with 95 % intervals. Those of the trials count their sampling error, those of the "
      "exact\nchain the sampling of the matrix. p: how often chance in both makes as large a "
      "difference,\ncorrected for all that is tested; *: this ending differs.\n";
  for (const lattice::StartValidation& r : v.starts) {
    text += "\n";
    if (v.starts.size() > 1) text += lattice::title_of(section, r.start) + "\n";
    text += endings_table(r) + rest_text(rest_of(r.exact));
  }
  return text;
}

/// A table of one measure with a line for each start; numbers have three decimals.
std::string measure_table(const StartTexts& labels, const std::vector<std::string>& headings,
                          const std::function<std::vector<TextCell>(std::size_t)>& cells_of) {
  std::vector<TextColumn> columns{{labels.header}};
  for (const std::string& heading : headings)
    columns.push_back({heading, std::max(10, static_cast<int>(heading.size()) + 2), 3});
  TextTable table(columns);
  for (std::size_t k = 0; k < labels.texts.size(); ++k) {
    std::vector<TextCell> line{labels.texts[k]};
    for (TextCell& cell : cells_of(k)) line.push_back(std::move(cell));
    table.row(line);
  }
  return table.text();
}

/// Our values beside Table IV's, for the paper's starts.
std::string table4_tables(const ValidateResult& result, const StartTexts& labels) {
  const std::vector<std::string> headings{"  paper", "  exact chain", "  floor", "    100 walks"};
  const auto table =
      [&](double lattice::PaperStart::*printed, lattice::MeanAndSd lattice::PaperSized::*exact,
          double lattice::NoiseFloor::*floor, lattice::MeanAndSd lattice::PaperSized::*walks) {
        return measure_table(labels, headings, [&](std::size_t k) -> std::vector<TextCell> {
          const lattice::StartValidation& r = result.validation.starts[k];
          const double paper =
              result.like_table4 && !result.papers.empty() ? result.papers[k].*printed : kUnknown;
          return {paper, with_sd(r.paper_sized.*exact), r.floor_100_exact.*floor,
                  with_sd(r.paper_sized.*walks)};
        });
      };
  return fmt::format(
      "\nAs in the paper's Table IV: final gates of 100 trials of the full dynamics against the "
      "chain,\nmean (standard deviation) over repeats. Floor: the best result to expect, what "
      "sampling noise alone\nwould give for a perfect chain.\n\n"
      "corrcoef\n{}\nRMSE, trials per 100\n{}",
      table(&lattice::PaperStart::corrcoef, &lattice::PaperSized::exact_corrcoef,
            &lattice::NoiseFloor::corrcoef, &lattice::PaperSized::walks_corrcoef),
      table(&lattice::PaperStart::rmse, &lattice::PaperSized::exact_rmse,
            &lattice::NoiseFloor::rmse_per_100, &lattice::PaperSized::walks_rmse));
}

/// Tables of the final gates, from all trials.
std::string final_gates_tables(const lattice::Validation& v, const StartTexts& labels) {
  const std::vector<std::string> headings{"exact chain", "floor", "walks", "floor"};
  std::vector<std::string> of_variation = headings;
  of_variation.insert(of_variation.end(), {"matrix", "chance"});
  const auto& starts = v.starts;
  const auto corrcoef =
      measure_table(labels, headings, [&](std::size_t k) -> std::vector<TextCell> {
        const lattice::Comparison &exact = starts[k].exact_against,
                                  &walks = starts[k].walks_against;
        return {exact.corrcoef, exact.floor.corrcoef, walks.corrcoef, walks.floor.corrcoef};
      });
  const auto rmse = measure_table(labels, headings, [&](std::size_t k) -> std::vector<TextCell> {
    const lattice::Comparison &exact = starts[k].exact_against, &walks = starts[k].walks_against;
    return {exact.rmse_per_100, exact.floor.rmse_per_100, walks.rmse_per_100,
            walks.floor.rmse_per_100};
  });
  const auto variation =
      measure_table(labels, of_variation, [&](std::size_t k) -> std::vector<TextCell> {
        const lattice::Comparison &exact = starts[k].exact_against,
                                  &walks = starts[k].walks_against;
        return {exact.total_variation,       exact.floor_total_variation,
                walks.total_variation,       walks.floor_total_variation,
                starts[k].matrix_noise_mean, starts[k].joint_test.chance_total_variation};
      });
  return fmt::format(
      "\nFinal gates of all {} trials per start against the exact chain and {} walks. Floor: "
      "chance "
      "in\nthese trials (and walks) alone. Matrix: the total variation that the sampling of the "
      "matrix alone\nmakes. Chance: trials and matrix together.\n\n"
      "corrcoef\n{}\nRMSE, trials per 100\n{}\ntotal variation\n{}",
      v.trials, v.walks, corrcoef, rmse, variation);
}

std::string exits_table(const lattice::Validation& v, const StartTexts& labels) {
  return "\nPlaces along the sides where the chain lies outside the 95 % interval of the trials\n"
         "(chance alone: 1 of 20)\n" +
         measure_table(labels, {"places"}, [&](std::size_t k) -> std::vector<TextCell> {
           return {places_outside(v.starts[k].dynamics_exits, v.starts[k].exact_exits)};
         });
}

std::string seconds_table(const lattice::Validation& v, const StartTexts& labels) {
  TextTable table({{labels.header},
                   {"dynamics", 12, 2},
                   {"walks", 11, 4},
                   {"exact", 11, 6},
                   {"dynamics/exact", 15, 0},
                   {"trial/walk", 12, 0}});
  for (std::size_t k = 0; k < v.starts.size(); ++k) {
    const lattice::StartValidation& r = v.starts[k];
    table.row({labels.texts[k], r.dynamics_seconds, r.walks_seconds, r.exact_seconds,
               r.dynamics_seconds / r.exact_seconds, seconds_per_trial(r) / seconds_per_walk(r)});
  }
  return fmt::format(
      "\nSeconds for {} trials and {} walks on {}, and for one exact prediction on one "
      "thread.\n\n{}",
      v.trials, v.walks, counted(static_cast<std::int64_t>(v.threads), "thread", "threads"),
      table.text());
}

/// The faces through which bodies went on: "S 61.2 %, W 19.4 %".
std::string by_face(const lattice::Validation& v, const dynamics::Section& section) {
  std::vector<std::string> faces;
  for (std::size_t f = 0; f < section.faces.size(); ++f)
    faces.push_back(
        fmt::format("{} {}", section.faces[f].name,
                    percent(static_cast<double>(v.entries_by[f]), static_cast<double>(v.entries))));
  return fmt::format("{}", fmt::join(faces, ", "));
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

namespace {

bool differs(const lattice::StartValidation& r) {
  return r.finding() == lattice::Finding::own_error;
}

StartTexts labels_of(const ValidateResult& result) {
  std::vector<dynamics::Entry> starts;
  for (const lattice::StartValidation& r : result.validation.starts) starts.push_back(r.start);
  return {result.shown.map.section, starts};
}

/// The answer for one start.
std::string answer_text(const lattice::StartValidation& r) {
  const EndingName& most = differs_most(r);
  const auto at = static_cast<std::size_t>(most.ending);
  const lattice::JointTest& j = r.joint_test;
  const auto shares = [&](const lattice::EndingShares& of) {
    const auto& [low, high] = of.interval[at];
    return percents(of.share[at]) + " %" +
           (std::isnan(low) ? "" : fmt::format(" [{}, {}]", percents(low), percents(high)));
  };
  return fmt::format(
      "{}\nLargest difference: {}, trials {}, chain {}.\n"
      "Final gates: total variation {} between trials and chain; chance alone makes {}.\n",
      chain_verdict(r), most.name, shares(r.dynamics_endings), shares(r.exact_endings),
      fixed(j.total_variation.seen, 3), fixed(j.chance_total_variation, 3));
}

/// The answer for several starts.
std::string answer_text(const lattice::Validation& v, const StartTexts& labels) {
  const auto n = std::count_if(v.starts.begin(), v.starts.end(), differs);
  return (n == 0
              ? fmt::format("The chain agrees with the full dynamics from all {} starts, as far as "
                            "these trials and this\nmatrix can tell.\n",
                            v.starts.size())
              : fmt::format(
                    "The chain differs from the full dynamics from {} of {} starts, by more "
                    "than chance in trials\nand matrix.\n",
                    n, v.starts.size())) +
         starts_table(v, labels);
}

}  // namespace

std::string chain_verdict(const lattice::StartValidation& r) {
  return fmt::format(
      "The chain {} ({}).",
      differs(r) ? "differs from the full dynamics by more than chance in trials and matrix"
                 : "agrees with the full dynamics as far as these trials and matrix can tell",
      p_of(r.joint_test));
}

std::string answer_text(const ValidateResult& result) {
  const lattice::Validation& v = result.validation;
  const ValidatedMatrix& matrix = result.matrix;
  if (const auto& experiment = v.starts.front().observed)
    return answer_text(*experiment, v.starts.front());
  const bool is_one = v.starts.size() == 1;
  constexpr std::int64_t kFewTrials = 1000;
  std::string text =
      (is_one ? answer_text(v.starts.front()) : answer_text(v, labels_of(result))) +
      sentence_of(*v.memory) +
      fmt::format("From {} of the full dynamics{} and a matrix of {} gate runs{}.\n",
                  counted(v.trials, "trial", "trials"), is_one ? "" : " per start",
                  totals_of(matrix).runs, matrix.path.empty() ? "" : " in " + matrix.path);
  if (std::any_of(v.starts.begin(), v.starts.end(), differs))
    text +=
        "Beware: the chain has an error of its own here. gatewalk lattice simulates the full "
        "dynamics.\n";
  else if (v.trials < kFewTrials)
    text += fmt::format(
        "Beware: {} trials reveal only large differences; more trials reveal smaller "
        "ones.\n",
        v.trials);
  return text;
}

std::string details_text(const ValidateResult& result) {
  const lattice::Validation& v = result.validation;
  const ValidatedMatrix& matrix = result.matrix;
  if (const auto& experiment = v.starts.front().observed)
    return details_text(*experiment, v.starts.front());
  const StartTexts labels = labels_of(result);
  const auto of_crossings = [&](std::int64_t n) {
    return percent(static_cast<double>(n), static_cast<double>(v.entries));
  };
  std::string text = endings_tables(v, result.shown.map.section);
  if (result.shown.mass) text += table4_tables(result, labels);  // for discs in gates
  text += final_gates_tables(v, labels) + exits_table(v, labels) + seconds_table(v, labels);
  text += fmt::format(
      "\nMatrix: {} gate runs, {}.\nCrossings between gates in the trials: {};\n{} lie outside the "
      "bins.\n",
      totals_of(matrix).runs,
      matrix.path.empty() ? "built in " + fixed(matrix.seconds, 2) + " s"
                          : "read from " + matrix.path,
      result.shown.mass ? fmt::format("{} through RT or LT{}", of_crossings(traverse_sides(v)),
                                      result.like_table4 ? " (paper: fewer than 4 %)" : "")
                        : by_face(v, result.shown.map.section),
      of_crossings(v.clamped));
  if (matrix.states) text += states_line(*matrix.states);
  text += text_of(*v.memory);
  for (const lattice::StartValidation& r : v.starts)
    if (r.force) {
      if (v.starts.size() > 1) text += lattice::title_of(result.shown.map.section, r.start) + ":\n";
      text += sentence_of(*r.force);
    }
  if (v.entries == 0) text += "No trial ever reached a second gate.\n";
  return text;
}

namespace {

using lattice::StartValidation;
using markov::CellProbabilities;

constexpr double kMapWidth = 130, kGap = 16, kLeft = 64, kHead = 46;

std::string summary(const StartValidation& v, const ShownField& shown) {
  return fmt::format(
      "{}: total variation {} (chance: {})", lattice::title_of(shown.map.section, v.start),
      fixed(v.exact_against.total_variation, 3), fixed(v.exact_against.floor_total_variation, 3));
}

}  // namespace

Figure figure_of(const lattice::Validation& v, const ShownField& shown) {
  if (v.starts.empty() || v.starts.size() > kMostValidated)
    throw std::invalid_argument(fmt::format("a figure shows 1 to {} starts, these are {}",
                                            kMostValidated, v.starts.size()));
  std::vector<ComparedGates> compared;
  for (const StartValidation& s : v.starts)
    compared.push_back(
        {summary(s, shown), lattice::shares(s.dynamics.final_cells), s.exact.final_cells});
  return figure_of(compared, fmt::format("final gates, {} trials", v.trials), "dynamics, %", shown,
                   panels_of(*v.memory));
}

Figure figure_of(const std::vector<ComparedGates>& compared, const std::string& title,
                 const std::string& seen_head, const ShownField& shown, const MorePanels& more) {
  struct Row {
    FieldMap map;  // of all gates that either map reaches
    double top, height;
  };
  std::vector<Row> rows;
  double most = 0.0, largest = 0.0, end = kHead;
  for (const ComparedGates& c : compared) {
    const FieldMap map(0.5 * (c.seen + c.chain), 60, 60);
    const CellProbabilities seen = map.blocks_of(c.seen), chain = map.blocks_of(c.chain);
    const double height = std::clamp(
        kMapWidth * static_cast<double>(chain.rows()) / static_cast<double>(chain.cols()), 60.0,
        240.0);
    rows.push_back({map, end + 24, height});
    end += 24 + height + 40;
    most = std::max({most, seen.maxCoeff(), chain.maxCoeff()});
    largest = std::max(largest, (seen - chain).abs().maxCoeff());
  }
  if (largest == 0.0) largest = 1e-4;
  end += 26;  // the name of the last row's axis
  const TypeMarks types(shown);
  const double below = end + 62 + types.legend_height(), bound = 100.0 * largest;
  const RootScale scale(100.0 * most);
  const std::string look = " scale 0.5 offset 0,0.4", tic = short_number(0.7 * bound);
  const auto left_of = [](int i) { return kLeft + i * (kMapWidth + kGap); };
  const auto bar_of = [&](int first, int last) {
    return Box{left_of(first), left_of(last) + kMapWidth, end + 8, end + 18};
  };
  const std::string names[] = {"$seen", "$chain", "$difference"},
                    heads[] = {seen_head, "chain, %", "difference, points"};
  bool marked = false;
  Panels out;
  out.say(title, 8, 16);
  for (int i = 0; i < 3; ++i) out.say(heads[i], left_of(i), kHead - 4, kSmallFont);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto& [map, top, height] = rows[k];
    const bool last = k + 1 == rows.size();
    for (int i = 0; i < 3; ++i) {
      Panel& panel = add_map(out, map, {left_of(i), left_of(i) + kMapWidth, top, top + height}, 34);
      panel.border = 15;
      if (!last) panel.x.name = "";
      if (i > 0) panel.y = {"", panel.y.low, panel.y.high, kNoTics};
      if (i == 0) panel.say(compared[k].summary, 8, top - 10, kSmallFont);
      Rows& data = out.data(names[i] + std::to_string(k));
      if (i < 2)
        add_shares(data, map, i == 0 ? compared[k].seen : compared[k].chain);
      else
        add_values(data,
                   100.0 * (map.blocks_of(compared[k].seen) - map.blocks_of(compared[k].chain)));
      panel.colours = i < 2 ? Colours{0, std::sqrt(scale.most())} : Colours{-bound, bound};
      if (i == 2) panel.colours->palette = kDiverging;
      if (last && i == 1) {
        panel.colours->bar = bar_of(0, 1);
        panel.colours->tics = fmt::format("({}){}", scale.tics(), look);
        panel.say("root scale", left_of(1) - 30, end + 50, kSmallFont);
      }
      if (last && i == 2) {
        panel.colours->bar = bar_of(2, 2);
        panel.colours->tics =
            fmt::format("('-{}' -{}, '0' 0, '+{}' {}){}", tic, tic, tic, tic, look);
      }
      panel.draw_cells(data);
      marked = types.draw_on(out, panel, map, data.name().substr(1)) || marked;
      if (last && i == 2) types.add_legend(panel, end + 60, marked);
    }
  }
  if (more.draw) more.draw(out, below);
  return out.figure(static_cast<int>(below + more.height));
}

}  // namespace gatewalk::cli
