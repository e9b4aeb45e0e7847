// SPDX-License-Identifier: Apache-2.0
#pragma once
// Devices behind the user's programs, docs/guides/processes.md: ProgramCamera, ProgramRobot, ProgramJoints,
// ProgramHand. ProgramConfig: how to run such a program. kRosPrograms: Saccade's own programs for ROS.

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

/// How to run a program. Every class below starts it, is used by one caller at a time, and ends it when destroyed. None
/// of its processes remains then, nor after a crash of the caller.
struct ProgramConfig {
  std::string command;                ///< command line for a shell; or ros:NAME, ros2:NAME, with options
  std::filesystem::path folder{};     ///< working directory; empty: the caller's
  double start_timeout_s{30.0};       ///< limit until it has introduced itself
  double timeout_s{10.0};             ///< limit of an answer to a request; a motion adds its own duration
  std::function<bool()> cancelled{};  ///< polled while waiting for the program; true: Errc::cancelled. Empty: never

  [[nodiscard]] Status validate(const char* role) const;
};

/// Program with the devices and publisher of a ROS version, present in builds that found its packages.
struct RosProgram {
  std::string_view name;      ///< "ROS 1"
  std::string_view prefix;    ///< prefix of a command that names a device: "ros:"
  std::string_view program;   ///< "saccade-ros1"
  std::string_view packages;  ///< Debian packages needed to build it
};
inline constexpr std::array<RosProgram, 2> kRosPrograms{
    {{"ROS 1", "ros:", "saccade-ros1",
      "ros-core-dev, libactionlib-dev, libtf2-ros-dev, libtopic-tools-dev, libpcl-msgs-dev and ros-pcl-msgs"},
     {"ROS 2", "ros2:", "saccade-ros2", "cyclonedds-dev and cyclonedds-tools"}}};
/// Searches beside the running program, then in PATH. Empty where it is not found.
[[nodiscard]] std::filesystem::path find_program(std::string_view name);

/// Largest distance of a reported pose from the requested one; more is an error.
constexpr double kMaxPoseError_m{0.5};

enum class ProgramDepth { float32_m, uint16_mm };
enum class ProgramColor { none, rgb8 };
inline constexpr auto kProgramDepthNames =
    make_names<ProgramDepth>({{ProgramDepth::float32_m, "float32_m"}, {ProgramDepth::uint16_mm, "uint16_mm"}});
inline constexpr auto kProgramColorNames =
    make_names<ProgramColor>({{ProgramColor::none, "none"}, {ProgramColor::rgb8, "rgb8"}});

/// Format announced by a camera.
struct ProgramCameraFormat {
  PinholeCamera camera;
  ProgramDepth depth{ProgramDepth::float32_m};
  ProgramColor color{ProgramColor::none};

  /// Returns the bytes of depth and colour together.
  [[nodiscard]] std::size_t frame_bytes() const;
};

class ProgramCamera final : public Camera {
 public:
  /// Starts the program and asks for its description. Answers unavailable when it reports an error itself; not_found
  /// when it does not exist; io_failure when it ended, or did not answer in time; corrupt_data, unsupported for a wrong
  /// answer. Each error names the command and quotes the program's stderr.
  [[nodiscard]] static Result<ProgramCamera> start(const ProgramConfig& config);
  ProgramCamera(ProgramCamera&&) noexcept;
  ProgramCamera& operator=(ProgramCamera&&) noexcept;
  ~ProgramCamera() override;

  [[nodiscard]] const PinholeCamera& intrinsics() const override { return format_.camera; }
  [[nodiscard]] const ProgramCameraFormat& format() const { return format_; }

  /// Takes one frame. Its T_world_camera is the given one, or the camera's own where it reports one; its index counts
  /// from 0.
  /// @param T_world_camera the camera's pose according to the robot
  /// @return unavailable: the camera reports an error, and may be asked again. Any other error is final.
  [[nodiscard]] Result<Frame> capture(const Pose& T_world_camera) override;

 private:
  ProgramCamera(ProgramConfig config, std::unique_ptr<ExternalProcess> process, ProgramCameraFormat format);

  ProgramConfig config_;
  std::unique_ptr<ExternalProcess> process_;
  ProgramCameraFormat format_;
  std::size_t asked_{0};
};

/// Robot that plans its own motions.
class ProgramRobot final : public Robot {
 public:
  /// Starts the program and waits until it is ready. Errors: as ProgramCamera::start().
  [[nodiscard]] static Result<std::unique_ptr<ProgramRobot>> start(const ProgramConfig& config);
  ~ProgramRobot() override;

  /// Plans to the first pose: the program finds its own path, or declines when asked to move.
  [[nodiscard]] Result<PlannedMotion> plan(std::span<const Pose> T_world_camera,
                                           MotionKind way = MotionKind::planned) override;
  /// Answers unavailable when the robot reports an error; it may be asked again. Any other error is final.
  [[nodiscard]] Result<std::optional<Arrival>> execute(const Motion& motion,
                                                       const MotionObserver& on_way = {}) override;
  /// Returns the robot's explanation why the last pose was not reached; may be empty.
  [[nodiscard]] const std::string& why_not_reached() const { return why_not_reached_; }

 private:
  ProgramRobot(ProgramConfig config, std::unique_ptr<ExternalProcess> process);

  ProgramConfig config_;
  std::unique_ptr<ExternalProcess> process_;
  std::string why_not_reached_;
  std::size_t asked_{0};
};

/// Names and limits of the joints behind a program.
struct ProgramJointsConfig {
  ProgramConfig program;
  std::vector<std::string> names;  ///< base first
  Configuration lower;             ///< rad or m
  Configuration upper;
  Configuration speed;         ///< limit, rad/s or m/s
  Configuration acceleration;  ///< limit, rad/s² or m/s²
  double tolerance{0.05};      ///< positions farther than this from the trajectory stop the arm, rad or m
  double lag_s{0.3};           ///< largest delay of positions behind the trajectory
  double watchdog_s{0.25};     ///< longest silence during a motion before the arm is stopped

  [[nodiscard]] Status validate() const;
};

/// Joints that a program moves along Saccade's trajectories. On any problem the program is told to stop at once:
/// positions off the trajectory, silence, nonsense, or the caller stops or cancels.
class ProgramJoints final : public JointController {
 public:
  /// Starts the program and sends it names and limits. Errors: as ProgramCamera::start().
  [[nodiscard]] static Result<std::unique_ptr<ProgramJoints>> start(ProgramJointsConfig config);
  ~ProgramJoints() override;

  /// Errors: those of a program; corrupt_data for positions outside the limits by more than the tolerance.
  [[nodiscard]] Result<Configuration> position() override;
  /// Calls the observer from the caller's thread with the latest positions; another thread supervises the program
  /// meanwhile. After an Error, the arm was told to stop, or the program is gone.
  [[nodiscard]] Result<JointArrival> execute(const Trajectory& trajectory, const JointObserver& observer = {}) override;

 private:
  class Drive;  ///< one motion

  ProgramJoints(ProgramJointsConfig config, std::unique_ptr<ExternalProcess> process);

  ProgramJointsConfig config_;
  std::unique_ptr<ExternalProcess> process_;
  std::size_t asked_{0};
};

/// Hand whose motion a program tracks.
class ProgramHand final : public HandTracker {
 public:
  /// Starts the program. Errors: as ProgramCamera::start().
  [[nodiscard]] static Result<std::unique_ptr<ProgramHand>> start(const ProgramConfig& config);
  ~ProgramHand() override;

  /// Returns the next sample. Its position is not finite where the program does not see the hand.
  [[nodiscard]] Result<std::optional<HandSample>> next() override;

 private:
  ProgramHand(ProgramConfig config, std::unique_ptr<ExternalProcess> process);

  ProgramConfig config_;
  std::unique_ptr<ExternalProcess> process_;
  std::size_t asked_{0};
};

}  // namespace saccade
