// SPDX-License-Identifier: MIT
#include "cli/render/order.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/cross_validation.h"
#include "cli/render/memory.h"
#include "cli/render/panel.h"
#include "lattice/pool/remembered.h"

namespace gatewalk::cli {
namespace {

using lattice::Fold;
using lattice::OrderAnswer;
using lattice::OrderStudy;

/// "turns", "faces before", "states before".
std::string letters(const OrderStudy& study) {
  const std::string name(lattice::name_of(study.of));
  return study.of == dynamics::LettersOf::turns ? name : name + " before";
}
/// "2 turns", "1 turn".
std::string letters(const OrderStudy& study, int order) {
  std::string name(lattice::name_of(study.of));
  if (order == 1) name.pop_back();
  if (study.of != dynamics::LettersOf::turns) name += " before";
  return std::to_string(order) + " " + name;
}

/// A share in percent with two significant digits or more; 0 for what rounding made.
std::string percent_of(double share) {
  constexpr double kRounding = 1e-9;
  const double percent = std::abs(share) < kRounding ? 0.0 : 100.0 * share;
  return (std::abs(percent) < 99.5 ? digits(percent, 2) : fixed(percent, 0)) + " %";
}

/// The mean over both halves.
double mean_of_halves(const OrderAnswer& a, double Fold::*number) {
  return 0.5 * (a.halves.folds[0].*number + a.halves.folds[1].*number);
}
double mean_total_variation(const OrderAnswer& a) {
  return 0.5 * (a.halves.folds[0].total_variation.seen + a.halves.folds[1].total_variation.seen);
}

std::string verdict(const OrderStudy& study) {
  const OrderAnswer& a = study.answer();
  const std::string compared = fmt::format(" (orders {} to {} compared).",
                                           study.orders.front().order, study.orders.back().order);
  const bool is_least = a.order > 0 && study.chosen == 0;  // fewer were not compared
  std::string text = a.order == 0 ? "The chain need not remember " + letters(study) + compared
                     : is_least   ? letters(study, a.order) + " are enough" + compared
                                  : "The chain must remember " + letters(study, a.order) + compared;
  if (study.may_need_more())
    text += " It may need more: no larger order was compared.";
  else if (study.chosen == study.best)
    text += " With more it predicts other bodies less well.";
  else
    text += fmt::format(
        " More gain nothing that {} bodies can show: a passage becomes at most {} more likely.",
        study.bodies, percent_of(a.interval[1]));
  return text;
}

/// Whether the chain should know the numbers that bodies remember; empty: they remember none.
std::string remembered_text(const OrderStudy& study) {
  if (!study.remembered) return "";
  const lattice::RememberedAnswer& a = *study.remembered;
  const std::string keys = fmt::format("what bodies carry ({})", fmt::join(a.keys, ", "));
  if (a.passages == 0)
    return fmt::format(
        "Whether the chain should know {} cannot be told: it does not vary, or too "
        "few passages are alike.",
        keys);
  const std::string interval =
      fmt::format("[{}, {}]", percent_of(a.interval[0]), percent_of(a.interval[1]));
  return a.matters()
             ? fmt::format(
                   "The chain forgets {}: knowing it made each of {} passages {} more likely {}.",
                   keys, a.passages, percent_of(a.gain), interval)
             : fmt::format(
                   "{} bodies do not show that the chain should know {}: it changed the "
                   "likelihood of each of {} passages by {} {}.",
                   study.bodies, keys, a.passages, percent_of(a.gain), interval);
}

/// Whether bodies do what the chain of that order says, with the caution that few bodies need.
std::string what_is_left(const OrderStudy& study) {
  const lattice::CrossValidation& halves = study.answer().halves;
  const std::string p =
      p_words(halves.p) + (study.bodies < kBodiesForP
                               ? fmt::format("; with {} bodies p may be too small", study.bodies)
                               : "");
  std::string text =
      halves.differs()
          ? fmt::format(
                "With this memory the chain of one half of the bodies still does not predict "
                "the other ({}): what is left is no memory of up to {}.",
                p, letters(study, study.orders.back().order))
          : fmt::format(
                "With this memory the chain of one half of the bodies predicts the other, as "
                "far as these runs can tell ({}).",
                p);
  if (const std::int64_t out = study.answer().left_out; out > 0)
    text += fmt::format(" Beware: a chain has no room for {} of its {} memories.", out,
                        out + study.answer().words);
  return text;
}

}  // namespace

void describe(Fields& out, const OrderResult& result) {
  describe_order(out, result);
  describe_recorded(out, result.recorded);
  describe_made_by(out, result.made_by);
}

void describe_order(Fields& out, const OrderResult& result) {
  const OrderStudy& study = result.study;
  out.text(Label("order_of", "what a chain remembers of the cells before")
               .one_of({"turns", "faces", "states"}),
           lattice::name_of(study.of));
  out.count(
      {"order", "1", "least number to remember of those compared: no other is known to be better"},
      study.orders.empty() ? 0 : study.answer().order);
  out.count({"best_order", "1", "the order with the largest likelihood"},
            study.orders.empty() ? 0 : study.orders[study.best].order);
  out.list(
      {"orders", "the orders compared, each by chains that predict other bodies"}, study.orders,
      [](Fields& f, const OrderAnswer& a) {
        f.count({"order", "1", "how much the chain remembers"}, a.order);
        f.count({"words", "1", "different memories of the chain of all bodies"}, a.words);
        f.number({"likelihood", "1",
                  "geometric mean of the probabilities that the chain of other bodies gave to "
                  "what each passage led to"},
                 a.likelihood);
        f.estimate(
            Field("gain_to_best", "1", "by which share the likelihood of the best order is larger")
                .bounded_by("95 % interval of gain_to_best, simultaneous for all "
                            "orders, by draws of bodies"),
            a.gain_to_best, known(a.interval));
        f.flag({"enough", "whether the best order is not known to be better"}, a.is_enough());
        f.list({"halves",
                "the second half of the bodies against the chain of the first, then the first "
                "against the second's"},
               a.halves.folds, [](Fields& of, const Fold& fold) {
                 of.count({"states", "1", "states of the chain"}, fold.states);
                 of.object({"total_variation", "total variation of the final gates"},
                           [&](Fields& t) { describe(t, fold.total_variation); });
                 of.number({"total_variation_chance", "1",
                            "mean total variation that chance in the bodies makes"},
                           fold.chance_total_variation);
                 of.number({"total_variation_chance_q95", "1",
                            "95 % of the total variations that chance makes are at most this"},
                           fold.chance_total_variation_95);
                 for (const lattice::EndingName& e : lattice::kAllEndingNames) {
                   const auto at = static_cast<std::size_t>(e.ending);
                   of.object({e.key, "share of this ending, as seen and by the chain"},
                             [&](Fields& s) {
                               s.estimate({"seen", "1", "share of the trials, as seen"},
                                          fold.seen.share[at], known(fold.seen.interval[at]));
                               s.estimate({"chain", "1", "share by the other half's chain"},
                                          fold.chain_endings.share[at],
                                          known(fold.chain_endings.interval[at]));
                               s.number({"chance_q95", "1",
                                         "95 % of the differences by chance are at most this"},
                                        fold.chance_95[at]);
                             });
                 }
               });
        f.number({"p", "1", "p-value of the difference of the halves, all statistics together"},
                 a.halves.p);
      });
  out.if_any(Label("remembered",
                   "what the chain would gain by the numbers that bodies carry and that their "
                   "entries do not show"),
             study.remembered, [](Fields& f, const lattice::RememberedAnswer& a) {
               f.texts({"numbers", "their keys"}, a.keys);
               f.count({"passages", "1",
                        "passages whose numbers could tell something; 0: nothing else is known"},
                       a.passages);
               const bool is_known = a.passages > 0;
               f.estimate(
                   Field("gain", "1",
                         "by which share knowing them made such a passage more likely, for chains "
                         "learned from nine tenths of these bodies")
                       .bounded_by("95 % interval of gain, by draws of bodies"),
                   is_known ? a.gain : kUnknown, is_known ? known(a.interval) : std::nullopt);
               f.flag({"matters", "whether the chain forgets something that matters"}, a.matters());
             });
  out.count({"passages", "1", "passages with a known outcome"}, study.passages);
  out.count({"max_gates", "1",
             "number of cells after which the halves are compared, 0: at the end of every trial; "
             "field.max_gates, or, of trials not seen to their ends, what nine of ten trials pass"},
            study.max_gates);
  const std::string remembered = remembered_text(study);
  out.text(
      {"verdict", "what the chain must remember, in words"},
      study.orders.empty() ? "" : verdict(study) + (remembered.empty() ? "" : " ") + remembered);
}

std::string answer_text(const OrderResult& result) {
  const OrderStudy& study = result.study;
  std::string text = wrapped(verdict(study)) +
                     (study.remembered ? wrapped(remembered_text(study)) : "") +
                     wrapped(what_is_left(study));
  TextTable table({{"Order", 5},
                   {"likelihood", 12, 4},
                   {"best order more likely by, 95 %", 34},
                   {"halves: total variation", 25, 3},
                   {"by chance", 11, 3},
                   {"at most (95 %)", 16, 3}});
  for (const OrderAnswer& a : study.orders)
    table.row({std::to_string(a.order), a.likelihood,
               &a == &study.orders[study.best]
                   ? std::string("(the best)")
                   : fmt::format("{} [{}, {}]", percent_of(a.gain_to_best),
                                 percent_of(a.interval[0]), percent_of(a.interval[1])),
               mean_total_variation(a), mean_of_halves(a, &Fold::chance_total_variation),
               mean_of_halves(a, &Fold::chance_total_variation_95)});
  text += table.text();
  text += study.max_gates == 0
              ? "Halves: where bodies ended.\n"
              : fmt::format("Halves: where bodies are after {} cells or where they ended before.\n",
                            study.max_gates);
  if (result.is_recorded) return text + table_of(result.recorded);
  return text +
         fmt::format("{} simulated trials, {} passages.\n", result.recorded.trials, study.passages);
}

std::string details_text(const OrderResult& result) {
  const OrderStudy& study = result.study;
  std::string text =
      "\nLikelihood: geometric mean of the probabilities that chains of other bodies gave to what "
      "each\npassage led to (ten-fold cross-validation over bodies). Intervals hold for all orders "
      "together. Bodies with different habits seem to remember, because past turns tell\nthem "
      "apart.\nShares of endings: half 2, as seen and by the chain of half 1; then half 1.\n\n";
  TextTable table({{"Order", 5},
                   {"words", 7},
                   {"ending", -14, 0, "", "  "},
                   {"seen, %", 9, 1},
                   {"chain, %", 10, 1},
                   {"seen, %", 10, 1},
                   {"chain, %", 10, 1}});
  for (const OrderAnswer& a : study.orders)
    for (const lattice::EndingName& e : lattice::kAllEndingNames) {
      const auto at = static_cast<std::size_t>(e.ending);
      const auto& [one, two] = a.halves.folds;
      if (one.seen.share[at] + one.chain_endings.share[at] + two.seen.share[at] +
              two.chain_endings.share[at] ==
          0.0)
        continue;
      table.row({std::to_string(a.order), std::to_string(a.words), e.name,
                 100.0 * one.seen.share[at], 100.0 * one.chain_endings.share[at],
                 100.0 * two.seen.share[at], 100.0 * two.chain_endings.share[at]});
    }
  return text + table.text();
}

Figure figure_of(const OrderResult& result) {
  const OrderStudy& study = result.study;
  Panels out;
  Rows &band = out.data("$chance"), &error = out.data("$error"), &gain = out.data("$gain"),
       &limits = out.data("$limits");
  double most = 0.0, most_gain = 0.0;
  for (const OrderAnswer& a : study.orders) {
    const double high = mean_of_halves(a, &Fold::chance_total_variation_95);
    band.add(a.order, 0.0, high);
    error.add(a.order, a.halves.folds[0].total_variation.seen,
              a.halves.folds[1].total_variation.seen, mean_total_variation(a));
    gain.add(a.order, 100.0 * a.gain_to_best);
    limits.add(a.order, 100.0 * a.interval[0], 0.0, 100.0 * (a.interval[1] - a.interval[0]));
    most = std::max({most, high, mean_total_variation(a)});
    most_gain = std::max(most_gain, 100.0 * a.interval[1]);
  }
  const double low = study.orders.front().order - 0.25, high = study.orders.back().order + 0.25;
  const std::string name = letters(study) + " remembered";
  Panel& p = out.add(Box{84, 250, 44, 250});
  p.x = {.name = name, .low = low, .high = high, .tics = "1"};
  p.y = {.name = "total variation", .low = 0.0, .high = 1.5 * most, .tics = "0.2"};
  p.say("One half predicts the other", 8, 18);
  p.key = Legend{"on top right samplen 1.5"};
  p.draw(band, "1:2:3", "filledcurves", {.colour = "#d9d9d9"}, "by chance");
  p.draw(error, "1:4", "linespoints", {.colour = "#0072b2", .width = 2, .mark = 7, .size = 0.7},
         "halves");
  p.draw_again("1:2", "points", {.colour = "#0072b2", .mark = 6, .size = 0.5});
  p.draw_again("1:3", "points", {.colour = "#0072b2", .mark = 6, .size = 0.5});
  Panel& g = out.add(Box{334, 494, 44, 250});
  g.x = {.name = name, .low = low, .high = high, .tics = "1"};
  g.y = {.name = "likelihood of a passage, %", .high = 1.15 * most_gain};
  g.say("What the best order gains", 266, 18);
  g.draw(limits, "1:2:3:4", kIntervals, kIntervalPen);
  g.draw(gain, "1:2", "points", {.colour = "#d55e00", .mark = 7, .size = 0.8});
  g.draw_level(0.0, {.colour = kInk, .width = 0.5});
  return out.figure(300);
}

}  // namespace gatewalk::cli
