// SPDX-License-Identifier: Apache-2.0
#include "saccade/segment/segmentation_truth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "saccade/segment/score_curve.hpp"

namespace saccade {
namespace {

using Numbers = std::vector<std::uint32_t>;

/// A strip of 100 × 4 surfels 1 cm apart, whose colour steps by 0.2 after each `step_after` columns.
PointCloud strip(int step_after) {
  PointCloud cloud;
  for (int i = 0; i < 100; ++i) {
    for (int k = 0; k < 4; ++k) {
      cloud.positions_m.push_back((Eigen::Vector3d{(i + 0.5) * 0.01, (k + 0.5) * 0.01, 0.005}).cast<float>());
      cloud.normals.emplace_back(0.0F, 0.0F, 1.0F);
      cloud.colors.push_back(Eigen::Vector3f::Constant(i / step_after % 2 == 0 ? 0.0F : 0.2F));
      cloud.radii_m.push_back(0.006F);
    }
  }
  return cloud;
}

/// As the columns of a strip are divided.
Numbers by_column(const std::vector<int>& first_columns) {
  Numbers labels;
  for (int i = 0; i < 100; ++i) {
    const auto label = std::upper_bound(first_columns.begin(), first_columns.end(), i) - first_columns.begin();
    labels.insert(labels.end(), 4, static_cast<std::uint32_t>(label));
  }
  return labels;
}

SegmentationTruth truth_of(const Numbers& labels, bool split = true) {
  SegmentationTruthConfig config;
  config.matching.tolerance_m = 0.015;
  config.split = split;
  return SegmentationTruth::create(strip(50), labels, config, Executor{}).value();
}

TEST(SegmentationTruth, ScoresByHand) {
  const SegmentationTruth truth = truth_of(by_column({0, 50}));
  EXPECT_EQ(truth.points(), 400U);
  EXPECT_EQ(truth.segments(), 2U);
  EXPECT_EQ(truth.boundary().size(), 8U);  // columns 49 and 50
  const auto score = [&](const std::vector<int>& columns) {
    return truth.score(by_column(columns), Executor{}).value();
  };
  const SegmentationScore same = score({0, 50});
  EXPECT_EQ(same.precision(), 1.0);
  EXPECT_EQ(same.recall(), 1.0);
  EXPECT_EQ(same.f(), 1.0);
  EXPECT_EQ(same.bce, 0.0);
  EXPECT_EQ(same.distance_m, 0.0);
  const SegmentationScore more = score({0, 20, 50});
  EXPECT_EQ(more.precision(), 0.5);
  EXPECT_EQ(more.recall(), 1.0);
  EXPECT_DOUBLE_EQ(*more.f(), 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(more.bce, (20 * 0.6 + 30 * 0.4) / 100.0);
  const SegmentationScore moved = score({0, 51});  // columns 50, 51
  EXPECT_EQ(moved.matched, 8U);
  EXPECT_NEAR(moved.distance_m, 0.01, 1e-6);
  const SegmentationScore far = score({0, 60});
  EXPECT_EQ(far.precision(), 0.0);
  EXPECT_EQ(far.recall(), 0.0);
  EXPECT_EQ(far.f(), 0.0);
  const SegmentationScore whole = score({0});
  EXPECT_FALSE(whole.precision());
  EXPECT_EQ(whole.recall(), 0.0);
  EXPECT_EQ(whole.f(), 0.0);
  EXPECT_DOUBLE_EQ(whole.bce, 0.5);
}

TEST(SegmentationTruth, IsSplitWhereSurfelsDoNotTouch) {
  Numbers labels = by_column({0, 30, 31});
  for (std::uint32_t& label : labels) label = label == 3 ? 1 : label;  // one label on either side of a column
  EXPECT_EQ(truth_of(labels, false).segments(), 2U);
  EXPECT_EQ(truth_of(labels).segments(), 3U);
  const Numbers three = by_column({0, 30, 31});
  EXPECT_GT(truth_of(labels, false).score(three, Executor{}).value().bce, 0.1);
  EXPECT_EQ(truth_of(labels).score(three, Executor{}).value().bce, 0.0);
}

TEST(SegmentationTruth, LeavesOutWhatHasNoLabel) {
  Numbers labels = by_column({0, 50});
  for (std::size_t i = 0; i < 100; ++i) labels[i] = kUnlabelled;
  const SegmentationTruth truth = truth_of(labels);
  EXPECT_EQ(truth.points(), 300U);
  EXPECT_EQ(truth.score(by_column({0, 5, 9, 50}), Executor{}).value().f(), 1.0);  // columns from 25 on count
  EXPECT_EQ(truth_of(Numbers(400, kUnlabelled)).points(), 0U);
}

TEST(SegmentationTruth, BadInputIsAnError) {
  const auto error = [](const PointCloud& cloud, const Numbers& labels, const SegmentationTruthConfig& config) {
    return SegmentationTruth::create(cloud, labels, config, Executor{}).error().code;
  };
  EXPECT_EQ(error(strip(50), Numbers(3), {}), Errc::size_mismatch);
  PointCloud without = strip(50);
  without.radii_m.clear();
  EXPECT_EQ(error(without, Numbers(400), {}), Errc::invalid_argument);
  EXPECT_EQ(error(strip(50), Numbers(400), {{-1.0, 9}, true}), Errc::invalid_argument);
  EXPECT_EQ(truth_of(Numbers(400, 1)).score(Numbers(3), Executor{}).error().code, Errc::size_mismatch);
}

ScoreCurve made_curve(const std::vector<std::array<std::size_t, 3>>& counts) {
  ScoreCurve curve;
  for (const auto& [boundary, true_boundary, matched] : counts) {
    curve.points.push_back({0.0, 0, {boundary, true_boundary, matched, 0.0, 1.0 / static_cast<double>(boundary + 1)}});
  }
  return curve;
}

TEST(ScoreCurve, AreaIsThatOfTheGreatestPrecisionSoFar) {
  // Precision 1 at recall 0.2, 0.5 at 0.4, 0.8 at 0.8.
  const ScoreCurve curve = made_curve({{2, 10, 2}, {8, 10, 4}, {10, 10, 8}});
  EXPECT_NEAR(curve.area(), 0.2 * 1.0 + 0.6 * 0.8, 1e-12);
  EXPECT_NEAR(made_curve({{10, 10, 8}, {2, 10, 2}}).area(), curve.area(), 1e-12);
  EXPECT_EQ(*curve.best_f()->score.f(), 0.8);
  EXPECT_EQ(curve.least_bce()->score.boundary, 10U);
  EXPECT_EQ(made_curve({}).area(), 0.0);
  EXPECT_FALSE(made_curve({}).best_f());
  EXPECT_FALSE(made_curve({}).least_bce());
  EXPECT_EQ(made_curve({{0, 10, 0}}).area(), 0.0);
}

TEST(ScoreCurve, OfFloodFillFindsTheThresholdBetween) {
  const std::vector<double> thresholds{0.5, 0.1, 0.0};
  const SegmentationTruth truth = truth_of(by_column({0, 50}));
  const ScoreCurve curve = flood_fill_curve(strip(50), truth, thresholds, {}, Executor{}).value();
  ASSERT_EQ(curve.points.size(), 3U);
  EXPECT_EQ(curve.points[0].segments, 1U);
  EXPECT_EQ(curve.points[1].segments, 2U);
  EXPECT_EQ(curve.points[2].segments, 400U);
  EXPECT_EQ(curve.best_f()->threshold, 0.1);
  EXPECT_EQ(curve.least_bce()->threshold, 0.1);
  EXPECT_EQ(curve.area(), 1.0);
  EXPECT_EQ(curve.points[2].score.recall(), 1.0);
  EXPECT_LT(*curve.points[2].score.precision(), 0.1);
  Progress cancelled;
  cancelled.request_cancel();
  EXPECT_EQ(flood_fill_curve(strip(50), truth, thresholds, {}, Executor{}, cancelled).error().code, Errc::cancelled);
  EXPECT_EQ(flood_fill_curve(strip(50), truth, std::vector{-1.0}, {}, Executor{}).error().code, Errc::invalid_argument);
}

TEST(SvLccp, ColoursPruneTheGraph) {
  const PointCloud cloud = strip(50);
  SvLccpConfig config;
  const auto segments = [&] { return segment_by_sv_lccp(cloud, config, Executor{}).value().segments.segments; };
  config.max_color_difference = 1.0;
  EXPECT_EQ(segments(), 1U);
  config.max_color_difference = 0.3;  // 0.2 · √3 = 0.35
  EXPECT_EQ(segments(), 2U);
  const ScoreCurve curve = sv_lccp_curve(find_supervoxels(cloud, config.supervoxels, Executor{}).value(),
                                         truth_of(by_column({0, 50})), std::vector{0.3, 1.0}, config.lccp, Executor{})
                               .value();
  EXPECT_EQ(curve.points[0].segments, 2U);
  EXPECT_EQ(curve.points[0].score.f(), 1.0);
  EXPECT_EQ(curve.points[1].segments, 1U);
  config.max_color_difference = -1.0;
  EXPECT_EQ(segment_by_sv_lccp(cloud, config, Executor{}).error().code, Errc::invalid_argument);
}

TEST(SvLccp, PruningTakesEdgesOfUnlikeColoursOnly) {
  SupervoxelResult row;
  for (const float red : {0.0F, 0.25F, 0.75F}) {
    row.supervoxels.push_back({Eigen::Vector3f::Zero(), Eigen::Vector3f::UnitZ(), {red, 0.0F, 0.0F}, 1, 1});
  }
  row.edges = {{0, 1}, {0, 2}, {1, 2}};
  prune_by_color(row, 0.25);  // as far is not farther
  EXPECT_EQ(row.edges, (std::vector<std::pair<std::uint32_t, std::uint32_t>>{{0, 1}}));
}

}  // namespace
}  // namespace saccade
