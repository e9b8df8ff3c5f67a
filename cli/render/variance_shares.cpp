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

std::string table_of(const RangedShares& shares) {
  const auto& [ranges, target, found] = shares;
  const lattice::SobolIndices& i = found.indices;
  const auto points = [](double share) { return fixed(100.0 * share, 2); };
  const char* const ending = ending_name(target).name;
  if (found.ended == 0 || found.ended == found.trials)
    return fmt::format(
        "\nat all points of these ranges {} of {} trials ended as \"{}\": these cannot\ntell what "
        "the chance depends on\n",
        found.ended > 0 ? "all" : "none", found.trials, ending);
  const auto& [low, high] = i.variance.interval;
  TextTable table({{"", -34}, {"range", 20}, {"alone", 20}, {"with others, 95 %", 22}});
  for (std::size_t k = 0; k < ranges.size() && std::isfinite(i.first[k].mean); ++k)
    table.row({ranges[k].key,
               fmt::format("{} to {}", lattice::shortest(ranges[k].low),
                           lattice::shortest(ranges[k].high)),
               with_interval(i.first[k]), with_interval(i.total[k])});
  const std::string varies =
      std::isnan(i.first.front().mean)
          ? fmt::format(
                "it does not vary\nby more than chance: its standard deviation is at most "
                "{} points (more --over-trials see less)\n",
                points(std::sqrt(std::max(0.5 * (high - low), high))))
          : fmt::format("its standard deviation is {} points;\nof its variance each number makes\n",
                        points(std::sqrt(i.variance.mean))) +
                table.text();
  return fmt::format(
      "\nover these ranges the chance of \"{}\" is {} [{}, {}] % on average; {}by {} trials at {} "
      "points; the chance in the trials of a point is left out, {} s\n",
      ending, points(i.mean.mean), points(i.mean.interval[0]), points(i.mean.interval[1]), varies,
      found.trials, found.points, fixed(found.seconds, 1));
}

}  // namespace gatewalk::cli
