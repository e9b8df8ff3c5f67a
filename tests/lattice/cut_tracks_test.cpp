// SPDX-License-Identifier: MIT
// Tracks with known paths, cut at the borders of cells.
#include "lattice/recorded/cut_tracks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "dynamics/base/random.h"
#include "lattice/recorded/crossings.h"
#include "lattice/recorded/smooth_path.h"

namespace gatewalk::lattice {
namespace {

constexpr double kFps = 120.0, kSize = 0.1;  // 1/s, m
constexpr int kFaceS = 0, kFaceN = 1, kFaceW = 2, kFaceE = 3;

/// Squares of size kSize with the coordinates s, vx, vy.
CellFile squares() {
  CellFile cell;
  cell.source = "cell.toml";
  cell.map.section.faces = {{"S", 0, 1, 0, 0b011, "from below", {}},
                            {"N", 0, -1, 1, 0b011, "from above", {}},
                            {"W", 1, 0, 3, 0b010, "from the left", {}},
                            {"E", -1, 0, 2, 0b010, "from the right", {}}};
  cell.map.section.coordinates = {{"s", "s_m", "m", "s", 1.0},
                                  {"vx", "vx_m_per_s", "m/s", "vx", 1.0},
                                  {"vy", "vy_m_per_s", "m s-1", "vy", 1.0}};
  cell.map.section.costs = {{"time_s", "s", "duration"}};
  cell.map.types = {{true}};
  cell.types = {"cell"};
  cell.has_scale = {false, false, false};
  cell.width = cell.length = kSize;
  return cell;
}

struct Place {
  double x, y;
};
using Way = std::function<Place(double time)>;

TrackFile file_of(const std::vector<Way>& ways, int frames, double noise = 0.0) {
  TrackFile file;
  file.source = "t.csv";
  file.interval = 1.0 / kFps;
  for (std::size_t b = 0; b < ways.size(); ++b) {
    Track track{"b" + std::to_string(b), {}, {}, {}};
    dynamics::Random random(dynamics::Purpose::row, {7, b, 0});
    for (int i = 0; i < frames; ++i) {
      const double t = i / kFps;
      const Place at = ways[b](t);
      track.time.push_back(t);
      track.x.push_back(at.x + noise * random.normal());
      track.y.push_back(at.y + noise * random.normal());
    }
    file.tracks.push_back(track);
  }
  return file;
}
Way straight(Place from, double vx, double vy) {
  return [=](double t) { return Place{from.x + vx * t, from.y + vy * t}; };
}
Way circle(Place middle, double radius, double speed, double phase = 0.0) {
  return [=](double t) {
    const double a = phase + speed / radius * t;
    return Place{middle.x + radius * std::cos(a), middle.y + radius * std::sin(a)};
  };
}
/// Removes frames first to last - 1 from the first track.
void hide(TrackFile& file, int first, int last) {
  Track& t = file.tracks[0];
  for (auto* values : {&t.time, &t.x, &t.y})
    values->erase(values->begin() + first, values->begin() + last);
}
/// In cells without end.
CutOptions fast(double fastest = 100.0) { return {.fastest = fastest, .endless = true}; }
std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "nothing refused";
}
std::string refusal(const TrackFile& file, const CellFile& cell, const CutOptions& options) {
  return refusal([&] { (void)cut_tracks(file, cell, options); });
}
#define EXPECT_REFUSED(words, ...)                          \
  do {                                                      \
    const std::string said = refusal(__VA_ARGS__);          \
    EXPECT_NE(said.find(words), std::string::npos) << said; \
  } while (false)

/// A body with an Ornstein-Uhlenbeck velocity along each axis, as the smoother assumes: the true
/// places, and the track with noise.
struct Wanderer {
  Track truth{"w", {}, {}, {}}, seen{"w", {}, {}, {}};
  std::vector<double> vx;  // m/s, by frame
  Wanderer(int frames, double speed, double rate, double noise, std::uint64_t seed) {
    dynamics::Random random(dynamics::Purpose::row, {8, seed, 0});
    constexpr int kParts = 20;  // of a step
    const double dt = 1.0 / (kParts * kFps);
    std::array<double, 2> at{}, v{speed * random.normal(), speed * random.normal()};
    for (int i = 0; i < frames; ++i) {
      truth.time.push_back(i / kFps);
      truth.x.push_back(at[0]);
      truth.y.push_back(at[1]);
      vx.push_back(v[0]);
      for (int part = 0; part < kParts; ++part)
        for (std::size_t k = 0; k < 2; ++k) {
          v[k] += -rate * v[k] * dt + speed * std::sqrt(2.0 * rate * dt) * random.normal();
          at[k] += v[k] * dt;
        }
    }
    seen = truth;
    for (auto* places : {&seen.x, &seen.y})
      for (double& place : *places) place += noise * random.normal();
  }
};

TEST(SmoothPath, NoiseSpeedAndAccelerationsAreFound) {
  const double speed = 0.06, rate = 2.0;
  for (const double noise : {0.0005, 0.002}) {
    std::vector<Wanderer> bodies;
    std::vector<TrackPiece> pieces;
    for (std::uint64_t b = 0; b < 20; ++b) bodies.emplace_back(3000, speed, rate, noise, b);
    for (const Wanderer& w : bodies) pieces.push_back({&w.seen, 0, w.seen.time.size()});
    const TrackNoise found = noise_of(pieces);
    EXPECT_NEAR(found.place, noise, 0.03 * noise);
    EXPECT_NEAR(found.square_speed, speed * speed, 0.2 * speed * speed);
    const double acceleration = 2.0 * rate * speed * speed;
    EXPECT_NEAR(found.acceleration, acceleration, 0.4 * acceleration);
    // What the smoother says of its own error is true.
    double square = 0.0, said = 0.0, square_v = 0.0, said_v = 0.0;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const SmoothPath path = smoothed(pieces[b], found);
      const Track& truth = bodies[b].truth;
      for (std::size_t i = 0; i < truth.time.size(); ++i) {
        square += std::pow(path.x[i] - truth.x[i], 2) + std::pow(path.y[i] - truth.y[i], 2);
        said += 2.0 * path.place_variance[i];
        square_v += std::pow(path.vx[i] - bodies[b].vx[i], 2);
        said_v += path.velocity_variance[i];
      }
    }
    EXPECT_NEAR(square, said, 0.15 * said);
    EXPECT_NEAR(square_v, said_v, 0.2 * said_v);
  }
}

/// The number of crossings of borders of cells of 0.06 m after which a path goes further than
/// `margin` beyond the border.
double crossings_beyond(const std::vector<double>& x, const std::vector<double>& y, double margin) {
  double count = 0.0;
  for (const auto* places : {&x, &y}) {
    constexpr double kCell = 0.06;
    int cell = cell_at((*places)[0], kCell);
    for (const double place : *places) {
      for (; place > kCell * (cell + 1) + margin; ++cell) ++count;
      for (; place < kCell * cell - margin; --cell) ++count;
    }
  }
  return count;
}

// Bodies that turn round at borders: a drawn path crosses them as often as the body, the expected
// path less often, and a rule that asks for five standard deviations much less often.
TEST(SmoothPath, DrawnPathsCrossBordersAsOftenAsBodies) {
  const double noise = 0.002;
  std::vector<Wanderer> bodies;
  std::vector<TrackPiece> seen, truth;
  for (std::uint64_t b = 0; b < 40; ++b) bodies.emplace_back(6000, 0.06, 3.0, noise, 100 + b);
  for (const Wanderer& w : bodies) {
    seen.push_back({&w.seen, 0, w.seen.time.size()});
    truth.push_back({&w.truth, 0, w.truth.time.size()});
  }
  const TrackNoise found = noise_of(seen);
  double own = 0.0, drawn = 0.0, expected = 0.0, sure = 0.0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const SmoothPath path = smoothed(seen[b], found);
    dynamics::Random random(dynamics::Purpose::row, {9, b, 0});
    const SmoothPath one = drawn_path(seen[b], found, path, random);
    own += crossings_beyond(bodies[b].truth.x, bodies[b].truth.y, 0.0);
    expected += crossings_beyond(path.x, path.y, 0.0);
    sure += crossings_beyond(path.x, path.y, 5.0 * std::sqrt(path.place_variance[3000]));
    drawn += crossings_beyond(one.x, one.y, 0.0);
  }
  EXPECT_GT(own, 3000.0);
  EXPECT_NEAR(drawn, own, 0.03 * own);
  EXPECT_LT(expected, drawn);
  EXPECT_LT(sure, 0.85 * own);
}

// A body rests for half of its time: where it rests, its path is known better.
TEST(SmoothPath, WhoRestsIsKnownBetter) {
  const auto rests = [](double t) {
    return Place{0.05 + 0.1 * std::sin(8.0 * std::min(t, 5.0)), 0.05};
  };
  const TrackFile file = file_of({rests}, 1200, 0.001);
  const TrackPiece piece{&file.tracks[0], 0, 1200};
  const SmoothPath path = smoothed(piece, noise_of({piece}));
  EXPECT_LT(path.place_variance[900], 0.25 * path.place_variance[300]);
  EXPECT_LT(path.acceleration[900], 0.01 * path.acceleration[300]);
}

TEST(CutTracks, AStraightLineIsCutWhereItCrosses) {
  // From (0.03, 0.05) with (0.1, 0.4) m/s: rows at y = 0.1, 0.2, ... after 0.125 s, 0.375 s, ...; x
  // = 0.1 after 0.7 s.
  const TrackFile file = file_of({straight({0.03, 0.05}, 0.1, 0.4)}, 121);
  const CutTracks cut = cut_tracks(file, squares(), fast());
  ASSERT_EQ(cut.passages.size(), 5U);  // rows entered at .125, .375, .625, .875 s, a column at .7
  EXPECT_EQ(cut.trials, 1);
  EXPECT_EQ(cut.first_stays, 1);
  const std::vector<double> times{0.25, 0.25, 0.075, 0.175};
  const std::vector<int> faces{kFaceS, kFaceS, kFaceW, kFaceS};
  for (std::size_t i = 0; i < 4; ++i) {
    const CutPassage& p = cut.passages[i];
    EXPECT_EQ(p.end, CutEnd::left);
    EXPECT_EQ(p.trial, 1);
    EXPECT_NEAR(p.time, times[i], 1e-7);
    EXPECT_EQ(p.out.face, faces[i]);
    EXPECT_TRUE(p.out == cut.passages[i + 1].in);
    EXPECT_NEAR(p.out.at[1], 0.1, 1e-7);
    EXPECT_NEAR(p.out.at[2], 0.4, 1e-7);
  }
  EXPECT_EQ(cut.passages[0].in.face, kFaceS);
  EXPECT_NEAR(cut.passages[0].in.at[0], 0.03 + 0.0125 - 0.05, 1e-7);
  EXPECT_NEAR(cut.passages[3].in.at[0], 0.05 + 0.4 * 0.7 - 0.35, 1e-7);  // sideways: along y
  EXPECT_NEAR(cut.passages[4].in.at[0], 0.03 + 0.0875 - 0.15, 1e-7);     // in the next column
  EXPECT_EQ(cut.passages[4].end, CutEnd::lost);
  EXPECT_EQ(cut.passages[4].lost_by, LostBy::end);
  EXPECT_NEAR(cut.passages[4].time, 0.125, 1e-7);
  EXPECT_LT(cut.noise.place, 1e-12);
}

TEST(CutTracks, OtherCoordinates) {
  CellFile cell = squares();
  cell.map.section.coordinates = {{"heading", "heading_rad", "rad", "heading", 1.0},
                                  {"speed", "speed_m_per_s", "m/s", "speed", 1.0}};
  for (auto& face : cell.map.section.faces) face.odd = 0b01;
  const CutTracks cut = cut_tracks(file_of({straight({0.05, 0.05}, 0.3, 0.4)}, 60), cell, fast());
  EXPECT_NEAR(cut.passages[0].in.at[0], std::atan2(0.3, 0.4), 1e-7);
  EXPECT_NEAR(cut.passages[0].in.at[1], 0.5, 1e-7);
  EXPECT_EQ(cut.passages[0].in.at[2], 0.0);
}

// Places and velocities where a circle without noise crosses the lines. What is drawn are the
// accelerations within a step, in which the velocity turns by omega / kFps.
TEST(CutTracks, ACircleIsCutWhereItCrosses) {
  const double radius = 0.07, speed = 0.5, omega = speed / radius, turn = omega / kFps;
  const Place middle{0.11, 0.12};
  const CutTracks cut =
      cut_tracks(file_of({circle(middle, radius, speed, 0.3)}, 240), squares(), fast());
  ASSERT_GT(cut.passages.size(), 6U);
  const double off_v = speed * turn, off_x = 0.5 * radius * turn * turn;
  for (const CutPassage& p : cut.passages) {
    const bool upright = p.in.face <= kFaceN;
    const double border =
        upright ? std::round(p.from[1] / kSize) * kSize : std::round(p.from[0] / kSize) * kSize;
    EXPECT_NEAR(upright ? p.from[1] : p.from[0], border, 1e-12);
    // The place on the circle with this x or y, on the side where the body crossed.
    const double away = upright ? border - middle.y : border - middle.x;
    const double along = std::sqrt(radius * radius - away * away);
    const double other = upright ? p.from[0] - middle.x : p.from[1] - middle.y;
    const double x = upright ? std::copysign(along, other) : away;
    const double y = upright ? away : std::copysign(along, other);
    // The error along a border is the error across it times the slope.
    const double slope = 1.0 + std::abs(away / along);
    EXPECT_NEAR(std::abs(other), along, slope * off_x);
    EXPECT_NEAR(p.in.at[1], -omega * y, off_v + omega * slope * off_x);
    EXPECT_NEAR(p.in.at[2], omega * x, off_v + omega * slope * off_x);
    EXPECT_NEAR(p.in.at[0],
                upright ? middle.x + x - (std::floor(p.from[0] / kSize) + 0.5) * kSize
                        : middle.y + y - (std::floor(p.from[1] / kSize) + 0.5) * kSize,
                slope * off_x);
  }
  // The sum of the times is that of the lap.
  double lap = 0.0;
  for (std::size_t i = 1; i <= 4; ++i) lap += cut.passages[i].time;
  EXPECT_NEAR(lap, 2.0 * std::numbers::pi / omega, 1e-3 / omega);
}

/// Twenty bodies on different circles.
std::vector<Way> circles() {
  std::vector<Way> ways;
  for (int b = 0; b < 20; ++b)
    ways.push_back(circle({0.013 * b, 0.3 - 0.017 * b}, 0.12 + 0.004 * b, 0.4, 0.3 * b));
  return ways;
}

TEST(CutTracks, NoiseIsFoundAndWhatItMakesOfVelocities) {
  for (const double noise : {0.0002, 0.001}) {
    const TrackFile file = file_of(circles(), 600, noise);
    const CutTracks cut = cut_tracks(file, squares(), fast());
    EXPECT_NEAR(cut.noise.place, noise, 0.1 * noise);
    EXPECT_EQ(cut.trials, 20);
    double square = 0.0;
    for (const CutPassage& p : cut.passages) {
      // The true velocity is perpendicular to the line from the circle's centre.
      const double b = static_cast<double>(p.track);
      const double dx = p.from[0] - 0.013 * b, dy = p.from[1] - (0.3 - 0.017 * b);
      const double omega = 0.4 / (0.12 + 0.004 * b);
      square += std::pow(p.in.at[1] + omega * dy, 2) + std::pow(p.in.at[2] - omega * dx, 2);
    }
    // Of a drawn path: the error of the expected path and that of the draw. A circle is smoother
    // than a body that is pushed at random, so less is known than could be.
    const double found = std::sqrt(square / (2.0 * static_cast<double>(cut.passages.size())));
    EXPECT_LT(found, 1.1 * std::sqrt(2.0) * cut.velocity_noise) << noise;
    EXPECT_GT(found, 0.8 * cut.velocity_noise) << noise;
  }
}

// With this much noise, the crossings are exactly those of the circles themselves.
TEST(CutTracks, NoiseMakesNoCrossings) {
  const CutTracks clean = cut_tracks(file_of(circles(), 600), squares(), fast());
  const CutTracks noisy = cut_tracks(file_of(circles(), 600, 0.001), squares(), fast());
  EXPECT_GT(clean.passages.size(), 200U);
  // Where a circle barely touches a border, noise decides.
  EXPECT_NEAR(static_cast<double>(noisy.passages.size()),
              static_cast<double>(clean.passages.size()),
              0.02 * static_cast<double>(clean.passages.size()));
}

TEST(CutTracks, WhoDithersOnABorderCrossesItOnce) {
  // Creeps over y = 0.1 within 100 frames, with noise: 30 s on each side.
  const auto creeps = [](double t) { return Place{0.05, 0.1 + 0.002 * (t - 2.0)}; };
  const TrackFile file = file_of({creeps}, 600, 0.001);
  const CutTracks cut = cut_tracks(file, squares(), fast());
  EXPECT_EQ(cut.passages.size(), 1U);
  EXPECT_LT(cut.path_noise, 0.0003);
  EXPECT_EQ(cut.passages[0].in.face, kFaceS);
  EXPECT_GT(cut.passages[0].in.at[2], -0.05);  // there the body crossed
}

TEST(CutTracks, ThroughACornerAreTwoCrossings) {
  const CutTracks cut =
      cut_tracks(file_of({straight({0.05, 0.05}, 0.3, 0.3)}, 55), squares(), fast());
  ASSERT_EQ(cut.passages.size(), 2U);
  EXPECT_LT(cut.passages[0].time, 1e-6);
  EXPECT_GT(cut.passages[0].time, 0.0);
  EXPECT_EQ(cut.passages[0].end, CutEnd::left);
  EXPECT_NEAR(std::abs(cut.passages[1].in.at[0]), 0.05, 1e-9);
}

TEST(CutTracks, GapsAreLostAndBeginANewTrial) {
  TrackFile file = file_of({straight({0.05, 0.05}, 0.0, 0.4)}, 121);
  hide(file, 50, 51);  // at y = 0.2167, in the third row
  const CutTracks cut = cut_tracks(file, squares(), fast());
  ASSERT_EQ(cut.passages.size(), 4U);
  EXPECT_EQ(cut.gaps, 1);
  EXPECT_EQ(cut.passages[1].end, CutEnd::lost);
  EXPECT_EQ(cut.passages[1].lost_by, LostBy::gap);
  EXPECT_NEAR(cut.passages[1].time, 49.0 / kFps - 0.375, 1e-7);
  // The rest of that row is not a passage: the next trial begins with the fourth row.
  EXPECT_EQ(cut.passages[2].trial, 2);
  EXPECT_NEAR(cut.passages[2].in.at[0], 0.0, 1e-7);
  EXPECT_NEAR(cut.passages[2].time, 0.25, 1e-7);
  EXPECT_EQ(cut.lost(LostBy::gap), 1);
  EXPECT_EQ(cut.lost(LostBy::end), 1);
  // A frame that may be missing is no gap.
  CutOptions bridged = fast();
  bridged.bridge = 1;
  const CutTracks whole = cut_tracks(file, squares(), bridged);
  EXPECT_EQ(whole.gaps, 0);
  EXPECT_EQ(whole.trials, 1);
  EXPECT_NEAR(whole.passages[1].time, 0.25, 1e-7);
}

TEST(CutTracks, SwapsOfIdentityAreLost) {
  TrackFile file =
      file_of({straight({0.05, 0.05}, 0.0, 0.4), straight({0.45, 0.05}, 0.0, 0.4)}, 121);
  for (std::size_t i = 50; i < 121; ++i) {
    std::swap(file.tracks[0].x[i], file.tracks[1].x[i]);
    std::swap(file.tracks[0].y[i], file.tracks[1].y[i]);
  }
  const CutTracks cut = cut_tracks(file, squares(), fast(2.0));
  EXPECT_EQ(cut.jumps, 2);
  EXPECT_EQ(cut.lost(LostBy::jump), 2);
  EXPECT_EQ(cut.trials, 4);
  EXPECT_NEAR(cut.fastest_step, 0.4, 1e-9);
  for (const CutPassage& p : cut.passages)
    EXPECT_TRUE(p.end == CutEnd::lost || p.out.face == kFaceS);
}

// A single place far away is a jump there and a jump back; the frame in between is too short for a
// fit.
TEST(CutTracks, OutliersAreJumps) {
  TrackFile file = file_of({straight({0.05, 0.05}, 0.0, 0.4)}, 121);
  file.tracks[0].x[50] = 3.0;
  const CutTracks cut = cut_tracks(file, squares(), fast(2.0));
  EXPECT_EQ(cut.jumps, 2);
  EXPECT_EQ(cut.short_pieces, 1);
  EXPECT_EQ(cut.short_frames, 1);
  EXPECT_EQ(cut.lost(LostBy::jump), 1);
}

TEST(CutTracks, WhoStaysTooLongIsTrapped) {
  CellFile cell = squares();
  cell.trapped_after = 1.0;
  // Enters the second row at 0.125 s, stays there until 2.125 s, then goes on.
  const auto rests = [](double t) {
    return Place{0.05, t < 0.25 ? 0.05 + 0.4 * t : t < 2.0 ? 0.15 : 0.15 + 0.4 * (t - 2.0)};
  };
  const TrackFile file = file_of({rests}, 300);
  const CutTracks cut = cut_tracks(file, cell, fast());
  ASSERT_EQ(cut.passages.size(), 3U);
  EXPECT_EQ(cut.passages[0].end, CutEnd::trapped);
  EXPECT_EQ(cut.passages[0].time, 1.0);
  EXPECT_EQ(cut.passages[1].trial, 2);  // begins where the body is seen to enter the next cell
  EXPECT_EQ(cut.passages[1].in.face, kFaceS);
  // A body that is still there at the end is trapped, and so is one that was there for longer
  // before it was lost.
  EXPECT_EQ(cut_tracks(file_of({rests}, 200), cell, fast()).count(CutEnd::trapped), 1);
  TrackFile gone = file_of({rests}, 300);
  hide(gone, 170, 180);
  const CutTracks lost = cut_tracks(gone, cell, fast());
  EXPECT_EQ(lost.count(CutEnd::trapped), 1);
  hide(gone, 100, 110);
  EXPECT_EQ(cut_tracks(gone, cell, fast()).passages[0].end, CutEnd::lost);
}

TEST(CutTracks, ALatticeHasAnEnd) {
  CutOptions options = fast();
  options.columns = 1;
  options.rows = 3;
  // Comes from below, crosses three rows, leaves, and comes back by the side.
  const auto loop = [](double t) {
    return t < 1.0 ? Place{0.05, -0.05 + 0.4 * t} : Place{0.05 + 0.4 * (t - 1.0), 0.35};
  };
  const CutTracks cut = cut_tracks(file_of({loop}, 200), squares(), options);
  ASSERT_EQ(cut.passages.size(), 3U);
  EXPECT_EQ(cut.first_stays, 0);
  EXPECT_EQ(cut.passages[0].in.face, kFaceS);
  EXPECT_EQ(cut.passages[2].end, CutEnd::left);
  EXPECT_EQ(cut.passages[2].out.face, kFaceS);
}

// A chain with a known law: in each of four rows, a fifth of the bodies that enter stay. Of 625
// bodies 125, 100, 80 and 64 stay, and 256 cross: 0.8^4. Before the first row lie four row lengths
// of open ground, after the last row two; no body stays there.
TEST(CutTracks, OpenGroundBeforeAndBehindTheFieldIsNoCell) {
  CellFile cell = squares();
  cell.trapped_after = 1.0;
  cell.field.columns = 1;
  cell.field.rows = 4;
  std::vector<Way> ways;
  for (const auto& [stays_in, bodies] : {std::pair{0, 125}, {1, 100}, {2, 80}, {3, 64}, {9, 256}})
    for (int b = 0; b < bodies; ++b)
      ways.push_back([=, last = kSize * (stays_in + 0.5)](double t) {
        return Place{0.05, std::min(-0.35 + 0.5 * t, last)};
      });
  const TrackFile file = file_of(ways, 300);  // 2.5 s: up to y = 0.9; from y = 0.4 on 1 s more
  EXPECT_REFUSED(
      "cell.toml does not say how many cells there are: give columns and rows of [field]", file,
      cell, CutOptions{.fastest = 100.0});
  cell.has_field = true;
  const CutTracks cut = cut_tracks(file, cell, {.fastest = 100.0});
  EXPECT_EQ(cut.columns, 1);
  EXPECT_EQ(cut.rows, 4);
  EXPECT_EQ(cut.trials, 625);
  EXPECT_EQ(cut.passages.size(), 625U + 500U + 400U + 320U);
  EXPECT_EQ(cut.count(CutEnd::trapped), 125 + 100 + 80 + 64);  // a fifth of each row
  EXPECT_EQ(cut.count(CutEnd::lost), 0);
  EXPECT_EQ(cut.first_stays, 0);
  EXPECT_EQ(cut.bodies_outside, 0);
  EXPECT_EQ(cut.came_back, 0);
  // Below y = 0, all bodies are seen for 0.7 s, in frames 0 to 83 (frame 84 is on the border, or
  // slightly beside it); above y = 0.4 the last ones from 1.5 s on, in frames 180 to 299.
  const double outside = 625.0 * 84.0 + 256.0 * 120.0;
  EXPECT_NEAR(static_cast<double>(cut.places_outside), outside, 625.0 + 256.0);
  // The same result with the option. Without an end, the open ground counts, and no body stays
  // there.
  CutOptions given{.fastest = 100.0};
  given.columns = 1;
  given.rows = 4;
  EXPECT_EQ(cut_tracks(file, cell, given).passages.size(), cut.passages.size());
  const CutTracks endless = cut_tracks(file, cell, fast());
  EXPECT_EQ(endless.count(CutEnd::trapped), 369);
  EXPECT_EQ(endless.passages.size() - static_cast<std::size_t>(endless.count(CutEnd::lost)),
            1845U + 3U * 625U + 4U * 256U);
  EXPECT_EQ(endless.places_outside, 0);
}

// One body begins inside, one leaves by a side and comes back, one is never inside.
TEST(CutTracks, WhatComesBackBeginsAnotherTrial) {
  CellFile cell = squares();
  cell.field.columns = cell.field.rows = 2;
  cell.has_field = true;
  const auto turns = [](double t) { return Place{0.15 + 0.4 * std::min(t, 1.0 - t), 0.05}; };
  const CutTracks cut = cut_tracks(
      file_of({straight({0.05, 0.05}, 0.0, 0.4), turns, straight({0.5, 0.5}, 0.1, 0.1)}, 121), cell,
      {.fastest = 100.0});
  // In rows 0 and 1 until 0.375 s; in column 1 until 0.125 s, and again from 0.875 s on.
  EXPECT_EQ(cut.first_stays, 2);
  EXPECT_EQ(cut.trials, 2);
  EXPECT_EQ(cut.came_back, 1);
  EXPECT_EQ(cut.bodies_outside, 1);
  ASSERT_EQ(cut.passages.size(), 2U);
  EXPECT_EQ(cut.passages[0].in.face, kFaceS);
  EXPECT_EQ(cut.passages[0].end, CutEnd::left);
  EXPECT_EQ(cut.passages[1].in.face, kFaceE);
  EXPECT_EQ(cut.passages[1].end, CutEnd::lost);
  EXPECT_NEAR(cut.passages[1].time, 0.125, 1e-6);
  // 75 frames of the first body, 0.375 to 1 s; 90 of the second; all of the third.
  EXPECT_NEAR(static_cast<double>(cut.places_outside), 75.0 + 90.0 + 121.0, 3.0);
}

TEST(CutTracks, TypesAreThoseOfTheMap) {
  CellFile cell = squares();
  cell.map.types = {{false}, {false}};
  cell.types = {"sand", "grass"};
  cell.map.columns = 2;
  cell.map.type_of_cell = {0, 1, 1, 0};
  const TrackFile file = file_of({straight({-0.05, 0.05}, 0.4, 0.05)}, 121);
  const CutTracks cut = cut_tracks(file, cell, {.fastest = 100.0});
  ASSERT_EQ(cut.passages.size(), 2U);
  EXPECT_EQ(cut.passages[0].type, 0);
  EXPECT_EQ(cut.passages[1].type, 1);
  EXPECT_EQ(cut.passages[1].end, CutEnd::left);
  EXPECT_EQ(recorded_runs(cut, file, cell).passages[1].type, 1);
  CutOptions options = fast();
  options.columns = options.rows = 3;
  EXPECT_REFUSED("--lattice: the map of cell.toml has 2 columns and 2 rows", file, cell, options);
}

// The file contains what was cut, and follows the rules of the format.
TEST(CutTracks, RunsReadBack) {
  CellFile cell = squares();
  cell.trapped_after = 0.5;
  std::vector<Way> ways = circles();
  ways.push_back([](double t) { return Place{0.05, t < 0.5 ? -0.05 + 0.4 * t : 0.15}; });
  ways.push_back(straight({0.05, 0.05}, 0.3, 0.3));
  TrackFile file = file_of(ways, 300, 0.0002);
  file.tracks[3].body = "Ann, \"the\" ant";
  hide(file, 100, 101);
  const CutTracks cut = cut_tracks(file, cell, fast());
  const RecordedRuns runs = recorded_runs(cut, file, cell);
  EXPECT_GE(runs.trapped, 1);
  EXPECT_GE(runs.lost, 10);
  const std::string path = testing::TempDir() + "cut_tracks_runs.csv";
  write_runs(path, cell, runs);
  const RecordedRuns again = read_runs(path, cell);
  EXPECT_EQ(again.bodies, runs.bodies);
  EXPECT_EQ(again.trapped, runs.trapped);
  EXPECT_EQ(again.lost, runs.lost);
  ASSERT_EQ(again.trials.size(), static_cast<std::size_t>(cut.trials));
  ASSERT_EQ(again.passages.size(), cut.passages.size());
  for (std::size_t i = 0; i < cut.passages.size(); ++i) {
    EXPECT_TRUE(again.passages[i].entry == cut.passages[i].out);
    EXPECT_EQ(again.passages[i].costs[0], cut.passages[i].time);
  }
  std::filesystem::remove(path);
}

/// Three columns and two rows, of which the way is a horseshoe: the middle cell of the lower row is
/// closed to all sides.
CellFile horseshoe() {
  CellFile cell = squares();
  cell.map.section.faces[0].odd = cell.map.section.faces[1].odd = 0;
  cell.map.types = {{false}, {false}};
  cell.types = {"open", "closed"};
  cell.walls = {0, 0b1111};
  cell.map.columns = 3;
  cell.map.type_of_cell = {0, 1, 0, 0, 0, 0};
  return cell;
}
std::vector<std::string> ways_of(const CutTracks& cut, const CellFile& cell) {
  std::vector<std::string> ways;
  for (const CutPassage& p : cut.passages)
    ways.push_back(cell.types[static_cast<std::size_t>(p.type)] + " " +
                   cell.map.section.faces[static_cast<std::size_t>(p.in.face)].name);
  return ways;
}

// From the lower left cell up, over and down again; the path cuts the corners of the closed cell by
// a few millimetres, and leans over its walls.
TEST(CutTracks, PlacesBeyondWallsArePutBack) {
  const CellFile cell = horseshoe();
  const auto way = [](double t) {
    if (t < 1.0) return Place{0.097 + 0.006 * std::min(t, 0.9), 0.02 + 0.078 * t};  // over x = 0.1
    if (t < 2.0) return Place{0.103 + 0.094 * (t - 1.0), 0.098};                    // below y = 0.1
    return Place{0.197 + 0.02 * (t - 2.0), 0.098 - 0.07 * (t - 2.0)};
  };
  const TrackFile file = file_of({way}, 300, 1e-5);
  const CutTracks cut = cut_tracks(file, cell, {.fastest = 100.0});
  EXPECT_EQ(ways_of(cut, cell), (std::vector<std::string>{"open S", "open W", "open W", "open N"}));
  EXPECT_EQ(cut.lost(LostBy::wall), 0);
  EXPECT_EQ(cut.lost(LostBy::end), 1);
  EXPECT_GT(cut.places_put_back, 150);
  for (const CutPassage& p : cut.passages) EXPECT_LE(std::abs(p.in.at[0]), 0.5 * kSize);
  // Without walls, the same path goes through the closed cell.
  CellFile without = cell;
  without.walls = {};
  EXPECT_EQ(ways_of(cut_tracks(file, without, {.fastest = 100.0}), cell)[0], "closed W");
}

// Enters the left cell of three from below and goes right, through a closed cell that no way leads
// round, to the right cell, which it leaves.
TEST(CutTracks, WhoStaysBeyondWallsIsLost) {
  CellFile cell = horseshoe();
  cell.map.type_of_cell = {0, 1, 0};
  const auto way = [](double t) {
    return t < 1.0 ? Place{0.05, -0.05 + 0.1 * t} : Place{0.05 + 0.1 * (t - 1.0), 0.05};
  };
  const CutTracks cut = cut_tracks(file_of({way}, 540, 1e-5), cell, {.fastest = 100.0});
  EXPECT_EQ(cut.lost(LostBy::wall), 1);
  EXPECT_EQ(ways_of(cut, cell), (std::vector<std::string>{"open S"}));
  EXPECT_EQ(cut.first_stays, 1);
  EXPECT_NE(cut.doubts.at(0).find("of the places lie beyond walls"), std::string::npos);
}

// A corridor of four cells, up on the left and down on the right. The body leans over the wall
// between the lower cells for half a second; the way round would be through all others.
TEST(CutTracks, WhoLeansOverAWallStaysInItsCell) {
  CellFile cell = horseshoe();
  const auto face = [](int f) { return std::uint64_t{1} << f; };
  cell.types = {"open", "lower left"};
  cell.walls = {0, face(kFaceE)};
  cell.map.columns = 2;
  cell.map.type_of_cell = {1, 0, 0, 0};
  for (const double lean : {0.005, 0.01, 0.02, 0.03}) {
    const auto way = [&](double t) {
      const double over = 0.03 + lean;  // from x = 0.07
      const double x = t < 0.75   ? 0.07
                       : t < 1.0  ? 0.07 + over * (t - 0.75) / 0.25
                       : t < 1.5  ? 0.07 + over
                       : t < 1.75 ? 0.07 + over * (1.75 - t) / 0.25
                                  : 0.07;
      const double y = t < 0.75   ? -0.05 + 0.1 * t / 0.75
                       : t < 1.75 ? 0.05
                                  : 0.05 + 0.2 * (t - 1.75);
      return Place{x, y};
    };
    const CutTracks cut = cut_tracks(file_of({way}, 270, 1e-4), cell, {.fastest = 100.0});
    EXPECT_EQ(ways_of(cut, cell), (std::vector<std::string>{"lower left S", "open S"})) << lean;
    EXPECT_GT(cut.places_put_back, 50) << lean;
  }
}

// Parked for long beside a border, with noise or in whole pixels: it enters its cell once, and is
// trapped there.
TEST(CutTracks, WhoRestsAtABorderDoesNotCrossItAgain) {
  CellFile cell = squares();
  cell.trapped_after = 2.0;
  for (const double noise : {0.0, 0.0003})
    for (const double behind : {0.001, 0.002}) {
      const auto parks = [&](double t) {
        return Place{0.05, std::min(0.05 + 0.1 * t, 0.1 + behind)};
      };
      const CutTracks cut =
          cut_tracks(file_of({parks, straight({0.03, 0.0}, 0.01, 0.1)}, 1200, noise), cell, fast());
      EXPECT_EQ(std::count_if(cut.passages.begin(), cut.passages.end(),
                              [](const CutPassage& p) { return p.track == 0; }),
                1)
          << noise << " " << behind;
      EXPECT_EQ(cut.passages[0].end, CutEnd::trapped) << noise << " " << behind;
    }
  // On the border itself, in whole pixels.
  const auto on_it = [](double t) { return Place{0.05, std::min(0.05 + 0.1 * t, 0.1)}; };
  const CutTracks cut =
      cut_tracks(file_of({on_it, straight({0.03, 0.0}, 0.01, 0.1)}, 1200), cell, fast());
  EXPECT_LE(std::count_if(cut.passages.begin(), cut.passages.end(),
                          [](const CutPassage& p) { return p.track == 0; }),
            2);
}

// A body that stays at one place, beside one that moves without noise.
TEST(CutTracks, WhoNeverMovesIsInOneCell) {
  const CutTracks cut =
      cut_tracks(file_of({straight({0.25, 0.25}, 0.0, 0.0), straight({0.05, 0.05}, 0.0, 0.4)}, 121),
                 squares(), fast());
  EXPECT_EQ(cut.first_stays, 2);
  for (const CutPassage& p : cut.passages) EXPECT_EQ(p.track, 1U);
  EXPECT_EQ(cut.passages.size(), 4U);
  EXPECT_REFUSED("no body is seen to enter a cell", file_of({straight({0.25, 0.25}, 0.0, 0.0)}, 50),
                 squares(), fast());
}

// 60 bodies have more stretches than are needed to find the noise; in the other order the same
// bodies have the same passages.
TEST(CutTracks, TheOrderOfBodiesChangesNothing) {
  std::vector<Way> ways;
  for (int b = 0; b < 60; ++b)
    ways.push_back(
        circle({0.013 * b, 0.3 - 0.007 * b}, 0.12 + 0.002 * b, 0.3 + 0.002 * b, 0.3 * b));
  TrackFile file = file_of(ways, 900, 0.001);
  const CutTracks there = cut_tracks(file, squares(), fast());
  TrackFile turned = file;
  std::reverse(turned.tracks.begin(), turned.tracks.end());
  const CutTracks back = cut_tracks(turned, squares(), fast());
  EXPECT_EQ(there.noise.place, back.noise.place);
  ASSERT_EQ(there.passages.size(), back.passages.size());
  const auto of_first = [](const CutTracks& cut, std::size_t track) {
    std::vector<double> times;
    for (const CutPassage& p : cut.passages)
      if (p.track == track) times.push_back(p.time);
    return times;
  };
  EXPECT_EQ(of_first(there, 0), of_first(back, 59));
  EXPECT_LE(there.unsure_crossings, there.crossings);
}

// Walls that a path never meets change nothing, to the last bit.
TEST(CutTracks, OpenBordersAreCutAsWithoutWalls) {
  CellFile plain = squares();
  plain.map.types = {{true}, {true}};
  plain.types = {"open", "closed"};
  plain.map.columns = 20;
  plain.map.type_of_cell.assign(400, 0);
  plain.map.type_of_cell[399] = 1;
  CellFile walled = plain;
  walled.walls = {0, 0b1111};
  TrackFile file = file_of(circles(), 600, 0.001);
  for (Track& t : file.tracks)
    for (auto* places : {&t.x, &t.y})
      for (double& place : *places) place += 0.7;
  const CutTracks without = cut_tracks(file, plain, {.fastest = 100.0}),
                  with = cut_tracks(file, walled, {.fastest = 100.0});
  EXPECT_EQ(with.places_put_back, 0);
  ASSERT_EQ(with.passages.size(), without.passages.size());
  EXPECT_GT(with.passages.size(), 200U);
  for (std::size_t i = 0; i < with.passages.size(); ++i) {
    EXPECT_TRUE(with.passages[i].in == without.passages[i].in) << i;
    EXPECT_EQ(with.passages[i].time, without.passages[i].time) << i;
  }
}

TEST(CutTracks, CellsThatTracksDoNotHave) {
  const auto refused = [](const char* words, auto change) {
    CellFile cell = squares();
    change(cell.map.section);
    EXPECT_REFUSED(words, [&] { require_measurable(cell); });
  };
  using dynamics::Section;
  refused("face S with the move (1, 1): tracks are cut into rectangles",
          [](Section& s) { s.faces[0].di_x = 1; });
  refused("face N with the move (0, 1): face S has the same",
          [](Section& s) { s.faces[1].di_y = 1; });
  refused("coordinate spin cannot be measured of tracks: these can, s (m,",
          [](Section& s) { s.coordinates[1].name = "spin"; });
  refused("coordinate vx is in \"mm/s\": of tracks it is measured in m/s",
          [](Section& s) { s.coordinates[1].unit = "mm/s"; });
  refused("s of face S changes its sign in the mirror (x to -x): it must be among",
          [](Section& s) { s.faces[0].odd = 0b010; });
  refused("s of face W keeps its sign in the mirror (x to -x): it must not be among",
          [](Section& s) { s.faces[2].odd = 0b011; });
  CellFile lopsided = squares();
  lopsided.map.types = {{false}};
  lopsided.map.section.faces[0].odd = 0;
  EXPECT_EQ(refusal([&] { require_measurable(lopsided); }), "nothing refused");
}

// Windows in which a body stands exactly still say nothing about noise.
TEST(SmoothPath, PlacesThatAreTheSameAreNoNoise) {
  TrackFile file = file_of({straight({0.05, 0.05}, 0.0, 0.4)}, 600, 1e-4);
  const auto noise = [&] {
    return noise_of({{&file.tracks[0], 0, file.tracks[0].time.size()}}).place;
  };
  const double before = noise();
  Track& t = file.tracks[0];
  for (int i = 0; i < 2000; ++i) {
    t.time.push_back(t.time.back() + file.interval);
    t.x.push_back(t.x.back());
    t.y.push_back(t.y.back());
  }
  EXPECT_NEAR(noise(), before, 0.1 * before);  // half of it, if these windows counted
}

TEST(CutTracks, SaysWhatIsLikelyToBeWrong) {
  const Way up = straight({0.05, 0.05}, 0.0, 0.4), down = straight({0.05, 5.0}, 0.0, -0.4);
  EXPECT_TRUE(cut_tracks(file_of({up}, 600), squares(), fast()).doubts.empty());
  EXPECT_TRUE(cut_tracks(file_of({up, down}, 600), squares(), fast()).doubts.empty());
  // A body that turns round does not show which way is up.
  const Way turning = [](double t) { return Place{0.05, 0.05 + 0.4 * std::abs(t - 4.5)}; };
  EXPECT_NE(cut_tracks(file_of({down, down, down, down, down, down, down, down, turning}, 600),
                       squares(), fast())
                .doubts.at(0)
                .find("nearly all passages go backwards"),
            std::string::npos);
  TrackFile back = file_of({down}, 600);
  EXPECT_NE(cut_tracks(back, squares(), fast()).doubts.at(0).find("give --y-down"),
            std::string::npos);
  back.y_down = true;
  EXPECT_NE(cut_tracks(back, squares(), fast()).doubts.at(0).find("leave --y-down out"),
            std::string::npos);
  TrackFile lossy = file_of({up}, 600);  // one frame in ten is lost
  for (int f = 589; f > 0; f -= 10) hide(lossy, f, f + 1);
  const std::string words = cut_tracks(lossy, squares(), fast()).doubts.at(0);
  EXPECT_NE(words.find("9.8 % of the frames are missing, 1 at a time: --bridge 1 bridges them"),
            std::string::npos)
      << words;
  CutOptions bridged = fast();
  bridged.bridge = 1;
  EXPECT_TRUE(cut_tracks(lossy, squares(), bridged).doubts.empty());
  TrackFile blind = file_of({up}, 950);
  for (const int first : {720, 490, 260, 30}) hide(blind, first, first + 200);
  EXPECT_NE(cut_tracks(blind, squares(), fast())
                .doubts.at(0)
                .find("200 at a time: too long to be bridged"),
            std::string::npos);
  EXPECT_REFUSED("all lie below the first row: is y measured downwards (--y-down)?",
                 file_of({straight({0.05, -5.03}, 0.0, 0.001)}, 100), squares(), fast());
}

TEST(CutTracks, TracksThatMakeNoSense) {
  const TrackFile up = file_of({straight({0.05, 0.05}, 0.0, 0.4)}, 121);
  EXPECT_REFUSED("--fastest 0: must be above 0", up, squares(), fast(0.0));
  EXPECT_REFUSED(
      "no body was seen in 5 frames in a row, without a gap or a jump: most steps are faster than "
      "--fastest 0.1 m/s (median 0.4 m/s)",
      up, squares(), fast(0.1));
  // Tracks of 120 frames per second, declared as 240.
  TrackFile every_second = up;
  every_second.interval = 1.0 / 240.0;
  EXPECT_REFUSED(
      "frames go up by 2 from one place of a body to its next (a frame is 0.00416667 s): --bridge "
      "1 "
      "bridges them, unless --fps is wrong",
      every_second, squares(), fast());
  CutOptions options = fast();
  options.bridge = -1;
  EXPECT_REFUSED("--bridge: must be 0 or more", up, squares(), options);
  CellFile no_way = squares();
  no_way.map.section.faces.erase(no_way.map.section.faces.begin());
  no_way.map.types = {{false}};
  EXPECT_REFUSED(
      "body b0 crosses a border at 0.125 s by a move of (0, 1), at (0.05, 0.1) m: no face "
      "of cell.toml has that move",
      up, no_way, fast());
  EXPECT_REFUSED(
      "no body is seen to enter a cell: places are x = 0.05 to 0.05 m, y = 0.05 to 0.09 m",
      file_of({[](double t) {
                return Place{0.05, 0.05 + 0.04 * t};
              }},
              121),
      squares(), fast());
  EXPECT_REFUSED("are too small for tracks with a noise of",
                 file_of({straight({0.05, 0.05}, 0.0, 0.4)}, 121, 0.2), squares(), fast());
}

}  // namespace
}  // namespace gatewalk::lattice
