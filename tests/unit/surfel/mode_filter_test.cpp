// SPDX-License-Identifier: Apache-2.0
// The mode filter: equal to the average with K = ∞, weights kept, colours by turns, threads.
#include "saccade/surfel/mode_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>
#include <string>

#include "saccade/core/simd.hpp"
#include "saccade/surfel/surfel_fusion.hpp"
#include "support/naive_mode_filter.hpp"

namespace saccade {
namespace {

constexpr PinholeCamera kModeCamera{64, 48, 52.5, 52.5, 31.5, 23.5, 0.3, 6.0};
constexpr std::size_t kModePixels{64 * 48};

/// A wall that is seen with noise from a camera that sways; each pixel has one of two colours at random.
std::vector<Frame> wall_frames(int count, const std::vector<Rgb8>& colors, std::uint64_t seed) {
  std::mt19937_64 random{seed};
  std::vector<Frame> frames(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    Frame& frame = frames[i];
    frame.depth = DepthImage{kModeCamera.width, kModeCamera.height, 1.0F};
    frame.color = ColorImage{kModeCamera.width, kModeCamera.height};
    for (std::size_t k = 0; k < kModePixels; ++k) {
      frame.depth.data()[k] += 0.004F * (static_cast<float>(random() % 1000) / 1000.0F);
      frame.color->data()[k] = colors[random() % colors.size()];
    }
    frame.T_world_camera =
        Pose{Eigen::Translation3d{0.013 * static_cast<double>(i % 5), 0.007 * static_cast<double>(i % 3), 0.0}};
  }
  return frames;
}

struct Filtered {
  SurfelFusion fusion;
  ModeFilter filter;
  ModeFilterReport sum;
};

Filtered run(const std::vector<Frame>& frames, const ModeFilterConfig& config, std::size_t threads) {
  Filtered result{SurfelFusion::create().value(), ModeFilter::create(config).value(), {}};
  const Executor executor = Executor::with_threads(threads);
  for (const Frame& frame : frames) {
    EXPECT_TRUE(result.fusion.add_frame(frame, kModeCamera, executor));
    const ModeFilterReport report = result.filter.add_frame(frame, result.fusion.association(), executor).value();
    result.sum.pixels += report.pixels;
    result.sum.guided += report.guided;
    result.sum.new_modes += report.new_modes;
    result.sum.merged_modes += report.merged_modes;
    result.sum.evicted_modes += report.evicted_modes;
    result.sum.evicted_weight += report.evicted_weight;
  }
  return result;
}

TEST(ModeFilter, WithOneModeAndNoEnhancementIsTheAverage) {
  ModeFilterConfig config;
  config.color_sigmas = std::numeric_limits<double>::infinity();
  config.enhance_depth = false;
  const Filtered result = run(wall_frames(12, {{10, 20, 30}, {200, 180, 20}, {90, 90, 250}}, 5), config, 2);
  const std::vector<SurfelMode> winners = result.filter.winners({});
  ASSERT_EQ(winners.size(), result.fusion.map().size());
  ASSERT_GE(winners.size(), kModePixels);
  for (SurfelId id = 0; id < winners.size(); ++id) {
    const Surfel surfel = result.fusion.map().surfel(id);
    ASSERT_EQ(winners[id].weight, surfel.disc.weight) << id;  // the same sums: not even rounding differs
    ASSERT_EQ(winners[id].position_m, surfel.disc.position_m) << id;
    // Each mean is rounded to half a unit, and what was before counts less and less.
    ASSERT_LE((winners[id].color - surfel.color.color).cwiseAbs().maxCoeff(), 4.0F / (255.0F * 8192.0F)) << id;
  }
}

TEST(ModeFilter, ThreadsChangeNoBit) {
  const std::vector<Frame> frames = wall_frames(6, {{10, 20, 30}, {200, 180, 20}, {12, 22, 28}}, 7);
  const std::vector<SurfelMode> one = run(frames, {}, 1).filter.winners({});
  ASSERT_GE(one.size(), kModePixels);
  for (const std::size_t threads : {2U, 7U}) {
    const std::vector<SurfelMode> other = run(frames, {}, threads).filter.winners({});
    ASSERT_EQ(other.size(), one.size());
    EXPECT_EQ(std::memcmp(one.data(), other.data(), one.size() * sizeof(SurfelMode)), 0) << threads;
  }
}

struct FilterTargetGuard {
  FilterTargetGuard() = default;
  FilterTargetGuard(const FilterTargetGuard&) = delete;
  FilterTargetGuard& operator=(const FilterTargetGuard&) = delete;
  ~FilterTargetGuard() { static_cast<void>(use_simd_target("")); }
};

TEST(ModeFilter, InstructionSetsChangeNoBit) {
  const FilterTargetGuard guard;
  const std::vector<Frame> frames = wall_frames(6, {{10, 20, 30}, {200, 180, 20}, {12, 22, 28}}, 13);
  std::vector<SurfelMode> first;
  for (const std::string& target : simd_targets()) {
    ASSERT_TRUE(use_simd_target(target).ok());
    const std::vector<SurfelMode> winners = run(frames, {}, 1).filter.winners({});
    if (first.empty()) first = winners;
    ASSERT_EQ(winners.size(), first.size());
    EXPECT_EQ(std::memcmp(first.data(), winners.data(), first.size() * sizeof(SurfelMode)), 0) << target;
  }
  EXPECT_GE(first.size(), kModePixels);
}

TEST(ModeFilter, WeightsAreKeptButForEvictions) {
  std::vector<Rgb8> colors;
  for (int i = 0; i < 40; ++i) {  // a colour with its noise, and many far ones
    colors.push_back({static_cast<std::uint8_t>(100 + i % 10), 100, static_cast<std::uint8_t>(50 + i / 10)});
    if (i < 15) colors.push_back({static_cast<std::uint8_t>(15 * i), 200, 50});
  }
  ModeFilterConfig config;
  config.max_modes = 5;
  config.color_sigmas = 1.0;  // modes so near each other that some grow together
  const Filtered result = run(wall_frames(30, colors, 11), config, 2);
  EXPECT_GT(result.sum.guided, kModePixels);
  EXPECT_GT(result.sum.merged_modes, 10U);
  EXPECT_GT(result.sum.evicted_modes, 10U);
  double seen{0.0};
  double kept{0.0};
  for (SurfelId id = 0; id < result.filter.size(); ++id) {
    seen += static_cast<double>(result.fusion.map().discs[id].weight);
    const std::vector<SurfelMode> modes = result.filter.modes(id);
    ASSERT_LE(modes.size(), 5U);
    for (const SurfelMode& mode : modes) {
      ASSERT_GT(mode.weight, 0.0F);
      kept += static_cast<double>(mode.weight);
    }
  }
  EXPECT_NEAR(kept + result.sum.evicted_weight, seen, 1e-5 * seen);
}

TEST(ModeFilter, TheMoreFrequentColourWinsInAnyOrder) {
  for (const bool rare_first : {false, true}) {
    std::vector<Frame> frames = wall_frames(5, {{10, 20, 30}}, 3);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      frames[i].T_world_camera = Pose::Identity();
      const bool rare = rare_first ? i < 2 : i >= 3;
      if (rare) frames[i].color = ColorImage{kModeCamera.width, kModeCamera.height, {200, 100, 30}};
    }
    const Filtered result = run(frames, {}, 1);
    ASSERT_EQ(result.filter.size(), kModePixels);
    for (const SurfelMode& winner : result.filter.winners({})) {
      ASSERT_NEAR(winner.color.x(), 10.0F / 255.0F, 1e-6F);
    }
  }
}

TEST(ModeFilter, OfEqualWeightsTheFirstWins) {
  std::vector<Frame> frames = wall_frames(2, {{200, 20, 30}}, 3);
  frames[1].color = ColorImage{kModeCamera.width, kModeCamera.height, {10, 100, 30}};
  for (Frame& frame : frames) frame.T_world_camera = Pose::Identity();
  const Filtered result = run(frames, {}, 1);
  ASSERT_EQ(result.filter.modes(7).size(), 2U);
  for (const SurfelMode& winner : result.filter.winners({})) ASSERT_GT(winner.color.x(), 0.7F);
}

/// Random frames of a wall with noise of depth that the guided filter moves far, and of colours around three tones, so
/// far apart that no colour is as near to one as to another.
std::vector<Frame> far_frames(std::mt19937_64& random, int count) {
  std::vector<Frame> frames(static_cast<std::size_t>(count));
  for (Frame& frame : frames) {
    frame.depth = DepthImage{kModeCamera.width, kModeCamera.height, 0.8F};
    frame.color = ColorImage{kModeCamera.width, kModeCamera.height};
    for (std::size_t k = 0; k < frame.depth.size(); ++k) {
      frame.depth.data()[k] += 0.036F * (static_cast<float>(random() % 1000) / 1000.0F);
      const auto tone = static_cast<std::uint8_t>(60 + random() % 3 * 12 + random() % 5);
      frame.color->data()[k] = {tone, tone, 90};
    }
    frame.T_world_camera = Pose::Identity();
  }
  return frames;
}

/// Algorithm 6 and eq. 4.11 to the letter; and each departure from it gives other winners.
TEST(ModeFilter, WinnersAsPrintedAreThoseOfTheEquation) {
  std::mt19937_64 random{23};
  const std::vector<Frame> frames = far_frames(random, 9);
  const auto winners_of = [&](const ModeFilterConfig& config, test::NaiveModes* naive) {
    SurfelFusion fusion = SurfelFusion::create().value();
    ModeFilter filter = ModeFilter::create(config).value();
    for (const Frame& frame : frames) {
      EXPECT_TRUE(fusion.add_frame(frame, kModeCamera, {}));
      EXPECT_TRUE(filter.add_frame(frame, fusion.association(), {}));
      if (naive != nullptr) test::naive_mode_filter(*naive, frame, fusion.association(), config);
    }
    return filter.winners({});
  };
  test::NaiveModes naive;
  const std::vector<SurfelMode> printed = winners_of(ModeFilterConfig::as_printed(), &naive);
  ASSERT_EQ(printed.size(), naive.size());
  ASSERT_GT(printed.size(), 700U);
  std::size_t several{0};
  for (SurfelId id = 0; id < printed.size(); ++id) {
    const auto heaviest =
        std::max_element(naive[id].begin(), naive[id].end(), [](const auto& a, const auto& b) { return a.w < b.w; });
    several += naive[id].size() > 1 ? 1U : 0U;
    ASSERT_LE((printed[id].color.cast<double>() - heaviest->c / 255.0).norm(), 2e-6) << id;
    ASSERT_LE((printed[id].position_m.cast<double>() - heaviest->p).norm(), 2e-5)
        << id;  // moves of centimetres; guidance in floats
    ASSERT_EQ(printed[id].weight, heaviest->w) << id;
  }
  EXPECT_GT(several, 300U);

  const ModeFilterConfig ours;
  ModeFilterConfig densest = ModeFilterConfig::as_printed();
  densest.choice_sigmas = ours.choice_sigmas;
  ModeFilterConfig sharpened = densest;
  sharpened.sharpening.strength = ours.sharpening.strength;
  ModeFilterConfig limited = ModeFilterConfig::as_printed();
  limited.max_depth_change_m = ours.max_depth_change_m;
  ModeFilterConfig unguided = ModeFilterConfig::as_printed();
  unguided.enhance_depth = false;
  const auto differ = [](const std::vector<SurfelMode>& a, const std::vector<SurfelMode>& b) {
    std::size_t count{0};
    for (std::size_t i = 0; i < a.size(); ++i) {
      count += a[i].color != b[i].color || a[i].position_m != b[i].position_m ? 1U : 0U;
    }
    return count;
  };
  EXPECT_GT(differ(printed, winners_of(densest, nullptr)), 300U) << "decision 18";
  EXPECT_GT(differ(winners_of(densest, nullptr), winners_of(sharpened, nullptr)), 10U) << "decision 19";
  EXPECT_GT(differ(printed, winners_of(limited, nullptr)), 100U) << "decision 18, depths";
  EXPECT_GT(differ(printed, winners_of(unguided, nullptr)), 300U) << "decision 20";
}

TEST(ModeFilter, WithoutColourDoesNothingAndSaysSo) {
  Frame frame = wall_frames(1, {{1, 2, 3}}, 1).front();
  frame.color.reset();
  const Filtered result = run({frame}, {}, 1);
  EXPECT_EQ(result.sum.pixels, 0U);
  EXPECT_EQ(result.filter.winners({}).front().weight, 0.0F);
  ModeFilter filter = ModeFilter::create().value();
  frame.color = ColorImage{3, 3};
  EXPECT_EQ(filter.add_frame(frame, result.fusion.association(), {}).error().code, Errc::size_mismatch);
  ModeFilterConfig config;
  config.max_modes = 0;
  EXPECT_FALSE(ModeFilter::create(config));
}

}  // namespace
}  // namespace saccade
