#pragma once
/// Small films, made by hand: the body goes straight ahead and pushes the beams aside.

#include <algorithm>
#include <cmath>

#include "cli/command.h"

namespace gatewalk::cli {

/// `steps` steps of 0.02 s; the body moves 0.5 m in each, a gate is 60 m deep.
inline Json small_film(int steps = 50) {
  Json run = {{"label", "trial 1: traversed left after " + std::to_string(steps / 50) + " s"},
              {"ending", "traversed left"},
              {"propulsion_N", 7.0}};
  for (const char* name :
       {"t", "gx", "gy", "x", "y", "vx", "vy", "left", "right", "contact_left", "contact_right",
        "random_N", "body_J", "beams_J", "elastic_J", "work_J", "lost_J", "lost_in_hits_J"})
    run[name] = Json::array();
  for (int i = 0; i <= steps; ++i) {
    const int row = i / 120;
    const double y = 0.5 * i - 60.0 * row, pushed = std::clamp(0.05 * (y - 15.0), 0.0, 1.2);
    const int contact = pushed == 0.0 ? 0 : y < 17.0 ? 1 : 2;
    run["t"].push_back(0.02 * i);
    run["gx"].push_back(0);
    run["gy"].push_back(row);
    run["x"].push_back(0.0);
    run["y"].push_back(y);
    run["vx"].push_back(0.0);
    run["vy"].push_back(25.0);
    for (const char* side : {"left", "right"}) run[side].push_back(pushed);
    for (const char* side : {"contact_left", "contact_right"}) run[side].push_back(contact);
    run["random_N"].push_back(10.0 * std::sin(i));
    run["body_J"].push_back(312.5);
    run["beams_J"].push_back(i % 3);
    run["elastic_J"].push_back(250.0 * pushed * pushed);
    run["work_J"].push_back(7.0 * 0.5 * i);
    run["lost_J"].push_back(3.0 * 0.5 * i);
    run["lost_in_hits_J"].push_back(0.0);
  }
  return {{"title", "A small film"},
          {"scale", {{"length_m", 1.0}, {"mass_kg", 1.0}, {"time_s", 1.0}}},
          {"radius_m", 10.0},
          {"beam_m", 25.0},
          {"joint_x_m", 25.0},
          {"joint_y_m", 30.0},
          {"gate_m", {50.0, 60.0}},
          {"columns", 1},
          {"rows", 1},
          {"start_column", 0},
          {"runs", {run}}};
}

/// Through three gates of a field of 3 x 3.
inline Json small_field_film() {
  Json film = small_film(330);
  film["title"] = "A small field";
  film["columns"] = film["rows"] = 3;
  return film;
}

/// The same film of a scene with other units: all lengths, masses and times times these.
inline Json twin(Json film, double length, double mass, double time) {
  const double speed = length / time, force = mass * speed / time, energy = force * length;
  const auto multiply = [](Json& values, double factor) {
    for (Json& value : values)
      if (value.is_number()) value = value.get<double>() * factor;
  };
  const auto at = [&](Json& object, const char* name, double factor) {
    object[name] = object.at(name).get<double>() * factor;
  };
  at(film["scale"], "length_m", length);
  at(film["scale"], "mass_kg", mass);
  at(film["scale"], "time_s", time);
  for (const char* name : {"radius_m", "beam_m", "joint_x_m", "joint_y_m"}) at(film, name, length);
  multiply(film["gate_m"], length);
  for (Json& run : film["runs"]) {
    at(run, "propulsion_N", force);
    multiply(run["t"], time);
    multiply(run["random_N"], force);
    for (const char* name : {"x", "y"}) multiply(run[name], length);
    for (const char* name : {"vx", "vy"}) multiply(run[name], speed);
    for (const auto& [name, values] : run.items())
      if (name.ends_with("_J")) multiply(values, energy);
  }
  return film;
}

/// Powers of 4 for lengths, masses and times: whatever is multiplied by them keeps its digits.
struct Powers {
  int length, mass, time;
};
inline constexpr Powers kTwins[] = {{-5, 0, 0},   {0, 5, 0},    {0, 0, -5}, {-10, -10, -10},
                                    {10, 10, 10}, {10, -10, 4}, {-3, 7, 10}};
inline double power(int exponent) { return std::ldexp(1.0, 2 * exponent); }

}  // namespace gatewalk::cli
