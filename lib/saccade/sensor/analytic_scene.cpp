// SPDX-License-Identifier: Apache-2.0
#include "saccade/sensor/analytic_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "saccade/core/angle.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

struct ShapeHit {
  double t{0.0};
  Vector3d normal{Vector3d::Zero()};
};

std::optional<ShapeHit> hit(const Sphere& sphere, const Vector3d& origin, const Vector3d& direction) {
  const Vector3d to_origin = origin - sphere.center;
  const double a = direction.squaredNorm();
  const double b = to_origin.dot(direction);
  const double discriminant = b * b - a * (to_origin.squaredNorm() - sphere.radius_m * sphere.radius_m);
  if (discriminant < 0.0) return std::nullopt;
  const double t = (-b - std::sqrt(discriminant)) / a;
  if (!(t > 0.0)) return std::nullopt;
  return ShapeHit{t, (to_origin + t * direction) / sphere.radius_m};
}

std::optional<ShapeHit> hit(const Box& box, const Vector3d& origin, const Vector3d& direction) {
  ShapeHit entry{-std::numeric_limits<double>::infinity(), Vector3d::Zero()};
  double exit = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    if (direction[k] == 0.0) {
      if (origin[k] < box.min[k] || origin[k] > box.max[k]) return std::nullopt;
      continue;
    }
    const bool forward = direction[k] > 0.0;
    const double near = ((forward ? box.min[k] : box.max[k]) - origin[k]) / direction[k];
    const double far = ((forward ? box.max[k] : box.min[k]) - origin[k]) / direction[k];
    exit = std::min(exit, far);
    if (near > entry.t) entry = {near, (forward ? -1.0 : 1.0) * Vector3d::Unit(k)};
  }
  if (!(entry.t > 0.0) || entry.t > exit) return std::nullopt;
  return entry;
}

std::optional<ShapeHit> hit(const HalfSpace& plane, const Vector3d& origin, const Vector3d& direction) {
  const double slope = plane.normal.dot(direction);
  if (!(slope < 0.0)) return std::nullopt;
  const double t = (plane.offset_m - plane.normal.dot(origin)) / slope;
  if (!(t > 0.0)) return std::nullopt;
  return ShapeHit{t, plane.normal};
}

std::optional<ShapeHit> hit(const Cylinder& cylinder, const Vector3d& origin, const Vector3d& direction) {
  const double height = (cylinder.top - cylinder.base).norm();
  const Vector3d axis = (cylinder.top - cylinder.base) / height;
  const Vector3d to_origin = origin - cylinder.base;
  const double start = axis.dot(to_origin);
  const double rate = axis.dot(direction);
  // Inside the slab between the end faces and inside the infinite tube: the later of the two entries counts.
  ShapeHit entry{-std::numeric_limits<double>::infinity(), Vector3d::Zero()};
  double exit = std::numeric_limits<double>::infinity();
  if (rate != 0.0) {
    entry = {((rate > 0.0 ? 0.0 : height) - start) / rate, rate > 0.0 ? Vector3d{-axis} : axis};
    exit = ((rate > 0.0 ? height : 0.0) - start) / rate;
  } else if (start < 0.0 || start > height) {
    return std::nullopt;
  }
  const Vector3d across = direction - rate * axis;
  const Vector3d offset = to_origin - start * axis;
  const double a = across.squaredNorm();
  const double b = offset.dot(across);
  const double c = offset.squaredNorm() - cylinder.radius_m * cylinder.radius_m;
  if (a == 0.0) {
    if (c > 0.0) return std::nullopt;
  } else {
    const double discriminant = b * b - a * c;
    if (discriminant < 0.0) return std::nullopt;
    const double near = (-b - std::sqrt(discriminant)) / a;
    exit = std::min(exit, (-b + std::sqrt(discriminant)) / a);
    if (near > entry.t) entry = {near, (offset + near * across) / cylinder.radius_m};
  }
  if (!(entry.t > 0.0) || entry.t > exit) return std::nullopt;
  return entry;
}

double distance(const Sphere& sphere, const Vector3d& p) { return (p - sphere.center).norm() - sphere.radius_m; }

double distance(const HalfSpace& plane, const Vector3d& p) { return plane.normal.dot(p) - plane.offset_m; }

double distance(const Box& box, const Vector3d& p) {
  const Vector3d outside = (box.min - p).cwiseMax(p - box.max);
  return outside.cwiseMax(0.0).norm() + std::min(outside.maxCoeff(), 0.0);
}

double distance(const Cylinder& cylinder, const Vector3d& p) {
  const double height = (cylinder.top - cylinder.base).norm();
  const Vector3d axis = (cylinder.top - cylinder.base) / height;
  const double along = axis.dot(p - cylinder.base);
  const double radial = (p - cylinder.base - along * axis).norm() - cylinder.radius_m;
  const double axial = std::max(-along, along - height);
  return std::hypot(std::max(radial, 0.0), std::max(axial, 0.0)) + std::min(std::max(radial, axial), 0.0);
}

bool dark_square(const Checker& checker, const Vector3d& p_world) {
  if (checker.edge_m <= 0.0) return false;
  // A small shift keeps squares from flickering on surfaces that lie on the lattice.
  constexpr double kShift{0.37};
  long long sum = 0;
  for (int k = 0; k < 3; ++k) sum += std::llround(std::floor(p_world[k] / checker.edge_m + kShift));
  return (sum & 1) != 0;
}

Rgb8 shade(const AnalyticScene& scene, const SurfaceHit& surface, const Vector3d& p_world) {
  const AnalyticObject& object = scene.objects[static_cast<std::size_t>(surface.object)];
  const double lambert = std::max(0.0, surface.normal_world.dot(scene.to_light_world.normalized()));
  double brightness = scene.ambient + (1.0 - scene.ambient) * lambert;
  if (dark_square(object.checker, p_world)) brightness *= object.checker.darkening;
  Rgb8 color{};
  for (std::size_t c = 0; c < 3; ++c) {
    color[c] = static_cast<std::uint8_t>(std::clamp(std::lround(object.color[c] * brightness), 0L, 255L));
  }
  return color;
}

void render_row(const AnalyticScene& scene, const PinholeCamera& camera, const Pose& T_world_camera, int v,
                RenderedFrame& frame) {
  const Vector3d origin = T_world_camera.translation();
  for (int u = 0; u < camera.width; ++u) {
    // The ray has z = 1 in the camera's frame, so t is the depth.
    const Vector3d direction = T_world_camera.linear() * camera.ray(u, v);
    const auto surface = scene.cast(origin, direction);
    if (!surface || surface->t < camera.min_range_m || surface->t > camera.max_range_m) continue;
    frame.depth(u, v) = static_cast<float>(surface->t);
    frame.color(u, v) = shade(scene, *surface, origin + surface->t * direction);
    frame.object_id(u, v) = surface->object;
  }
}

Status validate_shape(const AnalyticObject& object) {
  if (const auto* plane = std::get_if<HalfSpace>(&object.shape)) {
    constexpr double kTolerance{1e-9};
    if (std::abs(plane->normal.norm() - 1.0) <= kTolerance && std::isfinite(plane->offset_m)) return {};
    return Error{Errc::invalid_argument, "a plane needs a normal of length 1 and a finite offset", object.name};
  }
  const auto region = std::visit(
      [](const auto& shape) -> Region {
        if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, HalfSpace>) {
          return Sphere{};
        } else {
          return shape;
        }
      },
      object.shape);
  return saccade::validate(region);
}

}  // namespace

std::optional<SurfaceHit> AnalyticScene::cast(const Vector3d& origin, const Vector3d& direction) const {
  std::optional<SurfaceHit> nearest;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const auto found = std::visit([&](const auto& shape) { return hit(shape, origin, direction); }, objects[i].shape);
    if (found && (!nearest || found->t < nearest->t))
      nearest = SurfaceHit{found->t, found->normal, static_cast<int>(i)};
  }
  return nearest;
}

double AnalyticScene::signed_distance_m(const Vector3d& p_world) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const AnalyticObject& object : objects) {
    nearest = std::min(nearest, std::visit([&](const auto& shape) { return distance(shape, p_world); }, object.shape));
  }
  return nearest;
}

Status AnalyticScene::validate() const {
  for (const AnalyticObject& object : objects) SACCADE_CHECK(validate_shape(object));
  if (!(to_light_world.norm() > 0.0) || !to_light_world.allFinite()) {
    return Error{Errc::invalid_argument, "the light needs a direction", "scene"};
  }
  return {};
}

Result<RenderedFrame> render(const AnalyticScene& scene, const PinholeCamera& camera, const Pose& T_world_camera,
                             const Executor& executor) {
  SACCADE_CHECK(camera.validate());
  SACCADE_CHECK(scene.validate());
  if (!T_world_camera.matrix().allFinite()) {
    return Error{Errc::invalid_argument, "the camera's pose is not finite", "render"};
  }
  RenderedFrame frame{DepthImage{camera.width, camera.height}, ColorImage{camera.width, camera.height},
                      Image<int>{camera.width, camera.height, -1}};
  constexpr std::size_t kRowsPerTask{16};
  executor.parallel_for(static_cast<std::size_t>(camera.height), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      render_row(scene, camera, T_world_camera, static_cast<int>(v), frame);
    }
  });
  return frame;
}

AnalyticScene sample_tabletop() {
  AnalyticScene scene;
  constexpr Checker kLarge{0.10, 0.6};
  constexpr Checker kSmall{0.03, 0.55};
  scene.objects = {
      {"table", Box{{-0.6, -0.4, -0.04}, {0.6, 0.4, 0.0}}, {196, 164, 120}, kLarge},
      {"box", Box{{-0.30, 0.02, 0.0}, {-0.12, 0.16, 0.22}}, {198, 60, 52}, kSmall},
      {"ball", Sphere{{0.20, 0.12, 0.08}, 0.08}, {70, 120, 200}, kSmall},
      {"can", Cylinder{{0.02, -0.10, 0.0}, {0.02, -0.10, 0.12}, 0.035}, {80, 170, 90}, kSmall},
      {"brick", Box{{0.16, -0.22, 0.0}, {0.36, -0.14, 0.06}}, {230, 190, 60}, kSmall},
      {"wall", Box{{-1.5, 0.9, -0.8}, {1.5, 1.0, 1.2}}, {205, 205, 198}, Checker{0.25, 0.85}},
      {"floor", HalfSpace{Vector3d::UnitZ(), -0.75}, {120, 120, 126}, Checker{0.25, 0.8}},
  };
  return scene;
}

std::vector<Pose> sample_trajectory(std::size_t n) {
  SACCADE_EXPECTS(n >= 1);
  constexpr double kHalfArc_rad{70_deg};
  constexpr double kTwoPi{360_deg};
  const Vector3d target{0.0, 0.0, 0.05};
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < n; ++i) {
    const double s = n > 1 ? static_cast<double>(i) / static_cast<double>(n - 1) : 0.5;
    const double azimuth_rad = -90_deg + kHalfArc_rad * (2.0 * s - 1.0);
    const double elevation_rad = to_rad(38.0 + 8.0 * std::sin(kTwoPi * s));
    const double radius_m = 0.85 + 0.10 * std::cos(kTwoPi * s);
    const Vector3d outward{std::cos(elevation_rad) * std::cos(azimuth_rad),
                           std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad)};
    poses.push_back(look_at(target + radius_m * outward, target));
  }
  return poses;
}

}  // namespace saccade
