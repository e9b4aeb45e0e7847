// SPDX-License-Identifier: Apache-2.0
// Seen and unknown surfels in pictures of explorations.
#include "saccade/report/drawn_surfels.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "saccade/report/exploration_pictures.hpp"

namespace saccade {
namespace {

/// A square metre of green discs on the ground, which face upwards.
SurfelMap green_ground() {
  SurfelMap surfels;
  for (int y = -20; y <= 20; ++y) {
    for (int x = -20; x <= 20; ++x) {
      surfels.resize(surfels.size() + 1);
      surfels.discs.back() = {{0.025F * static_cast<float>(x), 0.025F * static_cast<float>(y), 0.0F},
                              0.02F,
                              Eigen::Vector3f::UnitZ(),
                              3.0F};
      surfels.colors.back() = {Eigen::Vector3f{0.0F, 0.8F, 0.0F}, 3.0F};
    }
  }
  return surfels;
}

std::size_t count(const ColorImage& image, bool (*is)(const Rgb8&)) {
  return static_cast<std::size_t>(std::count_if(image.pixels().begin(), image.pixels().end(), is));
}

bool is_green(const Rgb8& c) { return c[1] > 100 && c[0] < 40 && c[2] < 40; }
bool is_orange(const Rgb8& c) { return c[0] > 100 && c[0] > c[1] + 30 && c[1] > c[2] + 30; }

TEST(DrawnSurfels, LightOnesAndThoseOutsideAreLeftOut) {
  const SurfelMap ground = green_ground();
  const Box box{{-1.0, -1.0, -0.1}, {1.0, 1.0, 0.5}};
  EXPECT_EQ(drawn_surfels(ground, 1.0, {}, box).colors.size(), ground.size());
  EXPECT_EQ(drawn_surfels(ground, 4.0, {}, box).colors.size(), 0U);
  EXPECT_EQ(drawn_surfels(ground, 1.0, {}, Box{{-1.0, -1.0, 0.1}, {1.0, 1.0, 0.5}}).colors.size(), 0U);
}

TEST(DrawnSurfels, PicturesShowThemInsteadOfTheMap) {
  const SurfelMap ground = green_ground();
  const Box box{{-0.5, -0.5, -0.1}, {0.5, 0.5, 0.4}};
  SurfelDisc disc;
  disc.position_m = {0.0F, 0.0F, 0.2F};
  disc.radius_m = 0.1F;
  disc.normal = Eigen::Vector3f::UnitZ();
  disc.weight = 1.0F;
  const Executor executor;
  const DrawnSurfels seen = drawn_surfels(ground, 1.0, {}, Box{{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}});
  const DrawnSurfels both = drawn_surfels(ground, 1.0, std::span{&disc, 1}, Box{{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}});
  MapPictureConfig config;
  config.overview = {.width = 240, .height = 180};
  config.surfels = &seen;
  const ColorImage without = map_picture({}, box, executor, config);
  EXPECT_GT(count(without, is_green), 5000U);
  EXPECT_EQ(count(without, is_orange), 0U);
  config.surfels = &both;
  const ColorImage with = map_picture({}, box, executor, config);
  EXPECT_GT(count(with, is_orange), 200U);
  EXPECT_LT(count(with, is_green), count(without, is_green)) << "the unknown disc hides some of the ground";
}

}  // namespace
}  // namespace saccade
