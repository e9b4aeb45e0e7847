// SPDX-License-Identifier: Apache-2.0
#pragma once
// McapWriter: messages of ROS 2 in an MCAP file, readable by Foxglove Studio and ros2 bag.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "saccade/io/messages/message_sink.hpp"

namespace saccade::messages {

/// Writer of MCAP files. Chunks are compressed by zstd; index, statistics and a summary follow at the end. An
/// unfinished file lacks these, and readers scan its chunks. One caller at a time.
class McapWriter final : public MessageSink {
 public:
  /// Creates a file, replacing one of that name. Answers io_failure naming it.
  [[nodiscard]] static Result<McapWriter> create(const std::filesystem::path& path);

  [[nodiscard]] Wire wire() const override { return Wire::cdr; }
  /// Adds a message. Chunks of 4 MiB are written as they fill.
  [[nodiscard]] Status add(std::string_view topic, const MessageType& type, Time time,
                           std::span<const std::byte> bytes) override;
  /// Writes the current chunk, so that all added messages are in the file.
  [[nodiscard]] Status flush() override;
  /// Writes the summary.
  [[nodiscard]] Status finish() override;
  [[nodiscard]] std::uint64_t message_count() const { return messages_; }

 private:
  struct Channel {
    std::uint16_t id{0};
    std::uint32_t sequence{0};
    std::uint64_t count{0};
  };
  struct Entry {
    std::uint64_t time;
    std::uint64_t offset;
  };
  struct ChunkIndex {
    std::uint64_t first_time, last_time, start, length, index_length;
    std::map<std::uint16_t, std::uint64_t> index_offsets;
    std::uint64_t compressed, uncompressed;
  };

  McapWriter(std::filesystem::path path, std::ofstream file);
  [[nodiscard]] Channel& channel_of(std::string_view topic, const MessageType& type);
  [[nodiscard]] Status write(std::span<const std::byte> bytes);
  [[nodiscard]] Error failure() const;

  std::filesystem::path path_;
  std::ofstream file_;
  std::uint64_t offset_{0};  ///< bytes in the file
  std::vector<std::byte> chunk_;
  std::map<std::uint16_t, std::vector<Entry>> chunk_messages_;
  std::map<std::string, std::uint16_t, std::less<>> schemas_;
  std::map<std::string, Channel, std::less<>> channels_;
  std::vector<std::byte> descriptions_;  ///< schemas and channels, repeated in the summary
  std::vector<ChunkIndex> chunks_;
  std::uint64_t first_time_{~std::uint64_t{0}}, last_time_{0}, messages_{0};
};

}  // namespace saccade::messages
