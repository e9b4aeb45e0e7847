// SPDX-License-Identifier: Apache-2.0
#pragma once
// DepthPanorama: how far discs lie from a place in every direction, on the six faces of a cube around it.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "saccade/core/uninitialized_vector.hpp"
#include "saccade/surfel/surfel_map.hpp"

namespace saccade {

/// Panorama of discs. Depth is measured along the axis of the face, as a camera behind it would. A disc covers the
/// pixel that its centre falls into, whatever its size and slant, and the pixels whose rays through their middle meet
/// it, from either side. A disc that is no farther along a face's axis than its diameter covers only the pixel of its
/// centre there; one nearer than kNear_m covers nothing.
class DepthPanorama {
 public:
  static constexpr float kNear_m{0.01F};
  static constexpr float kNothing{std::numeric_limits<float>::infinity()};

  /// Makes a panorama of all pixels.
  /// @param edge_px pixels along the edges of the faces
  DepthPanorama(const Eigen::Vector3f& place_m, int edge_px);
  /// Makes a panorama of the pixels that these points fall on; others are never drawn, nor may they be read.
  DepthPanorama(const Eigen::Vector3f& place_m, int edge_px, std::span<const Eigen::Vector3f> points_m);

  /// Position of a point relative to a face: across it, and along its axis.
  struct OnFace {
    float x, y, z;
  };
  /// Returns the face on which a point (relative to the place) falls.
  [[nodiscard]] static int face_of(const Eigen::Vector3f& p) {
    int axis{0};
    if (std::abs(p.y()) > std::abs(p[axis])) axis = 1;
    if (std::abs(p.z()) > std::abs(p[axis])) axis = 2;
    return 2 * axis + (p[axis] < 0.0F ? 1 : 0);
  }
  [[nodiscard]] static OnFace on_face(const Eigen::Vector3f& p, int face) {
    const int axis = face / 2;
    return {p[(axis + 1) % 3], p[(axis + 2) % 3], face % 2 == 0 ? p[axis] : -p[axis]};
  }
  /// Returns the coordinate, within −1 and 1, of a pixel's middle; and the pixel of a coordinate.
  [[nodiscard]] float middle(int pixel) const {
    return (2.0F * static_cast<float>(pixel) + 1.0F) / static_cast<float>(edge_px_) - 1.0F;
  }
  [[nodiscard]] int pixel(float coordinate) const {
    return std::clamp(static_cast<int>(0.5F * (coordinate + 1.0F) * static_cast<float>(edge_px_)), 0, edge_px_ - 1);
  }

  /// Draws discs. O(discs + covered pixels).
  void add(std::span<const SurfelDisc> discs);

  /// Returns the depth of a point, and of the nearest disc at its pixel; kNothing: there is none. The latter expects a
  /// point whose pixel is drawn.
  [[nodiscard]] float depth_m(const Eigen::Vector3f& p_m) const { return (p_m - place_m_).cwiseAbs().maxCoeff(); }
  [[nodiscard]] float nearest_m(const Eigen::Vector3f& p_m) const;

  [[nodiscard]] int edge_px() const { return edge_px_; }
  /// Returns the depths by index().
  [[nodiscard]] std::span<const float> depths_m() const { return depth_m_; }
  [[nodiscard]] std::size_t index(int face, int x, int y) const {
    const auto edge = static_cast<std::size_t>(edge_px_);
    return (static_cast<std::size_t>(face) * edge + static_cast<std::size_t>(y)) * edge + static_cast<std::size_t>(x);
  }

 private:
  [[nodiscard]] std::size_t size() const {
    return 6 * static_cast<std::size_t>(edge_px_) * static_cast<std::size_t>(edge_px_);
  }
  /// Returns the pixel of a point relative to the place; nullopt at the place itself.
  [[nodiscard]] std::optional<std::size_t> index_of(const Eigen::Vector3f& p) const;
  [[nodiscard]] bool is_drawn(std::size_t index) const { return ((drawn_[index / 64] >> (index % 64)) & 1U) != 0; }
  void put(std::size_t index, float depth_m) {
    if (is_drawn(index)) depth_m_[index] = std::min(depth_m_[index], depth_m);
  }
  void add_wide(const SurfelDisc& disc, const Eigen::Vector3f& p, int face);

  Eigen::Vector3f place_m_;
  int edge_px_;
  std::vector<std::uint64_t> drawn_;    ///< a bit per pixel: few panoramas ask for many of them
  UninitializedVector<float> depth_m_;  ///< faces, rows (y), columns (x); set where pixels are drawn
};

}  // namespace saccade
