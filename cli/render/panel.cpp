// SPDX-License-Identifier: MIT
#include "cli/render/panel.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "cli/render/final_gates.h"

namespace gatewalk::cli {
namespace {

/// Edges of 0 (left, top) and of the sheet's size mean the whole sheet.
constexpr Box kWholeSheet{0, Sheet::kWidth, 0, HUGE_VAL};

std::string words_of(const Pen& pen) {
  std::string words;
  const std::string_view colour = pen.colour ? pen.colour : "";
  if (colour == kInk)
    words += " lt -1";
  else if (colour.starts_with('#'))
    words += fmt::format(" lc rgb '{}'", colour);
  else if (!colour.empty())
    words += fmt::format(" lc {}", colour);
  if (pen.width > 0.0) words += " lw " + digits(pen.width);
  if (pen.dashes > 0) words += fmt::format(" dt {}", pen.dashes);
  if (pen.mark > 0) words += fmt::format(" pt {}", pen.mark);
  if (pen.size > 0.0) words += " ps " + digits(pen.size);
  return words;
}

std::string words_of(const Layer& layer, bool with_key) {
  std::string words = layer.data;
  if (!layer.columns.empty()) words += " using " + layer.columns;
  words += " with " + layer.with + words_of(layer.pen);
  if (!layer.title.text.empty()) return words + " title " + layer.title.quoted();
  return with_key ? words + " notitle" : words;
}

std::string range_of(double low, double high) {
  const auto end = [](double x) { return std::isnan(x) ? "*" : digits(x); };
  return fmt::format("[{}:{}]\n", end(low), end(high));
}

/// `name`: "x" or "y".
std::string words_of(const Axis& axis, const std::string& name, const std::string& name_look) {
  std::string words = fmt::format("set {}range {}", name, range_of(axis.low, axis.high));
  if (axis.tics == kNoTics)
    words += fmt::format("unset {}tics\n", name);
  else if (!axis.tics.empty())
    words += fmt::format("set {}tics {}\n", name, axis.tics);
  if (!axis.format.empty() || !axis.numbers)
    words += fmt::format("set format {} '{}'\n", name, axis.numbers ? axis.format : "");
  if (axis.logarithmic) words += fmt::format("set logscale {}\n", name);
  if (!axis.name.text.empty())
    words += fmt::format("set {}label {} {}\n", name, axis.name.quoted(),
                         axis.name_look.empty() ? name_look : axis.name_look);
  return words;
}

std::string words_of(const Colours& colours, const Sheet& sheet) {
  std::string words = colours.palette + "set cbrange " + range_of(colours.low, colours.high);
  if (!colours.bar) return words + "unset colorbox\n";
  const Box& bar = *colours.bar;
  words +=
      fmt::format("set colorbox {}user origin screen {} size screen {},{}\n",
                  bar.width() > bar.height() ? "horizontal " : "", sheet.at(bar.left, bar.bottom),
                  digits(bar.width() / Sheet::kWidth), digits(bar.height() / sheet.height));
  if (!colours.tics.empty()) words += "set cbtics " + colours.tics + "\n";
  if (!colours.name.text.empty())
    words += fmt::format("set cblabel {} {}\n", colours.name.quoted(), colours.name_look);
  return words;
}

std::string words_of(const Text& text, const Sheet& sheet) {
  const std::string place = text.on_axes ? digits(text.left) + "," + digits(text.middle)
                                         : "screen " + sheet.at(text.left, text.middle);
  const bool plain = text.text.kind == Caption::Kind::plain;
  return fmt::format("set label {} at {} {} font ',{}'{}\n",
                     (plain ? verbatim(text.text.text) : text.text).quoted(), place, text.how,
                     text.font, text.mark.mark > 0 ? " point" + words_of(text.mark) : "");
}

std::string words_of(const Panel& panel, const std::string& frame, const Sheet& sheet) {
  Box box = panel.box;
  box.bottom = std::min<double>(box.bottom, sheet.height);
  std::string words = "reset\n" + frame + sheet.margins(box);
  words += panel.border == 0 ? "unset border\n" : fmt::format("set border {}\n", panel.border);
  if (panel.tics_font > 0) words += fmt::format("set tics font ',{}'\n", panel.tics_font);
  words += words_of(panel.x, "x", "offset 0,0.9") + words_of(panel.y, "y", "offset 0.8,0");
  if (!panel.grid.empty()) words += "set grid " + panel.grid + "\n";
  if (panel.key && std::isnan(panel.key->left))
    words += "set key " + panel.key->how + "\n";
  else if (panel.key)
    words += fmt::format("set key at screen {} {}\n", sheet.at(panel.key->left, panel.key->top),
                         panel.key->how);
  if (panel.colours) words += words_of(*panel.colours, sheet);
  for (const Text& text : panel.texts) words += words_of(text, sheet);
  for (const Upright& line : panel.uprights)
    words += fmt::format("set arrow from {0}, graph 0 to {0}, graph 1 nohead{1}{2}\n",
                         digits(line.x), line.in_front ? " front" : "", words_of(line.pen));
  words += panel.more + "plot ";
  if (panel.layers.empty()) words += "NaN";
  for (std::size_t i = 0; i < panel.layers.size(); ++i)
    words += (i == 0 ? "" : ", ") + words_of(panel.layers[i], panel.key.has_value());
  return words + "\n";
}

}  // namespace

std::string Caption::quoted() const {
  const std::string words = literal(text);
  const bool as_it_stands = kind == Kind::verbatim ||
                            (kind == Kind::plain && text.find_first_of("_^{}@&~\\") != text.npos);
  return as_it_stands ? words : words.substr(0, words.rfind(" noenhanced"));
}

Caption markup(std::string text) {
  Caption caption(std::move(text));
  caption.kind = Caption::Kind::marked_up;
  return caption;
}

Caption verbatim(std::string text) {
  Caption caption(std::move(text));
  caption.kind = Caption::Kind::verbatim;
  return caption;
}

void Panel::draw(const Rows& rows, std::string columns, std::string with, Pen pen, Caption title) {
  if (!rows.empty())
    layers.push_back({rows.name(), std::move(columns), std::move(with), pen, std::move(title)});
}

void Panel::draw_again(std::string columns, std::string with, Pen pen) {
  if (!layers.empty()) layers.push_back({"''", std::move(columns), std::move(with), pen});
}

void Panel::draw_cells(const Rows& rows, double half_x, double half_y) {
  draw(rows, fmt::format("1:2:({}):({}):3", digits(half_x), digits(half_y)), kBars, {kByPalette});
}

void Panel::draw_numbers(double most) {
  draw_again("1:2:4:" + ink(most), "labels tc rgb variable font ',12'");
}

void Panel::draw_outlined(const Rows& rows, const std::string& columns, const std::string& with,
                          const Pen& below, const Pen& above) {
  for (const Pen& pen : {below, above}) draw(rows, columns, with, pen);
}

Panel& Panels::add(Panel panel) {
  panel.texts.insert(panel.texts.begin(), texts_.begin(), texts_.end());
  texts_.clear();
  return panels_.emplace_back(std::move(panel));
}

void Panels::add_key(double left, double top, std::vector<Layer> entries) {
  Panel& panel = add(kWholeSheet);
  panel.x = panel.y = {"", 0, 1, kNoTics};
  panel.border = 0;
  panel.key = {fmt::format("left top Left reverse vertical maxcols 1 samplen 1.5 spacing 1.1 font "
                           "',{}'",
                           kSmallFont),
               left, top};
  panel.layers = std::move(entries);
}

Figure Panels::figure(int height, int font) const {
  const Sheet sheet{height};
  std::string script;
  for (const Rows& rows : data_) script += data_block(rows.name(), rows.text()) + rows.derived;
  const bool several = panels_.size() > 1;
  if (several) script += "set multiplot\n";
  for (const Panel& panel : panels_) script += words_of(panel, frame_, sheet);
  if (several) script += "unset multiplot\n";
  return {Sheet::kWidth, height, script, font};
}

std::string tics_of(const std::vector<Tic>& tics) {
  std::string list;
  for (const Tic& tic : tics)
    list +=
        fmt::format("{}{} {}", list.empty() ? "" : ", ", markup(tic.text).quoted(), digits(tic.at));
  return "(" + list + ")";
}

std::string tics_of(const std::vector<std::string>& names) {
  std::vector<Tic> tics;
  for (const std::string& name : names) tics.push_back({name, static_cast<double>(tics.size())});
  return tics_of(tics);
}

void add_colours(Panel& panel, const RootScale& scale, const Box& bar) {
  panel.colours = {0, std::sqrt(scale.most()), bar, "(" + scale.tics() + ") offset -0.8,0"};
  panel.say("%, root scale", bar.left - 4, bar.bottom + 18, kSmallFont);
}

Panel& add_share_bars(Panels& out, const Box& box, const std::string& data,
                      const std::vector<ShareBar>& bars) {
  std::vector<std::string> names;
  Rows& rows = out.data(data);
  for (const auto& [name, share, interval] : bars) {
    const bool has_interval = std::isfinite(interval[0]);
    rows.add(names.size(), 100 * share, 100 * (has_interval ? interval[0] : share),
             100 * (has_interval ? interval[1] : share),
             "\"" + with_interval(share, interval) + " %\"");
    names.push_back(name);
  }
  Panel& panel = out.add(box);
  panel.x = {"", 0, 100, kNoTics};
  panel.y = {"", static_cast<double>(bars.size()) - 0.4, -0.6, tics_of(names) + " scale 0"};
  panel.border = 0;
  panel.draw(rows, "($2/2):1:($2/2):(0.36)", kBars, {kFirstColour});
  panel.draw_again("3:1:($4-$3):(0)", kIntervals, kIntervalPen);
  panel.draw_again("($4 > 98 ? 100 : $4 + 2):1:5",
                   fmt::format("labels left font ',{}'", kSmallFont));
  return panel;
}

}  // namespace gatewalk::cli
