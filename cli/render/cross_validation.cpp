// SPDX-License-Identifier: MIT
#include "cli/render/cross_validation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/compared_gates.h"
#include "cli/render/field_ends.h"
#include "cli/render/final_gates.h"
#include "cli/render/tested_shares.h"

namespace gatewalk::cli {
namespace {

using lattice::CrossValidation;
using lattice::Fold;

/// The endings that a half or its prediction has.
std::vector<EndingName> shown_endings_of(const CrossValidation& v) {
  std::vector<EndingName> names(kEndingNames.begin(), kEndingNames.end());
  const auto back = static_cast<std::size_t>(lattice::kWentBack.ending);
  if (std::any_of(v.folds.begin(), v.folds.end(), [&](const Fold& fold) {
        return fold.seen.share[back] > 0.0 || fold.chain_endings.share[back] > 0.0;
      }))
    names.push_back(lattice::kWentBack);
  return names;
}

void describe(Fields& out, const Fold& fold) {
  const lattice::Watched& watched = fold.watched;
  out.count({"bodies", "1", "bodies of the half that the chain predicts"}, fold.bodies);
  out.count({"chain_bodies", "1", "bodies of the other half, whose runs make the chain"},
            fold.chain_bodies);
  out.count({"states", "1", "states of the chain"}, fold.states);
  out.object({"trials", "how far the predicted trials were watched"}, [&](Fields& f) {
    f.count({"compared", "1", "trials with at least one known passage"}, watched.trials);
    f.count({"seen_to_their_end", "1", "compared trials that were watched until their end"},
            watched.to_end);
    f.count({"unwatched", "1", "compared trials that were watched only for a time"},
            watched.unwatched);
    f.count({"lost", "1", "compared trials in which the body was lost from sight"}, watched.lost);
    f.count({"in_a_cell_of_another_type", "1",
             "compared trials watched until they entered a cell of another type than the field has "
             "there"},
            watched.other_type);
    f.count({"left_out", "1", "trials without any passage that can be compared"}, watched.left_out);
  });
  out.object(
      {"seen", "observed endings; the chain goes on where a trial was not watched to its end"},
      [&](Fields& f) {
        describe_endings(f, fold.seen);
        f.grid({"final_gates", "1", "share of all trials by the gate in which they end"},
               fold.seen_gates);
      });
  out.object({"chain", "endings by the chain of the other half, from the same starts"},
             [&](Fields& f) {
               describe_endings(f, fold.chain_endings);
               const FieldEnds<double> ends = ends_of(fold.chain, fold.chain_endings);
               ends.describe_never_sampled(f);
               ends.describe_still_walking(f);
               f.number({"error_95", "1",
                         "95 % bound of the total variation between final_gates and the truth"},
                        fold.chain_error.total_variation);
               f.grid({"final_gates", "1", "share of all trials by the gate in which they end"},
                      fold.chain.final_cells);
             });
  out.object({"final_gates", "final gates as observed, compared with the chain's"}, [&](Fields& f) {
    f.object({"total_variation", "total variation of the two maps of final gates"},
             [&](Fields& of) { describe(of, fold.total_variation); });
    f.number(
        {"total_variation_chance", "1", "mean total variation that chance in the bodies makes"},
        fold.chance_total_variation);
    f.number({"total_variation_chance_q95", "1",
              "95 % of the total variations that chance makes are at most this"},
             fold.chance_total_variation_95);
    f.number(
        {"corrcoef", "1", "Pearson correlation of the two maps of final gates, over all gates"},
        fold.corrcoef);
    f.number({"corrcoef_chance", "1", "mean correlation that chance in the bodies makes"},
             fold.chance_corrcoef);
    f.number({"rmse_per_100", "trials per 100",
              "root mean squared difference of the two maps of final gates, over all gates"},
             fold.rmse_per_100);
    f.number({"rmse_per_100_chance", "trials per 100", "mean RMSE that chance in the bodies makes"},
             fold.chance_rmse_per_100);
  });
  out.object(
      {"differences", "difference of the share of each ending between observation and chain"},
      [&](Fields& f) {
        for (const EndingName& e : kAllEndingNames) {
          const auto at = static_cast<std::size_t>(e.ending);
          f.object({e.key, fmt::format("absolute difference of the share of trials that {}",
                                       meaning_of(e))},
                   [&](Fields& of) {
                     describe(of, fold.endings[at]);
                     of.number({"chance_q95", "1",
                                "95 % of the differences that chance makes are at most this"},
                               fold.chance_95[at]);
                   });
        }
      });
}

std::string half_name(std::size_t half) { return half == 0 ? "half 1" : "half 2"; }
/// In fold 0 the second half is observed.
std::string seen_name(std::size_t fold) { return half_name(1 - fold); }
std::string chain_name(std::size_t fold) { return half_name(fold); }

std::string total_variation_text(const Fold& fold) {
  return fmt::format("total variation {} (chance: {})", fixed(fold.total_variation.seen, 3),
                     fixed(fold.chance_total_variation, 3));
}

std::string endings_table(const Fold& fold, const std::vector<EndingName>& names,
                          const std::string& seen, const std::string& chain) {
  TextTable table({{"", -10},
                   {seen + " as seen, %", -24, 0, "", "  "},
                   {"chain of " + chain + ", %", -24, 0, "", "  "},
                   {"difference by chance", 0, 0, "", "  "}});
  for (const EndingName& e : names) {
    const auto at = static_cast<std::size_t>(e.ending);
    table.row({e.name, with_interval(fold.seen.share[at], fold.seen.interval[at]),
               with_interval(fold.chain_endings.share[at], fold.chain_endings.interval[at]) +
                   (fold.differs(e.ending) ? " *" : ""),
               "+-" + percents(fold.chance_95[at])});
  }
  return table.text();
}

std::string seen_text(const Fold& fold, const std::string& name) {
  const lattice::Watched& s = fold.watched;
  const auto share = [&](std::int64_t n) {
    return percent(static_cast<double>(n), static_cast<double>(s.trials));
  };
  std::string text = fmt::format(
      "{}: {} bodies, {} trials. Seen to their end: {}; unwatched after a while: {}; lost: {}",
      name, fold.bodies, s.trials, share(s.to_end), share(s.unwatched), share(s.lost));
  if (s.other_type > 0)
    text += fmt::format("; seen until a cell of another type: {}", share(s.other_type));
  if (s.left_out > 0) text += fmt::format("; {} trials without a passage are left out", s.left_out);
  return wrapped(text + ".");
}

std::string verdict(const CrossValidation& v) {
  if (!v.differs())
    return fmt::format(
        "One half of the bodies predicts the other: nothing that these runs could show is missing "
        "({})",
        p_words(v.p));
  std::vector<std::string> said;
  for (std::size_t w = 0; w < 2; ++w) {
    const Fold& fold = v.folds[w];
    for (const EndingName& e : shown_endings_of(v)) {
      const auto at = static_cast<std::size_t>(e.ending);
      if (fold.differs(e.ending))
        said.push_back(fmt::format("{} {} % in {}, {} % by the chain of {} (chance: +-{})", e.name,
                                   percents(fold.seen.share[at]), seen_name(w),
                                   percents(fold.chain_endings.share[at]), chain_name(w),
                                   percents(fold.chance_95[at])));
    }
    if (fold.differs(markov::Ending::unsampled))
      said.push_back(fmt::format("{} % of {} reach states that the chain of {} does not know",
                                 percents(fold.chain.unsampled()), seen_name(w), chain_name(w)));
    if (fold.total_variation.p_adjusted <= Fold::kLevel)
      said.push_back(
          fmt::format("final gates of {}, {}", seen_name(w), total_variation_text(fold)));
  }
  return fmt::format("One half of the bodies does not predict the other ({}): {}", p_words(v.p),
                     fmt::join(said, "; "));
}

std::string verdict(const lattice::Independence& m, const dynamics::Section& section) {
  if (m.label < 0)
    return "no state shows two faces before and two outcomes: memory cannot be asked for";
  if (m.p > lattice::MemoryStudy::kLevel)
    return fmt::format("the face of the cell before tells nothing that these runs could show ({})",
                       p_words(m.p));
  const auto& faces = section.faces;
  const auto outcome = static_cast<std::size_t>(m.outcome);
  return fmt::format(
      "the face of the cell before tells more than the state ({}): most of all, after {} bodies {} "
      "{} often than other bodies of the same state, by {}. What that does to predictions the "
      "halves show",
      p_words(m.p), faces[static_cast<std::size_t>(m.label)].name,
      outcome < faces.size() ? "go on by " + faces[outcome].name : "are trapped",
      m.more > 0.0 ? "more" : "less", percent(std::abs(m.more), 1.0));
}

void describe(Fields& out, const lattice::Independence& m, const dynamics::Section& section) {
  const auto& faces = section.faces;
  out.count({"runs", "1",
             "passages in states where at least two faces before and two outcomes were seen"},
            m.runs);
  out.count({"states", "1", "states in which these passages begin"}, m.states);
  out.object({"together", "statistic of all faces before and all outcomes together"},
             [&](Fields& f) { describe(f, m.pooled); });
  out.object(
      {"strongest", "largest difference of one face and outcome, over its standard deviation"},
      [&](Fields& f) {
        describe(f, m.strongest);
        f.optional(m.label >= 0, [&](Fields& whose) {
          const std::size_t face = m.label < 0 ? 0 : static_cast<std::size_t>(m.label),
                            outcome = m.label < 0 ? 0 : static_cast<std::size_t>(m.outcome);
          whose.text({"face_before", "face by which the body entered the cell before"},
                     faces[face].name);
          whose.text(
              {"outcome", "outcome that differs: the face by which bodies go on, or trapped"},
              outcome < faces.size() ? faces[outcome].name : "trapped");
          whose.number(
              {"more", "1",
               "share of these passages by which the outcome is more frequent than expected"},
              m.more);
        });
      });
  out.number({"p", "1", "p-value of both statistics together"}, m.p);
  out.flag({"remembers", "whether the face before predicts the outcome beyond what the state does"},
           m.p <= lattice::MemoryStudy::kLevel);
  out.count({"null_draws", "1", "random draws behind the p-values"}, m.null_draws);
  out.text({"verdict", "whether the face before matters, in words"}, verdict(m, section));
}

}  // namespace

void describe(Fields& out, const CrossValidationResult& result) {
  describe_halves(out, result);
  describe_recorded(out, result.recorded);
  describe_made_by(out, result.made_by);
}

void describe_halves(Fields& out, const CrossValidationResult& result) {
  const auto& [validation, memory, section, recorded, made_by] = result;
  out.list(
      {"halves",
       "two: the second half against the chain of the first, then the first against the second's"},
      validation.folds, [](Fields& f, const Fold& fold) { describe(f, fold); });
  out.number({"p", "1", "p-value of both halves and all statistics together"}, validation.p);
  out.number({"level", "1", "level of significance"}, Fold::kLevel);
  out.flag({"differs", "verdict: p is at most the level, one half does not predict the other"},
           validation.differs());
  out.count({"null_draws", "1", "random draws behind the p-values"}, validation.null_draws);
  out.text({"verdict", "whether the halves predict each other, in words"}, verdict(validation));
  out.object(
      {"memory",
       "test: does the face of the cell before predict the outcome beyond what the state does?"},
      [&](Fields& f) { describe(f, memory, section); });
}

std::vector<std::string> rest_warnings(const CrossValidation& v) {
  std::vector<std::string> all;
  for (std::size_t w = 0; w < 2; ++w)
    if (std::string rest = rest_warning(rest_of(v.folds[w].chain),
                                        fmt::format("by the chain of {} ", chain_name(w)));
        !rest.empty())
      all.push_back(std::move(rest));
  return all;
}

namespace {

/// A line on the half and the ending that differ most from the other half's chain.
std::string largest_difference(const CrossValidation& v) {
  std::vector<TestedShare> shares;
  double p_of_gates = 1.0;
  for (const Fold& fold : v.folds) {
    add_tested(shares, fold.endings);
    p_of_gates = std::min(p_of_gates, fold.total_variation.p_adjusted);
  }
  const auto most = named_share(shares, p_of_gates, Fold::kLevel);
  if (!most) return kOnlyGatesDiffer;
  const std::size_t w = *most < shares.size() / 2 ? 0 : 1,
                    at = static_cast<std::size_t>(shares[*most].ending);
  const Fold& fold = v.folds[w];
  return fmt::format(
      "Largest difference: {}, {} % seen in {}, {} % by the chain of {};\n"
      "chance alone makes up to {} points (95 %).\n",
      name_of(shares[*most].ending), percents(fold.seen.share[at]), seen_name(w),
      percents(fold.chain_endings.share[at]), chain_name(w), percents(fold.chance_95[at]));
}

std::string memory_text(const lattice::Independence& m, const dynamics::Section& section) {
  if (m.label < 0)
    return "Memory cannot be tested: no state was entered in two ways with two outcomes.\n";
  if (m.p > lattice::MemoryStudy::kLevel)
    return fmt::format(
        "Memory: these runs give no evidence that the face of the cell before matters ({}).\n",
        p_words(m.p));
  const auto& faces = section.faces;
  const auto outcome = static_cast<std::size_t>(m.outcome);
  return fmt::format(
      "Memory: the state alone does not say all ({}). After face {} in the cell before, bodies\n"
      "{} {} points {} often than others in the same state; the halves include this error.\n",
      p_words(m.p), faces[static_cast<std::size_t>(m.label)].name,
      outcome < faces.size() ? "go on by " + faces[outcome].name : "are trapped",
      fixed(100.0 * std::abs(m.more), 1), m.more > 0.0 ? "more" : "less");
}

}  // namespace

/// How many single differences are larger than chance makes in 95 of 100 cases.
struct LargerThanChance {
  std::size_t count = 0, of = 0;
};
LargerThanChance larger_than_chance(const CrossValidation& v) {
  LargerThanChance larger;
  const auto add = [&](double seen, double chance_95) {
    ++larger.of;
    larger.count += seen > chance_95;
  };
  for (const Fold& fold : v.folds) {
    add(fold.total_variation.seen, fold.chance_total_variation_95);
    for (const EndingName& e : shown_endings_of(v)) {
      const auto at = static_cast<std::size_t>(e.ending);
      add(fold.endings[at].seen, fold.chance_95[at]);
    }
  }
  return larger;
}

/// Why the verdict may differ from what single differences suggest.
std::string single_differences_text(const CrossValidation& v) {
  const auto [count, of] = larger_than_chance(v);
  if (count == 0)
    return fmt::format(
        "None of {} differences is larger than chance alone makes in 95 of 100 cases.\n", of);
  return fmt::format(
      "{} of {} differences {} larger than chance alone makes in 95 of 100 cases;\n"
      "corrected for testing all of them: {}.\n",
      count, of, count == 1 ? "is" : "are", p_words(v.p));
}

/// Which share of the trials the chain continues.
std::string continued_text(const CrossValidation& v) {
  const auto share = [&](std::size_t w) {
    const lattice::Watched& watched = v.folds[w].watched;
    return percent(static_cast<double>(watched.trials - watched.to_end),
                   static_cast<double>(watched.trials));
  };
  if (std::ranges::all_of(
          v.folds, [](const Fold& fold) { return fold.watched.to_end == fold.watched.trials; }))
    return "";
  return fmt::format(
      "The chain continues the trials that were not seen to their end: {} in {}, {} in {}.\n",
      share(0), seen_name(0), share(1), seen_name(1));
}

std::string answer_text(const CrossValidationResult& result) {
  const CrossValidation& v = result.validation;
  std::string text = fmt::format("One half of the bodies {} ({}).\n{}{}{}",
                                 v.differs() ? "does not predict the other"
                                             : "predicts the other, as far as these runs can tell",
                                 p_words(v.p), single_differences_text(v), largest_difference(v),
                                 continued_text(v));
  for (std::size_t k = 0; k < 2; ++k)
    text += fmt::format("Final gates of {}: {}.\n", seen_name(k), total_variation_text(v.folds[k]));
  text += memory_text(result.memory, result.section) + table_of(result.recorded);
  if (v.differs())
    text += "Beware: a prediction for other bodies may err as much as the halves differ.\n";
  return text;
}

std::string details_text(const CrossValidationResult& result) {
  const CrossValidation& v = result.validation;
  const std::vector<EndingName> names = shown_endings_of(v);
  std::string text =
      "\nEndings with 95 % intervals: as seen, of the sampling of bodies; by the chain from the "
      "same "
      "starts,\nof its error bars. The chain continues a trial that was not seen to its end from "
      "its "
      "last entry.\nDifference by chance: 95 of 100 single differences that chance alone makes are "
      "smaller.\n*: a difference is larger than chance, corrected for testing all differences (p "
      "at "
      "most 0.05).\n";
  for (std::size_t w = 0; w < 2; ++w)
    text += "\n" + endings_table(v.folds[w], names, seen_name(w), chain_name(w));
  text += "\n";
  for (std::size_t w = 2; w-- > 0;) text += seen_text(v.folds[w], seen_name(w));
  TextTable gates({{"", -8},
                   {"corrcoef (chance)", -18, 0, "", "  "},
                   {"RMSE per 100 (chance)", -22, 0, "", "  "},
                   {"total variation (chance, 95 % of chance)", 0, 0, "", "  "}});
  for (std::size_t w = 0; w < 2; ++w) {
    const Fold& fold = v.folds[w];
    gates.row(
        {seen_name(w),
         fmt::format("{} ({})", fixed(fold.corrcoef, 3), fixed(fold.chance_corrcoef, 3)),
         fmt::format("{} ({})", fixed(fold.rmse_per_100, 2), fixed(fold.chance_rmse_per_100, 2)),
         fmt::format("{} ({}, {})", fixed(fold.total_variation.seen, 3),
                     fixed(fold.chance_total_variation, 3),
                     fixed(fold.chance_total_variation_95, 3))});
  }
  return text + "\nFinal gates as seen against the chain of the other half\n" + gates.text();
}

Figure figure_of(const CrossValidation& v, const ShownField& shown) {
  std::vector<ComparedGates> compared;
  for (std::size_t w = 0; w < 2; ++w) {
    const Fold& fold = v.folds[w];
    compared.push_back({fmt::format("{}, chain of {}: {}", seen_name(w), chain_name(w),
                                    total_variation_text(fold)),
                        fold.seen_gates, fold.chain.final_cells});
  }
  return figure_of(compared,
                   fmt::format("final gates: halves {} ({})",
                               v.differs() ? "differ" : "do not differ", p_words(v.p)),
                   "as seen, %", shown);
}

}  // namespace gatewalk::cli
