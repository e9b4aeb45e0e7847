// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/run_report.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "saccade/report/html_text.hpp"
#include "unit/report/png_header.hpp"
#include "unit/report/shown_view.hpp"
#include "unit/report/well_formed.hpp"

namespace saccade {
namespace {

using test::count;
using test::Markup;
using test::png_header;
using test::shown_view;
using test::well_formed;

RunReport example() {
  RunReport report;
  report.title = "Exploration of tabletop-2";
  report.scene = "tabletop-2";
  report.strategy = "sphere";
  report.robot = "free";
  report.noise = "Kinect v1";
  report.seed = 4711;
  report.threads = 3;
  report.version = "9.8.7";
  report.facts = {{"voxel size", "5.8 mm"}, {"camera", "640×480"}};
  report.min_gain = 30.0;
  report.stop_reason = "views_used_up";
  report.initial = {{0.709, 273794, 12134},
                    {{png_header(720, 540), "after the scan", "the map", "map"}},
                    {{"poses passed over", "1 out of reach"}}};
  report.views = {
      shown_view(1, 5581.0, 960, {0.932, 162586, 4606}, false, {{Phase::gain, 931.0}, {Phase::fusion, 357.0}}),
      shown_view(2, 1590.5, 959, {0.941, 132342, 3132}, true, {{Phase::gain, 877.0}, {Phase::fusion, 371.0}})};
  report.views[0].pictures = {{png_header(720, 592), "the choice", "candidates", "choice"},
                              {png_header(972, 412), "the sight", "colour and depth", "seen"}};
  report.final = {0.941, 132342, 3132, 0.00143, 0.00163, 0.938};
  report.links = {{"mesh.ply", "the surface"}, {"map.sacmap", "the map"}};
  return report;
}

/// A robot's run: nobody knows the truth.
RunReport without_truth() {
  RunReport report = example();
  report.initial.measures.coverage.reset();
  report.initial.measures.unknown_near_objects.reset();
  for (ShownView& view : report.views) test::without_truth(view);
  report.final = {{}, 132342, {}, {}, {}, {}};
  return report;
}

bool has(const std::string& page, const std::string& text) { return page.find(text) != std::string::npos; }

TEST(WellFormed, RefusesWhatAnXmlParserRefuses) {
  EXPECT_EQ(well_formed("<!DOCTYPE html>\n<p class=\"a\">x &amp; y<br/></p>\n").problem, "");
  EXPECT_EQ(well_formed("<p>a</p>").elements, 1U);
  for (const char* bad : {"<p>", "<p></q>", "<p>a & b</p>", "<p a=b></p>", "<p a=\"1\" a=\"2\"></p>", "<p a=\"<\"></p>",
                          "</p>", "<p><b></p></b>", "<p id=\"a\"><b id=\"a\"></b></p>", "a<p></p>", "<p>&nbsp;</p>"}) {
    EXPECT_NE(well_formed(bad).problem, "") << bad;
  }
}

TEST(RunReport, IsWellFormedAndSelfContained) {
  for (const RunReport& report : {example(), without_truth(), RunReport{}}) {
    const std::string page = run_report_html(report);
    const Markup markup = well_formed(page);
    EXPECT_EQ(markup.problem, "");
    EXPECT_GT(markup.elements, 15U);
    for (const std::string& reference : markup.references) {
      const bool inside = reference.starts_with("data:image/png;base64,") ||
                          (reference.starts_with("#") && markup.ids.contains(reference.substr(1)));
      const bool beside = reference == "mesh.ply" || reference == "map.sacmap";
      EXPECT_TRUE(inside || beside) << reference;
    }
    EXPECT_EQ(count(page, "http"), 2U) << "the name space and http-equiv, nothing to load";
    EXPECT_FALSE(has(page, "url(") || has(page, "@import"));
  }
}

TEST(RunReport, SaysEveryFigure) {
  const std::string page = run_report_html(example());
  for (const std::string& text : {std::string{"Exploration of tabletop-2"},
                                  std::string{"poses passed over"},
                                  std::string{"sphere"},
                                  std::string{"Kinect v1"},
                                  std::string{"4711"},
                                  std::string{"9.8.7"},
                                  std::string{"voxel size"},
                                  std::string{"5.8 mm"},
                                  std::string{"640×480"},
                                  std::string{"70.9 %"},
                                  std::string{"93.2 %"},
                                  std::string{"94.1 %"},
                                  grouped(273794),
                                  grouped(12134),
                                  grouped(5581),
                                  std::string{"590.50"},
                                  std::string{"960"},
                                  std::string{"959"},
                                  grouped(162586),
                                  grouped(132342),
                                  grouped(4606),
                                  grouped(3132),
                                  std::string{"+22.3 points"},
                                  number_text(162586.0 - 273794.0, 0),
                                  duration_text(931.0),
                                  duration_text(1288.0),
                                  duration_text(1248.0),
                                  std::string{"1.43 mm"},
                                  std::string{"1.63 mm"},
                                  std::string{"0.938"},
                                  std::string{"at the number of views it was given"},
                                  std::string{"after the scan"},
                                  std::string{"the choice"},
                                  std::string{"the sight"},
                                  std::string{"mesh.ply"},
                                  std::string{"the surface"}}) {
    EXPECT_TRUE(has(page, text)) << text;
  }
  EXPECT_EQ(count(page, "<svg"), 4U);
  EXPECT_EQ(count(page, "<img"), 3U);
  EXPECT_EQ(count(page, "<figure class=\"wide\">"), 1U) << "colour beside depth";
  EXPECT_TRUE(has(page, base64(png_header(972, 412))));
  EXPECT_TRUE(has(page, "width=\"972\" height=\"412\" alt=\"colour and depth\""));
  EXPECT_EQ(page, run_report_html(example()));
}

TEST(RunReport, WithoutTruthSaysNothingOfIt) {
  const std::string page = run_report_html(without_truth());
  for (const char* text : {"overage", "near objects", "points at an object", "F-score", "Chamfer", "accuracy", "NaN"}) {
    EXPECT_FALSE(has(page, text)) << text;
  }
  EXPECT_EQ(count(page, "<svg"), 3U);
  EXPECT_TRUE(has(page, grouped(132342)));
}

TEST(RunReport, ViewsWithoutGainHaveNoGain) {
  RunReport report = example();
  for (ShownView& view : report.views) view.record.gain_predicted = std::nan("");
  report.min_gain.reset();
  const std::string page = run_report_html(report);
  EXPECT_EQ(count(page, "<svg"), 3U);
  EXPECT_FALSE(has(page, "gain, rays"));
  report.views[1].record.gain_predicted = 12.0;
  EXPECT_TRUE(has(run_report_html(report), "gain, rays"));
}

TEST(RunReport, NoViewIsARunToo) {
  RunReport report = example();
  report.views.clear();
  report.stop_reason = "regions_done";
  const std::string page = run_report_html(report);
  EXPECT_EQ(well_formed(page).problem, "");
  EXPECT_TRUE(has(page, "No view after the initial scan"));
  EXPECT_TRUE(has(page, "no view gains enough"));
  EXPECT_FALSE(has(page, "<svg") || has(page, "<table"));
}

TEST(RunReport, EscapesAllText) {
  const std::string evil = "</style><script>alert('1')</script>\"&\x01\xFF";
  RunReport report = example();
  for (std::string* text : {&report.title, &report.scene, &report.strategy, &report.robot, &report.noise,
                            &report.version, &report.gain_unit, &report.stop_reason}) {
    *text = evil;
  }
  report.facts = {{evil, evil}};
  report.links = {{evil, evil}};
  report.views[0].facts = {{evil, evil}};
  for (ReportPicture& picture : report.views[0].pictures) picture.caption = picture.alt = picture.kind = evil;
  const std::string page = run_report_html(report);
  EXPECT_EQ(well_formed(page).problem, "");
  EXPECT_EQ(count(page, "<script>"), 1U);
  EXPECT_GT(count(page, html_escaped(evil)), 15U);
}

TEST(RunReport, OddNumbersDoNotBreakThePage) {
  RunReport report = example();
  const double infinite = std::numeric_limits<double>::infinity();
  report.views[0].record.gain_predicted = std::nan("");
  report.views[1].record.gain_predicted = infinite;
  report.views[0].record.measures.coverage = std::nan("");
  report.views[0].record.times.add(Phase::gain, std::nan(""));
  report.views[0].record.times.add(Phase::planning, -1.0);
  report.views[0].record.times.add(Phase::motion, infinite);
  report.min_gain = infinite;
  report.final.chamfer_m = std::nan("");
  const std::string page = run_report_html(report);
  EXPECT_EQ(well_formed(page).problem, "");
  for (const char* text : {"nan", "inf\"", "\"inf", "-nan"}) EXPECT_FALSE(has(page, text)) << text;
}

TEST(RunReport, PicturesThatAreNoneAreLeftOut) {
  RunReport report = example();
  report.views[0].pictures[0].png.resize(10);
  report.views[0].pictures[1].png[1] = std::byte{'J'};
  const std::string page = run_report_html(report);
  EXPECT_EQ(count(page, "<img"), 1U);
  EXPECT_FALSE(has(page, "the choice"));
}

TEST(RunReport, IsLittleMoreThanItsPictures) {
  RunReport report = example();
  constexpr std::size_t kPictureBytes{100000};
  constexpr std::size_t kViews{12};
  const ShownView view = report.views[1];
  report.views.assign(kViews, view);
  for (std::size_t i = 0; i < kViews; ++i) {
    report.views[i].number = i + 1;
    report.views[i].pictures.assign(3, {png_header(720, 540, kPictureBytes), "caption", "alt", "kind"});
  }
  const std::string page = run_report_html(report);
  EXPECT_EQ(well_formed(page).problem, "");
  EXPECT_GT(page.size(), 36 * kPictureBytes * 4 / 3);
  EXPECT_LT(page.size(), 36 * kPictureBytes * 4 / 3 + 64000);
}

}  // namespace
}  // namespace saccade
