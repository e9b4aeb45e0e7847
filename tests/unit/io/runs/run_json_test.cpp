// SPDX-License-Identifier: Apache-2.0
// Records of views and runs go into JSON and come back; what 0.1 wrote is read.
#include "saccade/io/runs/run_json.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "saccade/io/files/file_io.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

using Json = nlohmann::json;
using test::TempFolder;

ViewRecord some_view() {
  ViewRecord view;
  view.region = 2;
  view.T_world_camera = look_at({0.3, -0.7, 0.9}, {0.01, 0.02, 0.03});
  view.q = Configuration{{0.1, -0.2, 1.0 / 3.0}};
  view.gain_predicted = 321.5;
  view.gain_observed = 300.25;
  view.measures = {0.625, 900, 90, 0.0012, std::nullopt, 0.9};
  view.reveals_object = true;
  view.candidates = 960;
  view.evaluated = 700;
  view.refused.add(Refusal::no_ik, 250);
  view.frames = 5;
  view.frames_on_way = 3;
  view.tilt = {-0.08, 0.04};
  view.motion_s = 2.25;
  view.retreat_s = 0.5;
  view.path_m = 1.5;
  view.times.add(Phase::gain, 20.25);
  view.attention = ViewAttention{40, 600, 12, 3, 0.52, "round and alone", 24};
  return view;
}

TEST(RunJson, AViewComesBackToTheLastBit) {
  const ViewRecord view = some_view();
  const Json written = Json::parse(view_to_json(view, 6).dump());
  EXPECT_EQ(written.at("index"), 6);
  EXPECT_EQ(written.at("ms").at("evaluation"), 20.25);
  const ViewRecord read = view_from_json(written).value();
  EXPECT_EQ(read.T_world_camera.matrix(), view.T_world_camera.matrix());
  EXPECT_EQ(*read.q, *view.q);
  EXPECT_EQ(read.attention, view.attention);
  EXPECT_EQ(read.times, view.times);
  EXPECT_EQ(read.gain_observed, view.gain_observed);
  EXPECT_EQ(view_to_json(read, 6), written);
  // Accuracy, Chamfer distance and F-score are written for the end of a run alone.
  EXPECT_EQ(read.measures.coverage, view.measures.coverage);
  EXPECT_EQ(read.measures.f_score, std::nullopt);
}

TEST(RunJson, WhatIsNotKnownIsNull) {
  const Json written = Json::parse(view_to_json(ViewRecord{}, 0).dump());
  for (const char* key :
       {"gain", "coverage", "unknown_near_objects", "points_at_object", "looks_at_object", "q", "attention"}) {
    EXPECT_TRUE(written.at(key).is_null()) << key;
  }
  const ViewRecord read = view_from_json(written).value();
  EXPECT_TRUE(std::isnan(read.gain_predicted));
  EXPECT_FALSE(read.q || read.reveals_object || read.attention || read.measures.coverage);
}

TEST(RunJson, AViewOfAnOlderVersionKeepsDefaults) {
  Json old = view_to_json(some_view(), 0);
  for (const char* key : {"tilt_rad", "frames_on_way", "retreat_s", "evaluated", "refused", "q", "attention", "ms"}) {
    old.erase(key);
  }
  const ViewRecord read = view_from_json(old).value();
  EXPECT_EQ(read.tilt, Tilt{});
  EXPECT_EQ(read.refused.total(), 0U);
  EXPECT_EQ(read.times, PhaseTimes{});
  EXPECT_EQ(read.candidates, 960U);
}

TEST(RunJson, DamageIsAnError) {
  const Json whole = view_to_json(some_view(), 0);
  for (const auto& [key, wrong] :
       std::initializer_list<std::pair<const char*, Json>>{{"region", "two"},
                                                           {"T_world_camera", {1, 2, 3}},
                                                           {"q", "straight"},
                                                           {"attention", {{"segments", -1}}},
                                                           {"gain", "much"},
                                                           {"refused", {{"no_ik", "all"}}}}) {
    Json damaged = whole;
    damaged[key] = wrong;
    const auto read = view_from_json(damaged);
    ASSERT_FALSE(read) << key;
    EXPECT_EQ(read.error().code, Errc::corrupt_data) << key;
  }
  EXPECT_FALSE(views_from_json(Json::array({whole, 3})));
  EXPECT_EQ(views_from_json(views_to_json({some_view(), some_view()}))->size(), 2U);
}

TEST(RunJson, AScanComesBack) {
  ScanRecord scan;
  scan.views = 3;
  scan.refused.add(Refusal::no_path, 2);
  scan.measures.coverage = 0.25;
  scan.measures.unknown_left = 77;
  const ScanRecord read = scan_from_json(scan_to_json(scan)).value();
  EXPECT_EQ(read.views, 3U);
  EXPECT_EQ(read.refused, scan.refused);
  EXPECT_EQ(read.measures, scan.measures);
  EXPECT_FALSE(scan_from_json({{"views", 3}}));
}

TEST(RunJson, PhasesAreSummedInSeconds) {
  EXPECT_TRUE(phases_to_json({}).empty());
  const Json phases = phases_to_json({some_view(), some_view()});
  EXPECT_DOUBLE_EQ(phases.at("evaluation").get<double>(), 0.0405);
  EXPECT_DOUBLE_EQ(phases.at("robot").get<double>(), 4.5);
  EXPECT_EQ(phases.size(), kPhaseNames.values.size() + 1);
}

TEST(ViewChoiceFile, ComesBackAndDamageIsNamed) {
  const TempFolder folder;
  ViewRecord view = some_view();
  view.path = {{0.0, 0.0, 1.0}, {0.5, 0.0, 1.0}};
  ViewChoice choice;
  choice.region = Sphere{{0.1, 0.2, 0.3}, 0.4};
  choice.candidates = {{look_at({0.5, 0.0, 0.5}, {0.0, 0.0, 0.0}), 17.0}, {view.T_world_camera}};
  choice.sensor = PinholeCamera{40, 30, 33.0, 33.5, 19.0, 14.0, 0.5, 2.0};
  choice.saliency = {0.5, 0.25};
  choice.segment = 1;
  view.choice = std::make_shared<const ViewChoice>(choice);
  ASSERT_TRUE(write_view_choice(folder.path(), 7, view).ok());
  EXPECT_TRUE(std::filesystem::exists(folder / "view-07.json"));
  const ViewRecord read = read_view_choice(folder.path(), 7).value();
  EXPECT_EQ(read.path, view.path);
  EXPECT_EQ(read.choice->sensor, choice.sensor);
  EXPECT_EQ(read.choice->saliency, choice.saliency);
  EXPECT_EQ(read.choice->segment, choice.segment);
  EXPECT_EQ(std::get<Sphere>(read.choice->region).radius_m, 0.4);
  ASSERT_EQ(read.choice->candidates.size(), 2U);
  EXPECT_EQ(read.choice->candidates[0].gain, 17.0);
  EXPECT_TRUE(std::isnan(read.choice->candidates[1].gain));
  EXPECT_EQ(read_view_choice(folder.path(), 8).error().code, Errc::not_found);
  Json damaged = Json::parse(*read_text_file(folder / "view-07.json"));
  damaged["gains"].push_back(3.0);
  folder.write("view-07.json", damaged.dump());
  EXPECT_EQ(read_view_choice(folder.path(), 7).error().code, Errc::corrupt_data);
  folder.write("view-05.json", R"({"schema": "saccade-view/1"})");
  EXPECT_EQ(read_view_choice(folder.path(), 5).error().code, Errc::corrupt_data);
  folder.write("view-06.json", R"({"schema": "saccade-view/9"})");
  EXPECT_EQ(read_view_choice(folder.path(), 6).error().code, Errc::unsupported);
}

}  // namespace
}  // namespace saccade
