// SPDX-License-Identifier: Apache-2.0
// Annotation on a labelled cloud (mOSD) and on ten million points tiled from these: the neighbourhood graph, the forest
// from 90 control points, and one control point more or fewer, beside nanoflann and Dijkstra's algorithm as in a book.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nanoflann.hpp>
#include <queue>
#include <random>
#include <string>

#include "saccade/annotate/shortest_path_forest.hpp"
#include "saccade/core/clock.hpp"
#include "saccade/io/clouds/cloud_io.hpp"
#include "support/places.hpp"

namespace {

using namespace saccade;
namespace fs = std::filesystem;

constexpr std::size_t kControlPoints{90};
constexpr std::size_t kThesisPoints{150'868};

PointCloud without_gaps(const PointCloud& cloud) {
  PointCloud points;
  for (std::size_t i = 0; i < cloud.positions_m.size(); ++i) {
    if (!cloud.positions_m[i].allFinite()) continue;
    points.positions_m.push_back(cloud.positions_m[i]);
    points.colors.push_back(cloud.colors[i]);
  }
  return points;
}

/// A sheet with ripples, for where there are no recorded clouds.
PointCloud made_sheet(std::size_t points) {
  PointCloud sheet;
  std::mt19937 random{7};
  std::uniform_real_distribution<float> side{0.0F, 1.0F};
  for (std::size_t i = 0; i < points; ++i) {
    const float x = side(random);
    const float y = side(random);
    sheet.positions_m.emplace_back(x, y, 0.05F * std::sin(20.0F * x) * std::sin(20.0F * y));
    sheet.colors.emplace_back(x, y, 0.5F);
  }
  return sheet;
}

std::vector<PointCloud> recorded_clouds() {
  const fs::path folder = test::shared_data() / "mosd_labelled" / "learn";
  if (!fs::is_directory(folder)) return {made_sheet(kThesisPoints)};
  std::vector<PointCloud> clouds;
  const std::vector<fs::path> paths = list_clouds(folder).value();
  for (const fs::path& path : paths) {
    clouds.push_back(without_gaps(cloud_from_fields(read_cloud(path)->fields()).value()));
  }
  return clouds;
}

/// Returns the cloud whose size is nearest to that of thesis §4.2.3.
const PointCloud& cloud() {
  static const PointCloud chosen = [] {
    std::vector<PointCloud> clouds = recorded_clouds();
    const auto off = [](const PointCloud& c) {
      return std::abs(static_cast<double>(c.positions_m.size()) - static_cast<double>(kThesisPoints));
    };
    return *std::min_element(clouds.begin(), clouds.end(),
                             [&](const PointCloud& a, const PointCloud& b) { return off(a) < off(b); });
  }();
  return chosen;
}

/// Recorded clouds beside each other, again and again.
const PointCloud& ten_million_points() {
  static const PointCloud tiled = [] {
    constexpr std::size_t kPoints{10'000'000};
    constexpr std::size_t kTilesPerRow{8};
    constexpr float kTile_m{3.0F};
    const std::vector<PointCloud> clouds = recorded_clouds();
    PointCloud points;
    points.positions_m.reserve(kPoints);
    points.colors.reserve(kPoints);
    for (std::size_t tile = 0; points.positions_m.size() < kPoints; ++tile) {
      const std::size_t row = tile / kTilesPerRow;
      const std::size_t column = tile % kTilesPerRow;
      const Eigen::Vector3f at{kTile_m * static_cast<float>(column), kTile_m * static_cast<float>(row), 0.0F};
      const PointCloud& cloud = clouds[tile % clouds.size()];
      const std::size_t count = std::min(cloud.positions_m.size(), kPoints - points.positions_m.size());
      for (std::size_t i = 0; i < count; ++i) {
        points.positions_m.emplace_back(cloud.positions_m[i] + at);
        points.colors.push_back(cloud.colors[i]);
      }
    }
    return points;
  }();
  return tiled;
}

/// Returns a line of /proc/self/status in MiB; 0 where it is missing.
double memory_mib(const std::string& line) {
  std::ifstream status{"/proc/self/status"};
  for (std::string word; status >> word;) {
    double kib{0.0};
    if (word == line && status >> kib) return kib / 1024.0;
  }
  return 0.0;
}

std::shared_ptr<const Neighbourhood> graph_of(const PointCloud& points) {
  return std::make_shared<const Neighbourhood>(Neighbourhood::build(points, {}, Executor::with_threads(2)).value());
}

const std::shared_ptr<const Neighbourhood>& graph() {
  static const std::shared_ptr<const Neighbourhood> built = graph_of(cloud());
  return built;
}

std::shared_ptr<const Neighbourhood>& graph_of_ten_million() {
  static std::shared_ptr<const Neighbourhood> built;
  return built;
}

std::vector<Root> random_roots(std::size_t count, std::size_t points) {
  std::mt19937 random{1};
  std::vector<std::uint32_t> all(points);
  for (std::uint32_t i = 0; i < points; ++i) all[i] = i;
  std::vector<Root> roots;
  for (std::size_t i = 0; i < count; ++i) {
    std::swap(all[i], all[i + random() % (points - i)]);
    roots.push_back({all[i], 0.0});
  }
  return roots;
}

/// As in a book: nanoflann's k-d tree, lists of neighbours, and Dijkstra's algorithm with a heap.
class BookForest {
 public:
  explicit BookForest(const PointCloud& points) : points_{points}, adjacent_(points.positions_m.size()) {
    const NeighbourhoodConfig config;
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, BookForest>, BookForest, 3> tree{3, *this};
    tree.buildIndex();
    const auto k = static_cast<std::size_t>(config.neighbours) + 1;
    std::vector<std::uint32_t> found(k);
    std::vector<float> squared(k);
    for (std::uint32_t i = 0; i < adjacent_.size(); ++i) {
      const std::size_t count = tree.knnSearch(points.positions_m[i].data(), k, found.data(), squared.data());
      for (std::size_t n = 0; n < count; ++n) {
        if (found[n] != i) adjacent_[i].push_back({found[n], std::sqrt(squared[n])});
      }
    }
    std::vector<std::vector<Edge>> back(adjacent_.size());
    for (std::uint32_t i = 0; i < adjacent_.size(); ++i) {
      for (const Edge& edge : adjacent_[i]) {
        const auto& theirs = adjacent_[edge.point];
        if (std::none_of(theirs.begin(), theirs.end(), [i](const Edge& e) { return e.point == i; })) {
          back[edge.point].push_back({i, edge.cost});
        }
      }
    }
    for (std::uint32_t i = 0; i < adjacent_.size(); ++i) {
      adjacent_[i].insert(adjacent_[i].end(), back[i].begin(), back[i].end());
      edges_ += adjacent_[i].size();
    }
  }

  [[nodiscard]] std::size_t edge_count() const { return edges_ / 2; }
  std::size_t kdtree_get_point_count() const { return points_.positions_m.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points_.positions_m[i][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;
  }

  /// Path lengths.
  [[nodiscard]] std::vector<float> paths(const std::vector<Root>& roots, std::size_t count) const {
    std::vector<float> path(adjacent_.size(), std::numeric_limits<float>::infinity());
    std::vector<std::uint32_t> root(adjacent_.size());
    using Entry = std::pair<float, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    for (std::size_t i = 0; i < count; ++i) {
      path[roots[i].point] = 0.0F;
      root[roots[i].point] = roots[i].point;
      open.push({0.0F, roots[i].point});
    }
    while (!open.empty()) {
      const auto [length, point] = open.top();
      open.pop();
      if (length > path[point]) continue;
      for (const Edge& edge : adjacent_[point]) {
        const float further = length + edge.cost;
        if (further >= path[edge.point] || further >= 1.0F) continue;
        path[edge.point] = further;
        root[edge.point] = root[point];
        open.push({further, edge.point});
      }
    }
    return path;
  }

 private:
  struct Edge {
    std::uint32_t point;
    float cost;
  };
  const PointCloud& points_;
  std::vector<std::vector<Edge>> adjacent_;
  std::size_t edges_{0};
};

/// Both costs of distance alone.
NeighbourhoodConfig distance_alone() {
  NeighbourhoodConfig config;
  config.normal_weight = 0.0;
  return config;
}

void build_graph(benchmark::State& state, const NeighbourhoodConfig& config) {
  const Executor executor = Executor::with_threads(static_cast<std::size_t>(state.range(0)));
  std::size_t edges{0};
  for (auto _ : state) edges = Neighbourhood::build(cloud(), config, executor)->edge_count();
  state.counters["points"] = static_cast<double>(cloud().positions_m.size());
  state.counters["edges"] = static_cast<double>(edges);
}

void neighbourhood(benchmark::State& state) { build_graph(state, {}); }
void neighbourhood_without_normals(benchmark::State& state) { build_graph(state, distance_alone()); }

void neighbourhood_by_nanoflann(benchmark::State& state) {
  std::size_t edges{0};
  for (auto _ : state) edges = BookForest{cloud()}.edge_count();
  state.counters["edges"] = static_cast<double>(edges);
}

void control_points_90(benchmark::State& state) {
  ShortestPathForest forest{graph()};
  const std::vector<Root> roots = random_roots(kControlPoints, cloud().positions_m.size());
  for (auto _ : state) forest.rebuild(roots);
  state.counters["reached"] = static_cast<double>(forest.touched().size());
}

void control_points_90_by_dijkstra(benchmark::State& state) {
  const BookForest book{cloud()};
  const std::vector<Root> roots = random_roots(kControlPoints, cloud().positions_m.size());
  std::vector<float> paths;
  for (auto _ : state) paths = book.paths(roots, kControlPoints);
  const auto reached = std::count_if(paths.begin(), paths.end(), [](float path) { return std::isfinite(path); });
  state.counters["reached"] = static_cast<double>(reached);
}

/// Adds one of many other points as a control point to the existing ones, and removes it again.
void change_one(benchmark::State& state, const std::shared_ptr<const Neighbourhood>& of, std::size_t there,
                bool adding) {
  constexpr std::size_t kOthers{997};
  ShortestPathForest forest{of};
  const std::vector<Root> roots = random_roots(there + kOthers, of->size());
  forest.rebuild({roots.data(), there});
  std::size_t next{0};
  std::vector<double> all_ms;
  for (auto _ : state) {
    const Root& root = roots[there + next++ % kOthers];
    Stopwatch stopwatch;
    forest.add(root);
    const double add_ms = stopwatch.elapsed_ms();
    stopwatch = Stopwatch{};
    forest.remove(root.point);
    all_ms.push_back(adding ? add_ms : stopwatch.elapsed_ms());
    state.SetIterationTime(1e-3 * all_ms.back());
  }
  const auto middle = all_ms.begin() + static_cast<std::ptrdiff_t>(all_ms.size() / 2);
  std::nth_element(all_ms.begin(), middle, all_ms.end());
  state.counters["median_us"] = 1e3 * *middle;
}

void add_control_point(benchmark::State& state) { change_one(state, graph(), kControlPoints, true); }
void remove_control_point(benchmark::State& state) { change_one(state, graph(), kControlPoints, false); }

/// With the forest's state. What the cloud takes is not counted.
void graph_ten_million(benchmark::State& state) {
  const PointCloud& points = ten_million_points();
  graph_of_ten_million().reset();
  const double before_mib = memory_mib("VmRSS:");
  for (auto _ : state) graph_of_ten_million() = graph_of(points);
  const ShortestPathForest forest{graph_of_ten_million()};
  state.counters["points"] = static_cast<double>(points.positions_m.size());
  state.counters["edges"] = static_cast<double>(graph_of_ten_million()->edge_count());
  if (graph_of_ten_million()->edge_count() < 5 * points.positions_m.size()) state.SkipWithError("too few edges");
  state.counters["peak_mib"] = memory_mib("VmHWM:") - before_mib;
  state.counters["kept_mib"] = memory_mib("VmRSS:") - before_mib;
}

const std::shared_ptr<const Neighbourhood>& built_graph_of_ten_million() {
  if (!graph_of_ten_million()) graph_of_ten_million() = graph_of(ten_million_points());
  return graph_of_ten_million();
}

/// From a graph to the first labels.
void first_control_point_ten_million(benchmark::State& state) {
  const std::shared_ptr<const Neighbourhood>& of = built_graph_of_ten_million();
  const std::vector<Root> roots = random_roots(100, of->size());
  std::size_t next{0};
  double reached{0.0};
  for (auto _ : state) {
    ShortestPathForest forest{of};
    forest.add(roots[next++ % roots.size()]);
    reached += static_cast<double>(forest.touched().size());
  }
  state.counters["reached"] = benchmark::Counter(reached, benchmark::Counter::kAvgIterations);
}

/// Beside 100 per million points.
void add_ten_million(benchmark::State& state) { change_one(state, built_graph_of_ten_million(), 1000, true); }

BENCHMARK(neighbourhood)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(neighbourhood_without_normals)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(neighbourhood_by_nanoflann)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(control_points_90)->Unit(benchmark::kMillisecond);
BENCHMARK(control_points_90_by_dijkstra)->Unit(benchmark::kMillisecond);
BENCHMARK(add_control_point)->UseManualTime()->Iterations(997)->Unit(benchmark::kMicrosecond);
BENCHMARK(remove_control_point)->UseManualTime()->Iterations(997)->Unit(benchmark::kMicrosecond);

BENCHMARK(graph_ten_million)->UseRealTime()->Iterations(1)->Repetitions(1)->Unit(benchmark::kMillisecond);
BENCHMARK(first_control_point_ten_million)->Iterations(5)->Repetitions(1)->Unit(benchmark::kMillisecond);
BENCHMARK(add_ten_million)->UseManualTime()->Iterations(499)->Repetitions(1)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
