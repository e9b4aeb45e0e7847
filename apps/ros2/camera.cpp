// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "commands.hpp"
#include "depth_message.hpp"
#include "node.hpp"

namespace saccade::ros2 {
namespace {

using devices::Options;
using devices::Shot;
using messages::CameraInfo;
using messages::Image;

constexpr int kDepth{5};             // largest number of waiting images
constexpr double kSameClock_s{2.0};  // stamps that differ by more belong to another clock, as in simulations
constexpr double kImagePatience_s{0.02};

/// Returns seconds since 1970, the clock of nodes.
double ros_now_s() {
  return std::chrono::duration<double>{std::chrono::system_clock::now().time_since_epoch()}.count();
}

std::string info_topic_of(const std::string& topic) { return topic.substr(0, topic.rfind('/') + 1) + "camera_info"; }

class TopicCamera final : public devices::DeviceCamera {
 public:
  explicit TopicCamera(const Options& options)
      : min_range_m_{options.number("--min-range", 0.4)},
        max_range_m_{options.number("--max-range", 4.5)},
        skip_{options.has("--skip") ? std::optional{static_cast<int>(options.number("--skip", 2.0))} : std::nullopt},
        timeout_s_{options.number("--timeout", 3.0)},
        images_{node_, options.text(""), options.has("--reliable") ? Delivery::reliable : Delivery::best_effort,
                kDepth} {
    const double wait_s = options.number("--wait", 10.0);
    first_ = awaited_image(wait_s);
    depth_ = depth_format(first_);
    static_cast<void>(depth_bytes(first_));
    const std::string info_topic = options.text("--info", info_topic_of(options.text("")));
    Reader<CameraInfo> infos{node_, info_topic, Delivery::best_effort, 1};
    std::vector<CameraInfo> came;
    for (const double began_s = devices::now_s(); came.empty(); came = infos.wait(kImagePatience_s)) {
      if (devices::now_s() - began_s < wait_s) continue;
      throw std::runtime_error{"no camera info came on " + info_topic + " in " + seconds(wait_s) + "; " +
                               infos.publishers() + ". --info names another topic"};
    }
    intrinsics_ = intrinsics_of(came.back(), first_, options.has("--rectified"));
  }

  [[nodiscard]] nlohmann::json hello() const override {
    return devices::camera_hello(static_cast<int>(first_.width), static_cast<int>(first_.height), intrinsics_.fx,
                                 intrinsics_.fy, intrinsics_.cx, intrinsics_.cy, min_range_m_, max_range_m_, depth_,
                                 "none");
  }

  /// Returns the first image that was taken after the call.
  [[nodiscard]] Shot capture(const nlohmann::json& /*T_world_camera*/) override {
    const double asked_s = ros_now_s();
    idle();
    for (int passed = 0;; ++passed) {
      const Image image = awaited_image(timeout_s_);
      if (!taken_after(image, asked_s, passed)) continue;
      if (image.width != first_.width || image.height != first_.height) {
        throw std::runtime_error{images_.name() + " has images of " + std::to_string(image.width) + "x" +
                                 std::to_string(image.height) + " pixels now; they were " +
                                 std::to_string(first_.width) + "x" + std::to_string(first_.height) + " at first"};
      }
      if (depth_format(image) != depth_) throw std::runtime_error{images_.name() + " is " + image.encoding + " now"};
      return {depth_bytes(image), {}, has_stamp(image) ? image.header.stamp.seconds() : ros_now_s()};
    }
  }

  /// Drops images between requests.
  void idle() override {
    waiting_.clear();
    if (!images_.take().empty()) heard_s_ = devices::now_s();
  }
  [[nodiscard]] std::chrono::milliseconds patience() const override { return std::chrono::milliseconds{20}; }

 private:
  static std::string seconds(double s) { return nlohmann::json(s).dump() + " s"; }
  static bool has_stamp(const Image& image) { return image.header.stamp != messages::Time{}; }

  /// Tells whether an image was taken after the request: by its stamp, where it follows this machine's clock; otherwise
  /// after skipping a number of images.
  [[nodiscard]] bool taken_after(const Image& image, double asked_s, int passed) const {
    const double stamp_s = image.header.stamp.seconds();
    if (skip_ || std::abs(ros_now_s() - stamp_s) > kSameClock_s) return passed >= skip_.value_or(2);
    return stamp_s >= asked_s;
  }

  [[nodiscard]] Image awaited_image(double longest_s) {
    for (const double began_s = devices::now_s(); waiting_.empty();) {
      waiting_ = images_.wait(kImagePatience_s);
      if (waiting_.empty() && devices::now_s() - std::max(began_s, heard_s_) > longest_s) {
        throw std::runtime_error{"no image came on " + images_.name() + " in " + seconds(longest_s) + "; " +
                                 images_.publishers()};
      }
    }
    heard_s_ = devices::now_s();
    Image image = std::move(waiting_.front());
    waiting_.erase(waiting_.begin());
    return image;
  }

  double min_range_m_, max_range_m_;
  std::optional<int> skip_;  ///< nullopt: stamps decide, where possible
  double timeout_s_;
  Node node_;
  Reader<Image> images_;
  std::vector<Image> waiting_;
  double heard_s_{0.0};
  Image first_;
  const char* depth_{nullptr};
  Intrinsics intrinsics_{};
};

}  // namespace

int run_camera_command(const Options& options) {
  options.only(
      {"", "--info", "--rectified", "--min-range", "--max-range", "--skip", "--wait", "--timeout", "--reliable"});
  if (options.text("").empty())
    throw std::runtime_error{"which topic? saccade-ros2 camera /camera/depth/image_rect_raw"};
  return devices::run_camera([&] { return std::make_unique<TopicCamera>(options); });
}

}  // namespace saccade::ros2
