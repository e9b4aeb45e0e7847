// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/internal/truth_labels.hpp"

#include <cmath>
#include <limits>

#include "saccade/map/mesh.hpp"
#include "saccade/scene/internal/embree_handles.hpp"
#include "saccade/scene/scene.hpp"

namespace saccade {

using Eigen::Vector3d;

struct TruthLabels::Impl {
  RayScene scene;
  SegmentTable segments;
  EmbreeDevice device;    // released last
  EmbreeScene triangles;  // scene of this device
};

namespace {

constexpr double kAbove_m{1e-4};  // height above the surface from which a point looks out of its body

struct SurfaceQuery {
  const RayScene& scene;
  Vector3d p;
  std::optional<Vector3d> normal;
  double nearest_m;
  std::size_t object{std::numeric_limits<std::size_t>::max()};
  Vector3d at{Vector3d::Zero()};
  Vector3d normal_at{Vector3d::Zero()};
};

/// Tells whether a point lies inside another body: a ray outwards leaves that body before it enters any.
bool covered(const RayScene& scene, const Vector3d& at, const Vector3d& normal) {
  const auto hit = scene.cast(at + kAbove_m * normal, normal);
  return hit && hit->normal_world.dot(normal) > 0.0;
}

bool consider(RTCPointQueryFunctionArguments* arguments) {
  SurfaceQuery& query = *static_cast<SurfaceQuery*>(arguments->userPtr);
  const TriangleMesh& mesh = query.scene.meshes()[arguments->geomID].mesh;
  const auto& [ia, ib, ic] = mesh.triangles[arguments->primID];
  const Vector3d a = mesh.vertices[ia].cast<double>();
  const Vector3d b = mesh.vertices[ib].cast<double>();
  const Vector3d c = mesh.vertices[ic].cast<double>();
  const Vector3d at = closest_point_on_triangle(query.p, a, b, c);
  const double distance_m = (at - query.p).norm();
  if (distance_m >= query.nearest_m) return false;
  const Vector3d normal = (b - a).cross(c - a).normalized();
  if (query.normal && normal.dot(*query.normal) <= 0.0) return false;
  if (covered(query.scene, at, normal)) return false;
  query.nearest_m = distance_m;
  query.object = arguments->geomID;
  query.at = at;
  query.normal_at = normal;
  // Rounded up with some margin: single precision must not miss a triangle that is nearer still.
  arguments->query->radius =
      std::nextafter(static_cast<float>(distance_m * (1.0 + 1e-5)), std::numeric_limits<float>::max());
  return true;
}

}  // namespace

TruthLabels::TruthLabels(std::shared_ptr<const Impl> impl) : impl_{std::move(impl)} {}

Result<TruthLabels> TruthLabels::build(const RayScene& scene) {
  EmbreeDevice device{rtcNewDevice(nullptr)};
  if (!device) return embree_failed(nullptr);
  EmbreeScene triangles{rtcNewScene(device.get())};
  rtcSetSceneFlags(triangles.get(), RTC_SCENE_FLAG_ROBUST);
  for (std::size_t i = 0; i < scene.meshes().size(); ++i) {
    if (!attach_mesh(device.get(), triangles.get(), scene.meshes()[i].mesh, static_cast<unsigned>(i)))
      return embree_failed(device.get());
  }
  rtcCommitScene(triangles.get());
  if (rtcGetDeviceError(device.get()) != RTC_ERROR_NONE) return embree_failed(device.get());
  return TruthLabels{
      std::make_shared<const Impl>(Impl{scene, SegmentTable{scene.scene()}, std::move(device), std::move(triangles)})};
}

const std::vector<std::string>& TruthLabels::names() const { return impl_->segments.names(); }

std::uint16_t TruthLabels::label(const Vector3d& p_world, double beyond_m,
                                 const std::optional<Vector3d>& normal_world) const {
  SurfaceQuery search{impl_->scene, p_world, normal_world, beyond_m};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  RTCPointQuery query{};
  query.x = static_cast<float>(p_world.x());
  query.y = static_cast<float>(p_world.y());
  query.z = static_cast<float>(p_world.z());
  query.radius = std::nextafter(static_cast<float>(beyond_m * (1.0 + 1e-5)), std::numeric_limits<float>::max());
  rtcPointQuery(impl_->triangles.get(), &query, &context, consider, &search);
  if (search.object == std::numeric_limits<std::size_t>::max()) return 0;
  const SceneObject& object = impl_->scene.scene().objects[search.object];
  const Paint paint = paint_at(object, object.T_world_object.inverse() * search.at,
                               object.T_world_object.linear().transpose() * search.normal_at);
  return impl_->segments.label(search.object, paint);
}

}  // namespace saccade
