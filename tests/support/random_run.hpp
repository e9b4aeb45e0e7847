// SPDX-License-Identifier: Apache-2.0
#pragma once
// RandomRun: random configurations, cameras, poses, depth and colour images and regions around the origin.

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "saccade/map/tsdf_map.hpp"

namespace saccade::test {

constexpr int kHalfEdge{40};  ///< 80³ voxels across several sectors, the origin inside

class RandomRun {
 public:
  explicit RandomRun(std::uint32_t seed) : rng_{seed} {
    config_.voxel_size_m = uniform(0.004, 0.03);
    config_.truncation_vox = uniform(1.5, 5.0);
    config_.max_weight = static_cast<std::uint16_t>(integer(5, 60));
    config_.free_weight = static_cast<std::uint16_t>(integer(1, 5));
    camera_.width = integer(8, 90);
    camera_.height = integer(8, 70);
    camera_.fx = uniform(20.0, 90.0);
    camera_.fy = uniform(20.0, 90.0);
    camera_.cx = uniform(0.3, 0.7) * camera_.width;
    camera_.cy = uniform(0.3, 0.7) * camera_.height;
    camera_.min_range_m = 0.05;
    camera_.max_range_m = uniform(1.0, 4.0) * extent();
  }

  /// Makes a run from these draws, with any clearing share; every third has that of eq. 2.2.
  [[nodiscard]] static RandomRun with_clearing(std::uint32_t seed) {
    RandomRun run{seed};
    if (seed % 3 != 0) run.config_.clearing_percent = static_cast<std::uint8_t>(1 + seed * 37 % 100);
    return run;
  }

  [[nodiscard]] const TsdfConfig& config() const { return config_; }
  [[nodiscard]] const PinholeCamera& camera() const { return camera_; }
  double uniform(double lo, double hi) { return std::uniform_real_distribution<double>{lo, hi}(rng_); }
  int integer(int lo, int hi) { return std::uniform_int_distribution<int>{lo, hi}(rng_); }
  [[nodiscard]] double extent() const { return kHalfEdge * config_.voxel_size_m; }

  Pose pose() {
    const double distance = uniform(0.0, 2.5) * extent();
    const Eigen::Vector3d direction = Eigen::Vector3d::NullaryExpr([&] { return uniform(-1.0, 1.0); }).normalized();
    const Eigen::Vector3d target = Eigen::Vector3d::NullaryExpr([&] { return uniform(-0.5, 0.5) * extent(); });
    const Eigen::Vector3d position = target + direction * std::max(distance, 0.01);
    if (integer(0, 4) == 0) {  // on the lattice, axis-parallel: every tie there is
      Pose T{Pose::Identity()};
      T.translation() = Eigen::Vector3d{0.0, 0.0, -std::floor(distance / config_.voxel_size_m) * config_.voxel_size_m};
      return T;
    }
    return look_at(position, target, Eigen::Vector3d::UnitZ(), uniform(-3.0, 3.0));
  }

  /// Patches of smooth depth, steps, holes, "free up to" pixels, NaN, infinity and returns out of range.
  DepthImage depth() {
    DepthImage image{camera_.width, camera_.height};
    const double base = uniform(0.3, 3.0) * extent();
    const double slope_u = uniform(-0.5, 0.5) * base / camera_.width;
    const double slope_v = uniform(-0.5, 0.5) * base / camera_.height;
    const int style = integer(0, 3);
    for (int v = 0; v < camera_.height; ++v) {
      for (int u = 0; u < camera_.width; ++u) {
        double d = base + slope_u * u + slope_v * v;
        if (style == 1 && (u / 7 + v / 5) % 2 == 0) d *= 0.7;
        if (style == 2) d += uniform(-0.1, 0.1) * base;
        if (style == 3 && integer(0, 9) == 0) d = -d;
        switch (integer(0, 60)) {
          case 0: d = 0.0; break;
          case 1: d = std::numeric_limits<double>::quiet_NaN(); break;
          case 2: d = std::numeric_limits<double>::infinity(); break;
          case 3: d = -std::numeric_limits<double>::infinity(); break;
          case 4: d = 0.01; break;
          default: break;
        }
        image(u, v) = static_cast<float>(d);
      }
    }
    return image;
  }

  ColorImage color() {
    ColorImage image{camera_.width, camera_.height};
    for (int v = 0; v < camera_.height; ++v) {
      for (int u = 0; u < camera_.width; ++u) {
        for (std::uint8_t& c : image(u, v)) c = static_cast<std::uint8_t>(integer(0, 255));
      }
    }
    return image;
  }

  Region region() {
    const Eigen::Vector3d c = Eigen::Vector3d::NullaryExpr([&] { return uniform(-0.8, 0.8) * extent(); });
    const Eigen::Vector3d size = Eigen::Vector3d::NullaryExpr([&] { return uniform(0.05, 0.7) * extent(); });
    switch (integer(0, 2)) {
      case 0: return Sphere{c, size.x()};
      case 1: return Box{c - size, c + size};
      default: return Cylinder{c, c + size, size.y()};
    }
  }

 private:
  std::mt19937 rng_;
  TsdfConfig config_;
  PinholeCamera camera_;
};

}  // namespace saccade::test
