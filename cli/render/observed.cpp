// SPDX-License-Identifier: MIT
#include "cli/render/observed.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/final_gates.h"
#include "cli/render/panel.h"
#include "cli/render/power.h"
#include "cli/render/tested_shares.h"
#include "cli/render/validation.h"
#include "dynamics/base/share.h"

namespace gatewalk::cli {
namespace {

using lattice::JointTest;

/// A difference of this share should not go unnoticed.
constexpr double kFewAreEnough = 0.25;

std::size_t index_of(const EndingName& e) { return static_cast<std::size_t>(e.ending); }

/// What bodies with each ending do, in the order of kEndingNames: "fewer cross".
constexpr std::array<const char*, kEndingNames.size()> kDo{
    "cross", "leave by the left side", "leave by the right side", "are trapped", "are cut off"};

/// "fewer cross, 10.00 [4.22, 19.07] % of them, 28.10 % by the model; final gates, ..."
std::string differences(const lattice::ObservedComparison& c, const JointTest& j,
                        const lattice::EndingShares& model) {
  std::vector<std::string> said;
  for (std::size_t e = 0; e < kEndingNames.size(); ++e) {
    const std::size_t at = index_of(kEndingNames[e]);
    if (!j.differs(kEndingNames[e].ending)) continue;
    said.push_back(fmt::format("{} {}, {} % of them, {} % by the model",
                               c.endings.share[at] < model.share[at] ? "fewer" : "more", kDo[e],
                               with_interval(c.endings.share[at], c.endings.interval[at]),
                               fixed(100.0 * model.share[at], 2)));
  }
  if (p_of_gates(j) <= JointTest::kLevel)
    said.push_back(fmt::format("they end in other gates, total variation {} (chance: {})",
                               fixed(j.total_variation.seen, 3),
                               fixed(j.chance_total_variation, 3)));
  if (j.differs(markov::Ending::unsampled)) said.emplace_back("states never sampled");
  return fmt::format("{}", fmt::join(said, "; "));
}

void describe(Fields& out, const JointTest& j, const std::optional<lattice::Comparison>& gates) {
  describe(out, j);
  out.object(
      {"p_endings", "p-value of the share of each ending, not corrected for testing several"},
      [&](Fields& f) {
        for (const EndingName& e : kEndingNames)
          f.number(
              {e.key, "1", fmt::format("p-value of the share of bodies that {}", meaning_of(e))},
              j.endings[index_of(e)].p);
      });
  out.if_any({"final_gates", "observed final gates compared with the model's"}, gates,
             [&](Fields& of, const auto& value) { describe(of, value); });
}

/// Describes the smallest detectable differences; `c` says in which numbers they are tested.
void describe(Fields& out, const lattice::LeastDifferences& least,
              const lattice::ObservedComparison& c) {
  out.number(
      {"power", "1", "statistical power: share of such experiments that detect the difference"},
      least.goal.power);
  out.number({"level", "1", "level of significance: share of experiments with a false detection"},
             least.goal.level);
  out.optional(c.seen.has_gates(), [&](Fields& f) {
    f.number({"final_gates_total_variation", "1",
              "total variation of the final gates, of the kind hardest to detect; null: none is "
              "detected"},
             least.final_gates.value_or(kUnknown));
  });
  out.optional(c.seen.has_endings(), [&](Fields& f) {
    f.number(
        {"endings_total_variation", "1",
         "total variation of the endings, of the kind hardest to detect; null: none is detected"},
        least.endings.value_or(kUnknown));
    f.object({"endings_percentage_points", "smallest detected change of each possible ending"},
             [&](Fields& of) {
               for (const EndingName& e : kEndingNames)
                 of.optional(!c.endings.rules_out(e.ending), [&](Fields& there) {
                   there.object({e.key, fmt::format("bodies that {}", meaning_of(e))},
                                [&](Fields& d) { describe(d, least.by_ending[index_of(e)]); });
                 });
             });
  });
}

std::string gates_part(const lattice::ObservedComparison& c) {
  TextTable table({{"", -14},
                   {"corrcoef (floor)", -20, 0, "", "  "},
                   {"RMSE (floor)", -16, 0, "", "  "},
                   {"TV (chance, 95 % of chance)", -28, 0, "", "  "},
                   {"p", 7, 0, "", "  "}});
  const auto row = [&](const char* name, const lattice::Comparison& k, const JointTest& j) {
    table.row(
        {name, fmt::format("{} ({})", fixed(k.corrcoef, 3), fixed(k.floor.corrcoef, 3)),
         fmt::format("{} ({})", fixed(k.rmse_per_100, 3), fixed(k.floor.rmse_per_100, 3)),
         fmt::format("{} ({}, {})", fixed(k.total_variation, 3), fixed(j.chance_total_variation, 3),
                     fixed(j.chance_total_variation_95, 3)),
         p_text(p_of_gates(j))});
  };
  row("full dynamics", *c.dynamics_gates, c.against_dynamics);
  row("chain", *c.chain_gates, c.against_chain);
  return "\nFinal gates of the observed trials against both; TV: total variation\n" + table.text();
}

/// The observed endings beside both models'; * marks a share that differs from the observed.
std::string shares_part(const lattice::ObservedComparison& c, const lattice::StartValidation& v) {
  TextTable table({{"", -10},
                   {"observed, %", -22, 0, "", "  "},
                   {"full dynamics, %", -22, 0, "", "  "},
                   {"chain, %", -22, 0, "", "  "},
                   {"detectable", 0, 0, "", "  "}});
  for (const EndingName& e : kEndingNames) {
    if (c.endings.rules_out(e.ending)) continue;
    const std::size_t at = index_of(e);
    const auto cell = [&](const lattice::EndingShares& of, bool differs) {
      return with_interval(of.share[at], of.interval[at]) + (differs ? " *" : "");
    };
    table.row({e.name, cell(c.endings, false),
               cell(v.dynamics_endings, c.against_dynamics.differs(e.ending)),
               cell(v.exact_endings, c.against_chain.differs(e.ending)),
               text_of(c.least.by_ending[at])});
  }
  const bool is_marked = std::ranges::any_of(kEndingNames, [&](const EndingName& e) {
    return !c.endings.rules_out(e.ending) &&
           (c.against_dynamics.differs(e.ending) || c.against_chain.differs(e.ending));
  });
  return table.text() +
         (is_marked ? "*: differs from the observed share by more than chance.\n" : "") +
         fmt::format("Detectable: the smallest shift, in points, that {} reveal (power {} %).\n",
                     counted(c.seen.trials(), "trial", "trials"),
                     fixed(100.0 * c.least.goal.power, 0));
}

std::string endings_part(const lattice::ObservedComparison& c) {
  TextTable table({{"", -10}, {"p: full dynamics", 18}, {"p: chain", 10}});
  for (const EndingName& e : kEndingNames) {
    if (c.endings.rules_out(e.ending)) continue;
    const std::size_t at = index_of(e);
    table.row({e.name, p_text(c.against_dynamics.endings[at].p_adjusted),
               p_text(c.against_chain.endings[at].p_adjusted)});
  }
  return "\nEach ending: how often chance makes as large a difference (p, corrected for all that "
         "is "
         "tested)\n" +
         table.text();
}

/// The verdict in a sentence; its p-values belong to the differences that it names.
std::string verdict_of(const lattice::ObservedComparison& c, const lattice::StartValidation& v) {
  const JointTest &d = c.against_dynamics, &k = c.against_chain;
  const std::string these = fmt::format("these {} trials ", c.seen.trials()),
                    in_dynamics =
                        fmt::format("the dynamics by more than chance ({})", p_words(d.p)),
                    in_chain = fmt::format("the chain ({})", p_words(k.p));
  if (d.differs())
    return fmt::format("{}differ from {}: {}; {} {}", these, in_dynamics,
                       differences(c, d, v.dynamics_endings),
                       k.differs() ? "and so they do from" : "but not from", in_chain);
  if (k.differs())
    return fmt::format(
        "{}do not differ from {}, but from {}: {}; the dynamics is the model, the chain its "
        "approximation",
        these, in_dynamics, in_chain, differences(c, k, v.exact_endings));
  return fmt::format("{}do not differ from {}, nor from {}; that does not say that they are equal",
                     these, in_dynamics, in_chain);
}

}  // namespace

void describe_observed(Fields& out, const lattice::ObservedComparison& c,
                       const lattice::StartValidation& v, const ObservedFiles& files) {
  out.object({"observed", "counts of an experiment, compared with dynamics and chain"}, [&](Fields&
                                                                                                f) {
    f.text({"verdict",
            "sentence: whether the counts differ from dynamics and chain, in what, and p-values"},
           verdict_of(c, v));
    f.texts({"files", "paths of the tables of counts"}, files.paths);
    f.count({"trials", "1", "observed trials, without those in went_back"}, c.seen.trials());
    f.optional(c.seen.has_endings(), [&](Fields& seen) {
      describe_endings(seen, c.seen.endings, static_cast<double>(c.seen.trials()), c.endings);
    });
    f.optional(c.seen.has_gates(), [&](Fields& seen) {
      seen.grid({"final_gates", "1", "number of observed trials by the gate in which they end"},
                c.seen.final_gates);
    });
    f.object({"against_dynamics", "test of the counts against the full dynamics"},
             [&](Fields& of) { describe(of, c.against_dynamics, c.dynamics_gates); });
    f.object({"against_chain", "test of the counts against the chain"},
             [&](Fields& of) { describe(of, c.against_chain, c.chain_gates); });
    f.object({"smallest_difference", "smallest differences that this number of trials detects"},
             [&](Fields& of) { describe(of, c.least, c); });
    f.count(
        {"went_back", "1",
         "observed trials that left by the side they came in by; the comparison leaves them out"},
        files.went_back);
  });
}

namespace {

/// The first sentence of the screen.
std::string first_sentence(const lattice::ObservedComparison& c) {
  const JointTest &d = c.against_dynamics, &k = c.against_chain;
  if (d.differs())
    return fmt::format(
        "The {} observed trials differ from the full dynamics ({}){} the chain ({}).",
        c.seen.trials(), p_words(d.p), k.differs() ? " and from" : "; no difference found from",
        p_words(k.p));
  return fmt::format("No difference found between {} trials and the full dynamics ({}){}.",
                     c.seen.trials(), p_words(d.p),
                     k.differs() ? fmt::format("; the chain differs ({})", p_words(k.p))
                                 : fmt::format(" or the chain ({})", p_words(k.p)));
}

/// A sentence for a publication, with the p against the full dynamics.
std::string sentence_to_quote(const lattice::ObservedComparison& c) {
  const JointTest& d = c.against_dynamics;
  const bool endings = c.seen.has_endings(), gates = c.seen.has_gates();
  const char* const what = endings && gates ? "endings and final gates"
                           : endings        ? "endings"
                                            : "final gates";
  return wrapped(fmt::format(
      "To quote: \"The {} of {} {} the full dynamics of the model ({}, test by simulation, "
      "corrected "
      "for all {}).\"",
      what, counted(c.seen.trials(), "trial", "trials"),
      d.differs() ? "differed from" : "did not differ detectably from", p_words(d.p), what));
}

}  // namespace

std::string answer_text(const lattice::ObservedComparison& c, const lattice::StartValidation& v) {
  const JointTest& d = c.against_dynamics;
  std::string text = wrapped(first_sentence(c));
  if (c.seen.has_endings()) text += shares_part(c, v);
  if (c.seen.has_gates())
    text += fmt::format(
        "Final gates: total variation {} from the full dynamics; chance alone makes {}.\n",
        fixed(c.dynamics_gates->total_variation, 3), fixed(d.chance_total_variation, 3));
  text += sentence_to_quote(c);
  text += wrapped(
      fmt::format("From {} and {} of the full dynamics.{}",
                  counted(c.seen.trials(), "observed trial", "observed trials"),
                  counted(v.dynamics.trials, "trial", "trials"),
                  d.differs() ? " gatewalk fit finds numbers that explain the counts." : ""));
  if (v.finding() == lattice::Finding::own_error)
    text += fmt::format(
        "Beware: the chain differs from the full dynamics ({}); compare with the "
        "dynamics.\n",
        p_words(v.joint_test.p));
  return text;
}

std::string details_text(const lattice::ObservedComparison& c, const lattice::StartValidation& v) {
  std::string text;
  if (c.seen.has_endings()) text += endings_part(c);
  if (c.seen.has_gates()) {
    text += gates_part(c);
    text += c.least.final_gates
                ? fmt::format(
                      "Detectable: a total variation of the final gates of {} or more, if it "
                      "is spread over all gates.\n",
                      fixed(*c.least.final_gates, 2))
                : "Detectable: no total variation of the final gates that is spread over all "
                  "gates.\n";
  }
  return fmt::format(
      "{}\n{}\nThe full dynamics is the model, and the chain approximates it. validate without "
      "--observed shows\nmore of their comparison.\n",
      text, chain_verdict(v));
}

std::string who_went_back(const lattice::Observed& observed) {
  if (observed.went_back == 0) return "";
  return fmt::format(
      "{} of {} trials went back, which the model excludes: they are left out (a body that gave up "
      "at a gate is trapped there)",
      observed.went_back, observed.went_back + observed.seen.trials());
}

std::string too_few_observed(const lattice::Observed& observed) {
  const std::int64_t n = observed.seen.trials();
  const lattice::PowerGoal goal;
  const auto least = lattice::smallest_difference(n, 0.5, goal);
  if (least.more && *least.more <= kFewAreEnough) return "";
  return fmt::format(
      "{} a shift of {} points in an ending of 50 % (power {} %); gatewalk power plans experiments",
      counted(n, "trial detects", "trials detect"),
      least.more ? fixed(100.0 * *least.more, 0) : "more than 50", fixed(100.0 * goal.power, 0));
}

std::string endings_not_listed(const lattice::Observed& observed,
                               const lattice::StartValidation& v) {
  constexpr double kWorthASentence = 0.01;
  if (!observed.seen.has_endings()) return "";
  std::string text;
  for (const EndingName& e : kEndingNames) {
    const double share = v.dynamics_endings.share[index_of(e)];
    if (observed.listed[index_of(e)] || share < kWorthASentence) continue;
    text += fmt::format("{}{}, which counts as 0 (dynamics: {})",
                        text.empty() ? "the table of endings has no row for " : ", ", e.name,
                        percent(share, 1.0));
    if (e.ending == markov::Ending::cut_off)
      text += "; field.max_gates = 0 cuts off nobody, if nothing stopped your trials";
  }
  return text;
}

namespace {

/// A share to draw, with its interval; without an interval low and high are the share.
struct DrawnShare {
  double share, low, high;
};
/// A row of the figure: observed, by the dynamics, and by the chain.
struct ComparedShare {
  std::string name;
  std::array<DrawnShare, 3> shares;
};
constexpr std::array<const char*, 3> kCompared{"observed", "dynamics", "chain"};
constexpr std::array<const char*, 3> kInks{kSecondColour, kFirstColour, kThirdColour};
constexpr std::array<int, 3> kSymbols{7, 6, 4};  // a dot, a ring, a square

DrawnShare drawn_share(double share, const std::array<double, 2>& interval) {
  if (std::isnan(interval[0])) return {share, share, share};
  return {share, interval[0], interval[1]};
}
DrawnShare drawn_share(std::int64_t count, std::int64_t trials) {
  return drawn_share(static_cast<double>(count) / static_cast<double>(trials),
                     dynamics::share_interval(count, trials));
}

std::vector<ComparedShare> compared_endings(const lattice::ObservedComparison& c,
                                            const lattice::StartValidation& v) {
  std::vector<ComparedShare> rows;
  for (const EndingName& e : kEndingNames) {
    if (c.endings.rules_out(e.ending)) continue;
    const auto of = [&](const lattice::EndingShares& all) {
      const auto at = static_cast<std::size_t>(e.ending);
      return drawn_share(all.share[at], all.interval[at]);
    };
    rows.push_back({e.name, {of(c.endings), of(v.dynamics_endings), of(v.exact_endings)}});
  }
  return rows;
}

/// The gates with the largest share in any of the three, and all others together.
std::vector<ComparedShare> compared_gates(const lattice::ObservedComparison& c,
                                          const lattice::StartValidation& v,
                                          const lattice::FieldParams& field) {
  constexpr std::size_t kMostRows = 20;
  const markov::CellCounts &seen = c.seen.final_gates, &trials = v.dynamics.final_cells;
  const auto columns = static_cast<Eigen::Index>(field.columns);
  const std::int64_t n = seen.sum(), m = trials.sum();
  struct Gate {
    Eigen::Index row, column;
    double most;
  };
  std::vector<Gate> gates;
  for (Eigen::Index row = 0; row < seen.rows(); ++row)
    for (Eigen::Index column = 0; column < columns; ++column) {
      const double most =
          std::max({static_cast<double>(seen(row, column)) / static_cast<double>(n),
                    static_cast<double>(trials(row, column)) / static_cast<double>(m),
                    v.exact.final_cells(row, column)});
      if (most > 0.0) gates.push_back({row, column, most});
    }
  std::stable_sort(gates.begin(), gates.end(),
                   [](const Gate& a, const Gate& b) { return a.most > b.most; });
  std::vector<ComparedShare> rows;
  std::int64_t other_seen = n, other_trials = m;
  double other_chain = v.exact.final_cells.sum();
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [row, column, most] : gates) {
    if (rows.size() == kMostRows) break;
    const double chain = v.exact.final_cells(row, column);
    other_seen -= seen(row, column);
    other_trials -= trials(row, column);
    other_chain -= chain;
    rows.push_back({fmt::format("{}, {}", column - field.start_column(), row),
                    {drawn_share(seen(row, column), n), drawn_share(trials(row, column), m),
                     drawn_share(chain, {kNone, kNone})}});
  }
  if (rows.size() < gates.size())
    rows.push_back({"others",
                    {drawn_share(other_seen, n), drawn_share(other_trials, m),
                     drawn_share(std::max(0.0, other_chain), {kNone, kNone})}});
  return rows;
}

/// Draws a panel with three marks in each row from `top` on. Returns where the next panel begins.
double add_compared(Panels& out, double top, const std::string& title, const std::string& kind,
                    double row_height, const std::vector<ComparedShare>& rows) {
  const auto count = static_cast<double>(rows.size());
  Panel& panel = out.add({110, 372, top + 36, top + 36 + row_height * count});
  std::vector<Layer> key;
  double most = 0.0;
  for (std::size_t k = 0; k < kCompared.size(); ++k) {
    Rows& data = out.data(fmt::format("${}_{}", kCompared[k], kind));
    bool has_intervals = false;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const DrawnShare& s = rows[i].shares[k];
      most = std::max(most, 100.0 * s.high);
      has_intervals = has_intervals || s.low < s.high;
      // The marks stand one below the other, so that they do not hide each other.
      const double at = static_cast<double>(i) + 0.25 * (static_cast<double>(k) - 1.0);
      data.add(100.0 * s.share, at, 100.0 * s.low, 100.0 * s.high);
    }
    const Pen pen{kInks[k], 1.2, kSymbols[k], 0.6};
    panel.draw(data, has_intervals ? "1:2:3:4" : "1:2", has_intervals ? "xerrorbars" : "points",
               pen);
    key.push_back(entry("points", pen, kCompared[k]));
  }
  std::vector<std::string> names;
  for (const ComparedShare& row : rows) names.push_back(row.name);
  most = most > 0.0 ? std::min(100.0, 1.05 * most) : 100.0;
  panel.say(title, 8, top + 18);
  panel.x = {"% of trials, 95 %", 0, most, digits(tic_step(most, 5))};
  panel.y = {"", count - 0.5, -0.5, tics_of(names) + " scale 0 font ',12'"};
  const Box box = panel.box;
  out.add_key(388, box.top, std::move(key));
  return box.bottom + 54;
}

}  // namespace

Figure figure_of(const lattice::ObservedComparison& c, const lattice::StartValidation& v,
                 const lattice::FieldParams& field) {
  Panels out;
  out.say(fmt::format("{} trials observed, {} of the dynamics", c.seen.trials(), v.dynamics.trials),
          8, 16);
  out.say(fmt::format("against the dynamics {}, against the chain {}",
                      p_words(c.against_dynamics.p), p_words(c.against_chain.p)),
          8, 36, kSmallFont);
  double end = 46.0;
  if (c.seen.has_endings())
    end = add_compared(out, end, "endings", "endings", 28.0, compared_endings(c, v));
  if (c.seen.has_gates())
    end = add_compared(out, end, "final gates: column i_x, row i_y", "gates", 22.0,
                       compared_gates(c, v, field));
  return out.figure(static_cast<int>(std::ceil(end)));
}

}  // namespace gatewalk::cli
