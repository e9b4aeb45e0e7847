// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/metrics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "saccade/scene/simulated_camera.hpp"
#include "saccade/scene/solids.hpp"
#include "support/effort.hpp"
#include "support/placed_object.hpp"

namespace saccade {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;
using test::placed;

constexpr std::size_t kBlock{1};
constexpr std::size_t kJug{2};
constexpr std::size_t kBottle{3};
constexpr std::size_t kTin{4};

/// A turned block, a jug, a bottle, and a tin on a board, on a table.
Scene shelf() {
  Scene scene;
  scene.name = "shelf";
  scene.workspace = Box{{-0.45, -0.3, -0.03}, {0.45, 0.3, 0.35}};
  SceneObject table = placed("table", BoxShape{{1.0, 0.7, 0.04}}, {0.0, 0.0, -0.04});
  table.support = true;
  SceneObject block = placed("block", BoxShape{{0.12, 0.08, 0.1}}, {-0.25, 0.0, 0.0});
  block.T_world_object.linear() = AngleAxisd{0.35, Vector3d::UnitZ()}.toRotationMatrix();
  const RevolutionShape body{{{0.055, 0.0}, {0.055, 0.19}}, 0.005};
  SceneObject jug = placed("jug", JugShape{body, 0.04, 0.16, 0.04, 0.008}, {0.25, 0.0, 0.0});
  jug.T_world_object.linear() = AngleAxisd{-1.0, Vector3d::UnitZ()}.toRotationMatrix();
  const SceneObject bottle = placed(
      "bottle", RevolutionShape{{{0.035, 0.0}, {0.035, 0.15}, {0.014, 0.2}, {0.014, 0.24}}, 0.003}, {0.0, 0.12, 0.0});
  const SceneObject tin = placed("tin", CylinderShape{0.04, 0.09}, {0.0, -0.15, 0.03});
  SceneObject board = placed("board", BoxShape{{0.2, 0.16, 0.03}}, {0.0, -0.15, 0.0});
  scene.objects = {table, block, jug, bottle, tin, board};
  return scene;
}

const RayScene& rays() {
  static const RayScene made = *RayScene::build(shelf());
  return made;
}

const ObjectShapes& shapes() {
  static const ObjectShapes made = *ObjectShapes::build(rays());
  return made;
}

TriangleMesh everything() {
  return joined_mesh(rays().meshes(), [](std::size_t) { return true; });
}

ObjectShape error_of(std::size_t object, const TriangleMesh& mesh) {
  const std::optional<ObjectShape> measured = shapes().measure(object, mesh, Executor::with_threads(2));
  if (!measured) {
    ADD_FAILURE() << "object " << object << " was not measured";
    return {};
  }
  return shape_error(*measured, shapes().true_shape(object));
}

void expect_error(std::size_t object, const TriangleMesh& mesh, const ObjectShape& expected, double tolerance_m) {
  const ObjectShape error = error_of(object, mesh);
  EXPECT_NEAR(error.height_m, expected.height_m, tolerance_m) << object;
  EXPECT_NEAR(error.major_m, expected.major_m, tolerance_m) << object;
  EXPECT_NEAR(error.minor_m, expected.minor_m, tolerance_m) << object;
}

/// The scene's mesh with every vertex of one object moved.
template <typename Move>
TriangleMesh moved(std::size_t object, const Move& move) {
  std::vector<ObjectMesh> meshes = rays().meshes();
  for (Eigen::Vector3f& vertex : meshes[object].mesh.vertices)
    vertex = move(vertex.cast<double>()).template cast<float>();
  return joined_mesh(meshes, [](std::size_t) { return true; });
}

TEST(ObjectShapes, TrueShapesAreThoseOfTheBodies) {
  EXPECT_EQ(shapes().objects(), (std::vector<std::size_t>{1, 2, 3, 4, 5}));
  const auto expect = [](std::size_t object, const ObjectShape& expected) {
    const ObjectShape& shape = shapes().true_shape(object);
    // The square centimetre that is trimmed costs a slim neck the most.
    EXPECT_NEAR(shape.height_m, expected.height_m, 0.0015) << object;
    EXPECT_NEAR(shape.major_m, expected.major_m, 0.0035) << object;
    EXPECT_NEAR(shape.minor_m, expected.minor_m, 0.0015) << object;
    EXPECT_LE(shape.height_m, expected.height_m + 1e-6);
    EXPECT_GE(shape.major_m, shape.minor_m);
  };
  expect(kBlock, {0.1, 0.12, 0.08});
  // The bar's axis stands 4 cm off the body, and the bar is 8 mm thick on either side of it.
  expect(kJug, {0.19, 0.055 + 0.055 + 0.04 + 0.008, 0.11});
  expect(kBottle, {0.24, 0.07, 0.07});
  expect(kTin, {0.09, 0.08, 0.08});
  expect(5, {0.03, 0.2, 0.16});
}

TEST(ObjectShapes, ATrueMeshHasNoErrors) {
  for (const std::size_t object : shapes().objects()) expect_error(object, everything(), {}, 0.0012);
}

TEST(ObjectShapes, ALargerObjectIsMeasuredLarger) {
  // 10 mm thicker on every side, and as much higher.
  const Pose T_block_world = rays().scene().objects[kBlock].T_world_object.inverse();
  const TriangleMesh thicker = moved(kBlock, [&](const Vector3d& p_world) -> Vector3d {
    Vector3d p = T_block_world * p_world;
    p.x() += p.x() > 0.0 ? 0.01 : -0.01;
    p.y() += p.y() > 0.0 ? 0.01 : -0.01;
    p.z() += p.z() > 0.05 ? 0.01 : 0.0;
    return T_block_world.inverse() * p;
  });
  expect_error(kBlock, thicker, {0.01, 0.02, 0.02}, 0.0015);
  expect_error(kTin, thicker, {}, 0.001);  // the others are what they were
  const Pose& T_world_bottle = rays().scene().objects[kBottle].T_world_object;
  const TriangleMesh slimmer = moved(kBottle, [&](const Vector3d& p_world) -> Vector3d {
    const Vector3d at = T_world_bottle.translation();
    return at + Vector3d{0.8, 0.8, 1.0}.cwiseProduct(p_world - at);
  });
  expect_error(kBottle, slimmer, {0.0, -0.014, -0.014}, 0.001);
}

TEST(ObjectShapes, AMissingTopIsMissed) {
  TriangleMesh mesh = everything();
  const auto too_high = [&](const std::array<std::uint32_t, 3>& triangle) {
    const Eigen::Vector3f& p = mesh.vertices[triangle[0]];
    return std::max({p.z(), mesh.vertices[triangle[1]].z(), mesh.vertices[triangle[2]].z()}) > 0.16F &&
           (p.head<2>() - Eigen::Vector2f{0.0F, 0.12F}).norm() < 0.06F;
  };
  mesh.triangles.erase(std::remove_if(mesh.triangles.begin(), mesh.triangles.end(), too_high), mesh.triangles.end());
  expect_error(kBottle, mesh, {-0.09, 0.0, 0.0}, 0.0015);  // shoulder and neck are gone
}

TEST(ObjectShapes, AShiftedTableOrNeighbourIsNotTheObject) {
  if (test::kSanitized) GTEST_SKIP() << "true shapes take long under sanitizers; the tests around measure, too";
  const TriangleMesh raised = moved(0, [](const Vector3d& p) -> Vector3d { return p + Vector3d{0.0, 0.0, 0.008}; });
  for (const std::size_t object : shapes().objects()) {
    const ObjectShape error = error_of(object, raised);
    EXPECT_NEAR(error.height_m, 0.0, 0.001);
    EXPECT_LT(error.major_m, 0.017);  // at most 8 mm of the table on either side are nearer to it
  }
}

/// Spurs in the air about every object: single triangles of 10 mm² as noise leaves them.
TEST(ObjectShapes, StrayTrianglesDoNotCount) {
  if (test::kSanitized) GTEST_SKIP() << "true shapes take long under sanitizers; the tests around measure, too";
  TriangleMesh mesh = everything();
  for (const std::size_t object : shapes().objects()) {
    const Vector3d at = rays().scene().objects[object].T_world_object.translation();
    const ObjectShape& shape = shapes().true_shape(object);
    for (int i = 0; i < 3; ++i) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      const double turn = 2.0 * i;
      const Vector3d side{std::cos(turn), std::sin(turn), 0.0};
      const Vector3d p = at + Vector3d{0.0, 0.0, shape.height_m + 0.015} + 0.02 * side;
      for (const Vector3d& corner : {p, Vector3d{p + 0.0045 * side}, Vector3d{p + Vector3d{0.0, 0.0, 0.0045}}}) {
        mesh.vertices.push_back(corner.cast<float>());
      }
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
    expect_error(object, mesh, {}, 0.0012);
  }
}

TEST(ObjectShapes, TooLittleIsNothing) {
  const TriangleMesh table = joined_mesh(rays().meshes(), [](std::size_t i) { return i == 0; });
  for (const std::size_t object : shapes().objects()) {
    EXPECT_FALSE(shapes().measure(object, table, Executor{})) << object;
    EXPECT_FALSE(shapes().measure(object, TriangleMesh{}, Executor{})) << object;
  }
  TriangleMesh part = everything();
  // Keeps one side of the block's six.
  const Vector3d block_at = rays().scene().objects[kBlock].T_world_object.translation();
  std::vector<std::array<std::uint32_t, 3>> kept;
  for (const auto& triangle : part.triangles) {
    const Vector3d a = part.vertices[triangle[0]].cast<double>();
    const Vector3d n =
        (part.vertices[triangle[1]].cast<double>() - a).cross(part.vertices[triangle[2]].cast<double>() - a);
    if ((a - block_at).head<2>().norm() < 0.1 && n.normalized().x() < 0.9) continue;
    kept.push_back(triangle);
  }
  part.triangles = kept;
  const double share = 0.08 * 0.1 / (2.0 * (0.12 * 0.08 + 0.12 * 0.1 + 0.08 * 0.1));
  ObjectShapeConfig config;
  config.least_share = share + 0.02;
  EXPECT_FALSE(ObjectShapes::build(rays(), config)->measure(kBlock, part, Executor{}));
  config.least_share = share - 0.02;
  EXPECT_TRUE(ObjectShapes::build(rays(), config)->measure(kBlock, part, Executor{}));
}

/// A camera with the noise of a Kinect goes around the shelf.
TEST(ObjectShapes, NoiseCostsMillimetres) {
  if (test::kSanitized) GTEST_SKIP() << "true shapes take long under sanitizers; the tests around measure, too";
  SimulatedCameraConfig config;
  config.camera = test::kSanitized ? PinholeCamera{160, 120, 131.25, 131.25, 79.5, 59.5, 0.5, 2.0}
                                   : PinholeCamera{320, 240, 262.5, 262.5, 159.5, 119.5, 0.5, 2.0};
  SimulatedCamera camera = *SimulatedCamera::create(rays(), config);
  TsdfConfig map_config;
  map_config.voxel_size_m = 0.0058;
  map_config.truncation_vox = 2.0;
  TsdfMap map = *TsdfMap::create(map_config);
  const int views = test::kSanitized ? 12 : 40;
  for (int i = 0; i < views; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / views;
    const Pose T_world_camera =
        look_at({0.75 * std::cos(turn), 0.75 * std::sin(turn), 0.3 + 0.3 * (i % 2)}, {0.0, 0.0, 0.05});
    ASSERT_TRUE(map.integrate(camera.camera(), camera.capture(T_world_camera).depth, T_world_camera, Executor{}));
  }
  const TriangleMesh mesh = extract_mesh(map.content(), Executor{});
  std::vector<ObjectShape> errors;
  for (const std::size_t object : shapes().objects()) errors.push_back(error_of(object, mesh));
  const ShapeErrors summary = summarize(errors);
  EXPECT_EQ(summary.parameters, 15U);
  EXPECT_LT(summary.mean_abs_m, test::kSanitized ? 0.01 : 0.003);
  EXPECT_GT(summary.mean_abs_m, 0.0002);
}

TEST(ObjectShapes, ErrorsAreSummarized) {
  const std::vector<ObjectShape> errors{{0.01, -0.01, 0.0}, {0.02, -0.02, 0.0}};
  const ShapeErrors summary = summarize(errors);
  EXPECT_EQ(summary.parameters, 6U);
  EXPECT_NEAR(summary.mean_abs_m, 0.01, 1e-12);
  EXPECT_NEAR(summary.standard_deviation_m, std::sqrt(0.001 / 5.0), 1e-12);
  EXPECT_EQ(summarize({}).parameters, 0U);
}

TEST(ObjectShapes, RefuseWhatCannotBeMeasured) {
  ObjectShapeConfig config;
  config.reach_m = 0.0;
  EXPECT_FALSE(ObjectShapes::build(rays(), config));
  config = {};
  config.least_share = 1.5;
  EXPECT_FALSE(ObjectShapes::build(rays(), config));
  config = {};
  config.trimmed_m2 = 1.0;
  const auto refused = ObjectShapes::build(rays(), config);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().context.find("block"), std::string::npos);
}

}  // namespace
}  // namespace saccade
