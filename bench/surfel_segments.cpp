// SPDX-License-Identifier: Apache-2.0
// Flood fill of a million surfels, beside nanoflann's k-d tree and a queue as in a book; their score against a truth.
#include <benchmark/benchmark.h>

#include <cmath>
#include <nanoflann.hpp>
#include <random>

#include "saccade/segment/flood_fill.hpp"
#include "saccade/segment/segmentation_truth.hpp"

namespace {

using namespace saccade;

constexpr int kColumns{1250};
constexpr int kRows{800};
constexpr double kSpacing_m{0.003};

/// Waves of 5 cm, in tiles of 10 cm of eight colours, with noise; row by row, as a camera sees surfels first.
struct Waves {
  PointCloud cloud;
  std::vector<std::uint32_t> truth;
};

const Waves& waves() {
  static const Waves made = [] {
    Waves waves;
    std::mt19937_64 random{413};
    std::normal_distribution<double> noise{0.0, 1.0};
    for (int k = 0; k < kRows; ++k) {
      for (int i = 0; i < kColumns; ++i) {
        const double x = kSpacing_m * (i + 0.2 * noise(random));
        const double y = kSpacing_m * (k + 0.2 * noise(random));
        const double slope = std::cos(5.0 * x) * 0.25;
        const auto tile = static_cast<std::uint32_t>(std::floor(x * 10.0 + 1.0) + 100.0 * std::floor(y * 10.0 + 1.0));
        const std::uint32_t hue = tile * 2654435761U >> 29U;
        waves.cloud.positions_m.push_back(Eigen::Vector3d{x, y, 0.05 * std::sin(5.0 * x)}.cast<float>());
        waves.cloud.normals.push_back(Eigen::Vector3d{-slope, 0.0, 1.0}.normalized().cast<float>());
        const Eigen::Vector3d color{0.2 + 0.5 * (hue & 1U), 0.2 + 0.25 * (hue >> 1U & 1U), 0.2 + 0.5 * (hue >> 2U)};
        waves.cloud.colors.push_back((color + Eigen::Vector3d::Constant(0.005 * noise(random))).cast<float>());
        waves.cloud.radii_m.push_back(static_cast<float>(kSpacing_m * (1.2 + 0.1 * std::abs(noise(random)))));
        waves.truth.push_back(hue);
      }
    }
    return waves;
  }();
  return made;
}

bool are_alike(const PointCloud& cloud, std::uint32_t a, std::uint32_t b, const FloodFillConfig& config) {
  const double sum_m = static_cast<double>(cloud.radii_m[a]) + static_cast<double>(cloud.radii_m[b]);
  const Eigen::Vector3d between_m = cloud.positions_m[a].cast<double>() - cloud.positions_m[b].cast<double>();
  return between_m.squaredNorm() < sum_m * sum_m &&
         surfel_difference(cloud.colors[a], cloud.normals[a], cloud.colors[b], cloud.normals[b], config) <
             config.threshold;
}

/// As in a book: from surfel to surfel, each one's neighbours by nanoflann's k-d tree.
class BookFill {
 public:
  explicit BookFill(const PointCloud& cloud) : cloud_{cloud} {}

  [[nodiscard]] std::size_t kdtree_get_point_count() const { return cloud_.positions_m.size(); }
  [[nodiscard]] float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return cloud_.positions_m[i][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;
  }

  [[nodiscard]] std::vector<std::uint32_t> labels(const FloodFillConfig& config) const {
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, BookFill>, BookFill, 3> tree{3, *this};
    tree.buildIndex();
    const float largest_m = *std::max_element(cloud_.radii_m.begin(), cloud_.radii_m.end());
    nanoflann::SearchParams unsorted;
    unsorted.sorted = false;
    std::vector<std::uint32_t> labels(cloud_.positions_m.size(), kUnlabelled);
    std::vector<std::pair<unsigned int, float>> near;
    std::uint32_t next{0};
    for (std::uint32_t first = 0; first < labels.size(); ++first) {
      if (labels[first] != kUnlabelled) continue;
      std::vector<std::uint32_t> front{first};
      labels[first] = next++;
      while (!front.empty()) {
        const std::uint32_t surfel = front.back();
        front.pop_back();
        const float reach_m = cloud_.radii_m[surfel] + largest_m;
        tree.radiusSearch(cloud_.positions_m[surfel].data(), reach_m * reach_m * 1.0001F, near, unsorted);
        for (const auto& [other, squared] : near) {
          if (labels[other] != kUnlabelled || !are_alike(cloud_, surfel, other, config)) continue;
          labels[other] = labels[surfel];
          front.push_back(other);
        }
      }
    }
    return labels;
  }

 private:
  const PointCloud& cloud_;
};

const std::vector<std::uint32_t>& labels_by_book() {
  static const std::vector<std::uint32_t> made = BookFill{waves().cloud}.labels({});
  return made;
}

void fill(benchmark::State& state) {
  const Executor executor = Executor::with_threads(static_cast<std::size_t>(state.range(0)));
  SurfelComponents found;
  for (auto _ : state) found = flood_fill(waves().cloud, {}, executor).value();
  if (found.labels != labels_by_book() || found.count < 100) state.SkipWithError("other segments than by the book");
  state.counters["surfels"] = static_cast<double>(found.labels.size());
  state.counters["segments"] = static_cast<double>(found.count);
}

void fill_by_nanoflann(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(BookFill{waves().cloud}.labels({}));
}

void score(benchmark::State& state) {
  const Executor executor = Executor::with_threads(static_cast<std::size_t>(state.range(0)));
  const auto truth = SegmentationTruth::create(waves().cloud, waves().truth, {}, executor).value();
  SegmentationScore found;
  for (auto _ : state) found = truth.score(labels_by_book(), executor).value();
  if (!(found.f().value_or(0.0) > 0.9)) state.SkipWithError("the tiles were not found");
  state.counters["boundary"] = static_cast<double>(found.boundary);
  state.counters["F"] = found.f().value_or(0.0);
}

BENCHMARK(fill)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(fill_by_nanoflann)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(score)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
