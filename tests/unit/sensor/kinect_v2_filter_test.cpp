// SPDX-License-Identifier: Apache-2.0
// The filter beside the thesis' formulas in double loops, and on scenes whose shadows and edges are known.
#include "saccade/sensor/kinect_v2_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>
#include <span>

#include "saccade/sensor/analytic_scene.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

constexpr double kPi{std::numbers::pi};

const PinholeCamera& kinect_v2() {
  static const PinholeCamera camera = camera_preset("kinect-v2").value();
  return camera;
}

bool is_return(float z) { return z > 0.0F && std::isfinite(z); }

/// Eq. 3.13–3.17 for pixel (u, v), k running over the whole row. NaN where rounding decides.
double naive_is_shadow(const DepthImage& depth, const PinholeCamera& camera, const DepthFilterConfig& config, int u,
                       int v) {
  const double side = config.emitter_side == EmitterSide::left ? 1.0 : -1.0;
  const auto alpha = [&](int i) { return side * std::atan((i - camera.cx) / camera.fx) + kPi / 2.0; };
  const auto beta = [&](int i) {
    const double z = depth(i, v);
    const double x = side * (i - camera.cx) / camera.fx * z;
    return std::atan((x + config.baseline_m) / z) + kPi / 2.0;
  };
  double max_beta{-std::numeric_limits<double>::infinity()};
  for (int k = 0; k < depth.width(); ++k) {
    if (is_return(depth(k, v)) && alpha(k) < alpha(u)) max_beta = std::max(max_beta, beta(k));
  }
  if (std::abs(beta(u) - max_beta) < 1e-12) return std::nan("");
  return beta(u) <= max_beta ? 1.0 : 0.0;
}

/// Eq. 3.19 for pixel (u, v). NaN where rounding decides.
double naive_is_veil(const DepthImage& depth, const PinholeCamera& camera, const DepthFilterConfig& config, int u,
                     int v) {
  const auto point = [&](int i, int j) { return Eigen::Vector3d{camera.ray(i, j) * static_cast<double>(depth(i, j))}; };
  const Eigen::Vector3d p_i = point(u, v);
  double largest{0.0};
  for (const auto& [i, j] : {std::pair{u - 1, v}, {u + 1, v}, {u, v - 1}, {u, v + 1}}) {
    if (i < 0 || j < 0 || i >= depth.width() || j >= depth.height() || !is_return(depth(i, j))) continue;
    const Eigen::Vector3d p_k = point(i, j);
    largest = std::max(largest, std::abs((p_k - p_i).dot(p_i) / ((p_k - p_i).norm() * p_i.norm())));
  }
  const double limit = std::cos(config.veil_angle_rad);
  if (std::abs(largest - limit) < 1e-9) return std::nan("");
  return largest > limit ? 1.0 : 0.0;
}

/// Patches of different depth, noise, single wild pixels, and everything that is no return.
DepthImage random_depth(const PinholeCamera& camera, std::mt19937_64& random) {
  std::uniform_real_distribution<float> share{0.0F, 1.0F};
  DepthImage depth{camera.width, camera.height, 1.0F + 3.0F * share(random)};
  for (int patch = 0; patch < 6; ++patch) {
    const int u0 = static_cast<int>(share(random) * static_cast<float>(camera.width));
    const int v0 = static_cast<int>(share(random) * static_cast<float>(camera.height));
    const float z = 0.6F + 3.0F * share(random);
    const float slope = 0.02F * (share(random) - 0.5F);
    for (int v = v0; v < std::min(v0 + 12, camera.height); ++v) {
      for (int u = u0; u < std::min(u0 + 9, camera.width); ++u) depth(u, v) = z + slope * static_cast<float>(u - u0);
    }
  }
  for (float& z : std::span{depth.data(), depth.size()}) {
    z += 0.01F * share(random);
    if (share(random) < 0.03F) z = 0.5F + 4.0F * share(random);
    if (share(random) < 0.03F) z = 0.0F;
    if (share(random) < 0.02F) z = -z;
    if (share(random) < 0.02F) z = std::numeric_limits<float>::quiet_NaN();
    if (share(random) < 0.02F) z = std::numeric_limits<float>::infinity();
  }
  return depth;
}

TEST(KinectV2Filter, IsTheThesisFormulas) {
  std::mt19937_64 random{7};
  std::uniform_real_distribution<double> share{0.0, 1.0};
  std::size_t compared{0};
  std::size_t shadow_points{0};
  std::size_t veil_points{0};
  std::size_t undecided{0};
  const int cases = test::scaled_cases(40);
  for (int n = 0; n < cases; ++n) {
    const PinholeCamera camera{
        48,  30, 40.0 + 300.0 * share(random), 40.0 + 300.0 * share(random), 48.0 * share(random), 30.0 * share(random),
        0.5, 4.5};
    DepthFilterConfig config{.method = DepthFilterMethod::thesis};
    config.baseline_m = 0.2 * share(random);
    config.emitter_side = n % 2 == 0 ? EmitterSide::left : EmitterSide::right;
    config.veil_angle_rad = (2.0 + 40.0 * share(random)) * kPi / 180.0;
    const DepthImage depth = random_depth(camera, random);
    const FilteredDepth filtered = DepthFilter::create(camera, config).value().filter(depth).value();
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        if (!is_return(depth(u, v))) {
          EXPECT_EQ(filtered.pixels(u, v), FilteredPixel::no_return);
          continue;
        }
        const double shadow = naive_is_shadow(depth, camera, config, u, v);
        const double veil = naive_is_veil(depth, camera, config, u, v);
        if (std::isnan(shadow) || std::isnan(veil)) {
          ++undecided;
          continue;
        }
        const FilteredPixel expected = shadow > 0.0 ? FilteredPixel::shadow_point
                                       : veil > 0.0 ? FilteredPixel::veil_point
                                                    : FilteredPixel::kept;
        ASSERT_EQ(filtered.pixels(u, v), expected) << "case " << n << ", pixel " << u << ", " << v;
        ASSERT_EQ(filtered.depth(u, v), expected == FilteredPixel::kept ? depth(u, v) : 0.0F);
        ++compared;
        shadow_points += expected == FilteredPixel::shadow_point ? 1U : 0U;
        veil_points += expected == FilteredPixel::veil_point ? 1U : 0U;
      }
    }
  }
  EXPECT_GT(compared, 1000U * static_cast<std::size_t>(cases));
  EXPECT_GT(shadow_points, 50U * static_cast<std::size_t>(cases));
  EXPECT_GT(veil_points, 50U * static_cast<std::size_t>(cases));
  EXPECT_LT(undecided, compared / 1000U);
}

/// A wall at 2.5 m behind a box whose front is at 1 m.
DepthImage box_before_wall(double half_width_m) {
  AnalyticScene scene;
  scene.objects.push_back({"wall", HalfSpace{-Eigen::Vector3d::UnitZ(), -2.5}});
  scene.objects.push_back({"box", Box{{-half_width_m, -0.1, 1.0}, {half_width_m, 0.1, 1.05}}});
  return render(scene, kinect_v2(), Pose::Identity()).value().depth;
}

TEST(KinectV2Filter, RemovesWhatTheEmitterDoesNotLight) {
  constexpr double kHalfWidth_m{0.08};
  const DepthImage depth = box_before_wall(kHalfWidth_m);
  for (const EmitterSide side : {EmitterSide::left, EmitterSide::right}) {
    DepthFilterConfig config{.method = DepthFilterMethod::thesis};
    config.emitter_side = side;
    config.remove_veil_points = false;
    const FilteredDepth filtered = DepthFilter::create(kinect_v2(), config).value().filter(depth).value();
    const double emitter_x = side == EmitterSide::left ? -config.baseline_m : config.baseline_m;
    std::size_t unlit{0};
    std::size_t beside_emitter{0};
    for (int v = 0; v < depth.height(); ++v) {
      int differing{0};
      for (int u = 0; u < depth.width(); ++u) {
        const Eigen::Vector3d p = kinect_v2().ray(u, v) * static_cast<double>(depth(u, v));
        // Where the light to a point of the wall passes the plane of the box' front, and that of its back.
        const auto blocked_at = [&](double z) {
          const double x = emitter_x + (p.x() - emitter_x) * z / p.z();
          return p.z() > 2.0 && std::abs(x) < kHalfWidth_m && std::abs(p.y() * z / p.z()) < 0.1;
        };
        const bool is_unlit = blocked_at(1.0) || blocked_at(1.05);
        unlit += is_unlit ? 1U : 0U;
        const bool removed = filtered.pixels(u, v) == FilteredPixel::shadow_point;
        differing += is_unlit != removed ? 1 : 0;
        beside_emitter += removed && p.x() * emitter_x >= 0.0 ? 1U : 0U;
      }
      EXPECT_LE(differing, 2) << v;  // at the shadow's borders, where the box' edges lie between two pixels
    }
    EXPECT_GT(unlit, 1000U);
    EXPECT_EQ(beside_emitter, 0U);
    EXPECT_EQ(filtered.veil_points, 0U);
  }
}

TEST(KinectV2Filter, RemovesPointsAtEdgesAndBetweenThem) {
  DepthFilterConfig config{.method = DepthFilterMethod::thesis};
  config.remove_shadow_points = false;
  const DepthFilter filter = DepthFilter::create(kinect_v2(), config).value();
  DepthImage depth{512, 424, 2.0F};
  for (int u = 200; u < 300; ++u) depth(u, 100) = 1.0F;
  depth(199, 100) = 1.4F;  // interpolated
  const FilteredDepth filtered = filter.filter(depth).value();
  EXPECT_EQ(filtered.pixels(199, 100), FilteredPixel::veil_point);
  EXPECT_EQ(filtered.pixels(198, 100), FilteredPixel::veil_point);
  EXPECT_EQ(filtered.pixels(250, 100), FilteredPixel::veil_point);  // above it lies the background
  EXPECT_EQ(filtered.pixels(250, 99), FilteredPixel::veil_point);
  EXPECT_EQ(filtered.pixels(197, 100), FilteredPixel::kept);
  EXPECT_EQ(filtered.pixels(250, 98), FilteredPixel::kept);
  EXPECT_EQ(filtered.veil_points, 101U + 2U * 101U + 2U);
}

TEST(KinectV2Filter, KeepsWallsThatAreNotGrazed) {
  for (const double slope : {-1.0, 0.0, 1.0}) {
    AnalyticScene scene;
    scene.objects.push_back(
        {"wall", HalfSpace{Eigen::Vector3d{slope, 0.0, -1.0}.normalized(), -2.0 / std::sqrt(1.0 + slope * slope)}});
    const DepthImage depth = render(scene, kinect_v2(), Pose::Identity()).value().depth;
    const FilteredDepth filtered =
        DepthFilter::create(kinect_v2(), {.method = DepthFilterMethod::thesis}).value().filter(depth).value();
    EXPECT_GT(filtered.points, 30000U);
    EXPECT_EQ(filtered.kept(), filtered.points) << slope;
  }
}

TEST(KinectV2Filter, CanLeaveOutEitherStep) {
  const DepthImage depth = box_before_wall(0.08);
  DepthFilterConfig config{.method = DepthFilterMethod::thesis};
  const FilteredDepth both = DepthFilter::create(kinect_v2(), config).value().filter(depth).value();
  EXPECT_GT(both.shadow_points, 0U);
  EXPECT_GT(both.veil_points, 0U);
  config.remove_shadow_points = false;
  config.remove_veil_points = false;
  const FilteredDepth none = DepthFilter::create(kinect_v2(), config).value().filter(depth).value();
  EXPECT_EQ(none.depth, depth);
  EXPECT_EQ(none.kept(), none.points);
}

TEST(KinectV2Filter, IsTheSameForEveryThreadCountAndEveryImageBefore) {
  std::mt19937_64 random{3};
  const DepthFilter filter = DepthFilter::create(kinect_v2(), {.method = DepthFilterMethod::thesis}).value();
  const DepthImage depth = random_depth(kinect_v2(), random);
  const FilteredDepth once = filter.filter(depth).value();
  EXPECT_GT(once.shadow_points + once.veil_points, 1000U);
  for (const std::size_t threads : {2U, 3U, 8U}) {
    const Executor executor = Executor::with_threads(threads);
    ASSERT_TRUE(filter.filter(box_before_wall(0.02), executor));
    const FilteredDepth again = filter.filter(depth, executor).value();
    EXPECT_EQ(again.pixels, once.pixels);
    EXPECT_EQ(again.shadow_points, once.shadow_points);
    EXPECT_EQ(again.veil_points, once.veil_points);
  }
}

TEST(KinectV2Filter, TakesImagesWithNothingInThem) {
  const PinholeCamera one{1, 1, 100.0, 100.0, 0.0, 0.0, 0.5, 4.5};
  const DepthFilter filter = DepthFilter::create(one, {.method = DepthFilterMethod::thesis}).value();
  EXPECT_EQ(filter.filter(DepthImage{1, 1, 1.0F}).value().kept(), 1U);
  EXPECT_EQ(filter.filter(DepthImage{1, 1}).value().points, 0U);
  EXPECT_EQ(filter.filter(DepthImage{1, 1, -2.0F}).value().depth(0, 0), -2.0F);
}

TEST(KinectV2Filter, RefusesWhatMakesNoSense) {
  const auto with_baseline = [](double baseline_m) {
    return DepthFilterConfig{.baseline_m = baseline_m}.validate().ok();
  };
  EXPECT_TRUE(with_baseline(0.0));
  EXPECT_FALSE(with_baseline(-0.08));
  EXPECT_FALSE(with_baseline(8.0));
  EXPECT_FALSE(with_baseline(std::nan("")));
  const auto with_angle = [](double rad) { return DepthFilterConfig{.veil_angle_rad = rad}.validate().ok(); };
  EXPECT_FALSE(with_angle(0.0));
  EXPECT_FALSE(with_angle(kPi / 2.0));
  EXPECT_FALSE(with_angle(std::nan("")));
  PinholeCamera camera = kinect_v2();
  const auto filtered = DepthFilter::create(camera).value().filter(DepthImage{640, 480, 1.0F});
  ASSERT_FALSE(filtered);
  EXPECT_EQ(filtered.error().code, Errc::size_mismatch);
  EXPECT_NE(filtered.error().message.find("640x480"), std::string::npos);
  camera.fx = 0.0;
  EXPECT_FALSE(DepthFilter::create(camera));
}

}  // namespace
}  // namespace saccade
