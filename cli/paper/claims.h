// SPDX-License-Identifier: MIT
#pragma once
/// The claims of the paper's abstract and of Secs. II and III beside what was found.

#include <cstdint>
#include <string>
#include <vector>

#include "cli/paper/findings.h"
#include "cli/paper/verdicts.h"

namespace gatewalk::cli {

struct Claim {
  const char* id;
  const char* where;  // in the paper
  std::string claim, paper, ours;
  Verdict verdict;
  std::string why;  // may be empty
  const char* see;  // a section of the report
};

/// All of them, in the order of the report.
[[nodiscard]] std::vector<Claim> claims_of(const Findings& f);

/// Objects with the members of Claim as keys.
[[nodiscard]] Json to_json(const std::vector<Claim>& claims);
[[nodiscard]] std::string csv_of(const std::vector<Claim>& claims);
[[nodiscard]] std::string table_of(const std::vector<Claim>& claims);

// ---- One by one

// Fig. 8 (claims_equal_beams.cpp)
Claim rises_with_propulsion(const Findings& f);
Claim rises_then_falls(const Findings& f);
Claim peak_at_20(const Findings& f);
Claim exits_grow(const Findings& f);
Claim escape(const Findings& f);

// Figs. 9 and 12 (claims_unequal_beams.cpp)
Claim softer_side(const Findings& f);
Claim thirteen_and_eight(const Findings& f);
Claim alike(const Findings& f);
/// `printed` % by the left beam, with these beams.
Claim percentage(const Findings& f, const char* id, const char* where, double k_left,
                 double damping, std::int64_t printed);
/// `strong`: with a strong random force.
Claim right_share_falls(const Findings& f, bool strong);
Claim fig12_propulsion(const Findings& f);

// Landscape and Secs. II-A, II-B (claims_landscape.cpp)
Claim accord(const Findings& f);
Claim landscape_sides();
Claim basin(const Findings& f);
Claim steep(const Findings& f);
Claim above_landscape(const Findings& f);
Claim many_hits(const Findings& f);
Claim inertia();
Claim euler_step(const Findings& f);
Claim run_time(const Findings& f);

// Sec. III-C (claims_field.cpp)
Claim table4_row(const Findings& f, std::size_t start, const char* id);
Claim accuracy(const Findings& f);
Claim speed_up(const Findings& f);
Claim side_entries(const Findings& f);
Claim side_entries_free();
Claim velocities(const Findings& f);
Claim drag(const Findings& f);
Claim states();
Claim thirteen_steps(const Findings& f);

// ---- What several of them say or look up

[[nodiscard]] std::string number(double x, int digits = 0);
[[nodiscard]] std::string of(std::int64_t part, std::int64_t whole);  // "3 of 8"
/// Traversed in Fig. 8.
[[nodiscard]] Share fig8_at(const Findings& f, double damping, double force, double random);
[[nodiscard]] const SweepPoint& fig12_at(const Findings& f, double damping, double force,
                                         double random, double k_left);

}  // namespace gatewalk::cli
