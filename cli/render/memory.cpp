// SPDX-License-Identifier: MIT
#include "cli/render/memory.h"

#include <fmt/core.h>

#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "cli/render/final_gates.h"
#include "cli/render/text.h"

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

/// What a label means.
std::string label_name(const MemoryStudy& study, Question q, int label) {
  if (q == Question::gate_before) return study.origins[static_cast<std::size_t>(label)];
  if (q == Question::visit)
    return fmt::format("gate number {}{}", label + 1,
                       label + 1 == lattice::kVisits ? " or later" : "");
  return fmt::format("i_y = {}{}", label, label + 1 == lattice::kRows ? " or more" : "");
}

// ---- Independence ----

std::string power_words(const Independence& i) {
  if (i.runs == 0) return "no state shows two of them";
  if (!std::isfinite(i.seen_at_90)) return "too few runs to see any memory";
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

/// By the way now and the way then: {"EN": {"EN": ..., "trapped": ...}, ...}
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

std::string text_of(const MemoryStudy& study) {
  std::string text = fmt::format(
      "\nIs it Markov? {} gate runs of {} trials from all starts, in the states of the chain; p "
      "for four questions together.\n",
      study.runs, study.walks);
  for (int k = 0; k < lattice::kQuestions; ++k)
    text += fmt::format("  {}\n", any_sentence(study, static_cast<Question>(k)));
  return text + (study.remembers()
                     ? "So the chain forgets what matters; how much that costs its predictions, "
                       "the verdicts above say.\n"
                     : "So the chain forgets nothing that these runs could show.\n");
}

std::string text_of(const lattice::ForceMemory& m) {
  const lattice::Comparison &pairs = m.change.in_pairs, &apart = m.change.apart;
  return fmt::format(
      "a random force drawn anew at every crossing {} ({}): total variation {} +- {}, chance makes "
      "{}; {} of the trials end in another gate",
      m.matters() ? "changes the final gates" : "changes no more than chance does",
      p_words(pairs.p_total_variation), fixed(apart.total_variation, 4),
      fixed(m.change.uncertainty(), 4), fixed(pairs.floor_total_variation, 4),
      percent(m.change.changed, 1.0));
}

void describe(Fields& out, const lattice::ForceMemory& m) {
  out.text({"verdict", "the result of the test in words"}, text_of(m));
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

}  // namespace gatewalk::cli
