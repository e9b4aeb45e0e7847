// SPDX-License-Identifier: Apache-2.0
#include "saccade/segment/overlap.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace saccade {
namespace {

using Labels = std::vector<std::uint32_t>;

TEST(SegmentOverlap, EqualLabelsUnderOtherNamesArePerfect) {
  const SegmentOverlap score = score_segments(Labels{7, 7, 3, 3, kUnlabelled}, Labels{1, 1, 2, 2, kUnlabelled}).value();
  EXPECT_EQ(score.objects, 2U);
  EXPECT_EQ(score.points, 4U);
  EXPECT_DOUBLE_EQ(score.weighted_overlap, 1.0);
  EXPECT_DOUBLE_EQ(score.over_segmentation, 0.0);
  EXPECT_DOUBLE_EQ(score.under_segmentation, 0.0);
}

TEST(SegmentOverlap, IsCountedByHand) {
  // Object 1 has four points, three of them in segment 5, which has one of object 2's two.
  const Labels objects{1, 1, 1, 1, 2, 2};
  const Labels segments{5, 5, 5, kUnlabelled, 5, 6};
  const SegmentOverlap all = score_segments(segments, objects).value();
  EXPECT_DOUBLE_EQ(all.over_segmentation, 1.0 - (3.0 + 1.0) / 6.0);
  EXPECT_DOUBLE_EQ(all.under_segmentation, (1.0 + 3.0) / 6.0);  // at equal overlaps the first segment is the best
  EXPECT_DOUBLE_EQ(all.weighted_overlap, (4.0 * 3.0 / 5.0 + 2.0 * 1.0 / 2.0) / 6.0);
  const SegmentOverlap second = score_segments(segments, objects, 2).value();
  EXPECT_EQ(second.objects, 1U);
  EXPECT_DOUBLE_EQ(second.weighted_overlap, 0.5);
}

TEST(SegmentOverlap, NothingScoresZeroAndUnlikeNumbersAreRefused) {
  EXPECT_EQ(score_segments(Labels{}, Labels{}).value().objects, 0U);
  EXPECT_EQ(score_segments(Labels{1}, Labels{kUnlabelled}).value().points, 0U);
  EXPECT_DOUBLE_EQ(score_segments(Labels{kUnlabelled}, Labels{1}).value().over_segmentation, 1.0);
  EXPECT_EQ(score_segments(Labels{1}, Labels{}).error().code, Errc::size_mismatch);
}

}  // namespace
}  // namespace saccade
