// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analytic_map.hpp"
#include "saccade/report/depth_picture.hpp"
#include "saccade/report/mesh_picture.hpp"
#include "saccade/report/sheet.hpp"
#include "saccade/report/view_picture.hpp"
#include "unit/report/pixels.hpp"

namespace saccade {
namespace {

using test::count;
using test::is_dark;
using test::is_unknown;
using test::kSequential;

using test::map_of;

bool is_bright(const Rgb8& c) { return *std::min_element(c.begin(), c.end()) > 90; }

auto like(const Rgb8& want) {
  return [want](const Rgb8& c) {
    return std::abs(c[0] - want[0]) < 8 && std::abs(c[1] - want[1]) < 8 && std::abs(c[2] - want[2]) < 8;
  };
}

/// A ball of 10 cm in a known cube of ±32 cm; 1 cm voxels.
TsdfSnapshot ball(bool colored = false) {
  TsdfConfig config;
  config.voxel_size_m = 0.01;
  return map_of(
      config, {{-32, -32, -32}, {32, 32, 32}},
      [](const Eigen::Vector3d& p) { return test::sphere_sdf(p, Eigen::Vector3d::Zero(), 0.1); }, colored);
}

constexpr double kFocal{150.0};
Viewpoint from(const Eigen::Vector3d& position) {
  Viewpoint view;
  view.camera = {160, 120, kFocal, kFocal, 79.5, 59.5, 0.01, 10.0};
  view.T_world_camera = look_at(position, Eigen::Vector3d::Zero());
  return view;
}
Viewpoint inside() { return from({0.3, 0.0, 0.0}); }   // in the known cube
Viewpoint outside() { return from({0.8, 0.2, 0.3}); }  // beyond what is known

/// Radius in the picture of a ball seen at a distance, both in metres.
double silhouette_px(double radius_m, double distance_m) { return kFocal * std::tan(std::asin(radius_m / distance_m)); }

TernaryPictureConfig no_unknown() {
  TernaryPictureConfig config;
  config.unknown_within = {Sphere{{0.0, 0.0, 50.0}, 0.01}};
  return config;
}

TEST(TernaryPicture, OccupiedIsGreyWithoutColorsAndTakesTheFusedOnes) {
  const Rgb8 grey = ternary_picture(ball(), inside(), kSequential, no_unknown())(80, 60);
  EXPECT_TRUE(is_bright(grey));
  EXPECT_NEAR(grey[0], grey[2], 12);
  const Rgb8 fused = ternary_picture(ball(true), inside(), kSequential, no_unknown())(80, 60);
  EXPECT_GT(fused[0], fused[1] + 50);
  EXPECT_GT(fused[1], fused[2] + 25);
}

TEST(TernaryPicture, EmptyIsBackgroundAndTheBallHasItsSize) {
  TernaryPictureConfig config = no_unknown();
  config.background = {10, 200, 250};
  const ColorImage picture = ternary_picture(ball(), inside(), kSequential, config);
  EXPECT_EQ(picture(0, 0), config.background);
  const auto covered = count(picture, [&](const Rgb8& c) { return c != config.background; });
  EXPECT_NEAR(std::sqrt(static_cast<double>(covered) / std::numbers::pi), silhouette_px(0.1, 0.3),
              4.0);  // voxels stick out
}

TEST(TernaryPicture, UnknownIsAVeilAroundWhatIsKnown) {
  const ColorImage picture = ternary_picture(ball(), inside(), kSequential);
  EXPECT_TRUE(is_unknown(picture(2, 2))) << "behind the free space begins the unknown";
  EXPECT_TRUE(is_bright(picture(80, 60)));
  EXPECT_FALSE(is_unknown(ternary_picture(ball(), from({1.6, 0.4, 0.6}), kSequential)(0, 0))) << "beyond the map";
}

TEST(TernaryPicture, UnknownOutsideTheWorkspaceIsNotDrawn) {
  TsdfSnapshot map = ball();
  map.config.workspace = Box{{-0.32, -0.32, -0.32}, {0.32, 0.32, 0.32}};
  EXPECT_EQ(count(ternary_picture(map, inside(), kSequential), is_unknown), 0U);
}

TEST(TernaryPicture, ForgottenBallIsSeenFromWithinTheUnknown) {
  TsdfMap map{ball()};
  ASSERT_TRUE(map.forget(Sphere{{0.0, 0.0, 0.0}, 0.15}).ok());
  TernaryPictureConfig config;
  config.unknown_within = {Sphere{{0.0, 0.0, 0.0}, 0.15}};
  config.samples = 1;
  const ColorImage picture = ternary_picture(map.snapshot(), outside(), kSequential, config);
  EXPECT_EQ(picture(0, 0), config.background);
  const double radius_px = silhouette_px(0.15, outside().T_world_camera.translation().norm());
  const double disc = std::numbers::pi * radius_px * radius_px;
  const auto dark = static_cast<double>(count(picture, is_unknown));
  EXPECT_GT(dark, 0.7 * disc);  // the outline covers the rest
  EXPECT_LT(dark, 1.05 * disc);
  EXPECT_GT(count(picture, [](const Rgb8& c) { return c[0] > 190 && c[1] < 110 && c[2] < 60; }), 20U) << "outline";
  EXPECT_LT(count(ternary_picture(ball(), outside(), kSequential, config), is_unknown), 30U) << "not forgotten: seen";
}

TEST(TernaryPicture, UnknownFacesAreToldApart) {
  TsdfSnapshot map = ball();
  map.config.workspace = Box{{-0.1, -0.1, 0.4}, {0.1, 0.1, 0.5}};  // a block of unknown above the known cube
  Viewpoint view = outside();
  view.T_world_camera = look_at({0.7, 0.5, 0.9}, {0.0, 0.0, 0.45});
  TernaryPictureConfig config;
  config.samples = 1;
  const ColorImage picture = ternary_picture(map, view, kSequential, config);
  std::vector<Rgb8> faces;
  for (const Rgb8& c : picture.pixels()) {
    if (is_unknown(c) && std::find(faces.begin(), faces.end(), c) == faces.end()) faces.push_back(c);
  }
  EXPECT_EQ(faces.size(), 3U);
}

TEST(TernaryPicture, SameForEveryThreadCount) {
  const TsdfSnapshot map = ball(true);
  EXPECT_EQ(ternary_picture(map, inside(), Executor::with_threads(3, Executor::Backend::std_thread)),
            ternary_picture(map, inside(), kSequential));
}

TEST(TernaryPicture, EmptyMapIsBackground) {
  const ColorImage picture = ternary_picture(TsdfSnapshot{}, outside(), kSequential);
  EXPECT_EQ(count(picture, [](const Rgb8& c) { return c != TernaryPictureConfig{}.background; }), 0U);
}

TEST(MeshPicture, CoversTheBallAndShadesItsEdgeDarker) {
  const TriangleMesh mesh = extract_mesh(ball(), kSequential);
  const MeshPictureConfig config{.samples = 1, .background = {0, 0, 255}};
  const ColorImage picture = mesh_picture(mesh, inside(), kSequential, config);
  const double radius_px = silhouette_px(0.1, 0.3);
  const auto covered = count(picture, [&](const Rgb8& c) { return c != config.background; });
  EXPECT_NEAR(std::sqrt(static_cast<double>(covered) / std::numbers::pi), radius_px, 0.7);
  EXPECT_GT(picture(80, 60)[0], picture(80, 60 + static_cast<int>(radius_px) - 2)[0] + 20);
  EXPECT_EQ(mesh_picture(mesh, inside(), Executor::with_threads(3, Executor::Backend::std_thread), config), picture);
}

TEST(MeshPicture, NearerTrianglesWin) {
  TriangleMesh mesh;
  for (const float z : {2.0F, 1.0F}) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const auto& [x, y] : {std::pair{-5.0F, -5.0F}, {5.0F, -5.0F}, {0.0F, 5.0F}}) {
      mesh.vertices.emplace_back(x, y, z);
      mesh.colors.push_back(z > 1.5F ? Rgb8{255, 0, 0} : Rgb8{0, 255, 0});
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  Viewpoint view;
  view.camera = inside().camera;
  const Rgb8 green = mesh_picture(mesh, view, kSequential)(80, 60);
  EXPECT_EQ(green[0], 0);
  EXPECT_GT(green[1], 150);
  mesh.triangles.pop_back();
  EXPECT_GT(mesh_picture(mesh, view, kSequential)(80, 60)[0], 150);
  view.T_world_camera.translation() = Eigen::Vector3d{0.0, 0.0, 3.0};
  EXPECT_EQ(mesh_picture(mesh, view, kSequential)(80, 60), MeshPictureConfig{}.background) << "all behind";
}

TEST(DepthPicture, NearIsRedFarIsVioletInvalidIsDark) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const DepthImage depth{6, 1, {1.0F, 3.0F, 0.0F, nan, -2.0F, 9.0F}};
  const ColorImage picture = depth_picture(depth, {1.0, 3.0});
  EXPECT_EQ(picture(0, 0), depth_colors()(0.0));
  EXPECT_EQ(picture(1, 0), depth_colors()(1.0));
  EXPECT_EQ(picture(5, 0), depth_colors()(1.0)) << "beyond the scale";
  for (int u = 2; u < 5; ++u) EXPECT_TRUE(is_dark(picture(u, 0)));
  EXPECT_GT(picture(0, 0)[0], picture(0, 0)[2] + 60);
  EXPECT_GT(picture(1, 0)[2], picture(1, 0)[1] + 60);
}

TEST(DepthPicture, ScaleSpansTheValidDepths) {
  DepthImage depth{100, 10, 1.43F};
  for (int u = 0; u < 50; ++u) depth(u, 0) = 0.0F;
  for (int u = 0; u < 100; ++u) depth(u, 9) = 3.11F;
  const DepthScale scale = depth_scale(depth);
  EXPECT_NEAR(scale.near_m, 1.4, 1e-9);
  EXPECT_NEAR(scale.far_m, 3.2, 1e-9);
  EXPECT_EQ(depth_scale(DepthImage{4, 4, 0.0F}).far_m, DepthScale{}.far_m);
}

TEST(DifferencePicture, IsBlueBelowWhiteAtAndRedAboveZero) {
  const DepthImage a{5, 1, {1.00F, 0.99F, 1.01F, 0.0F, 1.5F}};
  const DepthImage b{5, 1, 1.0F};
  const ColorImage picture = difference_picture(a, b, 0.02);
  EXPECT_EQ(picture(0, 0), signed_colors()(0.5));
  EXPECT_GT(picture(1, 0)[2], picture(1, 0)[0] + 40);
  EXPECT_GT(picture(2, 0)[0], picture(2, 0)[2] + 40);
  EXPECT_TRUE(is_dark(picture(3, 0)));
  EXPECT_EQ(picture(4, 0), signed_colors()(1.0));
}

TEST(FusionPicture, ResidualCountsThePixelsThatBothHave) {
  DepthImage measured{10, 10, 1.0F};
  DepthImage cast{10, 10, 1.004F};
  for (int u = 0; u < 10; ++u) {
    measured(u, 0) = 0.0F;
    cast(u, 9) = 0.0F;
  }
  cast(3, 3) = 2.0F;  // an outlier does not move the median
  const Residual fit = residual(measured, cast);
  EXPECT_NEAR(fit.median_m, 0.004, 1e-6);
  EXPECT_NEAR(fit.share, 80.0 / 90.0, 1e-12);
  EXPECT_EQ(residual(DepthImage{4, 4, 0.0F}, DepthImage{4, 4, 1.0F}).share, 0.0);
}

TEST(FusionPicture, ShowsThreePanelsSideBySide) {
  const DepthImage measured{60, 40, 1.0F};
  const DepthImage cast{60, 40, 1.01F};
  FusionPictureConfig config;
  config.scale = DepthScale{0.0, 2.0};
  const ColorImage sheet = fusion_picture(measured, cast, config);
  EXPECT_GT(sheet.width(), 3 * 60);
  EXPECT_GT(sheet.height(), 40);
  EXPECT_GE(count(sheet, like(signed_colors()(0.75))), 60U * 40U);
  EXPECT_GE(count(sheet, like(depth_colors()(0.5))), 2U * 60U * 40U);
}

TEST(FusionPicture, EnlargesSmallImagesToTheWidthOfTheirTitles) {
  const DepthImage measured{60, 40, 1.0F};
  const DepthImage cast{60, 40, 1.01F};
  FusionPictureConfig config;
  config.title = "";
  config.scale = DepthScale{0.0, 2.0};
  const ColorImage small = fusion_picture(measured, cast, config);
  constexpr int kTimes{5};
  const ColorImage large = fusion_picture({kTimes * 60, kTimes * 40, 1.0F}, {kTimes * 60, kTimes * 40, 1.01F}, config);
  EXPECT_EQ(small, large);
}

TEST(ColorMaps, AreCutAtTheirEndsAndRoundBarsAreRound) {
  for (const ColorMap& map : {depth_colors(), amount_colors(), signed_colors()}) {
    EXPECT_EQ(map(-1.0), map(0.0));
    EXPECT_EQ(map(7.0), map(1.0));
    EXPECT_EQ(map(std::nan("")), map(0.0));
    EXPECT_NE(map(0.0), map(1.0));
  }
  const ColorBar bar = round_bar(8986.0, "gain");
  EXPECT_DOUBLE_EQ(bar.high, 10000.0);
  EXPECT_EQ(bar.ticks, 6);
  EXPECT_EQ(bar.decimals, 0);
  EXPECT_DOUBLE_EQ(round_bar(0.7, "").high, 0.8);
  EXPECT_EQ(round_bar(0.7, "").decimals, 1);
}

TEST(ViewPicture, ShowsTheRegionTheCandidatesAndTheBestViews) {
  TsdfMap map{ball()};
  const Sphere region{{0.0, 0.0, 0.0}, 0.15};
  ASSERT_TRUE(map.forget(region).ok());
  std::vector<ScoredPose> ranked;
  for (int i = 0; i < 24; ++i) {
    const double angle = i * std::numbers::pi / 12.0;
    const Eigen::Vector3d p{0.5 * std::cos(angle), 0.5 * std::sin(angle), 0.3};
    ranked.push_back({look_at(p, region.center), i < 12 ? 1000.0 - 10.0 * i : 0.0});
  }
  ViewPictureConfig config;
  config.overview.width = 480;
  config.overview.height = 360;
  config.samples = 1;
  const ColorImage picture = view_picture(map.snapshot(), region, ranked, kSequential, config);
  const ColorImage none = view_picture(map.snapshot(), region, {}, kSequential, config);
  EXPECT_GT(count(picture, is_unknown), 1500U) << "the forgotten ball";
  constexpr Rgb8 kBest{214, 28, 92};
  constexpr Rgb8 kNoGain{176, 180, 188};
  EXPECT_GT(count(picture, like(kBest)), count(none, like(kBest)) + 150) << "frusta of the best views";
  EXPECT_GT(count(picture, like(amount_colors()(0.95))), 30U) << "centres in the colour of their gain";
  EXPECT_GT(count(picture, like(kNoGain)), count(none, like(kNoGain)) + 60) << "centres without gain";
}

}  // namespace
}  // namespace saccade
