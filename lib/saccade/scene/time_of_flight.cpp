// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/time_of_flight.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace saccade {
namespace {

constexpr double kTouching_m{0.002};  // a surface does not shade itself from so near
constexpr int kMaxSamples{16};
constexpr double kMaxFootprint_px{5.0};
constexpr std::size_t kRowsPerTask{8};

struct Measurement {
  float depth_m{0.0F};
  MeasuredPixel truth{MeasuredPixel::no_return};
};

class Sensor {
 public:
  Sensor(const RayScene& scene, const TimeOfFlightConfig& config, const Pose& T_world_camera, const DepthImage& exact)
      : scene_{scene}, config_{config}, T_world_camera_{T_world_camera}, exact_{exact} {
    const double x_m = config.emitter_side == EmitterSide::left ? -config.baseline_m : config.baseline_m;
    emitter_world_ = T_world_camera * Eigen::Vector3d{x_m, 0.0, 0.0};
  }

  /// Without noise.
  [[nodiscard]] Measurement at(int u, int v) const {
    const float z = exact_(u, v);
    if (!(z > 0.0F)) return {};
    if (may_hold_edge(u, v)) return mixed_at(u, v);
    return {z, truth_of(u, v)};
  }

 private:
  [[nodiscard]] MeasuredPixel truth_of(int u, int v) const {
    return is_lit(u, v) ? MeasuredPixel::good : MeasuredPixel::in_shadow;
  }

  [[nodiscard]] bool is_lit(int u, int v) const {
    const Eigen::Vector3d p_world =
        T_world_camera_ * Eigen::Vector3d{config_.camera.ray(u, v) * static_cast<double>(exact_(u, v))};
    const Eigen::Vector3d way = p_world - emitter_world_;
    const auto hit = scene_.cast(emitter_world_, way);
    return !hit || (1.0 - hit->t) * way.norm() < kTouching_m;
  }

  /// Whether a neighbour within the footprint lies at another depth.
  [[nodiscard]] bool may_hold_edge(int u, int v) const {
    const int reach = static_cast<int>(std::ceil(0.5 * config_.footprint_px));
    for (int j = std::max(0, v - reach); j <= std::min(exact_.height() - 1, v + reach); ++j) {
      for (int i = std::max(0, u - reach); i <= std::min(exact_.width() - 1, u + reach); ++i) {
        if (exact_(i, j) > 0.0F && std::abs(exact_(i, j) - exact_(u, v)) > config_.veil_distance_m) return true;
      }
    }
    return false;
  }

  [[nodiscard]] Measurement mixed_at(int u, int v) const {
    std::vector<double> depths_m;
    double weights{0.0};
    double sum{0.0};
    const int n = config_.footprint_samples;
    for (int k = 0; k < n * n; ++k) {
      const double du = config_.footprint_px * ((k % n + 0.5) / n - 0.5);
      const double dv = config_.footprint_px * ((k / n + 0.5) / n - 0.5);
      const auto hit =
          scene_.cast(T_world_camera_.translation(), T_world_camera_.linear() * config_.camera.ray(u + du, v + dv));
      if (!hit || hit->t < config_.camera.min_range_m || hit->t > config_.camera.max_range_m) continue;
      depths_m.push_back(hit->t);
      weights += 1.0 / (hit->t * hit->t);
      sum += 1.0 / hit->t;
    }
    if (depths_m.empty()) return {exact_(u, v), truth_of(u, v)};
    const double mean_m = sum / weights;
    const bool veil = std::none_of(depths_m.begin(), depths_m.end(), [&](double depth_m) {
      return std::abs(depth_m - mean_m) <= config_.veil_distance_m;
    });
    return {static_cast<float>(mean_m), veil ? MeasuredPixel::veil : truth_of(u, v)};
  }

  const RayScene& scene_;
  const TimeOfFlightConfig& config_;
  const Pose& T_world_camera_;
  const DepthImage& exact_;
  Eigen::Vector3d emitter_world_;
};

}  // namespace

TimeOfFlightConfig::TimeOfFlightConfig() : camera{camera_preset("kinect-v2").value()} {}

Status TimeOfFlightConfig::validate() const {
  SACCADE_CHECK(camera.validate());
  SACCADE_CHECK((DepthFilterConfig{baseline_m, emitter_side}.validate()));
  SACCADE_CHECK(noise.validate());
  if (!(shadow_sigma_m >= 0.0 && std::isfinite(shadow_sigma_m) && veil_distance_m > 0.0 &&
        std::isfinite(veil_distance_m))) {
    return Error{Errc::invalid_argument, "the spread of shadow points and the distance of veil points must be positive",
                 "time of flight"};
  }
  if (!(footprint_px > 0.0 && footprint_px <= kMaxFootprint_px) || footprint_samples < 2 ||
      footprint_samples > kMaxSamples) {
    return Error{Errc::invalid_argument, "the footprint must be within 0 and 5 pixels and have 2 to 16 samples",
                 "time of flight"};
  }
  return {};
}

Result<TimeOfFlightFrame> capture_time_of_flight(const RayScene& scene, const TimeOfFlightConfig& config,
                                                 const Pose& T_world_camera, std::uint64_t frame,
                                                 const Executor& executor) {
  SACCADE_CHECK(config.validate());
  const int width = config.camera.width;
  const int height = config.camera.height;
  TimeOfFlightFrame measured{
      DepthImage{width, height}, scene.render(config.camera, T_world_camera, executor).depth, {width, height}};
  const Sensor sensor{scene, config, T_world_camera, measured.exact};
  executor.parallel_for(static_cast<std::size_t>(height), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    for (auto v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
      for (int u = 0; u < width; ++u) {
        const Measurement at = sensor.at(u, v);
        measured.depth(u, v) = at.depth_m;
        measured.truth(u, v) = at.truth;
      }
    }
  });
  DepthNoise in_shadow{config.shadow_sigma_m, 0.0, 0.0};
  in_shadow.seed = config.noise.seed;
  const DepthImage unlit = with_noise(measured.depth, in_shadow, frame);
  measured.depth = with_noise(measured.depth, config.noise, frame);
  for (std::size_t i = 0; i < unlit.size(); ++i) {
    if (measured.truth.pixels()[i] == MeasuredPixel::in_shadow) measured.depth.data()[i] = unlit.pixels()[i];
  }
  return measured;
}

}  // namespace saccade
