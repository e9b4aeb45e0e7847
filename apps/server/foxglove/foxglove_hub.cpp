// SPDX-License-Identifier: Apache-2.0
#include "server/foxglove/foxglove_hub.hpp"

#include <algorithm>
#include <utility>

#include "server/http_server.hpp"

namespace saccade::server {
namespace {

constexpr std::chrono::milliseconds kLastWords{2000};

std::uint64_t nanoseconds_of(messages::Time time) {
  return time.sec < 0 ? 0 : static_cast<std::uint64_t>(time.sec) * 1'000'000'000 + time.nanosec;
}

}  // namespace

FoxgloveHub::FoxgloveHub() : session_{make_token()} {}

FoxgloveChannel& FoxgloveHub::channel_of(std::string_view topic, const messages::MessageType& type) {
  const auto found = std::find_if(channels_.begin(), channels_.end(),
                                  [topic](const FoxgloveChannel& channel) { return channel.topic == topic; });
  if (found != channels_.end()) return *found;
  const auto id = static_cast<std::uint32_t>(channels_.size() + 1);
  channels_.push_back({id, std::string{topic}, type.ros2_name(), type.definition(messages::Wire::cdr)});
  for (auto& [key, member] : members_) member.client.advertise(channels_.back());
  return channels_.back();
}

void FoxgloveHub::publish(std::string_view topic, const messages::MessageType& type, messages::Time time,
                          std::span<const std::byte> bytes) {
  const auto message =
      std::make_shared<const FoxgloveMessage>(FoxgloveMessage{nanoseconds_of(time), {bytes.begin(), bytes.end()}});
  const std::lock_guard lock{mutex_};
  FoxgloveChannel& channel = channel_of(topic, type);
  channel.newest = message;
  for (auto& [key, member] : members_) {
    member.client.send(channel.id, message);
    if (!member.client.is_idle()) member.wake();
  }
}

bool FoxgloveHub::is_all_written() const {
  return std::all_of(members_.begin(), members_.end(),
                     [](const auto& entry) { return entry.second.client.is_idle() && !entry.second.is_writing; });
}

bool FoxgloveHub::wait_until_written(std::chrono::milliseconds patience) {
  std::unique_lock lock{mutex_};
  return written_.wait_for(lock, patience, [this] { return is_all_written(); });
}

FoxgloveHub::ClientId FoxgloveHub::join(std::function<void()> wake) {
  const std::lock_guard lock{mutex_};
  members_.emplace(++last_id_, Member{FoxgloveClient{session_, channels_}, std::move(wake)});
  return last_id_;
}

void FoxgloveHub::leave(ClientId client) {
  const std::lock_guard lock{mutex_};
  members_.erase(client);
  written_.notify_all();
}

void FoxgloveHub::received(ClientId client, bool is_text, std::string_view message) {
  const std::lock_guard lock{mutex_};
  members_.at(client).client.received(is_text, message, channels_);
}

std::optional<FoxgloveFrame> FoxgloveHub::next(ClientId client) {
  const std::lock_guard lock{mutex_};
  Member& member = members_.at(client);
  std::optional<FoxgloveFrame> frame = member.client.next();
  member.is_writing = frame.has_value();
  if (!frame) written_.notify_all();
  return frame;
}

bool FoxgloveHub::may_read(ClientId client) {
  const std::lock_guard lock{mutex_};
  return members_.at(client).client.may_read();
}

FoxgloveSink::FoxgloveSink(std::shared_ptr<FoxgloveHub> hub, std::unique_ptr<HttpServer> server)
    : hub_{std::move(hub)}, server_{std::move(server)} {}

FoxgloveSink::~FoxgloveSink() = default;

Status FoxgloveSink::add(std::string_view topic, const messages::MessageType& type, messages::Time time,
                         std::span<const std::byte> bytes) {
  hub_->publish(topic, type, time, bytes);
  return {};
}

Status FoxgloveSink::finish() {
  static_cast<void>(hub_->wait_until_written(kLastWords));  // slower clients miss the rest
  return {};
}

}  // namespace saccade::server
