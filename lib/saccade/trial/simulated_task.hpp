// SPDX-License-Identifier: Apache-2.0
#pragma once
// scene_changes and simulated_hand: what a user changed in a scene, and how the hand may have moved meanwhile;
// made_up_task: a hand that reaches, acts and leaves.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "saccade/core/region.hpp"
#include "saccade/scene/scene.hpp"
#include "saccade/sensor/hand_trajectory.hpp"

namespace saccade {

struct MadeUpTaskConfig {
  int actions{2};             ///< places where the hand acts, one after the other
  double rate_hz{100.0};      ///< samples per second
  double speed_m_s{0.8};      ///< mean of a reach; each differs by up to a third
  double action_s{0.3};       ///< mean time at a place
  double sway_m{0.02};        ///< by how much the hand sways there, at most
  double repeat_share{0.15};  ///< samples that repeat the position before, as those of magnetic sensors do
  double noise_m{0.0};        ///< standard deviation of a position that is no repeat, on each coordinate
};

/// A trajectory and the places that the hand went to.
struct MadeUpTask {
  HandTrajectory trajectory;
  std::vector<Eigen::Vector3d> actions_m;
};

/// Enters from the side of the user, reaches to each place on bent minimum-jerk ways (Flash and Hogan 1985), sways
/// there and leaves the way it came. Places lie on a table of 1 m × 0.8 m around the origin at z = 0, 0.35 m apart at
/// least. The seed decides everything, on every platform. Expects 1 to 4 actions and positive rates. O(samples).
[[nodiscard]] MadeUpTask made_up_task(std::uint64_t seed, const MadeUpTaskConfig& config = {});

/// Where a hand is to go.
struct MadeUpWay {
  Eigen::Vector3d outside_m{Eigen::Vector3d::Zero()};  ///< where it comes from and leaves to
  std::vector<Eigen::Vector3d> places_m;               ///< where it acts, one after the other
  std::vector<Box> obstacles;                          ///< it passes over those that lie between two places
};

/// The same for given places, whose number takes the place of `config.actions`. A way is lifted as far as it takes
/// to pass over the obstacles, but by no more than 0.6 of its length; those that it begins or ends over do not count.
/// Expects a place at least, finite points and positive rates. O(samples · obstacles).
[[nodiscard]] MadeUpTask made_up_task(const MadeUpWay& way, std::uint64_t seed, const MadeUpTaskConfig& config = {});

/// An object that appeared, vanished or moved.
struct SceneChange {
  std::string object;
  std::optional<Box> was{};  ///< bounds before, world frame; nullopt: it was not there
  std::optional<Box> is{};   ///< after; nullopt: it is gone
};

/// Compares two scenes by the names of their objects; one whose triangles differ has moved. What vanished comes first,
/// then what moved and what appeared, each in its scene's order; none where nothing differs.
/// @return invalid_argument: the workspaces differ, or a support or fixture does; errors of true_meshes.
/// O(triangles).
[[nodiscard]] Result<std::vector<SceneChange>> scene_changes(const Scene& before, const Scene& after);

struct SimulatedHandConfig {
  MadeUpTaskConfig motion{.sway_m = 0.005, .noise_m = 0.001};  ///< `actions` is not looked at: the changes say how many
  Eigen::Vector3d user_m{0.0, 0.85, 0.35};  ///< where the hand comes from and leaves to; a seed's is up to 0.2 m beside
  double grip_share{0.75};                  ///< of the object's height, at which it is held
  double wrist_m{0.06};                     ///< from there to the sensor: half of it upwards, the rest towards the user
  double clearance_m{0.03};                 ///< between what is carried and what it passes over

  [[nodiscard]] Status validate() const;
};

/// Where the hand did something.
struct HandPlace {
  std::string object;
  bool picked_up{false};                                ///< false: put down
  Eigen::Vector3d position_m{Eigen::Vector3d::Zero()};  ///< of the sensor
};

struct SimulatedHand {
  HandTrajectory trajectory;
  std::vector<HandPlace> places;  ///< in time
};

/// The motion sensor on a hand that makes the changes one after the other: it reaches to where an object was and picks
/// it up, carries it to where it is and puts it down, or does only one of these; what does not change it passes over.
/// Thesis §2.4.3. Motions: made_up_task.
/// @param before  the scene that it works in.
/// @return invalid_argument: a bad config, or no changes; errors of true_meshes. The seed decides everything, on every
///         platform. O(samples · objects + triangles).
[[nodiscard]] Result<SimulatedHand> simulated_hand(const Scene& before, const std::vector<SceneChange>& changes,
                                                   std::uint64_t seed, const SimulatedHandConfig& config = {});

}  // namespace saccade
