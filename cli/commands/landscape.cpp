#include "dynamics/landscape.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "cli/command.h"
#include "cli/render/choice.h"
#include "cli/render/drawing.h"
#include "cli/render/quantity.h"
#include "cli/render/report.h"
#include "cli/terminal/output.h"
#include "cli/terminal/progress.h"

namespace gatewalk::cli {
namespace {

using dynamics::Landscape;
using dynamics::Pass;

constexpr double kSpacing = 0.5;  // in the scene's unit of length: the paper's grid
constexpr double kFiner = 10.0;   // the pass is looked for on a grid so much finer too

dynamics::BeamsThatPush beams_of(const std::string& name) {
  if (name != "both" && name != "left" && name != "right")
    throw UsageError("--beam " + name + ": must be both, left or right");
  return {name != "right", name != "left"};
}

double kinetic(const lattice::Scene& s) {
  return 0.5 * s.gate.body.mass * (s.start.vx * s.start.vx + s.start.vy * s.start.vy);
}

Json json_of(const Pass& pass) {
  return {{"x_m", pass.x},
          {"y_m", pass.y},
          {"energy_J", pass.energy},
          {"begins_at_J", pass.start_energy},
          {"barrier_J", pass.barrier()},
          {"way_m", pass.way}};
}

std::string csv_of(const Landscape& l) {
  std::ostringstream out;
  out << "x_m,y_m,elastic_J,total_J\n";
  for (std::size_t i = 0; i < l.y.size(); ++i)
    for (std::size_t j = 0; j < l.x.size(); ++j)
      out << digits(l.x[j]) << ',' << digits(l.y[i]) << ',' << digits(l.elastic(i, j)) << ','
          << digits(l.total(i, j)) << '\n';
  return out.str();
}

/// 1, 2 or 5 times a power of ten that cuts `span` into about `parts`.
double tic_step(double span, double parts) {
  const double wanted = span / parts, power = std::pow(10.0, std::floor(std::log10(wanted)));
  double best = power;
  for (const double k : {2.0, 5.0, 10.0})
    if (std::abs(k * power - wanted) < std::abs(best - wanted)) best = k * power;
  return best;
}

/// The paper's Fig. 5: elastic energy as a surface and from above, with the propulsion as a
/// surface, and, from above, the lowest way through.
void draw(const std::string& path, const Landscape& l, const Pass& pass, double ceiling) {
  std::ostringstream rows, way, out;
  const Sized metre = readable_unit("m", std::max(l.x.back(), l.y.back() - l.y.front()));
  const Sized joule = readable_unit("J", ceiling);
  const auto length = [&](double x) { return digits(x / metre.size); };
  const auto energy = [&](double e) { return digits(std::min(e, ceiling) / joule.size); };
  // No more points than can be seen.
  const std::size_t stride = std::max<std::size_t>(1, std::max(l.x.size(), l.y.size()) / 150);
  for (std::size_t i = 0; i < l.y.size(); i += stride) {
    for (std::size_t j = 0; j < l.x.size(); j += stride)
      rows << length(l.x[j]) << ' ' << length(l.y[i]) << ' ' << energy(l.elastic(i, j)) << ' '
           << energy(l.total(i, j)) << '\n';
    rows << '\n';
  }
  for (const auto& [x, y] : pass.way) way << length(x) << ' ' << length(y) << '\n';
  const double wide = (l.x.back() - l.x.front()) / metre.size,
               deep = (l.y.back() - l.y.front()) / metre.size;
  const auto surface = [&](const char* title, int column, const char* origin) {
    return std::string("unset colorbox\nset size noratio\nset size 0.52,0.52\nset origin ") +
           origin +
           "\nset lmargin 6\nset rmargin 2\nset tmargin 2\nset bmargin 2\nset view "
           "58,330,0.95\nset title '" +
           title + "'\nset ytics " + digits(tic_step(deep, 3.0)) +
           "\nsplot $grid using 1:2:" + std::to_string(column) + " with pm3d\n";
  };
  const auto from_above = [&](const char* title, const char* origin) {
    return std::string("set colorbox\nset size 0.48,0.5\nset size ratio -1\nset origin ") + origin +
           "\nset lmargin 8\nset rmargin 10\nset tmargin 2\nset bmargin 4\nset title '" + title +
           "'\nset ytics " + digits(tic_step(deep, 6.0)) + "\n";
  };
  out << data_block("$grid", rows.str()) << data_block("$way", way.str())
      << "set multiplot\nset xlabel 'x (" << metre.name << ")'\nset ylabel 'y (" << metre.name
      << ")'\nset cblabel '" << joule.name
      << "'\nset pm3d\nunset key\n"
         "set xrange ["
      << length(l.x.front()) << ":" << length(l.x.back()) << "]\nset yrange ["
      << length(l.y.front()) << ":" << length(l.y.back()) << "]\nset cbrange [0:" << energy(ceiling)
      << "]\nset zrange [0:" << energy(ceiling)
      << "]\n"
         "set palette defined (0 '#30123b', 1 '#4145ab', 2 '#4675ed', 3 '#39a2fc', 4 '#1bcfd4', 5 "
         "'#24eca6', "
         "6 '#61fc6c', 7 '#a4fc3b', 8 '#d1e834', 9 '#f3c63a', 10 '#fe9b2d', 11 '#f36315', 12 "
         "'#d93806', 13 '#7a0403')\n"
         "set xyplane 0\nset xtics "
      << digits(tic_step(wide, 5.0)) << "\n"
      << surface("elastic energy, Eq. (14)", 3, "0.0,0.49")
      << from_above("the same from above", "0.52,0.5") << "plot $grid using 1:2:3 with image\n"
      << surface("with the propulsion, Eq. (15)", 4, "0.0,-0.01")
      << from_above("lowest way through (white), its highest point", "0.52,0.0")
      << "plot $grid using 1:2:4 with image, $way using 1:2 with lines lw 2 lc rgb '#ffffff', '-' "
         "using 1:2 with "
         "points pt 7 ps 1 lc rgb '#ff00ff'\n"
      << length(pass.x) << ' ' << length(pass.y) << "\ne\nunset multiplot\n";
  draw_svg(path, 1100, 950, out.str());
}

}  // namespace

int run_landscape(const std::vector<std::string>& arguments) {
  Options options("landscape SCENE -o DIR [options]",
                  "The potential energy of body and beams over the gate, Eqs. (14) and (15) of the "
                  "paper, with beams\n"
                  "deflected forward; the way through whose highest point is lowest, and how far "
                  "that lies above the\n"
                  "energy of the start and above the basin on the way. Writes landscape.csv, "
                  "landscape.json, landscape.svg.",
                  "gatewalk landscape scenes/single_gate.toml -o landscape --trials 1000");
  options.positional("scene", "scene file (TOML)", true);
  options.output_folder("folder to write to", {"landscape.csv", "landscape.json", "landscape.svg"});
  options.add()("spacing", po::value<double>()->value_name("M"),
                "of the grid, in m (default: a twentieth of body.radius_m, as in the paper)")(
      "beam", po::value<std::string>()->default_value("both")->value_name("WHICH"),
      "beams that resist: both, left or right (the other swings free: Fig. 6C)")(
      "trials", po::value<Count>()->default_value(Count{0}, "0")->value_name("N"),
      "also run the gate N times: who passes, beside who should");
  add_seed(options);
  add_strict(options);
  if (!options.parse(arguments)) return kFine;
  const std::string folder = options.text("output");
  const auto beams = beams_of(options.get<std::string>("beam"));
  const std::int64_t trials = options.count("trials", 0);
  lattice::Scene scene = lattice::read_scene(options.text("scene"), options.overrides());
  const double unit = dynamics::scale_of(scene.gate).length;
  const double low = std::min(0.0, scene.start.y);
  // At most 2000 points along each side of the gate.
  const double most = scene.gate.beams.joint_x;
  const double least = std::max(scene.gate.run.traverse_y - low, 2.0 * most) / 2000;
  const double spacing = options.has("spacing")
                             ? options.get<double>("spacing")
                             : std::clamp(kSpacing * unit, least, std::max(least, most));
  if (!(spacing >= least && spacing <= most))
    throw UsageError("--spacing " + digits(spacing) + ": must lie in [" + digits(least) + ", " +
                     digits(most) + "] m");
  require_folder(folder);

  // On the grid that is asked for and on a finer one: the pass may lie between grid points.
  struct Level {
    double spacing;
    Landscape l;
    Pass from_start, from_basin;
    /// J; below zero where the start lies higher than the pass out of the basin.
    [[nodiscard]] double above_start() const { return from_basin.energy - from_start.start_energy; }
    [[nodiscard]] bool downhill() const { return from_basin.way.size() == 1; }
  };
  std::vector<Level> levels;
  for (const double step : {spacing, std::max(spacing / kFiner, least)}) {
    Landscape l = dynamics::landscape(scene.gate, low, step, beams);
    const Pass from_start = dynamics::lowest_pass(l, scene.start.x, scene.start.y);
    const auto [x, y] = dynamics::basin_below(l, scene.start.x, scene.start.y);
    const Pass from_basin = dynamics::lowest_pass(l, x, y);
    levels.push_back({step, std::move(l), from_start, from_basin});
  }
  const Landscape& l = levels.front().l;
  const Level& fine = levels.back();
  const double moving = kinetic(scene);

  bool clean = true;
  Json json;
  json["spacing_m"] = spacing;
  json["beams"] = options.get<std::string>("beam");
  json["start_kinetic_energy_J"] = moving;
  json["passes"] = Json::array();
  std::string table =
      scene_line(scene) + padded("", -22) +
      "    pass at x           y   above the start   above the basin   basin at x           y\n";
  const dynamics::Scale scale = dynamics::scale_of(scene.gate);
  const auto place = [&](double x) { return reading(x, "m", 0.01 * scale.length); };
  const auto energy = [&](double e) { return reading(e, "J", 0.01 * scale.energy()); };
  for (const Level& level : levels) {
    const auto& [x, y] = level.from_basin.way.front();
    json["passes"].push_back({{"grid_m", level.spacing},
                              {"from_start", json_of(level.from_start)},
                              {"from_basin", json_of(level.from_basin)},
                              {"basin_m", level.from_basin.way.front()},
                              {"above_start_J", level.above_start()}});
    table += padded("grid " + quantity(level.spacing, "m"), -22);
    if (level.downhill()) {
      table += "  no basin on the way: downhill to the far boundary\n";
      continue;
    }
    table += padded(place(level.from_basin.x), 13) + padded(place(level.from_basin.y), 12) +
             padded(energy(level.above_start()), 18) +
             padded(energy(level.from_basin.barrier()), 18) + padded(place(x), 13) +
             padded(place(y), 12) + "\n";
  }
  table +=
      "Between grid points the pass may lie lower: hence the finer grid.\nThe start has " +
      energy(moving) + " of kinetic energy: " +
      (fine.above_start() > moving ? "too little for the pass without work of the random force.\n"
                                   : "as energies go enough, but hits and dampers take theirs: a "
                                     "body that comes to rest in a basin must "
                                     "climb out of it.\n");
  if (trials > 0) {
    const Json settled = settle_method(options, scene, lattice::RunsFrom::start);
    dynamics::GateTally tally;
    run_in_batches("gate runs", trials, options.talk(), [&](std::int64_t first, std::int64_t n) {
      tally += dynamics::run_gate_trials(scene.gate, scene.start, options.seed(), {first, n});
    });
    lattice::check_outcomes(scene, lattice::RunsFrom::start, options.seed(), trials, tally.health,
                            options.work());
    json["measured"] = to_json(tally);
    if (!settled.is_null()) json["measured"]["method"] = settled;
    json["measured"]["status"] = to_json(tally.health);
    const auto [from, to] = share_interval(tally.traversed(), tally.trials);
    table += "measured: " +
             percent(static_cast<double>(tally.traversed()), static_cast<double>(trials)) + " of " +
             std::to_string(trials) + " trials traverse, 95 % [" + fixed(100.0 * from, 1) + ", " +
             fixed(100.0 * to, 1) + "]\n";
    clean = tally.health.clean();
    if (!clean) warn(complaint(tally.health));
  }
  json["made_by"] = manifest(options, scene);
  write_text_atomically(folder + "/landscape.csv", csv_of(l));
  write_text_atomically(folder + "/landscape.json", text_of(json) + "\n");
  // Beside the joints the beams' energy leaves every scale; what matters lies lower.
  double ceiling = 0.0;
  for (const double k : {scene.gate.beams.stiffness_left, scene.gate.beams.stiffness_right})
    ceiling = std::max(ceiling, 0.5 * k * 2.0);
  draw(folder + "/landscape.svg", l, fine.downhill() ? fine.from_start : fine.from_basin,
       1.2 * ceiling + scene.gate.forces.propulsion * (20.0 * unit));
  options.give_out(json, table);
  return exit_status(options, clean);
}

}  // namespace gatewalk::cli
