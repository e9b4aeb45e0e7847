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
#include "saccade/views/internal/find_supports.hpp"
#include "saccade/views/internal/find_walls.hpp"
#include "saccade/views/internal/state_volume.hpp"

namespace saccade {
namespace {

constexpr float kLeastCosine{0.17364818F};  // the cosine of 80°

/// Area of a voxel's exposed faces across its normal, which points to their open side.
struct Exposed {
  std::uint32_t voxel{0};
  Eigen::Vector3f normal;
  float area_vox{0.0F};  ///< faces
};

/// Returns the exposed part of an unknown voxel where is_free(neighbour's index) holds; `strides` as in a volume.
template <class IsFree>
std::optional<Exposed> exposed_at(const StateVolume& volume, std::size_t voxel, const IsFree& is_free) {
  const std::ptrdiff_t row = volume.row();
  const std::ptrdiff_t layer = volume.layer();
  const auto at = [&](std::ptrdiff_t offset) {
    return is_free(static_cast<std::size_t>(static_cast<std::ptrdiff_t>(voxel) + offset));
  };
  const std::array<std::ptrdiff_t, 3> stride{1, row, layer};
  Eigen::Vector3f faces{Eigen::Vector3f::Zero()};
  Eigen::Vector3f count{Eigen::Vector3f::Zero()};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    const bool above = at(stride[axis]);
    const bool below = at(-stride[axis]);
    count[i] = static_cast<float>(above) + static_cast<float>(below);
    faces[i] = static_cast<float>(above) - static_cast<float>(below);
  }
  if (count.sum() == 0.0F) return std::nullopt;
  Eigen::Vector3f normal{Eigen::Vector3f::Zero()};
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) {
        if (at(z * layer + y * row + x))
          normal += Eigen::Vector3f(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
      }
    }
  }
  if (normal.squaredNorm() < 1e-6F) normal = faces;
  if (normal.squaredNorm() < 1e-6F) return std::nullopt;  // a sheet between empty voxels has no direction
  normal.normalize();
  return Exposed{static_cast<std::uint32_t>(voxel), normal, std::max(faces.cwiseAbs().dot(normal.cwiseAbs()), 0.5F)};
}

/// Merges exposed voxels that lie in one block with an edge of `block` voxels and face the same octant.
std::vector<ExpectedPoint> merged(const StateVolume& volume, std::span<const Exposed> exposed, std::int32_t block) {
  struct Keyed {
    std::uint64_t key;
    std::uint32_t index;
  };
  std::vector<Keyed> order(exposed.size());
  const Index3 blocks = parents(volume.box()).size() * kBrickEdge;  // exceeds the number along each axis
  for (std::size_t i = 0; i < exposed.size(); ++i) {
    const Index3 at = volume.voxel(exposed[i].voxel) - volume.box().lo;
    const auto& n = exposed[i].normal;
    const unsigned octant = (n.x() < 0.0F ? 1U : 0U) | (n.y() < 0.0F ? 2U : 0U) | (n.z() < 0.0F ? 4U : 0U);
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
    const auto center = [&](const Exposed& e) -> Eigen::Vector3f {
      return voxel_center(volume.voxel(e.voxel), volume.voxel_size_m()).cast<float>();
    };
    for (end = first; end < order.size() && order[end].key == order[first].key; ++end) {
      const Exposed& e = exposed[order[end].index];
      normal += e.area_vox * e.normal;
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
  std::vector<double> areas_vox(seen.size() / kChunk + 1);
  executor.parallel_for(seen.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!inner.contains(volume.voxel(seen[i]))) continue;
      const auto e = exposed_at(volume, seen[i], [&](std::size_t other) { return volume[other] == VoxelState::empty; });
      if (e) areas_vox[begin / kChunk] += static_cast<double>(e->area_vox);
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

/// Calls add(index, x) for the exposed unknown voxels of a row, except its ends: those in an object beside anything
/// open, those outside beside empty voxels. `marks` is working memory of equal length.
template <class Add>
void for_exposed(const StateVolume& volume, const VoxelRole* all_roles, std::size_t row,
                 std::vector<std::uint8_t>& marks, const Add& add) {
  const std::ptrdiff_t to_y = volume.row();
  const std::ptrdiff_t to_z = volume.layer();
  const auto width = static_cast<std::size_t>(volume.row());
  const VoxelState* states = volume.data() + row;
  const VoxelRole* roles = all_roles + row;
  marks.assign(width, 0);
  unsigned any{0};
  for (std::size_t x = 1; x + 1 < width; ++x) {
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
    if (marks[x] != 0) add(row + x, static_cast<std::int32_t>(x));
  }
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

/// Tells whether an empty voxel lies in a cavity: in each direction along x and y within its object's hull, the empty
/// space ends, and on at least two sides at seen surface.
bool is_in_cavity(const StateVolume& volume, const VoxelRole* roles, std::size_t voxel) {
  int seen{0};
  for (const std::ptrdiff_t step : {std::ptrdiff_t{1}, std::ptrdiff_t{-1}, volume.row(), -volume.row()}) {
    std::size_t at = voxel;
    while (at < volume.size() && roles[at].is_empty_inside()) at += static_cast<std::size_t>(step);
    if (at >= volume.size() || volume[at] == VoxelState::empty) return false;
    seen += volume[at] == VoxelState::occupied ? 1 : 0;
  }
  return seen >= 2;
}

/// Tells whether an unknown voxel closes a cavity towards known empty space.
bool closes_cavity(const StateVolume& volume, const VoxelRole* roles, std::size_t voxel) {
  const std::array<std::ptrdiff_t, 6> steps{volume.layer(), 1, -1, volume.row(), -volume.row(), -volume.layer()};
  const auto open = std::find_if(steps.begin(), steps.end(), [&](std::ptrdiff_t step) {
    return roles[voxel + static_cast<std::size_t>(step)].is_empty_inside();
  });
  return open != steps.end() && is_in_cavity(volume, roles, voxel + static_cast<std::size_t>(*open));
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
                                         const Executor& executor) {
  SACCADE_CHECK(config.validate());
  const double voxel_m = map.config.voxel_size_m;
  const IndexBox box =
      map.config.workspace ? voxels_with_center_in(*map.config.workspace, voxel_m) : map.grid.known_bounds();
  SACCADE_TRY(StateVolume read, StateVolume::read(map, box, executor));
  ExpectedSurface result;
  result.config = config;
  result.volume = std::make_shared<const StateVolume>(std::move(read));
  const StateVolume& volume = *result.volume;
  if (volume.size() == 0) return result;
  result.supports = find_supports(map, volume, config.min_support_m2, executor);
  std::vector<std::vector<std::int32_t>> tops;
  for (const Support& support : result.supports) tops.push_back(top_layers(volume, support));
  result.walls = find_walls(volume, config.min_wall_m2, executor);
  const CompletedObjects objects = complete_objects(volume, {tops, result.walls}, executor);
  result.seen_cm2 = seen_area_cm2(volume, objects.seen, executor);
  if (objects.objects.empty()) return result;
  for (const CompletedObject& object : objects.objects) result.objects.push_back(bounds_m(object.seen, voxel_m));
  const DistanceToObjects distance{volume, objects.seen, config.reach_m, executor};
  const VoxelRole* roles = objects.roles.data();

  // Layers and rows at the border lack neighbours, so no surface is expected there.
  const Index3 size = box.size();
  const std::int32_t block = std::max(1, static_cast<std::int32_t>(std::lround(config.spacing_m / voxel_m)));
  std::vector<Points> slabs(static_cast<std::size_t>((size.z - 1) / block + 1));
  executor.parallel_for(slabs.size(), 1, [&](std::size_t slab, std::size_t) {
    std::vector<Exposed> completed;
    std::vector<Exposed> beside;
    std::vector<std::uint8_t> marks;
    const std::int32_t first = static_cast<std::int32_t>(slab) * block;
    for (std::int32_t z = std::max(first, 1); z < std::min(first + block, size.z - 1); ++z) {
      for (std::int32_t y = 1; y + 1 < size.y; ++y) {
        const auto row = static_cast<std::size_t>(z * volume.layer() + y * volume.row());
        for_exposed(volume, roles, row, marks, [&](std::size_t i, std::int32_t x) {
          if (is_behind(result.walls, voxel_center(volume.voxel(i), voxel_m))) return;
          if (roles[i].reach() == VoxelRole::inside) {
            auto e =
                exposed_at(volume, i, [&](std::size_t other) { return roles[other].opening() != VoxelRole::closed; });
            if (!e) return;
            e->area_vox *= static_cast<float>(config.completed_share);
            if (closes_cavity(volume, roles, i)) e->area_vox *= static_cast<float>(config.behind_opening);
            completed.push_back(*e);
            return;
          }
          const float d = distance.at_m(x, y, z);
          if (d > static_cast<float>(config.reach_m)) return;
          auto e = exposed_at(volume, i, [&](std::size_t other) { return roles[other].opening() == VoxelRole::empty; });
          if (!e) return;
          e->area_vox *= static_cast<float>(config.beside_share) * std::exp(-d / static_cast<float>(config.decay_m));
          beside.push_back(*e);
        });
      }
    }
    slabs[slab] = {merged(volume, completed, block), merged(volume, beside, block)};
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
  SACCADE_TRY(ExpectedSurface made, expected_surface(context.map, config, context.executor));
  auto surface = std::make_shared<const ExpectedSurface>(std::move(made));
  if (context.expected != nullptr) *context.expected = surface;
  return surface;
}

}  // namespace saccade
