// SPDX-License-Identifier: Apache-2.0
#pragma once
// find_upright: which way is up in a scene, and from which side it was seen, so that pictures and pages stand upright.

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "saccade/core/names.hpp"
#include "saccade/core/pose.hpp"

namespace saccade {

/// What is known of a scene besides its points. All directions and poses are in the frame of the points.
struct UprightHints {
  std::optional<Eigen::Vector3d> up{};       ///< stated by the user: taken as it is
  std::optional<Eigen::Vector3d> gravity{};  ///< measured; points down
  std::vector<Pose> T_world_cameras{};       ///< cameras that were held upright: their +y points down on average
  bool is_organized{false};                  ///< the cloud is a camera's image, in that camera's frame
};

enum class UprightSource : std::uint8_t { stated, gravity, cameras, camera_frame, none };
inline constexpr auto kUprightSourceNames = make_names<UprightSource>({{UprightSource::stated, "stated"},
                                                                       {UprightSource::gravity, "gravity"},
                                                                       {UprightSource::cameras, "cameras"},
                                                                       {UprightSource::camera_frame, "camera frame"},
                                                                       {UprightSource::none, "none"}});

struct Upright {
  Eigen::Vector3d up{Eigen::Vector3d::UnitZ()};     ///< a unit vector
  std::optional<Eigen::Vector3d> towards_viewer{};  ///< from the scene to where it was seen from, of length 1
  UprightSource source{UprightSource::none};        ///< the hint that `up` rests on
  [[nodiscard]] bool operator==(const Upright&) const = default;
};

/// Whether the points are as one camera sees them: before the origin, around +z. O(points).
[[nodiscard]] bool is_in_camera_frame(std::span<const Eigen::Vector3f> positions_m);

/// The first hint that is there decides, in this order: `up`, `gravity`, the cameras, a camera's frame (organized, or
/// told by the points), and where there is none world z. Cameras and a camera's frame give a rough direction only: the
/// largest plane near it (12° for cameras, 50° for one camera's frame), a table or a floor, makes it exact if it has a
/// sixth of the points. Points that are
/// not finite are left out. Deterministic; O(points).
[[nodiscard]] Upright find_upright(std::span<const Eigen::Vector3f> positions_m, const UprightHints& hints = {});

}  // namespace saccade
