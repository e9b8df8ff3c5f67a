// SPDX-License-Identifier: MIT
#pragma once
/// Draws shapes and words on a picture with cairo.

#include <cairo.h>

#include <memory>
#include <string>
#include <string_view>

#include "cli/film/playback.h"

namespace gatewalk::cli {

struct Colour {
  double red, green, blue;
};
constexpr Colour rgb(int hex) {
  return {(hex >> 16) / 255.0, (hex >> 8 & 255) / 255.0, (hex & 255) / 255.0};
}

/// A rectangle, from one corner to the other.
struct PictureBox {
  double x0, y0, x1, y1;
};

/// A picture to draw on. All places and sizes are in points of the picture, y downward.
class Painter {
 public:
  Painter(int width, int height);

  /// The pixels in rows, four bytes each: blue, green, red, unused. Throws std::runtime_error when
  /// cairo failed.
  [[nodiscard]] std::string_view pixels() const;

  void fill(const PictureBox& b, Colour c, double alpha = 1.0);
  void line(Point a, Point b, Colour c, double width, double alpha = 1.0);
  void arrow(Point a, Point b, Colour c, double thick);
  /// Outlines; a fill or stroke draws them next.
  void circle(Point p, double r);
  void move_to(Point p) { cairo_move_to(cr_.get(), p.x, p.y); }
  void line_to(Point p) { cairo_line_to(cr_.get(), p.x, p.y); }
  void stroke(Colour c, double width, double alpha = 1.0);
  void fill(Colour c, double alpha = 1.0);
  void fill_and_stroke(Colour inside, double alpha, Colour edge, double width);

  /// Draws text from x on, or up to x for a width below 0. Text wider than `width` loses its end.
  void text(double x, double y, double size, std::string words, Colour c, bool bold = false,
            double width = 1e9);

  /// During the object's life, nothing is drawn outside of the box, and lines have round ends.
  class Clip {
   public:
    Clip(Painter& painter, const PictureBox& box);
    ~Clip() { cairo_restore(cr_); }
    Clip(const Clip&) = delete;
    Clip& operator=(const Clip&) = delete;

   private:
    cairo_t* cr_;
  };
  /// During the object's life, lines have flat ends and dashes of this length (0: no dashes).
  class FlatLines {
   public:
    explicit FlatLines(Painter& painter, double dash = 0.0);
    ~FlatLines();
    FlatLines(const FlatLines&) = delete;
    FlatLines& operator=(const FlatLines&) = delete;

   private:
    cairo_t* cr_;
  };

 private:
  void check() const;
  void colour(Colour c, double alpha) {
    cairo_set_source_rgba(cr_.get(), c.red, c.green, c.blue, alpha);
  }
  [[nodiscard]] double width_of(const std::string& words) const;  // in the current font

  int height_;
  std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface_;
  std::unique_ptr<cairo_t, decltype(&cairo_destroy)> cr_;
};

}  // namespace gatewalk::cli
