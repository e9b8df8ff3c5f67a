// SPDX-License-Identifier: MIT
#include "cli/render/assumptions.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "lattice/pool/assumptions.h"

namespace gatewalk::cli {
namespace {

using lattice::Assumption;
using lattice::AssumptionCheck;

/// An assumption in words.
struct Words {
  Assumption assumption;
  std::string_view name;
  std::string_view meaning;  // of the key
  std::string_view wrong;    // a sentence of its own
  std::string_view cure;     // what to do
  std::string_view cure_of_recorded;
};
constexpr std::array<Words, lattice::kAssumptions.size()> kWords{{
    {Assumption::mirror, "mirror images",
     "the mirror image of a run is a run too, in cells that say so; null: none do",
     "left and right differ in cells that count as symmetric", "set symmetric = false",
     "set symmetric = false"},
    {Assumption::states, "size of states",
     "bodies of one state are alike; the relaxed chain has smaller states",
     "the states are too large",
     "ask for a smaller --accuracy; for a matrix with --states, for more states",
     "only more recorded bodies make them smaller"},
    {Assumption::face_before, "the face before",
     "the face by which a body entered the cell before does not matter",
     "bodies remember the face by which they entered the cell before", "trust gatewalk lattice",
     "let the chain remember turns: validate --order says how many, build --order does it"},
    {Assumption::quarters, "quarters of the field",
     "cells of one type are alike near and far, on the left and right; null also: recorded runs",
     "cells of one type differ between near and far, or left and right",
     "give them types of their own, or trust gatewalk lattice", "give them types of their own"},
    {Assumption::cells, "places in the field",
     "cells of one type are alike everywhere; null also: recorded runs",
     "cells of one type differ from place to place",
     "give them types of their own, or trust gatewalk lattice", "give them types of their own"},
}};

const AssumptionCheck* find(const std::vector<AssumptionCheck>& checks, Assumption assumption) {
  const auto at = std::find_if(checks.begin(), checks.end(), [&](const AssumptionCheck& check) {
    return check.assumption == assumption;
  });
  return at == checks.end() ? nullptr : &*at;
}

std::string difference_text(const AssumptionCheck& check) {
  return fmt::format("gives other final gates (total variation {}, by chance up to {})",
                     fixed(check.total_variation, 4), fixed(check.chance_95, 4));
}

}  // namespace

void describe_assumptions(Fields& out, const std::vector<AssumptionCheck>& checks) {
  out.object(
      Label("assumptions",
            "the chain against chains of the same runs that drop one of its assumptions each; "
            "null: not checked (answers of trials or walks), or not assumed")
          .shared(),
      [&](Fields& f) {
        for (const Words& words : kWords) {
          const AssumptionCheck* const check = find(checks, words.assumption);
          f.maybe(Label(lattice::key_of(words.assumption), words.meaning),
                  check ? std::optional(*check) : std::nullopt,
                  [](Fields& of, const AssumptionCheck& c) {
                    of.number({"total_variation", "1",
                               "total variation between the final gates of both chains"},
                              c.total_variation);
                    of.number({"chance_total_variation_limit", "1",
                               "95 % of differences by chance are at most this"},
                              c.chance_95);
                    of.number({"p", "1", "p-value of the difference"}, c.p);
                    of.number({"p_adjusted", "1", "p-value, adjusted for all assumptions together"},
                              c.p_adjusted);
                    of.flag({"wrong", "whether p_adjusted is at most 0.01"}, c.is_wrong());
                  });
        }
      });
}

std::string assumptions_text(const std::vector<AssumptionCheck>& checks) {
  if (checks.empty()) return "";
  TextTable table({{"Assumption", -kFit},
                   {"", -kFit, 0, "", "  "},
                   {"p, corrected", kFit, 4, "", "  "},
                   {"final gates differ without it by", kFit, 4, "", "  "},
                   {"by chance up to", kFit, 4, "", "  "}});
  for (const Words& words : kWords)
    if (const AssumptionCheck* const check = find(checks, words.assumption))
      table.row({words.name, check->is_wrong() ? "wrong" : "fine", check->p_adjusted,
                 check->total_variation, check->chance_95});
  return table.text();
}

std::string wrong_assumption_text(const std::vector<AssumptionCheck>& checks, bool is_recorded) {
  const AssumptionCheck* const wrong = lattice::wrong_assumption(checks);
  if (wrong == nullptr) return "";
  const auto words = std::find_if(kWords.begin(), kWords.end(), [&](const Words& w) {
    return w.assumption == wrong->assumption;
  });
  return fmt::format("{}: a chain without this assumption {}; {}", words->wrong,
                     difference_text(*wrong), is_recorded ? words->cure_of_recorded : words->cure);
}

std::string beware_of(const std::vector<AssumptionCheck>& checks, bool is_recorded) {
  const std::string text = wrong_assumption_text(checks, is_recorded);
  return text.empty() ? "" : wrapped("Beware: " + text + ".");
}

}  // namespace gatewalk::cli
