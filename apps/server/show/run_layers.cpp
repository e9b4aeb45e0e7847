// SPDX-License-Identifier: Apache-2.0
#include "server/show/run_layers.hpp"

#include <cmath>
#include <numbers>
#include <optional>

#include "saccade/arm/arm_mesh.hpp"
#include "saccade/report/robot_drawing.hpp"
#include "server/show/figures.hpp"
#include "server/show/ray_hits.hpp"

namespace saccade::server {
namespace {

constexpr Rgb8 kGained{255, 140, 26};
constexpr Rgb8 kUnknownElsewhere{112, 120, 138};
constexpr Rgb8 kSurfaceHit{64, 152, 222};

Layer placed(Layer layer, std::optional<std::size_t> step, bool visible = true) {
  if (step) layer.id += "-" + std::to_string(*step);
  layer.step = step;
  layer.visible = visible;
  return layer;
}

/// Appends a circle around `center` through center + a and center + b.
void append_circle(std::vector<Eigen::Vector3f>& ends, const Eigen::Vector3d& center, const Eigen::Vector3d& a,
                   const Eigen::Vector3d& b) {
  constexpr int kParts{48};
  const auto at = [&](int i) {
    const double angle = 2.0 * std::numbers::pi * i / kParts;
    return Eigen::Vector3f{(center + std::cos(angle) * a + std::sin(angle) * b).cast<float>()};
  };
  for (int i = 0; i < kParts; ++i) {
    ends.push_back(at(i));
    ends.push_back(at(i + 1));
  }
}

std::vector<Eigen::Vector3f> outline_of(const Sphere& sphere) {
  const Eigen::Matrix3d axes = sphere.radius_m * Eigen::Matrix3d::Identity();
  std::vector<Eigen::Vector3f> ends;
  for (int i = 0; i < 3; ++i) append_circle(ends, sphere.center, axes.col(i), axes.col((i + 1) % 3));
  return ends;
}

std::vector<Eigen::Vector3f> outline_of(const Cylinder& cylinder) {
  const Eigen::Vector3d axis = (cylinder.top - cylinder.base).normalized();
  const Eigen::Vector3d a = cylinder.radius_m * axis.unitOrthogonal();
  const Eigen::Vector3d b = axis.cross(a);
  std::vector<Eigen::Vector3f> ends;
  append_circle(ends, cylinder.base, a, b);
  append_circle(ends, cylinder.top, a, b);
  for (const Eigen::Vector3d& side : {a, b, Eigen::Vector3d{-a}, Eigen::Vector3d{-b}}) {
    ends.emplace_back((cylinder.base + side).cast<float>());
    ends.emplace_back((cylinder.top + side).cast<float>());
  }
  return ends;
}

}  // namespace

Layer candidates_layer(std::span<const RankedView> candidates, const std::array<double, 2>& fov_rad, std::size_t step) {
  std::vector<Pose> T_world_candidates;
  std::vector<double> gains;
  for (const RankedView& candidate : candidates) {
    T_world_candidates.push_back(candidate.T_world_camera);
    gains.push_back(candidate.gain);
  }
  return placed(views_layer("candidates", "Candidates", T_world_candidates, gains, fov_rad), step);
}

Layer hits_layer(const TsdfSnapshot& before, const ViewChoice& choice, const Pose& T_world_camera, std::size_t step,
                 const Executor& executor) {
  std::vector<Eigen::Vector3f> points;
  std::vector<Rgb8> colors;
  std::array<std::size_t, 3> counts{};
  for (const RayHit& hit : ray_hits(before, choice.region, choice.sensor, T_world_camera, executor)) {
    constexpr std::array<Rgb8, 3> kColors{kGained, kUnknownElsewhere, kSurfaceHit};
    points.push_back(hit.center_m);
    colors.push_back(kColors[static_cast<std::size_t>(hit.end)]);
    ++counts[static_cast<std::size_t>(hit.end)];
  }
  Layer layer = points_layer("hits", "Where rays end", points, colors);
  layer.size_m = before.config.voxel_size_m;
  layer.legend = {{"unknown in the region, what is gained: " + grouped(counts[0]), kGained},
                  {"unknown elsewhere: " + grouped(counts[1]), kUnknownElsewhere},
                  {"surface: " + grouped(counts[2]), kSurfaceHit}};
  return placed(std::move(layer), step);
}

Layer region_layer(const Region& region, std::size_t step) {
  Layer layer;
  if (const auto* box = std::get_if<Box>(&region)) {
    layer = box_layer("region", "Region of the gain", *box);
  } else if (const auto* sphere = std::get_if<Sphere>(&region)) {
    layer = lines_layer("region", "Region of the gain", outline_of(*sphere));
  } else {
    layer = lines_layer("region", "Region of the gain", outline_of(std::get<Cylinder>(region)));
  }
  layer.color = kGained;
  return placed(std::move(layer), step, false);
}

Layer path_layer(std::span<const Eigen::Vector3d> path, std::optional<std::size_t> step) {
  SACCADE_EXPECTS(path.size() > 1);
  std::vector<Eigen::Vector3f> ends;
  for (std::size_t i = 1; i < path.size(); ++i) {
    ends.emplace_back(path[i - 1].cast<float>());
    ends.emplace_back(path[i].cast<float>());
  }
  Layer layer = lines_layer("path", "The camera's way", ends);
  layer.color = path_color();
  return placed(std::move(layer), step);
}

Layer arm_layer(const ArmModel& arm, const Configuration& q, std::size_t step) {
  Layer layer = triangles_layer("arm", "Arm", arm_mesh(arm, q));
  layer.holds_camera = true;
  return placed(std::move(layer), step);
}

}  // namespace saccade::server
