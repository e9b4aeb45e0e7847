// SPDX-License-Identifier: Apache-2.0
#include "thesis/filter_trials.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace saccade::thesis {
namespace {

using Eigen::Vector3d;

constexpr double kBarHeight_m{2.0};
constexpr double kSensorHeight_m{1.0};
constexpr double kToBar_m{1.0};
constexpr double kToWall_m{1.5};
constexpr double kThickness_m{1.0};  // thickness of walls and tops, so that their backs are no planes here
constexpr double kFar_m{30.0};

/// `center` is the middle of its lower face; turned about z.
SceneObject box(const std::string& name, const Vector3d& size_m, const Vector3d& center, double turn_rad = 0.0) {
  SceneObject object;
  object.name = name;
  object.shape = BoxShape{size_m};
  object.T_world_object = Eigen::Translation3d{center} * Eigen::AngleAxisd{turn_rad, Vector3d::UnitZ()};
  return object;
}

Result<FilterScene> build(const std::string& name, std::vector<SceneObject> objects, const Pose& T_world_camera,
                          const Box& workspace) {
  Scene scene;
  scene.name = name;
  scene.objects = std::move(objects);
  scene.workspace = workspace;
  SACCADE_TRY(RayScene rays, RayScene::build(std::move(scene)));
  return FilterScene{std::move(rays), T_world_camera, workspace};
}

/// From the surface of a box around the origin, inside or outside.
double distance_from_surface(const Vector3d& half_m, const Vector3d& p) {
  const Vector3d beyond = p.cwiseAbs() - half_m;
  const double outside_m = beyond.cwiseMax(0.0).norm();
  return outside_m > 0.0 ? outside_m : -beyond.maxCoeff();
}

}  // namespace

Result<FilterScene> bar_before_wall(double width_m, double angle_rad) {
  const double back_m = 0.5 * width_m;  // distance of the bar's back from its axis
  const double wall_m = back_m + kToWall_m;
  const Vector3d axis{0.0, 0.0, kSensorHeight_m};
  const Vector3d camera = axis + (kToBar_m + back_m) * Vector3d{-std::cos(angle_rad), -std::sin(angle_rad), 0.0};
  return build("bar before a wall",
               {box("ground", {kFar_m, kFar_m, kThickness_m}, {0.0, 0.0, -kThickness_m}),
                box("wall", {kThickness_m, kFar_m, kFar_m}, {wall_m + 0.5 * kThickness_m, 0.0, 0.0}),
                box("bar", {width_m, width_m, kBarHeight_m}, {0.0, 0.0, 0.0})},
               look_at(camera, axis, Vector3d::UnitZ()), Box{Vector3d::Constant(-kFar_m), Vector3d::Constant(kFar_m)});
}

Result<FilterScene> planar_table() {
  return build(
      "planar table",
      {box("table", {1.2, 1.4, kThickness_m}, {0.0, 0.0, -kThickness_m}),
       box("box", {0.16, 0.24, 0.30}, {-0.15, 0.0, 0.0}, 0.3), box("board", {0.02, 0.9, 0.5}, {0.45, 0.1, 0.0}, -0.15),
       box("wall", {kThickness_m, 6.0, 6.0}, {2.1, 0.0, -2.0})},
      look_at({-1.05, 0.0, 0.75}, {0.0, 0.0, 0.05}, Vector3d::UnitZ()), Box{{-0.65, -0.75, -0.1}, {0.65, 0.75, 0.6}});
}

double distance_from_planes(const FilterScene& scene, const Vector3d& p_world) {
  double nearest_m{std::numeric_limits<double>::infinity()};
  for (const SceneObject& object : scene.scene.scene().objects) {
    const Vector3d half_m = 0.5 * std::get<BoxShape>(object.shape).size_m;
    const Vector3d p = object.T_world_object.inverse() * p_world - Vector3d{0.0, 0.0, half_m.z()};
    nearest_m = std::min(nearest_m, distance_from_surface(half_m, p));
  }
  return nearest_m;
}

FilterScore score_filter(const FilterScene& scene, const PinholeCamera& camera, const TimeOfFlightFrame& frame,
                         const Image<FilteredPixel>& pixels) {
  FilterScore score;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      if (pixels(u, v) == FilteredPixel::no_return) continue;
      const bool removed = pixels(u, v) != FilteredPixel::kept;
      const bool good = frame.truth(u, v) == MeasuredPixel::good;
      const Vector3d p_world =
          scene.T_world_camera * Vector3d{camera.ray(u, v) * static_cast<double>(frame.depth(u, v))};
      const bool outlier = distance_from_planes(scene, p_world) > kPlaneDistance_m;
      ++score.points;
      score.removed += removed ? 1U : 0U;
      score.good_removed += removed && good ? 1U : 0U;
      score.wrong += good ? 0U : 1U;
      score.wrong_kept += good || removed ? 0U : 1U;
      score.outliers += outlier ? 1U : 0U;
      score.outliers_kept += outlier && !removed ? 1U : 0U;
    }
  }
  return score;
}

AverageScore score_average(const FilterScene& scene, const PinholeCamera& camera, std::span<const DepthImage> frames) {
  Image<double> sums{camera.width, camera.height};
  Image<int> counts{camera.width, camera.height};
  for (const DepthImage& frame : frames) {
    for (std::size_t i = 0; i < frame.size(); ++i) {
      if (!(frame.data()[i] > 0.0F)) continue;
      sums.data()[i] += static_cast<double>(frame.data()[i]);
      ++counts.data()[i];
    }
  }
  AverageScore score;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      if (2 * counts(u, v) < static_cast<int>(frames.size()) || counts(u, v) == 0) continue;
      const Vector3d p_world = scene.T_world_camera * Vector3d{camera.ray(u, v) * (sums(u, v) / counts(u, v))};
      if (!contains(scene.workspace, p_world)) continue;
      ++score.measurements;
      score.outliers += distance_from_planes(scene, p_world) > kPlaneDistance_m ? 1U : 0U;
    }
  }
  return score;
}

}  // namespace saccade::thesis
