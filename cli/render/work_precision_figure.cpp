#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <set>
#include <sstream>

#include "cli/render/figure.h"
#include "cli/render/text.h"
#include "cli/render/work_precision.h"

namespace gatewalk::cli {
namespace {

using dynamics::ChartPoint;
using dynamics::StrongError;
using dynamics::Verdict;
using dynamics::WorkPrecision;

char letter_of(Verdict v) {
  switch (v) {
    case Verdict::penetration:
      return 'P';
    case Verdict::energy:
      return 'E';
    case Verdict::too_fast:
      return 'F';
    case Verdict::beyond_bound:
      return 'B';
    case Verdict::no_formula:
      return 'N';
    case Verdict::stuck:
      return 'S';
    case Verdict::not_finite:
      return 'X';
    default:
      return '?';
  }
}

/// Settings that have no place in a panel, with the reason: "paper 0.02 to 0.005 s: not finite".
std::vector<std::string> strip(
    const std::vector<std::pair<const ChartPoint*, std::string>>& without) {
  std::vector<std::string> lines;
  constexpr std::size_t kLongest = 95;  // letters that a panel is wide
  for (std::size_t i = 0; i < without.size();) {
    const auto& [first, reason] = without[i];
    std::size_t last = i;  // of a run of neighbours in the list with the same reason
    while (last + 1 < without.size() && without[last + 1].first == without[last].first + 1 &&
           without[last + 1].first->setting.method == first->setting.method &&
           without[last + 1].second == reason)
      ++last;
    const auto value = [](const ChartPoint* p) {
      char text[16];
      std::snprintf(text, sizeof text, "%.3g", p->setting.value);
      return std::string(text);
    };
    const std::string text = first->setting.method + " " + value(first) +
                             (last > i ? " to " + value(without[last].first) : "") + " " +
                             first->setting.unit() + ": " + reason;
    if (lines.empty() || lines.back().size() + text.size() > kLongest)
      lines.push_back(lines.empty() ? "no point: " + text : text);
    else
      lines.back() += "; " + text;
    i = last + 1;
  }
  return lines;
}

/// Why a setting that ran has no strong error.
std::string lacks(const StrongError& e, double limit) {
  if (std::isinf(limit)) return "the reference itself parted";
  if (e.compared > 0) return "half or more parted";
  return e.parted > 0 ? "all parted" : "no exits";
}

/// A point's error, its standard error, and what it must reach to be told from no error.
struct Drawn {
  double error, spread, bound;
};

/// One panel: least time per trial against error. What is below its bound is drawn there, as less
/// than that.
class Panel {
 public:
  /// `tag` makes names of data blocks; `limit` is the bound that the reference sets to all, `own`
  /// its error.
  Panel(const WorkPrecision& chart, std::string tag, double limit, double own,
        const std::function<Drawn(const ChartPoint&)>& value)
      : tag_(std::move(tag)), limit_(limit), lowest_(limit), highest_(limit) {
    std::vector<std::string> methods;
    for (const ChartPoint& p : chart.points)
      if (std::find(methods.begin(), methods.end(), p.setting.method) == methods.end())
        methods.push_back(p.setting.method);
    for (const std::string& method : methods) add_method(chart, method, value);
    if (separator_ == "plot ") {
      plot_ << "plot [1:10] [0.1:1] NaN";
      return;
    }
    if (limit > 0.0 && std::isfinite(limit))
      element(digits(limit) + " with lines dt 2 lw 1 lc rgb '#666666'");
    if (own > 0.0 && own >= 0.01 * lowest_) {
      element(digits(own) + " with lines dt 3 lw 1 lc rgb '#666666'");
      lowest_ = std::min(lowest_, own);
    }
  }

  [[nodiscard]] std::string text(const std::string& title, const std::string& label) const {
    std::ostringstream out;
    const std::vector<std::string> lines = strip(without_);
    out << blocks_.str() << "unset label\nset title " << literal(title) << " offset 0,"
        << 0.3 + 0.8 * static_cast<double>(lines.size()) << "\nset ylabel " << literal(label)
        << "\n";
    for (std::size_t i = 0; i < lines.size(); ++i)
      out << "set label " << 11 + i << " " << literal(lines[i]) << " at graph 0, graph "
          << 1.03 + 0.045 * static_cast<double>(lines.size() - 1 - i)
          << " font ',8' tc rgb '#444444'\n";
    if (limit_ > 0.0 && slowest_ > 0.0)
      out << "set label 10 'below: not told from the reference' at graph 0.99, first "
          << digits(limit_) << " right offset 0,-0.6 font ',8' tc rgb '#666666'\n";
    if (slowest_ > 0.0)
      out << "set xrange [" << digits(quickest_ / 1.5) << ":" << digits(slowest_ * 1.5)
          << "]\nset xtics nomirror (" << tics_1_2_5(quickest_ / 1.5, slowest_ * 1.5)
          << ")\nset yrange [" << digits(lowest_ / 2.5) << ":" << digits(highest_ * 2.0) << "]\n";
    out << plot_.str() << "\n";
    return out.str();
  }

 private:
  /// Rows of a method's data blocks: "time error ...".
  struct Rows {
    std::string line, good, bars, failed, below, usual;

    void add(const ChartPoint& p, double time, const Drawn& drawn) {
      const auto [error, spread, bound] = drawn;
      const std::string x_y = digits(time) + " " + digits(std::max(error, bound));
      line += x_y + "\n";
      const bool fails = p.verdict != Verdict::fine;
      if (fails) failed += x_y + " " + letter_of(p.verdict) + "\n";
      if (error < bound)
        below += x_y + "\n";
      else if (!fails)
        good += x_y + "\n";
      if (error >= bound && std::isfinite(spread))
        bars += x_y + " " + digits(std::max(error - 2 * spread, 0.1 * error)) + " " +
                digits(error + 2 * spread) + "\n";
      if (p.setting.usual) usual += x_y + "\n";
    }
  };

  void add_method(const WorkPrecision& chart, const std::string& method,
                  const std::function<Drawn(const ChartPoint&)>& value) {
    Rows rows;
    for (const ChartPoint& p : chart.points) {
      if (p.setting.method != method) continue;
      const Drawn drawn = value(p);
      if (!p.ran() || !std::isfinite(drawn.error) || !std::isfinite(drawn.bound)) {
        without_.emplace_back(&p, p.ran() ? lacks(p.errors.strong, limit_)
                                          : std::string(dynamics::name_of(p.verdict)));
        continue;
      }
      const double time = p.least_microseconds(), y = std::max(drawn.error, drawn.bound);
      quickest_ = std::min(quickest_, time);
      slowest_ = std::max(slowest_, time);
      lowest_ = std::min(lowest_, y);
      highest_ = std::max(highest_, y);
      rows.add(p, time, drawn);
    }
    if (!rows.line.empty()) plot_method(method, rows);
  }

  void plot_method(const std::string& method, const Rows& rows) {
    const Look look = look_of(method);
    const std::string colour = std::string(" lc rgb '") + look.colour + "'";
    const auto block = [&](const char* kind, const std::string& lines) {
      const std::string name = "$" + tag_ + "_" + method + "_" + kind;
      blocks_ << data_block(name, lines);
      return name;
    };
    element(block("line", rows.line) + " using 1:2 with lines lw 1.2" + colour);
    if (!rows.bars.empty())
      element(block("bars", rows.bars) + " using 1:2:3:4 with yerrorbars pt 0 lw 0.8" + colour);
    if (!rows.good.empty())
      element(block("good", rows.good) + " using 1:2 with points ps 0.8 pt " +
              std::to_string(look.marker) + colour);
    if (!rows.below.empty())
      element(block("below", rows.below) + " using 1:2 with points pt 10 ps 1.1 lw 1.5" + colour);
    if (!rows.failed.empty()) {
      const std::string name = block("failed", rows.failed);
      element(name + " using 1:2 with points pt 2 ps 0.8 lw 1.8" + colour);
      element(name + " using 1:2:3 with labels font ',8' offset 0.7,0.5 tc rgb '" + look.colour +
              "'");
    }
    if (!rows.usual.empty())
      element(block("usual", rows.usual) +
              " using 1:2 with points pt 6 ps 1.8 lw 1.2 lc rgb 'black'");
  }

  void element(const std::string& text) {
    plot_ << separator_ << text;
    separator_ = ", ";
  }

  std::string tag_, separator_ = "plot ";
  double limit_, lowest_, highest_;
  double quickest_ = std::numeric_limits<double>::infinity(), slowest_ = 0.0;
  std::ostringstream blocks_, plot_;
  std::vector<std::pair<const ChartPoint*, std::string>> without_;
};

/// On top of the first row, drawn with a plot that has nothing else.
std::string legend(const WorkPrecision& chart, int height) {
  std::ostringstream out;
  out << "set lmargin at screen 0\nset rmargin at screen 1\nset tmargin at screen 1\n"
         "set bmargin at screen 0\nunset border\nunset tics\nunset xlabel\n";
  double x = 0.02;
  const double y = 1.0 - 16.0 / height;
  int label = 10;
  const auto entry = [&](const std::string& text, const std::string& point, double width) {
    out << "set label " << label++ << " " << literal(text) << " at screen " << x << ", screen " << y
        << " left point " << point << " offset 1,0\n";
    x += width;
  };
  std::set<std::string> drawn;
  for (const ChartPoint& p : chart.points) {
    if (!drawn.insert(p.setting.method).second) continue;
    const Look look = look_of(p.setting.method);
    entry(p.setting.method,
          "pt " + std::to_string(look.marker) + " ps 0.8 lc rgb '" + look.colour + "'", 0.085);
  }
  entry("usual: the method's default", "pt 6 ps 1.8 lc rgb 'black'", 0.21);
  entry("less: below what the reference or chance can show", "pt 10 ps 1.1 lc rgb '#444444'", 0.3);
  out << "set label " << label++ << " "
      << literal(
             "x fails: E energy from nothing, P disc sinks into a beam, F too fast for its steps, "
             "S stuck, N contact without a formula, B beyond the stability bound, X not finite. "
             "Bars: 2 standard errors.")
      << " at screen 0.016, screen " << 1.0 - 40.0 / height << " font ',10'\n"
      << "plot [0:1] [0:1] NaN\nunset label\nset border 3\nset xtics nomirror\n"
         "set ytics nomirror\nset xlabel 'least time per trial (µs)' offset 0,0.3\n"
         "set logscale xy\n";
  return out.str();
}

}  // namespace

Figure figure_of(const std::vector<WorkPrecision>& charts) {
  constexpr int kRow = 395, kHeader = 60;
  const int height = kRow * static_cast<int>(charts.size()) + kHeader;
  std::ostringstream out;
  out << "set multiplot\nset format y '10^{%L}'\nset xtics nomirror\n"
         "set ytics nomirror\nset border 3\n"
         "set grid lc rgb '#eeeeee' lt 1\nunset key\nset xlabel 'least time per trial (µs)' offset "
         "0,0.3\n"
         "set lmargin 0\nset rmargin 0\nset tmargin 0\nset bmargin 0\n"
      << legend(charts.front(), height);
  for (std::size_t row = 0; row < charts.size(); ++row) {
    const WorkPrecision& chart = charts[row];
    const double top =
        1.0 - static_cast<double>(kHeader + kRow * static_cast<int>(row) + 86) / height;
    const double bottom = top - 240.0 / height;
    const auto place = [&](double left, double right) {
      out << "set lmargin at screen " << left << "\nset rmargin at screen " << right
          << "\nset tmargin at screen " << top << "\nset bmargin at screen " << bottom << "\n";
    };
    const std::string tag = "S" + std::to_string(row);
    place(0.075, 0.485);
    const Panel weak(
        chart, tag + "weak", chart.outcome_limit(), chart.reference.own.outcomes.total_variation,
        [&](const ChartPoint& p) {
          const dynamics::WeakError& e = p.errors.outcomes;
          return Drawn{e.total_variation, e.standard_error, chart.outcome_bound(p.errors)};
        });
    out << weak.text(chart.label + ": distribution of outcomes", "total variation");
    place(0.575, 0.985);
    const Panel strong(
        chart, tag + "strong", chart.position_limit(), chart.reference.own.strong.position,
        [&](const ChartPoint& p) {
          return Drawn{p.errors.strong.position, std::nan(""), chart.position_limit()};
        });
    out << strong.text(chart.label + ": where a trial ends, median", "distance (m)");
  }
  out << "unset multiplot\n";
  return {1000, height, out.str()};
}

}  // namespace gatewalk::cli
