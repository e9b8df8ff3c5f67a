// SPDX-License-Identifier: MIT
#include "cli/fields/json_value.h"
#include "cli/paper/page.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace gatewalk::cli {
namespace {

/// The smallest report that has one of everything.
Report sample() {
  return {.title = "T",
          .paper = "P",
          .claims = {{"c1", "W", "C1", "52 %", "46.0 % [45.3, 46.7]", Verdict::agrees, "", "fig1"},
                     {"c2", "W", "C2", "P", "O", Verdict::differs, "Because.", "play"}},
          .lead = {"k_L and F_prop"},
          .first = {{"x.svg", "A", "C", "gatewalk show m.nc"}},
          .sections = {{"fig1", "Fig. 1: H", {"T"}, "A", {"gatewalk gate"}, {"fig1.svg"}, nullptr},
                       {"play", "H", {"T"}, "A", {}, {}, {{"title", "F"}}}},
          .made_by = {"P", "C", "M", "D", 1.5, {{"N", "T"}}}};
}

std::string page_of(const Report& report) {
  return report_page(report, [](const std::string& name) {
    return "<svg id='" + name + "'\nwidth='1' fill='#fff'>100%</svg>";
  });
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++n;
  return n;
}

TEST(ReportPage, HoldsEveryClaimAndSection) {
  const Report report = sample();
  const std::string page = page_of(report);
  for (const Claim& claim : report.claims)
    EXPECT_EQ(count(page, "id=\"claim-" + std::string(claim.id) + "\""), 1u);
  for (const Report::Section& s : report.sections)
    EXPECT_EQ(count(page, "<section id=\"" + s.id + "\""), 1u);
  EXPECT_EQ(count(page, "{{"), 0u) << "a place of the template left open";
}

TEST(ReportPage, HoldsItsPicturesWhole) {
  const std::string page = page_of(sample());
  for (const char* name : {"x.svg", "fig1.svg"})
    EXPECT_EQ(count(page, "data:image/svg+xml,&lt;svg id='" + std::string(name) +
                              "'%0Awidth='1' fill='%23fff'&gt;100%25&lt;/svg&gt;"),
              1u);
}

TEST(ReportPage, PrintsIndicesAndKeepsNumbersTogether) {
  const std::string page = page_of(sample());
  EXPECT_EQ(count(page, "k<sub>L</sub> and F<sub>prop</sub>"), 1u);
  EXPECT_EQ(count(page, "46.0&nbsp;% [45.3,&nbsp;46.7]"), 1u);
}

// Claims that differ stand first.
TEST(ReportPage, PutsWhatDiffersOnTop) {
  const std::string page = page_of(sample());
  EXPECT_LT(page.find("id=\"claim-c2\""), page.find("id=\"claim-c1\""));
}

// Text of a report is escaped: it can neither become markup nor end the script with the data.
TEST(ReportPage, TextStaysText) {
  Report report = sample();
  const std::string plain = page_of(report);
  report.title = "<i>title</i>";
  report.sections[1].film["title"] = "</script><i>title</i><!--";
  report.sections[0].alt = "\"><i>title</i>";
  const std::string page = page_of(report);
  EXPECT_EQ(count(page, "<i>title"), 0u);
  EXPECT_EQ(count(page, "</script"), count(plain, "</script"));
}

// Wrong reports give an error rather than an empty place on the page.
TEST(ReportPage, RefusesWhatItDoesNotKnow) {
  Report report = sample();
  report.claims[0].see = "nowhere";
  EXPECT_THROW((void)page_of(report), std::invalid_argument);
  report = sample();
  report.sections[1].id = report.sections[0].id;
  EXPECT_THROW((void)page_of(report), std::invalid_argument);
}

TEST(ReportPage, ItsJsonHasTheFilmsInTheirSections) {
  const Json json = json_of([](Fields& out) { describe(out, sample()); });
  EXPECT_EQ(json.at("claims").at(1).at("verdict"), "differs");
  EXPECT_FALSE(json.at("sections").at(0).contains("film"));
  EXPECT_EQ(json.at("sections").at(1).at("film").at("title"), "F");
  EXPECT_EQ(json.at("made_by").at("scenes").at(0).at("name"), "N");
}

}  // namespace
}  // namespace gatewalk::cli
