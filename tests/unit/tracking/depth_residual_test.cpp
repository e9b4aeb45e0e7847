// SPDX-License-Identifier: Apache-2.0
#include "saccade/tracking/trajectory_error.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace saccade {
namespace {

DepthImage row(std::vector<float> depths) {
  const int width = static_cast<int>(depths.size());
  return {width, 1, std::move(depths)};
}

TEST(DepthResidual, MedianAndShareOverSeveralImages) {
  DepthResidual residual;
  constexpr float kNaN{std::numeric_limits<float>::quiet_NaN()};
  ASSERT_TRUE(residual.add(row({1.0F, 1.0F, 1.0F, 0.0F, kNaN, -2.0F}), row({1.001F, 0.998F, 0.0F, 1.0F, 1.0F, 2.0F})));
  ASSERT_TRUE(residual.add(row({2.0F}), row({2.5F})));
  EXPECT_EQ(residual.valid(), 4U);
  EXPECT_EQ(residual.taking_part(), 3U);
  EXPECT_DOUBLE_EQ(residual.share(), 0.75);
  EXPECT_NEAR(residual.median_m(), 0.002, DepthResidual::kStep_m);
}

TEST(DepthResidual, LargeResidualsAreCut) {
  DepthResidual residual;
  ASSERT_TRUE(residual.add(row({1.0F}), row({5.0F})));
  EXPECT_NEAR(residual.median_m(), DepthResidual::kLargest_m, 1e-12);
}

TEST(DepthResidual, IsEmptyAtFirstAndRefusesOtherSizes) {
  DepthResidual residual;
  EXPECT_EQ(residual.median_m(), 0.0);
  EXPECT_EQ(residual.share(), 0.0);
  EXPECT_EQ(residual.add(row({1.0F}), row({1.0F, 1.0F})).error().code, Errc::size_mismatch);
  EXPECT_EQ(residual.valid(), 0U);
}

}  // namespace
}  // namespace saccade
