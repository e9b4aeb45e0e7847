// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/internal/lathe.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace saccade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kTwoPi{2.0 * std::numbers::pi};

/// Vertices of one ring: `count` of them from `first` on; a single vertex is a point on the axis.
struct Ring {
  std::uint32_t first{0};
  std::uint32_t count{1};
  [[nodiscard]] std::uint32_t operator[](std::uint32_t i) const { return count == 1 ? first : first + i % count; }
};

/// Adds the strip between two rings, counter-clockwise seen from the right of lower → upper.
void add_strip(const Ring& lower, const Ring& upper, TriangleMesh& mesh) {
  const std::uint32_t count = std::max(lower.count, upper.count);
  if (count == 1) return;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (lower.count > 1) mesh.triangles.push_back({lower[i], lower[i + 1], upper[i]});
    if (upper.count > 1) mesh.triangles.push_back({lower[i + 1], upper[i + 1], upper[i]});
  }
}

}  // namespace

int sides_of_circle(double radius_m, double max_deviation_m) {
  constexpr int kFewest{8};
  constexpr int kMost{1024};
  if (max_deviation_m >= radius_m) return kFewest;
  const double half_side_rad = std::acos(1.0 - max_deviation_m / radius_m);
  return static_cast<int>(std::clamp(std::ceil(std::numbers::pi / half_side_rad), 1.0 * kFewest, 1.0 * kMost));
}

double profile_radius_m(const std::vector<Vector2d>& profile_m, double height_m) {
  SACCADE_EXPECTS(!profile_m.empty());
  if (height_m <= profile_m.front().y()) return profile_m.front().x();
  for (std::size_t i = 1; i < profile_m.size(); ++i) {
    const Vector2d& below = profile_m[i - 1];
    const Vector2d& above = profile_m[i];
    if (height_m > above.y()) continue;
    return below.x() + (height_m - below.y()) / (above.y() - below.y()) * (above.x() - below.x());
  }
  return profile_m.back().x();
}

TriangleMesh turned(const std::vector<Vector2d>& outline_m, int sides) {
  SACCADE_EXPECTS(sides >= 3);
  TriangleMesh mesh;
  Ring before;
  for (std::size_t i = 0; i < outline_m.size(); ++i) {
    const auto& [radius_m, height_m] = std::pair{outline_m[i].x(), outline_m[i].y()};
    const Ring ring{static_cast<std::uint32_t>(mesh.vertices.size()),
                    radius_m > 0.0 ? static_cast<std::uint32_t>(sides) : 1U};
    for (std::uint32_t side = 0; side < ring.count; ++side) {
      const double angle_rad = kTwoPi * side / sides;
      mesh.vertices.push_back(
          Vector3d{radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), height_m}.cast<float>());
    }
    if (i > 0) add_strip(before, ring, mesh);
    before = ring;
  }
  return mesh;
}

TriangleMesh bent_bar(const std::vector<Vector2d>& axis_m, double radius_m, int sides) {
  SACCADE_EXPECTS(axis_m.size() >= 2 && sides >= 3);
  TriangleMesh mesh;
  const auto add_vertex = [&](const Vector2d& p, const Vector2d& across, double along_across_m, double y_m) {
    const Vector2d moved = p + along_across_m * across;
    mesh.vertices.push_back(Vector3d{moved.x(), y_m, moved.y()}.cast<float>());
  };
  const auto across_at = [&](std::size_t i) {
    const Vector2d tangent = axis_m[std::min(i + 1, axis_m.size() - 1)] - axis_m[i == 0 ? 0 : i - 1];
    return Vector2d{Vector2d{tangent.y(), -tangent.x()}.normalized()};
  };
  Ring before{0, 1};
  add_vertex(axis_m.front(), across_at(0), 0.0, 0.0);
  for (std::size_t i = 0; i < axis_m.size(); ++i) {
    const Ring ring{static_cast<std::uint32_t>(mesh.vertices.size()), static_cast<std::uint32_t>(sides)};
    for (int side = 0; side < sides; ++side) {
      const double angle_rad = kTwoPi * side / sides;
      add_vertex(axis_m[i], across_at(i), radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad));
    }
    add_strip(before, ring, mesh);
    before = ring;
  }
  const Ring end{static_cast<std::uint32_t>(mesh.vertices.size()), 1};
  add_vertex(axis_m.back(), across_at(axis_m.size() - 1), 0.0, 0.0);
  add_strip(before, end, mesh);
  return mesh;
}

}  // namespace saccade
