// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/label_seeds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "saccade/annotate/annotation.hpp"
#include "saccade/annotate/annotation_error.hpp"
#include "support/annotated_cloud.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

constexpr std::uint32_t kTableSide{60};

/// A table with four boxes on it, lattices a centimetre apart with normals, and a wall apart from it, of two labels.
struct BoxScene {
  PointCloud cloud;
  std::vector<std::uint32_t> labels;

  void add(const Eigen::Vector3f& p_m, const Eigen::Vector3f& normal, std::uint32_t label) {
    cloud.positions_m.push_back(p_m);
    cloud.normals.push_back(normal);
    labels.push_back(label);
  }
};

BoxScene table_with_boxes() {
  BoxScene scene;
  for (std::uint32_t y = 0; y < kTableSide; ++y) {
    for (std::uint32_t x = 0; x < kTableSide; ++x) {
      const bool on_box = x % 30 >= 8 && x % 30 < 22 && y % 30 >= 10 && y % 30 < 20;
      const std::uint32_t label = on_box ? 20 + x / 30 + 2 * (y / 30) : 1;
      scene.add({0.01F * static_cast<float>(x), 0.01F * static_cast<float>(y), on_box ? 0.06F : 0.0F},
                Eigen::Vector3f::UnitZ(), label);
    }
  }
  for (std::uint32_t z = 0; z < 30; ++z) {
    for (std::uint32_t x = 0; x < kTableSide; ++x) {
      scene.add({0.01F * static_cast<float>(x), 1.0F, 0.01F * static_cast<float>(z)}, Eigen::Vector3f::UnitY(),
                x < 30 ? 2 : 3);
    }
  }
  return scene;
}

std::shared_ptr<const Neighbourhood> graph_of_boxes(const PointCloud& cloud) {
  return std::make_shared<const Neighbourhood>(Neighbourhood::build(cloud, {}, Executor{}).value());
}

/// Labels that the seeds give, by way of an annotation.
std::vector<std::uint32_t> labels_from(const std::shared_ptr<const Neighbourhood>& graph, const LabelSeeds& seeds) {
  Annotation annotation{graph};
  for (const SetControlPoints& action : seeds.actions) {
    EXPECT_TRUE(annotation.validate({1, action}));
    annotation.apply({1, action});
  }
  return {annotation.labels().begin(), annotation.labels().end()};
}

std::size_t seed_count(const LabelSeeds& seeds) {
  std::size_t count{0};
  for (const SetControlPoints& action : seeds.actions) count += action.points.size();
  return count;
}

TEST(LabelSeeds, GiveAMadeSceneBackFully) {
  const BoxScene scene = table_with_boxes();
  const auto graph = graph_of_boxes(scene.cloud);
  const LabelSeeds seeds = label_seeds(graph, scene.cloud, scene.labels, {1.0, 64}).value();
  EXPECT_EQ(seeds.points, scene.labels.size());
  EXPECT_EQ(seeds.reproduced, scene.labels.size());
  EXPECT_EQ(labels_from(graph, seeds), scene.labels);
  ASSERT_EQ(seeds.actions.size(), 7U);
  for (std::size_t i = 0; i < seeds.actions.size(); ++i) {
    const SetControlPoints& action = seeds.actions[i];
    EXPECT_TRUE(i == 0 || seeds.actions[i - 1].label < action.label);
    EXPECT_TRUE(std::is_sorted(action.points.begin(), action.points.end()));
    EXPECT_EQ(action.start_cost, 0.0);
    for (const std::uint32_t point : action.points) EXPECT_EQ(scene.labels[point], action.label);
  }
  EXPECT_LT(seed_count(seeds), 100U);
}

TEST(LabelSeeds, StopAtTheShareAndAtTheMostPerLabel) {
  const BoxScene scene = table_with_boxes();
  const auto graph = graph_of_boxes(scene.cloud);
  const LabelSeeds all = label_seeds(graph, scene.cloud, scene.labels, {1.0, 64}).value();
  const LabelSeeds most = label_seeds(graph, scene.cloud, scene.labels, {0.97, 64}).value();
  EXPECT_LT(seed_count(most), seed_count(all));
  EXPECT_GE(static_cast<double>(most.reproduced), 0.97 * static_cast<double>(most.points));
  const LabelSeeds one_each = label_seeds(graph, scene.cloud, scene.labels, {1.0, 1}).value();
  EXPECT_EQ(seed_count(one_each), 7U);
  EXPECT_LT(one_each.reproduced, all.reproduced);
}

TEST(LabelSeeds, EveryLabelHasOneHoweverFewItsPoints) {
  BoxScene scene = table_with_boxes();
  scene.labels[0] = 9;
  const auto graph = graph_of_boxes(scene.cloud);
  const LabelSeeds seeds = label_seeds(graph, scene.cloud, scene.labels, {0.9, 64}).value();
  ASSERT_EQ(seeds.actions.size(), 8U);
  EXPECT_EQ(seeds.actions[3].label, 9U);
  EXPECT_EQ(seeds.actions[3].points, std::vector<std::uint32_t>{0});
}

TEST(LabelSeeds, RefuseWhatTheyCannotReproduce) {
  const PointCloud cloud = test::patchy_cloud(6);
  const auto graph = test::graph_of(cloud);
  const std::size_t size = cloud.positions_m.size();
  const auto code = [&](const PointCloud& of, const std::vector<std::uint32_t>& labels, SeedConfig config = {}) {
    return label_seeds(graph, of, labels, config).error().code;
  };
  const std::vector<std::uint32_t> ones(size, 1);
  EXPECT_EQ(code(cloud, std::vector<std::uint32_t>(size - 1, 1)), Errc::size_mismatch);
  EXPECT_EQ(code(PointCloud{}, ones), Errc::size_mismatch);
  EXPECT_EQ(code(cloud, std::vector<std::uint32_t>(size, 0)), Errc::invalid_argument);
  EXPECT_EQ(code(cloud, std::vector<std::uint32_t>(size, kUnlabelled)), Errc::invalid_argument);
  std::vector<std::uint32_t> only_nan(size, 0);
  only_nan.back() = 1;  // its position is not finite
  EXPECT_EQ(code(cloud, only_nan), Errc::invalid_argument);
  for (const SeedConfig& config : {SeedConfig{0.0, 64}, SeedConfig{1.1, 64}, SeedConfig{0.9, 0},
                                   SeedConfig{std::numeric_limits<double>::quiet_NaN(), 64}}) {
    EXPECT_EQ(code(cloud, ones, config), Errc::invalid_argument);
  }
}

TEST(LabelSeeds, CountAsTheScoreDoesOnRandomLabels) {
  constexpr int kClouds{test::scaled_cases(100)};
  int reached{0};
  for (int seed = 1; seed <= kClouds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random{static_cast<std::uint32_t>(seed)};
    PointCloud cloud;
    std::vector<std::uint32_t> labels;
    const std::size_t patches = 1 + random() % 6;
    const std::size_t count = 20 + random() % 400;
    for (std::size_t i = 0; i < count; ++i) {
      const auto at = [&] { return 0.01F * static_cast<float>(random() % 25); };
      cloud.positions_m.emplace_back(at(), at(), 0.0F);
      const auto patch = static_cast<std::size_t>(cloud.positions_m.back().x() / 0.05F) % patches;
      labels.push_back(static_cast<std::uint32_t>(random() % 20 == 0 ? random() % 4 : patch));
    }
    NeighbourhoodConfig config;
    config.neighbours = 3 + static_cast<int>(random() % 8);
    config.max_path = random() % 2 == 0 ? 1.0 : 0.03;
    const auto graph = std::make_shared<const Neighbourhood>(Neighbourhood::build(cloud, config, Executor{}).value());
    const SeedConfig wanted{random() % 2 == 0 ? 1.0 : 0.9, 1 + random() % 64};
    const Result<LabelSeeds> seeds = label_seeds(graph, cloud, labels, wanted);
    if (!seeds) continue;  // no label at all
    const AnnotationScore score = score_annotation(labels_from(graph, *seeds), labels).value();
    ASSERT_EQ(seeds->points, score.points);
    ASSERT_EQ(seeds->reproduced, score.points - score.wrong);
    ASSERT_EQ(seeds->actions.size(), score.objects.size());
    bool full{false};
    for (const SetControlPoints& action : seeds->actions) {
      ASSERT_LE(action.points.size(), wanted.most_per_label);
      full = full || action.points.size() == wanted.most_per_label;
    }
    const bool enough = static_cast<double>(seeds->reproduced) >= wanted.share * static_cast<double>(seeds->points);
    ASSERT_TRUE(enough || full || wanted.share == 1.0);  // coincident points cannot differ
    reached += enough ? 1 : 0;
  }
  EXPECT_GT(reached, kClouds / 4);
}

}  // namespace
}  // namespace saccade
