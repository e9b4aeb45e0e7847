// SPDX-License-Identifier: Apache-2.0
#pragma once
// expose: the unknown voxels that are expected to be surface, one by one, on the host and on a device.

#include <cmath>
#include <cstdint>

#include "saccade/core/host_device.hpp"
#include "saccade/views/internal/line_of_sight.hpp"
#include "saccade/views/internal/voxel_role.hpp"

namespace saccade {

/// Area of a voxel's exposed faces across its normal, which points to their open side.
struct ExposedVoxel {
  std::uint32_t voxel{0};
  std::uint32_t completed{0};  ///< 1: of a completed object; 0: beside seen surface
  float normal[3]{};           ///< unit length
  float area_vox{0.0F};        ///< faces
};

/// Input of expose(). Pointers are those of the host or of a device.
struct ExposureTask {
  StateBox volume;
  const VoxelRole* roles;        ///< one per voxel
  const std::uint16_t* squared;  ///< squared distance to seen surface of each cell of 2³ voxels, in cells
  std::int64_t cell_row;         ///< strides of the cells
  std::int64_t cell_layer;
  const float* beside_shares;  ///< share of the area that counts, by squared distance; negative: beyond reach
  float completed_share;
  float behind_opening;
};

/// Finds the direction and the area of a voxel's faces towards neighbours that are open; false where it has none.
/// Requires all 26 neighbours.
template <class IsOpen>
[[nodiscard]] SACCADE_HD inline bool expose_faces(const StateBox& volume, std::int64_t voxel, const IsOpen& is_open,
                                                  ExposedVoxel& exposed) {
  const std::int64_t stride[3]{1, volume.row(), volume.layer()};
  float faces[3];
  float count{0.0F};
  for (int axis = 0; axis < 3; ++axis) {
    const bool above = is_open(voxel + stride[axis]);
    const bool below = is_open(voxel - stride[axis]);
    count += static_cast<float>(above) + static_cast<float>(below);
    faces[axis] = static_cast<float>(above) - static_cast<float>(below);
  }
  if (count == 0.0F) return false;
  float n[3]{};
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        if (!is_open(voxel + z * stride[2] + y * stride[1] + x)) continue;
        n[0] += static_cast<float>(x);
        n[1] += static_cast<float>(y);
        n[2] += static_cast<float>(z);
      }
    }
  }
  const auto squared = [](const float(&v)[3]) { return v[0] * v[0] + (v[1] * v[1] + v[2] * v[2]); };
  if (squared(n) < 1e-6F) {
    for (int axis = 0; axis < 3; ++axis) n[axis] = faces[axis];
  }
  if (squared(n) < 1e-6F) return false;  // a sheet between empty voxels has no direction
  const float norm = std::sqrt(squared(n));
  float across[3];
  for (int axis = 0; axis < 3; ++axis) {
    exposed.normal[axis] = n[axis] / norm;
    across[axis] = std::abs(faces[axis]) * std::abs(exposed.normal[axis]);
  }
  const float area = across[0] + (across[1] + across[2]);
  exposed.voxel = static_cast<std::uint32_t>(voxel);
  exposed.area_vox = area < 0.5F ? 0.5F : area;
  return true;
}

/// Tells whether an empty voxel lies in a cavity: in each direction along x and y within its object's hull, the empty
/// space ends, and on at least two sides at seen surface.
[[nodiscard]] SACCADE_HD inline bool is_in_cavity(const ExposureTask& task, std::int64_t voxel) {
  int seen{0};
  const std::int64_t count = task.volume.count();
  for (int side = 0; side < 4; ++side) {
    const std::int64_t along = side < 2 ? 1 : task.volume.row();
    const std::int64_t step = side % 2 == 0 ? along : -along;
    std::int64_t at = voxel;
    while (at >= 0 && at < count && task.roles[at].is_empty_inside()) at += step;
    if (at < 0 || at >= count || task.volume.states[at] == StateBox::kEmpty) return false;
    seen += task.volume.states[at] == StateBox::kOccupied ? 1 : 0;
  }
  return seen >= 2;
}

/// Tells whether an unknown voxel closes a cavity towards known empty space.
[[nodiscard]] SACCADE_HD inline bool closes_cavity(const ExposureTask& task, std::int64_t voxel) {
  const std::int64_t row = task.volume.row();
  const std::int64_t layer = task.volume.layer();
  const std::int64_t steps[6]{layer, 1, -1, row, -row, -layer};
  for (int i = 0; i < 6; ++i) {
    if (task.roles[voxel + steps[i]].is_empty_inside()) return is_in_cavity(task, voxel + steps[i]);
  }
  return false;
}

/// Tells whether an unknown voxel lies beside anything open to it: a voxel of an object beside unknown space outside or
/// empty space, any other beside empty space. Requires all 6 neighbours.
[[nodiscard]] SACCADE_HD inline bool is_exposed(const ExposureTask& task, std::int64_t voxel) {
  if (task.volume.states[voxel] != StateBox::kUnknown) return false;
  const VoxelRole* const at = task.roles + voxel;
  const std::int64_t row = task.volume.row();
  const std::int64_t layer = task.volume.layer();
  const unsigned beside = at[1].bits | at[-1].bits | at[row].bits | at[-row].bits | at[layer].bits | at[-layer].bits;
  const unsigned of_outside = at->reach() == VoxelRole::outside ? +VoxelRole::empty : +VoxelRole::closed;
  return (beside & (at->reach() == VoxelRole::inside ? +VoxelRole::openings : of_outside)) != 0;
}

/// Finds the surface that is expected at a voxel for which is_exposed holds; false where there is none. Requires all 26
/// neighbours.
[[nodiscard]] SACCADE_HD inline bool expose(const ExposureTask& task, std::int64_t voxel, ExposedVoxel& exposed) {
  const VoxelRole* const roles = task.roles;
  if (roles[voxel].reach() == VoxelRole::inside) {
    const auto is_open = [&](std::int64_t other) { return roles[other].opening() != VoxelRole::closed; };
    if (!expose_faces(task.volume, voxel, is_open, exposed)) return false;
    exposed.completed = 1;
    exposed.area_vox *= task.completed_share;
    if (closes_cavity(task, voxel)) exposed.area_vox *= task.behind_opening;
    return true;
  }
  const Index3 at = task.volume.at(voxel);
  const float share =
      task.beside_shares[task.squared[at.z / 2 * task.cell_layer + at.y / 2 * task.cell_row + at.x / 2]];
  if (share < 0.0F) return false;
  const auto is_open = [&](std::int64_t other) { return roles[other].opening() == VoxelRole::empty; };
  if (!expose_faces(task.volume, voxel, is_open, exposed)) return false;
  exposed.completed = 0;
  exposed.area_vox *= share;
  return true;
}

}  // namespace saccade
