// SPDX-License-Identifier: Apache-2.0
// Selections in a picture of ten million points, all of which are in view, beside a depth buffer as in a book: one
// thread, every pixel of every square.
#include "saccade/annotate/selection.hpp"

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <random>

namespace {

using namespace saccade;

constexpr std::size_t kPoints{10'000'000};

/// Three sheets one behind the other, at every place of the picture; in rows as a scanner takes them, or in any order.
const std::vector<Eigen::Vector3f>& points(bool in_rows) {
  static const std::array<std::vector<Eigen::Vector3f>, 2> clouds = [] {
    std::mt19937 rng{7};
    std::uniform_real_distribution<float> place{-1.0F, 1.0F};
    std::uniform_real_distribution<float> noise{0.0F, 0.003F};
    std::array<std::vector<Eigen::Vector3f>, 2> made;
    constexpr std::size_t kColumns{4000};
    for (std::size_t i = 0; i < kPoints; ++i) {
      const std::size_t line = i / kColumns;
      const float row = static_cast<float>(line) / (static_cast<float>(kPoints) / kColumns);
      const float column = static_cast<float>(i % kColumns) / kColumns;
      const float depth_m = 1.0F + 0.5F * static_cast<float>(i % 3);
      const auto seen_at = [&](float x, float y) {
        return Eigen::Vector3f{0.95F * depth_m * x, 0.52F * depth_m * y, depth_m + noise(rng)};
      };
      made[0].push_back(seen_at(place(rng), place(rng)));
      made[1].push_back(seen_at(2.0F * column - 1.0F, 2.0F * row - 1.0F));
    }
    return made;
  }();
  return clouds[in_rows ? 1 : 0];
}

SelectionView view() {
  SelectionView view{Eigen::Matrix4d::Zero(), 1920, 1080, 5};
  view.clip_world.diagonal() << 1.0, -1920.0 / 1080.0, 1.02, 0.0;
  view.clip_world(2, 3) = -0.2;
  view.clip_world(3, 2) = 1.0;
  return view;
}

std::vector<std::uint32_t> select_by_the_book(const std::vector<Eigen::Vector3f>& points_m) {
  const SelectionView of = view();
  const auto clip = [&](const Eigen::Vector3f& p) -> Eigen::Vector4d {
    return of.clip_world * Eigen::Vector4d{p.x(), p.y(), p.z(), 1.0};
  };
  const auto u_px = [&](const Eigen::Vector4d& at) { return (at.x() / at.w() + 1.0) * 0.5 * of.width; };
  const auto v_px = [&](const Eigen::Vector4d& at) { return (1.0 - at.y() / at.w()) * 0.5 * of.height; };
  std::vector<float> depth(static_cast<std::size_t>(of.width * of.height), INFINITY);
  const int reach = of.point_size_px / 2;
  for (const Eigen::Vector3f& p : points_m) {
    const Eigen::Vector4d at = clip(p);
    const int u = static_cast<int>(u_px(at));
    const int v = static_cast<int>(v_px(at));
    for (int row = std::max(0, v - reach); row <= std::min(of.height - 1, v + reach); ++row) {
      for (int column = std::max(0, u - reach); column <= std::min(of.width - 1, u + reach); ++column) {
        float& nearest = depth[static_cast<std::size_t>(row * of.width + column)];
        nearest = std::min(nearest, static_cast<float>(at.w()));
      }
    }
  }
  std::vector<std::uint32_t> selected;
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const Eigen::Vector4d at = clip(points_m[i]);
    const std::size_t pixel = static_cast<std::size_t>(static_cast<int>(v_px(at)) * of.width) +
                              static_cast<std::size_t>(static_cast<int>(u_px(at)));
    if (static_cast<float>(at.w()) <= depth[pixel]) selected.push_back(static_cast<std::uint32_t>(i));
  }
  return selected;
}

const ScreenRectangle kWhole{{0.0, 0.0}, {1920.0, 1080.0}};

ScreenPolygon lasso() {
  ScreenPolygon round;
  for (int i = 0; i < 400; ++i) {
    const double angle = 2.0 * M_PI * i / 400.0;
    const double radius_px = 400.0 + 60.0 * std::sin(9.0 * angle);
    round.corners.push_back({960.0 + radius_px * std::cos(angle), 540.0 + radius_px * std::sin(angle)});
  }
  return round;
}

ScreenStroke brush() {
  ScreenStroke stroke;
  for (int i = 0; i < 300; ++i) stroke.line.push_back({500.0 + 3.0 * i, 540.0 + 100.0 * std::sin(0.05 * i)});
  stroke.radius_px = 20.0;
  return stroke;
}

void run(benchmark::State& state, const ScreenShape& shape, double below_m) {
  const std::vector<Eigen::Vector3f>& cloud = points(state.range(0) == 1);
  const Executor executor = Executor::with_threads(static_cast<std::size_t>(state.range(1)));
  std::vector<std::uint32_t> selected;
  for (auto _ : state) selected = select_points(cloud, view(), shape, below_m, executor).value();
  if (selected.empty() ||
      (below_m == kAnyDepth_m && std::holds_alternative<ScreenRectangle>(shape) && selected.size() != cloud.size())) {
    state.SkipWithError("the selection is wrong");
  }
  state.counters["selected"] = static_cast<double>(selected.size());
}

void by_the_book(benchmark::State& state) {
  const std::vector<Eigen::Vector3f>& cloud = points(state.range(0) == 1);
  std::vector<std::uint32_t> selected;
  for (auto _ : state) selected = select_by_the_book(cloud);
  const auto ours =
      select_points(cloud, view(), kWhole, kOnSurface_m, Executor::with_threads(2), SurfaceRule::as_printed).value();
  if (selected.empty() ||
      std::abs(static_cast<double>(selected.size()) / static_cast<double>(ours.size()) - 1) > 1e-4) {
    state.SkipWithError("another selection");
  }
}

void around(benchmark::State& state) {
  const std::vector<Eigen::Vector3f>& cloud = points(state.range(0) == 1);
  const Executor executor = Executor::with_threads(static_cast<std::size_t>(state.range(1)));
  std::vector<std::uint32_t> selected;
  for (auto _ : state) selected = select_around(cloud, view(), brush().line, 0.03, executor).value();
  if (selected.empty()) state.SkipWithError("nothing selected");
  state.counters["selected"] = static_cast<double>(selected.size());
}

void orders_and_threads(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"in_rows", "threads"})
      ->ArgsProduct({{0, 1}, {1, 2}})
      ->Unit(benchmark::kMillisecond)
      ->UseRealTime();
}

BENCHMARK_CAPTURE(run, whole_picture_deep, kWhole, kAnyDepth_m)->Apply(orders_and_threads);
BENCHMARK_CAPTURE(run, whole_picture_surface, kWhole, kOnSurface_m)->Apply(orders_and_threads);
BENCHMARK_CAPTURE(run, whole_picture_below, kWhole, 0.6)->Apply(orders_and_threads);
BENCHMARK_CAPTURE(run, lasso_surface, lasso(), kOnSurface_m)->Apply(orders_and_threads);
BENCHMARK_CAPTURE(run, brush_surface, brush(), kOnSurface_m)->Apply(orders_and_threads);
BENCHMARK(around)->Apply(orders_and_threads);
BENCHMARK(by_the_book)->ArgName("in_rows")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
