// SPDX-License-Identifier: MIT
#include "cli/render/memory.h"

#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "cli/render/final_gates.h"
#include "cli/render/json.h"
#include "cli/render/text.h"
#include "lattice/text/text_stream.h"

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
    return "gate number " + std::to_string(label + 1) +
           (label + 1 == lattice::kVisits ? " or later" : "");
  return "i_y = " + std::to_string(label) + (label + 1 == lattice::kRows ? " or more" : "");
}

// ---- Independence ----

std::string power_words(const Independence& i) {
  if (i.runs == 0) return "no state shows two of them";
  if (!std::isfinite(i.seen_at_90)) return "too few runs to see any memory";
  return "a memory of total variation " + fixed(i.seen_at_90, 3) +
         " would have been seen with probability 0.9";
}

/// "a memory of total variation 0.031 [0.025, 0.038]; most of all ..."
std::string size_words(const MemoryStudy& study, Question q) {
  const Independence& i = study.independence(q);
  std::string text;
  if (i.memory_low > 0.0)
    text = "a memory of total variation " + fixed(i.memory, 3) + " [" + fixed(i.memory_low, 3) +
           ", " + fixed(i.memory_high, 3) + "]";
  else
    text = "not the same way in all states";
  if (i.label >= 0)
    text += "; most of all " + label_name(study, q, i.label) + ": " +
            outcome_name(study, i.outcome) + " by " + fixed(100.0 * std::abs(i.more), 1) +
            " % of its runs more " + (i.more > 0.0 ? "often" : "seldom");
  return text;
}

std::string sentence(const MemoryStudy& study, Question q) {
  const Independence& i = study.independence(q);
  const std::string asked(kAsked[static_cast<std::size_t>(q)]), p = p_words(study.p_adjusted(q));
  return study.remembers(q)
             ? asked + " tells more than the state (" + p + "): " + size_words(study, q)
             : asked + " tells nothing more than the state (" + p + "; " + power_words(i) + ")";
}

Json to_json(const MemoryStudy& study, Question q) {
  const Independence& i = study.independence(q);
  Json j;
  j["p"] = i.p;
  j["p_adjusted"] = study.p_adjusted(q);
  j["runs"] = i.runs;
  j["states"] = i.states;
  j["statistics"] = {{"pooled", cli::to_json(i.pooled)},
                     {"strongest", cli::to_json(i.strongest)},
                     {"state_by_state", cli::to_json(i.state_by_state)}};
  j["statistics"]["pooled"]["degrees"] = i.degrees;
  j["statistics"]["pooled"]["p_chi_squared"] = i.p_chi_squared;
  if (i.label >= 0) {
    j["statistics"]["strongest"]["label"] = label_name(study, q, i.label);
    j["statistics"]["strongest"]["outcome"] = outcome_name(study, i.outcome);
    j["statistics"]["strongest"]["excess"] = i.more;
  }
  j["total_variation"] = i.memory;
  j["total_variation_95"] = {i.memory_low, i.memory_high};
  j["seen_with_probability_90"] = i.seen_at_90;
  j["power"] = power_words(i);
  j["sentence"] = sentence(study, q);
  return j;
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
    return std::to_string(s.gates) +
           " gates ahead bodies are elsewhere than the kernel's powers put them (" + p +
           "): by a total variation of " + seen + ", where chance makes up to " + chance;
  return "up to " + std::to_string(study.ahead.steps.back().gates) +
         " gates ahead bodies are where the kernel's powers put them (" + p +
         "; nearest to an excess " + std::to_string(s.gates) + " gates ahead: total variation " +
         seen + ", chance makes up to " + chance + ")";
}

/// By the way now and the way then: {"EN": {"EN": ..., "trapped": ...}, ...}
template <class Value>
Json by_ways(const MemoryStudy& study, const std::vector<Value>& values) {
  Json j;
  std::size_t at = 0;
  const std::vector<std::string>& names = study.outcomes;  // the last one: trapped
  for (std::size_t from = 0; from + 1 < names.size(); ++from)
    for (const std::string& to : names) j[names[from]][to] = values[at++];
  return j;
}

/// The longest first; those that are endless are null.
Json scales(const std::vector<double>& gates) {
  Json all = Json::array();
  for (const double scale : gates) all.push_back(or_null(scale));
  return all;
}

Json to_json(const MemoryStudy& study, const GatesAhead& ahead) {
  Json j;
  j["p"] = ahead.p;
  j["p_adjusted"] = study.p_adjusted(Question::gates_ahead);
  j["runs"] = ahead.runs;
  if (!ahead.steps.empty()) j["largest"] = ahead.largest().gates;
  j["steps"] = Json::array();
  for (const GatesAhead::Step& s : ahead.steps)
    j["steps"].push_back(
        {{"gates", s.gates},
         {"total_variation", cli::to_json(s.total_variation)},
         {"total_variation_by_chance", {{"mean", s.chance}, {"at_95", s.chance_95}}},
         {"seen", by_ways(study, s.seen)},
         {"predicted", by_ways(study, s.predicted)},
         {"excess_95", by_ways(study, s.excess_95)},
         {"time_scales_gates", scales(s.seen_scales)},
         {"predicted_time_scales_gates", scales(s.predicted_scales)},
         {"time_scales_chance_95", s.scales_95}});
  j["sentence"] = sentence_ahead(study);
  return j;
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
  return "the chain forgets nothing that these " + std::to_string(study.runs) +
         " runs could show: " + sentence(study, Question::gate_before);
}

}  // namespace

Json to_json(const lattice::LookedAt::Test& test) {
  return {{"value", test.seen}, {"p", test.p}, {"p_adjusted", test.p_adjusted}};
}

Json to_json(const MemoryStudy& study) {
  Json j;
  j["verdict"] = verdict(study);
  j["remembers"] = study.remembers();
  j["level"] = MemoryStudy::kLevel;
  j["walks"] = study.walks;
  j["runs"] = study.runs;
  j["null_draws"] = study.ahead.null_draws;
  for (int k = 0; k < lattice::kQuestions; ++k) {
    const auto q = static_cast<Question>(k);
    j[std::string(lattice::kQuestionKeys[static_cast<std::size_t>(k)])] =
        q == Question::gates_ahead ? to_json(study, study.ahead) : to_json(study, q);
  }
  return j;
}

std::string text_of(const MemoryStudy& study) {
  lattice::TextStream out;
  out << "\nIs it Markov? " << study.runs << " gate runs of " << study.walks
      << " trials from all starts, in the states of the chain; p for four questions together.\n";
  for (int k = 0; k < lattice::kQuestions; ++k)
    out << "  " << any_sentence(study, static_cast<Question>(k)) << "\n";
  out << (study.remembers()
              ? "So the chain forgets what matters; how much that costs its predictions, the "
                "verdicts above say.\n"
              : "So the chain forgets nothing that these runs could show.\n");
  return out.str();
}

std::string text_of(const lattice::ForceMemory& m) {
  const lattice::Comparison &pairs = m.change.in_pairs, &apart = m.change.apart;
  return std::string("a random force drawn anew at every crossing ") +
         (m.matters() ? "changes the final gates (" : "changes no more than chance does (") +
         p_words(pairs.p_total_variation) + "): total variation " +
         fixed(apart.total_variation, 4) + " +- " + fixed(m.change.uncertainty(), 4) +
         ", chance makes " + fixed(pairs.floor_total_variation, 4) + "; " +
         percent(m.change.changed, 1.0) + " of the trials end in another gate";
}

Json to_json(const lattice::ForceMemory& m) {
  Json j;
  j["verdict"] = text_of(m);
  j["matters"] = m.matters();
  j["trials"] = m.change.trials;
  j["changed_share"] = m.change.changed;
  j["total_variation_uncertainty"] = m.change.uncertainty();
  j["in_pairs"] = to_json(m.change.in_pairs);
  for (const EndingName& e : kEndingNames) {
    const lattice::PairedDifference& d = m.endings[static_cast<std::size_t>(e.ending)];
    j["endings"][e.key] = {{"difference", d.difference}, {"interval_95", {d.low, d.high}}};
  }
  return j;
}

}  // namespace gatewalk::cli
