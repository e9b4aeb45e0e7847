// SPDX-License-Identifier: Apache-2.0
// Height and axes of boxes of any size and turn are those of the box, and off by as much as its mesh is.
#include "saccade/trial/metrics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <numbers>
#include <random>

#include "saccade/scene/solids.hpp"
#include "support/effort.hpp"
#include "support/placed_object.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr std::uint64_t kBoxSeed{71};

Scene box_on_table(const Vector3d& size_m, double turn_rad) {
  Scene scene;
  scene.name = "box";
  scene.workspace = Box{{-0.5, -0.5, -0.03}, {0.5, 0.5, 0.4}};
  SceneObject table = test::placed("table", BoxShape{{1.2, 1.2, 0.04}}, {0.0, 0.0, -0.04});
  table.support = true;
  SceneObject box = test::placed("box", BoxShape{size_m}, {0.1, -0.05, 0.0});
  box.T_world_object.linear() = Eigen::AngleAxisd{turn_rad, Vector3d::UnitZ()}.toRotationMatrix();
  scene.objects = {table, box};
  return scene;
}

TEST(ObjectShape, BoxesAreMeasuredByTheirSides) {
  const int cases = test::scaled_cases(40);
  std::printf("seed %llu, %d cases\n", static_cast<unsigned long long>(kBoxSeed), cases);
  std::mt19937_64 random{kBoxSeed};
  const auto between = [&random](double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random);
  };
  for (int i = 0; i < cases; ++i) {
    const Vector3d size_m{between(0.04, 0.25), between(0.04, 0.25), between(0.02, 0.2)};
    const double turn_rad = between(0.0, std::numbers::pi);
    const double larger_m = between(-0.008, 0.012);  // on every side and at the top
    const RayScene scene = *RayScene::build(box_on_table(size_m, turn_rad));
    const ObjectShapes shapes = *ObjectShapes::build(scene);
    // A square centimetre is trimmed, and what is as narrow to within 2 mm may be taken for the minor axis.
    const ObjectShape& truth = shapes.true_shape(1);
    ASSERT_NEAR(truth.height_m, size_m.z(), 0.001) << "case " << i;
    ASSERT_NEAR(truth.major_m, std::max(size_m.x(), size_m.y()), 0.0035) << "case " << i;
    ASSERT_NEAR(truth.minor_m, std::min(size_m.x(), size_m.y()), 0.0035) << "case " << i;

    const Vector3d rebuilt_m = size_m + Vector3d{2.0 * larger_m, 2.0 * larger_m, larger_m};
    const RayScene rebuilt = *RayScene::build(box_on_table(rebuilt_m, turn_rad));
    const TriangleMesh mesh = joined_mesh(rebuilt.meshes(), [](std::size_t) { return true; });
    const std::optional<ObjectShape> measured = shapes.measure(1, mesh, Executor{});
    ASSERT_TRUE(measured) << "case " << i;
    const ObjectShape error = shape_error(*measured, truth);
    EXPECT_NEAR(error.height_m, larger_m, 0.001) << "case " << i;
    EXPECT_NEAR(error.major_m, 2.0 * larger_m, 0.0035) << "case " << i;
    EXPECT_NEAR(error.minor_m, 2.0 * larger_m, 0.0035) << "case " << i;
  }
}

}  // namespace
}  // namespace saccade
