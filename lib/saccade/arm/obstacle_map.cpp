// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/obstacle_map.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

#include "saccade/arm/internal/obstacle_field.hpp"
#include "saccade/arm/internal/obstacle_kernels.hpp"
#include "saccade/core/clock.hpp"

namespace saccade {
namespace {

/// Slack above the rounding of double precision, in cells.
constexpr double kSlack_cells{1e-9};
/// Slack above the rounding of the stored distances, in half cells.
constexpr double kFieldSlack{1e-4};

Error invalid(const std::string& what) { return {Errc::invalid_argument, what, "obstacle map"}; }

double squared(double x) { return x * x; }

/// Returns the distance of a coordinate from [lo, lo + 1].
double gap(double at, double lo) { return std::max({lo - at, at - lo - 1.0, 0.0}); }

/// Returns the first and last existing cell from `lo` to `hi`.
std::pair<std::int32_t, std::int32_t> range_of_cells(double lo, double hi, std::int32_t size) {
  return {static_cast<std::int32_t>(std::clamp(std::floor(lo), 0.0, 1.0 * size)),
          static_cast<std::int32_t>(std::clamp(std::floor(hi), -1.0, size - 1.0))};
}

/// Tells whether one of the bits from first to last is set.
bool any_set(const std::uint64_t* row, std::int32_t first, std::int32_t last) {
  const std::uint64_t from_first = ~std::uint64_t{0} << (first % 64);
  const std::uint64_t to_last = ~std::uint64_t{0} >> (63 - last % 64);
  const std::int32_t end = last / 64;
  std::int32_t word = first / 64;
  if (word == end) return (row[word] & from_first & to_last) != 0;
  if ((row[word] & from_first) != 0) return true;
  while (++word < end) {
    if (row[word] != 0) return true;
  }
  return (row[end] & to_last) != 0;
}

/// Returns the spheres from one of them on.
obstacle::SphereArrays from(const SphereSpans& spheres, std::size_t first) {
  return {spheres.x_m.data() + first, spheres.y_m.data() + first, spheres.z_m.data() + first,
          spheres.radius_m.data() + first};
}

double squared_distance(const Box& box, const Eigen::Vector3d& p) {
  return (box.min - p).cwiseMax(p - box.max).cwiseMax(0.0).squaredNorm();
}

}  // namespace

Status ObstacleConfig::validate() const {
  if (!(cell_size_m > 0.0 && std::isfinite(cell_size_m))) return invalid("the cell size must be positive");
  if (!(max_distance_m > 0.0 && std::isfinite(max_distance_m))) return invalid("the maximum distance must be positive");
  for (std::size_t i = 0; i < fixtures.size(); ++i) {
    if (const Status valid = saccade::validate(Region{fixtures[i]}); !valid) {
      return invalid("fixture " + std::to_string(i + 1) + ": " + valid.error().message);
    }
  }
  return {};
}

Result<ObstacleMap> ObstacleMap::create(const TsdfSnapshot& map, const ObstacleConfig& config,
                                        const Executor& executor) {
  SACCADE_CHECK(config.validate());
  SACCADE_TRY(ObstacleCells cells, ObstacleCells::create(map.config, config.cell_size_m, config.unknown_is_obstacle));
  const double reach = std::ceil(config.max_distance_m / cells.cell_edge_m());
  if (!(reach <= ObstacleField::kMostReach_cells)) {
    return invalid("the maximum distance must be at most " + std::to_string(ObstacleField::kMostReach_cells) +
                   " cells; choose larger cells or a smaller distance");
  }
  cells.update(map.grid, executor);
  return ObstacleMap{map.config, config, std::move(cells), static_cast<int>(reach), executor};
}

ObstacleMap::ObstacleMap(const TsdfConfig& map, ObstacleConfig config, ObstacleCells cells, int reach_cells,
                         const Executor& executor)
    : config_{std::move(config)},
      voxel_size_m_{map.voxel_size_m},
      workspace_{map.workspace},
      cells_{std::move(cells)},
      field_{ObstacleField{*cells_, reach_cells, config_.fixtures, executor}},
      origin_{cells_->bounds_of(cells_->box().lo).min},
      half_cells_per_m_{2.0 / cells_->cell_edge_m()} {
  // A float's relative rounding is 6e-8; the kernel adds a little.
  const double largest = half_cells_per_m_ * (origin_.cwiseAbs().maxCoeff() +
                                              (cells_->bounds_of(cells_->box().hi).min - origin_).maxCoeff());
  batch_slack_ = static_cast<float>(1e-3 + 1e-6 * largest);
  for (const Box& box : config_.fixtures) {
    const Eigen::Vector3f lo = box.min.cast<float>();
    const Eigen::Vector3f hi = box.max.cast<float>();
    float_fixtures_.push_back({lo.x(), lo.y(), lo.z(), hi.x(), hi.y(), hi.z()});
  }
  field_->update(*cells_, executor);
}

Result<ObstacleUpdate> ObstacleMap::update(const TsdfSnapshot& map, const Executor& executor) {
  const Stopwatch stopwatch;
  const auto same_box = [](const Box& a, const Box& b) { return a.min == b.min && a.max == b.max; };
  if (map.config.voxel_size_m != voxel_size_m_) return invalid("the map has another voxel size than before");
  if (!map.config.workspace || !same_box(*map.config.workspace, *workspace_)) {
    return invalid("the map has another workspace than before");
  }
  const ObstacleCells::Changes changes = cells_->update(map.grid, executor);
  if (changes.cells > 0) field_->update(*cells_, executor);
  return ObstacleUpdate{changes.bricks, changes.cells, stopwatch.elapsed_ms()};
}

ObstacleMap::Place ObstacleMap::place(const Eigen::Vector3d& p_world) const {
  const Index3 n = cells_->size();
  const Eigen::Array3d most{2.0 * n.x, 2.0 * n.y, 2.0 * n.z};
  const Eigen::Array3d at = (p_world - origin_).array() * half_cells_per_m_;
  const Eigen::Array3d inside = at.max(0.0).min(most);
  const Eigen::Array3d cell = (inside * 0.5).floor().min(most * 0.5 - 1.0);
  return {
      {static_cast<std::int32_t>(cell.x()), static_cast<std::int32_t>(cell.y()), static_cast<std::int32_t>(cell.z())},
      (at - inside).matrix().squaredNorm(),
      (inside - (2.0 * cell + 1.0)).matrix().norm()};
}

bool ObstacleMap::clear(const Eigen::Vector3d& center_world, double radius_m) const {
  if (!center_world.allFinite() || !std::isfinite(radius_m)) return false;
  const double radius = std::max(radius_m, 0.0);
  const Place at = place(center_world);
  const double distance = field_->distance(at.cell);
  const double reach = radius * half_cells_per_m_ + kFieldSlack;
  const double left = squared(reach) - at.outside_squared;
  if (left < 0.0 || distance > at.from_centre + std::sqrt(left)) {
    return at.outside_squared == 0.0 || !touches_fixture(center_world, radius);
  }
  // A squared distance from a fixture was rounded down by less than one.
  const bool within_reach = distance < field_->reach() && at.outside_squared == 0.0;
  if (within_reach && std::sqrt(squared(distance) + 1.0) + at.from_centre < reach - 2.0 * kFieldSlack) return false;
  return !touches_cell(center_world, radius) && !touches_fixture(center_world, radius);
}

obstacle::FieldView ObstacleMap::view() const {
  const Index3 n = cells_->size();
  const Eigen::Vector3f origin = origin_.cast<float>();
  return {field_->distances().data(),
          {n.x, n.y, n.z},
          static_cast<std::int32_t>(field_->row_stride()),
          {origin.x(), origin.y(), origin.z()},
          static_cast<float>(half_cells_per_m_),
          batch_slack_,
          static_cast<float>(config_.max_distance_m),
          float_fixtures_};
}

void ObstacleMap::clearance_bounds(const SphereSpans& spheres, std::span<float> out) const {
  SACCADE_EXPECTS(spheres.same_length() && out.size() == spheres.x_m.size());
  obstacle::clearances(view(), from(spheres, 0), out.size(), out.data());
}

void ObstacleMap::perhaps_touching(const SphereSpans& spheres, std::span<std::uint64_t> out) const {
  constexpr std::size_t kAtOnce{64};
  const std::size_t count = spheres.x_m.size();
  SACCADE_EXPECTS(spheres.same_length() && out.size() == (count + kAtOnce - 1) / kAtOnce);
  const obstacle::FieldView field = view();
  for (std::size_t word = 0; word < out.size(); ++word) {
    const std::size_t first = word * kAtOnce;
    out[word] = obstacle::perhaps_touching(field, from(spheres, first), std::min(kAtOnce, count - first));
  }
}

std::size_t ObstacleMap::first_touching(const SphereSpans& spheres) const {
  SACCADE_EXPECTS(spheres.same_length());
  const std::size_t count = spheres.x_m.size();
  const obstacle::FieldView field = view();
  constexpr std::size_t kAtOnce{64};
  for (std::size_t first = 0; first < count; first += kAtOnce) {
    std::uint64_t perhaps = obstacle::perhaps_touching(field, from(spheres, first), std::min(kAtOnce, count - first));
    for (; perhaps != 0; perhaps &= perhaps - 1) {
      const std::size_t i = first + static_cast<std::size_t>(std::countr_zero(perhaps));
      if (!clear({spheres.x_m[i], spheres.y_m[i], spheres.z_m[i]}, spheres.radius_m[i])) return i;
    }
  }
  return count;
}

bool ObstacleMap::touches_cell(const Eigen::Vector3d& center_world, double radius_m) const {
  const Eigen::Vector3d p = (center_world - origin_) / cells_->cell_edge_m();
  const double radius = radius_m / cells_->cell_edge_m() + kSlack_cells;
  const Index3 n = cells_->size();
  const auto [first_z, last_z] = range_of_cells(p.z() - radius, p.z() + radius, n.z);
  const auto [first_y, last_y] = range_of_cells(p.y() - radius, p.y() + radius, n.y);
  for (std::int32_t z = first_z; z <= last_z; ++z) {
    const double left = squared(radius) - squared(gap(p.z(), z));
    for (std::int32_t y = first_y; y <= last_y; ++y) {
      const double left_in_row = left - squared(gap(p.y(), y));
      if (left_in_row < 0.0) continue;
      const double half = std::sqrt(left_in_row);
      const auto [first_x, last_x] = range_of_cells(p.x() - half, p.x() + half, n.x);
      const auto row = static_cast<std::size_t>(z) * static_cast<std::size_t>(n.y) + static_cast<std::size_t>(y);
      if (first_x <= last_x && any_set(cells_->row(row), first_x, last_x)) return true;
    }
  }
  return false;
}

bool ObstacleMap::touches_fixture(const Eigen::Vector3d& center_world, double radius_m) const {
  const double reach = radius_m + kSlack_cells * cells_->cell_edge_m();
  return std::any_of(config_.fixtures.begin(), config_.fixtures.end(),
                     [&](const Box& box) { return squared_distance(box, center_world) <= squared(reach); });
}

double ObstacleMap::fixture_distance_m(const Eigen::Vector3d& p_world) const {
  double least = squared(config_.max_distance_m);
  for (const Box& box : config_.fixtures) least = std::min(least, squared_distance(box, p_world));
  return std::sqrt(least);
}

double ObstacleMap::distance_bound_m(const Eigen::Vector3d& p_world) const {
  if (!p_world.allFinite()) return 0.0;
  const Place at = place(p_world);
  const double inside = std::max(field_->distance(at.cell) - at.from_centre, 0.0);
  const double half_cells = std::sqrt(at.outside_squared + squared(inside)) - kFieldSlack;
  const double bound = std::clamp(half_cells / half_cells_per_m_, 0.0, config_.max_distance_m);
  return at.outside_squared == 0.0 ? bound : std::min(bound, fixture_distance_m(p_world));
}

double ObstacleMap::distance_m(const Eigen::Vector3d& p_world) const {
  if (!p_world.allFinite()) return 0.0;
  const Place at = place(p_world);
  const double distance = field_->distance(at.cell);
  const double edge_m = cells_->cell_edge_m();
  double best_m = fixture_distance_m(p_world);
  if (at.outside_squared == 0.0 && distance >= field_->reach() + at.from_centre) return best_m;
  if (distance < field_->reach()) {  // the nearest cell or fixture is at most as far as through the centre
    const double half_cells = std::sqrt(squared(distance) + 1.0) + at.from_centre + std::sqrt(at.outside_squared);
    best_m = std::min(best_m, half_cells / half_cells_per_m_ + kFieldSlack * edge_m);
  }
  const Eigen::Vector3d p = (p_world - origin_) / edge_m;
  const Index3 n = cells_->size();
  double best = squared(best_m / edge_m);
  const double radius = best_m / edge_m;
  const auto [first_z, last_z] = range_of_cells(p.z() - radius, p.z() + radius, n.z);
  const auto [first_y, last_y] = range_of_cells(p.y() - radius, p.y() + radius, n.y);
  for (std::int32_t z = first_z; z <= last_z; ++z) {
    for (std::int32_t y = first_y; y <= last_y; ++y) {
      const double aside = squared(gap(p.z(), z)) + squared(gap(p.y(), y));
      if (aside >= best) continue;
      const double half = std::sqrt(best - aside);
      const auto [first_x, last_x] = range_of_cells(p.x() - half, p.x() + half, n.x);
      const auto row = static_cast<std::size_t>(z) * static_cast<std::size_t>(n.y) + static_cast<std::size_t>(y);
      for (std::int32_t x = first_x; x <= last_x; ++x) {
        if (any_set(cells_->row(row), x, x)) best = std::min(best, aside + squared(gap(p.x(), x)));
      }
    }
  }
  return std::min(std::sqrt(best) * edge_m, fixture_distance_m(p_world));
}

std::vector<Box> ObstacleMap::boxes() const {
  std::vector<Box> all;
  all.reserve(cells_->obstacle_count() + config_.fixtures.size());
  cells_->box().for_each([&](const Index3& cell) {
    if (cells_->is_obstacle(cell)) all.push_back(cells_->bounds_of(cell));
  });
  all.insert(all.end(), config_.fixtures.begin(), config_.fixtures.end());
  return all;
}

}  // namespace saccade
