// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/cast_window.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "saccade/core/angle.hpp"

namespace saccade {
namespace {

constexpr double kInfinity{std::numeric_limits<double>::infinity()};
constexpr double kMargin_vox{0.05};
constexpr double kHalfDiagonal_vox{0.8660254037844387};

struct Range {
  double lo{-kInfinity};
  double hi{kInfinity};
  [[nodiscard]] bool empty() const { return !(lo <= hi); }
  [[nodiscard]] Range operator&(const Range& o) const { return {std::max(lo, o.lo), std::min(hi, o.hi)}; }
};
constexpr Range kNowhere{1.0, 0.0};

/// Transform from the world to canonical camera coordinates, in voxels.
class CameraFrame {
 public:
  CameraFrame(const SensorRays& rays, double voxel_size_m) {
    for (int i = 0; i < 3; ++i) {
      to_camera_(0, i) = rays.x[i] * voxel_size_m;
      to_camera_(1, i) = rays.y[i] * voxel_size_m;
      to_camera_(2, i) = rays.z[i] * voxel_size_m;
      center_[i] = static_cast<double>(rays.origin.fraction[i]);
    }
    center_ += Eigen::Vector3d(rays.origin.voxel.x, rays.origin.voxel.y, rays.origin.voxel.z);
  }
  [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& p_vox) const { return to_camera_ * (p_vox - center_); }

 private:
  Eigen::Matrix3d to_camera_;
  Eigen::Vector3d center_;
};

struct CameraSphere {
  Eigen::Vector3d center;
  double radius;
};
std::optional<CameraSphere> sphere_in_camera(const SensorRays& rays, const Region& region, double voxel_size_m) {
  const auto* sphere = std::get_if<Sphere>(&region);
  if (sphere == nullptr) return std::nullopt;
  return CameraSphere{CameraFrame{rays, voxel_size_m} * (sphere->center / voxel_size_m),
                      sphere->radius_m / voxel_size_m + kHalfDiagonal_vox + kMargin_vox};
}

/// Returns the image coordinates x / z of a disc seen in the plane of x and z.
Range disc_range(double x, double z, double radius) {
  const double distance = std::hypot(x, z);
  if (distance <= radius) return {};
  const double middle = std::atan2(x, z);
  const double half = std::asin(radius / distance);
  if (middle - half >= 90_deg || middle + half <= -90_deg) {
    return middle - half <= -270_deg || middle + half >= 270_deg ? Range{} : kNowhere;
  }
  return {middle - half <= -90_deg ? -kInfinity : std::tan(middle - half),
          middle + half >= 90_deg ? kInfinity : std::tan(middle + half)};
}

struct ImageRange {
  Range a;
  Range b;
};

ImageRange box_range(const CameraFrame& camera, const IndexBox& voxels) {
  ImageRange range{{kInfinity, -kInfinity}, {kInfinity, -kInfinity}};
  int behind{0};
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d p =
        camera * Eigen::Vector3d{static_cast<double>((corner & 1) != 0 ? voxels.hi.x : voxels.lo.x),
                                 static_cast<double>((corner & 2) != 0 ? voxels.hi.y : voxels.lo.y),
                                 static_cast<double>((corner & 4) != 0 ? voxels.hi.z : voxels.lo.z)};
    if (p.z() <= kMargin_vox) {
      ++behind;
      continue;
    }
    range.a = {std::min(range.a.lo, p.x() / p.z()), std::max(range.a.hi, p.x() / p.z())};
    range.b = {std::min(range.b.lo, p.y() / p.z()), std::max(range.b.hi, p.y() / p.z())};
  }
  if (behind == 8) return {kNowhere, kNowhere};
  return behind > 0 ? ImageRange{} : range;
}

/// Returns the indices of the ascending, evenly spaced coordinates that lie in the range, and one more on either side.
ColumnRange indices(std::span<const float> coordinates, double pixels_per_unit, const Range& range) {
  const auto size = static_cast<double>(coordinates.size());
  if (range.empty()) return {};
  const double first = static_cast<double>(coordinates.front());
  const double begin = std::clamp(std::floor((range.lo - first) * pixels_per_unit) - 1.0, 0.0, size);
  const double end = std::clamp(std::ceil((range.hi - first) * pixels_per_unit) + 2.0, 0.0, size);
  return {static_cast<int>(begin), static_cast<int>(std::max(begin, end))};
}

std::span<const float> part(std::span<const float> values, const ColumnRange& range) {
  return values.subspan(static_cast<std::size_t>(range.begin), static_cast<std::size_t>(range.end - range.begin));
}

}  // namespace

CastWindow whole_image(const SensorRays& rays, const PixelAxes& axes) {
  return {rays, axes.a, axes.b, axes.pixels_per_a, axes.pixels_per_b};
}

CastWindow window_of(const SensorRays& rays, const PixelAxes& axes, const IndexBox& voxels, const Region& region,
                     double voxel_size_m) {
  ImageRange range = box_range(CameraFrame{rays, voxel_size_m}, voxels);
  if (const auto sphere = sphere_in_camera(rays, region, voxel_size_m)) {
    range.a = range.a & disc_range(sphere->center.x(), sphere->center.z(), sphere->radius);
    range.b = range.b & disc_range(sphere->center.y(), sphere->center.z(), sphere->radius);
  }
  return {rays, part(axes.a, indices(axes.a, axes.pixels_per_a, range.a)),
          part(axes.b, indices(axes.b, axes.pixels_per_b, range.b)), axes.pixels_per_a, axes.pixels_per_b};
}

std::vector<ColumnRange> column_ranges(const CastWindow& window, const Region& region, double voxel_size_m) {
  const auto width = static_cast<int>(window.a.size());
  const auto sphere = sphere_in_camera(window.rays, region, voxel_size_m);
  if (!sphere || width < 2) return {};
  const double pixels_per_a =
      (width - 1) / (static_cast<double>(window.a.back()) - static_cast<double>(window.a.front()));
  const Eigen::Vector3d& c = sphere->center;
  const double squared_tangent = c.squaredNorm() - sphere->radius * sphere->radius;
  const double quadratic = c.x() * c.x() - squared_tangent;
  // Rays (a, b, 1) that meet the sphere satisfy (a·cx + b·cy + cz)² ≥ (a² + b² + 1)·(|c|² − R²), that is a lies between
  // two roots, as long as the quadratic term is negative.
  if (squared_tangent <= 0.0 || quadratic >= -1e-9 * squared_tangent) return {};
  std::vector<ColumnRange> ranges(window.b.size(), {0, width});
  for (std::size_t j = 0; j < ranges.size(); ++j) {
    const double b = static_cast<double>(window.b[j]);
    const double along = b * c.y() + c.z();
    const double constant = along * along - squared_tangent * (b * b + 1.0);
    const double half_linear = c.x() * along;
    const double discriminant = half_linear * half_linear - quadratic * constant;
    if (discriminant < 0.0) {
      ranges[j] = {0, 0};
      continue;
    }
    const double root = std::sqrt(discriminant);
    ranges[j] = indices(window.a, pixels_per_a, {(-half_linear + root) / quadratic, (-half_linear - root) / quadratic});
  }
  return ranges;
}

}  // namespace saccade
