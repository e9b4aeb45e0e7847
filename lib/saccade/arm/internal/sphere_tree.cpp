// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/sphere_tree.hpp"

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <limits>
#include <numbers>

#include "saccade/map/mesh.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;
using Polygon = std::vector<Vector3d>;
using Triangle = std::array<Vector3d, 3>;

constexpr std::size_t kMostBalls{std::size_t{1} << 16U};
constexpr double kFlat_m{1e-5};      ///< deviation up to which a body counts as convex
constexpr double kRounding_m{2e-5};  ///< added to every radius; exceeds the error of float coordinates and flat sides

/// Cuboid of space, the body's surface in it, and its corners inside the body.
struct Cell {
  Vector3d low;
  Vector3d high;
  std::vector<Polygon> surface;
  std::bitset<8> inside;  // bit x + 2 y + 4 z

  [[nodiscard]] Vector3d corner(int i) const {
    return {(i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(), (i & 4) != 0 ? high.z() : low.z()};
  }
};

/// Solid angle that the triangle subtends at p, signed (van Oosterom and Strackee 1983).
double solid_angle(const Triangle& t, const Vector3d& p) {
  const Vector3d a = t[0] - p;
  const Vector3d b = t[1] - p;
  const Vector3d c = t[2] - p;
  const double la = a.norm();
  const double lb = b.norm();
  const double lc = c.norm();
  return 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

bool is_inside(const std::vector<Triangle>& body, const Vector3d& p) {
  double total = 0.0;
  for (const Triangle& t : body) total += solid_angle(t, p);
  return std::fabs(total) > 2.0 * std::numbers::pi;
}

/// Returns the part of a convex polygon on one side of the plane where coordinate `axis` is `at` (Sutherland and
/// Hodgman 1974).
Polygon clipped(const Polygon& polygon, int axis, double at, bool keep_low) {
  Polygon kept;
  const double sign = keep_low ? 1.0 : -1.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d& a = polygon[i];
    const Vector3d& b = polygon[(i + 1) % polygon.size()];
    const double over_a = sign * (a[axis] - at);
    const double over_b = sign * (b[axis] - at);
    if (over_a <= 0.0) kept.push_back(a);
    if ((over_a < 0.0 && over_b > 0.0) || (over_a > 0.0 && over_b < 0.0)) {
      Vector3d crossing = a + (b - a) * (over_a / (over_a - over_b));
      crossing[axis] = at;
      kept.push_back(crossing);
    }
  }
  return kept;
}

struct Ball {
  Vector3d center;
  double radius_m;
};

struct Farthest {
  std::size_t point{0};
  double squared_m2{0.0};
};

/// Returns the farthest of the points, the first of several.
Farthest farthest_from(const Vector3d& center, const std::vector<Vector3d>& points) {
  Farthest farthest;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (const double squared_m2 = (points[i] - center).squaredNorm(); squared_m2 > farthest.squared_m2) {
      farthest = {i, squared_m2};
    }
  }
  return farthest;
}

/// Returns a ball with this centre whose radius reaches all points.
Ball reaching(const Vector3d& center, const std::vector<Vector3d>& points) {
  return {center, std::sqrt(farthest_from(center, points).squared_m2)};
}

/// Returns a small ball around points: the centre moves towards the farthest by ever smaller steps (Bădoiu and Clarkson
/// 2003), and the radius reaches all of them.
Ball ball_around(const std::vector<Vector3d>& points) {
  constexpr int kSteps{64};
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : points) box.extend(p);
  Vector3d center = box.center();
  Farthest farthest = farthest_from(center, points);
  Ball best{center, std::sqrt(farthest.squared_m2)};
  for (int i = 1; i <= kSteps; ++i) {
    center += (points[farthest.point] - center) / (i + 1.0);
    farthest = farthest_from(center, points);
    if (const double radius_m = std::sqrt(farthest.squared_m2); radius_m < best.radius_m) best = {center, radius_m};
  }
  return best;
}

using Plane = Eigen::Hyperplane<double, 3>;

/// Returns the planes of the sides of a convex body, normals outwards; none for a body that is not convex.
std::vector<Plane> sides_of(const std::vector<Triangle>& body) {
  Vector3d middle = Vector3d::Zero();
  for (const Triangle& t : body) middle += (t[0] + t[1] + t[2]) / (3.0 * static_cast<double>(body.size()));
  std::vector<Plane> sides;
  for (const Triangle& t : body) {
    const Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
    if (normal.norm() <= 1e-12) continue;
    Plane side{normal.normalized(), t[0]};
    if (side.signedDistance(middle) > 0.0) side.coeffs() = -side.coeffs();
    const bool known = std::any_of(sides.begin(), sides.end(), [&](const Plane& other) {
      return (other.coeffs() - side.coeffs()).cwiseAbs().maxCoeff() < 1e-9;
    });
    if (!known) sides.push_back(side);
  }
  const auto holds_all = [&](const Plane& side) {
    return std::all_of(body.begin(), body.end(), [&](const Triangle& t) {
      return std::all_of(t.begin(), t.end(), [&](const Vector3d& p) { return side.signedDistance(p) <= kFlat_m; });
    });
  };
  if (sides.size() < 4 || !std::all_of(sides.begin(), sides.end(), holds_all)) sides.clear();
  return sides;
}

class Builder {
 public:
  Builder(std::vector<Triangle> body, double max_excess_m)
      : body_{std::move(body)}, sides_{sides_of(body_)}, max_excess_m_{max_excess_m} {}

  /// Builds the tree. Returns false when there would be too many balls.
  [[nodiscard]] bool build() {
    Cell all;
    Eigen::AlignedBox3d box;
    for (const Triangle& t : body_) {
      for (const Vector3d& p : t) box.extend(p);
      all.surface.emplace_back(t.begin(), t.end());
    }
    all.low = box.min();
    all.high = box.max();
    for (int i = 0; i < 8; ++i) all.inside[static_cast<std::size_t>(i)] = holds(all.corner(i));
    return add(all, 0);
  }

  [[nodiscard]] std::vector<TreeBall> take() { return std::move(balls_); }

 private:
  /// Adds the ball around the body's part in the cell, and those below it. A convex hull has its corners among those of
  /// the clipped surface and the cell's corners inside the body.
  /// @param halvings  number of times that the cell was halved; after kMostHalvings its ball stays as it is, since an
  /// open mesh has corners that seem to lie inside it anywhere.
  bool add(const Cell& cell, int halvings) {
    constexpr int kMostHalvings{60};  // a metre becomes a micrometre along each axis
    std::vector<Vector3d> points;
    for (const Polygon& polygon : cell.surface) points.insert(points.end(), polygon.begin(), polygon.end());
    for (int i = 0; i < 8; ++i) {
      if (cell.inside[static_cast<std::size_t>(i)]) points.push_back(cell.corner(i));
    }
    if (points.empty()) return true;
    if (balls_.size() == kMostBalls) return false;
    const Ball around = ball_around(points);
    const Ball deeper = sunk(around, points);
    const bool tight = excess_m(deeper) <= max_excess_m_;
    const bool finest = tight || halvings == kMostHalvings;
    const Ball& ball = tight ? deeper : around;
    const std::size_t index = balls_.size();
    balls_.push_back({ball.center.cast<float>(), static_cast<float>(ball.radius_m + kRounding_m), 0, finest});
    if (!finest && !add_halves(cell, halvings + 1)) return false;
    balls_[index].next = static_cast<std::uint32_t>(balls_.size());
    return true;
  }

  bool add_halves(const Cell& cell, int halvings) {
    int axis = 0;
    (cell.high - cell.low).maxCoeff(&axis);
    const double at = 0.5 * (cell.low[axis] + cell.high[axis]);
    const auto bit = static_cast<std::size_t>(1 << axis);
    Cell low = cell;
    Cell high = cell;
    low.high[axis] = at;
    high.low[axis] = at;
    low.surface.clear();
    high.surface.clear();
    for (const Polygon& polygon : cell.surface) {
      if (Polygon part = clipped(polygon, axis, at, true); !part.empty()) low.surface.push_back(std::move(part));
      if (Polygon part = clipped(polygon, axis, at, false); !part.empty()) high.surface.push_back(std::move(part));
    }
    for (std::size_t i = 0; i < 8; ++i) {
      if ((i & bit) == 0) continue;
      const bool inside = cell.surface.empty() || holds(low.corner(static_cast<int>(i)));
      low.inside[i] = inside;
      high.inside[i ^ bit] = inside;
    }
    return add(low, halvings) && add(high, halvings);
  }

  /// Returns an upper bound of the distance of the ball's points from the body.
  [[nodiscard]] double excess_m(const Ball& ball) const { return ball.radius_m - depth(ball.center).first; }

  /// Returns the side of a convex body above which p is highest, or below which it is least.
  [[nodiscard]] const Plane* highest_side(const Vector3d& p) const {
    const Plane* highest = &sides_.front();
    double height_m = -std::numeric_limits<double>::infinity();
    for (const Plane& side : sides_) {
      const double over_m = side.signedDistance(p);
      if (over_m > height_m) {
        height_m = over_m;
        highest = &side;
      }
    }
    return highest;
  }

  [[nodiscard]] bool holds(const Vector3d& p) const {
    return sides_.empty() ? is_inside(body_, p) : highest_side(p)->signedDistance(p) <= 0.0;
  }

  /// Returns the depth of a point in the body, negative outside, and the direction inwards.
  [[nodiscard]] std::pair<double, Vector3d> depth(const Vector3d& p) const {
    if (!sides_.empty()) {
      const Plane* nearest = highest_side(p);
      return {-nearest->signedDistance(p), -nearest->normal()};
    }
    Vector3d nearest = Vector3d::Zero();
    double distance_m = std::numeric_limits<double>::infinity();
    for (const Triangle& t : body_) {
      const Vector3d candidate = closest_point_on_triangle(p, t[0], t[1], t[2]);
      if (const double d = (p - candidate).norm(); d < distance_m) {
        distance_m = d;
        nearest = candidate;
      }
    }
    const double sign = holds(p) ? 1.0 : -1.0;
    return {sign * distance_m, sign * (p - nearest).normalized()};
  }

  /// Returns a larger ball around these points that exceeds the body less, since its centre is deeper inside.
  [[nodiscard]] Ball sunk(const Ball& ball, const std::vector<Vector3d>& points) const {
    constexpr double kSteps[]{2.0, 1.0, 0.5, 0.25};
    Ball best = ball;
    auto [depth_m, inwards] = depth(ball.center);
    double least_m = ball.radius_m - depth_m;
    for (const double step : kSteps) {
      const Ball deeper = reaching(best.center + step * ball.radius_m * inwards, points);
      const auto [deeper_m, then_inwards] = depth(deeper.center);
      if (deeper.radius_m - deeper_m >= least_m) continue;
      best = deeper;
      least_m = deeper.radius_m - deeper_m;
      inwards = then_inwards;
    }
    return best;
  }

  std::vector<Triangle> body_;
  std::vector<Plane> sides_;  ///< empty where the body is not convex
  double max_excess_m_;
  std::vector<TreeBall> balls_;
};

Error invalid_body(std::string what) { return {Errc::invalid_argument, std::move(what), "sphere tree"}; }

}  // namespace

Result<SphereTree> SphereTree::build(const TriangleMesh& body, const SphereTreeConfig& config) {
  if (!(config.max_excess_m >= 1e-4) || !std::isfinite(config.max_excess_m)) {
    return invalid_body("max_excess_m must be a number of at least 0.0001");
  }
  if (body.triangles.empty()) return invalid_body("the body has no triangles");
  std::vector<Triangle> triangles;
  for (const auto& corners : body.triangles) {
    Triangle& t = triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      if (corners[i] >= body.vertices.size()) return invalid_body("a triangle names a vertex that does not exist");
      t[i] = body.vertices[corners[i]].cast<double>();
      if (!t[i].allFinite()) return invalid_body("a vertex is not finite");
    }
  }
  Builder builder{std::move(triangles), config.max_excess_m};
  if (!builder.build())
    return invalid_body("the body is too large for balls that exceed it by no more than max_excess_m");
  return SphereTree{builder.take()};
}

}  // namespace saccade
