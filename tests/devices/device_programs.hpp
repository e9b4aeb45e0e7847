// SPDX-License-Identifier: Apache-2.0
#pragma once
// Programs of devices under test: their commands, cameras started from them, and clocks that pictures show.

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>

#include "saccade/devices/programs.hpp"
#include "support/places.hpp"
#include "support/temp_folder.hpp"

namespace saccade::test {

namespace fs = std::filesystem;

inline std::string quoted(const fs::path& path) { return "'" + path.string() + "'"; }

/// The command of saccade-NAME, with variables of its environment before and options after it.
inline std::string device_command(const std::string& name, const std::string& environment, const std::string& options) {
  return (environment.empty() ? "" : "env " + environment + " ") + quoted(device_program(name)) + " " + options;
}

/// Starts a camera that must answer; its error fails the test.
inline std::optional<ProgramCamera> started(const std::string& command) {
  auto camera = ProgramCamera::start({command});
  if (camera) return std::move(*camera);
  ADD_FAILURE() << camera.error().to_string();
  return std::nullopt;
}

/// Returns the error of a camera that cannot be started.
inline std::string refusal(const std::string& command) {
  const auto camera = ProgramCamera::start({command});
  return camera ? "it started" : camera.error().to_string();
}

/// What is built for these tests, beside them.
inline fs::path openni2_driver() {
  return fs::path{saccade_program()}.parent_path() / "tests/devices/libopenni2_driver.so";
}
inline fs::path openni2_recorder() {
  return fs::path{saccade_program()}.parent_path() / "tests/devices/openni2_recorder";
}
inline fs::path kinect1_stub() {
  return fs::path{saccade_program()}.parent_path() / "tests/devices/libkinect1_stub.so";
}

/// Milliseconds of the clock that programs of a machine share.
inline long clock_ms() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// Milliseconds from a moment to the one that a pixel shows as 1000 + its milliseconds, modulo 2000; −1000 to 999.
inline long shown_after_ms(long moment_ms, float depth_m) {
  const long shown = std::lround(depth_m * 1000.0F) - 1000;
  return (shown - moment_ms % 2000 + 5000) % 2000 - 1000;
}

}  // namespace saccade::test
