// SPDX-License-Identifier: Apache-2.0
// Writes a small posed RGB-D sequence of a made-up table: example_table_scene OUT. What make demo starts from.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "saccade/core/pose.hpp"
#include "saccade/core/region.hpp"
#include "saccade/io/image_io.hpp"
#include "saccade/io/trajectory_io.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace {

using Eigen::Vector3d;
using saccade::Rgb8;

constexpr int kFrames{60};
constexpr double kDistance_m{0.95};
constexpr double kNoise_m{0.0012};  // standard deviation at 1 m; grows with the square of the depth
constexpr double kNoHit{std::numeric_limits<double>::infinity()};

struct Hit {
  double t{kNoHit};  // in lengths of the ray's direction
  Vector3d normal{Vector3d::Zero()};
};

struct Ray {
  Vector3d origin;
  Vector3d direction;
};

Hit intersect(const saccade::Sphere& sphere, const Ray& ray) {
  const Vector3d o = ray.origin - sphere.center;
  const double a = ray.direction.squaredNorm();
  const double b = o.dot(ray.direction);
  const double root = b * b - a * (o.squaredNorm() - sphere.radius_m * sphere.radius_m);
  const double t = (-b - std::sqrt(root)) / a;  // NaN without a hit
  if (!(t > 0.0)) return {};
  return {t, (o + t * ray.direction).normalized()};
}

Hit intersect(const saccade::Box& box, const Ray& ray) {
  Hit hit{0.0, Vector3d::Zero()};
  double exit{kNoHit};
  for (int axis = 0; axis < 3; ++axis) {
    const double to_min = (box.min[axis] - ray.origin[axis]) / ray.direction[axis];
    const double to_max = (box.max[axis] - ray.origin[axis]) / ray.direction[axis];
    const double entry = std::min(to_min, to_max);
    if (entry > hit.t) hit = {entry, Vector3d::Unit(axis) * (to_min < to_max ? -1.0 : 1.0)};
    exit = std::min(exit, std::max(to_min, to_max));
  }
  return hit.t > 0.0 && hit.t < exit ? hit : Hit{};
}

/// Upright cylinders only: the side, then the lid.
Hit intersect(const saccade::Cylinder& cylinder, const Ray& ray) {
  const Vector3d o = ray.origin - cylinder.base;
  const double height_m = cylinder.top.z() - cylinder.base.z();
  const double r2 = cylinder.radius_m * cylinder.radius_m;
  const double a = ray.direction.head<2>().squaredNorm();
  const double b = o.head<2>().dot(ray.direction.head<2>());
  const double side = (-b - std::sqrt(b * b - a * (o.head<2>().squaredNorm() - r2))) / a;
  const Vector3d p_side = o + side * ray.direction;
  if (side > 0.0 && p_side.z() >= 0.0 && p_side.z() <= height_m) {
    return {side, Vector3d{p_side.x(), p_side.y(), 0.0}.normalized()};
  }
  const double lid = (height_m - o.z()) / ray.direction.z();
  const Vector3d p_lid = o + lid * ray.direction;
  return lid > 0.0 && p_lid.head<2>().squaredNorm() <= r2 ? Hit{lid, Vector3d::UnitZ()} : Hit{};
}

struct Thing {
  saccade::Region shape;
  Vector3d color;
};

std::vector<Thing> table_scene() {
  return {{saccade::Box{{-3.0, -3.0, -0.80}, {3.0, 3.0, -0.75}}, {0.55, 0.53, 0.50}},    // floor
          {saccade::Box{{-0.60, -0.40, -0.04}, {0.60, 0.40, 0.0}}, {0.70, 0.52, 0.34}},  // table top
          {saccade::Cylinder{{0.02, 0.04, 0.0}, {0.02, 0.04, 0.11}, 0.045}, {0.20, 0.45, 0.70}},
          {saccade::Box{{0.14, -0.02, 0.0}, {0.34, 0.14, 0.17}}, {0.80, 0.30, 0.22}},
          {saccade::Sphere{{-0.20, -0.02, 0.07}, 0.07}, {0.93, 0.78, 0.25}},
          {saccade::Cylinder{{-0.06, -0.18, 0.0}, {-0.06, -0.18, 0.05}, 0.06}, {0.35, 0.62, 0.38}}};
}

/// The camera goes round the near half of the table; the far sides of things stay unseen.
saccade::Pose camera_pose(int frame) {
  const double part = static_cast<double>(frame) / (kFrames - 1);
  const double azimuth_rad = (-160.0 + 140.0 * part) * std::numbers::pi / 180.0;
  const double elevation_rad = (35.0 + 10.0 * std::sin(2.0 * std::numbers::pi * part)) * std::numbers::pi / 180.0;
  const Vector3d direction{std::cos(elevation_rad) * std::cos(azimuth_rad),
                           std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad)};
  return saccade::look_at(kDistance_m * direction, Vector3d::Zero());
}

struct Rendered {
  saccade::Image16 depth_mm;
  saccade::ColorImage color;
};

Rendered render(const std::vector<Thing>& things, const saccade::PinholeCamera& camera,
                const saccade::Pose& T_world_camera, std::mt19937& random) {
  Rendered out{{camera.width, camera.height}, {camera.width, camera.height}};
  std::normal_distribution<double> noise{0.0, kNoise_m};
  const Vector3d to_light = Vector3d{-0.4, -0.5, 1.0}.normalized();
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Ray ray{T_world_camera.translation(), T_world_camera.linear() * camera.ray(u, v)};  // t is the depth
      Hit nearest;
      Vector3d color = Vector3d::Zero();
      for (const Thing& thing : things) {
        const Hit hit = std::visit([&](const auto& shape) { return intersect(shape, ray); }, thing.shape);
        if (hit.t < nearest.t) {
          nearest = hit;
          color = thing.color;
        }
      }
      if (nearest.t > camera.max_range_m) continue;
      color *= 255.0 * (0.35 + 0.65 * std::max(0.0, nearest.normal.dot(to_light)));
      for (int c = 0; c < 3; ++c) out.color(u, v)[static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(color[c]);
      const bool grazing = -nearest.normal.dot(ray.direction.normalized()) < 0.12;
      const double measured_m = nearest.t + nearest.t * nearest.t * noise(random);
      if (!grazing) out.depth_mm(u, v) = static_cast<std::uint16_t>(std::lround(1000.0 * measured_m));
    }
  }
  return out;
}

saccade::Status write_sequence(const std::filesystem::path& folder) {
  const saccade::PinholeCamera camera{.width = 640, .height = 480};
  const std::vector<Thing> things = table_scene();
  std::mt19937 random{1};
  for (int frame = 0; frame < kFrames; ++frame) {
    std::string name = "frame-" + std::to_string(1000000 + frame).substr(1);
    const saccade::Pose T_world_camera = camera_pose(frame);
    const Rendered image = render(things, camera, T_world_camera, random);
    SACCADE_CHECK(saccade::write_png16(folder / (name + ".depth.png"), image.depth_mm));
    SACCADE_CHECK(saccade::write_png(folder / (name + ".color.png"), image.color));
    SACCADE_CHECK(saccade::write_matrices(folder / (name + ".pose.txt"), std::vector{T_world_camera}));
  }
  std::ofstream intrinsics{folder / "camera-intrinsics.txt"};
  intrinsics << camera.fx << " 0 " << camera.cx << "\n0 " << camera.fy << ' ' << camera.cy << "\n0 0 1\n";
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: example_table_scene OUT\n";
    return 2;
  }
  std::error_code error;
  std::filesystem::create_directories(argv[1], error);
  const saccade::Status written = write_sequence(argv[1]);
  if (!written) {
    std::cerr << written.error().to_string() << '\n';
    return 3;
  }
  std::cout << kFrames << " frames in " << argv[1] << '\n';
}
