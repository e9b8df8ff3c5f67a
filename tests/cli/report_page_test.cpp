// SPDX-License-Identifier: MIT
#include "cli/paper/page.h"
#include "cli/render/json.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace gatewalk::cli {
namespace {

/// The smallest report that has one of everything.
Json sample() {
  return Json::parse(R"({"title": "T", "paper": "P", "lead": ["k_L and F_prop"],
    "first": [{"figure": "x.svg", "alt": "A", "caption": "C", "command": "gatewalk show m.nc"}],
    "claims": [
      {"id": "c1", "where": "W", "claim": "C1", "paper": "52 %", "ours": "46.0 % [45.3, 46.7]",
       "verdict": "agrees", "why": "", "see": "fig1"},
      {"id": "c2", "where": "W", "claim": "C2", "paper": "P", "ours": "O", "verdict": "differs",
       "why": "Because.", "see": "play"}],
    "sections": [
      {"id": "fig1", "heading": "Fig. 1: H", "text": ["T"], "alt": "A", "commands": ["gatewalk gate"],
       "files": ["fig1.svg"]},
      {"id": "play", "heading": "H", "text": ["T"], "alt": "A", "commands": [], "files": [],
       "film": {"title": "F"}}],
    "made_by": {"program": "P", "command": "C", "seed": 1, "machine": "M", "seconds": 1.5,
      "date": "D", "scenes": [{"name": "N", "text": "T"}]}})");
}

std::string page_of(const Json& report) {
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
  const Json report = sample();
  const std::string page = page_of(report);
  for (const Json& claim : report.at("claims")) {
    EXPECT_EQ(count(page, "id=\"claim-" + claim.at("id").get<std::string>() + "\""), 1u);
  }
  for (const Json& s : report.at("sections")) {
    EXPECT_EQ(count(page, "<section id=\"" + s.at("id").get<std::string>() + "\""), 1u);
  }
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

// What differs is read first.
TEST(ReportPage, PutsWhatDiffersOnTop) {
  const std::string page = page_of(sample());
  EXPECT_LT(page.find("id=\"claim-c2\""), page.find("id=\"claim-c1\""));
}

// Text of a report is text: it can neither become markup nor end the script that holds the data.
TEST(ReportPage, TextStaysText) {
  Json report = sample();
  const std::string plain = page_of(report);
  report["title"] = "<i>title</i>";
  report["sections"][1]["film"]["title"] = "</script><i>title</i><!--";
  report["sections"][0]["alt"] = "\"><i>title</i>";
  const std::string page = page_of(report);
  EXPECT_EQ(count(page, "<i>title"), 0u);
  EXPECT_EQ(count(page, "</script"), count(plain, "</script"));
}

// An error rather than an empty place on the page.
TEST(ReportPage, RefusesWhatItDoesNotKnow) {
  Json report = sample();
  report["claims"][0]["verdict"] = "splendid";
  EXPECT_THROW((void)page_of(report), std::invalid_argument);
  report = sample();
  report["claims"][0]["see"] = "nowhere";
  EXPECT_THROW((void)page_of(report), std::invalid_argument);
  report = sample();
  report["sections"][1]["id"] = report["sections"][0]["id"];
  EXPECT_THROW((void)page_of(report), std::invalid_argument);
  report = sample();
  report["claims"][0].erase("paper");
  EXPECT_THROW((void)page_of(report), nlohmann::json::exception);
}

}  // namespace
}  // namespace gatewalk::cli
