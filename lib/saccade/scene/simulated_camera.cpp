// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/simulated_camera.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/core/angle.hpp"

namespace saccade {
namespace {

constexpr double kNearest_m{1e-4};
constexpr Rgb8 kBeforeColor{70, 72, 76};

/// Returns the camera with a range that reaches as far as returns show free space.
PinholeCamera far_sighted(const SimulatedCameraConfig& config) {
  PinholeCamera camera = config.camera;
  camera.max_range_m = std::max(config.reach_m, config.camera.max_range_m);
  return camera;
}

}  // namespace

DepthNoise kinect_v1_noise(std::uint64_t seed) {
  DepthNoise noise;
  noise.disparity_step_per_m = 348.0;
  noise.grazing_from_rad = 70_deg;
  noise.seed = seed;
  return noise;
}

Status SimulatedCameraConfig::validate() const {
  SACCADE_CHECK(camera.validate());
  if (!std::isfinite(reach_m)) return Error{Errc::invalid_argument, "the reach must be finite", "simulated camera"};
  if (depth_filter) SACCADE_CHECK(depth_filter->validate());
  if (time_of_flight) return time_of_flight->validate();
  return noise ? noise->validate() : Status{};
}

Result<SimulatedCamera> SimulatedCamera::create(RayScene scene, const SimulatedCameraConfig& config) {
  SACCADE_CHECK(config.validate());
  std::shared_ptr<const DepthFilter> filter;
  if (config.depth_filter) {
    SACCADE_TRY(DepthFilter created, DepthFilter::create(config.camera, *config.depth_filter));
    filter = std::make_shared<const DepthFilter>(std::move(created));
  }
  return SimulatedCamera{std::move(scene), config, std::move(filter)};
}

Frame SimulatedCamera::capture(const Pose& T_world_camera, const Executor& executor) {
  return frame_of(scene_.render(far_sighted(config_), T_world_camera, executor), T_world_camera, nullptr, executor);
}

Frame SimulatedCamera::capture(const Pose& T_world_camera, const DepthImage& before, const Executor& executor) {
  SACCADE_EXPECTS(before.width() == config_.camera.width && before.height() == config_.camera.height);
  PinholeCamera all_seeing = far_sighted(config_);
  all_seeing.min_range_m = kNearest_m;  // objects too near to be measured still hide others
  ExactFrame exact = scene_.render(all_seeing, T_world_camera, executor);
  const auto min_range_m = static_cast<float>(config_.camera.min_range_m);
  for (std::size_t i = 0; i < before.size(); ++i) {
    float& z = exact.depth.data()[i];
    const float z_before = before.data()[i];
    if (z_before > 0.0F && !(z > 0.0F && z <= z_before)) {
      z = z_before;
      exact.color.data()[i] = kBeforeColor;
      exact.incidence_cosine.data()[i] = 1.0F;
    }
    if (z < min_range_m) {
      z = 0.0F;
      exact.color.data()[i] = {};
    }
  }
  return frame_of(std::move(exact), T_world_camera, &before, executor);
}

DepthImage SimulatedCamera::measured(ExactFrame& exact, const Pose& T_world_camera, const DepthImage* before,
                                     const Executor& executor) {
  if (config_.time_of_flight) {
    TimeOfFlightFrame frame = measure_time_of_flight(scene_, far_sighted(config_), *config_.time_of_flight,
                                                     T_world_camera, std::move(exact.depth), before, frames_, executor);
    truth_ = std::move(frame.truth);
    return std::move(frame.depth);
  }
  return config_.noise ? with_noise(exact.depth, *config_.noise, frames_, &exact.incidence_cosine, executor)
                       : std::move(exact.depth);
}

Frame SimulatedCamera::frame_of(ExactFrame exact, const Pose& T_world_camera, const DepthImage* before,
                                const Executor& executor) {
  Frame frame;
  frame.index = frames_;
  frame.name = "frame " + std::to_string(frames_);
  frame.T_world_camera = T_world_camera;
  frame.depth = measured(exact, T_world_camera, before, executor);
  frame.color = std::move(exact.color);
  const auto max_range_m = static_cast<float>(config_.camera.max_range_m);
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    float& z = frame.depth.data()[i];
    if (z <= max_range_m) continue;
    z = -max_range_m;
    if (!truth_.empty()) truth_.data()[i] = MeasuredPixel::no_return;
  }
  if (filter_) frame.depth = filter_->filter(frame.depth, executor).value().depth;
  ++frames_;
  return frame;
}

}  // namespace saccade
