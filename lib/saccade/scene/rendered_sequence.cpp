// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/rendered_sequence.hpp"

#include "saccade/core/seeded_random.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kRowsPerChunk{8};
constexpr int kRaysAcrossPixel{4};
constexpr double kLampShare{0.45};  // lamp's share of the light at the middle of the scene; the rest is ambient
constexpr double kLampDistance_m{2.5};

/// Returns a number with mean 0 and standard deviation 1, never beyond ±6: the sum of twelve uniform numbers.
double bounded_normal(SeededRandom& random) {
  double sum = 0.0;
  for (int i = 0; i < 12; ++i) sum += random.unit();
  return sum - 6.0;
}

Vector3d bounded_normals(SeededRandom& random) {
  const double x = bounded_normal(random);
  const double y = bounded_normal(random);
  return {x, y, bounded_normal(random)};
}

struct Sample {
  Eigen::Vector3f light{Eigen::Vector3f::Zero()};
  float depth_m{0.0F};
  int object{-1};
  std::uint16_t label{0};
  bool fine{false};
};

const std::array<double, 256>& linear_table() {
  static const std::array<double, 256> table = [] {
    std::array<double, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = linear_of_srgb(static_cast<double>(i) / 255.0);
    return values;
  }();
  return table;
}

Pose moved(const Pose& T, const Vector3d& by_m, const Vector3d& by_rad) {
  Pose T_moved = T;
  T_moved.translation() += by_m;
  const double angle_rad = by_rad.norm();
  if (angle_rad > 0.0) T_moved.rotate(Eigen::AngleAxisd{angle_rad, by_rad / angle_rad});
  return T_moved;
}

Sample sample_at(const RayScene& scene, const std::vector<Pose>& T_object_world, const SegmentTable& segments,
                 const PinholeCamera& camera, const Vector3d& lamp_world, const Pose& T_world_camera, double u,
                 double v) {
  const Vector3d direction = T_world_camera.linear() * camera.ray(u, v);
  const auto hit = scene.cast(T_world_camera.translation(), direction);
  if (!hit) return {};
  const SceneObject& object = scene.scene().objects[hit->object];
  const Pose& T = T_object_world[hit->object];
  const Vector3d p_world = T_world_camera.translation() + hit->t * direction;
  const Paint paint = paint_at(object, T * p_world, T.linear() * hit->normal_world);
  const Vector3d to_lamp = lamp_world - p_world;
  const double nearness = kLampDistance_m / to_lamp.norm();
  const double facing = std::max(0.0, hit->normal_world.dot(to_lamp.normalized()));
  const double lit = (1.0 - kLampShare) + kLampShare * facing * std::min(4.0, nearness * nearness);
  Sample sample;
  for (std::size_t k = 0; k < 3; ++k) {
    sample.light[static_cast<Eigen::Index>(k)] = static_cast<float>(lit * linear_table()[paint.color[k]]);
  }
  sample.object = static_cast<int>(hit->object);
  sample.fine = paint.fine || object.texture.kind != Texture::Kind::plain;
  if (hit->t >= camera.min_range_m && hit->t <= camera.max_range_m) {
    sample.depth_m = static_cast<float>(hit->t);
    sample.label = segments.label(hit->object, paint);
  }
  return sample;
}

/// Tells whether the pixel's colour needs more than one ray.
bool mixed(const Image<Sample>& centers, int u, int v) {
  const Sample& here = centers(u, v);
  if (here.fine) return true;
  for (int j = std::max(0, v - 1); j <= std::min(centers.height() - 1, v + 1); ++j) {
    for (int i = std::max(0, u - 1); i <= std::min(centers.width() - 1, u + 1); ++i) {
      if (centers(i, j).object != here.object || centers(i, j).label != here.label) return true;
    }
  }
  return false;
}

}  // namespace

std::vector<Pose> hand_held_poses(const HandHeldPath& path, std::size_t frames, std::uint64_t seed) {
  SACCADE_EXPECTS(frames >= 1);
  SeededRandom random{seed};
  std::array<double, 12> phases{};
  for (double& phase : phases) phase = 2.0 * std::numbers::pi * random.unit();
  const auto between = [](double from, double to, double swing) { return from + 0.5 * (1.0 + swing) * (to - from); };
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < frames; ++i) {
    const double turns = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(frames);
    const double time_s = static_cast<double>(i) / 30.0;
    const auto swing = [&](double cycles, std::size_t k) { return std::sin(cycles * turns + phases[k]); };
    const auto tremble = [&](double hertz, std::size_t k) {
      return path.tremor_m * std::sin(2.0 * std::numbers::pi * hertz * time_s + phases[k]);
    };
    const Vector3d target{between(path.targets.min.x(), path.targets.max.x(), swing(3.0, 0)),
                          between(path.targets.min.y(), path.targets.max.y(), swing(4.3, 1)),
                          between(path.targets.min.z(), path.targets.max.z(), swing(5.1, 2))};
    const double azimuth_rad = between(path.azimuth_from_rad, path.azimuth_to_rad, swing(2.3, 3));
    const double elevation_rad = between(path.elevation_from_rad, path.elevation_to_rad, swing(3.7, 4));
    const double distance_m = between(path.distance_from_m, path.distance_to_m, swing(2.9, 5));
    const Vector3d outwards{std::cos(elevation_rad) * std::cos(azimuth_rad),
                            std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad)};
    const Vector3d tremor{tremble(1.7, 6), tremble(2.3, 7), tremble(2.9, 8)};
    poses.push_back(
        look_at(target + distance_m * outwards + tremor, target, Vector3d::UnitZ(), path.roll_rad * swing(4.9, 9)));
  }
  return poses;
}

std::vector<Pose> with_noise(const std::vector<Pose>& T_world_camera, const PoseNoise& noise) {
  struct Knot {
    Vector3d m;
    Vector3d rad;
  };
  SeededRandom drift{noise.seed};
  SeededRandom jitter{noise.seed + 0x9E3779B97F4A7C15ULL};
  const auto draw = [&] {
    const Vector3d m = noise.drift_m * bounded_normals(drift);
    return Knot{m, noise.drift_rad * bounded_normals(drift)};
  };
  std::vector<Knot> knots;
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < T_world_camera.size(); ++i) {
    const double place = static_cast<double>(i) / noise.drift_frames;
    const auto k = static_cast<std::size_t>(place);
    while (knots.size() < k + 2) knots.push_back(draw());
    const double s = place - static_cast<double>(k);
    const double w = s * s * (3.0 - 2.0 * s);
    const double norm = std::hypot(1.0 - w, w);  // keeps the variance constant between the knots
    const Vector3d m = ((1.0 - w) * knots[k].m + w * knots[k + 1].m) / norm + noise.jitter_m * bounded_normals(jitter);
    const Vector3d rad =
        ((1.0 - w) * knots[k].rad + w * knots[k + 1].rad) / norm + noise.jitter_rad * bounded_normals(jitter);
    poses.push_back(moved(T_world_camera[i], m, rad));
  }
  return poses;
}

RenderedSequence::RenderedSequence(RayScene scene, std::vector<Pose> true_poses, std::vector<Pose> poses,
                                   const RenderedSequenceConfig& config, Executor executor)
    : scene_{std::move(scene)},
      segments_{scene_.scene()},
      true_poses_{std::move(true_poses)},
      poses_{std::move(poses)},
      config_{config},
      executor_{std::move(executor)} {
  for (const SceneObject& object : scene_.scene().objects) T_object_world_.push_back(object.T_world_object.inverse());
}

Result<RenderedSequence> RenderedSequence::create(RayScene scene, std::vector<Pose> T_world_camera,
                                                  const RenderedSequenceConfig& config, Executor executor) {
  SACCADE_CHECK(config.camera.validate());
  SACCADE_CHECK(config.color.validate());
  if (config.depth_noise) SACCADE_CHECK(config.depth_noise->validate());
  if (config.time_of_flight) SACCADE_CHECK(config.time_of_flight->validate());
  if (!(std::isfinite(config.lateral_noise_px) && config.lateral_noise_px >= 0.0)) {
    return Error{Errc::invalid_argument, "the lateral noise must not be negative", "rendered sequence"};
  }
  if (T_world_camera.empty()) return Error{Errc::invalid_argument, "there are no poses", "rendered sequence"};
  std::vector<Pose> poses = config.pose_noise ? with_noise(T_world_camera, *config.pose_noise) : T_world_camera;
  return RenderedSequence{std::move(scene), std::move(T_world_camera), std::move(poses), config, std::move(executor)};
}

LightImage RenderedSequence::render_light(const Pose& T_world_camera) {
  const int width = config_.camera.width;
  const int height = config_.camera.height;
  const Box& workspace = scene_.scene().workspace;
  const Vector3d lamp_world =
      0.5 * (workspace.min + workspace.max) + kLampDistance_m * Vector3d{0.3, -0.5, 0.8}.normalized();
  const auto at = [&](double u, double v) {
    return sample_at(scene_, T_object_world_, segments_, config_.camera, lamp_world, T_world_camera, u, v);
  };
  const auto each_row = [&](const auto& work) {
    executor_.parallel_for(static_cast<std::size_t>(height), kRowsPerChunk, [&](std::size_t begin, std::size_t end) {
      for (auto v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
        for (int u = 0; u < width; ++u) work(u, v);
      }
    });
  };
  Image<Sample> centers{width, height};
  each_row([&](int u, int v) { centers(u, v) = at(u, v); });
  LightImage light{width, height};
  each_row([&](int u, int v) {
    Eigen::Vector3f sum = centers(u, v).light;
    if (mixed(centers, u, v)) {
      sum.setZero();
      for (int k = 0; k < kRaysAcrossPixel * kRaysAcrossPixel; ++k) {
        const int row = k / kRaysAcrossPixel;
        const double du = (k % kRaysAcrossPixel + 0.5) / kRaysAcrossPixel - 0.5;
        const double dv = (row + 0.5) / kRaysAcrossPixel - 0.5;
        sum += at(u + du, v + dv).light;
      }
      sum /= static_cast<float>(kRaysAcrossPixel * kRaysAcrossPixel);
    }
    light(u, v) = {sum.x(), sum.y(), sum.z()};
  });
  truth_.depth = DepthImage{width, height};
  truth_.label = Image<std::uint16_t>{width, height};
  for (std::size_t i = 0; i < centers.size(); ++i) {
    truth_.depth.data()[i] = centers.data()[i].depth_m;
    truth_.label.data()[i] = centers.data()[i].label;
  }
  return light;
}

DepthImage RenderedSequence::measured(const Pose& T_world_camera) const {
  if (config_.time_of_flight) {
    return measure_time_of_flight(scene_, config_.camera, *config_.time_of_flight, T_world_camera, truth_.depth,
                                  nullptr, next_, executor_)
        .depth;
  }
  if (!config_.depth_noise) return truth_.depth;
  DepthImage shifted = truth_.depth;
  if (config_.lateral_noise_px > 0.0) {
    const int width = shifted.width();
    const int height = shifted.height();
    const std::uint64_t frame_key = config_.depth_noise->seed * 0xD1B54A32D192ED03ULL + next_ * 0x9E3779B97F4A7C15ULL;
    executor_.parallel_for(static_cast<std::size_t>(height), kRowsPerChunk, [&](std::size_t begin, std::size_t end) {
      for (auto v = static_cast<int>(begin); v < static_cast<int>(end); ++v) {
        SeededRandom random{frame_key ^ static_cast<std::uint64_t>(v)};
        for (int u = 0; u < width; ++u) {
          const auto du = static_cast<int>(std::lround(config_.lateral_noise_px * bounded_normal(random)));
          const auto dv = static_cast<int>(std::lround(config_.lateral_noise_px * bounded_normal(random)));
          shifted(u, v) = truth_.depth(std::clamp(u + du, 0, width - 1), std::clamp(v + dv, 0, height - 1));
        }
      }
    });
  }
  return with_noise(shifted, *config_.depth_noise, next_);
}

Result<std::optional<Frame>> RenderedSequence::next() {
  if (next_ == true_poses_.size()) return std::optional<Frame>{};
  const Pose& T_world_camera = true_poses_[next_];
  const LightImage light = render_light(T_world_camera);
  const double mean = mean_light(light, config_.camera, config_.color);
  // The first frame is exposed as if the camera had seen this view for a while.
  if (next_ == 0 && config_.color.automatic_gain) {
    gain_ = std::clamp(config_.color.target_light / std::max(mean, 1e-6), 1.0 / config_.color.max_gain,
                       config_.color.max_gain);
  }
  truth_.T_world_camera = T_world_camera;
  truth_.gain = gain_;
  Frame frame;
  frame.index = next_;
  frame.name = "frame " + std::to_string(next_);
  frame.T_world_camera = poses_[next_];
  frame.depth = measured(T_world_camera);
  frame.color = expose(light, config_.camera, config_.color, gain_, next_, executor_);
  gain_ = next_gain(config_.color, gain_, mean);
  ++next_;
  return std::optional{std::move(frame)};
}

}  // namespace saccade
