// SPDX-License-Identifier: Apache-2.0
// Surfel fusion: the surface it finds, a camera at rest, thread counts, and frames that cannot be fused.
#include "saccade/surfel/surfel_fusion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <limits>
#include <optional>
#include <random>
#include <string>

#include "saccade/core/simd.hpp"
#include "saccade/sensor/analytic_scene.hpp"
#include "saccade/surfel/mode_filter.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

constexpr PinholeCamera kSurfelCamera{160, 120, 131.25, 131.25, 79.5, 59.5, 0.3, 6.0};

std::vector<Frame> table_frames(std::size_t count) {
  std::vector<Frame> frames;
  const std::vector<Pose> poses = sample_trajectory(60);
  for (std::size_t i = 0; i < count; ++i) {
    RenderedFrame seen = render(sample_tabletop(), kSurfelCamera, poses[i]).value();
    Frame frame;
    frame.depth = std::move(seen.depth);
    frame.color = std::move(seen.color);
    frame.T_world_camera = poses[i];
    frames.push_back(std::move(frame));
  }
  return frames;
}

bool same_bits(const SurfelMap& a, const SurfelMap& b) {
  static_assert(sizeof(SurfelDisc) == 32 && sizeof(SurfelColor) == 16);  // no padding
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0;
  };
  return same(a.discs, b.discs) && same(a.colors, b.colors);
}

TEST(SurfelFusion, SurfelsLieOnTheSurface) {
  SurfelFusion fusion = SurfelFusion::create().value();
  std::size_t created{0};
  std::size_t associated{0};
  for (const Frame& frame : table_frames(8)) {
    const SurfelFusionReport report = fusion.add_frame(frame, kSurfelCamera, {}).value();
    EXPECT_TRUE(report.has_color);
    EXPECT_EQ(fusion.association().surfels, fusion.map().size());
    created += report.created;
    associated += report.associated;
  }
  ASSERT_EQ(fusion.map().size(), created);
  EXPECT_GT(created, 10000U);
  EXPECT_GT(associated, 4 * created);
  const AnalyticScene scene = sample_tabletop();
  std::size_t near{0};
  for (SurfelId id = 0; id < fusion.map().size(); ++id) {
    const Surfel surfel = fusion.map().surfel(id);
    EXPECT_NEAR(surfel.disc.normal.norm(), 1.0F, 1e-5F);
    EXPECT_GT(surfel.disc.weight, 0.0F);
    near += std::abs(scene.signed_distance_m(surfel.disc.position_m.cast<double>())) < 0.003 ? 1U : 0U;
  }
  EXPECT_GT(near, fusion.map().size() * 95 / 100);
}

TEST(SurfelFusion, ThreadsChangeNoBit) {
  const std::vector<Frame> frames = table_frames(4);
  const auto fused = [&](std::size_t threads) {
    SurfelFusion fusion = SurfelFusion::create().value();
    const Executor executor = Executor::with_threads(threads);
    for (const Frame& frame : frames) EXPECT_TRUE(fusion.add_frame(frame, kSurfelCamera, executor));
    return fusion;
  };
  const SurfelFusion one = fused(1);
  ASSERT_GT(one.map().size(), 10000U);
  for (const std::size_t threads : {2U, 7U}) {
    const SurfelFusion other = fused(threads);
    EXPECT_TRUE(same_bits(one.map(), other.map())) << threads;
    EXPECT_EQ(one.association().of_pixel, other.association().of_pixel) << threads;
  }
}

struct FusionTargetGuard {
  FusionTargetGuard() = default;
  FusionTargetGuard(const FusionTargetGuard&) = delete;
  FusionTargetGuard& operator=(const FusionTargetGuard&) = delete;
  ~FusionTargetGuard() { static_cast<void>(use_simd_target("")); }
};

TEST(SurfelFusion, InstructionSetsChangeNoBit) {
  const FusionTargetGuard guard;
  const std::vector<Frame> frames = table_frames(3);
  std::optional<SurfelFusion> first;
  for (const std::string& target : simd_targets()) {
    ASSERT_TRUE(use_simd_target(target).ok());
    SurfelFusion fusion = SurfelFusion::create().value();
    for (const Frame& frame : frames) ASSERT_TRUE(fusion.add_frame(frame, kSurfelCamera, {}));
    if (!first)
      first = std::move(fusion);
    else
      EXPECT_TRUE(same_bits(first->map(), fusion.map())) << target;
  }
  EXPECT_GT(first.value().map().size(), 10000U);
}

/// Checks of a pixel that saw a surfel, or made one.
TEST(SurfelFusion, PixelsSeeWhatFillsTheirCellOrCoversTheirRay) {
  SurfelFusion fusion = SurfelFusion::create().value();
  SurfelMap before;
  std::size_t own{0};
  std::size_t around{0};
  for (const Frame& frame : table_frames(5)) {
    ASSERT_TRUE(fusion.add_frame(frame, kSurfelCamera, {}));
    const SurfelAssociation& seen = fusion.association();
    const PointImage points = to_points(frame.depth, kSurfelCamera, {});
    const Pose T_camera_world = frame.T_world_camera->inverse();
    for (int v = 0; v < kSurfelCamera.height; ++v) {
      for (int u = 0; u < kSurfelCamera.width; ++u) {
        const SurfelId id = seen.of_pixel(u, v);
        if (id == kNoSurfel || id >= seen.first_new) continue;
        const double z = static_cast<double>(frame.depth(u, v));
        const Eigen::Vector3f n{points.nx(u, v), points.ny(u, v), points.nz(u, v)};
        const Eigen::Vector3f n_world = frame.T_world_camera->linear().cast<float>() * n;
        ASSERT_GE(n_world.dot(before.discs[id].normal), std::cos(0.8F) - 1e-5F);
        const Eigen::Vector3d p = T_camera_world * before.discs[id].position_m.cast<double>();
        ASSERT_LE(std::abs(p.z() - z), 0.02 + 0.005 * z * z + 1e-5);
        if (seen.of_cell(u, v) == id) {
          ++own;
        } else {
          ++around;
          const double beside = (p - kSurfelCamera.ray(u, v) * p.z()).norm();
          ASSERT_LE(beside, static_cast<double>(before.discs[id].radius_m) + 1e-5);
        }
      }
    }
    before = fusion.map();
  }
  EXPECT_GT(own, 30000U);
  EXPECT_GT(around, 1000U);
}

TEST(SurfelFusion, PixelsWeighAsInEquation42) {
  SurfelFusionConfig config;
  config.image_sigma = 0.2;
  SurfelFusion fusion = SurfelFusion::create(config).value();
  ASSERT_TRUE(fusion.add_frame(table_frames(1).front(), kSurfelCamera, {}));
  std::size_t compared{0};
  for (const int u : {0, 17, 80, 159}) {
    for (const int v : {0, 33, 60, 119}) {
      const double delta = (std::pow(u - 79.5, 2.0) + std::pow(v - 59.5, 2.0)) / (160.0 * 160.0 + 120.0 * 120.0);
      const double weight = std::exp(-delta / (2.0 * 0.2 * 0.2));
      ASSERT_NEAR(fusion.association().weight(u, v), weight, 1e-6);
      const SurfelId id = fusion.association().of_pixel(u, v);
      if (id == kNoSurfel) continue;
      ASSERT_NEAR(fusion.map().discs[id].weight, weight, 1e-6);
      ++compared;
    }
  }
  EXPECT_GT(compared, 4U);
}

/// Corners whose weight would be 0 are averaged like others.
TEST(SurfelFusion, NoWeightIsZero) {
  SurfelFusion fusion = SurfelFusion::create({.image_sigma = 0.01}).value();
  ModeFilter filter = ModeFilter::create().value();
  for (const Frame& frame : table_frames(3)) {
    ASSERT_TRUE(fusion.add_frame(frame, kSurfelCamera, {}));
    ASSERT_TRUE(filter.add_frame(frame, fusion.association(), {}));
  }
  ASSERT_GT(fusion.map().size(), 10000U);
  const std::vector<SurfelMode> winners = filter.winners({});
  for (SurfelId id = 0; id < fusion.map().size(); ++id) {
    const auto& [disc, color] = fusion.map().surfel(id);
    ASSERT_GT(disc.weight, 0.0F);
    ASSERT_TRUE(disc.position_m.allFinite() && disc.normal.allFinite() && color.color.allFinite()) << id;
    ASSERT_GT(winners[id].weight, 0.0F);
    ASSERT_TRUE(winners[id].color.allFinite()) << id;
  }
}

TEST(SurfelFusion, FewSurfelsTakeLittleMemoryToo) {
  SurfelFusion fusion = SurfelFusion::create().value();
  ModeFilter filter = ModeFilter::create().value();
  for (const Frame& frame : table_frames(2)) {
    ASSERT_TRUE(fusion.add_frame(frame, kSurfelCamera, {}));
    ASSERT_TRUE(filter.add_frame(frame, fusion.association(), {}));
  }
  const std::size_t surfels = fusion.map().size();
  ASSERT_GT(surfels, 10000U);
  ASSERT_LT(surfels, 30000U);
  EXPECT_LT(double(fusion.map().memory_bytes() + filter.memory_bytes()) / double(surfels), 305.0);
}

TEST(SurfelFusion, AnotherNormalAtTheSameDepthChangesNothing) {
  SurfelFusion fusion = SurfelFusion::create().value();
  Frame frame;
  frame.depth = DepthImage{kSurfelCamera.width, kSurfelCamera.height, 1.0F};
  frame.T_world_camera = Pose::Identity();
  ASSERT_GT(fusion.add_frame(frame, kSurfelCamera, {}).value().created, 19000U);
  for (int v = 0; v < kSurfelCamera.height; ++v) {
    for (int u = 0; u < kSurfelCamera.width; ++u) {  // a wall at more than 50° through the middle column
      frame.depth(u, v) = 1.0F / (1.0F - 1.2F * static_cast<float>((u - 79.5) / 131.25));
    }
  }
  const SurfelMap before = fusion.map();
  const SurfelFusionReport report = fusion.add_frame(frame, kSurfelCamera, {}).value();
  EXPECT_GT(report.contradicted, 200U);
  const SurfelId middle = fusion.association().of_cell(80, 60);
  ASSERT_NE(middle, kNoSurfel);
  EXPECT_EQ(fusion.association().of_pixel(80, 60), kNoSurfel);
  EXPECT_EQ(fusion.map().discs[middle].weight, before.discs[middle].weight);
  EXPECT_EQ(report.associated, 0U);
}

TEST(SurfelFusion, ACameraAtRestAddsNothing) {
  const Frame frame = table_frames(1).front();
  SurfelFusion fusion = SurfelFusion::create().value();
  const std::size_t created = fusion.add_frame(frame, kSurfelCamera, {}).value().created;
  ASSERT_GT(created, 10000U);
  for (int i = 0; i < 5; ++i) {
    const SurfelFusionReport report = fusion.add_frame(frame, kSurfelCamera, {}).value();
    EXPECT_EQ(report.created, 0U);
    EXPECT_GE(report.associated, created);
  }
}

TEST(SurfelFusion, TwoSurfacesThatAreSeenByTurnsKeepASurfelEach) {
  SurfelFusion fusion = SurfelFusion::create().value();
  const auto seen = [&](float depth_m) {
    Frame frame;
    frame.depth = DepthImage{kSurfelCamera.width, kSurfelCamera.height, depth_m};
    frame.T_world_camera = Pose::Identity();
    return fusion.add_frame(frame, kSurfelCamera, {}).value();
  };
  constexpr std::size_t kPixels{160 * 120};
  EXPECT_EQ(seen(1.0F).created, kPixels);
  EXPECT_EQ(seen(2.0F).created, kPixels);
  for (const float depth_m : {1.0F, 2.0F, 2.0F, 1.0F}) EXPECT_EQ(seen(depth_m).associated, kPixels);
  EXPECT_EQ(fusion.map().size(), 2 * kPixels);
}

TEST(SurfelFusion, FromFarAwaySurfelsGrowNoLarger) {
  SurfelFusion fusion = SurfelFusion::create().value();
  const auto look = [&](float depth_m) {
    Frame frame;
    frame.depth = DepthImage{kSurfelCamera.width, kSurfelCamera.height, depth_m};
    frame.T_world_camera = Pose{Eigen::Translation3d{0.0, 0.0, 1.0 - static_cast<double>(depth_m)}};
    return fusion.add_frame(frame, kSurfelCamera, {}).value();
  };
  EXPECT_GT(look(1.0F).created, 19000U);
  const SurfelMap near = fusion.map();
  EXPECT_GT(look(2.5F).associated, 1000U);
  std::size_t seen_again{0};
  for (SurfelId id = 0; id < near.size(); ++id) {
    seen_again += fusion.map().discs[id].weight > near.discs[id].weight ? 1U : 0U;
    ASSERT_EQ(fusion.map().discs[id].radius_m, near.discs[id].radius_m);
  }
  EXPECT_GT(seen_again, 1000U);
}

TEST(SurfelFusion, FramesWithoutColourLeaveColoursAsTheyAre) {
  std::vector<Frame> frames = table_frames(2);
  frames.push_back(frames[1]);
  frames[1].color.reset();
  SurfelFusion fusion = SurfelFusion::create().value();
  EXPECT_TRUE(fusion.add_frame(frames[0], kSurfelCamera, {}).value().has_color);
  const SurfelMap first = fusion.map();
  EXPECT_FALSE(fusion.add_frame(frames[1], kSurfelCamera, {}).value().has_color);
  std::size_t seen_again{0};
  for (SurfelId id = 0; id < fusion.map().size(); ++id) {
    const Surfel now = fusion.map().surfel(id);
    const SurfelColor before = id < first.size() ? first.colors[id] : SurfelColor{Eigen::Vector3f::Zero(), 0.0F};
    ASSERT_EQ(now.color.color, before.color);
    ASSERT_EQ(now.color.weight, before.weight);
    if (id < first.size() && now.disc.weight > first.discs[id].weight) ++seen_again;
  }
  EXPECT_GT(seen_again, 5000U);
  EXPECT_GT(fusion.map().size(), first.size());
  const std::size_t second = fusion.map().size();
  ASSERT_TRUE(fusion.add_frame(frames[2], kSurfelCamera, {}));  // the same view, with colour
  std::size_t colored{0};
  for (std::size_t id = first.size(); id < second; ++id) {
    const Surfel now = fusion.map().surfel(static_cast<SurfelId>(id));
    ASSERT_LT(now.color.weight, now.disc.weight);
    if (now.color.weight > 0.0F) ++colored;
  }
  EXPECT_GT(colored, (second - first.size()) / 2);
}

/// A wall by turns at one and two metres, with noise of depth and colour.
std::vector<Frame> flickering_frames(const PinholeCamera& camera) {
  std::mt19937_64 random{3};
  std::vector<Frame> frames(16);
  for (Frame& frame : frames) {
    frame.depth = DepthImage{camera.width, camera.height, random() % 2 == 0 ? 1.0F : 2.0F};
    frame.color = ColorImage{camera.width, camera.height};
    for (std::size_t k = 0; k < frame.depth.size(); ++k) {
      frame.depth.data()[k] += 0.004F * (static_cast<float>(random() % 1000) / 1000.0F);
      const std::uint64_t bits = random();
      frame.color->data()[k] = {std::uint8_t(bits), std::uint8_t(bits >> 8U), std::uint8_t(bits >> 16U)};
    }
    frame.T_world_camera = Pose::Identity();
  }
  return frames;
}

/// Ten thousand frames; more under SACCADE_SURFEL_FRAMES.
TEST(SurfelFusion, FramesOfTheSameSpotDoNotGrow) {
  constexpr PinholeCamera kSmall{64, 48, 52.5, 52.5, 31.5, 23.5, 0.3, 6.0};
  constexpr std::size_t kPixels{64 * 48};
  const char* const asked = std::getenv("SACCADE_SURFEL_FRAMES");
  const auto frames =
      static_cast<std::size_t>(asked ? std::atoi(asked) : test::scaled_cases(10'000) / (test::kSanitized ? 10 : 1));
  const std::vector<Frame> wall = flickering_frames(kSmall);
  SurfelFusion fusion = SurfelFusion::create().value();
  ModeFilter filter = ModeFilter::create().value();
  std::mt19937_64 random{7};
  std::size_t early{0};
  std::size_t early_bytes{0};
  std::size_t done{0};
  for (; done < frames; ++done) {
    const Frame& frame = wall[random() % wall.size()];
    ASSERT_TRUE(fusion.add_frame(frame, kSmall, {}));
    ASSERT_TRUE(filter.add_frame(frame, fusion.association(), {}));
    if (done == frames / 10) {
      early = fusion.map().size();
      early_bytes = fusion.map().memory_bytes() + filter.memory_bytes();
    }
  }
  EXPECT_EQ(done, frames);
  EXPECT_GE(early, kPixels);
  EXPECT_LE(fusion.map().size(), 2 * kPixels);
  EXPECT_LE(fusion.map().size() - early, early / 100);
  EXPECT_EQ(fusion.map().memory_bytes() + filter.memory_bytes(), early_bytes);
  float heaviest{0.0F};
  for (SurfelId id = 0; id < filter.size(); ++id) {
    ASSERT_LE(filter.modes(id).size(), 10U);
    heaviest = std::max(heaviest, fusion.map().discs[id].weight);
  }
  EXPECT_GT(heaviest, 0.2F * static_cast<float>(frames));
  std::cout << "growth: " << frames << " frames of " << kPixels << " pixels: " << early << " surfels after a tenth, "
            << fusion.map().size() << " at the end; " << early_bytes << " bytes, with modes, both times\n";
}

TEST(SurfelFusion, SaysWhyAFrameCannotBeFused) {
  Frame good = table_frames(1).front();
  SurfelFusion fusion = SurfelFusion::create().value();
  Frame frame = good;
  frame.T_world_camera.reset();
  EXPECT_EQ(fusion.add_frame(frame, kSurfelCamera, {}).error().code, Errc::invalid_argument);
  frame.T_world_camera = Pose::Identity();
  frame.T_world_camera->translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(fusion.add_frame(frame, kSurfelCamera, {}).error().code, Errc::invalid_argument);
  frame = good;
  frame.color = ColorImage{80, 60};
  EXPECT_EQ(fusion.add_frame(frame, kSurfelCamera, {}).error().code, Errc::size_mismatch);
  frame = good;
  frame.depth = DepthImage{80, 60};
  EXPECT_EQ(fusion.add_frame(frame, kSurfelCamera, {}).error().code, Errc::size_mismatch);
  EXPECT_EQ(fusion.map().size(), 0U);
  SurfelFusionConfig config;
  config.image_sigma = 0.0;
  EXPECT_FALSE(SurfelFusion::create(config));
  config = {};
  config.max_stretch = 0.9;
  EXPECT_FALSE(SurfelFusion::create(config));
}

}  // namespace
}  // namespace saccade
