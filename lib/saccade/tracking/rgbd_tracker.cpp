// SPDX-License-Identifier: Apache-2.0
#include "saccade/tracking/rgbd_tracker.hpp"

#include <algorithm>
#include <cmath>

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

/// Returns how well a frame fits: the shares of its depths and of its grey values that agree.
double fit(const FrameReport& report) {
  return 0.5 * (report.icp.agreement + (report.used_color ? report.color_agreement : report.icp.agreement));
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
  if (!(doubtful_deviations >= 0.0 && least_doubt >= 0.0 && most_doubt >= least_doubt)) {
    return Error{Errc::invalid_argument, "the bounds of a doubtful fit must be positive and in order",
                 "RGB-D tracking"};
  }
  if (std::isnan(relocalisation_agreement)) {
    return Error{Errc::invalid_argument, "the agreement of a frame that is found again must be a number",
                 "RGB-D tracking"};
  }
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

Result<GreyPoints> RgbdTracker::model_at(const SurfaceAt& surface_at, const GreyPoints& measured,
                                         const PinholeCamera& camera, const Pose& T_world_camera,
                                         const Executor& executor) const {
  GreyPoints model;
  SACCADE_TRY(model.points, surface_at(T_world_camera));
  const Keyframe* keyframe = measured.grey.empty() ? nullptr : keyframes_.nearest_with_color(T_world_camera);
  if (keyframe != nullptr) model.grey = grey_of_surface(*keyframe, model.points, camera, T_world_camera, executor);
  return model;
}

FrameReport RgbdTracker::align_to(const GreyPoints& model, const GreyPoints& measured, const PinholeCamera& camera,
                                  const Pose& T_world_start, const RgbdConfig& how, const Executor& executor) {
  const RgbdResult found = align_rgbd(measured, model, camera, Pose::Identity(), executor, how);
  FrameReport report;
  report.T_world_camera = T_world_start;
  report.icp = found.icp;
  report.used_color = found.used_color;
  report.color_agreement = found.color_agreement;
  report.confidence = tracking_confidence(found.icp, how.icp);
  if (found.icp.converged) {
    report.T_world_camera = with_rotation(T_world_start * found.icp.T_model_camera);
  } else {
    report.status = FrameReport::Status::lost;
    report.why = found.icp.why;
  }
  return report;
}

bool RgbdTracker::is_usual(double fit) const {
  const double doubt =
      std::clamp(config_.doubtful_deviations * usual_deviation_, config_.least_doubt, config_.most_doubt);
  return usual_fit_ && fit >= *usual_fit_ - doubt;
}

Result<FrameReport> RgbdTracker::track_from(const SurfaceAt& surface_at, const Frame& frame,
                                            const PinholeCamera& camera, const Pose& T_world_start,
                                            const Executor& executor) {
  SACCADE_TRY(const GreyPoints measured, measured_points(frame, camera, executor));
  Stopwatch stopwatch;
  SACCADE_TRY(const GreyPoints model, model_at(surface_at, measured, camera, T_world_start, executor));
  const double raycast_ms = stopwatch.lap_ms();
  FrameReport report = align_to(model, measured, camera, T_world_start, config_.alignment, executor);
  report.raycast_ms = raycast_ms;
  report.track_ms = stopwatch.lap_ms();
  return report;
}

Result<FrameReport> RgbdTracker::track(const SurfaceAt& surface_at, const Frame& frame, const PinholeCamera& camera,
                                       const Executor& executor) {
  Stopwatch stopwatch;
  SACCADE_TRY(const GreyPoints measured, measured_points(frame, camera, executor));
  double track_ms = stopwatch.lap_ms();
  double raycast_ms{0.0};
  std::optional<FrameReport> first;
  std::optional<FrameReport> found;
  const auto sure = [&] { return found && is_usual(fit(*found)); };
  const auto model_from = [&](const Pose& start) -> Result<GreyPoints> {
    stopwatch.lap_ms();
    SACCADE_TRY(GreyPoints model, model_at(surface_at, measured, camera, start, executor));
    raycast_ms += stopwatch.lap_ms();
    return model;
  };
  const auto try_from = [&](const GreyPoints& model, const Pose& start, const RgbdConfig& how) {
    FrameReport report = align_to(model, measured, camera, start, how, executor);
    track_ms += stopwatch.lap_ms();
    if (!first) first = report;
    return report;
  };
  const auto keep_better = [&](FrameReport report) {
    if (report.status == FrameReport::Status::lost) return;
    if (!found || fit(report) > fit(*found)) found = std::move(report);
  };
  RgbdConfig near = config_.alignment;
  near.looks_far = false;
  // A pose that fits worse than those before it may be a false one. Pairs that are not far apart, the surface as seen
  // from that pose, or another start tell.
  for (const Pose& start : starts()) {
    SACCADE_TRY(const GreyPoints model, model_from(start));
    keep_better(try_from(model, start, config_.alignment));
    if (sure()) break;
    keep_better(try_from(model, start, near));
    if (sure()) break;
    if (!found) continue;
    const Pose there = found->T_world_camera;
    SACCADE_TRY(const GreyPoints model_there, model_from(there));
    keep_better(try_from(model_there, there, config_.alignment));
    if (sure()) break;
  }
  if (!found) {
    const Thumbnail small = thumbnail(measured.grey, measured.points.z);
    for (const Pose& start : keyframes_.most_alike(small, config_.relocalisation_tries)) {
      SACCADE_TRY(const GreyPoints model, model_from(start));
      FrameReport report = try_from(model, start, config_.alignment);
      const bool certain = report.icp.agreement >= config_.relocalisation_agreement;
      if (report.status == FrameReport::Status::lost || !certain) continue;
      report.relocalised = true;
      found = std::move(report);
      break;
    }
  }
  if (found) {
    const double change = fit(*found) - usual_fit_.value_or(fit(*found));
    usual_deviation_ = std::abs(change) + kMemory * (usual_deviation_ - std::abs(change));
    usual_fit_ = fit(*found) - kMemory * change;
  }
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
