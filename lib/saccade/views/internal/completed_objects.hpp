// SPDX-License-Identifier: Apache-2.0
#pragma once
// complete_objects: objects on supports, each with its possible extent; DistanceToObjects.

#include <cstdint>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/views/internal/find_supports.hpp"
#include "saccade/views/internal/state_volume.hpp"
#include "saccade/views/internal/voxel_role.hpp"
#include "saccade/views/supports.hpp"

namespace saccade {

/// Supports and walls of the objects.
struct Surroundings {
  std::span<const std::vector<std::int32_t>> tops;  ///< top_layers of each support
  std::span<const Wall> walls;
};

/// Connected set of occupied voxels. Indices of columns and layers count from the volume's lowest.
struct CompletedObject {
  IndexBox seen;                         ///< box around its voxels, indices of the map
  std::vector<std::uint32_t> footprint;  ///< columns of its convex hull
  std::vector<std::int32_t> first;       ///< per column: lowest layer, the first above its support
  std::vector<std::uint8_t> stands;      ///< per column: 1 where the support reaches below it
  std::int32_t last{0};                  ///< highest layer
  bool symmetric{false};                 ///< whether it may be carved
  std::int32_t sum_x{0};                 ///< its half turn maps (x, y) to (sum_x − x, sum_y − y)
  std::int32_t sum_y{0};
};

struct CompletedObjects {
  std::vector<CompletedObject> objects;
  std::vector<std::uint32_t> seen;  ///< occupied voxels of all objects, in their order
  /// One role per voxel of the volume. Occupied voxels, and unknown ones within or below objects, are closed.
  std::vector<VoxelRole> roles;
};

/// Finds objects and extrudes their footprints' hulls from their supports to their tops. An object has the symmetry of
/// a half turn about a vertical axis unless the turn maps more than a few of its voxels to known empty space; most
/// things on tables have it. Such an object is carved where the half turn maps unknown space to known empty space.
/// Objects that touch a wall extend to its surface. O(voxels of the volume); the thread count never changes a bit.
[[nodiscard]] CompletedObjects complete_objects(const StateVolume& volume, const Surroundings& surroundings,
                                                const Executor& executor);

/// Distance to the nearest seen voxel of an object, for cells of 2³ voxels, with their accuracy.
class DistanceToObjects {
 public:
  /// O(cells · reach); the thread count never changes a bit.
  DistanceToObjects(const StateVolume& volume, std::span<const std::uint32_t> seen, double reach_m,
                    const Executor& executor);
  /// Returns the squared distance of each cell, in cells; x fastest.
  [[nodiscard]] std::span<const std::uint16_t> squared() const { return squared_; }
  /// Strides of the cells along y and z.
  [[nodiscard]] std::size_t row() const { return row_; }
  [[nodiscard]] std::size_t layer() const { return layer_; }
  /// Returns the distance by squared distance; infinity beyond the reach.
  [[nodiscard]] std::span<const float> metres() const { return metres_; }

 private:
  std::size_t row_{0};
  std::size_t layer_{0};
  std::vector<std::uint16_t> squared_;  ///< in cells, limited to the range of metres_
  std::vector<float> metres_;           ///< by squared distance
};

}  // namespace saccade
