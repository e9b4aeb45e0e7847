// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/completed_objects.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace saccade {
namespace {

constexpr std::int32_t kAboveSupport{2};   // voxels; anything lower is noise of the support
constexpr std::int32_t kBelowSupport{8};   // voxels behind the support's surface that fusion marks as occupied
constexpr double kTouchesWall{6.0};        // voxels in front of a wall: nearer objects reach to it
constexpr std::size_t kLeastVoxels{12};    // objects with fewer voxels are noise
constexpr std::int32_t kMaxShift{6};       // half voxels from the middle of a footprint to the axis of a half turn
constexpr std::size_t kMaxTurned{400};     // sample of voxels for testing half turns
constexpr double kMaxContradicted{0.05};   // share of them that a half turn may map to known empty space
constexpr std::int32_t kBaseThickness{2};  // voxels

/// Layers of a support's surface, by column.
using TopLayers = std::vector<std::int32_t>;

bool is_of_wall(std::span<const Wall> walls, const StateVolume& volume, std::size_t voxel) {
  if (walls.empty()) return false;
  const double voxel_m = volume.voxel_size_m();
  const Eigen::Vector3d p = voxel_center(volume.voxel(voxel), voxel_m);
  return std::any_of(walls.begin(), walls.end(), [&](const Wall& wall) {
    const double m = wall.in_front_m(p.head<2>());
    return m <= kAboveSupport * voxel_m && m >= -kBelowSupport * voxel_m && wall.faces(p);
  });
}

/// Returns the occupied voxels that belong to no support or wall, in their order.
std::vector<std::uint32_t> voxels_of_objects(const StateVolume& volume, const Surroundings& surroundings,
                                             const Executor& executor) {
  const std::span<const TopLayers> tops = surroundings.tops;
  const auto layer = static_cast<std::size_t>(volume.layer());
  const auto row = static_cast<std::size_t>(volume.row());
  std::vector<std::vector<std::uint32_t>> found(static_cast<std::size_t>(volume.box().size().z));
  executor.parallel_for(found.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t z = begin; z < end; ++z) {
      for (std::size_t first = 0; first < layer; first += row) {
        const VoxelState* states = volume.data() + z * layer + first;
        if (!any_occupied(states, row)) continue;
        for (std::size_t x = 0; x < row; ++x) {
          if (states[x] != VoxelState::occupied) continue;
          const bool of_support = std::any_of(tops.begin(), tops.end(), [&](const TopLayers& top) {
            const std::int32_t t = top[first + x];
            const auto at = static_cast<std::int32_t>(z);
            return t != kNoLayer && at < t + kAboveSupport && at >= t - kBelowSupport;
          });
          const std::size_t i = z * layer + first + x;
          if (!of_support && !is_of_wall(surroundings.walls, volume, i))
            found[z].push_back(static_cast<std::uint32_t>(i));
        }
      }
    }
  });
  std::vector<std::uint32_t> voxels;
  for (const std::vector<std::uint32_t>& some : found) voxels.insert(voxels.end(), some.begin(), some.end());
  return voxels;
}

/// Cells of 2³ voxels.
struct Cells {
  Index3 size;
  explicit Cells(const StateVolume& volume) : size{volume.box().size() + Index3{1, 1, 1}} {
    size = {size.x / 2, size.y / 2, size.z / 2};
  }
  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z);
  }
  [[nodiscard]] std::size_t index(const Index3& cell) const {
    return (static_cast<std::size_t>(cell.z) * static_cast<std::size_t>(size.y) + static_cast<std::size_t>(cell.y)) *
               static_cast<std::size_t>(size.x) +
           static_cast<std::size_t>(cell.x);
  }
};
Index3 cell_of(const StateVolume& volume, std::uint32_t voxel) {
  const Index3 at = volume.voxel(voxel) - volume.box().lo;
  return {at.x / 2, at.y / 2, at.z / 2};
}

/// Returns the voxels of one object after the other, each in their order. Cells that touch belong to one object.
std::vector<std::vector<std::uint32_t>> connected(const StateVolume& volume, std::span<const std::uint32_t> seen) {
  constexpr std::uint16_t kFree{0xFFFFU};
  constexpr std::uint16_t kWaiting{0xFFFEU};
  const Cells cells{volume};
  const IndexBox all{{0, 0, 0}, cells.size};
  std::vector<std::uint16_t> part_of(cells.count(), kFree);
  for (const std::uint32_t i : seen) part_of[cells.index(cell_of(volume, i))] = kWaiting;
  std::uint16_t parts{0};
  std::vector<Index3> open;
  for (const std::uint32_t seed : seen) {
    std::uint16_t& of_seed = part_of[cells.index(cell_of(volume, seed))];
    if (of_seed != kWaiting || parts == kWaiting) continue;
    of_seed = parts;
    open.assign(1, cell_of(volume, seed));
    while (!open.empty()) {
      const Index3 from = open.back();
      open.pop_back();
      IndexBox{from, from + Index3{1, 1, 1}}.grown(1).intersection(all).for_each([&](const Index3& to) {
        std::uint16_t& part = part_of[cells.index(to)];
        if (part != kWaiting) return;
        part = parts;
        open.push_back(to);
      });
    }
    ++parts;
  }
  std::vector<std::vector<std::uint32_t>> objects(parts);
  for (const std::uint32_t i : seen) {
    const std::uint16_t part = part_of[cells.index(cell_of(volume, i))];
    if (part < parts) objects[part].push_back(i);
  }
  std::erase_if(objects, [](const std::vector<std::uint32_t>& object) { return object.size() < kLeastVoxels; });
  return objects;
}

/// Returns the support on which an object stands: the highest that is below most of its voxels; nullptr: none is.
const TopLayers* base_of(std::span<const TopLayers> tops, std::span<const std::uint32_t> voxels, std::size_t layer) {
  const TopLayers* base = nullptr;
  std::int64_t highest{0};
  for (const TopLayers& top : tops) {
    std::size_t above{0};
    std::int64_t sum{0};
    for (const std::uint32_t i : voxels) {
      const std::int32_t t = top[i % layer];
      if (t == kNoLayer || t > static_cast<std::int32_t>(i / layer)) continue;
      ++above;
      sum += t;
    }
    if (above == 0 || 2 * above < voxels.size()) continue;
    const std::int64_t mean = sum / static_cast<std::int64_t>(above);
    if (base != nullptr && mean <= highest) continue;
    base = &top;
    highest = mean;
  }
  return base;
}

/// Half turn about a vertical axis: maps (x, y) to (sum_x − x, sum_y − y).
struct HalfTurn {
  std::int32_t sum_x{0};
  std::int32_t sum_y{0};
  double contradicted{1.0};  ///< share of the seen voxels that it maps to known empty space
};

/// Returns whether a voxel (counted within the volume) and its neighbours along x and y are known to be empty.
bool is_well_empty(const StateVolume& volume, std::int32_t x, std::int32_t y, std::size_t z) {
  const Index3 size = volume.box().size();
  if (x < 1 || y < 1 || x + 1 >= size.x || y + 1 >= size.y) return false;
  const VoxelState* at = volume.data() + static_cast<std::ptrdiff_t>(z) * volume.layer() + y * volume.row() + x;
  return at[0] == VoxelState::empty && at[1] == VoxelState::empty && at[-1] == VoxelState::empty &&
         at[volume.row()] == VoxelState::empty && at[-volume.row()] == VoxelState::empty;
}

/// Returns the half turn, about an axis near the middle of a footprint, with the fewest contradictions.
HalfTurn best_half_turn(const StateVolume& volume, std::span<const std::uint32_t> voxels,
                        std::span<const std::uint32_t> footprint) {
  const auto row = static_cast<std::uint32_t>(volume.row());
  std::int64_t x{0};
  std::int64_t y{0};
  for (const std::uint32_t column : footprint) {
    x += column % row;
    y += column / row;
  }
  const auto count = static_cast<std::int64_t>(footprint.size());
  const HalfTurn middle{static_cast<std::int32_t>(2 * x / count), static_cast<std::int32_t>(2 * y / count), 1.0};
  const std::size_t stride = voxels.size() / kMaxTurned + 1;
  const Index3 size = volume.box().size();
  HalfTurn best = middle;
  double most = -1e9;
  const auto try_at = [&](std::int32_t sum_x, std::int32_t sum_y) {
    std::int64_t occupied{0};
    std::int64_t empty{0};
    std::int64_t all{0};
    for (std::size_t i = 0; i < voxels.size(); i += stride) {
      const Index3 from = volume.voxel(voxels[i]) - volume.box().lo;
      const Index3 to{sum_x - from.x, sum_y - from.y, from.z};
      ++all;
      if (!IndexBox{{0, 0, 0}, size}.contains(to)) continue;
      const VoxelState state = volume[volume.index(to + volume.box().lo)];
      if (state == VoxelState::occupied) ++occupied;
      if (state == VoxelState::empty && is_well_empty(volume, to.x, to.y, static_cast<std::size_t>(to.z))) ++empty;
    }
    const double off = std::hypot(sum_x - middle.sum_x, sum_y - middle.sum_y);
    const double score = static_cast<double>(occupied - 2 * empty) / static_cast<double>(all) - 0.01 * off;
    if (score <= most) return;
    most = score;
    best = {sum_x, sum_y, static_cast<double>(empty) / static_cast<double>(all)};
  };
  for (std::int32_t j = -kMaxShift; j <= kMaxShift; j += 2) {
    for (std::int32_t i = -kMaxShift; i <= kMaxShift; i += 2) try_at(middle.sum_x + i, middle.sum_y + j);
  }
  const HalfTurn coarse = best;
  for (std::int32_t j = -1; j <= 1; ++j) {
    for (std::int32_t i = -1; i <= 1; ++i) try_at(coarse.sum_x + i, coarse.sum_y + j);
  }
  return best;
}

/// Adds the columns on the surface of a wall behind those of an object that touches it.
void reach_to_wall(const StateVolume& volume, const Wall& wall, const Eigen::Vector3d& middle_m,
                   std::vector<std::uint32_t>& columns) {
  if (!wall.faces(middle_m)) return;
  const double voxel_m = volume.voxel_size_m();
  const Index3 low = volume.box().lo;
  const auto center_m = [&](std::uint32_t column) -> Eigen::Vector2d {
    return voxel_center(volume.voxel(column), voxel_m).head<2>();
  };
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const std::uint32_t column : columns) nearest_m = std::min(nearest_m, wall.in_front_m(center_m(column)));
  if (nearest_m < 0.0 || nearest_m > kTouchesWall * voxel_m) return;
  const std::size_t count = columns.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2d p = center_m(columns[i]);
    const Eigen::Vector2d on_wall = p - (wall.in_front_m(p) - 0.5 * voxel_m) * wall.normal;
    const Index3 voxel = voxel_at({on_wall.x(), on_wall.y(), middle_m.z()}, voxel_m);
    if (volume.box().contains(voxel))
      columns.push_back(static_cast<std::uint32_t>((voxel.y - low.y) * volume.row() + voxel.x - low.x));
  }
}

CompletedObject completed(const StateVolume& volume, const Surroundings& surroundings,
                          std::span<const std::uint32_t> voxels) {
  const std::span<const TopLayers> tops = surroundings.tops;
  CompletedObject object;
  const auto layer = static_cast<std::size_t>(volume.layer());
  std::vector<std::uint32_t> columns;
  for (const std::uint32_t i : voxels) {
    const Index3 at = volume.voxel(i);
    object.seen = object.seen.hull({at, at + Index3{1, 1, 1}});
    columns.push_back(static_cast<std::uint32_t>(i % layer));
  }
  const auto sort = [&] {
    std::sort(columns.begin(), columns.end());
    columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
  };
  sort();
  const Index3 size = object.seen.size();
  const Index3 middle = object.seen.lo + Index3{size.x / 2, size.y / 2, size.z / 2};
  for (const Wall& wall : surroundings.walls)
    reach_to_wall(volume, wall, voxel_center(middle, volume.voxel_size_m()), columns);
  sort();
  object.footprint = hull_columns(columns, static_cast<std::int32_t>(volume.row()));
  object.last = object.seen.hi.z - 1 - volume.box().lo.z;
  const std::int32_t lowest = object.seen.lo.z - volume.box().lo.z;
  const TopLayers* base = base_of(tops, voxels, layer);
  for (const std::uint32_t column : object.footprint) {
    // Where the hull extends beyond the support, the object ends at its lowest voxel.
    const bool stands = base != nullptr && (*base)[column] != kNoLayer;
    object.stands.push_back(stands ? 1 : 0);
    object.first.push_back(stands ? std::max((*base)[column], 0) : lowest);
  }
  const HalfTurn turn = best_half_turn(volume, voxels, object.footprint);
  object.symmetric = turn.contradicted <= kMaxContradicted;
  object.sum_x = turn.sum_x;
  object.sum_y = turn.sum_y;
  return object;
}

/// Writes the roles of an object's voxels in a layer.
void write_reach(const StateVolume& volume, const CompletedObject& object, std::int32_t z, VoxelRole* roles) {
  if (z > object.last) return;
  const auto row = static_cast<std::uint32_t>(volume.row());
  const VoxelState* states = volume.data() + static_cast<std::ptrdiff_t>(z) * volume.layer();
  for (std::size_t i = 0; i < object.footprint.size(); ++i) {
    const std::int32_t first = object.first[i];
    if (z < first - (object.stands[i] != 0 ? kBaseThickness : 0)) continue;
    const std::uint32_t column = object.footprint[i];
    std::uint8_t reach = z < first ? VoxelRole::below : VoxelRole::inside;
    if (reach == VoxelRole::inside && object.symmetric && states[column] == VoxelState::unknown &&
        is_well_empty(volume, object.sum_x - static_cast<std::int32_t>(column % row),
                      object.sum_y - static_cast<std::int32_t>(column / row), static_cast<std::size_t>(z)))
      reach = VoxelRole::carved;
    roles[column].bits = std::max(roles[column].bits, reach);
  }
}

/// Relaxes squared distances along a line of cells `stride` apart from those of its neighbours, for `width` adjacent
/// lines.
void spread(const std::uint16_t* from, std::uint16_t* to, std::size_t width, std::int32_t at, std::int32_t count,
            std::ptrdiff_t stride, std::int32_t reach) {
  std::copy_n(from + at * stride, width, to);
  for (std::int32_t other = std::max(0, at - reach); other <= std::min(count - 1, at + reach); ++other) {
    const auto squared = static_cast<std::uint16_t>((other - at) * (other - at));
    const std::uint16_t* line = from + other * stride;
    for (std::size_t x = 0; x < width; ++x) to[x] = std::min(to[x], static_cast<std::uint16_t>(line[x] + squared));
  }
}

}  // namespace

CompletedObjects complete_objects(const StateVolume& volume, const Surroundings& surroundings,
                                  const Executor& executor) {
  CompletedObjects result;
  const auto parts = connected(volume, voxels_of_objects(volume, surroundings, executor));
  result.objects.resize(parts.size());
  executor.parallel_for(parts.size(), 1, [&](std::size_t i, std::size_t) {
    result.objects[i] = completed(volume, surroundings, parts[i]);
  });
  for (const auto& part : parts) result.seen.insert(result.seen.end(), part.begin(), part.end());
  std::sort(result.seen.begin(), result.seen.end());
  result.roles.assign(volume.size(), {});
  const auto layer = static_cast<std::size_t>(volume.layer());
  executor.parallel_for(static_cast<std::size_t>(volume.box().size().z), 1, [&](std::size_t z, std::size_t) {
    VoxelRole* roles = result.roles.data() + z * layer;
    for (const CompletedObject& object : result.objects)
      write_reach(volume, object, static_cast<std::int32_t>(z), roles);
    const VoxelState* states = volume.data() + z * layer;
    for (std::size_t i = 0; i < layer; ++i) {
      const bool within = roles[i].bits == VoxelRole::inside || roles[i].bits == VoxelRole::below;
      const std::uint8_t of_unknown = within ? VoxelRole::closed : VoxelRole::unknown;
      const std::uint8_t of_known = states[i] == VoxelState::empty ? VoxelRole::empty : VoxelRole::closed;
      roles[i].bits |= states[i] == VoxelState::unknown ? of_unknown : of_known;
    }
  });
  return result;
}

DistanceToObjects::DistanceToObjects(const StateVolume& volume, std::span<const std::uint32_t> seen, double reach_m,
                                     const Executor& executor) {
  const Cells cells{volume};
  const double cell_m = 2.0 * volume.voxel_size_m();
  // Squares of longer distances would not fit.
  const std::int32_t reach = std::min(100, static_cast<std::int32_t>(std::ceil(reach_m / cell_m)));
  const auto far = static_cast<std::uint16_t>(reach * reach + 1);
  row_ = static_cast<std::size_t>(cells.size.x);
  layer_ = row_ * static_cast<std::size_t>(cells.size.y);
  for (int squared = 0; squared <= reach * reach; ++squared) {
    const double m = cell_m * std::sqrt(static_cast<double>(squared));
    metres_.push_back(m <= reach_m ? static_cast<float>(m) : std::numeric_limits<float>::infinity());
  }
  metres_.resize(metres_.size() + 3 * static_cast<std::size_t>(reach * reach) + 3,
                 std::numeric_limits<float>::infinity());
  squared_.assign(cells.count(), far);
  for (const std::uint32_t i : seen) squared_[cells.index(cell_of(volume, i))] = 0;
  std::vector<std::uint16_t> other(squared_.size());
  const auto layers = static_cast<std::size_t>(cells.size.z);
  executor.parallel_for(layers, 1, [&](std::size_t z, std::size_t) {
    std::uint16_t* in_layer = squared_.data() + z * layer_;
    for (std::size_t first = 0; first < layer_; first += row_) {
      std::uint16_t* line = in_layer + first;
      std::int32_t last = -reach - 1;
      for (std::int32_t x = 0; x < cells.size.x; ++x) {
        if (line[x] == 0) last = x;
        if (x - last <= reach) line[x] = static_cast<std::uint16_t>((x - last) * (x - last));
      }
      last = cells.size.x + reach;
      for (std::int32_t x = cells.size.x; x-- > 0;) {
        if (line[x] == 0) last = x;
        if (last - x <= reach) line[x] = std::min(line[x], static_cast<std::uint16_t>((last - x) * (last - x)));
      }
    }
    for (std::int32_t y = 0; y < cells.size.y; ++y) {
      spread(in_layer, other.data() + z * layer_ + static_cast<std::size_t>(y) * row_, row_, y, cells.size.y,
             static_cast<std::ptrdiff_t>(row_), reach);
    }
  });
  executor.parallel_for(layers, 1, [&](std::size_t z, std::size_t) {
    spread(other.data(), squared_.data() + z * layer_, layer_, static_cast<std::int32_t>(z), cells.size.z,
           static_cast<std::ptrdiff_t>(layer_), reach);
  });
}

}  // namespace saccade
