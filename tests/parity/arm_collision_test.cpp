// SPDX-License-Identifier: Apache-2.0
// Arms against obstacles and themselves, beside FCL with a box per obstacle cell and the bodies as they are described.
// SACCADE_COLLISION_CASES: configurations per arm (3000), anywhere, and as many near contact.
#include "saccade/arm/arm_collision.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <vector>

#include "saccade/arm/arm_mesh.hpp"
#include "support/effort.hpp"
#include "support/fcl_arm.hpp"
#include "support/shared_arms.hpp"
#include "support/test_arms.hpp"

namespace saccade {
namespace {

constexpr double kNear_m{0.05};             ///< distance that counts as nearly a contact
constexpr std::size_t kDistanceEvery{512};  ///< distances to meshes take FCL long

int cases() {
  const char* wanted = std::getenv("SACCADE_COLLISION_CASES");
  return wanted != nullptr ? std::atoi(wanted) : test::scaled_cases(3000);
}

/// One set of configurations.
struct ContactTally {
  int free{0};        ///< by FCL
  int called{0};      ///< contacts by ours among these
  int collisions{0};  ///< by FCL

  [[nodiscard]] int all() const { return free + collisions; }
  [[nodiscard]] double share() const { return static_cast<double>(collisions) / std::max(all(), 1); }
};

std::ostream& operator<<(std::ostream& out, const ContactTally& tally) {
  return out << tally.all() << " configurations, " << 100.0 * tally.share() << " % collide; of " << tally.free
             << " free ones " << tally.called << " are called contacts";
}

/// An arm, clutter, and the oracle.
class Comparison {
 public:
  Comparison(const ArmModel& model, const ArmCollision& arm)
      : model_{model},
        arm_{arm},
        obstacles_{
            test::clutter_around(forward_kinematics(model, model.middle()).T_world_link[1].translation(), random_)},
        fcl_{arm, obstacles_},
        corners_{corners_of(model)} {}

  /// Anywhere within the limits.
  [[nodiscard]] Configuration any() { return test::random_configuration(model_, random_); }

  /// Within kNear_m of contact: away in any direction from the border between the last free and the last colliding one
  /// of those compared, so that no point of the arm is farther from where it is in one that is called a contact, hence
  /// misses by no more than the excess of the covers. None as long as one of the two is missing.
  [[nodiscard]] std::optional<Configuration> near() {
    if (!free_ || !colliding_) return std::nullopt;
    Configuration free = *free_;
    Configuration touching = *colliding_;
    while (arm_.travel_bound_m(free, touching) > 0.1 * kNear_m) {
      const Configuration middle = 0.5 * (free + touching);
      (arm_.contact(middle, obstacles_) ? touching : free) = middle;
    }
    const auto contact = arm_.contact(touching, obstacles_);
    const bool itself = contact && contact->other_link;  // both links may move, and both covers exceed
    const double most_m = itself ? 0.4 * kNear_m : 0.9 * kNear_m;
    const double wanted_m = std::uniform_real_distribution<double>{0.0, most_m}(random_);
    Configuration step = 0.01 * (any() - touching);
    for (int i = 0; i < 3; ++i) step *= wanted_m / std::max(moved_m(touching, touching + step), 1e-9);
    while (moved_m(touching, touching + step) > most_m) step *= 0.9;
    return touching + step;
  }

  void compare(const Configuration& q, ContactTally& tally) {
    const bool ours = arm_.contact(q, obstacles_).has_value();
    if (collides(q)) {
      colliding_ = q;
      ++tally.collisions;
      EXPECT_TRUE(ours) << model_.name() << " at " << q.transpose();
    } else {
      free_ = q;
      ++tally.free;
      tally.called += ours ? 1 : 0;
    }
  }

  /// That near() is what it says, by FCL's distance from obstacles and from the arm itself.
  [[nodiscard]] double distance_m(const Configuration& q) {
    const ArmPoses poses = forward_kinematics(model_, q);
    return fcl_.collides(poses) ? 0.0 : fcl_.distance_m(poses);
  }

 private:
  [[nodiscard]] bool collides(const Configuration& q) { return fcl_.collides(forward_kinematics(model_, q)); }
  /// The farthest that a point of the arm is from where it was: one of the corners, as distances are convex.
  [[nodiscard]] double moved_m(const Configuration& from, const Configuration& to) const {
    const ArmPoses before = forward_kinematics(model_, from);
    const ArmPoses after = forward_kinematics(model_, to);
    double farthest_m = 0.0;
    for (std::size_t link = 0; link < corners_.size(); ++link) {
      const Eigen::Matrix<double, 3, 4> apart =
          (after.T_world_link[link].matrix() - before.T_world_link[link].matrix()).topRows<3>();
      for (const Eigen::Vector3d& corner : corners_[link]) {
        farthest_m = std::max(farthest_m, (apart * corner.homogeneous()).norm());
      }
    }
    return farthest_m;
  }

  [[nodiscard]] static std::vector<std::vector<Eigen::Vector3d>> corners_of(const ArmModel& model) {
    std::vector<std::vector<Eigen::Vector3d>> corners;
    for (const ArmLink& link : model.links()) {
      std::vector<Eigen::Vector3d>& of_link = corners.emplace_back();
      for (const CollisionBody& body : link.bodies) {
        for (const Eigen::Vector3f& corner : body_surface(body).vertices) of_link.push_back(corner.cast<double>());
      }
    }
    return corners;
  }

  const ArmModel& model_;
  const ArmCollision& arm_;
  std::mt19937_64 random_{11};
  ObstacleMap obstacles_;
  test::FclArm fcl_;
  std::vector<std::vector<Eigen::Vector3d>> corners_;  ///< per link, in its frame
  std::optional<Configuration> free_;
  std::optional<Configuration> colliding_;
};

void compare(const ArmModel& model) {
  ArmCollisionConfig config;
  if (test::kSanitized) config.max_excess_m = 0.01;  // fewer balls
  const auto arm = ArmCollision::create(model, config);
  ASSERT_TRUE(arm.ok()) << arm.error().to_string();
  Comparison comparison{model, *arm};
  ContactTally any;
  ContactTally near;
  std::vector<Configuration> close;
  for (int i = 0; i < cases(); ++i) {
    comparison.compare(comparison.any(), any);
    if (auto q = comparison.near()) close.push_back(std::move(*q));
  }
  for (std::size_t i = 0; i < close.size(); ++i) {
    comparison.compare(close[i], near);
    if (i % kDistanceEvery == 0) {
      EXPECT_LE(comparison.distance_m(close[i]), kNear_m) << model.name() << " at " << close[i].transpose();
    }
  }
  std::cout << model.name() << ", anywhere: " << any << '\n'
            << model.name() << ", within " << 100.0 * kNear_m << " cm of contact: " << near << '\n';
  EXPECT_GT(any.collisions, 0);
  EXPECT_GT(near.collisions, 0);
  EXPECT_GT(near.free, 0);
  if (test::kSanitized) return;  // too few for shares, and covered by coarser balls
  EXPECT_GT(any.share(), 0.3);
  EXPECT_LT(any.share(), 0.7);
  EXPECT_LE(any.called, 0.05 * any.free);
}

TEST(ArmCollisionParity, BuiltInComauIsNeverFreeWhereFclCollides) { compare(find_robot("comau_smart_six")->arm); }

TEST(ArmCollisionParity, RecordedHullsAreNeverFreeWhereFclCollides) {
  if (test::kSanitized) GTEST_SKIP() << "many triangles take long under sanitizers; those of the built-in arm do not";
  if (!std::filesystem::exists(test::shared_robots())) GTEST_SKIP() << "no " << test::shared_robots();
  compare(test::shared_comau(true)->arm);
}

}  // namespace
}  // namespace saccade
