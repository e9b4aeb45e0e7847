// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/plot.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "saccade/core/result.hpp"
#include "unit/report/well_formed.hpp"

namespace saccade {
namespace {

using test::count;

/// Every opening tag has its closing one, in order; no stray markup.
bool is_well_formed(const std::string& svg) {
  std::vector<std::string> open;
  for (std::size_t at = svg.find('<'); at != std::string::npos; at = svg.find('<', at + 1)) {
    const std::size_t end = svg.find('>', at);
    if (end == std::string::npos) return false;
    const std::string tag = svg.substr(at + 1, end - at - 1);
    if (tag.find('<') != std::string::npos || std::count(tag.begin(), tag.end(), '"') % 2 != 0) return false;
    const std::string name = tag.substr(0, tag.find_first_of(" /", 1));
    if (tag.front() == '/') {
      if (open.empty() || tag.substr(1) != open.back()) return false;
      open.pop_back();
    } else if (tag.back() != '/') {
      open.push_back(name);
    }
  }
  return open.empty();
}

Plot two_curves() {
  Plot plot{"Coverage", "views", "coverage, %", {}};
  plot.series.push_back({"sphere", {0, 1, 2, 3}, {40, 70, 85, 90}, {35, 66, 83, 89}, {45, 74, 87, 91}});
  plot.series.push_back({"random", {0, 1, 2, 3}, {40, 55, 60, 71}});
  return plot;
}

/// The numbers of the first path whose text contains `mark`.
std::vector<double> path_numbers(const std::string& svg, const std::string& mark) {
  std::size_t at = svg.find("<path d=\"");
  while (at != std::string::npos) {
    const std::size_t end = svg.find('>', at);
    if (svg.substr(at, end - at).find(mark) != std::string::npos) break;
    at = svg.find("<path d=\"", end);
  }
  std::vector<double> numbers;
  if (at == std::string::npos) return numbers;
  at += 9;
  std::string text = svg.substr(at, svg.find('"', at) - at);
  for (char& c : text) c = c == 'M' || c == 'L' || c == 'Z' ? ' ' : c;
  const char* cursor = text.c_str();
  char* end = nullptr;
  for (double value = std::strtod(cursor, &end); end != cursor; value = std::strtod(cursor, &end)) {
    numbers.push_back(value);
    cursor = end;
  }
  return numbers;
}

TEST(Plot, HasCurvesBandsTicksLabelsAndALegend) {
  const std::string svg = plot_svg(two_curves());
  EXPECT_TRUE(is_well_formed(svg)) << svg;
  EXPECT_TRUE(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\""));
  EXPECT_EQ(count(svg, "fill-opacity"), 1U);  // one series has a band
  EXPECT_EQ(count(svg, "fill=\"none\""), 2U);
  for (const char* part : {">Coverage</text>", ">views</text>", ">coverage, %</text>", ">sphere</text>",
                           ">random</text>", ">40</text>", ">90</text>", ">3</text>"})
    EXPECT_NE(svg.find(part), std::string::npos) << part;
  EXPECT_EQ(count(svg, " id="), 0U);
  EXPECT_EQ(svg, plot_svg(two_curves()));
}

TEST(Plot, CurvesLieWhereTheAxesSay) {
  Plot plot = two_curves();
  plot.x_range = {0.0, 3.0};
  plot.y_range = {0.0, 100.0};
  const std::string svg = plot_svg(plot);
  const std::vector<double> curve = path_numbers(svg, "fill=\"none\"");
  ASSERT_EQ(curve.size(), 8U);
  // Evenly spaced in x, and linear in y.
  const double step = curve[2] - curve[0];
  EXPECT_GT(step, 50.0);
  EXPECT_NEAR(curve[4] - curve[2], step, 0.02);
  EXPECT_NEAR(curve[6] - curve[4], step, 0.02);
  const double per_percent = (curve[1] - curve[3]) / 30.0;
  EXPECT_NEAR((curve[1] - curve[7]) / 50.0, per_percent, 0.001);
  const std::vector<double> band = path_numbers(svg, "fill-opacity");
  ASSERT_EQ(band.size(), 16U);
  EXPECT_NEAR(curve[1] - band[1], 5.0 * per_percent, 0.02);   // the high end of the first point
  EXPECT_NEAR(band[15] - curve[1], 5.0 * per_percent, 0.02);  // and its low end
}

TEST(Plot, WhatIsNotFiniteBreaksTheLineAndWhatIsBeyondIsCutOff) {
  Plot plot{"t", "x", "y", {}};
  const double nan = std::nan("");
  plot.series.push_back({"a", {0, 1, 2, 3, 4, 9}, {1, 2, nan, 500, 4, 1}, {0, nan, 0, 0, 0, 0}, {2, 3, 3, 600, 5, 1}});
  plot.x_range = {0.0, 4.0};
  plot.y_range = {0.0, 10.0};
  const std::string svg = plot_svg(plot);
  EXPECT_TRUE(is_well_formed(svg));
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  const std::vector<double> curve = path_numbers(svg, "fill=\"none\"");
  EXPECT_EQ(curve.size(), 8U);  // x = 9 is beyond, x = 2 has no y
  for (std::size_t i = 1; i < curve.size(); i += 2) EXPECT_TRUE(curve[i] >= 0.0 && curve[i] <= plot.height_px);
  EXPECT_EQ(count(svg, "Z"), 2U);  // a band of one point, and one of three
}

TEST(Plot, DrawsNothingOneAndMany) {
  EXPECT_TRUE(is_well_formed(plot_svg({"empty", "", "", {}})));
  Plot one{"one", "x", "y", {{"a", {5}, {0.3}}}};
  const std::string svg = plot_svg(one);
  EXPECT_TRUE(is_well_formed(svg));
  EXPECT_EQ(count(svg, "<circle"), 2U);  // on the curve and in the legend
  Plot many{"many", "x", "y", {}};
  for (int i = 0; i < 13; ++i)
    many.series.push_back({std::string(1, static_cast<char>(97 + i)), {0, 1}, {1.0 * i, 2.0 * i}});
  EXPECT_TRUE(is_well_formed(plot_svg(many)));
  for (const double scale : {1e-9, 1.0, 1e12}) {
    Plot scaled{"scaled", "x", "y", {{"a", {0, 1}, {0.11 * scale, 0.93 * scale}}}};
    EXPECT_GE(count(plot_svg(scaled), "text-anchor=\"end\""), 4U) << scale;
  }
}

TEST(Plot, TextIsEscapedAndContractsAreKept) {
  Plot plot = two_curves();
  plot.title = "<script>\"&'\x01\xff";
  plot.series[0].name = "Größe";
  const std::string svg = plot_svg(plot);
  EXPECT_TRUE(is_well_formed(svg));
  EXPECT_NE(svg.find("&lt;script&gt;&quot;&amp;&#39;\xEF\xBF\xBD\xEF\xBF\xBD"), std::string::npos);
  EXPECT_NE(svg.find("Größe"), std::string::npos);
  plot.series[0].low.pop_back();
  EXPECT_THROW(static_cast<void>(plot_svg(plot)), ContractViolation);
  plot = two_curves();
  plot.y_range = {1.0, 1.0};
  EXPECT_THROW(static_cast<void>(plot_svg(plot)), ContractViolation);
}

}  // namespace
}  // namespace saccade
