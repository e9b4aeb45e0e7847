// SPDX-License-Identifier: Apache-2.0
#include "saccade/tracking/hand_eye.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "saccade/tracking/internal/clock_match.hpp"
#include "saccade/tracking/internal/mount_equation.hpp"
#include "saccade/tracking/internal/mount_refinement.hpp"
#include "saccade/tracking/reconstruction.hpp"

namespace saccade {
namespace {

constexpr std::size_t kMinViews{3};
constexpr double kMinAgreeing{0.4};  // share of the points that both views measured

std::string in_words(const Eigen::Vector3d& axis) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "(%.2f %.2f %.2f)", axis.x(), axis.y(), axis.z());
  return text.data();
}

std::string rounded(double value, const char* unit) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.1f %s", value, unit);
  return text.data();
}

bool is_rigid(const Pose& T) { return T.matrix().allFinite() && pose_from_matrix(T.matrix()).ok(); }

Status check_views(const HandEyeInput& input) {
  SACCADE_CHECK(input.camera.validate());
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "calibration of the mount"}; };
  if (input.still.size() + input.moving.size() < kMinViews) return fail("at least three views are needed");
  const auto fits = [&](const DepthImage& depth) {
    return depth.width() == input.camera.width && depth.height() == input.camera.height;
  };
  for (const StillView& view : input.still) {
    if (!fits(view.depth)) return Error{Errc::size_mismatch, "a depth image and the camera differ in size", {}};
    if (!is_rigid(view.T_base_flange)) return fail("a flange pose is not a rigid transform");
  }
  for (const MovingView& view : input.moving) {
    if (!fits(view.depth)) return Error{Errc::size_mismatch, "a depth image and the camera differ in size", {}};
    if (view.time_s && !std::isfinite(*view.time_s)) return fail("a frame's time is not finite");
  }
  for (std::size_t i = 0; i < input.flange.size(); ++i) {
    if (!is_rigid(input.flange[i].T_base_flange)) return fail("a flange pose is not a rigid transform");
    if (!std::isfinite(input.flange[i].time_s)) return fail("a flange pose's time is not finite");
    if (i > 0 && !(input.flange[i].time_s > input.flange[i - 1].time_s)) return fail("the flange's times do not rise");
  }
  if (input.T_flange_camera_guess && !is_rigid(*input.T_flange_camera_guess))
    return fail("the guess is not a rigid transform");
  return {};
}

/// Frames that could be tracked, by index, and their camera poses.
struct Track {
  std::vector<std::size_t> frames;
  std::vector<Pose> T_world_camera;
};

/// One calibration in progress, which fills the result.
class HandEyeCalibration {
 public:
  HandEyeCalibration(const HandEyeInput& input, const Executor& executor, const HandEyeConfig& config,
                     const Progress* progress)
      : input_{input}, executor_{executor}, config_{config}, progress_{progress}, record_{input.flange} {
    for (const StillView& view : input_.still) {
      views_.push_back({to_points(view.depth, input_.camera, executor_), view.T_base_flange});
    }
  }

  Result<HandEyeResult> run() {
    SACCADE_CHECK(track_still());
    SACCADE_CHECK(track_moving());
    const std::optional<Pose> tracked = solve_mount(motions_);
    result_.T_flange_camera_tracked = tracked;
    add_moving_views();
    if (!check_motions() || !check_structure() || !choose_start(tracked)) return std::move(result_);
    SACCADE_CHECK(report("refining the mount", 0));
    const MountEstimate estimate = refine_mount(views_, input_.camera, record_, start_, config_, executor_);
    judge(estimate);
    return std::move(result_);
  }

 private:
  [[nodiscard]] Status report(const char* stage, std::size_t done, std::size_t total = 0) const {
    if (progress_ == nullptr) return {};
    progress_->report(stage, done, total);
    if (progress_->cancelled()) return Error{Errc::cancelled, "the calibration was cancelled", {}};
    return {};
  }

  /// Tracks frames against the map of those before. moved(last, k): approximate camera motion from frame to frame.
  template <class DepthOf, class Moved>
  Result<Track> track(const char* stage, std::size_t count, DepthOf&& depth_of, Moved&& moved) const {
    ReconstructionConfig config;
    config.map.voxel_size_m = config_.tracking_voxel_m;
    SACCADE_TRY(Reconstruction reconstruction, Reconstruction::create(config));
    Track track;
    for (std::size_t k = 0; k < count; ++k) {
      SACCADE_CHECK(report(stage, k, count));
      Frame frame;
      frame.depth = depth_of(k);
      const Pose last = track.frames.empty() ? Pose{Pose::Identity()} : track.T_world_camera.back();
      const Pose hint = track.frames.empty() ? last : last * moved(track.frames.back(), k);
      SACCADE_TRY(FrameReport done, reconstruction.process(frame, input_.camera, TrackingMode::hint, hint, executor_));
      if (done.status != FrameReport::Status::fused && hint.matrix() != last.matrix()) {
        SACCADE_TRY(done, reconstruction.process(frame, input_.camera, TrackingMode::hint, last, executor_));
      }
      if (done.status != FrameReport::Status::fused) continue;
      track.frames.push_back(k);
      track.T_world_camera.push_back(done.T_world_camera);
    }
    return track;
  }

  Status track_still() {
    const auto moved = [&](std::size_t last, std::size_t k) {
      if (!input_.T_flange_camera_guess) return Pose{Pose::Identity()};
      const Pose& X = *input_.T_flange_camera_guess;
      return Pose{X.inverse() * input_.still[last].T_base_flange.inverse() * input_.still[k].T_base_flange * X};
    };
    SACCADE_TRY(const Track found, track(
                                       "tracking still views", input_.still.size(),
                                       [&](std::size_t k) { return input_.still[k].depth; }, moved));
    std::vector<Pose> T_base_flange;
    for (const std::size_t k : found.frames) T_base_flange.push_back(input_.still[k].T_base_flange);
    add_motions(T_base_flange, found.T_world_camera, motions_);
    result_.still_tracked = found.frames.size();
    return {};
  }

  /// Tracks the moving views and finds the clock offset.
  Status track_moving() {
    if (input_.moving.empty() || input_.flange.size() < 2) {
      result_.why_no_clock = "there are no frames taken in motion, or no record of the flange's motion";
      return {};
    }
    if (!std::all_of(input_.moving.begin(), input_.moving.end(), [](const auto& view) { return view.time_s; })) {
      result_.why_no_clock = "frames taken in motion carry no time";
      return {};
    }
    // The clocks are not known to agree yet, but a motion that is slightly early or late is a better start than none.
    const auto moved = [&](std::size_t last, std::size_t k) {
      const double from_s = *input_.moving[last].time_s;
      const double to_s = *input_.moving[k].time_s;
      if (!input_.T_flange_camera_guess || !record_.covers(from_s) || !record_.covers(to_s)) {
        return Pose{Pose::Identity()};
      }
      const Pose& X = *input_.T_flange_camera_guess;
      return Pose{X.inverse() * record_.at(from_s).inverse() * record_.at(to_s) * X};
    };
    SACCADE_TRY(const Track found, track(
                                       "tracking the motion", input_.moving.size(),
                                       [&](std::size_t k) { return input_.moving[k].depth; }, moved));
    result_.moving_tracked = found.frames.size();
    std::vector<TimedPose> timed;
    for (std::size_t i = 0; i < found.frames.size(); ++i) {
      timed.push_back({*input_.moving[found.frames[i]].time_s, found.T_world_camera[i]});
    }
    const ClockMatch match = match_clocks(record_, timed, config_.max_clock_offset_s);
    result_.clock_offset_s = match.offset_s;
    result_.why_no_clock = match.why;
    if (!match.offset_s) return {};
    start_.clock_offset_s = *match.offset_s;
    std::vector<Pose> T_base_flange;
    std::vector<Pose> T_world_camera;
    for (const TimedPose& pose : timed) {
      if (!covered(pose.time_s)) continue;
      T_base_flange.push_back(record_.at(pose.time_s + start_.clock_offset_s));
      T_world_camera.push_back(pose.T_world_camera);
    }
    add_motions(T_base_flange, T_world_camera, motions_);
    return {};
  }

  [[nodiscard]] bool covered(double camera_time_s) const {
    constexpr double kMargin_s{0.05};  // the offset is refined
    return record_.covers(camera_time_s + start_.clock_offset_s - kMargin_s) &&
           record_.covers(camera_time_s + start_.clock_offset_s + kMargin_s);
  }

  void add_moving_views() {
    if (!result_.clock_offset_s) return;
    std::vector<const MovingView*> usable;
    for (const MovingView& view : input_.moving) {
      if (covered(*view.time_s)) usable.push_back(&view);
    }
    const std::size_t count = std::min(usable.size(), config_.max_moving_views);
    for (std::size_t k = 0; k < count; ++k) {
      const MovingView& view = *usable[k * usable.size() / count];
      views_.push_back({to_points(view.depth, input_.camera, executor_), Pose::Identity(), view.time_s});
    }
  }

  void lack(std::string sentence) { result_.missing.push_back(std::move(sentence)); }

  bool check_motions() {
    if (views_.size() < kMinViews) {
      lack("only " + std::to_string(views_.size()) + " views have a known flange pose: take at least three");
      return false;
    }
    const Turns turns = turns_of(camera_poses(views_, record_, Pose::Identity(), start_.clock_offset_s));
    if (turns.rms_rad[0] < config_.min_turn_rad) {
      lack(
          "the flange hardly turned between views: where the camera sits is not seen in any direction; turn it about "
          "two axes");
      return false;
    }
    if (turns.rms_rad[1] < config_.min_turn_rad) {
      const std::string axis = in_words(turns.axes_flange.col(0));
      lack("all turns are about nearly one axis, " + axis +
           " of the flange: the mount's position along that axis, and its angle about it, are not determined; turn the "
           "camera about another axis, too");
      return false;
    }
    return true;
  }

  [[nodiscard]] std::vector<const PointImage*> points() const {
    std::vector<const PointImage*> points;
    for (const MountView& view : views_) points.push_back(&view.points);
    return points;
  }

  [[nodiscard]] static double second_share(const Eigen::Matrix3d& normals) {
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>{normals, Eigen::EigenvaluesOnly}.eigenvalues()[1];
  }

  bool check_structure() {
    const std::vector<const PointImage*> all = points();
    const std::optional<Pose> X =
        input_.T_flange_camera_guess ? input_.T_flange_camera_guess : result_.T_flange_camera_tracked;
    double share{0.0};
    if (X) {
      share = second_share(normals_of(all, camera_poses(views_, record_, *X, start_.clock_offset_s)));
    } else {  // view by view, as their orientations are not known
      const Pose own{Pose::Identity()};
      for (const PointImage* view : all) {
        share += second_share(normals_of({&view, 1}, {&own, 1})) / static_cast<double>(all.size());
      }
    }
    if (share >= config_.min_structure) return true;
    lack("nearly all that is seen is one plane: put objects with faces in several directions before the camera");
    return false;
  }

  [[nodiscard]] ViewAgreement agreement_at(const Pose& T_flange_camera, double clock_offset_s) const {
    const std::vector<Pose> poses = camera_poses(views_, record_, T_flange_camera, clock_offset_s);
    const std::vector<const PointImage*> all = points();
    const std::vector<ViewPair> pairs =
        overlapping_pairs(all, input_.camera, poses, config_.min_overlap, config_.max_pairs, executor_);
    return agreement_of(all, input_.camera, poses, pairs, executor_);
  }

  /// Chooses the start at which views agree better: the guess or stage 1's mount.
  bool choose_start(const std::optional<Pose>& tracked) {
    const std::optional<Pose>& guess = input_.T_flange_camera_guess;
    if (!tracked && !guess) {
      lack("the camera could not be tracked between views (" + std::to_string(result_.still_tracked) + " of " +
           std::to_string(input_.still.size()) + " still, " + std::to_string(result_.moving_tracked) + " of " +
           std::to_string(input_.moving.size()) + " moving): give a rough mount, or take views closer to each other");
      return false;
    }
    start_.T_flange_camera = guess.value_or(tracked.value_or(Pose::Identity()));
    ViewAgreement best = agreement_at(start_.T_flange_camera, start_.clock_offset_s);
    result_.agreement_before = best;
    if (guess && tracked) {
      const ViewAgreement other = agreement_at(*tracked, start_.clock_offset_s);
      if (other.pairs > 0 &&
          (best.pairs == 0 || other.agreeing * best.median_plane_m > best.agreeing * other.median_plane_m)) {
        start_.T_flange_camera = *tracked;
        best = other;
      }
    }
    if (best.pairs >= 2) return true;
    lack("views hardly overlap: take more views of the same objects");
    return false;
  }

  void judge(const MountEstimate& estimate) {
    using Solver = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;
    result_.iterations = estimate.iterations;
    result_.agreement_after = agreement_at(estimate.T_flange_camera, estimate.clock_offset_s);
    const Solver rotation{estimate.covariance.block<3, 3>(0, 0)};
    const Solver translation{estimate.covariance.block<3, 3>(3, 3)};
    result_.rotation_sigma_rad = std::sqrt(std::max(rotation.eigenvalues()[2], 0.0));
    result_.translation_sigma_m = std::sqrt(std::max(translation.eigenvalues()[2], 0.0));
    result_.least_sure_flange = estimate.T_flange_camera.linear() * translation.eigenvectors().col(2);
    result_.flange_rotation_sigma_rad = estimate.flange_rotation_sigma_rad;
    result_.flange_translation_sigma_m = estimate.flange_translation_sigma_m;
    if (result_.clock_offset_s) {
      result_.clock_offset_s = estimate.clock_offset_s;
      result_.clock_sigma_s = std::sqrt(std::max(estimate.covariance(6, 6), 0.0));
    }
    if (result_.agreement_after->agreeing < kMinAgreeing) {
      lack(
          "the views do not agree at any mount near the start: something moved, flange poses are wrong, or the guess "
          "is too far off");
    }
    if (!(result_.rotation_sigma_rad <= config_.max_rotation_sigma_rad)) {
      lack("the mount's rotation is sure to " + rounded(to_deg(result_.rotation_sigma_rad), "degrees") +
           " only: take more views, turned farther about two axes");
    }
    if (!(result_.translation_sigma_m <= config_.max_translation_sigma_m)) {
      lack("the mount's position along " + in_words(result_.least_sure_flange) + " of the flange is sure to " +
           rounded(1e3 * result_.translation_sigma_m, "mm") + " only: turn the camera about other axes");
    }
    if (result_.missing.empty()) result_.T_flange_camera = estimate.T_flange_camera;
  }

  const HandEyeInput& input_;
  const Executor& executor_;
  const HandEyeConfig& config_;
  const Progress* progress_;
  FlangeRecord record_;
  std::vector<MountView> views_;
  std::vector<MotionPair> motions_;
  MountEstimate start_;
  HandEyeResult result_;
};

}  // namespace

Status HandEyeConfig::validate() const {
  const auto fail = [](const char* what) { return Error{Errc::invalid_argument, what, "calibration of the mount"}; };
  if (!(tracking_voxel_m > 0.0)) return fail("the voxel size must be positive");
  if (max_pairs < 2) return fail("at least two pairs of views are needed");
  if (!(min_overlap > 0.0 && min_overlap <= 1.0)) return fail("the overlap must lie within 0 and 1");
  if (!(min_turn_rad > 0.0)) return fail("the turn that is needed must be positive");
  if (!(min_structure >= 0.0 && min_structure < 0.5)) return fail("the structure must lie within 0 and 0.5");
  if (!(max_clock_offset_s > 0.0 && max_clock_offset_s <= 10.0)) return fail("the clock offset must be within 10 s");
  if (!(max_rotation_sigma_rad > 0.0 && max_translation_sigma_m > 0.0)) return fail("limits must be positive");
  return {};
}

Result<ViewAgreement> view_agreement(std::span<const DepthImage> depth, const PinholeCamera& camera,
                                     std::span<const Pose> T_world_camera, const Executor& executor,
                                     double min_overlap) {
  SACCADE_CHECK(camera.validate());
  if (depth.size() != T_world_camera.size())
    return Error{Errc::size_mismatch, "there must be a pose for every view", {}};
  std::vector<PointImage> points;
  std::vector<const PointImage*> views;
  for (const DepthImage& image : depth) {
    if (image.width() != camera.width || image.height() != camera.height) {
      return Error{Errc::size_mismatch, "a depth image and the camera differ in size", {}};
    }
    points.push_back(to_points(image, camera, executor));
  }
  for (const PointImage& image : points) views.push_back(&image);
  const std::vector<ViewPair> pairs =
      overlapping_pairs(views, camera, T_world_camera, min_overlap, depth.size() * depth.size(), executor);
  return agreement_of(views, camera, T_world_camera, pairs, executor);
}

Result<HandEyeResult> calibrate_hand_eye(const HandEyeInput& input, const Executor& executor,
                                         const HandEyeConfig& config, const Progress* progress) {
  SACCADE_CHECK(config.validate());
  SACCADE_CHECK(check_views(input));
  return HandEyeCalibration{input, executor, config, progress}.run();
}

}  // namespace saccade
