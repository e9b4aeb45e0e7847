// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/rendered_sequence.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <set>

#include "saccade/core/clock.hpp"
#include "saccade/scene/internal/truth_labels.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr PinholeCamera kSmall{320, 240, 285.0, 285.0, 159.5, 119.5, 0.4, 3.5};

RenderedSequenceConfig exact() {
  RenderedSequenceConfig config;
  config.camera = kSmall;
  config.color.noise = false;
  config.pose_noise.reset();
  return config;
}

TEST(SurfelScenesEvidence, HaveManySegmentsThatTheCameraSees) {
  if (test::kSanitized) GTEST_SKIP() << "200 frames take long under sanitizers; the next tests cover the code";
  std::size_t scenes{0};
  for (const std::string_view name : kSurfelScenes) {
    const SurfelScene made = surfel_scene(name).value();
    auto sequence = RenderedSequence::create(RayScene::build(made.scene).value(), hand_held_poses(made.path, 40),
                                             exact(), Executor::with_threads(2))
                        .value();
    std::set<std::uint16_t> seen;
    const Stopwatch stopwatch;
    while (sequence.next().value()) {
      for (const std::uint16_t label : sequence.truth().label.pixels()) seen.insert(label);
    }
    std::printf("%s: %zu segments, %zu seen, %.1f ms per frame\n", std::string{name}.c_str(),
                sequence.segments().names().size() - 1, seen.size(), stopwatch.elapsed_ms() / 40.0);
    EXPECT_GE(sequence.segments().names().size(), 87U) << name;
    EXPECT_LE(sequence.segments().names().size(), 210U) << name;
    EXPECT_GE(100 * seen.size(), 95 * sequence.segments().names().size()) << name;
    EXPECT_GE(made.frames, 1000U) << name;
    EXPECT_TRUE(surfel_sensor(made.sensor)) << name;
    ++scenes;
  }
  EXPECT_EQ(scenes, 5U);
}

/// What is measured with the scenes means nothing once they have changed: docs/guides/surfel-scenes.md says when that
/// may be.
TEST(SurfelScenes, AreFrozen) {
  struct Counts {
    std::size_t objects{0};
    std::size_t patches{0};
    std::size_t segments{0};
    std::size_t light{0};  ///< sum of all channels
    bool operator==(const Counts&) const = default;
  };
  const auto counts_of = [](const Scene& scene) {
    Counts counts{scene.objects.size(), 0, SegmentTable{scene}.names().size() - 1, 0};
    const auto add = [&](const Rgb8& color) {
      for (const std::uint8_t channel : color) counts.light += channel;
    };
    for (const SceneObject& object : scene.objects) {
      add(object.color);
      counts.patches += object.patches.size();
      for (const Patch& patch : object.patches) add(patch.color);
    }
    return counts;
  };
  constexpr std::array<Counts, 5> kFrozen{{{70, 26, 90, 34981},
                                           {165, 42, 201, 74293},
                                           {173, 128, 165, 117129},
                                           {15, 125, 127, 59537},
                                           {13, 102, 103, 46763}}};
  for (std::size_t i = 0; i < kFrozen.size(); ++i) {
    EXPECT_EQ(counts_of(surfel_scene(kSurfelScenes[i]).value().scene), kFrozen[i]) << kSurfelScenes[i];
  }
}

TEST(SurfelScenes, TheirPathsAreFrozen) {
  const std::array<Vector3d, 5> third_of_the_way{{{0.0828990763, -0.861418781, 0.415225695},
                                                  {0.0828990763, -0.861418781, 0.810705765},
                                                  {-0.235659451, -0.831578563, 0.824323888},
                                                  {-0.0707826378, -0.3894561, 0.60753541},
                                                  {-0.144016937, -0.389696319, 0.609190905}}};
  for (std::size_t i = 0; i < third_of_the_way.size(); ++i) {
    const SurfelScene made = surfel_scene(kSurfelScenes[i]).value();
    const Pose T_world_camera = hand_held_poses(made.path, made.frames)[made.frames / 3];
    EXPECT_LT((T_world_camera.translation() - third_of_the_way[i]).norm(), 1e-6)
        << kSurfelScenes[i] << ": " << T_world_camera.translation().transpose().format(Eigen::IOFormat{9});
  }
}

TEST(SurfelScenes, TheirNoiseIsFrozen) {
  const RenderedSequenceConfig xtion = surfel_sensor("xtion").value();
  ASSERT_TRUE(xtion.depth_noise && xtion.pose_noise);
  EXPECT_FALSE(xtion.time_of_flight);
  EXPECT_EQ(xtion.camera, camera_preset("xtion").value());
  EXPECT_NEAR(xtion.depth_noise->sigma_m(1.0), 0.001884, 1e-9);
  EXPECT_EQ(xtion.depth_noise->disparity_step_per_m, 348.0);
  EXPECT_EQ(xtion.lateral_noise_px, 0.8);
  EXPECT_EQ(xtion.color.electrons_at_white, 4000.0);
  EXPECT_EQ(xtion.color.read_noise_electrons, 10.0);
  EXPECT_EQ(xtion.pose_noise->drift_m, 0.004);
  EXPECT_EQ(xtion.pose_noise->drift_rad, 0.003);
  EXPECT_EQ(xtion.pose_noise->drift_frames, 60.0);
  EXPECT_EQ(xtion.pose_noise->jitter_m, 0.0005);
  EXPECT_EQ(xtion.pose_noise->jitter_rad, 0.0005);
  const RenderedSequenceConfig kinect = surfel_sensor("kinect-v2").value();
  ASSERT_TRUE(kinect.time_of_flight && kinect.pose_noise);
  EXPECT_FALSE(kinect.depth_noise);
  EXPECT_EQ(kinect.camera, camera_preset("kinect-v2").value());
  EXPECT_EQ(kinect.time_of_flight->noise.sigma_m(1.0), 0.002);
  EXPECT_EQ(kinect.time_of_flight->baseline_m, 0.08);
  EXPECT_EQ(kinect.color.target_light, 0.25);
  EXPECT_EQ(kinect.color.time_constant_frames, 15.0);
  EXPECT_EQ(kinect.color.max_gain, 2.0);
}

TEST(SurfelScenes, PixelsAndTheNearestSurfaceHaveTheSameLabels) {
  if (test::kSanitized) GTEST_SKIP() << "five scenes take long under sanitizers; others make them";
  for (const std::string_view name : kSurfelScenes) {
    const SurfelScene made = surfel_scene(name).value();
    const RayScene rays = RayScene::build(made.scene).value();
    const TruthLabels truth = TruthLabels::build(rays).value();
    auto sequence = RenderedSequence::create(rays, hand_held_poses(made.path, 5), exact()).value();
    EXPECT_EQ(sequence.segments().names(), truth.names());
    std::size_t compared{0};
    std::size_t same{0};
    while (sequence.next().value()) {
      const SequenceTruth& seen = sequence.truth();
      for (int v = 0; v < kSmall.height; v += 3) {
        for (int u = 0; u < kSmall.width; u += 3) {
          if (!(seen.depth(u, v) > 0.0F)) continue;
          const Vector3d p_camera = kSmall.ray(u, v) * static_cast<double>(seen.depth(u, v));
          same += truth.label(seen.T_world_camera * p_camera) == seen.label(u, v) ? 1 : 0;
          ++compared;
        }
      }
    }
    EXPECT_GT(compared, 20000U) << name;
    EXPECT_GT(static_cast<double>(same), 0.998 * static_cast<double>(compared)) << name;
  }
}

TEST(SurfelScenes, SaysWhatItKnows) {
  EXPECT_EQ(surfel_scene("atrium").error().message,
            "no such scene for surfels; there are workshop-1, workshop-2, desk, magazines-1, magazines-2");
  EXPECT_EQ(surfel_sensor("lidar").error().message, "no such sensor; there are xtion, kinect-v2");
}

}  // namespace
}  // namespace saccade
