// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numbers>

#include "analytic_map.hpp"

namespace saccade {
namespace {

using test::facts_of;
using test::map_of;
using test::MeshFacts;

void expect_closed_sphere_topology(const MeshFacts& facts) {
  EXPECT_EQ(facts.open_edges, 0U);
  EXPECT_EQ(facts.crowded_edges, 0U);
  EXPECT_EQ(facts.unused_vertices, 0U);
  EXPECT_EQ(facts.degenerate, 0U);
  EXPECT_EQ(facts.euler, 2);
}

TEST(MeshGolden, SphereAcrossSectorBorders) {
  TsdfConfig config;
  config.voxel_size_m = 0.0058;
  const Eigen::Vector3d center{0.371, 0.002, -0.004};  // straddles sector borders along every axis
  const double r{0.15};
  const auto map = map_of(config, {{20, -48, -48}, {108, 48, 48}},
                          [&](const Eigen::Vector3d& p) { return test::sphere_sdf(p, center, r); });
  ASSERT_GE(map.grid.sector_count(), 8U);
  const TriangleMesh mesh = extract_mesh(map, Executor::with_threads(2));
  const MeshFacts facts = facts_of(mesh);
  expect_closed_sphere_topology(facts);
  const double pi = std::numbers::pi;
  EXPECT_NEAR(facts.area_m2, 4.0 * pi * r * r, 0.01 * 4.0 * pi * r * r);
  EXPECT_NEAR(facts.volume_m3, 4.0 / 3.0 * pi * r * r * r, 0.003 * 4.0 / 3.0 * pi * r * r * r);
  for (const auto& v : mesh.vertices) {
    EXPECT_NEAR((v.cast<double>() - center).norm(), r, 0.05 * config.voxel_size_m);
  }
}

TEST(MeshGolden, Box) {
  TsdfConfig config;
  config.voxel_size_m = 0.005;
  const Eigen::Vector3d center{0.0012, 0.0007, 0.0021};
  const Eigen::Vector3d half{0.11, 0.07, 0.05};
  const auto map = map_of(config, {{-40, -32, -24}, {40, 32, 24}},
                          [&](const Eigen::Vector3d& p) { return test::box_sdf(p, center, half); });
  const TriangleMesh mesh = extract_mesh(map, Executor{});
  const MeshFacts facts = facts_of(mesh);
  expect_closed_sphere_topology(facts);
  const Eigen::Vector3d size = 2.0 * half;
  const double area = 2.0 * (size.x() * size.y() + size.y() * size.z() + size.z() * size.x());
  EXPECT_NEAR(facts.area_m2, area, 0.03 * area);  // edges are bevelled over about a voxel
  EXPECT_NEAR(facts.volume_m3, size.prod(), 0.01 * size.prod());
  for (const auto& v : mesh.vertices) {
    EXPECT_LT(std::abs(test::box_sdf(v.cast<double>(), center, half)), 0.5 * config.voxel_size_m);
  }
}

}  // namespace
}  // namespace saccade
