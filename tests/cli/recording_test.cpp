#include "cli/render/recording.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "dynamics/landscape.h"
#include "tests/cli/films.h"

namespace gatewalk::cli {
namespace {

lattice::Scene scene(const std::string& more = "") {
  return lattice::parse_scene(
      "[beams]\nstiffness_left_Nm_per_rad = 300.0\nstiffness_right_Nm_per_rad = "
      "500.0\ndamping_Nms_per_rad = 10.0\n"
      "[forces]\npropulsion_N = 7.0\nrandom_N = 10.0\ndrag_Ns_per_m = 0.0\n[run]\ntraverse_y_m = "
      "65.0\n[start]\nvy_m_per_s = 0.0\n" +
          more,
      "soft.toml");
}

std::vector<std::vector<std::string>> table(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
  }
  return rows;
}

// The endings are those that `gate` counts.
TEST(Recording, EndsAsTheRunThatIsCounted) {
  const lattice::Scene s = scene();
  dynamics::GateTally counted = dynamics::run_gate_trials(s.gate, s.start, 5, {10, 12});
  std::map<std::string, std::int64_t> ends;
  for (int i = 10; i < 22; ++i) ++ends[record(s, 5, i, false).ending];
  EXPECT_EQ(ends["traversed left"], counted.traversed_left);
  EXPECT_EQ(ends["exited left"], counted.exited_left);
  EXPECT_EQ(ends["exited right"], counted.exited_right);
  EXPECT_EQ(ends["trapped"], counted.trapped);
  EXPECT_GE(ends.size(), 3u);
  const auto known = endings(false);
  for (const auto& [ending, n] : ends)
    EXPECT_NE(std::find(known.begin(), known.end(), ending), known.end());
}

TEST(Recording, CsvHasALineForEachMomentAndFitsTheLandscape) {
  const lattice::Scene s = scene();
  const std::vector<Recording> runs{record(s, 1, 0, false), record(s, 1, 2, false)};
  const auto rows = table(csv_of(s, runs));
  ASSERT_EQ(rows.size(), 1 + runs[0].moments.size() + runs[1].moments.size());
  const auto column = [&](const char* name) {
    const auto at = std::find(rows[0].begin(), rows[0].end(), name);
    EXPECT_NE(at, rows[0].end()) << name;
    return static_cast<std::size_t>(at - rows[0].begin());
  };
  const auto number = [&](std::size_t row, const char* name) {
    return std::stod(rows[row][column(name)]);
  };
  std::map<std::string, int> modes;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i].size(), rows[0].size());
    ++modes[rows[i][column("contact_left")]];
    const double x = number(i, "x_m"), y = number(i, "y_m");
    const double height =
        dynamics::beam_energy(s.gate, x, y) + dynamics::propulsion_energy(s.gate, y);
    if (std::isfinite(height)) {
      EXPECT_NEAR(number(i, "landscape_J"), height, 1e-3 * (1 + std::abs(height)));
    }
    const double kept = number(i, "kinetic_body_J") + number(i, "kinetic_beams_J") +
                        number(i, "elastic_left_J") + number(i, "elastic_right_J");
    EXPECT_NEAR(number(i, "propulsion_work_J") + number(i, "random_work_J"),
                kept + number(i, "lost_J"), 2e-4);
  }
  EXPECT_EQ(rows.back()[column("trial")], "2");
  EXPECT_GT(modes["free"], 100);
  EXPECT_GT(modes["hit"], 3);
  EXPECT_GT(modes["held"], 3);
}

// Gate after gate: time and losses go on, the field's frame has no jumps.
TEST(Recording, GoesOnFromGateToGate) {
  const lattice::Scene s = lattice::parse_scene("", "field.toml");
  for (int trial = 0; trial < 5; ++trial) {
    const Recording r = record(s, 1, trial, true);
    for (std::size_t i = 1; i < r.moments.size(); ++i) {
      const Moment &a = r.moments[i - 1], &b = r.moments[i];
      EXPECT_GE(b.time, a.time);
      EXPECT_GE(b.energy.lost, a.energy.lost - 0.01);
      const double ax = a.sample.state.body.x + 50 * a.i_x, bx = b.sample.state.body.x + 50 * b.i_x;
      const double ay = a.sample.state.body.y + 60 * a.i_y, by = b.sample.state.body.y + 60 * b.i_y;
      EXPECT_LT(std::hypot(bx - ax, by - ay), 0.02 * 60);
      const double start = 0.5 * 15 * 15;
      EXPECT_NEAR(start + b.energy.propulsion_work + b.energy.random_work,
                  b.energy.mechanical() + b.energy.lost, 1e-6);
    }
  }
}

// A film's force holds until the next entry; a sample's acted before it.
TEST(Recording, FilmHasTheForceThatComes) {
  const lattice::Scene s = scene();
  const std::vector<Recording> runs{record(s, 1, 0, false)};
  Json film = film_of(s, runs, false);
  const Json& run = film["runs"][0];
  const auto& moments = runs[0].moments;
  ASSERT_EQ(run["random_N"].size(), moments.size());
  ASSERT_EQ(run["t"].size(), moments.size());
  for (std::size_t i = 0; i + 1 < moments.size(); ++i)
    EXPECT_NEAR(run["random_N"][i].get<double>(), moments[i + 1].sample.random_force, 1e-5);
  EXPECT_FALSE(run.contains("landscape_J"));
  add_details(film, s, runs);
  EXPECT_EQ(film["runs"][0]["landscape_J"].size(), moments.size());
  EXPECT_EQ(film["runs"][0]["hits"], runs[0].health.impacts);
}

/// The scene in other units: each of its keys times what its unit is made of.
lattice::Scene in_other_units(const lattice::Scene& s, double length, double mass, double time) {
  const double force = mass * length / (time * time);
  lattice::Scene other = s;
  other.gate.body = {s.gate.body.mass * mass, s.gate.body.radius * length};
  dynamics::Beams& beams = other.gate.beams;
  for (double* const x : {&beams.length, &beams.joint_x, &beams.joint_y}) *x *= length;
  beams.mass *= mass;
  for (double* const k : {&beams.stiffness_left, &beams.stiffness_right}) *k *= force * length;
  beams.damping *= force * length * time;
  dynamics::Forces& forces = other.gate.forces;
  forces = {forces.propulsion * force, forces.random * force, forces.random_rate / time,
            forces.drag * mass / time};
  other.gate.contact.impulse_threshold *= force * time;
  dynamics::Run& run = other.gate.run;
  for (double* const t : {&run.step, &run.time_limit}) *t *= time;
  for (double* const x : {&run.traverse_y, &run.event_tolerance}) *x *= length;
  other.start = {s.start.x * length, s.start.y * length, s.start.vx * length / time,
                 s.start.vy * length / time};
  return other;
}

/// What a recording is in other units.
Recording in_other_units(Recording r, double length, double mass, double time) {
  const double speed = length / time, force = mass * speed / time, joule = force * length;
  const auto scale = [&](dynamics::Energies& e) {
    for (double* const x : {&e.body, &e.beams[0], &e.beams[1], &e.elastic[0], &e.elastic[1],
                            &e.propulsion_work, &e.random_work, &e.hit_loss, &e.lost})
      *x *= joule;
  };
  r.seconds *= time;
  for (Moment& m : r.moments) {
    m.time *= time;
    m.sample.time *= time;
    auto& [body, beams] = m.sample.state;
    body = {body.x * length, body.y * length, body.vx * speed, body.vy * speed};
    m.sample.random_force *= force;
    for (std::size_t i = 0; i < 2; ++i) {
      beams[i].omega /= time;
      m.sample.beam_force[i] *= force;
      m.sample.impulse[i] *= force * time;
      m.sample.gap[i] *= length;
    }
    scale(m.sample.energy);
    scale(m.energy);
  }
  return r;
}

/// A film without what is said in words, which name numbers with their units.
Json without_words(Json film) {
  film.erase("title");
  for (Json& run : film["runs"]) run.erase("label");
  return film;
}

// In other units a film has the same numbers times these, to the last bit; the CSV has its seven
// digits.
TEST(Recording, InOtherUnitsHasTheSameNumbers) {
  for (const auto& [s, across] :
       {std::pair{scene("x_m = 1.5\n"), false}, {lattice::parse_scene("", "field.toml"), true}}) {
    const std::vector<Recording> runs{record(s, 3, 1, across), record(s, 3, 2, across)};
    Json film = film_of(s, runs, across);
    add_details(film, s, runs);
    const auto lines = table(csv_of(s, runs));
    for (const auto& [l, m, t] : kTwins) {
      const double length = power(l), mass = power(m), time = power(t),
                   force = mass * length / (time * time);
      const lattice::Scene other = in_other_units(s, length, mass, time);
      std::vector<Recording> others;
      for (const Recording& run : runs) others.push_back(in_other_units(run, length, mass, time));
      Json there = film_of(other, others, across);
      add_details(there, other, others);
      EXPECT_TRUE(without_words(there) == without_words(twin(film, length, mass, time)))
          << l << " " << m << " " << t;

      const auto other_lines = table(csv_of(other, others));
      ASSERT_EQ(other_lines.size(), lines.size());
      std::size_t compared = 0;
      for (std::size_t row = 1; row < lines.size(); row += 7)
        for (std::size_t c = 0; c < lines[0].size(); ++c) {
          const std::string& name = lines[0][c];
          const double factor = name.ends_with("_J")           ? force * length
                                : name.ends_with("_N")         ? force
                                : name.ends_with("_Ns")        ? force * time
                                : name.ends_with("_m_per_s")   ? length / time
                                : name.ends_with("_rad_per_s") ? 1.0 / time
                                : name.ends_with("_m")         ? length
                                : name.ends_with("time_s")     ? time
                                                               : 0.0;
          if (factor == 0.0) {
            EXPECT_EQ(other_lines[row][c], lines[row][c]) << name;
            continue;
          }
          const double here = std::stod(lines[row][c]) * factor;
          ++compared;
          if (!std::isfinite(here)) continue;
          EXPECT_NEAR(std::strtod(other_lines[row][c].c_str(), nullptr), here,
                      1.1e-6 * std::abs(here))
              << name;
        }
      EXPECT_GT(compared, 1000u);
    }
  }
}

}  // namespace
}  // namespace gatewalk::cli
