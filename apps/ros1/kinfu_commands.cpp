// SPDX-License-Identifier: Apache-2.0
#include "kinfu_commands.hpp"

#include <std_msgs/String.h>

#include "kinfu_messages.hpp"

using kinfu_msgs::KinfuCommand;
using namespace saccade::ros1;

namespace {

bool holds(const KinfuCommand& command) { return ros::Time::now() <= command.hint_expiration_time; }

/// Clears a region if there are enough numbers for it; returns an error text.
template <class MakeRegion>
std::string clear(KinfuMap& map, const KinfuCommand& command, std::size_t numbers, const MakeRegion& make) {
  if (command.float_data.size() < numbers) {
    return "it needs " + std::to_string(numbers) + " numbers, not " + std::to_string(command.float_data.size());
  }
  const bool to_empty = !command.boolean_data.empty() && command.boolean_data[0];
  return map.clear(make(command.float_data), to_empty);
}

std::array<double, 3> three(const std::vector<float>& numbers, std::size_t first) {
  return {numbers[first], numbers[first + 1], numbers[first + 2]};
}

}  // namespace

KinfuCommands::KinfuCommands(ros::NodeHandle node, KinfuMap& map, const std::string& topic,
                             const std::string& ack_topic, bool running, bool forced_tf, std::function<void()> on_reset)
    : map_{map},
      on_reset_{std::move(on_reset)},
      acks_{node.advertise<std_msgs::String>(ack_topic, 100)},
      running_{running},
      forced_tf_{forced_tf},
      subscriber_{node.subscribe<KinfuCommand>(
          topic, 100, [this](const KinfuCommand::ConstPtr& command) { on_command(*command); })} {}

void KinfuCommands::acknowledge(const std::string& id, bool ok) {
  std_msgs::String ack;
  ack.data = id + (ok ? ":OK" : ":NO");
  acks_.publish(ack);
}

void KinfuCommands::take_hint(const KinfuCommand& command) {
  if (!holds(command)) return;
  const std::scoped_lock lock{mutex_};
  hint_ = command;
}

bool KinfuCommands::trigger(const std::string& id) {
  const std::scoped_lock lock{mutex_};
  if (running_ || trigger_) return false;
  trigger_ = id;
  return true;
}

void KinfuCommands::on_command(const KinfuCommand& command) {
  std::string error;
  const bool has_switch = !command.boolean_data.empty();
  if (command.command_type != KinfuCommand::COMMAND_TYPE_RESET) take_hint(command);
  switch (command.command_type) {
    case KinfuCommand::COMMAND_TYPE_NOOP: break;
    case KinfuCommand::COMMAND_TYPE_RESUME:
    case KinfuCommand::COMMAND_TYPE_SUSPEND: {
      const std::scoped_lock lock{mutex_};
      running_ = command.command_type == KinfuCommand::COMMAND_TYPE_RESUME;
      break;
    }
    case KinfuCommand::COMMAND_TYPE_RESET: {
      const bool hinted = holds(command);
      error = map_.reset(hinted ? std::optional{hint_of(command)} : std::nullopt);
      if (error.empty()) on_reset_();
      if (hinted && command.hint_forced) take_hint(command);
      break;
    }
    case KinfuCommand::COMMAND_TYPE_SET_ENABLED_MIN_MOVEMENT:
      if (!has_switch) error = "it needs boolean_data";
      if (has_switch) map_.set_minimum_motion(command.boolean_data[0]);
      break;
    case KinfuCommand::COMMAND_TYPE_SET_FORCED_TF_FRAMES: {
      if (!has_switch) error = "it needs boolean_data";
      const std::scoped_lock lock{mutex_};
      if (has_switch) forced_tf_ = command.boolean_data[0];
      if (has_switch && forced_tf_) hint_.reset();
      break;
    }
    case KinfuCommand::COMMAND_TYPE_CLEAR_SPHERE:
      error = clear(map_, command, 4, [](const auto& n) { return PlainSphere{three(n, 0), n[3]}; });
      break;
    case KinfuCommand::COMMAND_TYPE_CLEAR_BOUNDING_BOX:
      error = clear(map_, command, 6, [](const auto& n) { return PlainBox{three(n, 0), three(n, 3)}; });
      break;
    case KinfuCommand::COMMAND_TYPE_CLEAR_CYLINDER:
      error = clear(map_, command, 7, [](const auto& n) { return PlainCylinder{three(n, 0), three(n, 3), n[6]}; });
      break;
    case KinfuCommand::COMMAND_TYPE_TRIGGER:
      if (trigger(command.command_id)) return;  // acknowledged after the frame
      error = "frames are fused anyway, or one is waited for already";
      break;
    default: error = "there is no such command"; break;
  }
  if (!error.empty())
    ROS_WARN("command '%s' of type %u is refused: %s", command.command_id.c_str(), command.command_type, error.c_str());
  acknowledge(command.command_id, error.empty());
}

KinfuCommands::Turn KinfuCommands::next_turn() {
  const std::scoped_lock lock{mutex_};
  Turn turn;
  turn.wanted = running_ || trigger_;
  turn.forced_tf = forced_tf_;
  if (!turn.wanted || forced_tf_ || !hint_) return turn;
  if (holds(*hint_)) {
    turn.hint = hint_->hint_forced ? Hint::forced : Hint::start;
    turn.pose = hint_of(*hint_);
  }
  hint_.reset();
  return turn;
}

void KinfuCommands::frame_done(bool ok) {
  std::optional<std::string> id;
  {
    const std::scoped_lock lock{mutex_};
    id.swap(trigger_);
  }
  if (id) acknowledge(*id, ok);
}
