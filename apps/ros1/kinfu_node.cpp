// SPDX-License-Identifier: Apache-2.0
// The node kinfu: takes depth images and transforms, and answers questions about its map. A replacement for the thesis'
// node (docs/guides/ros.md).

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Empty.h>
#include <std_msgs/Header.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>

#include <condition_variable>
#include <thread>
#include <utility>

#include "depth_message.hpp"
#include "kinfu_commands.hpp"
#include "kinfu_messages.hpp"
#include "kinfu_parameters.hpp"
#include "shift_checker.hpp"
#include "subcommands.hpp"

using namespace saccade::ros1;

namespace {

constexpr double kSayEvery_s{10.0};
constexpr double kTransformWait_s{0.1};
constexpr std::chrono::milliseconds kViewPeriod{100};

/// Renders the camera's view of the map, beside the frames.
class CurrentView {
 public:
  CurrentView(ros::NodeHandle node, const KinfuMap& map, const std::string& topic)
      : map_{map}, publisher_{node.advertise<sensor_msgs::Image>(topic, 1)}, thread_{[this] { run(); }} {}
  ~CurrentView() {
    stop_ = true;
    wake_.notify_all();
    thread_.join();
  }
  void show(const PlainPose& pose, const AnswerHeader& header) {
    if (publisher_.getNumSubscribers() == 0) return;
    const std::scoped_lock lock{mutex_};
    pose_ = pose;
    header_ = header;
    wake_.notify_all();
  }

 private:
  void run() {
    std::unique_lock lock{mutex_};
    while (!stop_) {
      wake_.wait_for(lock, kViewPeriod, [this] { return pose_ || stop_; });
      if (stop_ || !pose_) continue;
      MapRequest request;
      request.question = Question::view;
      request.transformation = std::exchange(pose_, std::nullopt);
      const AnswerHeader header = header_;
      lock.unlock();
      const MapAnswer answer = map_.answer(request, stop_);
      if (answer.error.empty()) publisher_.publish(to_image(answer, header));
      std::this_thread::sleep_for(kViewPeriod);
      lock.lock();
    }
  }

  const KinfuMap& map_;
  ros::Publisher publisher_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<PlainPose> pose_;
  AnswerHeader header_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// The queue holds urgent work: images and the camera's description, on their own thread.
class KinfuNode {
 public:
  KinfuNode(ros::NodeHandle node, const KinfuParameters& parameters)
      : parameters_{parameters},
        map_{parameters.map},
        shift_{node, parameters.shift_checker, parameters.target_distance, parameters.shift_distance},
        listener_{buffer_, node},
        view_{node, map_, parameters.current_view_topic},
        commands_{node,
                  map_,
                  parameters.command_topic,
                  parameters.command_ack_topic,
                  parameters.autostart,
                  parameters.forced_tf,
                  [this] { shift_.reset(); }},
        requests_{node, map_, parameters.requests, [this] { shift_.reset(); }} {
    image_acks_ = node.advertise<std_msgs::Header>(parameters.image_ack_topic, 10);
    lost_ = node.advertise<std_msgs::Empty>(parameters.icp_lost_topic, 10);
    require_reset_ =
        node.subscribe<std_msgs::Empty>(parameters.require_reset_topic, 10, [this](const std_msgs::Empty::ConstPtr&) {
          map_.reset({});
          shift_.reset();
        });
    ros::NodeHandle frames{node};
    frames.setCallbackQueue(&frame_queue_);
    info_subscriber_ = frames.subscribe<sensor_msgs::CameraInfo>(
        parameters.info_topic, 2, [this](const sensor_msgs::CameraInfo::ConstPtr& info) {
          info_ = info;
          if (const auto early = std::exchange(early_image_, nullptr)) take(*early);
        });
    if (!parameters.color_topic.empty()) {
      color_subscriber_ = frames.subscribe<sensor_msgs::Image>(
          parameters.color_topic, 2, [this](const sensor_msgs::Image::ConstPtr& color) { color_ = color; });
    }
    depth_subscriber_ = frames.subscribe<sensor_msgs::Image>(
        parameters.depth_topic, 2, [this](const sensor_msgs::Image::ConstPtr& depth) { on_depth(depth); });
    spinner_ = std::make_unique<ros::AsyncSpinner>(1, &frame_queue_);
    spinner_->start();
  }
  ~KinfuNode() { spinner_->stop(); }

 private:
  void refuse(const std::string& why) { ROS_WARN_THROTTLE(kSayEvery_s, "an image cannot be used: %s", why.c_str()); }

  void on_depth(const sensor_msgs::Image::ConstPtr& image) {
    if (info_) return take(*image);
    // The first image may arrive before the first description; it then waits.
    if (std::exchange(early_image_, image)) refuse("no camera_info came on " + parameters_.info_topic);
  }

  void take(const sensor_msgs::Image& image) {
    const KinfuCommands::Turn turn = commands_.next_turn();
    if (!turn.wanted) return;
    const ros::WallTime begin = ros::WallTime::now();
    PlainFrame frame;
    if (!read(image, frame)) return;
    frame.hint = turn.hint;
    frame.pose = turn.pose;
    if (turn.forced_tf && !force_pose(image.header, frame)) return;
    const double conversion_ms = 1e3 * (ros::WallTime::now() - begin).toSec();
    const FrameOutcome outcome = map_.process(std::move(frame));
    if (!outcome.error.empty()) return refuse(outcome.error);
    ROS_DEBUG("frame: conversion %.2f ms, tracking %.1f ms, fusion %.1f ms", conversion_ms, outcome.track_ms,
              outcome.fuse_ms);
    report(image.header, outcome, turn.forced_tf);
    commands_.frame_done(!outcome.lost);
  }

  bool read(const sensor_msgs::Image& image, PlainFrame& frame) {
    if (info_->width != image.width || info_->height != image.height) {
      return refuse("it has " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                    " pixels, camera_info says " + std::to_string(info_->width) + " x " +
                    std::to_string(info_->height)),
             false;
    }
    const DepthMessage message{image.width, image.height,      image.encoding,   image.is_bigendian != 0,
                               image.step,  image.data.data(), image.data.size()};
    if (const std::string wrong = to_metres(message, frame.metres); !wrong.empty()) return refuse(wrong), false;
    frame.camera = {image.width, image.height, info_->K[0], info_->K[4], info_->K[2], info_->K[5]};
    if (color_ && color_->header.stamp == image.header.stamp) read_color(*color_, frame);
    return true;
  }

  void read_color(const sensor_msgs::Image& color, PlainFrame& frame) {
    const bool bgr = color.encoding == "bgr8";
    if ((!bgr && color.encoding != "rgb8") || color.width != frame.camera.width ||
        color.height != frame.camera.height || color.step < 3 * color.width ||
        color.data.size() < std::size_t{color.step} * color.height) {
      ROS_WARN_THROTTLE(kSayEvery_s,
                        "a colour image is not used: it must be rgb8 or bgr8, and as large as the depth image");
      return;
    }
    frame.rgb.resize(std::size_t{3} * color.width * color.height);
    for (std::size_t i = 0; i < frame.rgb.size(); ++i) {
      const std::size_t channel = i % 3;
      frame.rgb[i] =
          color.data[i / 3 / color.width * color.step + i / 3 % color.width * 3 + (bgr ? 2 - channel : channel)];
    }
  }

  /// Takes the frame's pose from TF; reports once where it is missing.
  bool force_pose(const std_msgs::Header& header, PlainFrame& frame) {
    const std::string current =
        parameters_.forced_current.empty() ? without_slash(header.frame_id) : parameters_.forced_current;
    std::string wrong;
    try {
      const geometry_msgs::Transform T =
          buffer_.lookupTransform(parameters_.forced_reference, current, header.stamp, ros::Duration{kTransformWait_s})
              .transform;
      geometry_msgs::Pose pose;
      pose.position.x = T.translation.x;
      pose.position.y = T.translation.y;
      pose.position.z = T.translation.z;
      pose.orientation = T.rotation;
      frame.pose = to_plain(pose);
      frame.hint = Hint::forced;
      if (!std::isfinite(frame.pose.linear[0] + frame.pose.translation[0] + frame.pose.translation[1] +
                         frame.pose.translation[2]))
        wrong = "it is not finite";
    } catch (const tf2::TransformException& error) {
      wrong = error.what();
    }
    if (wrong.empty()) {
      if (transform_missing_)
        ROS_INFO("the transform from %s to %s is there again", current.c_str(), parameters_.forced_reference.c_str());
      transform_missing_ = false;
      return true;
    }
    if (!transform_missing_)
      ROS_ERROR("no pose for an image: the transform from %s to %s: %s; images are passed over until it is there",
                current.c_str(), parameters_.forced_reference.c_str(), wrong.c_str());
    transform_missing_ = true;
    return false;
  }

  void report(const std_msgs::Header& header, const FrameOutcome& outcome, bool forced_tf) {
    image_acks_.publish(header);
    if (outcome.forgotten_mb > 0.0)
      ROS_WARN("the map had more than %.0f MB: %.0f MB outside the volume are forgotten",
               parameters_.map.memory_limit_mb, outcome.forgotten_mb);
    if (outcome.lost) {
      ROS_WARN_THROTTLE(kSayEvery_s, "tracking is lost: %s", outcome.why.c_str());
      lost_.publish(std_msgs::Empty{});
      return;
    }
    if (const auto center = shift_.follow(outcome.pose)) map_.set_volume_center(*center);
    geometry_msgs::TransformStamped T;
    T.header.stamp = header.stamp;
    T.header.frame_id = parameters_.first_frame;
    T.child_frame_id = parameters_.current_frame;
    const geometry_msgs::Pose pose = to_message(outcome.pose);
    T.transform.translation.x = pose.position.x;
    T.transform.translation.y = pose.position.y;
    T.transform.translation.z = pose.position.z;
    T.transform.rotation = pose.orientation;
    if (!(forced_tf && parameters_.forced_current == parameters_.current_frame)) broadcaster_.sendTransform(T);
    view_.show(outcome.pose, {parameters_.first_frame, header.stamp});
  }

  KinfuParameters parameters_;
  KinfuMap map_;
  ShiftChecker shift_;
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
  tf2_ros::TransformBroadcaster broadcaster_;
  CurrentView view_;
  KinfuCommands commands_;
  KinfuRequests requests_;
  ros::CallbackQueue frame_queue_;
  ros::Publisher image_acks_, lost_;
  ros::Subscriber info_subscriber_, color_subscriber_, depth_subscriber_, require_reset_;
  sensor_msgs::CameraInfo::ConstPtr info_;
  sensor_msgs::Image::ConstPtr early_image_;  ///< came before any camera_info
  sensor_msgs::Image::ConstPtr color_;
  bool transform_missing_{false};
  std::unique_ptr<ros::AsyncSpinner> spinner_;
};

}  // namespace

int run_kinfu(int argc, char** argv) {
  ros::init(argc, argv, "kinfu");
  ros::NodeHandle node{"~"};
  KinfuNode kinfu{node, KinfuParameters::read(node)};
  ros::spin();
  return 0;
}
