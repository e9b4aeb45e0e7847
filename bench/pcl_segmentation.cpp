// SPDX-License-Identifier: Apache-2.0
#include <pcl/point_types.h>
#include <pcl/segmentation/lccp_segmentation.h>
#include <pcl/segmentation/supervoxel_clustering.h>

#include <algorithm>
#include <map>
#include <set>

#include "saccade/core/clock.hpp"
#include "segmentation_peer.hpp"

namespace saccade::bench {

PeerSegments segment_with_pcl(const PointCloud& cloud, const SupervoxelConfig& supervoxels, const LccpConfig& lccp) {
  using Point = pcl::PointXYZRGBA;
  const pcl::PointCloud<Point>::Ptr points{new pcl::PointCloud<Point>};
  points->is_dense = false;
  for (std::size_t i = 0; i < cloud.positions_m.size(); ++i) {
    Point point;
    point.getVector3fMap() = cloud.positions_m[i];
    points->push_back(point);
  }

  PeerSegments result;
  const Stopwatch clustering_time;
  pcl::SupervoxelClustering<Point> clustering{static_cast<float>(supervoxels.voxels.voxel_size_m),
                                              static_cast<float>(supervoxels.seed_spacing_m)};
  clustering.setUseSingleCameraTransform(supervoxels.voxels.single_camera);
  clustering.setInputCloud(points);
  clustering.setColorImportance(static_cast<float>(supervoxels.color_weight));
  clustering.setSpatialImportance(static_cast<float>(supervoxels.spatial_weight));
  clustering.setNormalImportance(static_cast<float>(supervoxels.normal_weight));
  std::map<std::uint32_t, pcl::Supervoxel<Point>::Ptr> clusters;
  clustering.extract(clusters);
  std::multimap<std::uint32_t, std::uint32_t> adjacency;
  clustering.getSupervoxelAdjacency(adjacency);
  result.supervoxels_ms = clustering_time.elapsed_ms();

  const Stopwatch lccp_time;
  pcl::LCCPSegmentation<Point> segmentation;
  segmentation.setConcavityToleranceThreshold(static_cast<float>(lccp.concavity_tolerance_rad * 180.0 / M_PI));
  segmentation.setSanityCheck(lccp.sanity);
  segmentation.setSmoothnessCheck(lccp.smooth, static_cast<float>(supervoxels.voxels.voxel_size_m),
                                  static_cast<float>(supervoxels.seed_spacing_m), static_cast<float>(lccp.smoothness));
  segmentation.setKFactor(lccp.extended_convexity ? 1 : 0);
  segmentation.setInputSupervoxels(clusters, adjacency);
  segmentation.setMinSegmentSize(static_cast<std::uint32_t>(lccp.min_supervoxels));
  segmentation.segment();
  const pcl::PointCloud<pcl::PointXYZL>::Ptr labelled = clustering.getLabeledCloud();
  segmentation.relabelCloud(*labelled);
  result.lccp_ms = lccp_time.elapsed_ms();

  std::set<std::uint32_t> names;
  result.labels.reserve(labelled->size());
  for (const pcl::PointXYZL& point : *labelled) {
    result.labels.push_back(point.label == 0 ? kUnlabelled : point.label);
    if (point.label != 0) names.insert(point.label);
  }
  result.segments = names.size();
  return result;
}

}  // namespace saccade::bench
