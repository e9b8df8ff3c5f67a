#include <algorithm>
#include <cmath>
#include <sstream>

#include "cli/render/figure.h"
#include "cli/render/landscape.h"
#include "cli/render/quantity.h"
#include "cli/render/text.h"

namespace gatewalk::cli {
namespace {

/// 1, 2 or 5 times a power of ten that cuts `span` into about `parts`.
double tic_step(double span, double parts) {
  const double wanted = span / parts, power = std::pow(10.0, std::floor(std::log10(wanted)));
  double best = power;
  for (const double k : {2.0, 5.0, 10.0})
    if (std::abs(k * power - wanted) < std::abs(best - wanted)) best = k * power;
  return best;
}

/// What is drawn, in units that read well, up to a ceiling.
class Drawn {
 public:
  Drawn(const dynamics::Landscape& l, double ceiling)
      : ceiling_(ceiling),
        metre_(readable_unit("m", std::max(l.x.back(), l.y.back() - l.y.front()))),
        joule_(readable_unit("J", ceiling)) {}

  [[nodiscard]] std::string length(double x) const { return digits(in_units(x)); }
  [[nodiscard]] double in_units(double x) const { return x / metre_.size; }
  [[nodiscard]] std::string energy(double e) const {
    return digits(std::min(e, ceiling_) / joule_.size);
  }

  /// Rows of "x y elastic total", an empty one between two values of y.
  [[nodiscard]] std::string rows(const dynamics::Landscape& l) const {
    std::ostringstream rows;
    // No more points than can be seen.
    const std::size_t stride = std::max<std::size_t>(1, std::max(l.x.size(), l.y.size()) / 150);
    for (std::size_t i = 0; i < l.y.size(); i += stride) {
      for (std::size_t j = 0; j < l.x.size(); j += stride)
        rows << length(l.x[j]) << ' ' << length(l.y[i]) << ' ' << energy(l.elastic(i, j)) << ' '
             << energy(l.total(i, j)) << '\n';
      rows << '\n';
    }
    return rows.str();
  }

  /// Labels, ranges and colours that all four panels have.
  [[nodiscard]] std::string axes(const dynamics::Landscape& l) const {
    const std::string top = energy(ceiling_);
    return "set xlabel 'x (" + metre_.name + ")'\nset ylabel 'y (" + metre_.name +
           ")'\nset cblabel '" + joule_.name + "'\nset pm3d\nunset key\nset xrange [" +
           length(l.x.front()) + ":" + length(l.x.back()) + "]\nset yrange [" +
           length(l.y.front()) + ":" + length(l.y.back()) + "]\nset cbrange [0:" + top +
           "]\nset zrange [0:" + top +
           "]\n"
           "set palette defined (0 '#30123b', 1 '#4145ab', 2 '#4675ed', 3 '#39a2fc', 4 '#1bcfd4', "
           "5 '#24eca6', 6 '#61fc6c', 7 '#a4fc3b', 8 '#d1e834', 9 '#f3c63a', 10 '#fe9b2d', "
           "11 '#f36315', 12 '#d93806', 13 '#7a0403')\n"
           "set xyplane 0\nset xtics " +
           digits(tic_step(in_units(l.x.back() - l.x.front()), 5.0)) + "\n";
  }

 private:
  double ceiling_;  // J
  Sized metre_, joule_;
};

/// A panel on the left: column `column` of $grid as a surface; `deep`: extent of y as drawn.
std::string surface(const char* title, int column, double deep, const char* origin) {
  return std::string("unset colorbox\nset size noratio\nset size 0.52,0.52\nset origin ") + origin +
         "\nset lmargin 6\nset rmargin 2\nset tmargin 2\nset bmargin 2\nset view "
         "58,330,0.95\nset title '" +
         title + "'\nset ytics " + digits(tic_step(deep, 3.0)) +
         "\nsplot $grid using 1:2:" + std::to_string(column) + " with pm3d\n";
}

/// A panel on the right, without its plot.
std::string from_above(const char* title, double deep, const char* origin) {
  return std::string("set colorbox\nset size 0.48,0.5\nset size ratio -1\nset origin ") + origin +
         "\nset lmargin 8\nset rmargin 10\nset tmargin 2\nset bmargin 4\nset title '" + title +
         "'\nset ytics " + digits(tic_step(deep, 6.0)) + "\n";
}

/// Beside the joints the beams' energy leaves every scale; what matters lies lower (J).
double ceiling_of(const dynamics::GateParams& p) {
  const double stiffer = std::max(p.beams.stiffness_left, p.beams.stiffness_right);
  return 1.2 * stiffer + p.forces.propulsion * (20.0 * dynamics::scale_of(p).length);
}

}  // namespace

Figure figure_of(const dynamics::Passes& passes, const dynamics::GateParams& p) {
  const dynamics::Landscape& l = passes.coarse.landscape;
  const dynamics::Pass& pass =
      passes.fine.downhill() ? passes.fine.from_start : passes.fine.from_basin;
  const Drawn drawn(l, ceiling_of(p));
  std::string way;
  for (const auto& [x, y] : pass.way) way += drawn.length(x) + " " + drawn.length(y) + "\n";
  const double deep = drawn.in_units(l.y.back() - l.y.front());
  return {1100, 950,
          data_block("$grid", drawn.rows(l)) + data_block("$way", way) + "set multiplot\n" +
              drawn.axes(l) + surface("elastic energy, Eq. (14)", 3, deep, "0.0,0.49") +
              from_above("the same from above", deep, "0.52,0.5") +
              "plot $grid using 1:2:3 with image\n" +
              surface("with the propulsion, Eq. (15)", 4, deep, "0.0,-0.01") +
              from_above("lowest way through (white), its highest point", deep, "0.52,0.0") +
              "plot $grid using 1:2:4 with image, $way using 1:2 with lines lw 2 lc rgb '#ffffff', "
              "'-' using 1:2 with points pt 7 ps 1 lc rgb '#ff00ff'\n" +
              drawn.length(pass.x) + " " + drawn.length(pass.y) + "\ne\nunset multiplot\n"};
}

}  // namespace gatewalk::cli
