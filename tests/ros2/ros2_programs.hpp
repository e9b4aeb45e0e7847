// SPDX-License-Identifier: Apache-2.0
#pragma once
// saccade-ros2 under test: its command, and waiting for what comes over a topic.

#include <chrono>
#include <functional>
#include <string>
#include <thread>

#include "devices/device_programs.hpp"

namespace saccade::test {

inline std::string ros2_command(const std::string& arguments) { return device_command("ros2", "", arguments); }

inline bool eventually(const std::function<bool()>& met, int longest_ms = 5000) {
  for (int waited_ms = 0; !met() && waited_ms < longest_ms; waited_ms += 5) {
    std::this_thread::sleep_for(std::chrono::milliseconds{5});
  }
  return met();
}

}  // namespace saccade::test
