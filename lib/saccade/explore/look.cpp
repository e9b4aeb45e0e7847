// SPDX-License-Identifier: Apache-2.0
// Explorer at a view and during the motion to it: moves, tilts the camera, takes frames and fuses them.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "saccade/explore/explorer.hpp"
#include "saccade/explore/internal/timed_frame.hpp"

namespace saccade {
namespace {

/// Returns the view tilted about the camera's x axis.
Pose tilted(const Pose& T_world_view, double tilt_rad) {
  return T_world_view * Eigen::AngleAxisd{tilt_rad, Eigen::Vector3d::UnitX()};
}

/// Returns the tilt at the ends of an oscillation; 0 where a view has only one frame, which is taken at the view
/// itself.
double oscillation_rad(const ExplorerConfig& config) {
  return config.oscillation_frames > 1 ? config.oscillation_rad : 0.0;
}

/// Returns the tilts to try for one end of an oscillation, largest first, by repeated halving.
std::vector<double> tilts_towards(double farthest_rad) {
  constexpr int kHalvings{3};
  std::vector<double> tilts_rad;
  for (int i = 0; farthest_rad != 0.0 && i <= kHalvings; ++i) tilts_rad.push_back(std::ldexp(farthest_rad, -i));
  return tilts_rad;
}

}  // namespace

void TrackedFrames::add(const Pose& T_robot_tracked) {
  ++tracked;
  const double share = 1.0 / static_cast<double>(tracked);
  correction_m += share * (T_robot_tracked.translation().norm() - correction_m);
  correction_rad += share * (Eigen::AngleAxisd{T_robot_tracked.linear()}.angle() - correction_rad);
}

void TrackedFrames::refuse(std::string reason) {
  ++refused;
  why = std::move(reason);
}

Result<double> Explorer::farthest_tilt_rad(const Pose& T_world_view, double wanted_rad) {
  for (const double tilt_rad : tilts_towards(wanted_rad)) {
    const Pose pose = tilted(T_world_view, tilt_rad);
    SACCADE_TRY(const PlannedMotion planned, parts_.robot.plan(std::span{&pose, 1}, MotionKind::direct));
    if (planned.motion) return tilt_rad;
  }
  return 0.0;
}

Result<std::optional<Pose>> Explorer::track(const Frame& frame, const Pose& T_world_robot, TrackedFrames& tracking) {
  if (config_.tracking == TrackingMode::forced || parts_.map.content().grid.empty())
    return std::optional{T_world_robot};
  const bool carries = !needs_pose(config_.tracking);
  const Pose start = carries ? T_world_robot * T_robot_tracked_ : T_world_robot;
  FrameReport report;
  const PinholeCamera& camera = parts_.camera.intrinsics();
  if (config_.tracking == TrackingMode::rgbd) {
    const SurfaceAt surface = surface_of_map(parts_.map.content(), camera, parts_.executor);
    SACCADE_TRY(report, rgbd_.track_from(surface, frame, camera, start, parts_.executor));
  } else {
    SACCADE_TRY(report, track_frame(parts_.map.content(), frame, camera, start, parts_.executor, config_.icp));
  }
  if (report.status == FrameReport::Status::lost) {
    tracking.refuse(report.why);
    return carries ? std::optional<Pose>{} : std::optional{T_world_robot};
  }
  T_robot_tracked_ = T_world_robot.inverse() * report.T_world_camera;
  tracking.add(T_robot_tracked_);
  return std::optional{report.T_world_camera};
}

Result<bool> Explorer::fuse(Frame frame, const Pose& T_world_robot, bool keep, TrackedFrames& tracking) {
  const ColorImage* color = frame.color ? &*frame.color : nullptr;
  SACCADE_TRY(frame.T_world_camera, track(frame, T_world_robot, tracking));
  if (!frame.T_world_camera) return false;
  SACCADE_TRY(
      [[maybe_unused]] const FusionStats stats,
      parts_.map.integrate(parts_.camera.intrinsics(), frame.depth, *frame.T_world_camera, parts_.executor, color));
  if (parts_.model != nullptr) {
    SACCADE_CHECK(parts_.model->fuse(frame, parts_.camera.intrinsics(), parts_.executor));
  }
  if (config_.tracking == TrackingMode::rgbd) {
    rgbd_.fused(frame, parts_.camera.intrinsics(), *frame.T_world_camera, parts_.executor);
  }
  if (keep) frames_.push_back(std::move(frame));
  return true;
}

Result<bool> Explorer::fuse_on_way(Frame frame, const MotionSample& at, const Motion& motion, ViewRecord& view) {
  SACCADE_TRY(const bool fused, fuse(std::move(frame), at.T_world_camera, false, view.tracking));
  if (!fused) return false;
  ++view.frames_on_way;
  SACCADE_CHECK(parts_.robot.follow(parts_.map.content(), parts_.executor));
  return !parts_.robot.still_free(motion, at.t_s);
}

Result<std::optional<Arrival>> Explorer::move(const Motion& motion, ViewRecord& view) {
  double next_s = config_.frame_on_way_s;
  TimedFrame waiting{config_.camera_clock_offset_s};  // holds a frame with a time until the robot's pose then is known
  const auto take = [&](const MotionSample& sample) -> Result<bool> {
    if (const auto at = waiting.reached(sample)) return fuse_on_way(waiting.take(), *at, motion, view);
    if (config_.frame_on_way_s <= 0.0 || sample.t_s < next_s || waiting.holds() || suspended()) return false;
    next_s = std::max(next_s + config_.frame_on_way_s, sample.t_s);
    SACCADE_TRY(Frame frame, parts_.camera.capture(sample.T_world_camera));
    MotionSample at = sample;
    at.T_world_camera = frame.T_world_camera.value_or(sample.T_world_camera);
    if (waiting.hold(frame, sample)) return false;
    return fuse_on_way(std::move(frame), at, motion, view);
  };
  Result<bool> blocked{false};
  const MotionObserver on_way = [&](const MotionSample& sample) {
    view.path.emplace_back(sample.T_world_camera.translation());
    if (cancelled()) return Advance::stop;
    blocked = view.times.measure(Phase::fusion, [&] { return take(sample); });
    return blocked.ok() && !*blocked ? Advance::go_on : Advance::stop;
  };
  auto arrival = view.times.measure(Phase::motion, [&] { return parts_.robot.execute(motion, on_way); });
  view.path_m = length_m(view.path);
  if (!blocked.ok()) return blocked.error();
  return arrival;
}

Status Explorer::look(ViewRecord& view) {
  frames_.clear();
  return view.times.measure(Phase::fusion, [&]() -> Status {
    const double wanted_rad = oscillation_rad(config_);
    SACCADE_TRY(view.tilt.least_rad, farthest_tilt_rad(view.T_world_camera, -wanted_rad));
    SACCADE_TRY(view.tilt.greatest_rad, farthest_tilt_rad(view.T_world_camera, wanted_rad));
    const double middle_rad = 0.5 * (view.tilt.least_rad + view.tilt.greatest_rad);
    const double half_rad = 0.5 * (view.tilt.greatest_rad - view.tilt.least_rad);
    double motion_s = 0.0;
    for (int i = 0; i < config_.oscillation_frames; ++i) {
      const double share = config_.oscillation_frames > 1 ? 2.0 * i / (config_.oscillation_frames - 1) - 1.0 : 0.0;
      const Pose wanted = tilted(view.T_world_camera, middle_rad + share * half_rad);
      SACCADE_TRY(const PlannedMotion planned, parts_.robot.plan(std::span{&wanted, 1}, MotionKind::direct));
      if (!planned.motion) continue;
      SACCADE_TRY(const std::optional<Arrival> arrival, parts_.robot.execute(*planned.motion));
      if (!arrival) continue;
      if (arrival->stopped) break;  // the caller cancelled
      motion_s += arrival->motion_s;
      if (suspended()) continue;
      SACCADE_TRY(Frame frame, parts_.camera.capture(arrival->T_world_camera));
      const Pose at = frame.T_world_camera.value_or(arrival->T_world_camera);
      SACCADE_TRY(const bool fused, fuse(std::move(frame), at, true, view.tracking));
      if (fused) ++view.frames;
    }
    view.motion_s += motion_s;
    return {};
  });
}

void Explorer::check_promise(ViewRecord& view) const {
  if (!(view.gain_predicted > 0.0 && promise_.worth() > 0.0)) return;
  view.gain_observed = view.gain_predicted * promise_.kept_share(parts_.map.content().grid);
}

Result<ScanRecord> Explorer::scan(std::span<const Pose> T_world_camera, ScanRecord scan) {
  SACCADE_CHECK(config_.validate());
  const std::size_t first = std::min(scan.attempted, T_world_camera.size());
  std::vector<Pose> way;
  for (const Pose& pose : T_world_camera.subspan(first)) {
    way.push_back(pose);
    for (const double end_rad : {-oscillation_rad(config_), oscillation_rad(config_)}) {
      for (const double tilt_rad : tilts_towards(end_rad)) way.push_back(tilted(pose, tilt_rad));
    }
  }
  SACCADE_CHECK(parts_.robot.follow(parts_.map.content(), parts_.executor));
  SACCADE_TRY(const std::vector<Box> swept, parts_.robot.swept_volume(way));
  for (const Box& box : swept) SACCADE_CHECK(parts_.map.free(box));
  scan.complete = true;
  for (std::size_t i = first; i < T_world_camera.size(); ++i) {
    if (parts_.progress != nullptr) parts_.progress->report("initial scan", i, T_world_camera.size());
    SACCADE_TRY(const Outcome outcome, scan_from(T_world_camera[i], scan));
    if (outcome == Outcome::cancelled) {
      scan.complete = false;
      return scan;
    }
    scan.attempted = i + 1;
    if (parts_.recorder != nullptr) SACCADE_CHECK(parts_.recorder->scanning(scan, parts_.map.content()));
  }
  if (parts_.recorder != nullptr) SACCADE_CHECK(parts_.recorder->scanned(scan, parts_.map.content()));
  return scan;
}

Result<Explorer::Outcome> Explorer::scan_from(const Pose& T_world_camera, ScanRecord& scan) {
  if (cancelled()) return Outcome::cancelled;
  SACCADE_CHECK(parts_.robot.follow(parts_.map.content(), parts_.executor));
  SACCADE_TRY(const PlannedMotion planned, parts_.robot.plan(std::span{&T_world_camera, 1}));
  if (!planned.motion) {
    scan.refused.add(planned.refusal.value_or(Refusal::declined));
    return Outcome::nowhere_to_go;
  }
  const Approval approval = parts_.approve ? parts_.approve({T_world_camera}) : Approval::go;
  if (approval == Approval::stop) return Outcome::cancelled;
  if (approval == Approval::skip) return Outcome::nowhere_to_go;
  SACCADE_TRY(const std::optional<Arrival> arrival, parts_.robot.execute(*planned.motion));
  if (arrival && arrival->stopped) return Outcome::cancelled;
  if (!arrival) {
    scan.refused.add(Refusal::declined);
    return Outcome::nowhere_to_go;
  }
  ViewRecord view;
  view.T_world_camera = T_world_camera;
  SACCADE_CHECK(look(view));
  scan.frames += view.frames;
  ++scan.views;
  return Outcome::arrived;
}

}  // namespace saccade
