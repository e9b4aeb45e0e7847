// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/convex_cover.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade {
namespace {

using Corner = std::size_t;
using Edge = std::pair<Corner, Corner>;

constexpr int kSupportDirections{240};
constexpr double kThinnest_m{1e-3};    ///< side of a box around flat points
constexpr double kFlatShare{1e-3};     ///< points thinner than this share of the longest side are flat
constexpr double kJitter{1e-4};        ///< as a share of the size, so that no four corners lie in one plane
constexpr double kMostEnlarged{1.25};  ///< beyond, the hull has failed and the box is taken

/// Face of a hull; its normal, not normalised, points outwards.
struct HullFace {
  std::array<Corner, 3> corners;
  Eigen::Vector3d normal;
  double offset;
};

/// Returns directions spread evenly (Fibonacci's spiral), then both ways along each axis.
std::vector<Eigen::Vector3d> support_directions() {
  std::vector<Eigen::Vector3d> directions;
  for (int i = 0; i < kSupportDirections; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / kSupportDirections;
    const double turn = 2.0 * std::numbers::pi * i / std::numbers::phi;
    const double r = std::sqrt(1.0 - z * z);
    directions.emplace_back(r * std::cos(turn), r * std::sin(turn), z);
  }
  for (int axis = 0; axis < 3; ++axis) {
    directions.push_back(Eigen::Vector3d::Unit(axis));
    directions.push_back(-Eigen::Vector3d::Unit(axis));
  }
  return directions;
}

/// Returns the farthest points in the directions, each once, moved outwards a little and differently.
std::vector<Eigen::Vector3d> extreme_points(std::span<const Eigen::Vector3f> points, const Eigen::Vector3d& middle) {
  std::set<std::size_t> chosen;
  for (const Eigen::Vector3d& direction : support_directions()) {
    const Eigen::Vector3f along = direction.cast<float>();
    const auto less = [&along](const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
      return a.dot(along) < b.dot(along);
    };
    chosen.insert(static_cast<std::size_t>(std::max_element(points.begin(), points.end(), less) - points.begin()));
  }
  std::vector<Eigen::Vector3d> extreme;
  for (const std::size_t i : chosen) {
    const double turn = std::numbers::phi * static_cast<double>(extreme.size() + 1);
    const double outwards = 1.0 + kJitter * (turn - std::floor(turn));
    extreme.push_back(middle + outwards * (points[i].cast<double>() - middle));
  }
  return extreme;
}

/// Hull of points of which no four lie in one plane, built point by point.
class Hull {
 public:
  explicit Hull(std::vector<Eigen::Vector3d> corners) : corners_{std::move(corners)} {}

  /// Builds the hull; false where the points are too few or flat.
  bool build(double size) {
    if (!start(size)) return false;
    for (Corner i = 0; i < corners_.size(); ++i) add(i);
    return true;
  }
  [[nodiscard]] const std::vector<HullFace>& faces() const { return faces_; }
  [[nodiscard]] const std::vector<Eigen::Vector3d>& corners() const { return corners_; }

 private:
  [[nodiscard]] HullFace face(Corner a, Corner b, Corner c) const {
    const Eigen::Vector3d normal = (corners_[b] - corners_[a]).cross(corners_[c] - corners_[a]);
    return {{a, b, c}, normal, normal.dot(corners_[a])};
  }

  /// Makes the first four faces: the two farthest points, the farthest from their line, the farthest from their plane.
  bool start(double size) {
    if (corners_.size() < 4) return false;
    const auto farthest = [this](const auto& distance) {
      Corner best{0};
      for (Corner i = 1; i < corners_.size(); ++i) best = distance(i) > distance(best) ? i : best;
      return best;
    };
    const Corner a = farthest([this](Corner i) { return (corners_[i] - corners_[0]).norm(); });
    const Corner b = farthest([&](Corner i) { return (corners_[i] - corners_[a]).norm(); });
    const Eigen::Vector3d line = (corners_[b] - corners_[a]).normalized();
    const Corner c = farthest([&](Corner i) { return (corners_[i] - corners_[a]).cross(line).norm(); });
    const Eigen::Vector3d normal = (corners_[b] - corners_[a]).cross(corners_[c] - corners_[a]).normalized();
    const auto height = [&](Corner i) { return normal.dot(corners_[i] - corners_[a]); };
    const Corner d = farthest([&](Corner i) { return std::abs(height(i)); });
    if (!(std::abs(height(d)) > kFlatShare * size)) return false;
    const auto [p, q] = height(d) < 0.0 ? Edge{b, c} : Edge{c, b};
    faces_ = {face(a, p, q), face(a, d, p), face(p, d, q), face(q, d, a)};
    return true;
  }

  /// Replaces the faces that see a point by a cone from it to their rim.
  void add(Corner i) {
    std::set<Edge> rim;
    std::vector<HullFace> kept;
    for (const HullFace& each : faces_) {
      const auto [a, b, c] = each.corners;
      const bool sees = i != a && i != b && i != c && each.normal.dot(corners_[i]) > each.offset;
      if (!sees) {
        kept.push_back(each);
        continue;
      }
      for (const Edge& edge : {Edge{a, b}, Edge{b, c}, Edge{c, a}}) {
        if (rim.erase({edge.second, edge.first}) == 0) rim.insert(edge);
      }
    }
    if (rim.empty()) return;
    faces_ = std::move(kept);
    for (const auto& [from, to] : rim) faces_.push_back(face(from, to, i));
  }

  std::vector<Eigen::Vector3d> corners_;
  std::vector<HullFace> faces_;
};

/// Returns the factor by which a hull must grow about its middle to enclose the points.
double enlargement(const Hull& hull, const Eigen::Vector3d& middle, std::span<const Eigen::Vector3f> points) {
  double factor{1.0};
  for (const HullFace& face : hull.faces()) {
    const double depth = face.offset - face.normal.dot(middle);
    if (!(depth > 0.0)) return 2.0 * kMostEnlarged;
    for (const Eigen::Vector3f& point : points) {
      factor = std::max(factor, face.normal.dot(point.cast<double>() - middle) / depth);
    }
  }
  return factor;
}

TriangleMesh box_around(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  const Eigen::Vector3d middle = 0.5 * (low + high);
  const Eigen::Vector3d half = (0.5 * (high - low)).cwiseMax(0.5 * kThinnest_m);
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d sign{(i & 1) != 0 ? 1.0 : -1.0, (i & 2) != 0 ? 1.0 : -1.0, (i & 4) != 0 ? 1.0 : -1.0};
    mesh.vertices.push_back((middle + sign.cwiseProduct(half)).cast<float>());
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

}  // namespace

TriangleMesh convex_cover(std::span<const Eigen::Vector3f> points) {
  SACCADE_EXPECTS(!points.empty());
  Eigen::Vector3d low = points.front().cast<double>();
  Eigen::Vector3d high = low;
  for (const Eigen::Vector3f& point : points) {
    low = low.cwiseMin(point.cast<double>());
    high = high.cwiseMax(point.cast<double>());
  }
  const double size = (high - low).maxCoeff();
  if ((high - low).minCoeff() <= kFlatShare * size) return box_around(low, high);
  Hull hull{extreme_points(points, 0.5 * (low + high))};
  if (!hull.build(size)) return box_around(low, high);
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& corner : hull.corners()) middle += corner / static_cast<double>(hull.corners().size());
  const double factor = enlargement(hull, middle, points);
  if (factor > kMostEnlarged) return box_around(low, high);
  TriangleMesh mesh;
  constexpr double kRounding{1e-6};
  for (const Eigen::Vector3d& corner : hull.corners()) {
    mesh.vertices.push_back((middle + factor * (1.0 + kRounding) * (corner - middle)).cast<float>());
  }
  for (const HullFace& face : hull.faces()) {
    const auto [a, b, c] = face.corners;
    mesh.triangles.push_back(
        {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(c)});
  }
  return mesh;
}

}  // namespace saccade
