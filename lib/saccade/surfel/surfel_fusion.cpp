// SPDX-License-Identifier: Apache-2.0
#include "saccade/surfel/surfel_fusion.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "saccade/core/clock.hpp"

namespace saccade {
namespace {

constexpr std::size_t kRowsPerTask{16};
constexpr std::size_t kSurfelsPerTask{4096};
constexpr std::uint64_t kEmptyCell{~std::uint64_t{0}};
constexpr SurfelId kMakesSurfel{kNoSurfel - 1};
/// A radius that is so much larger comes from too far away to say anything of this surfel's.
constexpr float kComparableRadius{1.5F};

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

/// One factor of eq. 4.2.
std::vector<float> axis_weights(int count, double squared_diagonal, double sigma) {
  std::vector<float> weights(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double from_center = i - 0.5 * (count - 1);
    weights[static_cast<std::size_t>(i)] =
        static_cast<float>(std::exp(-from_center * from_center / squared_diagonal / (2.0 * sigma * sigma)));
  }
  return weights;
}

/// Camera and pose in single precision.
struct FloatView {
  explicit FloatView(const SurfelAssociation& seen)
      : R_camera_world{seen.T_world_camera.linear().transpose().cast<float>()},
        center_world{seen.T_world_camera.translation().cast<float>()},
        fx{static_cast<float>(seen.camera.fx)},
        fy{static_cast<float>(seen.camera.fy)},
        cx{static_cast<float>(seen.camera.cx)},
        cy{static_cast<float>(seen.camera.cy)} {}

  [[nodiscard]] Eigen::Vector3f to_camera(const Eigen::Vector3f& p_world) const {
    return R_camera_world * (p_world - center_world);
  }

  Eigen::Matrix3f R_camera_world;
  Eigen::Vector3f center_world;
  float fx, fy, cx, cy;
};

Eigen::Vector3f normal_at(const PointImage& points, int u, int v) {
  return {points.nx(u, v), points.ny(u, v), points.nz(u, v)};
}

}  // namespace

Status SurfelFusionConfig::validate() const {
  for (const double value : {image_sigma, depth_tolerance_m, max_normal_angle_rad, max_view_angle_rad, max_radius_m}) {
    if (!std::isfinite(value) || !(value > 0.0)) {
      return Error{Errc::invalid_argument, "surfel fusion: σ, tolerance, angles and radius must be positive", {}};
    }
  }
  if (!std::isfinite(depth_tolerance_growth_per_m) || depth_tolerance_growth_per_m < 0.0) {
    return Error{Errc::invalid_argument, "surfel fusion: the growth of the tolerance must not be negative", {}};
  }
  if (std::max(max_normal_angle_rad, max_view_angle_rad) >= std::numbers::pi / 2.0) {
    return Error{Errc::invalid_argument, "surfel fusion: angles must be less than 90°", {}};
  }
  return {};
}

Result<SurfelFusion> SurfelFusion::create(const SurfelFusionConfig& config) {
  SACCADE_CHECK(config.validate());
  return SurfelFusion{config};
}

void SurfelFusion::prepare(const PinholeCamera& camera, const Pose& T_world_camera) {
  SurfelAssociation& seen = association_;
  if (seen.of_pixel.empty() || seen.camera != camera) {
    const double squared_diagonal = double(camera.width) * camera.width + double(camera.height) * camera.height;
    seen.column_weights = axis_weights(camera.width, squared_diagonal, config_.image_sigma);
    seen.row_weights = axis_weights(camera.height, squared_diagonal, config_.image_sigma);
    seen.of_pixel = Image<SurfelId>{camera.width, camera.height, kNoSurfel};
    seen.of_cell = Image<SurfelId>{camera.width, camera.height, kNoSurfel};
  }
  seen.camera = camera;
  seen.T_world_camera = T_world_camera;
  seen.first_new = map_.size();
  cells_.assign(seen.of_pixel.size(), kEmptyCell);
}

/// The index image: every surfel that faces the camera, in the cell that its centre projects into.
void SurfelFusion::project(const PointImage& points, const Executor& executor) {
  const FloatView view{association_};
  const PinholeCamera& camera = association_.camera;
  const auto width = static_cast<float>(camera.width);
  const auto height = static_cast<float>(camera.height);
  executor.parallel_for(map_.size(), kSurfelsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t id = begin; id < end; ++id) {
      const Eigen::Vector3f p = view.to_camera(map_.positions_m[id]);
      if (!(p.z() > 0.0F)) continue;
      const float u = p.x() / p.z() * view.fx + view.cx + 0.5F;
      const float v = p.y() / p.z() * view.fy + view.cy + 0.5F;
      if (!(u >= 0.0F && u < width && v >= 0.0F && v < height)) continue;
      if (map_.normals[id].dot(map_.positions_m[id] - view.center_world) >= 0.0F) continue;
      const std::size_t cell =
          static_cast<std::size_t>(v) * static_cast<std::size_t>(camera.width) + static_cast<std::size_t>(u);
      const float measured = points.z.data()[cell];
      const float key = measured > 0.0F ? std::abs(p.z() - measured) : p.z();
      const std::uint64_t wanted = (std::uint64_t{std::bit_cast<std::uint32_t>(key)} << 32U) | id;
      const std::atomic_ref<std::uint64_t> place{cells_[cell]};
      std::uint64_t there = place.load(std::memory_order_relaxed);
      while (wanted < there && !place.compare_exchange_weak(there, wanted, std::memory_order_relaxed)) {
      }
    }
  });
  executor.parallel_for(
      cells_.size(), kRowsPerTask * static_cast<std::size_t>(camera.width), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          association_.of_cell.data()[i] = cells_[i] == kEmptyCell ? kNoSurfel : static_cast<SurfelId>(cells_[i]);
        }
      });
}

void SurfelFusion::associate(const PointImage& points, const Executor& executor, SurfelFusionReport& report) {
  SurfelAssociation& seen = association_;
  const FloatView view{seen};
  const auto tolerance = static_cast<float>(config_.depth_tolerance_m);
  const auto growth = static_cast<float>(config_.depth_tolerance_growth_per_m);
  const auto normal_cosine = static_cast<float>(std::cos(config_.max_normal_angle_rad));
  const auto view_cosine = static_cast<float>(std::cos(config_.max_view_angle_rad));
  const int width = seen.camera.width;
  const int height = seen.camera.height;
  struct Counts {
    std::size_t points{0}, associated{0}, contradicted{0}, created{0};
  };
  const std::size_t rows = static_cast<std::size_t>(height);
  std::vector<Counts> counts((rows + kRowsPerTask - 1) / kRowsPerTask);

  // What pixel (u, v) with depth z, normal n (world) and ray r (camera) sees.
  const auto surfel_of = [&](int u, int v, float z, const Eigen::Vector3f& n, float rx, float ry) -> SurfelId {
    const float limit = tolerance + growth * z * z;
    bool occupied{false};
    const SurfelId own = seen.of_cell(u, v);
    if (own != kNoSurfel) {
      const auto key = static_cast<std::uint32_t>(
          cells_[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) + static_cast<std::size_t>(u)] >> 32U);
      if (std::bit_cast<float>(key) <= limit) {
        if (map_.normals[own].dot(n) >= normal_cosine) return own;
        occupied = true;
      }
    }
    SurfelId best{kNoSurfel};
    float least = std::numeric_limits<float>::max();
    constexpr int kReach{SurfelAssociation::kReach_px};
    for (int row = std::max(v - kReach, 0); row <= std::min(v + kReach, height - 1); ++row) {
      for (int column = std::max(u - kReach, 0); column <= std::min(u + kReach, width - 1); ++column) {
        const SurfelId other = seen.of_cell(column, row);
        if (other == kNoSurfel || other == own) continue;
        const Eigen::Vector3f p = view.to_camera(map_.positions_m[other]);
        if (std::abs(p.z() - z) > limit) continue;
        const float dx = p.x() - rx * p.z();
        const float dy = p.y() - ry * p.z();
        const float squared = dx * dx + dy * dy;
        if (squared > map_.radii_m[other] * map_.radii_m[other]) continue;
        if (map_.normals[other].dot(n) < normal_cosine) {
          occupied = true;
        } else if (squared < least) {
          least = squared;
          best = other;
        }
      }
    }
    if (best != kNoSurfel) return best;
    return occupied ? kNoSurfel : kMakesSurfel;
  };

  executor.parallel_for(rows, kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    Counts& count = counts[begin / kRowsPerTask];
    for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
      const float ry = (static_cast<float>(v) - view.cy) / view.fy;
      for (int u = 0; u < width; ++u) {
        SurfelId& id = seen.of_pixel(u, v);
        id = kNoSurfel;
        const float z = points.z(u, v);
        const Eigen::Vector3f n = normal_at(points, u, v);
        if (!(z > 0.0F) || n.isZero(0.0F)) continue;
        ++count.points;
        const float rx = (static_cast<float>(u) - view.cx) / view.fx;
        id = surfel_of(u, v, z, view.R_camera_world.transpose() * n, rx, ry);
        if (id == kMakesSurfel) {
          const float toward = -(n.x() * rx + n.y() * ry + n.z());
          if (toward >= view_cosine * std::sqrt(rx * rx + ry * ry + 1.0F)) {
            ++count.created;
          } else {
            id = kNoSurfel;
          }
        } else if (id == kNoSurfel) {
          ++count.contradicted;
        } else {
          ++count.associated;
        }
      }
    }
  });

  std::vector<std::size_t> first(counts.size());
  std::size_t next = map_.size();
  for (std::size_t i = 0; i < counts.size(); ++i) {
    first[i] = next;
    next += counts[i].created;
    report.points += counts[i].points;
    report.associated += counts[i].associated;
    report.contradicted += counts[i].contradicted;
    report.created += counts[i].created;
  }
  map_.resize(next);
  seen.surfels = next;
  executor.parallel_for(rows, kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    auto id = static_cast<SurfelId>(first[begin / kRowsPerTask]);
    for (std::size_t v = begin; v < end; ++v) {
      SurfelId* row = seen.of_pixel.row(static_cast<int>(v));
      for (int u = 0; u < width; ++u) {
        if (row[u] == kMakesSurfel) row[u] = id++;
      }
    }
  });
}

void SurfelFusion::integrate(const Frame& frame, const PointImage& points, const Executor& executor) {
  const SurfelAssociation& seen = association_;
  const Eigen::Matrix3f R_world_camera = seen.T_world_camera.linear().cast<float>();
  const auto focal = static_cast<float>(std::sqrt(seen.camera.fx * seen.camera.fy));
  const auto max_radius = static_cast<float>(config_.max_radius_m);
  const auto fuse = [&](SurfelId id, std::span<const SeenPixel> pixels) {
    Surfel surfel = id < seen.first_new ? map_.surfel(id) : Surfel{{}, {}, Eigen::Vector3f::Zero()};
    for (const auto& [u, v] : pixels) {
      const float w = seen.weight(u, v);
      const float z = points.z(u, v);
      const Eigen::Vector3f n_camera = normal_at(points, u, v);
      const Eigen::Vector3f n = R_world_camera * n_camera;
      const Eigen::Vector3f p = seen.back_project(u, v, z);
      const float slope = std::max(std::abs(n_camera.z()), 1e-3F);
      const float radius = std::min(std::numbers::sqrt2_v<float> * z / focal / slope, max_radius);
      if (frame.color) {
        const Eigen::Vector3f c = unit_color((*frame.color)(u, v));
        surfel.color = surfel.color_weight > 0.0F ? weighted_mean(surfel.color, surfel.color_weight, c, w) : c;
        surfel.color_weight += w;
      }
      if (surfel.weight > 0.0F) {
        surfel.position_m = weighted_mean(surfel.position_m, surfel.weight, p, w);
        surfel.normal = weighted_mean(surfel.normal, surfel.weight, n, w).normalized();
        if (radius < kComparableRadius * surfel.radius_m) {
          surfel.radius_m = (surfel.radius_m * surfel.weight + radius * w) / (surfel.weight + w);
        }
      } else {
        surfel.position_m = p;
        surfel.normal = n;
        surfel.radius_m = radius;
      }
      surfel.weight += w;
    }
    map_.set(id, surfel);
  };
  executor.parallel_for(static_cast<std::size_t>(seen.camera.height), kRowsPerTask,
                        [&](std::size_t begin, std::size_t end) {
                          for_each_seen_surfel(seen, static_cast<int>(begin), static_cast<int>(end), fuse);
                        });
}

Result<SurfelFusionReport> SurfelFusion::add_frame(const Frame& frame, const PinholeCamera& camera,
                                                   const Executor& executor) {
  SACCADE_CHECK(check_frame(frame, camera));
  SurfelFusionReport report;
  report.has_color = frame.color.has_value();
  Stopwatch stopwatch;
  const PointImage points = to_points(frame.depth, camera, executor);
  report.points_ms = stopwatch.lap_ms();
  prepare(camera, *frame.T_world_camera);
  project(points, executor);
  report.index_ms = stopwatch.lap_ms();
  associate(points, executor, report);
  report.associate_ms = stopwatch.lap_ms();
  integrate(frame, points, executor);
  report.integrate_ms = stopwatch.lap_ms();
  return report;
}

}  // namespace saccade
