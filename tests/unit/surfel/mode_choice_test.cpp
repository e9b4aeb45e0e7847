// SPDX-License-Identifier: Apache-2.0
// Final colour of a surfel: the heaviest mode, or where modes are densest.
#include "saccade/surfel/internal/mode_choice.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace saccade {
namespace {

constexpr double kBandwidth{0.02};

TEST(ModeChoice, OfNoModesIsNothingAndOfOneThatOne) {
  EXPECT_EQ(heaviest_mode({}).weight, 0.0F);
  EXPECT_EQ(densest_mode({}, kBandwidth).weight, 0.0F);
  const std::vector<SurfelMode> one{{{0.2F, 0.4F, 0.6F}, {1.0F, 2.0F, 3.0F}, 5.0F}};
  for (const SurfelMode& mode : {heaviest_mode(one), densest_mode(one, kBandwidth)}) {
    EXPECT_EQ(mode.color, one[0].color);
    EXPECT_EQ(mode.position_m, one[0].position_m);
    EXPECT_EQ(mode.weight, one[0].weight);
  }
}

/// Noise made three modes of one grey, each lighter than that of the other side of the edge.
TEST(ModeChoice, ModesOfOneColourCountTogether) {
  const std::vector<SurfelMode> modes{{{0.50F, 0.50F, 0.50F}, {0.0F, 0.0F, 1.00F}, 3.0F},
                                      {{0.90F, 0.10F, 0.10F}, {0.0F, 0.0F, 1.04F}, 4.0F},
                                      {{0.52F, 0.50F, 0.50F}, {0.0F, 0.0F, 1.00F}, 3.0F},
                                      {{0.48F, 0.50F, 0.50F}, {0.0F, 0.0F, 1.00F}, 3.0F}};
  EXPECT_EQ(heaviest_mode(modes).color, modes[1].color);
  const SurfelMode densest = densest_mode(modes, kBandwidth);
  EXPECT_LT((densest.color - modes[0].color).norm(), 1e-4F);
  EXPECT_NEAR(densest.position_m.z(), (9.0 * 1.00 + 4.0 * 1.04) / 13.0, 1e-6) << "the mean over all modes";
  EXPECT_GT(densest.weight, 6.0F);
  EXPECT_LT(densest.weight, 9.0F);
}

/// A large enough Gaussian sees all modes alike, and a small one only the heaviest.
TEST(ModeChoice, BandwidthLeadsFromTheHeaviestToTheMean) {
  std::mt19937_64 random{7};
  const auto number = [&random] { return std::uniform_real_distribution<float>{0.0F, 1.0F}(random); };
  for (int i = 0; i < 200; ++i) {
    std::vector<SurfelMode> modes(2 + random() % 9);
    Eigen::Vector3f mean{Eigen::Vector3f::Zero()};
    float sum{0.0F};
    for (SurfelMode& mode : modes) {
      for (float* value : {&mode.color.x(), &mode.color.y(), &mode.color.z()}) *value = number();
      mode.weight = 0.1F + number();
      mean += mode.weight * mode.color;
      sum += mode.weight;
    }
    EXPECT_LT((densest_mode(modes, 1000.0).color - mean / sum).norm(), 1e-4F);
    EXPECT_LT((densest_mode(modes, 1e-4).color - heaviest_mode(modes).color).norm(), 1e-4F);
  }
}

/// Where mean shift ends, the density has a maximum: it is less all around.
TEST(ModeChoice, EndsAtAMaximumOfTheDensity) {
  std::mt19937_64 random{8};
  std::normal_distribution<float> noise{0.0F, 0.015F};
  for (int i = 0; i < 100; ++i) {
    std::vector<SurfelMode> modes(8);
    for (std::size_t k = 0; k < modes.size(); ++k) {
      const float base = k % 2 == 0 ? 0.3F : 0.5F;
      modes[k].color = {base + noise(random), base + noise(random), base + noise(random)};
      modes[k].weight = 1.0F + static_cast<float>(random() % 100) / 100.0F;
    }
    const auto density = [&modes](const Eigen::Vector3f& at) {
      double sum{0.0};
      for (const SurfelMode& mode : modes) {
        sum +=
            double{mode.weight} * std::exp(-double{(mode.color - at).squaredNorm()} / (2.0 * kBandwidth * kBandwidth));
      }
      return sum;
    };
    const SurfelMode densest = densest_mode(modes, kBandwidth);
    const double there = density(densest.color);
    EXPECT_NEAR(densest.weight, there, 1e-3 * there);
    for (int axis = 0; axis < 3; ++axis) {
      for (const float step : {-0.01F, 0.01F}) {
        Eigen::Vector3f beside = densest.color;
        beside[axis] += step;
        EXPECT_LT(density(beside), there);
      }
    }
  }
}

}  // namespace
}  // namespace saccade
