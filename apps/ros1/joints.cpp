// SPDX-License-Identifier: Apache-2.0
// The joints of a ROS robot for Saccade (docs/guides/processes.md).
//
//   saccade-ros1 joints ACTION [--states TOPIC] [--silence S] [--timeout S]
//
// ACTION is a control_msgs/FollowJointTrajectory action, as joint_trajectory_controller has one; --states where
// sensor_msgs/JointState comes (/joint_states), in which the joints may stand in any order and in several messages.
// Without positions for --silence seconds (0.2) on the way, the motion is an error. The goal is cancelled on stop, when
// Saccade is done or gone, and by SIGTERM.
#include <actionlib/client/simple_action_client.h>
#include <control_msgs/FollowJointTrajectoryAction.h>

#include <cmath>
#include <iostream>
#include <thread>

#include "../../devices/protocol.hpp"
#include "connection.hpp"
#include "joint_states.hpp"
#include "subcommands.hpp"

namespace saccade::ros1 {
namespace {

using devices::now_s;
using devices::say;
using nlohmann::json;
using Client = actionlib::SimpleActionClient<control_msgs::FollowJointTrajectoryAction>;

constexpr double kGone_s{0.5};  ///< connections of a restarted server appear and disappear for a moment

/// Describes how an unsuccessful goal ended.
std::string end_of_goal(const Client& client) {
  const actionlib::SimpleClientGoalState state = client.getState();
  std::string text = "the controller ended the motion as " + state.toString();
  if (const auto result = client.getResult()) {
    text += ", error_code " + std::to_string(result->error_code);
    if (!result->error_string.empty()) text += ": " + result->error_string;
  }
  return state.getText().empty() ? text : text + " (" + state.getText() + ")";
}

class RosJoints {
 public:
  explicit RosJoints(const devices::Options& options)
      : action_{ros::names::resolve(options.text(""))},
        states_topic_{ros::names::resolve(options.text("--states", "/joint_states"))},
        timeout_s_{options.number("--timeout", 5.0)},
        silence_s_{options.number("--silence", 0.2)},
        connection_{timeout_s_} {}
  RosJoints(const RosJoints&) = delete;
  RosJoints& operator=(const RosJoints&) = delete;
  ~RosJoints() {
    if (!moving_ || !client_) return;
    client_->cancelGoal();
    std::this_thread::sleep_for(std::chrono::milliseconds{100});  // for the message to go out
  }

  void hello(const json& request) {
    states_.name(request.at("joints").get<std::vector<std::string>>());
    subscribe();
    require_server();
    static_cast<void>(positions_after(now_s()));
  }

  void answer(const json& request) {
    const std::string kind = request.value("request", "");
    if (kind == "joints") {
      const JointPositions at = positions_after(now_s());
      say({{"number", request.at("number")}, {"q", at.q}, {"time_s", at.time_s}});
    } else if (kind == "follow") {
      follow(request);
    } else if (kind == "stop") {
      stop(request.at("number"));
    } else {
      say({{"error", "unknown request " + kind}});
    }
  }

  [[nodiscard]] bool moving() const { return moving_; }

  /// Reports a new position during the motion, or its end.
  void report() {
    const std::optional<JointPositions> at = states_.after(told_s_);
    const bool done = client_->getState().isDone();
    if (done && ended_s_ == 0.0) ended_s_ = now_s();
    if (done && client_->getState() != actionlib::SimpleClientGoalState::SUCCEEDED) fail(end_of_goal(*client_));
    if (done || client_->isServerConnected()) connected_s_ = now_s();
    if (now_s() - connected_s_ > kGone_s) fail("the action server " + action_ + " has gone");
    if (!at) {
      if (now_s() - told_s_ > silence_s_) fail(states_.silence(states_topic_));
      return;
    }
    told_s_ = at->came_s;
    const bool at_end = done && at->came_s > ended_s_;
    say({{"number", number_}, {"done", at_end}, {"q", at->q}, {"time_s", at->time_s}});
    if (at_end) moving_ = false;
  }

  void idle() {
    if (connection_.forgotten()) subscribe();
  }

 private:
  void subscribe() {
    subscriber_.shutdown();  // two at a time would share a registration
    subscriber_ = connection_.node().subscribe<sensor_msgs::JointState>(states_topic_, 8, &JointStates::take, &states_,
                                                                        ros::TransportHints{}.tcpNoDelay());
    client_.emplace(action_, false);
  }

  void require_server() {
    const double until_s = now_s() + timeout_s_;
    while (!client_->isServerConnected()) {
      if (now_s() > until_s) {
        std::vector<std::string> actions;
        for (std::string& goal : topics_of_type("control_msgs/FollowJointTrajectoryActionFeedback")) {
          actions.push_back(goal.substr(0, goal.rfind('/')));
        }
        throw std::runtime_error{"no action server answers at " + action_ + " for " + seconds_text(timeout_s_) +
                                 " s; FollowJointTrajectory actions that are there: " + listed(actions)};
      }
      std::this_thread::sleep_for(std::chrono::milliseconds{10});
    }
  }

  [[nodiscard]] JointPositions positions_after(double asked_s) {
    for (const double until_s = now_s() + timeout_s_; now_s() < until_s; idle()) {
      if (const auto at = states_.wait_after(asked_s, 0.2)) return *at;
    }
    throw std::runtime_error{states_.silence(states_topic_)};
  }

  void follow(const json& request) {
    require_server();
    control_msgs::FollowJointTrajectoryGoal goal;  // its stamp is zero: now
    goal.trajectory.joint_names = states_.names();
    for (const json& point : request.at("points")) {
      trajectory_msgs::JointTrajectoryPoint& wanted = goal.trajectory.points.emplace_back();
      wanted.positions = point.at("q").get<std::vector<double>>();
      wanted.velocities = point.at("dq").get<std::vector<double>>();
      wanted.time_from_start = ros::Duration{point.at("t_s").get<double>()};
    }
    number_ = request.at("number");
    moving_ = true;
    ended_s_ = 0.0;
    told_s_ = connected_s_ = now_s();
    client_->sendGoal(goal);
  }

  /// Answers when no joint has moved for some time.
  void stop(const json& number) {
    constexpr double kStill_s{0.04};
    constexpr double kStill{5e-4};  // rad or m within that time
    constexpr double kLongest_s{0.45};
    if (moving_) client_->cancelGoal();
    moving_ = false;
    const double asked_s = now_s();
    std::optional<JointPositions> before;
    while (now_s() - asked_s < kLongest_s) {
      const auto at = states_.wait_after(before ? before->came_s + kStill_s : asked_s, kLongest_s);
      if (!at) break;
      double moved = before ? 0.0 : 1.0;
      for (std::size_t i = 0; before && i < at->q.size(); ++i)
        moved = std::max(moved, std::abs(at->q[i] - before->q[i]));
      if (moved < kStill) return say({{"number", number}, {"q", at->q}});
      before = at;
    }
    throw std::runtime_error{before ? "the arm still moves 0.45 s after its goal was cancelled"
                                    : states_.silence(states_topic_)};
  }

  [[noreturn]] void fail(const std::string& what) {
    if (!client_->getState().isDone()) client_->cancelGoal();
    moving_ = false;
    throw std::runtime_error{what};
  }

  std::string action_, states_topic_;
  double timeout_s_, silence_s_;
  Connection connection_;
  JointStates states_;
  std::optional<Client> client_;
  ros::Subscriber subscriber_;
  json number_;
  bool moving_{false};
  double told_s_{0.0};  ///< when the position came that was told last
  double connected_s_{0.0};
  double ended_s_{0.0};  ///< when the goal ended; 0: not yet
};

void answer_requests(const devices::Options& options) {
  devices::keep_output_for_answers();
  std::optional<RosJoints> joints;
  for (devices::LineInput input; !input.ended();) {
    try {
      const bool moving = joints && joints->moving();
      const auto request = input.next(std::chrono::milliseconds{moving ? 5 : 200});
      if (request && request->value("request", "") == "hello") {
        if (!joints) joints.emplace(options);
        joints->hello(*request);
        say({{"saccade", 1}});
      } else if (request && joints) {
        joints->answer(*request);
      } else if (request) {
        say({{"error", "hello comes first"}});
      }
      if (joints && joints->moving())
        joints->report();
      else if (joints)
        joints->idle();
    } catch (const std::exception& e) {
      say({{"error", e.what()}});
    }
  }
}

}  // namespace
}  // namespace saccade::ros1

int run_joints_device(int argc, char** argv) {
  using namespace saccade;
  ros1::begin_node(argc, argv, "saccade_joints");
  const devices::Options options{argc, argv};
  options.only({"", "--states", "--silence", "--timeout"});
  if (options.text("").empty())
    throw std::runtime_error{"name the action, such as /arm_controller/follow_joint_trajectory"};
  ros1::answer_requests(options);
  return 0;
}
