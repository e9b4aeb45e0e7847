// SPDX-License-Identifier: Apache-2.0
// The mode filter against Algorithm 6 as it is printed, on random frames: equal modes in the same order.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <random>

#include "saccade/surfel/mode_filter.hpp"
#include "saccade/surfel/surfel_fusion.hpp"
#include "support/effort.hpp"
#include "support/naive_mode_filter.hpp"

namespace saccade {
namespace {

constexpr std::uint64_t kModeSeed{29};
constexpr PinholeCamera kNaiveCamera{32, 24, 26.25, 26.25, 15.5, 11.5, 0.3, 6.0};

TEST(ModeFilterProperty, EqualsAlgorithm6AsItIsPrinted) {
  const int cases = test::scaled_cases(24);
  std::printf("seed %llu, %d cases\n", static_cast<unsigned long long>(kModeSeed), cases);
  std::mt19937_64 random{kModeSeed};
  std::size_t compared{0};
  std::size_t several{0};
  std::size_t guided{0};
  std::size_t merged_modes{0};
  std::size_t evicted{0};
  for (int i = 0; i < cases; ++i) {
    ModeFilterConfig config;
    config.max_modes = i % 2 == 0 ? 4 : 1 + static_cast<int>(random() % 10);
    config.color_sigmas = i % 2 == 0 ? 1.0 : static_cast<double>(1 + random() % 6);
    config.enhance_depth = random() % 4 != 0;
    config.max_depth_change_m = i % 2 == 0 ? 0.001 : std::numeric_limits<double>::infinity();
    SurfelFusion fusion = SurfelFusion::create().value();
    ModeFilter filter = ModeFilter::create(config).value();
    test::NaiveModes naive;
    const Executor executor = Executor::with_threads(1 + random() % 3);
    for (int f = 0; f < 12; ++f) {
      Frame frame;
      frame.depth = DepthImage{kNaiveCamera.width, kNaiveCamera.height, 0.8F};
      frame.color = ColorImage{kNaiveCamera.width, kNaiveCamera.height};
      for (std::size_t k = 0; k < frame.depth.size(); ++k) {
        frame.depth.data()[k] += 0.006F * (static_cast<float>(random() % 1000) / 1000.0F);
        if (random() % 50 == 0) frame.depth.data()[k] = 0.0F;
        const auto base = static_cast<std::uint8_t>(random() % 3 * 60);
        // Near levels, the middle ones more often: modes that grow together.
        const std::uint64_t off = random() % 3 + random() % 3 + random() % 3;
        frame.color->data()[k] = {static_cast<std::uint8_t>(base + off), base, 90};
      }
      const double step = static_cast<double>(random() % 100) / 1000.0;
      frame.T_world_camera = Pose{Eigen::Translation3d{step, 0.3 * step, 2.0 * step}};
      ASSERT_TRUE(fusion.add_frame(frame, kNaiveCamera, executor));
      const auto report = filter.add_frame(frame, fusion.association(), executor);
      ASSERT_TRUE(report);
      guided += report->guided;
      merged_modes += report->merged_modes;
      evicted += report->evicted_modes;
      test::naive_mode_filter(naive, frame, fusion.association(), config);
    }
    for (SurfelId id = 0; id < filter.size(); ++id) {
      const std::vector<SurfelMode> ours = filter.modes(id);
      const std::vector<test::NaiveMode>& theirs = naive[id];
      ASSERT_EQ(ours.size(), theirs.size()) << "case " << i << ", surfel " << id;
      several += ours.size() > 1 ? 1U : 0U;
      for (std::size_t k = 0; k < ours.size(); ++k, ++compared) {
        ASSERT_LE((ours[k].color.cast<double>() - theirs[k].c / 255.0).norm(), 2e-6);
        ASSERT_LE((ours[k].position_m.cast<double>() - theirs[k].p).norm(), 2e-6);
        ASSERT_EQ(ours[k].weight, theirs[k].w);
      }
    }
  }
  EXPECT_GT(compared, static_cast<std::size_t>(cases) * 700U);
  EXPECT_GT(several, static_cast<std::size_t>(cases) * 200U);
  EXPECT_GT(guided, static_cast<std::size_t>(cases) * 500U);
  EXPECT_GT(merged_modes, static_cast<std::size_t>(cases));
  EXPECT_GT(evicted, 100U);
  std::printf("compared %zu modes; %zu pixels guided, %zu modes merged, %zu evicted\n", compared, guided, merged_modes,
              evicted);
}

/// Two colours farther apart than Kσ_c, in any order: the heavier wins.
TEST(ModeFilterProperty, TheOrderOfFarColoursDoesNotMatter) {
  const int cases = test::scaled_cases(60);
  std::mt19937_64 random{kModeSeed};
  std::size_t decided{0};
  for (int i = 0; i < cases; ++i) {
    ModeFilterConfig config;
    config.max_modes = 2 + static_cast<int>(random() % 9);
    const std::array<Rgb8, 2> colors{Rgb8{std::uint8_t(random() % 100), 20, 30}, Rgb8{200, std::uint8_t(random()), 90}};
    std::vector<std::size_t> order(3 + random() % 12);
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = random() % 2;
    const std::array<long, 2> times{std::count(order.begin(), order.end(), 0U),
                                    std::count(order.begin(), order.end(), 1U)};
    if (times[0] == times[1]) continue;
    const Rgb8& heavier = colors[times[1] > times[0] ? 1 : 0];
    for (int again = 0; again < 3; ++again) {
      std::shuffle(order.begin(), order.end(), random);
      SurfelFusion fusion = SurfelFusion::create().value();
      ModeFilter filter = ModeFilter::create(config).value();
      for (const std::size_t which : order) {
        Frame frame;
        frame.depth = DepthImage{kNaiveCamera.width, kNaiveCamera.height, 0.8F};
        frame.color = ColorImage{kNaiveCamera.width, kNaiveCamera.height, colors[which]};
        frame.T_world_camera = Pose::Identity();
        ASSERT_TRUE(fusion.add_frame(frame, kNaiveCamera, {}));
        ASSERT_EQ(filter.add_frame(frame, fusion.association(), {}).value().evicted_modes, 0U);
      }
      for (const SurfelMode& winner : filter.winners({})) {
        ASSERT_LE((winner.color - unit_color(heavier)).norm(), 1e-6F) << "case " << i;
        ++decided;
      }
    }
  }
  EXPECT_GT(decided, static_cast<std::size_t>(cases) * 1000U);
}

}  // namespace
}  // namespace saccade
