// SPDX-License-Identifier: MIT
// Bodies with a known truth, as a camera sees them: do predictions and halves from their tracks
// keep what they promise?
//   tracks_study film CELL.toml TRACKS.csv   one film, as a table of places in millimetres
//   tracks_study truth CELL.toml TRUTH.json  how 100 000 bodies end, without camera
//   tracks_study many CELL.toml OUT.csv FIRST FILMS   a line a film: its bars, its halves
// With NOISE_MM TURNING behind, the camera's noise, and bodies that turn (1/s) without a pull
// ahead. See results/tracks/README.md.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "dynamics/base/random.h"
#include "lattice/pool/pooled_prediction.h"
#include "lattice/pool/predict_pooled.h"
#include "lattice/recorded/cut_tracks.h"
#include "lattice/recorded/recorded_pool.h"
#include "lattice/scene/cell_file.h"
#include "lattice/study/cross_validation.h"
#include "lattice/study/memory.h"

using namespace gatewalk;
using dynamics::Purpose;
using dynamics::Random;

namespace {

constexpr double kSpeed = 0.06;  // m/s
/// What main may set.
struct Habits {
  double turning = 0.4, upwards = 0.6;  // 1/s: diffusion of the heading, pull ahead
  double noise = 0.001;                 // m, of each place
} habits;
constexpr double kPatch = 0.012, kSticky = 0.8;  // m; 1/s, how soon it holds who is on it
constexpr double kFrame = 1.0 / 120.0;           // s
constexpr int kSteps = 2;                        // a frame
constexpr double kMargin = 0.015;                // m, what the camera sees beyond its cells
constexpr int kViewColumns = 5, kViewRows = 3;
constexpr double kGapsPerSecond = 0.02;
constexpr int kLongestGap = 30;                   // frames
constexpr int kBridge = 15, kAway = kBridge + 1;  // frames that may be missing; between trials
constexpr int kBodies = 200, kTrialsOfOne = 8, kTrialsOfMany = 3;  // of a body in a film

constexpr double kStartWidth = 0.7,
                 kStartHeading = 0.3;  // of a cell, rad: where and how they are put
/// m/s, of a step that is no jump: noise hardly ever makes a faster one.
double fastest() { return std::max(2.0, 8.0 * std::sqrt(2.0) * habits.noise / kFrame); }

/// A body on its way; cells begin at multiples of their width.
struct Walker {
  double x, y, heading = 0.0;  // heading 0: ahead
  bool stuck = false;

  void step(double width, Random& random) {
    if (stuck) return;
    constexpr double kStep = kFrame / kSteps;
    heading += -habits.upwards * std::sin(heading) * kStep +
               std::sqrt(2.0 * habits.turning * kStep) * random.normal();
    x += kSpeed * std::sin(heading) * kStep;
    y += kSpeed * std::cos(heading) * kStep;
    const double off_x = x - width * (std::floor(x / width) + 0.5),
                 off_y = y - width * (std::floor(y / width) + 0.5);
    if (off_x * off_x + off_y * off_y < kPatch * kPatch) stuck = random.uniform() < kSticky * kStep;
  }
};

using Endings = std::array<std::int64_t, markov::kEndings>;

/// In the field of the cell file, cell by cell, of a body that is in its start cell: places from
/// that cell's lower left corner.
markov::Ending end_of_walk(const lattice::CellFile& cells, Walker w, Random& random) {
  const double width = cells.width;
  std::int64_t column = 0, row = 0, at_column = cells.field.start_column(), at_row = 0;
  int gates = 1;
  double since = 0.0;
  for (;;) {
    w.step(width, random);
    since += kFrame / kSteps;
    if (since >= *cells.trapped_after) return markov::Ending::trapped;
    const auto new_column = static_cast<std::int64_t>(std::floor(w.x / width)),
               new_row = static_cast<std::int64_t>(std::floor(w.y / width));
    for (const auto& [dx, dy] : {std::pair{new_column - column, std::int64_t{0}},
                                 std::pair{std::int64_t{0}, new_row - row}}) {
      if (dx == 0 && dy == 0) continue;
      const auto ending = markov::follow({cells.field.columns, cells.field.rows},
                                         {0, static_cast<int>(dx), static_cast<int>(dy)},
                                         gates == cells.field.max_gates, at_column, at_row);
      if (ending) return *ending;
      ++gates;
      since = 0.0;
    }
    column = new_column;
    row = new_row;
  }
}

/// Puts a body in front of the middle cell so many times, and calls see(where it is, whether the
/// camera sees it) every frame; places from the view's lower left corner.
template <class See>
void show(const lattice::CellFile& cells, int trials, Random& random, See see) {
  const double width = cells.width;
  int hidden = 0;  // frames yet
  for (int trial = 0; trial < trials; ++trial) {
    Walker w{width * (0.5 * kViewColumns + kStartWidth * (random.uniform() - 0.5)), -kMargin,
             kStartHeading * random.normal()};
    double still = 0.0;
    while (still < *cells.trapped_after + 1.0 && w.x > -kMargin &&
           w.x < kViewColumns * width + kMargin && w.y >= -kMargin &&
           w.y < kViewRows * width + kMargin) {
      if (hidden > 0)
        --hidden;
      else if (random.uniform() < kGapsPerSecond * kFrame)
        hidden = 1 + static_cast<int>(random.below(kLongestGap));
      see(w, hidden == 0);
      for (int s = 0; s < kSteps; ++s) w.step(width, random);
      if (w.stuck) still += kFrame;
    }
    for (int frame = 0; frame < kAway; ++frame) see(w, false);
  }
}

/// Of so many trials that begin as they are seen to begin in films: where a body first crosses a
/// border into a cell, and again after each gap.
Endings true_endings(const lattice::CellFile& cells, std::int64_t trials) {
  const double width = cells.width;
  Endings endings{};
  std::int64_t begun = 0;
  for (std::uint64_t body = 0; begun < trials; ++body) {
    Random filmed(Purpose::field, {1, 1, body}), goes_on(Purpose::field, {1, 2, body});
    bool in_trial = false;
    int missing = kBridge + 1;  // frames, until this one
    std::int64_t column = 0, row = 0;
    show(cells, 3, filmed, [&](const Walker& w, bool seen) {
      const auto new_column = static_cast<std::int64_t>(std::floor(w.x / width)),
                 new_row = static_cast<std::int64_t>(std::floor(w.y / width));
      const bool inside =
          new_column >= 0 && new_column < kViewColumns && new_row >= 0 && new_row < kViewRows;
      if (!seen) {
        ++missing;
        return;
      }
      const bool known = missing <= kBridge;
      const bool crossed = known && (new_column != column || new_row != row);
      if (!known || !inside) in_trial = false;
      if (inside && crossed && !in_trial && begun < trials) {
        in_trial = true;
        ++begun;
        Walker from = w;
        from.x -= width * static_cast<double>(new_column);
        from.y -= width * static_cast<double>(new_row);
        ++endings[static_cast<std::size_t>(end_of_walk(cells, from, goes_on))];
      }
      column = new_column;
      row = new_row;
      missing = 0;
    });
  }
  return endings;
}

lattice::Track film_of(const lattice::CellFile& cells, int body, int trials, std::uint64_t seed) {
  Random random(Purpose::comparison, {seed, 1, static_cast<std::uint64_t>(body)});
  lattice::Track track{std::to_string(body + 1), {}, {}, {}};
  std::int64_t frame = random.below(600);
  show(cells, trials, random, [&](const Walker& w, bool seen) {
    const double noise_x = habits.noise * random.normal(), noise_y = habits.noise * random.normal();
    if (seen) {
      track.time.push_back(static_cast<double>(frame) * kFrame);
      track.x.push_back(w.x + noise_x);
      track.y.push_back(w.y + noise_y);
    }
    ++frame;
  });
  return track;
}

/// From this frame on two bodies have each other's name.
void swap_names(lattice::Track& a, lattice::Track& b, double time) {
  const auto tail = [&](const lattice::Track& t) {
    return std::lower_bound(t.time.begin(), t.time.end(), time) - t.time.begin();
  };
  const auto i = tail(a), j = tail(b);
  const auto swap = [&](std::vector<double>& p, std::vector<double>& q) {
    std::vector<double> p_tail(p.begin() + i, p.end());
    p.resize(static_cast<std::size_t>(i));
    p.insert(p.end(), q.begin() + j, q.end());
    q.resize(static_cast<std::size_t>(j));
    q.insert(q.end(), p_tail.begin(), p_tail.end());
  };
  swap(a.x, b.x);
  swap(a.y, b.y);
  swap(a.time, b.time);
}

/// 200 bodies, two pairs of which swap names.
lattice::TrackFile film(const lattice::CellFile& cells, int trials, std::uint64_t seed) {
  lattice::TrackFile file;
  file.source = "film " + std::to_string(seed);
  file.kind = "a table";
  file.interval = kFrame;
  for (int body = 0; body < kBodies; ++body)
    file.tracks.push_back(film_of(cells, body, trials, seed));
  swap_names(file.tracks[3], file.tracks[4], 9.0);
  swap_names(file.tracks[100], file.tracks[150], 12.0);
  for (const lattice::Track& t : file.tracks) file.places += std::ssize(t.time);
  return file;
}

void write_film(const lattice::CellFile& cells, const std::string& path) {
  std::FILE* const out = std::fopen(path.c_str(), "w");
  if (out == nullptr) throw std::runtime_error("cannot write " + path);
  std::fputs("body,frame,x_mm,y_mm\n", out);
  for (const lattice::Track& t : film(cells, kTrialsOfOne, 1).tracks)
    for (std::size_t k = 0; k < t.time.size(); ++k)
      std::fprintf(out, "%s,%ld,%.2f,%.2f\n", t.body.c_str(), std::lround(t.time[k] / kFrame),
                   1e3 * t.x[k], 1e3 * t.y[k]);
  if (std::fclose(out) != 0) throw std::runtime_error("cannot write " + path);
}

constexpr std::array<std::pair<markov::Ending, const char*>, 6> kNames{
    {{markov::Ending::far_edge, "crossed"},
     {markov::Ending::left_edge, "left_side"},
     {markov::Ending::right_edge, "right_side"},
     {markov::Ending::trapped, "trapped"},
     {markov::Ending::cut_off, "cut_off"},
     {markov::Ending::near_edge, "went_back"}}};
constexpr std::int64_t kTruth = 100'000;

void write_truth(const lattice::CellFile& cells, const std::string& path) {
  const Endings endings = true_endings(cells, kTruth);
  std::ofstream out(path);
  out << "{\"trials\": " << kTruth;
  for (const auto& [ending, name] : kNames)
    out << ", \"" << name
        << "\": " << static_cast<double>(endings[static_cast<std::size_t>(ending)]) / kTruth;
  out << "}\n";
  if (!out.flush()) throw std::runtime_error("cannot write " + path);
}

/// A line a film: by ending the prediction with its bar; of both halves what was seen, the chain's
/// prediction and what chance makes of the difference; p-values.
void many_films(const std::string& cell_path, const std::string& path, int first, int films) {
  std::ofstream out(path);
  out << "film,passages,lost,error_95";
  for (const auto& [ending, name] : kNames)
    out << ',' << name << ',' << name << "_low," << name << "_high";
  for (const int half : {2, 1})
    for (const auto& [ending, name] : kNames)
      out << ",seen" << half << '_' << name << ",chain" << half << '_' << name << ",chance" << half
          << '_' << name;
  out << ",tv2,tv2_95,tv1,tv1_95,p_halves,p_memory\n";
  for (int k = first; k < first + films; ++k) {
    lattice::CellFile cells = lattice::read_cell_file(cell_path);
    const auto seed = static_cast<std::uint64_t>(k) + 1000;
    const lattice::TrackFile file = film(cells, kTrialsOfMany, seed);
    lattice::CutOptions how;
    how.fastest = fastest();
    how.bridge = kBridge;
    how.columns = kViewColumns;
    how.rows = kViewRows;
    const lattice::RecordedRuns runs =
        lattice::recorded_runs(lattice::cut_tracks(file, cells, how), file, cells);
    const lattice::RunPool pool = lattice::pool_of(runs);
    const lattice::Problem problem = lattice::problem_of(cells, pool);
    const auto prediction =
        lattice::predict_recorded(problem, pool, {std::nullopt}, {.seed = seed});
    const lattice::StartAnswer& a = prediction.starts.front();
    out << k << ',' << runs.passages.size() << ',' << runs.lost << ',' << a.error.total_variation;
    for (const auto& [ending, name] : kNames) {
      const auto e = static_cast<std::size_t>(ending);
      out << ',' << a.endings.share[e] << ',' << a.endings.interval[e][0] << ','
          << a.endings.interval[e][1];
    }
    const auto halves = lattice::cross_validate(problem, pool, {.null_draws = 999, .seed = seed});
    for (const auto& fold : halves.folds)
      for (const auto& [ending, name] : kNames) {
        const auto e = static_cast<std::size_t>(ending);
        out << ',' << fold.seen.share[e] << ',' << fold.chain.endings[e] << ','
            << fold.chance_95[e];
      }
    for (const auto& fold : halves.folds)
      out << ',' << fold.total_variation.seen << ',' << fold.chance_total_variation_95;
    out << ',' << halves.p << ','
        << lattice::body_memory(problem, pool, dynamics::kEntriesPerLeaf, 999, seed).p << '\n'
        << std::flush;
  }
  if (!out) throw std::runtime_error("cannot write " + path);
}

}  // namespace

int main(int count, char** words) {
  try {
    const bool has_range = count > 1 && words[1] == std::string("many");
    const int usual = has_range ? 6 : 4;
    if (count != usual && count != usual + 2)
      throw std::runtime_error(
          "film|truth CELL.toml OUT, or many CELL.toml OUT.csv FIRST FILMS; [NOISE_MM TURNING]");
    if (count > usual) habits = {std::stod(words[usual + 1]), 0.0, 1e-3 * std::stod(words[usual])};
    const std::string what = words[1], cell = words[2], path = words[3];
    const lattice::CellFile cells = lattice::read_cell_file(cell);
    if (what == "film")
      write_film(cells, path);
    else if (what == "truth")
      write_truth(cells, path);
    else if (what == "many")
      many_films(cell, path, std::stoi(words[4]), std::stoi(words[5]));
    else
      throw std::runtime_error("film, truth or many, not " + what);
  } catch (const std::exception& error) {
    std::cerr << "tracks_study: " << error.what() << '\n';
    return 1;
  }
}
