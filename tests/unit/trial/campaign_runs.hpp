// SPDX-License-Identifier: Apache-2.0
#pragma once
// Made-up runs of campaigns, and whether two are equal.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "saccade/trial/campaign.hpp"

namespace saccade::test {

inline CampaignKey key_of(std::uint64_t seed, const std::string& strategy = "sphere") {
  return {"jug", "00ff00ff00ff00ff", strategy, "kinect-v1", seed, R"({"max_views":3,"voxel_size_m":0.01})"};
}

inline const std::array<double, kPhaseNames.values.size()> kTimes_ms{0.5, 0.1, 3.0, 4.0, 1.25, 20.25, 2.0, 0.0, 7.0};

inline PhaseTimes times_of(const std::array<double, kPhaseNames.values.size()>& ms) {
  PhaseTimes times;
  for (std::size_t i = 0; i < ms.size(); ++i) times.add(kPhaseNames.values[i], ms[i]);
  return times;
}

inline CampaignEntry run_of(const CampaignKey& key, std::size_t views = 2) {
  CampaignEntry entry{key, {}, 1.5, "0.1.0", {}};
  RunRecord& run = entry.run;
  run.scan.measures = {0.25, 1000, 100, std::nullopt, std::nullopt, std::nullopt};
  for (std::size_t i = 0; i < views; ++i) {
    ViewRecord view;
    view.region = i;
    if (i != 1) view.gain_predicted = 321.5;
    if (i != 1) view.gain_observed = 300.25;
    view.T_world_camera =
        Pose{Eigen::Translation3d{0.1, 0.2, 0.3 + 1.0 / 3.0} * Eigen::AngleAxisd{0.7, Eigen::Vector3d::UnitX()}};
    view.candidates = 960;
    view.frames = 5;
    view.measures = {0.5 + 0.1 * static_cast<double>(i) + 0.001 * static_cast<double>(key.seed),
                     900 - i,
                     90 - i,
                     0.0012,
                     0.0034,
                     0.9};
    view.reveals_object = i % 2 == 0;
    view.looks_at_object = false;
    view.evaluated = 700;
    view.refused.add(Refusal::no_ik, 250);
    view.refused.add(Refusal::no_path, 10 + i);
    view.path_m = 1.5;
    view.motion_s = 2.25;
    view.times = times_of(kTimes_ms);
    run.views.push_back(view);
  }
  run.scan.views = 2;
  run.scan.refused.add(Refusal::declined);
  run.stopped_because = StopReason::views_used_up;
  run.refused_at_end.add(Refusal::outside_limits, 3);
  return entry;
}

inline void expect_same(const CampaignEntry& stored, const CampaignEntry& expected) {
  EXPECT_EQ(stored.key, expected.key);
  EXPECT_EQ(stored.seconds, expected.seconds);
  EXPECT_EQ(stored.program_version, expected.program_version);
  const RunRecord& a = stored.run;
  const RunRecord& b = expected.run;
  EXPECT_EQ(a.scan.measures, b.scan.measures);
  EXPECT_EQ(a.final(), b.final());
  EXPECT_EQ(a.scan.views, b.scan.views);
  EXPECT_EQ(a.scan.refused, b.scan.refused);
  EXPECT_EQ(a.stopped_because, b.stopped_because);
  EXPECT_EQ(a.refused_at_end, b.refused_at_end);
  ASSERT_EQ(a.views.size(), b.views.size());
  for (std::size_t i = 0; i < a.views.size(); ++i) {
    EXPECT_EQ(a.views[i].region, b.views[i].region);
    EXPECT_EQ(std::isnan(a.views[i].gain_predicted), i == 1);
    if (i != 1) {
      EXPECT_EQ(a.views[i].gain_predicted, b.views[i].gain_predicted);
      EXPECT_EQ(a.views[i].gain_observed, b.views[i].gain_observed);
    }
    EXPECT_LT((a.views[i].T_world_camera.matrix() - b.views[i].T_world_camera.matrix()).norm(), 1e-15);
    EXPECT_EQ(a.views[i].candidates, b.views[i].candidates);
    EXPECT_EQ(a.views[i].frames, b.views[i].frames);
    EXPECT_EQ(a.views[i].measures, b.views[i].measures);
    EXPECT_EQ(a.views[i].reveals_object, b.views[i].reveals_object);
    EXPECT_EQ(a.views[i].looks_at_object, b.views[i].looks_at_object);
    EXPECT_EQ(a.views[i].evaluated, b.views[i].evaluated);
    EXPECT_EQ(a.views[i].refused, b.views[i].refused);
    EXPECT_EQ(a.views[i].path_m, b.views[i].path_m);
    EXPECT_EQ(a.views[i].motion_s, b.views[i].motion_s);
    EXPECT_EQ(a.views[i].times, b.views[i].times);
  }
}

}  // namespace saccade::test
