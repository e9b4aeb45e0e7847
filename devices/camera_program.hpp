// SPDX-License-Identifier: Apache-2.0
#pragma once
// The program of a camera (docs/processes.md): DeviceCamera, which a device implements; run_camera, which answers for
// it.

#include <functional>
#include <memory>

#include "protocol.hpp"

namespace saccade::devices {

/// A frame as it is answered.
struct Shot {
  std::string bytes;                               ///< depth row by row, and after all of it colour
  std::optional<nlohmann::json> T_world_camera{};  ///< where the camera is, if it knows
  std::optional<double> time_s{};
};

/// Its functions throw what is wrong, in words for the user.
class DeviceCamera {
 public:
  DeviceCamera() = default;
  DeviceCamera(const DeviceCamera&) = delete;
  DeviceCamera& operator=(const DeviceCamera&) = delete;
  virtual ~DeviceCamera() = default;

  /// The keys of the answer to hello, without "saccade".
  [[nodiscard]] virtual nlohmann::json hello() const = 0;
  /// A frame that shows what is seen after the call.
  [[nodiscard]] virtual Shot capture(const nlohmann::json& T_world_camera) = 0;
  /// Returns how long requests are waited for before the next idle().
  [[nodiscard]] virtual std::chrono::milliseconds patience() const { return std::chrono::milliseconds{200}; }
  /// Called again and again while there is no request. What goes wrong here must be told by the next capture.
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

/// Answers requests until Saccade is done. The camera is opened when it is greeted, so that what is wrong with it can
/// be told. Returns the exit status.
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
