// SPDX-License-Identifier: MIT
#include "cli/render/variance_shares.h"

#include <algorithm>
#include <cmath>

#include "cli/render/final_gates.h"
#include "cli/render/health.h"
#include "cli/render/json.h"
#include "cli/render/text.h"
#include "lattice/text/digits.h"

namespace gatewalk::cli {
namespace {

using lattice::Mean95;

const EndingName& name_of(markov::Ending ending) {
  return *std::find_if(kAllEndingNames.begin(), kAllEndingNames.end(),
                       [&](const EndingName& e) { return e.ending == ending; });
}

void put(Json& json, const std::string& key, const Mean95& m) {
  const bool known = std::isfinite(m.mean);
  json[key] = known ? Json(m.mean) : Json();
  json[key + "_95"] = std::isfinite(m.interval[0]) ? Json(m.interval) : Json();
}

std::string with_interval(const Mean95& m) {
  return fixed(m.mean, 2) + " [" + fixed(m.interval[0], 2) + ", " + fixed(m.interval[1], 2) + "]";
}

}  // namespace

Json to_json(const RangedShares& shares) {
  const lattice::SobolIndices& i = shares.found.indices;
  Json json{{"of", name_of(shares.target).key}};
  put(json, "mean", i.mean);
  put(json, "variance", i.variance);
  json["noise_variance"] = i.noise;
  json["numbers"] = Json::array();
  for (std::size_t k = 0; k < shares.ranges.size(); ++k) {
    const lattice::NumberRange& r = shares.ranges[k];
    Json number{{"key", r.key}, {"low", r.low}, {"high", r.high}};
    put(number, "first", i.first[k]);
    put(number, "total", i.total[k]);
    json["numbers"].push_back(std::move(number));
  }
  json["points"] = shares.found.points;
  json["trials"] = shares.found.trials;
  json["seconds"] = shares.found.seconds;
  json["status"] = to_json(shares.found.health);
  return json;
}

std::string table_of(const RangedShares& shares) {
  const lattice::SobolIndices& i = shares.found.indices;
  const auto points = [](double share) { return fixed(100.0 * share, 2); };
  if (shares.found.ended == 0 || shares.found.ended == shares.found.trials)
    return "\nat all points of these ranges " +
           std::string(shares.found.ended > 0 ? "all" : "none") + " of " +
           std::to_string(shares.found.trials) + " trials ended as \"" +
           name_of(shares.target).name + "\": these cannot\ntell what the chance depends on\n";
  std::string table = "\nover these ranges the chance of \"" +
                      std::string(name_of(shares.target).name) + "\" is " + points(i.mean.mean) +
                      " [" + points(i.mean.interval[0]) + ", " + points(i.mean.interval[1]) +
                      "] % on average; ";
  const double half = 0.5 * (i.variance.interval[1] - i.variance.interval[0]);
  const double most = std::sqrt(std::max(half, i.variance.interval[1]));
  if (std::isnan(i.first.front().mean))
    table += "it does not vary\nby more than chance: its standard deviation is at most " +
             points(most) + " points (more --over-trials see less)\n";
  else
    table += "its standard deviation is " + points(std::sqrt(i.variance.mean)) +
             " points;\nof its variance each number makes\n" + padded("", 34) +
             padded("range", 20) + padded("alone", 20) + padded("with others, 95 %", 22) + "\n";
  for (std::size_t k = 0; k < shares.ranges.size() && std::isfinite(i.first[k].mean); ++k) {
    const lattice::NumberRange& r = shares.ranges[k];
    table += padded(r.key, -34) +
             padded(lattice::shortest(r.low) + " to " + lattice::shortest(r.high), 20) +
             padded(with_interval(i.first[k]), 20) + padded(with_interval(i.total[k]), 22) + "\n";
  }
  return table + "by " + std::to_string(shares.found.trials) + " trials at " +
         std::to_string(shares.found.points) + " points; the chance in the trials of a point is " +
         "left out, " + fixed(shares.found.seconds, 1) + " s\n";
}

}  // namespace gatewalk::cli
