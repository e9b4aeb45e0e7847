// SPDX-License-Identifier: Apache-2.0
#pragma once
// StateBox: the states of a box of voxels, where host and device read them. is_in_sight: the line from a voxel to a
// camera.

#include <cmath>
#include <cstdint>
#include <limits>

#include "saccade/core/host_device.hpp"
#include "saccade/map/voxel_index.hpp"

namespace saccade {

/// States of the voxels of a box, as in StateVolume. One byte each, x fastest: 0 unknown, 1 empty, 2 occupied.
struct StateBox {
  static constexpr std::uint8_t kUnknown{0};
  static constexpr std::uint8_t kEmpty{1};
  static constexpr std::uint8_t kOccupied{2};

  Index3 lo;
  Index3 size;
  double voxel_size_m;
  const std::uint8_t* states;

  [[nodiscard]] SACCADE_HD std::int64_t row() const { return size.x; }
  [[nodiscard]] SACCADE_HD std::int64_t layer() const { return std::int64_t{size.x} * size.y; }
  [[nodiscard]] SACCADE_HD std::int64_t count() const { return layer() * size.z; }
  /// Returns the coordinates of a voxel within the box.
  [[nodiscard]] SACCADE_HD Index3 at(std::int64_t voxel) const {
    return {static_cast<std::int32_t>(voxel % size.x), static_cast<std::int32_t>(voxel / size.x % size.y),
            static_cast<std::int32_t>(voxel / layer())};
  }
};

/// Progress of a line along one axis.
struct LineAxis {
  float next;         ///< share of the line at which the next plane is passed
  float between;      ///< share between planes
  std::int32_t left;  ///< voxels to the border
  std::int64_t move;  ///< stride of the next voxel

  [[nodiscard]] static SACCADE_HD LineAxis make(double step_vox, std::int32_t at, std::int32_t size,
                                                std::int64_t stride) {
    const float between =
        step_vox == 0.0 ? std::numeric_limits<float>::infinity() : static_cast<float>(1.0 / std::abs(step_vox));
    return {0.5F * between, between, step_vox > 0.0 ? size - 1 - at : at, step_vox > 0.0 ? stride : -stride};
  }
};

/// Tells whether nothing hides a voxel of the box from a camera, as StateVolume::is_visible. O(voxels between).
[[nodiscard]] SACCADE_HD inline bool is_in_sight(const StateBox& box, std::int64_t voxel, const double (&camera_m)[3],
                                                 double through_m) {
  const Index3 at = box.at(voxel);
  const double step_m[3]{camera_m[0] - (box.lo.x + at.x + 0.5) * box.voxel_size_m,
                         camera_m[1] - (box.lo.y + at.y + 0.5) * box.voxel_size_m,
                         camera_m[2] - (box.lo.z + at.z + 0.5) * box.voxel_size_m};
  const double length_m = __builtin_sqrt(step_m[0] * step_m[0] + (step_m[1] * step_m[1] + step_m[2] * step_m[2]));
  const float through = length_m > 0.0 ? static_cast<float>(through_m / length_m) : 1.0F;
  LineAxis x = LineAxis::make(step_m[0] / box.voxel_size_m, at.x, box.size.x, 1);
  LineAxis y = LineAxis::make(step_m[1] / box.voxel_size_m, at.y, box.size.y, box.row());
  LineAxis z = LineAxis::make(step_m[2] / box.voxel_size_m, at.z, box.size.z, box.layer());
  std::int64_t index = voxel;
  float t{0.0F};
  const auto cross = [&](LineAxis& axis) {
    t = axis.next;
    if (t >= 1.0F || axis.left-- == 0) return false;
    axis.next += axis.between;
    index += axis.move;
    return true;
  };
  for (;;) {
    const bool before_y = x.next <= y.next;
    const bool crossed = before_y ? (x.next <= z.next ? cross(x) : cross(z)) : (y.next <= z.next ? cross(y) : cross(z));
    if (!crossed) return true;
    const std::uint8_t state = box.states[index];
    if (state != StateBox::kEmpty && (state == StateBox::kOccupied || t > through)) return false;
  }
}

}  // namespace saccade
