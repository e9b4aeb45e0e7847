// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/robot_drawing.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "saccade/report/internal/plane_drawing.hpp"
#include "saccade/report/sheet.hpp"
#include "unit/report/pixels.hpp"

namespace saccade {
namespace {

using Eigen::Vector2d;
using std::numbers::pi;
using test::count;

constexpr Rgb8 kPaperWhite{255, 255, 255};
constexpr Rgb8 kInk{10, 20, 30};

/// Two squares of 0.5 m side by side; the colour bar has every colour once a column at most.
ReachScene two_squares(double left, std::optional<double> right) {
  ReachScene scene;
  scene.title = "Reach";
  scene.workspace = Box{{0.0, 0.0, 0.0}, {1.0, 0.5, 0.4}};
  scene.square_m = 0.5;
  scene.squares = {{{0.25, 0.25}, left}, {{0.75, 0.25}, right}};
  return scene;
}

TEST(ReachPicture, ColorsTheSquaresByTheirShare) {
  const ColorImage picture = reach_picture(two_squares(0.25, 0.9));
  const std::size_t low = count(picture, amount_colors()(0.25));
  const std::size_t high = count(picture, amount_colors()(0.9));
  EXPECT_GT(low, 60000U);  // half a metre is about 268 pixels; the workspace's outline takes some
  EXPECT_NEAR(static_cast<double>(low), static_cast<double>(high), 0.01 * static_cast<double>(low));
  // The left one lies to the left of the right one.
  double low_u{0.0};
  double high_u{0.0};
  for (int v = 0; v < picture.height(); ++v) {
    for (int u = 0; u < picture.width(); ++u) {
      if (picture(u, v) == amount_colors()(0.25)) low_u += u / static_cast<double>(low);
      if (picture(u, v) == amount_colors()(0.9)) high_u += u / static_cast<double>(high);
    }
  }
  EXPECT_NEAR(high_u - low_u, 268.0, 6.0);
}

TEST(ReachPicture, TellsNothingReachableFromNotTested) {
  const ColorImage none = reach_picture(two_squares(0.25, 0.0));
  const ColorImage untested = reach_picture(two_squares(0.25, std::nullopt));
  EXPECT_GT(count(untested, kPaperWhite), count(none, kPaperWhite) + 50000U);
  EXPECT_EQ(count(none, amount_colors()(0.0)), count(untested, amount_colors()(0.0))) << "neither is in the map";
}

TEST(ReachPicture, ShowsArmFixturesAndTheBestPoint) {
  ReachScene scene = two_squares(0.5, 0.5);
  const ColorImage bare = reach_picture(scene);
  scene.arm = {{{0.1, -0.5}, {0.3, -0.5}, {0.3, 0.2}, {0.1, 0.2}, {0.2, 0.0}}};
  const ColorImage with_arm = reach_picture(scene);
  EXPECT_GT(with_arm.height(), bare.height()) << "room for the arm";
  const auto is_orange = [](const Rgb8& c) { return c[0] > c[1] + 50 && c[1] > c[2] + 20; };
  EXPECT_GT(count(with_arm, is_orange), count(bare, is_orange) + 500U);
  scene.arm.clear();
  scene.fixtures = {{{0.2, 0.1, -1.0}, {0.8, 0.4, 1.0}}, {{-9.0, -9.0, -1.0}, {9.0, 9.0, 0.0}}};
  EXPECT_GT(count(reach_picture(scene), Rgb8{150, 84, 40}), 1000U);
  scene.best = Vector2d{0.75, 0.25};
  EXPECT_GT(count(reach_picture(scene), Rgb8{214, 28, 92}), 40U);
}

TEST(ReachPicture, PutsDirectionsWhereTheyAreSeenFromAbove) {
  ReachScene scene = two_squares(0.0, 0.0);
  const ColorImage without = reach_picture(scene);
  for (int latitude = 0; latitude <= 3; ++latitude) {
    for (int longitude = 0; longitude < 4; ++longitude) {
      const bool to_y = latitude == 1 && longitude == 1;  // from +y, low
      scene.directions.push_back({latitude * pi / 6.0, longitude * pi / 2.0, to_y ? 1.0 : 0.0});
    }
  }
  const ColorImage picture = reach_picture(scene);
  EXPECT_GT(picture.width(), without.width() + 300);
  const Rgb8 full = amount_colors()(1.0);
  double u_sum{0.0};
  double v_sum{0.0};
  double n{0.0};
  for (int v = 0; v < 400; ++v) {  // above the colour bars
    for (int u = without.width(); u < picture.width(); ++u) {
      if (picture(u, v) != full) continue;
      u_sum += u;
      v_sum += v;
      n += 1.0;
    }
  }
  ASSERT_GT(n, 4000.0);
  EXPECT_NEAR(u_sum / n, without.width() + 0.5 * (picture.width() - without.width()) - 8.0, 6.0) << "in the middle";
  EXPECT_LT(v_sum / n, 200.0) << "in the upper half";
}

TEST(PlaneDrawing, FillsPolygonsToTheirArea) {
  for (const bool turned : {false, true}) {
    ColorImage image{60, 60, kPaperWhite};
    std::vector<Vector2d> corners{{9.5, 9.5}, {49.5, 9.5}, {49.5, 39.5}};
    if (turned) std::swap(corners[0], corners[2]);
    fill_convex(image, corners, kInk);
    EXPECT_NEAR(static_cast<double>(count(image, kInk)), 600.0, 40.0);
    EXPECT_EQ(image(5, 5), kPaperWhite);
    EXPECT_EQ(image(45, 15), kInk);
  }
}

TEST(PlaneDrawing, StrokesHaveTheirWidthAndGaps) {
  ColorImage image{100, 20, kPaperWhite};
  draw_stroke(image, {-50.0, 10.0}, {150.0, 10.0}, {kInk, 3.0});
  EXPECT_EQ(count(image, kInk), 300U);
  ColorImage dashed{100, 20, kPaperWhite};
  draw_stroke(dashed, {0.0, 10.0}, {99.0, 10.0}, {kInk, 3.0, 10.0});
  EXPECT_NEAR(static_cast<double>(count(dashed, kInk)), 150.0, 30.0);
}

}  // namespace
}  // namespace saccade
