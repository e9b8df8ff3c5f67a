// SPDX-License-Identifier: MIT
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "cli/fields/text.h"
#include "cli/paper/figures.h"

namespace gatewalk::cli {
namespace {

/// Symbols as the paper prints them. An index has kSmallFont in letters of either size.
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

Panels paper_panels() {
  return Panels(
      "set encoding utf8\nset minussign\nunset key\nset tics out nomirror scale 0.5\n"
      "set xtics offset 0,0.4\n");
}

Caption as_printed(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto* const symbol = std::find_if(std::begin(kSymbols), std::end(kSymbols), [&](auto& s) {
      const std::string_view plain = s.first;
      return text.compare(i, plain.size(), plain) == 0;
    });
    if (symbol != std::end(kSymbols)) {
      out += symbol->second;
      i += std::string_view(symbol->first).size();
    } else {
      out += text[i++];
    }
  }
  return markup(out);
}

Panel& add_panel(Panels& out, const Box& box, const std::string& x, const std::string& y,
                 double room) {
  Panel& panel = out.add(box);
  panel.y.numbers = !y.empty();
  if (!x.empty())
    panel.texts.push_back(
        {as_printed(x), 0.5 * (box.left + box.right), box.bottom + 42, kFont, "center"});
  if (!y.empty())
    panel.texts.push_back({as_printed(y), box.left - room, 0.5 * (box.top + box.bottom), kFont,
                           "center rotate by 90"});
  return panel;
}

std::string root_tics(const std::vector<double>& percents, bool numbers) {
  std::string list;
  for (const double p : percents)
    list += fmt::format("{}{}' {}", list.empty() ? "('" : ", '", numbers ? digits(p) : "",
                        digits(std::sqrt(p)));
  return list + ")";
}

// ---- Landscapes

Rows& EnergyMap::add_data(Panels& out, const dynamics::Landscape& l,
                          const Eigen::ArrayXXd& energy) const {
  Rows& rows = out.data(name);
  for (std::size_t i = 0; i < l.y.size(); ++i) {
    for (std::size_t j = 0; j < l.x.size(); ++j) {
      const double e = energy(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      rows.add(l.x[j], l.y[i], std::isfinite(e) ? digits(std::min(e, ceiling)) : "NaN");
    }
    rows.gap();
  }
  rows.derived = fmt::format(
      "set contour base\nunset surface\nset cntrparam levels incremental {0},{0},{1}\n"
      "set table {2}_lines\nsplot {2} using 1:2:3 with lines\nunset table\nunset contour\n"
      "set surface\n",
      digits(step), digits(ceiling - step), name);
  return rows;
}

Panel& EnergyMap::add(Panels& out, const Rows& rows, double left, double top, const std::string& x,
                      const std::string& y) const {
  Panel& panel = add_panel(out, {left, left + kWidth, top, top + kHeight}, x, y);
  panel.tics_font = kSmallFont;
  panel.border = 15;
  panel.x = {"", -25, 25, "20"};
  panel.y = {"", 0, 65, "20", "", !y.empty()};
  panel.colours = {0, ceiling};
  panel.more =
      "set object 1 rectangle from graph 0,0 to graph 1,1 behind fillcolor rgb '#999999' fillstyle "
      "solid noborder\n";
  panel.draw(rows, "1:2:3", "image");
  panel.layers.push_back({rows.name() + "_lines",
                          "1:2:" + ink(ceiling),
                          "lines",
                          {.colour = kOwnColour, .width = 0.5}});
  return panel;
}

void EnergyMap::add_bar(Panel& panel, double left, double top) const {
  const double bar = left + kWidth + 12;
  panel.colours->bar = {bar, bar + 12, top, top + kHeight};
  panel.colours->tics = "100 font ',12' offset -0.8,0";
  panel.say(as_printed("J, cut at"), bar, top - 34, kSmallFont);
  panel.say(as_printed(digits(ceiling) + " J"), bar, top - 18, kSmallFont);
}

void draw_track(Panel& panel, const Rows& rows, const std::string& columns, double width,
                const char* colour) {
  panel.draw_outlined(rows, columns, "lines", {"#000000", width + 0.9}, {colour, width});
}

// ---- Rows of shares

Axis row_axis(const std::vector<std::string>& labels) {
  std::vector<std::string> names;
  for (const std::string& label : labels) names.push_back(as_printed(label).text);
  return {"",   static_cast<double>(labels.size()) - 0.4,
          -0.6, tics_of(names) + " scale 0 font ',12'",
          "",   false};
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
  Panels out = paper_panels();
  Rows &guides = out.data("$guides"), marks("$marks");
  std::vector<Rows> dots;
  for (std::size_t i = 0; i < series.size(); ++i) dots.emplace_back(fmt::format("$series{}", i));
  std::vector<Text> mark_labels;
  for (const RateGroup& g : groups) {
    const auto first = static_cast<double>(labels.size());
    labels.push_back(bold(g.name));
    for (const RateRow& row : g.rows) {
      const auto at = static_cast<double>(labels.size());
      labels.push_back(row.label);
      guides.add(0, at, end, 0);
      for (std::size_t i = 0; i < row.shares.size(); ++i) {
        const Share& s = row.shares[i];
        const double beside =
            0.26 * (static_cast<double>(i) - 0.5 * static_cast<double>(series.size() - 1));
        if (!std::isnan(s.value))
          dots[i].add(root_percent(s.value), at + beside, root_percent(s.low),
                      root_percent(s.high));
      }
    }
    if (std::isnan(g.mark)) continue;
    const double x = std::sqrt(g.mark);
    marks.add(x, first + 0.5, 0, g.rows.size());
    if (!g.mark_label.empty())
      mark_labels.push_back({as_printed(g.mark_label), x, first, kSmallFont, "center", true});
  }
  const double top =
      18.0 + 22.0 * static_cast<double>(head.size()) + (series.size() > 1 ? 22.0 : 0.0);
  Panel& panel =
      add_panel(out, {186, 488, top, top + 19.0 * static_cast<double>(labels.size())}, axis, "");
  panel.texts.insert(panel.texts.end(), mark_labels.begin(), mark_labels.end());
  for (std::size_t i = 0; i < head.size(); ++i)
    panel.say(as_printed(head[i]), 8, 18 + 22.0 * static_cast<double>(i));
  panel.border = 1;
  panel.x = {"", 0, 1.02 * end, fmt::format("({})", scale.tics())};
  panel.y = row_axis(labels);
  panel.more = "set bars 0.4\n";
  panel.draw(guides, "1:2:3:4", std::string("vectors nohead") + kGrid);
  if (!marks.empty())
    panel.draw(out.data(marks), "1:2:3:4", "vectors nohead",
               {.colour = kInk, .width = 1.5, .dashes = 2});
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (dots[i].empty()) dots[i].add("NaN NaN NaN NaN");
    panel.draw(out.data(dots[i]), "1:2:3:4", "xerrorbars",
               {series[i].colour, 1.2, series[i].marker, 0.5},
               series.size() > 1 ? as_printed(series[i].name) : Caption());
  }
  if (series.size() > 1)
    panel.key = {"left center maxrows 1 Left reverse samplen 1.5", 8, top - 20};
  return out.figure(static_cast<int>(panel.box.bottom + 60));
}

}  // namespace gatewalk::cli
