// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/laser_scan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "saccade/core/seeded_random.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kMostStations{64};
constexpr double kSmallestStep_rad{1.7453e-4};
constexpr double kLargestStep_rad{0.17454};
constexpr double kMixedWithin_m{0.5};

struct ScannedPoint {
  Vector3d p_world;
  Eigen::Vector3f color;
  std::uint32_t label{0};
};

Vector3d direction_of(double azimuth_rad, double elevation_rad) {
  return {std::cos(elevation_rad) * std::cos(azimuth_rad), std::cos(elevation_rad) * std::sin(azimuth_rad),
          std::sin(elevation_rad)};
}

/// Scanner at one station.
class Scanner {
 public:
  Scanner(const RayScene& scene, const SegmentTable& segments, const LaserScanConfig& config, const Vector3d& station)
      : scene_{scene}, segments_{segments}, config_{config}, station_{station} {}

  /// Returns the points of one turn of the mirror. The number of the column seeds its noise.
  [[nodiscard]] std::vector<ScannedPoint> column(std::uint64_t number, double azimuth_rad) const {
    SeededRandom random{config_.seed * 0x9E3779B97F4A7C15ULL + number};
    std::vector<ScannedPoint> points;
    const int rays = static_cast<int>((0.5 * std::numbers::pi - config_.lowest_rad) / config_.step_rad);
    for (int i = 0; i < rays; ++i) {
      if (const auto point = measure(azimuth_rad, config_.lowest_rad + i * config_.step_rad, random)) {
        points.push_back(*point);
      }
    }
    return points;
  }

 private:
  [[nodiscard]] std::optional<ScannedPoint> measure(double azimuth_rad, double elevation_rad,
                                                    SeededRandom& random) const {
    const Vector3d direction = direction_of(azimuth_rad, elevation_rad);
    const auto hit = scene_.cast(station_, direction);
    const double noise_m = config_.range_noise_m * random.normal();
    const double share = random.unit();
    Vector3d color_noise;
    for (Eigen::Index k = 0; k < 3; ++k) color_noise[k] = config_.color_noise * random.normal();
    if (!hit || hit->t < config_.min_range_m || hit->t > config_.max_range_m) return std::nullopt;
    double range_m = hit->t;
    if (config_.beam_rad > 0.0) {
      const auto edge = scene_.cast(station_, direction_of(azimuth_rad + config_.beam_rad, elevation_rad));
      // A smooth surface changes the range too, but steadily: twice as far from the ray, twice as much.
      if (edge && edge->object != hit->object && std::abs(edge->t - hit->t) < kMixedWithin_m) {
        range_m += share * (edge->t - hit->t);
      }
    }
    const SceneObject& object = scene_.scene().objects[hit->object];
    const Pose T_object_world = object.T_world_object.inverse();
    const Paint paint =
        paint_at(object, T_object_world * (station_ + hit->t * direction), T_object_world.linear() * hit->normal_world);
    ScannedPoint point;
    point.p_world = station_ + (range_m + noise_m) * direction;
    // The panorama that colours a scan is taken in ambient light: faces differ little.
    constexpr double kDarkest{0.75};
    const double light = kDarkest + (1.0 - kDarkest) * std::abs(hit->normal_world.dot(Vector3d{0.48, 0.36, 0.8}));
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double value = light * paint.color[static_cast<std::size_t>(k)] / 255.0 + color_noise[k];
      point.color[k] = static_cast<float>(std::clamp(value, 0.0, 1.0));
    }
    point.label = segments_.label(hit->object, paint);
    return point;
  }

  const RayScene& scene_;
  const SegmentTable& segments_;
  const LaserScanConfig& config_;
  Vector3d station_;
};

}  // namespace

Status LaserScanConfig::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "laser scan"}; };
  if (stations_m.empty()) return fail("there is no station");
  if (stations_m.size() > kMostStations) return fail("there are more than 64 stations");
  for (const Vector3d& station : stations_m) {
    if (!station.allFinite()) return fail("a station is not finite");
  }
  if (!(step_rad >= kSmallestStep_rad && step_rad <= kLargestStep_rad)) {
    return fail("the step between rays must be within 0.01 and 10 degrees");
  }
  if (!(lowest_rad >= -0.5 * std::numbers::pi && lowest_rad < 0.5 * std::numbers::pi)) {
    return fail("the lowest elevation must be within -90 and 90 degrees");
  }
  if (!(min_range_m >= 0.0 && max_range_m > min_range_m && std::isfinite(max_range_m))) {
    return fail("the range must not be empty");
  }
  for (const double value : {range_noise_m, color_noise, beam_rad}) {
    if (!(std::isfinite(value) && value >= 0.0)) return fail("noise must be finite and not negative");
  }
  return {};
}

Result<LaserScan> scan_by_laser(const RayScene& scene, const LaserScanConfig& config, const Executor& executor,
                                const Progress& progress) {
  SACCADE_CHECK(config.validate());
  const SegmentTable segments{scene.scene()};
  const auto columns = static_cast<std::size_t>(2.0 * std::numbers::pi / config.step_rad);
  constexpr std::size_t kColumnsAtOnce{64};
  LaserScan scan;
  scan.names = segments.names();
  for (std::size_t s = 0; s < config.stations_m.size(); ++s) {
    const Scanner scanner{scene, segments, config, config.stations_m[s]};
    for (std::size_t first = 0; first < columns; first += kColumnsAtOnce) {
      if (progress.cancelled()) return Error{Errc::cancelled, "cancelled", "laser scan"};
      progress.report("scanning", s * columns + first, config.stations_m.size() * columns);
      const std::size_t count = std::min(kColumnsAtOnce, columns - first);
      std::vector<std::vector<ScannedPoint>> parts(count);
      executor.parallel_for(count, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          parts[i] = scanner.column(s * columns + first + i, static_cast<double>(first + i) * config.step_rad);
        }
      });
      for (const auto& part : parts) {
        for (const ScannedPoint& point : part) {
          scan.cloud.positions_m.emplace_back(point.p_world.cast<float>());
          scan.cloud.colors.push_back(point.color);
          scan.labels.push_back(point.label);
        }
      }
    }
  }
  return scan;
}

}  // namespace saccade
