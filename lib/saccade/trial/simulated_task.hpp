// SPDX-License-Identifier: Apache-2.0
#pragma once
// scene_changes and simulated_hand: a user's changes of a scene, and the hand's motion meanwhile. synthetic_task: a
// hand that reaches, acts and leaves.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "saccade/core/region.hpp"
#include "saccade/scene/scene.hpp"
#include "saccade/sensor/hand_trajectory.hpp"

namespace saccade {

struct SyntheticTaskConfig {
  int actions{2};             ///< number of places where the hand acts, one after the other
  double rate_hz{100.0};      ///< samples per second
  double speed_m_s{0.8};      ///< mean speed of a reach; each differs by up to a third
  double action_s{0.3};       ///< mean time at a place
  double sway_m{0.02};        ///< largest sway of the hand there
  double repeat_share{0.15};  ///< share of samples that repeat the previous position, as with magnetic sensors
  double noise_m{0.0};        ///< standard deviation of other positions, per coordinate
};

/// Trajectory and the places that the hand visited.
struct SyntheticTask {
  HandTrajectory trajectory;
  std::vector<Eigen::Vector3d> actions_m;
};

/// Simulates a hand that enters from the user's side, reaches to each place on curved minimum-jerk paths (Flash and
/// Hogan 1985), sways there and leaves on the path it came by. Places lie on a table of 1 m × 0.8 m around the origin
/// at z = 0, at least 0.35 m apart. The seed decides everything, on every platform. Expects 1 to 4 actions and positive
/// rates. O(samples).
[[nodiscard]] SyntheticTask synthetic_task(std::uint64_t seed, const SyntheticTaskConfig& config = {});

/// Path of a simulated hand.
struct SyntheticHandPath {
  Eigen::Vector3d outside_m{Eigen::Vector3d::Zero()};  ///< point where it enters and leaves
  std::vector<Eigen::Vector3d> places_m;               ///< places where it acts, one after the other
  std::vector<Box> obstacles;                          ///< boxes that it passes over between two places
};

/// Simulates the hand for given places, whose number replaces `config.actions`. A path is lifted as far as needed to
/// pass over the obstacles, at most by 0.6 of its length; obstacles above which it begins or ends do not count. Expects
/// at least one place, finite points and positive rates. O(samples · obstacles).
[[nodiscard]] SyntheticTask synthetic_task(const SyntheticHandPath& way, std::uint64_t seed,
                                           const SyntheticTaskConfig& config = {});

/// Object that appeared, vanished or moved.
struct SceneChange {
  std::string object;
  std::optional<Box> was{};  ///< bounds before, world frame; nullopt: it did not exist
  std::optional<Box> is{};   ///< bounds after; nullopt: it is gone
};

/// Compares two scenes by the names of their objects; an object with different triangles has moved. Vanished objects
/// come first, then moved and new ones, each in its scene's order; empty where nothing differs.
/// @return invalid_argument: the workspaces differ, or a support or fixture does; errors of true_meshes.
/// O(triangles).
[[nodiscard]] Result<std::vector<SceneChange>> scene_changes(const Scene& before, const Scene& after);

struct SimulatedHandConfig {
  SyntheticTaskConfig motion{.sway_m = 0.005,
                             .noise_m = 0.001};  ///< `actions` is ignored: the changes give their number
  Eigen::Vector3d user_m{0.0, 0.85, 0.35};  ///< point where the hand enters and leaves; varied by a seed by up to 0.2 m
  double grip_share{0.75};                  ///< share of the object's height at which it is held
  double wrist_m{0.06};                     ///< distance from there to the sensor: half of it upwards, the rest towards
                                            ///< the user
  double clearance_m{0.03};                 ///< between the carried object and those that it passes over

  [[nodiscard]] Status validate() const;
};

/// Place where the hand acted.
struct HandPlace {
  std::string object;
  bool picked_up{false};                                ///< false: put down
  Eigen::Vector3d position_m{Eigen::Vector3d::Zero()};  ///< position of the sensor
};

struct SimulatedHand {
  HandTrajectory trajectory;
  std::vector<HandPlace> places;  ///< in order of time
};

/// Simulates the motion sensor on a hand that makes the changes one after the other. It reaches to an object's old
/// place and picks it up, carries it to its new place and puts it down, or does only one of these; it passes over
/// unchanged objects. Thesis §2.4.3. Motions: synthetic_task.
/// @param before  the scene at the start.
/// @return invalid_argument: a bad config, or no changes; errors of true_meshes. The seed decides everything, on every
///         platform. O(samples · objects + triangles).
[[nodiscard]] Result<SimulatedHand> simulated_hand(const Scene& before, const std::vector<SceneChange>& changes,
                                                   std::uint64_t seed, const SimulatedHandConfig& config = {});

}  // namespace saccade
