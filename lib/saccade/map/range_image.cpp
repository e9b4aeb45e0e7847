// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/range_image.hpp"

#include <algorithm>
#include <atomic>
#include <limits>

#include "saccade/map/fusion_kernels.hpp"

namespace saccade {
namespace {

/// The finest level: cells of 4×4 pixels.
constexpr int kFirstShift{2};
constexpr int kFirstCell{1 << kFirstShift};

constexpr float kInfinity{std::numeric_limits<float>::infinity()};
constexpr BeamBounds kNoBeam{kInfinity, 0.0F, kInfinity};

BeamBounds merged(const BeamBounds& a, const BeamBounds& b) {
  return {std::min(a.clear_m, b.clear_m), std::max(a.reach_m, b.reach_m), std::min(a.nearest_m, b.nearest_m)};
}

std::size_t row_offset(int row, int width) { return static_cast<std::size_t>(row) * static_cast<std::size_t>(width); }

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
  std::vector<float> dx_squared(static_cast<std::size_t>(camera_.width));
  for (int u = 0; u < camera_.width; ++u) {
    dx_squared[static_cast<std::size_t>(u)] = tsdf::squared_slope(u, camera_.cx, camera_.fx);
  }
  const fusion::RayLengths rays{dx_squared.data(), camera_.width,
                                static_cast<float>(std::max(camera.min_range_m, 1e-6)),
                                static_cast<float>(camera.max_range_m), camera_.truncation_m};
  Level cells = level(kFirstShift, camera_.width, camera_.height);
  std::atomic<std::size_t> valid{0};
  executor.parallel_for(static_cast<std::size_t>(cells.height), 4, [&](std::size_t begin, std::size_t end) {
    std::vector<float> clear_m(dx_squared.size());
    std::vector<float> reach_m(dx_squared.size());
    std::vector<float> nearest_m(dx_squared.size());
    std::size_t count{0};
    for (int row = static_cast<int>(begin); row < static_cast<int>(end); ++row) {
      std::fill(clear_m.begin(), clear_m.end(), kNoBeam.clear_m);
      std::fill(reach_m.begin(), reach_m.end(), kNoBeam.reach_m);
      std::fill(nearest_m.begin(), nearest_m.end(), kNoBeam.nearest_m);
      for (int v = row * kFirstCell; v < std::min((row + 1) * kFirstCell, camera_.height); ++v) {
        count += fusion::ranges_of_row(rays, tsdf::squared_slope(v, camera_.cy, camera_.fy), depth.row(v),
                                       ranges_.data() + row_offset(v, camera_.width),
                                       {clear_m.data(), reach_m.data(), nearest_m.data()});
      }
      BeamBounds* out = cells.cells.data() + row_offset(row, cells.width);
      for (std::size_t u = 0; u < clear_m.size(); ++u) {
        BeamBounds& cell = out[u >> kFirstShift];
        cell = merged(cell, {clear_m[u], reach_m[u], nearest_m[u]});
      }
    }
    valid += count;
  });
  valid_pixels_ = valid;
  levels_.push_back(std::move(cells));
  build_pyramid();
}

RangeImage::Level RangeImage::level(int shift, int fine_width, int fine_height) {
  const int cell = shift == kFirstShift ? kFirstCell : 2;
  Level result{shift, (fine_width + cell - 1) / cell, (fine_height + cell - 1) / cell, {}};
  result.cells.resize(row_offset(result.height, result.width), kNoBeam);
  return result;
}

void RangeImage::build_pyramid() {
  while (levels_.back().width > 1 || levels_.back().height > 1) {
    const Level& fine = levels_.back();
    Level coarse = level(fine.shift + 1, fine.width, fine.height);
    for (int y = 0; y < fine.height; ++y) {
      const BeamBounds* in = fine.cells.data() + row_offset(y, fine.width);
      BeamBounds* out = coarse.cells.data() + row_offset(y / 2, coarse.width);
      for (int x = 0; x < fine.width; ++x) out[x / 2] = merged(out[x / 2], in[x]);
    }
    levels_.push_back(std::move(coarse));
  }
}

float RangeImage::max_reach_m() const { return levels_.back().cells.front().reach_m; }

BeamBounds RangeImage::bounds(const PixelRect& rect) const {
  const int extent = std::max(rect.u1 - rect.u0, rect.v1 - rect.v0);
  std::size_t level{0};
  while (level + 1 < levels_.size() && (extent >> levels_[level].shift) > 5) ++level;
  const Level& cells = levels_[level];
  BeamBounds result = kNoBeam;
  for (int y = rect.v0 >> cells.shift; y <= rect.v1 >> cells.shift; ++y) {
    const BeamBounds* row = cells.cells.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(cells.width);
    for (int x = rect.u0 >> cells.shift; x <= rect.u1 >> cells.shift; ++x) result = merged(result, row[x]);
  }
  return result;
}

}  // namespace saccade
