// SPDX-License-Identifier: Apache-2.0
// Several threads find the result of one thread, in its order, whichever comes first.
#include "saccade/annotate/internal/parallel_spread.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "saccade/annotate/annotation.hpp"
#include "support/annotated_cloud.hpp"

namespace saccade {
namespace {

/// 22,500 points, more than one thread goes through alone. One tree reaches all of them.
std::shared_ptr<const Neighbourhood> wide_graph() {
  static const auto graph = [] {
    constexpr int kSide{150};
    NeighbourhoodConfig config;
    config.color_weight = 0.05;
    auto built = Neighbourhood::build(test::patchy_cloud(kSide), config, Executor{});
    return std::make_shared<const Neighbourhood>(std::move(built).value());
  }();
  return graph;
}

std::vector<Executor> threads_of_all_kinds() {
  return {Executor{}, Executor::with_threads(2), Executor::with_threads(2, Executor::Backend::std_thread),
          Executor::with_threads(7, Executor::Backend::std_thread)};
}

TEST(ParallelSpread, LowersReachesToTheSameFromManyRoots) {
  const std::shared_ptr<const Neighbourhood> graph = wide_graph();
  const std::vector<Root> roots{{3, 0.0}, {7000, 0.01}, {7001, 0.02}, {22000, 0.0}};
  ShortestPathForest expected{graph};
  expected.rebuild(roots);
  for (const Executor& executor : threads_of_all_kinds()) {
    std::vector<PathReach> reaches(graph->size(), kNoPath);
    PathBuckets queue{*graph};
    for (const Root& root : roots) {
      const std::uint32_t node = graph->node_of(root.point);
      reaches[node] = reach_of(expected.start_units(root.point), root.point);
      queue.push(path_of(reaches[node]), node);
    }
    std::vector<std::uint32_t> touched;
    spread_in_parallel(*graph, reaches, queue, executor, touched);
    EXPECT_EQ(queue.count(), 0U);
    for (std::uint32_t point = 0; point < graph->size(); ++point) {
      const PathReach reach = reaches[graph->node_of(point)];
      ASSERT_EQ(path_of(reach), expected.path_units(point)) << point;
      ASSERT_TRUE(reach == kNoPath || root_of_reach(reach) == expected.root_of(point)) << point;
    }
    std::vector<bool> is_touched(graph->size(), false);
    for (const std::uint32_t node : touched) is_touched[node] = true;
    for (std::uint32_t node = 0; node < graph->size(); ++node) EXPECT_EQ(is_touched[node], reaches[node] != kNoPath);
  }
}

TEST(ParallelSpread, LeavesWhatIsNearerAlone) {
  const std::shared_ptr<const Neighbourhood> graph = wide_graph();
  ShortestPathForest before{graph};
  before.add({100, 0.0});
  std::vector<PathReach> reaches(graph->size());
  for (std::uint32_t point = 0; point < graph->size(); ++point) {
    reaches[graph->node_of(point)] = reach_of(before.path_units(point), 100);
  }
  const std::vector<PathReach> there = reaches;
  PathBuckets queue{*graph};
  for (std::uint32_t node = 0; node + 1 < graph->size(); node += 10) queue.push(path_of(reaches[node]), node);
  std::vector<std::uint32_t> touched;
  spread_in_parallel(*graph, reaches, queue, Executor::with_threads(2), touched);
  EXPECT_EQ(reaches, there);
}

TEST(ParallelSpread, ForestsOfAnyNumberOfThreadsAreTheSame) {
  const std::shared_ptr<const Neighbourhood> graph = wide_graph();
  for (const Executor& executor : threads_of_all_kinds()) {
    ShortestPathForest one{graph};
    ShortestPathForest many{graph, executor};
    std::mt19937 random{5};
    std::vector<std::uint32_t> points;
    for (int i = 0; i < 12; ++i) {
      if (i % 3 == 2) {
        one.remove(points[static_cast<std::size_t>(i) / 2]);
        many.remove(points[static_cast<std::size_t>(i) / 2]);
      } else {
        points.push_back(static_cast<std::uint32_t>(random() % (graph->size() - 1)));
        one.add({points.back(), 0.0});
        many.add({points.back(), 0.0});
      }
      for (std::uint32_t point = 0; point < graph->size(); ++point) {
        ASSERT_EQ(one.root_of(point), many.root_of(point)) << point;
        ASSERT_EQ(one.path_units(point), many.path_units(point)) << point;
      }
      EXPECT_EQ(std::set<std::uint32_t>(one.touched().begin(), one.touched().end()),
                std::set<std::uint32_t>(many.touched().begin(), many.touched().end()));
    }
  }
}

TEST(ParallelSpread, AnnotationsSayTheSameInTheSameOrder) {
  constexpr int kActions{60};
  std::vector<std::vector<std::uint32_t>> said;
  std::vector<std::vector<std::uint32_t>> labels;
  for (const Executor& executor : {Executor::with_threads(2), Executor::with_threads(2),
                                   Executor::with_threads(7, Executor::Backend::std_thread), Executor{}}) {
    Annotation annotation{wide_graph(), executor};
    test::RandomActions actions{9};
    std::vector<std::uint32_t>& points = said.emplace_back();
    for (int i = 0; i < kActions; ++i) {
      const Applied applied = annotation.apply(actions.next(annotation));
      points.insert(points.end(), applied.points.begin(), applied.points.end());
    }
    labels.emplace_back(annotation.labels().begin(), annotation.labels().end());
  }
  EXPECT_GT(said.front().size(), 100'000U);
  EXPECT_EQ(said[0], said[1]);
  EXPECT_EQ(said[0], said[2]);
  for (std::size_t i = 1; i < labels.size(); ++i) EXPECT_EQ(labels[0], labels[i]);
}

}  // namespace
}  // namespace saccade
