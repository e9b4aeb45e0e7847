// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/surface_samples.hpp"

#include <cmath>
#include <numbers>

namespace saccade {
namespace {

using Eigen::Vector3d;

/// Returns evenly spread positions on the upper half sphere (golden angle), in an order that jumps around it, so that
/// visible samples are found early.
std::vector<Vector3d> free_positions(const Box& workspace, const ObservabilityConfig& config) {
  const Vector3d base{0.5 * (workspace.min.x() + workspace.max.x()), 0.5 * (workspace.min.y() + workspace.max.y()),
                      workspace.min.z()};
  const double radius_m = 0.5 * (workspace.max - workspace.min).norm() + config.clearance_m;
  const double golden_rad = std::numbers::pi * (3.0 - std::sqrt(5.0));
  const auto count = static_cast<std::size_t>(config.positions);
  std::vector<Vector3d> positions;
  constexpr std::size_t kStride{37};
  for (std::size_t start = 0; start < kStride; ++start) {
    for (std::size_t i = start; i < count; i += kStride) {
      const double height = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
      const double across = std::sqrt(1.0 - height * height);
      const double angle_rad = golden_rad * static_cast<double>(i);
      positions.push_back(base +
                          radius_m * Vector3d{across * std::cos(angle_rad), across * std::sin(angle_rad), height});
    }
  }
  return positions;
}

/// Tells whether the bounds of the triangle abc miss the box.
bool apart(const Box& box, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d low = a.cwiseMin(b).cwiseMin(c);
  const Vector3d high = a.cwiseMax(b).cwiseMax(c);
  return (low.array() > box.max.array()).any() || (high.array() < box.min.array()).any();
}

}  // namespace

double surface_area_m2(const std::vector<ObjectMesh>& meshes, const std::optional<Box>& within) {
  double area_m2{0.0};
  for (const ObjectMesh& object : meshes) {
    for (const auto& [ia, ib, ic] : object.mesh.triangles) {
      const Vector3d a = object.mesh.vertices[ia].cast<double>();
      const Vector3d b = object.mesh.vertices[ib].cast<double>();
      const Vector3d c = object.mesh.vertices[ic].cast<double>();
      if (!within || !apart(*within, a, b, c)) area_m2 += 0.5 * (b - a).cross(c - a).norm();
    }
  }
  return area_m2;
}

SurfaceSamples sample_surfaces(const std::vector<ObjectMesh>& meshes, double spacing_m,
                               const std::optional<Box>& within) {
  SACCADE_EXPECTS(spacing_m > 0.0);
  // The plastic number's sequence fills the unit square evenly.
  constexpr double kAlpha{0.7548776662466927};
  constexpr double kBeta{0.5698402909980532};
  SurfaceSamples samples;
  for (std::size_t object = 0; object < meshes.size(); ++object) {
    const TriangleMesh& mesh = meshes[object].mesh;
    double owed = 0.5;  // samples due for the area so far
    std::uint64_t n = 0;
    for (const auto& [ia, ib, ic] : mesh.triangles) {
      const Vector3d a = mesh.vertices[ia].cast<double>();
      const Vector3d ab = mesh.vertices[ib].cast<double>() - a;
      const Vector3d ac = mesh.vertices[ic].cast<double>() - a;
      const Vector3d normal = ab.cross(ac);
      if (within && apart(*within, a, a + ab, a + ac)) continue;
      owed += 0.5 * normal.norm() / (spacing_m * spacing_m);
      for (; owed >= 1.0; owed -= 1.0, ++n) {
        double s = std::fmod(0.5 + kAlpha * static_cast<double>(n), 1.0);
        double t = std::fmod(0.5 + kBeta * static_cast<double>(n), 1.0);
        if (s + t > 1.0) {
          s = 1.0 - s;
          t = 1.0 - t;
        }
        const Vector3d p = a + s * ab + t * ac;
        if (within && !contains(*within, p)) continue;
        samples.points.push_back(p.cast<float>());
        samples.normals.push_back(normal.normalized().cast<float>());
        samples.objects.push_back(static_cast<std::uint32_t>(object));
      }
    }
  }
  return samples;
}

std::vector<std::uint8_t> observable(const RayScene& scene, const SurfaceSamples& samples,
                                     const ObservabilityConfig& config, const Executor& executor,
                                     const Progress& progress) {
  SACCADE_EXPECTS(config.positions >= 1 && config.clearance_m >= 0.0);
  const std::vector<Vector3d> positions = free_positions(scene.scene().workspace, config);
  const double least_cosine = std::cos(config.max_incidence_rad);
  constexpr double kTolerance{1e-5};  // share of the distance: the sample's own triangle is no obstacle
  const auto seen_from = [&](std::size_t i, const Vector3d& position) {
    const Vector3d p = samples.points[i].cast<double>();
    const Vector3d to_sample = p - position;
    if (-samples.normals[i].cast<double>().dot(to_sample) < least_cosine * to_sample.norm()) return false;
    const auto hit = scene.cast(position, to_sample);
    return hit && hit->t > 1.0 - kTolerance;
  };
  std::vector<std::uint8_t> result(samples.points.size(), 0);
  executor.parallel_for(result.size(), 256, [&](std::size_t begin, std::size_t end) {
    if (progress.cancelled()) return;
    for (std::size_t i = begin; i < end; ++i) {
      for (const Vector3d& position : positions) {
        if (!seen_from(i, position)) continue;
        result[i] = 1;
        break;
      }
    }
  });
  return result;
}

}  // namespace saccade
