// SPDX-License-Identifier: MIT
#include "cli/render/recording.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/render/health.h"
#include "cli/render/landscape.h"
#include "cli/render/panel.h"
#include "cli/render/quantity.h"
#include "cli/render/scene.h"
#include "dynamics/disc/landscape.h"
#include "markov/formats/netcdf.h"

namespace gatewalk::cli {

using lattice::Column;
using lattice::Moment;
using lattice::Recording;
using lattice::Recordings;
using lattice::Scene;

namespace {

constexpr std::size_t kFewLines = 6, kMostLines = 20;  // of the table, without and with --details

/// One unit for each column of a table, so that its lines can be compared.
struct Readings {
  double second, joule;  // smallest difference that matters

  Readings(const lattice::Scene& scene, const std::vector<Recording>& runs) {
    const dynamics::Scale scale = dynamics::scale_of(scene.gate);
    double longest = 0.0, most = 0.0;
    for (const Recording& r : runs) {
      const dynamics::Energies& e = r.moments.back().energy;
      longest = std::max(longest, r.seconds);
      for (const double energy :
           {e.propulsion_work + e.random_work, e.lost, e.hit_loss, e.mechanical()})
        most = std::max(most, std::abs(energy));
    }
    second = step_of(0.01 * scale.time, longest);
    joule = step_of(0.1 * scale.energy(), most);
  }
  [[nodiscard]] std::string seconds(double time) const { return reading(time, "s", second); }
  [[nodiscard]] std::string joules(double energy) const { return reading(energy, "J", joule); }
};

/// Writes the meanings of a variable's codes.
void put_words(int nc, int variable, const std::vector<std::string>& words) {
  using namespace markov::netcdf;
  std::string meanings;
  std::vector<signed char> codes;
  for (std::string word : words) {
    std::replace(word.begin(), word.end(), ' ', '_');
    meanings += (meanings.empty() ? "" : " ") + word;
    codes.push_back(static_cast<signed char>(codes.size()));
  }
  put_text(nc, variable, "flag_meanings", meanings);
  check(nc_put_att_schar(nc, variable, "flag_values", NC_BYTE, codes.size(), codes.data()),
        "flag_values");
}

/// Writes the dimension run, and the variables with a value for each run.
void put_runs(int nc, const Recordings& recordings) {
  using namespace markov::netcdf;
  std::vector<std::int64_t> trial;
  std::vector<std::int32_t> row_size;
  std::vector<std::int8_t> ending;
  const auto known = lattice::endings(recordings.across_field);
  for (const Recording& r : recordings.runs) {
    trial.push_back(r.trial);
    row_size.push_back(static_cast<std::int32_t>(r.moments.size()));
    ending.push_back(
        static_cast<std::int8_t>(std::find(known.begin(), known.end(), r.ending) - known.begin()));
  }
  const int run = define_dimension(nc, "run", recordings.runs.size());
  put_text(nc, put_variable(nc, "run_trial", run, trial, "1", "number of the trial"), "cf_role",
           "trajectory_id");
  const int sizes =
      put_variable(nc, "row_size", run, row_size, "1", "samples of a run, which follow each other");
  put_text(nc, sizes, "sample_dimension", "sample");
  put_words(nc, put_variable(nc, "ending", run, ending, "1", "how a run ended"), known);
}

/// The axes of trajectories' coordinates, as the CF conventions name them. The time has no axis:
/// CF's axis T needs a date from which time counts, and a trial has none.
const std::map<std::string_view, const char*> kAxes{{"field_x_m", "X"}, {"field_y_m", "Y"}};

/// Writes a column of all runs: codes as bytes, counts as integers.
void put_column(int nc, int sample, const Column& c, const Recordings& recordings) {
  using namespace markov::netcdf;
  const auto put = [&](auto zero) {
    std::vector<decltype(zero)> values;
    for (const Recording& r : recordings.runs)
      for (const Moment& m : r.moments)
        values.push_back(static_cast<decltype(zero)>(c.value({recordings.of(m), r.trial, m})));
    const int variable = put_variable(nc, std::string(c.name), sample, values, std::string(c.unit),
                                      std::string(c.meaning));
    if (const auto axis = kAxes.find(c.name); axis != kAxes.end())
      put_text(nc, variable, "axis", axis->second);
    else if (c.name != "time_s")
      put_text(nc, variable, "coordinates", "time_s field_x_m field_y_m");
    return variable;
  };
  if (!c.words.empty())
    put_words(nc, put(std::int8_t{}), {c.words.begin(), c.words.end()});
  else if (c.unit == lattice::kCounted)
    put(std::int64_t{});
  else
    put(double{});
}

}  // namespace

namespace {

/// A line for each of the first `most` runs.
std::string table_of(const lattice::Scene& scene, const Recordings& recordings, std::size_t most) {
  const std::vector<Recording>& runs = recordings.runs;
  const std::size_t shown = std::min(runs.size(), most);
  std::size_t longest_ending = 14;
  for (std::size_t i = 0; i < shown; ++i)
    longest_ending = std::max(longest_ending, runs[i].ending.size());
  std::vector<TextColumn> columns{{"trial", 6},
                                  {"ending", -static_cast<int>(longest_ending) - 1, 0, "", "  "},
                                  {"time", 9},
                                  {"steps", 7},
                                  {"hits", 6}};
  if (recordings.across_field) columns.push_back({"gates", 6});
  for (const char* energy : {"work", "lost", "in hits", "left over"})
    columns.push_back({energy, 11});
  TextTable table(columns);
  const Readings show(scene, runs);
  for (std::size_t i = 0; i < shown; ++i) {
    const Recording& r = runs[i];
    const dynamics::Energies& e = r.moments.back().energy;
    std::vector<TextCell> cells{r.trial, r.ending, show.seconds(r.seconds), r.health.steps,
                                r.health.impacts};
    if (recordings.across_field) cells.emplace_back(r.gates);
    for (const double energy :
         {e.propulsion_work + e.random_work, e.lost, e.hit_loss, e.mechanical()})
      cells.emplace_back(show.joules(energy));
    table.row(cells);
  }
  const std::size_t more = runs.size() - shown;
  return table.text() + (more > 0 ? fmt::format("  ... and {} more\n", more) : "");
}

/// "3 trapped, 1 traversed left"
std::string endings_of(const std::vector<Recording>& runs) {
  std::vector<std::pair<std::string, std::int64_t>> counts;
  for (const Recording& r : runs) {
    const auto at =
        std::ranges::find(counts, r.ending, &std::pair<std::string, std::int64_t>::first);
    if (at == counts.end())
      counts.emplace_back(r.ending, 1);
    else
      ++at->second;
  }
  std::string text;
  for (const auto& [ending, n] : counts)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", n, ending);
  return text;
}

}  // namespace

std::string answer_text(const lattice::Scene& scene, const Recordings& recordings) {
  const std::vector<Recording>& runs = recordings.runs;
  return wrapped(fmt::format("Recorded {}: {}.", counted(std::ssize(runs), "run", "runs"),
                             endings_of(runs))) +
         table_of(scene, recordings, kFewLines);
}

std::string details_text(const lattice::Scene& scene, const Recordings& recordings) {
  return (recordings.runs.size() > kFewLines ? "\n" + table_of(scene, recordings, kMostLines)
                                             : "") +
         "\nwork: of the propulsion and the random force. lost: to hits, dampers and drag; in "
         "hits: "
         "the part\nof it that hits took. left over: kinetic energy of body and beams, and elastic "
         "energy.\n" +
         scene_line(scene, recordings.actions);
}

std::string csv_of(const Recordings& recordings) {
  const std::vector<Column> columns = lattice::columns_of(recordings);
  std::string text;
  for (const Column& c : columns) text += (text.empty() ? "" : ",") + std::string(c.name);
  text += '\n';
  for (const Recording& r : recordings.runs)
    for (const Moment& m : r.moments) {
      std::string row;
      for (const Column& c : columns) {
        const double x = c.value({recordings.of(m), r.trial, m});
        row += row.empty() ? "" : ",";
        if (!c.words.empty())
          row += c.words[static_cast<std::size_t>(x)];
        else
          row += c.unit == lattice::kCounted ? std::to_string(static_cast<std::int64_t>(x))
                                             : digits(x);
      }
      text += row + '\n';
    }
  return text;
}

std::string netcdf_of(const Recordings& recordings, const Provenance& made_by) {
  using namespace markov::netcdf;
  Image nc;
  nc.create();
  put_text(nc, NC_GLOBAL, "format", "gatewalk traces");
  put_conventions(nc);
  put_text(nc, NC_GLOBAL, "title", "Bodies in a field of gates, step by step");
  put_text(nc, NC_GLOBAL, "featureType", "trajectory");
  for (const auto& [key, text] : attributes_of(made_by)) put_text(nc, NC_GLOBAL, key, text);
  std::size_t samples = 0;
  for (const Recording& r : recordings.runs) samples += r.moments.size();
  const int sample = define_dimension(nc, "sample", samples);
  put_runs(nc, recordings);
  for (const Column& c : lattice::columns_of(recordings)) put_column(nc, sample, c, recordings);
  const std::vector<char> bytes = nc.close_image();
  return {bytes.begin(), bytes.end()};
}

void describe_details(Fields& out, const Recordings& recordings, const Recording& run,
                      double joule) {
  out.count({"trial", "1", "number of the trial, counted from 0"}, run.trial);
  out.count({"hits", "1", "number of hits of the body on beams"}, run.health.impacts);
  for (const char* name : {"potential_J", "elastic_left_J", "elastic_right_J", "landscape_J",
                           "landscape_left_J", "landscape_right_J"}) {
    const Column& c = lattice::column(name);
    std::vector<double> values;
    for (const Moment& m : run.moments)
      values.push_back(seven_digits(c.value({recordings.of(m), run.trial, m}), joule));
    out.numbers({name, c.unit, c.meaning}, values);
  }
}

namespace {

/// The place of a body in the whole field, from the middle of the first gate's lower edge (m).
std::array<double, 2> place(const Scene& scene, const lattice::Moment& m) {
  const dynamics::BodyState& b = m.sample.state.body;
  return {b.x + 2.0 * scene.gate.beams.joint_x * m.i_x, b.y + scene.gate.run.traverse_y * m.i_y};
}

struct Window {
  double left, right, bottom, top;  // m
  int first_row;                    // that of the start
};

/// The smallest window of whole gates that holds all tracks.
Window window_of(const Scene& scene, const std::vector<const Recording*>& runs) {
  const double half = scene.gate.beams.joint_x, deep = scene.gate.run.traverse_y;
  const int first = runs.empty() ? 0 : runs.front()->moments.front().i_y;
  Window w{-half, half, first * deep, (first + 1) * deep, first};
  for (const Recording* run : runs)
    for (const lattice::Moment& m : run->moments) {
      w.left = std::min(w.left, (2 * m.i_x - 1) * half);
      w.right = std::max(w.right, (2 * m.i_x + 1) * half);
      w.top = std::max(w.top, (m.i_y + 1) * deep);
      w.bottom = std::min(w.bottom, place(scene, m)[1] - scene.gate.body.radius);
    }
  return w;
}

/// Adds the beams at rest of every gate in the window: "x y dx dy" from joint to tip.
void add_beams(Rows& beams, const Scene& scene, const lattice::FieldGates& gates, const Window& w,
               double metre) {
  const auto& b = scene.gate.beams;  // all gates have the same joints
  const auto columns = std::lround((w.right - w.left) / (2.0 * b.joint_x)),
             rows = std::lround(w.top / scene.gate.run.traverse_y);
  const long first = std::lround(w.left / (2.0 * b.joint_x) + 0.5);  // i_x
  for (long r = w.first_row; r < rows; ++r)
    for (long c = 0; c < columns; ++c) {
      const double beam =
          gates.at(static_cast<int>(first + c) + scene.field.start_column(), static_cast<int>(r))
              .beams.length;
      const double middle = w.left + static_cast<double>(2 * c + 1) * b.joint_x,
                   y = b.joint_y + static_cast<double>(r) * scene.gate.run.traverse_y;
      for (const double side : {-1.0, 1.0})
        beams.add((middle + side * b.joint_x) / metre, y / metre, -side * beam / metre, 0);
    }
}

}  // namespace

Figure figure_of(const Scene& scene, const Recordings& recordings) {
  std::vector<const Recording*> runs;
  for (const Recording& r : recordings.runs)
    if (runs.size() < kMostDrawn) runs.push_back(&r);
  const Window w = window_of(scene, runs);
  const Sized metre = readable_unit("m", std::max({w.top, w.right, -w.left}));
  Panels out;
  std::vector<const Rows*> ways;
  Rows ends("$ends");
  for (const Recording* run : runs) {
    Rows& way = out.data(fmt::format("$way{}", run->trial));
    const std::size_t stride = run->moments.size() / 4000 + 1;  // no more than can be seen
    for (std::size_t i = 0; i < run->moments.size(); i += stride) {
      const auto [x, y] = place(scene, run->moments[i]);
      way.add(x / metre.size, y / metre.size);
    }
    const auto [x, y] = place(scene, run->moments.back());
    way.add(x / metre.size, y / metre.size);
    ends.add(x / metre.size, y / metre.size, scene.gate.body.radius / metre.size);
    ways.push_back(&way);
  }
  const bool over_landscape = !recordings.across_field;
  const double wide = w.right - w.left, tall = w.top - w.bottom;
  const double room = over_landscape ? 320.0 : 414.0, scale = std::min(room / wide, 560.0 / tall);
  Panel& panel = out.add({78, 78 + scale * wide, 44, 44 + scale * tall});
  const int height = static_cast<int>(panel.box.bottom + (over_landscape ? 84 : 62));
  const std::string title =
      runs.size() == 1 ? fmt::format("trial {}: {}", runs.front()->trial, runs.front()->ending)
                       : fmt::format("{} trials{}", runs.size(),
                                     runs.size() < recordings.runs.size()
                                         ? fmt::format(" of {}", recordings.runs.size())
                                         : "");
  panel.say(title + "; disc: where it ended", 8, 18);
  panel.border = 15;
  panel.x = {fmt::format("x ({})", metre.name), w.left / metre.size, w.right / metre.size,
             digits(tic_step(wide / metre.size, std::max(1.0, panel.box.width() / 70.0)))};
  panel.y = {fmt::format("y ({})", metre.name), w.bottom / metre.size, w.top / metre.size};
  if (over_landscape) {
    const dynamics::Landscape l =
        dynamics::landscape(scene.gate, std::min(0.0, w.bottom), scene.gate.run.traverse_y / 120.0);
    const double highest = ceiling_of(l);
    const Sized joule = readable_unit("J", highest);
    Rows& ground = out.data("$ground");
    add_rows(ground, l, metre, joule, highest);
    panel.colours = {kFree, highest / joule.size, panel.box.beside(14, 12), "",
                     fmt::format("potential energy ({})", joule.name)};
    panel.say(fmt::format("cut at {}; no colour: {}", short_energy(highest, joule), kHole), 8,
              height - 12, kSmallFont);
    panel.draw(ground, "1:2:4", "image pixels");
  }
  for (const Rows* way : ways)
    if (over_landscape)
      panel.draw_outlined(*way, "1:2", "lines", {"#000000", 3}, {"#ffffff", 1.2});
    else
      panel.draw(*way, "1:2", "lines", {kFirstColour, 1.5});
  const Rows& discs = out.data(std::move(ends));
  Rows& beams = out.data("$beams");
  add_beams(beams, scene, recordings.gates, w, metre.size);
  panel.draw(beams, "1:2:3:4", "vectors nohead", {kSecondColour, 2});
  panel.more = "set style fill empty border\n";
  panel.draw(discs, "1:2:3", "circles", {over_landscape ? "#ffffff" : kInk});
  return out.figure(height);
}

}  // namespace gatewalk::cli
