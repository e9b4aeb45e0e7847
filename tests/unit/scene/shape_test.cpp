// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

namespace saccade {
namespace {

constexpr double kPi{std::numbers::pi};

TriangleMesh made(const Shape& shape, double max_deviation_m = 1e-5) {
  auto mesh = tessellate(shape, max_deviation_m);
  EXPECT_TRUE(mesh) << mesh.error().to_string();
  return *std::move(mesh);
}

/// Each edge must be there once in each direction.
bool closed(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  }
  for (const auto& [edge, count] : edges) {
    if (count != 1 || !edges.contains({edge.second, edge.first})) return false;
  }
  return !edges.empty();
}

/// Positive for a mesh whose triangles are counter-clockwise seen from outside.
double volume_m3(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    sum += mesh.vertices[a].cast<double>().dot(mesh.vertices[b].cast<double>().cross(mesh.vertices[c].cast<double>()));
  }
  return sum / 6.0;
}

double lowest_m(const TriangleMesh& mesh) {
  float lowest = 1e9F;
  for (const auto& vertex : mesh.vertices) lowest = std::min(lowest, vertex.z());
  return lowest;
}

const RevolutionShape kVessel{{{0.05, 0.0}, {0.06, 0.05}, {0.04, 0.12}}, 0.004};
const JugShape kJug{{{{0.06, 0.0}, {0.06, 0.20}}, 0.005}, 0.04, 0.16, 0.05, 0.008};

TEST(Shape, VolumesAreTheTextbooks) {
  const double r = 0.05;
  const double h = 0.12;
  EXPECT_NEAR(volume_m3(made(BoxShape{{0.1, 0.2, 0.3}})), 0.006, 1e-9);
  EXPECT_NEAR(volume_m3(made(CylinderShape{r, h})) / (kPi * r * r * h), 1.0, 1e-3);
  EXPECT_NEAR(volume_m3(made(SphereShape{r})) / (4.0 / 3.0 * kPi * r * r * r), 1.0, 1e-3);
  EXPECT_NEAR(volume_m3(made(ConeShape{r, 0.0, h})) / (kPi * r * r * h / 3.0), 1.0, 1e-3);
  EXPECT_NEAR(volume_m3(made(SuperquadricShape{{0.1, 0.2, 0.3}, 1.0, 1.0})) / (4.0 / 3.0 * kPi * 0.006), 1.0, 2e-3);
  EXPECT_NEAR(volume_m3(made(SuperquadricShape{{0.1, 0.2, 0.3}, 2.0, 2.0})) / (4.0 / 3.0 * 0.006), 1.0, 2e-3);
  const double inner = kPi * (r - 0.004) * (r - 0.004) * (h - 0.004);
  EXPECT_NEAR(volume_m3(made(RevolutionShape{{{r, 0.0}, {r, h}}, 0.004})) / (kPi * r * r * h - inner), 1.0, 5e-3);
}

TEST(Shape, EveryBodyIsClosedAndStandsOnTheGround) {
  const std::vector<Shape> shapes{BoxShape{{0.1, 0.2, 0.3}},
                                  CylinderShape{0.05, 0.1},
                                  SphereShape{0.05},
                                  ConeShape{0.05, 0.0, 0.1},
                                  ConeShape{0.05, 0.02, 0.1},
                                  SuperquadricShape{{0.05, 0.04, 0.06}, 0.3, 0.5},
                                  RevolutionShape{{{0.0, 0.0}, {0.05, 0.02}, {0.0, 0.1}}, 0.0},
                                  kVessel,
                                  kJug};
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const TriangleMesh mesh = made(shapes[i], 1e-4);
    EXPECT_TRUE(closed(mesh)) << "shape " << i;
    EXPECT_GT(volume_m3(mesh), 0.0) << "shape " << i;
    EXPECT_NEAR(lowest_m(mesh), 0.0, 1e-6) << "shape " << i;
  }
}

TEST(Shape, SpheresAndCirclesKeepTheirDeviation) {
  for (const double deviation_m : {1e-3, 1e-4, 1e-5}) {
    const TriangleMesh mesh = made(SphereShape{0.05}, deviation_m);
    double worst = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
      const Eigen::Vector3d p = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]).cast<double>() / 3.0;
      worst = std::max(worst, std::fabs((p - Eigen::Vector3d{0.0, 0.0, 0.05}).norm() - 0.05));
    }
    EXPECT_LE(worst, deviation_m);
    EXPECT_GT(worst, 0.1 * deviation_m);  // and is not finer than it need be by far
  }
}

TEST(Shape, SuperquadricVerticesSatisfyTheirEquation) {
  const SuperquadricShape body{{0.05, 0.04, 0.06}, 0.3, 1.5};
  for (const Eigen::Vector3f& vertex : made(body, 1e-3).vertices) {
    const Eigen::Vector3d p =
        (vertex.cast<double>() - Eigen::Vector3d{0.0, 0.0, 0.06}).cwiseQuotient(body.semi_axes_m).cwiseAbs();
    const double horizontal = std::pow(p.x(), 2.0 / 1.5) + std::pow(p.y(), 2.0 / 1.5);
    EXPECT_NEAR(std::pow(horizontal, 1.5 / 0.3) + std::pow(p.z(), 2.0 / 0.3), 1.0, 1e-4);
  }
}

TEST(Shape, TheHandlesEndsStayInsideTheWall) {
  const TriangleMesh mesh = made(kJug);
  float reach = 0.0F;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    reach = std::max(reach, vertex.x());
    const float radius = std::hypot(vertex.x(), vertex.y());
    if (vertex.z() > 0.0051F && radius > 1e-6F) {
      EXPECT_GE(radius, 0.055F - 1e-6F);
    }
  }
  EXPECT_NEAR(reach, 0.06 + 0.05 + 0.008, 1e-4);
}

TEST(Shape, RefusesWhatIsNoBody) {
  const double nan = std::nan("");
  JugShape thick = kJug;
  thick.handle_radius_m = 0.03;
  JugShape high = kJug;
  high.handle_top_m = 0.199;
  TriangleMesh dangling;
  dangling.vertices.resize(3, Eigen::Vector3f::Zero());
  dangling.triangles = {{0, 1, 3}};
  const std::vector<Shape> shapes{BoxShape{{0.1, 0.0, 0.1}},
                                  CylinderShape{-0.1, 0.1},
                                  SphereShape{nan},
                                  ConeShape{0.0, 0.1, 0.1},
                                  SuperquadricShape{{0.1, 0.1, 0.1}, 0.01, 1.0},
                                  RevolutionShape{{{0.1, 0.0}}, 0.0},
                                  RevolutionShape{{{0.1, 0.1}, {0.1, 0.0}}, 0.0},
                                  RevolutionShape{{{0.1, 0.0}, {0.1, 0.1}}, 0.1},
                                  RevolutionShape{{{0.003, 0.0}, {0.1, 0.1}}, 0.004},
                                  thick,
                                  high,
                                  MeshShape{},
                                  MeshShape{dangling}};
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const auto mesh = tessellate(shapes[i]);
    ASSERT_FALSE(mesh) << "shape " << i;
    EXPECT_EQ(mesh.error().code, Errc::invalid_argument) << "shape " << i;
  }
  EXPECT_FALSE(tessellate(SphereShape{0.1}, 0.0));
}

}  // namespace
}  // namespace saccade
