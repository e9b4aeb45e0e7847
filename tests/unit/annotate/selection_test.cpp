// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/selection.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/naive_selection.hpp"

namespace saccade {
namespace {

using Indices = std::vector<std::uint32_t>;
constexpr float kNanF{std::numeric_limits<float>::quiet_NaN()};

/// 100 × 100 px at the origin, along +z; a metre at 1 m is 100 px. Seen from 0.1 m to 10 m.
SelectionView front_view(int point_size_px = 1) {
  return {test::perspective(Pose::Identity(), 100.0, 100, 100, 0.1, 10.0), 100, 100, point_size_px};
}

/// At (u, v) in front_view.
Eigen::Vector3f seen_at(double u_px, double v_px, double depth_m) {
  return {static_cast<float>((u_px - 50.0) / 100.0 * depth_m), static_cast<float>((v_px - 50.0) / 100.0 * depth_m),
          static_cast<float>(depth_m)};
}

const ScreenRectangle kWhole{{0.0, 0.0}, {100.0, 100.0}};

Indices select(const std::vector<Eigen::Vector3f>& points, const SelectionView& view, const ScreenShape& shape,
               double below_m, SurfaceRule rule = SurfaceRule::as_printed) {
  return select_points(points, view, shape, below_m, Executor{}, rule).value();
}

TEST(Selection, SurfaceHasWhatIsSeenAndDeepHasAll) {
  const std::vector<Eigen::Vector3f> points{seen_at(20.5, 30.5, 1.0), seen_at(20.4, 30.6, 1.2),
                                            seen_at(20.6, 30.4, 3.0), seen_at(60.5, 30.5, 3.0)};
  const ScreenRectangle rectangle{{10.0, 10.0}, {40.0, 40.0}};
  EXPECT_EQ(select(points, front_view(), rectangle, kOnSurface_m), Indices({0}));
  EXPECT_EQ(select(points, front_view(), rectangle, 0.3), Indices({0, 1}));
  EXPECT_EQ(select(points, front_view(), rectangle, kAnyDepth_m), Indices({0, 1, 2}));
  EXPECT_EQ(select(points, front_view(), kWhole, kOnSurface_m), Indices({0, 3}));
}

TEST(Selection, LargerPointsCloseTheGapsOfASurface) {
  std::vector<Eigen::Vector3f> points{seen_at(50.5, 50.5, 2.0)};  // behind a lattice with a gap there
  for (int v = 48; v <= 52; v += 2) {
    for (int u = 49; u <= 51; u += 2) points.push_back(seen_at(u + 0.5, v + 0.5, 1.0));
  }
  EXPECT_EQ(select(points, front_view(1), kWhole, kOnSurface_m).front(), 0U);
  EXPECT_EQ(select(points, front_view(3), kWhole, kOnSurface_m).front(), 1U);
}

TEST(Selection, ASurfaceThatIsSeenHasThickness) {
  // A pixel is 1 cm wide at 1 m. Points of 3 px have 6 cm of thickness, and look 1 px to either side.
  std::vector<Eigen::Vector3f> points{seen_at(50.5, 50.5, 1.0), seen_at(50.5, 50.5, 1.05), seen_at(50.5, 50.5, 1.07),
                                      seen_at(50.5, 50.5, 1.5)};
  const ScreenRectangle one{{50.0, 50.0}, {51.0, 51.0}};
  const auto taken = [&](double below_m, SurfaceRule rule = SurfaceRule::seen) {
    return select(points, front_view(3), one, below_m, rule);
  };
  EXPECT_EQ(taken(kOnSurface_m, SurfaceRule::as_printed), Indices({0}));
  EXPECT_EQ(taken(kOnSurface_m), Indices({0, 1}));
  EXPECT_EQ(taken(0.01), Indices({0, 1}));
  EXPECT_EQ(taken(0.09), Indices({0, 1, 2}));
}

TEST(Selection, APointIsSeenWhereItsSquareSticksOut) {
  std::vector<Eigen::Vector3f> points{seen_at(49.5, 50.5, 1.0), seen_at(50.5, 50.5, 1.2)};
  const ScreenRectangle one{{50.0, 50.0}, {51.0, 51.0}};
  EXPECT_TRUE(select(points, front_view(3), one, kOnSurface_m, SurfaceRule::as_printed).empty());
  EXPECT_EQ(select(points, front_view(3), one, kOnSurface_m, SurfaceRule::seen), Indices({1}));
  points[1] = seen_at(50.5, 50.5, 1.4);  // 32 px behind what its pixel shows are the most
  EXPECT_TRUE(select(points, front_view(3), one, kOnSurface_m, SurfaceRule::seen).empty());
  points[1] = seen_at(50.5, 50.5, 1.2);
  points.push_back(seen_at(52.5, 50.5, 1.0));  // covers the rest of it
  EXPECT_TRUE(select(points, front_view(3), one, kOnSurface_m, SurfaceRule::seen).empty());
}

TEST(Selection, APixelIsAsWideAsItsPlaceSays) {
  SelectionView view = front_view();
  EXPECT_FLOAT_EQ(ScreenProjection{view}.pixel_m(1.0F), 0.01F);
  EXPECT_FLOAT_EQ(ScreenProjection{view}.pixel_m(3.0F), 0.03F);
  view.clip_world = test::orthographic(Pose::Identity(), 50.0, 100, 100, -5.0, 5.0);
  EXPECT_FLOAT_EQ(ScreenProjection{view}.pixel_m(-1.0F), 0.02F);
  EXPECT_FLOAT_EQ(ScreenProjection{view}.pixel_m(3.0F), 0.02F);
  view.height = 50;  // half as many pixels for the same height
  EXPECT_FLOAT_EQ(ScreenProjection{view}.pixel_m(3.0F), 0.04F);
}

TEST(Selection, ASquareCoversAsManyPixelsAsItsAreaHas) {
  for (const int size : {1, 2, 3, 4, 7}) {
    std::vector<Eigen::Vector3f> points;
    for (int v = 0; v < 40; ++v) {
      for (int u = 0; u < 40; ++u) points.push_back(seen_at(u + 0.5, v + 0.5, 2.0));
    }
    points.push_back(seen_at(20.3, 20.8, 1.0));
    const std::size_t hidden = points.size() - select(points, front_view(size), kWhole, kOnSurface_m).size();
    EXPECT_EQ(hidden, static_cast<std::size_t>(size * size));
  }
}

TEST(Selection, WhatIsNotInViewIsNotSelectedAndHidesNothing) {
  const std::vector<Eigen::Vector3f> points{{0.0F, 0.0F, 0.05F},
                                            {0.0F, 0.0F, -1.0F},
                                            {0.0F, 0.0F, 11.0F},
                                            {kNanF, 0.0F, 1.0F},
                                            {0.0F, kNanF, 1.0F},
                                            {0.0F, 0.0F, kNanF},
                                            {0.0F, 0.0F, 0.0F},
                                            seen_at(-0.2, 50, 1),
                                            seen_at(50, -0.2, 1),
                                            seen_at(100.2, 50, 1),
                                            {0.0F, 0.0F, std::numeric_limits<float>::infinity()},
                                            {0.0F, 0.0F, 5.0F}};
  EXPECT_EQ(select(points, front_view(5), kWhole, kAnyDepth_m), Indices({11}));
  EXPECT_EQ(select(points, front_view(5), kWhole, kOnSurface_m), Indices({11}));
}

TEST(Selection, OrthographicViewsHaveDepthInMetresToo) {
  SelectionView view = front_view();
  view.clip_world = test::orthographic(Pose::Identity(), 100.0, 100, 100, -5.0, 5.0);
  const std::vector<Eigen::Vector3f> points{{0.1F, 0.1F, -3.0F}, {0.1F, 0.1F, -2.75F}, {0.1F, 0.1F, 6.0F}};
  EXPECT_EQ(select(points, view, kWhole, kOnSurface_m), Indices({0}));
  EXPECT_EQ(select(points, view, kWhole, 0.2), Indices({0}));
  EXPECT_EQ(select(points, view, kWhole, 0.3), Indices({0, 1}));
  EXPECT_EQ(select(points, view, ScreenRectangle{{60.0, 60.0}, {61.0, 61.0}}, kAnyDepth_m), Indices({0, 1}));
}

TEST(Selection, ABallReachesWhatIsHiddenButNotWhatIsFarBehind) {
  const std::vector<Eigen::Vector3f> points{seen_at(50.5, 50.5, 1.0), seen_at(50.5, 50.5, 1.09),
                                            seen_at(50.5, 50.5, 1.11), seen_at(58.5, 50.5, 1.0),
                                            seen_at(61.5, 50.5, 1.0)};
  const auto around = [&](std::vector<ScreenPoint> line) {
    return select_around(points, front_view(), line, 0.1, Executor{}).value();
  };
  EXPECT_EQ(around({{50.5, 50.5}}), Indices({0, 1, 3}));
  EXPECT_EQ(around({{50.5, 50.5}, {61.5, 50.5}}), Indices({0, 1, 3, 4}));
  EXPECT_TRUE(around({{20.5, 50.5}}).empty());
  EXPECT_TRUE(around({{500.0, 50.5}}).empty());
}

TEST(Selection, APlaceIsWhereItsProjectionCameFrom) {
  SelectionView view = front_view();
  const Pose T_world_camera = look_at({1.0, 2.0, 0.5}, {0.1, 0.2, 0.3});
  for (const bool is_perspective : {true, false}) {
    view.clip_world = is_perspective ? test::perspective(T_world_camera, 80.0, 100, 100, 0.1, 10.0)
                                     : 2.0 * test::orthographic(T_world_camera, 30.0, 100, 100, 0.1, 10.0);
    const ScreenProjection project{view};
    const Eigen::Vector3f p{0.2F, 0.1F, 0.4F};
    const ScreenPosition at = project(p);
    ASSERT_TRUE(at.in_view());
    EXPECT_LT((project.place(at.u_px, at.v_px, at.depth_m) - p.cast<double>()).norm(), 1e-6);
    EXPECT_NEAR(project(p + 0.5F * T_world_camera.linear().col(2).cast<float>()).depth_m - at.depth_m, 0.5F, 1e-5F);
  }
}

TEST(Selection, WhatMakesNoSenseIsRefused) {
  const std::vector<Eigen::Vector3f> points{{0.0F, 0.0F, 1.0F}};
  const std::vector<ScreenPoint> line{{50.0, 50.0}};
  const auto code = [](const auto& result) { return result.ok() ? Errc::cancelled : result.error().code; };
  const Executor executor;
  EXPECT_EQ(code(select_points(points, front_view(), kWhole, -0.1, executor)), Errc::invalid_argument);
  EXPECT_EQ(code(select_points(points, front_view(), kWhole, kNanF, executor)), Errc::invalid_argument);
  EXPECT_EQ(code(select_points(points, front_view(), ScreenPolygon{}, 0.0, executor)), Errc::invalid_argument);
  EXPECT_EQ(code(select_around(points, front_view(), line, 0.0, executor)), Errc::invalid_argument);
  EXPECT_EQ(code(select_around(points, front_view(), line, kAnyDepth_m, executor)), Errc::invalid_argument);
  EXPECT_EQ(code(select_around(points, front_view(), {}, 0.1, executor)), Errc::invalid_argument);
  for (const auto& spoil : std::vector<void (*)(SelectionView&)>{
           [](SelectionView& view) { view.width = 0; }, [](SelectionView& view) { view.height = 8193; },
           [](SelectionView& view) { view.point_size_px = 0; }, [](SelectionView& view) { view.point_size_px = 65; },
           [](SelectionView& view) { view.clip_world(1, 1) = kNanF; },
           [](SelectionView& view) { view.clip_world.row(0).setZero(); },
           [](SelectionView& view) { view.clip_world.row(3).setZero(); }}) {
    SelectionView view = front_view();
    spoil(view);
    EXPECT_EQ(code(select_points(points, view, kWhole, 0.0, executor)), Errc::invalid_argument);
    EXPECT_EQ(code(select_around(points, view, line, 0.1, executor)), Errc::invalid_argument);
  }
}

}  // namespace
}  // namespace saccade
