// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/contours.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace saccade {
namespace {

constexpr std::size_t kDirections{5};
constexpr double kRollSlack{1e-9};  // a step that divides the circle to within rounding counts as dividing it
constexpr double kMostContourViews{1e7};

double rolls_of(double step_rad) { return std::max(1.0, std::ceil(360_deg / step_rad - kRollSlack)); }
bool is_distance(double x) { return std::isfinite(x) && x > 0.0; }
Error fail(const char* what) { return {Errc::invalid_argument, what, "contour views"}; }

/// Returns the normal, and directions tilted towards the right, top, left and bottom of an image taken along it.
std::array<Eigen::Vector3d, kDirections> directions_around(const Eigen::Vector3d& normal, double cone_rad) {
  const Eigen::Matrix3d axes = look_at(normal, Eigen::Vector3d::Zero()).linear();
  const Eigen::Vector3d ahead = std::cos(cone_rad) * normal;
  const Eigen::Vector3d right = std::sin(cone_rad) * axes.col(0);
  const Eigen::Vector3d down = std::sin(cone_rad) * axes.col(1);
  return {normal, ahead + right, ahead - down, ahead - right, ahead + down};
}

}  // namespace

Status ContourViewConfig::validate() const {
  if (distances_m.empty()) return fail("at least one distance is needed");
  if (!std::all_of(distances_m.begin(), distances_m.end(), is_distance)) return fail("distances must be positive");
  if (!(cone_rad > 0.0 && cone_rad < 90_deg)) return fail("cone_rad must lie between 0 and 90 deg");
  if (!is_distance(roll_step_rad)) return fail("roll_step_rad must be positive");
  if (static_cast<double>(kDirections * distances_m.size()) * rolls_of(roll_step_rad) > kMostContourViews) {
    return fail("the steps give more than ten million poses per point; make them larger");
  }
  return {};
}

std::size_t ContourViewConfig::views_per_point() const {
  return kDirections * distances_m.size() * static_cast<std::size_t>(rolls_of(roll_step_rad));
}

Result<std::vector<Pose>> contour_views(std::span<const ContourPoint> points, const ContourViewConfig& config) {
  SACCADE_CHECK(config.validate());
  if (static_cast<double>(points.size()) * static_cast<double>(config.views_per_point()) > kMostContourViews) {
    return fail("more than ten million poses; group the contours more coarsely");
  }
  const auto rolls = static_cast<int>(rolls_of(config.roll_step_rad));
  std::vector<Pose> poses;
  poses.reserve(points.size() * config.views_per_point());
  for (const ContourPoint& point : points) {
    const double length = point.normal.norm();
    if (!point.position_m.allFinite() || !std::isfinite(length)) return fail("a point contains NaN or infinity");
    if (length == 0.0) return fail("a point has a normal without length");
    const auto directions = directions_around(point.normal / length, config.cone_rad);
    for (const double distance_m : config.distances_m) {
      for (const Eigen::Vector3d& direction : directions) {
        for (int roll = 0; roll < rolls; ++roll) {
          poses.push_back(look_at(point.position_m + distance_m * direction, point.position_m, Eigen::Vector3d::UnitZ(),
                                  roll * config.roll_step_rad));
        }
      }
    }
  }
  return poses;
}

}  // namespace saccade
