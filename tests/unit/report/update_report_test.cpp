// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/update_report.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "saccade/report/html_text.hpp"
#include "unit/report/png_header.hpp"
#include "unit/report/shown_view.hpp"
#include "unit/report/well_formed.hpp"

namespace saccade {
namespace {

using test::count;
using test::Markup;
using test::well_formed;

/// Two regions and three views.
UpdateReport jug_update() {
  UpdateReport report;
  report.title = "Update of jug-before";
  report.scene = "jug-before to jug";
  report.hand = "simulated, seed 5";
  report.method = "dips";
  report.fuse_when = "at views";
  report.robot = "comau";
  report.draws_robot = true;
  report.noise = "Kinect v1";
  report.seed = 4712;
  report.threads = 3;
  report.version = "9.8.7";
  report.facts = {{"voxel size", "5.8 mm"}};
  report.min_gain = 200.0;
  report.before = {
      {0.981, 171547, 2077}, {{test::png_header(720, 540), "as it was", "the map", "map"}}, {{"poses", "8"}}};
  report.task_pictures = {{test::png_header(720, 594), "the hand's way", "hand", "task"},
                          {test::png_header(720, 540), "forgotten", "regions", "task"}};
  report.task_facts = {{"samples", "409"}};
  report.speed_svg = "<svg xmlns=\"http://www.w3.org/2000/svg\"><title>speed</title></svg>";
  report.regions = {
      {1, "slowed at the pallet", {-0.35, 0.09, 0.22}, 0.2, "complete", {171770, 1044, 1040, 985}, 0.971, 0.902},
      {2, "slowed at the disc", {0.35, -0.03, 0.2}, 0.2, "out of reach", {171697, 171690, 16755, 8408}, 0.703, {}}};
  report.once_ms = {{"clearing", 0.9}};
  const auto times = [](double planning_ms, double fusion_ms) {
    return std::vector{std::pair{Phase::planning, planning_ms}, std::pair{Phase::fusion, fusion_ms}};
  };
  report.views = {test::shown_view(1, 3719.0, 960, {0.71, 340148, 28473}, true, times(2.0, 200.0)),
                  test::shown_view(2, 3720.0, 959, {0.891, 185079, 9795}, true, times(4.0, 220.0)),
                  test::shown_view(3, 781.0, 958, {0.936, 176380, 5552}, true, times(6.0, 240.0))};
  for (std::size_t i = 0; i < 3; ++i) report.views[i].region = i == 0 ? 1 : 2;
  report.views[0].pictures = {{test::png_header(720, 592), "the choice", "candidates", "choice"}};
  report.unknown_after_task = 511063;
  report.coverage_after_task = 0.658;
  report.after_pictures = {{test::png_header(720, 540), "as it is", "the map", "map"}};
  report.final = {0.936, 176380, 5552, 0.00046, 0.00078, 0.975};
  report.objects = {{"jug", {{"height", 0.19, 0.1911}, {"major axis", 0.17, 0.1678}, {"minor axis", {}, 0.131}}}};
  report.links = {{"mesh.ply", "the surface"}};
  return report;
}

bool says(const std::string& page, const std::string& text) { return page.find(text) != std::string::npos; }

TEST(UpdateReport, IsWellFormedAndSelfContained) {
  for (const UpdateReport& report : {jug_update(), UpdateReport{}}) {
    const std::string page = update_report_html(report);
    const Markup markup = well_formed(page);
    EXPECT_EQ(markup.problem, "");
    EXPECT_GT(markup.elements, 15U);
    for (const std::string& reference : markup.references) {
      const bool inside = reference.starts_with("data:image/png;base64,") ||
                          (reference.starts_with("#") && markup.ids.contains(reference.substr(1)));
      EXPECT_TRUE(inside || reference == "mesh.ply") << reference;
    }
    for (const char* id : {"summary", "before", "task", "during", "after", "run"}) {
      EXPECT_TRUE(markup.ids.contains(id)) << id;
    }
    EXPECT_FALSE(says(page, "url(") || says(page, "@import"));
  }
}

TEST(UpdateReport, SaysEveryFigure) {
  const std::string page = update_report_html(jug_update());
  for (const std::string& text :
       {std::string{"Update of jug-before"},
        std::string{"jug-before to jug"},
        std::string{"simulated, seed 5"},
        std::string{"at views"},
        std::string{"4712"},
        std::string{"9.8.7"},
        std::string{"voxel size"},
        std::string{"The hand acted at 2 places"},
        std::string{"took 3 views"},
        std::string{"1 of 2 regions is complete"},
        std::string{"98.1 %"},
        std::string{"65.8 % after the task"},
        std::string{"93.6 %"},
        grouped(171547),
        std::string{"(−0.35, 0.09, 0.22) m"},
        std::string{"slowed at the disc"},
        std::string{"out of reach"},
        grouped(171770),
        grouped(985),
        std::string{"97.1 %"},
        std::string{"90.2 %"},
        grouped(16755) + " (" + number_text(16755.0 - 171690.0, 0) + ")",
        grouped(340148) + " (" + number_text(340148.0 - 511063.0, 0) + ")",
        std::string{"+5.2 points"},
        "<td>clearing</td><td>–</td><td>" + duration_text(0.9) + "</td>",
        "<td>motion planning</td><td>" + duration_text(4.0) + "</td><td>" + duration_text(12.0),
        std::string{"<td>jug</td><td>height</td><td>190.0</td><td>191.1</td><td>+1.1</td>"},
        std::string{"<td>minor axis</td><td>–</td><td>131.0</td><td>–</td>"},
        std::string{"1.6 mm"},  // mean of 1.1 and 2.2
        std::string{"<title>speed</title>"},
        std::string{"Unknown voxels in the regions"},
        std::string{"region 2"},
        std::string{"the hand's way"},
        std::string{"mesh.ply"}}) {
    EXPECT_TRUE(says(page, text) || says(page, html_escaped(text))) << text;
  }
  EXPECT_EQ(count(page, "<img"), 5U);
  EXPECT_EQ(count(page, "<svg"), 3U) << "speed, unknown voxels, time";
  EXPECT_EQ(page, update_report_html(jug_update()));
}

TEST(UpdateReport, LeavesOutWhatIsNotKnown) {
  UpdateReport report = jug_update();
  report.speed_svg.clear();
  report.objects.clear();
  report.min_gain.reset();
  report.coverage_after_task.reset();
  report.before.measures.coverage.reset();
  report.before.measures.unknown_near_objects.reset();
  report.final = {{}, 176380, {}, {}, {}, {}};
  for (ReportRegion& region : report.regions) region.coverage_objects.reset(), region.coverage_surfaces.reset();
  for (ShownView& view : report.views) test::without_truth(view);
  const std::string page = update_report_html(report);
  EXPECT_EQ(well_formed(page).problem, "");
  for (const char* text :
       {"overage", "covered", "near objects", "Chamfer", "F-score", "error", "Objects of the task"}) {
    EXPECT_FALSE(says(page, text)) << text;
  }
  EXPECT_EQ(count(page, "<svg"), 2U);
  report.regions.clear();
  report.views.clear();
  const std::string idle = update_report_html(report);
  EXPECT_TRUE(says(idle, "The hand did nothing that the robot would look at again."));
  EXPECT_FALSE(says(idle, "<svg"));
  EXPECT_EQ(well_formed(idle).problem, "");
}

TEST(UpdateReport, OneRegionHasASentenceOfItsOwn) {
  UpdateReport report = jug_update();
  report.regions.resize(1);
  EXPECT_TRUE(says(update_report_html(report), "the region is complete."));
  report.regions[0].end = "out of reach";
  report.views.resize(1);
  const std::string page = update_report_html(report);
  EXPECT_TRUE(says(page, "took one view to look there again; the region ended: out of reach."));
  report.regions = jug_update().regions;
  report.regions[1].end = "complete";
  EXPECT_TRUE(says(update_report_html(report), "all regions are complete."));
}

TEST(UpdateReport, EscapesAllText) {
  const std::string evil = "</style><script>alert('1')</script>\"&\x01\xFF";
  UpdateReport report = jug_update();
  for (std::string* text : {&report.title, &report.scene, &report.hand, &report.method, &report.fuse_when,
                            &report.robot, &report.noise, &report.version, &report.gain_unit}) {
    *text = evil;
  }
  report.facts = report.task_facts = report.before.facts = {{evil, evil}};
  report.links = {{evil, evil}};
  report.regions[0].why = report.regions[0].end = evil;
  report.objects = {{evil, {{evil, 0.1, 0.1}}}};
  report.once_ms = {{evil, 1.0}};
  report.views[0].facts = {{evil, evil}};
  for (ReportPicture& picture : report.task_pictures) picture.caption = picture.alt = picture.kind = evil;
  const std::string page = update_report_html(report);
  EXPECT_EQ(well_formed(page).problem, "");
  EXPECT_EQ(count(page, "<script>"), 1U);
  EXPECT_GT(count(page, html_escaped(evil)), 25U);
}

TEST(UpdateReport, OddNumbersDoNotBreakThePage) {
  UpdateReport report = jug_update();
  report.regions[0].center_m = {std::nan(""), HUGE_VAL, 0.0};
  report.regions[1].unknown = {5};  // fewer than views
  report.views[1].region = 17;      // which is none
  report.objects[0].measures[0].measured_m = std::nan("");
  report.once_ms[0].second = HUGE_VAL;
  const std::string page = update_report_html(report);
  EXPECT_EQ(well_formed(page).problem, "");
  for (const char* text : {">nan", "inf\"", "\"inf", "-nan"}) EXPECT_FALSE(says(page, text)) << text;
}

}  // namespace
}  // namespace saccade
