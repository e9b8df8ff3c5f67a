// SPDX-License-Identifier: MIT
#include "cli/film/painter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace gatewalk::cli {

Painter::Painter(int width, int height)
    : height_(height),
      surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height),
               cairo_surface_destroy),
      cr_(cairo_create(surface_.get()), cairo_destroy) {
  check();
}

std::string_view Painter::pixels() const {
  check();
  cairo_surface_flush(surface_.get());
  return {reinterpret_cast<const char*>(cairo_image_surface_get_data(surface_.get())),
          static_cast<std::size_t>(cairo_image_surface_get_stride(surface_.get()) * height_)};
}

void Painter::check() const {
  const cairo_status_t status = cairo_status(cr_.get());
  if (status != CAIRO_STATUS_SUCCESS)
    throw std::runtime_error(std::string("cairo cannot draw: ") + cairo_status_to_string(status));
}

void Painter::fill(const PictureBox& b, Colour c, double alpha) {
  cairo_rectangle(cr_.get(), b.x0, b.y0, b.x1 - b.x0, b.y1 - b.y0);
  fill(c, alpha);
}

void Painter::fill(Colour c, double alpha) {
  colour(c, alpha);
  cairo_fill(cr_.get());
}

void Painter::stroke(Colour c, double width, double alpha) {
  colour(c, alpha);
  cairo_set_line_width(cr_.get(), width);
  cairo_stroke(cr_.get());
}

void Painter::fill_and_stroke(Colour inside, double alpha, Colour edge, double width) {
  colour(inside, alpha);
  cairo_fill_preserve(cr_.get());
  stroke(edge, width);
}

void Painter::circle(Point p, double r) {
  cairo_new_sub_path(cr_.get());
  cairo_arc(cr_.get(), p.x, p.y, r, 0.0, 2.0 * std::numbers::pi);
}

void Painter::line(Point a, Point b, Colour c, double width, double alpha) {
  move_to(a);
  line_to(b);
  stroke(c, width, alpha);
}

void Painter::arrow(Point a, Point b, Colour c, double thick) {
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  if (length < 1.0) return;
  const double ux = (b.x - a.x) / length, uy = (b.y - a.y) / length;
  const double head = std::min(0.6 * length, std::max(6.0, 2.6 * thick));
  line(a, {b.x - 0.8 * head * ux, b.y - 0.8 * head * uy}, c, std::max(1.5, 0.7 * thick));
  move_to(b);
  line_to({b.x - head * ux - 0.5 * head * uy, b.y - head * uy + 0.5 * head * ux});
  line_to({b.x - head * ux + 0.5 * head * uy, b.y - head * uy - 0.5 * head * ux});
  cairo_close_path(cr_.get());
  fill(c);
}

double Painter::width_of(const std::string& words) const {
  cairo_text_extents_t extents;
  cairo_text_extents(cr_.get(), words.c_str(), &extents);
  return extents.x_advance;
}

void Painter::text(double x, double y, double size, std::string words, Colour c, bool bold,
                   double width) {
  cairo_select_font_face(cr_.get(), "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cr_.get(), size);
  if (width_of(words) > std::abs(width)) {
    do {
      // Removes whole characters of UTF-8, not single bytes.
      while (!words.empty() && (words.back() & 0xC0) == 0x80) words.pop_back();
      if (!words.empty()) words.pop_back();
    } while (!words.empty() && width_of(words + "…") > std::abs(width));
    words += "…";
  }
  move_to({width < 0.0 ? x - width_of(words) : x, y});
  colour(c, 1.0);
  cairo_show_text(cr_.get(), words.c_str());
}

Painter::Clip::Clip(Painter& painter, const PictureBox& box) : cr_(painter.cr_.get()) {
  cairo_save(cr_);
  cairo_rectangle(cr_, box.x0, box.y0, box.x1 - box.x0, box.y1 - box.y0);
  cairo_clip(cr_);
  cairo_set_line_cap(cr_, CAIRO_LINE_CAP_ROUND);
  cairo_set_line_join(cr_, CAIRO_LINE_JOIN_ROUND);
}

Painter::FlatLines::FlatLines(Painter& painter, double dash) : cr_(painter.cr_.get()) {
  cairo_set_line_cap(cr_, CAIRO_LINE_CAP_BUTT);
  if (dash > 0.0) cairo_set_dash(cr_, &dash, 1, 0.0);
}

Painter::FlatLines::~FlatLines() {
  cairo_set_dash(cr_, nullptr, 0, 0.0);
  cairo_set_line_cap(cr_, CAIRO_LINE_CAP_ROUND);
}

}  // namespace gatewalk::cli
