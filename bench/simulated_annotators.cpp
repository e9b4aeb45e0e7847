// SPDX-License-Identifier: Apache-2.0
// Work of simulated annotators between actions, on a labelled cloud (mOSD): rectangles, errors, and their centres.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "saccade/annotate/annotation_error.hpp"
#include "saccade/annotate/simulated_annotator.hpp"
#include "support/labelled_clouds.hpp"
#include "support/places.hpp"

namespace {

using namespace saccade;

struct Scene {
  PointCloud cloud;
  std::vector<std::uint32_t> truth;
};

/// Returns a scene of about the size of those in thesis §4.2.3; a synthetic one where there are no recorded ones.
const Scene& scene() {
  static const Scene chosen = [] {
    constexpr std::size_t kPoints{150'000};
    Scene best;
    const auto off = [](const Scene& s) { return std::abs(static_cast<double>(s.truth.size()) - kPoints); };
    for (const test::LabelledCloud& labelled : test::labelled_clouds(test::shared_data())) {
      Scene next;
      for (std::size_t i = 0; i < labelled.parts.size(); ++i) {
        if (!labelled.cloud.positions_m[i].allFinite()) continue;
        next.cloud.positions_m.push_back(labelled.cloud.positions_m[i]);
        next.truth.push_back(labelled.parts[i] == kUnlabelled ? 0 : labelled.parts[i]);
      }
      if (off(next) < off(best)) best = std::move(next);
    }
    for (std::size_t i = 0; best.truth.size() < kPoints / 2; ++i) {
      const std::size_t row = i / 300;
      const auto x = static_cast<float>(i % 300) / 300.0F - 0.5F;
      const auto y = static_cast<float>(row) / 300.0F - 0.5F;
      const bool in_object = std::abs(std::remainder(x, 0.25F)) < 0.08F && std::abs(std::remainder(y, 0.25F)) < 0.08F;
      best.cloud.positions_m.emplace_back(x, y, in_object ? 0.9F : 1.0F);
      best.truth.push_back(in_object ? 20U + static_cast<std::uint32_t>(4.0F * x + 2.0F) : 1U);
    }
    return best;
  }();
  return chosen;
}

const Neighbourhood& graph() {
  static const Neighbourhood built = Neighbourhood::build(scene().cloud, {}, Executor::with_threads(2)).value();
  return built;
}

void rectangle(benchmark::State& state) {
  const Executor executor = Executor::with_threads(2);
  const RectangleAnnotator start =
      RectangleAnnotator::create(scene().cloud.positions_m, scene().truth, {}, executor).value();
  RectangleAnnotator annotator = start;
  double actions{0.0};
  for (auto _ : state) {
    if (!annotator.next(executor)) annotator = start;
    actions += 1.0;
  }
  if (annotator.wrong() >= start.wrong()) state.SkipWithError("nothing was corrected");
  state.counters["points"] = static_cast<double>(scene().truth.size());
  state.counters["left_wrong"] = static_cast<double>(annotator.wrong());
  state.counters["actions"] = actions;
}

void score(benchmark::State& state) {
  AnnotationScore found;
  for (auto _ : state) found = score_annotation(scene().truth, scene().truth).value();
  if (found.mean_iou != 1.0) state.SkipWithError("the truth is not right");
}

void regions_of_all(benchmark::State& state) {
  const std::vector<std::uint32_t> none(scene().truth.size(), 0);
  std::vector<ErrorRegion> regions;
  for (auto _ : state) regions = error_regions(graph(), none, scene().truth).value();
  if (regions.empty()) state.SkipWithError("nothing is wrong");
  state.counters["regions"] = static_cast<double>(regions.size());
}

void ends(benchmark::State& state) {
  std::vector<std::uint8_t> found;
  for (auto _ : state) found = cloud_ends(graph(), scene().cloud.positions_m, {});
  const auto count = std::count(found.begin(), found.end(), 1);
  if (count == 0) state.SkipWithError("the cloud has no end");
  state.counters["ends"] = static_cast<double>(count);
}

void centre_of_largest(benchmark::State& state) {
  const std::vector<std::uint32_t> none(scene().truth.size(), 0);
  const std::vector<ErrorRegion> regions = error_regions(graph(), none, scene().truth).value();
  const std::vector<std::uint8_t> found = cloud_ends(graph(), scene().cloud.positions_m, {});
  std::uint32_t centre{0};
  for (auto _ : state) centre = region_centre(graph(), found, regions.front());
  if (scene().truth[centre] != regions.front().truth) state.SkipWithError("outside");
  state.counters["points"] = static_cast<double>(regions.front().points.size());
}

BENCHMARK(rectangle)->Unit(benchmark::kMillisecond)->UseRealTime()->Iterations(20);
BENCHMARK(score)->Unit(benchmark::kMillisecond);
BENCHMARK(regions_of_all)->Unit(benchmark::kMillisecond);
BENCHMARK(ends)->Unit(benchmark::kMillisecond);
BENCHMARK(centre_of_largest)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
