// SPDX-License-Identifier: MIT
#include "cli/render/variance_shares.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/final_gates.h"
#include "cli/render/health.h"
#include "lattice/text/digits.h"

namespace gatewalk::cli {
namespace {

using lattice::Mean95;

void estimate(Fields& out, const Field& field, const Mean95& m) {
  out.estimate(field, m.mean, m.interval);
}

std::string with_interval(const Mean95& m) {
  return fmt::format("{} [{}, {}]", fixed(m.mean, 2), fixed(m.interval[0], 2),
                     fixed(m.interval[1], 2));
}

}  // namespace

void describe(Fields& out, const RangedShares& shares) {
  const lattice::SobolIndices& i = shares.found.indices;
  out.text(Label("of", "the ending whose chance varies").one_of(ending_keys()),
           ending_name(shares.target).key);
  estimate(out, {"mean", "1", "mean of the chance of this ending over the ranges"}, i.mean);
  estimate(out, {"variance", "1", "variance of the chance over the ranges, without sampling noise"},
           i.variance);
  out.number({"noise_variance", "1",
              "mean sampling variance of the share that 16 trials at one point show"},
             i.noise);
  out.list_of({"numbers", "the numbers that --over varies"}, shares.ranges.size(),
              [&](Fields& number, std::size_t k) {
                const lattice::NumberRange& r = shares.ranges[k];
                number.text({"key", "key of the number in the scene"}, r.key);
                number.number({"low", "its own", "lower end of the number's range"}, r.low);
                number.number({"high", "its own", "upper end of the number's range"}, r.high);
                estimate(number,
                         {"first", "1",
                          "Sobol's first-order index: share of the variance by this number alone; "
                          "null: no variance beyond noise"},
                         i.first[k]);
                estimate(number,
                         {"total", "1",
                          "Sobol's total index: share of the variance by this number alone and "
                          "together with others"},
                         i.total[k]);
              });
  out.count({"points", "1", "number of points of the ranges at which trials were run"},
            shares.found.points);
  out.count({"trials", "1", "number of trials at all points together"}, shares.found.trials);
  out.number({"seconds", "s", "time that these trials took"}, shares.found.seconds);
  describe_status(out, shares.found.health);
}

std::string answer_text(const RangedShares& shares) {
  const auto& [ranges, target, found] = shares;
  const lattice::SobolIndices& i = found.indices;
  const auto points = [](double share) { return fixed(100.0 * share, 2); };
  const char* const ending = ending_name(target).name;
  if (found.ended == 0 || found.ended == found.trials)
    return wrapped(fmt::format(
        "At all points of these ranges {} of {} trials ended as \"{}\": these trials cannot tell "
        "what the chance depends on.",
        found.ended > 0 ? "all" : "none", found.trials, ending));
  std::string text =
      fmt::format("Over these ranges the chance of \"{}\" is {} % [{}, {}] on average; ", ending,
                  points(i.mean.mean), points(i.mean.interval[0]), points(i.mean.interval[1]));
  if (std::isnan(i.first.front().mean)) {
    const auto& [low, high] = i.variance.interval;
    return wrapped(text + fmt::format("it does not vary by more than sampling noise (standard "
                                      "deviation at most {} points). More --over-trials show less.",
                                      points(std::sqrt(std::max(0.5 * (high - low), high)))));
  }
  text = wrapped(text + fmt::format("its standard deviation is {} points.",
                                    points(std::sqrt(i.variance.mean))));
  TextTable table({{"Share of this variance", -34},
                   {"range", 20},
                   {"alone, 95 %", 20},
                   {"with others, 95 %", 20}});
  for (std::size_t k = 0; k < ranges.size(); ++k)
    table.row({ranges[k].key,
               fmt::format("{} to {}", lattice::shortest(ranges[k].low),
                           lattice::shortest(ranges[k].high)),
               with_interval(i.first[k]), with_interval(i.total[k])});
  return text + table.text();
}

std::string details_text(const RangedShares& shares) {
  const lattice::VarianceShares& found = shares.found;
  return fmt::format(
      "\nShares of the variance: from {} trials at {} points, in {} s. The sampling noise of the "
      "trials\nat one point is not part of the variance.\n",
      found.trials, found.points, fixed(found.seconds, 1));
}

}  // namespace gatewalk::cli
