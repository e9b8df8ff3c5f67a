// SPDX-License-Identifier: MIT
#include "cli/render/memory.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "cli/fields/text.h"
#include "cli/render/final_gates.h"
#include "cli/render/panel.h"

namespace gatewalk::cli {
namespace {

using lattice::GatesAhead;
using lattice::Independence;
using lattice::MemoryStudy;
using lattice::Question;

constexpr std::array<std::string_view, lattice::kQuestions> kAsked{"gates ahead", "the gate before",
                                                                   "which gate of the walk it is",
                                                                   "which row of the field it is"};

const std::string& outcome_name(const MemoryStudy& study, int outcome) {
  return study.outcomes[static_cast<std::size_t>(outcome)];
}

/// The meaning of a label.
std::string label_name(const MemoryStudy& study, Question q, int label) {
  if (q == Question::gate_before) return study.origins[static_cast<std::size_t>(label)];
  if (q == Question::visit)
    return fmt::format("gate number {}{}", label + 1,
                       label + 1 == lattice::kVisits ? " or later" : "");
  return fmt::format("i_y = {}{}", label, label + 1 == lattice::kRows ? " or more" : "");
}

// ---- Independence ----

/// Whether so few outcomes vary that the test has no power to speak of: any memory would count.
bool is_untestable(const Independence& i) {
  constexpr double kLeastShown = 5e-4;
  return i.seen_at_90 < kLeastShown;
}
constexpr const char* kUntestable =
    "memory cannot be tested: in nearly every state all bodies went the same way";

std::string power_words(const Independence& i) {
  if (i.runs == 0) return "no state shows two of them";
  if (!std::isfinite(i.seen_at_90)) return "too few runs to see any memory";
  if (is_untestable(i)) return kUntestable;
  return fmt::format("a memory of total variation {} would have been seen with probability 0.9",
                     fixed(i.seen_at_90, 3));
}

/// "a memory of total variation 0.031 [0.025, 0.038]; most of all ..."
std::string size_words(const MemoryStudy& study, Question q) {
  const Independence& i = study.independence(q);
  std::string text = "not the same way in all states";
  if (i.memory_low > 0.0)
    text = fmt::format("a memory of total variation {} [{}, {}]", fixed(i.memory, 3),
                       fixed(i.memory_low, 3), fixed(i.memory_high, 3));
  if (i.label >= 0)
    text += fmt::format("; most of all {}: {} by {} % of its runs more {}",
                        label_name(study, q, i.label), outcome_name(study, i.outcome),
                        fixed(100.0 * std::abs(i.more), 1), i.more > 0.0 ? "often" : "seldom");
  return text;
}

std::string sentence(const MemoryStudy& study, Question q) {
  const Independence& i = study.independence(q);
  const std::string_view asked = kAsked[static_cast<std::size_t>(q)];
  const std::string p = p_words(study.p_adjusted(q));
  return study.remembers(q)
             ? fmt::format("{} tells more than the state ({}): {}", asked, p, size_words(study, q))
             : fmt::format("{} tells nothing more than the state ({}; {})", asked, p,
                           power_words(i));
}

void describe_p(Fields& out, const MemoryStudy& study, Question q) {
  out.number({"p", "1", "p-value: how often chance makes as large a difference"}, study.p(q));
  out.number({"p_adjusted", "1", "p-value, corrected for asking all four questions"},
             study.p_adjusted(q));
}

void describe(Fields& out, const MemoryStudy& study, Question q) {
  const Independence& i = study.independence(q);
  describe_p(out, study, q);
  out.count(
      {"runs", "1", "gate runs in states where at least two labels and two outcomes were seen"},
      i.runs);
  out.count({"states", "1", "states in which these runs begin"}, i.states);
  out.object(
      {"statistics", "test statistics: do outcomes depend on the label, given the state?"},
      [&](Fields& f) {
        f.object({"pooled", "statistic for differences that have the same sign in all states"},
                 [&](Fields& pooled) {
                   cli::describe(pooled, i.pooled);
                   pooled.count(
                       {"degrees", "1", "degrees of freedom of the chi-squared distribution"},
                       i.degrees);
                   pooled.number({"p_chi_squared", "1", "p-value by the chi-squared distribution"},
                                 i.p_chi_squared);
                 });
        f.object(
            {"strongest",
             "largest pooled difference of one label and outcome, over its standard deviation"},
            [&](Fields& strongest) {
              cli::describe(strongest, i.strongest);
              strongest.optional(i.label >= 0, [&](Fields& whose) {
                const bool any = i.label >= 0;
                whose.text({"label", "label whose runs differ most from expectation"},
                           any ? label_name(study, q, i.label) : "");
                whose.text(
                    {"outcome", "outcome that differs: the way into the next gate, or trapped"},
                    any ? outcome_name(study, i.outcome) : "");
                whose.number({"excess", "1",
                              "share of this label's runs by which the outcome is more frequent "
                              "than expected"},
                             i.more);
              });
            });
        f.object({"state_by_state", "statistic for differences that vary from state to state"},
                 [&](Fields& each) { cli::describe(each, i.state_by_state); });
      });
  out.estimate({"total_variation", "1",
                "size of the memory: total variation of outcomes between two halves of the labels; "
                "null: unknown"},
               i.memory, Interval{i.memory_low, i.memory_high});
  out.number({"seen_with_probability_90", "1",
              "total variation of a memory that is detected with probability 0.9; null: none is"},
             i.seen_at_90);
  out.text({"power", "seen_with_probability_90 in words"}, power_words(i));
  out.text({"sentence", "the answer to this question in words"}, sentence(study, q));
}

// ---- Gates ahead ----

std::string sentence_ahead(const MemoryStudy& study) {
  if (study.ahead.steps.empty())
    return "gates ahead: not asked of a field with several types of gates, where the next one's "
           "depends on the place";
  const GatesAhead::Step& s = study.ahead.largest();
  const std::string p = p_words(study.p_adjusted(Question::gates_ahead)),
                    seen = fixed(s.total_variation.seen, 4), chance = fixed(s.chance_95, 4);
  if (study.remembers(Question::gates_ahead))
    return fmt::format(
        "{} gates ahead bodies are elsewhere than the kernel's powers put them ({}): by a total "
        "variation of {}, where chance makes up to {}",
        s.gates, p, seen, chance);
  return fmt::format(
      "up to {} gates ahead bodies are where the kernel's powers put them ({}; nearest to an "
      "excess {} gates ahead: total variation {}, chance makes up to {})",
      study.ahead.steps.back().gates, p, s.gates, seen, chance);
}

/// Values by the face of the first entry and of the later one: {"EN": {"EN": ..., "trapped": ...},
/// ...}
template <class Value, class Put>
void describe_ways(Fields& out, const MemoryStudy& study, const Label& label,
                   const std::vector<Value>& values, Put put) {
  out.object(label, [&](Fields& f) {
    std::size_t at = 0;
    const std::vector<std::string>& names = study.outcomes;  // the last one: trapped
    for (std::size_t from = 0; from + 1 < names.size(); ++from)
      f.object(Label(names[from], "bodies that entered the first of these gates this way")
                   .varying("<way>"),
               [&](Fields& ways) {
                 for (const std::string& to : names)
                   put(ways,
                       Field(to, "1",
                             "share of all runs with the way above now and this way then (trapped: "
                             "by then)")
                           .varying("<way>"),
                       values[at++]);
               });
  });
}

void describe(Fields& out, const MemoryStudy& study, const GatesAhead::Step& s) {
  out.count({"gates", "1", "number of gates ahead"}, s.gates);
  out.object({"total_variation", "total variation between seen and predicted, way by way"},
             [&](Fields& f) { cli::describe(f, s.total_variation); });
  describe_by_chance(out, s.chance, s.chance_95);
  const auto share = [](Fields& f, const Field& key, double x) { f.number(key, x); };
  describe_ways(
      out, study,
      {"seen",
       "observed shares of all runs, by the way of entry now and that number of gates later"},
      s.seen, share);
  describe_ways(
      out, study,
      {"predicted",
       "shares of all runs predicted by the powers of the transition matrix, by both ways"},
      s.predicted, share);
  describe_ways(out, study, {"excess_95", "95 % intervals of seen less predicted, by both ways"},
                s.excess_95,
                [](Fields& f, const Field& key, const Interval& x) { f.interval(key, x); });
  out.numbers({"time_scales_gates", "1",
               "implied time scales of seen, longest first: -gates / ln(modulus of an eigenvalue); "
               "null: infinite"},
              s.seen_scales);
  out.numbers({"predicted_time_scales_gates", "1",
               "implied time scales of predicted, longest first; null: infinite"},
              s.predicted_scales);
  out.intervals(
      {"time_scales_chance_95", "1",
       "95 % ranges of time_scales_gates under the chain; few walks bias these scales upwards"},
      s.scales_95);
}

void describe(Fields& out, const MemoryStudy& study, const GatesAhead& ahead) {
  describe_p(out, study, Question::gates_ahead);
  out.count({"runs", "1", "gate runs from which bodies are followed ahead"}, ahead.runs);
  out.optional(!ahead.steps.empty(), [&](Fields& f) {
    f.count({"largest", "1",
             "number of gates ahead that exceeds the 95 % bound of chance most, or comes closest"},
            ahead.steps.empty() ? 0 : ahead.largest().gates);
  });
  out.list(
      {"steps", "one for each number of gates ahead, from 2 on; empty: several types of gates"},
      ahead.steps, [&](Fields& f, const GatesAhead::Step& s) { describe(f, study, s); });
  out.text({"sentence", "the answer to this question in words"}, sentence_ahead(study));
}

std::string any_sentence(const MemoryStudy& study, Question q) {
  return q == Question::gates_ahead ? sentence_ahead(study) : sentence(study, q);
}

std::string verdict(const MemoryStudy& study) {
  std::string text;
  for (int k = 0; k < lattice::kQuestions; ++k) {
    const auto q = static_cast<Question>(k);
    if (study.remembers(q)) text += (text.empty() ? "" : ". Also, ") + any_sentence(study, q);
  }
  if (!text.empty()) return "the chain forgets: " + text;
  return fmt::format("the chain forgets nothing that these {} runs could show: {}", study.runs,
                     sentence(study, Question::gate_before));
}

}  // namespace

void describe(Fields& out, const lattice::MultipleTests::Test& test) {
  out.number({"value", "1", "observed value of the statistic"}, test.seen);
  out.number({"p", "1", "p-value: how often chance makes the statistic as large"}, test.p);
  out.number({"p_adjusted", "1", "p-value, corrected for testing all statistics"}, test.p_adjusted);
}

void describe(Fields& out, const MemoryStudy& study) {
  constexpr std::array kMeanings{
      "Chapman-Kolmogorov test: do powers of the matrix predict bodies some gates later?",
      "does the gate before predict the next step beyond what the state does?",
      "does the number of gates so far predict the next step beyond what the state does?",
      "does the row of the field predict the next step beyond what the state does?"};
  out.text({"verdict", "the answers to all questions in words"}, verdict(study));
  out.flag({"remembers", "whether any question finds a memory that the chain lacks"},
           study.remembers());
  out.number({"level", "1", "level of significance for all questions together"},
             MemoryStudy::kLevel);
  out.count({"walks", "1", "trials of the full dynamics behind the tests"}, study.walks);
  out.count({"runs", "1", "gate runs of the trials behind the tests"}, study.runs);
  out.count({"null_draws", "1", "random draws behind each p-value"}, study.ahead.null_draws);
  for (std::size_t k = 0; k < kMeanings.size(); ++k) {
    const auto q = static_cast<Question>(k);
    Label label(lattice::kQuestionKeys[k], kMeanings[k]);
    if (q != Question::gates_ahead) label = label.shared("memory_of_label");
    out.object(label, [&](Fields& f) {
      q == Question::gates_ahead ? describe(f, study, study.ahead) : describe(f, study, q);
    });
  }
}

namespace {

/// Which memory of the gate before these runs would have shown.
std::string detectable_text(const Independence& i) {
  if (i.runs == 0) return "No state was entered in two ways, so its memory cannot be tested.\n";
  if (!std::isfinite(i.seen_at_90)) return "They are too few to detect any memory.\n";
  if (is_untestable(i)) return fmt::format("But {}.\n", kUntestable);
  return fmt::format(
      "They would detect a memory of the gate before only if its total variation is {} or more.\n",
      fixed(i.seen_at_90, 3));
}

}  // namespace

std::string sentence_of(const MemoryStudy& study) {
  double least = 1.0;
  for (int k = 0; k < lattice::kQuestions; ++k)
    least = std::min(least, study.p_adjusted(static_cast<Question>(k)));
  if (study.remembers())
    return fmt::format(
        "Is it Markov? No: in {} gate runs the next step depends on more than the state ({}).\n",
        study.runs, p_words(least));
  return fmt::format(
             "Is it Markov? {} gate runs give no evidence that the chain has lost information "
             "({}).\n",
             study.runs, p_words(least)) +
         detectable_text(study.independence(Question::gate_before));
}

namespace {

/// The subject of each question's sentence.
constexpr std::array<std::string_view, lattice::kQuestions> kSubjects{
    "Several gates ahead", "The gate before", "The number of gates so far", "The row of the field"};

std::string lines_ahead(const MemoryStudy& study) {
  if (study.ahead.steps.empty())
    return "not tested, because the field has several types of gates.\n";
  const GatesAhead::Step& s = study.ahead.largest();
  return fmt::format(
      "{} the powers of the matrix.\n"
      "    {} gates ahead: total variation {}; chance alone makes up to {} (95 %).\n",
      study.remembers(Question::gates_ahead) ? "bodies deviate from"
                                             : "no evidence that bodies deviate from",
      s.gates, fixed(s.total_variation.seen, 4), fixed(s.chance_95, 4));
}

std::string lines_of(const MemoryStudy& study, Question q) {
  const Independence& i = study.independence(q);
  if (!study.remembers(q)) {
    const std::string text = "no evidence that it tells more than the state.\n    ";
    if (i.runs == 0) return text + "No state was entered in two such ways.\n";
    if (!std::isfinite(i.seen_at_90)) return text + "There are too few runs to detect a memory.\n";
    if (is_untestable(i)) return text + fmt::format("But {}.\n", kUntestable);
    return text + fmt::format(
                      "A memory of total variation {} would be detected with probability "
                      "0.9.\n",
                      fixed(i.seen_at_90, 3));
  }
  std::string text = "tells more than the state.\n    ";
  text += i.memory_low > 0.0
              ? fmt::format("The memory has a total variation of {} [{}, {}].\n",
                            fixed(i.memory, 3), fixed(i.memory_low, 3), fixed(i.memory_high, 3))
              : "The difference has another sign in other states.\n";
  if (i.label >= 0)
    text += fmt::format("    Strongest: {}, next {}: {} points {} than in the other runs.\n",
                        label_name(study, q, i.label), outcome_name(study, i.outcome),
                        fixed(100.0 * std::abs(i.more), 1), i.more > 0.0 ? "more" : "fewer");
  return text;
}

}  // namespace

std::string text_of(const MemoryStudy& study) {
  std::string text = fmt::format(
      "\nIs it Markov? Four tests with {} gate runs of {} trials from all starts, in the chain's "
      "states.\np is corrected for four tests.\n",
      study.runs, study.walks);
  for (int k = 0; k < lattice::kQuestions; ++k) {
    const auto q = static_cast<Question>(k);
    text += fmt::format("  {} ({}): {}", kSubjects[static_cast<std::size_t>(k)],
                        p_words(study.p_adjusted(q)),
                        q == Question::gates_ahead ? lines_ahead(study) : lines_of(study, q));
  }
  return text + (study.remembers()
                     ? "So the chain loses information; the verdict above says what that costs its "
                       "predictions.\n"
                     : "So these runs give no evidence that the chain has lost information.\n");
}

std::string sentence_of(const lattice::ForceMemory& m) {
  const lattice::Comparison &pairs = m.change.in_pairs, &apart = m.change.apart;
  return wrapped(fmt::format(
      "With the random force drawn anew at every crossing, the final gates {} ({}): total "
      "variation "
      "{} +- {}; chance makes {}. {} of the trials end in another gate.",
      m.matters() ? "change" : "are not shown to change", p_words(pairs.p_total_variation),
      fixed(apart.total_variation, 4), fixed(m.change.uncertainty(), 4),
      fixed(pairs.floor_total_variation, 4), percent(m.change.changed, 1.0)));
}

namespace {

std::string verdict(const lattice::ForceMemory& m) {
  const lattice::Comparison &pairs = m.change.in_pairs, &apart = m.change.apart;
  return fmt::format(
      "a random force drawn anew at every crossing {} ({}): total variation {} +- {}, chance makes "
      "{}; {} of the trials end in another gate",
      m.matters() ? "changes the final gates" : "changes no more than chance does",
      p_words(pairs.p_total_variation), fixed(apart.total_variation, 4),
      fixed(m.change.uncertainty(), 4), fixed(pairs.floor_total_variation, 4),
      percent(m.change.changed, 1.0));
}

}  // namespace

void describe(Fields& out, const lattice::ForceMemory& m) {
  out.text({"verdict", "the result of the test in words"}, verdict(m));
  out.flag(
      {"matters",
       "whether the final gates change by more than chance: p of total variation at most 0.05"},
      m.matters());
  out.count({"trials", "1", "trials that were run both with the force kept and drawn anew"},
            m.change.trials);
  describe_change(out, m.change);
  out.object(
      {"in_pairs", "final gates with the force drawn anew and kept, compared trial by trial"},
      [&](Fields& f) { describe(f, m.change.in_pairs); });
  out.object({"endings", "change of the share of each ending when the force is drawn anew"},
             [&](Fields& f) {
               for (const EndingName& e : kEndingNames) {
                 const lattice::PairedDifference& d = m.endings[static_cast<std::size_t>(e.ending)];
                 f.object({e.key, fmt::format("trials that {}", meaning_of(e))}, [&](Fields& of) {
                   of.estimate(
                       {"difference", "1",
                        "share with the force drawn anew less the share with the force kept"},
                       d.difference, Interval{d.low, d.high});
                 });
               }
             });
}

namespace {

constexpr double kPanelsLeft = 88, kPanelsRight = 492, kMemoryPanelHeight = 54, kPanelGap = 14,
                 kPanelsHead = 50, kScalesHeight = 110, kScalesHead = 82;
/// With more faces the panels would be too small to read.
constexpr std::size_t kMostWays = 6;
constexpr std::size_t kDrawnScales = 3;

/// Draws a curve: the kernel's powers with a 95 % band, and the observed shares. Rows are "gates
/// low high predicted seen".
void draw_curve(Panel& panel, const Rows& rows, const char* colour, const char* seen_colour) {
  panel.draw(rows, "1:2:3", "filledcurves fs transparent solid 0.25 noborder", {colour});
  panel.draw(rows, "1:4", "lines", {.colour = colour, .width = 1.2});
  panel.draw(rows, "1:5", "points", {.colour = seen_colour, .mark = 7, .size = 0.45});
}

/// For bodies that enter through one face, the share (%) that enters through another k gates later.
struct Probabilities {
  Rows rows;
  double most = 0.0;

  Probabilities(const GatesAhead& ahead, std::size_t ways, std::size_t from, std::size_t to,
                std::string name = "")
      : rows(std::move(name)) {
    for (const GatesAhead::Step& s : ahead.steps) {
      const auto begin = static_cast<std::ptrdiff_t>(from * (ways + 1));
      const auto sum = [&](const std::vector<double>& shares) {
        double all = 0.0;
        for (std::size_t k = 0; k <= ways; ++k) all += shares[static_cast<std::size_t>(begin) + k];
        return all;
      };
      const std::size_t at = static_cast<std::size_t>(begin) + to;
      const double unit = 100.0 / sum(s.predicted), excess = s.seen[at] - s.predicted[at];
      if (!std::isfinite(unit)) continue;
      const double predicted = unit * s.predicted[at], seen = 100.0 / sum(s.seen) * s.seen[at],
                   low = std::max(0.0, predicted + unit * (excess - s.excess_95[at][1])),
                   high = predicted + unit * (excess - s.excess_95[at][0]);
      rows.add(s.gates, low, high, predicted, seen);
      most = std::max({most, high, seen, predicted});
    }
  }
};

/// An axis from 0 with a tic or two.
Axis up_to(double most, const char* name) {
  const double end = most > 0.0 ? 1.15 * most : 1.0;
  return {name, 0, end, "0," + digits(tic_step(end, 2.0))};
}

/// The faces through which bodies entered; the last column is trapped.
std::vector<std::size_t> entered_ways(const MemoryStudy& study) {
  const std::size_t ways = study.outcomes.size() - 1;
  std::vector<std::size_t> entered;
  for (std::size_t from = 0; from < ways; ++from)
    if (!Probabilities(study.ahead, ways, from, ways).rows.empty()) entered.push_back(from);
  return entered;
}

void add_ways(Panels& out, const MemoryStudy& study, double top) {
  const GatesAhead& ahead = study.ahead;
  const std::vector<std::string>& names = study.outcomes;
  const std::size_t ways = names.size() - 1;
  const std::vector<std::size_t> rows = entered_ways(study);
  std::vector<std::size_t> columns = rows;
  columns.push_back(ways);
  const double pitch = (kPanelsRight - kPanelsLeft) / static_cast<double>(columns.size());
  const auto left_of = [&](std::size_t i) { return kPanelsLeft + static_cast<double>(i) * pitch; };
  out.say("Chapman-Kolmogorov test: % of those who enter as at the left, some gates later", 8,
          top + 14, kSmallFont);
  out.say("line: powers of the kernel, with 95 % of chance; points: trials", 8, top + 28,
          kSmallFont);
  for (std::size_t i = 0; i < columns.size(); ++i)
    out.say(names[columns[i]], left_of(i) + 4, top + kPanelsHead - 6, kSmallFont);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double above =
        top + kPanelsHead + static_cast<double>(k) * (kMemoryPanelHeight + kPanelGap);
    const bool lowest = k + 1 == rows.size();
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const Probabilities p(ahead, ways, rows[k], columns[i], fmt::format("$ahead{}_{}", k, i));
      Panel& panel =
          out.add({left_of(i), left_of(i) + pitch - 30, above, above + kMemoryPanelHeight});
      if (i == 0) panel.say(names[rows[k]], 8, above + 0.5 * kMemoryPanelHeight, kSmallFont);
      panel.tics_font = kSmallFont;
      panel.x = {lowest && i == columns.size() / 2 ? "gates" : "", ahead.steps.front().gates - 0.5,
                 ahead.steps.back().gates + 0.5, "2,2"};
      panel.x.numbers = lowest;
      panel.y = up_to(p.most, i == 0 ? "%" : "");
      panel.y.name_look = "font ',12' offset 2.2,0";
      draw_curve(panel, out.data(p.rows), kFirstColour, "black");
    }
  }
}

void add_scales(Panels& out, const MemoryStudy& study, double top) {
  const std::vector<GatesAhead::Step>& steps = study.ahead.steps;
  const char* const colours[] = {kFirstColour, kSecondColour, kThirdColour};
  const std::size_t count = std::min(kDrawnScales, steps.front().seen_scales.size());
  Panel panel(
      {kPanelsLeft, 0.5 * (kPanelsLeft + kPanelsRight), top + 26, top + 26 + kScalesHeight});
  panel.say("implied time scales of the same tables, in gates, over the lag", 8, top + 14,
            kSmallFont);
  double most = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    Rows rows(fmt::format("$scale{}", k));
    for (const GatesAhead::Step& s : steps) {
      if (!std::isfinite(s.seen_scales[k]) || !std::isfinite(s.scales_95[k][1])) continue;
      rows.add(s.gates, s.scales_95[k], s.predicted_scales[k], s.seen_scales[k]);
      most = std::max({most, s.scales_95[k][1], s.seen_scales[k]});
    }
    if (!rows.empty()) draw_curve(panel, out.data(rows), colours[k], colours[k]);
  }
  if (panel.layers.empty()) return;
  panel.x = {"lag, gates", steps.front().gates - 0.5, steps.back().gates + 0.5, "2,1"};
  panel.y = up_to(most, "time scale");
  out.add(std::move(panel));
}

}  // namespace

MorePanels panels_of(const MemoryStudy& study) {
  const GatesAhead& ahead = study.ahead;
  const std::size_t ways = study.outcomes.empty() ? 0 : study.outcomes.size() - 1;
  if (ahead.steps.empty() || ways == 0 || ways > kMostWays) return {};
  const double of_all =
      kPanelsHead + 34 +
      static_cast<double>(entered_ways(study).size()) * (kMemoryPanelHeight + kPanelGap);
  return {of_all + kScalesHead + kScalesHeight, [&study, of_all](Panels& out, double top) {
            add_ways(out, study, top);
            add_scales(out, study, top + of_all);
          }};
}

}  // namespace gatewalk::cli
