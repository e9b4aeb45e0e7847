// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/simulated_camera.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace saccade {

DepthNoise kinect_v1_noise(std::uint64_t seed) {
  DepthNoise noise;
  noise.disparity_step_per_m = 348.0;
  noise.grazing_from_rad = 70.0 * std::numbers::pi / 180.0;
  noise.seed = seed;
  return noise;
}

Status SimulatedCameraConfig::validate() const {
  SACCADE_CHECK(camera.validate());
  if (!std::isfinite(reach_m)) return Error{Errc::invalid_argument, "the reach must be finite", "simulated camera"};
  return noise ? noise->validate() : Status{};
}

Result<SimulatedCamera> SimulatedCamera::create(RayScene scene, const SimulatedCameraConfig& config) {
  SACCADE_CHECK(config.validate());
  return SimulatedCamera{std::move(scene), config};
}

Frame SimulatedCamera::capture(const Pose& T_world_camera, const Executor& executor) {
  PinholeCamera far_sighted = config_.camera;
  far_sighted.max_range_m = std::max(config_.reach_m, config_.camera.max_range_m);
  ExactFrame exact = scene_.render(far_sighted, T_world_camera, executor);
  Frame frame;
  frame.index = frames_;
  frame.name = "frame " + std::to_string(frames_);
  frame.T_world_camera = T_world_camera;
  frame.color = std::move(exact.color);
  frame.depth = config_.noise ? with_noise(exact.depth, *config_.noise, frames_, &exact.incidence_cosine)
                              : std::move(exact.depth);
  const auto max_range_m = static_cast<float>(config_.camera.max_range_m);
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    float& z = frame.depth.data()[i];
    if (z > max_range_m) z = -max_range_m;
  }
  ++frames_;
  return frame;
}

}  // namespace saccade
