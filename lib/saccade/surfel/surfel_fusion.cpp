// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/surfel_fusion.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <utility>

#include "saccade/core/angle.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/surfel/internal/surfel_averages.hpp"
#include "saccade/surfel/internal/surfel_index.hpp"

namespace saccade {
namespace {

constexpr std::size_t kRowsPerTask{16};
constexpr std::size_t kSurfelsPerTask{4096};
constexpr double kLeastFactor{1e-18};
constexpr std::uint64_t kEmptyCell{~std::uint64_t{0}};  ///< farther than any surfel; its id is kNoSurfel

Status check_frame(const Frame& frame, const PinholeCamera& camera) {
  SACCADE_CHECK(camera.validate());
  const auto same_size = [&](int width, int height) { return width == camera.width && height == camera.height; };
  if (!same_size(frame.depth.width(), frame.depth.height())) {
    return Error{Errc::size_mismatch, "the depth image is not of the camera's size", frame.name};
  }
  if (frame.color && !same_size(frame.color->width(), frame.color->height())) {
    return Error{Errc::size_mismatch, "the colour image is not of the depth image's size", frame.name};
  }
  if (!frame.T_world_camera) return Error{Errc::invalid_argument, "the frame has no pose: track it first", frame.name};
  if (!frame.T_world_camera->matrix().allFinite()) {
    return Error{Errc::invalid_argument, "the frame's pose is not finite", frame.name};
  }
  return {};
}

/// Returns one factor of eq. 4.2 for each index, never so small that a product of two is 0.
std::vector<float> axis_weights(int count, double squared_diagonal, double sigma) {
  std::vector<float> weights(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double from_center = i - 0.5 * (count - 1);
    const double factor = std::exp(-from_center * from_center / squared_diagonal / (2.0 * sigma * sigma));
    weights[static_cast<std::size_t>(i)] = static_cast<float>(std::max(factor, kLeastFactor));
  }
  return weights;
}

}  // namespace

Status SurfelFusionConfig::validate() const {
  for (const double value : {image_sigma, depth_tolerance_m, max_normal_angle_rad, max_view_angle_rad, max_radius_m}) {
    if (!std::isfinite(value) || !(value > 0.0)) {
      return Error{
          Errc::invalid_argument, "surfel fusion: σ, tolerance, angles and radius must be positive, and finite", {}};
    }
  }
  if (!std::isfinite(depth_tolerance_growth_per_m) || depth_tolerance_growth_per_m < 0.0) {
    return Error{Errc::invalid_argument, "surfel fusion: the growth of the tolerance must not be negative", {}};
  }
  if (!std::isfinite(max_stretch) || max_stretch < 1.0) {
    return Error{Errc::invalid_argument, "surfel fusion: the stretch must be at least 1, and finite", {}};
  }
  if (std::max(max_normal_angle_rad, max_view_angle_rad) >= 90_deg) {
    return Error{Errc::invalid_argument, "surfel fusion: angles must be less than 90°", {}};
  }
  return {};
}

Result<SurfelFusion> SurfelFusion::create(const SurfelFusionConfig& config, SurfelMap map) {
  SACCADE_CHECK(config.validate());
  return SurfelFusion{config, std::move(map)};
}

void SurfelFusion::prepare(const PinholeCamera& camera, const Pose& T_world_camera) {
  SurfelAssociation& seen = association_;
  if (seen.of_pixel.empty() || seen.camera != camera) {
    const double squared_diagonal = double(camera.width) * camera.width + double(camera.height) * camera.height;
    seen.column_weights = axis_weights(camera.width, squared_diagonal, config_.image_sigma);
    seen.row_weights = axis_weights(camera.height, squared_diagonal, config_.image_sigma);
    seen.of_pixel = Image<SurfelId>{camera.width, camera.height, kNoSurfel};
    seen.of_cell = Image<SurfelId>{camera.width, camera.height, kNoSurfel};
    seen.groups.resize((static_cast<std::size_t>(camera.height) + SurfelAssociation::kRowsAtOnce - 1) /
                       SurfelAssociation::kRowsAtOnce);
    cells_.assign(seen.of_pixel.size(), kEmptyCell);
  }
  seen.camera = camera;
  seen.T_world_camera = T_world_camera;
  seen.first_new = map_.size();
}

/// Fills the index image: each surfel that faces the camera, in the cell that its centre projects into.
void SurfelFusion::project(const PointImage& points, const Executor& executor) {
  const FloatView view{association_};
  const auto enter = [&](const ProjectedSurfel& landing) {
    const float measured = points.z.data()[landing.cell];
    const float key = measured > 0.0F ? std::abs(landing.z - measured) : landing.z;
    const std::uint64_t wanted = (std::uint64_t{std::bit_cast<std::uint32_t>(key)} << 32U) | landing.id;
    const std::atomic_ref<std::uint64_t> place{cells_[landing.cell]};
    std::uint64_t there = place.load(std::memory_order_relaxed);
    while (wanted < there && !place.compare_exchange_weak(there, wanted, std::memory_order_relaxed)) {
    }
  };
  executor.parallel_for(map_.size(), kSurfelsPerTask, [&](std::size_t begin, std::size_t end) {
    // In batches, since an atomic exchange waits for its cell and blocks other work.
    std::array<std::array<ProjectedSurfel, kMaxProjected>, 2> landings;
    std::array<std::size_t, 2> counts{};
    std::size_t now{0};
    const auto enter_all = [&](std::size_t which) {
      for (std::size_t i = 0; i < counts[which]; ++i) enter(landings[which][i]);
    };
    for (std::size_t first = begin; first < end; first += kMaxProjected, now = 1 - now) {
      const std::size_t discs = std::min(kMaxProjected, end - first);
      counts[now] = project_discs(view, {&map_.discs[first], discs}, static_cast<SurfelId>(first), landings[now]);
      for (std::size_t i = 0; i < counts[now]; ++i) {
        __builtin_prefetch(&cells_[landings[now][i].cell], 1);
        __builtin_prefetch(points.z.data() + landings[now][i].cell);
      }
      enter_all(1 - now);
    }
    enter_all(1 - now);
  });
  const auto width = static_cast<std::size_t>(view.width);
  executor.parallel_for(static_cast<std::size_t>(view.height), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    SurfelId* ids = association_.of_cell.data();
    for (std::size_t i = begin * width; i < end * width; ++i) ids[i] = static_cast<SurfelId>(cells_[i]);
    std::fill_n(cells_.data() + begin * width, (end - begin) * width, kEmptyCell);  // ready for the next frame
  });
}

void SurfelFusion::associate(const PointImage& points, const Executor& executor, SurfelFusionReport& report) {
  const FloatView view{association_};
  AssociationLimits limits{view.fx, view.fy, view.cx, view.cy, 0.0F, 0.0F, 0.0F, 0.0F};
  limits.tolerance_m = static_cast<float>(config_.depth_tolerance_m);
  limits.growth_per_m = static_cast<float>(config_.depth_tolerance_growth_per_m);
  limits.normal_cosine = static_cast<float>(std::cos(config_.max_normal_angle_rad));
  limits.view_cosine = static_cast<float>(std::cos(config_.max_view_angle_rad));
  const auto rows = static_cast<std::size_t>(association_.camera.height);
  std::vector<RowCounts> counts((rows + kRowsPerTask - 1) / kRowsPerTask);
  executor.parallel_for(rows, kRowsPerTask, [&](std::size_t first, std::size_t last) {
    const int begin = static_cast<int>(first);
    const int end = static_cast<int>(last);
    SurfelCells cells{view.width, begin, end};
    const auto fill = [&](int v) {
      if (v < 0 || v >= view.height) return cells.set_empty(v);
      fill_row(view, map_, association_.of_cell.row(v), v, cells);
    };
    fill(begin - 1);
    fill(begin);
    for (int v = begin; v < end; ++v) {
      fill(v + 1);
      associate_row(cells, points, limits, v, association_.of_pixel.row(v), counts[first / kRowsPerTask]);
    }
  });
  std::vector<std::size_t> created;
  for (const RowCounts& count : counts) {
    report.points += count.points;
    report.associated += count.associated;
    report.contradicted += count.contradicted;
    report.created += count.created;
    created.push_back(count.created);
  }
  number_new_surfels(created, executor);
}

/// Numbers the pixels that create surfels, in row-major order. `created`: their number per task.
void SurfelFusion::number_new_surfels(const std::vector<std::size_t>& created, const Executor& executor) {
  SurfelAssociation& seen = association_;
  std::vector<std::size_t> first(created.size());
  std::exclusive_scan(created.begin(), created.end(), first.begin(), map_.size());
  map_.resize(std::reduce(created.begin(), created.end(), map_.size()));
  seen.surfels = map_.size();
  const auto rows = static_cast<std::size_t>(seen.camera.height);
  const auto width = static_cast<std::size_t>(seen.camera.width);
  executor.parallel_for(rows, kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    auto id = static_cast<SurfelId>(first[begin / kRowsPerTask]);
    for (std::size_t v = begin; v < end; ++v) {
      SurfelId* row = seen.of_pixel.row(static_cast<int>(v));
      for (std::size_t u = 0; u < width; ++u) {
        if (row[u] == kMakesSurfel) row[u] = id++;
      }
    }
  });
}

void SurfelFusion::integrate(const Frame& frame, const Executor& executor, SurfelFusionReport& report) {
  const Stopwatch stopwatch;
  const ObservedFrame observed{association_, points_, frame.color ? &*frame.color : nullptr,
                               static_cast<float>(config_.max_radius_m), static_cast<float>(1.0 / config_.max_stretch)};
  executor.parallel_for(association_.groups.size(), SurfelAssociation::kGroupsPerTask,
                        [&](std::size_t begin, std::size_t end) {
                          for (std::size_t g = begin; g < end; ++g) {
                            association_.collect(g);
                            for (const auto& round : association_.groups[g]) average_pixels(observed, round, map_);
                          }
                        });
  report.integrate_ms = stopwatch.elapsed_ms();
}

Result<SurfelFusionReport> SurfelFusion::associate(const Frame& frame, const PinholeCamera& camera,
                                                   const Executor& executor) {
  SACCADE_CHECK(check_frame(frame, camera));
  SurfelFusionReport report;
  report.has_color = frame.color.has_value();
  Stopwatch stopwatch;
  points_ = to_points(frame.depth, camera, executor);
  report.points_ms = stopwatch.lap_ms();
  prepare(camera, *frame.T_world_camera);
  project(points_, executor);
  report.index_ms = stopwatch.lap_ms();
  associate(points_, executor, report);
  report.associate_ms = stopwatch.lap_ms();
  return report;
}

Result<SurfelFusionReport> SurfelFusion::add_frame(const Frame& frame, const PinholeCamera& camera,
                                                   const Executor& executor) {
  SACCADE_TRY(SurfelFusionReport report, associate(frame, camera, executor));
  integrate(frame, executor, report);
  return report;
}

Result<SurfelFusionReport> SurfelFusion::add_frame(Frame& frame, const PinholeCamera& camera,
                                                   ExposureCompensation& exposure, const Executor& executor) {
  SACCADE_TRY(SurfelFusionReport report, associate(frame, camera, executor));
  if (frame.color) {
    const Stopwatch stopwatch;
    report.exposure = exposure.apply(association_, map_, executor, *frame.color);
    report.exposure_ms = stopwatch.elapsed_ms();
  }
  integrate(frame, executor, report);
  return report;
}

}  // namespace saccade
