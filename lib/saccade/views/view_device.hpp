// SPDX-License-Identifier: Apache-2.0
#pragma once
// ViewDevice: the seam to a device that evaluates views and computes parts of the expected surface, such as a GPU.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/core/pose.hpp"
#include "saccade/core/region.hpp"
#include "saccade/core/result.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/views/view_gain.hpp"

namespace saccade {

struct ExposedVoxel;
struct ExposureTask;

/// Line from the centre of a voxel to a camera.
struct LineOfSight {
  std::uint32_t voxel{0};   ///< index into ExpectedSurface::volume
  std::uint32_t camera{0};  ///< index into the cameras of the call
};

/// Device beside the CPU. What it returns equals the CPU's to the bit. One caller at a time. After an error of the
/// device the CPU does the work: every caller goes on without the device for that call.
class ViewDevice {
 public:
  virtual ~ViewDevice() = default;
  /// Makes a map the one that read_states is about. Parts that did not change since the last call are not sent
  /// again. O(bricks that changed).
  [[nodiscard]] virtual Status follow(const TsdfSnapshot& map, const Executor& executor) = 0;
  /// Computes the gains of saccade::evaluate_views, and follows the map. Answers unsupported for what it does not
  /// compute, before anything is sent. O(bricks that changed + rays that meet the region · bricks along them).
  [[nodiscard]] virtual Result<GainResult> evaluate_views_of(const TsdfSnapshot& map, const Region& region,
                                                             std::span<const Pose> T_world_camera,
                                                             const GainConfig& config, const Executor& executor) = 0;
  /// Writes the states of the voxels of a box, x fastest, and keeps them until the next call.
  /// @return a ticket, never 0, for the calls below: they refuse any but the last one with invalid_argument. O(voxels).
  [[nodiscard]] virtual Result<std::uint64_t> read_states(const IndexBox& box, std::span<VoxelState> states) = 0;
  /// Finds the exposed voxels of that box, except those at its border, by increasing index. The task's pointers are
  /// those of the host. O(voxels).
  [[nodiscard]] virtual Result<std::vector<ExposedVoxel>> exposed(std::uint64_t ticket, const ExposureTask& task) = 0;
  /// Tells for each line whether it is a line of sight, as StateVolume::is_visible: 1, or 0.
  /// O(lines · voxels along them).
  [[nodiscard]] virtual Result<std::vector<std::uint8_t>> in_sight(std::uint64_t ticket,
                                                                   std::span<const LineOfSight> lines,
                                                                   std::span<const Eigen::Vector3d> cameras_m,
                                                                   double through_m) = 0;
  /// Returns the last error after which the CPU had to go on, and forgets it; nullopt: there was none since the last
  /// call. A device that is lost says so once.
  [[nodiscard]] virtual std::optional<Error> take_problem() { return std::nullopt; }
};

}  // namespace saccade
