// SPDX-License-Identifier: MIT
#include "cli/render/halves.h"

#include <algorithm>
#include <vector>

#include "cli/render/final_gates.h"
#include "cli/render/json.h"
#include "cli/render/memory.h"
#include "cli/render/text.h"
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

Json to_json(const HalfAgainstHalf& way) {
  const lattice::SeenSoFar& s = way.seen_so_far;
  Json tests = Json::object();
  const auto add = [&](const EndingName& e) {
    const auto at = static_cast<std::size_t>(e.ending);
    tests[e.key] = cli::to_json(way.endings[at]);
    tests[e.key]["chance_95"] = way.chance_95[at];
  };
  for (const EndingName& e : kEndingNames) add(e);
  add(lattice::kWentBack);
  return {{"bodies", way.bodies},
          {"chain_bodies", way.chain_bodies},
          {"states", way.states},
          {"trials",
           {{"compared", s.trials},
            {"seen_to_their_end", s.to_end},
            {"unwatched", s.unwatched},
            {"lost", s.lost},
            {"in_a_cell_of_another_type", s.other_type},
            {"left_out", s.left_out}}},
          {"seen",
           {{"endings", cli::endings(way.seen.share)},
            {"endings_95", endings_95(way.seen)},
            {"final_gates", grid(way.seen_gates)}}},
          {"chain",
           {{"endings", cli::endings(way.chain_endings.share)},
            {"endings_95", endings_95(way.chain_endings)},
            {"never_sampled", way.chain.unsampled},
            {"still_walking", way.chain.remainder},
            {"error_95", way.chain_error.total_variation},
            {"final_gates", grid(way.chain.final_cells)}}},
          {"final_gates",
           {{"total_variation", cli::to_json(way.total_variation)},
            {"total_variation_chance", way.chance_total_variation},
            {"total_variation_chance_95", way.chance_total_variation_95},
            {"corrcoef", way.corrcoef},
            {"corrcoef_chance", way.chance_corrcoef},
            {"rmse_per_100", way.rmse_per_100},
            {"rmse_per_100_chance", way.chance_rmse_per_100}}},
          {"differences", std::move(tests)}};
}

std::string half_name(std::size_t half) { return half == 0 ? "half 1" : "half 2"; }
/// Of way 0 the second half is seen.
std::string seen_name(std::size_t way) { return half_name(1 - way); }
std::string chain_name(std::size_t way) { return half_name(way); }

std::string endings_table(const HalvesValidation& v) {
  const std::vector<EndingName> names = shown_endings_of(v);
  std::vector<std::vector<std::string>> lines{{""}};
  for (const EndingName& e : names) lines[0].push_back(std::string(e.name) + " ");
  for (std::size_t w = 0; w < 2; ++w) {
    const HalfAgainstHalf& way = v.ways[w];
    std::vector<std::string> seen{seen_name(w) + " as seen"}, chain{"chain of " + chain_name(w)},
        chance{"chance"};
    for (const EndingName& e : names) {
      const auto at = static_cast<std::size_t>(e.ending);
      seen.push_back(cli::with_interval(way.seen.share[at], way.seen.interval[at]) + " ");
      chain.push_back(
          cli::with_interval(way.chain_endings.share[at], way.chain_endings.interval[at]) +
          (way.differs(e.ending) ? "*" : " "));
      chance.push_back("+-" + percents(way.chance_95[at]) + " ");
    }
    lines.insert(lines.end(), {seen, chain, chance});
  }
  std::string text;
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) {
      std::size_t width = 0;
      for (const auto& other : lines) width = std::max(width, other[i].size());
      text += i == 0 ? padded(line[i], -static_cast<int>(width)) + "  |"
                     : "  " + padded(line[i], static_cast<int>(width));
    }
    text += "\n";
  }
  return text;
}

std::string seen_text(const HalfAgainstHalf& way, const std::string& name) {
  const lattice::SeenSoFar& s = way.seen_so_far;
  const auto of = static_cast<double>(s.trials);
  std::string text = name + ": " + std::to_string(way.bodies) + " bodies, " +
                     std::to_string(s.trials) + " trials, of which " +
                     percent(static_cast<double>(s.to_end), of) + " were seen to their end, " +
                     percent(static_cast<double>(s.unwatched), of) + " until nobody looked, " +
                     percent(static_cast<double>(s.lost), of) + " until they were lost";
  if (s.other_type > 0)
    text += ", " + percent(static_cast<double>(s.other_type), of) +
            " until their cell's type was not the field's";
  if (s.left_out > 0)
    text += "; " + std::to_string(s.left_out) + " trials without a passage are left out";
  return text + "\n";
}

}  // namespace

std::string verdict(const HalvesValidation& v) {
  if (!v.differs())
    return "One half of the bodies predicts the other: nothing that these runs could show is "
           "missing (" +
           p_words(v.p) + ")";
  std::string text = "One half of the bodies does not predict the other (" + p_words(v.p) + "):";
  const char* separator = " ";
  for (std::size_t w = 0; w < 2; ++w) {
    const HalfAgainstHalf& way = v.ways[w];
    for (const EndingName& e : shown_endings_of(v)) {
      if (!way.differs(e.ending)) continue;
      const auto at = static_cast<std::size_t>(e.ending);
      text += separator + std::string(e.name) + " " + percents(way.seen.share[at]) + " % in " +
              seen_name(w) + ", " + percents(way.chain_endings.share[at]) + " % by the chain of " +
              chain_name(w) + " (chance: +-" + percents(way.chance_95[at]) + ")";
      separator = "; ";
    }
    if (way.differs(markov::Ending::unsampled)) {
      text += separator + percents(way.chain.unsampled) + " % of " + seen_name(w) +
              " reach states that the chain of " + chain_name(w) + " does not know";
      separator = "; ";
    }
    if (way.total_variation.p_adjusted <= HalfAgainstHalf::kLevel) {
      text += separator + std::string("final gates of ") + seen_name(w) + ", total variation " +
              fixed(way.total_variation.seen, 3) +
              " (chance: " + fixed(way.chance_total_variation, 3) + ")";
      separator = "; ";
    }
  }
  return text;
}

std::string verdict(const lattice::BodyMemory& m, const dynamics::Section& section) {
  if (m.face < 0)
    return "no state shows two faces before and two outcomes: memory cannot be asked for";
  if (!m.remembers())
    return "the face of the cell before tells nothing that these runs could show (" + p_words(m.p) +
           ")";
  const auto& faces = section.faces;
  const auto outcome = static_cast<std::size_t>(m.outcome);
  return "the face of the cell before tells more than the state (" + p_words(m.p) +
         "): most of all, after " + faces[static_cast<std::size_t>(m.face)].name + " " +
         (outcome < faces.size() ? "bodies go on by " + faces[outcome].name
                                 : std::string("bodies are trapped")) +
         (m.more > 0.0 ? " more" : " less") + " often than other bodies of the same state, by " +
         percent(std::abs(m.more), 1.0) + ". What that does to predictions the halves show";
}

Json to_json(const HalvesValidation& v) {
  return {{"halves", {to_json(v.ways[0]), to_json(v.ways[1])}},
          {"p", v.p},
          {"level", HalfAgainstHalf::kLevel},
          {"differs", v.differs()},
          {"null_draws", v.null_draws},
          {"verdict", verdict(v)}};
}

Json to_json(const lattice::BodyMemory& m, const dynamics::Section& section) {
  const auto& faces = section.faces;
  Json json{{"runs", m.runs},
            {"states", m.states},
            {"together", to_json(m.together)},
            {"strongest", to_json(m.strongest)},
            {"p", m.p},
            {"remembers", m.remembers()},
            {"null_draws", m.null_draws},
            {"verdict", verdict(m, section)}};
  if (m.face < 0) return json;
  const auto outcome = static_cast<std::size_t>(m.outcome);
  json["strongest"]["face_before"] = faces[static_cast<std::size_t>(m.face)].name;
  json["strongest"]["outcome"] = outcome < faces.size() ? faces[outcome].name : "trapped";
  json["strongest"]["more"] = m.more;
  return json;
}

std::vector<std::string> rest_warnings(const HalvesValidation& v) {
  std::vector<std::string> all;
  for (std::size_t w = 0; w < 2; ++w)
    if (std::string rest =
            rest_warning(rest_of(v.ways[w].chain), "by the chain of " + chain_name(w) + " ");
        !rest.empty())
      all.push_back(std::move(rest));
  return all;
}

std::string table_of(const HalvesValidation& v) {
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
    text += seen_name(w) + "  | corrcoef " + fixed(way.corrcoef, 3) + " (" +
            fixed(way.chance_corrcoef, 3) + "), RMSE " + fixed(way.rmse_per_100, 2) + " (" +
            fixed(way.chance_rmse_per_100, 2) + ") per 100, total variation " +
            fixed(way.total_variation.seen, 3) + " (" + fixed(way.chance_total_variation, 3) +
            ", " + fixed(way.chance_total_variation_95, 3) + ")\n";
  }
  return text + "\n" + verdict(v) + ".\n";
}

Figure figure_of(const HalvesValidation& v, const ShownField& shown) {
  std::vector<ComparedGates> compared;
  for (std::size_t w = 0; w < 2; ++w) {
    const HalfAgainstHalf& way = v.ways[w];
    compared.push_back({seen_name(w) + ", chain of " + chain_name(w) + ": total variation " +
                            fixed(way.total_variation.seen, 3) +
                            " (chance: " + fixed(way.chance_total_variation, 3) + ")",
                        way.seen_gates, way.chain.final_cells});
  }
  return figure_of(compared,
                   std::string("final gates: halves ") +
                       (v.differs() ? "differ" : "do not differ") + " (" + p_words(v.p) + ")",
                   "as seen, %", shown);
}

}  // namespace gatewalk::cli
