// SPDX-License-Identifier: Apache-2.0
// Path lengths to a point's own label and to the nearest other one, and gains of clicks, against their definitions.
#include "saccade/annotate/annotation_margin.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>

#include "support/annotated_cloud.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

constexpr int kMarginClouds{test::scaled_cases(300)};

TEST(AnnotationMarginProperty, IsTheForestOfTheOtherLabelsRoots) {
  std::size_t compared{0}, ties{0};
  for (int seed = 1; seed <= kMarginClouds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random{static_cast<std::uint32_t>(seed)};
    PointCloud cloud;  // on a coarse grid: points coincide, and many paths are equally long
    const std::size_t count = 1 + random() % 150;
    for (std::size_t i = 0; i < count; ++i) {
      const auto at = [&] { return 0.05F * static_cast<float>(random() % 7); };
      cloud.positions_m.emplace_back(at(), at(), 0.0F);
    }
    NeighbourhoodConfig config;
    config.neighbours = 1 + static_cast<int>(random() % 10);
    config.max_path = std::array{0.1, 0.5, 5.0}[random() % 3];
    const auto graph = std::make_shared<const Neighbourhood>(Neighbourhood::build(cloud, config, Executor{}).value());
    std::map<std::uint32_t, std::uint32_t> label_of_root;
    std::vector<Root> roots;
    const std::size_t wanted = 1 + random() % 10;
    for (std::size_t i = 0; i < wanted; ++i) {
      const auto point = static_cast<std::uint32_t>(random() % count);
      if (label_of_root.contains(point)) continue;
      label_of_root[point] = 1 + static_cast<std::uint32_t>(random() % 3);
      roots.push_back({point, config.max_path * std::array{0.0, 0.0, 0.3, 0.77}[random() % 4]});
    }
    ShortestPathForest forest{graph};
    forest.rebuild(roots);
    std::vector<std::uint32_t> labels;
    for (const auto& [point, label] : label_of_root) labels.push_back(label);
    const LabelPaths paths = label_paths(forest, labels);
    for (std::uint32_t label = 1; label <= 3; ++label) {
      std::vector<Root> others;
      for (const Root& root : roots) {
        if (label_of_root[root.point] != label) others.push_back(root);
      }
      ShortestPathForest without{graph};
      without.rebuild(others);
      for (std::uint32_t point = 0; point < count; ++point) {
        const auto root = forest.root_of(point);
        ASSERT_TRUE(root || paths.other[point] == kPathUnits);
        if (!root || label_of_root[*root] != label) continue;
        ASSERT_EQ(paths.own[point], forest.path_units(point));
        ASSERT_EQ(paths.other[point], without.path_units(point));
        ties += paths.own[point] == paths.other[point] ? 1 : 0;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 20U * kMarginClouds);
  EXPECT_GT(ties, 0U);
  std::printf("%d clouds, %zu points compared, %zu of them between two labels\n", kMarginClouds, compared, ties);
}

TEST(AnnotationMarginProperty, PaintIsSureAndGainsAreThoseOfTheForest) {
  constexpr int kRuns{test::scaled_cases(100)};
  const PointCloud cloud = test::patchy_cloud(16);
  const auto graph = test::graph_of(cloud);
  std::size_t clicks{0};
  for (int seed = 1; seed <= kRuns; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::RandomActions actions{static_cast<std::uint64_t>(seed)};
    Annotation annotation{graph};
    for (int i = 0; i < 5 + seed % 20; ++i) annotation.apply(actions.next(annotation));
    const std::vector<float> margins = label_margins(annotation);
    for (std::uint32_t point = 0; point < margins.size(); ++point) {
      const bool painted = annotation.painted(point) != kNoLabel;
      ASSERT_TRUE(margins[point] >= 0.0F && margins[point] <= 1.0F);
      ASSERT_TRUE(!painted || margins[point] == 1.0F);
      ASSERT_TRUE(annotation.label_of(point) != kNoLabel || margins[point] == 0.0F);
    }
    const std::optional<BestClick> click = next_best_click(annotation, margins, {});
    if (!click) continue;
    ASSERT_EQ(click->label, annotation.label_of(click->point));
    ASSERT_EQ(click->gain, click_gain(annotation, margins, click->point));
    ShortestPathForest after = annotation.forest();
    if (after.is_root(click->point)) continue;
    after.add({click->point, 0.0});
    double gain{0.0};
    for (std::uint32_t point = 0; point + 1 < margins.size(); ++point) {
      const double own = annotation.forest().path_units(point);
      if (annotation.painted(point) != kNoLabel || after.path_units(point) == own) continue;
      gain += std::pow(1.0 - static_cast<double>(margins[point]), 8.0) * (1.0 - after.path_units(point) / own);
    }
    ASSERT_NEAR(click->gain, gain, 1e-4 * (1.0 + gain));
    ++clicks;
  }
  EXPECT_GT(clicks, static_cast<std::size_t>(kRuns) / 2);
}

}  // namespace
}  // namespace saccade
