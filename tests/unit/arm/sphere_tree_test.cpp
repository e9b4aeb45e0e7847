// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/sphere_tree.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "support/brute_force_distance.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

TriangleMesh box_mesh(const Vector3d& low, const Vector3d& high) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    const Vector3d p{(i & 1) != 0 ? high.x() : low.x(), (i & 2) != 0 ? high.y() : low.y(),
                     (i & 4) != 0 ? high.z() : low.z()};
    mesh.vertices.push_back(p.cast<float>());
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TriangleMesh both(TriangleMesh a, const TriangleMesh& b) {
  const auto first = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& [i, j, k] : b.triangles) a.triangles.push_back({i + first, j + first, k + first});
  return a;
}

/// An L of two boxes that share a side of their surfaces: neither convex nor a simple surface.
const Vector3d kLow{-0.15, -0.1, 0.0};
const Vector3d kMiddle{-0.03, 0.12, 0.5};
const Vector3d kForearm{0.21, 0.12, 0.11};
TriangleMesh l_shape() { return both(box_mesh(kLow, kMiddle), box_mesh({-0.03, -0.1, 0.0}, kForearm)); }
bool in_l_shape(const Vector3d& p) {
  const auto within = [&](const Vector3d& low, const Vector3d& high) {
    return (p.array() >= low.array()).all() && (p.array() <= high.array()).all();
  };
  return within(kLow, kMiddle) || within({-0.03, -0.1, 0.0}, kForearm);
}

bool holds(const TreeBall& ball, const Vector3d& p) {
  return (ball.center.cast<double>() - p).norm() <= static_cast<double>(ball.radius_m);
}

/// Tells whether p lies in the ball and, if it has balls below it, in one of those in the same way.
bool covered(std::span<const TreeBall> balls, std::uint32_t i, const Vector3d& p) {
  if (!holds(balls[i], p)) return false;
  bool leaf = true;
  for (std::uint32_t child = i + 1; child < balls[i].next; child = balls[child].next) {
    if (covered(balls, child, p)) return true;
    leaf = false;
  }
  return leaf;
}

TEST(SphereTree, CoversEveryPointOfTheBodyOnEveryLevel) {
  const auto tree = SphereTree::build(l_shape());
  ASSERT_TRUE(tree.ok()) << tree.error().to_string();
  std::mt19937 random{5};
  std::uniform_real_distribution<double> coordinate{-0.16, 0.51};
  int tried = 0;
  while (tried < 4000) {
    Vector3d p{coordinate(random), coordinate(random), coordinate(random)};
    if (!in_l_shape(p)) continue;
    if (tried % 4 == 0) p[tried % 3] = p[tried % 3] < 0.0 ? kLow[tried % 3] : p[tried % 3];  // onto a side
    EXPECT_TRUE(covered(tree->balls(), 0, p)) << p.transpose();
    ++tried;
  }
}

TEST(SphereTree, ExceedsTheBodyByLittle) {
  SphereTreeConfig config;
  const TriangleMesh mesh = l_shape();
  std::size_t last = std::numeric_limits<std::size_t>::max();
  for (const double max_excess_m : {0.004, 0.01, 0.04}) {
    config.max_excess_m = max_excess_m;
    const auto tree = SphereTree::build(mesh, config);
    ASSERT_TRUE(tree.ok());
    const auto balls = tree->balls();
    double worst_m = 0.0;
    for (std::uint32_t i = 0; i < balls.size(); ++i) {
      if (!balls[i].finest) continue;
      const Vector3d center = balls[i].center.cast<double>();
      const double depth_m = test::brute_force_distance_m(mesh, center) * (in_l_shape(center) ? 1.0 : -1.0);
      worst_m = std::max(worst_m, static_cast<double>(balls[i].radius_m) - depth_m);
    }
    EXPECT_LE(worst_m, max_excess_m + 2e-5);
    EXPECT_GT(worst_m, 0.5 * max_excess_m);
    EXPECT_LT(balls.size(), last);
    last = balls.size();
  }
}

TEST(SphereTree, ClearAsksTheCoarsestThatWillDo) {
  const auto tree = SphereTree::build(l_shape());
  ASSERT_TRUE(tree.ok());
  const auto questions = [&](const Vector3d& obstacle, bool expected) {
    int asked = 0;
    EXPECT_EQ(tree->clear([&](const TreeBall& ball) {
      ++asked;
      return !holds(ball, obstacle);
    }),
              expected)
        << obstacle.transpose();
    return asked;
  };
  EXPECT_EQ(questions({2.0, 0.0, 0.0}, true), 1);
  const int near = questions({0.1, 0.0, 0.3}, true);  // between the legs of the L: inside its convex hull
  EXPECT_GT(near, 3);
  EXPECT_LT(near, static_cast<int>(tree->balls().size()) / 4);
  questions({-0.1, 0.0, 0.4}, false);
}

TEST(SphereTree, RefusesWhatIsNoBody) {
  const auto message = [](const TriangleMesh& mesh, double max_excess_m = 0.005) {
    SphereTreeConfig config;
    config.max_excess_m = max_excess_m;
    const auto tree = SphereTree::build(mesh, config);
    EXPECT_FALSE(tree.ok());
    return tree.ok() ? "" : tree.error().to_string();
  };
  TriangleMesh mesh = l_shape();
  EXPECT_NE(message({}).find("no triangles"), std::string::npos);
  EXPECT_NE(message(mesh, 0.0).find("max_excess_m"), std::string::npos);
  EXPECT_NE(message(mesh, std::nan("")).find("max_excess_m"), std::string::npos);
  EXPECT_NE(message(box_mesh({-500, -500, -500}, {500, 500, 500}), 0.001).find("too large"), std::string::npos);
  mesh.triangles[3][1] = 99;
  EXPECT_NE(message(mesh).find("does not exist"), std::string::npos);
  mesh = l_shape();
  mesh.vertices[2].y() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(message(mesh).find("not finite"), std::string::npos);
}

/// A pyramid without its base has corners of cells that seem to lie inside it though no surface is near.
TEST(SphereTree, AnOpenMeshIsCoveredOrRefusedWithoutEnd) {
  for (int turn = 0; turn < 24; ++turn) {
    SCOPED_TRACE(turn);
    const Eigen::AngleAxisd rotation{0.26 * turn, Vector3d{1.0, -0.5, 0.2 * turn}.normalized()};
    TriangleMesh open;
    for (const Vector3d& p : {Vector3d{0.05, 0.05, 0.0}, Vector3d{-0.05, 0.05, 0.0}, Vector3d{-0.05, -0.05, 0.0},
                              Vector3d{0.05, -0.05, 0.0}, Vector3d{0.0, 0.0, 0.15}}) {
      open.vertices.push_back((rotation * p).cast<float>());
    }
    open.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
    const auto tree = SphereTree::build(open);
    if (!tree) {
      EXPECT_EQ(tree.error().code, Errc::invalid_argument);
      continue;
    }
    for (const Eigen::Vector3f& p : open.vertices) {
      EXPECT_FALSE(tree->clear([&](const TreeBall& ball) { return (ball.center - p).norm() > ball.radius_m; }));
    }
  }
}

}  // namespace
}  // namespace saccade
