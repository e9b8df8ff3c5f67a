#include "cli/film/video.h"

#include <cairo.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/render/quantity.h"
#include "cli/terminal/child.h"
#include "cli/terminal/interrupt.h"
#include "cli/terminal/output.h"
#include "cli/terminal/progress.h"
#include "dynamics/params.h"

namespace gatewalk::cli {
namespace {

// ---- The film, as numbers

struct Run {
  std::string label, ending;
  double propulsion = 0.0;  // N
  std::vector<double> t, gx, gy, x, y, vx, vy, left, right, contact_left, contact_right, random;
  std::vector<double> body, beams, elastic, work, lost;  // J
  std::vector<double> X, Y;                              // m, in the field's frame
  std::vector<double> sum_X, sum_Y;                      // m s, their integrals
};

struct Film {
  std::string title;
  dynamics::Scale scale;
  double radius, beam, joint_x, joint_y, width, depth;  // m
  int columns, rows;
  Run run;

  [[nodiscard]] bool is_field() const { return columns * rows > 1; }
  [[nodiscard]] int first_column() const { return -(columns / 2); }
};

std::vector<double> integral(const std::vector<double>& t, const std::vector<double>& values) {
  std::vector<double> sums(values.size(), 0.0);
  for (std::size_t i = 1; i < values.size(); ++i)
    sums[i] = sums[i - 1] + 0.5 * (values[i] + values[i - 1]) * (t[i] - t[i - 1]);
  return sums;
}

Film film_of(const Json& json, int index) {
  const auto wrong = [](const std::string& what) -> void {
    throw std::invalid_argument("film: " + what);
  };
  Film film{};
  try {
    film.title = json.at("title");
    const Json& scale = json.at("scale");
    film.scale = {scale.at("length_m"), scale.at("mass_kg"), scale.at("time_s")};
    film.radius = json.at("radius_m");
    film.beam = json.at("beam_m");
    film.joint_x = json.at("joint_x_m");
    film.joint_y = json.at("joint_y_m");
    film.width = json.at("gate_m").at(0);
    film.depth = json.at("gate_m").at(1);
    film.columns = json.at("columns");
    film.rows = json.at("rows");
    const Json& from = json.at("runs").at(static_cast<std::size_t>(index));
    Run& run = film.run;
    run.label = from.at("label");
    run.ending = from.at("ending");
    run.propulsion = from.at("propulsion_N");
    const std::pair<const char*, std::vector<double>*> arrays[] = {
        {"t", &run.t},
        {"gx", &run.gx},
        {"gy", &run.gy},
        {"x", &run.x},
        {"y", &run.y},
        {"vx", &run.vx},
        {"vy", &run.vy},
        {"left", &run.left},
        {"right", &run.right},
        {"contact_left", &run.contact_left},
        {"contact_right", &run.contact_right},
        {"random_N", &run.random},
        {"body_J", &run.body},
        {"beams_J", &run.beams},
        {"elastic_J", &run.elastic},
        {"work_J", &run.work},
        {"lost_J", &run.lost}};
    for (const auto& [name, values] : arrays) {
      *values = from.at(name).get<std::vector<double>>();
      if (values->size() != run.t.size() || values->empty())
        wrong(std::string(name) + " has " + std::to_string(values->size()) + " entries, t has " +
              std::to_string(run.t.size()));
      for (const double value : *values)
        if (!std::isfinite(value)) wrong(std::string(name) + " holds what is no number");
    }
  } catch (const Json::exception& e) {
    wrong(e.what());
  }
  for (const double length : {film.radius, film.beam, film.width, film.depth})
    if (!(length > 0.0)) wrong("a length is not above 0");
  for (const double unit : {film.scale.length, film.scale.mass, film.scale.time})
    if (!(unit > 0.0)) wrong("a unit of its scale is not above 0");
  if (film.columns < 1 || film.rows < 1) wrong("a field without gates");
  Run& run = film.run;
  if (!std::is_sorted(run.t.begin(), run.t.end())) wrong("t goes back in time");
  for (const auto* contacts : {&run.contact_left, &run.contact_right})
    for (const double c : *contacts)
      if (c != 0.0 && c != 1.0 && c != 2.0) wrong("a contact is none of 0, 1, 2");
  for (std::size_t i = 0; i < run.t.size(); ++i) {
    run.X.push_back(run.x[i] + film.width * run.gx[i]);
    run.Y.push_back(run.y[i] + film.depth * run.gy[i]);
  }
  run.sum_X = integral(run.t, run.X);
  run.sum_Y = integral(run.t, run.Y);
  return film;
}

// ---- Where everything is at a time; the same rules as in web/replay.js

/// The last entry at or before a time, and how far it is from there to the next.
struct Moment {
  std::size_t i = 0, j = 0;
  double part = 0.0;

  [[nodiscard]] double between(const std::vector<double>& values) const {
    return values[i] + part * (values[j] - values[i]);
  }
};

Moment moment_at(const Run& run, double time) {
  const auto later = std::upper_bound(run.t.begin(), run.t.end(), time);
  Moment m;
  m.i = later == run.t.begin() ? 0 : static_cast<std::size_t>(later - run.t.begin()) - 1;
  m.j = std::min(m.i + 1, run.t.size() - 1);
  const double step = run.t[m.j] - run.t[m.i];
  m.part = step > 0.0 ? std::clamp((time - run.t[m.i]) / step, 0.0, 1.0) : 0.0;
  return m;
}

struct Point {
  double x, y;
};

enum Side { kLeft, kRight };

struct Segment {
  Point joint, tip;
};

Segment beam_of(const Film& film, double gx, double gy, Side side, double angle) {
  const double sign = side == kLeft ? 1.0 : -1.0;
  const Point joint{-sign * film.joint_x + film.width * gx, film.joint_y + film.depth * gy};
  return {joint,
          {joint.x + sign * film.beam * std::cos(angle), joint.y + film.beam * std::sin(angle)}};
}

Point nearest(const Segment& s, Point p) {
  const double dx = s.tip.x - s.joint.x, dy = s.tip.y - s.joint.y;
  const double part =
      std::clamp(((p.x - s.joint.x) * dx + (p.y - s.joint.y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
  return {s.joint.x + part * dx, s.joint.y + part * dy};
}

struct State {
  double time;
  Moment moment;
  double gx, gy;
  Point body;
  std::array<double, 2> angle;  // rad
  std::array<int, 2> contact;   // 0 free, 1 hit, 2 held
  std::array<int, 2> last_hit;  // entry, -1: none so far
};

State state_at(const Run& run, double time) {
  State s{};
  s.time = time;
  const Moment m = s.moment = moment_at(run, time);
  s.gx = run.gx[m.i];
  s.gy = run.gy[m.i];
  s.body = {m.between(run.X), m.between(run.Y)};
  // In another gate other beams are the moving ones: those left behind keep their last angle until
  // then.
  const bool same_gate = run.gx[m.j] == s.gx && run.gy[m.j] == s.gy;
  for (const Side side : {kLeft, kRight}) {
    const auto& angles = side == kLeft ? run.left : run.right;
    const auto& contacts = side == kLeft ? run.contact_left : run.contact_right;
    s.angle[side] = same_gate ? m.between(angles) : angles[m.i];
    s.contact[side] = static_cast<int>(contacts[m.i]);
    s.last_hit[side] = static_cast<int>(m.i);
    while (s.last_hit[side] >= 0 && contacts[static_cast<std::size_t>(s.last_hit[side])] != 1.0)
      --s.last_hit[side];
  }
  return s;
}

/// The body's mean place around a time: what a calm camera looks at.
Point calm_place(const Film& film, double time) {
  const Run& run = film.run;
  const double most = 0.75 * film.scale.time;  // before and after
  const double reach = std::min({most, time - run.t.front(), run.t.back() - time});
  const Moment now = moment_at(run, time);
  if (!(reach > 1e-6 * film.scale.time)) return {now.between(run.X), now.between(run.Y)};
  const auto up_to = [&](const std::vector<double>& sums, const std::vector<double>& values,
                         double at) {
    const Moment m = moment_at(run, at);
    return sums[m.i] + 0.5 * (at - run.t[m.i]) * (values[m.i] + m.between(values));
  };
  const auto mean = [&](const std::vector<double>& sums, const std::vector<double>& values) {
    return (up_to(sums, values, time + reach) - up_to(sums, values, time - reach)) / (2.0 * reach);
  };
  return {mean(run.sum_X, run.X), mean(run.sum_Y, run.Y)};
}

// ---- The picture

constexpr int kWidth = 1280, kHeight = 720;  // points
constexpr std::array<const char*, 3> kContactNames{"free", "hit", "held"};

struct Colour {
  double red, green, blue;
};
constexpr Colour rgb(int hex) {
  return {(hex >> 16) / 255.0, (hex >> 8 & 255) / 255.0, (hex & 255) / 255.0};
}
// Those of web/replay.js.
constexpr Colour kText = rgb(0x1b1f24), kMuted = rgb(0x59626d), kLine = rgb(0xd5dae0),
                 kPaper = rgb(0xffffff), kStage = rgb(0xf5f7f9), kBlue = rgb(0x0072b2),
                 kRed = rgb(0xc8401c), kOrange = rgb(0xd98300), kGrey = rgb(0x7b858f),
                 kGreen = rgb(0x00805c), kSky = rgb(0x2b8fc9), kPurple = rgb(0xa8447f),
                 kDisc = rgb(0xdfe4ea), kEdge = rgb(0x2c333b);

/// A text for the picture: with a true minus sign.
std::string shown(std::string text) {
  if (const std::size_t minus = text.starts_with('>') ? 1 : 0; text[minus] == '-')
    text.replace(minus, 1, "−");
  return text;
}

std::string whole(double x) { return shown(std::to_string(std::lround(x))); }

struct Box {
  double x0, y0, x1, y1;
};

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

class Picture {
 public:
  /// `pace`: units of the scene's time in a second of the film.
  Picture(const Film& film, double pace, bool labels)
      : film_(film),
        run_(film.run),
        unit_(film.scale),
        pace_(pace),
        labels_(labels),
        surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, kWidth, kHeight),
                 cairo_surface_destroy),
        cr_(cairo_create(surface_.get()), cairo_destroy) {
    check();
    std::vector<double> draws;
    for (const double f : run_.random) draws.push_back(std::abs(f));
    const auto few =
        draws.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(draws.size() - 1));
    std::nth_element(draws.begin(), few, draws.end());
    // The larger of propulsion and of what few draws exceed spans two radii.
    if (const double strong = std::max(*few, std::abs(run_.propulsion)); strong > 0.0)
      arrow_ = 2.0 * film.radius / strong;
    for (std::size_t i = 0; i < run_.t.size(); ++i) {
      stored_ = std::max({stored_, run_.body[i], run_.beams[i], run_.elastic[i]});
      moved_ = std::max({moved_, run_.work[i], run_.lost[i]});
    }
  }

  /// The picture at a time: rows of blue, green, red, nothing.
  std::string_view draw(double time) {
    const State state = state_at(run_, time);
    fill({0, 0, kWidth, kHeight}, kPaper);
    text(32, 46, 24, film_.title, kText, true, kWidth - 64);
    text(32, 72, 16, run_.label, kMuted, false, kWidth - 64);
    const Box whole = bounds();
    constexpr Box kArea{32, 92, 920, kHeight - 28};
    if (film_.is_field()) {
      // The field on the left, what the following camera sees on the right.
      const double fit = (kArea.y1 - kArea.y0) * (whole.x1 - whole.x0) / (whole.y1 - whole.y0);
      const double middle = kArea.x0 + std::clamp(fit, 120.0, 440.0);
      stage({kArea.x0, kArea.y0, middle, kArea.y1}, state, whole);
      const Point centre = calm_place(film_, time);
      const double half_x = 1.15 * film_.width, half_y = 0.95 * film_.depth;
      stage({middle + 16, kArea.y0, kArea.x1, kArea.y1}, state,
            {centre.x - half_x, centre.y - half_y, centre.x + half_x, centre.y + half_y});
    } else {
      stage(kArea, state, whole);
    }
    // Words and numbers change ten times in a second of the film, so that they can be read.
    const double word = 0.1 * pace_ * unit_.time, start = run_.t.front();
    const double said = start + word * std::floor((time - start) / word + 1e-9);
    panel(952, state, time < run_.t.back() ? state_at(run_, said) : state);
    check();
    cairo_surface_flush(surface_.get());
    return {reinterpret_cast<const char*>(cairo_image_surface_get_data(surface_.get())),
            static_cast<std::size_t>(cairo_image_surface_get_stride(surface_.get())) * kHeight};
  }

 private:
  void check() const {
    cairo_status_t status = cairo_status(cr_.get());
    if (status != CAIRO_STATUS_SUCCESS)
      throw std::runtime_error(std::string("cairo cannot draw: ") + cairo_status_to_string(status));
  }

  // Paint
  void colour(Colour c, double alpha = 1.0) {
    cairo_set_source_rgba(cr_.get(), c.red, c.green, c.blue, alpha);
  }
  void fill(const Box& b, Colour c) {
    cairo_rectangle(cr_.get(), b.x0, b.y0, b.x1 - b.x0, b.y1 - b.y0);
    colour(c);
    cairo_fill(cr_.get());
  }
  void stroke(Colour c, double width, double alpha = 1.0) {
    colour(c, alpha);
    cairo_set_line_width(cr_.get(), width);
    cairo_stroke(cr_.get());
  }
  void circle(Point p, double r) {
    cairo_new_sub_path(cr_.get());
    cairo_arc(cr_.get(), p.x, p.y, r, 0.0, 2.0 * std::numbers::pi);
  }
  void line(Point a, Point b, Colour c, double width, double alpha = 1.0) {
    cairo_move_to(cr_.get(), a.x, a.y);
    cairo_line_to(cr_.get(), b.x, b.y);
    stroke(c, width, alpha);
  }
  void arrow(Point a, Point b, Colour c, double thick) {
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    if (length < 1.0) return;
    const double ux = (b.x - a.x) / length, uy = (b.y - a.y) / length;
    const double head = std::min(0.6 * length, std::max(6.0, 2.6 * thick));
    line(a, {b.x - 0.8 * head * ux, b.y - 0.8 * head * uy}, c, std::max(1.5, 0.7 * thick));
    cairo_move_to(cr_.get(), b.x, b.y);
    cairo_line_to(cr_.get(), b.x - head * ux - 0.5 * head * uy, b.y - head * uy + 0.5 * head * ux);
    cairo_line_to(cr_.get(), b.x - head * ux + 0.5 * head * uy, b.y - head * uy - 0.5 * head * ux);
    cairo_close_path(cr_.get());
    colour(c);
    cairo_fill(cr_.get());
  }
  /// How wide a text is, in points, in the font that is set.
  [[nodiscard]] double width_of(const std::string& words) const {
    cairo_text_extents_t extents;
    cairo_text_extents(cr_.get(), words.c_str(), &extents);
    return extents.x_advance;
  }
  /// Text from x on, or up to x for a width below 0; what is wider than `width` loses its end.
  void text(double x, double y, double size, std::string words, Colour c, bool bold = false,
            double width = 1e9) {
    if (!labels_) return;
    cairo_select_font_face(cr_.get(), "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cr_.get(), size);
    if (width_of(words) > std::abs(width)) {
      do {
        // A character of UTF-8 goes as a whole.
        while (!words.empty() && (words.back() & 0xC0) == 0x80) words.pop_back();
        if (!words.empty()) words.pop_back();
      } while (!words.empty() && width_of(words + "…") > std::abs(width));
      words += "…";
    }
    cairo_move_to(cr_.get(), width < 0.0 ? x - width_of(words) : x, y);
    colour(c);
    cairo_show_text(cr_.get(), words.c_str());
  }

  /// The field, or one gate with all places that the run visits.
  [[nodiscard]] Box bounds() const {
    const double margin = 3.0 * unit_.length;
    if (film_.is_field())
      return {(film_.first_column() - 0.5) * film_.width - margin, -film_.radius - margin,
              (film_.first_column() + film_.columns - 0.5) * film_.width + margin,
              film_.rows * film_.depth + film_.radius + margin};
    const auto [left, right] = std::minmax_element(run_.X.begin(), run_.X.end());
    const auto [low, high] = std::minmax_element(run_.Y.begin(), run_.Y.end());
    const double half =
        std::max({film_.joint_x, -*left + film_.radius, *right + film_.radius}) + margin;
    return {-half, std::min(0.0, *low - film_.radius) - margin, half,
            std::max(film_.joint_y + film_.beam, *high + film_.radius) + margin};
  }

  /// The body among the beams in a part of the picture, which shows at least the part `seen` (m) of
  /// the world.
  void stage(const Box& box, const State& s, const Box& seen) {
    cairo_t* const cr = cr_.get();
    const double w = box.x1 - box.x0, h = box.y1 - box.y0;
    const double scale = std::min(w / (seen.x1 - seen.x0), h / (seen.y1 - seen.y0));
    const Point centre{0.5 * (seen.x0 + seen.x1), 0.5 * (seen.y0 + seen.y1)};
    const auto at = [&](Point p) -> Point {
      return {0.5 * (box.x0 + box.x1) + (p.x - centre.x) * scale,
              0.5 * (box.y0 + box.y1) - (p.y - centre.y) * scale};
    };
    const double thick = std::clamp(0.9 * unit_.length * scale, 1.5, 5.0);
    cairo_save(cr);
    fill(box, kStage);
    cairo_rectangle(cr, box.x0, box.y0, w, h);
    cairo_clip(cr);
    cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);

    // Borders of the gates in sight, and their beams at rest. Of a gate alone only its sides are
    // borders.
    const double x0 = centre.x - 0.5 * w / scale, x1 = centre.x + 0.5 * w / scale;
    const double y0 = centre.y - 0.5 * h / scale, y1 = centre.y + 0.5 * h / scale;
    const int first =
        std::max(film_.first_column(), static_cast<int>(std::floor(x0 / film_.width - 0.5)));
    const int last = std::min(film_.first_column() + film_.columns - 1,
                              static_cast<int>(std::ceil(x1 / film_.width + 0.5)));
    const int low = std::max(0, static_cast<int>(std::floor(y0 / film_.depth - 1.0)));
    const int high = std::min(film_.rows - 1, static_cast<int>(std::ceil(y1 / film_.depth)));
    const double bottom = film_.is_field() ? low * film_.depth : y0;
    const double top = film_.is_field() ? (high + 1) * film_.depth : y1;
    const double dashes[] = {film_.width * scale > 60.0 ? 5.0 : 3.0};
    cairo_set_line_cap(cr, CAIRO_LINE_CAP_BUTT);
    cairo_set_dash(cr, dashes, 1, 0.0);
    if (film_.width * scale > 6.0)
      for (int k = first; k <= last + 1; ++k)
        line(at({(k - 0.5) * film_.width, bottom}), at({(k - 0.5) * film_.width, top}), kGreen, 1.2,
             0.55);
    if (film_.is_field() && film_.depth * scale > 6.0)
      for (int k = low; k <= high + 1; ++k)
        line(at({(first - 0.5) * film_.width, k * film_.depth}),
             at({(last + 0.5) * film_.width, k * film_.depth}), kGreen, 1.2, 0.55);
    cairo_set_dash(cr, nullptr, 0, 0.0);
    cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
    if (film_.is_field() && film_.width * scale > 12.0)
      for (int gx = first; gx <= last; ++gx)
        for (int gy = low; gy <= high; ++gy)
          for (const Side side : {kLeft, kRight}) {
            if (gx == s.gx && gy == s.gy) continue;
            const Segment beam = beam_of(film_, gx, gy, side, 0.0);
            line(at(beam.joint), at(beam.tip), side == kLeft ? kBlue : kRed,
                 std::max(1.2, 0.6 * thick), 0.45);
          }

    // The trail: all of it faintly, the last part strongly.
    circle(at({run_.X[0], run_.Y[0]}), 3.5);
    stroke(kMuted, 1.5);
    const auto trail = [&](std::size_t from, double width) {
      Point before = at({run_.X[from], run_.Y[from]});
      cairo_move_to(cr, before.x, before.y);
      for (std::size_t k = from + 1; k <= s.moment.i; ++k) {
        const Point p = at({run_.X[k], run_.Y[k]});
        if (std::abs(p.x - before.x) + std::abs(p.y - before.y) < 0.7) continue;
        cairo_line_to(cr, p.x, p.y);
        before = p;
      }
      const Point now = at(s.body);
      cairo_line_to(cr, now.x, now.y);
      stroke(kText, width, 0.5);
    };
    const double wake = 1.5 * unit_.time;  // of the trail is drawn strongly
    trail(0, 1.6);
    trail(moment_at(run_, s.time - wake).i, 2.2);

    circle(at(s.body), film_.radius * scale);
    colour(kDisc, 0.88);
    cairo_fill_preserve(cr);
    stroke(kEdge, std::clamp(0.4 * unit_.length * scale, 1.2, 2.0));

    // The gate's beams, with what touches.
    for (const Side side : {kLeft, kRight}) {
      const Segment beam = beam_of(film_, s.gx, s.gy, side, s.angle[side]);
      const Colour own = side == kLeft ? kBlue : kRed;
      const bool held = s.contact[side] == 2;
      line(at(beam.joint), at(beam.tip), own, held ? 1.5 * thick : thick);
      circle(at(beam.joint), 1.1 * thick);
      colour(kEdge);
      cairo_fill(cr);
      if (held) {
        circle(at(nearest(beam, s.body)), 1.5 * thick);
        colour(kStage);
        cairo_fill_preserve(cr);
        stroke(own, 0.7 * thick);
      }
      // time of the run for which a hit stays to be seen
      const double flash = 0.25 * std::max(1.0, pace_) * unit_.time;
      if (s.last_hit[side] < 0) continue;
      const auto i = static_cast<std::size_t>(s.last_hit[side]);
      const double grown = (s.time - run_.t[i]) / flash;
      if (grown > 1.0) continue;
      const Segment then = beam_of(film_, run_.gx[i], run_.gy[i], side,
                                   side == kLeft ? run_.left[i] : run_.right[i]);
      circle(at(nearest(then, {run_.X[i], run_.Y[i]})), thick * (1.6 + 2.6 * grown));
      stroke(own, 2.0, 0.9 * (1.0 - grown));
    }

    const Point body = at(s.body);
    arrow(body, {body.x + arrow_ * run_.random[s.moment.i] * scale, body.y}, kGrey, thick);
    arrow(body, {body.x, body.y - arrow_ * run_.propulsion * scale}, kOrange, thick);
    circle(body, std::max(1.5, 0.6 * thick));
    colour(kEdge);
    cairo_fill(cr);

    if (labels_) rule(box, scale);
    cairo_restore(cr);
  }

  /// A rule: the longest of 1, 2, 5, 10, ... m that takes a fifth of the width at `scale` points a
  /// metre.
  void rule(const Box& box, double scale) {
    cairo_t* const cr = cr_.get();
    const double w = box.x1 - box.x0;
    const double wanted = 0.2 * w / scale, power = std::pow(10.0, std::floor(std::log10(wanted)));
    const double length = power * (5.0 * power <= wanted ? 5.0 : 2.0 * power <= wanted ? 2.0 : 1.0);
    cairo_rectangle(cr, box.x0 + 6, box.y1 - 36, length * scale + 16, 32);
    colour(kStage, 0.85);
    cairo_fill(cr);
    text(box.x0 + 14, box.y1 - 18, 14, quantity(length, "m"), kMuted);
    cairo_set_line_cap(cr, CAIRO_LINE_CAP_BUTT);
    line({box.x0 + 14, box.y1 - 12}, {box.x0 + 14 + length * scale, box.y1 - 12}, kMuted, 2.0);
  }

  /// Time, contacts, forces and energies, from x on: bars of now, words and numbers of `s`.
  void panel(double x, const State& now, const State& s) {
    constexpr double kRightEdge = kWidth - 32.0;
    const Moment& m = s.moment;
    text(x, 124, 40, shown(reading(now.time, "s", 0.01 * unit_.time)), kText, true);
    const bool ended = now.time >= run_.t.back();
    if (ended)
      text(x, 154, 17, "ended: " + run_.ending, kText, true, kRightEdge - x);
    else if (film_.is_field())
      text(x, 154, 17, "gate: column " + whole(s.gx) + ", row " + whole(s.gy), kMuted);
    double y = 196;
    const auto force = [&](double newton) {
      return shown(reading(newton, "N", 0.1 * unit_.force()));
    };
    const auto row = [&](Colour c, bool is_arrow, const std::string& name,
                         const std::string& value) {
      if (is_arrow)
        arrow({x, y - 5}, {x + 26, y - 5}, c, 4.0);
      else
        line({x, y - 5}, {x + 26, y - 5}, c, 4.0);
      text(x + 38, y, 16, name, kText);
      text(kRightEdge, y, 16, value, kText, false, -160);
      y += 27;
    };
    for (const Side side : {kLeft, kRight}) {
      // A hit is named for a moment.
      const int hit = s.last_hit[side];
      const bool just_hit =
          hit >= 0 && s.time - run_.t[static_cast<std::size_t>(hit)] < 0.1 * pace_ * unit_.time;
      const int contact = s.contact[side] == 0 && just_hit ? 1 : s.contact[side];
      row(side == kLeft ? kBlue : kRed, false, side == kLeft ? "left beam" : "right beam",
          std::string(kContactNames[static_cast<std::size_t>(contact)]) + ", " +
              whole(s.angle[side] * 180.0 / std::numbers::pi) + "°");
    }
    row(kOrange, true, "propulsion", force(run_.propulsion));
    row(kGrey, true, "random force", force(run_.random[m.i]));
    text(x + 38, y, 16, "speed", kText);
    const double speed = std::hypot(m.between(run_.vx), m.between(run_.vy));
    text(kRightEdge, y, 16, reading(speed, "m/s", 0.1 * unit_.speed()), kText, false, -160);
    y += 48;

    const auto bar = [&](const std::string& name, const std::vector<double>& energy, double most,
                         Colour c) {
      const double step = step_of(0.1 * unit_.energy(), most);
      const double joules = now.moment.between(energy);
      text(x, y, 16, name, kText);
      text(kRightEdge, y, 16, shown(reading(m.between(energy), "J", step)), kText, false, -160);
      fill({x, y + 7, kRightEdge, y + 15}, kLine);
      if (most > 0.0)
        fill({x, y + 7, x + std::clamp(joules / most, 0.0, 1.0) * (kRightEdge - x), y + 15}, c);
      y += 40;
    };
    text(x, y, 16, "Energy stored now", kText, true);
    y += 28;
    bar("body, kinetic", run_.body, stored_, kText);
    bar("beams, kinetic", run_.beams, stored_, kSky);
    bar("beams, elastic", run_.elastic, stored_, kGreen);
    y += 10;
    text(x, y, 16, "Put in and lost since the start", kText, true);
    y += 28;
    bar("work put in", run_.work, moved_, kOrange);
    bar("lost", run_.lost, moved_, kPurple);
  }

  const Film& film_;
  const Run& run_;
  const dynamics::Scale unit_;
  double pace_;
  bool labels_;
  Surface surface_;
  Context cr_;
  double arrow_ = 0.0;                 // m per N
  double stored_ = 0.0, moved_ = 0.0;  // J, the bars' full lengths
};

// ---- ffmpeg

/// Pictures on their way to ffmpeg. A pair of sockets and no pipe: when ffmpeg has gone away,
/// writing is an error without a signal, and one that does not read leaves time to look at ctrl-C.
class Conveyor {
 public:
  Conveyor() {
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends_.data()) != 0)
      throw std::runtime_error(std::string("ffmpeg cannot be run: no sockets: ") +
                               std::strerror(errno));
    const timeval patience{0, 100'000};
    ::setsockopt(ends_[0], SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  }
  ~Conveyor() {
    close(ends_[0]);
    close(ends_[1]);
  }
  Conveyor(const Conveyor&) = delete;
  Conveyor& operator=(const Conveyor&) = delete;

  [[nodiscard]] int exit() const { return ends_[1]; }
  /// Once ffmpeg holds it.
  void close_exit() { close(ends_[1]); }
  /// No more pictures.
  void close_entry() { close(ends_[0]); }
  /// False when ffmpeg reads no more. Throws Interrupted after a signal.
  [[nodiscard]] bool send(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(ends_[0], bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent > 0) {
        bytes.remove_prefix(static_cast<std::size_t>(sent));
        continue;
      }
      if (interrupted()) throw Interrupted{};
      if (sent < 0 && errno != EINTR && errno != EAGAIN && errno != EWOULDBLOCK) return false;
    }
    return true;
  }

 private:
  static void close(int& fd) {
    if (fd >= 0) ::close(fd);
    fd = -1;
  }
  std::array<int, 2> ends_{-1, -1};
};

/// Pictures from all over the film that go ahead of a GIF: its 64 colours are chosen from them.
constexpr std::int64_t kPaletteFrames = 32;

std::vector<std::string> ffmpeg_command(const Film& film, VideoFormat format,
                                        double frames_per_second) {
  std::vector<std::string> command{"ffmpeg", "-hide_banner", "-loglevel", "error", "-nostdin", "-y",
                                   // Pictures as cairo keeps them, without a header.
                                   "-f", "rawvideo", "-pixel_format", "bgr0", "-video_size",
                                   std::to_string(kWidth) + "x" + std::to_string(kHeight),
                                   "-framerate", std::to_string(frames_per_second), "-i", "pipe:0",
                                   "-an"};
  const std::vector<std::string> mp4{
      "-c:v", "libx264", "-preset", "veryfast", "-crf", "20",
      // Players take HD pictures for BT.709 ones.
      "-vf", "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p", "-colorspace", "bt709",
      "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv", "-metadata",
      "title=" + film.title + ": " + film.run.label,
      // Its standard output is a file: the index can be moved to the front.
      "-movflags", "+faststart", "-f", "mp4", "file:/dev/stdout"};
  const std::string ahead = std::to_string(kPaletteFrames);
  const std::vector<std::string> gif{
      "-filter_complex",
      // The colours are known before the film begins, so that ffmpeg need not keep it in memory.
      // Without dither what does not move stays the same, and costs nothing.
      "[0:v]scale=800:-1:flags=area,split[a][b];[a]trim=end_frame=" + ahead +
          ",palettegen=max_colors=64[colours];[b]trim=start_frame=" + ahead +
          ",setpts=PTS-STARTPTS[film];[film][colours]paletteuse=dither=none:diff_mode=rectangle",
      "-loop", "0", "-f", "gif", "file:/dev/stdout"};
  const auto& packing = format == VideoFormat::gif ? gif : mp4;
  command.insert(command.end(), packing.begin(), packing.end());
  return command;
}

}  // namespace

namespace {

/// The film and how fast it goes. Throws std::invalid_argument.
std::pair<Film, double> film_and_pace(const Json& json, int run, const VideoOptions& options) {
  if (options.speed && (!(*options.speed > 0.0) || !std::isfinite(*options.speed)))
    throw std::invalid_argument("a video's speed must be above 0");
  if (const double rate = options.frames_per_second.value_or(50.0); !(rate >= 1.0 && rate <= 240.0))
    throw std::invalid_argument("a video has 1 to 240 frames a second");
  if (run < 0) throw std::invalid_argument("film: no run " + std::to_string(run));
  Film film = film_of(json, run);
  const double pace = options.speed ? *options.speed / film.scale.time : 1.0;
  return {std::move(film), pace};
}

}  // namespace

VideoFormat video_format(const std::string& path) {
  if (path.ends_with(".mp4")) return VideoFormat::mp4;
  if (path.ends_with(".gif")) return VideoFormat::gif;
  throw std::invalid_argument(path + ": a video is FILE.mp4 or FILE.gif");
}

std::string video_frame(const Json& json, int run, double time, const VideoOptions& options) {
  const auto [film, pace] = film_and_pace(json, run, options);
  return std::string(Picture(film, pace, options.labels)
                         .draw(std::clamp(time, film.run.t.front(), film.run.t.back())));
}

void write_video(const std::string& path, const Json& json, int run, const VideoOptions& options) {
  const auto [film, pace] = film_and_pace(json, run, options);
  const VideoFormat format = video_format(path);
  const double frames_per_second =
      options.frames_per_second.value_or(format == VideoFormat::gif ? 10 : 50.0);
  require_writable(path);

  Picture picture(film, pace, options.labels);
  Conveyor conveyor;
  Child ffmpeg(ffmpeg_command(film, format, frames_per_second), conveyor.exit(),
               "ffmpeg was not found; it packs the video (Debian: ffmpeg)");
  conveyor.close_exit();

  const double start = film.run.t.front(), end = film.run.t.back(),
               step = pace * film.scale.time / frames_per_second;
  const auto frames = static_cast<std::int64_t>(std::ceil((end - start) / step - 1e-9)) + 1 +
                      static_cast<std::int64_t>(frames_per_second);  // the last one stands
  bool reads = true;
  if (format == VideoFormat::gif)
    for (std::int64_t k = 0; k < kPaletteFrames && reads; ++k)
      reads = conveyor.send(picture.draw(start + static_cast<double>(k) * (end - start) /
                                                     static_cast<double>(kPaletteFrames - 1)));
  run_in_batches(
      "video, frames", frames, options.show_progress, [&](std::int64_t first, std::int64_t count) {
        for (std::int64_t k = first; k < first + count && reads; ++k)
          reads = conveyor.send(picture.draw(std::min(end, start + static_cast<double>(k) * step)));
      });
  conveyor.close_entry();
  while (ffmpeg.runs()) {
    if (interrupted()) throw Interrupted{};
    ::usleep(5'000);
  }
  const std::string video = ffmpeg.output();
  if (!reads) throw std::runtime_error("ffmpeg stopped reading before the end");
  write_text_atomically(path, video);
}

}  // namespace gatewalk::cli
