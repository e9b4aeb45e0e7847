// SPDX-License-Identifier: Apache-2.0
// Arms that back out of what was seen where they stand: the way is the one that they came, no ball of a cover reaches
// deeper into any obstacle (by all balls and all boxes) or into another one, and FCL finds them free where the way
// ends.
#include "saccade/arm/internal/executed_path.hpp"
#include "saccade/arm/internal/sphere_tree.hpp"

#include <gtest/gtest.h>

#include <iostream>

#include "saccade/arm/motion_planner.hpp"
#include "saccade/arm/urdf.hpp"
#include "support/effort.hpp"
#include "support/fcl_arm.hpp"
#include "support/test_arms.hpp"

namespace saccade {
namespace {

/// Positions between two samples are not checked, and may be slightly deeper.
constexpr double kSlack_m{1e-3};

/// [box][link]: how deep the finest balls of a link reach into a box; below 0 they are so far from it.
using Depths = std::vector<std::vector<double>>;

Depths depths_by_plain_search_m(const Configuration& q, const ArmCollision& arm, const std::vector<Box>& boxes) {
  const ArmPoses poses = forward_kinematics(arm.arm(), q);
  Depths depths_m;
  for (const Box& box : boxes) {
    std::vector<double>& of_box = depths_m.emplace_back(static_cast<std::size_t>(arm.arm().dof()) + 1, -1.0);
    for (std::size_t link = 1; link < of_box.size(); ++link) {
      for (const SphereTree& cover : arm.cover(static_cast<int>(link))) {
        for (const TreeBall& ball : cover.balls()) {
          if (!ball.finest) continue;
          const Eigen::Vector3d center = poses.T_world_link[link] * ball.center.cast<double>();
          const double distance_m = (center.cwiseMax(box.min).cwiseMin(box.max) - center).norm();
          of_box[link] = std::max(of_box[link], static_cast<double>(ball.radius_m) - distance_m);
        }
      }
    }
  }
  return depths_m;
}

double deepest_m(const std::vector<double>& depths_m) { return *std::max_element(depths_m.begin(), depths_m.end()); }
double deepest_m(const Depths& depths_m, std::size_t link) {
  double most_m = 0.0;
  for (const std::vector<double>& of_box : depths_m) most_m = std::max(most_m, of_box[link]);
  return most_m;
}

/// An arm in free space that has driven a little.
class Driven {
 public:
  Driven(const ArmModel& model, const ArmCollision& arm, std::uint64_t seed)
      : model_{model}, arm_{arm}, random_{seed}, free_{free_space(model)} {}

  /// Three motions, free of self-contact.
  void drive() {
    way = ExecutedPath{};
    driven.clear();
    do {
      rests = {test::random_configuration(model_, random_)};
      for (int i = 0; i < 3; ++i) {
        Configuration next = rests.back();
        for (double& value : next) value += within(-0.3, 0.3);
        rests.push_back(next);
      }
    } while (!possible());
    for (std::size_t i = 1; i < rests.size(); ++i) {
      driven.push_back(parametrise(model_, {rests[i - 1], rests[i]}));
      way.add(driven.back());
    }
  }

  /// Something near a ball of the arm as it stands.
  [[nodiscard]] ObstacleMap seen_late() {
    const ArmPoses poses = forward_kinematics(model_, rests.back());
    TsdfMap map{free_.snapshot()};
    const auto link = static_cast<int>(random_() % static_cast<std::uint64_t>(model_.dof())) + 1;
    if (!arm_.cover(link).empty()) {
      const auto balls = arm_.cover(link).front().balls();
      const TreeBall& ball = balls[random_() % balls.size()];
      const Eigen::Vector3d away = Eigen::Vector3d{within(-1, 1), within(-1, 1), within(-1, 1)}.normalized();
      const Eigen::Vector3d p_world = poses.T_world_link[static_cast<std::size_t>(link)] *
                                      (ball.center.cast<double>() + (ball.radius_m + within(0.0, 0.05)) * away);
      SACCADE_EXPECTS(map.forget(Sphere{p_world, within(0.01, 0.03)}).ok());
    }
    return ObstacleMap::create(map.snapshot(), {}, Executor{}).value();
  }

  /// Where the arm was so long before it stopped.
  [[nodiscard]] Configuration before(double t_s) const {
    for (auto motion = driven.rbegin(); motion != driven.rend(); ++motion) {
      if (t_s <= motion->duration_s()) return motion->at(motion->duration_s() - t_s).q;
      t_s -= motion->duration_s();
    }
    return rests.front();
  }

  ExecutedPath way;
  std::vector<Configuration> rests;
  std::vector<Trajectory> driven;

 private:
  static TsdfMap free_space(const ArmModel& model) {
    const Eigen::Vector3d shoulder = forward_kinematics(model, model.middle()).T_world_link[1].translation();
    TsdfConfig config;
    config.voxel_size_m = 0.01;
    config.workspace = Box{shoulder - Eigen::Vector3d::Constant(1.6), shoulder + Eigen::Vector3d::Constant(1.6)};
    TsdfMap map = TsdfMap::create(config).value();
    SACCADE_EXPECTS(map.free(*config.workspace).ok());
    return map;
  }
  [[nodiscard]] double within(double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random_);
  }
  [[nodiscard]] bool possible() {
    static const ObstacleMap nothing = ObstacleMap::create(free_.snapshot(), {}, Executor{}).value();
    for (std::size_t i = 1; i < rests.size(); ++i) {
      if (!model_.within_limits(rests[i]) || arm_.motion_contact(rests[i - 1], rests[i], nothing)) return false;
    }
    return true;
  }

  const ArmModel& model_;
  const ArmCollision& arm_;
  std::mt19937_64 random_;
  TsdfMap free_;
};

void expect_to_back_out_the_way_it_came(int cases) {
  const ArmModel model = find_robot("comau_smart_six")->arm;
  const ArmCollision arm = ArmCollision::create(model).value();
  Driven driven{model, arm, 5};
  constexpr double kStep_s{test::kSanitized ? 0.11 : 0.011};
  int touching = 0;
  int backed_out = 0;
  std::size_t looked_at = 0;
  for (int i = 0; i < cases; ++i) {
    driven.drive();
    const Configuration& stands = driven.rests.back();
    const ObstacleMap obstacles = driven.seen_late();
    if (!arm.contact(stands, obstacles)) continue;
    ++touching;
    const std::optional<Trajectory> back = driven.way.retreat_from(stands, arm, obstacles);
    if (!back) continue;
    ++backed_out;
    const std::vector<Box> boxes = obstacles.boxes();
    const Depths at_first_m = depths_by_plain_search_m(stands, arm, boxes);
    test::FclArm fcl{arm, obstacles};
    for (double t_s = 0.0; t_s < back->duration_s(); t_s += kStep_s) {
      const Configuration q = back->at(t_s).q;
      EXPECT_LT(test::distance(q, driven.before(t_s)), 1e-6);
      const Depths depths_m = depths_by_plain_search_m(q, arm, boxes);
      for (std::size_t box = 0; box < boxes.size(); ++box) {
        EXPECT_FALSE(deepest_m(at_first_m[box]) < 0.0 && deepest_m(depths_m[box]) > kSlack_m) << "another cell";
      }
      for (int link = 1; link <= model.dof(); ++link) {
        const auto of_link = static_cast<std::size_t>(link);
        EXPECT_LE(deepest_m(depths_m, of_link), deepest_m(at_first_m, of_link) + kSlack_m);
      }
      EXPECT_FALSE(!arm.contact(q, obstacles) && fcl.collides(forward_kinematics(model, q)));
      ++looked_at;
    }
    EXPECT_FALSE(fcl.collides(forward_kinematics(model, back->end())));
    EXPECT_FALSE(arm.contact(back->end(), obstacles));
    EXPECT_LT(test::nearest(driven.rests, back->end()), 1e-6) << "a place of rest";
  }
  EXPECT_GT(touching, cases / 4);
  EXPECT_GT(20 * backed_out, touching);
  EXPECT_LT(backed_out, touching) << "some ways lead deeper";
  std::cout << "cases " << cases << ", touching " << touching << ", backed out " << backed_out << ", looked at "
            << looked_at << '\n';
}

TEST(DrivenWayParity, BackOutIsTheWayThatItCameAndNeverDeeper) {
  expect_to_back_out_the_way_it_came(test::scaled_cases(60));
}
TEST(DrivenWayParityEvidence, BackOutIsTheWayThatItCameAndNeverDeeper) { expect_to_back_out_the_way_it_came(250); }

}  // namespace
}  // namespace saccade
