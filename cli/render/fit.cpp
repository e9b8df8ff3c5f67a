// SPDX-License-Identifier: MIT
#include "cli/render/fit.h"

#include <algorithm>
#include <cmath>

#include "cli/render/choice.h"
#include "cli/render/csv.h"
#include "cli/render/final_gates.h"
#include "cli/render/health.h"
#include "cli/render/json.h"
#include "cli/render/quantity.h"
#include "cli/render/text.h"
#include "lattice/text/digits.h"
#include "markov/formats/netcdf.h"

namespace gatewalk::cli {
namespace {

constexpr double kTogether = 0.9;  // a correlation, from which on two numbers are not told apart
constexpr double kUnexplained = 0.01;  // p, below which no number of the ranges explains the counts
constexpr std::size_t kMostShown = 3;  // groups of outcomes that differ most

/// When bodies of an outcome left: " within 2 s", " from 2 s to 3 s", " after 3 s".
std::string time_of(const lattice::FittedOutcomes& of, std::size_t outcome) {
  if (of.times.empty()) return "";
  if (of.is_of_passages()) {
    if (outcome / of.parts() % (of.faces.size() + 1) == of.faces.size()) return "";
  } else if (of.endings) {
    const auto ending =
        static_cast<markov::Ending>(outcome / of.parts() / std::max<std::size_t>(1, of.gates));
    if (ending == markov::Ending::trapped || ending == markov::Ending::cut_off) return "";
  }
  const std::size_t part = outcome % of.parts();
  const auto time = [](double t) { return quantity(t, "s", 3); };
  if (part == 0) return " within " + time(of.times.front());
  if (part == of.times.size()) return " after " + time(of.times.back());
  return " from " + time(of.times[part - 1]) + " to " + time(of.times[part]);
}

/// An outcome in words: "trapped in (0, 3)", "crossed", "(0, 3)"; of passages "to RT", "trapped".
std::string words_of(const FittedScene& f, std::size_t outcome) {
  const lattice::FittedOutcomes& of = f.fit.outcomes;
  const std::string time = time_of(of, outcome);
  outcome /= of.parts();
  if (of.is_of_passages()) {
    const std::size_t to = outcome % (of.faces.size() + 1);
    return to < of.faces.size() ? "to " + of.faces[to] + time : "trapped";
  }
  std::string words;
  if (of.endings) {
    const auto ending = static_cast<markov::Ending>(of.gates == 0 ? outcome : outcome / of.gates);
    const auto at = std::find_if(kAllEndingNames.begin(), kAllEndingNames.end(),
                                 [&](const EndingName& e) { return e.ending == ending; });
    words = at == kAllEndingNames.end() ? "other" : at->name;
  }
  if (of.gates == 0) return words + time;
  const auto columns = static_cast<std::size_t>(f.field.columns), gate = outcome % of.gates;
  const int x = static_cast<int>(gate % columns) - f.field.start_column(),
            y = static_cast<int>(gate / columns);
  return words + (words.empty() ? "(" : " (") + std::to_string(x) + ", " + std::to_string(y) + ")" +
         time;
}
std::string words_of(const FittedScene& f, const lattice::OutcomeGroup& group) {
  const std::size_t front = group.outcomes.front(), back = group.outcomes.back();
  const std::string first = words_of(f, front), last = words_of(f, back);
  const lattice::FittedOutcomes& of = f.fit.outcomes;
  if (!of.is_of_passages()) return first == last ? first : first + " to " + last;
  const std::string &begin = of.begins[front / of.together()],
                    &other = of.begins[back / of.together()];
  if (front == back) return begin + ": " + first;
  return begin + ": " + first + " ... " + (begin == other ? "" : other + ": ") + last;
}

/// How far a count lies from what is expected, by chance alone.
double surprise(const lattice::OutcomeGroup& g) {
  return (static_cast<double>(g.observed) - g.expected) / std::sqrt(std::max(g.expected, 1e-12));
}

/// Digits that tell a range's thousandth.
std::string in_range(const FittedScene& f, std::size_t k, double at) {
  const lattice::NumberRange& r = f.ranges[k];
  const double step = 1e-3 * (r.high - r.low);
  const int decimals = static_cast<int>(std::ceil(-std::log10(step)));
  return decimals > 9 || decimals < -3 ? digits(f.ranges[k].at(at))
                                       : fixed(f.ranges[k].at(at), std::max(0, decimals));
}

}  // namespace

std::string counted(const FittedScene& f) {
  return f.fit.outcomes.is_of_passages() ? "passages" : "trials";
}

Json to_json(const FittedScene& f) {
  const lattice::Fit& fit = f.fit;
  Json json;
  json["numbers"] = Json::array();
  for (std::size_t k = 0; k < f.ranges.size(); ++k) {
    const lattice::FittedNumber& n = fit.numbers[k];
    const lattice::NumberRange& r = f.ranges[k];
    const auto at = [&](double x) { return f.ranges[k].at(x); };
    json["numbers"].push_back({{"key", r.key},
                               {"low", r.low},
                               {"high", r.high},
                               {"best", at(n.best)},
                               {"median", at(n.median)},
                               {"mean", at(n.mean)},
                               {"sd", n.sd * (r.high - r.low)},
                               {"interval_95", {at(n.interval[0]), at(n.interval[1])}},
                               {"told", n.told},
                               {"goes_on_below", n.goes_on[0]},
                               {"goes_on_above", n.goes_on[1]},
                               {"variance_by_trials", n.by_runs}});
  }
  json["correlation"] = Json::array();
  for (const auto row : fit.correlation.rowwise())
    json["correlation"].push_back(std::vector<double>(row.begin(), row.end()));
  json["p"] = fit.p;
  json["observed"] = fit.observed;
  json["of"] = counted(f);
  json["outcomes"] = Json::array();
  for (const lattice::OutcomeGroup& g : fit.groups)
    json["outcomes"].push_back({{"outcomes", words_of(f, g)},
                                {"observed", g.observed},
                                {"expected", seven_digits(g.expected, 1.0)},
                                {"interval_95", g.interval}});
  json["draws"] = fit.draws.rows();
  json["settled"] = fit.settled();
  json["misfit_nats"] = fit.misfit;
  json["mixing"] = fit.mixing;
  json["near_bounds"] = fit.near_bounds;
  json["outside"] = fit.outside;
  json["never"] = fit.never;
  json["rounds"] = fit.rounds;
  json["degree"] = fit.degree;
  json["parts"] = fit.parts;
  json["points"] = fit.points;
  json["volume"] = fit.volume;
  json["trials"] = fit.trials;
  if (f.method) json["method"] = to_json(*f.method);
  json["seconds"] = fit.seconds;
  json["status"] = to_json(fit.health);
  return json;
}

std::string table_of(const FittedScene& f) {
  const lattice::Fit& fit = f.fit;
  std::string table = padded("", 34) + padded("range", 18) + padded("best", 12) +
                      padded("median", 12) + padded("95 % interval", 26) + "\n";
  for (std::size_t k = 0; k < f.ranges.size(); ++k) {
    const lattice::NumberRange& r = f.ranges[k];
    const lattice::FittedNumber& n = fit.numbers[k];
    table +=
        padded(r.key, -34) +
        padded(lattice::shortest(r.low) + " to " + lattice::shortest(r.high), 18) +
        padded(in_range(f, k, n.best), 12) + padded(in_range(f, k, n.median), 12) +
        padded("[" + in_range(f, k, n.interval[0]) + ", " + in_range(f, k, n.interval[1]) + "]",
               26) +
        "\n";
  }
  for (std::size_t k = 0; k < f.ranges.size(); ++k) {
    const lattice::FittedNumber& n = fit.numbers[k];
    const std::string& key = f.ranges[k].key;
    if (!n.told)
      table += "these data cannot tell " + key + ": they leave it anywhere in its range\n";
    for (std::size_t other = 0; other < k; ++other)
      if (const double c =
              fit.correlation(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(other));
          std::abs(c) > kTogether)
        table += "these data tell " + f.ranges[other].key + " and " + key +
                 " only together: correlation " + fixed(c, 2) + "\n";
  }
  table += std::to_string(fit.observed) + " observed " + counted(f) +
           "; of experiments like this one " + percent(fit.p, 1.0) +
           " are further from what is expected (" + p_words(fit.p) + ")\n";
  if (fit.p < kUnexplained) {
    std::vector<lattice::OutcomeGroup> sorted = fit.groups;
    std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
      return std::abs(surprise(a)) > std::abs(surprise(b));
    });
    table += "no numbers in these ranges explain the counts" +
             std::string(fit.outcomes.is_of_passages() ? " (of cells of other lengths?)" : "") +
             "; furthest off, expected and observed:\n";
    for (std::size_t i = 0; i < std::min(kMostShown, sorted.size()); ++i)
      table += "  " + words_of(f, sorted[i]) + ": " + fixed(sorted[i].expected, 1) + ", " +
               std::to_string(sorted[i].observed) + "\n";
  }
  return table + method_line(f.method) + std::to_string(fit.trials) + " " + counted(f) +
         ", in the last of " + std::to_string(fit.rounds + 1) + " rounds at " +
         std::to_string(fit.points) + " points of " +
         percent(fit.volume, 1.0, fit.volume < 0.01 ? 3 : 1) +
         " of the ranges; chances between them by polynomials of degree " +
         std::to_string(fit.degree) +
         (fit.parts > 1 ? " in " + std::to_string(fit.parts) + " parts of these" : "") + ", " +
         fixed(fit.seconds, 1) + " s\n";
}

bool is_clean(const FittedScene& f) {
  return f.fit.health.clean() && f.fit.settled() && f.fit.p >= kUnexplained;
}

std::vector<std::string> warnings_of(const FittedScene& f) {
  std::vector<std::string> all;
  const auto warn = [&](const std::string& text) { all.push_back(text); };
  const lattice::Fit& fit = f.fit;
  const bool goes_on = std::any_of(fit.numbers.begin(), fit.numbers.end(),
                                   [](const auto& n) { return n.goes_on[0] || n.goes_on[1]; });
  for (std::size_t k = 0; k < f.ranges.size(); ++k) {
    const lattice::FittedNumber& n = fit.numbers[k];
    for (const std::size_t end : {0U, 1U})
      if (n.goes_on[end])
        warn(f.ranges[k].key + " is likely to lie beyond " +
             lattice::shortest(end == 0 ? f.ranges[k].low : f.ranges[k].high) +
             ", where its range ends: a wider one tells, if that is permitted");
  }
  if (fit.never > 0)
    warn(std::to_string(fit.never) + " of " + std::to_string(fit.observed) + " observed " +
         counted(f) +
         " ended as none of the model did where their numbers are likeliest: they "
         "are counted with their neighbours");
  for (std::size_t k = 0; k < f.ranges.size(); ++k)
    if (const lattice::FittedNumber& n = fit.numbers[k];
        !n.goes_on[0] && !n.goes_on[1] && (n.best < n.interval[0] || n.best > n.interval[1]))
      warn("the counts are likeliest outside the interval of " + f.ranges[k].key +
           ": many other values fit nearly as well, and the ranges decide how many");
  if (fit.settled()) return all;
  double by_trials = 0.0;
  for (const lattice::FittedNumber& n : fit.numbers) by_trials = std::max(by_trials, n.by_runs);
  warn("the posterior is rough: chances between the points change the log likelihood by " +
       fixed(fit.misfit, 2) + ", trials make " + percent(by_trials, 1.0, 0) +
       " of a variance (which is counted), R of the walks is " + fixed(fit.mixing, 2) + ", " +
       percent(fit.near_bounds, 1.0) + " of the draws lie at the edge of the points, " +
       percent(fit.outside, 1.0) + " of the posterior may lie where there are none; more --trials" +
       (goes_on ? " help" : ", or narrower ranges, help"));
  return all;
}

std::string draws_csv(const FittedScene& f) {
  std::string text;
  for (const lattice::NumberRange& r : f.ranges) text += csv_text(r.key) + ",";
  text += "log_likelihood\n";
  for (Eigen::Index i = 0; i < f.fit.draws.rows(); ++i) {
    for (std::size_t k = 0; k < f.ranges.size(); ++k)
      text += digits(f.ranges[k].at(f.fit.draws(i, static_cast<Eigen::Index>(k)))) + ",";
    text += digits(f.fit.log_likelihoods[i]) + "\n";
  }
  return text;
}

std::string inference_data(const FittedScene& f, const Json& made_by) {
  using namespace markov::netcdf;
  const lattice::Fit& fit = f.fit;
  const auto chains = static_cast<std::size_t>(fit.walks.back() + 1),
             draws = static_cast<std::size_t>(fit.draws.rows()) / chains,
             outcomes = fit.groups.size();
  Image nc;
  nc.create();
  for (const auto& [key, value] : made_by.items())
    put_text(nc, NC_GLOBAL, key, value.is_string() ? value.get<std::string>() : text_of(value, -1));
  const auto numbers_to = [](std::size_t count) {
    std::vector<std::int32_t> all(count);
    for (std::size_t i = 0; i < count; ++i) all[i] = static_cast<std::int32_t>(i);
    return all;
  };
  struct Group {
    int id = -1, chain = -1, draw = -1, outcome = -1;
  };
  const auto group = [&](const char* name, bool of_draws, bool of_outcomes) {
    Group g;
    check(nc_def_grp(nc, name, &g.id), name);
    put_text(g.id, NC_GLOBAL, "inference_library", "gatewalk");
    if (of_draws) {
      g.chain = define_dimension(g.id, "chain", chains);
      g.draw = define_dimension(g.id, "draw", draws);
      put_variable(g.id, "chain", g.chain, numbers_to(chains), "", "walk with its own chances");
      put_variable(g.id, "draw", g.draw, numbers_to(draws), "", "draw of a walk");
    }
    if (of_outcomes) {
      g.outcome = define_dimension(g.id, "outcome", outcomes);
      int names = -1;
      check(nc_def_var(g.id, "outcome", NC_STRING, 1, &g.outcome, &names), "outcome");
      for (std::size_t i = 0; i < outcomes; ++i) {
        const std::string words = words_of(f, fit.groups[i]);
        const char* const text = words.c_str();
        check(nc_put_var1_string(g.id, names, &i, const_cast<const char**>(&text)), "outcome");
      }
    }
    return g;
  };
  // As many dimensions as there are; in the order of `values`, the last one fastest.
  const auto put = [&](int id, const std::string& name, const std::vector<int>& dimensions,
                       const std::vector<double>& values, const std::string& meaning) {
    int variable = -1;
    check(nc_def_var(id, name.c_str(), NC_DOUBLE, static_cast<int>(dimensions.size()),
                     dimensions.data(), &variable),
          name);
    check(nc_def_var_fletcher32(id, variable, NC_FLETCHER32), name);
    put_text(id, variable, "long_name", meaning);
    check(nc_put_var_double(id, variable, values.data()), name);
  };
  const Group posterior = group("posterior", true, false);
  for (std::size_t k = 0; k < f.ranges.size(); ++k) {
    std::vector<double> values;
    for (const double x : fit.draws.col(static_cast<Eigen::Index>(k)))
      values.push_back(f.ranges[k].at(x));
    put(posterior.id, f.ranges[k].key, {posterior.chain, posterior.draw}, values,
        "uniform from " + lattice::shortest(f.ranges[k].low) + " to " +
            lattice::shortest(f.ranges[k].high) + " before the data");
  }
  const Group stats = group("sample_stats", true, false);
  put(stats.id, "lp", {stats.chain, stats.draw},
      {fit.log_likelihoods.begin(), fit.log_likelihoods.end()},
      "log likelihood of the observed counts, up to a constant");
  const Group predictive = group("posterior_predictive", true, true);
  std::vector<double> counts;
  for (const auto row : fit.predicted.rowwise())
    counts.insert(counts.end(), row.begin(), row.end());
  put(predictive.id, "count", {predictive.chain, predictive.draw, predictive.outcome}, counts,
      counted(f) + " of an experiment like it that end so");
  const Group observed = group("observed_data", false, true);
  std::vector<double> seen;
  for (const lattice::OutcomeGroup& g : fit.groups) seen.push_back(static_cast<double>(g.observed));
  put(observed.id, "count", {observed.outcome}, seen, "observed " + counted(f) + " that ended so");
  const std::vector<char> bytes = nc.close_image();
  return {bytes.begin(), bytes.end()};
}

}  // namespace gatewalk::cli
