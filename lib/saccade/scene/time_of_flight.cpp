// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/simulated_camera.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace saccade {
namespace {

constexpr double kTouching_m{0.002};  // a surface does not shade itself within this distance
constexpr int kMaxSamples{16};
constexpr double kMaxFootprint_px{5.0};
constexpr std::size_t kRowsPerTask{8};
constexpr double kModulation_hz{16e6};
constexpr double kLight_m_s{299792458.0};
constexpr double kPhase_rad_per_m{4.0 * std::numbers::pi * kModulation_hz / kLight_m_s};

struct Measurement {
  float depth_m{0.0F};
  MeasuredPixel truth{MeasuredPixel::no_return};
};

class Sensor {
 public:
  Sensor(const RayScene& scene, const PinholeCamera& camera, const TimeOfFlightConfig& config,
         const Pose& T_world_camera, const DepthImage& exact, const DepthImage* before)
      : scene_{scene},
        camera_{camera},
        config_{config},
        T_world_camera_{T_world_camera},
        exact_{exact},
        before_{before} {
    const double x_m = config.emitter_side == EmitterSide::left ? -config.baseline_m : config.baseline_m;
    emitter_world_ = T_world_camera * Eigen::Vector3d{x_m, 0.0, 0.0};
  }

  /// Measures a pixel without noise.
  [[nodiscard]] Measurement at(int u, int v) const {
    const float z = exact_(u, v);
    if (!(z > 0.0F)) return {};
    if (!is_before(u, v) && may_hold_edge(u, v)) return mixed_at(u, v);
    return {z, truth_of(u, v)};
  }

 private:
  [[nodiscard]] bool is_before(int u, int v) const {
    return before_ != nullptr && (*before_)(u, v) > 0.0F && exact_(u, v) >= (*before_)(u, v);
  }

  [[nodiscard]] MeasuredPixel truth_of(int u, int v) const {
    return is_lit(u, v) ? MeasuredPixel::good : MeasuredPixel::in_shadow;
  }

  [[nodiscard]] bool is_lit(int u, int v) const {
    const Eigen::Vector3d p_world =
        T_world_camera_ * Eigen::Vector3d{camera_.ray(u, v) * static_cast<double>(exact_(u, v))};
    const Eigen::Vector3d way = p_world - emitter_world_;
    const auto hit = scene_.cast(emitter_world_, way);
    return !hit || (1.0 - hit->t) * way.norm() < kTouching_m;
  }

  /// Tells whether a neighbour within the footprint lies at another depth.
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
    const int n = config_.footprint_samples;
    for (int k = 0; k < n * n; ++k) {
      const int row = k / n;
      const double du = config_.footprint_px * ((k % n + 0.5) / n - 0.5);
      const double dv = config_.footprint_px * ((row + 0.5) / n - 0.5);
      const auto hit =
          scene_.cast(T_world_camera_.translation(), T_world_camera_.linear() * camera_.ray(u + du, v + dv));
      if (hit && hit->t >= camera_.min_range_m && hit->t <= camera_.max_range_m) depths_m.push_back(hit->t);
    }
    if (depths_m.empty()) return {exact_(u, v), truth_of(u, v)};
    const double mean_m =
        config_.edge_model == EdgeModel::mean_depth ? mean_depth_m(depths_m) : phase_depth_m(depths_m);
    const bool veil = std::none_of(depths_m.begin(), depths_m.end(), [&](double depth_m) {
      return std::abs(depth_m - mean_m) <= config_.veil_distance_m;
    });
    return {static_cast<float>(mean_m), veil ? MeasuredPixel::veil : truth_of(u, v)};
  }

  [[nodiscard]] static double mean_depth_m(const std::vector<double>& depths_m) {
    double weights{0.0};
    double sum{0.0};
    for (const double depth_m : depths_m) {
      weights += 1.0 / (depth_m * depth_m);
      sum += 1.0 / depth_m;
    }
    return sum / weights;
  }

  [[nodiscard]] static double phase_depth_m(const std::vector<double>& depths_m) {
    std::complex<double> sum;
    for (const double depth_m : depths_m) {
      sum += std::polar(1.0 / (depth_m * depth_m), kPhase_rad_per_m * (depth_m - depths_m.front()));
    }
    return depths_m.front() + std::arg(sum) / kPhase_rad_per_m;
  }

  const RayScene& scene_;
  const PinholeCamera& camera_;
  const TimeOfFlightConfig& config_;
  const Pose& T_world_camera_;
  const DepthImage& exact_;
  const DepthImage* before_;
  Eigen::Vector3d emitter_world_;
};

}  // namespace

Status TimeOfFlightConfig::validate() const {
  SACCADE_CHECK((DepthFilterConfig{.baseline_m = baseline_m, .emitter_side = emitter_side}.validate()));
  SACCADE_CHECK(noise.validate());
  if (!(shadow_bias_m >= 0.0 && std::isfinite(shadow_bias_m) && shadow_sigma_m >= 0.0 &&
        std::isfinite(shadow_sigma_m) && veil_distance_m > 0.0 && std::isfinite(veil_distance_m))) {
    return Error{Errc::invalid_argument,
                 "the bias and spread of shadow points and the distance of veil points must not be negative",
                 "time of flight"};
  }
  if (!(footprint_px > 0.0 && footprint_px <= kMaxFootprint_px) || footprint_samples < 2 ||
      footprint_samples > kMaxSamples) {
    return Error{Errc::invalid_argument, "the footprint must be within 0 and 5 pixels and have 2 to 16 samples",
                 "time of flight"};
  }
  return {};
}

Result<TimeOfFlightFrame> capture_time_of_flight(const RayScene& scene, const PinholeCamera& camera,
                                                 const TimeOfFlightConfig& config, const Pose& T_world_camera,
                                                 std::uint64_t frame, const Executor& executor) {
  SACCADE_CHECK(camera.validate());
  SACCADE_CHECK(config.validate());
  return measure_time_of_flight(scene, camera, config, T_world_camera,
                                scene.render(camera, T_world_camera, executor).depth, nullptr, frame, executor);
}

TimeOfFlightFrame measure_time_of_flight(const RayScene& scene, const PinholeCamera& camera,
                                         const TimeOfFlightConfig& config, const Pose& T_world_camera, DepthImage exact,
                                         const DepthImage* before, std::uint64_t frame, const Executor& executor) {
  const int width = camera.width;
  const int height = camera.height;
  SACCADE_EXPECTS(exact.width() == width && exact.height() == height);
  SACCADE_EXPECTS(before == nullptr || before->size() == exact.size());
  TimeOfFlightFrame measured{DepthImage{width, height}, std::move(exact), {width, height}};
  const Sensor sensor{scene, camera, config, T_world_camera, measured.exact, before};
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
  const auto bias_m = static_cast<float>(config.shadow_bias_m);
  const DepthImage unlit = with_noise(measured.depth, in_shadow, frame);
  measured.depth = with_noise(measured.depth, config.noise, frame);
  for (std::size_t i = 0; i < unlit.size(); ++i) {
    if (measured.truth.pixels()[i] != MeasuredPixel::in_shadow) continue;
    const float z = unlit.pixels()[i];
    measured.depth.data()[i] = z > 0.0F ? z + bias_m : z;
  }
  return measured;
}

}  // namespace saccade
