// SPDX-License-Identifier: Apache-2.0
#include "saccade/map/internal/range_image.hpp"

#include <algorithm>
#include <atomic>
#include <limits>

#include "saccade/map/internal/fusion_kernels.hpp"

namespace saccade {
namespace {

constexpr float kInfinity{std::numeric_limits<float>::infinity()};
constexpr BeamBounds kNoBeam{kInfinity, 0.0F, kInfinity};

int cells_over(int pixels) { return (pixels + RangeImage::kCellPx - 1) / RangeImage::kCellPx; }

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
      ranges_(depth.size()),
      width_cells_{cells_over(camera.width)},
      height_cells_{cells_over(camera.height)},
      level_size_{row_offset(height_cells_, width_cells_)},
      least_(kLevels * level_size_, Least{kInfinity, 0.0F, kInfinity, 0.0F}) {
  std::vector<float> dx_squared(static_cast<std::size_t>(camera_.width));
  for (int u = 0; u < camera_.width; ++u) {
    dx_squared[static_cast<std::size_t>(u)] = tsdf::squared_slope(u, camera_.cx, camera_.fx);
  }
  const fusion::RayLengths rays{dx_squared.data(), camera_.width,
                                static_cast<float>(std::max(camera.min_range_m, 1e-6)),
                                static_cast<float>(camera.max_range_m), camera_.truncation_m};
  std::atomic<std::size_t> valid{0};
  executor.parallel_for(static_cast<std::size_t>(height_cells_), 4, [&](std::size_t begin, std::size_t end) {
    std::vector<float> clear_m(dx_squared.size());
    std::vector<float> reach_m(dx_squared.size());
    std::vector<float> nearest_m(dx_squared.size());
    std::size_t count{0};
    for (int row = static_cast<int>(begin); row < static_cast<int>(end); ++row) {
      std::fill(clear_m.begin(), clear_m.end(), kNoBeam.clear_m);
      std::fill(reach_m.begin(), reach_m.end(), kNoBeam.reach_m);
      std::fill(nearest_m.begin(), nearest_m.end(), kNoBeam.nearest_m);
      for (int v = row * kCellPx; v < std::min((row + 1) * kCellPx, camera_.height); ++v) {
        count += fusion::ranges_of_row(rays, tsdf::squared_slope(v, camera_.cy, camera_.fy), depth.row(v),
                                       ranges_.data() + row_offset(v, camera_.width),
                                       {clear_m.data(), reach_m.data(), nearest_m.data()});
      }
      Least* out = level(0) + row_offset(row, width_cells_);
      for (std::size_t u = 0; u < clear_m.size(); ++u) {
        Least& cell = out[u >> kCellShift];
        cell = cell.min(Least{clear_m[u], -reach_m[u], nearest_m[u], 0.0F});
      }
    }
    valid += count;
  });
  valid_pixels_ = valid;
  bound_squares();
  max_reach_m_ = bounds({0, 0, camera_.width - 1, camera_.height - 1}).reach_m;
}

void RangeImage::bound_squares() {
  for (std::size_t k = 1; k < kLevels; ++k) {
    const int half = 1 << (k - 1);
    for (int y = 0; y < height_cells_; ++y) {
      const Least* upper = level(k - 1) + row_offset(y, width_cells_);
      const Least* lower = level(k - 1) + row_offset(std::min(y + half, height_cells_ - 1), width_cells_);
      Least* out = level(k) + row_offset(y, width_cells_);
      for (int x = 0; x < width_cells_; ++x) {
        const int right = std::min(x + half, width_cells_ - 1);
        out[x] = upper[x].min(upper[right]).min(lower[x].min(lower[right]));
      }
    }
  }
}

}  // namespace saccade
