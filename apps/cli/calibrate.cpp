// SPDX-License-Identifier: Apache-2.0
// saccade calibrate: where the camera of a cell sits on the arm's flange, and how their clocks differ, without a board.
#include <algorithm>
#include <iomanip>
#include <sstream>

#include "cell_options.hpp"
#include "context.hpp"
#include "explore_devices.hpp"
#include "length_options.hpp"
#include "saccade/arm/kinematics.hpp"
#include "saccade/core/angle.hpp"
#include "saccade/core/statistics.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/tracking/hand_eye.hpp"
#include "summary.hpp"

namespace saccade::cli {
namespace {

using nlohmann::json;

struct CalibrateOptions : ExploreOptions {
  double turn_deg{15.0};    ///< turn between the views around each pose of the scan
  double max_depth_m{2.0};  ///< farther depth is left out
};

/// Turned about its own axes, one after the other.
std::vector<Pose> turned_about(const Pose& T_world_camera, double turn_rad) {
  std::vector<Pose> poses{T_world_camera};
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d axis = Eigen::Vector3d::Unit(k);
    for (const double sign : {1.0, -1.0}) poses.push_back(T_world_camera * Eigen::AngleAxisd{sign * turn_rad, axis});
  }
  return poses;
}

/// Moves the arm through views, and takes frames at rest and on the way.
class ViewCollector {
 public:
  ViewCollector(ExploreDevices& devices, const ArmModel& arm, double max_depth_m, const Progress& progress)
      : devices_{devices},
        progress_{progress},
        max_depth_m_{max_depth_m},
        T_camera_flange_{arm.description().T_flange_camera.inverse()} {
    input_.camera = devices.intrinsics();
    input_.T_flange_camera_guess = arm.description().T_flange_camera;
  }

  /// Views at rest around a pose; those that cannot be reached are left out.
  [[nodiscard]] Status look_around(const Pose& T_world_camera, double turn_rad) {
    for (const Pose& pose : turned_about(T_world_camera, turn_rad)) {
      SACCADE_TRY(const std::optional<Arrival> arrival, go_to(pose, {}));
      if (!arrival) continue;
      SACCADE_TRY(Frame frame, capture(arrival->T_world_camera));
      input_.still.push_back({std::move(frame.depth), arrival->T_world_camera * T_camera_flange_});
      reached_.push_back(pose);
      progress_.report("views at rest", input_.still.size(), 0);
    }
    return {};
  }

  /// Goes through the views again, and takes frames while it moves.
  [[nodiscard]] Status move_through(std::size_t count) {
    for (std::size_t i = 0; i < std::min(count, reached_.size()); ++i) {
      progress_.report("views in motion", i, count);
      Status taken;
      const MotionObserver on_way = [&](const MotionSample& sample) {
        taken = take_on_way(sample);
        return taken.ok() && !progress_.cancelled() ? Advance::go_on : Advance::stop;
      };
      SACCADE_TRY([[maybe_unused]] const std::optional<Arrival> arrival, go_to(reached_[i], on_way));
      if (!taken.ok()) return taken.error();
    }
    stand_at_ends();
    return {};
  }

  [[nodiscard]] const HandEyeInput& input() const { return input_; }

 private:
  [[nodiscard]] Result<std::optional<Arrival>> go_to(const Pose& pose, const MotionObserver& on_way) {
    if (progress_.cancelled()) return Error{Errc::cancelled, "interrupted", "calibrate"};
    SACCADE_TRY(const PlannedMotion planned, devices_.robot().plan(std::span{&pose, 1}));
    if (!planned.motion) return std::optional<Arrival>{};
    SACCADE_TRY(const std::optional<Arrival> arrival, devices_.robot().execute(*planned.motion, on_way));
    if (arrival && arrival->stopped) return Error{Errc::cancelled, "interrupted", "calibrate"};
    return arrival;
  }

  /// Far depth is too noisy to be tracked.
  [[nodiscard]] Result<Frame> capture(const Pose& T_world_camera) {
    SACCADE_TRY(Frame frame, devices_.camera().capture(T_world_camera));
    const std::span<float> pixels{frame.depth.data(), frame.depth.size()};
    std::replace_if(
        pixels.begin(), pixels.end(), [this](float depth) { return static_cast<double>(depth) > max_depth_m_; }, 0.0F);
    return frame;
  }

  [[nodiscard]] Status take_on_way(const MotionSample& sample) {
    if (!sample.time_s) return {};
    std::vector<FlangeSample>& flange = input_.flange;
    if (!flange.empty() && *sample.time_s <= flange.back().time_s) return {};
    flange.push_back({*sample.time_s, sample.T_world_camera * T_camera_flange_});
    SACCADE_TRY(Frame frame, capture(sample.T_world_camera));
    input_.moving.push_back({std::move(frame.depth), frame.time_s});
    return {};
  }

  /// The arm stood before the first sample and stands after the last one.
  void stand_at_ends() {
    constexpr double kStand_s{0.6};
    std::vector<FlangeSample>& flange = input_.flange;
    if (flange.empty()) return;
    flange.insert(flange.begin(), {flange.front().time_s - kStand_s, flange.front().T_base_flange});
    flange.push_back({flange.back().time_s + kStand_s, flange.back().T_base_flange});
  }

  ExploreDevices& devices_;
  const Progress& progress_;
  double max_depth_m_;
  Pose T_camera_flange_;
  HandEyeInput input_;
  std::vector<Pose> reached_;
};

/// Voxels no smaller than what a pixel sees at the median depth: finer ones would be left with holes.
HandEyeConfig config_for(const HandEyeInput& input) {
  constexpr double kPixels{2.0};
  std::vector<double> depths_m;
  for (const StillView& view : input.still) {
    for (const float depth : view.depth.pixels()) {
      if (depth > 0.0F) depths_m.push_back(static_cast<double>(depth));
    }
  }
  HandEyeConfig config;
  if (depths_m.empty()) return config;
  config.tracking_voxel_m = std::max(config.tracking_voxel_m, kPixels * median(depths_m) / input.camera.fx);
  return config;
}

json agreement_json(const std::optional<ViewAgreement>& agreement) {
  if (!agreement) return nullptr;
  return {{"pairs", agreement->pairs},
          {"agreeing", agreement->agreeing},
          {"median_depth_m", agreement->median_depth_m},
          {"median_plane_m", agreement->median_plane_m}};
}

json calibration_json(const HandEyeInput& input, const HandEyeResult& found) {
  return {{"views_at_rest", input.still.size()},
          {"views_in_motion", input.moving.size()},
          {"tracked_at_rest", found.still_tracked},
          {"tracked_in_motion", found.moving_tracked},
          {"T_flange_camera", found.T_flange_camera ? pose_to_json(*found.T_flange_camera) : json(nullptr)},
          {"rotation_sigma_rad", found.rotation_sigma_rad},
          {"translation_sigma_m", found.translation_sigma_m},
          {"clock_offset_s", found.clock_offset_s ? json(*found.clock_offset_s) : json(nullptr)},
          {"clock_sigma_s", found.agreement_after ? json(found.clock_sigma_s) : json(nullptr)},
          {"why_no_clock", found.why_no_clock},
          {"flange_rotation_sigma_rad", found.flange_rotation_sigma_rad},
          {"flange_translation_sigma_m", found.flange_translation_sigma_m},
          {"agreement_before", agreement_json(found.agreement_before)},
          {"agreement_after", agreement_json(found.agreement_after)},
          {"missing", found.missing}};
}

/// Lines for the cell's file.
std::string yaml_of(const HandEyeResult& found) {
  std::ostringstream text;
  text << std::setprecision(10) << "arm:\n  T_flange_camera:\n";
  for (Eigen::Index row = 0; row < 3; ++row) {
    text << "    - [";
    for (Eigen::Index column = 0; column < 4; ++column) {
      text << (column > 0 ? ", " : "") << found.T_flange_camera->matrix()(row, column);
    }
    text << "]\n";
  }
  if (found.clock_offset_s) text << "camera:\n  clock_offset: " << *found.clock_offset_s << '\n';
  return text.str();
}

std::string calibration_text(const HandEyeInput& input, const HandEyeResult& found) {
  std::ostringstream out;
  out << std::left;
  const auto line = [&out](const char* name, const std::string& text) { out << std::setw(10) << name << text << '\n'; };
  line("views", std::to_string(input.still.size()) + " at rest, " + std::to_string(input.moving.size()) + " in motion");
  if (found.T_flange_camera) {
    const Pose moved = input.T_flange_camera_guess->inverse() * *found.T_flange_camera;
    line("mount", fixed(1e3 * moved.translation().norm(), 1) + " mm and " +
                      fixed(to_deg(Eigen::AngleAxisd{moved.linear()}.angle()), 2) + "° from where it was taken to be");
    line("sure to", fixed(1e3 * found.translation_sigma_m, 2) + " mm, " + fixed(to_deg(found.rotation_sigma_rad), 3) +
                        "° (one standard deviation)");
  }
  const std::string how_sure = found.agreement_after ? ", ± " + fixed(1e3 * found.clock_sigma_s, 1) + " ms"
                                                     : ", as motions alone match: not refined with the mount";
  line("clock", found.clock_offset_s
                    ? fixed(1e3 * *found.clock_offset_s, 1) + " ms to be added to the camera's times" + how_sure
                    : "not found: " + found.why_no_clock);
  if (found.agreement_before && found.agreement_after) {
    line("views lie", fixed(1e3 * found.agreement_before->median_depth_m, 2) + " mm apart before, " +
                          fixed(1e3 * found.agreement_after->median_depth_m, 2) + " mm after (median)");
  }
  for (const std::string& missing : found.missing) line("missing", missing);
  if (found.T_flange_camera) out << "\nInto the cell's file:\n\n" << yaml_of(found);
  return out.str();
}

/// Says first where the cell's file is none: its keys are not what is missing then.
Status check_cell_file(const std::string& cell) {
  std::error_code ignored;
  const std::filesystem::path path{cell};
  if (std::filesystem::is_directory(path, ignored)) {
    return Error{Errc::invalid_argument, "is a folder; name the cell's file in it, such as cell.yaml", cell};
  }
  const bool is_yaml = path.extension() == ".yaml" || path.extension() == ".yml";
  if (is_yaml && !std::filesystem::exists(path, ignored)) return Error{Errc::not_found, "no such file", cell};
  return {};
}

/// There is no arm: the file is not there, or it lacks the key.
Error no_arm(const std::string& cell) {
  std::error_code ignored;
  if (!std::filesystem::exists(cell, ignored)) {
    return {Errc::not_found, "no such file; name a cell's YAML file, whose key arm says what carries the camera", cell};
  }
  return {Errc::invalid_argument, "no arm carries the camera; add the key arm", cell};
}

class Calibrate final : public Command {
 public:
  [[nodiscard]] CommandInfo info() const override {
    return {"calibrate",
            "finds the pose of the camera on the arm's flange, and the offset of their clocks, without a board"};
  }

  void declare(Options& options) override {
    options.value("cell", cell_.scene, "CELL", "a cell's YAML file (docs/reference/cell.md)").required();
    options
        .value("--turn", cell_.turn_deg, "DEGREES",
               "turn of the views around each pose of the scan, about each axis of the camera")
        .range(3.0, 45.0);
    options.value("--max-depth", cell_.max_depth_m, "METRES",
                  "depth beyond this is left out: it is too noisy to be tracked");
    add_arm_options(options.group(), cell_);
    add_device_options(options.group(), cell_);
  }

  void check(const GlobalOptions& global) override {
    require_length(cell_.max_depth_m, "--max-depth");
    check_device_options(cell_);
    if (cell_.robot.empty()) cell_.robot = "free";
    check_arm_options(cell_, global);
    cell_.arm.obstacles.unknown_is_obstacle = false;  // nothing is known yet, and the caller vouches for the space
  }

  [[nodiscard]] Result<Outcome> run(Context& context) override {
    const Executor& executor = context.executor();
    SACCADE_CHECK(check_cell_file(cell_.scene));
    if (cell_.cell_problem) return *cell_.cell_problem;
    SACCADE_TRY(const std::optional<ArmModel> arm, read_arm(cell_, &context.bar()));
    if (!arm) return no_arm(cell_.scene);
    SACCADE_TRY(const ExploreSetup subject, open_case(cell_, executor));
    if (subject.scene.scan.empty()) {
      return Error{Errc::invalid_argument, "there are no poses to look from; add some under the key scan", cell_.scene};
    }
    SACCADE_TRY(ExploreDevices devices, ExploreDevices::open(cell_, subject, arm, executor));
    ViewCollector views{devices, *arm, cell_.max_depth_m, context.progress()};
    for (const Pose& pose : subject.scene.scan) SACCADE_CHECK(views.look_around(pose, to_rad(cell_.turn_deg)));
    constexpr std::size_t kMotions{7};  // back through the views around the first pose
    SACCADE_CHECK(views.move_through(kMotions));
    SACCADE_TRY(const HandEyeResult found,
                calibrate_hand_eye(views.input(), executor, config_for(views.input()), &context.progress()));
    return Outcome{.result = calibration_json(views.input(), found), .text = calibration_text(views.input(), found)}
        .empty_if(!found.T_flange_camera,
                  found.missing.empty() ? "the views do not determine the mount" : found.missing.front());
  }

 private:
  CalibrateOptions cell_;
};

}  // namespace

void add_calibrate(CLI::App& program, const GlobalOptions& global, Action& action) {
  add_command<Calibrate>(program, global, action);
}

}  // namespace saccade::cli
