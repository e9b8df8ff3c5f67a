#include "cli/arguments.h"

#include <charconv>
#include <cmath>
#include <sstream>

#include "cli/render/choice.h"
#include "cli/render/health.h"
#include "cli/render/json.h"
#include "cli/render/matrix.h"
#include "cli/render/start.h"
#include "dynamics/work.h"

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
  options.add_texts("start", "D,VX,VY", help);
}

std::vector<lattice::PaperStart> given_starts(const Options& options) {
  std::vector<lattice::PaperStart> starts;
  for (const std::string& text : options.texts("start")) starts.push_back(parse_start(text));
  return starts;
}

std::vector<lattice::PaperStart> starts_of(const Options& options, const lattice::Scene& scene) {
  return options.has("start") ? given_starts(options) : lattice::usual_starts(scene);
}

void add_bins(Options& options) {
  options.add_text(
      "bins", "paper|auto|FACTOR",
      "the chain's states: paper: Table III's, in the scene's own units; FACTOR: these "
      "with so many times "
      "the bins per axis (2 makes 696 states, 0.5 makes 23); auto: at the quantiles of "
      "what bodies do in a "
      "pilot of the full dynamics. Default: the scene's table [bins], else paper where the gate "
      "has "
      "the paper's proportions and these bins resolve what bodies do, else auto");
}

lattice::BinsChoice bins_choice(const Options& options, const lattice::Scene& scene) {
  using Kind = lattice::BinsChoice::Kind;
  if (!options.has("bins")) return lattice::usual_bins(scene);
  const std::string text = options.text("bins");
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

std::optional<lattice::Settled> settle_method(const Options& options, lattice::Scene& scene,
                                              lattice::RunsFrom from) {
  for (const std::string& text : lattice::keys_without_effect(scene)) options.warn(text);
  if (options.talk()) options.warn(lattice::derived_keys(scene));
  auto settled = lattice::settle_method(scene, from, options.seed(), options.work());
  if (settled) options.warn(complaint(*settled));
  return settled;
}

lattice::States states_of(const Options& options, const lattice::Scene& scene,
                          const lattice::BinsChoice& choice,
                          const std::vector<dynamics::BodyState>& starts) {
  lattice::States states =
      lattice::states_of(scene, choice, starts, options.seed(), options.work());
  if (states.replaced)
    options.warn(
        "Table III's bins do not resolve how bodies move in this scene; takes --bins auto");
  return states;
}

lattice::SceneMatrix read_matrix(const Options& options) {
  return read_matrix(options, options.text("matrix"), options.text("scene"), options.overrides());
}

lattice::SceneMatrix read_matrix(const Options& options, const std::string& matrix_path,
                                 const std::string& scene_path,
                                 const std::vector<std::string>& overrides) {
  lattice::SceneMatrix m = lattice::read_scene_matrix(matrix_path, scene_path, overrides);
  if (const std::string faults = faults_recorded(recorded_status(m.file)); !faults.empty())
    options.warn("the runs that made " + matrix_path + ": " + faults);
  return m;
}

lattice::ChainStart checked_start(const Options& options, const dynamics::StateSpace& space,
                                  const lattice::FieldParams& field,
                                  const dynamics::BodyState& body, const std::string& name) {
  const lattice::ChainStart start = lattice::start_in_bins(space, field, body, name);
  if (start.beyond)
    options.warn(
        name + " lies beyond every entry that the bins were made from, " +
        lattice::entry_bins(space) +
        "; the prediction is that of the outermost bin. A matrix of a scene with this start suits "
        "it");
  return start;
}

void require_inside_bins(const Options& options, const std::vector<lattice::PaperStart>& starts,
                         const lattice::Scene& scene, const dynamics::StateSpace& space) {
  for (const lattice::PaperStart& s : starts)
    (void)checked_start(options, space, scene.field, s.body(), "start" + start_text(s));
}

lattice::ChainStart ready_start(const Options& options, const lattice::SceneMatrix& m,
                                const dynamics::BodyState& body, const std::string& name) {
  const dynamics::StateSpace& space = m.file.transitions.space;
  const lattice::ChainStart start = checked_start(options, space, m.scene.field, body, name);
  const dynamics::Cell cell = space.cell(start.start.input);
  const auto on_edge = [](const std::array<double, 2>& edges, double v) {
    return edges[0] < edges[1] && (v == edges[0] || v == edges[1]);
  };
  if (on_edge(cell.d, body.x) || on_edge(cell.vx, body.vx) || on_edge(cell.vy, body.vy))
    options.remark(name + " lies on an edge of its bin, " + text_of(cell) +
                   "; its prediction is that of the whole bin");
  return start;
}

int status_of(const Options& options, const dynamics::Health& health) {
  options.warn(complaint(health));
  return exit_status(options, health.clean());
}

}  // namespace gatewalk::cli
