// SPDX-License-Identifier: Apache-2.0
#pragma once
// label_boxes: an upright box around the points of each label.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace saccade {

/// Box around the points of one label. It stands upright and is turned about the vertical by its yaw.
struct LabelBox {
  std::uint32_t label{0};
  std::size_t points{0};
  Eigen::Vector3d center_m{Eigen::Vector3d::Zero()};
  Eigen::Vector3d size_m{Eigen::Vector3d::Zero()};    ///< length, width, height; length is at least width
  Eigen::Matrix3d axes{Eigen::Matrix3d::Identity()};  ///< columns: directions of length, width and up; right-handed
};

/// Returns the boxes of all labels but 0, by label: the rectangle of least area around the points as seen from above,
/// between the lowest and the highest point. A box has no front, so length points anywhere within half a turn: towards
/// +x, or along +y. Points that are not finite are left out, as are labels without others. `up` is a unit vector.
/// O(points · log points + the square of a hull's corners).
[[nodiscard]] std::vector<LabelBox> label_boxes(std::span<const Eigen::Vector3f> positions_m,
                                                std::span<const std::uint32_t> labels, const Eigen::Vector3d& up);

}  // namespace saccade
