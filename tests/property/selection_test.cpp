// SPDX-License-Identifier: Apache-2.0
// Selections of random clouds, views and shapes against their definition, and how the tools' selections contain
// another.
#include "saccade/annotate/selection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <random>

#include "support/effort.hpp"
#include "support/naive_selection.hpp"
#include "support/parallel_backend.hpp"

namespace saccade {
namespace {

using Indices = std::vector<std::uint32_t>;

constexpr int kSelectionRuns{test::scaled_cases(400)};
constexpr int kShapesPerRun{4};

class RandomSelection {
 public:
  explicit RandomSelection(std::uint32_t seed) : rng_{seed} {
    on_grid_ = integer(0, 2) == 0;
    view_.width = integer(1, 60);
    view_.height = integer(1, 60);
    view_.point_size_px = integer(0, 3) == 0 ? integer(1, 64) : integer(1, 6);
    const Pose T_world_camera = on_grid_ ? Pose{Eigen::Translation3d{0.0, 0.0, -2.0}}
                                         : look_at(direction() * uniform(0.2, 3.0), 0.3 * direction(),
                                                   Eigen::Vector3d::UnitZ(), uniform(-3.0, 3.0));
    const double near_m = uniform(0.01, 1.0);
    const double far_m = near_m + uniform(0.5, 5.0);
    view_.clip_world = integer(0, 1) == 0 ? test::perspective(T_world_camera, uniform(10.0, 80.0), view_.width,
                                                              view_.height, near_m, far_m)
                                          : test::orthographic(T_world_camera, on_grid_ ? 16.0 : uniform(5.0, 40.0),
                                                               view_.width, view_.height, -near_m, far_m);
    const int count = integer(0, 300);
    for (int i = 0; i < count; ++i) {
      Eigen::Vector3f p = direction().cast<float>();
      if (on_grid_) p = (8.0F * p).array().round() / 8.0F;  // borders, depths and places that coincide
      if (integer(0, 30) == 0) p[integer(0, 2)] = std::numeric_limits<float>::quiet_NaN();
      if (integer(0, 30) == 0) p[integer(0, 2)] = -std::numeric_limits<float>::infinity();
      positions_m_.push_back(p);
    }
  }
  [[nodiscard]] const SelectionView& view() const { return view_; }
  [[nodiscard]] const std::vector<Eigen::Vector3f>& positions_m() const { return positions_m_; }
  double uniform(double lo, double hi) { return std::uniform_real_distribution<double>{lo, hi}(rng_); }
  int integer(int lo, int hi) { return std::uniform_int_distribution<int>{lo, hi}(rng_); }

  ScreenPoint screen_point() {
    const ScreenPoint p{uniform(-0.3, 1.3) * view_.width, uniform(-0.3, 1.3) * view_.height};
    return on_grid_ ? ScreenPoint{(2.0 * p).array().round() / 2.0} : p;
  }
  std::vector<ScreenPoint> screen_points(int fewest, int most) {
    std::vector<ScreenPoint> points(static_cast<std::size_t>(integer(fewest, most)));
    for (ScreenPoint& p : points) p = screen_point();
    return points;
  }
  ScreenShape shape(int kind) {
    if (kind == 0) return ScreenRectangle{screen_point(), screen_point()};
    if (kind == 1) return ScreenPolygon{screen_points(3, 12)};
    return ScreenStroke{screen_points(1, 6), on_grid_ ? 0.5 * integer(1, 20) : uniform(0.1, 15.0)};
  }

 private:
  Eigen::Vector3d direction() {
    return Eigen::Vector3d::NullaryExpr([&] { return uniform(-1.0, 1.0); });
  }

  std::mt19937 rng_;
  bool on_grid_{false};
  SelectionView view_;
  std::vector<Eigen::Vector3f> positions_m_;
};

bool is_part(const Indices& part, const Indices& whole) {
  return std::includes(whole.begin(), whole.end(), part.begin(), part.end());
}

TEST(SelectionProperty, EqualsItsDefinitionAndDeeperSelectionsContainShallowerOnes) {
  std::size_t selected{0}, hidden{0};
  int compared{0};
  for (std::uint32_t seed = 1; seed <= kSelectionRuns; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomSelection random{seed};
    const Executor executor = Executor::with_threads(1 + seed % 3, test::kParallelBackend);
    test::NaivePicture picture{random.positions_m(), random.view()};
    for (int i = 0; i < kShapesPerRun; ++i) {
      const ScreenShape shape = random.shape(i % 3);
      const double below_m = random.uniform(0.0, 0.8);
      const auto select = [&](double at_most_m, SurfaceRule rule = SurfaceRule::seen) {
        return select_points(random.positions_m(), random.view(), shape, at_most_m, executor, rule).value();
      };
      const Indices surface = select(kOnSurface_m);
      const Indices below = select(below_m);
      const Indices deep = select(kAnyDepth_m);
      ASSERT_EQ(surface, test::naive_select(picture, shape, kOnSurface_m));
      ASSERT_EQ(below, test::naive_select(picture, shape, below_m));
      ASSERT_EQ(deep, test::naive_select(picture, shape, kAnyDepth_m));
      const Indices nearest = select(kOnSurface_m, SurfaceRule::as_printed);
      const Indices behind_nearest = select(below_m, SurfaceRule::as_printed);
      ASSERT_EQ(nearest, test::naive_select(picture, shape, kOnSurface_m, SurfaceRule::as_printed));
      ASSERT_EQ(behind_nearest, test::naive_select(picture, shape, below_m, SurfaceRule::as_printed));
      ASSERT_TRUE(is_part(nearest, surface));
      ASSERT_TRUE(is_part(behind_nearest, below));
      ASSERT_TRUE(is_part(surface, below));
      ASSERT_TRUE(is_part(below, deep));
      if (const auto* rectangle = std::get_if<ScreenRectangle>(&shape)) {
        const ScreenPoint a = rectangle->corner;
        const ScreenPoint b = rectangle->opposite;
        const ScreenPolygon lasso{{a, {a.x(), b.y()}, b, {b.x(), a.y()}}};
        ASSERT_EQ(below, select_points(random.positions_m(), random.view(), lasso, below_m, executor).value());
      }
      selected += surface.size();
      hidden += deep.size() - surface.size();
      ++compared;
    }
  }
  EXPECT_EQ(compared, kSelectionRuns * kShapesPerRun);
  EXPECT_GT(selected, static_cast<std::size_t>(compared));
  EXPECT_GT(hidden, static_cast<std::size_t>(compared));
  std::printf("%d selections, %zu points, %zu more that are hidden\n", compared, selected, hidden);
}

/// The definition of select_around.
Indices naive_around(const RandomSelection& random, const std::vector<ScreenPoint>& line, double radius_m) {
  const SelectionView& view = random.view();
  const std::vector<test::NaivePosition> positions = test::naive_positions(view, random.positions_m());
  const ScreenProjection project{view};
  Indices selected;
  std::vector<Eigen::Vector3d> centres_m;
  for (int v = 0; v < view.height; ++v) {
    for (int u = 0; u < view.width; ++u) {
      if (!test::naive_contains(ScreenStroke{line, 0.75}, {u + 0.5, v + 0.5})) continue;
      const float depth_m = test::naive_depth_m(positions, 0.5 * view.point_size_px, u, v);
      if (std::isfinite(depth_m)) centres_m.push_back(project.place(u + 0.5, v + 0.5, depth_m));
    }
  }
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!positions[i].in_view) continue;
    for (const Eigen::Vector3d& centre : centres_m) {
      if ((random.positions_m()[i].cast<double>() - centre).squaredNorm() > radius_m * radius_m) continue;
      selected.push_back(static_cast<std::uint32_t>(i));
      break;
    }
  }
  return selected;
}

TEST(SelectionProperty, BallsEqualTheirDefinition) {
  std::size_t selected{0};
  for (std::uint32_t seed = 1; seed <= kSelectionRuns; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomSelection random{seed};
    const Executor executor = Executor::with_threads(1 + seed % 3, test::kParallelBackend);
    const std::vector<ScreenPoint> line = random.screen_points(1, 4);
    const double radius_m = random.uniform(0.01, 0.5);
    const Indices around = select_around(random.positions_m(), random.view(), line, radius_m, executor).value();
    ASSERT_EQ(around, naive_around(random, line, radius_m));
    selected += around.size();
  }
  EXPECT_GT(selected, static_cast<std::size_t>(kSelectionRuns));
  std::printf("%d selections, %zu points\n", kSelectionRuns, selected);
}

TEST(SelectionProperty, TheThreadCountNeverChangesASelectionOfManyPoints) {
  std::mt19937 rng{7};
  std::normal_distribution<float> about{0.0F, 0.3F};
  std::vector<Eigen::Vector3f> positions_m(300'000 / test::kEffortDivisor);
  for (Eigen::Vector3f& p : positions_m) p = {about(rng), about(rng), 1.5F + about(rng)};
  const SelectionView view{test::perspective(Pose::Identity(), 150.0, 160, 120, 0.1, 5.0), 160, 120, 3};
  const ScreenPolygon lasso{{{20, 10}, {150, 30}, {120, 110}, {60, 60}, {15, 90}}};
  std::array<std::array<Indices, 5>, 3> found;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Executor executor = Executor::with_threads(i + 1, test::kParallelBackend);
    found[i] = {select_points(positions_m, view, lasso, kOnSurface_m, executor).value(),
                select_points(positions_m, view, lasso, 0.05, executor).value(),
                select_points(positions_m, view, lasso, kAnyDepth_m, executor).value(),
                select_around(positions_m, view, lasso.corners, 0.05, executor).value(),
                select_points(positions_m, view, lasso, kOnSurface_m, executor, SurfaceRule::as_printed).value()};
  }
  EXPECT_EQ(found[0], found[1]);
  EXPECT_EQ(found[0], found[2]);
  for (const Indices& indices : found[0]) EXPECT_GT(indices.size(), 500U);
}

}  // namespace
}  // namespace saccade
