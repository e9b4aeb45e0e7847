// SPDX-License-Identifier: Apache-2.0
#include "thesis/scan_tracking.hpp"

#include <algorithm>

#include "saccade/arm/urdf.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "saccade/tracking/reconstruction.hpp"
#include "saccade/trial/simulated_run.hpp"
#include "thesis/scan_motion.hpp"

namespace saccade::thesis {
namespace {

constexpr double kDepthTooLong{1.01};

/// One way to know the pose, with its map.
struct Tracker {
  ScanTracking tracking;
  Reconstruction reconstruction;
  Pose T_world_first{Pose::Identity()};  ///< where it believes that the camera was first
};

Result<std::vector<Tracker>> make_trackers(const TsdfConfig& map) {
  ReconstructionConfig config;
  config.map = map;
  std::vector<Tracker> trackers;
  for (const double depth_scale : {1.0, kDepthTooLong}) {
    for (const bool egomotion : {true, false}) {
      SACCADE_TRY(Reconstruction reconstruction, Reconstruction::create(config));
      ScanTracking tracking;
      tracking.egomotion = egomotion;
      tracking.depth_scale = depth_scale;
      trackers.push_back({std::move(tracking), std::move(reconstruction)});
    }
  }
  return trackers;
}

/// Difference between the camera's pose and the one assumed by the arm.
Pose calibration_error(const ScanTrackingConfig& config) {
  const Eigen::Vector3d diagonal = Eigen::Vector3d::Ones().normalized();
  Pose T_camera_reported = Pose::Identity();
  T_camera_reported.translation() = config.calibration_m * diagonal;
  T_camera_reported.linear() = Eigen::AngleAxisd{config.calibration_rad, diagonal}.toRotationMatrix();
  return T_camera_reported;
}

DepthImage scaled(DepthImage depth, double scale) {
  for (int v = 0; v < depth.height(); ++v) {
    for (int u = 0; u < depth.width(); ++u) depth(u, v) *= static_cast<float>(scale);
  }
  return depth;
}

/// @param T_first_camera the true motion since the first frame
Status add_frame(Tracker& tracker, Frame frame, const PinholeCamera& camera, const Pose& T_world_reported,
                 const Pose& T_first_camera, const Executor& executor) {
  ScanTracking& tracking = tracker.tracking;
  frame.depth = scaled(std::move(frame.depth), tracking.depth_scale);
  const TrackingMode mode = tracking.egomotion ? TrackingMode::icp : TrackingMode::forced;
  SACCADE_TRY(const FrameReport report,
              tracker.reconstruction.process(frame, camera, mode, T_world_reported, executor));
  if (report.status == FrameReport::Status::lost) ++tracking.lost;
  if (tracking.translation_m.empty()) tracker.T_world_first = report.T_world_camera;
  const Pose T_true_tracked = T_first_camera.inverse() * tracker.T_world_first.inverse() * report.T_world_camera;
  tracking.translation_m.push_back(T_true_tracked.translation().norm());
  tracking.rotation_rad.push_back(rotation_angle_rad(T_true_tracked));
  return {};
}

void measure_objects(const ObjectShapes& shapes, const Executor& executor, Tracker& tracker) {
  const TriangleMesh mesh = extract_mesh(tracker.reconstruction.map().content(), executor);
  for (const std::size_t object : shapes.objects()) {
    const std::optional<ObjectShape> measured = shapes.measure(object, mesh, executor);
    if (measured) {
      tracker.tracking.errors.push_back(shape_error(*measured, shapes.true_shape(object)));
    } else {
      ++tracker.tracking.unmeasured;
    }
  }
}

}  // namespace

Result<std::vector<ScanTracking>> track_scan(const std::string& scene, const ScanTrackingConfig& config,
                                             const Executor& executor, const Progress& progress) {
  SACCADE_TRY(Scene found, find_scene(scene));
  SACCADE_TRY(const RayScene rays, RayScene::build(std::move(found)));
  SACCADE_TRY(const ObjectShapes shapes, ObjectShapes::build(rays));
  SACCADE_TRY(const UrdfArm robot, find_robot("comau_smart_six"));
  SACCADE_TRY(std::vector<Pose> T_world_camera, scan_motion(rays.scene(), robot.arm, config.pace));
  if (config.frames > 0) T_world_camera.resize(std::min(config.frames, T_world_camera.size()));
  SimulatedRunConfig run;
  run.seed = config.seed;
  SACCADE_TRY(SimulatedCamera camera, simulated_camera(rays, run));
  SACCADE_TRY(std::vector<Tracker> trackers, make_trackers(run.map()));

  const Pose T_camera_reported = calibration_error(config);
  const std::string stage = "scanning " + scene;
  for (std::size_t i = 0; i < T_world_camera.size(); ++i) {
    progress.report(stage, i, T_world_camera.size());
    if (progress.cancelled()) return Error{Errc::cancelled, "cancelled", stage};
    const Frame frame = camera.capture(T_world_camera[i], executor);
    const Pose T_first_camera = T_world_camera.front().inverse() * T_world_camera[i];
    for (Tracker& tracker : trackers) {
      SACCADE_CHECK(
          add_frame(tracker, frame, camera.camera(), T_world_camera[i] * T_camera_reported, T_first_camera, executor));
    }
  }
  std::vector<ScanTracking> trackings;
  for (Tracker& tracker : trackers) {
    measure_objects(shapes, executor, tracker);
    trackings.push_back(std::move(tracker.tracking));
  }
  return trackings;
}

}  // namespace saccade::thesis
