// SPDX-License-Identifier: Apache-2.0
// RayGain with a device ranks views as it does without: the same views, gains and order, whatever was attempted; also
// where the device fails.
#include <gtest/gtest.h>

#include "failing_compute.hpp"
#include "saccade/cuda/internal/gpu_map_impl.hpp"
#include "saccade/views/gain.hpp"
#include "support/random_run.hpp"

namespace saccade {
namespace {

void expect_same(const RankedViews& views, const RankedViews& expected) {
  EXPECT_EQ(views.complete, expected.complete);
  EXPECT_EQ(views.evaluated, expected.evaluated);
  ASSERT_EQ(views.views.size(), expected.views.size());
  for (std::size_t i = 0; i < views.views.size(); ++i) {
    EXPECT_EQ(views.views[i].T_world_camera.matrix(), expected.views[i].T_world_camera.matrix()) << i;
    EXPECT_EQ(views.views[i].gain, expected.views[i].gain) << i;
  }
}

TEST(GpuGainOrder, IsThatOfTheCpu) {
  int scoring{0};
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    test::RandomRun run = test::RandomRun::with_clearing(seed);
    TsdfMap map = TsdfMap::create(run.config()).value();
    for (int frame = 0; frame < 3; ++frame) {
      ASSERT_TRUE(map.integrate(run.camera(), run.depth(), run.pose(), {}).ok());
    }
    RegionOfInterest region;
    do region.bounds = run.region();
    while (std::holds_alternative<Cylinder>(region.bounds));
    std::vector<Pose> poses;
    for (int i = 0; i < 12; ++i) poses.push_back(run.pose());
    poses.push_back(poses.front());  // a tie
    GainConfig config;
    config.sensor = run.camera();
    const auto faults = std::make_shared<test::Faults>();
    faults->times = 0;
    GpuMap gpu = internal::cuda::GpuMapMaker::make(run.config(), std::make_unique<test::FailingCompute>(faults));
    const Executor executor;
    PlanningContext context{map.content(), executor};
    context.attempted = [&](const Pose& pose) { return pose.matrix() == poses[3].matrix(); };
    for (const std::size_t count : {std::size_t{1}, std::size_t{4}, poses.size()}) {
      for (const Trust trust : {Trust::blind, Trust::credible}) {
        context.device = nullptr;
        const RankedViews expected = RayGain{config, trust}.best(context, region, poses, count).value();
        context.device = &gpu;
        expect_same(RayGain{config, trust}.best(context, region, poses, count).value(), expected);
        scoring += !expected.views.empty() && expected.views.front().gain > 0.0 ? 1 : 0;
      }
    }
    EXPECT_GT(gpu.traffic().kernels, 6U);
    EXPECT_FALSE(gpu.take_problem());
    faults->lost = true;
    context.device = nullptr;
    const RankedViews expected = RayGain{config, Trust::blind}.best(context, region, poses, 2).value();
    context.device = &gpu;
    expect_same(RayGain{config, Trust::blind}.best(context, region, poses, 2).value(), expected);
    EXPECT_TRUE(gpu.take_problem());
  }
  EXPECT_GE(scoring, 6);
}

}  // namespace
}  // namespace saccade
