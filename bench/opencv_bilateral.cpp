// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "depth_filter_peer.hpp"

namespace saccade::bench {

DepthImage opencv_bilateral(const DepthImage& depth, const thesis::BilateralConfig& config) {
  cv::Mat before(depth.height(), depth.width(), CV_32F);
  std::copy(depth.pixels().begin(), depth.pixels().end(), before.ptr<float>());
  cv::Mat after;
  cv::bilateralFilter(before, after, 2 * config.radius_px + 1, config.sigma_m, config.sigma_px);
  DepthImage filtered{depth.width(), depth.height()};
  std::copy(after.ptr<float>(), after.ptr<float>() + filtered.size(), filtered.data());
  return filtered;
}

}  // namespace saccade::bench
