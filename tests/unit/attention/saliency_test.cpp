// SPDX-License-Identifier: Apache-2.0
// Heuristics on a table with a ball, a book, a far wall and scraps.
#include "saccade/attention/saliency.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "saccade/cloud/point_cloud.hpp"

namespace saccade {
namespace {

enum Thing : std::uint32_t { kTable, kBall, kBook, kScrap, kThings };

/// Surface points of a table at z = 0.7, a ball that hovers over it, a flat book on it, and one point beside the book.
class Saliencies : public ::testing::Test {
 protected:
  void SetUp() override {
    for (int x = -50; x <= 50; ++x) {
      for (int y = -30; y <= 30; ++y) add({0.01 * x, 0.01 * y, 0.7}, kTable);
    }
    for (int i = 0; i < 600; ++i) {
      const double z = 1.0 - 2.0 * (i + 0.5) / 600.0;
      const double turn = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
      const double r = std::sqrt(1.0 - z * z);
      add(Eigen::Vector3d{0.2, 0.1, 0.9} + 0.06 * Eigen::Vector3d{r * std::cos(turn), r * std::sin(turn), z}, kBall);
    }
    for (int x = 0; x <= 20; ++x) {
      for (int y = 0; y <= 10; ++y) add({-0.3 + 0.01 * x, -0.2 + 0.01 * y, 0.73}, kBook);
    }
    add({-0.31, -0.2, 0.73}, kScrap);
    points_.emplace(SegmentedPoints::create(positions_m_, labels_, kThings).value());
    measures_ = measure_segments(*points_, config_, Executor{}).value();
  }
  void add(const Eigen::Vector3d& p, Thing thing) {
    positions_m_.push_back(p.cast<float>());
    labels_.push_back(thing);
  }
  [[nodiscard]] MeasuredSegments segments() const { return {*points_, measures_, config_}; }
  [[nodiscard]] std::vector<double> values(const SaliencyHeuristic& heuristic) const {
    std::vector<double> found;
    for (const Saliency& saliency : heuristic(segments())) {
      EXPECT_GE(saliency.value, 0.0);
      EXPECT_LE(saliency.value, 1.0);
      EXPECT_FALSE(saliency.why.empty());
      found.push_back(saliency.value);
    }
    EXPECT_EQ(found.size(), std::size_t{kThings});
    return found;
  }

  std::vector<Eigen::Vector3f> positions_m_;
  std::vector<std::uint32_t> labels_;
  std::optional<SegmentedPoints> points_;
  MeasureConfig config_;
  std::vector<SegmentMeasures> measures_;
};

TEST_F(Saliencies, ObjectnessIsRoundnessTimesIsolation) {
  const auto objects = values(objectness());
  const auto round = values(roundness_alone());
  const auto alone = values(isolation_alone());
  for (std::size_t s = 0; s < kThings; ++s) {
    EXPECT_EQ(objects[s], alone[s] * round[s]);
    EXPECT_EQ(round[s], measures_[s].roundness);
    EXPECT_EQ(alone[s], measures_[s].isolation);
  }
  EXPECT_GT(objects[kBall], 0.95);
  EXPECT_LT(objects[kTable], 0.02);
  EXPECT_EQ(objects[kScrap], 0.0);
  EXPECT_GT(alone[kBook], 0.9);
  EXPECT_EQ(alone[kScrap], 0.0);
  const std::string why = objectness()(segments())[kBall].why;
  EXPECT_NE(why.find("roundness 1.00 (12.0"), std::string::npos) << why;
  EXPECT_NE(why.find("100 % of its points are farther than 2.0 cm"), std::string::npos) << why;
}

TEST_F(Saliencies, RoughFirstTurnsTheOrderAroundButForScraps) {
  const auto rough = values(rough_first());
  EXPECT_GT(rough[kTable], 0.98);
  EXPECT_GT(rough[kTable], rough[kBook]);
  EXPECT_GT(rough[kBook], rough[kBall]);
  EXPECT_EQ(rough[kScrap], 0.0);
}

TEST_F(Saliencies, SizePriorPrefersTheSizeLookedFor) {
  const auto small = values(size_prior({0.12, 2.0}));
  EXPECT_NEAR(small[kBall], 1.0, 0.01);
  EXPECT_GT(small[kBall], small[kBook]);
  EXPECT_GT(small[kBook], small[kTable]);
  EXPECT_EQ(small[kScrap], 0.0);
  const double ball_m = measures_[kBall].sizes_m.maxCoeff();
  EXPECT_NEAR(values(size_prior({2.0 * ball_m, 2.0}))[kBall], std::exp(-0.5), 1e-9);
  EXPECT_NEAR(values(size_prior({0.5 * ball_m, 2.0}))[kBall], std::exp(-0.5), 1e-9);
}

TEST_F(Saliencies, HeightIsAboveTheLevelSupport) {
  const auto heights = values(height_above_support({}));
  EXPECT_EQ(heights[kTable], 0.0);
  EXPECT_NEAR(heights[kBall], 0.2 / 0.25, 1e-3);
  EXPECT_NEAR(heights[kBook], 0.03 / 0.08, 1e-3);
  HeightConfig upside_down;
  upside_down.up = {0.0, 0.0, -2.0};
  EXPECT_EQ(values(height_above_support(upside_down))[kBall], 0.0);
  HeightConfig sideways;  // nothing stands level: above the lowest point along x
  sideways.up = {1.0, 0.0, 0.0};
  const auto along_x = values(height_above_support(sideways));
  EXPECT_NEAR(along_x[kTable], 0.5 / 0.55, 1e-3);
  EXPECT_NEAR(along_x[kBall], 0.7 / 0.75, 1e-3);
}

TEST_F(Saliencies, RegionCountsWhatItContains) {
  const auto inside = values(inside_region(Box{{-0.305, -0.25, 0.72}, {-0.195, 0.0, 0.8}}));
  EXPECT_NEAR(inside[kBook], 11.0 / 21.0, 1e-6);
  EXPECT_EQ(inside[kTable], 0.0);
  EXPECT_EQ(values(inside_region(Sphere{{0.2, 0.1, 0.9}, 0.1}))[kBall], 1.0);
}

TEST_F(Saliencies, BlendIsTheWeightedMean) {
  const auto blended =
      values(weighted_blend({{"size", 3.0, size_prior({})}, {"height", 1.0, height_above_support({})}}));
  const auto sizes = values(size_prior({}));
  const auto heights = values(height_above_support({}));
  for (std::size_t s = 0; s < kThings; ++s) EXPECT_NEAR(blended[s], 0.75 * sizes[s] + 0.25 * heights[s], 1e-12);
  const std::string why =
      weighted_blend({{"size", 3.0, size_prior({})}, {"height", 1.0, height_above_support({})}})(segments())[kBall].why;
  EXPECT_NE(why.find("75 % size"), std::string::npos) << why;
  EXPECT_NE(why.find("25 % height"), std::string::npos) << why;
}

TEST_F(Saliencies, NothingIsNoError) {
  const SegmentedPoints none = SegmentedPoints::create({}, {}, 0).value();
  const SegmentedPoints empty = SegmentedPoints::create({}, {}, 2).value();
  const std::vector<SegmentMeasures> two(2);
  for (const SaliencyHeuristic& heuristic :
       {objectness(), roundness_alone(), isolation_alone(), rough_first(), size_prior({}), height_above_support({}),
        inside_region(Sphere{{0.0, 0.0, 0.0}, 1.0}), weighted_blend({{"size", 1.0, size_prior({})}})}) {
    EXPECT_TRUE(heuristic({none, {}, config_}).empty());
    for (const Saliency& saliency : heuristic({empty, two, config_})) EXPECT_EQ(saliency.value, 0.0);
  }
}

TEST_F(Saliencies, BadParametersAreRefused) {
  EXPECT_FALSE((SizePriorConfig{0.0, 2.0}.validate()));
  EXPECT_FALSE((SizePriorConfig{0.2, 1.0}.validate()));
  HeightConfig height;
  height.up.setZero();
  EXPECT_FALSE(height.validate());
  EXPECT_THROW((void)weighted_blend({}), ContractViolation);
  EXPECT_THROW((void)weighted_blend({{"size", 0.0, size_prior({})}}), ContractViolation);
  EXPECT_THROW((void)inside_region(Sphere{{0.0, 0.0, 0.0}, 0.0}), ContractViolation);
}

}  // namespace
}  // namespace saccade
