// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "arm_states.hpp"
#include "commands.hpp"
#include "node.hpp"

namespace saccade::ros2 {
namespace {

using devices::now_s;
using devices::say;
using messages::JointTrajectory;
using messages::JointTrajectoryPoint;
using nlohmann::json;

constexpr double kSilence_s{0.2};       // states must come at least this often while the arm moves
constexpr double kStandsAfter_s{0.06};  // without having moved
constexpr double kStopTimeout_s{0.45};  // Saccade waits half a second
constexpr double kTellEvery_s{0.008};   // positions on the way
constexpr std::chrono::milliseconds kMoving{2};
constexpr std::chrono::milliseconds kResting{20};

messages::Duration duration_of(double s) {
  const auto nanoseconds = static_cast<std::int64_t>(std::llround(1e9 * s));
  return {static_cast<std::int32_t>(nanoseconds / 1'000'000'000),
          static_cast<std::uint32_t>(nanoseconds % 1'000'000'000)};
}

/// Requested motion.
struct Motion {
  json number;
  std::vector<JointTrajectoryPoint> points;
  std::vector<double> times_s;
  double began_s{0.0};
  double told_s{0.0};

  [[nodiscard]] double duration_s() const { return times_s.back(); }
  [[nodiscard]] double elapsed_s() const { return now_s() - began_s; }
  [[nodiscard]] const std::vector<double>& planned_now() const {
    const auto next = std::lower_bound(times_s.begin(), times_s.end() - 1, elapsed_s());
    return points[static_cast<std::size_t>(next - times_s.begin())].positions;
  }
};

/// Arm behind a joint_trajectory_controller.
class ControlledArm {
 public:
  explicit ControlledArm(const devices::Options& options)
      : topic_{options.text("")},
        states_topic_{options.text("--states", "/joint_states")},
        wait_s_{options.number("--wait", 10.0)},
        timeout_s_{options.number("--timeout", 3.0)},
        arrived_{options.number("--arrived", 0.01)},
        stop_time_s_{options.number("--stop-time", 0.2)} {}

  void run() {
    devices::LineInput input;
    while (!input.ended()) {
      try {
        const auto request = input.next(motion_ ? kMoving : kResting);
        if (states_ && states_->hear(0.0) && motion_) told_anew_ = true;
        if (request) answer(*request);
        if (motion_) move();
      } catch (const std::exception& e) {
        if (motion_) hold();
        say({{"error", e.what()}});
      }
    }
    if (!motion_) return;
    hold();  // Saccade is gone
    controller_->flush(kStopTimeout_s);
  }

 private:
  void answer(const json& request) {
    const std::string kind = request.value("request", "");
    if (kind == "hello") {
      greet(request.at("joints").get<std::vector<std::string>>());
      say({{"saccade", 1}});
    } else if (kind == "joints" && states_) {
      await([] { return true; }, timeout_s_);
      tell(request.at("number"), {});
    } else if (kind == "follow" && states_) {
      follow(request);
    } else if (kind == "stop" && states_) {
      hold();
      if (!await([&] { return states_->still_s() > kStandsAfter_s; }, kStopTimeout_s)) {
        throw std::runtime_error{"the arm has not come to rest in " + std::to_string(kStopTimeout_s) + " s"};
      }
      tell(request.at("number"), {});
    } else {
      say({{"error", "unknown request " + kind}});
    }
  }

  /// Finds the states and the controller.
  void greet(std::vector<std::string> joints) {
    if (joints.empty()) throw std::runtime_error{"the arm has no joints"};
    names_ = joints;
    states_.emplace(node_, states_topic_, std::move(joints));
    controller_.emplace(node_, topic_, messages::type_of<JointTrajectory>().dds_name(), Delivery::reliable);
    await([] { return true; }, wait_s_);
    if (await([&] { return controller_->readers() > 0; }, wait_s_)) return;
    throw std::runtime_error{"nothing listens on " + topic_ + " in domain " + std::to_string(node_.domain()) +
                             " (ROS_DOMAIN_ID); is the joint_trajectory_controller active?"};
  }

  /// Waits for new positions that satisfy a condition. Throws when no positions come.
  template <class Condition>
  bool await(const Condition& met, double longest_s) {
    for (const double began_s = now_s(); now_s() - began_s < longest_s;) {
      if (states_->hear(0.01) && met()) return true;
    }
    if (states_->age_s() > std::min(longest_s, kSilence_s)) throw std::runtime_error{states_->silence()};
    return false;
  }

  void tell(const json& number, json more) {
    more["number"] = number;
    more["q"] = states_->q();
    if (const auto stamp_s = states_->stamp_s()) more["time_s"] = *stamp_s;
    say(more);
  }

  void follow(const json& request) {
    Motion motion{request.at("number"), {}, {}, now_s(), 0.0};
    for (const json& point : request.at("points")) {
      const double t_s = point.at("t_s");
      motion.times_s.push_back(t_s);
      motion.points.push_back({point.at("q"), point.at("dq"), {}, {}, duration_of(t_s)});
      if (motion.points.back().positions.size() != names_.size()) throw std::runtime_error{"a point has other joints"};
    }
    if (motion.points.empty()) throw std::runtime_error{"a motion has no points"};
    send(motion.points);
    motion_ = std::move(motion);
    told_anew_ = false;
  }

  /// Reports the positions during the motion, and its end once.
  void move() {
    if (states_->age_s() > kSilence_s) throw std::runtime_error{states_->silence()};
    const double elapsed_s = motion_->elapsed_s();
    if (elapsed_s >= motion_->duration_s()) {
      const double off = distance(states_->q(), motion_->points.back().positions);
      if (off <= arrived_ && states_->still_s() > kStandsAfter_s && told_anew_) {
        tell(motion_->number, {{"done", true}});
        return motion_.reset();
      }
      if (elapsed_s > motion_->duration_s() + timeout_s_) {
        throw std::runtime_error{"the arm stands " + std::to_string(off) + " rad or m from the end of its motion; " +
                                 "did the controller take the trajectory?"};
      }
    }
    if (!told_anew_ || now_s() - motion_->told_s < kTellEvery_s) return;
    told_anew_ = false;
    motion_->told_s = now_s();
    tell(motion_->number, {{"done", false}, {"t_s", std::min(elapsed_s, motion_->duration_s())}});
  }

  /// Holds the arm at its position; if it has been silent for some time, where it should be.
  void hold() {
    const bool fresh = states_->age_s() < 0.5 * kSilence_s;
    if (!fresh && !motion_) throw std::runtime_error{states_->silence()};
    JointTrajectoryPoint here;
    here.positions = fresh ? states_->q() : motion_->planned_now();
    here.velocities.assign(names_.size(), 0.0);
    here.time_from_start = duration_of(stop_time_s_);
    motion_.reset();
    send({here});
  }

  /// Sends a trajectory. A stamp of 0 means: now.
  void send(const std::vector<JointTrajectoryPoint>& points) {
    JointTrajectory trajectory;
    trajectory.joint_names = names_;
    trajectory.points = points;
    controller_->write(messages::write_message(messages::Wire::cdr, trajectory));
  }

  static double distance(const std::vector<double>& a, const std::vector<double>& b) {
    double farthest = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) farthest = std::max(farthest, std::abs(a[i] - b[i]));
    return farthest;
  }

  std::string topic_, states_topic_;
  double wait_s_, timeout_s_, arrived_, stop_time_s_;
  Node node_;
  std::vector<std::string> names_;
  std::optional<ArmStates> states_;
  std::optional<RawWriter> controller_;
  std::optional<Motion> motion_;
  bool told_anew_{false};  ///< new positions were not reported yet
};

}  // namespace

int run_joints(const devices::Options& options) {
  options.only({"", "--states", "--wait", "--timeout", "--arrived", "--stop-time"});
  if (options.text("").empty())
    throw std::runtime_error{"which topic? saccade-ros2 joints /arm_controller/joint_trajectory"};
  devices::keep_output_for_answers();
  ControlledArm{options}.run();
  return 0;
}

}  // namespace saccade::ros2
