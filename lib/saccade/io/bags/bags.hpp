// SPDX-License-Identifier: Apache-2.0
#pragma once
// Bag: the messages of a ROS 1 bag or an MCAP file. open_bag_frames: a depth topic as frames. read_bag_hand: the motion
// of a hand.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/io/frames/rgbd_folder.hpp"
#include "saccade/io/frames/trajectory_io.hpp"
#include "saccade/io/messages/messages.hpp"

namespace saccade {

struct BagTopic {
  std::string name;
  std::string type;                    ///< as in ROS 1: sensor_msgs/Image
  std::optional<messages::Wire> wire;  ///< none: an encoding other than ROS messages
  std::uint64_t messages{0};
};

/// Place of a message in a bag.
struct BagEntry {
  std::int64_t time_ns{0};  ///< time of recording
  std::uint64_t offset{0};  ///< position of its record in its chunk or, outside of chunks, in the file
  std::uint32_t chunk{0};
  std::uint32_t topic{0};  ///< index into Bag::topics()
};

struct BagMessage {
  std::string_view topic;
  std::string_view type;
  std::int64_t time_ns{0};
  std::optional<messages::Wire> wire;
  std::vector<std::byte> bytes;
};

/// Recording of ROS: a bag of format 2.0 (chunks none, bz2, lz4) or an MCAP file (none, lz4, zstd; ROS 1 or ROS 2).
/// Messages are read on request; at most a few chunks are in memory. One caller at a time.
class Bag {
 public:
  /// Opens a recording. Answers not_found, io_failure; corrupt_data for a file that is neither, or not readable at all.
  /// A file that is truncated, damaged or without index is read as far as possible, and damage() describes it.
  /// O(chunks) with an index, otherwise all bytes are read.
  [[nodiscard]] static Result<std::unique_ptr<Bag>> open(const std::filesystem::path& path);
  virtual ~Bag() = default;

  /// Returns the topics by name; a topic with several types or publishers occurs once for each type.
  [[nodiscard]] virtual const std::vector<BagTopic>& topics() const = 0;
  /// Returns a description of the file's damage for people; empty for a sound file.
  [[nodiscard]] virtual const std::string& damage() const = 0;
  /// Returns the places of all messages of some topics, by time, then by position in the file.
  [[nodiscard]] virtual Result<std::vector<BagEntry>> entries(std::span<const std::uint32_t> topics) = 0;
  /// Reads one message. Answers corrupt_data, or unavailable where this build cannot unpack its chunk.
  [[nodiscard]] virtual Result<BagMessage> read(const BagEntry& entry) = 0;

  /// Returns an index into topics().
  [[nodiscard]] std::optional<std::uint32_t> find(std::string_view topic) const;
  /// Lists topics of the given types, or of all: "/a (sensor_msgs/Image, 12 messages), /b (…)".
  [[nodiscard]] std::string list(std::span<const std::string_view> types = {}) const;
};

/// Tells whether a file begins, or is named, like a bag or an MCAP file.
[[nodiscard]] bool is_bag(const std::filesystem::path& path);

struct BagFramesConfig {
  RgbdFolderConfig reading;  ///< except layout and require_poses
  std::string depth;         ///< topic of sensor_msgs/Image or CompressedImage; empty: the only one
  std::string info;          ///< topic of its sensor_msgs/CameraInfo; empty: camera_info beside the depth topic
  std::string color;         ///< topic of colour images registered to depth; empty: none
  std::string world_frame;   ///< frame of TF; empty: the root of the camera's tree
};

/// Opens the frames of a depth topic by recording time: 16UC1 and mono16 (1/1000 m unless the encoding says otherwise),
/// 32FC1 (metres; negative: free up to there), compressedDepth. Poses are interpolated from TF at the image's stamp,
/// between the world and its frame_id. Frames have none unless the camera moves in TF.
[[nodiscard]] Result<std::unique_ptr<RgbdFolderSource>> open_bag_frames(const std::filesystem::path& path,
                                                                        const BagFramesConfig& config);

/// Reads the motion of a hand from a bag.
/// @param hand  a topic of PoseStamped, PointStamped or TransformStamped, or a frame of TF; empty: the only such topic.
/// @param world_frame  frame of the positions; empty: that of the messages, or the root of the frame's tree.
[[nodiscard]] Result<HandRecording> read_bag_hand(const std::filesystem::path& path, const std::string& hand,
                                                  const std::string& world_frame);

}  // namespace saccade
