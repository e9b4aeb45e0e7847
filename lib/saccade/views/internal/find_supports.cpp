// SPDX-License-Identifier: Apache-2.0
#include "saccade/views/internal/find_supports.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "saccade/core/convex_hull.hpp"

namespace saccade {
namespace {

constexpr std::int32_t kPatchEdge{8};     // voxels
constexpr std::size_t kLeastOfPatch{20};  // voxels
constexpr double kFlat_vox{0.6};          // root mean square distance to the plane of a patch
constexpr double kInlier_vox{1.0};        // voxels within this distance of a plane belong to it
constexpr std::size_t kMaxSeeds{64};      // patches to try planes from
constexpr std::size_t kMaxRefined{4096};  // voxels for the final fit of a plane

/// Occupied voxel with an empty one above; columns and layers counted within the volume.
struct Top {
  std::int32_t x{0};
  std::int32_t y{0};
  std::int32_t layer{0};
  [[nodiscard]] double height_vox() const { return layer + 1.0; }
};

/// Plane: height in voxels is offset + slope · (x, y), at the columns' centres.
struct Plane {
  double offset{0.0};
  Eigen::Vector2d slope{Eigen::Vector2d::Zero()};
  [[nodiscard]] double at(double x, double y) const { return offset + slope.x() * x + slope.y() * y; }
};

/// Least squares fit. The plane is level in directions that the points leave open.
class PlaneFit {
 public:
  void add(double x, double y, double height, double weight = 1.0) {
    const Eigen::Vector3d p{x, y, height};
    weight_ += weight;
    sum_ += weight * p;
    squares_ += weight * p * p.transpose();
  }
  [[nodiscard]] double weight() const { return weight_; }
  [[nodiscard]] Plane plane() const {
    const Eigen::Vector3d mean = sum_ / weight_;
    const Eigen::Matrix3d spread = squares_ - weight_ * mean * mean.transpose();
    const Eigen::Matrix2d ridge = 0.01 * weight_ * Eigen::Matrix2d::Identity();
    Plane plane;
    plane.slope = (spread.topLeftCorner<2, 2>() + ridge).ldlt().solve(spread.topRightCorner<2, 1>());
    plane.offset = mean.z() - plane.slope.dot(mean.head<2>());
    return plane;
  }
  [[nodiscard]] Eigen::Vector3d mean() const { return sum_ / weight_; }
  /// Returns the mean square distance along z to plane().
  [[nodiscard]] double residual() const {
    const Eigen::Vector3d mean = sum_ / weight_;
    const Eigen::Matrix3d spread = (squares_ - weight_ * mean * mean.transpose()) / weight_;
    const Eigen::Vector3d across{-plane().slope.x(), -plane().slope.y(), 1.0};
    return across.dot(spread * across);
  }

 private:
  double weight_{0.0};
  Eigen::Vector3d sum_{Eigen::Vector3d::Zero()};
  Eigen::Matrix3d squares_{Eigen::Matrix3d::Zero()};
};

/// Small flat part of a surface.
struct Patch {
  Eigen::Vector3d mean;  ///< x, y and height in voxels
  Plane plane;
  double weight{0.0};
};

/// Returns the tops layer by layer, row by row.
std::vector<Top> tops_of(const StateVolume& volume, const Executor& executor) {
  const auto row = static_cast<std::size_t>(volume.row());
  const auto layer = static_cast<std::size_t>(volume.layer());
  const auto layers = static_cast<std::size_t>(volume.box().size().z);
  std::vector<std::vector<Top>> found(layers);
  executor.parallel_for(layers - 1, 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t z = begin; z < end; ++z) {
      for (std::size_t first = 0; first < layer; first += row) {
        const VoxelState* here = volume.data() + z * layer + first;
        if (!any_occupied(here, row)) continue;
        for (std::size_t x = 0; x < row; ++x) {
          if (here[x] != VoxelState::occupied || here[x + layer] != VoxelState::empty) continue;
          found[z].push_back(
              {static_cast<std::int32_t>(x), static_cast<std::int32_t>(first / row), static_cast<std::int32_t>(z)});
        }
      }
    }
  });
  std::vector<Top> tops;
  for (const std::vector<Top>& some : found) tops.insert(tops.end(), some.begin(), some.end());
  return tops;
}

/// Returns groups of tops in one tile of columns, without a gap in height, that lie on a plane.
std::vector<Patch> patches_of(std::span<const Top> tops, std::int32_t tiles_per_row) {
  std::vector<std::vector<const Top*>> tiles;
  for (const Top& top : tops) {
    const auto tile = static_cast<std::size_t>(top.y / kPatchEdge * tiles_per_row + top.x / kPatchEdge);
    if (tile >= tiles.size()) tiles.resize(tile + 1);
    tiles[tile].push_back(&top);
  }
  std::vector<Patch> patches;
  for (const std::vector<const Top*>& tile : tiles) {
    for (std::size_t first = 0, end = 0; first < tile.size(); first = end) {
      PlaneFit fit;
      for (end = first; end < tile.size() && (end == first || tile[end]->layer <= tile[end - 1]->layer + 1); ++end) {
        fit.add(tile[end]->x, tile[end]->y, tile[end]->height_vox());
      }
      if (end - first < kLeastOfPatch) continue;
      const Plane plane = fit.plane();
      if (plane.slope.norm() > kMaxSlope || fit.residual() > kFlat_vox * kFlat_vox) continue;
      patches.push_back({fit.mean(), plane, fit.weight()});
    }
  }
  return patches;
}

/// Returns the plane supported by most patches, nullopt without patches.
std::optional<Plane> best_plane(std::span<const Patch> patches) {
  std::optional<Plane> best;
  double most{0.0};
  const std::size_t stride = patches.size() / kMaxSeeds + 1;
  for (std::size_t seed = 0; seed < patches.size(); seed += stride) {
    Plane plane = patches[seed].plane;
    double weight{0.0};
    for (int round = 0; round < 4; ++round) {
      // The slope of one patch is accurate to about a degree.
      const double per_vox = round == 0 ? 0.02 : 0.0;
      PlaneFit fit;
      for (const Patch& patch : patches) {
        const double far_vox = (patch.mean - patches[seed].mean).head<2>().norm();
        if (std::abs(patch.mean.z() - plane.at(patch.mean.x(), patch.mean.y())) > kInlier_vox + per_vox * far_vox)
          continue;
        fit.add(patch.mean.x(), patch.mean.y(), patch.mean.z(), patch.weight);
      }
      weight = fit.weight();
      if (weight == 0.0) break;
      plane = fit.plane();
    }
    if (weight <= most || plane.slope.norm() > kMaxSlope) continue;
    most = weight;
    best = plane;
  }
  return best;
}

bool is_inlier(const Plane& plane, const Top& top) {
  return std::abs(top.height_vox() - plane.at(top.x, top.y)) <= kInlier_vox;
}

/// Returns the height in voxels at which the signed distance is zero.
double zero_crossing_vox(const TsdfSnapshot& map, const StateVolume& volume, const Top& top) {
  const Index3 below = volume.box().lo + Index3{top.x, top.y, top.layer};
  const int inside = map.grid.voxel(below).v;
  const int outside = map.grid.voxel(below + Index3{0, 0, 1}).v;
  if (outside >= kTsdfOne || outside <= inside) return top.height_vox();
  return top.layer + 0.5 - static_cast<double>(inside) / (outside - inside);
}

Plane refined(const TsdfSnapshot& map, const StateVolume& volume, std::span<const Top> tops) {
  PlaneFit fit;
  const std::size_t stride = tops.size() / kMaxRefined + 1;
  for (std::size_t i = 0; i < tops.size(); i += stride)
    fit.add(tops[i].x, tops[i].y, zero_crossing_vox(map, volume, tops[i]));
  return fit.plane();
}

Support support_of(const StateVolume& volume, const Plane& plane, std::span<const Top> tops) {
  Support support;
  const double voxel_m = volume.voxel_size_m();
  const Index3 low = volume.box().lo;
  Eigen::Vector2d middle_vox{Eigen::Vector2d::Zero()};
  std::vector<std::uint32_t> seen;
  for (const Top& top : tops) {
    middle_vox += Eigen::Vector2d(top.x, top.y) / static_cast<double>(tops.size());
    seen.push_back(static_cast<std::uint32_t>(top.y * volume.row() + top.x));
  }
  std::sort(seen.begin(), seen.end());
  seen.erase(std::unique(seen.begin(), seen.end()), seen.end());
  support.middle_m = (middle_vox + Eigen::Vector2d(low.x + 0.5, low.y + 0.5)) * voxel_m;
  support.slope = plane.slope;
  const double height_vox = plane.at(middle_vox.x(), middle_vox.y());
  support.height_m = (low.z + height_vox) * voxel_m;
  support.top = low.z + static_cast<std::int32_t>(std::lround(height_vox));
  support.area_m2 = static_cast<double>(seen.size()) * voxel_m * voxel_m;
  support.columns.assign(static_cast<std::size_t>(volume.layer()), 0);
  for (const std::uint32_t column : hull_columns(seen, static_cast<std::int32_t>(volume.row())))
    support.columns[column] = 1;
  return support;
}

/// Removes known holes from a support's columns. Returns their number.
std::size_t leave_out_holes(const StateVolume& volume, Support& support) {
  const std::vector<std::int32_t> tops = top_layers(volume, support);
  std::size_t holes{0};
  for (std::size_t column = 0; column < tops.size(); ++column) {
    if (support.columns[column] == 0) continue;
    const auto is_empty = [&](std::int32_t z) {
      return z >= 0 && z < volume.box().size().z &&
             volume[static_cast<std::size_t>(z * volume.layer()) + column] == VoxelState::empty;
    };
    if (!is_empty(tops[column] - 1) || !is_empty(tops[column] - 2)) continue;
    support.columns[column] = 0;
    ++holes;
  }
  return holes;
}

}  // namespace

std::vector<std::uint32_t> hull_columns(std::span<const std::uint32_t> seen, std::int32_t width) {
  const auto columns_per_row = static_cast<std::uint32_t>(width);
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const std::uint32_t row = seen[i] / columns_per_row;
    const bool within_row =
        i > 0 && i + 1 < seen.size() && seen[i - 1] / columns_per_row == row && seen[i + 1] / columns_per_row == row;
    if (!within_row) points.emplace_back(static_cast<double>(seen[i] % columns_per_row), static_cast<double>(row));
  }
  const std::vector<Eigen::Vector2d> hull = convex_hull(std::move(points));
  if (hull.size() < 3) return {seen.begin(), seen.end()};
  std::vector<std::uint32_t> columns;
  const auto [low, high] =
      std::minmax_element(hull.begin(), hull.end(), [](const auto& a, const auto& b) { return a.y() < b.y(); });
  for (double y = low->y(); y <= high->y(); y += 1.0) {
    double begin = width;
    double end = -1.0;
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const Eigen::Vector2d& a = hull[i];
      const Eigen::Vector2d& b = hull[(i + 1) % hull.size()];
      if (std::min(a.y(), b.y()) > y || std::max(a.y(), b.y()) < y) continue;
      const bool level = a.y() == b.y();  // then b also starts the next edge
      const double x = level ? a.x() : a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      begin = std::min(begin, x);
      end = std::max(end, x);
    }
    constexpr double kCornerSlack{1e-9};  // keeps corners in their own row
    const auto first = static_cast<std::uint32_t>(y) * columns_per_row;
    for (double x = std::ceil(begin - kCornerSlack); x <= end + kCornerSlack; x += 1.0) {
      columns.push_back(first + static_cast<std::uint32_t>(x));
    }
  }
  return columns;
}

std::vector<std::int32_t> top_layers(const StateVolume& volume, const Support& support) {
  std::vector<std::int32_t> tops(support.columns.size(), kNoLayer);
  const Index3 low = volume.box().lo;
  const double voxel_m = volume.voxel_size_m();
  for (std::size_t column = 0; column < tops.size(); ++column) {
    if (support.columns[column] == 0) continue;
    const std::size_t row = column / static_cast<std::size_t>(volume.row());
    const double x = low.x + static_cast<double>(column % static_cast<std::size_t>(volume.row())) + 0.5;
    const double y = low.y + static_cast<double>(row) + 0.5;
    const double height_m = support.height_at(Eigen::Vector2d{x, y} * voxel_m);
    tops[column] = static_cast<std::int32_t>(std::lround(height_m / voxel_m)) - low.z;
  }
  return tops;
}

std::vector<Support> find_supports(const TsdfSnapshot& map, const StateVolume& volume, double min_area_m2,
                                   const Executor& executor) {
  std::vector<Support> supports;
  std::vector<Top> tops = tops_of(volume, executor);
  std::vector<Patch> patches = patches_of(tops, static_cast<std::int32_t>(volume.row()) / kPatchEdge + 1);
  const double voxel_m = volume.voxel_size_m();
  const auto least = static_cast<std::size_t>(std::ceil(min_area_m2 / (voxel_m * voxel_m)));
  while (const std::optional<Plane> rough = best_plane(patches)) {
    const auto inliers = [&](const Plane& plane) {
      std::vector<Top> of_plane;
      std::copy_if(tops.begin(), tops.end(), std::back_inserter(of_plane),
                   [&](const Top& top) { return is_inlier(plane, top); });
      return of_plane;
    };
    std::vector<Top> of_plane = inliers(*rough);
    if (of_plane.size() < least) break;
    const Plane plane = refined(map, volume, of_plane);
    of_plane = inliers(plane);
    std::erase_if(tops, [&](const Top& top) { return is_inlier(plane, top); });
    const auto is_used = [&](const Patch& patch) {
      const auto off = [&](const Plane& of) {
        return std::abs(patch.mean.z() - of.at(patch.mean.x(), patch.mean.y()));
      };
      return off(plane) <= 1.5 * kInlier_vox || off(*rough) <= kInlier_vox;
    };
    std::erase_if(patches, is_used);
    if (of_plane.size() < least || plane.slope.norm() > kMaxSlope) continue;
    Support support = support_of(volume, plane, of_plane);
    if (leave_out_holes(volume, support) <= of_plane.size()) supports.push_back(std::move(support));
  }
  std::stable_sort(supports.begin(), supports.end(),
                   [](const Support& a, const Support& b) { return a.area_m2 > b.area_m2; });
  return supports;
}

}  // namespace saccade
