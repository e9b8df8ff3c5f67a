// SPDX-License-Identifier: MIT
#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>

#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/assumptions.h"
#include "cli/render/compared_gates.h"
#include "cli/render/exits.h"
#include "cli/render/field_ends.h"
#include "cli/render/final_gates.h"
#include "cli/render/start.h"
#include "cli/render/tested_shares.h"
#include "cli/render/validation.h"
#include "lattice/source/start_text.h"

namespace gatewalk::cli {
namespace {

std::string with_sd(const lattice::MeanAndSd& m) {
  return fmt::format("{} ({})", fixed(m.mean(), 3), fixed(m.sd(), 3));
}

/// The ending of one start that a screen names; nullopt if only the final gates differ.
std::optional<markov::Ending> named_ending(const lattice::StartValidation& r) {
  const lattice::JointTest& j = r.joint_test;
  std::vector<TestedShare> shares;
  add_tested(shares, j.endings);
  const auto most = named_share(shares, p_of_gates(j), lattice::JointTest::kLevel);
  return most ? std::optional(shares[*most].ending) : std::nullopt;
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
    const auto most = named_ending(r);
    const auto share = [&](const lattice::EndingShares& of) {
      return most ? percents(of.share[static_cast<std::size_t>(*most)]) : std::string("-");
    };
    table.row({labels.texts[k], p_text(r.joint_test.p), most ? name_of(*most) : "final gates",
               share(r.dynamics_endings), share(r.exact_endings), r.joint_test.total_variation.seen,
               r.joint_test.chance_total_variation});
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
               r.dynamics_seconds / r.exact_seconds, trial_over_walk(r)});
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
  const lattice::JointTest& j = r.joint_test;
  std::string difference = kOnlyGatesDiffer;
  if (const auto most = named_ending(r)) {
    const auto shares = [at = static_cast<std::size_t>(*most)](const lattice::EndingShares& of) {
      const auto& [low, high] = of.interval[at];
      return percents(of.share[at]) + " %" +
             (std::isnan(low) ? "" : fmt::format(" [{}, {}]", percents(low), percents(high)));
    };
    difference = fmt::format("Largest difference: {}, trials {}, chain {}.\n", name_of(*most),
                             shares(r.dynamics_endings), shares(r.exact_endings));
  }
  return fmt::format(
      "{}\n{}Final gates: total variation {} between trials and chain; chance alone makes {}.\n",
      chain_verdict(r), difference, fixed(j.total_variation.seen, 3),
      fixed(j.chance_total_variation, 3));
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

std::vector<lattice::AssumptionCheck> assumptions_of(const ValidatedMatrix& matrix) {
  if (!matrix.states || !matrix.states->trees) return {};
  return matrix.states->trees->assumptions;
}

/// What the memory that was found does to the final gates.
std::string memory_in_gates(const lattice::Validation& v,
                            const std::vector<lattice::AssumptionCheck>& assumptions) {
  if (!v.remembers()) return "";
  const auto at = std::find_if(assumptions.begin(), assumptions.end(), [](const auto& check) {
    return check.assumption == lattice::Assumption::face_before;
  });
  if (at == assumptions.end()) return "";
  return fmt::format(
      "With the face before in the state the final gates differ by a total variation of {}; chance "
      "makes up\nto {}.\n",
      fixed(at->total_variation, 3), fixed(at->chance_95, 3));
}

}  // namespace

std::string chain_verdict(const lattice::StartValidation& r) {
  return fmt::format(
      "The chain {} ({}).",
      differs(r) ? "differs from the full dynamics by more than chance in trials and matrix"
                 : "agrees with the full dynamics as far as these trials and matrix can tell",
      p_words(r.joint_test.p));
}

std::string answer_text(const ValidateResult& result) {
  const lattice::Validation& v = result.validation;
  const ValidatedMatrix& matrix = result.matrix;
  if (const auto& experiment = v.starts.front().observed)
    return answer_text(*experiment, v.starts.front());
  const bool is_one = v.starts.size() == 1;
  const auto assumptions = assumptions_of(matrix);
  constexpr std::int64_t kFewTrials = 1000;
  std::string text =
      (is_one ? answer_text(v.starts.front()) : answer_text(v, labels_of(result))) +
      sentence_of(*v.memory) + memory_in_gates(v, assumptions) +
      fmt::format("From {} of the full dynamics{} and a matrix of {} gate runs{}.\n",
                  counted(v.trials, "trial", "trials"), is_one ? "" : " per start",
                  totals_of(matrix).runs, matrix.path.empty() ? "" : " in " + matrix.path);
  if (lattice::wrong_assumption(assumptions))
    text += beware_of(assumptions);
  else if (std::any_of(v.starts.begin(), v.starts.end(), differs))
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

std::string summary(const lattice::StartValidation& v, const ShownField& shown) {
  return fmt::format(
      "{}: total variation {} (chance: {})", lattice::title_of(shown.map.section, v.start),
      fixed(v.joint_test.total_variation.seen, 3), fixed(v.joint_test.chance_total_variation, 3));
}

}  // namespace

Figure figure_of(const lattice::Validation& v, const ShownField& shown) {
  if (v.starts.empty() || v.starts.size() > kMostValidated)
    throw std::invalid_argument(fmt::format("a figure shows 1 to {} starts, these are {}",
                                            kMostValidated, v.starts.size()));
  std::vector<ComparedGates> compared;
  for (const lattice::StartValidation& s : v.starts)
    compared.push_back(
        {summary(s, shown), lattice::shares(s.dynamics.final_cells), s.exact.final_cells});
  return figure_of(compared, fmt::format("final gates, {} trials", v.trials), "dynamics, %", shown,
                   panels_of(*v.memory));
}

}  // namespace gatewalk::cli
