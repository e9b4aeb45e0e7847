// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/messages/mcap_writer.hpp"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <limits>

#include "saccade/io/files/crc32.hpp"
#include "saccade/io/files/little_endian.hpp"

namespace saccade::messages {
namespace {

constexpr std::size_t kChunkBytes{std::size_t{4} << 20};
constexpr int kCompression{1};
constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'M', 'C', 'A', 'P', 0x30, '\r', '\n'};

enum class Op : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  statistics = 0x0B,
  summary_offset = 0x0E,
  data_end = 0x0F,
};

using Bytes = std::vector<std::byte>;

void append_text(Bytes& out, std::string_view text) {
  append_value(out, static_cast<std::uint32_t>(text.size()));
  const auto bytes = std::as_bytes(std::span{text});
  out.insert(out.end(), bytes.begin(), bytes.end());
}

void append_bytes(Bytes& out, std::span<const std::byte> bytes) { out.insert(out.end(), bytes.begin(), bytes.end()); }

void append_record(Bytes& out, Op op, std::span<const std::byte> content) {
  append_value(out, op);
  append_value(out, static_cast<std::uint64_t>(content.size()));
  append_bytes(out, content);
}

/// Appends a map of numbers after the number of its bytes.
template <class Value>
void append_numbers(Bytes& out, const std::map<std::uint16_t, Value>& numbers) {
  append_value(out, static_cast<std::uint32_t>(numbers.size() * (sizeof(std::uint16_t) + sizeof(Value))));
  for (const auto& [key, value] : numbers) {
    append_value(out, key);
    append_value(out, value);
  }
}

std::uint64_t nanoseconds(Time time) {
  return time.sec < 0 ? 0 : static_cast<std::uint64_t>(time.sec) * 1'000'000'000 + time.nanosec;
}

}  // namespace

McapWriter::McapWriter(std::filesystem::path path, std::ofstream file)
    : path_{std::move(path)}, file_{std::move(file)} {}

Result<McapWriter> McapWriter::create(const std::filesystem::path& path) {
  McapWriter writer{path, std::ofstream{path, std::ios::binary | std::ios::trunc}};
  if (!writer.file_) return writer.failure();
  Bytes begin;
  append_value(begin, kMagic);
  Bytes header;
  append_text(header, "ros2");
  append_text(header, "saccade");
  append_record(begin, Op::header, header);
  SACCADE_CHECK(writer.write(begin));
  return writer;
}

Error McapWriter::failure() const {
  return {Errc::io_failure, "the file cannot be written; is the disk full, or its folder missing?", path_.string()};
}

Status McapWriter::write(std::span<const std::byte> bytes) {
  file_.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));  // NOLINT
  file_.flush();
  if (!file_) return failure();
  offset_ += bytes.size();
  return {};
}

McapWriter::Channel& McapWriter::channel_of(std::string_view topic, const MessageType& type) {
  if (const auto known = channels_.find(topic); known != channels_.end()) return known->second;
  Bytes described;
  auto [schema, is_new] = schemas_.try_emplace(type.ros2_name(), static_cast<std::uint16_t>(schemas_.size() + 1));
  if (is_new) {
    Bytes content;
    append_value(content, schema->second);
    append_text(content, schema->first);
    append_text(content, "ros2msg");
    append_text(content, type.definition(Wire::cdr));
    append_record(described, Op::schema, content);
  }
  const auto id = static_cast<std::uint16_t>(channels_.size());
  Bytes content;
  append_value(content, id);
  append_value(content, schema->second);
  append_text(content, topic);
  append_text(content, "cdr");
  append_value(content, std::uint32_t{0});  // no further words
  append_record(described, Op::channel, content);
  append_bytes(chunk_, described);
  append_bytes(descriptions_, described);
  return channels_.emplace(std::string{topic}, Channel{id}).first->second;
}

Status McapWriter::add(std::string_view topic, const MessageType& type, Time time, std::span<const std::byte> bytes) {
  Channel& channel = channel_of(topic, type);
  const std::uint64_t at = nanoseconds(time);
  chunk_messages_[channel.id].push_back({at, chunk_.size()});
  append_value(chunk_, Op::message);
  append_value(chunk_, static_cast<std::uint64_t>(22 + bytes.size()));
  append_value(chunk_, channel.id);
  append_value(chunk_, channel.sequence++);
  append_value(chunk_, at);
  append_value(chunk_, at);
  append_bytes(chunk_, bytes);
  ++channel.count;
  ++messages_;
  first_time_ = std::min(first_time_, at);
  last_time_ = std::max(last_time_, at);
  return chunk_.size() < kChunkBytes ? Status{} : flush();
}

Status McapWriter::flush() {
  if (chunk_.empty()) return {};
  ChunkIndex index{std::numeric_limits<std::uint64_t>::max(), 0, offset_, 0, 0, {}, 0, chunk_.size()};
  for (const auto& [channel, entries] : chunk_messages_) {
    for (const Entry& entry : entries) {
      index.first_time = std::min(index.first_time, entry.time);
      index.last_time = std::max(index.last_time, entry.time);
    }
  }
  if (chunk_messages_.empty()) index.first_time = 0;
  Bytes compressed(ZSTD_compressBound(chunk_.size()));
  compressed.resize(ZSTD_compress(compressed.data(), compressed.size(), chunk_.data(), chunk_.size(), kCompression));
  index.compressed = compressed.size();

  Bytes content;
  append_value(content, index.first_time);
  append_value(content, index.last_time);
  append_value(content, index.uncompressed);
  append_value(content, crc32(chunk_));
  append_text(content, "zstd");
  append_value(content, index.compressed);
  append_bytes(content, compressed);
  Bytes out;
  append_record(out, Op::chunk, content);
  index.length = out.size();
  for (const auto& [channel, entries] : chunk_messages_) {
    index.index_offsets[channel] = offset_ + out.size();
    content.clear();
    append_value(content, channel);
    append_value(content, static_cast<std::uint32_t>(entries.size() * sizeof(Entry)));
    for (const Entry& entry : entries) append_value(content, entry);
    append_record(out, Op::message_index, content);
  }
  index.index_length = out.size() - index.length;
  chunks_.push_back(std::move(index));
  chunk_.clear();
  chunk_messages_.clear();
  return write(out);
}

Status McapWriter::finish() {
  SACCADE_CHECK(flush());
  Bytes out;
  append_record(out, Op::data_end, Bytes(4));  // checksum of everything before: 0 for none
  const std::uint64_t summary = offset_ + out.size();
  const std::size_t before_summary = out.size();

  Bytes content;
  append_value(content, messages_);
  append_value(content, static_cast<std::uint16_t>(schemas_.size()));
  append_value(content, static_cast<std::uint32_t>(channels_.size()));
  append_value(content, std::uint32_t{0});  // attachments
  append_value(content, std::uint32_t{0});  // metadata
  append_value(content, static_cast<std::uint32_t>(chunks_.size()));
  append_value(content, messages_ == 0 ? 0 : first_time_);
  append_value(content, last_time_);
  std::map<std::uint16_t, std::uint64_t> counts;
  for (const auto& [topic, channel] : channels_) counts[channel.id] = channel.count;
  append_numbers(content, counts);
  append_bytes(out, descriptions_);
  append_record(out, Op::statistics, content);
  for (const ChunkIndex& chunk : chunks_) {
    content.clear();
    for (const std::uint64_t value : {chunk.first_time, chunk.last_time, chunk.start, chunk.length}) {
      append_value(content, value);
    }
    append_numbers(content, chunk.index_offsets);
    append_value(content, chunk.index_length);
    append_text(content, "zstd");
    append_value(content, chunk.compressed);
    append_value(content, chunk.uncompressed);
    append_record(out, Op::chunk_index, content);
  }

  append_value(out, Op::footer);
  append_value(out, std::uint64_t{20});
  append_value(out, summary);
  append_value(out, std::uint64_t{0});  // no table of the summary's groups
  append_value(out, crc32(std::span{out}.subspan(before_summary)));
  append_value(out, kMagic);
  SACCADE_CHECK(write(out));
  file_.close();
  return file_ ? Status{} : Status{failure()};
}

}  // namespace saccade::messages
