// SPDX-License-Identifier: Apache-2.0
// Bags of ROS 1, format 2.0 (wiki.ros.org/Bags/Format/2.0).
#include <algorithm>
#include <cstring>
#include <limits>

#include "saccade/io/bags/internal/bag_format.hpp"
#include "saccade/io/files/little_endian.hpp"

namespace saccade::internal::io_bags {
namespace {

constexpr std::string_view kRosbagMagic{"#ROSBAG V2.0\n"};
constexpr std::uint32_t kMaxHeaderBytes{1U << 20U};
struct RosbagOp {
  enum : std::uint8_t { message_data = 2, bag_header = 3, index_data = 4, chunk = 5, chunk_info = 6, connection = 7 };
};

/// Header of a record, and the position of its data. Missing fields are 0.
struct RosbagRecord {
  std::uint8_t op{0};
  std::uint32_t conn{0}, count{0}, size{0}, conn_count{0}, chunk_count{0};
  std::uint64_t time{0}, index_pos{0}, chunk_pos{0};
  std::string compression, topic;
  std::uint64_t data_at{0};
  std::uint32_t data_bytes{0};
  std::uint64_t end{0};
};

/// Converts seconds and nanoseconds, 32 bits each.
std::int64_t rosbag_ns(std::uint64_t time) {
  return static_cast<std::int64_t>(time & 0xFFFFFFFFU) * 1'000'000'000 + static_cast<std::int64_t>(time >> 32U);
}

/// Calls `on_field(name, value)` for each field of a header; returns false where they do not fill it.
template <class OnField>
bool each_field(std::span<const std::byte> header, const OnField& on_field) {
  ByteReader reader{header};
  while (reader.left() > 0) {
    if (!reader.has(4)) return false;
    const auto length = reader.value<std::uint32_t>();
    if (!reader.has(length)) return false;
    const std::string_view field = as_text(reader.take(length));
    const std::size_t equals = field.find('=');
    if (equals == std::string_view::npos) return false;
    on_field(field.substr(0, equals), field.substr(equals + 1));
  }
  return true;
}

template <class T>
void set_number(T& to, std::string_view value) {
  if (value.size() == sizeof(T)) std::memcpy(&to, value.data(), sizeof(T));
}

void set_field(RosbagRecord& record, std::string_view name, std::string_view value) {
  if (name == "op") set_number(record.op, value);
  if (name == "conn") set_number(record.conn, value);
  if (name == "count") set_number(record.count, value);
  if (name == "size") set_number(record.size, value);
  if (name == "conn_count") set_number(record.conn_count, value);
  if (name == "chunk_count") set_number(record.chunk_count, value);
  if (name == "time") set_number(record.time, value);
  if (name == "index_pos") set_number(record.index_pos, value);
  if (name == "chunk_pos") set_number(record.chunk_pos, value);
  if (name == "compression") record.compression = value;
  if (name == "topic") record.topic = value;
}

/// Returns nullopt where no complete header begins. The data may reach beyond the window.
std::optional<RosbagRecord> record_at(ByteWindow& window, std::uint64_t offset) {
  const auto uint32_at = [&window](std::uint64_t at) -> std::optional<std::uint32_t> {
    const auto bytes = window.at(at, 4);
    if (bytes.size() < 4) return std::nullopt;
    return ByteReader{bytes}.value<std::uint32_t>();
  };
  const auto header_bytes = uint32_at(offset);
  if (!header_bytes || *header_bytes > kMaxHeaderBytes) return std::nullopt;
  const auto header = window.at(offset + 4, *header_bytes);
  RosbagRecord record;
  const auto on_field = [&record](std::string_view name, std::string_view value) { set_field(record, name, value); };
  if (header.size() < *header_bytes || !each_field(header, on_field)) return std::nullopt;
  const auto data_bytes = uint32_at(offset + 4 + *header_bytes);
  if (!data_bytes || record.op == 0) return std::nullopt;
  record.data_at = offset + 8 + *header_bytes;
  record.data_bytes = *data_bytes;
  record.end = record.data_at + *data_bytes;
  return record;
}

Chunk chunk_of(const RosbagRecord& record) {
  return {record.data_at, record.data_bytes, record.size, packing_of(record.compression), false, record.end, 0, 0};
}

class Rosbag final : public BagFormat {
 public:
  [[nodiscard]] bool walk(ByteWindow& window, const OnMessage& on_message) override {
    std::uint64_t at = 0;
    while (at < window.size()) {
      const auto record = record_at(window, at);
      if (!record || record->end > window.size()) return false;
      if (record->op == RosbagOp::connection) add_connection(window, *record);
      if (record->op == RosbagOp::message_data) on_message(rosbag_ns(record->time), at, record->conn);
      at = record->end;
    }
    return true;
  }

  [[nodiscard]] bool index(const BagFile& file, const Chunk& chunk, const OnMessage& on_message) const override {
    ByteWindow window{file, chunk.index_at, std::numeric_limits<std::uint64_t>::max()};
    std::uint64_t at = 0;
    for (std::uint32_t i = 0; i < chunk.index_count; ++i) {
      const auto record = record_at(window, at);
      if (!record || record->op != RosbagOp::index_data || record->end > window.size()) return false;
      if (std::uint64_t{record->count} * 12 != record->data_bytes || record->data_bytes > kMaxPieceBytes) return false;
      ByteReader reader{window.at(record->data_at, record->data_bytes)};
      if (!reader.has(record->data_bytes)) return false;
      for (std::uint32_t n = 0; n < record->count; ++n) {
        const auto time = reader.value<std::uint64_t>();
        const auto offset = reader.value<std::uint32_t>();
        if (offset >= chunk.size) return false;
        on_message(rosbag_ns(time), offset, record->conn);
      }
      at = record->end;
    }
    return true;
  }

  [[nodiscard]] Result<MessageView> message_at(ByteWindow& window, std::uint64_t offset) const override {
    const auto record = record_at(window, offset);
    if (!record || record->op != RosbagOp::message_data || record->data_bytes > kMaxPieceBytes) {
      return Error{Errc::corrupt_data, "there is no message where the index says", {}};
    }
    const auto bytes = window.at(record->data_at, record->data_bytes);
    if (bytes.size() < record->data_bytes) return Error{Errc::corrupt_data, "a message ends beyond its chunk", {}};
    return MessageView{rosbag_ns(record->time), record->conn, bytes};
  }

  /// Reads connections and chunks from the index at the end of the file. Returns false where it contradicts the bag's
  /// header.
  [[nodiscard]] bool read_index(const BagFile& file, ByteWindow& window, const RosbagRecord& header) {
    std::uint64_t at = header.index_pos;
    ByteWindow chunk_window{file, 0, file.size()};
    for (std::uint64_t i = 0; i < std::uint64_t{header.conn_count} + header.chunk_count; ++i) {
      const auto record = record_at(window, at);
      if (!record || record->end > window.size()) return false;
      at = record->end;
      if (i < header.conn_count) {
        if (record->op != RosbagOp::connection) return false;
        add_connection(window, *record);
        continue;
      }
      if (record->op != RosbagOp::chunk_info || std::uint64_t{record->count} * 8 != record->data_bytes) return false;
      const auto data = window.at(record->data_at, record->data_bytes);
      if (data.size() < record->data_bytes) return false;
      ByteReader reader{data};
      for (std::uint32_t n = 0; n < record->count; ++n) {
        const auto conn = reader.value<std::uint32_t>();
        counts[conn] += reader.value<std::uint32_t>();
      }
      const auto packed = record_at(chunk_window, record->chunk_pos);
      if (!packed || packed->op != RosbagOp::chunk || packed->end > file.size()) return false;
      chunks.push_back(chunk_of(*packed));
      chunks.back().index_count = record->count;
      chunks.back().index_bytes = 1;
    }
    return true;
  }

  /// Scans everything from the first record on.
  [[nodiscard]] Status scan(const BagFile& file, ByteWindow& window) {
    std::uint64_t at = kRosbagMagic.size();
    while (at < window.size()) {
      const auto record = record_at(window, at);
      if (!record) break;
      if (record->op == RosbagOp::chunk) {
        Chunk chunk = chunk_of(*record);
        chunk.is_damaged = record->end > file.size();
        chunk.stored = std::min(chunk.stored, file.size() - std::min(file.size(), chunk.data_at));
        SACCADE_CHECK(scan_chunk(file, chunk));
      }
      if (record->op == RosbagOp::connection && record->end <= file.size()) add_connection(window, *record);
      if (record->end > file.size()) break;
      at = record->end;
    }
    if (at < window.size()) add_damage("it is cut or damaged at byte " + std::to_string(at));
    return {};
  }

 private:
  void add_connection(ByteWindow& window, const RosbagRecord& record) {
    if (record.data_bytes > kMaxPieceBytes) return;
    Channel channel{record.topic, {}, messages::Wire::ros1};
    static_cast<void>(each_field(window.at(record.data_at, record.data_bytes), [&](auto name, auto value) {
      if (name == "type") channel.type = value;
      if (name == "topic" && channel.topic.empty()) channel.topic = value;
    }));
    channels[record.conn] = std::move(channel);
  }
};

}  // namespace

bool begins_as_rosbag(std::span<const std::byte> bytes) { return as_text(bytes).starts_with(kRosbagMagic); }

Result<std::unique_ptr<BagFormat>> read_rosbag(const BagFile& file) {
  ByteWindow window{file, 0, file.size()};
  const auto header = record_at(window, kRosbagMagic.size());
  if (!header || header->op != RosbagOp::bag_header) {
    return Error{Errc::corrupt_data, "this bag of ROS has no header behind its first line", {}};
  }
  auto bag = std::make_unique<Rosbag>();
  if (header->index_pos >= kRosbagMagic.size() && header->index_pos <= file.size() &&
      bag->read_index(file, window, *header)) {
    return std::unique_ptr<BagFormat>{std::move(bag)};
  }
  bag = std::make_unique<Rosbag>();
  bag->add_damage(header->index_pos == 0 ? "it has no index: recording it was not finished"
                                         : "its index is missing or damaged");
  SACCADE_CHECK(bag->scan(file, window));
  return std::unique_ptr<BagFormat>{std::move(bag)};
}

}  // namespace saccade::internal::io_bags
