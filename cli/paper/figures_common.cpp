// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "cli/paper/figures.h"
#include "cli/render/text.h"

namespace gatewalk::cli {
namespace {

/// As the paper prints them; an index has kSmallFont in letters of either size.
constexpr std::pair<const char*, const char*> kSymbols[] = {{"F_prop", "{/:Italic F}_{/=12 prop}"},
                                                            {"k_L", "{/:Italic k}_{/=12 L}"},
                                                            {"k_R", "{/:Italic k}_{/=12 R}"},
                                                            {"v_x", "{/:Italic v_{/=12 x}}"},
                                                            {"v_y", "{/:Italic v_{/=12 y}}"},
                                                            {"i_x", "{/:Italic i_{/=12 x}}"},
                                                            {"i_y", "{/:Italic i_{/=12 y}}"},
                                                            {"Rm", "{/:Italic Rm}"},
                                                            {"d = ", "{/:Italic d} = "},
                                                            {"d in N", "{/:Italic d} in N"},
                                                            {"n = ", "{/:Italic n} = "}};

}  // namespace

Figure figure_of(const Sheet& sheet, const std::string& data, const std::string& panels) {
  return {Sheet::kWidth, sheet.height,
          "set encoding utf8\nset minussign\nunset key\nset tics out "
          "nomirror scale 0.5\n"
          "set xtics offset 0,0.4\n" +
              data + "set multiplot\n" + panels + "unset multiplot\n",
          kFont};
}

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (std::size_t i = 0; i < text.size();) {
    const auto* const symbol = std::find_if(std::begin(kSymbols), std::end(kSymbols), [&](auto& s) {
      const std::string_view plain = s.first;
      return text.compare(i, plain.size(), plain) == 0;
    });
    if (symbol != std::end(kSymbols)) {
      out += symbol->second;
      i += std::string_view(symbol->first).size();
    } else {
      if (text[i] == '\'') out += '\'';  // doubled
      out += text[i++];
    }
  }
  return out + "'";
}

std::string words(const Sheet& sheet, const std::string& text, double left, double middle,
                  int font) {
  return "set label " + quoted(text) + " at screen " + sheet.at(left, middle) + " left font '," +
         std::to_string(font) + "'\n";
}

std::string frame(const Sheet& sheet, const Box& box, const std::string& x, const std::string& y,
                  double room) {
  const auto name = [&](const std::string& text, double left, double top, const char* how) {
    return text.empty() ? ""
                        : "set label " + quoted(text) + " at screen " + sheet.at(left, top) +
                              " center " + how + "\n";
  };
  return sheet.margins(box) + "set format y" + (y.empty() ? " ''\n" : "\n") +
         name(x, 0.5 * (box.left + box.right), box.bottom + 42, "") +
         name(y, box.left - room, 0.5 * (box.top + box.bottom), "rotate by 90");
}

std::string line_of(const std::vector<double>& values) {
  std::string line;
  for (const double x : values) line += (line.empty() ? "" : " ") + digits(x);
  return line + "\n";
}

std::string root_tics(const std::vector<double>& percents, bool numbers) {
  std::string list;
  for (const double p : percents)
    list +=
        (list.empty() ? "('" : ", '") + (numbers ? digits(p) : "") + "' " + digits(std::sqrt(p));
  return list + ")";
}

// ---- Landscapes

std::string EnergyMap::data(const dynamics::Landscape& l, const Eigen::ArrayXXd& energy) const {
  std::string rows;
  for (std::size_t i = 0; i < l.y.size(); ++i) {
    for (std::size_t j = 0; j < l.x.size(); ++j) {
      const double e = energy(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      rows += digits(l.x[j]) + " " + digits(l.y[i]) + " " +
              (std::isfinite(e) ? digits(std::min(e, ceiling)) : "NaN") + "\n";
    }
    rows += "\n";
  }
  return data_block(name, rows) +
         "set contour base\nunset surface\nset cntrparam levels incremental " + digits(step) + "," +
         digits(step) + "," + digits(ceiling - step) + "\nset table " + name + "_lines\nsplot " +
         name + " using 1:2:3 with lines\nunset table\nunset contour\nset surface\n";
}

std::string EnergyMap::plot(const Sheet& sheet, double left, double top, const std::string& x,
                            const std::string& y) const {
  return kSequential + frame(sheet, {left, left + kWidth, top, top + kHeight}, x, y) + kSmallTics +
         "set border 15\nset cbrange [0:" + digits(ceiling) +
         "]\nset xrange [-25:25]\nset yrange [0:65]\nset xtics 20\nset ytics 20\n"
         "set object 1 rectangle from graph 0,0 to graph 1,1 behind fillcolor rgb '#999999' "
         "fillstyle solid noborder\nplot " +
         name + " using 1:2:3 with image, " + name + "_lines using 1:2:" + ink(ceiling) +
         " with lines lw 0.5 lc rgb variable";
}

std::string EnergyMap::colours(const Sheet& sheet, double left, double top) const {
  const double bar = left + kWidth + 12;
  return "set cbtics 100 font ',12' offset -0.8,0\nset colorbox user origin screen " +
         sheet.at(bar, top + kHeight) + " size screen " + digits(12.0 / Sheet::kWidth) + "," +
         digits(kHeight / sheet.height) + "\n" +
         words(sheet, "J, cut at", bar, top - 34, kSmallFont) +
         words(sheet, digits(ceiling) + " J", bar, top - 18, kSmallFont);
}

std::string track(const std::string& what, double width, const std::string& colour) {
  return what + " with lines lw " + digits(width + 0.9) + " lc rgb '#000000', " + what +
         " with lines lw " + digits(width) + " lc rgb '" + colour + "'";
}

// ---- Rows of shares

std::string row_tics(const std::vector<std::string>& labels) {
  std::string list;
  for (std::size_t i = 0; i < labels.size(); ++i)
    list += (i ? ", " : "(") + quoted(labels[i]) + " " + std::to_string(i);
  return "set ytics " + list + ") scale 0 font ',12'\nset yrange [" +
         digits(static_cast<double>(labels.size()) - 0.4) + ":-0.6]\n";
}

Figure rates(const std::vector<std::string>& head, const std::vector<Series>& series,
             const std::vector<RateGroup>& groups, const std::string& axis) {
  double most = 0.0;
  for (const RateGroup& g : groups) {
    most = std::fmax(most, g.mark);
    for (const RateRow& row : g.rows)
      for (const Share& s : row.shares) most = std::fmax(most, 100.0 * s.high);
  }
  const RootScale scale(most);
  const double end = std::sqrt(scale.most());
  std::vector<std::string> labels;
  std::vector<std::string> dots(series.size());
  std::string guides, marks, texts;
  for (const RateGroup& g : groups) {
    const auto first = static_cast<double>(labels.size());
    labels.push_back(bold(g.name));
    for (const RateRow& row : g.rows) {
      const auto at = static_cast<double>(labels.size());
      labels.push_back(row.label);
      guides += line_of({0, at, end, 0});
      for (std::size_t i = 0; i < row.shares.size(); ++i) {
        const Share& s = row.shares[i];
        const double beside =
            0.26 * (static_cast<double>(i) - 0.5 * static_cast<double>(series.size() - 1));
        if (!std::isnan(s.value))
          dots[i] += line_of(
              {root_percent(s.value), at + beside, root_percent(s.low), root_percent(s.high)});
      }
    }
    if (std::isnan(g.mark)) continue;
    const double x = std::sqrt(g.mark);
    marks += line_of({x, first + 0.5, 0, static_cast<double>(g.rows.size())});
    if (!g.mark_label.empty())
      texts += "set label " + quoted(g.mark_label) + " at " + digits(x) + "," + digits(first) +
               " center font ',12'\n";
  }
  const double top =
      18.0 + 22.0 * static_cast<double>(head.size()) + (series.size() > 1 ? 22.0 : 0.0);
  const Box box{186, 488, top, top + 19.0 * static_cast<double>(labels.size())};
  const Sheet sheet{static_cast<int>(box.bottom + 60)};
  std::string data = data_block("$guides", guides);
  std::string plot = std::string("plot $guides using 1:2:3:4 notitle with vectors nohead") + kGrid;
  for (std::size_t i = 0; i < head.size(); ++i)
    texts += words(sheet, head[i], 8, 18 + 22.0 * static_cast<double>(i));
  if (!marks.empty()) {
    data += data_block("$marks", marks);
    plot += ", $marks using 1:2:3:4 notitle with vectors nohead lt -1 lw 1.5 dt 2";
  }
  for (std::size_t i = 0; i < series.size(); ++i) {
    const std::string name = "$series" + std::to_string(i);
    data += data_block(name, dots[i].empty() ? "NaN NaN NaN NaN\n" : dots[i]);
    plot += ", " + name + " using 1:2:3:4 with xerrorbars lw 1.2 pt " +
            std::to_string(series[i].marker) + " ps 0.5 lc rgb '" + series[i].colour + "'" +
            (series.size() > 1 ? " title " + quoted(series[i].name) : "");
  }
  if (series.size() > 1)
    texts += "set key at screen " + sheet.at(8, top - 20) +
             " left center maxrows 1 Left reverse samplen 1.5\n";
  return figure_of(sheet, data,
                   frame(sheet, box, axis, "") + texts + row_tics(labels) +
                       "set border 1\nset xrange [0:" + digits(1.02 * end) + "]\nset xtics (" +
                       scale.tics() + ")\n" + "set bars 0.4\n" + plot + "\n");
}

}  // namespace gatewalk::cli
