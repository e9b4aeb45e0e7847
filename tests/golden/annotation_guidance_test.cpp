// SPDX-License-Identifier: Apache-2.0
// Seeds from the truth, and clicks where they would settle most, on real clouds of tables with labelled objects (mOSD).

#include <gtest/gtest.h>

#include <functional>
#include <iostream>
#include <random>
#include <set>

#include "saccade/annotate/annotation_error.hpp"
#include "saccade/annotate/annotation_margin.hpp"
#include "saccade/annotate/label_seeds.hpp"
#include "saccade/annotate/simulated_annotator.hpp"
#include "support/effort.hpp"
#include "support/labelled_clouds.hpp"
#include "support/places.hpp"

namespace saccade {
namespace {

constexpr std::size_t kClicksPerLabel{3};

struct TrueScene {
  PointCloud cloud;
  std::vector<std::uint32_t> truth;
  std::size_t labels{0};
};

std::vector<TrueScene> true_scenes(std::size_t most) {
  std::vector<TrueScene> scenes;
  for (const test::LabelledCloud& labelled : test::labelled_clouds(test::shared_data())) {
    if (scenes.size() == (test::kSanitized ? 1 : most)) break;
    TrueScene scene;
    for (std::size_t i = 0; i < labelled.parts.size(); ++i) {
      if (labelled.parts[i] == kUnlabelled || !labelled.cloud.positions_m[i].allFinite()) continue;
      scene.cloud.positions_m.push_back(labelled.cloud.positions_m[i]);
      scene.truth.push_back(labelled.parts[i]);
    }
    scene.labels = std::set<std::uint32_t>{scene.truth.begin(), scene.truth.end()}.size();
    scenes.push_back(std::move(scene));
  }
  return scenes;
}

std::shared_ptr<const Neighbourhood> graph_of_scene(const TrueScene& scene, bool weighted) {
  NeighbourhoodConfig config;
  if (weighted) {
    config.max_path = 100.0;
    config.normal_weight = 2.0;
  }
  return std::make_shared<const Neighbourhood>(
      Neighbourhood::build(scene.cloud, config, Executor::with_threads(2)).value());
}

/// Mean IoU after as many clicks for each label, with the truth's labels.
double iou_of_clicks(const TrueScene& scene, const std::shared_ptr<const Neighbourhood>& graph,
                     const std::function<std::uint32_t(const Annotation&)>& choose) {
  Annotation annotation{graph};
  for (std::size_t i = 0; i < kClicksPerLabel * scene.labels; ++i) {
    const std::uint32_t point = choose(annotation);
    annotation.apply({1, SetControlPoints{{point}, scene.truth[point], 0.0}});
  }
  return score_annotation(annotation.labels(), scene.truth).value().mean_iou;
}

TEST(AnnotationGuidance, AFewSeedsGiveTheTruthBack) {
  const std::vector<TrueScene> scenes = true_scenes(12);
  if (scenes.empty()) GTEST_SKIP() << "no labelled clouds in " << test::shared_data();
  std::size_t seeds_of_all{0}, labels{0};
  for (const TrueScene& scene : scenes) {
    const auto graph = graph_of_scene(scene, false);
    const LabelSeeds seeds = label_seeds(graph, scene.cloud, scene.truth, {}).value();
    EXPECT_GE(static_cast<double>(seeds.reproduced), 0.99 * static_cast<double>(seeds.points));
    for (const SetControlPoints& action : seeds.actions) seeds_of_all += action.points.size();
    labels += scene.labels;
  }
  std::cout << scenes.size() << " clouds, " << labels << " labels: " << seeds_of_all << " seeds for 99 %\n";
  EXPECT_LT(seeds_of_all, 4 * labels);
}

TEST(AnnotationGuidanceEvidence, ClicksWhereMostIsSettledBeatRandomOnes) {
  if (test::kSanitized) GTEST_SKIP() << "takes long under sanitizers; the next test runs the code";
  const std::vector<TrueScene> scenes = true_scenes(5);
  if (scenes.empty()) GTEST_SKIP() << "no labelled clouds in " << test::shared_data();
  constexpr std::uint32_t kSeeds{3};
  double guided{0.0}, random{0.0}, simulated{0.0};
  for (const TrueScene& scene : scenes) {
    const auto graph = graph_of_scene(scene, true);
    const std::vector<std::uint8_t> ends = cloud_ends(*graph, scene.cloud.positions_m, {});
    guided += iou_of_clicks(scene, graph, [&](const Annotation& annotation) {
      return next_best_click(annotation, label_margins(annotation), ends).value().point;
    });
    for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
      std::mt19937 rng{seed};
      const auto any = [&](const Annotation&) { return static_cast<std::uint32_t>(rng() % scene.truth.size()); };
      random += iou_of_clicks(scene, graph, any) / kSeeds;
    }
    SimulatedAnnotator annotator = SimulatedAnnotator::create(graph, scene.cloud, scene.truth).value();
    double iou{0.0};
    for (std::size_t i = 0; i < kClicksPerLabel * scene.labels; ++i) {
      const std::optional<SimulatedClick> click = annotator.next();
      if (!click) break;
      iou = click->score.mean_iou;
    }
    simulated += iou;
  }
  const auto clouds = static_cast<double>(scenes.size());
  std::cout << "mean IoU of " << clouds << " clouds at " << kClicksPerLabel << " clicks per label: guided "
            << guided / clouds << ", random " << random / clouds << ", who knows what is wrong " << simulated / clouds
            << "\n";
  EXPECT_TRUE(test::kSanitized || guided > random + 0.1 * clouds);
}

}  // namespace
}  // namespace saccade
