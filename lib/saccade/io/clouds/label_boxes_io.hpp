// SPDX-License-Identifier: Apache-2.0
#pragma once
// write_label_boxes: boxes around labels as JSON, or as the object labels of KITTI.

#include <filesystem>
#include <span>

#include "saccade/cloud/label_boxes.hpp"
#include "saccade/core/result.hpp"
#include "saccade/io/clouds/label_io.hpp"

namespace saccade {

/// Answers invalid_argument for a suffix other than .json and .txt.
[[nodiscard]] Status check_label_boxes_path(const std::filesystem::path& path);

/// Writes boxes, whose centres are relative to `offset_m` (PointCloud::offset_m), atomically.
/// - .json: {"schema": "saccade-boxes-1", "boxes": [{"label", "name", "class", "instance", "points", "center_m",
///   "size_m": [length, width, height], "axes": three unit vectors, "yaw_rad"}, …]} in the coordinates of the file.
///   The yaw turns x to the length about z, and is null where up is not z.
/// - .txt: KITTI's label_2, a line per box: type, −1 −1 (truncated, occluded: unknown), alpha, −1 four times (no
///   image), height width length, bottom centre and rotation_y in a camera's frame (x right, y down, z forward). Up
///   must be within 1° of the cloud's z (a laser scanner's frame: x forward, which becomes the camera's z) or of its
///   −y (a camera's frame). The type is the label's class, else its name, else its number; blanks become '_'.
/// @return unsupported for KITTI's frame where up is neither; invalid_argument for another suffix; io_failure.
[[nodiscard]] Status write_label_boxes(const std::filesystem::path& path, std::span<const LabelBox> boxes,
                                       std::span<const NamedLabel> names, const Eigen::Vector3d& offset_m);

}  // namespace saccade
