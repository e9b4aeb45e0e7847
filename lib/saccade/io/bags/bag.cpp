// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/bags/bags.hpp"

#include <algorithm>
#include <array>
#include <list>
#include <tuple>

#include "saccade/io/bags/internal/bag_format.hpp"

namespace saccade {
namespace internal::io_bags {

std::string ros1_type(std::string_view type) {
  constexpr std::string_view kMiddle{"/msg/"};
  std::string name{type};
  const std::size_t at = name.find(kMiddle);
  if (at != std::string::npos) name.replace(at, kMiddle.size(), "/");
  return name;
}

void BagFormat::add_damage(const std::string& what) { damage += (damage.empty() ? "" : "; ") + what; }

Result<UninitializedVector<std::byte>> BagFormat::unpack(const BagFile& file, const Chunk& chunk) {
  if (chunk.stored > kMaxPieceBytes) return Error{Errc::unsupported, "a chunk of more than 512 MiB", {}};
  ByteWindow window{file, chunk.data_at, chunk.stored};
  const auto packed = window.at(0, static_cast<std::size_t>(chunk.stored));
  return unpack_chunk(chunk.packing, packed, chunk.size, chunk.is_damaged);
}

Status BagFormat::scan_chunk(const BagFile& file, Chunk chunk) {
  const auto count = [this](std::int64_t, std::uint64_t, std::uint32_t channel) { ++counts[channel]; };
  chunk.index_bytes = 0;
  bool whole = !chunk.is_damaged;
  if (chunk.packing == Packing::none) {
    ByteWindow window{file, chunk.data_at, chunk.stored};
    whole = walk(window, count) && whole;
  } else {
    auto bytes = unpack(file, chunk);
    if (!bytes && bytes.error().code != Errc::corrupt_data) return bytes.error();
    if (!bytes) {
      whole = false;
      chunk.is_damaged = true;
      SACCADE_TRY(bytes, unpack(file, chunk));
    }
    ByteWindow window{*bytes};
    whole = walk(window, count) && whole;
  }
  if (!whole) add_damage("the chunk at byte " + std::to_string(chunk.data_at) + " is not whole");
  chunks.push_back(chunk);
  return {};
}

namespace {

constexpr std::uint64_t kCacheBytes{std::uint64_t{64} << 20U};

class OpenBag final : public Bag {
 public:
  OpenBag(std::filesystem::path path, BagFile file, std::unique_ptr<BagFormat> format)
      : path_{std::move(path)}, file_{std::move(file)}, format_{std::move(format)} {
    list_topics();
  }

  [[nodiscard]] const std::vector<BagTopic>& topics() const override { return topics_; }
  [[nodiscard]] const std::string& damage() const override { return format_->damage; }

  [[nodiscard]] Result<std::vector<BagEntry>> entries(std::span<const std::uint32_t> topics) override {
    std::vector<BagEntry> found;
    for (std::uint32_t i = 0; i < format_->chunks.size(); ++i) {
      const std::size_t before = found.size();
      const OnMessage add = [&](std::int64_t time_ns, std::uint64_t offset, std::uint32_t channel) {
        const auto topic = topic_of_.find(channel);
        if (topic == topic_of_.end() || std::ranges::find(topics, topic->second) == topics.end()) return;
        found.push_back({time_ns, offset, i, topic->second});
      };
      const Chunk& chunk = format_->chunks[i];
      if (chunk.index_bytes > 0 && format_->index(file_, chunk, add)) continue;
      found.resize(before);
      auto window = window_of(i);
      if (!window && window.error().code == Errc::corrupt_data && !chunk.is_damaged) {
        format_->chunks[i].is_damaged = true;  // from now on read as far as it goes
        format_->add_damage("the chunk at byte " + std::to_string(chunk.data_at) + " is not whole");
        window = window_of(i);
      }
      if (!window) return in_file(window.error(), path_);
      static_cast<void>(format_->walk(**window, add));
    }
    std::ranges::sort(found, {}, [](const BagEntry& e) { return std::tuple{e.time_ns, e.chunk, e.offset}; });
    return found;
  }

  [[nodiscard]] Result<BagMessage> read(const BagEntry& entry) override {
    SACCADE_EXPECTS(entry.chunk < format_->chunks.size() && entry.topic < topics_.size());
    auto window = window_of(entry.chunk);
    if (!window) return in_file(window.error(), path_);
    const auto view = format_->message_at(**window, entry.offset);
    if (!view) return in_file(view.error(), path_);
    const BagTopic& topic = topics_[entry.topic];
    const auto channel = topic_of_.find(view->channel);
    if (channel == topic_of_.end() || channel->second != entry.topic) {
      return Error{Errc::corrupt_data, "the index leads to a message of another topic", path_.string()};
    }
    return BagMessage{topic.name, topic.type, view->time_ns, topic.wire, {view->bytes.begin(), view->bytes.end()}};
  }

 private:
  void list_topics() {
    std::map<std::pair<std::string, std::string>, std::vector<std::uint32_t>> by_name;
    for (const auto& [id, channel] : format_->channels) by_name[{channel.topic, channel.type}].push_back(id);
    for (const auto& [name, ids] : by_name) {
      BagTopic topic{name.first, name.second, format_->channels[ids.front()].wire, 0};
      for (const std::uint32_t id : ids) {
        topic_of_[id] = static_cast<std::uint32_t>(topics_.size());
        topic.messages += format_->counts[id];
      }
      topics_.push_back(std::move(topic));
    }
  }

  /// Returns the bytes of a chunk: those of the file, or unpacked ones, which are cached. Valid until the next call.
  Result<ByteWindow*> window_of(std::uint32_t index) {
    const Chunk& chunk = format_->chunks[index];
    if (chunk.packing == Packing::none) {
      in_file_.move_to(chunk.data_at, chunk.stored);
      return &in_file_;
    }
    auto held = std::ranges::find(unpacked_, index, &Unpacked::chunk);
    if (held == unpacked_.end()) {
      SACCADE_TRY(UninitializedVector<std::byte> bytes, BagFormat::unpack(file_, chunk));
      unpacked_bytes_ += bytes.size();
      unpacked_.push_front({index, std::move(bytes)});
      while (unpacked_.size() > 1 && unpacked_bytes_ > kCacheBytes) {
        unpacked_bytes_ -= unpacked_.back().bytes.size();
        unpacked_.pop_back();
      }
    } else if (held != unpacked_.begin()) {
      unpacked_.splice(unpacked_.begin(), unpacked_, held);
    }
    in_memory_ = ByteWindow{unpacked_.front().bytes};
    return &in_memory_;
  }

  struct Unpacked {
    std::uint32_t chunk{0};
    UninitializedVector<std::byte> bytes;
  };

  std::filesystem::path path_;
  BagFile file_;
  std::unique_ptr<BagFormat> format_;
  std::vector<BagTopic> topics_;
  std::map<std::uint32_t, std::uint32_t> topic_of_;  ///< by channel
  std::list<Unpacked> unpacked_;                     ///< the last used first
  std::uint64_t unpacked_bytes_{0};
  ByteWindow in_file_{file_, 0, 0};
  ByteWindow in_memory_{std::span<const std::byte>{}};
};

}  // namespace
}  // namespace internal::io_bags

Result<std::unique_ptr<Bag>> Bag::open(const std::filesystem::path& path) {
  using namespace internal::io_bags;
  SACCADE_TRY(BagFile file, BagFile::open(path));
  std::array<std::byte, 16> start{};
  const std::span<const std::byte> begin{start.data(), file.read(0, start)};
  const auto read = [&]() -> Result<std::unique_ptr<BagFormat>> {
    if (begins_as_rosbag(begin)) return read_rosbag(file);
    if (begins_as_mcap(begin)) return read_mcap(file);
    if (as_text(begin).starts_with("#ROSBAG") || as_text(begin).starts_with("#ROSRECORD")) {
      return Error{Errc::unsupported, "this bag is older than format 2.0; convert it with `rosbag fix` of ROS 1", {}};
    }
    return Error{Errc::corrupt_data, "this is neither a bag of ROS 1 nor an MCAP file", {}};
  };
  auto format = read();
  if (!format) return in_file(format.error(), path);
  if ((*format)->channels.empty() && !(*format)->damage.empty()) {
    return Error{Errc::corrupt_data, "nothing in it can be read: " + (*format)->damage, path.string()};
  }
  return std::unique_ptr<Bag>{std::make_unique<OpenBag>(path, std::move(file), *std::move(format))};
}

std::optional<std::uint32_t> Bag::find(std::string_view topic) const {
  const auto found = std::ranges::find(topics(), topic, &BagTopic::name);
  if (found == topics().end()) return std::nullopt;
  return static_cast<std::uint32_t>(found - topics().begin());
}

std::string Bag::list(std::span<const std::string_view> types) const {
  std::string text;
  for (const BagTopic& topic : topics()) {
    if (!types.empty() && std::ranges::find(types, topic.type) == types.end()) continue;
    text += (text.empty() ? "" : ", ") + topic.name + " (" + (topic.type.empty() ? "no type" : topic.type) + ", " +
            std::to_string(topic.messages) + (topic.messages == 1 ? " message)" : " messages)");
  }
  return text.empty() ? "none" : text;
}

bool is_bag(const std::filesystem::path& path) {
  using namespace internal::io_bags;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  if (path.extension() == ".bag" || path.extension() == ".mcap") return true;
  const auto file = BagFile::open(path);
  if (!file) return false;
  std::array<std::byte, 16> start{};
  const std::span<const std::byte> begin{start.data(), file->read(0, start)};
  return begins_as_mcap(begin) || as_text(begin).starts_with("#ROSBAG") || as_text(begin).starts_with("#ROSRECORD");
}

}  // namespace saccade
