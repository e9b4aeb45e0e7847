// SPDX-License-Identifier: Apache-2.0
// The method surface of the depth filter on scenes whose shadows and edges are known, and on what makes no sense.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "saccade/sensor/analytic_scene.hpp"
#include "saccade/sensor/kinect_v2_filter.hpp"
#include "support/depth_rows.hpp"

namespace saccade {
namespace {

const PinholeCamera& whole_sensor() {
  static const PinholeCamera camera = camera_preset("kinect-v2").value();
  return camera;
}

FilteredDepth filtered_by(DepthFilterMethod method, const DepthImage& depth, DepthFilterConfig config = {},
                          const Executor& executor = {}) {
  config.method = method;
  PinholeCamera camera = whole_sensor();
  camera.width = depth.width();
  camera.height = depth.height();
  return DepthFilter::create(camera, config).value().filter(depth, executor).value();
}

/// A wall at 2.5 m behind a plate at 1 m.
DepthImage plate_before_wall(double half_width_m) {
  AnalyticScene scene;
  scene.objects.push_back({"wall", HalfSpace{-Eigen::Vector3d::UnitZ(), -2.5}});
  scene.objects.push_back({"plate", Box{{-half_width_m, -0.4, 1.0}, {half_width_m, 0.4, 1.001}}});
  return render(scene, whole_sensor(), Pose::Identity()).value().depth;
}

TEST(SurfaceFilter, KeepsTheBackgroundThatIsLitBehindAThinPlate) {
  for (const EmitterSide side : {EmitterSide::left, EmitterSide::right}) {
    DepthFilterConfig config;
    config.emitter_side = side;
    config.remove_veil_points = false;
    const DepthImage depth = plate_before_wall(0.01);
    const FilteredDepth thesis = filtered_by(DepthFilterMethod::thesis, depth, config);
    const FilteredDepth surface = filtered_by(DepthFilterMethod::surface, depth, config);
    const double emitter_x = side == EmitterSide::left ? -config.baseline_m : config.baseline_m;
    std::size_t unlit{0};
    std::size_t unlit_removed{0};
    std::size_t lit_removed{0};
    for (int v = 0; v < depth.height(); ++v) {
      for (int u = 0; u < depth.width(); ++u) {
        const Eigen::Vector3d p = whole_sensor().ray(u, v) * static_cast<double>(depth(u, v));
        const double x = emitter_x + (p.x() - emitter_x) / p.z();  // where the light passes the plate
        const bool is_unlit = p.z() > 2.0 && std::abs(x) < 0.01 && std::abs(p.y() / p.z()) < 0.4;
        const bool removed = surface.pixels(u, v) == FilteredPixel::shadow_point;
        unlit += is_unlit ? 1U : 0U;
        unlit_removed += is_unlit && removed ? 1U : 0U;
        lit_removed += !is_unlit && removed ? 1U : 0U;
      }
    }
    EXPECT_GT(thesis.shadow_points, 2U * unlit);
    // Here nothing tells a point in shadow from others but geometry; the borders are in doubt and lie on the wall.
    EXPECT_GT(unlit, 1000U);
    EXPECT_GT(unlit_removed, unlit / 10U);
    EXPECT_LT(lit_removed, unlit / 20U);
    EXPECT_EQ(surface.veil_points, 0U);
  }
}

TEST(SurfaceFilter, RemovesWhatIsInDoubtAndOffTheBackground) {
  DepthImage depth = plate_before_wall(0.08);
  DepthFilterConfig config;
  const FilteredDepth before = filtered_by(DepthFilterMethod::thesis, depth, config);
  std::mt19937_64 random{5};
  std::normal_distribution<float> error{0.05F, 0.1F};
  Image<std::uint8_t> rough{depth.width(), depth.height()};
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (before.pixels.pixels()[i] != FilteredPixel::shadow_point) continue;
    depth.data()[i] += error(random);
    rough.data()[i] = 1;
  }
  for (const double share : {0.9, 1.0, 1.1}) {
    config.baseline_m = 0.08 * share;
    const FilteredDepth filtered = filtered_by(DepthFilterMethod::surface, depth, config);
    std::size_t kept{0};
    std::size_t all{0};
    for (std::size_t i = 0; i < depth.size(); ++i) {
      if (rough.pixels()[i] == 0) continue;
      ++all;
      kept += filtered.depth.pixels()[i] > 0.0F && std::abs(filtered.depth.pixels()[i] - 2.5F) > 0.03F ? 1U : 0U;
    }
    EXPECT_GT(all, 1000U);
    EXPECT_LE(kept, all / 500U) << share;
  }
}

TEST(SurfaceFilter, KeepsEdgesAndRemovesWhatHangsBetweenThem) {
  DepthFilterConfig config;
  config.remove_shadow_points = false;
  DepthImage depth{512, 424, 2.0F};
  for (int v = 100; v < 200; ++v) {
    for (int u = 200; u < 300; ++u) depth(u, v) = 1.0F;
    depth(199, v) = 1.4F;  // interpolated
    depth(300, v) = 1.03F;
  }
  for (int u = 200; u < 300; ++u) depth(u, 99) = 1.5F;
  const FilteredDepth filtered = filtered_by(DepthFilterMethod::surface, depth, config);
  EXPECT_EQ(filtered.veil_points, 100U + 100U + 100U);
  for (const auto& [u, v] : {std::pair{198, 150}, {200, 150}, {299, 150}, {301, 150}, {250, 100}, {250, 98}}) {
    EXPECT_EQ(filtered.pixels(u, v), FilteredPixel::kept) << u << ", " << v;
  }
  for (const auto& [u, v] : {std::pair{199, 150}, {300, 150}, {250, 99}}) {
    EXPECT_EQ(filtered.pixels(u, v), FilteredPixel::veil_point) << u << ", " << v;
  }
}

TEST(SurfaceFilter, KeepsPlanesHoweverTheyLie) {
  for (const double slope : {-4.0, -1.0, 0.0, 1.0, 4.0}) {
    AnalyticScene scene;
    const Eigen::Vector3d normal = Eigen::Vector3d{slope, 0.3 * slope, -1.0}.normalized();
    scene.objects.push_back({"plane", HalfSpace{normal, normal.z() * 2.0}});
    const DepthImage depth = render(scene, whole_sensor(), Pose::Identity()).value().depth;
    const FilteredDepth filtered = filtered_by(DepthFilterMethod::surface, depth);
    EXPECT_GT(filtered.points, 10000U);
    // At the border of what is measured, two pixels on one side are all that can be asked.
    const auto is_inside = [&](int u, int v) {
      return u >= 2 && v >= 2 && u + 2 < depth.width() && v + 2 < depth.height() && depth(u - 2, v) > 0.0F &&
             depth(u + 2, v) > 0.0F && depth(u, v - 2) > 0.0F && depth(u, v + 2) > 0.0F;
    };
    std::size_t removed_inside{0};
    for (int v = 0; v < depth.height(); ++v) {
      for (int u = 0; u < depth.width(); ++u) {
        removed_inside += is_inside(u, v) && filtered.pixels(u, v) != FilteredPixel::kept ? 1U : 0U;
      }
    }
    EXPECT_EQ(removed_inside, 0U) << slope;
  }
}

TEST(SurfaceFilter, NeverReturnsWhatDidNotComeAndCounts) {
  std::mt19937_64 random{3};
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 40}, {40, 1}, {2, 2}, {5, 3}, {160, 120}}) {
    for (int n = 0; n < 5; ++n) {
      DepthImage depth{width, height};
      for (int v = 0; v < height; ++v) {
        const std::vector<float> row = test::random_depth_row(static_cast<std::size_t>(width), random);
        std::copy(row.begin(), row.end(), depth.row(v));
      }
      if (n == 0) depth(0, 0) = -2.0F;
      for (const EmitterSide side : {EmitterSide::left, EmitterSide::right}) {
        DepthFilterConfig config;
        config.emitter_side = side;
        const FilteredDepth filtered = filtered_by(DepthFilterMethod::surface, depth, config);
        std::size_t kept{0};
        for (std::size_t i = 0; i < depth.size(); ++i) {
          const float z = depth.pixels()[i];
          const FilteredPixel pixel = filtered.pixels.pixels()[i];
          EXPECT_EQ(pixel == FilteredPixel::no_return, !(z > 0.0F && std::isfinite(z)));
          kept += pixel == FilteredPixel::kept ? 1U : 0U;
          if (pixel != FilteredPixel::no_return) {
            EXPECT_EQ(filtered.depth.pixels()[i], pixel == FilteredPixel::kept ? z : 0.0F);
          }
        }
        EXPECT_EQ(kept, filtered.kept());
      }
    }
  }
}

TEST(SurfaceFilter, TakesImagesOfNothingAndOfMonsters) {
  for (const float z : {0.0F, -1.0F, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    EXPECT_EQ(filtered_by(DepthFilterMethod::surface, DepthImage{64, 48, z}).points, 0U);
  }
  for (const float z : {std::numeric_limits<float>::max(), std::numeric_limits<float>::min(),
                        std::numeric_limits<float>::denorm_min(), 1e-20F, 1e20F}) {
    DepthImage depth{64, 48, z};
    EXPECT_EQ(filtered_by(DepthFilterMethod::surface, depth).points, depth.size()) << z;
    for (int v = 0; v < 48; v += 2) {
      for (int u = v % 3; u < 64; u += 3) depth(u, v) = 1.0F;
    }
    EXPECT_EQ(filtered_by(DepthFilterMethod::surface, depth).points, depth.size()) << z;
  }
  DepthFilterConfig none;
  none.baseline_m = 0.0;
  EXPECT_EQ(filtered_by(DepthFilterMethod::surface, plate_before_wall(0.02), none).shadow_points, 0U);
}

TEST(SurfaceFilter, IsTheSameForEveryThreadCount) {
  std::mt19937_64 random{9};
  DepthImage depth{200, 150};
  for (int v = 0; v < 150; ++v) {
    const std::vector<float> row = test::random_depth_row(200, random);
    std::copy(row.begin(), row.end(), depth.row(v));
  }
  const FilteredDepth once = filtered_by(DepthFilterMethod::surface, depth);
  EXPECT_GT(once.shadow_points, 1000U);
  EXPECT_GT(once.veil_points, 100U);
  for (const std::size_t threads : {2U, 3U, 8U}) {
    EXPECT_EQ(filtered_by(DepthFilterMethod::surface, depth, {}, Executor::with_threads(threads)).pixels, once.pixels);
  }
}

TEST(SurfaceFilter, RefusesWhatMakesNoSense) {
  EXPECT_FALSE((DepthFilterConfig{.baseline_uncertainty = -0.1}.validate().ok()));
  EXPECT_FALSE((DepthFilterConfig{.baseline_uncertainty = 1.1}.validate().ok()));
  EXPECT_FALSE((DepthFilterConfig{.tolerance_m = std::nan("")}.validate().ok()));
  EXPECT_FALSE((DepthFilterConfig{.tolerance_per_m = -1.0}.validate().ok()));
}

}  // namespace
}  // namespace saccade
