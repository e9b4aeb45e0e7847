// SPDX-License-Identifier: Apache-2.0
#pragma once
// Devices behind programs of the user's, docs/processes.md: ProgramCamera, ProgramRobot, ProgramJoints, ProgramHand;
// ProgramConfig: how such a program is run; kRosPrograms: those of ours that speak ROS.

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/names.hpp"
#include "saccade/core/result.hpp"
#include "saccade/robot/joint_controller.hpp"
#include "saccade/robot/robot.hpp"
#include "saccade/sensor/camera.hpp"
#include "saccade/sensor/hand_tracker.hpp"
#include "saccade/sensor/pinhole_camera.hpp"

namespace saccade {

class ExternalProcess;

/// How a program is run. Every class below starts it, is used by one caller at a time, and ends it when it is
/// destroyed; no process of it is left then, nor after a crash of the caller.
struct ProgramConfig {
  std::string command;                ///< as a shell would run it; or ros:NAME, ros2:NAME, with options
  std::filesystem::path folder{};     ///< working directory; empty: that of the caller
  double start_timeout_s{30.0};       ///< until it has said what it is
  double timeout_s{10.0};             ///< until it has answered a request; a motion adds its own duration
  std::function<bool()> cancelled{};  ///< asked while the program is waited for; true: Errc::cancelled. Empty: never

  [[nodiscard]] Status validate(const char* role) const;
};

/// A program that has the devices of a version of ROS, and publishes, in a build that found its packages.
struct RosProgram {
  std::string_view name;      ///< "ROS 1"
  std::string_view prefix;    ///< begins a command that names a device: "ros:"
  std::string_view program;   ///< "saccade-ros1"
  std::string_view packages;  ///< that it needs to be built (Debian)
};
inline constexpr std::array<RosProgram, 2> kRosPrograms{
    {{"ROS 1", "ros:", "saccade-ros1",
      "ros-core-dev, libactionlib-dev, libtf2-ros-dev, libtopic-tools-dev and libpcl-msgs-dev"},
     {"ROS 2", "ros2:", "saccade-ros2", "cyclonedds-dev and cyclonedds-tools"}}};
/// Looks beside the program that is running, and then in PATH. Empty: it is not there.
[[nodiscard]] std::filesystem::path find_program(std::string_view name);

/// A pose that a program reports may be this far from the one that was asked for; a farther one is an error.
constexpr double kMaxPoseError_m{0.5};

enum class ProgramDepth { float32_m, uint16_mm };
enum class ProgramColor { none, rgb8 };
inline constexpr auto kProgramDepthNames =
    make_names<ProgramDepth>({{ProgramDepth::float32_m, "float32_m"}, {ProgramDepth::uint16_mm, "uint16_mm"}});
inline constexpr auto kProgramColorNames =
    make_names<ProgramColor>({{ProgramColor::none, "none"}, {ProgramColor::rgb8, "rgb8"}});

/// What a camera says of itself.
struct ProgramCameraFormat {
  PinholeCamera camera;
  ProgramDepth depth{ProgramDepth::float32_m};
  ProgramColor color{ProgramColor::none};

  /// Bytes of depth and colour together.
  [[nodiscard]] std::size_t frame_bytes() const;
};

class ProgramCamera final : public Camera {
 public:
  /// Starts the program and asks what it is. unavailable: it reports an error itself; not_found: there is no such
  /// program; io_failure: it ended, or did not answer in time; corrupt_data, unsupported: its answer is wrong. Each
  /// names the command and quotes what the program wrote to stderr.
  [[nodiscard]] static Result<ProgramCamera> start(const ProgramConfig& config);
  ProgramCamera(ProgramCamera&&) noexcept;
  ProgramCamera& operator=(ProgramCamera&&) noexcept;
  ~ProgramCamera() override;

  [[nodiscard]] const PinholeCamera& intrinsics() const override { return format_.camera; }
  [[nodiscard]] const ProgramCameraFormat& format() const { return format_; }

  /// Takes one frame. Its T_world_camera is the one given, or the camera's own where that knows better; its index
  /// counts from 0.
  /// @param T_world_camera where the robot says the camera is
  /// @return unavailable: the camera reports an error, and may be asked again. Any other error is final.
  [[nodiscard]] Result<Frame> capture(const Pose& T_world_camera) override;

 private:
  ProgramCamera(ProgramConfig config, std::unique_ptr<ExternalProcess> process, ProgramCameraFormat format);

  ProgramConfig config_;
  std::unique_ptr<ExternalProcess> process_;
  ProgramCameraFormat format_;
  std::size_t asked_{0};
};

/// A robot that plans for itself.
class ProgramRobot final : public Robot {
 public:
  /// Starts the program and waits until it is ready. Errors: as ProgramCamera::start().
  [[nodiscard]] static Result<std::unique_ptr<ProgramRobot>> start(const ProgramConfig& config);
  ~ProgramRobot() override;

  /// The first pose: the program finds its own way, or declines when it is asked to go.
  [[nodiscard]] Result<PlannedMotion> plan(std::span<const Pose> T_world_camera, Way way = Way::any) override;
  /// unavailable: the robot reports an error, and may be asked again. Any other error is final.
  [[nodiscard]] Result<std::optional<Arrival>> execute(const Motion& motion, const OnWay& on_way = {}) override;
  /// Why the last pose was not reached, in the robot's words; empty without any.
  [[nodiscard]] const std::string& why_not_reached() const { return why_not_reached_; }

 private:
  ProgramRobot(ProgramConfig config, std::unique_ptr<ExternalProcess> process);

  ProgramConfig config_;
  std::unique_ptr<ExternalProcess> process_;
  std::string why_not_reached_;
  std::size_t asked_{0};
};

/// What the joints behind a program are called, and how they may move.
struct ProgramJointsConfig {
  ProgramConfig program;
  std::vector<std::string> names;  ///< base first
  Configuration lower;             ///< rad or m
  Configuration upper;
  Configuration speed;         ///< at most, rad/s or m/s
  Configuration acceleration;  ///< at most, rad/s² or m/s²
  double tolerance{0.05};      ///< positions farther than this from the trajectory stop the arm, rad or m
  double lag_s{0.3};           ///< positions may come this much later than the trajectory has them
  double watchdog_s{0.25};     ///< silence on the way for longer than this stops the arm

  [[nodiscard]] Status validate() const;
};

/// Joints that a program moves along trajectories of ours. Whatever goes wrong on the way, the program is told to stop
/// at once: positions off the trajectory, silence, nonsense, a caller who stops or cancels.
class ProgramJoints final : public JointController {
 public:
  /// Starts the program and tells it names and limits. Errors: as ProgramCamera::start().
  [[nodiscard]] static Result<std::unique_ptr<ProgramJoints>> start(ProgramJointsConfig config);
  ~ProgramJoints() override;

  /// Errors: those of a program; corrupt_data for positions outside the limits by more than the tolerance.
  [[nodiscard]] Result<Configuration> position() override;
  /// The observer is called from the caller's thread with the latest positions; another one watches the program
  /// meanwhile. Errors mean that the arm was told to stop, or that the program is gone.
  [[nodiscard]] Result<JointArrival> execute(const Trajectory& trajectory, const JointObserver& observer = {}) override;

 private:
  class Drive;  ///< one motion

  ProgramJoints(ProgramJointsConfig config, std::unique_ptr<ExternalProcess> process);

  ProgramJointsConfig config_;
  std::unique_ptr<ExternalProcess> process_;
  std::size_t asked_{0};
};

/// A hand whose motion a program tracks.
class ProgramHand final : public HandTracker {
 public:
  /// Starts the program. Errors: as ProgramCamera::start().
  [[nodiscard]] static Result<std::unique_ptr<ProgramHand>> start(const ProgramConfig& config);
  ~ProgramHand() override;

  /// Asks for the next sample. A sample in which the program does not see the hand has a position that is not finite.
  [[nodiscard]] Result<std::optional<HandSample>> next() override;

 private:
  ProgramHand(ProgramConfig config, std::unique_ptr<ExternalProcess> process);

  ProgramConfig config_;
  std::unique_ptr<ExternalProcess> process_;
  std::size_t asked_{0};
};

}  // namespace saccade
