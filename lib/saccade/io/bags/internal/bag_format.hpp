// SPDX-License-Identifier: Apache-2.0
#pragma once
// BagFormat: chunks and channels of a bag, and reading of its records; read_rosbag, read_mcap.

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "saccade/core/result.hpp"
#include "saccade/io/bags/internal/bag_file.hpp"
#include "saccade/io/bags/internal/chunk.hpp"
#include "saccade/io/messages/messages.hpp"

namespace saccade::internal::io_bags {

struct Channel {
  std::string topic;
  std::string type;
  std::optional<messages::Wire> wire;
};

struct Chunk {
  std::uint64_t data_at{0};  ///< in the file
  std::uint64_t stored{0};   ///< bytes in the file
  std::uint64_t size{0};     ///< bytes unpacked
  Packing packing{Packing::none};
  bool is_damaged{false};        ///< read as far as possible
  std::uint64_t index_at{0};     ///< first index record, in the file
  std::uint64_t index_bytes{0};  ///< upper bound of the bytes of its index records; 0: the chunk is walked instead
  std::uint32_t index_count{0};  ///< index records; 0 where only their bytes are known
};

struct MessageView {
  std::int64_t time_ns{0};
  std::uint32_t channel{0};
  std::span<const std::byte> bytes;  ///< valid until the window moves
};

/// Receives the time, the record's offset and the channel.
using OnMessage = std::function<void(std::int64_t time_ns, std::uint64_t offset, std::uint32_t channel)>;

class BagFormat {
 public:
  virtual ~BagFormat() = default;

  std::vector<Chunk> chunks;
  std::map<std::uint32_t, Channel> channels;
  std::map<std::uint32_t, std::uint64_t> counts;  ///< messages per channel
  std::string damage;

  /// Reads the records of a chunk one after the other, and learns channels. Returns false where a record is incomplete.
  [[nodiscard]] virtual bool walk(ByteWindow& window, const OnMessage& on_message) = 0;
  /// Reads the index records of a chunk. Returns false where they are unusable.
  [[nodiscard]] virtual bool index(const BagFile& file, const Chunk& chunk, const OnMessage& on_message) const = 0;
  [[nodiscard]] virtual Result<MessageView> message_at(ByteWindow& window, std::uint64_t offset) const = 0;

  /// Unpacks a chunk; without is_damaged, an incomplete chunk is an error.
  [[nodiscard]] static Result<UninitializedVector<std::byte>> unpack(const BagFile& file, const Chunk& chunk);
  /// Counts the messages of a chunk without an index, and adds it; sets is_damaged and damage.
  [[nodiscard]] Status scan_chunk(const BagFile& file, Chunk chunk);
  void add_damage(const std::string& what);
};

[[nodiscard]] bool begins_as_rosbag(std::span<const std::byte> bytes);
[[nodiscard]] bool begins_as_mcap(std::span<const std::byte> bytes);
[[nodiscard]] Result<std::unique_ptr<BagFormat>> read_rosbag(const BagFile& file);
[[nodiscard]] Result<std::unique_ptr<BagFormat>> read_mcap(const BagFile& file);

/// Converts type names of ROS 2 to those of ROS 1: sensor_msgs/msg/Image → sensor_msgs/Image.
[[nodiscard]] std::string ros1_type(std::string_view type);

}  // namespace saccade::internal::io_bags
