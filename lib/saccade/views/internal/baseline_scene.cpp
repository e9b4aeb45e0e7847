// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/baseline_scene.hpp"

#include <algorithm>
#include <cmath>

#include "saccade/views/internal/completed_objects.hpp"
#include "saccade/views/internal/find_supports.hpp"

namespace saccade {
namespace {

constexpr std::int32_t kBelow_vox{2};  // margin below objects: includes their support, not the space below it

IndexBox box_around(const StateVolume& volume, std::span<const std::uint32_t> voxels) {
  IndexBox box = IndexBox::cube(volume.voxel(voxels.front()), 1);
  for (const std::uint32_t i : voxels) box = box.hull(IndexBox::cube(volume.voxel(i), 1));
  return box;
}

}  // namespace

Status BaselineGainConfig::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "baseline gain"}; };
  SACCADE_CHECK(sensor.validate());
  if (!(tilt_rad >= 0.0 && std::isfinite(tilt_rad))) return fail("the tilt must not be negative");
  if (columns_px < 1) return fail("at least one column of rays is needed");
  if (!(object_margin_m >= 0.0 && std::isfinite(object_margin_m)))
    return fail("the margin around objects must not be negative");
  return {};
}

Result<BaselineScene> read_baseline_scene(const PlanningContext& context, const RegionOfInterest& region,
                                          double object_margin_m) {
  const TsdfSnapshot& map = context.map;
  const double voxel_m = map.config.voxel_size_m;
  const IndexBox box =
      map.config.workspace ? voxels_with_center_in(*map.config.workspace, voxel_m) : map.grid.known_bounds();
  BaselineScene scene;
  scene.bounds = region.bounds;
  SACCADE_TRY(scene.volume, StateVolume::read(map, box, context.executor));
  if (scene.volume.size() == 0) return scene;
  scene.counted = box;
  const std::vector<Support> supports = find_supports(context.map, scene.volume, kMinSupport_m2, context.executor);
  std::vector<std::vector<std::int32_t>> tops;
  for (const Support& support : supports) tops.push_back(top_layers(scene.volume, support));
  const CompletedObjects objects = complete_objects(scene.volume, {tops, {}}, context.executor);
  if (!objects.seen.empty()) {
    const auto margin_vox = static_cast<std::int32_t>(std::lround(object_margin_m / voxel_m));
    IndexBox around = box_around(scene.volume, objects.seen).grown(margin_vox);
    scene.on_support = !supports.empty();
    if (scene.on_support) around.lo.z += std::max(margin_vox - kBelow_vox, 0);
    scene.counted = around.intersection(box);
  }
  return scene;
}

PinholeCamera sampled_camera(const BaselineGainConfig& config) {
  const int columns_px = std::min(config.columns_px, config.sensor.width);
  return widened_vertically(config.sensor.scaled_to_width(columns_px), config.tilt_rad);
}

Neighbours::Neighbours(const StateVolume& volume) {
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        if (x == 0 && y == 0 && z == 0) continue;
        offsets.push_back(z * volume.layer() + y * volume.row() + x);
        directions.emplace_back(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
      }
    }
  }
}

std::vector<SurfaceVoxel> surface_voxels(const StateVolume& volume, const IndexBox& box, const Executor& executor) {
  const IndexBox inner = box.intersection(volume.box().grown(-1));
  if (inner.empty()) return {};
  const Neighbours around{volume};
  std::vector<std::vector<SurfaceVoxel>> layers(static_cast<std::size_t>(inner.size().z));
  executor.parallel_for(layers.size(), 1, [&](std::size_t layer, std::size_t) {
    inner.layer(layer).for_each([&](const Index3& voxel) {
      const std::size_t i = volume.index(voxel);
      if (volume[i] != VoxelState::occupied) return;
      Eigen::Vector3f normal{Eigen::Vector3f::Zero()};
      Eigen::Vector3f faces{Eigen::Vector3f::Zero()};
      bool exposed = false;
      for (std::size_t k = 0; k < around.offsets.size(); ++k) {
        if (volume[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(i) + around.offsets[k])] != VoxelState::empty)
          continue;
        const Eigen::Vector3f& direction = around.directions[k];
        normal += direction;
        if (direction.squaredNorm() > 1.5F) continue;
        exposed = true;
        faces += direction;
      }
      if (!exposed || normal.squaredNorm() < 1e-6F) return;
      normal.normalize();
      layers[layer].push_back(
          {static_cast<std::uint32_t>(i), normal, std::max(faces.cwiseAbs().dot(normal.cwiseAbs()), 0.5F)});
    });
  });
  std::vector<SurfaceVoxel> all;
  for (const std::vector<SurfaceVoxel>& part : layers) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace saccade
