// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/exploration_pictures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analytic_map.hpp"
#include "saccade/report/internal/canvas.hpp"
#include "saccade/report/sheet.hpp"
#include "unit/report/pixels.hpp"

namespace saccade {
namespace {

using test::count;
using test::is_unknown;
using test::kSequential;

constexpr Rgb8 kChosen{214, 28, 92};
constexpr Rgb8 kEarlier{112, 119, 131};
constexpr Rgb8 kNoGainGrey{176, 180, 188};
constexpr double kNotEvaluated{std::numeric_limits<double>::quiet_NaN()};

const Sphere kRegion{{0.0, 0.0, 0.0}, 0.15};

/// A ball of 10 cm in a known cube of ±32 cm; 1 cm voxels; the region around it forgotten.
TsdfSnapshot forgotten_ball() {
  TsdfConfig config;
  config.voxel_size_m = 0.01;
  TsdfMap map{test::map_of(config, {{-32, -32, -32}, {32, 32, 32}},
                           [](const Eigen::Vector3d& p) { return test::sphere_sdf(p, Eigen::Vector3d::Zero(), 0.1); })};
  EXPECT_TRUE(map.forget(kRegion).ok());
  return map.snapshot();
}

constexpr std::size_t kPlaces{24};
constexpr std::size_t kRolls{3};

/// A ring of places with three rolls each; half of the places gain something, the best roll 1000 − 10 · place.
std::vector<ScoredPose> ring() {
  std::vector<ScoredPose> candidates;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    const double angle = static_cast<double>(i) * 2.0 * std::numbers::pi / kPlaces;
    const Eigen::Vector3d p{0.5 * std::cos(angle), 0.5 * std::sin(angle), 0.3};
    for (std::size_t roll = 0; roll < kRolls; ++roll) {
      const Pose pose = look_at(p, kRegion.center, Eigen::Vector3d::UnitZ(), static_cast<double>(roll));
      const double gain = 1000.0 - 10.0 * static_cast<double>(i) - 300.0 * static_cast<double>(roll);
      candidates.push_back({pose, i < kPlaces / 2 ? gain : 0.0});
    }
  }
  return candidates;
}

CandidatesPictureConfig small() {
  CandidatesPictureConfig config;
  config.overview.width = 360;
  config.overview.height = 270;
  return config;
}

/// The viewpoint that shows the region and all candidates.
Viewpoint viewpoint_of(const std::vector<ScoredPose>& candidates) {
  std::vector<Eigen::Vector3d> shown = corners_of(bounds(Region{kRegion}));
  for (const ScoredPose& candidate : candidates) shown.emplace_back(candidate.T_world_camera.translation());
  return overview_of(shown, small().overview);
}

struct Pixels {
  std::size_t count{0};
  Eigen::Vector2d mean{0.0, 0.0};
};
Pixels pixels_of(const ColorImage& picture, const Rgb8& color) {
  Pixels found;
  for (int v = 0; v < picture.height(); ++v) {
    for (int u = 0; u < picture.width(); ++u) {
      if (picture(u, v) != color) continue;
      found.mean += Eigen::Vector2d{u, v};
      ++found.count;
    }
  }
  if (found.count > 0) found.mean /= static_cast<double>(found.count);
  return found;
}

TEST(CandidatesPicture, ShowsTheChosenViewWhereItIs) {
  const std::vector<ScoredPose> candidates = ring();
  const TsdfSnapshot map = forgotten_ball();
  const Viewpoint view = viewpoint_of(candidates);
  const Canvas canvas{view, {}, 1};
  std::size_t tried{0};
  for (std::size_t i = 0; i < candidates.size(); i += 3 * kRolls) {
    const Pose& chosen = candidates[i].T_world_camera;
    const ColorImage picture = candidates_picture({map, kRegion, candidates, chosen, {}}, kSequential, small());
    const auto tip = canvas.project(chosen.translation());
    const auto ahead = canvas.project(chosen * Eigen::Vector3d{0.0, 0.0, 0.1});
    ASSERT_TRUE(tip && ahead);
    const Pixels drawn = pixels_of(picture, kChosen);
    EXPECT_GT(drawn.count, 60U);
    EXPECT_LT((drawn.mean - (*tip + *ahead) / 2.0).norm(), 20.0) << "place " << i / kRolls;
    ++tried;
  }
  EXPECT_EQ(tried, 8U);
}

TEST(CandidatesPicture, ColorsEachPlaceByItsBestGain) {
  const std::vector<ScoredPose> candidates = ring();
  const TsdfSnapshot map = forgotten_ball();
  const Pose aside = candidates.back().T_world_camera;
  const ColorImage picture = candidates_picture({map, kRegion, candidates, aside, {}}, kSequential, small());
  const Canvas canvas{viewpoint_of(candidates), {}, 1};
  std::size_t compared{0};
  for (std::size_t place = 0; place < kPlaces / 2; ++place) {
    const auto at = canvas.project(candidates[place * kRolls].T_world_camera.translation());
    ASSERT_TRUE(at);
    const auto u = static_cast<int>(std::lround(at->x()));
    const auto v = static_cast<int>(std::lround(at->y()));
    const Rgb8 want = amount_colors()((1000.0 - 10.0 * static_cast<double>(place)) / 1000.0);
    compared += picture(u, v) == want ? 1 : 0;
  }
  EXPECT_GE(compared, 9U) << "the region may hide a few";
  EXPECT_GT(count(picture, kNoGainGrey), 60U);
  EXPECT_GT(count(picture, is_unknown), 600U) << "the forgotten ball";
  EXPECT_EQ(picture.width(), 360);
  EXPECT_GT(picture.height(), 270) << "the scale of gains below";
  EXPECT_GT(count(picture, amount_colors()(0.5 / 340.0)), 5U) << "its left end";
}

TEST(CandidatesPicture, OrderAndThreadsChangeNothing) {
  std::vector<ScoredPose> candidates = ring();
  const TsdfSnapshot map = forgotten_ball();
  const Pose chosen = candidates.front().T_world_camera;
  const ColorImage picture = candidates_picture({map, kRegion, candidates, chosen, {}}, kSequential, small());
  const Executor three = Executor::with_threads(3, Executor::Backend::std_thread);
  EXPECT_EQ(candidates_picture({map, kRegion, candidates, chosen, {}}, three, small()), picture);
  for (std::size_t i = 0; i + kRolls <= candidates.size(); i += kRolls) std::swap(candidates[i], candidates[i + 2]);
  EXPECT_EQ(candidates_picture({map, kRegion, candidates, chosen, {}}, kSequential, small()), picture);
}

TEST(CandidatesPicture, ShowsTheWholeRegion) {
  constexpr Rgb8 kOutline{214, 92, 22};
  const Box wide{{-1.0, -0.6, 0.0}, {1.0, 0.6, 0.1}};
  const std::vector<ScoredPose> candidates = ring();
  const ColorImage picture = candidates_picture(
      {forgotten_ball(), wide, candidates, candidates.front().T_world_camera, {}}, kSequential, small());
  EXPECT_GT(count(picture, kOutline), 60U);
  for (int u = 0; u < picture.width(); ++u) EXPECT_NE(picture(u, 269), kOutline) << u;
  for (int v = 0; v < 270; ++v) {
    EXPECT_NE(picture(0, v), kOutline) << v;
    EXPECT_NE(picture(picture.width() - 1, v), kOutline) << v;
  }
}

TEST(CandidatesPicture, ShowsEarlierViewsInGrey) {
  const std::vector<ScoredPose> candidates = ring();
  const TsdfSnapshot map = forgotten_ball();
  const std::vector<Pose> earlier{candidates[6 * kRolls].T_world_camera, candidates[9 * kRolls].T_world_camera};
  const Pose chosen = candidates.front().T_world_camera;
  const ColorImage without = candidates_picture({map, kRegion, candidates, chosen, {}}, kSequential, small());
  const ColorImage with = candidates_picture({map, kRegion, candidates, chosen, earlier}, kSequential, small());
  EXPECT_GT(count(with, kEarlier), count(without, kEarlier) + 60);
  EXPECT_EQ(count(with, kChosen), count(without, kChosen));
}

TEST(CandidatesPicture, NotEvaluatedIsNoGain) {
  std::vector<ScoredPose> candidates = ring();
  const TsdfSnapshot map = forgotten_ball();
  for (ScoredPose& candidate : candidates) candidate.gain = kNotEvaluated;
  const Pose chosen = candidates.front().T_world_camera;
  const ColorImage none = candidates_picture({map, kRegion, candidates, chosen, {}}, kSequential, small());
  EXPECT_EQ(none.height(), 270) << "no scale";
  EXPECT_GT(count(none, kNoGainGrey), 60U);
  EXPECT_GT(count(none, kChosen), 60U);
  candidates[1].gain = 10.0;  // one roll of the first place
  EXPECT_GT(candidates_picture({map, kRegion, candidates, chosen, {}}, kSequential, small()).height(), 270);
  EXPECT_GT(count(candidates_picture({map, kRegion, {}, chosen, {}}, kSequential, small()), kChosen), 60U);
}

TEST(SeenPicture, ShowsColorBesideDepthWithItsScale) {
  Frame frame;
  frame.depth = DepthImage{64, 48, 1.0F};
  frame.color = ColorImage{64, 48, {10, 200, 30}};
  const ColorImage picture = seen_picture(frame, {0.0, 2.0});
  EXPECT_GE(picture.width(), 2 * 64);
  EXPECT_EQ(picture(5, 5), (Rgb8{10, 200, 30}));
  EXPECT_EQ(picture(picture.width() - 5, 5), depth_colors()(0.5));
  EXPECT_GT(picture.height(), 48) << "the scale";
  frame.color.reset();
  EXPECT_EQ(seen_picture(frame, {0.0, 2.0}).width(), 64) << "depth alone";
}

TEST(SeenPicture, ReducesColorByAveragingAndDepthByChoosing) {
  Frame frame;
  frame.depth = DepthImage{640, 480};
  frame.color = ColorImage{640, 480};
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 640; ++u) {
      frame.depth(u, v) = u < 320 ? 1.0F : 3.0F;
      (*frame.color)(u, v) = (u + v) % 2 == 0 ? Rgb8{200, 200, 200} : Rgb8{100, 100, 100};
    }
  }
  const ColorImage picture = seen_picture(frame, {0.0, 4.0}, 320);
  EXPECT_EQ(picture(100, 100), (Rgb8{150, 150, 150}));
  const int depth_x = picture.width() - 320;
  EXPECT_EQ(count(picture, depth_colors()(0.25)) / 240, 160U);
  EXPECT_EQ(picture(depth_x + 159, 100), depth_colors()(0.25));
  EXPECT_EQ(picture(depth_x + 160, 100), depth_colors()(0.75));
  EXPECT_THROW((void)seen_picture(Frame{}, {}), ContractViolation);
}

TEST(MapPicture, ShowsUnknownInTheBoxAndNothingBeyond) {
  const TsdfSnapshot map = forgotten_ball();
  MapPictureConfig config;
  config.overview.width = 360;
  config.overview.height = 270;
  config.margin_m = 0.0;
  TsdfSnapshot bounded = map;
  bounded.config.workspace = Box{{-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2}};
  const ColorImage picture = map_picture(bounded, *bounded.config.workspace, kSequential, config);
  EXPECT_GT(count(picture, is_unknown), 5000U);
  EXPECT_EQ(picture(2, 2), TernaryPictureConfig{}.background);
  EXPECT_EQ(picture.height(), 270);
  const ColorImage beside = map_picture(bounded, {{0.2, 0.2, 0.2}, {0.3, 0.3, 0.3}}, kSequential, config);
  EXPECT_LT(count(beside, is_unknown), 100U) << "no more than the edge of the blue axis";
}

}  // namespace
}  // namespace saccade
