// SPDX-License-Identifier: Apache-2.0
// Explorations on surfels: measured like those on a volume, and the same whatever the number of threads.
#include <gtest/gtest.h>

#include <numbers>

#include "saccade/scene/scene.hpp"
#include "saccade/trial/simulated_run.hpp"
#include "saccade/trial/surfel_measures.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

constexpr int kSurfelViews{test::kSanitized ? 1 : 2};

const GroundTruth& few_things() {
  static const GroundTruth truth =
      GroundTruth::build(RayScene::build(random_clutter(5, 4)).value(), 0.008, Executor::with_threads(2)).value();
  return truth;
}

SimulatedRunConfig on_surfels() {
  SimulatedRunConfig config;
  config.map_kind = MapKind::surfels;
  config.voxel_size_m = 0.015;
  config.free_voxel_m = 0.03;
  config.camera = PinholeCamera{120, 90, 98.4375, 98.4375, 59.5, 44.5, 0.5, 2.0};
  config.exploration.max_views = kSurfelViews;
  config.exploration.oscillation_frames = 3;
  return config;
}

TEST(SurfelRun, ShowsMoreWithEachView) {
  const RunRecord run = run_simulated(few_things(), on_surfels(), Executor::with_threads(2)).value();
  ASSERT_EQ(run.views.size(), static_cast<std::size_t>(kSurfelViews));
  const double before = run.scan.measures.coverage.value();
  EXPECT_GT(before, 0.1);
  EXPECT_GT(run.final().coverage.value(), before + 0.1);
  EXPECT_LT(run.final().accuracy_m.value(), 0.002) << "discs stand off the surface";
  EXPECT_FALSE(run.final().unknown_near_objects);
  for (const ViewRecord& view : run.views) {
    EXPECT_GT(view.gain_predicted, 2.0);
    EXPECT_GT(view.gain_observed, 0.0);
    EXPECT_LE(view.gain_observed, view.gain_predicted * 1.000001);
  }
}

TEST(SurfelRun, TheThreadCountChangesNoBit) {
  const RunRecord one = run_simulated(few_things(), on_surfels(), Executor::with_threads(1)).value();
  const RunRecord three = run_simulated(few_things(), on_surfels(), Executor::with_threads(3)).value();
  EXPECT_EQ(one.scan.measures, three.scan.measures);
  ASSERT_EQ(one.views.size(), three.views.size());
  ASSERT_FALSE(one.views.empty());
  for (std::size_t i = 0; i < one.views.size(); ++i) {
    EXPECT_EQ(one.views[i].T_world_camera.matrix(), three.views[i].T_world_camera.matrix());
    EXPECT_EQ(one.views[i].gain_predicted, three.views[i].gain_predicted);
    EXPECT_EQ(one.views[i].measures, three.views[i].measures);
  }
}

TEST(SurfelRun, AnOwnPlannerNeedsAVolume) {
  ViewPlanner planner = make_planner(SimulatedRunConfig{}, on_surfels().camera, std::vector<Region>{Box{}});
  const auto refused = run_simulated(few_things(), on_surfels(), planner, Executor{});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::invalid_argument);
}

TEST(SurfelMesh, HexagonsLieInTheirDiscs) {
  SurfelMap surfels;
  surfels.resize(3);
  surfels.discs[0] = {{0.0F, 0.0F, 0.1F}, 0.02F, Eigen::Vector3f{1.0F, 2.0F, 2.0F} / 3.0F, 4.0F};
  surfels.discs[1] = {{5.0F, 0.0F, 0.1F}, 0.02F, Eigen::Vector3f::UnitZ(), 4.0F};  // outside the box
  surfels.discs[2] = {{0.0F, 0.1F, 0.1F}, 0.02F, Eigen::Vector3f::UnitZ(), 0.5F};  // too light
  const TriangleMesh mesh = surfel_mesh(surfels, 1.0, Box{{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}});
  ASSERT_EQ(mesh.vertices.size(), 6U);
  ASSERT_EQ(mesh.triangles.size(), 4U);
  float area_m2{0.0F};
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const Eigen::Vector3f out = vertex - surfels.discs[0].position_m;
    EXPECT_NEAR(out.norm(), 0.02F, 1e-6F);
    EXPECT_NEAR(out.dot(surfels.discs[0].normal), 0.0F, 1e-6F);
  }
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3f a = mesh.vertices[triangle[0]];
    area_m2 += 0.5F * (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a).norm();
  }
  EXPECT_NEAR(area_m2, 1.5F * std::numbers::sqrt3_v<float> * 0.02F * 0.02F, 1e-6F);
}

}  // namespace
}  // namespace saccade
