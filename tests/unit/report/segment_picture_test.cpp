// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/segment_picture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "saccade/cloud/point_cloud.hpp"
#include "saccade/report/sheet.hpp"
#include "unit/report/pixels.hpp"

namespace saccade {
namespace {

/// Two squares side by side, 1 m in front of a camera at the origin, and a point without a place.
struct TwoSquares {
  std::vector<Eigen::Vector3f> positions_m;
  std::vector<std::uint32_t> labels;

  TwoSquares() {
    for (int x = -50; x <= 50; ++x) {
      for (int y = -30; y <= 30; ++y) {
        positions_m.emplace_back(0.01F * static_cast<float>(x), 0.01F * static_cast<float>(y), 1.0F);
        labels.push_back(x < 0 ? 0U : 1U);
      }
    }
    positions_m.emplace_back(std::nanf(""), 0.0F, 0.0F);
    labels.push_back(kUnlabelled);
  }
  [[nodiscard]] DrawnSegments drawn() const { return {positions_m, {}, labels, {}, 0.01}; }
  [[nodiscard]] Viewpoint view() const { return camera_view_of(positions_m, 400, 300); }
};

TEST(SegmentPicture, ShowsEachSegmentInItsColor) {
  const TwoSquares squares;
  const std::vector<Rgb8> colors{{255, 0, 0}, {0, 0, 255}};
  const ColorImage picture = draw_segments(squares.drawn(), squares.view(), colors, test::kSequential);
  EXPECT_EQ(picture.width(), 400);
  const std::size_t red = test::count(picture, colors[0]);
  const std::size_t blue = test::count(picture, colors[1]);
  EXPECT_GT(red, 30000U);
  EXPECT_NEAR(static_cast<double>(red), static_cast<double>(blue), 0.05 * static_cast<double>(blue));
  EXPECT_EQ(picture(100, 150), colors[0]);
  EXPECT_EQ(picture(300, 150), colors[1]);
}

TEST(SegmentPicture, PanelsNameSegmentsAndBrightenSalientOnes) {
  const TwoSquares squares;
  std::vector<SegmentMeasures> measures(2);
  measures[0].points = measures[1].points = 100;
  const Panel named = segments_panel(squares.drawn(), measures, squares.view(), test::kSequential);
  EXPECT_EQ(named.title, "2 segments");
  EXPECT_GT(test::count(named.image, test::is_dark), 10U);
  const std::vector<double> values{0.0, 0.4};
  const Panel salient = saliency_panel(squares.drawn(), values, 0.4, squares.view(), "saliency", test::kSequential);
  EXPECT_EQ(salient.image(100, 150), amount_colors()(0.0));
  EXPECT_EQ(salient.image(300, 150), amount_colors()(0.4 / salient.bar->high));
  EXPECT_GE(salient.bar->high, 0.4);
}

TEST(SegmentPicture, MarkedPointsHaveARim) {
  const TwoSquares squares;
  const std::vector<Rgb8> colors{{255, 0, 0}, {0, 0, 255}};
  const std::vector<std::uint32_t> marked{30 * 61 + 30};
  const Viewpoint view = squares.view();
  const Panel panel = marked_panel(squares.drawn(), colors, marked, view, "points", test::kSequential);
  EXPECT_EQ(panel.title, "points");
  const Eigen::Vector2d at = view.camera.project(squares.positions_m[marked[0]].cast<double>());
  const auto u = static_cast<int>(std::lround(at.x()));
  const auto v = static_cast<int>(std::lround(at.y()));
  EXPECT_EQ(panel.image(u, v), colors[0]);
  EXPECT_GT(test::count(panel.image, test::is_dark), 10U);
  EXPECT_EQ(panel.image(u + 9, v), colors[0]);
  const Rgb8 white{255, 255, 255};
  EXPECT_GT(test::count(panel.image, white), 4U);
  const ColorImage plain = draw_segments(squares.drawn(), view, colors, test::kSequential);
  EXPECT_EQ(test::count(plain, white) + test::count(plain, test::is_dark), 0U);
}

TEST(SegmentPicture, DrawsMeshesToo) {
  const std::vector<Eigen::Vector3f> corners{{-0.5F, -0.5F, 1.0F}, {0.5F, -0.5F, 1.0F}, {0.0F, 0.5F, 1.0F}};
  const std::vector<std::uint32_t> labels(3, 0);
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 2, 1}};
  const std::vector<Rgb8> colors{{200, 40, 40}};
  const ColorImage picture = draw_segments({corners, {}, labels, triangles, 0.01}, camera_view_of(corners, 200, 200),
                                           colors, test::kSequential);
  EXPECT_GT(picture(100, 80)[0], 2 * picture(100, 80)[1]);
}

TEST(SegmentPicture, OfNothingIsEmptyGround) {
  EXPECT_EQ(draw_segments({}, camera_view_of({}, 64, 48), {}, test::kSequential).width(), 64);
  EXPECT_EQ(saliency_panel({}, {}, 0.0, camera_view_of({}, 64, 48), "", test::kSequential).bar->high, 1.0);
  const TwoSquares squares;
  EXPECT_THROW((void)draw_segments({squares.positions_m, {}, {}, {}, 0.01}, squares.view(), {}, test::kSequential),
               ContractViolation);
}

TEST(SegmentPicture, NeighboursInNumberHaveOtherColors) {
  const std::vector<Rgb8> colors = segment_colors(100);
  ASSERT_EQ(colors.size(), 100U);
  for (std::size_t i = 1; i < colors.size(); ++i) {
    int difference{0};
    for (std::size_t c = 0; c < 3; ++c) difference += std::abs(int{colors[i][c]} - int{colors[i - 1][c]});
    EXPECT_GT(difference, 90) << i;
  }
  EXPECT_GT(std::set<Rgb8>(colors.begin(), colors.end()).size(), 90U);
}

}  // namespace
}  // namespace saccade
