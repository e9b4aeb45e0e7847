// SPDX-License-Identifier: Apache-2.0
// octree_search with PCL.
#include <pcl/octree/octree_search.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "thesis/ray_search.hpp"

namespace saccade::thesis {
namespace {

/// One unit is a voxel; the origin is the middle of the volume, so that single precision holds where rays start.
class OctreeSearch final : public RaySearch {
 public:
  explicit OctreeSearch(const StopVolume& volume) : middle_{volume.middle()} {
    const auto most = static_cast<unsigned>(std::max({volume.size().x, volume.size().y, volume.size().z}));
    const double half = 0.5 * std::bit_ceil(most);
    auto cloud = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
    for (const Index3& voxel : volume.boundary()) {
      const Index3 at = voxel - middle_;
      cloud->push_back(
          {static_cast<float>(at.x) + 0.5F, static_cast<float>(at.y) + 0.5F, static_cast<float>(at.z) + 0.5F});
    }
    octree_.defineBoundingBox(-half, -half, -half, half, half, half);
    octree_.setInputCloud(cloud);
    octree_.addPointsFromInputCloud();
  }

  [[nodiscard]] std::string_view name() const override { return "every ray, through PCL's octree"; }
  [[nodiscard]] std::optional<Index3> first_voxel(const LatticeRay& ray) const override {
    const Index3 from = ray.origin - middle_;
    const Eigen::Vector3f origin{static_cast<float>(from.x) + ray.o[0], static_cast<float>(from.y) + ray.o[1],
                                 static_cast<float>(from.z) + ray.o[2]};
    const Eigen::Vector3f direction{ray.d[0], ray.d[1], ray.d[2]};
    Octree::AlignedPointTVector centers;
    if (octree_.getIntersectedVoxelCenters(origin, direction, centers, 1) == 0) return std::nullopt;
    const pcl::PointXYZ& center = centers.front();
    return middle_ + Index3{static_cast<std::int32_t>(std::floor(center.x)),
                            static_cast<std::int32_t>(std::floor(center.y)),
                            static_cast<std::int32_t>(std::floor(center.z))};
  }

 private:
  using Octree = pcl::octree::OctreePointCloudSearch<pcl::PointXYZ>;

  Index3 middle_;
  Octree octree_{1.0};
};

}  // namespace

Result<std::unique_ptr<RaySearch>> octree_search(const StopVolume& volume) {
  return std::unique_ptr<RaySearch>{std::make_unique<OctreeSearch>(volume)};
}

}  // namespace saccade::thesis
