// SPDX-License-Identifier: Apache-2.0
#pragma once
// ArmCollision: whether an arm collides with the map, fixtures or itself, in a configuration or during a motion.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "saccade/arm/arm_model.hpp"
#include "saccade/arm/kinematics.hpp"
#include "saccade/arm/obstacle_map.hpp"

namespace saccade {

class ArmCover;
class PlacedFront;
class SphereTree;
struct CoveredBodies;
struct FrontBall;

struct ArmCollisionConfig {
  double max_excess_m{0.005};  ///< excess of the balls that cover the links: SphereTreeConfig
  /// Largest movement of any point of the arm between two checked configurations of a motion, unless more space around
  /// it is known to be free. No link passes through a thicker plate.
  double max_step_m{0.01};

  [[nodiscard]] Status validate() const;
};

/// Contact of a link with another or with an obstacle; link 0 is the base.
struct Contact {
  int link{0};
  std::optional<int> other_link;  ///< none: the link touches an obstacle
};

/// Returns a text such as "link "wrist" touches an obstacle".
[[nodiscard]] std::string describe(const ArmModel& arm, const Contact& contact);

/// Collision checks of an arm. Links are solids covered by balls (SphereTree): a configuration called free is free,
/// while a gap below max_excess_m may be called a contact. The base does not move and is checked against the other
/// links only, not against obstacles. Consecutive links, and links that touch in every one of many random
/// configurations, are not checked against each other. Immutable; safe for concurrent use.
class ArmCollision {
 public:
  /// Errors: those of ArmCollisionConfig::validate and of SphereTree::build, with the link's name.
  [[nodiscard]] static Result<ArmCollision> create(const ArmModel& arm, const ArmCollisionConfig& config = {});

  /// Returns the first contact found; nullopt if free. Ignores limits. About a microsecond when free.
  [[nodiscard]] std::optional<Contact> contact(const Configuration& q, const ObstacleMap& obstacles) const;
  /// Checks poses that are known already.
  [[nodiscard]] std::optional<Contact> contact(const ArmPoses& poses, const ObstacleMap& obstacles) const;

  struct MotionContact {
    double share;  ///< position of the contact between `from` and `to`, in [0, 1]
    Contact contact;
  };
  /// Checks the straight line between two configurations. Returns the first contact along it; nullopt if free. Halves
  /// intervals until they are as short as the free space around the arm's parts requires. O(length / clearance)
  /// contacts at most.
  [[nodiscard]] std::optional<MotionContact> motion_contact(const Configuration& from, const Configuration& to,
                                                            const ObstacleMap& obstacles) const;

  /// Predicate on a ball around a part of the arm, in the world; `finest` balls have none below them.
  using BallIsClear = std::function<bool(const Eigen::Vector3d& center_world, double radius_m, bool finest)>;
  /// Tells whether is_clear holds for balls that cover all links except the base, using balls as coarse as possible.
  [[nodiscard]] bool clear(const ArmPoses& poses, const BallIsClear& is_clear) const;

  /// Returns an upper bound of the movement of any point of the arm between two configurations, metres.
  [[nodiscard]] double travel_bound_m(const Configuration& from, const Configuration& to) const;

  [[nodiscard]] const ArmModel& arm() const { return *arm_; }
  [[nodiscard]] const ArmCollisionConfig& config() const { return config_; }
  /// Returns the covers of the bodies of link i, in its frame.
  [[nodiscard]] const std::vector<SphereTree>& cover(int link) const;
  /// Returns the pairs of links that are checked against each other, lower number first.
  [[nodiscard]] const std::vector<std::pair<int, int>>& self_pairs() const { return self_pairs_; }

 private:
  static constexpr std::size_t kMostPairs{kMaxJoints * (kMaxJoints - 1) / 2};
  class Motion;

  /// Upper bound of a ball's movement when joints move: fixed_m + turn_rad · (distance of its farthest point from the
  /// link's origin).
  struct MotionBound {
    double fixed_m{0.0};
    double turn_rad{0.0};
  };

  explicit ArmCollision(const ArmModel& arm, const ArmCollisionConfig& config)
      : arm_{std::make_shared<const ArmModel>(arm)}, config_{config} {}
  [[nodiscard]] std::optional<Contact> contact(const PlacedFront& placed, const ObstacleMap& obstacles) const;
  void find_levers();
  void find_self_pairs();
  [[nodiscard]] bool touches_obstacle(const FrontBall& of_front, const PlacedFront& placed,
                                      const ObstacleMap& obstacles) const;
  /// Lower bound of the distance between two links. The search stops once it exceeds enough_m.
  [[nodiscard]] double separation_m(const PlacedFront& placed, int a, int b, double enough_m) const;
  [[nodiscard]] double separation_m(const Pose& T_world_a, const Pose& T_world_b, int a, int b, double enough_m) const;
  /// Returns the motion bound of a link relative to link `first`: the joints between them count.
  [[nodiscard]] MotionBound motion_bound_of(std::size_t first, std::size_t link, const Configuration& from,
                                            const Configuration& to) const;

  std::shared_ptr<const ArmModel> arm_;
  ArmCollisionConfig config_;
  std::shared_ptr<const CoveredBodies> bodies_;
  std::vector<std::pair<int, int>> self_pairs_;
  std::shared_ptr<const ArmCover> front_;
  std::vector<double> reach_m_;    ///< per link: largest distance of its bodies from its origin
  std::vector<double> offsets_m_;  ///< [joint · links + link]: upper bound of the distance from the joint's origin to
                                   ///< the link's
};

}  // namespace saccade
