// SPDX-License-Identifier: Apache-2.0
// MCAP files, version 0 (mcap.dev/spec).
#include <algorithm>
#include <array>
#include <limits>

#include "saccade/io/bags/internal/bag_format.hpp"
#include "saccade/io/files/little_endian.hpp"

namespace saccade::internal::io_bags {
namespace {

constexpr std::array<std::uint8_t, 8> kMcapMagic{0x89, 'M', 'C', 'A', 'P', 0x30, '\r', '\n'};
constexpr std::uint64_t kFooterBytes{9 + 20 + 8};
constexpr std::size_t kChunkHeadBytes{8 + 8 + 8 + 4 + 4};
constexpr std::size_t kMessageHeadBytes{2 + 4 + 8 + 8};
struct McapOp {
  enum : std::uint8_t {
    footer = 0x02,
    schema = 0x03,
    channel = 0x04,
    message = 0x05,
    chunk = 0x06,
    message_index = 0x07,
    chunk_index = 0x08,
    statistics = 0x0B,
    data_end = 0x0F
  };
};

struct McapRecord {
  std::uint8_t op{0};
  std::uint64_t data_at{0};
  std::uint64_t data_bytes{0};
  std::uint64_t end{0};
};

/// Returns nullopt where no record begins. The data may reach beyond the window.
std::optional<McapRecord> mcap_record_at(ByteWindow& window, std::uint64_t offset) {
  ByteReader reader{window.at(offset, 9)};
  if (!reader.has(9)) return std::nullopt;
  McapRecord record;
  record.op = reader.value<std::uint8_t>();
  record.data_at = offset + 9;
  record.data_bytes = reader.value<std::uint64_t>();
  if (record.op == 0 || record.data_bytes > std::numeric_limits<std::uint64_t>::max() / 2) return std::nullopt;
  record.end = record.data_at + record.data_bytes;
  return record;
}

/// Fields of a record; after the first missing one all others are empty or 0.
class McapFields {
 public:
  explicit McapFields(std::span<const std::byte> bytes) : reader_{bytes} {}

  template <class T>
  T number() {
    return need(sizeof(T)) ? reader_.value<T>() : T{};
  }
  std::span<const std::byte> bytes(std::uint64_t count) {
    return need(count) ? reader_.take(static_cast<std::size_t>(count)) : std::span<const std::byte>{};
  }
  std::string text() { return std::string{as_text(bytes(number<std::uint32_t>()))}; }
  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] std::size_t left() const { return reader_.left(); }

 private:
  bool need(std::uint64_t count) {
    ok_ = ok_ && count <= reader_.left();
    return ok_;
  }
  ByteReader reader_;
  bool ok_{true};
};

class Mcap final : public BagFormat {
 public:
  [[nodiscard]] bool walk(ByteWindow& window, const OnMessage& on_message) override {
    return walk_from(window, 0, on_message, {});
  }

  [[nodiscard]] bool index(const BagFile& file, const Chunk& chunk, const OnMessage& on_message) const override {
    ByteWindow window{file, chunk.index_at, chunk.index_bytes};
    std::uint64_t at = 0;
    while (at < window.size()) {
      const auto record = mcap_record_at(window, at);
      if (!record || record->op != McapOp::message_index || record->end > window.size()) return false;
      if (record->data_bytes > kMaxPieceBytes) return false;
      McapFields fields{window.at(record->data_at, static_cast<std::size_t>(record->data_bytes))};
      const auto id = fields.number<std::uint16_t>();
      const auto bytes = fields.number<std::uint32_t>();
      if (!fields.ok() || bytes % 16 != 0 || bytes > fields.left()) return false;
      for (std::uint32_t n = 0; n < bytes / 16; ++n) {
        const auto time_ns = fields.number<std::int64_t>();
        const auto offset = fields.number<std::uint64_t>();
        if (offset >= chunk.size) return false;
        on_message(time_ns, offset, id);
      }
      at = record->end;
    }
    return true;
  }

  [[nodiscard]] Result<MessageView> message_at(ByteWindow& window, std::uint64_t offset) const override {
    const auto record = mcap_record_at(window, offset);
    if (!record || record->op != McapOp::message || record->data_bytes > kMaxPieceBytes ||
        record->data_bytes < kMessageHeadBytes) {
      return Error{Errc::corrupt_data, "there is no message where the index says", {}};
    }
    const auto bytes = window.at(record->data_at, static_cast<std::size_t>(record->data_bytes));
    if (bytes.size() < record->data_bytes) return Error{Errc::corrupt_data, "a message ends beyond its chunk", {}};
    McapFields fields{bytes};
    const auto id = fields.number<std::uint16_t>();
    fields.number<std::uint32_t>();
    const auto time_ns = fields.number<std::int64_t>();
    return MessageView{time_ns, id, bytes.subspan(kMessageHeadBytes)};
  }

  /// Reads channels and chunks from the summary at the end of the file. Returns false where it is missing or unusable.
  [[nodiscard]] bool read_summary(const BagFile& file, ByteWindow& window) {
    if (file.size() < kMcapMagic.size() + kFooterBytes) return false;
    const auto last = mcap_record_at(window, file.size() - kFooterBytes);
    if (!last || last->op != McapOp::footer || last->data_bytes != 20) return false;
    const auto start = McapFields{window.at(last->data_at, 8)}.number<std::uint64_t>();
    if (start < kMcapMagic.size() || start > file.size() - kFooterBytes) return false;
    has_statistics_ = false;
    const auto on_record = [&](const McapRecord& record) {
      if (record.op == McapOp::chunk_index) add_chunk_index(file, window, record);
      if (record.op == McapOp::statistics) read_statistics(window, record);
    };
    if (!walk_from(
            window, start, [](auto, auto, auto) {}, on_record))
      return false;
    // Otherwise a scan of all records finds messages outside of chunks, and what the summary lacks.
    return is_good_ && has_statistics_ && !chunks.empty() && chunks.size() == chunk_count_;
  }

  /// Scans everything from the first record on.
  [[nodiscard]] Status scan(const BagFile& file, ByteWindow& window) {
    Status failed;
    std::uint64_t loose = 0;
    const auto on_record = [&](const McapRecord& record) {
      if (record.op == McapOp::chunk && failed.ok()) failed = scan_chunk_record(file, window, record);
    };
    const auto on_message = [&](std::int64_t, std::uint64_t, std::uint32_t id) {
      ++loose;
      ++counts[id];
    };
    const bool whole = walk_from(window, kMcapMagic.size(), on_message, on_record);
    if (!failed) return failed;
    if (loose > 0) {
      const std::uint64_t begin = kMcapMagic.size();
      chunks.push_back({begin, file.size() - begin, file.size() - begin, Packing::none, !whole, 0, 0, 0});
    }
    if (!whole) add_damage("it is cut or damaged at byte " + std::to_string(reached_));
    return {};
  }

 private:
  /// Walks records, ending at the footer, too.
  template <class OnRecord>
  bool walk_records(ByteWindow& window, std::uint64_t at, const OnRecord& on_record) {
    while (at < window.size()) {
      reached_ = at;
      const auto record = mcap_record_at(window, at);
      if (!record) return false;
      if (record->op != McapOp::chunk && record->end > window.size()) return false;
      on_record(*record, at);
      if (record->end > window.size()) return false;
      if (record->op == McapOp::footer) return true;
      at = record->end;
    }
    return true;
  }

  bool walk_from(ByteWindow& window, std::uint64_t from, const OnMessage& on_message,
                 const std::function<void(const McapRecord&)>& on_record) {
    return walk_records(window, from, [&](const McapRecord& record, std::uint64_t at) {
      if (record.op == McapOp::schema) add_schema(window, record);
      if (record.op == McapOp::channel) add_channel(window, record);
      if (record.op == McapOp::message && record.data_bytes >= kMessageHeadBytes) {
        McapFields fields{window.at(record.data_at, kMessageHeadBytes)};
        const auto id = fields.number<std::uint16_t>();
        fields.number<std::uint32_t>();
        const auto time_ns = fields.number<std::int64_t>();
        if (fields.ok()) on_message(time_ns, at, id);
      }
      if (on_record) on_record(record);
    });
  }

  static McapFields content(ByteWindow& window, const McapRecord& record) {
    if (record.data_bytes > kMaxPieceBytes) return McapFields{{}};
    return McapFields{window.at(record.data_at, static_cast<std::size_t>(record.data_bytes))};
  }

  void add_schema(ByteWindow& window, const McapRecord& record) {
    McapFields fields = content(window, record);
    const auto id = fields.number<std::uint16_t>();
    std::string name = fields.text();
    if (fields.ok()) schemas_[id] = ros1_type(name);
  }

  void add_channel(ByteWindow& window, const McapRecord& record) {
    McapFields fields = content(window, record);
    const auto id = fields.number<std::uint16_t>();
    const auto schema_id = fields.number<std::uint16_t>();
    std::string topic = fields.text();
    const std::string encoding = fields.text();
    if (!fields.ok()) return;
    const auto type = schemas_.find(schema_id);
    std::optional<messages::Wire> wire;
    if (encoding == "ros1") wire = messages::Wire::ros1;
    if (encoding == "cdr") wire = messages::Wire::cdr;
    channels[id] = {std::move(topic), type == schemas_.end() ? std::string{} : type->second, wire};
  }

  /// Returns a chunk's record, as far as the file goes.
  static std::optional<Chunk> chunk_at(const BagFile& file, ByteWindow& window, const McapRecord& record) {
    constexpr std::uint64_t kMaxName{64};
    McapFields fields{window.at(record.data_at, kChunkHeadBytes + 8 + kMaxName)};
    fields.bytes(16);
    Chunk chunk;
    chunk.size = fields.number<std::uint64_t>();
    fields.number<std::uint32_t>();
    const std::string packing = fields.text();
    const auto stored = fields.number<std::uint64_t>();
    if (!fields.ok()) return std::nullopt;
    chunk.packing = packing_of(packing);
    chunk.data_at = record.data_at + kChunkHeadBytes + packing.size() + 8;
    chunk.stored = std::min(stored, file.size() - chunk.data_at);
    chunk.is_damaged = stored > chunk.stored || chunk.data_at + chunk.stored > record.end;
    return chunk;
  }

  Status scan_chunk_record(const BagFile& file, ByteWindow& window, const McapRecord& record) {
    const auto found = chunk_at(file, window, record);
    return found ? scan_chunk(file, *found) : Status{};
  }

  void add_chunk_index(const BagFile& file, ByteWindow& window, const McapRecord& record) {
    McapFields fields = content(window, record);
    fields.bytes(16);
    const auto at = fields.number<std::uint64_t>();
    fields.number<std::uint64_t>();
    fields.bytes(fields.number<std::uint32_t>());  // where the message indexes of each channel are
    const auto index_bytes = fields.number<std::uint64_t>();
    ByteWindow chunk_window{file, 0, file.size()};
    const auto place = fields.ok() ? mcap_record_at(chunk_window, at) : std::nullopt;
    if (!place || place->op != McapOp::chunk || place->end > file.size() || index_bytes > file.size() - place->end) {
      is_good_ = false;
      return;
    }
    auto found = chunk_at(file, chunk_window, *place);
    is_good_ = is_good_ && found.has_value() && !found->is_damaged;
    if (!is_good_) return;
    found->index_at = place->end;
    found->index_bytes = index_bytes;
    chunks.push_back(*found);
  }

  void read_statistics(ByteWindow& window, const McapRecord& record) {
    McapFields fields = content(window, record);
    const auto message_count = fields.number<std::uint64_t>();
    fields.bytes(2 + 4 + 4 + 4);
    chunk_count_ = fields.number<std::uint32_t>();
    fields.bytes(16);
    const auto bytes = fields.number<std::uint32_t>();
    std::uint64_t total = 0;
    for (std::uint32_t n = 0; n < bytes / 10 && fields.ok(); ++n) {
      const auto id = fields.number<std::uint16_t>();
      const auto count = fields.number<std::uint64_t>();
      counts[id] = count;
      total += count;
    }
    has_statistics_ = fields.ok() && total == message_count;
  }

  std::map<std::uint16_t, std::string> schemas_;
  std::uint64_t chunk_count_{0};
  std::uint64_t reached_{0};
  bool has_statistics_{false};
  bool is_good_{true};
};

}  // namespace

bool begins_as_mcap(std::span<const std::byte> bytes) {
  return bytes.size() >= kMcapMagic.size() &&
         std::ranges::equal(bytes.first(kMcapMagic.size()), std::as_bytes(std::span{kMcapMagic}));
}

Result<std::unique_ptr<BagFormat>> read_mcap(const BagFile& file) {
  ByteWindow window{file, 0, file.size()};
  auto bag = std::make_unique<Mcap>();
  if (bag->read_summary(file, window)) return std::unique_ptr<BagFormat>{std::move(bag)};
  ByteReader ending{window.at(file.size() - std::min<std::uint64_t>(8, file.size()), 8)};
  const bool finished = file.size() >= 16 && begins_as_mcap(ending.take(ending.left()));
  bag = std::make_unique<Mcap>();
  SACCADE_CHECK(bag->scan(file, window));
  if (!finished && bag->damage.empty()) bag->add_damage("recording it was not finished");
  return std::unique_ptr<BagFormat>{std::move(bag)};
}

}  // namespace saccade::internal::io_bags
