#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "cli/paper/figures.h"
#include "cli/render/figure.h"
#include "cli/render/json.h"
#include "cli/render/provenance.h"
#include "cli/render/text.h"
#include "cli/terminal/gnuplot.h"
#include "cli/terminal/output.h"
#include "cli/web/html.h"

namespace gatewalk::cli {
namespace {

constexpr double kSpacing = 1.0;  // m, of drawn landscapes

}  // namespace

void draw(const std::string& name, int width, int height, const std::string& script) {
  for (const char* end : {".svg", ".pdf"})
    draw(name + end, Figure{width, height, script}, {name, "gatewalk reproduce"});
}

std::string line_of(const std::vector<double>& values) {
  std::string line;
  for (const double x : values) line += (line.empty() ? "" : " ") + digits(x);
  return line + "\n";
}

Json rounded(double x, double unit) {
  if (!std::isfinite(x)) return nullptr;
  // Through text: a multiple of 0.1 shall be written as one.
  return std::strtod(digits(std::round(x / unit) * unit).c_str(), nullptr);
}

Json surface_of(const dynamics::GateParams& p, bool with_propulsion,
                dynamics::BeamsThatPush beams) {
  const dynamics::Landscape l = dynamics::landscape(p, 0.0, kSpacing, beams);
  const auto& e = with_propulsion ? l.total : l.elastic;
  Json s{{"x", Json::array()}, {"y", Json::array()}, {"z", Json::array()}};
  for (const double x : l.x) s["x"].push_back(rounded(x, 1e-3));
  for (std::size_t i = 0; i < l.y.size(); ++i) {
    s["y"].push_back(rounded(l.y[i], 1e-3));
    Json row = Json::array();
    for (std::size_t j = 0; j < l.x.size(); ++j) row.push_back(rounded(e(i, j), 0.1));
    s["z"].push_back(std::move(row));
  }
  return s;
}

/// The surface as blocks that gnuplot's pm3d reads, cut at the ceiling.
std::string blocks_of(const Json& surface, double ceiling) {
  std::string rows;
  const Json &x = surface["x"], &y = surface["y"], &z = surface["z"];
  for (std::size_t i = 0; i < y.size(); ++i) {
    for (std::size_t j = 0; j < x.size(); ++j) {
      const double e = z[i][j].is_number() ? std::min(z[i][j].get<double>(), ceiling) : ceiling;
      rows += x[j].dump() + " " + y[i].dump() + " " + digits(e) + "\n";
    }
    rows += "\n";
  }
  return rows;
}

std::string tics_of(const std::vector<std::string>& names) {
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string quoted = literal(names[i]);
    list +=
        (i ? ", " : "") + quoted.substr(0, quoted.rfind(" noenhanced")) + " " + std::to_string(i);
  }
  return "set ytics (" + list + ") noenhanced";
}

Json to_json(const std::vector<Rate>& rates) {
  Json rows = Json::array();
  for (const Rate& r : rates)
    rows.push_back({{"label", r.label},
                    {"group", r.group},
                    {"value", r.share.value},
                    {"low", r.share.low},
                    {"high", r.share.high}});
  return rows;
}

void draw_rates(const std::string& name, const std::vector<Rate>& rates, double mark,
                const std::string& mark_label, const std::string& title, double most) {
  std::string lines;
  std::vector<std::string> names;
  for (const Rate& r : rates) {
    lines += std::to_string(names.size()) + " " +
             line_of({100 * r.share.value, 100 * r.share.low, 100 * r.share.high});
    names.push_back(r.group + ": " + r.label);
  }
  const std::size_t n = names.size();
  draw(name, 1000, static_cast<int>(140 + 17 * n),
       data_block("$rates", lines) + filled(R"(
set title '{{title}}' offset 0,1
set yrange [{{n}}:-1]
{{tics}} font ',9'
set xlabel '%'
set xrange [-0.01*{{most}}:{{most}}]
set grid x
unset key
set arrow from {{mark}},graph 0 to {{mark}},graph 1 nohead dt 2 lw 2 lc rgb '#d55e00'
set label {{label}} at {{mark}},graph 1.02 center tc rgb '#d55e00'
set tmargin 5
plot $rates using 2:1:3:4 with xerrorbars pt 7 ps 0.6 lc rgb '#0072b2'
)",
                                            {{"title", title},
                                             {"n", std::to_string(n)},
                                             {"tics", tics_of(names)},
                                             {"most", digits(most)},
                                             {"mark", digits(mark)},
                                             {"label", literal(mark_label)}}));
}

}  // namespace gatewalk::cli
