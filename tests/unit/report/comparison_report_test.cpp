// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/comparison_report.hpp"

#include <gtest/gtest.h>

#include "well_formed.hpp"

namespace saccade {
namespace {

ComparisonReport small_report() {
  ComparisonSection section;
  section.title = "a <jug> & more";
  section.facts = {"sphere: 3 of 3 runs stopped for views used up"};
  Plot plot;
  plot.title = "Coverage: a <jug>";
  plot.series.push_back({"sphere", {0, 1}, {50, 90}, {40, 85}, {60, 95}});
  section.plots = {plot, plot};
  section.columns = {"sphere", "random"};
  section.rows = {{"coverage, %", {"90.1 ± 0.5", "80.0"}}};
  section.shares = {{"sphere", {"100 %", "50 %"}}, {"random", {"0 %", ""}}};
  section.marks = {{"sphere", "seed 1", {true, false}}, {"random", "seed 1", {false}}};
  section.phases = {"candidates", "evaluation", "fusion"};
  section.times = {{"sphere", {0.0, 750.0, 250.0}}, {"random", {0.0, 0.0, 250.0}}};
  ComparisonReport report;
  report.title = "Strategies compared";
  report.version = "1.2.3";
  report.settings = {{"strategies", "sphere, random"}, {"robot", ""}};
  report.verdict = "6 runs.";
  report.sections = {section};
  report.facts = {{"seeds", "3"}};
  report.links = {{"runs.csv", "a row per run"}};
  return report;
}

TEST(ComparisonReport, IsOneWellFormedPage) {
  const std::string page = comparison_report_html(small_report());
  EXPECT_EQ(test::well_formed(page).problem, "");
  for (const char* part : {"Strategies compared", "a &lt;jug&gt; &amp; more", "90.1 ± 0.5", "100 %", "sphere, seed 1",
                           "✓", "×", "href=\"runs.csv\"", "Written by Saccade 1.2.3", "views used up"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(page.find("robot"), std::string::npos);  // it has no value
  for (const std::string& reference : test::well_formed(page).references) {
    EXPECT_TRUE(reference == "runs.csv" || reference.starts_with('#')) << reference;
  }
}

TEST(ComparisonReport, BarsAreSharesOfTheLongest) {
  const std::string page = comparison_report_html(small_report());
  EXPECT_NE(page.find("width:75.0%\" title=\"evaluation: 750"), std::string::npos);
  EXPECT_NE(page.find("width:25.0%\" title=\"fusion: 250"), std::string::npos);
  EXPECT_EQ(page.find("candidates"), std::string::npos);  // no time was spent on it
}

TEST(ComparisonReport, NothingIsDrawnOfNothing) {
  ComparisonReport report;
  report.sections.emplace_back();
  const std::string page = comparison_report_html(report);
  EXPECT_EQ(test::well_formed(page).problem, "");
  EXPECT_EQ(page.find("<svg"), std::string::npos);
  EXPECT_EQ(page.find("Time per phase"), std::string::npos);
}

}  // namespace
}  // namespace saccade
