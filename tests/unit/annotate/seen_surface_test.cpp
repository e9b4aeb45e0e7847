// SPDX-License-Identifier: Apache-2.0
// Areas on the surface against a z-buffer that draws points as the page does: what is seen is selected, and what is
// clearly hidden is not. Twenty clouds, three zooms, three point sizes, three rectangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "saccade/annotate/selection.hpp"
#include "support/drawn_points.hpp"
#include "support/effort.hpp"
#include "support/layered_scenes.hpp"
#include "support/naive_selection.hpp"

namespace saccade {
namespace {

constexpr int kWidth{240};
constexpr int kHeight{180};
const ScreenRectangle kAreas[]{{{90, 60}, {150, 120}}, {{20, 20}, {220, 160}}, {{100, 85}, {113, 94}}};

struct TakenShare {
  std::size_t taken{0}, all{0};
  void add(bool is_taken) {
    taken += is_taken ? 1 : 0;
    all += 1;
  }
  void add(const TakenShare& other) {
    taken += other.taken;
    all += other.all;
  }
  [[nodiscard]] double value() const { return all == 0 ? 1.0 : static_cast<double>(taken) / static_cast<double>(all); }
};

struct Judged {
  TakenShare seen;        ///< with a pixel, and the pixel in the middle shows the same side
  TakenShare any_pixel;   ///< with a pixel
  TakenShare hidden;      ///< farther behind what their squares show than the surface is thick, and 5 px
  TakenShare far_behind;  ///< farther behind than any point that may be selected
  void add(const Judged& other) {
    seen.add(other.seen);
    any_pixel.add(other.any_pixel);
    hidden.add(other.hidden);
    far_behind.add(other.far_behind);
  }
};

Judged judged(const test::LayeredScene& scene, const SelectionView& view, const test::DrawnPoints& drawn,
              double focal_px, SurfaceRule rule) {
  Judged all;
  for (const ScreenRectangle& area : kAreas) {
    std::vector<bool> taken(scene.positions_m.size());
    const auto selected = select_points(scene.positions_m, view, area, kOnSurface_m, Executor{}, rule).value();
    for (const std::uint32_t point : selected) taken[point] = true;
    for (std::size_t i = 0; i < taken.size(); ++i) {
      if (!drawn.is_in(i, area)) continue;
      if (drawn.pixels_of(i) > 0) {
        all.any_pixel.add(taken[i]);
        if (scene.sides[drawn.shown_before(i)] == scene.sides[i]) all.seen.add(taken[i]);
        continue;
      }
      if (i % 4 != 0) continue;  // a sample of what is hidden
      const double hidden_px = drawn.hidden_px(i, 1.0 / focal_px);
      if (hidden_px > seen_thickness_px(view.point_size_px) + 5.0) all.hidden.add(taken[i]);
      if (hidden_px > seen_depth_px(view.point_size_px)) all.far_behind.add(taken[i]);
    }
  }
  return all;
}

TEST(SeenSurface, AnAreaTakesWhatAZBufferShowsAndLeavesWhatItHides) {
  Judged all, printed;
  int cells{0};
  double least{1.0};
  for (const test::LayeredScene& scene : test::layered_scenes()) {
    for (const double focal_px : {120.0, 300.0, 900.0}) {
      for (const int size : {1, 4, 7}) {
        if (test::kSanitized && (focal_px != 300.0 || size != 4)) continue;
        SCOPED_TRACE(scene.name + ", " + std::to_string(focal_px) + " px, size " + std::to_string(size));
        const SelectionView view{test::perspective(Pose::Identity(), focal_px, kWidth, kHeight, 0.1, 10.0), kWidth,
                                 kHeight, size};
        const test::DrawnPoints drawn{scene.positions_m, view};
        const Judged cell = judged(scene, view, drawn, focal_px, SurfaceRule::seen);
        EXPECT_GE(cell.seen.value(), 0.95);
        EXPECT_EQ(cell.far_behind.taken, 0U);
        least = std::min(least, cell.seen.value());
        all.add(cell);
        if (size == 4) printed.add(judged(scene, view, drawn, focal_px, SurfaceRule::as_printed));
        ++cells;
      }
    }
  }
  EXPECT_EQ(cells, test::kSanitized ? 20 : 180);
  EXPECT_GE(all.seen.value(), 0.999);
  EXPECT_GE(all.any_pixel.value(), 0.95);  // also points that only show beside what is far before them
  EXPECT_LE(all.hidden.value(), test::kSanitized ? 0.03 : 0.02);  // the one zoom under sanitizers has more than all
  EXPECT_GT(all.hidden.all, test::kSanitized ? 5'000U : 50'000U);
  EXPECT_GT(all.far_behind.all, test::kSanitized ? 5'000U : 50'000U);
  EXPECT_LT(printed.seen.value(), 0.5);  // what was wrong: overlapping squares hide their own surface
  std::printf(
      "seen %.4f of %zu (least %.3f), with a pixel %.4f of %zu, hidden %.4f of %zu, far behind %zu of %zu; "
      "as printed, 4 px: seen %.3f of %zu\n",
      all.seen.value(), all.seen.all, least, all.any_pixel.value(), all.any_pixel.all, all.hidden.value(),
      all.hidden.all, all.far_behind.taken, all.far_behind.all, printed.seen.value(), printed.seen.all);
}

/// A rough box on a table of five million points, and an area well inside the box, in the page's usual picture.
TEST(SeenSurfaceEvidence, AnAreaOfABoxOfFiveMillionPoints) {
  test::SceneMaker maker{"box of five million", 7};
  maker.box(3'000'000, {0.0, 0.0, 1.0}, 0.2, 0.5, 0.001);
  maker.patch(2'000'000, {0.0, 0.1, 1.2}, {1.2, 0.0, 0.0}, {0.0, 0.25, -0.8}, 0.001, test::Side::wall);
  const test::LayeredScene scene = maker.made();
  const ScreenRectangle area{{620, 330}, {655, 390}};
  for (const double focal_px : {700.0, 1400.0}) {
    for (const int size : {2, 4, 8}) {
      const SelectionView view{test::perspective(Pose::Identity(), focal_px, 1280, 720, 0.05, 20.0), 1280, 720, size};
      const auto seen = select_points(scene.positions_m, view, area, kOnSurface_m, Executor{}).value();
      const auto printed =
          select_points(scene.positions_m, view, area, kOnSurface_m, Executor{}, SurfaceRule::as_printed).value();
      std::size_t front{0}, others{0};
      const test::DrawnPoints drawn{scene.positions_m, view};
      for (std::size_t i = 0; i < scene.sides.size(); ++i) {
        front += scene.sides[i] == test::Side::front && drawn.is_in(i, area) ? 1 : 0;
      }
      for (const std::uint32_t point : seen) others += scene.sides[point] == test::Side::front ? 0 : 1;
      EXPECT_GE(static_cast<double>(seen.size() - others), 0.95 * static_cast<double>(front));
      EXPECT_LE(others, seen.size() / 100);
      std::printf("%.0f px, size %d: %zu of %zu points of the front, %zu others; as printed %zu\n", focal_px, size,
                  seen.size() - others, front, others, printed.size());
    }
  }
}

}  // namespace
}  // namespace saccade
