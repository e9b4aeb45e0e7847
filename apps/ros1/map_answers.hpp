// SPDX-License-Identifier: Apache-2.0
#pragma once
// Answers to requests, from a snapshot of the map. C++20.

#include <atomic>

#include "kinfu_types.hpp"
#include "saccade/core/executor.hpp"
#include "saccade/core/region.hpp"
#include "saccade/map/tsdf_map.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade::ros1 {

/// Data for an answer.
struct Source {
  const TsdfSnapshot& map;
  std::optional<PinholeCamera> sensor;  ///< the camera that took the last frame
  double max_range_m{0.0};
  const std::atomic<bool>& cancelled;
  Executor executor;

  [[nodiscard]] Status go_on() const {
    return cancelled ? Status{Error{Errc::cancelled, "the request was cancelled", {}}} : Status{};
  }
};

/// Filter of voxels and points: inside the box and the sphere, where given.
struct Filter {
  std::optional<Box> box;
  std::optional<Sphere> sphere;

  explicit Filter(const MapRequest& request);
  [[nodiscard]] bool any() const { return box || sphere; }
  [[nodiscard]] bool operator()(const Eigen::Vector3d& p) const {
    return (!box || contains(*box, p)) && (!sphere || contains(*sphere, p));
  }
  /// Returns the voxels of a box whose centre the filter may contain.
  [[nodiscard]] IndexBox voxels(const IndexBox& within, double voxel_size_m) const;
};

[[nodiscard]] Result<MapAnswer> tsdf_answer(const Source& source, const MapRequest& request);
[[nodiscard]] Result<MapAnswer> mesh_answer(const Source& source, const MapRequest& request);
[[nodiscard]] Result<MapAnswer> known_answer(const Source& source, const MapRequest& request);
[[nodiscard]] Result<MapAnswer> voxelgrid_answer(const Source& source, const MapRequest& request);
/// Answers with frontier, border and surface points.
[[nodiscard]] Result<MapAnswer> points_answer(const Source& source, const MapRequest& request);
[[nodiscard]] Result<MapAnswer> view_answer(const Source& source, const MapRequest& request);
[[nodiscard]] Result<MapAnswer> view_cloud_answer(const Source& source, const MapRequest& request);
/// Answers with counts or scores of views, or counts of voxels without views.
[[nodiscard]] Result<MapAnswer> views_answer(const Source& source, const MapRequest& request);

}  // namespace saccade::ros1
