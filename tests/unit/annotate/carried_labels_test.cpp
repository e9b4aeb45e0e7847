// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/carried_labels.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/annotated_cloud.hpp"

namespace saccade {
namespace {

constexpr int kCarriedSide{20};
constexpr std::uint32_t kCarriedPoints{kCarriedSide * kCarriedSide + 1};  // with one that is not finite

/// Two samples of one surface, seen from different places: points lie within a third of their spacing of each other.
class CarriedLabelsTest : public ::testing::Test {
 protected:
  CarriedLabelsTest() {
    T_next_first_ =
        Eigen::Translation3d{3.0, -1.0, 0.5} * Eigen::AngleAxisd{0.7, Eigen::Vector3d{1.0, 2.0, 3.0}.normalized()};
    for (Eigen::Vector3f& p : next_.positions_m) p = (T_next_first_ * p.cast<double>()).cast<float>();
    // Label 1 on the left half; the lower quarter has none.
    labels_.resize(kCarriedPoints, kNoLabel);
    for (std::uint32_t i = 0; i + 1 < kCarriedPoints; ++i) labels_[i] = label_at(i);
  }
  static std::uint32_t label_at(std::uint32_t point) {
    if (point / kCarriedSide < kCarriedSide / 4) return kNoLabel;
    return point % kCarriedSide < kCarriedSide / 2 ? 1 : 2;
  }
  [[nodiscard]] CarriedLabels carried(const CarryConfig& config = {}, std::size_t threads = 1) const {
    auto found = carry_labels({first_.positions_m, labels_, T_next_first_}, next_.positions_m, annotation_, config,
                              Executor::with_threads(threads));
    EXPECT_TRUE(found);
    return found ? *found : CarriedLabels{};
  }
  void apply(AnnotationChange change) {
    const AnnotationAction action{1, std::move(change)};
    ASSERT_TRUE(annotation_.validate(action));
    annotation_.apply(action);
  }

  PointCloud first_{test::patchy_cloud(kCarriedSide, 1)};
  PointCloud next_{test::patchy_cloud(kCarriedSide, 2)};
  Pose T_next_first_{Pose::Identity()};
  std::vector<std::uint32_t> labels_;
  Annotation annotation_{test::graph_of(next_)};
};

TEST_F(CarriedLabelsTest, EachPointTakesTheLabelOfTheNearest) {
  const CarriedLabels found = carried();
  EXPECT_EQ(found.kept, 0U);
  EXPECT_EQ(found.locked, 0U);
  apply(found.paint);
  for (std::uint32_t i = 0; i + 1 < kCarriedPoints; ++i) EXPECT_EQ(annotation_.label_of(i), label_at(i)) << i;
  EXPECT_EQ(annotation_.label_of(kCarriedPoints - 1), kNoLabel);
  EXPECT_EQ(carried({}, 4).paint, carried().paint);
  apply(UndoAction{});
  EXPECT_TRUE(annotation_.counts().empty()) << "one action";
  EXPECT_EQ(carried({}, 4).paint, found.paint);
}

TEST_F(CarriedLabelsTest, ManyPointsAtOnePlaceReachAsFarAsOne) {
  const CarriedLabels once = carried();
  const std::vector<Eigen::Vector3f> places_m = first_.positions_m;
  const std::vector<std::uint32_t> labels = labels_;
  for (int copy = 1; copy < 12; ++copy) {
    first_.positions_m.insert(first_.positions_m.end(), places_m.begin(), places_m.end());
    labels_.insert(labels_.end(), labels.begin(), labels.end());
  }
  EXPECT_EQ(carried().paint, once.paint);
}

TEST_F(CarriedLabelsTest, WhatHasALabelKeepsIt) {
  apply(PaintPoints{{210, 211, 212}, 7});
  const std::uint32_t click = 399;
  apply(SetControlPoints{{click}, 8, 0.0});
  const std::vector<std::uint32_t> before{annotation_.labels().begin(), annotation_.labels().end()};
  const CarriedLabels found = carried();
  EXPECT_GT(found.kept, 10U);
  apply(found.paint);
  std::size_t taken{0};
  for (std::uint32_t i = 0; i + 1 < kCarriedPoints; ++i) {
    EXPECT_EQ(annotation_.label_of(i), before[i] != kNoLabel ? before[i] : label_at(i)) << i;
    taken += before[i] == kNoLabel ? 0 : 1;
  }
  EXPECT_GT(taken, 10U);
}

TEST_F(CarriedLabelsTest, LockedLabelsTakeNothing) {
  apply(PaintPoints{{399}, 2});
  apply(LockLabel{2, true, {399}});
  const CarriedLabels found = carried();
  EXPECT_EQ(std::count(found.paint.labels.begin(), found.paint.labels.end(), 2U), 0);
  EXPECT_EQ(found.locked, static_cast<std::size_t>(std::count(labels_.begin(), labels_.end(), 2U)) - 1);
  EXPECT_EQ(found.kept, 1U);
  apply(found.paint);
  EXPECT_EQ(annotation_.counts().at(2), 1U);
}

TEST_F(CarriedLabelsTest, NothingReachesFartherThanItsNeighbours) {
  T_next_first_.translation().x() += 0.2;  // twenty spacings
  const CarriedLabels moved = carried();
  EXPECT_LT(moved.paint.points.size(), 40U);
  T_next_first_.translation().x() += 10.0;
  EXPECT_TRUE(carried().paint.points.empty());
  EXPECT_FALSE(carried({1000.0, 10}).paint.points.empty());
}

TEST_F(CarriedLabelsTest, BadInputIsRefused) {
  EXPECT_FALSE((CarryConfig{0.0, 10}.validate()));
  EXPECT_FALSE((CarryConfig{std::numeric_limits<double>::quiet_NaN(), 10}.validate()));
  EXPECT_FALSE((CarryConfig{1.0, 0}.validate()));
  EXPECT_FALSE((CarryConfig{1.0, 65}.validate()));
  labels_.pop_back();
  EXPECT_FALSE(carry_labels({first_.positions_m, labels_, T_next_first_}, next_.positions_m, annotation_, {}, {}));
  const auto why_not = [&](PaintLabels paint) { return check_action({1, std::move(paint)}, 10, 1.0).error().message; };
  EXPECT_NE(why_not({{1, 2}, {1}}).find("one label for each"), std::string::npos);
  EXPECT_NE(why_not({{2, 1}, {1, 1}}).find("not in order"), std::string::npos);
  EXPECT_NE(why_not({{2, 2}, {1, 1}}).find("named twice"), std::string::npos);
  EXPECT_NE(why_not({{2}, {kNoLabel}}).find("labels are"), std::string::npos);
  EXPECT_NE(why_not({{}, {}}).find("no point"), std::string::npos);
  EXPECT_NE(why_not({{10}, {1}}).find("not one of"), std::string::npos);
}

}  // namespace
}  // namespace saccade
