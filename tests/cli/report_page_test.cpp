#include "cli/paper/page.h"
#include "cli/render/json.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace gatewalk::cli {
namespace {

Json sample() {
  std::ifstream in(std::filesystem::path(__FILE__).parent_path() / "report_sample.json");
  return Json::parse(in);
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++n;
  return n;
}

TEST(ReportPage, HoldsEveryClaimAndSection) {
  const Json report = sample();
  const std::string page = report_page(report);
  for (const Json& claim : report.at("claims")) {
    EXPECT_EQ(count(page, "id=\"claim-" + claim.at("id").get<std::string>() + "\""), 1u);
  }
  for (const Json& s : report.at("sections")) {
    EXPECT_EQ(count(page, "<section id=\"" + s.at("id").get<std::string>() + "\">"), 1u);
  }
  EXPECT_EQ(count(page.substr(0, page.find("<script")), "{{"), 0u)
      << "a place of the template left open";
}

// Text of a report is text: it can neither become markup nor end the script that holds the data.
TEST(ReportPage, TextStaysText) {
  Json report = sample();
  const std::string plain = report_page(report);
  report["title"] = "<i>title</i>";
  report["sections"][0]["data"]["film"]["title"] = "</script><i>title</i><!--";
  report["sections"][0]["alt"] = "\"><i>title</i>";
  const std::string page = report_page(report);
  EXPECT_EQ(count(page, "<i>title"), 0u);
  EXPECT_EQ(count(page, "</script"), count(plain, "</script"));
}

// An error rather than an empty place on the page.
TEST(ReportPage, RefusesWhatItDoesNotKnow) {
  Json report = sample();
  report["sections"][0]["chart"] = "pie";
  EXPECT_THROW((void)report_page(report), std::invalid_argument);
  report = sample();
  report["claims"][0]["verdict"] = "splendid";
  EXPECT_THROW((void)report_page(report), std::invalid_argument);
  report = sample();
  report["claims"][0]["see"] = "nowhere";
  EXPECT_THROW((void)report_page(report), std::invalid_argument);
  report = sample();
  report["sections"][1]["id"] = report["sections"][0]["id"];
  EXPECT_THROW((void)report_page(report), std::invalid_argument);
  report = sample();
  report["claims"][0].erase("paper");
  EXPECT_THROW((void)report_page(report), nlohmann::json::exception);
}

}  // namespace
}  // namespace gatewalk::cli
