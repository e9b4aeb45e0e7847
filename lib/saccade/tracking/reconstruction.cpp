// SPDX-License-Identifier: Apache-2.0
#include "saccade/tracking/reconstruction.hpp"

#include <utility>

#include "saccade/core/clock.hpp"
#include "saccade/map/raycast.hpp"

namespace saccade {
namespace {

Result<SurfaceView> cast(const TsdfSnapshot& map, const PinholeCamera& camera, const Pose& T_world_camera,
                         const Executor& executor, TrackingDevice* device) {
  if (device != nullptr) {
    Result<SurfaceView> view = device->raycast(map, camera, T_world_camera, executor);
    if (view.ok()) return view;
  }
  return raycast(map, camera, T_world_camera, executor);
}

IcpResult aligned(const PointImage& measured, const PointImage& model, const PinholeCamera& camera,
                  const Executor& executor, const IcpConfig& icp, TrackingDevice* device) {
  if (device != nullptr) {
    Result<IcpResult> result = device->align(measured, model, camera, Pose::Identity(), icp);
    if (result.ok()) return *std::move(result);
  }
  return align(measured, model, camera, Pose::Identity(), executor, icp);
}

}  // namespace

Result<FrameReport> track_frame(const TsdfSnapshot& map, const Frame& frame, const PinholeCamera& camera,
                                const Pose& T_world_start, const Executor& executor, const IcpConfig& icp,
                                TrackingDevice* device) {
  if (frame.depth.width() != camera.width || frame.depth.height() != camera.height) {
    return Error{Errc::size_mismatch, "the depth image and the camera differ in size", frame.name};
  }
  FrameReport report;
  report.T_world_camera = T_world_start;
  Stopwatch stopwatch;
  SACCADE_TRY(const SurfaceView view, cast(map, camera, T_world_start, executor, device));
  report.raycast_ms = stopwatch.lap_ms();
  const PointImage model = to_points(view, executor);
  const PointImage measured = to_points(frame.depth, camera, executor);
  report.icp = aligned(measured, model, camera, executor, icp, device);
  report.track_ms = stopwatch.lap_ms();
  report.confidence = tracking_confidence(report.icp, icp);
  if (report.icp.converged) {
    report.T_world_camera = T_world_start * report.icp.T_model_camera;
  } else {
    report.status = FrameReport::Status::lost;
    report.why = report.icp.why;
  }
  return report;
}

Result<Reconstruction> Reconstruction::create(const ReconstructionConfig& config) {
  SACCADE_CHECK(config.icp.validate());
  SACCADE_CHECK(config.rgbd.validate());
  SACCADE_TRY(TsdfMap map, TsdfMap::create(config.map));
  return Reconstruction{std::move(map), config.icp, config.rgbd};
}

Result<Reconstruction> Reconstruction::resume(TsdfSnapshot content, const IcpConfig& icp,
                                              const RgbdTrackerConfig& rgbd) {
  SACCADE_CHECK(icp.validate());
  SACCADE_CHECK(rgbd.validate());
  SACCADE_CHECK(content.config.validate());
  return Reconstruction{TsdfMap{std::move(content)}, icp, rgbd};
}

void Reconstruction::resume(const Pose& T_world_camera_hint) {
  suspended_ = false;
  T_world_resume_ = T_world_camera_hint;
  tracker_.moved_to(T_world_camera_hint);
}

SurfaceAt Reconstruction::seen_surface(const PinholeCamera& camera, const Executor& executor) {
  return [this, &camera, &executor](const Pose& T_world_camera) -> Result<PointImage> {
    SACCADE_CHECK(map_.look_from(camera, T_world_camera, executor));
    SACCADE_TRY(const SurfaceView view, cast(map_.content(), camera, T_world_camera, executor, device_));
    return to_points(view, executor);
  };
}

TsdfMap Reconstruction::exchange_map(TsdfMap map, const Pose& T_world_camera_last) {
  TsdfMap until_now = std::exchange(map_, std::move(map));
  T_world_last_ = T_world_camera_last;
  T_world_resume_.reset();
  tracker_ = RgbdTracker{tracker_.config()};  // its keyframes lie in the world of the earlier poses
  tracker_.moved_to(T_world_camera_last);
  return until_now;
}

Result<FrameReport> Reconstruction::process(const Frame& frame, const PinholeCamera& camera, TrackingMode mode,
                                            const std::optional<Pose>& hint, const Executor& executor) {
  FrameReport report;
  report.T_world_camera = T_world_last_.value_or(Pose::Identity());
  if (suspended_) {
    report.status = FrameReport::Status::suspended;
    return report;
  }
  if (needs_pose(mode) && !hint) {
    return Error{Errc::invalid_argument, "this tracking mode needs a pose for every frame", frame.name};
  }
  const bool map_is_empty = map_.content().grid.empty();
  if (mode == TrackingMode::forced) {
    report.T_world_camera = *hint;
  } else if (map_is_empty) {
    report.T_world_camera = hint.value_or(Pose::Identity());  // nothing to align to: the first frame defines the world
  } else {
    const Pose resumed_or_last = T_world_resume_.value_or(T_world_last_.value_or(Pose::Identity()));
    const Pose& start = mode == TrackingMode::hint ? *hint : resumed_or_last;
    const Pose kept = report.T_world_camera;
    if (mode == TrackingMode::rgbd) {
      SACCADE_TRY(report, tracker_.track(seen_surface(camera, executor), frame, camera, executor));
    } else {
      SACCADE_CHECK(map_.look_from(camera, start, executor));
      SACCADE_TRY(report, track_frame(map_.content(), frame, camera, start, executor, icp_, device_));
    }
    if (report.status == FrameReport::Status::lost) {
      report.T_world_camera = kept;
      return report;
    }
  }
  const ColorImage* color = frame.color ? &*frame.color : nullptr;
  SACCADE_TRY(report.fusion, map_.integrate(camera, frame.depth, report.T_world_camera, executor, color));
  report.integrate_ms = report.fusion.ms;
  if (mode == TrackingMode::rgbd) tracker_.fused(frame, camera, report.T_world_camera, executor);
  T_world_last_ = report.T_world_camera;
  T_world_resume_.reset();
  return report;
}

}  // namespace saccade
