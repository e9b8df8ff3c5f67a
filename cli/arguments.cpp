#include "cli/arguments.h"

#include <charconv>
#include <cmath>
#include <sstream>

namespace gatewalk::cli {
namespace {

lattice::PaperStart parse_start(const std::string& text) {
  std::istringstream in(text);
  lattice::PaperStart s{};
  char first = 0, second = 0;
  if (!(in >> s.d >> first >> s.vx >> second >> s.vy) || first != ',' || second != ',' ||
      in.peek() != std::char_traits<char>::eof() || !std::isfinite(s.d + s.vx + s.vy))
    throw UsageError("--start " + text +
                     ": must be three numbers d,vx,vy in m and m/s, e.g. 4,5,10");
  return s;
}

}  // namespace

void add_starts(Options& options, const std::string& by_default) {
  const std::string help =
      "start at x = D m, y = 0 with this velocity in m/s (may be repeated; "
      "default: " +
      by_default + ")";
  options.add()("start", po::value<std::vector<std::string>>()->composing()->value_name("D,VX,VY"),
                help.c_str());
}

std::vector<lattice::PaperStart> given_starts(const Options& options) {
  std::vector<lattice::PaperStart> starts;
  if (!options.has("start")) return starts;
  for (const auto& text : options.get<std::vector<std::string>>("start"))
    starts.push_back(parse_start(text));
  return starts;
}

std::vector<lattice::PaperStart> starts_of(const Options& options, const lattice::Scene& scene) {
  return options.has("start") ? given_starts(options) : lattice::usual_starts(scene);
}

void add_bins(Options& options) {
  options.add()("bins", po::value<std::string>()->value_name("paper|auto|FACTOR"),
                "the chain's states: paper: Table III's, in the scene's own units; FACTOR: these "
                "with so many times "
                "the bins per axis (2 makes 696 states, 0.5 makes 23); auto: at the quantiles of "
                "what bodies do in a "
                "pilot of the full dynamics. Default: the scene's table [bins], else paper in the "
                "paper's field and "
                "auto in any other");
}

lattice::BinsChoice bins_choice(const Options& options, const lattice::Scene& scene) {
  using Kind = lattice::BinsChoice::Kind;
  if (!options.has("bins")) return lattice::usual_bins(scene);
  const std::string& text = options.get<std::string>("bins");
  if (scene.bins)
    throw UsageError(
        "--bins " + text +
        ": the scene has a table [bins], which says what the bins are; leave out one of both");
  if (text == "auto") return {Kind::automatic};
  if (text == "paper") return {Kind::paper};
  lattice::BinsChoice choice;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, choice.factor);
  if (read.ec != std::errc() || read.ptr != end)
    throw UsageError("--bins " + text + ": must be paper, auto, or a factor > 0 such as 2");
  (void)dynamics::refined(dynamics::StateSpace::paper(scene.gate),
                          choice.factor);  // refuses other factors
  return choice;
}

}  // namespace gatewalk::cli
