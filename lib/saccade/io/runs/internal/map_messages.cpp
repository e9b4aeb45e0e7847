// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/runs/internal/map_messages.hpp"

#include <Eigen/Geometry>
#include <cstring>

#include "saccade/map/voxel_row.hpp"
#include "saccade/map/voxels_inside.hpp"

namespace saccade {
namespace {

constexpr std::uint8_t kFloat32{7};
constexpr Rgb8 kNoColor{180, 180, 180};

messages::PointCloud2 cloud_with(messages::Header header, std::vector<std::string> names, std::size_t points) {
  messages::PointCloud2 cloud;
  cloud.header = std::move(header);
  for (std::string& name : names) {
    const auto offset = static_cast<std::uint32_t>(sizeof(float) * cloud.fields.size());
    cloud.fields.push_back({std::move(name), offset, kFloat32, 1});
  }
  cloud.point_step = static_cast<std::uint32_t>(sizeof(float) * cloud.fields.size());
  cloud.width = static_cast<std::uint32_t>(points);
  cloud.row_step = cloud.point_step * cloud.width;
  cloud.data.resize(std::size_t{cloud.point_step} * points);
  return cloud;
}

/// Calls body(voxel, colour) for the occupied voxels of the workspace, sector by sector.
template <class Body>
void for_each_occupied(const TsdfSnapshot& map, const Body& body) {
  IndexBox box = map.grid.known_bounds();
  if (map.config.workspace) box = voxels_with_center_in(*map.config.workspace, map.config.voxel_size_m);
  for (const Index3& key : map.grid.sorted_sectors()) {
    const Sector& sector = *map.grid.find(key);
    for (int child = 0; child < kSectorBricks; ++child) {
      const DenseBrick* dense = sector.bricks[static_cast<std::size_t>(child)].dense();
      if (dense == nullptr) continue;
      const Index3 lo = (key * kSectorEdge + child_offset(child)) * kBrickEdge;
      (dense->occupied & voxels_inside(box, lo)).for_each([&](std::size_t i) {
        const bool colored = dense->colors != nullptr && (*dense->colors)[i] != Rgb8{};
        body(lo + child_offset(static_cast<int>(i)), colored ? (*dense->colors)[i] : kNoColor);
      });
    }
  }
}

}  // namespace

messages::Point to_point(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

messages::Pose to_message(const Pose& pose) {
  const Eigen::Quaterniond q{pose.linear()};
  return {to_point(pose.translation()), {q.x(), q.y(), q.z(), q.w()}};
}

std::vector<Eigen::Vector3f> thinned(std::vector<Eigen::Vector3f> points, std::size_t most) {
  if (points.size() <= most) return points;
  for (std::size_t i = 0; i < most; ++i) points[i] = points[i * points.size() / most];
  points.resize(most);
  return points;
}

messages::PointCloud2 cloud_of(messages::Header header, const std::vector<Eigen::Vector3f>& points) {
  messages::PointCloud2 cloud = cloud_with(std::move(header), {"x", "y", "z"}, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::memcpy(cloud.data.data() + i * cloud.point_step, points[i].data(), cloud.point_step);
  }
  return cloud;
}

messages::PointCloud2 occupied_cloud(messages::Header header, const TsdfSnapshot& map, std::size_t most) {
  std::size_t count = 0;
  for_each_occupied(map, [&](const Index3&, const Rgb8&) { ++count; });
  const std::size_t kept = std::min(count, most);
  messages::PointCloud2 cloud = cloud_with(std::move(header), {"x", "y", "z", "rgb"}, kept);
  std::size_t index = 0;
  std::size_t out = 0;
  for_each_occupied(map, [&](const Index3& voxel, const Rgb8& color) {
    if (out == kept || index++ != out * count / kept) return;
    const Eigen::Vector3f p = voxel_center(voxel, map.config.voxel_size_m).cast<float>();
    const std::uint32_t rgb = (std::uint32_t{color[0]} << 16U) | (std::uint32_t{color[1]} << 8U) | color[2];
    std::byte* const point = cloud.data.data() + out++ * cloud.point_step;
    std::memcpy(point, p.data(), 3 * sizeof(float));
    std::memcpy(point + 3 * sizeof(float), &rgb, sizeof(rgb));
  });
  return cloud;
}

messages::OccupancyGrid plan_of(messages::Header header, const TsdfSnapshot& map, const Box& workspace) {
  constexpr std::byte kUnknown{0xff};
  constexpr std::byte kOccupied{100};
  const double size = map.config.voxel_size_m;
  const IndexBox box = voxels_with_center_in(workspace, size);
  messages::OccupancyGrid plan;
  plan.info.map_load_time = header.stamp;
  plan.header = std::move(header);
  plan.info.resolution = static_cast<float>(size);
  plan.info.width = static_cast<std::uint32_t>(box.hi.x - box.lo.x);
  plan.info.height = static_cast<std::uint32_t>(box.hi.y - box.lo.y);
  plan.info.origin.position = {box.lo.x * size, box.lo.y * size, workspace.min.z()};
  plan.data.assign(std::size_t{plan.info.width} * plan.info.height, std::byte{0});
  for (std::int32_t z = box.lo.z; z < box.hi.z; ++z) {
    std::byte* cell = plan.data.data();
    for (std::int32_t y = box.lo.y; y < box.hi.y; ++y) {
      for_each_in_row(map.grid, {box.lo.x, y, z}, box.hi.x, [&](const Voxel& voxel) {
        const VoxelState state = state_of(voxel);
        if (state == VoxelState::occupied) *cell = kOccupied;
        if (state == VoxelState::unknown && *cell != kOccupied) *cell = kUnknown;
        ++cell;
      });
    }
  }
  return plan;
}

messages::Image depth_message(messages::Header header, const DepthImage& depth) {
  messages::Image image;
  image.header = std::move(header);
  image.width = static_cast<std::uint32_t>(depth.width());
  image.height = static_cast<std::uint32_t>(depth.height());
  image.encoding = "32FC1";
  image.step = image.width * static_cast<std::uint32_t>(sizeof(float));
  const auto bytes = std::as_bytes(std::span{depth.pixels()});
  image.data.assign(bytes.begin(), bytes.end());
  return image;
}

messages::CameraInfo info_message(messages::Header header, const PinholeCamera& camera) {
  messages::CameraInfo info;
  info.header = std::move(header);
  info.width = static_cast<std::uint32_t>(camera.width);
  info.height = static_cast<std::uint32_t>(camera.height);
  info.distortion_model = "plumb_bob";
  info.d.assign(5, 0.0);
  info.k = {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0};
  info.r = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  info.p = {camera.fx, 0.0, camera.cx, 0.0, 0.0, camera.fy, camera.cy, 0.0, 0.0, 0.0, 1.0, 0.0};
  return info;
}

}  // namespace saccade
