// SPDX-License-Identifier: Apache-2.0
#include "thesis/scan_motion.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "saccade/arm/kinematics.hpp"
#include "saccade/trial/simulated_run.hpp"

namespace saccade::thesis {
namespace {

using Eigen::Vector3d;

/// On a sphere around the middle of the table.
struct Corner {
  double radius_m;
  double azimuth_deg;
  double elevation_deg;
};
/// Lower down, the arm comes to the table's left and front only.
constexpr std::array<Corner, 12> kCorners{{{0.85, 165, 22},
                                           {0.85, 195, 25},
                                           {0.80, 180, 45},
                                           {0.75, 150, 52},
                                           {0.75, 115, 65},
                                           {0.70, 80, 65},
                                           {0.70, 40, 65},
                                           {0.75, 0, 65},
                                           {0.80, 330, 50},
                                           {0.80, 305, 35},
                                           {0.80, 275, 38},
                                           {0.80, 285, 60}}};
const Vector3d kLookedAt{0.0, 0.0, 0.08};

/// A camera at the corner, in four turns about its axis.
std::vector<Pose> views_at(const Corner& corner) {
  const double azimuth_rad = corner.azimuth_deg * std::numbers::pi / 180.0;
  const double elevation_rad = corner.elevation_deg * std::numbers::pi / 180.0;
  const Vector3d outward{std::cos(azimuth_rad) * std::cos(elevation_rad),
                         std::sin(azimuth_rad) * std::cos(elevation_rad), std::sin(elevation_rad)};
  std::vector<Pose> views;
  for (int quarter = 0; quarter < 4; ++quarter) {
    views.push_back(
        look_at(kLookedAt + corner.radius_m * outward, kLookedAt, Vector3d::UnitZ(), 0.5 * std::numbers::pi * quarter));
  }
  return views;
}

}  // namespace

Result<std::vector<Pose>> scan_motion(const Scene& scene, const ArmModel& arm, double pace) {
  SACCADE_EXPECTS(pace > 0.0);
  PlannedArmConfig config;
  config.obstacles.unknown_is_obstacle = false;
  Scene seen = scene;
  seen.scan = views_at(kCorners.front());
  // The person who teaches the arm its path sees the objects, which no map holds yet.
  for (SceneObject& object : seen.objects) object.fixture = true;
  const SimulatedRunConfig run;
  SACCADE_TRY(PlannedArm robot, planned_arm(arm, seen, run, config));

  std::vector<Pose> poses{robot.T_world_camera()};
  const double between_s = pace / kFrameRate_hz;  // in the time of the planned motions, which are the fastest
  double next_s = between_s;                      // since the arm left the last corner
  for (const Corner& corner : kCorners) {
    SACCADE_TRY(const PlannedMotion planned, robot.plan(views_at(corner)));
    if (!planned.motion) {
      return Error{Errc::not_found, "no way for the arm to a corner of the scan: " + planned.why, arm.name()};
    }
    const Trajectory& trajectory = planned.motion->trajectory;
    for (; next_s <= trajectory.duration_s(); next_s += between_s) {
      poses.push_back(camera_pose(arm, trajectory.at(next_s).q));
    }
    next_s -= trajectory.duration_s();
    SACCADE_TRY([[maybe_unused]] const auto arrival, robot.execute(*planned.motion));
  }
  return poses;
}

}  // namespace saccade::thesis
