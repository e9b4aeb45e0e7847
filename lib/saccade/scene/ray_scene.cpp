// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/ray_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "saccade/scene/internal/embree_handles.hpp"
#include "saccade/scene/scene.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kPacket{8};  // rays that Embree casts together: one traversal instead of eight

}  // namespace

struct RayScene::Impl {
  Scene scene;
  std::vector<ObjectMesh> meshes;
  std::vector<Pose> T_object_world;  // one per object
  EmbreeDevice device;               // released last
  EmbreeScene triangles;             // scene of this device

  [[nodiscard]] Rgb8 color_at(const TriangleHit& hit, const Vector3d& p_world) const;
  /// The hit with a triangle that Embree has found; nullopt where it found none, or one behind the origin.
  [[nodiscard]] std::optional<TriangleHit> hit_of(unsigned object, unsigned triangle, const Vector3d& origin,
                                                  const Vector3d& direction) const;
  /// Casts rays from one point that have nearly the same direction. Each hit is that of RayScene::cast.
  [[nodiscard]] std::array<std::optional<TriangleHit>, kPacket> cast_packet(const Vector3d& origin,
                                                                            std::span<const Vector3d> directions) const;
};

namespace {

/// Returns the direction to the light, fixed so that pictures of scenes compare.
const Vector3d& to_light_world() {
  static const Vector3d direction = Vector3d{0.3, -0.5, 0.8}.normalized();
  return direction;
}
constexpr double kAmbient{0.35};

/// Intersects the ray with the triangle's plane in double precision.
TriangleHit exact_hit(const TriangleMesh& mesh, std::size_t object, std::size_t triangle, const Vector3d& origin,
                      const Vector3d& direction) {
  const auto& [ia, ib, ic] = mesh.triangles[triangle];
  const Vector3d a = mesh.vertices[ia].cast<double>();
  const Vector3d ab = mesh.vertices[ib].cast<double>() - a;
  const Vector3d ac = mesh.vertices[ic].cast<double>() - a;
  const Vector3d normal = ab.cross(ac);
  TriangleHit hit;
  hit.object = object;
  hit.triangle = triangle;
  hit.normal_world = normal.normalized();
  hit.t = normal.dot(a - origin) / normal.dot(direction);
  const Vector3d ap = origin + hit.t * direction - a;
  const double area = normal.squaredNorm();
  hit.barycentric = {normal.dot(ap.cross(ac)) / area, normal.dot(ab.cross(ap)) / area};
  return hit;
}

}  // namespace

Rgb8 RayScene::Impl::color_at(const TriangleHit& hit, const Vector3d& p_world) const {
  const SceneObject& object = scene.objects[hit.object];
  const TriangleMesh& mesh = meshes[hit.object].mesh;
  Vector3d color;
  if (mesh.colors.empty()) {
    const Pose& to_object = T_object_world[hit.object];
    const Paint paint = paint_at(object, to_object * p_world, to_object.linear() * hit.normal_world);
    color = Vector3d{double(paint.color[0]), double(paint.color[1]), double(paint.color[2])};
  } else {
    const auto& [a, b, c] = mesh.triangles[hit.triangle];
    for (int k = 0; k < 3; ++k) {
      const auto channel = static_cast<std::size_t>(k);
      color[k] = mesh.colors[a][channel] * (1.0 - hit.barycentric.sum()) +
                 mesh.colors[b][channel] * hit.barycentric.x() + mesh.colors[c][channel] * hit.barycentric.y();
    }
  }
  const double lambert = std::max(0.0, hit.normal_world.dot(to_light_world()));
  const double light = kAmbient + (1.0 - kAmbient) * lambert;
  const auto shaded = [&](Eigen::Index k) {
    return static_cast<std::uint8_t>(std::clamp(color[k] * light + 0.5, 0.0, 255.0));  // rounds to the nearest
  };
  return {shaded(0), shaded(1), shaded(2)};
}

std::optional<TriangleHit> RayScene::Impl::hit_of(unsigned object, unsigned triangle, const Vector3d& origin,
                                                  const Vector3d& direction) const {
  if (object == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const TriangleHit hit = exact_hit(meshes[object].mesh, object, triangle, origin, direction);
  if (!(hit.t > 0.0) || !std::isfinite(hit.t)) return std::nullopt;
  return hit;
}

std::array<std::optional<TriangleHit>, kPacket> RayScene::Impl::cast_packet(
    const Vector3d& origin, std::span<const Vector3d> directions) const {
  SACCADE_EXPECTS(directions.size() <= kPacket);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(32) std::array<int, kPacket> valid{};
  RTCRayHit8 query{};
  for (std::size_t i = 0; i < directions.size(); ++i) {
    valid[i] = -1;
    query.ray.org_x[i] = static_cast<float>(origin.x());
    query.ray.org_y[i] = static_cast<float>(origin.y());
    query.ray.org_z[i] = static_cast<float>(origin.z());
    query.ray.dir_x[i] = static_cast<float>(directions[i].x());
    query.ray.dir_y[i] = static_cast<float>(directions[i].y());
    query.ray.dir_z[i] = static_cast<float>(directions[i].z());
    query.ray.tfar[i] = std::numeric_limits<float>::infinity();
    query.ray.mask[i] = ~0U;
    query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
  }
  rtcIntersect8(valid.data(), triangles.get(), &context, &query);
  std::array<std::optional<TriangleHit>, kPacket> hits;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    hits[i] = hit_of(query.hit.geomID[i], query.hit.primID[i], origin, directions[i]);
  }
  return hits;
}

RayScene::RayScene(std::shared_ptr<const Impl> impl) : impl_{std::move(impl)} {}

Result<RayScene> RayScene::build(Scene scene) {
  SACCADE_TRY(std::vector<ObjectMesh> meshes, true_meshes(scene));
  EmbreeDevice device{rtcNewDevice(nullptr)};
  if (!device) return embree_failed(nullptr);
  EmbreeScene triangles{rtcNewScene(device.get())};
  if (!triangles) return embree_failed(device.get());
  rtcSetSceneFlags(triangles.get(), RTC_SCENE_FLAG_ROBUST);  // no ray passes between neighbouring triangles
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    if (!attach_mesh(device.get(), triangles.get(), meshes[i].mesh, static_cast<unsigned>(i)))
      return embree_failed(device.get());
  }
  rtcCommitScene(triangles.get());
  if (rtcGetDeviceError(device.get()) != RTC_ERROR_NONE) return embree_failed(device.get());
  std::vector<Pose> T_object_world;
  for (const SceneObject& object : scene.objects) T_object_world.push_back(object.T_world_object.inverse());
  return RayScene{std::make_shared<const Impl>(
      Impl{std::move(scene), std::move(meshes), std::move(T_object_world), std::move(device), std::move(triangles)})};
}

const Scene& RayScene::scene() const { return impl_->scene; }

const std::vector<ObjectMesh>& RayScene::meshes() const { return impl_->meshes; }

std::optional<TriangleHit> RayScene::cast(const Vector3d& origin, const Vector3d& direction) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit query{};
  query.ray.org_x = static_cast<float>(origin.x());
  query.ray.org_y = static_cast<float>(origin.y());
  query.ray.org_z = static_cast<float>(origin.z());
  query.ray.dir_x = static_cast<float>(direction.x());
  query.ray.dir_y = static_cast<float>(direction.y());
  query.ray.dir_z = static_cast<float>(direction.z());
  query.ray.tfar = std::numeric_limits<float>::infinity();
  query.ray.mask = ~0U;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(impl_->triangles.get(), &context, &query);
  return impl_->hit_of(query.hit.geomID, query.hit.primID, origin, direction);
}

ExactFrame RayScene::render(const PinholeCamera& camera, const Pose& T_world_camera, const Executor& executor) const {
  SACCADE_EXPECTS(camera.validate().ok() && T_world_camera.matrix().allFinite());
  ExactFrame frame{DepthImage{camera.width, camera.height}, ColorImage{camera.width, camera.height},
                   Image<int>{camera.width, camera.height, -1}, Image<float>{camera.width, camera.height}};
  const Vector3d origin = T_world_camera.translation();
  const auto set_pixel = [&](int u, int v, const std::optional<TriangleHit>& hit, const Vector3d& direction) {
    if (!hit || hit->t < camera.min_range_m || hit->t > camera.max_range_m) return;
    frame.depth(u, v) = static_cast<float>(hit->t);
    frame.color(u, v) = impl_->color_at(*hit, origin + hit->t * direction);
    frame.object(u, v) = static_cast<int>(hit->object);
    frame.incidence_cosine(u, v) = static_cast<float>(std::fabs(hit->normal_world.dot(direction)) / direction.norm());
  };
  const auto render_packet = [&](int first, int v) {
    std::array<Vector3d, kPacket> directions;
    const int count = std::min(static_cast<int>(kPacket), camera.width - first);
    for (int i = 0; i < count; ++i) {
      // The ray has z = 1 in the camera's frame, so t is the depth.
      directions[static_cast<std::size_t>(i)] = T_world_camera.linear() * camera.ray(first + i, v);
    }
    const auto hits = impl_->cast_packet(origin, std::span{directions}.first(static_cast<std::size_t>(count)));
    for (int i = 0; i < count; ++i) {
      set_pixel(first + i, v, hits[static_cast<std::size_t>(i)], directions[static_cast<std::size_t>(i)]);
    }
  };
  constexpr std::size_t kRowsPerTask{16};
  executor.parallel_for(static_cast<std::size_t>(camera.height), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    for (auto v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
      for (int u = 0; u < camera.width; u += static_cast<int>(kPacket)) render_packet(u, v);
    }
  });
  return frame;
}

}  // namespace saccade
