// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfelAssociation: which surfel each pixel of a frame saw; BackProjection; for_each_seen_surfel: the pixels that saw
// one surfel.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
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
  /// Bit i: the i-th pixel around the cell, row by row, saw the cell's surfel. Bit kNewSurfel: the pixel made its own.
  Image<std::uint16_t> seen_by;
  static constexpr int kNewSurfel{9};
  std::size_t first_new{0};  ///< surfels from here on were made by this frame, each by its one pixel
  std::size_t surfels{0};    ///< ids are below
  std::vector<float> column_weights;
  std::vector<float> row_weights;

  /// w_uv of eq. 4.2: exp(−Δ / 2σ²) has a factor per column and one per row.
  [[nodiscard]] float weight(int u, int v) const {
    return column_weights[static_cast<std::size_t>(u)] * row_weights[static_cast<std::size_t>(v)];
  }
};

/// World points of depths, in single precision.
struct BackProjection {
  explicit BackProjection(const SurfelAssociation& seen)
      : R_world_camera{seen.T_world_camera.linear().cast<float>()},
        center_world{seen.T_world_camera.translation().cast<float>()},
        inverse_fx{static_cast<float>(1.0 / seen.camera.fx)},
        inverse_fy{static_cast<float>(1.0 / seen.camera.fy)},
        cx{static_cast<float>(seen.camera.cx)},
        cy{static_cast<float>(seen.camera.cy)} {}

  [[nodiscard]] Eigen::Vector3f operator()(int u, int v, float depth_m) const {
    const float x = (static_cast<float>(u) - cx) * inverse_fx;
    const float y = (static_cast<float>(v) - cy) * inverse_fy;
    return center_world + R_world_camera * Eigen::Vector3f{x * depth_m, y * depth_m, depth_m};
  }

  Eigen::Matrix3f R_world_camera;
  Eigen::Vector3f center_world;
  float inverse_fx, inverse_fy, cx, cy;
};

struct SeenPixel {
  int u{0};
  int v{0};
};

/// Calls visit(surfel, pixels) for the surfels whose cells are in rows [begin, end), pixels in row-major order. Over
/// all rows each surfel that was seen comes once, so that rows can be taken by several threads. Calls fetch(surfel, u,
/// v) some cells ahead: what lies side by side in the image is far apart in memory.
template <class Fetch, class Visit>
void for_each_seen_surfel(const SurfelAssociation& seen, int begin, int end, Fetch&& fetch, Visit&& visit) {
  constexpr int kCellsAhead{16};
  constexpr std::array<int, SurfelAssociation::kNewSurfel> kColumns{-1, 0, 1, -1, 0, 1, -1, 0, 1};
  constexpr std::array<int, SurfelAssociation::kNewSurfel> kRows{-1, -1, -1, 0, 0, 0, 1, 1, 1};
  std::array<SeenPixel, SurfelAssociation::kNewSurfel> pixels;
  const int width = seen.of_pixel.width();
  for (int v = begin; v < end; ++v) {
    const std::uint16_t* row = seen.seen_by.row(v);
    const SurfelId* cells = seen.of_cell.row(v);
    for (int u = 0; u < width; ++u) {
      if (u + kCellsAhead < width && cells[u + kCellsAhead] != kNoSurfel)
        fetch(cells[u + kCellsAhead], u + kCellsAhead, v);
      unsigned bits = row[u];
      if (bits == 0) continue;
      if ((bits >> SurfelAssociation::kNewSurfel) != 0) {
        pixels[0] = {u, v};
        visit(seen.of_pixel(u, v), std::span<const SeenPixel>{pixels.data(), 1});
        bits &= (1U << SurfelAssociation::kNewSurfel) - 1U;
        if (bits == 0) continue;
      }
      std::size_t count{0};
      for (; bits != 0; bits &= bits - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(bits));
        pixels[count].u = u + kColumns[i];
        pixels[count++].v = v + kRows[i];
      }
      visit(cells[u], std::span<const SeenPixel>{pixels.data(), count});
    }
  }
}

/// A pixel, and the surfel that it saw.
struct SurfelPixel {
  SurfelId id;
  std::uint16_t u, v;
};

/// The pixels that saw surfels, in rounds: the k-th has the k-th pixel, in row-major order, of each surfel that was
/// seen by more than k, so that within a round no surfel comes twice.
class SeenRounds {
 public:
  /// Of the surfels whose cells are in rows [begin, end), row by row.
  void collect(const SurfelAssociation& seen, int begin, int end);
  [[nodiscard]] const std::array<std::vector<SurfelPixel>, SurfelAssociation::kNewSurfel>& rounds() const {
    return rounds_;
  }

 private:
  std::array<std::vector<SurfelPixel>, SurfelAssociation::kNewSurfel> rounds_;
};

/// Weighted mean of eq. 4.1, 4.5 and 4.6.
inline Eigen::Vector3f weighted_mean(const Eigen::Vector3f& a, float weight_a, const Eigen::Vector3f& b,
                                     float weight_b) {
  return a + (b - a) * (weight_b / (weight_a + weight_b));
}

/// An 8-bit colour in [0, 1].
inline Eigen::Vector3f unit_color(const Rgb8& color) {
  return Eigen::Vector3f{static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2])} /
         255.0F;
}

}  // namespace saccade
