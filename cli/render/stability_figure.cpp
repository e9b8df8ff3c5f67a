#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "cli/render/figure.h"
#include "cli/render/stability.h"
#include "cli/render/text.h"

namespace gatewalk::cli {
namespace {

using dynamics::FinishedMap;
using dynamics::MapAxis;
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

/// An axis as gnuplot draws it. Grazing's delta runs over both signs and 24 decades: it is drawn by
/// number. A zero on a logarithmic axis stands one place below the first value.
struct DrawnAxis {
  std::vector<double> low, high;  // edges of each value's cell
  bool logarithmic, by_number;
  std::string tics;

  explicit DrawnAxis(const MapAxis& axis)
      : logarithmic(axis.logarithmic && axis.values.front() >= 0.0),
        by_number(axis.logarithmic && !logarithmic) {
    const std::vector<double>& v = axis.values;
    std::vector<double> at = v;  // places, in the measure in which cells are even
    for (std::size_t i = 0; i < v.size(); ++i)
      if (by_number)
        at[i] = static_cast<double>(i);
      else if (logarithmic && v[i] > 0.0)
        at[i] = std::log(v[i]);
    const bool zero_first = logarithmic && v.front() == 0.0;
    if (zero_first) at[0] = 2 * at[1] - at[2];
    set_edges(at);
    if (by_number || zero_first)
      tics = "(" + tics_by_hand(v, at) + ")";
    else if (logarithmic && high.back() < 1000.0 * low.front())
      tics = "(" + tics_1_2_5(low.front(), high.back()) + ")";
  }

  [[nodiscard]] double drawn(double place) const { return logarithmic ? std::exp(place) : place; }

  void set_edges(const std::vector<double>& at) {
    const std::size_t n = at.size();
    for (std::size_t i = 0; i < n; ++i) {
      const double before = i > 0 ? at[i - 1] : 2 * at[0] - at[1];
      const double after = i + 1 < n ? at[i + 1] : 2 * at[n - 1] - at[n - 2];
      low.push_back(drawn(0.5 * (before + at[i])));
      high.push_back(drawn(0.5 * (at[i] + after)));
    }
  }

  /// Zero and whole decades, of an axis by number only two of them and the middle.
  [[nodiscard]] std::string tics_by_hand(const std::vector<double>& v,
                                         const std::vector<double>& at) const {
    std::string list;
    const auto tic = [&](double place, const std::string& text) {
      list += (list.empty() ? "'" : ", '") + text + "' " + digits(drawn(place));
    };
    for (std::size_t i = 0; i < v.size(); ++i) {
      const double decade = std::log10(std::abs(v[i]));
      const long whole = std::lround(decade);
      if (v[i] == 0.0)
        tic(at[i], "0");
      else if (by_number ? whole == -3 || whole == -9
                         : std::abs(decade - static_cast<double>(whole)) < 1e-9)
        tic(at[i], (v[i] < 0 ? "-1e" : "1e") + std::to_string(whole));
    }
    if (by_number) tic(0.5 * (at.front() + at.back()), "-+1e-15");
    return list;
  }
};

/// A box for each point, for boxxyerror.
std::string cells_of(const FinishedMap& m, const DrawnAxis& x, const DrawnAxis& y) {
  std::string cells;
  for (std::size_t iy = 0; iy < m.map.y.values.size(); ++iy)
    for (std::size_t ix = 0; ix < m.map.x.values.size(); ++ix) {
      const char* colour = kColours[static_cast<std::size_t>(m.at(ix, iy).verdict)];
      cells += digits(std::sqrt(x.low[ix]) * std::sqrt(x.high[ix])) + " 0 " + digits(x.low[ix]) +
               " " + digits(x.high[ix]) + " " + digits(y.low[iy]) + " " + digits(y.high[iy]) +
               " 0x" + (colour + 1) + "\n";
    }
  return cells;
}

/// Known borders of a map: their data blocks, and what to add to `plot` for them.
struct BorderLines {
  std::string blocks, elements;
};
BorderLines borders_of(const dynamics::StabilityMap& map, const std::string& tag) {
  BorderLines lines;
  int number = 0;
  for (const auto& border : dynamics::borders(map)) {
    std::string rows;
    for (std::size_t k = 0; k < border.x.size(); ++k)
      rows += digits(border.x[k]) + " " + digits(border.y[k]) + "\n";
    const std::string name = tag + "B" + std::to_string(number);
    lines.blocks += data_block(name, rows);
    lines.elements += ", " + name +
                      " using 1:2 with linespoints lw 2 pt 7 ps 0.2 lc rgb 'black' dt " +
                      std::to_string(++number) + " title " + literal(border.label);
  }
  return lines;
}

/// In the place of the sixth panel: the verdicts that any of the maps has.
std::string legend(std::span<const FinishedMap> maps) {
  std::ostringstream out;
  int label = 10;
  for (std::size_t v = 0; v < kColours.size(); ++v) {
    const bool seen = std::any_of(maps.begin(), maps.end(), [v](const FinishedMap& m) {
      return m.count(static_cast<Verdict>(v)) > 0;
    });
    if (!seen) continue;
    const double row = 0.36 - 0.035 * (label - 10);
    out << "set label " << label++ << " " << literal(dynamics::kVerdictNames[v])
        << " at screen 0.74, screen " << row << " left point pt 5 ps 2 lc rgb '" << kColours[v]
        << "' offset 1.5,0\n";
  }
  return out.str();
}

/// Place, title and axes of panel i, of two rows of three.
std::string frame(const dynamics::StabilityMap& map, std::size_t i, const DrawnAxis& x,
                  const DrawnAxis& y, bool key) {
  std::ostringstream out;
  const double left = 0.08 + 0.32 * static_cast<double>(i % 3), right = left + 0.24;
  const double top = i < 3 ? 0.86 : 0.385, bottom = top - 0.29;
  out << "set lmargin at screen " << left << "\nset rmargin at screen " << right
      << "\nset tmargin at screen " << top << "\nset bmargin at screen " << bottom << "\nset title "
      << literal(map.method) << " offset 0,1.5\n"
      << "set xlabel " << literal(map.x.label) << "\nset ylabel " << literal(map.y.label) << "\n"
      << (x.logarithmic ? "set logscale x\nset format x '10^{%L}'\n"
                        : "unset logscale x\nset format x '%g'\n")
      << (y.logarithmic ? "set logscale y\nset format y '10^{%L}'\n"
                        : "unset logscale y\nset format y '%g'\n")
      << "set xtics nomirror out font ',10' " << (x.tics.empty() ? "autofreq" : x.tics) << "\n"
      << "set ytics nomirror out " << (y.tics.empty() ? "autofreq" : y.tics) << "\n"
      << "set xrange [" << digits(x.low.front()) << ":" << digits(x.high.back())
      << "]\nset yrange [" << digits(y.low.front()) << ":" << digits(y.high.back()) << "]\n"
      << (key ? "set key at graph 0.5, graph 1.1 center horizontal font ',9' samplen 2\n"
              : "unset key\n");
  return out.str();
}

}  // namespace

Figure figure_of(std::span<const FinishedMap> maps) {
  std::ostringstream out;
  out << "set multiplot\nunset key\nset border 3\nset style fill solid 1.0 noborder\n";
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const dynamics::StabilityMap& map = maps[i].map;
    const DrawnAxis x(map.x), y(map.y);
    const std::string tag = "$M" + std::to_string(i);
    const BorderLines lines = borders_of(map, tag);
    out << data_block(tag, cells_of(maps[i], x, y)) << lines.blocks
        << frame(map, i, x, y, !lines.elements.empty());
    if (i == 0)
      out << "set label 1 " << literal(map.title) << " at screen 0.02, screen 0.965 font ',16'\n";
    if (i + 1 == maps.size()) out << legend(maps);
    out << "plot " << tag << " using 1:2:3:4:5:6:7 with boxxyerror lc rgb variable notitle"
        << lines.elements << "\n"
        << "unset label\n";
  }
  out << "unset multiplot\n";
  return {.width = 1080, .height = 720, .commands = out.str()};
}

}  // namespace gatewalk::cli
