// SPDX-License-Identifier: Apache-2.0
#include "saccade/tracking/rgbd_tracker.hpp"

#include "saccade/core/clock.hpp"
#include "saccade/map/raycast.hpp"
#include "saccade/tracking/internal/intensity.hpp"

namespace saccade {
namespace {

/// Frames for which the camera is taken to move on as before, while it is lost.
constexpr std::size_t kFramesOfMotion{3};
constexpr double kMemory{0.9};  ///< share of the usual agreement that a frame leaves

Result<GreyPoints> measured_points(const Frame& frame, const PinholeCamera& camera, const Executor& executor) {
  if (frame.depth.width() != camera.width || frame.depth.height() != camera.height) {
    return Error{Errc::size_mismatch, "the depth image and the camera differ in size", frame.name};
  }
  if (frame.color && (frame.color->width() != camera.width || frame.color->height() != camera.height)) {
    return Error{Errc::size_mismatch, "the colour image and the camera differ in size", frame.name};
  }
  return GreyPoints{to_points(frame.depth, camera, executor),
                    frame.color ? to_grey(*frame.color, executor) : Image<float>{}};
}

/// Makes a product of many poses a rotation again: a predicted motion would double what is missing with each frame.
Pose with_rotation(const Pose& T) {
  Pose rigid = T;
  rigid.linear() = Eigen::Quaterniond{T.linear()}.normalized().toRotationMatrix();
  return rigid;
}

}  // namespace

SurfaceAt surface_of_map(const TsdfSnapshot& map, const PinholeCamera& camera, const Executor& executor) {
  return [&map, camera, &executor](const Pose& T_world_camera) -> Result<PointImage> {
    SACCADE_TRY(const SurfaceView view, raycast(map, camera, T_world_camera, executor));
    return to_points(view, executor);
  };
}

Status RgbdTrackerConfig::validate() const {
  SACCADE_CHECK(alignment.validate());
  return keyframes.validate();
}

std::vector<Pose> RgbdTracker::starts() const {
  const Pose last = T_world_last_.value_or(Pose::Identity());
  std::vector<Pose> poses;
  if (T_before_last_ && lost_ < kFramesOfMotion) {
    Pose moved = last;
    for (std::size_t i = 0; i <= lost_; ++i) moved = moved * *T_before_last_;
    poses.push_back(with_rotation(moved));
  }
  poses.push_back(last);
  return poses;
}

Result<FrameReport> RgbdTracker::align_from(const SurfaceAt& surface_at, const GreyPoints& measured,
                                            const PinholeCamera& camera, const Pose& T_world_start,
                                            const Executor& executor) const {
  FrameReport report;
  report.T_world_camera = T_world_start;
  Stopwatch stopwatch;
  GreyPoints model;
  SACCADE_TRY(model.points, surface_at(T_world_start));
  report.raycast_ms = stopwatch.lap_ms();
  const Keyframe* keyframe = measured.grey.empty() ? nullptr : keyframes_.nearest_with_color(T_world_start);
  if (keyframe != nullptr) model.grey = grey_of_surface(*keyframe, model.points, camera, T_world_start, executor);
  const RgbdResult found = align_rgbd(measured, model, camera, Pose::Identity(), executor, config_.alignment);
  report.track_ms = stopwatch.lap_ms();
  report.icp = found.icp;
  report.used_color = found.used_color;
  report.color_agreement = found.color_agreement;
  report.confidence = tracking_confidence(found.icp, config_.alignment.icp);
  if (found.icp.converged) {
    report.T_world_camera = with_rotation(T_world_start * found.icp.T_model_camera);
  } else {
    report.status = FrameReport::Status::lost;
    report.why = found.icp.why;
  }
  return report;
}

Result<FrameReport> RgbdTracker::track_from(const SurfaceAt& surface_at, const Frame& frame,
                                            const PinholeCamera& camera, const Pose& T_world_start,
                                            const Executor& executor) {
  SACCADE_TRY(const GreyPoints measured, measured_points(frame, camera, executor));
  return align_from(surface_at, measured, camera, T_world_start, executor);
}

Result<FrameReport> RgbdTracker::track(const SurfaceAt& surface_at, const Frame& frame, const PinholeCamera& camera,
                                       const Executor& executor) {
  const Stopwatch stopwatch;
  SACCADE_TRY(const GreyPoints measured, measured_points(frame, camera, executor));
  const double measured_ms = stopwatch.elapsed_ms();
  std::optional<FrameReport> first;
  double raycast_ms{0.0};
  double track_ms{measured_ms};
  const auto try_from = [&](const Pose& start) -> Result<FrameReport> {
    SACCADE_TRY(FrameReport report, align_from(surface_at, measured, camera, start, executor));
    raycast_ms += report.raycast_ms;
    track_ms += report.track_ms;
    if (!first) first = report;
    return report;
  };
  std::optional<FrameReport> found;
  const auto keep_better = [&](FrameReport report) {
    if (report.status == FrameReport::Status::lost) return;
    if (!found || report.icp.agreement > found->icp.agreement) found = std::move(report);
  };
  // A pose that fits worse than those before it may be a false one: the surface as seen from there, or another start,
  // tells.
  const auto sure = [&] {
    return found && usual_agreement_ && found->icp.agreement >= *usual_agreement_ - config_.doubtful_agreement;
  };
  for (const Pose& start : starts()) {
    SACCADE_TRY(FrameReport report, try_from(start));
    keep_better(std::move(report));
    if (sure()) break;
    if (!found) continue;
    SACCADE_TRY(FrameReport again, try_from(found->T_world_camera));
    keep_better(std::move(again));
    if (sure()) break;
  }
  if (!found) {
    const Thumbnail small = thumbnail(measured.grey, measured.points.z);
    for (const Pose& start : keyframes_.most_alike(small, config_.relocalisation_tries)) {
      SACCADE_TRY(FrameReport report, try_from(start));
      const bool certain = report.icp.agreement >= config_.relocalisation_agreement;
      if (report.status == FrameReport::Status::lost || !certain) continue;
      report.relocalised = true;
      found = std::move(report);
      break;
    }
  }
  if (found)
    usual_agreement_ =
        found->icp.agreement + kMemory * (usual_agreement_.value_or(found->icp.agreement) - found->icp.agreement);
  FrameReport report = found ? std::move(*found) : std::move(*first);
  report.raycast_ms = raycast_ms;
  report.track_ms = track_ms;
  if (report.status == FrameReport::Status::lost || report.relocalised) ++lost_;  // no motion leads there
  return report;
}

void RgbdTracker::fused(const Frame& frame, const PinholeCamera& camera, const Pose& T_world_camera,
                        const Executor& executor) {
  T_before_last_.reset();
  if (T_world_last_ && lost_ == 0) T_before_last_ = T_world_last_->inverse() * T_world_camera;
  T_world_last_ = T_world_camera;
  lost_ = 0;
  const bool has_color = frame.color && frame.color->width() == camera.width && frame.color->height() == camera.height;
  if (!keyframes_.wants(T_world_camera, has_color)) return;
  Image<float> z{camera.width, camera.height};
  const auto nearest_m = static_cast<float>(camera.min_range_m);
  const auto farthest_m = static_cast<float>(camera.max_range_m);
  for (std::size_t i = 0; i < z.size(); ++i) {
    const float depth = frame.depth.data()[i];
    if (depth > 0.0F && depth >= nearest_m && depth <= farthest_m) z.data()[i] = depth;
  }
  keyframes_.add(has_color ? to_grey(*frame.color, executor) : Image<float>{}, z, camera, T_world_camera);
}

void RgbdTracker::moved_to(const Pose& T_world_camera) {
  T_world_last_ = T_world_camera;
  T_before_last_.reset();
  lost_ = 0;
}

}  // namespace saccade
