// SPDX-License-Identifier: Apache-2.0
// SpaceNearObjects, unknown_near_objects, newly_known: voxels near true surfaces. A cube of voxels that is surely near
// or surely far is decided by the distance of its middle; the rest is asked voxel by voxel.
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <numeric>
#include <vector>

#include "saccade/map/voxels_inside.hpp"
#include "saccade/trial/metrics.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr double kRounding_m{1e-9};  // above the rounding of distances, below any voxel

/// Finds the voxels of one brick near objects.
class NearVoxels {
 public:
  NearVoxels(const GroundTruth& truth, double voxel_size_m, double within_m)
      : truth_{truth}, voxel_size_m_{voxel_size_m}, within_m_{within_m} {}

  /// Returns those of the wanted voxels of the brick from voxel `lo` whose centre is within the distance, to the bit as
  /// if each were asked.
  [[nodiscard]] Mask512 among(const Mask512& wanted, const Index3& lo) const {
    Mask512 near;
    add_cube(lo, IndexBox::cube({0, 0, 0}, kBrickEdge), wanted, near);
    return near;
  }

 private:
  void add_cube(const Index3& lo, const IndexBox& cube, const Mask512& wanted, Mask512& near) const {
    const Mask512 asked = wanted & voxels_inside(cube, {0, 0, 0});
    if (asked.none()) return;
    const int edge = cube.size().x;
    if (edge == 1) {
      const double distance_m = truth_.to_objects_m(voxel_center(lo + cube.lo, voxel_size_m_), 2.0 * within_m_);
      if (distance_m <= within_m_) near.set(child_index(cube.lo));
      return;
    }
    const Vector3d middle =
        0.5 * (voxel_center(lo + cube.lo, voxel_size_m_) + voxel_center(lo + cube.hi - Index3{1, 1, 1}, voxel_size_m_));
    const double to_corner_m = 0.5 * std::sqrt(3.0) * (edge - 1) * voxel_size_m_;
    const double far_m = within_m_ + to_corner_m + kRounding_m;
    const double distance_m = truth_.to_objects_m(middle, far_m);
    if (distance_m >= far_m) return;
    if (distance_m + to_corner_m + kRounding_m <= within_m_) {
      near = near | asked;
      return;
    }
    const int half = edge / 2;
    for (int i = 0; i < 8; ++i) {
      const Index3 octant{i & 1, (i >> 1) & 1, (i >> 2) & 1};
      add_cube(lo, IndexBox::cube(cube.lo + octant * half, half), wanted, near);
    }
  }

  const GroundTruth& truth_;
  double voxel_size_m_;
  double within_m_;
};

/// Adds up measure(brick) over the bricks with voxels in the box, layer by layer.
template <class Count, class Measure>
Count sum_over_bricks(const IndexBox& voxels, const Executor& executor, const Measure& measure) {
  const IndexBox bricks = parents(voxels);
  std::vector<Count> layers(static_cast<std::size_t>(bricks.size().z));
  executor.parallel_for(layers.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t layer = begin; layer < end; ++layer) {
      bricks.layer(layer).for_each([&](const Index3& brick) { layers[layer] += measure(brick); });
    }
  });
  return std::accumulate(layers.begin(), layers.end(), Count{});
}

}  // namespace

/// Voxels near objects, brick by brick. Immutable.
class SpaceNearObjects {
 public:
  struct Brick {
    Index3 key;
    Mask512 voxels;
  };
  SpaceNearObjects(std::vector<Brick> bricks, double voxel_size_m)
      : bricks_{std::move(bricks)}, voxel_size_m_{voxel_size_m} {}

  [[nodiscard]] double voxel_size_m() const { return voxel_size_m_; }

  [[nodiscard]] std::size_t unknown_in(const TsdfGrid& grid) const {
    return std::accumulate(bricks_.begin(), bricks_.end(), std::size_t{0}, [&](std::size_t sum, const Brick& brick) {
      return sum + static_cast<std::size_t>((grid.unknown_in(brick.key) & brick.voxels).count());
    });
  }

 private:
  std::vector<Brick> bricks_;
  double voxel_size_m_;
};

namespace {

/// Finds the voxels in the workspace and outside the solids, their centre within kNearObjects_m of an object's surface.
std::vector<SpaceNearObjects::Brick> bricks_near_objects(const GroundTruth& truth, double voxel_size_m,
                                                         const Executor& executor) {
  const Box& workspace = truth.scene().scene().workspace;
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high = -low;
  for (const ObjectMesh& object : truth.scene().meshes()) {
    if (object.support) continue;
    for (const Eigen::Vector3f& vertex : object.mesh.vertices) {
      low = low.cwiseMin(vertex.cast<double>());
      high = high.cwiseMax(vertex.cast<double>());
    }
  }
  low = (low - Vector3d::Constant(kNearObjects_m)).cwiseMax(workspace.min);
  high = (high + Vector3d::Constant(kNearObjects_m)).cwiseMin(workspace.max);
  if (!(low.array() < high.array()).all()) return {};
  const IndexBox box{voxel_at(low, voxel_size_m), voxel_at(high, voxel_size_m) + Index3{1, 1, 1}};
  const IndexBox keys = parents(box);
  const NearVoxels near{truth, voxel_size_m, kNearObjects_m};
  std::vector<std::vector<SpaceNearObjects::Brick>> layers(static_cast<std::size_t>(keys.size().z));
  executor.parallel_for(layers.size(), 1, [&](std::size_t layer, std::size_t) {
    keys.layer(layer).for_each([&](const Index3& key) {
      const Index3 lo = key * kBrickEdge;
      const Mask512 asked = voxels_inside(box, lo) & voxels_inside(workspace, lo, voxel_size_m);
      Mask512 voxels;
      near.among(asked, lo).for_each([&](std::size_t i) {
        const Index3 voxel = lo + child_offset(static_cast<int>(i));
        if (!truth.inside_solid(voxel_center(voxel, voxel_size_m))) voxels.set(static_cast<int>(i));
      });
      if (!voxels.none()) layers[layer].push_back({key, voxels});
    });
  });
  std::vector<SpaceNearObjects::Brick> bricks;
  for (const auto& layer : layers) bricks.insert(bricks.end(), layer.begin(), layer.end());
  return bricks;
}

}  // namespace

struct GroundTruth::Kept {
  std::mutex mutex;
  std::shared_ptr<const SpaceNearObjects> near;
};

std::shared_ptr<GroundTruth::Kept> GroundTruth::nothing_kept() { return std::make_shared<Kept>(); }

std::shared_ptr<const SpaceNearObjects> GroundTruth::space_near_objects(double voxel_size_m,
                                                                        const Executor& executor) const {
  Kept& kept = *data_->kept;
  {
    const std::lock_guard lock{kept.mutex};
    if (kept.near && kept.near->voxel_size_m() == voxel_size_m) return kept.near;
  }
  // Not under the lock: a thread that waits for its loop may begin another task that asks for the same.
  auto near =
      std::make_shared<const SpaceNearObjects>(bricks_near_objects(*this, voxel_size_m, executor), voxel_size_m);
  const std::lock_guard lock{kept.mutex};
  kept.near = near;
  return near;
}

std::size_t unknown_near_objects(const GroundTruth& truth, const TsdfSnapshot& map, const Executor& executor) {
  return truth.space_near_objects(map.config.voxel_size_m, executor)->unknown_in(map.grid);
}

ObservedGain newly_known(const GroundTruth& truth, const TsdfSnapshot& before, const TsdfSnapshot& after,
                         const Executor& executor) {
  const double e = after.config.voxel_size_m;
  const IndexBox box = voxels_with_center_in(truth.scene().scene().workspace, e);
  if (box.empty()) return {};
  const NearVoxels near{truth, e, kAtObject_m};
  return sum_over_bricks<ObservedGain>(box, executor, [&](const Index3& brick) {
    const Index3 lo = brick * kBrickEdge;
    const Mask512 known = before.grid.unknown_in(brick) & ~after.grid.unknown_in(brick) & voxels_inside(box, lo);
    if (known.none()) return ObservedGain{};
    return ObservedGain{static_cast<std::size_t>(known.count()),
                        static_cast<std::size_t>(near.among(known, lo).count())};
  });
}

}  // namespace saccade
