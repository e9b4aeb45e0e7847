// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>

#include "saccade/core/angle.hpp"
#include "saccade/core/statistics.hpp"
#include "saccade/scene/surface_samples.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

/// Returns the largest value after dropping the `trimmed` largest.
float highest(const std::vector<float>& values, std::size_t trimmed) {
  constexpr float kNearEnd_m{0.01F};  // range of values to sort; nearly always enough
  const float end = *std::max_element(values.begin(), values.end());
  std::vector<float> top;
  std::copy_if(values.begin(), values.end(), std::back_inserter(top),
               [&](float value) { return value > end - kNearEnd_m; });
  if (top.size() <= trimmed) top = values;
  const auto at = top.begin() + static_cast<std::ptrdiff_t>(trimmed);
  std::nth_element(top.begin(), at, top.end(), std::greater<>{});
  return *at;
}

/// Returns the extent of the points along a horizontal direction.
double reach_m(const std::vector<Eigen::Vector3f>& points, double direction_deg, std::size_t trimmed,
               std::vector<float>& scratch) {
  const auto x = static_cast<float>(std::cos(to_rad(direction_deg)));
  const auto y = static_cast<float>(std::sin(to_rad(direction_deg)));
  scratch.clear();
  for (const Eigen::Vector3f& p : points) scratch.push_back(x * p.x() + y * p.y());
  return static_cast<double>(highest(scratch, trimmed));
}

struct Axes {
  double major_m;
  double minor_m;
};

/// Finds the smallest width, to 0.1°: first in whole degrees, then around the best. A handle hidden behind the body
/// leaves several directions of smallest width; the one with the largest length across is chosen.
Axes axes_of(const std::vector<Eigen::Vector3f>& points, std::size_t trimmed) {
  constexpr std::size_t kHalfTurn{180};
  constexpr double kAsNarrow_m{0.002};
  std::vector<float> scratch;
  scratch.reserve(points.size());
  // Width between two vertical planes that enclose the points.
  const auto width_at_m = [&](double degrees) {
    return reach_m(points, degrees, trimmed, scratch) + reach_m(points, degrees + kHalfTurn, trimmed, scratch);
  };
  std::vector<double> widths_m;
  for (std::size_t degree = 0; degree < kHalfTurn; ++degree) {
    widths_m.push_back(width_at_m(static_cast<double>(degree)));
  }
  const auto narrowest = std::min_element(widths_m.begin(), widths_m.end());
  const auto coarse = static_cast<double>(narrowest - widths_m.begin());
  std::pair<double, double> least{*narrowest, coarse};  // with its direction, degrees
  for (int step = -9; step <= 9; ++step) {
    const double degrees = coarse + 0.1 * step;
    least = std::min(least, {width_at_m(degrees), degrees});
  }
  double across_m = width_at_m(least.second + kHalfTurn / 2.0);
  for (std::size_t degree = 0; degree < kHalfTurn; ++degree) {
    if (widths_m[degree] > least.first + kAsNarrow_m) continue;
    across_m = std::max(across_m, widths_m[(degree + kHalfTurn / 2) % kHalfTurn]);
  }
  return {across_m, least.first};
}

}  // namespace

Status ObjectShapeConfig::validate() const {
  for (const double value : {reach_m, trimmed_m2, spacing_m}) {
    if (std::isfinite(value) && value > 0.0) continue;
    return Error{Errc::invalid_argument, "reach, trimmed area and spacing must be positive", "object shape"};
  }
  if (!(least_share >= 0.0 && least_share <= 1.0)) {
    return Error{Errc::invalid_argument, "the least share must be within 0 and 1", "object shape"};
  }
  return {};
}

Result<ObjectShapes> ObjectShapes::build(const RayScene& scene, const ObjectShapeConfig& config) {
  SACCADE_CHECK(config.validate());
  ObjectShapes shapes{scene, config};
  for (std::size_t i = 0; i < scene.meshes().size(); ++i) {
    const ObjectMesh& object = scene.meshes()[i];
    SACCADE_TRY(MeshDistance surface, MeshDistance::build(object.mesh));
    shapes.surfaces_.push_back(std::move(surface));
    if (object.support) continue;
    const std::vector<Eigen::Vector3f> points = sample_surfaces({object}, config.spacing_m).points;
    if (static_cast<double>(points.size()) * config.spacing_m * config.spacing_m <= 2.0 * config.trimmed_m2) {
      return Error{Errc::invalid_argument, "it is too small to be measured", "object " + object.name};
    }
    const double base_z_m = bounds_of(object.mesh).min.z();
    shapes.objects_.push_back(i);
    shapes.measured_.push_back({i, base_z_m, points.size(), shapes.shape_of(points, base_z_m)});
  }
  return shapes;
}

const ObjectShapes::Measured& ObjectShapes::of(std::size_t object) const {
  const auto found = std::find_if(measured_.begin(), measured_.end(),
                                  [object](const Measured& measured) { return measured.object == object; });
  SACCADE_EXPECTS(found != measured_.end());
  return *found;
}

const ObjectShape& ObjectShapes::true_shape(std::size_t object) const { return of(object).shape; }

ObjectShape ObjectShapes::shape_of(const std::vector<Eigen::Vector3f>& points, double base_z_m) const {
  const auto trimmed = static_cast<std::size_t>(config_.trimmed_m2 / (config_.spacing_m * config_.spacing_m));
  std::vector<float> z;
  z.reserve(points.size());
  for (const Eigen::Vector3f& p : points) z.push_back(p.z());
  const Axes axes = axes_of(points, trimmed);
  return {static_cast<double>(highest(z, trimmed)) - base_z_m, axes.major_m, axes.minor_m};
}

std::optional<ObjectShape> ObjectShapes::measure(std::size_t object, const TriangleMesh& mesh,
                                                 const Executor& executor) const {
  const Measured& truth = of(object);
  Box around = bounds_of(scene_.meshes()[object].mesh);
  around.min -= Vector3d::Constant(config_.reach_m);
  around.max += Vector3d::Constant(config_.reach_m);
  const std::vector<Eigen::Vector3f> near = sample_surfaces({{"mesh", mesh, false}}, config_.spacing_m, around).points;
  const auto belongs = [&](const Eigen::Vector3f& point) {
    const Vector3d p = point.cast<double>();
    const double to_object_m = surfaces_[object].distance_m(p, 2.0 * config_.reach_m);
    if (to_object_m > config_.reach_m) return false;
    for (std::size_t other = 0; other < surfaces_.size(); ++other) {
      // Points equally near to another surface belong to that one, so that a foot does not take part of the table.
      if (other != object && surfaces_[other].distance_m(p, 2.0 * config_.reach_m) <= to_object_m) return false;
    }
    return true;
  };
  std::vector<std::uint8_t> of_object(near.size());
  executor.parallel_for(near.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) of_object[i] = belongs(near[i]) ? 1 : 0;
  });
  std::vector<Eigen::Vector3f> points;
  for (std::size_t i = 0; i < near.size(); ++i) {
    if (of_object[i] != 0) points.push_back(near[i]);
  }
  const double points_trimmed = 2.0 * config_.trimmed_m2 / (config_.spacing_m * config_.spacing_m);
  const auto found = static_cast<double>(points.size());
  if (found <= points_trimmed + 1.0 || found < config_.least_share * static_cast<double>(truth.points)) {
    return std::nullopt;
  }
  return shape_of(points, truth.base_z_m);
}

ObjectShape shape_error(const ObjectShape& measured, const ObjectShape& truth) {
  return {measured.height_m - truth.height_m, measured.major_m - truth.major_m, measured.minor_m - truth.minor_m};
}

ShapeErrors summarize(std::span<const ObjectShape> errors) {
  std::vector<double> signed_m;
  for (const ObjectShape& error : errors) {
    signed_m.insert(signed_m.end(), {error.height_m, error.major_m, error.minor_m});
  }
  if (signed_m.empty()) return {};
  ShapeErrors summary;
  summary.parameters = signed_m.size();
  summary.standard_deviation_m = estimate_mean(signed_m).standard_deviation.value_or(0.0);
  for (const double error_m : signed_m) summary.mean_abs_m += std::abs(error_m);
  summary.mean_abs_m /= static_cast<double>(signed_m.size());
  return summary;
}

}  // namespace saccade
