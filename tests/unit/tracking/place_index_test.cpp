// SPDX-License-Identifier: Apache-2.0
#include "saccade/tracking/place_index.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "saccade/scene/place_scenes.hpp"
#include "saccade/scene/rendered_sequence.hpp"

namespace saccade {
namespace {

/// Frames of a room that the camera turns in by 1.1 turns, as a noisy camera takes them.
std::vector<Frame> frames_of_room(std::size_t count) {
  const PlaceScene place = place_scene("loop:3").value();
  RenderedSequenceConfig config = surfel_sensor("xtion").value();
  config.camera = config.camera.scaled_to(80, 60);
  auto sequence =
      RenderedSequence::create(RayScene::build(place.scene).value(), carried_poses(place.path, count), config).value();
  std::vector<Frame> frames;
  while (auto frame = sequence.next().value()) frames.push_back(std::move(*frame));
  return frames;
}

TEST(PlaceIndex, FindsThePlaceAfterATurn) {
  constexpr std::size_t kFrames{89};  // 1.1 turns: frame 80 is where frame 0 was
  const std::vector<Frame> frames = frames_of_room(kFrames);
  PlaceIndex index = PlaceIndex::create().value();
  for (std::size_t i = 0; i < 60; i += 2) {
    EXPECT_EQ(index.add(index.encode(frames[i].depth, &*frames[i].color).value()), i / 2);
  }
  double unlike{0.0};
  int right_at_once{0};
  for (std::size_t i = 80; i < kFrames; ++i) {
    const PlaceCode code = index.encode(frames[i].depth, &*frames[i].color).value();
    const std::vector<PlaceMatch> matches = index.nearest(code, 3);
    ASSERT_EQ(matches.size(), 3U);
    const auto right = [&](const PlaceMatch& match) {
      return std::abs(static_cast<double>(2 * match.place) - static_cast<double>(i - 80)) < 2.01;
    };
    EXPECT_TRUE(std::any_of(matches.begin(), matches.end(), right)) << i;
    if (right(matches[0])) ++right_at_once;
    EXPECT_LE(matches[0].dissimilarity, matches[1].dissimilarity);
    unlike = std::max(unlike, matches[0].dissimilarity);
    EXPECT_GT(PlaceIndex::dissimilarity(code, index.encode(frames[i - 40].depth, &*frames[i - 40].color).value()),
              matches[0].dissimilarity);
  }
  EXPECT_LT(unlike, 0.6);
  EXPECT_GE(right_at_once, 7);  // 9 were asked for
}

TEST(PlaceIndex, IsTheSameEverywhereAndNeedsNoColour) {
  const std::vector<Frame> frames = frames_of_room(4);
  const PlaceIndex a = PlaceIndex::create().value();
  const PlaceIndex b = PlaceIndex::create().value();
  const PlaceIndex other = PlaceIndex::create({.seed = 2}).value();
  const PlaceCode code = a.encode(frames[0].depth, nullptr).value();
  EXPECT_EQ(code, b.encode(frames[0].depth, nullptr).value());
  EXPECT_NE(code, other.encode(frames[0].depth, nullptr).value());
  EXPECT_NE(code, a.encode(frames[0].depth, &*frames[0].color).value());
  EXPECT_EQ(PlaceIndex::dissimilarity(code, code), 0.0);
}

TEST(PlaceIndex, WithoutDepthNothingIsAlike) {
  const PlaceIndex index = PlaceIndex::create().value();
  const PlaceCode empty = index.encode(DepthImage{80, 60}, nullptr).value();
  EXPECT_EQ(std::count(empty.begin(), empty.end(), PlaceIndex::kNoCode), 500);
  EXPECT_EQ(PlaceIndex::dissimilarity(empty, empty), 1.0);
}

TEST(PlaceIndex, EqualPlacesComeInTheirOrder) {
  PlaceIndex index = PlaceIndex::create({.ferns = 8}).value();
  const PlaceCode one(8, 1);
  const PlaceCode two{1, 1, 1, 1, 2, 2, 2, 2};
  for (const PlaceCode& code : {two, one, two, one}) index.add(code);
  const std::vector<PlaceMatch> matches = index.nearest(one, 9);
  ASSERT_EQ(matches.size(), 4U);
  EXPECT_EQ(matches[0].place, 1U);
  EXPECT_EQ(matches[1].place, 3U);
  EXPECT_EQ(matches[2].place, 0U);
  EXPECT_EQ(matches[2].dissimilarity, 0.5);
  EXPECT_EQ(index.nearest(one, 9, 1).size(), 1U);
}

TEST(PlaceIndex, RefusesWhatDoesNotFit) {
  const PlaceIndex index = PlaceIndex::create().value();
  const ColorImage small{79, 60};
  EXPECT_EQ(index.encode(DepthImage{80, 60}, &small).error().code, Errc::size_mismatch);
  EXPECT_EQ(index.encode(DepthImage{20, 15}, nullptr).error().code, Errc::invalid_argument);
  EXPECT_FALSE(PlaceIndex::create({.ferns = 0}));
  EXPECT_FALSE(PlaceIndex::create({.min_depth_m = 2.0, .max_depth_m = 1.0}));
}

}  // namespace
}  // namespace saccade
