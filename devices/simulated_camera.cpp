// SPDX-License-Identifier: Apache-2.0
// A simulated depth camera in the hand of a simulated arm, which sees a scene from where the arm truly is.
//
//   saccade-simulated-camera --scene SCENE [--robot ROBOT] [--base LINK] [--base-at X,Y,Z[,DEGREES]] [--tip LINK]
//                            [--camera-frame LINK] [--package NAME=FOLDER] [--state FILE] [--mount X,Y,Z,RX,RY,RZ]
//                            [--delay S] [--clock S] [--width PIXELS] [--seed N] [--noise 0|1]
//                            [--fault none|hang|die|nonsense|error] [--after FRAMES] [--log FILE]
//                            [--then SCENE --when FILE]
//
// Options that saccade has too read the arm's description as there. Without --state it sees from where it is asked to
// be. --mount is how far off the camera truly sits on the flange: metres, and degrees about its x, y and z axes. A
// frame comes --delay seconds after it was taken; --clock is added to its time stamps. The fault shows when --after
// frames were taken; --log gets a line with its time. As soon as there is a file FILE, the scene of --then takes the
// place of the first one.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <span>
#include <thread>

#include "arm_reading.hpp"
#include "arm_state.hpp"
#include "protocol.hpp"
#include "saccade/arm/kinematics.hpp"
#include "saccade/arm/urdf.hpp"
#include "saccade/core/angle.hpp"
#include "saccade/io/files/json_io.hpp"
#include "saccade/scene/scene_yaml.hpp"
#include "saccade/scene/simulated_camera.hpp"

namespace {

using nlohmann::json;
using namespace saccade;
using devices::now_s;
using devices::say;

/// Returns the value, or throws what is wrong.
template <class T>
T value_of(Result<T> result) {
  if (!result) throw std::runtime_error{result.error().to_string()};
  return *std::move(result);
}

Pose mount_error(const std::vector<double>& values) {
  if (values.size() != 6) return Pose::Identity();
  Pose error = Pose::Identity();
  error.translation() << values[0], values[1], values[2];
  error.linear() = (Eigen::AngleAxisd{to_rad(values[5]), Eigen::Vector3d::UnitZ()} *
                    Eigen::AngleAxisd{to_rad(values[4]), Eigen::Vector3d::UnitY()} *
                    Eigen::AngleAxisd{to_rad(values[3]), Eigen::Vector3d::UnitX()})
                       .toRotationMatrix();
  return error;
}

class CameraInHand {
 public:
  explicit CameraInHand(const devices::Options& options)
      : mount_error_{mount_error(options.numbers("--mount"))},
        delay_s_{options.number("--delay", 0.0)},
        clock_s_{options.number("--clock", 0.0)},
        fault_{options.text("--fault", "none")},
        log_{options.text("--log")},
        after_{static_cast<std::size_t>(options.number("--after", 0.0))},
        camera_{value_of(camera_of(options, options.text("--scene")))},
        when_{options.text("--when")} {
    if (!when_.empty()) changed_ = value_of(camera_of(options, options.text("--then")));
    const std::string state = options.text("--state");
    if (state.empty()) return;
    arm_ = value_of(find_robot(options.text("--robot", "comau"), devices::reading_of(options))).arm;
    state_.emplace(state);
  }

  void run() {
    devices::LineInput input;
    while (!input.ended()) {
      const auto request = input.next(std::chrono::milliseconds{200});
      if (!request) continue;
      const std::string kind = request->at("request");
      if (kind == "hello")
        say(hello());
      else if (kind == "capture")
        capture(*request);
      else
        say({{"error", "unknown request " + kind}});
    }
  }

 private:
  [[nodiscard]] static Result<SimulatedCamera> camera_of(const devices::Options& options, const std::string& name) {
    SACCADE_TRY(Scene scene, find_scene(name));
    SACCADE_TRY(RayScene rays, RayScene::build(scene));
    SimulatedCameraConfig config;
    config.camera = config.camera.scaled_to_width(static_cast<int>(options.number("--width", 640.0)));
    const auto seed = static_cast<std::uint64_t>(options.number("--seed", 1.0));
    config.noise = options.number("--noise", 1.0) > 0.0 ? std::optional{kinect_v1_noise(seed)} : std::nullopt;
    return SimulatedCamera::create(std::move(rays), config);
  }

  [[nodiscard]] json hello() const {
    const PinholeCamera& c = camera_.camera();
    return {{"saccade", 1},
            {"width", c.width},
            {"height", c.height},
            {"fx", c.fx},
            {"fy", c.fy},
            {"cx", c.cx},
            {"cy", c.cy},
            {"min_range_m", c.min_range_m},
            {"max_range_m", c.max_range_m},
            {"depth", "float32_m"},
            {"color", "none"}};
  }

  /// Returns where the camera truly is.
  [[nodiscard]] Pose true_pose(const json& request) const {
    const std::vector<double> q = state_ ? state_->read() : std::vector<double>{};
    if (q.empty()) return value_of(pose_from_json(request.at("T_world_camera"))) * mount_error_;
    return camera_pose(*arm_, Eigen::Map<const Eigen::VectorXd>{q.data(), static_cast<Eigen::Index>(q.size())}) *
           mount_error_;
  }

  void capture(const json& request) {
    if (fault_ != "none" && taken_ >= after_) {
      if (!log_.empty()) std::ofstream{log_, std::ios::app} << std::to_string(now_s()) << " fault\n";
      if (fault_ == "hang") std::this_thread::sleep_for(std::chrono::hours{1});
      if (fault_ == "die") ::_exit(9);
      if (fault_ == "nonsense") return say("a fine frame");
      if (fault_ == "error") return say({{"error", "the cable is loose"}});
    }
    ++taken_;
    if (changed_ && std::filesystem::exists(when_)) {
      camera_ = *std::move(changed_);
      changed_.reset();
    }
    const double taken_s = now_s();
    const DepthImage depth = camera_.capture(true_pose(request)).depth;
    const double left_s = taken_s + delay_s_ - now_s();
    if (left_s > 0.0) std::this_thread::sleep_for(std::chrono::duration<double>{left_s});
    const auto bytes = std::as_bytes(std::span{depth.pixels()});
    say({{"number", request.at("number")}, {"bytes", bytes.size()}, {"time_s", taken_s + clock_s_}},
        {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }

  Pose mount_error_;
  double delay_s_, clock_s_;
  std::string fault_;
  std::string log_;
  std::size_t after_;
  SimulatedCamera camera_;
  std::string when_;
  std::optional<SimulatedCamera> changed_;
  std::optional<ArmModel> arm_;
  std::optional<devices::ArmState> state_;
  std::size_t taken_{0};
};

}  // namespace

int main(int argc, char** argv) {
  try {
    CameraInHand{devices::Options{argc, argv}}.run();
  } catch (const std::exception& e) {
    std::cerr << "saccade-simulated-camera: " << e.what() << '\n';
    return 1;
  }
  return 0;
}
