// SPDX-License-Identifier: MIT
#pragma once
/// The picture of a film at a time: the body among the beams, with words and bars beside it.

#include <string_view>
#include <vector>

#include "cli/film/painter.h"
#include "cli/film/playback.h"

namespace gatewalk::cli {

inline constexpr int kPictureWidth = 1280, kPictureHeight = 720;  // points

class Picture {
 public:
  /// `pace`: units of the scene's time in a second of the film. Without `labels` there are no
  /// words, numbers and scale bar. Throws std::invalid_argument as Playback does.
  Picture(const Film& film, const FilmRun& run, double pace, bool labels);

  [[nodiscard]] const Playback& playback() const { return run_; }

  /// The picture at a time (s) in rows of four bytes a pixel: blue, green, red, unused. Valid until
  /// the next call.
  [[nodiscard]] std::string_view draw(double time);

 private:
  /// An area of the world (m), drawn into a part of the picture.
  struct View {
    PictureBox box;  // part of the picture
    Point centre;    // m
    double scale;    // points per m
    double thick;    // points, of a beam
    [[nodiscard]] Point operator()(Point p) const {
      return {0.5 * (box.x0 + box.x1) + (p.x - centre.x) * scale,
              0.5 * (box.y0 + box.y1) - (p.y - centre.y) * scale};
    }
  };

  [[nodiscard]] PictureBox bounds() const;
  [[nodiscard]] int first_column() const { return -film_.field.start_column(); }
  void stage(const PictureBox& box, const Scenery& s, const PictureBox& seen);
  void gates(const View& view, const Scenery& s);
  void trail(const View& view, const Scenery& s);
  void moving_beam(const View& view, const Scenery& s, dynamics::Side side);
  void forces(const View& view, const Scenery& s);
  void rule(const View& view);

  void panel(double x, const Scenery& now, const Scenery& said);
  void legend(double x, double& y, const Scenery& said);
  struct Bar {
    const char* name;
    double FilmStep::*energy;
    double most;  // J, at the bar's full length
    Colour colour;
  };
  void bars(double x, double& y, const char* heading, const std::vector<Bar>& bars,
            const Scenery& now, const Scenery& said);
  void text(double x, double y, double size, std::string words, Colour c, bool bold = false,
            double width = 1e9) {
    if (labels_) painter_.text(x, y, size, std::move(words), c, bold, width);
  }

  const Film& film_;
  const FilmRun& about_;
  const Playback run_;
  const dynamics::Scale unit_;
  double pace_;
  bool labels_;
  Painter painter_{kPictureWidth, kPictureHeight};
  double arrow_ = 0.0;                 // m per N
  double stored_ = 0.0, moved_ = 0.0;  // J, at the bars' full lengths
};

}  // namespace gatewalk::cli
