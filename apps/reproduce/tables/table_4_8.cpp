// SPDX-License-Identifier: Apache-2.0
// Table 4.8: time of the neighbourhood graph, of annotation from 90 control points, and of one more or fewer.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "experiments/labelled_clouds.hpp"
#include "saccade/annotate/shortest_path_forest.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/core/seeded_random.hpp"
#include "saccade/core/statistics.hpp"
#include "tables.hpp"
#include "text.hpp"
#include "thesis/annotation_figures.hpp"

namespace saccade::reproduce {
namespace {

using nlohmann::json;
using thesis::AnnotationTimes;

constexpr std::size_t kTimedRuns{5};
constexpr std::size_t kChanges{200};

/// The cloud of about as many points as the thesis'.
Result<LabelledCloud> nearest_in_size(const LabelledClouds& clouds, const Executor& executor,
                                      const Progress& progress) {
  const auto off = [](const LabelledCloud& cloud) {
    return std::abs(static_cast<double>(cloud.finite_points()) - static_cast<double>(thesis::kTable4_5.points));
  };
  std::optional<LabelledCloud> nearest;
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    if (progress.cancelled()) return Error{Errc::cancelled, "cancelled", "Table 4.8"};
    progress.report("looking for a cloud", i, clouds.size());
    SACCADE_TRY(LabelledCloud cloud, clouds.load(i, executor));
    if (!nearest || off(cloud) < off(*nearest)) nearest = std::move(cloud);
  }
  return *std::move(nearest);
}

/// Points that have a place, as many as there are up to `count`, in random order.
std::vector<Root> random_roots(const PointCloud& cloud, std::size_t count, std::uint64_t seed) {
  std::vector<Root> roots;
  for (std::uint32_t i = 0; i < cloud.positions_m.size(); ++i) {
    if (cloud.positions_m[i].allFinite()) roots.push_back({i, 0.0});
  }
  SeededRandom random{seed};
  for (std::size_t i = 0; i < std::min(count, roots.size()); ++i) {
    std::swap(roots[i], roots[i + random.below(roots.size() - i)]);
  }
  roots.resize(std::min(count, roots.size()));
  return roots;
}

template <class Work>
double timed_ms(const Work& work) {
  const Stopwatch clock;
  work();
  return clock.elapsed_ms();
}

/// Medians.
Result<AnnotationTimes> measure(const LabelledCloud& cloud, const NeighbourhoodConfig& config, std::uint64_t seed,
                                const Executor& executor) {
  std::vector<double> graph_ms, annotation_ms, addition_ms, deletion_ms;
  std::shared_ptr<const Neighbourhood> graph;
  for (std::size_t run = 0; run <= kTimedRuns; ++run) {  // the first, with cold caches, does not count
    const Stopwatch clock;
    SACCADE_TRY(Neighbourhood built, Neighbourhood::build(cloud.points, config, executor));
    if (run > 0) graph_ms.push_back(clock.elapsed_ms());
    graph = std::make_shared<const Neighbourhood>(std::move(built));
  }
  const std::vector<Root> all = random_roots(cloud.points, thesis::kTable4_8ControlPoints + kChanges, seed);
  const std::span<const Root> there{all.data(), std::min(thesis::kTable4_8ControlPoints, all.size())};
  ShortestPathForest forest{graph};
  for (std::size_t run = 0; run <= kTimedRuns; ++run) {
    const double ms = timed_ms([&] { forest.rebuild(there); });
    if (run > 0) annotation_ms.push_back(ms);
  }
  for (const Root& root : std::span{all}.subspan(there.size())) {
    addition_ms.push_back(timed_ms([&] { forest.add(root); }));
    deletion_ms.push_back(timed_ms([&] { forest.remove(root.point); }));
  }
  return AnnotationTimes{median(graph_ms), median(annotation_ms), median(addition_ms), median(deletion_ms)};
}

}  // namespace

Result<ReproducedTable> table_4_8(const TableOptions& options, Experiments& /*experiments*/, const Executor& executor,
                                  const Progress& progress) {
  SACCADE_TRY(const LabelledClouds clouds, LabelledClouds::open(options));
  SACCADE_TRY(const LabelledCloud cloud, nearest_in_size(clouds, executor, progress));
  progress.report("timing", 0, 2);
  SACCADE_TRY(const AnnotationTimes here, measure(cloud, {}, options.seed, executor));
  progress.report("timing", 1, 2);
  SACCADE_TRY(const AnnotationTimes weighted, measure(cloud, thesis::kTable4_4, options.seed, executor));

  ReproducedTable table;
  table.caption = "Table 4.8: execution times of annotation, in milliseconds";
  table.columns = {"operation", "thesis", "here", "times faster", "here, weights of Table 4.4", "times faster"};
  json rows = json::array();
  const auto add = [&](const char* operation, double AnnotationTimes::*ms) {
    const auto text = [](double value) { return fixed(value, value < 1.0 ? 3 : 1); };
    const double printed = thesis::kTable4_8.*ms;
    table.rows.push_back({operation, fixed(printed, 0), text(here.*ms), fixed(printed / here.*ms, 1) + "×",
                          text(weighted.*ms), fixed(printed / weighted.*ms, 1) + "×"});
    rows.push_back(
        {{"operation", operation}, {"thesis_ms", printed}, {"ms", here.*ms}, {"table_4_4_weights_ms", weighted.*ms}});
  };
  add("neighbourhood graph", &AnnotationTimes::graph_ms);
  add("annotation from 90 control points", &AnnotationTimes::annotation_ms);
  add("addition of one", &AnnotationTimes::addition_ms);
  add("deletion of one", &AnnotationTimes::deletion_ms);
  const std::string name = cloud.job.cloud.filename().string();
  const std::size_t points = cloud.finite_points();
  table.notes = {"Here: " + name + " with " + std::to_string(points) + " points, the one of " +
                     std::to_string(clouds.size()) + (clouds.are_made() ? " made clouds" : " clouds") +
                     " nearest in number to the thesis' " + std::to_string(thesis::kTable4_5.points) + "; " +
                     std::to_string(executor.threads()) +
                     " threads for the graph, one for the rest. There: a Core i7-4770.",
                 "The graph here holds estimating normals, which the thesis' reconstruction gave. Medians of " +
                     std::to_string(kTimedRuns) + " graphs and annotations and of " + std::to_string(kChanges) +
                     " control points, random as the 90 are. With the weights of Table 4.4 paths are short and reach "
                     "fewer points.",
                 "Pictures and pages take what they take besides: these are the algorithms alone, as in the thesis."};
  table.figures = {{"cloud", name}, {"points", points}, {"rows", std::move(rows)}};
  return table;
}

}  // namespace saccade::reproduce
