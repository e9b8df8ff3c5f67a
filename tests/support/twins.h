// SPDX-License-Identifier: MIT
#pragma once
/// Scenes rescaled by powers of 4, which causes no rounding: each number must equal that of the
/// original scene, times the power of its unit.

#include <array>
#include <cmath>
#include <ostream>
#include <string_view>
#include <vector>

#include "dynamics/disc/params.h"

namespace gatewalk::test {

/// Powers of 4 by which lengths, times and masses are multiplied.
struct Twin {
  int length = 0, time = 0, mass = 0;

  /// The factor of a quantity with unit length^l time^t mass^m.
  [[nodiscard]] double of(int l, int t, int m) const {
    return std::ldexp(1.0, 2 * (l * length + t * time + m * mass));
  }
  /// The factor of a name that ends in its unit, such as "run.step_s"; 1 for a pure number.
  [[nodiscard]] double of(std::string_view name) const {
    struct Unit {
      std::string_view suffix;
      int l, t, m;
    };
    // Longer suffixes first.
    static constexpr std::array<Unit, 13> kUnits{{{"_J_per_kg_m", 1, -2, 0},
                                                  {"_Nms_per_rad", 2, -1, 1},
                                                  {"_Nm_per_rad", 2, -2, 1},
                                                  {"_Ns_per_m", 0, -1, 1},
                                                  {"_m_per_s", 1, -1, 0},
                                                  {"_rad_per_s", 0, -1, 0},
                                                  {"_kg", 0, 0, 1},
                                                  {"_Hz", 0, -1, 0},
                                                  {"_Ns", 1, -1, 1},
                                                  {"_N", 1, -2, 1},
                                                  {"_J", 2, -2, 1},
                                                  {"_m", 1, 0, 0},
                                                  {"_s", 0, 1, 0}}};
    for (const Unit& u : kUnits)
      if (name.ends_with(u.suffix)) return of(u.l, u.t, u.m);
    return 1.0;
  }
  [[nodiscard]] dynamics::GateParams of(dynamics::GateParams p) const {
    for (const dynamics::ParamInfo& info : dynamics::gate_param_table())
      info.ref(p) *= of(info.key);
    return p;
  }
  [[nodiscard]] dynamics::BodyState of(const dynamics::BodyState& b) const {
    const double l = of(1, 0, 0), v = of(1, -1, 0);
    return {l * b.x, l * b.y, v * b.vx, v * b.vy};
  }
};

inline std::ostream& operator<<(std::ostream& out, const Twin& t) {
  return out << "lengths x 4^" << t.length << ", times x 4^" << t.time << ", masses x 4^" << t.mass;
}

/// Each unit alone and all together, from 4^-10 to 4^10.
inline std::vector<Twin> twins() {
  return {{-10, 0, 0},    {10, 0, 0},     {0, -10, 0},     {0, 10, 0},    {0, 0, -10},
          {0, 0, 10},     {-1, 0, 0},     {0, 1, 0},       {0, 0, -1},    {-3, -1, -1},
          {5, 7, -2},     {-10, 10, 10},  {10, -10, 10},   {10, 10, -10}, {-10, -10, 10},
          {-10, 10, -10}, {10, -10, -10}, {-10, -10, -10}, {10, 10, 10},  {-6, -8, 9},
          {2, -3, 4}};
}

}  // namespace gatewalk::test
