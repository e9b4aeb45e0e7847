// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/expected_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <span>

#include "saccade/views/internal/completed_objects.hpp"
#include "saccade/views/internal/exposure.hpp"
#include "saccade/views/internal/find_supports.hpp"
#include "saccade/views/internal/find_walls.hpp"
#include "saccade/views/internal/state_volume.hpp"
#include "saccade/views/view_device.hpp"

namespace saccade {
namespace {

constexpr float kLeastCosine{0.17364818F};  // the cosine of 80°

/// Merges exposed voxels that lie in one block with an edge of `block` voxels and face the same octant.
std::vector<ExpectedPoint> merged(const StateVolume& volume, std::span<const ExposedVoxel> exposed,
                                  std::int32_t block) {
  struct Keyed {
    std::uint64_t key;
    std::uint32_t index;
  };
  std::vector<Keyed> order(exposed.size());
  const Index3 blocks = parents(volume.box()).size() * kBrickEdge;  // exceeds the number along each axis
  for (std::size_t i = 0; i < exposed.size(); ++i) {
    const Index3 at = volume.voxel(exposed[i].voxel) - volume.box().lo;
    const auto& n = exposed[i].normal;
    const unsigned octant = (n[0] < 0.0F ? 1U : 0U) | (n[1] < 0.0F ? 2U : 0U) | (n[2] < 0.0F ? 4U : 0U);
    const auto part = [&](std::int32_t v) { return static_cast<std::uint64_t>(v / block); };
    order[i] = {
        ((part(at.z) * static_cast<std::uint64_t>(blocks.y) + part(at.y)) * static_cast<std::uint64_t>(blocks.x) +
         part(at.x)) *
                8 +
            octant,
        static_cast<std::uint32_t>(i)};
  }
  std::sort(order.begin(), order.end(),
            [](const Keyed& a, const Keyed& b) { return a.key != b.key ? a.key < b.key : a.index < b.index; });
  const auto voxel_m = static_cast<float>(volume.voxel_size_m());
  const float face_cm2 = voxel_m * voxel_m * 1e4F;
  std::vector<ExpectedPoint> points;
  for (std::size_t first = 0, end = 0; first < order.size(); first = end) {
    Eigen::Vector3f normal{Eigen::Vector3f::Zero()};
    Eigen::Vector3f mean{Eigen::Vector3f::Zero()};
    float area{0.0F};
    const auto center = [&](const ExposedVoxel& e) -> Eigen::Vector3f {
      return voxel_center(volume.voxel(e.voxel), volume.voxel_size_m()).cast<float>();
    };
    for (end = first; end < order.size() && order[end].key == order[first].key; ++end) {
      const ExposedVoxel& e = exposed[order[end].index];
      normal += e.area_vox * Eigen::Vector3f{e.normal[0], e.normal[1], e.normal[2]};
      mean += e.area_vox * center(e);
      area += e.area_vox;
    }
    mean /= area;
    std::uint32_t nearest = order[first].index;
    for (std::size_t i = first; i < end; ++i) {
      if ((center(exposed[order[i].index]) - mean).squaredNorm() < (center(exposed[nearest]) - mean).squaredNorm())
        nearest = order[i].index;
    }
    ExpectedPoint& point = points.emplace_back();
    point.voxel = exposed[nearest].voxel;
    point.position_m = center(exposed[nearest]);
    point.normal = normal.normalized();
    point.area_cm2 = area * face_cm2;
  }
  return points;
}

/// Returns the area of the occupied voxels' faces towards empty ones.
double seen_area_cm2(const StateVolume& volume, std::span<const std::uint32_t> seen, const Executor& executor) {
  constexpr std::size_t kChunk{4096};
  const IndexBox inner = volume.box().grown(-1);
  const StateBox states = volume.state_box();
  const auto is_empty = [&](std::int64_t other) { return states.states[other] == StateBox::kEmpty; };
  std::vector<double> areas_vox(seen.size() / kChunk + 1);
  executor.parallel_for(seen.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!inner.contains(volume.voxel(seen[i]))) continue;
      ExposedVoxel e;
      if (expose_faces(states, seen[i], is_empty, e)) areas_vox[begin / kChunk] += static_cast<double>(e.area_vox);
    }
  });
  const double area_vox = std::accumulate(areas_vox.begin(), areas_vox.end(), 0.0);
  return area_vox * volume.voxel_size_m() * volume.voxel_size_m() * 1e4;
}

/// Points of one slab of layers.
struct Points {
  std::vector<ExpectedPoint> completed;
  std::vector<ExpectedPoint> beside;
};

Box bounds_m(const IndexBox& voxels, double voxel_m) {
  const auto corner_m = [&](const Index3& i) { return Eigen::Vector3d{i.x * voxel_m, i.y * voxel_m, i.z * voxel_m}; };
  return {corner_m(voxels.lo), corner_m(voxels.hi)};
}

/// Adds the exposed voxels of a row, except its ends. `marks` is working memory of equal length.
void add_exposed(const StateVolume& volume, const ExposureTask& task, std::size_t row, std::vector<std::uint8_t>& marks,
                 std::vector<ExposedVoxel>& exposed) {
  const std::ptrdiff_t to_y = volume.row();
  const std::ptrdiff_t to_z = volume.layer();
  const auto width = static_cast<std::size_t>(volume.row());
  const VoxelState* states = volume.data() + row;
  const VoxelRole* roles = task.roles + row;
  marks.assign(width, 0);
  unsigned any{0};
  for (std::size_t x = 1; x + 1 < width; ++x) {  // is_exposed, many voxels at a time
    const VoxelRole* at = roles + x;
    const unsigned beside = at[1].bits | at[-1].bits | at[to_y].bits | at[-to_y].bits | at[to_z].bits | at[-to_z].bits;
    const unsigned of_outside = at->reach() == VoxelRole::outside ? +VoxelRole::empty : +VoxelRole::closed;
    const unsigned wanted = at->reach() == VoxelRole::inside ? +VoxelRole::openings : of_outside;
    const unsigned mark = states[x] == VoxelState::unknown ? beside & wanted : 0U;
    marks[x] = static_cast<std::uint8_t>(mark);
    any |= mark;
  }
  if (any == 0) return;
  for (std::size_t x = 1; x + 1 < width; ++x) {
    ExposedVoxel e;
    if (marks[x] != 0 && expose(task, static_cast<std::int64_t>(row + x), e)) exposed.push_back(e);
  }
}

/// Returns the exposed voxels of some layers, by increasing index. Layers and rows at the border lack neighbours, so no
/// surface is expected there.
std::vector<ExposedVoxel> exposed_in_layers(const StateVolume& volume, const ExposureTask& task, std::int32_t begin,
                                            std::int32_t end) {
  std::vector<ExposedVoxel> exposed;
  std::vector<std::uint8_t> marks;
  const Index3 size = volume.box().size();
  for (std::int32_t z = std::max(begin, 1); z < std::min(end, size.z - 1); ++z) {
    for (std::int32_t y = 1; y + 1 < size.y; ++y) {
      add_exposed(volume, task, static_cast<std::size_t>(z * volume.layer() + y * volume.row()), marks, exposed);
    }
  }
  return exposed;
}

/// Returns those of some layers from all, which are in order.
std::vector<ExposedVoxel> those_in_layers(const StateVolume& volume, std::span<const ExposedVoxel> all,
                                          std::int32_t begin, std::int32_t end) {
  const auto before = [&](std::int32_t z) {
    const std::ptrdiff_t first = z * volume.layer();
    return std::partition_point(all.begin(), all.end(), [&](const ExposedVoxel& e) { return e.voxel < first; });
  };
  return {before(begin), before(end)};
}

/// Returns the share of its area for which surface beside an object counts, by squared distance; −1 beyond reach.
std::vector<float> beside_shares(const DistanceToObjects& distance, const ExpectedSurfaceConfig& config) {
  std::vector<float> shares;
  for (const float d : distance.metres()) {
    shares.push_back(d > static_cast<float>(config.reach_m)
                         ? -1.0F
                         : static_cast<float>(config.beside_share) * std::exp(-d / static_cast<float>(config.decay_m)));
  }
  return shares;
}

/// Finds the highest support below each point.
void find_supports_below(const StateVolume& volume, std::span<const std::vector<std::int32_t>> tops,
                         std::vector<ExpectedPoint>& points) {
  const auto layer = static_cast<std::size_t>(volume.layer());
  for (ExpectedPoint& point : points) {
    const std::size_t column = point.voxel % layer;
    const auto z = static_cast<std::int32_t>(point.voxel / layer);
    std::int32_t highest = kNoLayer;
    for (std::size_t i = 0; i < tops.size(); ++i) {
      const std::int32_t top = tops[i][column];
      if (top == kNoLayer || top > z + 1 || top <= highest) continue;
      highest = top;
      point.support = static_cast<std::int32_t>(i);
    }
  }
}

/// Reads the volume on a device where that works, else on the CPU.
Result<StateVolume> read_volume(const TsdfSnapshot& map, const IndexBox& box, const Executor& executor,
                                ViewDevice* device) {
  if (device != nullptr && device->follow(map, executor).ok()) {
    if (Result<StateVolume> volume = StateVolume::read(map, box, *device); volume.ok()) return volume;
  }
  return StateVolume::read(map, box, executor);
}

/// States of a volume, and the supports in it.
struct SupportedVolume {
  StateVolume volume;
  std::vector<Support> supports;
};

/// Reads the workspace and finds its supports. Where there are none, they are looked for just below it, too: what
/// stands on a table whose top is the workspace's floor would be taken for something that floats.
Result<SupportedVolume> read_with_supports(const TsdfSnapshot& map, const IndexBox& box, double min_support_m2,
                                           const Executor& executor, ViewDevice* device) {
  constexpr std::int32_t kLayersBelow{3};
  SACCADE_TRY(StateVolume volume, read_volume(map, box, executor, device));
  std::vector<Support> supports = find_supports(map, volume, min_support_m2, executor);
  if (!supports.empty() || !map.config.workspace || volume.size() == 0) {
    return SupportedVolume{std::move(volume), std::move(supports)};
  }
  IndexBox deeper = box;
  deeper.lo.z -= kLayersBelow;
  SACCADE_TRY(StateVolume with_floor, read_volume(map, deeper, executor, device));
  supports = find_supports(map, with_floor, min_support_m2, executor);
  return SupportedVolume{supports.empty() ? std::move(volume) : std::move(with_floor), std::move(supports)};
}

bool is_behind(std::span<const Wall> walls, const Eigen::Vector3d& p_m) {
  return std::any_of(walls.begin(), walls.end(),
                     [&](const Wall& wall) { return wall.in_front_m(p_m.head<2>()) < 0.0 && wall.faces(p_m); });
}

}  // namespace

Status ExpectedSurfaceConfig::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "expected surface"}; };
  const auto positive = [](double x) { return std::isfinite(x) && x > 0.0; };
  if (!positive(min_support_m2) || !positive(min_wall_m2))
    return fail("the areas of a support and of a wall must be positive");
  if (!positive(reach_m) || !positive(decay_m)) return fail("the reach around objects and its decay must be positive");
  const auto share = [](double x) { return x >= 0.0 && x <= 1.0; };
  if (!share(beside_share) || !share(completed_share))
    return fail("the share of unknown space that is surface lies within 0 and 1");
  if (!positive(spacing_m)) return fail("the distance between points must be positive");
  if (!(behind_opening >= 1.0 && std::isfinite(behind_opening)))
    return fail("the surface behind an opening must be finite and at least its area");
  if (!(through_m >= 0.0 && std::isfinite(through_m)))
    return fail("the unknown length of lines of sight must not be negative");
  return {};
}

bool ExpectedSurface::faces(const ExpectedPoint& point, const Eigen::Vector3d& camera_m) const {
  const Eigen::Vector3f towards = camera_m.cast<float>() - point.position_m;
  if (point.normal.dot(towards) < kLeastCosine * towards.norm()) return false;
  const Support* below = point.support < 0 ? nullptr : &supports[static_cast<std::size_t>(point.support)];
  return below == nullptr || camera_m.z() > below->height_at(camera_m.head<2>());
}

bool ExpectedSurface::is_visible(const ExpectedPoint& point, const Eigen::Vector3d& camera_m) const {
  return faces(point, camera_m) && volume->is_visible(point.voxel, camera_m, config.through_m);
}

std::int32_t ExpectedSurface::object_near(const Eigen::Vector3d& p_m, double within_m) const {
  std::int32_t nearest{-1};
  double least_m{within_m};
  double least_to_middle_m{std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const Box& box = objects[i];
    const double m = (p_m - p_m.cwiseMax(box.min).cwiseMin(box.max)).norm();
    const double to_middle_m = (p_m - 0.5 * (box.min + box.max)).norm();
    if (m > least_m || (m == least_m && to_middle_m >= least_to_middle_m)) continue;
    nearest = static_cast<std::int32_t>(i);
    least_m = m;
    least_to_middle_m = to_middle_m;
  }
  return nearest;
}

Result<ExpectedSurface> expected_surface(const TsdfSnapshot& map, const ExpectedSurfaceConfig& config,
                                         const Executor& executor, ViewDevice* device) {
  SACCADE_CHECK(config.validate());
  const double voxel_m = map.config.voxel_size_m;
  const IndexBox box =
      map.config.workspace ? voxels_with_center_in(*map.config.workspace, voxel_m) : map.grid.known_bounds();
  SACCADE_TRY(SupportedVolume read, read_with_supports(map, box, config.min_support_m2, executor, device));
  ExpectedSurface result;
  result.config = config;
  result.volume = std::make_shared<const StateVolume>(std::move(read.volume));
  const StateVolume& volume = *result.volume;
  if (volume.size() == 0) return result;
  result.supports = std::move(read.supports);
  std::vector<std::vector<std::int32_t>> tops;
  for (const Support& support : result.supports) tops.push_back(top_layers(volume, support));
  result.walls = find_walls(volume, config.min_wall_m2, executor);
  const CompletedObjects objects = complete_objects(volume, {tops, result.walls}, executor);
  result.seen_cm2 = seen_area_cm2(volume, objects.seen, executor);
  if (objects.objects.empty()) return result;
  for (const CompletedObject& object : objects.objects) result.objects.push_back(bounds_m(object.seen, voxel_m));
  const DistanceToObjects distance{volume, objects.seen, config.reach_m, executor};
  const std::vector<float> shares = beside_shares(distance, config);
  const ExposureTask task{volume.state_box(),
                          objects.roles.data(),
                          distance.squared().data(),
                          static_cast<std::int64_t>(distance.row()),
                          static_cast<std::int64_t>(distance.layer()),
                          shares.data(),
                          static_cast<float>(config.completed_share),
                          static_cast<float>(config.behind_opening)};
  std::optional<std::vector<ExposedVoxel>> all;
  if (volume.ticket() != 0) {
    if (auto exposed = device->exposed(volume.ticket(), task); exposed.ok()) all = std::move(exposed).value();
  }
  const std::int32_t block = std::max(1, static_cast<std::int32_t>(std::lround(config.spacing_m / voxel_m)));
  std::vector<Points> slabs(static_cast<std::size_t>((volume.box().size().z - 1) / block + 1));
  executor.parallel_for(slabs.size(), 1, [&](std::size_t slab, std::size_t) {
    const std::int32_t first = static_cast<std::int32_t>(slab) * block;
    std::vector<ExposedVoxel> exposed = all ? those_in_layers(volume, *all, first, first + block)
                                            : exposed_in_layers(volume, task, first, first + block);
    std::erase_if(exposed, [&](const ExposedVoxel& e) {
      const Index3 voxel = volume.voxel(e.voxel);
      return voxel.z < box.lo.z || is_behind(result.walls, voxel_center(voxel, voxel_m));
    });
    const auto beside =
        std::stable_partition(exposed.begin(), exposed.end(), [](const ExposedVoxel& e) { return e.completed != 0; });
    slabs[slab] = {merged(volume, {exposed.begin(), beside}, block), merged(volume, {beside, exposed.end()}, block)};
  });
  for (const Points& slab : slabs)
    result.points.insert(result.points.end(), slab.completed.begin(), slab.completed.end());
  result.completed = result.points.size();
  for (const Points& slab : slabs) result.points.insert(result.points.end(), slab.beside.begin(), slab.beside.end());
  find_supports_below(volume, tops, result.points);
  executor.parallel_for(result.points.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      result.points[i].object = result.object_near(result.points[i].position_m.cast<double>(), config.reach_m);
  });
  return result;
}

Result<std::shared_ptr<const ExpectedSurface>> expected_surface(const PlanningContext& context,
                                                                const ExpectedSurfaceConfig& config) {
  if (context.expected != nullptr && *context.expected && (*context.expected)->config == config)
    return *context.expected;
  SACCADE_TRY(ExpectedSurface made, expected_surface(context.map, config, context.executor, context.device));
  auto surface = std::make_shared<const ExpectedSurface>(std::move(made));
  if (context.expected != nullptr) *context.expected = surface;
  return surface;
}

}  // namespace saccade
