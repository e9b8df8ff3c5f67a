#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <sstream>

#include <tbb/parallel_for.h>

#include "cli/command.h"
#include "cli/render/drawing.h"
#include "cli/render/report.h"
#include "cli/terminal/output.h"
#include "cli/terminal/progress.h"
#include "cli/version.h"
#include "dynamics/study/accuracy.h"
#include "dynamics/study/stability.h"

namespace gatewalk::cli {
namespace {

using dynamics::MapAxis;
using dynamics::MapPoint;
using dynamics::StabilityMap;
using dynamics::Verdict;

/// One colour per verdict, in their order: pale while the numbers hold.
constexpr std::array<const char*, dynamics::kVerdictNames.size()> kColours{
    "#d8efd3",  // ok
    "#fff3b0",  // missed hit
    "#c9d3ea",  // no formula
    "#fdbe85",  // too fast
    "#f781bf",  // outcomes off
    "#e6550d",  // energy
    "#9e79bd",  // penetration
    "#7f1d1d",  // beyond bound
    "#2166ac",  // stuck
    "#111111",  // not finite
    "#9a9a9a",  // refused
};
static_assert(kColours.back() != nullptr, "one colour per verdict");

struct FinishedMap {
  StabilityMap map;
  std::vector<MapPoint> points;  // (y, x): row after row
  std::vector<double> seconds;   // each point took
  [[nodiscard]] const MapPoint& at(std::size_t ix, std::size_t iy) const {
    return points[iy * map.x.values.size() + ix];
  }
  [[nodiscard]] std::int64_t count(Verdict v) const {
    return std::count_if(points.begin(), points.end(),
                         [v](const MapPoint& p) { return p.verdict == v; });
  }
};

FinishedMap run_map(const Options& options, const StabilityMap& map) {
  FinishedMap done;
  done.map = map;
  const std::size_t columns = map.x.values.size();
  const std::size_t total = columns * map.y.values.size();
  done.points.resize(total);
  done.seconds.resize(total);
  run_in_batches(std::string(map.name) + ", " + map.method, static_cast<std::int64_t>(total),
                 options.talk(), [&](std::int64_t first, std::int64_t n) {
                   tbb::parallel_for(first, first + n, [&](std::int64_t k) {
                     const auto i = static_cast<std::size_t>(k);
                     const Stopwatch watch;
                     done.points[i] =
                         dynamics::run_point(map.kind, map.method, map.x.values[i % columns],
                                             map.y.values[i / columns], options.seed());
                     done.seconds[i] = watch.seconds();
                   });
                 });
  return done;
}

// ---- Figures ----

/// An axis as gnuplot draws it. Grazing's delta runs over both signs and 24 decades: it is drawn by
/// number. A zero on a logarithmic axis stands one place below the first value.
struct DrawnAxis {
  std::vector<double> low, high;  // edges of each value's cell
  bool logarithmic = false;
  std::string tics;

  explicit DrawnAxis(const MapAxis& axis) {
    const std::vector<double>& v = axis.values;
    const std::size_t n = v.size();
    const bool by_number = axis.logarithmic && v.front() < 0.0;
    logarithmic = axis.logarithmic && !by_number;
    std::vector<double> at = v;  // places, in the measure in which cells are even
    for (std::size_t i = 0; i < n; ++i)
      if (by_number)
        at[i] = static_cast<double>(i);
      else if (logarithmic && v[i] > 0.0)
        at[i] = std::log(v[i]);
    const bool zero_first = logarithmic && v.front() == 0.0;
    if (zero_first) at[0] = 2 * at[1] - at[2];
    const auto out = [&](double place) { return digits(logarithmic ? std::exp(place) : place); };
    for (std::size_t i = 0; i < n; ++i) {
      const double before = i > 0 ? at[i - 1] : 2 * at[0] - at[1];
      const double after = i + 1 < n ? at[i + 1] : 2 * at[n - 1] - at[n - 2];
      const double a = 0.5 * (before + at[i]), b = 0.5 * (at[i] + after);
      low.push_back(logarithmic ? std::exp(a) : a);
      high.push_back(logarithmic ? std::exp(b) : b);
    }
    if (by_number || zero_first) {
      std::string list;
      const auto tic = [&](double place, const std::string& text) {
        list += (list.empty() ? "'" : ", '") + text + "' " + out(place);
      };
      for (std::size_t i = 0; i < n; ++i) {
        const double decade = std::log10(std::abs(v[i]));
        const long whole = std::lround(decade);
        if (v[i] == 0.0)
          tic(at[i], "0");
        else if (by_number ? whole == -3 || whole == -9
                           : std::abs(decade - static_cast<double>(whole)) < 1e-9)
          tic(at[i], (v[i] < 0 ? "-1e" : "1e") + std::to_string(whole));
      }
      if (by_number) tic(0.5 * (at.front() + at.back()), "-+1e-15");
      tics = "(" + list + ")";
    } else if (logarithmic && high.back() < 1000.0 * low.front()) {
      tics = "(" + tics_1_2_5(low.front(), high.back()) + ")";
    }
  }
};

void draw(const std::string& path, const std::vector<const FinishedMap*>& maps) {
  std::ostringstream out;
  out << "set multiplot\nunset key\nset border 3\nset style fill solid 1.0 noborder\n";
  constexpr int kWidth = 1080, kHeight = 720;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const StabilityMap& map = maps[i]->map;
    const DrawnAxis x(map.x), y(map.y);
    std::string cells;
    for (std::size_t iy = 0; iy < map.y.values.size(); ++iy)
      for (std::size_t ix = 0; ix < map.x.values.size(); ++ix) {
        const char* colour = kColours[static_cast<std::size_t>(maps[i]->at(ix, iy).verdict)];
        cells += digits(std::sqrt(x.low[ix]) * std::sqrt(x.high[ix])) + " 0 " + digits(x.low[ix]) +
                 " " + digits(x.high[ix]) + " " + digits(y.low[iy]) + " " + digits(y.high[iy]) +
                 " 0x" + (colour + 1) + "\n";
      }
    const std::string tag = "$M" + std::to_string(i);
    out << data_block(tag, cells);
    std::string lines;
    int number = 0;
    for (const auto& border : dynamics::borders(map)) {
      std::string rows;
      for (std::size_t k = 0; k < border.x.size(); ++k)
        rows += digits(border.x[k]) + " " + digits(border.y[k]) + "\n";
      const std::string name = tag + "B" + std::to_string(number);
      out << data_block(name, rows);
      lines += ", " + name + " using 1:2 with linespoints lw 2 pt 7 ps 0.2 lc rgb 'black' dt " +
               std::to_string(++number) + " title " + literal(border.label);
    }
    const double left = 0.08 + 0.32 * static_cast<double>(i % 3), right = left + 0.24;
    const double top = i < 3 ? 0.86 : 0.385, bottom = top - 0.29;
    out << "set lmargin at screen " << left << "\nset rmargin at screen " << right
        << "\nset tmargin at screen " << top << "\nset bmargin at screen " << bottom
        << "\nset title " << literal(map.method) << " offset 0,1.5\n"
        << "set xlabel " << literal(map.x.label) << "\nset ylabel " << literal(map.y.label) << "\n"
        << (x.logarithmic ? "set logscale x\nset format x '10^{%L}'\n"
                          : "unset logscale x\nset format x '%g'\n")
        << (y.logarithmic ? "set logscale y\nset format y '10^{%L}'\n"
                          : "unset logscale y\nset format y '%g'\n")
        << "set xtics nomirror out font ',10' " << (x.tics.empty() ? "autofreq" : x.tics) << "\n"
        << "set ytics nomirror out " << (y.tics.empty() ? "autofreq" : y.tics) << "\n"
        << "set xrange [" << digits(x.low.front()) << ":" << digits(x.high.back())
        << "]\nset yrange [" << digits(y.low.front()) << ":" << digits(y.high.back()) << "]\n"
        << (lines.empty()
                ? "unset key\n"
                : "set key at graph 0.5, graph 1.1 center horizontal font ',9' samplen 2\n");
    if (i == 0)
      out << "set label 1 " << literal(map.title) << " at screen 0.02, screen 0.965 font ',16'\n";
    if (i + 1 == maps.size()) {  // the legend, in the place of the sixth panel
      int label = 10;
      for (std::size_t v = 0; v < kColours.size(); ++v) {
        const bool seen = std::any_of(maps.begin(), maps.end(), [v](const FinishedMap* m) {
          return m->count(static_cast<Verdict>(v)) > 0;
        });
        if (!seen) continue;
        const double row = 0.36 - 0.035 * (label - 10);
        out << "set label " << label++ << " " << literal(dynamics::kVerdictNames[v])
            << " at screen 0.74, screen " << row << " left point pt 5 ps 2 lc rgb '" << kColours[v]
            << "' offset 1.5,0\n";
      }
    }
    out << "plot " << tag << " using 1:2:3:4:5:6:7 with boxxyerror lc rgb variable notitle" << lines
        << "\n"
        << "unset label\n";
  }
  out << "unset multiplot\n";
  draw_svg(path, kWidth, kHeight, out.str());
}

// ---- Files and table ----

std::string csv_of(const std::vector<FinishedMap>& maps) {
  std::ostringstream out;
  out << "map,method,x_name,x,y_name,y,status,trials,not_finite,cut_short,penetrating,creating_"
         "energy,too_fast,"
         "beyond_bound,contacts_without_formula,forced_holds,steps,evaluations,worst_penetration_m,"
         "worst_energy_created_J,worst_speed_m_per_s\n";
  for (const FinishedMap& m : maps)
    for (std::size_t iy = 0; iy < m.map.y.values.size(); ++iy)
      for (std::size_t ix = 0; ix < m.map.x.values.size(); ++ix) {
        const MapPoint& p = m.at(ix, iy);
        const dynamics::Health& h = p.health;
        out << m.map.name << ',' << m.map.method << ',' << m.map.x.name << ','
            << digits(m.map.x.values[ix]) << ',' << m.map.y.name << ','
            << digits(m.map.y.values[iy]) << ',' << dynamics::name_of(p.verdict) << ',' << h.runs
            << ',' << h.broken << ',' << p.cut_short << ',' << h.penetrating << ','
            << h.creating_energy << ',' << h.fast << ',' << h.unstable << ','
            << h.undefined_contacts << ',' << h.forced_holds << ',' << h.steps << ','
            << h.evaluations << ',' << digits(h.worst_penetration) << ','
            << digits(h.worst_energy_created) << ',' << digits(h.worst_speed) << '\n';
      }
  return out.str();
}

Json to_json(const FinishedMap& m) {
  Json j;
  j["map"] = m.map.name;
  j["method"] = m.map.method;
  j["x"] = {{"name", m.map.x.name}, {"values", m.map.x.values}};
  j["y"] = {{"name", m.map.y.name}, {"values", m.map.y.values}};
  j["status"] = Json::array();
  for (std::size_t iy = 0; iy < m.map.y.values.size(); ++iy) {
    Json row = Json::array();
    for (std::size_t ix = 0; ix < m.map.x.values.size(); ++ix)
      row.push_back(dynamics::name_of(m.at(ix, iy).verdict));
    j["status"].push_back(std::move(row));
  }
  j["borders"] = Json::array();
  for (const auto& b : dynamics::borders(m.map))
    j["borders"].push_back({{"label", b.label}, {"x", b.x}, {"y", b.y}});
  return j;
}

std::string table_of(const std::vector<FinishedMap>& maps) {
  std::vector<Verdict> seen;
  for (std::size_t v = 0; v < dynamics::kVerdictNames.size(); ++v)
    if (std::any_of(maps.begin(), maps.end(),
                    [v](const FinishedMap& m) { return m.count(static_cast<Verdict>(v)) > 0; }))
      seen.push_back(static_cast<Verdict>(v));
  std::ostringstream out;
  out << "Points of each map by the worst that their " << dynamics::kTrialsPerPoint
      << " trials showed\n\n"
      << padded("", -35);
  for (const Verdict v : seen) out << padded(std::string(dynamics::name_of(v)), 13);
  out << "\n";
  for (const FinishedMap& m : maps) {
    out << padded(std::string(m.map.name), -24) << padded(m.map.method, -11);
    for (const Verdict v : seen) {
      const std::int64_t n = m.count(v);
      out << padded(n > 0 ? std::to_string(n) : ".", 13);
    }
    out << "\n";
  }
  return out.str();
}

std::string figure_name(const StabilityMap& map) { return std::string(map.name) + ".svg"; }

}  // namespace

int run_stability(const std::vector<std::string>& arguments) {
  Options options(
      "stability -o DIR [options]",
      "Maps where each method breaks: step and stiffness, step and damping, restitution and\n"
      "impulse threshold, first contact near a joint, grazing a tip. Writes stability.csv,\n"
      "stability.json and a figure per map. The maps have scenes of their own; for a scene of\n"
      "yours there are gatewalk chart and run.method = \"auto\".",
      "gatewalk stability -o results/stability --quick");
  std::vector<std::string> written{"stability.csv", "stability.json"};
  for (int kind = 0; kind < dynamics::kMapKinds; ++kind)
    written.push_back(figure_name(dynamics::stability_map(
        static_cast<dynamics::MapKind>(kind), dynamics::chart_methods().front(), true)));
  options.output_folder("folder to write to", written);
  options.add()("quick", "coarser maps");
  add_seed(options);
  options.without_scene("the maps have scenes of their own");
  if (!options.parse(arguments)) return kFine;
  const std::string folder = options.text("output");
  const auto file = [&](const std::string& name) {
    return (std::filesystem::path(folder) / name).string();
  };
  std::vector<StabilityMap> planned;
  std::vector<std::string> figures;  // one for each kind
  for (int kind = 0; kind < dynamics::kMapKinds; ++kind) {
    for (const auto method : dynamics::chart_methods())
      planned.push_back(dynamics::stability_map(static_cast<dynamics::MapKind>(kind), method,
                                                options.has("quick")));
    figures.push_back(file(figure_name(planned.back())));
  }
  require_folder(folder);

  std::vector<FinishedMap> maps;
  for (const StabilityMap& map : planned) maps.push_back(run_map(options, map));

  Json json;
  json["trials_per_point"] = dynamics::kTrialsPerPoint;
  json["work_granted_per_point"] = dynamics::kMostWorkPerPoint;
  json["holds_share"] = dynamics::Health::kPermittedHolds;
  json["maps"] = Json::array();
  for (const FinishedMap& m : maps) json["maps"].push_back(to_json(m));
  json["made_by"] = {{"program", "gatewalk"},
                     {"version", kVersion},
                     {"commit", kCommit},
                     {"command", options.canonical()},
                     {"seed", options.seed()}};
  // Old figures shall not stand beside new numbers.
  for (const std::string& figure : figures) std::filesystem::remove(figure);
  write_text_atomically(file("stability.csv"), csv_of(maps));
  write_text_atomically(file("stability.json"), text_of(json) + "\n");
  const std::size_t methods = dynamics::chart_methods().size();
  for (std::size_t kind = 0; kind < figures.size(); ++kind) {
    std::vector<const FinishedMap*> panels;
    for (std::size_t i = 0; i < methods; ++i) panels.push_back(&maps[kind * methods + i]);
    draw(figures[kind], panels);
  }
  double slowest = 0.0;
  for (const FinishedMap& m : maps)
    slowest = std::max(slowest, *std::max_element(m.seconds.begin(), m.seconds.end()));
  options.give_out(json, table_of(maps));
  remark(options, "the slowest point took " + fixed(slowest, 2) + " s");
  return kFine;
}

}  // namespace gatewalk::cli
