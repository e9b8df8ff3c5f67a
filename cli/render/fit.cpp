// SPDX-License-Identifier: MIT
#include "cli/render/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "cli/fields/csv.h"
#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/choice.h"
#include "cli/render/final_gates.h"
#include "cli/render/health.h"
#include "cli/render/panel.h"
#include "cli/render/quantity.h"
#include "lattice/text/digits.h"
#include "markov/formats/netcdf.h"

namespace gatewalk::cli {
namespace {

constexpr double kTogether = 0.9;  // correlation above which two numbers cannot be distinguished
constexpr double kUnexplained = 0.01;  // smaller p: no numbers explain the counts
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
  return fmt::format(" from {} to {}", time(of.times[part - 1]), time(of.times[part]));
}

/// An outcome in words: "trapped in (0, 3)", "crossed", "(0, 3)"; for passages "to RT", "trapped".
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
  return fmt::format("{}{}({}, {}){}", words, words.empty() ? "" : " ", x, y, time);
}
std::string words_of(const FittedScene& f, const lattice::OutcomeGroup& group) {
  const std::size_t front = group.outcomes.front(), back = group.outcomes.back();
  const std::string first = words_of(f, front), last = words_of(f, back);
  const lattice::FittedOutcomes& of = f.fit.outcomes;
  if (!of.is_of_passages()) return first == last ? first : first + " to " + last;
  const std::string &begin = of.begins[front / of.together()],
                    &other = of.begins[back / of.together()];
  if (front == back) return fmt::format("{}: {}", begin, first);
  return fmt::format("{}: {} ... {}{}", begin, first, begin == other ? "" : other + ": ", last);
}

/// The distance of a count from its expected value, in units of chance.
double surprise(const lattice::OutcomeGroup& g) {
  return (static_cast<double>(g.observed) - g.expected) / std::sqrt(std::max(g.expected, 1e-12));
}

/// The number, with digits down to a thousandth of its range.
std::string in_range(const FittedScene& f, std::size_t k, double at) {
  const lattice::NumberRange& r = f.ranges[k];
  const double step = 1e-3 * (r.high - r.low);
  const int decimals = static_cast<int>(std::ceil(-std::log10(step)));
  return decimals > 9 || decimals < -3 ? digits(f.ranges[k].at(at))
                                       : fixed(f.ranges[k].at(at), std::max(0, decimals));
}

void describe_number(Fields& out, const lattice::NumberRange& r, const lattice::FittedNumber& n) {
  out.text({"key", "key of the number in the scene, or of the cell program"}, r.key);
  out.number({"low", "its own",
              "lower end of the range, in which all values are equally likely before the data"},
             r.low);
  out.number({"high", "its own", "upper end of the range"}, r.high);
  out.number({"best", "its own",
              "value in the draw from the posterior that makes the observed counts likeliest"},
             r.at(n.best));
  out.estimate(Field("median", "its own", "median of the posterior")
                   .bounded_by("interval that holds 95 % of the posterior"),
               r.at(n.median), Interval{r.at(n.interval[0]), r.at(n.interval[1])});
  out.number({"mean", "its own", "mean of the posterior"}, r.at(n.mean));
  out.number({"sd", "its own", "standard deviation of the posterior"}, n.sd * (r.high - r.low));
  out.flag({"told",
            "whether the data tell more than the range: Kolmogorov distance of posterior and range "
            "over 0.15 plus noise"},
           n.told);
  out.flag({"goes_on_below",
            "whether told is true and over 5 % of the draws lie in the lowest 2 % of the range"},
           n.goes_on[0]);
  out.flag({"goes_on_above",
            "whether told is true and over 5 % of the draws lie in the highest 2 % of the range"},
           n.goes_on[1]);
  out.number({"variance_by_trials", "1",
              "share of the posterior's variance that more simulated trials would remove"},
             n.by_runs);
}

}  // namespace

std::string counted(const FittedScene& f) {
  return f.fit.outcomes.is_of_passages() ? "passages" : "trials";
}

void describe(Fields& out, const FittedScene& f) {
  const lattice::Fit& fit = f.fit;
  out.list_of(
      {"numbers", "the numbers of --free, in the units of their keys"}, f.ranges.size(),
      [&](Fields& number, std::size_t k) { describe_number(number, f.ranges[k], fit.numbers[k]); });
  out.grid({"correlation", "1",
            "correlation of each two numbers in the posterior, in the order of numbers"},
           markov::CellProbabilities(fit.correlation.array()));
  out.number({"p", "1",
              "posterior predictive p-value: share of drawn experiments with at least the observed "
              "chi-squared distance, in which never is a group"},
             fit.p);
  out.count({"observed", "1", "number of observed trials, or passages"}, fit.observed);
  out.text(Label("of",
                 "what was observed: trials through the field, or passages through a cell, given "
                 "where they begin")
               .one_of({"trials", "passages"}),
           counted(f));
  out.list({"outcomes",
            "groups of outcomes counted together: final gates and endings, or of passages faces "
            "and times"},
           fit.groups, [&](Fields& group, const lattice::OutcomeGroup& g) {
             group.text({"outcomes", "first and last outcome of the group"}, words_of(f, g));
             group.count({"observed", "1",
                          "number of observed trials, or passages, with an outcome of the group"},
                         g.observed);
             group.estimate(Field("expected", "1", "number expected, mean over the posterior")
                                .bounded_by("where the numbers of 95 % of such experiments lie"),
                            seven_digits(g.expected, 1.0), g.interval);
           });
  out.count({"draws", "1", "number of draws from the posterior"}, fit.draws.rows());
  out.flag({"settled",
            "whether misfit_nats <= 0.5, mixing <= 1.05, near_bounds and outside <= 0.01, "
            "variance_by_trials <= 0.2"},
           fit.settled());
  out.number({"misfit_nats", "nat",
              "possible error of the log likelihood, as chances between the points are no exact "
              "polynomials"},
             fit.misfit);
  out.number({"mixing", "1",
              "R of Gelman and Rubin from the halves of the walks, the largest of all numbers"},
             fit.mixing);
  out.number({"near_bounds", "1",
              "share of the draws at the edge of the region in which the last round's points lie"},
             fit.near_bounds);
  out.number(
      {"outside", "1",
       "share of the posterior in regions that earlier rounds cut off, when it was last checked"},
      fit.outside);
  out.count(
      {"never", "1",
       "number of observed trials with an outcome that no simulated trial of the last round had"},
      fit.never);
  out.count({"rounds", "1", "number of rounds before the last"}, fit.rounds);
  out.count({"degree", "1", "highest degree of the polynomials for chances between points"},
            fit.degree);
  out.count({"parts", "1", "number of parts of the ranges, each with polynomials of its own"},
            fit.parts);
  out.count({"points", "1", "number of points at which the chances of outcomes were simulated"},
            fit.points);
  out.number({"volume", "1",
              "approximate share of the ranges' volume in which the last round's points lie"},
             fit.volume);
  out.count({"trials", "1", "number of simulated trials, or passages, of all rounds"}, fit.trials);
  describe_method(out, f.method);
  out.number({"seconds", "s", "time of the whole computation"}, fit.seconds);
  describe_status(out, fit.health);
  describe_made_by(out, f.made_by);
}

namespace {

/// A sentence on the numbers that the data do not restrict within their ranges.
std::string untold_text(const FittedScene& f) {
  std::vector<std::string> keys;
  for (std::size_t k = 0; k < f.ranges.size(); ++k)
    if (!f.fit.numbers[k].told) keys.push_back(f.ranges[k].key);
  if (keys.empty()) return "";
  return wrapped(fmt::format("Beware: these data cannot tell {}: any value of the range fits.",
                             fmt::join(keys, " or ")));
}

/// Sentences on pairs of numbers of which only a combination is known, at most `most` pairs.
std::string together_text(const FittedScene& f, std::size_t most) {
  std::string text;
  for (std::size_t k = 0; k < f.ranges.size(); ++k)
    for (std::size_t other = 0; other < k; ++other)
      if (const double c =
              f.fit.correlation(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(other));
          std::abs(c) > kTogether && most > 0) {
        --most;
        text +=
            wrapped(fmt::format("Beware: these data tell {} and {} only together (correlation {}).",
                                f.ranges[other].key, f.ranges[k].key, fixed(c, 2)));
      }
  return text;
}

/// Whether the numbers explain the counts, and where they do not.
std::string explained_text(const FittedScene& f) {
  const lattice::Fit& fit = f.fit;
  if (fit.p >= kUnexplained)
    return wrapped(fmt::format(
        "The fitted scene explains the counts: {} of the experiments that it predicts lie further "
        "from the expectation ({}).",
        percent(fit.p, 1.0), p_words(fit.p)));
  std::vector<lattice::OutcomeGroup> sorted = fit.groups;
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
    return std::abs(surprise(a)) > std::abs(surprise(b));
  });
  std::string text = fmt::format(
      "Beware: no numbers in these ranges explain the counts ({}){}. Largest differences:\n",
      p_words(fit.p), fit.outcomes.is_of_passages() ? "; are the cells of the same size?" : "");
  if (fit.never > 0) text += fmt::format("  as no simulated one ended: {} observed\n", fit.never);
  for (std::size_t i = 0; i < std::min(kMostShown, sorted.size()); ++i)
    text += fmt::format("  {}: {} expected, {} observed\n", words_of(f, sorted[i]),
                        fixed(sorted[i].expected, 1), sorted[i].observed);
  return text;
}

}  // namespace

/// The numbers whose posterior reaches an end of its range.
std::string at_ends_text(const FittedScene& f) {
  std::string keys;
  for (std::size_t k = 0; k < f.ranges.size(); ++k)
    if (const lattice::FittedNumber& n = f.fit.numbers[k]; n.goes_on[0] || n.goes_on[1])
      keys += (keys.empty() ? "" : ", ") + f.ranges[k].key;
  return keys.empty() ? ""
                      : wrapped("Beware: the likeliest values lie at an end of the range of " +
                                keys + "; widen the range.");
}

std::string answer_text(const FittedScene& f) {
  const lattice::Fit& fit = f.fit;
  TextTable numbers(
      {{"", -34}, {"range", 18}, {"best", 11}, {"median", 11}, {"95 % interval", 25}});
  for (std::size_t k = 0; k < f.ranges.size(); ++k) {
    const auto& [key, low, high] = f.ranges[k];
    const lattice::FittedNumber& n = fit.numbers[k];
    const auto at = [&](double x) { return in_range(f, k, x); };
    numbers.row({key, fmt::format("{} to {}", lattice::shortest(low), lattice::shortest(high)),
                 at(n.best), at(n.median),
                 fmt::format("[{}, {}]", at(n.interval[0]), at(n.interval[1]))});
  }
  constexpr std::size_t kMostPairs = 1;
  return numbers.text() + explained_text(f) +
         fmt::format("From {} observed {} and {} simulated {}.\n", fit.observed, counted(f),
                     fit.trials, counted(f)) +
         at_ends_text(f) + untold_text(f) + together_text(f, kMostPairs);
}

std::string details_text(const FittedScene& f) {
  const lattice::Fit& fit = f.fit;
  double by_trials = 0.0;
  for (const lattice::FittedNumber& n : fit.numbers) by_trials = std::max(by_trials, n.by_runs);
  std::string text = "\n" + together_text(f, f.ranges.size() * f.ranges.size());
  text += method_line(f.method);
  text += wrapped(fmt::format(
      "The search took {} rounds. The last round has {} points in {} of the ranges' volume. "
      "Polynomials of degree {}{} give the chances between the points.",
      fit.rounds + 1, fit.points, percent(fit.volume, 1.0, fit.volume < 0.01 ? 3 : 1), fit.degree,
      fit.parts > 1 ? fmt::format(", in {} parts of the ranges,", fit.parts) : ""));
  text += fmt::format(
      "Checks of the posterior, with the largest value that passes:\n"
      "  error of the log likelihood between the points   {:>8}   0.5\n"
      "  share of a variance from the simulated trials    {:>8}   20 %\n"
      "  R of the walks (Gelman and Rubin)                {:>8}   1.05\n"
      "  draws at the edge of the points                  {:>8}   1 %\n"
      "  posterior that may lie outside the points        {:>8}   1 %\n",
      fixed(fit.misfit, 2), percent(by_trials, 1.0, 0), fixed(fit.mixing, 2),
      percent(fit.near_bounds, 1.0), percent(fit.outside, 1.0));
  return text + fmt::format("Time: {} s.\n", fixed(fit.seconds, 1));
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
  std::string beyond;
  for (std::size_t k = 0; k < f.ranges.size(); ++k) {
    const lattice::FittedNumber& n = fit.numbers[k];
    for (const std::size_t end : {0U, 1U})
      if (n.goes_on[end]) {
        const std::string where = lattice::shortest(end == 0 ? f.ranges[k].low : f.ranges[k].high);
        beyond += beyond.empty()
                      ? fmt::format("{} is likely to lie beyond {}, where its range ends",
                                    f.ranges[k].key, where)
                      : fmt::format("; {} beyond {}", f.ranges[k].key, where);
      }
  }
  if (!beyond.empty()) warn(beyond + ": use a wider range");
  if (fit.never > 0)
    warn(
        fmt::format("{} of {} observed {} ended as no simulated one did; they are counted with the "
                    "next outcome",
                    fit.never, fit.observed, counted(f)));
  for (std::size_t k = 0; k < f.ranges.size(); ++k)
    if (const lattice::FittedNumber& n = fit.numbers[k];
        !n.goes_on[0] && !n.goes_on[1] && (n.best < n.interval[0] || n.best > n.interval[1]))
      warn(fmt::format(
          "the best value of {} lies outside its interval: many others fit nearly as well",
          f.ranges[k].key));
  if (fit.settled()) return all;
  warn(fmt::format("the posterior is rough (--details lists the checks): more --trials{}",
                   goes_on ? " help" : ", or narrower ranges, help"));
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

std::string inference_data(const FittedScene& f) {
  using namespace markov::netcdf;
  const lattice::Fit& fit = f.fit;
  const auto chains = static_cast<std::size_t>(fit.walks.back() + 1),
             draws = static_cast<std::size_t>(fit.draws.rows()) / chains,
             outcomes = fit.groups.size();
  Image nc;
  nc.create();
  for (const auto& [key, text] : attributes_of(f.made_by)) put_text(nc, NC_GLOBAL, key, text);
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
  // Puts `values` with these dimensions; the last one varies fastest.
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

namespace {

constexpr std::size_t kBins = 24;  // of a panel

/// The range of a number's draws, in its unit, with a margin, without the outermost thousandth at
/// each end.
std::array<double, 2> shown_range(const FittedScene& f, std::size_t k) {
  std::vector<double> sorted(f.fit.draws.col(static_cast<Eigen::Index>(k)).begin(),
                             f.fit.draws.col(static_cast<Eigen::Index>(k)).end());
  std::sort(sorted.begin(), sorted.end());
  const double low = sorted[sorted.size() / 1000],
               high = sorted[sorted.size() - 1 - sorted.size() / 1000];
  const double margin = std::max(0.1 * (high - low), 1e-6);
  return {f.ranges[k].at(std::max(0.0, low - margin)),
          f.ranges[k].at(std::min(1.0, high + margin))};
}

std::size_t bin_of(double x, const std::array<double, 2>& range) {
  const double at = (x - range[0]) / (range[1] - range[0]) * static_cast<double>(kBins);
  return static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(kBins) - 1.0));
}
double middle(std::size_t bin, const std::array<double, 2>& range) {
  return range[0] +
         (static_cast<double>(bin) + 0.5) / static_cast<double>(kBins) * (range[1] - range[0]);
}

/// Tics whose numbers do not touch each other or those of the next panel; none at the very ends.
std::string range_tics(const std::array<double, 2>& range, double side) {
  constexpr double kLetter = 8.0, kApart = 14.0, kAside = 12.0;  // points
  const double span = range[1] - range[0];
  std::string list;
  for (double parts = 4.0; parts > 0.4; parts -= 0.5) {
    const double step = tic_step(span, parts);
    std::size_t longest = 0;
    list.clear();
    for (double at = std::ceil(range[0] / step); at * step <= range[1]; at += 1.0) {
      const double from_end = std::min(at * step - range[0], range[1] - at * step);
      const std::string number = digits(at * step);
      if (from_end / span * side < kAside) continue;
      list += (list.empty() ? "" : ", ") + number;
      longest = std::max(longest, number.size());
    }
    if (step / span * side > kLetter * static_cast<double>(longest) + kApart) break;
  }
  if (list.find(',') == list.npos) {  // one number makes no scale
    const double step = tic_step(span, 8.0);
    const auto near = [&](double share) {
      return digits(std::round((range[0] + share * span) / step) * step);
    };
    list = near(0.25) + ", " + near(0.75);
  }
  return fmt::format("({})", list);
}

/// The name of a number's axis; a letter if there are many numbers, which a list in the upper right
/// corner explains.
std::string axis_name(const FittedScene& f, std::size_t k) {
  return f.ranges.size() > 2 ? std::string(1, static_cast<char>('a' + k)) : f.ranges[k].key;
}

/// The number of draws in each bin of a number, or of two numbers, row by row.
std::vector<double> counts_of(const FittedScene& f, const std::vector<std::size_t>& numbers,
                              const std::vector<std::array<double, 2>>& ranges) {
  std::vector<double> counts(numbers.size() == 1 ? kBins : kBins * kBins, 0.0);
  for (Eigen::Index i = 0; i < f.fit.draws.rows(); ++i) {
    std::size_t bin = 0;
    for (const std::size_t k : numbers)
      bin = bin * kBins +
            bin_of(f.ranges[k].at(f.fit.draws(i, static_cast<Eigen::Index>(k))), ranges[k]);
    counts[bin] += 1.0;
  }
  return counts;
}

}  // namespace

Figure figure_of(const FittedScene& f) {
  const std::size_t numbers = f.ranges.size();
  constexpr double kLeft = 84, kTop = 40, kGap = 10;
  const double side = std::min(300.0, (478.0 - kLeft + kGap) / static_cast<double>(numbers) - kGap);
  std::vector<std::array<double, 2>> ranges;
  for (std::size_t k = 0; k < numbers; ++k) ranges.push_back(shown_range(f, k));
  const auto axis = [&](std::size_t k, bool named) {
    return Axis{named ? verbatim(axis_name(f, k)) : Caption(),
                ranges[k][0],
                ranges[k][1],
                range_tics(ranges[k], side),
                "%g",
                named};
  };
  Panels out;
  out.say(fmt::format("posterior after {} {}; dashed: 95 %", f.fit.observed, counted(f)), 8, 18);
  for (std::size_t k = 0; k < numbers && numbers > 2; ++k)
    out.say(axis_name(f, k) + ": " + f.ranges[k].key, kLeft + side + kGap,
            kTop + 10 + 20 * static_cast<double>(k), kSmallFont);
  for (std::size_t down = 0; down < numbers; ++down)
    for (std::size_t right = 0; right <= down; ++right) {
      const double left = kLeft + static_cast<double>(right) * (side + kGap),
                   top = kTop + static_cast<double>(down) * (side + kGap);
      Rows& rows = out.data(fmt::format("$p{}_{}", down, right));
      Panel& p = out.add({left, left + side, top, top + side});
      p.x = axis(right, down + 1 == numbers);
      if (right == down) {
        const std::vector<double> counts = counts_of(f, {down}, ranges);
        for (std::size_t b = 0; b < kBins; ++b) rows.add(middle(b, ranges[down]), counts[b]);
        p.y = {"", 0, kFree, kNoTics};
        p.border = 1;
        for (const double end : f.fit.numbers[down].interval)
          p.uprights.push_back(
              {f.ranges[down].at(end), {.colour = kInk, .width = 1.2, .dashes = 2}, true});
        p.draw(rows, "1:2", "boxes fs solid", {kFirstColour});
      } else {
        const std::vector<double> counts = counts_of(f, {down, right}, ranges);
        for (std::size_t b = 0; b < counts.size(); ++b)
          if (counts[b] > 0.0)
            rows.add(middle(b % kBins, ranges[right]), middle(b / kBins, ranges[down]), counts[b]);
        const auto half = [](const std::array<double, 2>& range) {
          return 0.5 * (range[1] - range[0]) / static_cast<double>(kBins);
        };
        p.y = axis(down, right == 0);
        p.colours = Colours{};
        p.draw_cells(rows, half(ranges[right]), half(ranges[down]));
      }
    }
  return out.figure(static_cast<int>(kTop + static_cast<double>(numbers) * (side + kGap) + 60));
}

}  // namespace gatewalk::cli
