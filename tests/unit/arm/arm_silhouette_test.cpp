// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/arm_silhouette.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "saccade/arm/arm_mesh.hpp"
#include "support/parallel_backend.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

PinholeCamera camera() { return {160, 120, 131.25, 131.25, 79.5, 59.5, 0.4, 6.0}; }

/// A wall before the base that a camera on a rail looks at: its face is at z = 2 − q of the camera's frame, and it
/// covers ±0.3 m across and ±0.2 m up and down.
ArmDescription rail() {
  ArmDescription description;
  description.name = "rail";
  ArmJoint joint;
  joint.name = "slide";
  joint.kind = JointKind::prismatic;
  joint.limits = {0.0, 1.9, 1.0, 1.0};
  description.joints = {joint};
  ArmLink base{"base", {}};
  base.bodies.push_back({"wall", Pose{Eigen::Translation3d{0.0, 0.0, 2.05}}, BoxBody{{0.6, 0.4, 0.1}}});
  description.links = {base, {"carriage", {}}};
  return description;
}

ArmDescription with_hand_body(const CollisionBody& body) {
  ArmDescription description = rail();
  description.links[1].bodies.push_back(body);
  return description;
}

ArmSilhouette silhouette_of(ArmDescription description, const ArmSilhouetteConfig& config = {}) {
  return ArmSilhouette::create(ArmModel::create(std::move(description)).value(), camera(), config).value();
}

Configuration at(double q) { return Configuration::Constant(1, q); }

std::size_t covered_pixels(const DepthImage& depth) {
  std::size_t count = 0;
  for (const float z : depth.pixels()) count += z != 0.0F ? 1U : 0U;
  return count;
}

TEST(ArmSilhouette, DrawsAWallWhereItIs) {
  const ArmSilhouette silhouette = silhouette_of(rail());
  const DepthImage depth = silhouette.depth(at(0.5));
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 160; ++u) {
      const Vector3d p = 1.5 * camera().ray(u, v);
      const bool inside = std::fabs(p.x()) <= 0.3 && std::fabs(p.y()) <= 0.2;
      ASSERT_NEAR(depth(u, v), inside ? 1.5F : 0.0F, 1e-5F) << u << ", " << v;
    }
  }
}

TEST(ArmSilhouette, MasksTheWallItsMarginAndTheBorder) {
  const ArmSilhouette silhouette = silhouette_of(rail(), {.margin_m = 0.05, .border_px = 3.0, .most_share = 0.5});
  DepthImage depth{160, 120, 4.0F};
  const auto lost = silhouette.mask(at(0.5), depth);
  ASSERT_TRUE(lost);
  const double beside_px = 3.0 + 131.25 * 0.05 / 1.45;  // as wide as the enlarged wall's face, which is nearer
  const double right = 79.5 + 131.25 * 0.3 / 1.5 + beside_px;
  const double bottom = 59.5 + 131.25 * 0.2 / 1.5 + beside_px;
  std::size_t count = 0;
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 160; ++u) {
      const bool inside = std::fabs(u - 79.5) <= right - 79.5 && std::fabs(v - 59.5) <= bottom - 59.5;
      count += inside ? 1U : 0U;
      ASSERT_EQ(depth(u, v), inside ? 0.0F : 4.0F) << u << ", " << v;
    }
  }
  EXPECT_EQ(*lost, count);
}

TEST(ArmSilhouette, KeepsWhatStandsClearlyBeforeTheArm) {
  const ArmSilhouette silhouette =
      silhouette_of(rail(), {.margin_m = 0.02, .border_px = 1.0, .depth_error_per_m = 0.01});
  // The face is at 1.5 m, enlarged at 1.48 m; nearer by 0.01 · 1.48² = 0.0219 m still counts as the wall.
  for (const auto& [z, kept] : {std::pair{1.45F, true}, {1.457F, true}, {1.46F, false}, {1.5F, false}, {3.0F, false}}) {
    DepthImage depth{160, 120, z};
    const auto lost = silhouette.mask(at(0.5), depth);
    ASSERT_TRUE(lost);
    EXPECT_EQ(depth(80, 60), kept ? z : 0.0F);
    EXPECT_EQ(*lost == 0, kept);
    EXPECT_EQ(depth(2, 2), z) << "far from the wall";
  }
}

TEST(ArmSilhouette, TakesFreeClaimsAndKeepsCountOfWhatWasMeasured) {
  const ArmSilhouette silhouette = silhouette_of(rail());
  DepthImage free{160, 120, -6.0F};
  EXPECT_GT(silhouette.mask(at(0.5), free).value(), 1000U);
  EXPECT_EQ(free(80, 60), 0.0F);
  DepthImage none{160, 120, 0.0F};
  none(80, 60) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(silhouette.mask(at(0.5), none).value(), 0U);
  EXPECT_EQ(none(80, 60), 0.0F);
}

TEST(ArmSilhouette, LeavesTheImageAloneWhenTheArmIsNotInIt) {
  ArmDescription description = rail();
  description.T_flange_camera = Pose{Eigen::AngleAxisd{M_PI / 2, Vector3d::UnitY()}};
  const ArmSilhouette silhouette = silhouette_of(description);
  DepthImage depth{160, 120, 4.0F};
  EXPECT_EQ(silhouette.mask(at(0.5), depth).value(), 0U);
  EXPECT_EQ(depth, (DepthImage{160, 120, 4.0F}));
  EXPECT_EQ(silhouette.depth(at(0.5)), (DepthImage{160, 120}));
  EXPECT_FALSE(silhouette.in_picture(at(0.5)));
  EXPECT_TRUE(silhouette_of(rail()).in_picture(at(0.5)));
}

TEST(ArmSilhouette, SeesThroughTheCamerasOwnHousing) {
  const DepthImage without = silhouette_of(rail()).depth(at(0.5));
  // The camera's centre lies in the box, its front 15 mm before it.
  const CollisionBody housing{"housing", Pose{Eigen::Translation3d{0.0, 0.0, -0.02}}, BoxBody{{0.28, 0.07, 0.07}}};
  EXPECT_EQ(silhouette_of(with_hand_body(housing)).depth(at(0.5)), without);
  // A closed mesh, turned inside out, is known by its volume.
  TriangleMesh inside_out = body_surface({"box", Pose::Identity(), BoxBody{{0.28, 0.07, 0.07}}});
  for (auto& t : inside_out.triangles) std::swap(t[0], t[1]);
  const CollisionBody mesh{"housing", housing.T_link_body, MeshBody{inside_out}};
  EXPECT_EQ(silhouette_of(with_hand_body(mesh)).depth(at(0.5)), without);
}

TEST(ArmSilhouette, SeesAFingerThatIsTooNearToBeMeasured) {
  const CollisionBody finger{"finger", Pose{Eigen::Translation3d{0.03, 0.0, 0.1}}, BoxBody{{0.01, 0.3, 0.02}}};
  const ArmSilhouette silhouette = silhouette_of(with_hand_body(finger));
  const int u = static_cast<int>(std::lround(79.5 + 131.25 * 0.03 / 0.09));
  EXPECT_NEAR(silhouette.depth(at(0.5))(u, 60), 0.09F, 1e-5F);
  DepthImage depth{160, 120, 1.0F};
  EXPECT_GT(silhouette.mask(at(0.5), depth).value(), 500U);
  EXPECT_EQ(depth(u, 60), 0.0F);
  EXPECT_EQ(depth(60, 60), 1.0F) << "before the wall";
}

TEST(ArmSilhouette, SeesBothSidesOfAnOpenMesh) {
  ArmDescription description = rail();
  TriangleMesh sheet;
  sheet.vertices = {{-0.3F, -0.2F, 0.0F}, {0.3F, -0.2F, 0.0F}, {0.3F, 0.2F, 0.0F}, {-0.3F, 0.2F, 0.0F}};
  for (const bool turned : {false, true}) {
    sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
    if (turned) sheet.triangles = {{0, 2, 1}, {0, 3, 2}};
    description.links[0].bodies = {{"sheet", Pose{Eigen::Translation3d{0.0, 0.0, 2.0}}, MeshBody{sheet}}};
    EXPECT_EQ(covered_pixels(silhouette_of(description).depth(at(0.5))),
              covered_pixels(silhouette_of(rail()).depth(at(0.5))));
  }
}

TEST(ArmSilhouette, CutsWhatReachesBehindTheCamera) {
  ArmDescription description = rail();
  // A long beam beside the camera, from far behind it to 2 m before it.
  description.links[0].bodies = {{"beam", Pose{Eigen::Translation3d{0.35, 0.0, 1.0}}, BoxBody{{0.1, 0.1, 4.0}}}};
  const DepthImage depth = silhouette_of(description).depth(at(0.5));
  for (int u = 0; u < 160; ++u) {
    const double x = camera().ray(u, 60).x();
    const double z = x > 0.0 ? 0.3 / x : 0.0;  // the beam's left side
    const bool hit = z > 0.0 && z <= 2.5 && std::fabs(z * camera().ray(u, 60).y()) < 0.05;
    ASSERT_NEAR(depth(u, 60), hit ? z : 0.0, 1e-4 * z) << u;
  }
  EXPECT_GT(covered_pixels(depth), 500U);
}

TEST(ArmSilhouette, RefusesACameraThatIsBlind) {
  const CollisionBody lid{"lens_cap", Pose{Eigen::Translation3d{0.0, 0.0, 0.03}}, BoxBody{{0.3, 0.3, 0.01}}};
  const ArmModel arm = ArmModel::create(with_hand_body(lid)).value();
  const auto blind = ArmSilhouette::create(arm, camera());
  ASSERT_FALSE(blind);
  EXPECT_EQ(blind.error().code, Errc::invalid_argument);
  EXPECT_NE(blind.error().message.find("lens_cap"), std::string::npos);
}

TEST(ArmSilhouette, RefusesWhatMakesNoSense) {
  const ArmModel arm = ArmModel::create(rail()).value();
  EXPECT_FALSE(ArmSilhouette::create(arm, camera(), {.margin_m = -0.01}));
  EXPECT_FALSE(ArmSilhouette::create(arm, camera(), {.border_px = std::numeric_limits<double>::infinity()}));
  PinholeCamera bad = camera();
  bad.fx = 0.0;
  EXPECT_FALSE(ArmSilhouette::create(arm, bad));
  DepthImage other{80, 60, 1.0F};
  const auto masked = silhouette_of(rail()).mask(at(0.5), other);
  ASSERT_FALSE(masked);
  EXPECT_EQ(masked.error().code, Errc::size_mismatch);
}

TEST(ArmSilhouette, AddsNothingWhereMarginsAreZero) {
  const ArmSilhouette silhouette = silhouette_of(rail(), {.margin_m = 0.0, .border_px = 0.0, .depth_error_per_m = 0.0});
  const Executor three = Executor::with_threads(3, test::kParallelBackend);
  DepthImage depth{160, 120, 4.0F};
  const std::size_t lost = silhouette.mask(at(0.5), depth, three).value();
  EXPECT_EQ(lost, covered_pixels(silhouette.depth(at(0.5))));
}

TEST(ArmMesh, HasEveryBodyWhereItsLinkIs) {
  const CollisionBody finger{"finger", Pose{Eigen::Translation3d{0.0, 0.0, 0.1}}, BoxBody{{0.02, 0.02, 0.02}}};
  const ArmModel arm = ArmModel::create(with_hand_body(finger)).value();
  const TriangleMesh mesh = arm_mesh(arm, at(0.7), {1, 2, 3});
  ASSERT_EQ(mesh.vertices.size(), 16U);
  EXPECT_EQ(mesh.triangles.size(), 24U);
  ASSERT_EQ(mesh.colors.size(), 16U);
  EXPECT_NE(mesh.colors[0], (Rgb8{1, 2, 3}));
  EXPECT_EQ(mesh.colors[15], (Rgb8{1, 2, 3}));
  for (std::size_t i = 0; i < 16; ++i) {
    const Vector3d middle{0.0, 0.0, i < 8 ? 2.05 : arm.joint(0).axis_joint.z() * 0.7 + 0.1};
    const Vector3d half = i < 8 ? Vector3d{0.3, 0.2, 0.05} : Vector3d{0.01, 0.01, 0.01};
    EXPECT_NEAR((mesh.vertices[i].cast<double>() - middle).cwiseAbs().cwiseQuotient(half).maxCoeff(), 1.0, 1e-5);
  }
  for (const auto& t : mesh.triangles) {
    EXPECT_EQ(t[0] / 8, t[1] / 8);
    EXPECT_EQ(t[0] / 8, t[2] / 8);
  }
}

}  // namespace
}  // namespace saccade
