// SPDX-License-Identifier: Apache-2.0
#pragma once
// ArmCollision: whether an arm touches the map, fixtures or itself, in a configuration and on the way between two.

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

class ArmFront;
class PlacedFront;
class SphereTree;
struct CoveredBodies;
struct FrontBall;

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

/// "link "wrist" touches an obstacle".
[[nodiscard]] std::string describe(const ArmModel& arm, const Contact& contact);

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
  /// The straight line between two configurations, the first contact along it; none: free all along. Halves of halves
  /// are looked at, as short as what is free around the parts of the arm asks for. O(length / clearance) contacts at
  /// most.
  [[nodiscard]] std::optional<MotionContact> motion_contact(const Configuration& from, const Configuration& to,
                                                            const ObstacleMap& obstacles) const;

  /// A ball about a part of the arm, in the world; those that are `finest` have none below them.
  using BallIsClear = std::function<bool(const Eigen::Vector3d& center_world, double radius_m, bool finest)>;
  /// Whether is_clear holds for balls that cover all links but the base, the coarsest that will do.
  [[nodiscard]] bool clear(const ArmPoses& poses, const BallIsClear& is_clear) const;

  /// No point of the arm moves farther than this between two configurations, metres.
  [[nodiscard]] double travel_bound_m(const Configuration& from, const Configuration& to) const;

  [[nodiscard]] const ArmModel& arm() const { return *arm_; }
  [[nodiscard]] const ArmCollisionConfig& config() const { return config_; }
  /// The covers of the bodies of link i, in its frame.
  [[nodiscard]] const std::vector<SphereTree>& cover(int link) const;
  /// Pairs of links that are held against each other, lower number first.
  [[nodiscard]] const std::vector<std::pair<int, int>>& self_pairs() const { return self_pairs_; }

 private:
  static constexpr std::size_t kMostPairs{kMaxJoints * (kMaxJoints - 1) / 2};
  class Motion;

  /// How far a ball of a link moves at most when joints do: fixed_m + turn_rad · (its farthest point from the link's
  /// origin).
  struct Travel {
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
  /// Of two links, at least; looked for until it is more than enough_m.
  [[nodiscard]] double separation_m(const PlacedFront& placed, int a, int b, double enough_m) const;
  [[nodiscard]] double separation_m(const Pose& T_world_a, const Pose& T_world_b, int a, int b, double enough_m) const;
  /// Of a link, seen from link `first`: the joints between them count.
  [[nodiscard]] Travel travel_of(std::size_t first, std::size_t link, const Configuration& from,
                                 const Configuration& to) const;

  std::shared_ptr<const ArmModel> arm_;
  ArmCollisionConfig config_;
  std::shared_ptr<const CoveredBodies> bodies_;
  std::vector<std::pair<int, int>> self_pairs_;
  std::shared_ptr<const ArmFront> front_;
  std::vector<double> reach_m_;    ///< per link, of its bodies from its origin
  std::vector<double> offsets_m_;  ///< [joint · links + link]: at most, from the joint's origin to that of the link
};

}  // namespace saccade
