// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>

#include "commands.hpp"
#include "node.hpp"
#include "transforms.hpp"

namespace saccade::ros2 {
namespace {

using devices::now_s;
using devices::say;
using messages::TFMessage;
using nlohmann::json;

constexpr int kMovingDepth{100};
constexpr double kReadingPatience_s{0.02};
constexpr double kTick_s{1e-4};

/// Hand tracked as a frame of /tf.
class FrameHand {
 public:
  explicit FrameHand(const devices::Options& options)
      : frame_{options.text("")},
        reference_{options.text("--reference", "world")},
        timeout_s_{options.number("--timeout", 0.5)},
        moving_{node_, "/tf", Delivery::best_effort, kMovingDepth},
        fixed_{node_, "/tf_static", Delivery::latched, kMovingDepth} {}

  void run() {
    devices::LineInput input;
    while (!input.ended()) {
      const auto request = input.next(std::chrono::milliseconds{20});
      hear(0.0);
      if (!request) continue;
      const std::string kind = request->value("request", "");
      if (kind == "hello") {
        say({{"saccade", 1}});
      } else if (kind == "sample") {
        json answer = sample();
        answer["number"] = request->at("number");
        say(answer);
      } else {
        say({{"error", "unknown request " + kind}});
      }
    }
  }

 private:
  void note(const std::string& what) {
    if (!what.empty() && noted_.insert(what).second) std::cerr << what << '\n';
  }

  void hear(double longest_s) {
    for (const TFMessage& message : fixed_.take()) note(transforms_.add(message, true));
    for (const TFMessage& message : moving_.wait(longest_s)) note(transforms_.add(message, false));
  }

  /// Waits for a newer reading. Without one in time, the hand counts as not visible.
  [[nodiscard]] json sample() {
    const double began_s = now_s();
    for (;;) {
      hear(kReadingPatience_s);
      const auto located = transforms_.find(reference_, frame_);
      if (located && (!located->time_s || located->time_s != last_s_)) {
        last_s_ = located->time_s.value_or(now_s());
        told_s_ = std::max(told_s_ + kTick_s, *last_s_);
        heard_s_ = now_s();
        const Eigen::Vector3d p = located->T_reference_frame.translation();
        return {{"time_s", told_s_}, {"position", {p.x(), p.y(), p.z()}}};
      }
      if (now_s() - began_s > timeout_s_) {
        if (!located) note("no transform from " + frame_ + " to " + reference_ + "; frames: " + transforms_.frames());
        if (located) note("the transform from " + frame_ + " to " + reference_ + " stands still in time");
        told_s_ = std::max(told_s_ + kTick_s, last_s_.value_or(0.0) + now_s() - heard_s_);
        return {{"time_s", told_s_}, {"position", nullptr}};
      }
    }
  }

  std::string frame_, reference_;
  double timeout_s_;
  Node node_;
  Reader<TFMessage> moving_, fixed_;
  Transforms transforms_;
  std::optional<double> last_s_;  ///< time of the last reading
  double heard_s_{now_s()};
  double told_s_{0.0};  ///< keeps reported times increasing
  std::set<std::string> noted_;
};

}  // namespace

int run_hand(const devices::Options& options) {
  options.only({"", "--reference", "--timeout"});
  if (options.text("").empty()) throw std::runtime_error{"which frame? saccade-ros2 hand FRAME [--reference FRAME]"};
  devices::keep_output_for_answers();
  FrameHand{options}.run();
  return 0;
}

}  // namespace saccade::ros2
