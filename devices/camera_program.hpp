// SPDX-License-Identifier: Apache-2.0
#pragma once
// Program of a camera (docs/guides/processes.md): DeviceCamera, which a device implements. run_camera, which answers
// requests with it.

#include <functional>
#include <memory>

#include "protocol.hpp"

namespace saccade::devices {

/// Frame in the form of an answer.
struct Shot {
  std::string bytes;                               ///< depth row by row, followed by all colour
  std::optional<nlohmann::json> T_world_camera{};  ///< pose of the camera, if it knows it
  std::optional<double> time_s{};
};

/// Camera of a device. Its functions throw error texts for the user.
class DeviceCamera {
 public:
  DeviceCamera() = default;
  DeviceCamera(const DeviceCamera&) = delete;
  DeviceCamera& operator=(const DeviceCamera&) = delete;
  virtual ~DeviceCamera() = default;

  /// Returns the keys of the answer to hello, without "saccade".
  [[nodiscard]] virtual nlohmann::json hello() const = 0;
  /// Captures a frame taken after the call.
  [[nodiscard]] virtual Shot capture(const nlohmann::json& T_world_camera) = 0;
  /// Returns how long to wait for requests before the next idle().
  [[nodiscard]] virtual std::chrono::milliseconds patience() const { return std::chrono::milliseconds{200}; }
  /// Called repeatedly while there is no request. The next capture must report errors that occur here.
  virtual void idle() {}
};

/// Returns a camera's answer to hello.
inline nlohmann::json camera_hello(int width, int height, double fx, double fy, double cx, double cy,
                                   double min_range_m, double max_range_m, const char* depth, const char* color) {
  return {{"width", width},
          {"height", height},
          {"fx", fx},
          {"fy", fy},
          {"cx", cx},
          {"cy", cy},
          {"min_range_m", min_range_m},
          {"max_range_m", max_range_m},
          {"depth", depth},
          {"color", color}};
}

/// Answers requests until Saccade is done. Opens the camera at hello, so that errors can be reported. Returns the exit
/// status.
inline int run_camera(const std::function<std::unique_ptr<DeviceCamera>()>& open) {
  keep_output_for_answers();
  LineInput input;
  std::unique_ptr<DeviceCamera> camera;
  while (!input.ended()) {
    try {
      const auto request = input.next(camera ? camera->patience() : std::chrono::milliseconds{200});
      if (!request) {
        if (camera) camera->idle();
        continue;
      }
      const std::string kind = request->value("request", "");
      if (kind == "hello") {
        if (!camera) camera = open();
        nlohmann::json answer = camera->hello();
        answer["saccade"] = 1;
        say(answer);
      } else if (kind == "capture" && camera) {
        const Shot shot = camera->capture(request->at("T_world_camera"));
        nlohmann::json answer{{"number", request->at("number")}, {"bytes", shot.bytes.size()}};
        if (shot.T_world_camera) answer["T_world_camera"] = *shot.T_world_camera;
        if (shot.time_s) answer["time_s"] = *shot.time_s;
        say(answer, shot.bytes);
      } else {
        say({{"error", "unknown request " + kind}});
      }
    } catch (const std::exception& e) {
      say({{"error", e.what()}});
    }
  }
  return 0;
}

}  // namespace saccade::devices
