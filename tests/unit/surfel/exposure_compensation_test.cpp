// SPDX-License-Identifier: Apache-2.0
// Exposure compensation: known gains come back, whatever is saturated; a camera at rest does not drift; frames that
// say nothing.
#include "saccade/surfel/exposure_compensation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "saccade/sensor/srgb.hpp"
#include "saccade/surfel/surfel_fusion.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

constexpr PinholeCamera kExposedCamera{160, 120, 131.25, 131.25, 79.5, 59.5, 0.3, 6.0};
constexpr PinholeCamera kSmallCamera{64, 48, 52.5, 52.5, 31.5, 23.5, 0.3, 6.0};

/// A wall of coloured squares in linear light, seen from the front with a gain; light from `sky_rows` rows saturates.
struct Wall {
  PinholeCamera camera{kExposedCamera};
  int sky_rows{0};
  double noise{0.0};  ///< standard deviation of the light

  [[nodiscard]] double light(int u, int v, std::size_t k) const {
    if (v < sky_rows) return 3.0;
    const auto square = static_cast<std::size_t>(u / 8 + 31 * (v / 8));
    return 0.03 + 0.37 * static_cast<double>((square * (7 + 4 * k) + 3 * k) % 17) / 16.0;
  }
  [[nodiscard]] Frame frame(double gain, unsigned seed = 1) const {
    std::mt19937 dice{seed};
    std::normal_distribution<double> normal{0.0, 1.0};
    Frame frame;
    frame.depth = DepthImage{camera.width, camera.height, 1.5F};
    frame.color = ColorImage{camera.width, camera.height};
    frame.T_world_camera = Pose::Identity();
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        for (std::size_t k = 0; k < 3; ++k) {
          const double seen = light(u, v, k) + (noise > 0.0 ? noise * normal(dice) : 0.0);
          const double encoded = srgb_of_linear(std::clamp(seen * gain, 0.0, 1.0));
          (*frame.color)(u, v)[k] = static_cast<std::uint8_t>(std::lround(encoded * 255.0));
        }
      }
    }
    return frame;
  }
};

struct CompensatedFusion {
  SurfelFusion fusion{SurfelFusion::create().value()};
  ExposureCompensation exposure{ExposureCompensation::create().value()};

  ExposureReport add(Frame& frame, const PinholeCamera& camera = kExposedCamera, const Executor& executor = {}) {
    return fusion.add_frame(frame, camera, exposure, executor).value().exposure.value();
  }
};

TEST(ExposureCompensation, KnownGainsComeBackWithinAPercent) {
  for (const int sky_rows : {0, 40}) {
    Wall wall;
    wall.sky_rows = sky_rows;
    wall.noise = 0.004;
    CompensatedFusion compensated;
    Frame first = wall.frame(1.0);
    const ColorImage before = *first.color;
    EXPECT_FALSE(compensated.add(first).estimated) << "there is no model yet";
    EXPECT_EQ(*first.color, before) << "the first frame is the anchor";
    unsigned seed{2};
    for (const double gain : {1.3, 0.7, 1.0, 1.9, 0.5, 1.004, 2.4}) {
      Frame frame = wall.frame(gain, seed++);
      const ExposureReport report = compensated.add(frame);
      EXPECT_TRUE(report.estimated) << gain;
      EXPECT_NEAR(report.gain / gain, 1.0, 0.01) << gain << ", rows of sky: " << sky_rows;
      EXPECT_GT(report.samples, 1000.0);
      EXPECT_GT(report.agreement, 0.8);
    }
  }
}

TEST(ExposureCompensation, CorrectedFramesLookLikeTheFirst) {
  const Wall wall;
  CompensatedFusion compensated;
  Frame first = wall.frame(1.0);
  compensated.add(first);
  for (const double gain : {1.5, 0.6}) {
    Frame frame = wall.frame(gain);
    compensated.add(frame);
    double sum{0.0};
    for (std::size_t i = 0; i < frame.color->size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const int difference = frame.color->data()[i][k] - first.color->data()[i][k];
        ASSERT_LE(std::abs(difference), 2) << gain << ", pixel " << i;
        sum += difference;
      }
    }
    EXPECT_LT(std::abs(sum) / static_cast<double>(3 * frame.color->size()), 0.5) << gain;
  }
}

/// Surfaces saturated in a brighter frame keep their colour.
TEST(ExposureCompensation, SaturatedPixelsTakeTheirSurfelsColourIfItIsBrighter) {
  const Wall wall;
  CompensatedFusion compensated;
  Frame first = wall.frame(2.0);
  compensated.add(first);
  Frame brighter = wall.frame(4.5);
  EXPECT_NEAR(compensated.add(brighter).gain, 2.25, 0.02);
  std::size_t saturated{0};
  const ColorImage raw = *wall.frame(4.5).color;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (raw.data()[i][k] < 255) continue;
      ++saturated;
      ASSERT_NEAR(brighter.color->data()[i][k], first.color->data()[i][k], 2) << i;
    }
  }
  EXPECT_GT(saturated, 10000U);
}

TEST(ExposureCompensation, ACameraAtRestDoesNotDrift) {
  Wall wall;
  wall.camera = kSmallCamera;
  wall.noise = 0.006;
  CompensatedFusion compensated;
  const int frames = test::kSanitized ? 200 : 2000;
  double worst{0.0};
  for (int i = 0; i < frames; ++i) {
    const double gain = 1.0 + 0.4 * std::sin(0.05 * i);
    Frame frame = wall.frame(gain, static_cast<unsigned>(i + 1));
    const ExposureReport report = compensated.add(frame, kSmallCamera);
    worst = std::max(worst, std::abs(report.gain / gain - 1.0));
  }
  EXPECT_LT(worst, 0.03) << "of any single frame, of 576 noisy values";
  double sum{0.0};
  const SurfelMap& map = compensated.fusion.map();
  ASSERT_EQ(map.size(), wall.frame(1.0).depth.size());
  const Frame exact = Wall{kSmallCamera}.frame(1.0);
  for (int v = 0; v < kSmallCamera.height; ++v) {
    for (int u = 0; u < kSmallCamera.width; ++u) {
      const SurfelId id = compensated.fusion.association().of_pixel(u, v);
      sum += double{map.colors[id].color.sum() - unit_color((*exact.color)(u, v)).sum()} / 3.0;
    }
  }
  EXPECT_LT(std::abs(sum) / static_cast<double>(map.size()), 0.004) << "one level of 255";
}

TEST(ExposureCompensation, WithoutOverlapTheGainStaysAsItWas) {
  const Wall wall;
  CompensatedFusion compensated;
  Frame first = wall.frame(1.0);
  compensated.add(first);
  Frame second = wall.frame(1.4);
  const double gain = compensated.add(second).gain;
  EXPECT_NEAR(gain, 1.4, 0.014);
  Frame elsewhere = wall.frame(0.8);
  elsewhere.T_world_camera->translation().x() = 10.0;
  const ExposureReport report = compensated.add(elsewhere);
  EXPECT_FALSE(report.estimated);
  EXPECT_EQ(report.samples, 0.0);
  EXPECT_EQ(report.gain, gain);
  Frame other = wall.frame(1.0);
  for (std::size_t i = 0; i < other.color->size(); ++i) {
    Rgb8& color = other.color->data()[i];
    color = {color[1], 255, static_cast<std::uint8_t>(255 - color[0])};
  }
  const ExposureReport repainted = compensated.add(other);
  EXPECT_TRUE(!repainted.estimated || repainted.agreement < 0.7) << repainted.gain;
}

TEST(ExposureCompensation, FramesWithoutColourSayNothingAndChangeNothing) {
  const Wall wall;
  CompensatedFusion compensated;
  Frame first = wall.frame(1.0);
  first.color.reset();
  const SurfelFusionReport report =
      compensated.fusion.add_frame(first, kExposedCamera, compensated.exposure, {}).value();
  EXPECT_FALSE(report.has_color);
  EXPECT_FALSE(report.exposure);
  Frame anchor = wall.frame(1.5);
  EXPECT_EQ(compensated.add(anchor).gain, 1.0) << "the first with colour is the anchor";
  Frame next = wall.frame(1.0);
  EXPECT_NEAR(compensated.add(next).gain, 1.0 / 1.5, 0.007);
}

TEST(ExposureCompensation, ThreadsChangeNoBit) {
  Wall wall;
  wall.noise = 0.01;
  const auto colors = [&](std::size_t threads) {
    CompensatedFusion compensated;
    const Executor executor = Executor::with_threads(threads);
    std::vector<std::uint8_t> bytes;
    unsigned seed{1};
    for (const double gain : {1.0, 1.3, 0.8, 1.1}) {
      Frame frame = wall.frame(gain, seed++);
      const double found = compensated.add(frame, kExposedCamera, executor).gain;
      const auto* data = reinterpret_cast<const std::uint8_t*>(&found);
      bytes.insert(bytes.end(), data, data + sizeof(found));
      for (const Rgb8& color : frame.color->pixels()) bytes.insert(bytes.end(), color.begin(), color.end());
    }
    return bytes;
  };
  const auto one = colors(1);
  EXPECT_GT(one.size(), 4U * 160U * 120U * 3U);
  EXPECT_EQ(one, colors(2));
  EXPECT_EQ(one, colors(7));
}

TEST(ExposureCompensation, BadParametersAreRefused) {
  const auto refused = [](auto change) {
    ExposureCompensationConfig config;
    change(config);
    return !config.validate().ok() && !ExposureCompensation::create(config);
  };
  EXPECT_TRUE(refused([](auto& config) { config.step_px = 0; }));
  EXPECT_TRUE(refused([](auto& config) { config.min_samples = 0.0; }));
  EXPECT_TRUE(refused([](auto& config) { config.brightest = config.darkest; }));
  EXPECT_TRUE(refused([](auto& config) { config.brightest = 1.0; }));
  EXPECT_TRUE(refused([](auto& config) { config.outlier_color = std::nan(""); }));
  EXPECT_TRUE(refused([](auto& config) { config.min_agreement = 0.0; }));
  EXPECT_TRUE(refused([](auto& config) { config.settled_weight = -1.0; }));
  EXPECT_TRUE(refused([](auto& config) { config.max_gain = 1.0; }));
}

}  // namespace
}  // namespace saccade
