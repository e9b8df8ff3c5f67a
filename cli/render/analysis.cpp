// SPDX-License-Identifier: MIT
#include "cli/render/analysis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "cli/render/choice.h"
#include "cli/render/costs.h"
#include "cli/render/health.h"
#include "dynamics/disc/gate.h"
#include "lattice/field/matrix_file.h"

namespace gatewalk::cli {
namespace {

using dynamics::Cost;
using lattice::FieldCosts;
using lattice::Mean95OfRuns;

constexpr std::int64_t kFew = 50;  // fewest walks or trials for a distribution

std::size_t place(markov::Ending ending) { return static_cast<std::size_t>(ending); }

const std::vector<dynamics::CostInfo>& costs_of(const AnalysedField& f) {
  return f.shown.map.section.costs;
}

/// Durations of walks with this ending (all walks without one), ascending; empty for too few walks.
std::vector<double> durations_of(const lattice::Analysis& a, std::optional<markov::Ending> ending) {
  std::vector<double> out;
  for (const markov::TimedWalk& w : a.walks)
    if (!ending || w.ending == *ending) out.push_back(w.total);
  if (std::ssize(out) < kFew) out.clear();
  std::sort(out.begin(), out.end());
  return out;
}

double quantile(const std::vector<double>& sorted, double level) {
  if (sorted.empty()) return kUnknown;
  const auto at = static_cast<std::size_t>(level * static_cast<double>(sorted.size()));
  return sorted[std::min(at, sorted.size() - 1)];
}

}  // namespace

Spent spent(const lattice::Analysis& a, std::optional<markov::Ending> ending) {
  Spent s;
  for (std::size_t c = 0; c < a.totals.totals.size(); ++c) {
    const auto& by_ending = a.totals.totals[c];
    const markov::Moments m =
        ending ? by_ending[place(*ending)] : markov::WalkTotals::all(by_ending);
    s.share = m.share;
    s.mean[c] = m.mean();
    s.sd[c] = m.sd();
  }
  const std::vector<double> walks = durations_of(a, ending);
  for (std::size_t q = 0; q < s.quantiles.size(); ++q)
    s.quantiles[q] = quantile(walks, Spent::kLevels[q]);
  return s;
}

KolmogorovDistance duration_distance(const lattice::Analysis& a, const FieldCosts& costs,
                                     std::optional<markov::Ending> ending) {
  const std::vector<double> walks = durations_of(a, ending);
  const auto steps = ending ? costs.durations(*ending) : costs.durations();
  if (walks.empty() || steps.empty() || steps.back().trials < kFew) return {};
  // A trial's duration is known to its bin, given by the middle, so walks are compared at the bin's
  // ends. Within a bin the trials' distribution function is constant and the walks' function grows.
  const double half = 0.5 * costs.bin();
  const auto n = static_cast<double>(steps.back().trials), m = static_cast<double>(walks.size());
  const auto walks_until = [&](double seconds) {
    return static_cast<double>(std::upper_bound(walks.begin(), walks.end(), seconds) -
                               walks.begin()) /
           m;
  };
  double distance = 0.0, before = 0.0;
  for (const FieldCosts::Step& s : steps) {
    const double trials = static_cast<double>(s.trials) / n;
    distance = std::max({distance, std::abs(before - walks_until(s.seconds - half)),
                         std::abs(trials - walks_until(s.seconds + half))});
    before = trials;
  }
  constexpr double kSmirnov95 = 1.358;  // 95 % quantile of the distance times sqrt(n m / (n + m))
  return {distance, kSmirnov95 * std::sqrt(1.0 / n + 1.0 / m)};
}

namespace {

// ---- The result ----

/// The list; null if it is empty.
template <class T>
const std::vector<T>* if_any(const std::vector<T>& list) {
  return list.empty() ? nullptr : &list;
}

/// A mean with its key; `varies` is the key as shown if it differs among results.
struct NamedMean {
  std::string key, varies, unit, meaning;
  const Mean95OfRuns* mean;

  [[nodiscard]] bool says_why() const { return !mean->why_none.empty(); }
  void describe(Fields& out) const {
    out.estimate(Field(key, unit, meaning).varying(varies), mean->mean, mean->interval);
  }
};

/// The key "why_no_interval", for means without an interval.
void describe_reasons(Fields& out, const std::vector<NamedMean>& means) {
  out.optional(std::ranges::any_of(means, &NamedMean::says_why), [&](Fields& f) {
    f.object({"why_no_interval", "by the key of the mean: why the mean has no 95 % interval"},
             [&](Fields& why) {
               for (const NamedMean& m : means)
                 if (m.says_why() || why.is_schema())
                   why.text(Label(m.key, "why this mean has no 95 % interval").varying("<mean>"),
                            m.mean->why_none);
             });
  });
}

struct MeanOfDiscs {
  Cost cost;
  const char *key, *unit, *meaning;
};
constexpr MeanOfDiscs kMeansOfDiscs[] = {
    {Cost::seconds, "expected_seconds", "s",
     "mean duration of a body's way through the field, however it ends"},
    {Cost::propulsion_work, "expected_work_J", "J",
     "mean work of the propulsion on a body, however its way ends"},
    {Cost::random_work, "expected_random_work_J", "J",
     "mean work of the random force on a body, however its way ends"},
    {Cost::lost, "expected_lost_J", "J",
     "mean energy that a body loses to hits, dampers and drag, or leaves in the beams"}};

/// Gates visited and costs, over all bodies.
void describe_means(Fields& out, const AnalysedField& f) {
  const lattice::Analysis& a = f.analysis;
  std::vector<NamedMean> means{{"expected_gates", "", "1",
                                "mean number of gate visits of a body, however its way ends",
                                &a.gates}};
  if (f.shown.mass)
    for (const auto& [cost, key, unit, meaning] : kMeansOfDiscs)
      means.push_back({key, "", unit, meaning, &a.costs[static_cast<std::size_t>(cost)]});
  if (!f.shown.mass || out.is_schema())
    for (std::size_t c = 0; c < a.costs.size(); ++c)
      means.push_back({"expected_" + costs_of(f)[c].key, "expected_<cost>", "its own",
                       "mean of this cost over all bodies, in the unit of the cost", &a.costs[c]});
  for (const NamedMean& m : means) {
    if (&m == &means.front())
      m.describe(out);
    else
      out.optional(true, [&](Fields& o) { m.describe(o); });
  }
  describe_reasons(out, means);
}

void describe_by_ending(Fields& out, const AnalysedField& f) {
  const lattice::Analysis& a = f.analysis;
  const auto means_of = [&](markov::Ending ending) {
    std::vector<NamedMean> means;
    for (std::size_t c = 0; c < costs_of(f).size(); ++c)
      means.push_back({"mean_" + costs_of(f)[c].key, "", "", "", &a.costs_of[place(ending)][c]});
    return means;
  };
  const auto add = [&](Fields& endings, const char* key, const std::string& who,
                       std::optional<markov::Ending> ending) {
    Spent s = spent(a, ending);
    const auto means = ending ? means_of(*ending) : std::vector<NamedMean>();
    for (const NamedMean& m : means) s.mean_95.push_back(m.mean->interval);
    endings.optional(s.share > 0.0, [&](Fields& o) {
      o.object(Label(key, who).shared("costs_of_bodies"), [&](Fields& one) {
        describe(one, s, f.shown);
        one.number(
            {"probability", "1", "share of all bodies that belong to this group, by the chain"},
            ending ? a.endings[place(*ending)] : s.share);
        if (ending) describe_reasons(one, means);
        one.optional(f.direct.has_value(), [&](Fields& d) {
          const auto [distance, chance_95] = duration_distance(a, f.direct->costs, ending);
          d.number({"kolmogorov_distance", "1",
                    "Kolmogorov distance between times of the chain's walks and of the trials; "
                    "null: fewer than 50 of either"},
                   distance);
          d.number({"kolmogorov_chance_q95", "1",
                    "kolmogorov_distance that chance alone exceeds in 5 % of cases; null: as "
                    "kolmogorov_distance"},
                   chance_95);
        });
      });
    });
  };
  out.object(
      {"by_ending", "times and costs of bodies by the chain: of all bodies, and by their ending"},
      [&](Fields& endings) {
        add(endings, "all", "times and costs of all bodies", {});
        for (const EndingName& e : kAllEndingNames)
          add(endings, e.key, fmt::format("times and costs of bodies that {}", meaning_of(e)),
              e.ending);
      });
}

void describe_endless(Fields& out, const lattice::Analysis& a) {
  out.maybe(
      {"quasi_stationary",
       "bodies not yet trapped after many gates of an endless field (quasi-stationary "
       "distribution); null: none"},
      a.endless, [&](Fields& q, const markov::QuasiStationary& endless) {
        q.number({"survival_per_gate", "1",
                  "share of bodies that are not trapped in each further gate: the largest "
                  "eigenvalue of a gate's kernel"},
                 endless.survival);
        q.number({"second_eigenvalue", "1",
                  "modulus of the second largest eigenvalue of a gate's kernel"},
                 endless.second);
        q.number({"spectral_gap", "1", "survival_per_gate minus second_eigenvalue"},
                 endless.spectral_gap());
        q.number({"kept_per_gate", "1",
                  "part of the memory of the start that one gate leaves: second_eigenvalue / "
                  "survival_per_gate"},
                 endless.second / endless.survival);
        q.number({"rows_per_gate", "1",
                  "mean number of rows that a body advances in each move to the next gate"},
                 endless.rows_per_cell);
        q.numbers(
            {"eigenvalues", "1",
             "moduli of the largest eigenvalues of a gate's kernel, largest first, at most six"},
            endless.moduli);
        std::vector<double> scales;
        for (const double modulus : endless.moduli)
          scales.push_back(markov::implied_time_scale(modulus));
        q.numbers({"time_scales_gates", "1",
                   "implied time scale of each of eigenvalues, in gates: -1 / ln(eigenvalue); "
                   "null: infinite"},
                  scales);
        q.object(
            {"boundaries",
             "quasi-stationary shares of bodies by the boundary through which they enter a gate"},
            [&](Fields& b) {
              for (std::size_t face = 0; face < a.endless_boundaries.size(); ++face)
                b.number(Field(a.space.section().faces[face].name, "1",
                               "share of bodies that enter a gate through this boundary")
                             .varying("<boundary>"),
                         a.endless_boundaries[face]);
            });
        std::vector<double> states;
        for (const int s : lattice::shown_order(a.space))
          states.push_back(endless.states[static_cast<std::size_t>(s)]);
        q.numbers({"states", "1",
                   "quasi-stationary share of bodies in each state of the chain, in the order of "
                   "gatewalk show"},
                  states);
      });
  out.optional(!a.endless, [&](Fields& f) {
    f.text({"why_not_quasi_stationary", "why there is no quasi-stationary distribution"},
           a.why_not_endless);
  });
}

void describe_lumping(Fields& out, const lattice::Analysis& a) {
  out.maybe(
      {"lumping",
       "error of a chain with merged states (--lump; default: one for each boundary); null: walks "
       "circle too long"},
      a.lumped, [&](Fields& l, const lattice::LumpedChain& lumped) {
        const char *const one = "one for each boundary", *const parts = "parts of each boundary";
        l.text(
            Label(
                "states",
                "how states are merged: into one for each boundary, or into parts of each boundary")
                .one_of({one, parts}),
            std::ranges::all_of(a.lumping, [](int n) { return n == 1; }) ? one : parts);
        l.counts({"parts", "1",
                  "number of parts into which each coordinate is cut; coordinates without a number "
                  "are not cut"},
                 {a.lumping.begin(), a.lumping.end()});
        l.count({"count", "1", "number of states after merging, the start's own state included"},
                lumped.states);
        l.number({"largest_difference", "1",
                  "largest total variation between rows of states that are merged into one: "
                  "visit-weighted mean over these"},
                 lumped.largest);
        l.object(
            {"error", "total variation between the chain with merged states and the whole chain"},
            [&](Fields& error) {
              error.number({"endings", "1", "total variation of the endings"}, lumped.endings);
              error.number({"final_gates", "1", "total variation of the final gates"},
                           lumped.final_gates);
            });
      });
}

void describe_visits(Fields& out, const lattice::Analysis& a) {
  out.grid({"expected_visits", "1", "mean number of visits of a body to each gate"},
           a.totals.visits);
}

void describe_target(Fields& out, const lattice::Analysis& a) {
  out.text(Label("target", "the ending to which starts, paths and sensitivities refer")
               .one_of(ending_keys()),
           ending_name(a.target).key);
}

void describe_starts(Fields& out, const lattice::Analysis& a) {
  out.list({"starts",
            "chance of the target by the range of entries into the first gate: all ranges, or the "
            "300 with most runs"},
           std::span(a.starts).first(static_cast<std::size_t>(a.told_starts())),
           [&](Fields& start, const lattice::StartChance& s) {
             describe(start, a.space.section(), s.range);
             start.estimate({"probability", "1",
                             "chance of the target; in a mirror-symmetric field its mean with the "
                             "mirror image's; null: no run entered"},
                            s.chance.mean, s.chance.interval);
             start.count({"runs", "1",
                          "gate runs from the state of this range; in a mirror-symmetric field "
                          "with those of the mirror image"},
                         s.runs);
           });
  out.count({"starts_in_all", "1",
             "number of ranges of entries into the first gate, listed in starts or not"},
            a.starts.size());
}

void describe_paths(Fields& out, const AnalysedField& f) {
  const lattice::FieldParams& field = f.shown.field;
  out.list(
      {"paths", "the most frequent sequences of gates that end in the target, most frequent first"},
      f.analysis.paths.paths, [&](Fields& way, const markov::CellPath& path) {
        way.number(
            {"probability", "1",
             "share of all bodies that visit exactly these gates and then end in the target"},
            path.share);
        way.list(
            {"gates", "gates of the path, from the start on"}, path.cells,
            [&](Fields& gate, std::int64_t cell) {
              gate.count({"i_x", "1",
                          "column of the gate: 0 is the start's, columns to its left are negative"},
                         cell % field.columns - field.start_column());
              gate.count({"i_y", "1", "row of the gate: 0 is the near one"}, cell / field.columns);
            });
      });
  out.flag(
      {"paths_complete", "whether all paths asked for were found; false: the search took too long"},
      !f.analysis.paths.gave_up);
}

void describe_types(Fields& out, const AnalysedField& f) {
  const std::vector<std::string>& types = f.shown.types;
  out.maybe(
      {"types", "visits and trapping by type of gate; null: all gates are of one type"},
      if_any(types), [&](Fields& o, const auto&) {
        for (std::size_t t = 0; t < types.size(); ++t)
          o.object(Label(types[t], "gates of this type").varying("<type>"), [&](Fields& type) {
            const auto& [visits, trapped] = f.analysis.types[t];
            type.number({"visits", "1", "mean number of visits of a body to gates of this type"},
                        visits);
            type.number(
                {"trapped", "1", "share of all bodies that are trapped in gates of this type"},
                trapped);
            type.number({"trapped_per_visit", "1",
                         "share of visits to gates of this type that end trapped"},
                        trapped / visits);
          });
      });
}

/// A list of elasticities by type of gate; null if all gates are alike.
template <class Items, class Describe>
void by_type(Fields& out, const Label& label, const AnalysedField& f, const Items& items,
             Describe describe) {
  const std::vector<std::string>& types = f.shown.types;
  out.maybe(label, types.empty() ? nullptr : if_any(items), [&](Fields& o, const auto&) {
    for (std::size_t t = 0; t < items.size(); ++t)
      describe(o, std::string_view(types[t]), items[t]);
  });
}

void describe_elasticity(Fields& out, const lattice::Mean95& m) {
  out.estimate(
      {"elasticity", "1",
       "per cent by which the chance of the target changes for one per cent more of the number"},
      m.mean, m.interval);
}

void describe_effect(Fields& out, const AnalysedField& f, const lattice::ParameterEffect& e) {
  const double unit = f.parameters.chance / e.value;
  const auto& [low, high] = e.elasticity.interval;
  out.text({"key", "key of the number in the scene"}, e.key);
  out.number({"value", "its own", "value of the number; null: types of gates differ in it"},
             e.value);
  describe_elasticity(out, e.elasticity);
  out.number({"with_more", "1",
              "elasticity by an increase of the number alone; null: the scene does not permit the "
              "increase"},
             e.more);
  out.number({"with_less", "1",
              "elasticity by a decrease of the number alone; null: the scene does not permit the "
              "decrease"},
             e.less);
  out.flag({"bends", "whether with_more and with_less differ by more than chance"}, e.bends);
  out.number({"left_out", "1",
              "share of entries left out, as bodies cannot enter the changed gate there or runs "
              "were not finite"},
             e.left_out);
  by_type(out,
          {"of_type",
           "elasticity if the number changes in gates of one type only; null: all gates are of one "
           "type"},
          f, e.of_type, [&](Fields& o, std::string_view type, const lattice::Mean95& m) {
            o.object(Label(type, "gates of this type").varying("<type>"),
                     [&](Fields& one) { describe_elasticity(one, m); });
          });
  out.estimate({"derivative", "1/(unit of the number)",
                "change of the target's chance per unit of the number; null: types of gates differ "
                "in the number"},
               e.elasticity.mean * unit, Interval{low * unit, high * unit});
}

void describe_sensitivities(Fields& out, const AnalysedField& f) {
  const lattice::Analysis& a = f.analysis;
  out.text(Label("of", "the ending whose chance is meant").one_of(ending_keys()),
           ending_name(a.target).key);
  out.grid(
      {"passed_gates", "1", "mean number of visits to each gate, of bodies that end in the target"},
      a.passed);
  const Field trapping("less_trapping", "1",
                       "per cent that the target's chance grows if 1 % fewer are trapped in the "
                       "gate; null: target trapped, or chance 0");
  if (a.trapping.size() > 0)
    out.grid(trapping, a.trapping);
  else
    out.no_grid(trapping);
  out.numbers({"less_trapping_by_state", "1",
               "less_trapping by state, summed over gates, states in the order of gatewalk show; "
               "null: as less_trapping"},
              a.state_trapping.empty() ? std::nullopt : std::optional(a.state_trapping));
  by_type(out,
          {"less_trapping_by_type",
           "less_trapping summed over the gates of each type; null: all gates are of one type, or "
           "as less_trapping"},
          f, a.type_trapping, [](Fields& o, std::string_view type, double x) {
            o.number(Field(type, "1", "gates of this type").varying("<type>"), x);
          });
  out.list({"parameters",
            "numbers of the scene and their elasticities, the largest (of either sign) first"},
           sorted_effects(f),
           [&](Fields& o, const lattice::ParameterEffect& e) { describe_effect(o, f, e); });
  out.number({"probability", "1",
              "chance of the target by the chain from which the elasticities are computed"},
             f.parameters.chance);
  out.count({"gate_runs", "1",
             "gate runs made for the elasticities: with changed numbers, and added_gate_runs"},
            f.parameters.health.runs);
  out.count(
      {"chain_gate_runs", "1", "gate runs of the chain from which the elasticities are computed"},
      f.parameters.pool_runs);
  out.number({"seconds", "s", "time that the elasticities took to compute"}, f.parameters.seconds);
  out.count({"added_gate_runs", "1",
             "gate runs that were added to the chain to make the elasticities precise enough"},
            f.parameters.added_runs);
  describe_status(out, f.parameters.health);
}

}  // namespace

void describe(Fields& out, const AnalysedField& f) {
  const auto& [shown, start, answer, a, parameters, step, direct, shares, passage, made_by] = f;
  describe_endings(out, answer.endings);
  describe_means(out, f);
  out.optional(shown.mass.has_value(), [&](Fields& o) {
    o.number({"cost_of_transport_J_per_kg_m", "J/(kg m)",
              "mean work of both forces / (body mass * mean distance forward); null: no distance "
              "forward"},
             spent(a, {}).cost_of_transport(*shown.mass));
  });
  describe_visits(out, a);
  describe(out, answer.rest);
  out.count({"drawn_walks", "1",
             "chain walks drawn to estimate times and costs (large fields without a limit of "
             "gates); 0: exact"},
            a.totals.drawn_walks);
  describe_by_ending(out, f);
  describe_endless(out, a);
  describe_answer_from(out, answer.from_trials);
  describe_lumping(out, a);
  describe_target(out, a);
  out.number(
      {"target_probability", "1",
       "chance of the target by the chain; the one in endings may come from trials (answer_from)"},
      a.target_chance);
  describe_starts(out, a);
  describe_paths(out, f);
  out.object(
      {"sensitivities",
       "how the chance of the target responds to trapping in gates and to numbers of the scene"},
      [&](Fields& o) { describe_sensitivities(o, f); });
  describe_types(out, f);
  out.if_any({"direct", "full simulation of the same field, for comparison"}, direct,
             [&](Fields& d, const auto& value) {
               d.count({"trials", "1", "number of simulated trials"}, value.tally.trials);
               describe_endings(d, {"endings", "number of simulated trials by ending"},
                                value.tally.endings);
               describe_costs(d, value.costs, shown);
             });
  out.count({"states", "1", "number of states of the chain"}, answer.states);
  out.count({"gate_runs", "1",
             "gate runs that this command made: for the chain, and for the elasticities"},
            f.gate_runs());
  out.flag({"accuracy_reached", "whether the prediction reached the accuracy that was asked for"},
           answer.reached);
  out.number({"seconds", "s", "time of the whole computation"}, f.seconds());
  describe_status(out, answer.health);
  describe_method(out, answer.method);
  out.maybe({"variance_shares",
             "with --over: share of the variance of the target's chance that each number causes; "
             "null: without --over"},
            shares, [](Fields& o, const RangedShares& s) { describe(o, s); });
  out.if_any({"first_passage",
              "with --first-passage: chance and time to reach a target, from the start and from "
              "each state of each gate"},
             passage, [&](Fields& p, const auto& value) { describe(p, value); });
  describe_made_by(out, made_by);
}

void describe_for_page(Fields& out, const AnalysedField& f) {
  describe_means(out, f);
  describe_visits(out, f.analysis);
  describe_by_ending(out, f);
  describe_target(out, f.analysis);
  describe_paths(out, f);
  describe_types(out, f);
  out.optional(!f.parameters.effects.empty(), [&](Fields& o) {
    o.list({"parameters",
            "numbers of the scene and their elasticities, the largest (of either sign) first"},
           sorted_effects(f), [](Fields& number, const lattice::ParameterEffect& e) {
             number.text({"key", "key of the number in the scene"}, e.key);
             describe_elasticity(number, e.elasticity);
           });
  });
}

const char* target_name(const AnalysedField& f) { return ending_name(f.analysis.target).name; }

DurationCurve duration_curve(const lattice::Analysis& a, markov::Ending ending) {
  constexpr std::size_t kPoints = 200;
  DurationCurve curve;
  const std::vector<double> walks = durations_of(a, ending);
  const std::size_t step = std::max<std::size_t>(1, walks.size() / kPoints);
  const auto add = [&](std::size_t i) {
    curve.seconds.push_back(walks[i]);
    curve.share.push_back(static_cast<double>(i + 1) / static_cast<double>(walks.size()));
  };
  for (std::size_t i = 0; i + 1 < walks.size(); i += step) add(i);
  if (!walks.empty()) add(walks.size() - 1);
  return curve;
}

double most_of_starts(const lattice::Analysis& a) {
  double most = 0.0;
  for (const lattice::StartChance& s : a.starts) most = std::max(most, s.chance.mean);
  return most;
}

std::vector<lattice::ParameterEffect> sorted_effects(const AnalysedField& f) {
  std::vector<lattice::ParameterEffect> effects = f.parameters.effects;
  std::ranges::stable_sort(effects, std::ranges::greater{},
                           [](const auto& e) { return std::abs(e.elasticity.mean); });
  return effects;
}

}  // namespace gatewalk::cli
