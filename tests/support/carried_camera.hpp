// SPDX-License-Identifier: Apache-2.0
#pragma once
// CarriedCamera: frames of a place_scene, in memory, with their true poses and with poses that drift.

#include <string>
#include <vector>

#include "saccade/core/angle.hpp"
#include "saccade/scene/place_scenes.hpp"
#include "saccade/scene/rendered_sequence.hpp"

namespace saccade::tests {

struct CarriedCamera {
  PinholeCamera camera;
  std::vector<Frame> frames;
  std::vector<Pose> T_world_true;
  std::vector<Pose> T_world_drifted;  ///< every step goes wrong in the same way

  /// @param drift_m, drift_rad of the whole way, downwards and about the vertical
  CarriedCamera(const std::string& scene, std::size_t count, double drift_m, double drift_rad) {
    const PlaceScene place = place_scene(scene).value();
    RenderedSequenceConfig config = surfel_sensor("xtion").value();
    config.camera = config.camera.scaled_to(160, 120);
    config.pose_noise.reset();
    config.color.noise = false;
    T_world_true = carried_poses(place.path, count);
    camera = config.camera;
    auto sequence =
        RenderedSequence::create(RayScene::build(place.scene).value(), T_world_true, config, Executor::with_threads(0))
            .value();
    while (auto frame = sequence.next().value()) frames.push_back(std::move(*frame));
    Pose T_drift{Pose::Identity()};
    T_drift.translation().y() = drift_m / static_cast<double>(count);
    T_drift.rotate(Eigen::AngleAxisd{drift_rad / static_cast<double>(count), Eigen::Vector3d::UnitY()});
    for (std::size_t i = 0; i < count; ++i) {
      T_world_drifted.push_back(i == 0 ? T_world_true[0]
                                       : T_world_drifted[i - 1] * (T_world_true[i - 1].inverse() * T_world_true[i]) *
                                             T_drift);
    }
  }

  [[nodiscard]] double end_error_m(const std::vector<Pose>& T_world_camera) const {
    return (T_world_camera.back().translation() - T_world_true.back().translation()).norm();
  }
};

}  // namespace saccade::tests
