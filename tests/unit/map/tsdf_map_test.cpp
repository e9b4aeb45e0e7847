// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/tsdf_map.hpp"

#include <gtest/gtest.h>

#include <array>

namespace saccade {
namespace {

TEST(TsdfMap, RefusesFramesThatSeeTooManyVoxels) {
  struct Case {
    double focal_px;
    float depth_m;
  };
  constexpr std::array<Case, 4> kCases{{{1e-6, 1.0F}, {1e-30, 1.0F}, {10.0, 1e6F}, {10.0, 1e37F}}};
  TsdfMap map = TsdfMap::create({}).value();
  for (const auto& [focal_px, depth_m] : kCases) {
    const PinholeCamera camera{8, 6, focal_px, focal_px, 3.5, 2.5, 0.1, 1e38};
    const auto refused = map.integrate(camera, DepthImage{8, 6, depth_m}, Pose::Identity(), {});
    ASSERT_FALSE(refused.ok()) << focal_px << " " << depth_m;
    EXPECT_EQ(refused.error().code, Errc::invalid_argument);
    EXPECT_TRUE(map.content().grid.empty());
  }
  const PinholeCamera camera{8, 6, 10.0, 10.0, 3.5, 2.5, 0.1, 6.0};
  EXPECT_TRUE(map.integrate(camera, DepthImage{8, 6, 1.0F}, Pose::Identity(), {}).ok());
  EXPECT_FALSE(map.content().grid.empty());
}

}  // namespace
}  // namespace saccade
