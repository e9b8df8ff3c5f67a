// SPDX-License-Identifier: MIT
#include "cli/render/recording.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>

#include "cli/fields/json_value.h"
#include "cli/film/replay.h"
#include "dynamics/disc/landscape.h"
#include "lattice/scene/terrain.h"
#include "tests/cli/films.h"

namespace gatewalk::cli {
namespace {

using lattice::Moment;
using lattice::Recording;
using lattice::Recordings;
using test::Twin;

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

Recordings trials(const lattice::Scene& s, std::vector<std::int64_t> numbers, std::uint64_t seed,
                  bool across_field = false) {
  Recordings recordings{.gates = across_field ? lattice::gates_of(s) : lattice::FieldGates(s.gate),
                        .across_field = across_field,
                        .trials = std::ssize(numbers),
                        .runs = {},
                        .health = {}};
  for (const std::int64_t trial : numbers)
    recordings.runs.push_back(lattice::record(s, seed, trial, across_field));
  return recordings;
}

TEST(Recording, CsvHasALineForEachMomentAndFitsTheLandscape) {
  const lattice::Scene s = scene();
  const Recordings recordings = trials(s, {0, 2}, 1);
  const auto& runs = recordings.runs;
  const auto rows = table(csv_of(recordings));
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

// A film's step holds the force until the next step; a sample holds the force that acted before it.
/// The details of the first run.
Json details_of(const lattice::Scene& s, const Recordings& recordings) {
  return json_of([&](Fields& out) {
    describe_details(out, recordings, recordings.runs[0], dynamics::scale_of(s.gate).energy());
  });
}

TEST(Recording, FilmHasTheForceThatComes) {
  const lattice::Scene s = scene();
  const Recordings recordings = trials(s, {0}, 1);
  const auto& moments = recordings.runs[0].moments;
  const Film film = film_of(s, recordings);
  const std::vector<FilmStep>& steps = film.runs[0].steps;
  ASSERT_EQ(steps.size(), moments.size());
  for (std::size_t i = 0; i + 1 < moments.size(); ++i)
    EXPECT_NEAR(steps[i].random_force, moments[i + 1].sample.random_force, 1e-5);
  const Json json = json_of(film)["runs"][0];
  EXPECT_EQ(json["random_N"].size(), moments.size());
  EXPECT_FALSE(json.contains("landscape_J"));
  const Json details = details_of(s, recordings);
  EXPECT_EQ(details["landscape_J"].size(), moments.size());
  EXPECT_EQ(details["hits"], recordings.runs[0].health.impacts);
}

/// The scene in other units.
lattice::Scene in_other_units(lattice::Scene s, const Twin& twin) {
  s.gate = twin.of(s.gate);
  s.start = twin.of(s.start);
  return s;
}

/// The recordings in other units.
Recordings in_other_units(Recordings recordings, const Twin& twin) {
  const double time = twin.of(0, 1, 0), force = twin.of(1, -2, 1), joule = twin.of(2, -2, 1);
  const auto scale = [&](dynamics::Energies& e) {
    for (double* const x : {&e.body, &e.beams[0], &e.beams[1], &e.elastic[0], &e.elastic[1],
                            &e.propulsion_work, &e.random_work, &e.hit_loss, &e.lost})
      *x *= joule;
  };
  for (Recording& r : recordings.runs) {
    r.seconds *= time;
    for (Moment& m : r.moments) {
      m.time *= time;
      m.sample.time *= time;
      auto& [body, beams] = m.sample.state;
      body = twin.of(body);
      m.sample.random_force *= force;
      for (std::size_t i = 0; i < 2; ++i) {
        beams[i].omega /= time;
        m.sample.beam_force[i] *= force;
        m.sample.impulse[i] *= force * time;
        m.sample.gap[i] *= twin.of(1, 0, 0);
      }
      scale(m.sample.energy);
      scale(m.energy);
    }
  }
  return recordings;
}

/// The film without texts, because texts contain numbers with units.
Json without_words(const Film& film) {
  Json json = json_of(film);
  json.erase("title");
  for (Json& run : json["runs"]) run.erase("label");
  return json;
}

/// Checks that lines of CSV are `others` times the factors of their units, to seven digits.
void expect_same_numbers(const std::vector<std::vector<std::string>>& lines,
                         const std::vector<std::vector<std::string>>& others, const Twin& twin) {
  ASSERT_EQ(others.size(), lines.size());
  std::size_t compared = 0;
  for (std::size_t row = 1; row < lines.size(); row += 7)
    for (std::size_t c = 0; c < lines[0].size(); ++c) {
      const std::string& name = lines[0][c];
      const double factor = twin.of(name);
      if (name.ends_with("_rad") || name.find('_') == name.npos) {
        EXPECT_EQ(others[row][c], lines[row][c]) << name;
        continue;
      }
      const double here = std::strtod(lines[row][c].c_str(), nullptr) * factor;
      ++compared;
      if (!std::isfinite(here)) continue;
      EXPECT_NEAR(std::strtod(others[row][c].c_str(), nullptr), here, 1.1e-6 * std::abs(here))
          << name;
    }
  EXPECT_GT(compared, 1000u);
}

// In other units a film has the same numbers times the units' factors, to the last bit.
TEST(Recording, InOtherUnitsHasTheSameNumbers) {
  for (const auto& [s, across] :
       {std::pair{scene("x_m = 1.5\n"), false}, {lattice::parse_scene("", "field.toml"), true}}) {
    const Recordings here = trials(s, {1, 2}, 3, across);
    for (const Twin& twin : kOtherUnits) {
      SCOPED_TRACE(testing::Message() << twin);
      const lattice::Scene other = in_other_units(s, twin);
      Recordings there = in_other_units(here, twin);
      there.gates = across ? lattice::gates_of(other) : lattice::FieldGates(other.gate);
      EXPECT_TRUE(without_words(film_of(other, there)) ==
                  without_words(in_other_units(film_of(s, here), twin)));
      Json details = details_of(s, here);
      for (auto& [name, values] : details.items())
        for (Json& value : values)
          if (value.is_number_float()) value = value.get<double>() * twin.of(name);
      EXPECT_TRUE(details_of(other, there).dump() == details.dump());
      expect_same_numbers(table(csv_of(here)), table(csv_of(there)), twin);
    }
  }
}

}  // namespace
}  // namespace gatewalk::cli
