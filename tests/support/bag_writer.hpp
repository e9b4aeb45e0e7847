// SPDX-License-Identifier: Apache-2.0
#pragma once
// RosbagWriter, McapWriter: small bags for tests, finished or not, with chunks packed in each way.

#include <zstd.h>
#if __has_include(<bzlib.h>)
#include <bzlib.h>
#endif
#if __has_include(<lz4frame.h>)
#include <lz4frame.h>
#endif

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "saccade/io/files/little_endian.hpp"
#include "saccade/io/messages/messages.hpp"

namespace saccade::test {

using Bytes = std::vector<std::byte>;

inline void append_bytes(Bytes& to, std::span<const std::byte> bytes) {
  to.insert(to.end(), bytes.begin(), bytes.end());
}
inline void append_chars(Bytes& to, std::string_view text) { append_bytes(to, std::as_bytes(std::span{text})); }

/// Packs as "none", "bz2", "lz4" or "zstd". Throws where the library is not there.
inline Bytes packed(std::string_view packing, const Bytes& bytes) {
  if (packing.empty() || packing == "none") return bytes;
  Bytes out;
  if (packing == "zstd") {
    out.resize(ZSTD_compressBound(bytes.size()));
    out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 1));
    return out;
  }
#if __has_include(<lz4frame.h>)
  if (packing == "lz4") {
    out.resize(LZ4F_compressFrameBound(bytes.size(), nullptr));
    out.resize(LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), nullptr));
    return out;
  }
#endif
#if __has_include(<bzlib.h>)
  if (packing == "bz2") {
    auto size = static_cast<unsigned>(bytes.size() + bytes.size() / 50 + 700);
    out.resize(size);
    BZ2_bzBuffToBuffCompress(reinterpret_cast<char*>(out.data()), &size,
                             const_cast<char*>(reinterpret_cast<const char*>(bytes.data())),
                             static_cast<unsigned>(bytes.size()), 1, 0, 0);
    out.resize(size);
    return out;
  }
#endif
  throw std::runtime_error{"no library packs so"};
}

/// Content for both formats.
struct WrittenMessage {
  std::string topic;
  std::string type;
  std::int64_t time_ns{0};
  Bytes bytes;
};

template <class Message>
WrittenMessage written(const std::string& topic, std::int64_t time_ns, const Message& message,
                       messages::Wire wire = messages::Wire::ros1) {
  return {topic, std::string{messages::type_of<Message>().name}, time_ns, messages::write_message(wire, message)};
}

struct BagStyle {
  std::string packing{"none"};
  bool indexed{true};             ///< else as a recording that was not finished
  std::size_t chunk_messages{3};  ///< 0, in MCAP: no chunks
  messages::Wire wire{messages::Wire::ros1};
};

class RosbagBytes {
 public:
  static Bytes make(const std::vector<WrittenMessage>& messages, const BagStyle& style) {
    RosbagBytes bag;
    append_chars(bag.out_, "#ROSBAG V2.0\n");
    bag.header(0, 0, 0);
    for (std::size_t i = 0; i < messages.size(); i += style.chunk_messages) {
      bag.add_chunk(std::span{messages}.subspan(i, std::min(style.chunk_messages, messages.size() - i)), style);
    }
    if (!style.indexed) return bag.out_;
    const std::uint64_t index_at = bag.out_.size();
    for (const auto& [topic, id] : bag.ids_) append_bytes(bag.out_, bag.connection(topic, id));
    for (const Bytes& info : bag.infos_) append_bytes(bag.out_, info);
    Bytes tail(bag.out_.begin() + 13 + 4096, bag.out_.end());
    bag.out_.resize(13);
    bag.header(index_at, static_cast<std::uint32_t>(bag.ids_.size()), static_cast<std::uint32_t>(bag.infos_.size()));
    append_bytes(bag.out_, tail);
    return bag.out_;
  }

 private:
  template <class T>
  static void field(Bytes& header, std::string_view name, const T& value) {
    append_value(header, static_cast<std::uint32_t>(name.size() + 1 + sizeof(T)));
    append_chars(header, name);
    append_chars(header, "=");
    append_value(header, value);
  }
  static void text_field(Bytes& header, std::string_view name, std::string_view value) {
    append_value(header, static_cast<std::uint32_t>(name.size() + 1 + value.size()));
    append_chars(header, std::string{name} + "=" + std::string{value});
  }
  static Bytes record(const Bytes& header, const Bytes& data) {
    Bytes out;
    append_value(out, static_cast<std::uint32_t>(header.size()));
    append_bytes(out, header);
    append_value(out, static_cast<std::uint32_t>(data.size()));
    append_bytes(out, data);
    return out;
  }
  static Bytes op(std::uint8_t code) {
    Bytes header;
    field(header, "op", code);
    return header;
  }
  static std::uint64_t ros_time(std::int64_t ns) {
    return static_cast<std::uint64_t>(ns / 1'000'000'000) | static_cast<std::uint64_t>(ns % 1'000'000'000) << 32U;
  }
  void header(std::uint64_t index_at, std::uint32_t connections, std::uint32_t chunks) {
    Bytes head = op(3);
    field(head, "index_pos", index_at);
    field(head, "conn_count", connections);
    field(head, "chunk_count", chunks);
    append_bytes(out_, record(head, Bytes(4096 - 8 - head.size(), std::byte{' '})));
  }
  Bytes connection(const std::string& topic, std::uint32_t id) const {
    Bytes head = op(7);
    field(head, "conn", id);
    text_field(head, "topic", topic);
    Bytes data;
    text_field(data, "topic", topic);
    text_field(data, "type", types_.at(topic));
    text_field(data, "md5sum", "*");
    text_field(data, "message_definition", "");
    return record(head, data);
  }
  void add_chunk(std::span<const WrittenMessage> messages, const BagStyle& style) {
    Bytes content;
    std::map<std::uint32_t, Bytes> index;
    for (const WrittenMessage& message : messages) {
      const auto [place, is_new] = ids_.try_emplace(message.topic, static_cast<std::uint32_t>(ids_.size()));
      types_[message.topic] = message.type;
      const std::uint32_t id = place->second;
      if (is_new) append_bytes(content, connection(message.topic, id));
      append_value(index[id], ros_time(message.time_ns));
      append_value(index[id], static_cast<std::uint32_t>(content.size()));
      Bytes head = op(2);
      field(head, "conn", id);
      field(head, "time", ros_time(message.time_ns));
      append_bytes(content, record(head, message.bytes));
    }
    Bytes info = op(6);
    field(info, "ver", std::uint32_t{1});
    field(info, "chunk_pos", std::uint64_t{out_.size()});
    field(info, "count", static_cast<std::uint32_t>(index.size()));
    Bytes counts;
    Bytes head = op(5);
    text_field(head, "compression", style.packing);
    field(head, "size", static_cast<std::uint32_t>(content.size()));
    append_bytes(out_, record(head, packed(style.packing, content)));
    for (const auto& [id, entries] : index) {
      const auto count = static_cast<std::uint32_t>(entries.size() / 12);
      append_value(counts, id);
      append_value(counts, count);
      Bytes index_head = op(4);
      field(index_head, "ver", std::uint32_t{1});
      field(index_head, "conn", id);
      field(index_head, "count", count);
      append_bytes(out_, record(index_head, entries));
    }
    infos_.push_back(record(info, counts));
  }

  Bytes out_;
  std::map<std::string, std::uint32_t> ids_;
  std::map<std::string, std::string> types_;
  std::vector<Bytes> infos_;
};

class McapBytes {
 public:
  static Bytes make(const std::vector<WrittenMessage>& messages, const BagStyle& style) {
    McapBytes file{style};
    file.magic();
    Bytes head;
    text(head, style.wire == messages::Wire::ros1 ? "ros1" : "ros2");
    text(head, "");
    record(file.out_, 1, head);
    if (style.chunk_messages == 0) {
      for (const WrittenMessage& message : messages) file.add_message(file.out_, message);
    } else {
      for (std::size_t i = 0; i < messages.size(); i += style.chunk_messages) {
        file.add_chunk(std::span{messages}.subspan(i, std::min(style.chunk_messages, messages.size() - i)));
      }
    }
    if (!style.indexed) return file.out_;
    record(file.out_, 0x0F, Bytes(4));
    file.add_summary(messages.size());
    file.magic();
    return file.out_;
  }

 private:
  explicit McapBytes(const BagStyle& style) : style_{style} {}

  static void text(Bytes& to, std::string_view value) {
    append_value(to, static_cast<std::uint32_t>(value.size()));
    append_chars(to, value);
  }
  static void record(Bytes& to, std::uint8_t op, const Bytes& content) {
    append_value(to, op);
    append_value(to, std::uint64_t{content.size()});
    append_bytes(to, content);
  }
  void magic() { append_chars(out_, "\x89MCAP0\r\n"); }
  [[nodiscard]] std::string type_name(const std::string& type) const {
    if (style_.wire == messages::Wire::ros1) return type;
    return std::string{type}.replace(type.find('/'), 1, "/msg/");
  }
  void add_channel(Bytes& to, const std::string& topic, std::uint16_t id) const {
    Bytes schema;
    append_value(schema, id);
    text(schema, type_name(types_.at(topic)));
    text(schema, style_.wire == messages::Wire::ros1 ? "ros1msg" : "ros2msg");
    text(schema, "");
    record(to, 3, schema);
    Bytes channel;
    append_value(channel, id);
    append_value(channel, id);
    text(channel, topic);
    text(channel, style_.wire == messages::Wire::ros1 ? "ros1" : "cdr");
    text(channel, "");
    record(to, 4, channel);
  }
  /// Returns the channel.
  std::uint16_t add_message(Bytes& to, const WrittenMessage& message) {
    const auto [place, is_new] = ids_.try_emplace(message.topic, static_cast<std::uint16_t>(ids_.size() + 1));
    types_[message.topic] = message.type;
    if (is_new) add_channel(to, message.topic, place->second);
    ++counts_[place->second];
    last_at_ = to.size();
    Bytes content;
    append_value(content, place->second);
    append_value(content, std::uint32_t{0});
    append_value(content, message.time_ns);
    append_value(content, message.time_ns);
    append_bytes(content, message.bytes);
    record(to, 5, content);
    return place->second;
  }
  void add_chunk(std::span<const WrittenMessage> messages) {
    Bytes content;
    std::map<std::uint16_t, Bytes> index;
    for (const WrittenMessage& message : messages) {
      const std::uint16_t id = add_message(content, message);
      append_value(index[id], message.time_ns);
      append_value(index[id], last_at_);
    }
    const Bytes stored = packed(style_.packing, content);
    const std::string name = style_.packing == "none" ? "" : style_.packing;
    Bytes chunk;
    append_value(chunk, messages.front().time_ns);
    append_value(chunk, messages.back().time_ns);
    append_value(chunk, std::uint64_t{content.size()});
    append_value(chunk, std::uint32_t{0});
    text(chunk, name);
    append_value(chunk, std::uint64_t{stored.size()});
    append_bytes(chunk, stored);
    const std::uint64_t at = out_.size();
    record(out_, 6, chunk);
    const std::uint64_t index_at = out_.size();
    Bytes offsets;
    for (const auto& [id, entries] : index) {
      append_value(offsets, id);
      append_value(offsets, std::uint64_t{out_.size()});
      Bytes one;
      append_value(one, id);
      append_value(one, static_cast<std::uint32_t>(entries.size()));
      append_bytes(one, entries);
      record(out_, 7, one);
    }
    Bytes info;
    append_value(info, messages.front().time_ns);
    append_value(info, messages.back().time_ns);
    append_value(info, at);
    append_value(info, index_at - at);
    append_value(info, static_cast<std::uint32_t>(offsets.size()));
    append_bytes(info, offsets);
    append_value(info, std::uint64_t{out_.size()} - index_at);
    text(info, name);
    append_value(info, std::uint64_t{stored.size()});
    append_value(info, std::uint64_t{content.size()});
    record(indexes_, 8, info);
    ++chunks_;
  }
  void add_summary(std::uint64_t messages) {
    const std::uint64_t at = out_.size();
    for (const auto& [topic, id] : ids_) add_channel(out_, topic, id);
    append_bytes(out_, indexes_);
    Bytes statistics;
    append_value(statistics, messages);
    append_value(statistics, static_cast<std::uint16_t>(ids_.size()));
    append_value(statistics, static_cast<std::uint32_t>(ids_.size()));
    append_value(statistics, std::uint64_t{0});
    append_value(statistics, chunks_);
    append_value(statistics, std::uint64_t{0});
    append_value(statistics, std::uint64_t{0});
    append_value(statistics, static_cast<std::uint32_t>(10 * counts_.size()));
    for (const auto& [id, count] : counts_) {
      append_value(statistics, id);
      append_value(statistics, count);
    }
    record(out_, 0x0B, statistics);
    Bytes footer;
    append_value(footer, at);
    append_value(footer, std::uint64_t{0});
    append_value(footer, std::uint32_t{0});
    record(out_, 2, footer);
  }

  BagStyle style_;
  Bytes out_;
  Bytes indexes_;
  std::map<std::string, std::uint16_t> ids_;
  std::map<std::string, std::string> types_;
  std::map<std::uint16_t, std::uint64_t> counts_;
  std::uint64_t last_at_{0};
  std::uint32_t chunks_{0};
};

inline std::filesystem::path write_bytes(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  std::ofstream file{path, std::ios::binary};
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return path;
}

}  // namespace saccade::test
