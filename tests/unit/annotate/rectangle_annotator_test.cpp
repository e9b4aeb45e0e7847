// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/simulated_annotator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "saccade/annotate/selection.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

using Labels = std::vector<std::uint32_t>;

struct Scene {
  std::vector<Eigen::Vector3f> positions_m;
  Labels truth;
};

/// A wall (7), two discs before it (3, 4), one of which hides a part of the other, and points without a truth.
Scene made_scene(std::size_t points, std::uint32_t seed) {
  Scene scene;
  std::mt19937 rng{seed};
  std::uniform_real_distribution<float> place{-0.6F, 0.6F};
  for (std::size_t i = 0; i < points; ++i) {
    const Eigen::Vector2f p{place(rng), place(rng)};
    const bool in_first = (p - Eigen::Vector2f{-0.1F, 0.0F}).norm() < 0.2F;
    const bool in_second = (p - Eigen::Vector2f{0.1F, 0.05F}).norm() < 0.2F;
    const std::uint32_t label = i % 50 == 0 ? 0 : in_first ? 3 : in_second ? 4 : 7;
    const float depth_m = in_first ? 0.9F : in_second ? 1.0F : 1.2F;
    scene.positions_m.emplace_back(p.x(), p.y(), depth_m);
    scene.truth.push_back(label);
  }
  scene.positions_m.front().x() = std::numeric_limits<float>::quiet_NaN();
  return scene;
}

RectangleAnnotatorConfig coarse(int columns, int rows) {
  RectangleAnnotatorConfig config;
  config.columns = columns;
  config.rows = rows;
  return config;
}

std::size_t wrong_points(const Labels& labels, const Scene& scene) {
  std::size_t wrong{0};
  for (std::size_t i = 0; i < labels.size(); ++i) {
    wrong += scene.truth[i] != 0 && scene.positions_m[i].allFinite() && labels[i] != scene.truth[i] ? 1 : 0;
  }
  return wrong;
}

/// Performs an action with the tool that it names.
Labels painted(Labels labels, const Scene& scene, const RectangleAnnotator& annotator,
               const RectangleAnnotatorConfig& config, const RectangleAction& action) {
  const double px = config.cell_px;
  const ScreenRectangle rectangle{{px * action.left, px * action.top}, {px * action.right, px * action.bottom}};
  const auto selected = select_points(scene.positions_m, annotator.view(action.view), rectangle,
                                      action.surface ? kOnSurface_m : kAnyDepth_m, Executor{}, SurfaceRule::as_printed);
  for (const std::uint32_t point : selected.value()) labels[point] = action.label;
  return labels;
}

TEST(RectangleAnnotator, ActionsAreThoseOfTheToolsAndNoneOfThemIsBetter) {
  const Scene scene = made_scene(600, 1);
  const RectangleAnnotatorConfig config = coarse(7, 5);
  RectangleAnnotator annotator = RectangleAnnotator::create(scene.positions_m, scene.truth, config, Executor{}).value();
  for (int step = 0; step < (test::kSanitized ? 1 : 3); ++step) {
    const Labels before = annotator.labels();
    std::size_t least_wrong = wrong_points(before, scene);
    EXPECT_EQ(annotator.wrong(), least_wrong);
    for (std::size_t view = 0; view < 6; ++view) {
      for (int i = 0; i < 7 * 7 * 5 * 5; ++i) {
        RectangleAction action{view, false, 0, i % 7, i / 7 % 5, i / 35 % 7 + 1, i / 245 + 1};
        if (action.left >= action.right || action.top >= action.bottom) continue;
        for (int kind = 0; kind < 6; ++kind) {
          action.surface = kind % 2 == 0;
          action.label = Labels{3, 4, 7}[static_cast<std::size_t>(kind / 2)];
          least_wrong = std::min(least_wrong, wrong_points(painted(before, scene, annotator, config, action), scene));
        }
      }
    }
    const RectangleAction action = annotator.next(Executor{}).value();
    EXPECT_EQ(annotator.labels(), painted(before, scene, annotator, config, action));
    EXPECT_EQ(annotator.wrong(), wrong_points(annotator.labels(), scene));
    EXPECT_EQ(annotator.wrong(), least_wrong);
    EXPECT_EQ(annotator.wrong() + action.corrected, wrong_points(before, scene) + action.broken);
  }
}

TEST(RectangleAnnotator, EveryActionMakesItBetterUntilNoneDoesOnAnyNumberOfThreads) {
  const Scene scene = made_scene(20'000, 2);
  std::vector<Labels> ends;
  for (const std::size_t threads : {1U, 3U}) {
    const Executor executor = Executor::with_threads(threads);
    RectangleAnnotator annotator =
        RectangleAnnotator::create(scene.positions_m, scene.truth, coarse(40, 30), executor).value();
    const std::size_t first = annotator.wrong();
    int actions{0};
    for (std::size_t before = first; annotator.next(executor); before = annotator.wrong(), ++actions) {
      ASSERT_LT(annotator.wrong(), before);
    }
    EXPECT_GT(actions, 10);
    EXPECT_LT(annotator.wrong(), first / 50);
    ends.push_back(annotator.labels());
  }
  EXPECT_EQ(ends[0], ends[1]);
}

TEST(RectangleAnnotator, GoesAroundARegionWhereThatHelpsAndOtherwiseTakesTheBest) {
  const Scene scene = made_scene(20'000, 5);
  const auto create = [&] {
    return RectangleAnnotator::create(scene.positions_m, scene.truth, coarse(40, 30), Executor{}).value();
  };
  const auto region_of = [&](std::uint32_t label) {
    ErrorRegion region{label, {}};
    for (std::uint32_t i = 0; i < scene.truth.size(); ++i) {
      if (scene.truth[i] == label && scene.positions_m[i].allFinite()) region.points.push_back(i);
    }
    return region;
  };
  RectangleAnnotator annotator = create();
  const RectangleAction wall = annotator.next_around(region_of(7), Executor{}).value();
  EXPECT_EQ(wall.label, 7U);
  EXPECT_EQ(wall.corrected, region_of(7).points.size());
  EXPECT_EQ(annotator.wrong(), wrong_points(annotator.labels(), scene));
  const std::size_t before = annotator.wrong();
  const RectangleAction disc = annotator.next_around(region_of(3), Executor{}).value();
  EXPECT_EQ(disc.label, 3U);
  EXPECT_EQ(annotator.wrong() + disc.corrected, before + disc.broken);
  EXPECT_LT(annotator.wrong(), before);
  const SelectionView& view = annotator.view(disc.view);
  const ScreenProjection project{view};
  for (const std::uint32_t point : region_of(3).points) {  // all of it that the tool selects has its label
    const bool is_selected = !disc.surface && project(scene.positions_m[point]).in_view();
    EXPECT_TRUE(!is_selected || annotator.labels()[point] == 3U);
  }
  // Nothing is left to win around what is right already: the best rectangle of all, as `next` takes it.
  RectangleAnnotator one = annotator;
  const RectangleAction fallback = one.next_around(region_of(3), Executor{}).value();
  const RectangleAction best = annotator.next(Executor{}).value();
  EXPECT_EQ(one.labels(), annotator.labels());
  EXPECT_EQ(fallback.label, best.label);
}

TEST(RectangleAnnotator, ShowsTheWholeCloudInEveryView) {
  const Scene scene = made_scene(2000, 3);
  const RectangleAnnotator annotator =
      RectangleAnnotator::create(scene.positions_m, scene.truth, {}, Executor{}).value();
  for (std::size_t view = 0; view < 6; ++view) {
    const ScreenProjection project{annotator.view(view)};
    std::size_t shown{0};
    for (const Eigen::Vector3f& p : scene.positions_m) shown += project(p).in_view() ? 1 : 0;
    EXPECT_EQ(shown, scene.positions_m.size() - 1) << view;
  }
}

TEST(RectangleAnnotator, WhatCannotBeAnnotatedIsRefused) {
  const Scene scene = made_scene(10, 4);
  const auto code = [&](const Labels& truth, const RectangleAnnotatorConfig& config) {
    const auto made = RectangleAnnotator::create(scene.positions_m, truth, config, Executor{});
    return made.ok() ? Errc::cancelled : made.error().code;
  };
  EXPECT_EQ(code(scene.truth, {}), Errc::cancelled);
  EXPECT_EQ(code(Labels(9, 1), {}), Errc::size_mismatch);
  EXPECT_EQ(code(Labels(10, 0), {}), Errc::invalid_argument);
  EXPECT_EQ(code(scene.truth, coarse(0, 5)), Errc::invalid_argument);
  EXPECT_EQ(code(scene.truth, coarse(5, 1025)), Errc::invalid_argument);
  RectangleAnnotatorConfig config;
  config.orbit_rad = 0.0;
  EXPECT_EQ(code(scene.truth, config), Errc::invalid_argument);
  config = {};
  config.point_size_px = 65;
  EXPECT_EQ(code(scene.truth, config), Errc::invalid_argument);
}

}  // namespace
}  // namespace saccade
