// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/internal/canvas.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "saccade/report/internal/blend.hpp"
#include "saccade/report/internal/font.hpp"
#include "unit/report/pixels.hpp"

namespace saccade {
namespace {

using test::count;

constexpr Rgb8 kWhite{255, 255, 255};
constexpr Rgb8 kRed{255, 0, 0};
constexpr Rgb8 kBlue{0, 0, 255};

/// Looks along world +z from the origin: world x is right, world y is down.
Viewpoint straight() {
  Viewpoint view;
  view.camera = {100, 80, 100.0, 100.0, 49.5, 39.5, 0.1, 10.0};
  return view;
}

TEST(Canvas, LineCoversTheProjectedPixelsAndNothingElse) {
  Canvas canvas{straight(), kWhite, 1};
  canvas.line({-0.2, 0.0, 1.0}, {0.2, 0.0, 1.0}, {kRed, 3.0});
  const ColorImage image = canvas.finish();
  for (int u = 31; u <= 68; ++u) {
    EXPECT_EQ(image(u, 39), kRed) << u;
    EXPECT_EQ(image(u, 40), kRed) << u;
    EXPECT_EQ(image(u, 36), kWhite);
    EXPECT_EQ(image(u, 43), kWhite);
  }
  EXPECT_EQ(image(26, 39), kWhite);
  EXPECT_EQ(image(73, 39), kWhite);
}

TEST(Canvas, NearerLinesHideFartherOnesInEitherOrder) {
  for (const bool near_first : {true, false}) {
    Canvas canvas{straight(), kWhite, 1};
    const auto draw = [&](double z, const Rgb8& color) {
      canvas.line({-0.2 * z, 0.0, z}, {0.2 * z, 0.0, z}, {color, 4.0});
    };
    draw(near_first ? 1.0 : 2.0, near_first ? kRed : kBlue);
    draw(near_first ? 2.0 : 1.0, near_first ? kBlue : kRed);
    EXPECT_EQ(canvas.finish()(50, 40), kRed);
    EXPECT_EQ(count(canvas.finish(), kBlue), 0U);
  }
}

TEST(Canvas, HiddenPartsAreFaintWhereAsked) {
  Canvas canvas{straight(), kWhite, 1};
  canvas.point({0.0, 0.0, 1.0}, 20.0, kBlue);
  canvas.line({-0.5, 0.0, 2.0}, {0.5, 0.0, 2.0}, {kRed, 2.0, 0.25});
  const ColorImage image = canvas.finish();
  EXPECT_EQ(image(50, 40), blend(kBlue, kRed, 0.25));
  EXPECT_EQ(image(70, 40), kRed);
}

TEST(Canvas, LinesThroughAndBehindTheCameraAreCut) {
  Canvas canvas{straight(), kWhite, 1};
  canvas.line({0.0, 0.0, -5.0}, {0.0, 0.0, -1.0}, {kRed, 3.0});
  EXPECT_EQ(count(canvas.finish(), kRed), 0U);
  canvas.line({0.3, 0.1, -1.0}, {0.0, 0.0, 2.0}, {kRed, 3.0});
  EXPECT_GT(count(canvas.finish(), kRed), 20U);
  EXPECT_EQ(canvas.finish()(10, 40), kWhite);
  canvas.line({1e6, 1e6, 1.0}, {-1e6, 2e6, 1.0}, {kBlue, 3.0});  // far outside: costs nothing, draws nothing
  EXPECT_EQ(count(canvas.finish(), kBlue), 0U);
}

TEST(Canvas, SphereOutlineStaysWithinItsDisc) {
  Canvas canvas{straight(), kWhite, 2};
  canvas.outline(Sphere{{0.0, 0.0, 2.0}, 0.4}, {kRed, 1.0});
  const ColorImage image = canvas.finish();
  std::size_t drawn{0};
  for (int v = 0; v < 80; ++v) {
    for (int u = 0; u < 100; ++u) {
      if (image(u, v) == kWhite) continue;
      ++drawn;
      EXPECT_LT(std::hypot(u - 49.5, v - 39.5), 100.0 * 0.4 / 2.0 * 1.3);
    }
  }
  EXPECT_GT(drawn, 100U);
}

TEST(Canvas, EveryRegionHasAnOutlineAndAxesTheirColors) {
  for (const Region& region : {Region{Sphere{{0, 0, 2}, 0.3}}, Region{Box{{-0.3, -0.3, 1.5}, {0.3, 0.3, 2.5}}},
                               Region{Cylinder{{0, -0.3, 2}, {0, 0.3, 2}, 0.2}}}) {
    Canvas canvas{straight(), kWhite, 1};
    canvas.outline(region, {kRed, 1.0});
    EXPECT_GT(count(canvas.finish(), kRed), 60U);
  }
  Canvas canvas{straight(), kWhite, 1};
  Pose frame = Pose::Identity();
  frame.translation() = Eigen::Vector3d{0.0, 0.0, 2.0};
  canvas.axes(frame, 0.5, 3.0);
  const ColorImage image = canvas.finish();
  EXPECT_GT(image(65, 40)[0], image(65, 40)[1] + 80);  // x to the right, red
  EXPECT_GT(image(50, 55)[1], image(50, 55)[0] + 60);  // y down, green
}

TEST(Canvas, FrustumShowsTheImageOfTheCamera) {
  Canvas canvas{straight(), kWhite, 1};
  Pose T_world_camera = Pose::Identity();
  T_world_camera.translation() = Eigen::Vector3d{0.0, 0.0, 1.0};
  const PinholeCamera square{100, 100, 100.0, 100.0, 49.5, 49.5, 0.1, 5.0};
  canvas.frustum(square, T_world_camera, 1.0, {kRed, 1.5});  // image corners at (±0.5, ±0.5, 2): 25 px from the centre
  const ColorImage image = canvas.finish();
  EXPECT_EQ(image(74, 40), kRed);
  EXPECT_EQ(image(25, 40), kRed);
  EXPECT_EQ(image(50, 64), kRed);
  EXPECT_EQ(image(80, 40), kWhite);
}

TEST(Canvas, LabelIsDrawnAtItsPoint) {
  constexpr Rgb8 kGround{120, 120, 120};
  Canvas canvas{straight(), kGround, 1};
  canvas.label({0.0, 0.0, 1.0}, "8", kRed, 12.0);
  const ColorImage image = canvas.finish();
  std::size_t drawn{0};
  for (int v = 0; v < 80; ++v) {
    for (int u = 0; u < 100; ++u) {
      if (image(u, v) == kGround) continue;
      ++drawn;
      EXPECT_LT(std::abs(u - 49.5), 10.0);
      EXPECT_TRUE(v > 23 && v < 45) << v;
    }
  }
  EXPECT_GT(drawn, 40U);
}

TEST(Overview, AllPointsAreInThePictureAndFillIt) {
  const std::array<Eigen::Vector3d, 5> points{
      {{0.0, 0.0, 0.0}, {2.0, 0.1, 0.3}, {-1.0, 0.7, 1.4}, {0.5, -3.0, 0.2}, {0.1, 0.1, 5.0}}};
  for (const double azimuth : {-2.0, 0.0, 0.5, 3.0}) {
    OverviewConfig config;
    config.azimuth_rad = azimuth;
    const Viewpoint view = overview_of(points, config);
    const Pose T_camera_world = view.T_world_camera.inverse();
    double widest{0.0};
    for (const Eigen::Vector3d& p : points) {
      const Eigen::Vector3d p_camera = T_camera_world * p;
      ASSERT_GT(p_camera.z(), 0.0);
      const Eigen::Vector2d at = view.camera.project(p_camera);
      const double x = std::abs(at.x() - view.camera.cx) / (view.camera.width / 2.0);
      const double y = std::abs(at.y() - view.camera.cy) / (view.camera.height / 2.0);
      EXPECT_LT(x, 1.0);
      EXPECT_LT(y, 1.0);
      widest = std::max({widest, x, y});
    }
    EXPECT_GT(widest, 0.85);
  }
  const Viewpoint view = overview_of(Box{{-1, -1, -1}, {1, 1, 1}});
  EXPECT_GT(view.T_world_camera.translation().z(), 1.0) << "looks down";
}

TEST(Font, EveryPrintableCharacterLeavesInkOfItsWidth) {
  for (char c = '!'; c <= '~'; ++c) {
    ColorImage image{60, 60, kWhite};
    const std::string text(1, c);
    const TextStyle style{.size_px = 24.0, .color = {0, 0, 0}};
    draw_text(image, 15.0, 40.0, text, style);
    int left{60};
    int right{-1};
    for (int v = 0; v < 60; ++v) {
      for (int u = 0; u < 60; ++u) {
        if (image(u, v)[0] > 128) continue;
        left = std::min(left, u);
        right = std::max(right, u);
        EXPECT_TRUE(v >= 13 && v <= 51) << text;
      }
    }
    ASSERT_GE(right, left) << text;
    EXPECT_GE(left, 12) << text;
    EXPECT_LE(right, 15.0 + text_width(text, style) + 3.0) << text;
  }
}

TEST(Font, AnchorsAndUtf8) {
  const TextStyle style{.size_px = 12.0};
  EXPECT_GT(text_width("10 mm", style), text_width("10", style));
  EXPECT_NEAR(text_width("\xC2\xB0", style), text_width("\xC2\xB0", {.size_px = 6.0}) * 2.0, 0.05);
  ColorImage left{100, 30, kWhite};
  ColorImage right{100, 30, kWhite};
  draw_text(left, 50.0 - text_width("±5°", style), 20.0, "±5°", style);
  draw_text(right, 50.0, 20.0, "±5°", {.size_px = 12.0, .anchor = TextAnchor::right});
  EXPECT_EQ(left, right);
  EXPECT_NE(left, (ColorImage{100, 30, kWhite}));
  draw_text(left, -500.0, 1000.0, "outside \xFF\xC3", style);
  EXPECT_EQ(left, right);
}

}  // namespace
}  // namespace saccade
