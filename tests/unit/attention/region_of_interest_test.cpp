// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/region_of_interest.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace saccade {
namespace {

TEST(RegionsOfInterest, AreSpheresAroundActions) {
  const std::vector<HandAction> actions{{{1.0, 2.0, 3.0}, 4.0, 5.0, "slow"}, {{0.0, 0.0, 0.0}, 6.0, 7.0, "round"}};
  const auto regions = regions_of_interest(actions).value();
  ASSERT_EQ(regions.size(), 2U);
  const auto& sphere = std::get<Sphere>(regions[0].bounds);
  EXPECT_EQ(sphere.center, actions[0].position_m);
  EXPECT_EQ(sphere.radius_m, 0.2);
  EXPECT_EQ(regions[0].saliency, 5.0);
  EXPECT_EQ(regions[1].why, "round");
  EXPECT_EQ(regions[0].origin, AttentionOrigin::hand_action);
  EXPECT_TRUE(regions_of_interest({}).value().empty());
}

TEST(RegionsOfInterest, BadRadiiAndPositionsAreRefused) {
  std::vector<HandAction> actions{{{1.0, 2.0, 3.0}, 4.0, 5.0, {}}};
  EXPECT_FALSE(regions_of_interest(actions, 0.0));
  actions[0].position_m.y() = std::nan("");
  EXPECT_FALSE(regions_of_interest(actions));
}

}  // namespace
}  // namespace saccade
