// SPDX-License-Identifier: Apache-2.0
// A box before a wall, whose shadows are known, and the depth filter on what the camera measures of them.
#include "saccade/scene/simulated_camera.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr double kWall_m{2.5};  // along the camera's axis
constexpr double kBox_m{1.0};   // its front
constexpr double kHalfWidth_m{0.08};
constexpr double kHalfHeight_m{0.15};

const PinholeCamera& kinect_v2() {
  static const PinholeCamera camera = camera_preset("kinect-v2").value();
  return camera;
}

/// The camera looks along world x; its x axis points along −y, its y axis down.
Pose camera_pose() { return look_at({0.0, 0.0, 1.0}, {1.0, 0.0, 1.0}, Vector3d::UnitZ()); }

RayScene box_before_wall() {
  const auto box = [](const std::string& name, const Vector3d& size_m, double front_m) {
    SceneObject object;
    object.name = name;
    object.shape = BoxShape{size_m};
    object.T_world_object = Pose{Eigen::Translation3d{front_m + 0.5 * size_m.x(), 0.0, 1.0 - 0.5 * size_m.z()}};
    return object;
  };
  Scene scene;
  scene.name = "box before a wall";
  scene.objects = {box("wall", {0.1, 20.0, 20.0}, kWall_m),
                   box("box", {0.02, 2.0 * kHalfWidth_m, 2.0 * kHalfHeight_m}, kBox_m)};
  scene.workspace = Box{Vector3d{-1.0, -2.0, -1.0}, Vector3d{3.0, 2.0, 3.0}};
  return RayScene::build(scene).value();
}

TEST(TimeOfFlight, KnowsWhatTheEmitterLights) {
  for (const EmitterSide side : {EmitterSide::left, EmitterSide::right}) {
    TimeOfFlightConfig config;
    config.emitter_side = side;
    const double emitter_x = side == EmitterSide::left ? -config.baseline_m : config.baseline_m;
    const TimeOfFlightFrame frame =
        capture_time_of_flight(box_before_wall(), kinect_v2(), config, camera_pose()).value();
    std::size_t in_shadow{0};
    for (int v = 0; v < frame.exact.height(); ++v) {
      int differing{0};
      for (int u = 0; u < frame.exact.width(); ++u) {
        const Vector3d p = kinect_v2().ray(u, v) * static_cast<double>(frame.exact(u, v));
        const auto blocked_at = [&](double z) {
          const double x = emitter_x + (p.x() - emitter_x) * z / p.z();
          return p.z() > 2.0 && std::abs(x) < kHalfWidth_m && std::abs(p.y() * z / p.z()) < kHalfHeight_m;
        };
        const bool is_unlit = blocked_at(kBox_m) || blocked_at(kBox_m + 0.02);
        const MeasuredPixel truth = frame.truth(u, v);
        ASSERT_NE(truth, MeasuredPixel::no_return);
        if (truth == MeasuredPixel::veil) continue;
        differing += is_unlit != (truth == MeasuredPixel::in_shadow) ? 1 : 0;
        in_shadow += is_unlit ? 1U : 0U;
      }
      EXPECT_LE(differing, 1) << v;
    }
    EXPECT_GT(in_shadow, 1000U);
  }
}

TEST(TimeOfFlight, MeasuresEachKindOfPixelAsStated) {
  TimeOfFlightConfig config;
  const TimeOfFlightFrame frame = capture_time_of_flight(box_before_wall(), kinect_v2(), config, camera_pose()).value();
  double good_squares{0.0};
  double shadow_sum{0.0};
  double shadow_squares{0.0};
  std::size_t good{0};
  std::size_t in_shadow{0};
  std::size_t veil{0};
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    const double error_m = static_cast<double>(frame.depth.pixels()[i]) - frame.exact.pixels()[i];
    switch (frame.truth.pixels()[i]) {
      case MeasuredPixel::no_return: break;
      case MeasuredPixel::good:
        good_squares += std::abs(error_m) < 0.02 ? error_m * error_m : 0.0;
        ++good;
        break;
      case MeasuredPixel::in_shadow:
        shadow_sum += error_m;
        shadow_squares += (error_m - config.shadow_bias_m) * (error_m - config.shadow_bias_m);
        ++in_shadow;
        break;
      case MeasuredPixel::veil:
        EXPECT_GT(frame.depth.pixels()[i], kBox_m);
        EXPECT_LT(frame.depth.pixels()[i], kWall_m);
        ++veil;
        break;
    }
  }
  EXPECT_NEAR(std::sqrt(good_squares / static_cast<double>(good)), config.noise.base_m, 0.1 * config.noise.base_m);
  EXPECT_NEAR(shadow_sum / static_cast<double>(in_shadow), config.shadow_bias_m, 0.02);
  EXPECT_NEAR(std::sqrt(shadow_squares / static_cast<double>(in_shadow)), config.shadow_sigma_m, 0.02);
  EXPECT_GT(veil, 50U);
  EXPECT_LT(veil, 2000U);
}

TEST(TimeOfFlight, ShowsTheFilterWhatToRemove) {
  const TimeOfFlightConfig config;
  const TimeOfFlightFrame frame = capture_time_of_flight(box_before_wall(), kinect_v2(), config, camera_pose()).value();
  const FilteredDepth filtered = DepthFilter::create(kinect_v2()).value().filter(frame.depth).value();
  std::size_t wrong{0};
  std::size_t wrong_kept{0};
  std::size_t good{0};
  std::size_t good_removed{0};
  for (std::size_t i = 0; i < frame.truth.size(); ++i) {
    const bool kept = filtered.pixels.pixels()[i] == FilteredPixel::kept;
    const bool is_good = frame.truth.pixels()[i] == MeasuredPixel::good;
    ++(is_good ? good : wrong);
    wrong_kept += !is_good && kept ? 1U : 0U;
    good_removed += is_good && !kept ? 1U : 0U;
  }
  EXPECT_GT(wrong, 1000U);
  EXPECT_LT(wrong_kept, wrong / 20U);
  EXPECT_LT(good_removed, good / 50U);
}

TEST(TimeOfFlight, FramesOfASeedAreTheSameForEveryThreadCount) {
  TimeOfFlightConfig config;
  const RayScene scene = box_before_wall();
  const TimeOfFlightFrame once = capture_time_of_flight(scene, kinect_v2(), config, camera_pose(), 3).value();
  const TimeOfFlightFrame again =
      capture_time_of_flight(scene, kinect_v2(), config, camera_pose(), 3, Executor::with_threads(3)).value();
  EXPECT_EQ(again.depth, once.depth);
  EXPECT_EQ(again.truth, once.truth);
  EXPECT_NE(capture_time_of_flight(scene, kinect_v2(), config, camera_pose(), 4).value().depth, once.depth);
}

TEST(TimeOfFlight, RefusesWhatMakesNoSense) {
  const auto refuses = [](const auto& change) {
    TimeOfFlightConfig config;
    change(config);
    return !capture_time_of_flight(box_before_wall(), kinect_v2(), config, camera_pose()).ok();
  };
  EXPECT_TRUE(refuses([](TimeOfFlightConfig& c) { c.baseline_m = -0.08; }));
  EXPECT_TRUE(refuses([](TimeOfFlightConfig& c) { c.footprint_px = 0.0; }));
  EXPECT_TRUE(refuses([](TimeOfFlightConfig& c) { c.footprint_samples = 1; }));
  EXPECT_TRUE(refuses([](TimeOfFlightConfig& c) { c.shadow_sigma_m = std::nan(""); }));
  EXPECT_TRUE(refuses([](TimeOfFlightConfig& c) { c.shadow_bias_m = -1.0; }));
}

}  // namespace
}  // namespace saccade
