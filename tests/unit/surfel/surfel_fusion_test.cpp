// SPDX-License-Identifier: Apache-2.0
// Surfel fusion: the surface it finds, a camera at rest, thread counts, and frames that cannot be fused.
#include "saccade/surfel/surfel_fusion.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "saccade/sensor/analytic_scene.hpp"
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

TEST(SurfelFusion, FlickeringDepthsOnTheSameSpotStayBounded) {
  constexpr PinholeCamera kSmall{64, 48, 52.5, 52.5, 31.5, 23.5, 0.3, 6.0};
  const int frames = test::scaled_cases(2000);
  SurfelFusion fusion = SurfelFusion::create().value();
  std::mt19937_64 random{3};
  std::size_t halfway{0};
  for (int i = 0; i < frames; ++i) {
    Frame frame;
    frame.depth = DepthImage{kSmall.width, kSmall.height, random() % 2 == 0 ? 1.0F : 2.0F};
    for (int k = 0; k < 3072; ++k) frame.depth.data()[k] += 0.004F * (static_cast<float>(random() % 1000) / 1000.0F);
    frame.T_world_camera = Pose::Identity();
    const SurfelFusionReport report = fusion.add_frame(frame, kSmall, {}).value();
    EXPECT_FALSE(report.has_color);
    if (i == frames / 2) halfway = fusion.map().size();
  }
  EXPECT_LE(fusion.map().size(), 2U * 3072U);
  EXPECT_LE(fusion.map().size() - halfway, halfway / 100);
  EXPECT_EQ(fusion.map().surfel(0).color.weight, 0.0F);
}

TEST(SurfelFusion, SaysWhyAFrameCannotBeFused) {
  Frame good = table_frames(1).front();
  SurfelFusion fusion = SurfelFusion::create().value();
  Frame frame = good;
  frame.T_world_camera.reset();
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
}

}  // namespace
}  // namespace saccade
