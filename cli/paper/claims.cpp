// SPDX-License-Identifier: MIT
#include "cli/paper/claims.h"

#include <fmt/core.h>

#include <optional>
#include <stdexcept>

#include "cli/fields/csv.h"
#include "cli/fields/text.h"
#include "cli/fields/text_table.h"
#include "cli/paper/studies.h"

namespace gatewalk::cli {
namespace {

/// The text with its values; nullopt if one of them is missing.
std::optional<std::string> filled(std::string_view text, const Measured& measured) {
  std::string out;
  for (;;) {
    const std::size_t open = text.find('{');
    out += text.substr(0, open);
    if (open == text.npos) return out;
    const std::size_t close = text.find('}', open);
    const std::string_view inside = text.substr(open + 1, close - open - 1),
                           name = inside.substr(0, inside.find(':'));
    const auto& value = measured.values.at(std::string(name)).held;
    if (const auto* const number = std::get_if<double>(&value))
      out += fixed(*number, name == inside ? 0 : inside.back() - '0');
    else if (const auto* const words = std::get_if<std::string>(&value))
      out += *words;
    else
      return std::nullopt;
    text.remove_prefix(close + 1);
  }
}

Claim claim_of(const ClaimRow& row, const Findings& f) {
  const Measured measured = row.sides.measure(f);
  const auto said = [&](const char* text) { return filled(text, measured).value_or(""); };
  std::string why;
  for (const char* sentence : row.why)
    if (const auto text = filled(sentence, measured)) why += (why.empty() ? "" : " ") + *text;
  return {row.place.id,
          row.place.where,
          said(row.text),
          said(row.sides.paper),
          said(row.sides.ours),
          measured.verdict,
          why,
          row.place.see};
}

std::vector<ClaimRow> table() {
  std::vector<ClaimRow> rows = claims_on_shares();
  for (const auto& more : {claims_on_the_field(), claims_on_one_run()})
    rows.insert(rows.end(), more.begin(), more.end());
  return rows;
}

}  // namespace

std::string of(std::int64_t part, std::int64_t whole) {
  return fmt::format("{} of {}", part, whole);
}

Measured measured(const Trend& t, Values more, bool wiggles) {
  more.insert({{"up", of(t.up, t.series)},
               {"down", t.down},
               {"falling", when(t.falling > 0, of(t.falling, t.steps))},
               {"fall", 100 * t.largest_fall},
               {"from", t.at},
               {"seen", t.seen},
               {"seen_of", when(t.lower > 0, of(t.seen, t.lower))}});
  return {t.verdict(wiggles), more};
}

std::vector<Claim> claims_of(const Findings& f) {
  std::vector<Claim> claims;
  for (const ClaimRow& row : table()) claims.push_back(claim_of(row, f));
  return claims;
}

Claim claim_of(std::string_view id, const Findings& f) {
  for (const ClaimRow& row : table())
    if (id == row.place.id) return claim_of(row, f);
  throw std::out_of_range("no claim " + std::string(id));
}

std::string csv_of(const std::vector<Claim>& claims) {
  Csv csv("id,where,claim,paper,ours,verdict,why,see");
  for (const Claim& c : claims)
    csv.row(c.id, c.where, c.claim, c.paper, c.ours, std::string(name_of(c.verdict)), c.why, c.see);
  return csv.text();
}

std::string table_of(const std::vector<Claim>& claims) {
  const std::string indent(13, ' ');
  std::string text;
  for (const Claim& c : claims)
    text += wrapped(fmt::format("{:13}{} ({})", name_of(c.verdict), c.claim, c.where), indent) +
            wrapped(fmt::format("{}paper: {}; here: {}", indent, c.paper, c.ours), indent);
  return text;
}

std::string summary_of(const std::vector<Claim>& claims) {
  const auto is_of_table4 = [](const Claim& c) { return std::string_view(c.see) == kTable4; };
  TextTable table({{"Table IV", -kFit, 0, "", "  "},
                   {"paper", kFit, 0, "", "  "},
                   {"here (sd)", kFit, 0, "", "  "},
                   {"", 0, 0, "", "  "}});
  // "Chain and dynamics, d = 0 m, v = (0, 15) m/s."
  const auto start_of = [](const std::string& claim) {
    const std::size_t from = claim.find("d = ");
    return claim.substr(from, claim.rfind('.') - from);
  };
  std::string differing;
  for (const Claim& c : claims)
    if (is_of_table4(c))
      table.row({start_of(c.claim), c.paper, c.ours, name_of(c.verdict)});
    else if (c.verdict == Verdict::differs)
      differing +=
          wrapped(fmt::format("- {} Paper: {}; here: {}.", c.claim, c.paper, c.ours), "  ");
  return "Corrcoef / RMSE of the final gates, 100 trials of the full dynamics against the "
         "chain:\n" +
         table.text() +
         (differing.empty() ? "" : "Of the other claims these differ:\n" + differing);
}

}  // namespace gatewalk::cli
