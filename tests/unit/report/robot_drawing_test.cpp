// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/robot_drawing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analytic_map.hpp"
#include "saccade/report/exploration_pictures.hpp"
#include "saccade/report/internal/canvas.hpp"
#include "saccade/report/mesh_picture.hpp"
#include "unit/report/pixels.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;
using test::count;
using test::kSequential;

constexpr Rgb8 kPaper{236, 239, 243};

/// An upright sheet through p, facing −y, of one colour.
TriangleMesh sheet(const Vector3d& p, double half_m, const Rgb8& color) {
  TriangleMesh mesh;
  for (const auto& [x, z] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}) {
    mesh.vertices.push_back((p + half_m * Vector3d{x, 0.0, z}).cast<float>());
  }
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.colors.assign(4, color);
  return mesh;
}

/// Looks along +y from y = −2; 100 pixels per metre at y = 0.
Canvas canvas() {
  Viewpoint view;
  view.camera = {200, 150, 200.0, 200.0, 99.5, 74.5, 0.01, 100.0};
  view.T_world_camera = look_at({0.0, -2.0, 0.0}, {0.0, 0.0, 0.0}, Vector3d::UnitZ());
  return Canvas{view, kPaper, 1};
}

std::size_t differing(const ColorImage& a, const ColorImage& b) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < a.size(); ++i) n += a.data()[i] != b.data()[i] ? 1U : 0U;
  return n;
}

TEST(RobotDrawing, AnArmHidesWhatIsBehindItAndIsHidden) {
  Canvas both = canvas();
  draw_mesh(both, sheet({-0.2, 0.5, 0.0}, 0.4, {220, 30, 30}), kSequential);   // behind
  draw_mesh(both, sheet({0.25, -0.5, 0.0}, 0.1, {30, 220, 30}), kSequential);  // before
  const ColorImage without = both.finish();
  const RobotDrawing robot{.arm = sheet({0.0, 0.0, 0.0}, 0.3, {30, 30, 220})};
  draw_robot(both, robot, kSequential);
  const ColorImage with = both.finish();
  const auto is_blue = [](const Rgb8& c) { return c[2] > c[0] + 40 && c[2] > c[1] + 40; };
  EXPECT_TRUE(is_blue(with(100, 75)));
  EXPECT_TRUE(is_blue(with(75, 75))) << "before the red sheet";
  EXPECT_EQ(with(132 - 5, 75), without(132 - 5, 75)) << "behind the green one";
  EXPECT_EQ(with(55, 75), without(55, 75)) << "beside the arm";
  EXPECT_NEAR(static_cast<double>(differing(with, without)), 60.0 * 60.0 - 13.0 * 26.0, 350.0);
}

TEST(RobotDrawing, AnOpacityLetsTheMapBeSeenThroughTheArm) {
  Canvas half = canvas();
  Canvas full = canvas();
  RobotDrawing robot{.arm = sheet({0.0, 0.0, 0.0}, 0.3, {30, 30, 220})};
  draw_robot(full, robot, kSequential);
  robot.opacity = 0.5;
  draw_robot(half, robot, kSequential);
  const Rgb8 solid = full.finish()(100, 75);
  const Rgb8 faint = half.finish()(100, 75);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(faint[c], 0.5 * (solid[c] + kPaper[c]), 1.0);
  EXPECT_EQ(half.finish()(10, 10), kPaper);
  Canvas none = canvas();
  robot.opacity = 0.0;
  draw_robot(none, robot, kSequential);
  EXPECT_EQ(none.finish(), canvas().finish());
  robot.opacity = 1.5;
  EXPECT_THROW(draw_robot(none, robot, kSequential), ContractViolation);
}

TEST(RobotDrawing, APathIsALineAndFaintWhereItIsHidden) {
  Canvas drawn = canvas();
  draw_mesh(drawn, sheet({0.0, -0.5, 0.0}, 0.1, {90, 90, 90}), kSequential);
  const ColorImage without = drawn.finish();
  draw_robot(drawn, {.arm = {}, .p_world_path = {{-0.5, 0.0, 0.0}, {0.5, 0.0, 0.0}, {0.5, 0.0, 0.3}}}, kSequential);
  const ColorImage with = drawn.finish();
  for (const int u : {60, 80, 120, 140}) EXPECT_TRUE(with(u, 74) == path_color() || with(u, 75) == path_color()) << u;
  EXPECT_TRUE(with(149, 60) == path_color() || with(150, 60) == path_color());
  EXPECT_NE(with(100, 75), path_color()) << "behind the sheet";
  EXPECT_NE(with(100, 75), without(100, 75)) << "but to be seen";
  EXPECT_GT(count(with, path_color()), 200U);
  EXPECT_LT(differing(with, without), 600U);
}

TEST(RobotDrawing, ThePictureIsTakenFromBesideTheBase) {
  constexpr double kDegree{std::numbers::pi / 180.0};
  const Vector3d middle{0.2, 0.1, 0.0};
  const auto base = [&](double degrees) {
    return Vector3d{middle + Vector3d{std::cos(degrees * kDegree), std::sin(degrees * kDegree), 0.5}};
  };
  const auto azimuth_deg = [&](double base_deg, double wanted_deg) {
    return std::remainder(azimuth_beside(base(base_deg), middle, wanted_deg * kDegree) / kDegree, 360.0);
  };
  EXPECT_NEAR(azimuth_deg(0.0, 150.0), 150.0, 1e-9) << "far enough";
  EXPECT_NEAR(azimuth_deg(0.0, 30.0), 125.0, 1e-9);
  EXPECT_NEAR(azimuth_deg(0.0, -30.0), -125.0, 1e-9);
  EXPECT_NEAR(azimuth_deg(170.0, -170.0), -65.0, 1e-9) << "across the seam";
  EXPECT_EQ(azimuth_beside(middle, middle, 0.3), 0.3) << "a base below everything";
}

/// Known free space with a wall in its middle.
TsdfSnapshot walled_map() {
  TsdfConfig config;
  config.voxel_size_m = 0.02;
  return test::map_of(config, {{-24, -24, -24}, {24, 24, 24}}, [](const Vector3d& p) {
    return test::box_sdf(p, Vector3d::Zero(), {0.3, 0.03, 0.2});
  });
}

TEST(RobotDrawing, MapAndCandidatesShowTheArmAndThePathAndChangeNowhereElse) {
  const TsdfSnapshot map = walled_map();
  const Box box{{-0.4, -0.4, -0.4}, {0.4, 0.4, 0.4}};
  MapPictureConfig config;
  config.overview = {.width = 360, .height = 270};
  config.margin_m = 0.0;  // unknown begins beyond the box
  const ColorImage without = map_picture(map, box, kSequential, config);
  const RobotDrawing nothing{};
  config.robot = &nothing;
  EXPECT_EQ(map_picture(map, box, kSequential, config), without);
  RobotDrawing robot;
  robot.arm = sheet({0.0, -0.2, 0.0}, 0.1, {30, 30, 220});
  robot.p_world_path = {{0.1, -0.2, 0.3}, {0.3, -0.2, 0.3}};
  config.robot = &robot;
  const ColorImage with = map_picture(map, box, kSequential, config);
  EXPECT_GT(count(with, path_color()), 20U);
  EXPECT_EQ(map_picture(map, box, Executor::with_threads(3, Executor::Backend::std_thread), config), with);
  Canvas only{overview_of(box, config.overview), kPaper, 1};
  draw_robot(only, robot, kSequential);
  const ColorImage drawn = only.finish();
  std::size_t changed = 0;
  for (std::size_t i = 0; i < with.size(); ++i) {
    if (with.data()[i] == without.data()[i]) continue;
    ++changed;
    ASSERT_NE(drawn.data()[i], kPaper);
  }
  EXPECT_GT(changed, 500U);

  const Region region = Sphere{Vector3d::Zero(), 0.2};
  const std::vector<ScoredPose> candidates{{look_at({0.0, -0.4, 0.3}, Vector3d::Zero()), 10.0}};
  CandidatesPictureConfig small;
  small.overview = {.width = 360, .height = 270};
  CandidatesScene scene{map, region, candidates, candidates[0].T_world_camera, {}};
  const ColorImage plain = candidates_picture(scene, kSequential, small);
  scene.robot = &nothing;
  EXPECT_EQ(candidates_picture(scene, kSequential, small), plain);
  scene.robot = &robot;
  EXPECT_GT(count(candidates_picture(scene, kSequential, small), path_color()), count(plain, path_color()) + 20U);
}

TEST(RobotDrawing, TheBoxFillsThePictureWhereverTheBaseIs) {
  const Box box{{-0.4, -0.4, -0.4}, {0.4, 0.4, 0.4}};
  RobotDrawing robot;
  robot.p_world_base = Vector3d{-0.6, -0.8, 0.4};
  const OverviewConfig config{.width = 360, .height = 270};
  const Viewpoint view = overview_with(&robot, corners_of(box), Vector3d::Zero(), config);
  double least_px{359.0};
  double most_px{0.0};
  for (const Vector3d& p : corners_of(box)) {
    const Vector3d p_camera = view.T_world_camera.inverse() * p;
    ASSERT_GT(p_camera.z(), 0.0);
    const Eigen::Vector2d at = view.camera.project(p_camera);
    EXPECT_TRUE(at.x() > 0.0 && at.x() < 359.0 && at.y() > 0.0 && at.y() < 269.0) << at.transpose();
    least_px = std::min({least_px, at.x(), at.y()});
    most_px = std::max({most_px, at.x(), at.y()});
  }
  EXPECT_GT(most_px - least_px, 200.0) << "the box, not the arm's base, decides how near the camera comes";
  const Vector3d from = view.T_world_camera.translation();
  EXPECT_LT(from.head<2>().normalized().dot(robot.p_world_base->head<2>().normalized()), 0.0);
  EXPECT_EQ(overview_with(nullptr, {box.min, box.max}, Vector3d::Zero(), config).T_world_camera.matrix(),
            overview_of(std::vector<Vector3d>{box.min, box.max}, config).T_world_camera.matrix());
}

}  // namespace
}  // namespace saccade
