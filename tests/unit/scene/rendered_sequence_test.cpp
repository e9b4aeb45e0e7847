// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/rendered_sequence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr PinholeCamera kCamera{160, 120, 142.5, 142.5, 79.5, 59.5, 0.3, 3.5};

/// A wide plate of one colour, with a patch in the middle.
RayScene plate(std::uint8_t grey) {
  Scene scene;
  scene.name = "plate";
  scene.workspace = Box{Vector3d::Constant(-1.0), Vector3d::Constant(1.0)};
  SceneObject object;
  object.name = "plate";
  object.shape = BoxShape{{8.0, 8.0, 0.1}};
  object.color = {grey, grey, grey};
  Patch patch;
  patch.size_m = {0.2, 0.2};
  patch.color = {200, 30, 30};
  patch.segment = "patch";
  object.patches = {patch};
  scene.objects = {object};
  return RayScene::build(scene).value();
}

std::vector<Pose> above(std::size_t frames) {
  return std::vector<Pose>(frames, look_at({0.0, 0.001, 1.1}, {0.0, 0.001, 0.0}, Vector3d::UnitY()));
}

RenderedSequenceConfig quiet() {
  RenderedSequenceConfig config;
  config.camera = kCamera;
  config.color.noise = false;
  config.color.vignetting = Vignetting::off;
  config.pose_noise.reset();
  return config;
}

std::vector<Frame> frames_of(const RenderedSequenceConfig& config, std::size_t count, std::uint8_t grey = 150,
                             std::size_t threads = 1) {
  auto sequence = RenderedSequence::create(plate(grey), above(count), config, Executor::with_threads(threads)).value();
  std::vector<Frame> frames;
  while (auto frame = sequence.next().value()) frames.push_back(std::move(*frame));
  return frames;
}

TEST(RenderedSequence, LabelsAndColoursAgreeWithTheGeometry) {
  auto sequence = RenderedSequence::create(plate(150), above(1), quiet()).value();
  const Frame frame = sequence.next().value().value();
  std::size_t in_patch{0};
  for (int v = 0; v < kCamera.height; ++v) {
    for (int u = 0; u < kCamera.width; ++u) {
      const Vector3d p = sequence.truth().T_world_camera * Vector3d{kCamera.ray(u, v)};
      const bool patch = std::max(std::abs(p.x()), std::abs(p.y())) <= 0.1;
      EXPECT_EQ(sequence.segments().names()[sequence.truth().label(u, v)], patch ? "patch" : "plate");
      EXPECT_NEAR(frame.depth(u, v), 1.0, 1e-5);
      in_patch += patch ? 1 : 0;
    }
  }
  EXPECT_GT(in_patch, 500U);
  EXPECT_FALSE(sequence.next().value());
}

TEST(RenderedSequence, NoThreadChangesAPixel) {
  RenderedSequenceConfig config = quiet();
  config.color.noise = true;
  config.color.automatic_gain = true;
  config.depth_noise = DepthNoise{};
  config.lateral_noise_px = 0.8;
  config.pose_noise = PoseNoise{};
  const std::vector<Frame> one = frames_of(config, 3);
  const std::vector<Frame> seven = frames_of(config, 3, 150, 7);
  ASSERT_EQ(one.size(), 3U);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].depth, seven[i].depth);
    EXPECT_EQ(*one[i].color, *seven[i].color);
    EXPECT_EQ(one[i].T_world_camera->matrix(), seven[i].T_world_camera->matrix());
  }
  EXPECT_NE(one[0].depth, one[1].depth);
}

TEST(RenderedSequence, VignettingDarkensTheCornersAndItsCorrectionDoesNot) {
  RenderedSequenceConfig config = quiet();
  const auto light_at = [](const Frame& frame, int u, int v) {
    return linear_of_srgb((*frame.color)(u, v)[1] / 255.0);
  };
  config.color.vignetting = Vignetting::on;
  const Frame on = frames_of(config, 1).front();
  config.color.vignetting = Vignetting::corrected;
  const Frame corrected = frames_of(config, 1).front();
  const Frame off = frames_of(quiet(), 1).front();
  EXPECT_NEAR(vignetting_at(kCamera, 0, 0), 0.43, 0.03);
  EXPECT_NEAR(light_at(on, 0, 0) / light_at(off, 0, 0), vignetting_at(kCamera, 0, 0), 0.02);
  EXPECT_EQ(*corrected.color, *off.color);
}

TEST(RenderedSequence, ColourNoiseHasItsSigma) {
  RenderedSequenceConfig config = quiet();
  config.color.noise = true;
  const Frame noisy = frames_of(config, 1).front();
  const Frame exact = frames_of(quiet(), 1).front();
  double squares = 0.0;  // squared errors in multiples of the standard deviation at the pixel's light
  std::size_t count = 0;
  for (int v = 0; v < 30; ++v) {
    for (int u = 0; u < kCamera.width; ++u) {
      const double light = linear_of_srgb((*exact.color)(u, v)[1] / 255.0);
      const double sigma = std::sqrt(light * 4000.0 + 100.0) / 4000.0;
      squares += std::pow((linear_of_srgb((*noisy.color)(u, v)[1] / 255.0) - light) / sigma, 2.0);
      ++count;
    }
  }
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(count)), 1.0, 0.06);
}

double mean_light_of(const Frame& frame) {
  double sum = 0.0;
  for (const Rgb8& color : frame.color->pixels()) {
    for (const std::uint8_t channel : color) sum += linear_of_srgb(channel / 255.0);
  }
  return sum / (3.0 * static_cast<double>(frame.color->size()));
}

TEST(RenderedSequence, AutomaticGainEvensOutHowLightThingsAre) {
  RenderedSequenceConfig config = quiet();
  const double dark = mean_light_of(frames_of(config, 1, 110).front());
  const double light = mean_light_of(frames_of(config, 1, 170).front());
  EXPECT_GT(light, 2.0 * dark);
  config.color.automatic_gain = true;
  EXPECT_NEAR(mean_light_of(frames_of(config, 1, 110).front()), config.color.target_light, 0.005);
  EXPECT_NEAR(mean_light_of(frames_of(config, 1, 170).front()), config.color.target_light, 0.005);
}

TEST(RenderedSequence, DepthNoiseHasItsSigma) {
  RenderedSequenceConfig config = quiet();
  config.depth_noise = DepthNoise{};
  const auto deviation = [&] {
    const Frame frame = frames_of(config, 1).front();
    double squares = 0.0;
    for (const float depth : frame.depth.pixels()) squares += (depth - 1.0) * (depth - 1.0);
    return std::sqrt(squares / static_cast<double>(frame.depth.size()));
  };
  EXPECT_NEAR(deviation() / config.depth_noise->sigma_m(1.0), 1.0, 0.03);
  config.lateral_noise_px = 0.8;  // on a plate before the camera, nothing changes
  EXPECT_NEAR(deviation() / config.depth_noise->sigma_m(1.0), 1.0, 0.03);
  config.depth_noise.reset();
  config.time_of_flight = TimeOfFlightConfig{};
  EXPECT_NEAR(deviation() / config.time_of_flight->noise.sigma_m(1.0), 1.0, 0.03);
  config.time_of_flight.reset();
  EXPECT_LT(deviation(), 1e-6);
}

TEST(RenderedSequence, LateralNoiseFraysEdges) {
  Scene scene = plate(150).scene();
  SceneObject post;
  post.name = "post";
  post.shape = BoxShape{{0.1, 0.1, 0.3}};
  scene.objects.push_back(post);
  const RayScene rays = RayScene::build(scene).value();
  RenderedSequenceConfig config = quiet();
  config.depth_noise = DepthNoise{0.0, 0.0, 0.0};
  const auto changed = [&](double lateral_noise_px) {
    config.lateral_noise_px = lateral_noise_px;
    auto sequence = RenderedSequence::create(rays, above(1), config).value();
    const Frame frame = sequence.next().value().value();
    std::size_t count{0};
    for (std::size_t i = 0; i < frame.depth.size(); ++i) {
      count += std::abs(frame.depth.data()[i] - sequence.truth().depth.data()[i]) > 0.1 ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(changed(0.0), 0U);
  const std::size_t outline_px{4 * 17};  // 0.1 m at 0.8 m
  EXPECT_GT(changed(0.8), outline_px / 4);
  EXPECT_LT(changed(0.8), 2 * outline_px);
}

TEST(RenderedSequence, AutomaticGainMovesTheMeanToItsTarget) {
  ColorCameraConfig config;
  config.automatic_gain = true;
  double gain = 1.0;
  for (int i = 0; i < 200; ++i) gain = next_gain(config, gain, 0.2);
  EXPECT_NEAR(gain, config.target_light / 0.2, 1e-4);
  for (int i = 0; i < 200; ++i) gain = next_gain(config, gain, 0.01);
  EXPECT_NEAR(gain, config.max_gain, 1e-4);
  config.automatic_gain = false;
  EXPECT_EQ(next_gain(config, 1.7, 0.01), 1.0);
}

TEST(RenderedSequence, PoseNoiseHasItsSigma) {
  const std::vector<Pose> exact(20000, Pose::Identity());
  PoseNoise noise;
  noise.drift_frames = 7.0;
  noise.jitter_m = 0.0;
  double squares = 0.0;
  for (const Pose& T : with_noise(exact, noise)) squares += T.translation().squaredNorm() / 3.0;
  EXPECT_NEAR(std::sqrt(squares / 20000.0) / noise.drift_m, 1.0, 0.05);
}

TEST(RenderedSequence, RefusesBadOptions) {
  RenderedSequenceConfig config = quiet();
  config.lateral_noise_px = -1.0;
  EXPECT_FALSE(RenderedSequence::create(plate(150), above(1), config));
  config = quiet();
  config.color.max_gain = 0.5;
  EXPECT_FALSE(RenderedSequence::create(plate(150), above(1), config));
  EXPECT_FALSE(RenderedSequence::create(plate(150), {}, quiet()));
}

}  // namespace
}  // namespace saccade
