// SPDX-License-Identifier: Apache-2.0
// The camera of a ROS robot for Saccade (docs/guides/processes.md).
//
//   saccade-ros1 camera TOPIC [--info TOPIC] [--color TOPIC] [--rectified yes|no] [--min-range M] [--max-range M]
//                       [--reference FRAME [--frame FRAME]] [--skip N] [--timeout S] [--times yes]
//
// TOPIC has sensor_msgs/Image with depth, or is the name above it (image_raw, image_rect_raw, image_rect or image are
// looked for below); --info is camera_info beside it. --rectified: whether the lens' distortion is out of the images
// already; by default, where the topic's name has "rect" in it. With --reference, frames are answered with where TF
// has the camera's frame at the image's time. A frame is one whose stamp is later than the request, --skip of which are
// passed over (0); where stamps do not follow ROS's clock, one that comes after --skip others (2). --times writes what
// each frame costs to standard error.
#include "../../devices/camera_program.hpp"

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <iostream>
#include <mutex>
#include <thread>

#include "connection.hpp"
#include "depth_message.hpp"
#include "lens.hpp"
#include "subcommands.hpp"

namespace saccade::ros1 {
namespace {

using devices::now_s;

constexpr double kTogether_s{0.05};  ///< between depth and its colour

/// Image, and its time of arrival.
struct Received {
  sensor_msgs::ImageConstPtr image;
  double at_s{0.0};  ///< on this machine's steady clock
  ros::Time at{};    ///< on ROS's clock

  /// Tells whether the stamp can be compared with ROS's clock.
  [[nodiscard]] bool follows_clock() const {
    const double old_s = (at - image->header.stamp).toSec();
    return !image->header.stamp.isZero() && !at.isZero() && old_s > -0.05 && old_s < 1.0;
  }
};

/// Latest images of one topic.
class Images {
 public:
  void subscribe(ros::NodeHandle& node, const std::string& topic) {
    topic_ = topic;
    subscriber_.shutdown();  // two at a time would share a registration
    subscriber_ = node.subscribe<sensor_msgs::Image>(topic, 2, &Images::take, this, ros::TransportHints{}.tcpNoDelay());
  }
  [[nodiscard]] std::size_t count() const {
    const std::lock_guard lock{mutex_};
    return count_;
  }
  /// Calls look(image) for each image after the first `count`, in order, until it returns true or the time is up;
  /// updates count.
  template <class Look>
  [[nodiscard]] std::optional<Received> next(std::size_t& count, double until_s, const Look& look) const {
    std::unique_lock lock{mutex_};
    for (;;) {
      const std::size_t fresh = std::min(count_ - std::min(count, count_), last_.size());
      for (std::size_t i = last_.size() - fresh; i < last_.size(); ++i) {
        if (look(last_[i])) return last_[i];
      }
      count = count_;
      const double left_s = until_s - now_s();
      if (left_s <= 0.0) return std::nullopt;
      came_.wait_for(lock, std::chrono::duration<double>{std::min(left_s, 0.2)}, [&] { return count_ > count; });
    }
  }
  /// Describes for an error that no image came, and when the last one did.
  [[nodiscard]] std::string silence(double waited_s) const {
    const std::lock_guard lock{mutex_};
    std::string text = "no image came on " + topic_ + " for " + seconds_text(waited_s) + " s; ";
    text +=
        last_.empty() ? "none ever came" : "the last one came " + seconds_text(now_s() - last_.back().at_s) + " s ago";
    const unsigned publishers = subscriber_.getNumPublishers();
    if (publishers == 0) return text + ", and no node publishes it now";
    return text + ", and " + std::to_string(publishers) + (publishers == 1 ? " node publishes" : " nodes publish") +
           " it";
  }
  [[nodiscard]] const std::string& topic() const { return topic_; }

 private:
  void take(const sensor_msgs::ImageConstPtr& image) {
    const Received received{image, now_s(), ros::Time::now()};
    const std::lock_guard lock{mutex_};
    last_.push_back(received);
    if (last_.size() > 4) last_.pop_front();
    ++count_;
    came_.notify_all();
  }

  std::string topic_;
  mutable std::mutex mutex_;
  mutable std::condition_variable came_;
  std::deque<Received> last_;
  std::size_t count_{0};
  ros::Subscriber subscriber_;  ///< last member, so that it ends first
};

/// Returns the topic of images that a name means.
std::string find_topic(const std::string& name, double wait_s) {
  const std::string full = ros::names::resolve(name);
  std::vector<std::string> there;
  for (const double until_s = now_s() + wait_s;; std::this_thread::sleep_for(std::chrono::milliseconds{50})) {
    there = topics_of_type("sensor_msgs/Image");
    for (const char* below : {"", "/image_raw", "/image_rect_raw", "/image_rect", "/image"}) {
      if (std::binary_search(there.begin(), there.end(), full + below)) return full + below;
    }
    if (now_s() > until_s) break;
  }
  throw std::runtime_error{"no node publishes images on " + full +
                           ", or image_raw, image_rect_raw, image_rect or image "
                           "below it; topics with images: " +
                           listed(there)};
}

CalibratedCamera calibrated(const sensor_msgs::CameraInfo& info) {
  CalibratedCamera camera{
      static_cast<int>(info.width), static_cast<int>(info.height), info.distortion_model, info.D, {}, {}};
  std::copy(info.K.begin(), info.K.end(), camera.K.begin());
  std::copy(info.P.begin(), info.P.end(), camera.P.begin());
  return camera;
}

sensor_msgs::CameraInfo wait_for_info(ros::NodeHandle& node, const std::string& topic, double wait_s) {
  std::mutex mutex;
  std::condition_variable came;
  sensor_msgs::CameraInfoConstPtr info;
  const boost::function<void(const sensor_msgs::CameraInfoConstPtr&)> take = [&](const auto& message) {
    const std::lock_guard lock{mutex};
    info = message;
    came.notify_all();
  };
  const ros::Subscriber subscriber = node.subscribe<sensor_msgs::CameraInfo>(topic, 1, take);
  std::unique_lock lock{mutex};
  if (!came.wait_for(lock, std::chrono::duration<double>{wait_s}, [&] { return info != nullptr; })) {
    lock.unlock();
    throw std::runtime_error{"no camera_info came on " + topic + " for " + seconds_text(wait_s) +
                             " s; topics with camera_info: " + listed(topics_of_type("sensor_msgs/CameraInfo")) +
                             "; name one by --info (info: in a cell)"};
  }
  const sensor_msgs::CameraInfo found = *info;
  lock.unlock();
  if (found.binning_x > 1 || found.binning_y > 1 || (found.roi.width != 0 && found.roi.width != found.width)) {
    throw std::runtime_error{topic +
                             " describes a part of the sensor (binning, region of interest), which is not "
                             "understood; publish whole images, or their own camera_info"};
  }
  return found;
}

nlohmann::json matrix_of(const geometry_msgs::TransformStamped& transform) {
  const auto& q = transform.transform.rotation;
  const auto& t = transform.transform.translation;
  return {{1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y - q.z * q.w), 2 * (q.x * q.z + q.y * q.w), t.x},
          {2 * (q.x * q.y + q.z * q.w), 1 - 2 * (q.x * q.x + q.z * q.z), 2 * (q.y * q.z - q.x * q.w), t.y},
          {2 * (q.x * q.z - q.y * q.w), 2 * (q.y * q.z + q.x * q.w), 1 - 2 * (q.x * q.x + q.y * q.y), t.z},
          {0, 0, 0, 1}};
}

class RosCamera final : public devices::DeviceCamera {
 public:
  explicit RosCamera(const devices::Options& options)
      : timeout_s_{options.number("--timeout", 5.0)},
        skip_{options.has("--skip") ? std::optional{options.number("--skip", 0.0)} : std::nullopt},
        min_range_m_{options.number("--min-range", 0.4)},
        max_range_m_{options.number("--max-range", 4.5)},
        reference_{options.text("--reference")},
        frame_{options.text("--frame")},
        times_{options.has("--times")},
        connection_{timeout_s_} {
    topic_ = find_topic(options.text(""), timeout_s_);
    color_topic_ = options.text("--color");
    const std::string folder = topic_.substr(0, topic_.rfind('/'));
    info_topic_ = ros::names::resolve(options.text("--info", folder + "/camera_info"));
    subscribe();
    info_ = calibrated(wait_for_info(connection_.node(), info_topic_, timeout_s_));
    const bool named_rectified = topic_.find("rect", topic_.rfind('/')) != std::string::npos;
    lens_.emplace(info_, options.text("--rectified", named_rectified ? "yes" : "no") == "yes");
  }

  [[nodiscard]] nlohmann::json hello() const override {
    return devices::camera_hello(info_.width, info_.height, lens_->fx(), lens_->fy(), lens_->cx(), lens_->cy(),
                                 min_range_m_, max_range_m_, "float32_m", color_topic_.empty() ? "none" : "rgb8");
  }

  [[nodiscard]] devices::Shot capture(const nlohmann::json& /*T_world_camera*/) override {
    const double asked_s = now_s();
    const Received depth = frame_after(asked_s, ros::Time::now());
    const double taken_s = now_s();
    const sensor_msgs::Image& image = *depth.image;
    const std::string refused = to_metres({image.width, image.height, image.encoding, image.is_bigendian != 0,
                                           image.step, image.data.data(), image.data.size()},
                                          metres_);
    if (!refused.empty()) throw std::runtime_error{"an image on " + depth_.topic() + " is wrong: " + refused};
    check_size(image, depth_.topic());
    lens_->undistort(metres_);
    devices::Shot shot{{reinterpret_cast<const char*>(metres_.data()), metres_.size() * sizeof(float)}};
    if (!color_topic_.empty()) shot.bytes += color_of(image);
    if (!image.header.stamp.isZero()) shot.time_s = image.header.stamp.toSec();
    if (!reference_.empty()) {
      const std::string& frame = frame_.empty() ? image.header.frame_id : frame_;
      shot.T_world_camera = matrix_of(transforms_->need(reference_, frame, image.header.stamp, 1.0));
    }
    if (times_) {
      std::cerr << "times: " << 1e3 * (taken_s - depth.at_s) << " ms to wake, " << 1e3 * (now_s() - taken_s)
                << " ms to convert; came at " << std::to_string(depth.at_s) << '\n';
    }
    return shot;
  }

  void idle() override {
    if (connection_.forgotten()) subscribe();
  }

 private:
  void subscribe() {
    depth_.subscribe(connection_.node(), topic_);
    if (!color_topic_.empty()) color_.subscribe(connection_.node(), color_topic_);
    if (reference_.empty()) return;
    if (transforms_) return transforms_->renew();
    transforms_.emplace();
  }

  /// Returns the first image taken after the request.
  [[nodiscard]] Received frame_after(double asked_s, ros::Time asked) {
    std::size_t passed = 0;
    const auto shows = [&](const Received& received) {
      const bool follows = received.follows_clock();
      if (!follows) warn_of_clocks(received);
      if (follows && received.image->header.stamp < asked) return false;
      return static_cast<double>(passed++) >= skip_.value_or(follows ? 0.0 : 2.0);
    };
    std::size_t seen = depth_.count();
    for (double until_s = asked_s + timeout_s_; now_s() < until_s; idle()) {
      if (auto found = depth_.next(seen, std::min(until_s, now_s() + 1.0), shows)) return *found;
      if (!ros::ok()) break;
    }
    throw std::runtime_error{depth_.silence(now_s() - asked_s)};
  }

  void warn_of_clocks(const Received& received) {
    if (warned_) return;
    warned_ = true;
    const ros::Time stamp = received.image->header.stamp;
    std::cerr << "stamps of " << depth_.topic() << " are "
              << (stamp.isZero() ? "zero" : seconds_text((received.at - stamp).toSec()) + " s behind ROS's clock")
              << ": frames are taken by when they come, and two are passed over (--skip)\n";
  }

  void check_size(const sensor_msgs::Image& image, const std::string& topic) const {
    if (static_cast<int>(image.width) == info_.width && static_cast<int>(image.height) == info_.height) return;
    throw std::runtime_error{"images of " + topic + " have " + std::to_string(image.width) + " x " +
                             std::to_string(image.height) + " pixels, and " + info_topic_ + " says " +
                             std::to_string(info_.width) + " x " + std::to_string(info_.height)};
  }

  [[nodiscard]] std::string color_of(const sensor_msgs::Image& depth) const {
    const auto belongs = [&](const Received& color) {
      return std::abs((color.image->header.stamp - depth.header.stamp).toSec()) <= kTogether_s;
    };
    std::size_t recent = color_.count() - std::min<std::size_t>(color_.count(), 4);
    const auto found = color_.next(recent, now_s() + 1.0, belongs);
    if (!found) throw std::runtime_error{"no image on " + color_.topic() + " has a stamp within 0.05 s of the depth's"};
    const sensor_msgs::Image& image = *found->image;
    check_size(image, color_.topic());
    const bool bgr = image.encoding == "bgr8";
    const std::size_t row = 3 * std::size_t{image.width};
    if ((!bgr && image.encoding != "rgb8") || image.step < row ||
        image.data.size() < std::size_t{image.step} * (image.height - 1) + row) {
      throw std::runtime_error{"an image on " + color_.topic() + " has the encoding '" + image.encoding + "' and " +
                               std::to_string(image.data.size()) +
                               " bytes; whole images in rgb8 or bgr8 are understood"};
    }
    std::string rgb(row * image.height, '\0');
    for (std::size_t v = 0; v < image.height; ++v) std::memcpy(&rgb[v * row], &image.data[v * image.step], row);
    for (std::size_t i = 0; bgr && i < rgb.size(); i += 3) std::swap(rgb[i], rgb[i + 2]);
    lens_->undistort(rgb);
    return rgb;
  }

  double timeout_s_;
  std::optional<double> skip_;
  double min_range_m_, max_range_m_;
  std::string reference_, frame_;
  bool times_;
  Connection connection_;
  std::string topic_, color_topic_, info_topic_;
  CalibratedCamera info_;
  std::optional<Lens> lens_;
  std::optional<Transforms> transforms_;
  Images depth_, color_;
  std::vector<float> metres_;
  bool warned_{false};
};

}  // namespace
}  // namespace saccade::ros1

int run_camera_device(int argc, char** argv) {
  using namespace saccade;
  ros1::begin_node(argc, argv, "saccade_camera");
  const devices::Options options{argc, argv};
  options.only({"", "--info", "--color", "--rectified", "--min-range", "--max-range", "--reference", "--frame",
                "--skip", "--timeout", "--times"});
  if (options.text("").empty()) throw std::runtime_error{"name the topic of depth images"};
  return devices::run_camera([&options] { return std::make_unique<ros1::RosCamera>(options); });
}
