#include "cli/bins.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "cli/render/report.h"
#include "cli/terminal/progress.h"
#include "lattice/reference.h"

namespace gatewalk::cli {
namespace {

using namespace dynamics;

constexpr int kAutoStates = 348;                            // four times Table III's
constexpr std::int64_t kJudgingTrials = 200;                // of a pilot that only judges bins
constexpr int kPilotGates = 30;                             // a pilot's trial visits no more
constexpr std::int64_t kPilotsOwn = std::int64_t{1} << 40;  // number of a pilot's first trial

Json to_json(const Crossing& c) {
  return {{"d_m", c.d}, {"vx_m_per_s", c.vx}, {"vy_m_per_s", c.vy}};
}

}  // namespace

bool papers_field(const lattice::Scene& scene) {
  const GateParams paper;
  const GateParams& p = scene.gate;
  const Scale unit = scale_of(p);
  // To rounding, which no other scene meets by chance.
  const auto is = [](double own, double papers) {
    return std::abs(own - papers) <= 1e-12 * papers;
  };
  return is(p.beams.length / unit.length, paper.beams.length) &&
         is(p.beams.joint_x / unit.length, paper.beams.joint_x) &&
         is(p.beams.joint_y / unit.length, paper.beams.joint_y) &&
         is(p.forces.random_rate * unit.time, paper.forces.random_rate);
}

std::string BinsChoice::name() const {
  return kind == Kind::paper ? "paper" : kind == Kind::automatic ? "auto" : "scene";
}

BinsChoice usual_bins(const lattice::Scene& scene) {
  using Kind = BinsChoice::Kind;
  BinsChoice choice{scene.bins ? Kind::scene : papers_field(scene) ? Kind::paper : Kind::automatic};
  choice.by_default = true;
  return choice;
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

BinsChoice bins_choice(const Options& options, const lattice::Scene& scene) {
  using Kind = BinsChoice::Kind;
  if (!options.has("bins")) return usual_bins(scene);
  const std::string& text = options.get<std::string>("bins");
  if (scene.bins)
    throw UsageError(
        "--bins " + text +
        ": the scene has a table [bins], which says what the bins are; leave out one of both");
  if (text == "auto") return {Kind::automatic};
  if (text == "paper") return {Kind::paper};
  BinsChoice choice;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, choice.factor);
  if (read.ec != std::errc() || read.ptr != end)
    throw UsageError("--bins " + text + ": must be paper, auto, or a factor > 0 such as 2");
  (void)refined(StateSpace::paper(scene.gate), choice.factor);  // refuses other factors
  return choice;
}

StateSpace fixed_space(const lattice::Scene& scene) {
  return scene.bins ? StateSpace(*scene.bins) : StateSpace::paper(scene.gate);
}

Pilot run_pilot(const Options& options, const lattice::Scene& scene,
                const std::vector<BodyState>& starts, std::int64_t trials) {
  Pilot pilot;
  lattice::FieldParams field = scene.field;
  field.fidelity = lattice::Fidelity::active;
  field.max_gates = field.max_gates == 0 ? kPilotGates : std::min(field.max_gates, kPilotGates);
  const StateSpace space =
      StateSpace::paper(scene.gate);  // run_field counts with it; nobody asks here
  for (const BodyState& start : starts) {
    const Crossing entry{Boundary::enter, start.x, start.vx, start.vy};
    if (start.y == 0.0 &&
        std::find(pilot.starts.begin(), pilot.starts.end(), entry) == pilot.starts.end())
      pilot.starts.push_back(entry);
    run_in_batches("pilot", trials, options.talk(), [&](std::int64_t first, std::int64_t n) {
      const auto part = lattice::run_field(scene.gate, field, start, space, options.seed(),
                                           {kPilotsOwn + first, n}, true);
      pilot.entries.insert(pilot.entries.end(), part.crossings.begin(), part.crossings.end());
      pilot.health += part.health;
    });
    pilot.trials += trials;
  }
  return pilot;
}

SeenStates seen_states(const lattice::Scene& scene, const Pilot& pilot, double scale) {
  std::vector<Crossing> entries = pilot.entries;
  if (symmetric(scene.gate)) add_mirror_images(entries);
  const double states = std::round(kAutoStates * scale * scale * scale);
  if (!(states >= 1.0 && states <= kMostStates))
    throw UsageError("--bins " + Json(scale).dump() + ": makes fewer than 1 or more than " +
                     std::to_string(kMostStates) + " states");
  StateSpace space = quantile_space(scene.gate, entries, static_cast<int>(states), pilot.starts);
  Entries of_rows = entries_of(space, entries);
  return {std::move(space), std::move(of_rows)};
}

States states_of(const Options& options, const lattice::Scene& scene, const BinsChoice& choice,
                 const std::vector<BodyState>& starts) {
  using Kind = BinsChoice::Kind;
  (void)StateSpace::paper(scene.gate);  // refuses gates too short for their beams
  Pilot pilot =
      run_pilot(options, scene, starts, choice.kind == Kind::paper ? kJudgingTrials : kPilotTrials);
  SeenStates seen{fixed_space(scene), {}};
  if (choice.kind == Kind::automatic) {
    seen = seen_states(scene, pilot);
  } else if (choice.kind == Kind::scene) {
    std::vector<Crossing> entries = pilot.entries;
    for (const Crossing& start : pilot.starts) entries.insert(entries.end(), kPilotTrials, start);
    seen.entries = entries_of(seen.space, entries);
  } else {
    seen.space = refined(StateSpace::paper(scene.gate), choice.factor);
  }
  const Resolution resolution = resolution_of(seen.space, pilot.entries);
  if (choice.by_default && choice.kind == Kind::paper && resolution.poor()) {
    warn("Table III's bins do not resolve how bodies move in this scene; takes --bins auto");
    return states_of(options, scene, {Kind::automatic}, starts);
  }
  return {choice, std::move(seen.space), std::move(seen.entries), std::move(pilot), resolution};
}

Json to_json(const States& s) {
  const Resolution& r = s.resolution;
  const auto n = static_cast<double>(std::max<std::int64_t>(1, r.entries));
  Json j;
  j["bins"] = s.choice.name();
  if (s.choice.kind == BinsChoice::Kind::paper) j["factor"] = s.choice.factor;
  j["states"] = s.space.size();
  j["outermost_bins"] = s.space.open() ? "open" : "closed";
  j["row_starts"] = s.entries.empty() ? "uniform" : "visited";
  if (!s.entries.empty()) {
    const auto bins =
        s.entries.begin() + (s.space.size() - static_cast<int>(s.space.points().size()));
    j["rows_without_entries"] =
        std::count_if(s.entries.begin(), bins, [](const auto& e) { return e.empty(); });
  }
  j["starts_of_their_own"] = Json::array();
  for (const Crossing& c : s.space.points()) j["starts_of_their_own"].push_back(to_json(c));
  j["pilot"] = {
      {"trials", s.pilot.trials}, {"entries", r.entries}, {"status", to_json(s.pilot.health)}};
  j["resolution"] = {{"clamped_share", static_cast<double>(r.clamped) / n},
                     {"states_entered", r.states_entered},
                     {"states_of_90_percent", r.states_of_90},
                     {"unresolved_variance",
                      {{"d", r.unresolved[0]}, {"vx", r.unresolved[1]}, {"vy", r.unresolved[2]}}},
                     {"poor", r.poor()}};
  return j;
}

std::string states_line(const Json& j) {
  if (j.is_null()) return "";
  const Json &r = j.at("resolution"), &pilot = j.at("pilot"),
             &unresolved = r.at("unresolved_variance");
  const std::string kind = j.at("bins");
  std::string text = "states: " + j.at("states").dump() +
                     (kind == "paper"  ? " (Table III's bins"
                      : kind == "auto" ? " (bins from a pilot"
                                       : " (the scene's bins");
  if (kind == "paper" && j.at("factor") != 1.0) text += " x " + j.at("factor").dump();
  text += "); of " + pilot.at("entries").dump() + " entries in " + pilot.at("trials").dump() +
          " pilot trials " + percent(r.at("clamped_share").get<double>(), 1.0) +
          " lie outside, 90 % in " + r.at("states_of_90_percent").dump() +
          " states; variance within states: d " + percent(unresolved.at("d").get<double>(), 1.0) +
          ", vx " + percent(unresolved.at("vx").get<double>(), 1.0) + ", vy " +
          percent(unresolved.at("vy").get<double>(), 1.0) + "\n";
  if (const auto rows = j.find("rows_without_entries"); rows != j.end() && rows->get<int>() > 0)
    text += "states without an entry seen: " + rows->dump() +
            ", their rows start anywhere in the bin\n";
  return text;
}

void warn_if_poor(const States& s) {
  if (!s.entries.empty() && !s.pilot.health.clean())
    warn("the pilot: " + complaint(s.pilot.health));
  if (s.pilot.entries.empty())
    warn("no body entered a second gate in " + std::to_string(s.pilot.trials) +
         " pilot trials: bins could not be judged by what bodies do");
  if (!s.resolution.poor()) return;
  const std::string what = "the bins resolve too little of how bodies enter gates: " +
                           percent(static_cast<double>(s.resolution.clamped),
                                   static_cast<double>(s.resolution.entries)) +
                           " of the entries seen lie outside, 90 % of them in " +
                           std::to_string(s.resolution.states_of_90) +
                           " states; the chain may be far off. ";
  warn(what + (s.choice.kind == BinsChoice::Kind::automatic
                   ? "Only " + std::to_string(s.resolution.entries) +
                         " entries were seen, too few for more states"
                   : "--bins auto, without a table [bins] in the scene, makes bins that suit it"));
}

}  // namespace gatewalk::cli
