// SPDX-License-Identifier: MIT
#include "cli/render/halves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/render/field_ends.h"
#include "cli/render/final_gates.h"
#include "cli/render/memory.h"
#include "cli/render/text.h"
#include "cli/render/text_table.h"
#include "cli/render/validation.h"

namespace gatewalk::cli {
namespace {

using lattice::HalfAgainstHalf;
using lattice::HalvesValidation;

/// Those that there are.
std::vector<EndingName> shown_endings_of(const HalvesValidation& v) {
  std::vector<EndingName> names(kEndingNames.begin(), kEndingNames.end());
  const auto back = static_cast<std::size_t>(lattice::kWentBack.ending);
  if (std::any_of(v.ways.begin(), v.ways.end(), [&](const HalfAgainstHalf& way) {
        return way.seen.share[back] > 0.0 || way.chain_endings.share[back] > 0.0;
      }))
    names.push_back(lattice::kWentBack);
  return names;
}

void describe(Fields& out, const HalfAgainstHalf& way) {
  const lattice::SeenSoFar& so_far = way.seen_so_far;
  out.count({"bodies", "1", "bodies of the half that the chain predicts"}, way.bodies);
  out.count({"chain_bodies", "1", "bodies of the other half, whose runs make the chain"},
            way.chain_bodies);
  out.count({"states", "1", "states of the chain"}, way.states);
  out.object({"trials", "how far the predicted trials were watched"}, [&](Fields& f) {
    f.count({"compared", "1", "trials with at least one known passage"}, so_far.trials);
    f.count({"seen_to_their_end", "1", "compared trials that were watched until their end"},
            so_far.to_end);
    f.count({"unwatched", "1", "compared trials that were watched only for a time"},
            so_far.unwatched);
    f.count({"lost", "1", "compared trials in which the body was lost from sight"}, so_far.lost);
    f.count({"in_a_cell_of_another_type", "1",
             "compared trials watched until they entered a cell of another type than the field has "
             "there"},
            so_far.other_type);
    f.count({"left_out", "1", "trials without any passage that can be compared"}, so_far.left_out);
  });
  out.object(
      {"seen", "observed endings; the chain goes on where a trial was not watched to its end"},
      [&](Fields& f) {
        describe_endings(f, way.seen);
        f.grid({"final_gates", "1", "share of all trials by the gate in which they end"},
               way.seen_gates);
      });
  out.object({"chain", "endings by the chain of the other half, from the same starts"},
             [&](Fields& f) {
               describe_endings(f, way.chain_endings);
               const FieldEnds<double> ends = ends_of(way.chain, way.chain_endings);
               ends.describe_never_sampled(f);
               ends.describe_still_walking(f);
               f.number({"error_95", "1",
                         "95 % bound of the total variation between final_gates and the truth"},
                        way.chain_error.total_variation);
               f.grid({"final_gates", "1", "share of all trials by the gate in which they end"},
                      way.chain.final_cells);
             });
  out.object({"final_gates", "final gates as observed, compared with the chain's"}, [&](Fields& f) {
    f.object({"total_variation", "total variation of the two maps of final gates"},
             [&](Fields& of) { describe(of, way.total_variation); });
    f.number(
        {"total_variation_chance", "1", "mean total variation that chance in the bodies makes"},
        way.chance_total_variation);
    f.number({"total_variation_chance_q95", "1",
              "95 % of the total variations that chance makes are at most this"},
             way.chance_total_variation_95);
    f.number(
        {"corrcoef", "1", "Pearson correlation of the two maps of final gates, over all gates"},
        way.corrcoef);
    f.number({"corrcoef_chance", "1", "mean correlation that chance in the bodies makes"},
             way.chance_corrcoef);
    f.number({"rmse_per_100", "trials per 100",
              "root mean squared difference of the two maps of final gates, over all gates"},
             way.rmse_per_100);
    f.number({"rmse_per_100_chance", "trials per 100", "mean RMSE that chance in the bodies makes"},
             way.chance_rmse_per_100);
  });
  out.object(
      {"differences", "difference of the share of each ending between observation and chain"},
      [&](Fields& f) {
        for (const EndingName& e : kAllEndingNames) {
          const auto at = static_cast<std::size_t>(e.ending);
          f.object({e.key, fmt::format("absolute difference of the share of trials that {}",
                                       meaning_of(e))},
                   [&](Fields& of) {
                     describe(of, way.endings[at]);
                     of.number({"chance_q95", "1",
                                "95 % of the differences that chance makes are at most this"},
                               way.chance_95[at]);
                   });
        }
      });
}

std::string half_name(std::size_t half) { return half == 0 ? "half 1" : "half 2"; }
/// Of way 0 the second half is seen.
std::string seen_name(std::size_t way) { return half_name(1 - way); }
std::string chain_name(std::size_t way) { return half_name(way); }

std::string total_variation_text(const HalfAgainstHalf& way) {
  return fmt::format("total variation {} (chance: {})", fixed(way.total_variation.seen, 3),
                     fixed(way.chance_total_variation, 3));
}

std::string endings_table(const HalvesValidation& v) {
  const std::vector<EndingName> names = shown_endings_of(v);
  std::vector<TextColumn> columns{{"", -kFit}};
  for (const EndingName& e : names)
    columns.push_back(
        {fmt::format("{} ", e.name), kFit, 0, "", columns.size() == 1 ? "  |  " : "  "});
  TextTable table(columns);
  const auto row = [&](const std::string& name, const auto& text_of) {
    std::vector<TextCell> cells{name};
    for (const EndingName& e : names)
      cells.emplace_back(text_of(static_cast<std::size_t>(e.ending)));
    table.row(cells);
  };
  for (std::size_t w = 0; w < 2; ++w) {
    const HalfAgainstHalf& way = v.ways[w];
    const auto shares = [&](const lattice::EndingShares& of, std::size_t at) {
      return with_interval(of.share[at], of.interval[at]);
    };
    row(seen_name(w) + " as seen", [&](std::size_t at) { return shares(way.seen, at) + " "; });
    row("chain of " + chain_name(w), [&](std::size_t at) {
      return shares(way.chain_endings, at) +
             (way.differs(static_cast<markov::Ending>(at)) ? "*" : " ");
    });
    row("chance",
        [&](std::size_t at) { return fmt::format("+-{} ", percents(way.chance_95[at])); });
  }
  return table.text();
}

std::string seen_text(const HalfAgainstHalf& way, const std::string& name) {
  const lattice::SeenSoFar& s = way.seen_so_far;
  const auto share = [&](std::int64_t n) {
    return percent(static_cast<double>(n), static_cast<double>(s.trials));
  };
  std::string text = fmt::format(
      "{}: {} bodies, {} trials, of which {} were seen to their end, {} until nobody looked, {} "
      "until they were lost",
      name, way.bodies, s.trials, share(s.to_end), share(s.unwatched), share(s.lost));
  if (s.other_type > 0)
    text += fmt::format(", {} until their cell's type was not the field's", share(s.other_type));
  if (s.left_out > 0) text += fmt::format("; {} trials without a passage are left out", s.left_out);
  return text + "\n";
}

std::string verdict(const HalvesValidation& v) {
  if (!v.differs())
    return fmt::format(
        "One half of the bodies predicts the other: nothing that these runs could show is missing "
        "({})",
        p_words(v.p));
  std::vector<std::string> said;
  for (std::size_t w = 0; w < 2; ++w) {
    const HalfAgainstHalf& way = v.ways[w];
    for (const EndingName& e : shown_endings_of(v)) {
      const auto at = static_cast<std::size_t>(e.ending);
      if (way.differs(e.ending))
        said.push_back(fmt::format("{} {} % in {}, {} % by the chain of {} (chance: +-{})", e.name,
                                   percents(way.seen.share[at]), seen_name(w),
                                   percents(way.chain_endings.share[at]), chain_name(w),
                                   percents(way.chance_95[at])));
    }
    if (way.differs(markov::Ending::unsampled))
      said.push_back(fmt::format("{} % of {} reach states that the chain of {} does not know",
                                 percents(way.chain.unsampled()), seen_name(w), chain_name(w)));
    if (way.total_variation.p_adjusted <= HalfAgainstHalf::kLevel)
      said.push_back(fmt::format("final gates of {}, {}", seen_name(w), total_variation_text(way)));
  }
  return fmt::format("One half of the bodies does not predict the other ({}): {}", p_words(v.p),
                     fmt::join(said, "; "));
}

std::string verdict(const lattice::BodyMemory& m, const dynamics::Section& section) {
  if (m.face < 0)
    return "no state shows two faces before and two outcomes: memory cannot be asked for";
  if (!m.remembers())
    return fmt::format("the face of the cell before tells nothing that these runs could show ({})",
                       p_words(m.p));
  const auto& faces = section.faces;
  const auto outcome = static_cast<std::size_t>(m.outcome);
  return fmt::format(
      "the face of the cell before tells more than the state ({}): most of all, after {} bodies {} "
      "{} often than other bodies of the same state, by {}. What that does to predictions the "
      "halves show",
      p_words(m.p), faces[static_cast<std::size_t>(m.face)].name,
      outcome < faces.size() ? "go on by " + faces[outcome].name : "are trapped",
      m.more > 0.0 ? "more" : "less", percent(std::abs(m.more), 1.0));
}

void describe(Fields& out, const lattice::BodyMemory& m, const dynamics::Section& section) {
  const auto& faces = section.faces;
  out.count({"runs", "1",
             "passages in states where at least two faces before and two outcomes were seen"},
            m.runs);
  out.count({"states", "1", "states in which these passages begin"}, m.states);
  out.object({"together", "statistic of all faces before and all outcomes together"},
             [&](Fields& f) { describe(f, m.together); });
  out.object(
      {"strongest", "largest difference of one face and outcome, over its standard deviation"},
      [&](Fields& f) {
        describe(f, m.strongest);
        f.optional(m.face >= 0, [&](Fields& whose) {
          const std::size_t face = m.face < 0 ? 0 : static_cast<std::size_t>(m.face),
                            outcome = m.face < 0 ? 0 : static_cast<std::size_t>(m.outcome);
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
           m.remembers());
  out.count({"null_draws", "1", "random draws behind the p-values"}, m.null_draws);
  out.text({"verdict", "whether the face before matters, in words"}, verdict(m, section));
}

}  // namespace

void describe(Fields& out, const HalvesResult& result) {
  const auto& [halves, memory, section, recorded, made_by] = result;
  out.list(
      {"halves",
       "two: the second half against the chain of the first, then the first against the second's"},
      halves.ways, [](Fields& f, const HalfAgainstHalf& way) { describe(f, way); });
  out.number({"p", "1", "p-value of both halves and all statistics together"}, halves.p);
  out.number({"level", "1", "level of significance"}, HalfAgainstHalf::kLevel);
  out.flag({"differs", "verdict: p is at most the level, one half does not predict the other"},
           halves.differs());
  out.count({"null_draws", "1", "random draws behind the p-values"}, halves.null_draws);
  out.text({"verdict", "whether the halves predict each other, in words"}, verdict(halves));
  out.object(
      {"memory",
       "test: does the face of the cell before predict the outcome beyond what the state does?"},
      [&](Fields& f) { describe(f, memory, section); });
  describe_recorded(out, recorded);
  describe_made_by(out, made_by);
}

std::vector<std::string> rest_warnings(const HalvesValidation& v) {
  std::vector<std::string> all;
  for (std::size_t w = 0; w < 2; ++w)
    if (std::string rest = rest_warning(rest_of(v.ways[w].chain),
                                        fmt::format("by the chain of {} ", chain_name(w)));
        !rest.empty())
      all.push_back(std::move(rest));
  return all;
}

std::string table_of(const HalvesResult& result) {
  const HalvesValidation& v = result.halves;
  std::string text =
      "Does one half of the bodies predict the other? Endings in % with 95 % intervals: chance in "
      "the\n"
      "bodies as seen; the error bars of the chain, from the same starts. Where a trial was not "
      "seen to its\n"
      "end, the chain goes on from the last entry seen: only what was seen can differ. Chance: 95 "
      "% of the\n"
      "differences that chance in the bodies of both halves makes; *: this ending differs.\n\n" +
      endings_table(v) + "\n";
  for (const std::string& rest : rest_warnings(v)) text += rest + "\n";
  for (std::size_t w = 2; w-- > 0;) text += seen_text(v.ways[w], seen_name(w));
  text +=
      "\nFinal gates, as seen against the chain; in brackets what chance makes on average (of the "
      "total\nvariation also what 95 % do not exceed).\n\n";
  for (std::size_t w = 0; w < 2; ++w) {
    const HalfAgainstHalf& way = v.ways[w];
    text += fmt::format(
        "{}  | corrcoef {} ({}), RMSE {} ({}) per 100, total variation {} ({}, {})\n", seen_name(w),
        fixed(way.corrcoef, 3), fixed(way.chance_corrcoef, 3), fixed(way.rmse_per_100, 2),
        fixed(way.chance_rmse_per_100, 2), fixed(way.total_variation.seen, 3),
        fixed(way.chance_total_variation, 3), fixed(way.chance_total_variation_95, 3));
  }
  return text +
         fmt::format("\n{}.\nMemory: {}.\n", verdict(v), verdict(result.memory, result.section));
}

Figure figure_of(const HalvesValidation& v, const ShownField& shown) {
  std::vector<ComparedGates> compared;
  for (std::size_t w = 0; w < 2; ++w) {
    const HalfAgainstHalf& way = v.ways[w];
    compared.push_back(
        {fmt::format("{}, chain of {}: {}", seen_name(w), chain_name(w), total_variation_text(way)),
         way.seen_gates, way.chain.final_cells});
  }
  return figure_of(compared,
                   fmt::format("final gates: halves {} ({})",
                               v.differs() ? "differ" : "do not differ", p_words(v.p)),
                   "as seen, %", shown);
}

}  // namespace gatewalk::cli
