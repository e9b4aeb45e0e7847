// SPDX-License-Identifier: Apache-2.0
#include "arm_states.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "devices/protocol.hpp"

namespace saccade::ros2 {
namespace {

constexpr double kStill{5e-4};  // rad or m: a joint that moves less counts as still
constexpr int kStateDepth{20};
constexpr double kNever_s{-std::numeric_limits<double>::infinity()};

}  // namespace

ArmStates::ArmStates(const Node& node, const std::string& topic, std::vector<std::string> joints)
    : joints_{std::move(joints)},
      reader_{node, topic, Delivery::best_effort, kStateDepth},
      q_(joints_.size()),
      heard_s_(joints_.size(), kNever_s) {}

bool ArmStates::hear(double longest_s) {
  const std::vector<messages::JointState> came = longest_s > 0.0 ? reader_.wait(longest_s) : reader_.take();
  const double newest_s = *std::max_element(heard_s_.begin(), heard_s_.end());
  for (const messages::JointState& state : came) take(state);
  return *std::max_element(heard_s_.begin(), heard_s_.end()) > newest_s && std::isfinite(age_s());
}

void ArmStates::take(const messages::JointState& state) {
  const double now_s = devices::now_s();
  bool ours = false;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const auto found = std::find(state.name.begin(), state.name.end(), joints_[i]);
    const auto at = static_cast<std::size_t>(found - state.name.begin());
    if (at >= state.position.size()) continue;
    if (!std::isfinite(state.position[at])) {
      throw std::runtime_error{reader_.name() + " says that " + joints_[i] +
                               " stands at a position that is not finite"};
    }
    q_[i] = state.position[at];
    heard_s_[i] = now_s;
    ours = true;
  }
  if (!ours) return;
  stamp_s_ = state.header.stamp == messages::Time{} ? std::nullopt : std::optional{state.header.stamp.seconds()};
  bool moved = still_q_.empty();
  for (std::size_t i = 0; i < still_q_.size(); ++i) moved = moved || std::abs(q_[i] - still_q_[i]) > kStill;
  if (!moved) return;
  still_q_ = q_;
  still_since_s_ = now_s;
}

double ArmStates::age_s() const { return devices::now_s() - *std::min_element(heard_s_.begin(), heard_s_.end()); }

double ArmStates::still_s() const { return devices::now_s() - still_since_s_; }

std::string ArmStates::silence() const {
  std::string missing;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (!std::isfinite(heard_s_[i])) missing += (missing.empty() ? "" : ", ") + joints_[i];
  }
  const bool none = std::none_of(heard_s_.begin(), heard_s_.end(), [](double s) { return std::isfinite(s); });
  if (none) return "no positions of the arm's joints come on " + reader_.name() + "; " + reader_.publishers();
  if (!missing.empty()) return reader_.name() + " does not tell the positions of " + missing;
  return reader_.name() + " has been silent for " + std::to_string(static_cast<int>(1e3 * age_s())) + " ms; " +
         reader_.publishers();
}

}  // namespace saccade::ros2
