// SPDX-License-Identifier: Apache-2.0
#include "saccade/explore/look.hpp"

#include <cmath>

namespace saccade {
Pose tilted(const Pose& T_world_view, double tilt_rad) {
  return T_world_view * Eigen::AngleAxisd{tilt_rad, Eigen::Vector3d::UnitX()};
}

double oscillation_rad(const ExplorationConfig& config) {
  return config.oscillation_frames > 1 ? config.oscillation_rad : 0.0;
}

std::vector<double> tilts_towards(double farthest_rad) {
  constexpr int kHalvings{3};
  std::vector<double> tilts_rad;
  for (int i = 0; farthest_rad != 0.0 && i <= kHalvings; ++i) tilts_rad.push_back(std::ldexp(farthest_rad, -i));
  return tilts_rad;
}

namespace {

/// How far the robot can tilt the camera at a view, of the tilts that are tried; 0: not at all.
Result<double> farthest_tilt_rad(Robot& robot, const Pose& T_world_view, double wanted_rad) {
  for (const double tilt_rad : tilts_towards(wanted_rad)) {
    const Pose pose = tilted(T_world_view, tilt_rad);
    SACCADE_TRY(const PlannedMotion planned, robot.plan(std::span{&pose, 1}, Way::straight));
    if (planned.motion) return tilt_rad;
  }
  return 0.0;
}

}  // namespace

Status fuse_frame(TsdfMap& map, ExplorationCell& cell, const Pose& T_world_camera, const Executor& executor) {
  SACCADE_TRY(const Frame frame, cell.observe(T_world_camera));
  const ColorImage* color = frame.color ? &*frame.color : nullptr;
  SACCADE_TRY([[maybe_unused]] const FusionStats stats,
              map.integrate(cell.camera, frame.depth, frame.T_world_camera.value_or(T_world_camera), executor, color));
  return {};
}

Result<Look> look(TsdfMap& map, ExplorationCell& cell, const Pose& T_world_view, const ExplorationConfig& config,
                  const Executor& executor) {
  Look seen;
  SACCADE_TRY(seen.tilt.least_rad, farthest_tilt_rad(cell.robot, T_world_view, -oscillation_rad(config)));
  SACCADE_TRY(seen.tilt.greatest_rad, farthest_tilt_rad(cell.robot, T_world_view, oscillation_rad(config)));
  const double middle_rad = 0.5 * (seen.tilt.least_rad + seen.tilt.greatest_rad);
  const double half_rad = 0.5 * (seen.tilt.greatest_rad - seen.tilt.least_rad);
  for (int i = 0; i < config.oscillation_frames; ++i) {
    const double share = config.oscillation_frames > 1 ? 2.0 * i / (config.oscillation_frames - 1) - 1.0 : 0.0;
    const Pose wanted = tilted(T_world_view, middle_rad + share * half_rad);
    SACCADE_TRY(const PlannedMotion planned, cell.robot.plan(std::span{&wanted, 1}, Way::straight));
    if (!planned.motion) continue;
    SACCADE_TRY(const std::optional<Arrival> arrival, cell.robot.execute(*planned.motion));
    if (!arrival) continue;
    seen.motion_s += arrival->motion_s;
    SACCADE_CHECK(fuse_frame(map, cell, arrival->T_world_camera, executor));
    ++seen.frames;
  }
  return seen;
}

}  // namespace saccade
