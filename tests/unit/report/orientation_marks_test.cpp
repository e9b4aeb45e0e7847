// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/internal/orientation_marks.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace saccade {
namespace {

constexpr Rgb8 kBlank{236, 239, 243};

TEST(OrientationMarks, LengthsAreRound) {
  EXPECT_DOUBLE_EQ(round_length(1.0), 1.0);
  EXPECT_DOUBLE_EQ(round_length(1.99), 1.0);
  EXPECT_DOUBLE_EQ(round_length(4.9), 2.0);
  EXPECT_DOUBLE_EQ(round_length(0.051), 0.05);
  EXPECT_EQ(length_text(2.0), "2 m");
  EXPECT_EQ(length_text(0.2), "20 cm");
  EXPECT_EQ(length_text(0.005), "5 mm");
}

TEST(OrientationMarks, TheBarIsAsLongAsItsLengthAtThatDepthAndTheAxesAreInTheCorner) {
  OverviewConfig config{.width = 640, .height = 480};
  const Box box{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}};
  const Viewpoint view = overview_of(box, config);
  Canvas canvas{view, kBlank, 1};
  draw_orientation(canvas, Eigen::Vector3d::Zero());
  const ColorImage picture = canvas.finish();
  const double depth_m = (view.T_world_camera.inverse() * Eigen::Vector3d::Zero()).z();
  const double px_per_m = view.camera.fx / depth_m;
  const double length_m = round_length(0.16 * 640 / px_per_m);
  int left = 640;
  int right = 0;
  for (int u = 85; u < 640; ++u) {
    if (picture(u, 480 - 24) == kBlank) continue;
    left = std::min(left, u);
    right = std::max(right, u);
  }
  EXPECT_NEAR(right - left, length_m * px_per_m, 4.0);
  const auto has = [&](bool (*is)(const Rgb8&)) {
    return std::any_of(picture.pixels().begin(), picture.pixels().end(), is);
  };
  EXPECT_TRUE(has([](const Rgb8& c) { return c[0] > 180 && c[1] < 80 && c[2] < 80; })) << "x";
  EXPECT_TRUE(has([](const Rgb8& c) { return c[1] > 120 && c[0] < 80 && c[2] < 90; })) << "y";
  EXPECT_TRUE(has([](const Rgb8& c) { return c[2] > 180 && c[0] < 80 && c[1] < 120; })) << "z";
  for (int v = 0; v < 380; ++v) {
    for (int u = 200; u < 640; ++u) ASSERT_EQ(picture(u, v), kBlank);
  }
}

}  // namespace
}  // namespace saccade
