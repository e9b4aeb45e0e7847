// SPDX-License-Identifier: Apache-2.0
#pragma once
// SurfelAssociation: the surfel that each pixel of a frame saw. SeenRounds: the pixels that saw surfels, in rounds
// without repeated surfels. BackProjection.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "saccade/core/pose.hpp"
#include "saccade/core/uninitialized_vector.hpp"
#include "saccade/sensor/image.hpp"
#include "saccade/sensor/pinhole_camera.hpp"
#include "saccade/surfel/surfel_map.hpp"

namespace saccade {

/// Pixel and the surfel that it saw.
struct SurfelPixel {
  SurfelId id;
  std::uint16_t u, v;
};

/// Rounds of pixels. Round k holds the k-th pixel, in row-major order, of each surfel seen by more than k pixels. No
/// surfel occurs twice within a round, so a batch can be processed at once. A surfel's pixels are in the cells around
/// its own.
using SeenRounds = std::array<UninitializedVector<SurfelPixel>, 9>;

/// Association s_{f,uv} of one frame (thesis §4.1.1), with positions and weights of the observations.
struct SurfelAssociation {
  static constexpr int kReach_px{1};  ///< largest distance between a pixel and the cell of its surfel

  PinholeCamera camera;
  Pose T_world_camera{Pose::Identity()};
  Image<SurfelId> of_pixel;  ///< the surfel that the pixel saw, or kNoSurfel
  Image<SurfelId> of_cell;   ///< the surfel that fills the cell of the index image, or kNoSurfel
  /// All pixels that saw a surfel, in groups: group g holds the surfels whose cells are in rows from kRowsAtOnce · g
  /// on. Different threads may process different groups.
  std::vector<SeenRounds> groups;
  static constexpr int kRowsAtOnce{4};  ///< keeps the data of a group in a near cache
  static constexpr std::size_t kGroupsPerTask{4};
  std::size_t first_new{0};  ///< ids from here on were created by this frame, one per pixel
  std::size_t surfels{0};    ///< ids are below this number
  std::vector<float> column_weights;
  std::vector<float> row_weights;

  /// Returns w_uv of eq. 4.2: exp(−Δ / 2σ²) is the product of a factor per column and one per row.
  [[nodiscard]] float weight(int u, int v) const {
    return column_weights[static_cast<std::size_t>(u)] * row_weights[static_cast<std::size_t>(v)];
  }

  /// Computes groups[g] from of_cell and of_pixel.
  void collect(std::size_t g);
};

/// Back-projection of depths to world points, in single precision.
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

/// Returns the weighted mean of eq. 4.1, 4.5 and 4.6.
inline Eigen::Vector3f weighted_mean(const Eigen::Vector3f& a, float weight_a, const Eigen::Vector3f& b,
                                     float weight_b) {
  return a + (b - a) * (weight_b / (weight_a + weight_b));
}

/// Converts an 8-bit colour to [0, 1].
inline Eigen::Vector3f unit_color(const Rgb8& color) {
  return Eigen::Vector3f{static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2])} /
         255.0F;
}

}  // namespace saccade
