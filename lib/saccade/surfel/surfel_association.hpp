// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfelAssociation: which surfel each pixel of a frame saw; for_each_seen_surfel: the pixels that saw one surfel.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "saccade/core/pose.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/sensor/pinhole_camera.hpp"
#include "saccade/surfel/surfel_map.hpp"

namespace saccade {

/// s_{f,uv} of one frame (thesis §4.1.1), and where and with which weights it was seen.
struct SurfelAssociation {
  static constexpr int kReach_px{1};  ///< a pixel's surfel is in its own cell or in one so far away

  PinholeCamera camera;
  Pose T_world_camera{Pose::Identity()};
  Image<SurfelId> of_pixel;  ///< the surfel that the pixel saw, or kNoSurfel
  Image<SurfelId> of_cell;   ///< the surfel that fills the cell of the index image, or kNoSurfel
  std::size_t first_new{0};  ///< surfels from here on were made by this frame, each by its one pixel
  std::size_t surfels{0};    ///< ids are below
  std::vector<float> column_weights;
  std::vector<float> row_weights;

  /// w_uv of eq. 4.2: exp(−Δ / 2σ²) has a factor per column and one per row.
  [[nodiscard]] float weight(int u, int v) const {
    return column_weights[static_cast<std::size_t>(u)] * row_weights[static_cast<std::size_t>(v)];
  }
  /// World point of a depth at pixel (u, v).
  [[nodiscard]] Eigen::Vector3f back_project(int u, int v, float depth_m) const {
    return (T_world_camera * (camera.ray(u, v) * static_cast<double>(depth_m))).cast<float>();
  }
};

struct SeenPixel {
  int u{0};
  int v{0};
};

/// Calls visit(surfel, pixels) for the surfels whose cells are in rows [begin, end), pixels in row-major order. Over
/// all rows each surfel that was seen comes once, so that rows can be taken by several threads.
template <class Visit>
void for_each_seen_surfel(const SurfelAssociation& seen, int begin, int end, Visit&& visit) {
  constexpr int kReach{SurfelAssociation::kReach_px};
  std::array<SeenPixel, (2 * kReach + 1) * (2 * kReach + 1)> pixels;
  const int width = seen.of_pixel.width();
  for (int v = begin; v < end; ++v) {
    const int last_row = std::min(v + kReach, seen.of_pixel.height() - 1);
    for (int u = 0; u < width; ++u) {
      const SurfelId own = seen.of_pixel(u, v);
      if (own != kNoSurfel && own >= seen.first_new) {
        pixels[0] = {u, v};
        visit(own, std::span<const SeenPixel>{pixels.data(), 1});
      }
      const SurfelId surfel = seen.of_cell(u, v);
      if (surfel == kNoSurfel) continue;
      std::size_t count{0};
      for (int row = std::max(v - kReach, 0); row <= last_row; ++row) {
        for (int column = std::max(u - kReach, 0); column <= std::min(u + kReach, width - 1); ++column) {
          if (seen.of_pixel(column, row) == surfel) pixels[count++] = {column, row};
        }
      }
      if (count > 0) visit(surfel, std::span<const SeenPixel>{pixels.data(), count});
    }
  }
}

/// Weighted mean of eq. 4.1, 4.5 and 4.6.
inline Eigen::Vector3f weighted_mean(const Eigen::Vector3f& a, float weight_a, const Eigen::Vector3f& b,
                                     float weight_b) {
  return (a * weight_a + b * weight_b) / (weight_a + weight_b);
}

/// An 8-bit colour in [0, 1].
inline Eigen::Vector3f unit_color(const Rgb8& color) {
  return Eigen::Vector3f{static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2])} /
         255.0F;
}

}  // namespace saccade
