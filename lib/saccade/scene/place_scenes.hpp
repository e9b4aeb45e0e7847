// SPDX-License-Identifier: Apache-2.0
#pragma once
// place_scene: rooms to carry a camera through, for tracking: one that the camera comes back to, and others whose
// places look alike.

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "saccade/core/pose.hpp"
#include "saccade/scene/scene.hpp"

namespace saccade {

/// Path of a carried camera. Eye and target pass through the knots at equal times, on Catmull-Rom splines; they sway
/// smoothly about these and the hand trembles.
struct CarriedPath {
  std::vector<Eigen::Vector3d> eyes;     ///< world frame
  std::vector<Eigen::Vector3d> targets;  ///< as many
  double sway_m{0.03};                   ///< amplitude per axis, over seconds
  double tremor_m{0.0015};               ///< amplitude per axis, several times a second
};

/// Returns the poses at 30 Hz. Expects two knots or more and frames ≥ 1. A seed shifts sway and tremor; the number of
/// frames does not change the path's extent. O(frames).
[[nodiscard]] std::vector<Pose> carried_poses(const CarriedPath& path, std::size_t frames, std::uint64_t seed = 1);

constexpr std::array<std::string_view, 2> kPlaceScenes{"loop", "alike"};

struct PlaceScene {
  Scene scene;
  CarriedPath path;
  std::size_t frames{0};  ///< number of frames at 1.8° or 2.5 cm per frame
};

/// Draws a scene: "loop:SEED" is a room with things along its four walls; the camera turns in it by 1.1 turns, so that
/// it ends where it has seen everything before. In "alike:SEED" the camera never comes back: odd seeds are a row of
/// bays that are equal to each other, which it passes; even ones a square room with four equal walls, in which it turns
/// by 300°, so that its last images overlap none of its first.
/// Answers not_found for another name, invalid_argument for a seed that is not a whole number.
[[nodiscard]] Result<PlaceScene> place_scene(std::string_view name);

}  // namespace saccade
