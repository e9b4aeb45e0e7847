// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/surface_coverage.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "saccade/map/voxel_index.hpp"
#include "saccade/scene/solids.hpp"
#include "saccade/scene/surface_samples.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr double kSlack_m{5e-4};  // a ray that ends this near to a point has reached it

/// Returns samples of the objects that do not lie inside another object.
Result<SurfaceSamples> outer_surface(const RayScene& scene, double spacing_m, const Executor& executor) {
  std::vector<Solids> bodies;
  std::vector<Box> around;  // looked at first, since it costs less
  std::vector<std::uint32_t> numbers;
  std::vector<ObjectMesh> objects;
  for (std::size_t i = 0; i < scene.meshes().size(); ++i) {
    if (scene.meshes()[i].support) continue;
    const std::string& name = scene.meshes()[i].name;
    SACCADE_TRY(Solids body, Solids::build(scene, [&](const SceneObject& object) { return object.name == name; }));
    bodies.push_back(std::move(body));
    around.push_back(bounds_of(scene.meshes()[i].mesh));
    numbers.push_back(static_cast<std::uint32_t>(i));
    objects.push_back(scene.meshes()[i]);
  }
  const SurfaceSamples samples = sample_surfaces(objects, spacing_m);
  std::vector<std::uint8_t> hidden(samples.points.size());
  executor.parallel_for(hidden.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vector3d p = samples.points[i].cast<double>();
      for (std::size_t other = 0; other < bodies.size() && hidden[i] == 0; ++other) {
        if (other == samples.objects[i] || !contains(around[other], p)) continue;
        hidden[i] = bodies[other].contain(p) ? 1 : 0;
      }
    }
  });
  SurfaceSamples outer;
  for (std::size_t i = 0; i < hidden.size(); ++i) {
    if (hidden[i] != 0) continue;
    outer.points.push_back(samples.points[i]);
    outer.normals.push_back(samples.normals[i]);
    outer.objects.push_back(numbers[samples.objects[i]]);
  }
  return outer;
}

/// Tells whether the view has a pixel for the point, and nothing hides it.
bool sees(const RayScene& scene, const PinholeCamera& camera, const Pose& T_world_camera, const Vector3d& p_world) {
  const Vector3d p_camera = T_world_camera.inverse(Eigen::Isometry) * p_world;
  if (p_camera.z() < camera.min_range_m || p_camera.z() > camera.max_range_m) return false;
  const Eigen::Vector2d pixel = camera.project(p_camera);
  if (pixel.x() < -0.5 || pixel.x() >= camera.width - 0.5 || pixel.y() < -0.5 || pixel.y() >= camera.height - 0.5) {
    return false;
  }
  const Vector3d origin = T_world_camera.translation();
  const Vector3d direction = p_world - origin;
  const auto hit = scene.cast(origin, direction);
  return !hit || hit->t * direction.norm() >= direction.norm() - kSlack_m;
}

/// Returns the part of the camera's image that may show the box; the whole image where the box is not all in front.
PinholeCamera cropped(const PinholeCamera& camera, const Pose& T_world_camera, const Eigen::AlignedBox3d& box) {
  Eigen::AlignedBox2d shown;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d p =
        T_world_camera.inverse(Eigen::Isometry) * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner));
    if (p.z() <= 0.01) return camera;
    shown.extend(camera.project(p));
  }
  const auto within = [](double value, int size) { return static_cast<int>(std::clamp(value, 0.0, size - 1.0)); };
  const int u0 = within(std::floor(shown.min().x()) - 1.0, camera.width);
  const int v0 = within(std::floor(shown.min().y()) - 1.0, camera.height);
  PinholeCamera part = camera;
  part.width = within(std::ceil(shown.max().x()) + 1.0, camera.width) - u0 + 1;
  part.height = within(std::ceil(shown.max().y()) + 1.0, camera.height) - v0 + 1;
  part.cx -= u0;
  part.cy -= v0;
  return part;
}

}  // namespace

Status CoverageRule::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "surface coverage"}; };
  if (!(std::isfinite(size_m) && size_m > 0.0)) return fail("the size of what counts as measured must be positive");
  if (!(std::isfinite(spacing_m) && spacing_m > 0.0)) return fail("the spacing of the samples must be positive");
  if (kind == Kind::voxels && size_m < spacing_m) return fail("voxels must not be smaller than the spacing");
  return {};
}

struct SurfaceCoverage::Data {
  struct CellHash {
    std::size_t operator()(const Index3& cell) const {
      const auto mixed = [](std::int32_t value, std::uint64_t factor) {
        return static_cast<std::uint64_t>(static_cast<std::uint32_t>(value)) * factor;
      };
      return static_cast<std::size_t>(mixed(cell.x, 0x9e3779b97f4a7c15ULL) ^ mixed(cell.y, 0xc2b2ae3d27d4eb4fULL) ^
                                      mixed(cell.z, 0x165667b19e3779f9ULL));
    }
  };
  using Cells = std::unordered_map<Index3, std::vector<std::uint32_t>, CellHash>;

  RayScene scene;
  PinholeCamera camera;
  CoverageRule rule;
  std::vector<Vector3d> points;       ///< samples of the surface
  std::vector<Vector3d> normals;      ///< outward, per sample
  std::vector<std::uint32_t> part;    ///< per sample: its voxel, or itself
  std::vector<std::uint8_t> visible;  ///< per part
  std::size_t visible_count{0};
  Eigen::AlignedBox3d bounds;  ///< around the objects
  Cells cells;                 ///< by voxels, or cells as large as the distance: the samples in them
};

Result<SurfaceCoverage> SurfaceCoverage::build(const RayScene& scene, const PinholeCamera& camera,
                                               std::span<const Pose> candidates, const CoverageRule& rule,
                                               const Executor& executor) {
  SACCADE_CHECK(rule.validate());
  SACCADE_CHECK(camera.validate());
  Data data{scene, camera, rule, {}, {}, {}, {}, 0, {}, {}};
  for (const ObjectMesh& object : scene.meshes()) {
    if (object.support) continue;
    for (const Eigen::Vector3f& p : object.mesh.vertices) data.bounds.extend(p.cast<double>());
  }
  SACCADE_TRY(const SurfaceSamples samples, outer_surface(scene, rule.spacing_m, executor));
  for (const Eigen::Vector3f& point : samples.points) data.points.push_back(point.cast<double>());
  for (const Eigen::Vector3f& normal : samples.normals) data.normals.push_back(normal.cast<double>());
  if (data.points.empty()) {
    return Error{Errc::invalid_argument, "there is no object whose surface could be measured", "surface coverage"};
  }
  std::size_t parts = 0;
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    std::vector<std::uint32_t>& cell = data.cells[voxel_at(data.points[i], rule.size_m)];
    const bool joins = rule.kind == CoverageRule::Kind::voxels && !cell.empty();
    data.part.push_back(joins ? data.part[cell.front()] : static_cast<std::uint32_t>(parts++));
    cell.push_back(static_cast<std::uint32_t>(i));
  }
  std::vector<std::uint8_t> seen(data.points.size());
  if (candidates.empty()) {
    seen = observable(scene, samples, {}, executor);
  } else {
    executor.parallel_for(seen.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto shows = [&](const Pose& view) { return sees(scene, camera, view, data.points[i]); };
        seen[i] = std::any_of(candidates.begin(), candidates.end(), shows) ? 1 : 0;
      }
    });
  }
  data.visible.assign(parts, 0);
  for (std::size_t i = 0; i < seen.size(); ++i) data.visible[data.part[i]] |= seen[i];
  data.visible_count = static_cast<std::size_t>(std::count(data.visible.begin(), data.visible.end(), 1));
  return SurfaceCoverage{std::make_shared<const Data>(std::move(data))};
}

std::size_t SurfaceCoverage::size() const { return data_->visible.size(); }
std::size_t SurfaceCoverage::visible() const { return data_->visible_count; }

std::vector<CoverageShares> SurfaceCoverage::along(std::span<const Pose> views, const Executor& executor) const {
  const Data& data = *data_;
  std::vector<std::uint8_t> measured(data.visible.size());
  std::size_t of_visible = 0;
  std::size_t of_all = 0;
  const auto mark = [&](std::uint32_t part) {
    if (measured[part] != 0) return;
    measured[part] = 1;
    ++of_all;
    of_visible += data.visible[part];
  };
  const auto add_voxel = [&](const Vector3d& p) {
    const auto cell = data.cells.find(voxel_at(p, data.rule.size_m));
    if (cell != data.cells.end()) mark(data.part[cell->second.front()]);
  };
  // A point on the far side of a thin wall lies near to what was measured, but no view has seen it.
  const auto add_near = [&](const Vector3d& p, const Vector3d& eye) {
    const Index3 middle = voxel_at(p, data.rule.size_m);
    IndexBox::cube(middle, 1).grown(1).for_each([&](const Index3& voxel) {
      const auto cell = data.cells.find(voxel);
      if (cell == data.cells.end()) return;
      for (const std::uint32_t i : cell->second) {
        if (measured[i] != 0 || data.normals[i].dot(eye - data.points[i]) <= 0.0) continue;
        if ((data.points[i] - p).norm() <= data.rule.size_m) mark(i);
      }
    });
  };
  std::vector<CoverageShares> shares;
  for (const Pose& view : views) {
    const PinholeCamera camera = cropped(data.camera, view, data.bounds);
    const ExactFrame frame = data.scene.render(camera, view, executor);
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const int object = frame.object(u, v);
        if (object < 0 || data.scene.meshes()[static_cast<std::size_t>(object)].support) continue;
        const Vector3d p = view * (static_cast<double>(frame.depth(u, v)) * camera.ray(u, v));
        data.rule.kind == CoverageRule::Kind::voxels ? add_voxel(p) : add_near(p, view.translation());
      }
    }
    const auto share = [](std::size_t part, std::size_t of) {
      return of > 0 ? static_cast<double>(part) / static_cast<double>(of) : 0.0;
    };
    shares.push_back({share(of_visible, data.visible_count), share(of_all, data.visible.size())});
  }
  return shares;
}

}  // namespace saccade
