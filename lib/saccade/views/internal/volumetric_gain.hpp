// SPDX-License-Identifier: Apache-2.0
#pragma once
// VolumetricGain: the result of volumetric_gain.

#include "saccade/views/internal/baseline_scene.hpp"

namespace saccade {

/// Distance d_max of the proximity count, beyond which voxels count as equally far from an occupied one.
constexpr double kProximity_m{0.1};
constexpr int kCoarser{3};
constexpr std::size_t kFineViews{512};

class VolumetricGain final : public Gain {
 public:
  /// Expects a valid configuration.
  VolumetricGain(VolumetricInformation information, const BaselineGainConfig& config);
  [[nodiscard]] Result<std::vector<double>> evaluate(const PlanningContext& context, const RegionOfInterest& region,
                                                     std::span<const Pose> T_world_camera) override;
  /// Evaluates all poses with the kCoarser-th part of the columns and rows, and the best of them with all: the
  /// attempted ones, and kFineViews or four times `count`.
  [[nodiscard]] Result<RankedViews> best(const PlanningContext& context, const RegionOfInterest& region,
                                         std::span<const Pose> T_world_camera, std::size_t count) override;

 private:
  [[nodiscard]] Result<std::vector<double>> evaluate_with(const PinholeCamera& camera, const PlanningContext& context,
                                                          const RegionOfInterest& region,
                                                          std::span<const Pose> T_world_camera) const;

  VolumetricInformation information_;
  BaselineGainConfig config_;
};

/// Returns approximate distances to the nearest occupied voxel in voxels, to within a few per cent, at most
/// `beyond_vox`; per voxel of `box`, x fastest. O(voxels).
[[nodiscard]] std::vector<float> distance_to_occupied(const StateVolume& volume, const IndexBox& box, float beyond_vox);

}  // namespace saccade
