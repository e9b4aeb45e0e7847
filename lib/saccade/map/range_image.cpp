// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/range_image.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace saccade {
namespace {

constexpr int kFirstShift{2};

/// The depth that fusion believes: 0 for none, negative for "free up to".
float trusted_depth(float depth_m, float min_range_m, float max_range_m) {
  if (depth_m >= min_range_m && depth_m <= max_range_m) return depth_m;
  if (depth_m < 0.0F) return std::max(depth_m, -max_range_m);  // −∞ included
  return 0.0F;                                                 // 0, NaN, out of range
}

BeamBounds bounds_of_range(float range_m, float truncation_m) {
  if (range_m > 0.0F) return {std::max(0.0F, range_m - truncation_m), range_m + truncation_m};
  return {-range_m, -range_m};
}

BeamBounds merged(const BeamBounds& a, const BeamBounds& b) {
  return {std::min(a.clear_m, b.clear_m), std::max(a.reach_m, b.reach_m)};
}

}  // namespace

RangeImage::RangeImage(const PinholeCamera& camera, const DepthImage& depth, double truncation_m,
                       const Executor& executor)
    : camera_{static_cast<float>(camera.fx),
              static_cast<float>(camera.fy),
              static_cast<float>(camera.cx),
              static_cast<float>(camera.cy),
              camera.width,
              camera.height,
              static_cast<float>(truncation_m),
              static_cast<float>(1.0 / truncation_m)},
      ranges_(depth.size()) {
  const auto min_range_m = static_cast<float>(std::max(camera.min_range_m, 1e-6));
  const auto max_range_m = static_cast<float>(camera.max_range_m);
  std::atomic<std::size_t> valid{0};
  executor.parallel_for(static_cast<std::size_t>(depth.height()), 16, [&](std::size_t begin, std::size_t end) {
    std::size_t count{0};
    for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
      const float* depth_row = depth.row(v);
      float* range_row = ranges_.data() + static_cast<std::size_t>(v) * static_cast<std::size_t>(camera_.width);
      for (int u = 0; u < camera_.width; ++u) {
        const float d = trusted_depth(depth_row[u], min_range_m, max_range_m);
        range_row[u] = d == 0.0F ? 0.0F : tsdf::range_of_depth(camera_, u, v, d);
        count += d > 0.0F ? 1U : 0U;
      }
    }
    valid += count;
  });
  valid_pixels_ = valid;
  build_pyramid();
}

void RangeImage::build_pyramid() {
  Level base{kFirstShift, (camera_.width + 3) >> kFirstShift, (camera_.height + 3) >> kFirstShift, {}};
  base.cells.resize(static_cast<std::size_t>(base.width) * static_cast<std::size_t>(base.height),
                    {std::numeric_limits<float>::infinity(), 0.0F});
  for (int v = 0; v < camera_.height; ++v) {
    const float* row = ranges_.data() + static_cast<std::size_t>(v) * static_cast<std::size_t>(camera_.width);
    BeamBounds* cells =
        base.cells.data() + static_cast<std::size_t>(v >> kFirstShift) * static_cast<std::size_t>(base.width);
    for (int u = 0; u < camera_.width; ++u) {
      BeamBounds& cell = cells[u >> kFirstShift];
      cell = merged(cell, bounds_of_range(row[u], camera_.truncation_m));
    }
  }
  levels_.push_back(std::move(base));
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const Level& fine = levels_.back();
    Level coarse{fine.shift + 1, (fine.width + 1) / 2, (fine.height + 1) / 2, {}};
    coarse.cells.resize(static_cast<std::size_t>(coarse.width) * static_cast<std::size_t>(coarse.height),
                        {std::numeric_limits<float>::infinity(), 0.0F});
    for (int y = 0; y < fine.height; ++y) {
      for (int x = 0; x < fine.width; ++x) {
        BeamBounds& cell = coarse.cells[static_cast<std::size_t>(y / 2) * static_cast<std::size_t>(coarse.width) +
                                        static_cast<std::size_t>(x / 2)];
        cell = merged(cell, fine.cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(fine.width) +
                                       static_cast<std::size_t>(x)]);
      }
    }
    levels_.push_back(std::move(coarse));
  }
}

float RangeImage::max_reach_m() const { return levels_.back().cells.front().reach_m; }

BeamBounds RangeImage::bounds(const PixelRect& rect) const {
  const int extent = std::max(rect.u1 - rect.u0, rect.v1 - rect.v0);
  std::size_t level{0};
  while (level + 1 < levels_.size() && (extent >> levels_[level].shift) > 3) ++level;
  const Level& cells = levels_[level];
  BeamBounds result{std::numeric_limits<float>::infinity(), 0.0F};
  for (int y = rect.v0 >> cells.shift; y <= rect.v1 >> cells.shift; ++y) {
    const BeamBounds* row = cells.cells.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(cells.width);
    for (int x = rect.u0 >> cells.shift; x <= rect.u1 >> cells.shift; ++x) result = merged(result, row[x]);
  }
  return result;
}

}  // namespace saccade
