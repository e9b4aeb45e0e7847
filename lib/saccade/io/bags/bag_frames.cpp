// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "saccade/io/bags/bags.hpp"
#include "saccade/io/bags/internal/depth_message.hpp"
#include "saccade/io/bags/internal/tf_buffer.hpp"
#include "saccade/io/files/file_io.hpp"

namespace saccade {
namespace internal::io_bags {
namespace {

constexpr std::array<std::string_view, 2> kImageTypes{"sensor_msgs/Image", "sensor_msgs/CompressedImage"};
constexpr std::array<std::string_view, 1> kInfoTypes{"sensor_msgs/CameraInfo"};

double seconds_of(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

std::string shown_time(std::int64_t ns) {
  std::array<char, 40> text{};
  static_cast<void>(std::snprintf(text.data(), text.size(), "%.6f", seconds_of(ns)));
  return text.data();
}

std::optional<Pose> nearest_pose(const std::vector<PoseEntry>& poses, double time_s, double tolerance_s) {
  const PoseEntry* best = nullptr;
  for (const PoseEntry& pose : poses) {
    if (!pose.time_s || std::abs(*pose.time_s - time_s) > tolerance_s) continue;
    if (best == nullptr || std::abs(*pose.time_s - time_s) < std::abs(*best->time_s - time_s)) best = &pose;
  }
  if (best == nullptr || !best->T_world_camera) return std::nullopt;
  return *best->T_world_camera;
}

/// Camera poses from a file, or from TF.
struct BagPoses {
  std::vector<PoseEntry> listed;
  TfBuffer tf;
  std::string world;
  bool known{false};

  [[nodiscard]] Result<Pose> at(const ImageHead& head, std::size_t index, double tolerance_s) const {
    if (!listed.empty()) {
      if (listed.front().time_s) {
        const auto pose = nearest_pose(listed, seconds_of(head.stamp_ns), tolerance_s);
        if (pose) return *pose;
      } else if (index < listed.size()) {
        return listed[index].T_world_camera;
      }
      return Error{Errc::not_found, "has no pose in the file of poses", {}};
    }
    const auto pose = known ? tf.look_up(world, head.frame_id, head.stamp_ns) : std::nullopt;
    if (pose) return *pose;
    return Error{
        Errc::not_found,
        "TF does not say where " + head.frame_id + " is in " + world + " at " + shown_time(head.stamp_ns) + " s",
        {}};
  }
};

class BagFrames final : public RgbdFolderSource {
 public:
  BagFrames(std::unique_ptr<Bag> bag, ImageCorrection correction, RgbdFolderInfo info, BagPoses poses,
            std::vector<BagEntry> depth, std::vector<BagEntry> color, const RgbdFolderConfig& config)
      : bag_{std::move(bag)},
        correction_{std::move(correction)},
        info_{std::move(info)},
        poses_{std::move(poses)},
        depth_{std::move(depth)},
        color_{std::move(color)},
        color_stamps_(color_.size()),
        config_{config} {
    for (std::size_t i = config.first; i < depth_.size(); i += config.every_nth) {
      if (config.count && chosen_.size() >= *config.count) break;
      chosen_.push_back(i);
      if (depth_.size() - i <= config.every_nth) break;
    }
  }

  [[nodiscard]] const PinholeCamera& camera() const override { return correction_.camera(); }
  [[nodiscard]] std::optional<std::size_t> size() const override { return chosen_.size(); }
  [[nodiscard]] const RgbdFolderInfo& info() const override { return info_; }

  [[nodiscard]] Result<std::optional<Frame>> next() override {
    if (position_ == chosen_.size()) return std::optional<Frame>{};
    SACCADE_TRY(Frame frame, at(position_++));
    return std::optional{std::move(frame)};
  }

  [[nodiscard]] Result<Frame> at(std::size_t position) const override {
    SACCADE_EXPECTS(position < chosen_.size());
    auto frame = read(chosen_[position]);
    if (!frame) return of_frame(frame.error(), chosen_[position]);
    return frame;
  }

  [[nodiscard]] Result<Pose> pose_at(std::size_t position) const override {
    SACCADE_EXPECTS(position < chosen_.size());
    const std::size_t index = chosen_[position];
    SACCADE_TRY(const BagMessage message, bag_->read(depth_[index]));
    SACCADE_TRY(const ImageHead head, head_of(message));
    auto pose = poses_.at(head, index, config_.max_time_difference_s);
    if (!pose) return of_frame(pose.error(), index);
    return pose;
  }

 private:
  [[nodiscard]] Error of_frame(Error error, std::size_t index) const {
    const std::string name = "frame " + std::to_string(index) + " at " + shown_time(depth_[index].time_ns) + " s";
    error.context = error.context.empty() ? name : name + ", " + error.context;
    return error;
  }

  /// Uses the time of recording where drivers leave the stamp at 0.
  static Result<ImageHead> head_of(const BagMessage& message) {
    SACCADE_TRY(ImageHead head, read_image_head(message));
    if (head.stamp_ns == 0) head.stamp_ns = message.time_ns;
    return head;
  }

  [[nodiscard]] Result<Frame> read(std::size_t index) const {
    SACCADE_TRY(const BagMessage message, bag_->read(depth_[index]));
    SACCADE_TRY(const ImageHead head, head_of(message));
    Frame frame;
    frame.index = index;
    frame.name = shown_time(head.stamp_ns);
    frame.time_s = seconds_of(head.stamp_ns);
    const auto pose = poses_.at(head, index, config_.max_time_difference_s);
    if (pose) {
      frame.T_world_camera = *pose;
    } else if (config_.require_poses && info_.has_poses) {
      return pose.error();
    }
    SACCADE_TRY(DepthImage depth, read_depth_message(message, info_.encoding));
    SACCADE_TRY(frame.depth, correction_.apply(std::move(depth)));
    if (info_.has_color) SACCADE_CHECK(add_color(frame, head.stamp_ns, depth_[index].time_ns));
    return frame;
  }

  Status add_color(Frame& frame, std::int64_t stamp_ns, std::int64_t recorded_ns) const {
    // Largest difference of recording times within one frame.
    constexpr double kRecordedTogether_s{1.0};
    std::optional<std::size_t> best;
    double best_s = config_.max_time_difference_s;
    const double recorded_s = seconds_of(recorded_ns);
    auto first = std::ranges::lower_bound(color_, recorded_s - kRecordedTogether_s, {},
                                          [](const BagEntry& entry) { return seconds_of(entry.time_ns); });
    for (; first != color_.end() && seconds_of(first->time_ns) <= recorded_s + kRecordedTogether_s; ++first) {
      const auto i = static_cast<std::size_t>(first - color_.begin());
      if (!color_stamps_[i]) {
        const auto message = bag_->read(*first);
        const auto head = message ? head_of(*message) : Result<ImageHead>{message.error()};
        color_stamps_[i] = head ? head->stamp_ns : first->time_ns;
      }
      const double apart_s = std::abs(seconds_of(*color_stamps_[i]) - seconds_of(stamp_ns));
      if (apart_s > best_s || (best && apart_s == best_s)) continue;
      best_s = apart_s;
      best = i;
    }
    if (!best) return {};
    SACCADE_TRY(const BagMessage message, bag_->read(color_[*best]));
    SACCADE_TRY(ColorImage color, read_color_message(message));
    SACCADE_TRY(frame.color, correction_.apply(std::move(color)));
    return {};
  }

  std::unique_ptr<Bag> bag_;
  ImageCorrection correction_;
  RgbdFolderInfo info_;
  BagPoses poses_;
  std::vector<BagEntry> depth_;
  std::vector<BagEntry> color_;
  mutable std::vector<std::optional<std::int64_t>> color_stamps_;  ///< read as needed
  RgbdFolderConfig config_;
  std::vector<std::size_t> chosen_;
  std::size_t position_{0};
};

Error no_topic(const Bag& bag, const std::string& topic, std::span<const std::string_view> types) {
  return {Errc::not_found, "the bag has no topic " + topic + " of that kind; it has " + bag.list(types), {}};
}

Result<std::uint32_t> image_topic(const Bag& bag, const std::string& name) {
  const auto topic = bag.find(name);
  if (topic && is_image(bag.topics()[*topic])) return *topic;
  if (topic) {
    return Error{Errc::invalid_argument,
                 name + " is of type " + bag.topics()[*topic].type +
                     ", no image; the bag has these image topics: " + bag.list(kImageTypes),
                 {}};
  }
  return Error{
      Errc::not_found, "the bag has no topic " + name + "; it has these image topics: " + bag.list(kImageTypes), {}};
}

/// Returns the only topic of depth, judged by the encoding of its first image.
Result<std::uint32_t> only_depth_topic(Bag& bag) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < bag.topics().size(); ++i) {
    if (!is_image(bag.topics()[i])) continue;
    SACCADE_TRY(const auto entries, bag.entries({&i, 1}));
    if (entries.empty()) continue;
    const auto message = bag.read(entries.front());
    const auto head = message ? read_image_head(*message) : Result<ImageHead>{message.error()};
    if (head && is_depth_encoding(head->encoding)) found.push_back(i);
  }
  if (found.size() == 1) return found.front();
  const bool has_images = bag.list(kImageTypes) != "none";
  if (!has_images) return Error{Errc::not_found, "the bag has no image topics; it has: " + bag.list(), {}};
  return Error{Errc::invalid_argument,
               std::string{found.empty() ? "no topic is known for depth" : "several topics are of depth"} +
                   ": choose with --depth; the bag has these image topics: " + bag.list(kImageTypes),
               {}};
}

/// Returns the topic camera_info in the name space of the image, otherwise the only one.
Result<std::uint32_t> info_topic(const Bag& bag, const std::string& given, std::string image) {
  if (!given.empty()) {
    const auto topic = bag.find(given);
    return topic ? Result<std::uint32_t>{*topic} : no_topic(bag, given, kInfoTypes);
  }
  for (int up = 0; up < 2; ++up) {  // image_raw/compressedDepth has its camera_info beside image_raw
    const std::size_t slash = image.rfind('/');
    if (slash == std::string::npos) break;
    image.resize(slash);
    if (const auto topic = bag.find(image + "/camera_info")) return *topic;
  }
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < bag.topics().size(); ++i) {
    if (bag.topics()[i].type == kInfoTypes.front()) found.push_back(i);
  }
  if (found.size() == 1) return found.front();
  return Error{Errc::not_found,
               "there is no camera_info beside the depth topic: choose with --info, or pass --camera or --intrinsics; "
               "the bag has " +
                   bag.list(kInfoTypes),
               {}};
}

Result<Intrinsics> find_bag_intrinsics(Bag& bag, const BagFramesConfig& config, const std::string& image,
                                       std::string& from) {
  from = "given";
  if (config.reading.intrinsics) return *config.reading.intrinsics;
  SACCADE_TRY(const std::uint32_t topic, info_topic(bag, config.info, image));
  SACCADE_TRY(const auto entries, bag.entries({&topic, 1}));
  from = bag.topics()[topic].name;
  if (entries.empty()) return Error{Errc::not_found, "no message is in the topic " + from, {}};
  SACCADE_TRY(const BagMessage message, bag.read(entries.front()));
  if (message.type != kInfoTypes.front()) {
    return Error{Errc::invalid_argument, from + " is of type " + std::string{message.type} + ", no CameraInfo", {}};
  }
  const bool is_rectified = image.find("rect") != std::string::npos;
  return read_camera_info(message, is_rectified);
}

struct FirstImage {
  ImageHead head;
  int width{0};
  int height{0};
};

/// Returns the first readable image, which gives size and frame.
Result<FirstImage> first_image(Bag& bag, const std::vector<BagEntry>& entries, const DepthEncoding& encoding) {
  constexpr std::size_t kTries{100};
  std::optional<Error> first_error;
  for (std::size_t i = 0; i < std::min(entries.size(), kTries); ++i) {
    const auto message = bag.read(entries[i]);
    const auto depth = message ? read_depth_message(*message, encoding) : Result<DepthImage>{message.error()};
    if (depth) {
      SACCADE_TRY(ImageHead head, read_image_head(*message));
      return FirstImage{std::move(head), depth->width(), depth->height()};
    }
    if (!first_error) first_error = depth.error();
  }
  if (!first_error) return Error{Errc::not_found, "there is no message in the depth topic", {}};
  return Error{first_error->code, "no depth image can be read; the first: " + first_error->message, {}};
}

Result<BagPoses> find_bag_poses(Bag& bag, const BagFramesConfig& config, const std::string& camera_frame) {
  BagPoses poses;
  if (config.reading.poses_file) {
    SACCADE_TRY(poses.listed, read_pose_list(*config.reading.poses_file));
    if (poses.listed.empty()) return Error{Errc::not_found, "holds no pose", config.reading.poses_file->string()};
    poses.known = true;
    return poses;
  }
  SACCADE_TRY(poses.tf, TfBuffer::read(bag));
  const bool is_given = !config.world_frame.empty();
  poses.world = is_given ? std::string{frame_name(config.world_frame)} : poses.tf.root(camera_frame);
  if (is_given && !poses.tf.connects(poses.world, camera_frame)) {
    return Error{Errc::not_found,
                 std::string{poses.tf.knows(poses.world) ? "TF does not connect " : "TF knows no frame "} +
                     poses.world + (poses.tf.knows(poses.world) ? " with the camera's frame " + camera_frame : ""),
                 {}};
  }
  poses.known = is_given || poses.tf.moves(poses.world, camera_frame);
  return poses;
}

Result<std::unique_ptr<RgbdFolderSource>> open_frames(std::unique_ptr<Bag> bag, const BagFramesConfig& config) {
  SACCADE_CHECK(config.reading.validate());
  SACCADE_TRY(const std::uint32_t topic,
              config.depth.empty() ? only_depth_topic(*bag) : image_topic(*bag, config.depth));
  SACCADE_TRY(std::vector<BagEntry> depth, bag->entries({&topic, 1}));
  if (depth.size() <= config.reading.first && !depth.empty()) {
    return Error{Errc::invalid_argument,
                 "there are only " + std::to_string(depth.size()) + " frames, none left after skipping " +
                     std::to_string(config.reading.first),
                 {}};
  }
  RgbdFolderInfo info;
  info.is_bag = true;
  info.encoding = config.reading.encoding.value_or(DepthEncoding{});
  SACCADE_TRY(const FirstImage first, first_image(*bag, depth, info.encoding));
  SACCADE_TRY(const Intrinsics intrinsics,
              find_bag_intrinsics(*bag, config, bag->topics()[topic].name, info.intrinsics_from));
  SACCADE_TRY(ImageCorrection correction,
              ImageCorrection::create(intrinsics, first.width, first.height, config.reading));
  SACCADE_TRY(BagPoses poses, find_bag_poses(*bag, config, first.head.frame_id));
  info.has_poses = poses.known;
  std::vector<BagEntry> color;
  if (!config.color.empty() && config.reading.read_color) {
    SACCADE_TRY(const std::uint32_t color_topic, image_topic(*bag, config.color));
    SACCADE_TRY(color, bag->entries({&color_topic, 1}));
    if (!color.empty()) {
      SACCADE_TRY(const BagMessage message, bag->read(color.front()));
      SACCADE_TRY(const ColorImage image, read_color_message(message));
      if (image.width() != first.width || image.height() != first.height) {
        return Error{Errc::size_mismatch,
                     config.color + " has images of " + std::to_string(image.width()) + "x" +
                         std::to_string(image.height()) + ", depth of " + std::to_string(first.width) + "x" +
                         std::to_string(first.height) + ": choose one that is registered to depth, or leave it out",
                     {}};
      }
    }
    info.has_color = !color.empty();
  }
  info.damage = bag->damage();
  return std::unique_ptr<RgbdFolderSource>{
      std::make_unique<BagFrames>(std::move(bag), std::move(correction), std::move(info), std::move(poses),
                                  std::move(depth), std::move(color), config.reading)};
}

}  // namespace
}  // namespace internal::io_bags

Result<std::unique_ptr<RgbdFolderSource>> open_bag_frames(const std::filesystem::path& path,
                                                          const BagFramesConfig& config) {
  SACCADE_TRY(std::unique_ptr<Bag> bag, Bag::open(path));
  auto frames = internal::io_bags::open_frames(std::move(bag), config);
  if (!frames && frames.error().context.empty()) return in_file(frames.error(), path);
  return frames;
}

}  // namespace saccade
