// SPDX-License-Identifier: Apache-2.0
// The silhouettes of recorded and built-in arms against rays cast at every triangle, and of enlarged ones against
// points.
#include "saccade/arm/arm_silhouette.hpp"
#include "saccade/arm/internal/depth_raster.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <iostream>
#include <optional>

#include "saccade/arm/arm_mesh.hpp"
#include "saccade/arm/urdf.hpp"
#include "support/effort.hpp"
#include "support/shared_arms.hpp"
#include "support/test_arms.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

constexpr std::uint64_t kSilhouetteSeed{21};

/// The built-in arm with its camera, and all arms with one beside the hand that looks back along them.
std::vector<ArmModel> arms() {
  std::vector<ArmModel> found{find_robot("comau_smart_six")->arm};
  std::vector<ArmModel> looking_back = found;
  if (std::filesystem::exists(test::shared_robots())) {
    looking_back.push_back(test::shared_comau(false)->arm);  // its bodies are meshes
    looking_back.push_back(test::shared_iiwa()->arm);
    looking_back.push_back(test::shared_panda()->arm);
  }
  for (const ArmModel& arm : looking_back) {
    ArmDescription description = arm.description();
    description.T_flange_camera =
        Pose{Eigen::Translation3d{0.15, 0.05, 0.12} * Eigen::AngleAxisd{2.4, Vector3d{0.3, 0.9, 0.1}.normalized()}};
    found.push_back(ArmModel::create(std::move(description)).value());
  }
  return found;
}

PinholeCamera small_camera() { return {160, 120, 131.25, 131.25, 79.5, 59.5, 0.4, 6.0}; }

/// The arm in the camera's frame, as in arm_mesh.
struct PosedTriangles {
  TriangleMesh mesh;
  std::vector<Vector3d> p_camera;

  PosedTriangles(const ArmModel& arm, const Configuration& q) : mesh{arm_mesh(arm, q)} {
    const Pose T_camera_world = camera_pose(arm, q).inverse();
    for (const Eigen::Vector3f& p : mesh.vertices) p_camera.emplace_back(T_camera_world * p.cast<double>());
  }

  /// Depth of the first triangle that faces the ray; 0: none.
  [[nodiscard]] double cast(const Vector3d& ray) const {
    double nearest = 0.0;
    for (const auto& [i, j, k] : mesh.triangles) {
      const Vector3d& a = p_camera[i];
      const Vector3d ab = p_camera[j] - a;
      const Vector3d ac = p_camera[k] - a;
      const Vector3d normal = ab.cross(ac);
      if (normal.dot(ray) >= 0.0) continue;
      const double t = normal.dot(a) / normal.dot(ray);
      const Vector3d inside = t * ray - a;
      const double wb = inside.cross(ac).dot(normal) / normal.squaredNorm();
      const double wc = ab.cross(inside).dot(normal) / normal.squaredNorm();
      if (wb < 0.0 || wc < 0.0 || wb + wc > 1.0 || t < DepthRaster::kNearest_m) continue;
      if (nearest == 0.0 || t < nearest) nearest = t;
    }
    return nearest;
  }

  /// As cast, unless rays close by meet something else.
  [[nodiscard]] std::optional<double> cast_surely(const PinholeCamera& camera, int u, int v) const {
    constexpr double kBeside_px{1e-3};
    const double z = cast(camera.ray(u, v));
    for (const auto& [du, dv] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
      const double other = cast(camera.ray(u + kBeside_px * du, v + kBeside_px * dv));
      if ((other > 0.0) != (z > 0.0) || std::fabs(other - z) > 1e-3 * z) return std::nullopt;
    }
    return z;
  }
};

TEST(ArmSilhouetteProperty, DepthIsThatOfRaysAtEveryTriangle) {
  RecordProperty("seed", static_cast<int>(kSilhouetteSeed));
  std::mt19937_64 random{kSilhouetteSeed};
  const PinholeCamera camera = small_camera();
  const int cases = test::scaled_cases(16);
  int compared = 0;
  int covered = 0;
  int unsure = 0;
  for (const ArmModel& arm : arms()) {
    const ArmSilhouette silhouette = ArmSilhouette::create(arm, camera).value();
    for (int i = 0; i < cases; ++i) {
      const Configuration q = test::random_configuration(arm, random);
      const DepthImage depth = silhouette.depth(q);
      const PosedTriangles triangles{arm, q};
      for (int n = 0; n < 40; ++n) {
        const auto u = static_cast<int>(random() % 160);
        const auto v = static_cast<int>(random() % 120);
        const std::optional<double> want = triangles.cast_surely(camera, u, v);
        unsure += want ? 0 : 1;
        if (!want) continue;
        ++compared;
        covered += *want > 0.0 ? 1 : 0;
        ASSERT_NEAR(depth(u, v), *want, 1e-4 * *want) << arm.name() << ", case " << i << ", " << u << ", " << v;
      }
    }
  }
  std::cout << "seed " << kSilhouetteSeed << ": " << compared << " pixels compared, " << covered << " of them covered, "
            << unsure << " at an edge\n";
  EXPECT_GT(compared, cases * 75);
  EXPECT_GT(covered, compared / 50);
  EXPECT_LT(unsure, compared / 20);
}

TEST(ArmSilhouetteProperty, WhatLiesWithinTheMarginIsMasked) {
  std::mt19937_64 random{kSilhouetteSeed + 1};
  std::uniform_real_distribution<double> unit{0.0, 1.0};
  const PinholeCamera camera = small_camera();
  const int cases = test::scaled_cases(16);
  std::size_t points = 0;
  std::size_t missed = 0;
  for (const ArmModel& arm : arms()) {
    const ArmSilhouette silhouette = ArmSilhouette::create(arm, camera).value();
    for (int i = 0; i < cases; ++i) {
      const Configuration q = test::random_configuration(arm, random);
      DepthImage depth{camera.width, camera.height, 5.0F};
      ASSERT_TRUE(silhouette.mask(q, depth));
      const PosedTriangles triangles{arm, q};
      for (int n = 0; n < 3000; ++n) {
        const auto& [a, b, c] = triangles.mesh.triangles[random() % triangles.mesh.triangles.size()];
        const double s = std::sqrt(unit(random));
        const double t = unit(random);
        const Vector3d on_body =
            (1.0 - s) * triangles.p_camera[a] + s * (1.0 - t) * triangles.p_camera[b] + s * t * triangles.p_camera[c];
        const Vector3d away = Vector3d{unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5}.normalized();
        const Vector3d p = on_body + silhouette.config().margin_m * away;
        if (p.z() < 0.15) continue;
        const Eigen::Vector2d at = camera.project(p);
        const auto u = static_cast<int>(std::lround(at.x()));
        const auto v = static_cast<int>(std::lround(at.y()));
        if (u < 0 || v < 0 || u >= camera.width || v >= camera.height) continue;
        if (triangles.cast(on_body) == 0.0) continue;  // a face seen from inside, or less enlarged
        ++points;
        missed += depth(u, v) == 0.0F ? 0 : 1;
      }
    }
  }
  std::cout << "seed " << kSilhouetteSeed + 1 << ": " << points << " points\n";
  EXPECT_GT(points, 100U);
  EXPECT_EQ(missed, 0U);
}

/// Depth with noise of the arm itself vanishes, and what stands clearly before it stays.
TEST(ArmSilhouetteProperty, TheArmsOwnDepthVanishesAndLittleElse) {
  std::mt19937_64 random{kSilhouetteSeed + 2};
  const PinholeCamera camera = small_camera();
  const int cases = test::scaled_cases(60);
  std::size_t own = 0;
  std::size_t masked = 0;
  std::size_t near = 0;
  for (const ArmModel& arm : arms()) {
    const ArmSilhouette silhouette = ArmSilhouette::create(arm, camera).value();
    for (int i = 0; i < cases; ++i) {
      const Configuration q = test::random_configuration(arm, random);
      const DepthImage exact = silhouette.depth(q);
      DepthImage seen = exact;
      std::size_t covered = 0;
      Image<char> around{camera.width, camera.height};
      for (int v = 0; v < camera.height; ++v) {
        for (int u = 0; u < camera.width; ++u) {
          const float z = exact(u, v);
          if (z <= 0.0F) continue;
          ++covered;
          // The margin, 0.01, counts along rays that are up to 1.3 long.
          seen(u, v) = z > 0.05F ? z - static_cast<float>(0.7 * 0.01 + 0.9 * 0.006 * z * z) : z;
          const int r = static_cast<int>(std::min(16.0, 2.0 + 1.6 * 131.25 * 0.01 / z) + 2.0);
          for (int y = std::max(0, v - r); y <= std::min(camera.height - 1, v + r); ++y) {
            for (int x = std::max(0, u - r); x <= std::min(camera.width - 1, u + r); ++x) around(x, y) = 1;
          }
        }
      }
      const auto count = silhouette.mask(q, seen);
      ASSERT_TRUE(count);
      EXPECT_EQ(*count, covered);
      own += covered;
      DepthImage far{camera.width, camera.height, 9.0F};
      const std::size_t enlarged = silhouette.mask(q, far).value();
      EXPECT_GE(enlarged, covered);
      EXPECT_TRUE(enlarged == 0 || silhouette.in_picture(q));
      masked += enlarged;
      for (std::size_t n = 0; n < far.size(); ++n) near += around.data()[n] != 0 ? 1U : 0U;
    }
  }
  std::cout << "seed " << kSilhouetteSeed + 2 << ": " << own << " pixels of arms, " << masked << " masked, " << near
            << " near\n";
  EXPECT_GT(own, 5000U);
  EXPECT_LT(masked, near + near / 20) << "the mask reaches far beyond the arm";
}

TEST(ArmSilhouetteProperty, ThreadsChangeNothing) {
  std::mt19937_64 random{kSilhouetteSeed + 3};
  const Executor three = Executor::with_threads(3, Executor::Backend::std_thread);
  int seen = 0;
  for (const ArmModel& arm : arms()) {
    const ArmSilhouette silhouette = ArmSilhouette::create(arm, PinholeCamera{}).value();
    for (int i = 0; i < test::scaled_cases(12); ++i) {
      const Configuration q = test::random_configuration(arm, random);
      const DepthImage depth = silhouette.depth(q);
      ASSERT_EQ(silhouette.depth(q, three), depth);
      DepthImage one{640, 480, 2.0F};
      DepthImage other = one;
      ASSERT_EQ(silhouette.mask(q, one).value(), silhouette.mask(q, other, three).value());
      ASSERT_EQ(one, other);
      seen += silhouette.in_picture(q) ? 1 : 0;
    }
  }
  EXPECT_GT(seen, 0);
}

}  // namespace
}  // namespace saccade
