// SPDX-License-Identifier: Apache-2.0
#include "saccade/sensor/pinhole_camera.hpp"

#include <gtest/gtest.h>

#include <string>

namespace saccade {
namespace {

constexpr PinholeCamera kUnscaled{640, 480, 525.0, 520.0, 310.0, 243.25, 0.5, 6.0};

TEST(PinholeCamera, ScaledKeepsFieldOfViewAndRange) {
  for (const PinholeCamera& scaled : {kUnscaled.scaled_to(100, 90), kUnscaled.scaled_to_width(160)}) {
    const auto corner = [](const PinholeCamera& camera) { return camera.ray(camera.width - 0.5, camera.height - 0.5); };
    EXPECT_TRUE(scaled.ray(-0.5, -0.5).isApprox(kUnscaled.ray(-0.5, -0.5), 1e-12));
    EXPECT_TRUE(corner(scaled).isApprox(corner(kUnscaled), 1e-12));
    EXPECT_EQ(scaled.min_range_m, kUnscaled.min_range_m);
    EXPECT_EQ(scaled.max_range_m, kUnscaled.max_range_m);
  }
}

TEST(PinholeCamera, ScaledToWidthRoundsTheHeight) {
  const PinholeCamera scaled = kUnscaled.scaled_to_width(99);
  EXPECT_EQ(scaled.width, 99);
  EXPECT_EQ(scaled.height, 74);  // 74.25 rows rounded
  EXPECT_EQ(scaled.fx, 525.0 * (99.0 / 640.0));
  EXPECT_EQ(scaled.fy, 520.0 * (74.0 / 480.0));
  EXPECT_EQ(kUnscaled.scaled_to_width(1).height, 1);
}

TEST(PinholeCamera, WholeFactorsAreExact) {
  for (int factor = 1; factor <= 4; ++factor) {
    const PinholeCamera large = kUnscaled.scaled_to_width(factor * kUnscaled.width);
    EXPECT_EQ(large, (PinholeCamera{factor * 640, factor * 480, factor * 525.0, factor * 520.0, factor * 310.5 - 0.5,
                                    factor * 243.75 - 0.5, 0.5, 6.0}));
  }
}

TEST(PinholeCamera, NumbersBeyondAnyCameraAreRefused) {
  EXPECT_TRUE(kUnscaled.validate());
  EXPECT_TRUE((PinholeCamera{640, 480, 0.7, 0.7, -5e5, 4e5, 0.0, 1e6}.validate()));
  const auto expect_refused = [](auto change, const std::string& part) {
    PinholeCamera camera = kUnscaled;
    change(camera);
    const Status status = camera.validate();
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, Errc::invalid_argument);
    EXPECT_NE(status.error().message.find(part), std::string::npos) << status.error().message;
  };
  for (const double focal_px : {1e-30, 0.5, 1e6, 1e300}) {
    expect_refused([=](PinholeCamera& camera) { camera.fx = focal_px; }, "focal lengths");
    expect_refused([=](PinholeCamera& camera) { camera.fy = 0.7 * focal_px; }, "pixels");
  }
  for (const double center_px : {-1e30, 1e6}) {
    expect_refused([=](PinholeCamera& camera) { camera.cx = center_px; }, "principal point");
    expect_refused([=](PinholeCamera& camera) { camera.cy = center_px; }, "pixels");
  }
  for (const double range_m : {2e6, 1e30}) {
    expect_refused([=](PinholeCamera& camera) { camera.max_range_m = range_m; }, "metres");
  }
}

}  // namespace
}  // namespace saccade
