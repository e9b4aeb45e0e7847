// SPDX-License-Identifier: Apache-2.0
// A hand that TF follows, for Saccade (docs/guides/processes.md).
//
//   saccade-ros1 hand FRAME [--reference FRAME] [--lost S] [--timeout S]
//
// FRAME's origin is the hand, in the frame --reference ("world"). Without a new transform for --lost seconds (0.5), the
// hand counts as not seen. A position that is not finite is passed over.
#include <cmath>
#include <iostream>
#include <thread>

#include "../../devices/protocol.hpp"
#include "connection.hpp"
#include "subcommands.hpp"

namespace saccade::ros1 {
namespace {

using devices::now_s;
using devices::say;
using nlohmann::json;

class RosHand {
 public:
  explicit RosHand(const devices::Options& options)
      : frame_{without_slash(options.text(""))},
        reference_{without_slash(options.text("--reference", "world"))},
        lost_s_{options.number("--lost", 0.5)},
        connection_{options.number("--timeout", 5.0)} {
    transforms_.emplace();
  }

  /// Returns the next reading, or that the hand is not visible.
  [[nodiscard]] json sample(const json& number) {
    for (const double until_s = now_s() + lost_s_; now_s() < until_s;) {
      const auto found = transforms_->find(reference_, frame_, ros::Time{0});
      if (found && found->header.stamp != last_ && std::isfinite(found->transform.translation.x)) {
        last_ = found->header.stamp;
        seen_s_ = now_s();
        const auto& p = found->transform.translation;
        return {{"number", number}, {"time_s", last_.toSec()}, {"position", {p.x, p.y, p.z}}};
      }
      std::this_thread::sleep_for(std::chrono::milliseconds{2});
    }
    if (seen_s_ == 0.0 && !told_) {
      told_ = true;
      std::cerr << "TF does not say where " << frame_ << " is in " << reference_
                << "; frames that it knows: " << listed(transforms_->frames()) << '\n';
    }
    const double since_s = seen_s_ == 0.0 ? ros::Time::now().toSec() : last_.toSec() + now_s() - seen_s_;
    return {{"number", number}, {"time_s", since_s}, {"position", nullptr}};
  }

  void idle() {
    if (connection_.forgotten()) transforms_->renew();
  }

 private:
  [[nodiscard]] static std::string without_slash(std::string name) {
    return !name.empty() && name.front() == '/' ? name.substr(1) : name;
  }

  std::string frame_, reference_;
  double lost_s_;
  Connection connection_;
  std::optional<Transforms> transforms_;
  ros::Time last_{};
  double seen_s_{0.0};
  bool told_{false};
};

void answer_requests(const devices::Options& options) {
  devices::keep_output_for_answers();
  std::optional<RosHand> hand;
  for (devices::LineInput input; !input.ended();) {
    try {
      const auto request = input.next(std::chrono::milliseconds{200});
      if (hand) hand->idle();
      if (!request) continue;
      const std::string kind = request->value("request", "");
      if (kind == "hello") {
        if (!hand) hand.emplace(options);
        say({{"saccade", 1}});
      } else if (kind == "sample" && hand) {
        say(hand->sample(request->at("number")));
      } else {
        say({{"error", "unknown request " + kind}});
      }
    } catch (const std::exception& e) {
      say({{"error", e.what()}});
    }
  }
}

}  // namespace
}  // namespace saccade::ros1

int run_hand_device(int argc, char** argv) {
  using namespace saccade;
  ros1::begin_node(argc, argv, "saccade_hand");
  const devices::Options options{argc, argv};
  options.only({"", "--reference", "--lost", "--timeout"});
  if (options.text("").empty()) throw std::runtime_error{"name the hand's frame in TF"};
  ros1::answer_requests(options);
  return 0;
}
