// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/arm_silhouette.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "saccade/arm/arm_mesh.hpp"
#include "saccade/arm/internal/depth_raster.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr double kMostCovered{0.9};  ///< share of the image covered by the camera's own link
constexpr std::size_t kRowsPerTask{32};

/// Tells whether the camera's centre, the origin, is on the outer side of the triangle's plane.
bool faces_camera(const Vector3d& a, const Vector3d& b, const Vector3d& c) { return (b - a).cross(c - a).dot(a) < 0.0; }

std::size_t covered_pixels(const Image<float>& inverse_depth) {
  return static_cast<std::size_t>(
      std::count_if(inverse_depth.pixels().begin(), inverse_depth.pixels().end(), [](float w) { return w > 0.0F; }));
}

/// Returns the largest x/z or y/z of points in the image, with `beyond` pixels around it.
double half_extent(int pixels, double middle, double focal, double beyond) {
  return (std::max(middle, pixels - 1 - middle) + 0.5 + beyond) / focal;
}

}  // namespace

Status ArmSilhouetteConfig::validate() const {
  for (const double value : {margin_m, border_px, most_share, depth_error_per_m}) {
    if (!std::isfinite(value) || value < 0.0) {
      return Error{Errc::invalid_argument, "its margins must be finite and not negative", "arm silhouette"};
    }
  }
  return {};
}

ArmSilhouette::ArmSilhouette(const ArmModel& arm, const PinholeCamera& camera, const ArmSilhouetteConfig& config)
    : arm_{std::make_shared<const ArmModel>(arm)}, camera_{camera}, config_{config} {}

Result<ArmSilhouette> ArmSilhouette::create(const ArmModel& arm, const PinholeCamera& camera,
                                            const ArmSilhouetteConfig& config) {
  SACCADE_CHECK(camera.validate());
  SACCADE_CHECK(config.validate());
  ArmSilhouette silhouette{arm, camera, config};
  const std::size_t last = arm.links().size() - 1;
  for (std::size_t link = 0; link < last; ++link) {
    for (const CollisionBody& body : arm.links()[link].bodies) {
      silhouette.surfaces_.push_back(surface_of(body, link));
    }
  }
  const Pose T_camera_hand = arm.T_link_camera().inverse(Eigen::Isometry);
  DepthRaster exact{camera, {}};
  DepthRaster enlarged{camera, silhouette.growth()};
  std::string names;
  for (const CollisionBody& body : arm.links()[last].bodies) {
    const Surface surface = surface_of(body, last);
    if (!silhouette.may_be_seen(surface, T_camera_hand)) continue;
    add(surface, T_camera_hand, exact);
    add(surface, T_camera_hand, enlarged);
    names += (names.empty() ? "" : ", ") + body.name;
  }
  if (!exact.empty()) {
    silhouette.hand_ = Image<float>{camera.width, camera.height};
    exact.draw_rows(0, camera.height, silhouette.hand_->data());
    const std::size_t covered = covered_pixels(*silhouette.hand_);
    if (static_cast<double>(covered) > kMostCovered * static_cast<double>(silhouette.hand_->size())) {
      return Error{Errc::invalid_argument,
                   "the camera sees hardly anything but what it is fixed to (" + names +
                       "): its optical frame lies behind a body or in an open mesh, or looks the wrong way",
                   arm.name()};
    }
  }
  if (!enlarged.empty()) {
    silhouette.hand_with_margins_ = Image<float>{camera.width, camera.height};
    enlarged.draw_rows(0, camera.height, silhouette.hand_with_margins_->data());
  }
  return silhouette;
}

ArmSilhouette::Surface ArmSilhouette::surface_of(const CollisionBody& body, std::size_t link) {
  const TriangleMesh mesh = body_surface(body);
  Surface surface;
  surface.link = link;
  // Merges vertices at one place, so that triangles know their neighbours.
  std::map<std::array<float, 3>, std::uint32_t> index;
  std::vector<std::uint32_t> welded;
  for (const Eigen::Vector3f& p : mesh.vertices) {
    const auto [it, is_new] =
        index.try_emplace({p.x(), p.y(), p.z()}, static_cast<std::uint32_t>(surface.vertices.size()));
    if (is_new) surface.vertices.push_back(p.cast<double>());
    welded.push_back(it->second);
  }
  double volume = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::array<std::uint32_t, 3> t{welded[a], welded[b], welded[c]};
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    surface.triangles.push_back(t);
    volume += surface.vertices[t[0]].dot(surface.vertices[t[1]].cross(surface.vertices[t[2]]));
  }
  connect(surface);
  if (surface.closed && volume < 0.0) {
    for (auto& t : surface.triangles) std::swap(t[1], t[2]);
    connect(surface);
  }
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high = -low;
  for (const Vector3d& p : surface.vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  surface.center = 0.5 * (low + high);
  for (const Vector3d& p : surface.vertices) {
    surface.radius_m = std::max(surface.radius_m, (p - surface.center).norm());
  }
  return surface;
}

/// Finds the neighbours. A surface is closed when every edge occurs once in each direction.
void ArmSilhouette::connect(Surface& surface) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> triangle_at;  // by directed edge
  bool single = true;
  for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& corners = surface.triangles[t];
    for (std::size_t i = 0; i < 3; ++i) {
      single = triangle_at.try_emplace({corners[i], corners[(i + 1) % 3]}, t).second && single;
    }
  }
  surface.neighbors.assign(surface.triangles.size(), {kNone, kNone, kNone});
  surface.closed = single;
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& corners = surface.triangles[t];
    for (std::size_t i = 0; i < 3; ++i) {
      const auto across = triangle_at.find({corners[(i + 1) % 3], corners[i]});
      if (across != triangle_at.end() && single) surface.neighbors[t][i] = across->second;
      surface.closed = surface.closed && across != triangle_at.end();
    }
  }
}

RasterGrowth ArmSilhouette::growth() const {
  return {config_.margin_m, config_.border_px, config_.most_share * camera_.width};
}

bool ArmSilhouette::may_be_seen(const Surface& surface, const Pose& T_camera_link) const {
  const Vector3d p = T_camera_link * surface.center;
  const double beyond_px = config_.most_share * camera_.width;
  const double x = half_extent(camera_.width, camera_.cx, camera_.fx, beyond_px);
  const double y = half_extent(camera_.height, camera_.cy, camera_.fy, beyond_px);
  const double radius_m = surface.radius_m;
  return p.z() + radius_m > DepthRaster::kNearest_m && std::fabs(p.x()) - x * p.z() <= radius_m * std::hypot(1.0, x) &&
         std::fabs(p.y()) - y * p.z() <= radius_m * std::hypot(1.0, y);
}

void ArmSilhouette::add(const Surface& surface, const Pose& T_camera_link, DepthRaster& raster) {
  std::vector<Vector3d> p_camera;
  p_camera.reserve(surface.vertices.size());
  for (const Vector3d& p : surface.vertices) p_camera.emplace_back(T_camera_link * p);
  const auto corner = [&](std::size_t t, std::size_t i) -> const Vector3d& {
    return p_camera[surface.triangles[t][i]];
  };
  std::vector<char> faces(surface.triangles.size());
  for (std::size_t t = 0; t < faces.size(); ++t) {
    faces[t] = faces_camera(corner(t, 0), corner(t, 1), corner(t, 2)) ? 1 : 0;
  }
  for (std::size_t t = 0; t < faces.size(); ++t) {
    if (surface.closed && faces[t] == 0) continue;
    const auto ends = [&](std::uint32_t neighbor) { return neighbor == kNone || faces[neighbor] != faces[t]; };
    const auto& neighbors = surface.neighbors[t];
    const bool at_rim = ends(neighbors[0]) || ends(neighbors[1]) || ends(neighbors[2]);
    raster.add({corner(t, 0), corner(t, 1), corner(t, 2)}, at_rim);
  }
}

DepthRaster ArmSilhouette::others(const Configuration& q, const RasterGrowth& growth) const {
  const ArmPoses poses = forward_kinematics(*arm_, q);
  const Pose T_camera_world = poses.T_world_camera.inverse(Eigen::Isometry);
  DepthRaster raster{camera_, growth};
  for (const Surface& surface : surfaces_) {
    const Pose T_camera_link = T_camera_world * poses.T_world_link[surface.link];
    if (may_be_seen(surface, T_camera_link)) add(surface, T_camera_link, raster);
  }
  return raster;
}

template <class Visit>
void ArmSilhouette::draw(const DepthRaster& raster, const std::optional<Image<float>>& hand, const Executor& executor,
                         const Visit& visit) const {
  const auto width = static_cast<std::size_t>(camera_.width);
  executor.parallel_for(static_cast<std::size_t>(camera_.height), kRowsPerTask,
                        [&](std::size_t begin, std::size_t end) {
                          const std::size_t count = (end - begin) * width;
                          std::vector<float> inverse_depth(count);
                          if (hand) std::copy_n(hand->data() + begin * width, count, inverse_depth.begin());
                          raster.draw_rows(static_cast<int>(begin), static_cast<int>(end), inverse_depth.data());
                          visit(begin * width, inverse_depth);
                        });
}

DepthImage ArmSilhouette::depth(const Configuration& q, const Executor& executor) const {
  const DepthRaster raster = others(q, {});
  DepthImage depth{camera_.width, camera_.height};
  if (raster.empty() && !hand_) return depth;
  draw(raster, hand_, executor, [&](std::size_t first, const std::vector<float>& inverse_depth) {
    float* out = depth.data() + first;
    for (std::size_t i = 0; i < inverse_depth.size(); ++i) {
      const float w = inverse_depth[i];
      const float z = 1.0F / std::max(w, 1e-6F);
      out[i] = w > 0.0F ? z : 0.0F;
    }
  });
  return depth;
}

Result<std::size_t> ArmSilhouette::mask(const Configuration& q, DepthImage& depth, const Executor& executor) const {
  if (depth.width() != camera_.width || depth.height() != camera_.height) {
    return Error{Errc::size_mismatch,
                 "the depth is " + std::to_string(depth.width()) + "x" + std::to_string(depth.height()) +
                     ", the camera's images are " + std::to_string(camera_.width) + "x" +
                     std::to_string(camera_.height),
                 "arm silhouette"};
  }
  const DepthRaster raster = others(q, growth());
  if (raster.empty() && !hand_with_margins_) return std::size_t{0};
  const auto error_per_m = static_cast<float>(config_.depth_error_per_m);
  const std::size_t task = kRowsPerTask * static_cast<std::size_t>(camera_.width);
  std::vector<std::size_t> lost(depth.size() / task + 1);
  draw(raster, hand_with_margins_, executor, [&](std::size_t first, const std::vector<float>& inverse_depth) {
    float* out = depth.data() + first;
    unsigned count = 0;
    for (std::size_t i = 0; i < inverse_depth.size(); ++i) {
      const float w = inverse_depth[i];
      const float d = out[i];
      // d < z − error · z² with z = 1/w: an object stands in front of the arm.
      const bool before = (d > 0.0F) & (d * w * w < w - error_per_m);
      const bool masked = (w > 0.0F) & !before;
      count += static_cast<unsigned>(masked & ((d > 0.0F) | (d < 0.0F)));  // NaN is not a measurement
      out[i] = masked ? 0.0F : d;
    }
    lost[first / task] = count;
  });
  std::size_t sum = 0;
  for (const std::size_t count : lost) sum += count;
  return sum;
}

bool ArmSilhouette::in_picture(const Configuration& q) const {
  return hand_with_margins_ || !others(q, growth()).empty();
}

}  // namespace saccade
