// SPDX-License-Identifier: MIT
#include "cli/parsers.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <ranges>
#include <sstream>
#include <stdexcept>

#include "cli/arguments.h"
#include "cli/film/video.h"
#include "cli/render/text.h"
#include "cli/web/embedded.h"
#include "dynamics/disc/study/work_precision.h"
#include "lattice/statistics/ending_shares.h"

namespace gatewalk::cli {
namespace {

/// "4-6=other.nc": rows whose gates are those of another matrix.
lattice::RowMatrix parse_rows(const Options& options, const std::string& text) {
  const auto wrong = [&] {
    return UsageError(fmt::format(
        "--row {}: must be rows i_y and a matrix, e.g. 4-6=other.nc or 4=other.nc", text));
  };
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals + 1 == text.size()) throw wrong();
  const char *at = text.data(), *const end = text.data() + equals;
  int first = 0, last = 0;
  const auto number = [&](int& value) {
    const auto read = std::from_chars(at, end, value);
    if (read.ec != std::errc() || value < 0) throw wrong();
    at = read.ptr;
  };
  number(first);
  last = first;
  if (at != end) {
    if (*at++ != '-') throw wrong();
    number(last);
  }
  if (at != end) throw wrong();
  const std::string path = text.substr(equals + 1);
  return {first, last, path, read_matrix(options, path, "", {})};
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  stream.exceptions(std::ios_base::badbit);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

/// What `check` refuses is wrong with the option of that name.
template <class Check>
void check_option(const Options& options, const char* name, Check check) try {
  if (options.has(name)) check(options.text(name));
} catch (const std::invalid_argument& e) {
  throw UsageError(fmt::format("--{} {}", name, e.what()));
}

}  // namespace

std::vector<lattice::RowMatrix> other_rows(const Options& options) {
  std::vector<lattice::RowMatrix> rows;
  for (const std::string& text : options.texts("row")) rows.push_back(parse_rows(options, text));
  return rows;
}

markov::PredictOptions::Solver solver_of(const Options& options) {
  using Solver = markov::PredictOptions::Solver;
  const std::string name = options.text("solver");
  if (name == "auto") return Solver::automatic;
  if (name == "propagate") return Solver::steps;
  if (name == "march") return Solver::rows;
  if (name == "klu") return Solver::klu;
  throw UsageError(fmt::format("--solver {}: must be auto, propagate, march or klu", name));
}

markov::Ending target_of(const Options& options) {
  const std::string name = options.text("target");
  if (const auto ending = lattice::ending_named(name)) return *ending;
  throw UsageError(fmt::format(
      "--target {}: must be one of {}", name,
      fmt::join(lattice::kEndingNames | std::views::transform(&lattice::EndingName::key), ", ")));
}

lattice::LumpingParts lumping_of(const Options& options, const dynamics::Section& section) {
  constexpr int kMost = 1000;
  lattice::LumpingParts parts(section.coordinates.size(), 1);
  if (!options.has("lump")) return parts;
  const std::string text = options.text("lump");
  const char *at = text.data(), *const end = at + text.size();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto [next, error] = std::from_chars(at, end, parts[i]);
    const bool ends_well = i + 1 < parts.size() ? next != end && *next == ',' : next == end;
    if (error != std::errc() || !ends_well || parts[i] < 1 || parts[i] > kMost)
      throw UsageError(fmt::format("--lump {}: must be {} whole numbers from 1 to {}: parts of {}",
                                   text, parts.size(), kMost, names_of(section.coordinates, ",")));
    at = next + 1;
  }
  return parts;
}

double number_within(const Options& options, const char* name, double usual, double low,
                     double high) {
  if (!options.has(name)) return usual;
  const double value = options.number(name);
  if (!(value >= low && value <= high))
    throw UsageError(fmt::format("--{} {}: must lie in [{}, {}]", name, digits(value), digits(low),
                                 digits(high)));
  return value;
}

std::vector<std::string> chosen_methods(const Options& options) {
  const auto known = dynamics::chart_methods();
  if (!options.has("methods")) return {known.begin(), known.end()};
  std::vector<std::string> methods = split(options.text("methods"));
  const std::string names = fmt::format("{}", fmt::join(known, ", "));
  if (methods.empty()) throw UsageError("--methods needs at least one of " + names);
  for (std::size_t i = 0; i < methods.size(); ++i) {
    if (std::find(known.begin(), known.end(), methods[i]) == known.end())
      throw UsageError(fmt::format("--methods: no method '{}'; there are {}", methods[i], names));
    if (std::find(methods.begin(), methods.begin() + static_cast<std::ptrdiff_t>(i), methods[i]) !=
        methods.begin() + static_cast<std::ptrdiff_t>(i))
      throw UsageError(fmt::format("--methods: {} stands there twice", methods[i]));
  }
  return methods;
}

lattice::RecordingOptions recording_options(const Options& options) {
  const lattice::RecordingOptions wanted{
      .seed = options.seed(),
      .first = options.count("trial", 0),
      .trials = options.trials(),
      .across_field = options.has("field") || options.has("policy"),
      .only = options.text("only"),
      .chosen = {}};
  check_option(options, "only", [&](const std::string& only) {
    lattice::require_ending(only, wanted.across_field);
  });
  if (!options.has("only") && wanted.trials > lattice::kMostRecordings)
    throw UsageError(fmt::format("--trials {}: at most {} runs are recorded; pick some with --only",
                                 wanted.trials, lattice::kMostRecordings));
  check_option(options, "replay", [](const std::string&) {
    if (!has_pages())
      throw std::invalid_argument(
          "needs pages: this gatewalk was built without (GATEWALK_PAGES=OFF)");
  });
  check_option(options, "video", [](const std::string& path) { (void)video_format(path); });
  return wanted;
}

}  // namespace gatewalk::cli
