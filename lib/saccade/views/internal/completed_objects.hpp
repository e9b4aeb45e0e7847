// SPDX-License-Identifier: Apache-2.0
#pragma once
// complete_objects: objects that stand on supports, each as far as it may reach; DistanceToObjects.

#include <cstdint>
#include <span>
#include <vector>

#include "saccade/core/executor.hpp"
#include "saccade/views/internal/find_supports.hpp"
#include "saccade/views/internal/state_volume.hpp"
#include "saccade/views/supports.hpp"

namespace saccade {

/// What completion makes of a voxel.
struct VoxelRole {
  /// Bits 0 and 1: what lies there for the surface of an unknown neighbour.
  enum Opening : std::uint8_t { closed = 0, unknown = 1, empty = 2, openings = 3 };
  /// Bits 2 and 3: how an object may reach there. Where hulls overlap, the larger holds.
  enum Reach : std::uint8_t {
    outside = 0,
    below = 4,    ///< up to two voxels below an object, in its support
    carved = 8,   ///< in an object's hull, but empty on its other side
    inside = 12,  ///< in an object's hull
  };
  std::uint8_t bits{0};
  [[nodiscard]] std::uint8_t reach() const { return bits & inside; }
  [[nodiscard]] std::uint8_t opening() const { return bits & openings; }
  /// Known to be empty, in an object's hull.
  [[nodiscard]] bool is_empty_inside() const { return bits == (+inside | +empty); }
};

/// What objects stand on and in front of.
struct Surroundings {
  std::span<const std::vector<std::int32_t>> tops;  ///< top_layers of each support
  std::span<const Wall> walls;
};

/// A connected set of occupied voxels. Indices of columns and layers count from the volume's lowest.
struct CompletedObject {
  IndexBox seen;                         ///< around its voxels, indices of the map
  std::vector<std::uint32_t> footprint;  ///< columns of its convex hull
  std::vector<std::int32_t> first;       ///< lowest layer of each: the first above its support
  std::vector<std::uint8_t> stands;      ///< 1: the support reaches below that column
  std::int32_t last{0};                  ///< highest layer
  bool symmetric{false};                 ///< whether it may be carved
  std::int32_t sum_x{0};                 ///< its half turn takes (x, y) to (sum_x − x, sum_y − y)
  std::int32_t sum_y{0};
};

struct CompletedObjects {
  std::vector<CompletedObject> objects;
  std::vector<std::uint32_t> seen;  ///< occupied voxels of all objects, in their order
  /// One per voxel of the volume. Unknown voxels within or below objects and occupied ones are closed.
  std::vector<VoxelRole> roles;
};

/// Finds objects and extrudes their footprints' hulls from their supports to their tops. An object that a half turn
/// about a vertical axis does not contradict, that is, takes next to none of its voxels to known empty space, is carved
/// where the half turn takes the unknown to known empty space. Most things on tables have that symmetry.
/// Objects that touch a wall reach to its surface. O(voxels of the volume); the thread count never changes a bit.
[[nodiscard]] CompletedObjects complete_objects(const StateVolume& volume, const Surroundings& surroundings,
                                                const Executor& executor);

/// Distance to the nearest seen voxel of an object, for cells of 2³ voxels; as exact as these are.
class DistanceToObjects {
 public:
  /// O(cells · reach); the thread count never changes a bit.
  DistanceToObjects(const StateVolume& volume, std::span<const std::uint32_t> seen, double reach_m,
                    const Executor& executor);
  /// Distance from a voxel, given by its coordinates in the volume; infinity beyond the reach.
  [[nodiscard]] float at_m(std::int32_t x, std::int32_t y, std::int32_t z) const {
    const std::uint16_t squared = squared_[static_cast<std::size_t>(z / 2) * layer_ +
                                           static_cast<std::size_t>(y / 2) * row_ + static_cast<std::size_t>(x / 2)];
    return metres_[squared];
  }

 private:
  std::size_t row_{0};
  std::size_t layer_{0};
  std::vector<std::uint16_t> squared_;  ///< in cells, no more than metres_ goes
  std::vector<float> metres_;           ///< by squared distance
};

}  // namespace saccade
