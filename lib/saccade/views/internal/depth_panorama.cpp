// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/depth_panorama.hpp"

namespace saccade {

DepthPanorama::DepthPanorama(const Eigen::Vector3f& place_m, int edge_px)
    : place_m_{place_m}, edge_px_{edge_px}, drawn_(size() / 64 + 1, ~std::uint64_t{0}) {
  depth_m_.resize(size());
  std::fill(depth_m_.begin(), depth_m_.end(), kNothing);
}

DepthPanorama::DepthPanorama(const Eigen::Vector3f& place_m, int edge_px, std::span<const Eigen::Vector3f> points_m)
    : place_m_{place_m}, edge_px_{edge_px}, drawn_(size() / 64 + 1) {
  depth_m_.resize(size());
  for (const Eigen::Vector3f& point : points_m) {
    const std::optional<std::size_t> index = index_of(point - place_m_);
    if (!index) continue;
    drawn_[*index / 64] |= std::uint64_t{1} << (*index % 64);
    depth_m_[*index] = kNothing;
  }
}

std::optional<std::size_t> DepthPanorama::index_of(const Eigen::Vector3f& p) const {
  const int face = face_of(p);
  const OnFace at = on_face(p, face);
  if (!(at.z > 0.0F)) return std::nullopt;
  return index(face, pixel(at.x / at.z), pixel(at.y / at.z));
}

void DepthPanorama::add(std::span<const SurfelDisc> discs) {
  const float half_edge = 0.5F * static_cast<float>(edge_px_);
  for (const SurfelDisc& disc : discs) {
    const Eigen::Vector3f p = disc.position_m - place_m_;
    const int face = face_of(p);
    const OnFace at = on_face(p, face);
    if (!(at.z > kNear_m)) continue;
    const float x = at.x / at.z;
    const float y = at.y / at.z;
    put(index(face, pixel(x), pixel(y)), at.z);
    // Balls of smaller discs reach the middle of no other pixel, at the corner of a face either.
    if (!(disc.radius_m * half_edge > 0.25F * (at.z - disc.radius_m))) continue;
    const float reach = 4.0F * disc.radius_m / at.z;  // across the face, at its corner and at half the depth
    const bool stays = std::max(std::abs(x), std::abs(y)) + reach < 1.0F;
    if (stays) {
      add_wide(disc, p, face);
    } else {
      for (int other = 0; other < 6; ++other) add_wide(disc, p, other);
    }
  }
}

void DepthPanorama::add_wide(const SurfelDisc& disc, const Eigen::Vector3f& p, int face) {
  const OnFace at = on_face(p, face);
  const float radius_m = disc.radius_m;
  if (!(at.z > 2.0F * radius_m)) return;
  const auto bounds = [&](float across, int& first, int& last) {
    // Bounds of the ball around the disc, at its nearest depth, hence never too small.
    const float middle = across / at.z;
    const float reach = radius_m * (1.0F + std::abs(middle)) / (at.z - radius_m);
    first = middle - reach >= 1.0F ? edge_px_ : pixel(std::max(middle - reach, -1.0F));
    last = middle + reach <= -1.0F ? -1 : pixel(std::min(middle + reach, 1.0F));
  };
  int x0{0};
  int x1{0};
  int y0{0};
  int y1{0};
  bounds(at.x, x0, x1);
  bounds(at.y, y0, y1);
  const OnFace n = on_face(disc.normal, face);
  const float to_plane = n.x * at.x + n.y * at.y + n.z * at.z;
  const float squared_m2 = radius_m * radius_m;
  for (int y = y0; y <= y1; ++y) {
    const float b = middle(y);
    for (int x = x0; x <= x1; ++x) {
      if (!is_drawn(index(face, x, y))) continue;
      const float a = middle(x);
      const float z = to_plane / (n.x * a + n.y * b + n.z);
      const float dx = z * a - at.x;
      const float dy = z * b - at.y;
      const float dz = z - at.z;
      if (z > kNear_m && dx * dx + dy * dy + dz * dz <= squared_m2) put(index(face, x, y), z);
    }
  }
}

float DepthPanorama::nearest_m(const Eigen::Vector3f& p_m) const {
  const std::optional<std::size_t> index = index_of(p_m - place_m_);
  return index ? depth_m_[*index] : kNothing;
}

}  // namespace saccade
