// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/solids.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "saccade/map/mesh.hpp"
#include "saccade/scene/internal/embree_handles.hpp"

namespace saccade {

using Eigen::Vector3d;

struct MeshDistance::Impl {
  TriangleMesh mesh;
  EmbreeDevice device;    // released last
  EmbreeScene triangles;  // scene of this device
};

namespace {

/// State of one search: Embree visits the triangles near the query's ball, which shrinks to the nearest one found.
struct Search {
  const TriangleMesh& mesh;
  Vector3d p;
  double nearest_m;
};

/// Tells, cheaply, whether the triangle's plane is farther away than that, by more than rounding could explain.
bool plane_is_beyond(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c, double distance_m) {
  constexpr double kRounding{1.0 + 1e-9};
  const Vector3d normal = (b - a).cross(c - a);
  const double height = normal.dot(p - a);  // times the normal's length
  return height * height > kRounding * distance_m * distance_m * normal.squaredNorm();
}

bool visit(RTCPointQueryFunctionArguments* arguments) {
  Search& search = *static_cast<Search*>(arguments->userPtr);
  const auto& [a, b, c] = search.mesh.triangles[arguments->primID];
  const auto corner = [&](std::uint32_t i) -> Vector3d { return search.mesh.vertices[i].cast<double>(); };
  const Vector3d pa = corner(a);
  const Vector3d pb = corner(b);
  const Vector3d pc = corner(c);
  if (plane_is_beyond(search.p, pa, pb, pc, search.nearest_m)) return false;
  const double distance_m = (closest_point_on_triangle(search.p, pa, pb, pc) - search.p).norm();
  if (distance_m >= search.nearest_m) return false;
  search.nearest_m = distance_m;
  // Rounded up with some margin: single precision must not miss a triangle that is nearer still.
  arguments->query->radius =
      std::nextafter(static_cast<float>(distance_m * (1.0 + 1e-5)), std::numeric_limits<float>::max());
  return true;
}

}  // namespace

MeshDistance::MeshDistance(std::shared_ptr<const Impl> impl) : impl_{std::move(impl)} {}

Result<MeshDistance> MeshDistance::build(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return Error{Errc::invalid_argument, "the mesh has no triangles", "mesh distance"};
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t index : triangle) {
      if (index < mesh.vertices.size()) continue;
      return Error{Errc::invalid_argument, "a triangle names a vertex that is not there", "mesh distance"};
    }
  }
  EmbreeDevice device{rtcNewDevice(nullptr)};
  if (!device) return embree_failed(nullptr);
  EmbreeScene triangles{rtcNewScene(device.get())};
  rtcSetSceneFlags(triangles.get(), RTC_SCENE_FLAG_ROBUST);
  if (!attach_mesh(device.get(), triangles.get(), mesh, 0)) return embree_failed(device.get());
  rtcCommitScene(triangles.get());
  if (rtcGetDeviceError(device.get()) != RTC_ERROR_NONE) return embree_failed(device.get());
  return MeshDistance{std::make_shared<const Impl>(Impl{mesh, std::move(device), std::move(triangles)})};
}

double MeshDistance::distance_m(const Vector3d& p, double beyond_m) const {
  Search search{impl_->mesh, p, beyond_m};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  RTCPointQuery query{};
  query.x = static_cast<float>(p.x());
  query.y = static_cast<float>(p.y());
  query.z = static_cast<float>(p.z());
  query.radius = std::nextafter(static_cast<float>(beyond_m * (1.0 + 1e-5)), std::numeric_limits<float>::max());
  rtcPointQuery(impl_->triangles.get(), &query, &context, visit, &search);
  return search.nearest_m;
}

std::vector<double> MeshDistance::distances_m(std::span<const Eigen::Vector3f> points, double beyond_m,
                                              const Executor& executor) const {
  constexpr double kRounding_m{1e-9};  // the bound stays above the distance that is found
  std::vector<double> distances(points.size());
  executor.parallel_for(points.size(), 256, [&](std::size_t begin, std::size_t end) {
    double bound_m = beyond_m;
    for (std::size_t i = begin; i < end; ++i) {
      const Vector3d p = points[i].cast<double>();
      distances[i] = distance_m(p, bound_m);
      if (i + 1 == end) break;
      const double step_m = (points[i + 1].cast<double>() - p).norm();
      bound_m = std::min(beyond_m, (distances[i] + step_m) * (1.0 + kRounding_m) + kRounding_m);
    }
  });
  return distances;
}

}  // namespace saccade
