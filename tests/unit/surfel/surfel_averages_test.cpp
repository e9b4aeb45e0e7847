// SPDX-License-Identifier: Apache-2.0
// The index image and the averages of surfel fusion, which are made in vectors, against plain loops that say the same
// surfel by surfel: the same bits, for every instruction set.
#include "saccade/surfel/internal/surfel_averages.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "saccade/core/simd.hpp"
#include "saccade/sensor/analytic_scene.hpp"
#include "saccade/surfel/mode_filter.hpp"
#include "saccade/surfel/surfel_fusion.hpp"

namespace saccade {
namespace {

/// No multiple of any vector.
constexpr PinholeCamera kOddCamera{157, 119, 131.25, 129.5, 77.5, 59.0, 0.3, 6.0};

/// Every third without colour; the poses come nearer, so that pixels share surfels, and the other way round.
std::vector<Frame> odd_frames() {
  std::vector<Frame> frames;
  const std::vector<Pose> poses = sample_trajectory(60);
  for (std::size_t i = 0; i < 9; ++i) {
    Pose T_world_camera = poses[i];
    T_world_camera.translate(Eigen::Vector3d{0.0, 0.0, i % 2 == 0 ? 0.0 : 0.12});
    RenderedFrame seen = render(sample_tabletop(), kOddCamera, T_world_camera).value();
    Frame& frame = frames.emplace_back();
    frame.depth = std::move(seen.depth);
    if (i % 3 != 2) frame.color = std::move(seen.color);
    frame.T_world_camera = T_world_camera;
  }
  return frames;
}

struct AveragesTargetGuard {
  AveragesTargetGuard() = default;
  AveragesTargetGuard(const AveragesTargetGuard&) = delete;
  AveragesTargetGuard& operator=(const AveragesTargetGuard&) = delete;
  ~AveragesTargetGuard() { static_cast<void>(use_simd_target("")); }
};

/// Eq. 4.1 for one pixel.
void average_plainly(const Frame& frame, const PointImage& points, const SurfelAssociation& seen, int u, int v,
                     const SurfelFusionConfig& config, Surfel& surfel) {
  const BackProjection back_project{seen};
  const auto focal = static_cast<float>(std::sqrt(seen.camera.fx * seen.camera.fy));
  const float w = seen.weight(u, v);
  const float z = points.z(u, v);
  const Eigen::Vector3f n_camera{points.nx(u, v), points.ny(u, v), points.nz(u, v)};
  const Eigen::Vector3f n = back_project.R_world_camera * n_camera;
  const Eigen::Vector3f p = back_project(u, v, z);
  const float slope = std::max(std::abs(n_camera.z()), static_cast<float>(1.0 / config.max_stretch));
  const float radius_m =
      std::min(std::numbers::sqrt2_v<float> * z / focal / slope, static_cast<float>(config.max_radius_m));
  SurfelDisc& disc = surfel.disc;
  if (frame.color) {
    SurfelColor& color = surfel.color;
    color.color = weighted_mean(color.color, color.weight, unit_color((*frame.color)(u, v)), w);
    color.weight += w;
  }
  if (disc.weight > 0.0F) {
    disc.position_m = weighted_mean(disc.position_m, disc.weight, p, w);
    disc.normal = weighted_mean(disc.normal, disc.weight, n, w).normalized();
    if (radius_m < 1.5F * disc.radius_m) disc.radius_m += (radius_m - disc.radius_m) * (w / (disc.weight + w));
  } else {
    disc.position_m = p;
    disc.normal = n;
    disc.radius_m = radius_m;
  }
  disc.weight += w;
}

/// Which surfel fills each cell.
std::vector<SurfelId> fill_plainly(const SurfelMap& map, std::size_t surfels, const PointImage& points,
                                   const SurfelAssociation& seen) {
  std::vector<SurfelId> filled(seen.of_cell.size(), kNoSurfel);
  std::vector<float> least(filled.size());
  const Eigen::Matrix3f R_camera_world = seen.T_world_camera.linear().transpose().cast<float>();
  const Eigen::Vector3f center = seen.T_world_camera.translation().cast<float>();
  for (SurfelId id = 0; id < surfels; ++id) {
    const Eigen::Vector3f p = map.discs[id].position_m - center;
    const Eigen::Vector3f p_camera = R_camera_world * p;
    if (!(p_camera.z() > 0.0F) || map.discs[id].normal.dot(p) >= 0.0F) continue;
    const float inverse_z = 1.0F / p_camera.z();
    const auto column = [&](float along, double focal, double middle) {
      return std::floor(along * inverse_z * static_cast<float>(focal) + static_cast<float>(middle) + 0.5F);
    };
    const float u = column(p_camera.x(), seen.camera.fx, seen.camera.cx);
    const float v = column(p_camera.y(), seen.camera.fy, seen.camera.cy);
    if (!(u >= 0.0F && u < 157.0F && v >= 0.0F && v < 119.0F)) continue;
    const auto cell = static_cast<std::size_t>(v) * 157 + static_cast<std::size_t>(u);
    const float measured = points.z.data()[cell];
    const float off = measured > 0.0F ? std::abs(p_camera.z() - measured) : p_camera.z();
    if (filled[cell] == kNoSurfel || off < least[cell]) {
      filled[cell] = id;
      least[cell] = off;
    }
  }
  return filled;
}

/// Fuses frames as SurfelFusion does, in plain loops beside it.
void expect_plain_averages(const SurfelFusionConfig& config, const std::string& name) {
  SurfelFusion fusion = SurfelFusion::create(config).value();
  std::vector<Surfel> plain;
  std::size_t shared{0};
  for (const Frame& frame : odd_frames()) {
    const SurfelMap before = fusion.map();
    ASSERT_TRUE(fusion.add_frame(frame, kOddCamera, {}));
    const SurfelAssociation& seen = fusion.association();
    const PointImage points = to_points(frame.depth, kOddCamera, {});
    ASSERT_EQ(seen.of_cell.pixels(), fill_plainly(before, before.size(), points, seen)) << name;
    plain.resize(fusion.map().size(), Surfel{{Eigen::Vector3f::Zero(), 0.0F, Eigen::Vector3f::Zero(), 0.0F},
                                             {Eigen::Vector3f::Zero(), 0.0F}});
    std::vector<int> pixels_of(plain.size());
    for (int v = 0; v < kOddCamera.height; ++v) {
      for (int u = 0; u < kOddCamera.width; ++u) {
        const SurfelId id = seen.of_pixel(u, v);
        if (id == kNoSurfel) continue;
        average_plainly(frame, points, seen, u, v, config, plain[id]);
        shared += ++pixels_of[id] > 1 ? 1U : 0U;
      }
    }
    for (SurfelId id = 0; id < plain.size(); ++id) {
      const Surfel fused = fusion.map().surfel(id);
      ASSERT_EQ(std::memcmp(&fused, &plain[id], sizeof fused), 0) << name << ", surfel " << id;
    }
  }
  EXPECT_GT(plain.size(), 10000U);
  EXPECT_GT(shared, 5000U);
}

TEST(SurfelAverages, EqualPlainLoopsToTheBit) {
  const AveragesTargetGuard guard;
  for (const std::string& target : simd_targets()) {
    ASSERT_TRUE(use_simd_target(target).ok());
    SurfelFusionConfig config;
    config.max_radius_m = 0.02;  // some are as large
    expect_plain_averages(config, target);
    config.max_stretch = 1.5;  // most are not
    expect_plain_averages(config, target + ", little stretch");
  }
}

TEST(SurfelAverages, RoundsHaveEachPixelOnceWithItsSurfel) {
  SurfelFusion fusion = SurfelFusion::create().value();
  std::size_t rounds{0};
  for (const Frame& frame : odd_frames()) {
    ASSERT_TRUE(fusion.add_frame(frame, kOddCamera, {}));
    const SurfelAssociation& seen = fusion.association();
    std::map<SurfelId, std::vector<int>> wanted;
    for (int i = 0; i < kOddCamera.width * kOddCamera.height; ++i) {
      const SurfelId id = seen.of_pixel.data()[i];
      if (id != kNoSurfel) wanted[id].push_back(i);
    }
    std::map<SurfelId, std::vector<int>> visited;
    std::map<SurfelId, std::size_t> group_of;
    for (std::size_t g = 0; g < seen.groups.size(); ++g) {
      for (std::size_t k = 0; k < seen.groups[g].size(); ++k) {
        if (!seen.groups[g][k].empty()) rounds = std::max(rounds, k + 1);
        for (const SurfelPixel& pixel : seen.groups[g][k]) {
          ASSERT_EQ(visited[pixel.id].size(), k);  // once in each round, and in none after one without it
          ASSERT_EQ(group_of.emplace(pixel.id, g).first->second, g);
          visited[pixel.id].push_back(pixel.v * kOddCamera.width + pixel.u);
        }
      }
    }
    EXPECT_EQ(visited, wanted);  // row by row, too
  }
  EXPECT_GE(rounds, 4U);
}

/// Smaller than a vector, just larger, and with depths and poses that no camera gives: nothing beyond the images is
/// touched, and each surfel that was made is where a pixel was.
TEST(SurfelAverages, TakeImagesOfAnySizeAndDepthsOfAnyValue) {
  const AveragesTargetGuard guard;
  constexpr std::array kDepths{1.0F,
                               1.002F,
                               0.0F,
                               -1.0F,
                               1e-30F,
                               1e30F,
                               std::numeric_limits<float>::quiet_NaN(),
                               std::numeric_limits<float>::infinity()};
  std::mt19937 random{3};
  std::size_t made{0};
  for (const std::string& target : simd_targets()) {
    ASSERT_TRUE(use_simd_target(target).ok());
    for (const auto& [width, height] :
         std::vector<std::pair<int, int>>{{1, 1}, {3, 1}, {1, 5}, {9, 7}, {17, 9}, {65, 6}}) {
      const PinholeCamera camera{width, height, 40.0, 40.0, 0.5 * (width - 1), 0.5 * (height - 1), 0.3, 6.0};
      SurfelFusion fusion = SurfelFusion::create().value();
      ModeFilter filter = ModeFilter::create().value();
      for (int f = 0; f < 12; ++f) {
        Frame frame;
        frame.depth = DepthImage{width, height, 1.0F};
        frame.color = ColorImage{width, height};
        for (float& depth_m : std::span{frame.depth.data(), frame.depth.size()}) {
          if (random() % 8 == 0) depth_m = kDepths[random() % kDepths.size()];
        }
        for (Rgb8& color : std::span{frame.color->data(), frame.color->size()}) {
          color = {static_cast<std::uint8_t>(random()), 0, 255};
        }
        const double far_m = f % 4 == 3 ? 1e30 : 0.001 * f;
        frame.T_world_camera = Pose{Eigen::Translation3d{0.001 * f, far_m, 0.0}};
        ASSERT_TRUE(fusion.add_frame(frame, camera, Executor::with_threads(2)));
        ASSERT_TRUE(filter.add_frame(frame, fusion.association(), Executor::with_threads(2)));
      }
      ASSERT_EQ(filter.size(), fusion.map().size());
      for (const SurfelDisc& disc : fusion.map().discs) {
        ASSERT_TRUE(disc.position_m.allFinite());
        ASSERT_NEAR(disc.normal.norm(), 1.0F, 1e-4F);
        ASSERT_GT(disc.weight, 0.0F);
      }
      made += fusion.map().size();
    }
  }
  EXPECT_GT(made, 1000U);
}

}  // namespace
}  // namespace saccade
