// SPDX-License-Identifier: MIT
#pragma once
/// The claims of the paper's abstract and of Secs. II and III, each with the result found here.

#include <concepts>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "cli/paper/findings.h"
#include "cli/paper/verdicts.h"

namespace gatewalk::cli {

struct Claim {
  const char* id = "";
  const char* where = "";  // place in the paper
  std::string claim, paper, ours;
  Verdict verdict = Verdict::cannot_tell;
  std::string why;       // may be empty
  const char* see = "";  // id of a section of the report
};

/// The section of the report with Table IV, to which the claims about its starts point.
inline constexpr const char* kTable4 = "table4";

/// All claims, in the order of the report.
[[nodiscard]] std::vector<Claim> claims_of(const Findings& f);
/// The claim of this id. Throws std::out_of_range for an unknown id.
[[nodiscard]] Claim claim_of(std::string_view id, const Findings& f);

[[nodiscard]] std::string csv_of(const std::vector<Claim>& claims);
/// A text table of all claims, each with its verdict, the paper's value and ours.
[[nodiscard]] std::string table_of(const std::vector<Claim>& claims);
/// A text table: Table IV beside the values found here, and the other claims that differ.
[[nodiscard]] std::string summary_of(const std::vector<Claim>& claims);

// ---- The table of claims

/// A measured value as it stands in a claim's texts. A sentence whose value is missing is left out.
struct Said {
  std::variant<std::monostate, double, std::string> held;

  Said() = default;
  template <class T>
  requires std::integral<T> || std::floating_point<T> Said(T x) : held(static_cast<double>(x)) {}
  Said(std::string words) : held(std::move(words)) {}
  Said(const char* words) : held(words) {}
  Said(const Share& s) : held(percent_text(s)) {}
};
[[nodiscard]] inline Said when(bool applies, Said value) { return applies ? value : Said(); }
[[nodiscard]] std::string of(std::int64_t part, std::int64_t whole);  // "3 of 8"

using Values = std::map<std::string, Said, std::less<>>;  // by their names in the texts
struct Measured {
  Verdict verdict;
  Values values;
};
/// The trend's verdict and values, together with the values `more`.
[[nodiscard]] Measured measured(const Trend& trend, Values more, bool wiggles = false);

/// A claim and the measurement that tests it. In all texts {name} stands for a measured value,
/// {name:2} for a number with two decimals.
struct ClaimRow {
  struct Place {
    const char *id, *where, *see;  // id; place in the paper; section of the report
  } place;
  const char* text;
  struct Sides {
    const char *paper, *ours;
    Measured (*measure)(const Findings&);  // measures, and gives the verdict
  } sides;
  std::vector<const char*> why;  // sentences
};
[[nodiscard]] std::vector<ClaimRow> claims_on_shares();     // Figs. 8, 9, 12
[[nodiscard]] std::vector<ClaimRow> claims_on_the_field();  // Sec. III-C
[[nodiscard]] std::vector<ClaimRow> claims_on_one_run();    // Secs. II-A to II-C

}  // namespace gatewalk::cli
