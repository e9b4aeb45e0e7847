// SPDX-License-Identifier: Apache-2.0
#pragma once
// Maps, frames and poses as messages of ROS.

#include <Eigen/Core>
#include <vector>

#include "saccade/core/pose.hpp"
#include "saccade/core/region.hpp"
#include "saccade/io/messages/messages.hpp"
#include "saccade/map/tsdf_map.hpp"

namespace saccade {

[[nodiscard]] messages::Point to_point(const Eigen::Vector3d& p);
[[nodiscard]] messages::Pose to_message(const Pose& pose);

/// Keeps at most `most` points, evenly spread over their order.
[[nodiscard]] std::vector<Eigen::Vector3f> thinned(std::vector<Eigen::Vector3f> points, std::size_t most);
/// Returns a cloud with the fields x, y, z: float32.
[[nodiscard]] messages::PointCloud2 cloud_of(messages::Header header, const std::vector<Eigen::Vector3f>& points);
/// Returns the centres of the workspace's occupied voxels, and rgb, packed as in PCL; grey where no colour was fused.
/// At most `most`.
[[nodiscard]] messages::PointCloud2 occupied_cloud(messages::Header header, const TsdfSnapshot& map, std::size_t most);
/// Returns the workspace from above: 100 where a voxel of the column is occupied, otherwise -1 where one is unknown,
/// otherwise 0.
[[nodiscard]] messages::OccupancyGrid plan_of(messages::Header header, const TsdfSnapshot& map, const Box& workspace);
/// Returns an image of 32FC1, metres.
[[nodiscard]] messages::Image depth_message(messages::Header header, const DepthImage& depth);
[[nodiscard]] messages::CameraInfo info_message(messages::Header header, const PinholeCamera& camera);

}  // namespace saccade
