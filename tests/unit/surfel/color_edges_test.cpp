// SPDX-License-Identifier: Apache-2.0
// Edges in images and how steep renderings are there: of known ramps, and of a checked plane seen with wrong poses,
// fused with and without the mode filter.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "saccade/surfel/mode_filter.hpp"
#include "saccade/surfel/surfel_fusion.hpp"
#include "saccade/surfel/surfel_points.hpp"
#include "support/color_edges.hpp"

namespace saccade {
namespace {

using test::ColorEdge;
using test::ColorEdgesConfig;
using test::edge_sharpness;
using test::EdgeSharpness;
using test::find_color_edges;
using test::luminance;

constexpr int kEdgeWidth{120};
constexpr int kEdgeHeight{80};

/// Makes an image that is dark on the left, bright from column 60 on, with a ramp of ramp_px pixels.
ColorImage step_image(int ramp_px) {
  ColorImage image{kEdgeWidth, kEdgeHeight};
  for (int v = 0; v < kEdgeHeight; ++v) {
    for (int u = 0; u < kEdgeWidth; ++u) {
      const double share = std::clamp((u - 59.5) / ramp_px + 0.5, 0.0, 1.0);
      const auto level = static_cast<std::uint8_t>(std::lround(40.0 + 160.0 * share));
      image(u, v) = {level, level, level};
    }
  }
  return image;
}

TEST(ColorEdges, AreFoundWhereColoursChangeAndDepthDoesNot) {
  ColorEdgesConfig config;
  config.quantile = 0.9;
  DepthImage depth{kEdgeWidth, kEdgeHeight, 1.5F};
  const std::vector<ColorEdge> edges = find_color_edges(step_image(3), depth, config);
  ASSERT_EQ(edges.size(), static_cast<std::size_t>(kEdgeHeight - 2 * config.margin_px));
  for (const ColorEdge& edge : edges) {
    EXPECT_NEAR(edge.u, 59.5, 0.6);
    EXPECT_NEAR(edge.du, 1.0F, 1e-6F);
    EXPECT_NEAR(edge.dv, 0.0F, 1e-6F);
  }
  // A hole, and a step, each take the edges around.
  depth(63, 20) = 0.0F;
  EXPECT_EQ(find_color_edges(step_image(3), depth, config).size(), edges.size() - 11);
  for (int v = 50; v < kEdgeHeight; ++v) {
    for (int u = 62; u < kEdgeWidth; ++u) depth(u, v) = 1.7F;
  }
  EXPECT_EQ(find_color_edges(step_image(3), depth, config).size(), edges.size() - 11 - 30);
  EXPECT_TRUE(find_color_edges(ColorImage{kEdgeWidth, kEdgeHeight, Rgb8{9, 9, 9}}, depth, config).empty());
}

TEST(ColorEdges, SharpnessIsTheSteepestRise) {
  const DepthImage depth{kEdgeWidth, kEdgeHeight, 1.5F};
  const ColorImage sharp = step_image(1);
  std::array<Image<float>, 3> renderings{luminance(sharp), luminance(step_image(8)), luminance(sharp)};
  // Displaced by two pixels, it is as sharp.
  for (int v = 0; v < kEdgeHeight; ++v) {
    for (int u = kEdgeWidth - 1; u >= 2; --u) renderings[2](u, v) = renderings[2](u - 2, v);
  }
  for (int u = 0; u < kEdgeWidth; ++u) renderings[1](u, 30) = std::numeric_limits<float>::quiet_NaN();
  const std::vector<ColorEdge> edges = find_color_edges(sharp, depth);
  const std::vector<EdgeSharpness> found = edge_sharpness(edges, renderings);
  ASSERT_EQ(found.size(), 3U);
  const double height = 160.0 / 255.0;
  EXPECT_EQ(found[0].edges, edges.size() - 4) << "what asks for the missing row";
  EXPECT_NEAR(found[0].across, 0.5 * height, 0.01);
  EXPECT_NEAR(found[1].across, height / 8.0, 0.01);
  EXPECT_NEAR(found[2].across, 0.5 * height, 0.01);
  for (const EdgeSharpness& one : found) EXPECT_NEAR(one.along, 0.0, 1e-6);
  EXPECT_EQ(edge_sharpness({}, renderings)[1].edges, 0U);
}

constexpr PinholeCamera kBoardCamera{160, 120, 150.0, 150.0, 79.5, 59.5, 0.3, 4.0};

/// A plane at z = 1 m, checked, seen by a camera at `position`.
Frame board_frame(const Eigen::Vector3d& position, std::mt19937& random) {
  constexpr double kSquare_m{0.12};
  Frame frame;
  frame.depth = DepthImage{kBoardCamera.width, kBoardCamera.height};
  frame.color = ColorImage{kBoardCamera.width, kBoardCamera.height};
  std::normal_distribution<double> noise{0.0, 1.0};
  for (int v = 0; v < kBoardCamera.height; ++v) {
    for (int u = 0; u < kBoardCamera.width; ++u) {
      const double z = 1.0 - position.z();
      const Eigen::Vector3d p = position + z * kBoardCamera.ray(u, v);
      const bool bright = (static_cast<int>(std::floor(p.x() / kSquare_m + 0.37)) +
                           static_cast<int>(std::floor(p.y() / kSquare_m + 0.21))) %
                              2 ==
                          0;
      frame.depth(u, v) = static_cast<float>(z);
      for (std::uint8_t& channel : (*frame.color)(u, v)) {
        channel = static_cast<std::uint8_t>(std::lround((bright ? 190.0 : 60.0) + noise(random)));
      }
    }
  }
  return frame;
}

TEST(ColorEdges, ModesKeepTheEdgesOfABoardThatWrongPosesBlur) {
  SurfelFusion fusion = SurfelFusion::create().value();
  ModeFilter filter = ModeFilter::create().value();
  std::mt19937 random{11};
  std::normal_distribution<double> wrong_m{0.0, 0.008};  // about a pixel
  std::uniform_real_distribution<double> place_m{-0.05, 0.05};
  constexpr int kFrames{40};
  for (int i = 0; i < kFrames; ++i) {
    const Eigen::Vector3d position{place_m(random), place_m(random), place_m(random)};
    Frame frame = board_frame(position, random);
    frame.T_world_camera =
        Pose{Eigen::Translation3d{position.x() + wrong_m(random), position.y() + wrong_m(random), position.z()}};
    ASSERT_TRUE(fusion.add_frame(frame, kBoardCamera, {}));
    ASSERT_TRUE(filter.add_frame(frame, fusion.association(), {}));
  }
  const Frame exact = board_frame(Eigen::Vector3d::Zero(), random);
  const std::vector<ColorEdge> edges = find_color_edges(*exact.color, exact.depth);
  ASSERT_GT(edges.size(), 400U);
  const std::vector<SurfelMode> winners = filter.winners({});
  std::array<Image<float>, 2> renderings;
  std::array<std::size_t, 2> covered{};
  for (std::size_t i = 0; i < renderings.size(); ++i) {
    const SurfelPoints points = surfel_points(fusion.map(), i == 0 ? std::span<const SurfelMode>{} : winners, 2.0);
    ASSERT_GT(points.size(), 10000U);
    const SurfelView view =
        view_surfels({points.positions_m, points.normals, points.radii_m}, kBoardCamera, Pose::Identity(), {});
    renderings[i] = Image<float>{kBoardCamera.width, kBoardCamera.height, std::numeric_limits<float>::quiet_NaN()};
    for (std::size_t k = 0; k < view.seen.size(); ++k) {
      if (view.seen.pixels()[k] == kNoSurfel) continue;
      renderings[i].data()[k] = points.colors[view.seen.pixels()[k]].mean();
      ++covered[i];
    }
  }
  const std::vector<EdgeSharpness> found = edge_sharpness(edges, renderings);
  EXPECT_GT(found[0].edges, edges.size() * 9 / 10);
  const double whole = 0.5 * 130.0 / 255.0;  // within two pixels, from dark to bright
  EXPECT_LT(found[0].across, 0.75 * whole);
  EXPECT_GT(found[1].across, 0.90 * whole);
  EXPECT_GE(covered[1] + covered[1] / 200, covered[0]);
}

}  // namespace
}  // namespace saccade
