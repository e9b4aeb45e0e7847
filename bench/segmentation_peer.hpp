// SPDX-License-Identifier: Apache-2.0
#pragma once
// PCL's segmentation of a cloud, beside ours.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "saccade/segment/lccp.hpp"

namespace saccade::bench {

struct PeerSegments {
  std::vector<std::uint32_t> labels;  ///< one per point; kUnlabelled: none
  std::size_t segments{0};
  double supervoxels_ms{0.0};
  double lccp_ms{0.0};
};

/// pcl::SupervoxelClustering and pcl::LCCPSegmentation with the same parameters, and its own transform of organised
/// clouds.
[[nodiscard]] PeerSegments segment_with_pcl(const PointCloud& cloud, const SupervoxelConfig& supervoxels,
                                            const LccpConfig& lccp);

}  // namespace saccade::bench
