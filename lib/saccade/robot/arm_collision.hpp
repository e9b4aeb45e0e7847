// SPDX-License-Identifier: Apache-2.0
#pragma once
// ArmCollision: whether an arm touches the map, fixtures or itself, in a configuration and on the way between two.

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "saccade/robot/kinematics.hpp"
#include "saccade/robot/obstacle_map.hpp"
#include "saccade/robot/sphere_tree.hpp"

namespace saccade {

struct ArmCollisionConfig {
  double max_excess_m{0.005};  ///< of the balls that cover the links: SphereTreeConfig
  /// Between two checked configurations of a motion no point of the arm moves farther than this, or than what is known
  /// to be free around it: no link passes through a plate that is thicker.
  double max_step_m{0.01};

  [[nodiscard]] Status validate() const;
};

/// What touches what; link 0 is the base.
struct Contact {
  int link{0};
  std::optional<int> other_link;  ///< none: the link touches an obstacle
};

/// Links are solids covered by balls (SphereTree), so what is called free is free, and what misses by less than
/// max_excess_m may be called a contact. The base does not move and is not held against obstacles, only
/// against the other links. Links that follow each other, and those that touch in every one of many random
/// configurations, are not held against each other. Immutable; safe for concurrent use.
class ArmCollision {
 public:
  /// Errors: those of ArmCollisionConfig::validate and of SphereTree::build, with the link's name.
  [[nodiscard]] static Result<ArmCollision> create(const ArmModel& arm, const ArmCollisionConfig& config = {});

  /// The first contact that is found; none: free. Limits are not looked at. About a microsecond when free.
  [[nodiscard]] std::optional<Contact> contact(const Configuration& q, const ObstacleMap& obstacles) const;
  /// The same for poses that are known already.
  [[nodiscard]] std::optional<Contact> contact(const ArmPoses& poses, const ObstacleMap& obstacles) const;

  struct MotionContact {
    double share;  ///< of the way from `from` to `to`, in [0, 1]
    Contact contact;
  };
  /// The straight line between two configurations; none: free all along. Steps are as long as what is free around the
  /// arm allows. O(length / clearance) contacts.
  [[nodiscard]] std::optional<MotionContact> motion_contact(const Configuration& from, const Configuration& to,
                                                            const ObstacleMap& obstacles) const;

  /// No point of the arm moves farther than this between two configurations, metres.
  [[nodiscard]] double travel_bound_m(const Configuration& from, const Configuration& to) const;

  [[nodiscard]] const ArmModel& arm() const { return *arm_; }
  /// The covers of the bodies of link i, in its frame.
  [[nodiscard]] const std::vector<SphereTree>& cover(int link) const { return covers_[static_cast<std::size_t>(link)]; }
  /// Pairs of links that are held against each other, lower number first.
  [[nodiscard]] const std::vector<std::pair<int, int>>& self_pairs() const { return self_pairs_; }

 private:
  /// Balls that cover the whole arm are asked about together; only where one is not clear, those below it.
  struct FrontBall {
    std::size_t link;
    std::size_t body;
    std::uint32_t index;  ///< in the body's cover
    TreeBall ball;
  };

  /// A box around a body, or around all of a link, in the link's frame.
  struct BodyBox {
    Pose T_link_box;
    Eigen::Vector3d half_m;
  };

  explicit ArmCollision(const ArmModel& arm, const ArmCollisionConfig& config)
      : arm_{std::make_shared<const ArmModel>(arm)}, config_{config} {}
  void choose_front();
  void find_travel();
  void find_self_pairs();
  /// Calls visit(front ball, lower bound of its clearance in metres) until it returns false; whether it never did.
  template <class Visit>
  bool visit_front(const ArmPoses& poses, const ObstacleMap& obstacles, const Visit& visit) const;
  [[nodiscard]] double clearance_m(const ArmPoses& poses, const ObstacleMap& obstacles) const;
  [[nodiscard]] double separation_m(const ArmPoses& poses, int a, int b, double enough_m) const;

  std::shared_ptr<const ArmModel> arm_;
  ArmCollisionConfig config_;
  std::vector<std::vector<SphereTree>> covers_;  ///< per link
  std::vector<std::vector<BodyBox>> boxes_;      ///< the same bodies
  std::vector<BodyBox> link_boxes_;              ///< per link
  std::vector<FrontBall> front_;                 ///< links that move, hand first
  std::vector<std::pair<int, int>> self_pairs_;
  std::vector<double> travel_m_;  ///< per joint: no point behind it is farther from its axis; 1 for prismatic joints
};

}  // namespace saccade
