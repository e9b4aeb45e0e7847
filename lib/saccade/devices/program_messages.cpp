// SPDX-License-Identifier: Apache-2.0
#include "saccade/devices/program_messages.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <system_error>

#include "saccade/devices/internal/external_process.hpp"
#include "saccade/devices/internal/ros_device.hpp"

namespace saccade {
namespace {

constexpr double kLongestWrite_s{86400.0};  // longest time of a write; finish() has its own limit

const RosProgram& program_of(RosVersion version) { return kRosPrograms[static_cast<std::size_t>(version)]; }

/// Returns a message as sent through the pipe: length of the head, head, bytes.
std::vector<std::byte> piped(std::string_view topic, const messages::MessageType& type, messages::Wire wire,
                             std::span<const std::byte> bytes) {
  nlohmann::json head{{"topic", topic}, {"type", type.name}, {"latched", true}, {"bytes", bytes.size()}};
  if (wire == messages::Wire::ros1) {
    head["md5"] = type.md5;
    head["definition"] = type.definition(wire);
  }
  const std::string line = head.dump();
  std::vector<std::byte> all;
  all.reserve(4 + line.size() + bytes.size());
  for (int shift = 0; shift < 32; shift += 8) all.push_back(static_cast<std::byte>(line.size() >> shift));
  const auto line_bytes = std::as_bytes(std::span{line});
  all.insert(all.end(), line_bytes.begin(), line_bytes.end());
  all.insert(all.end(), bytes.begin(), bytes.end());
  return all;
}

}  // namespace

Result<std::string> publisher_command(RosVersion version) {
  SACCADE_TRY(const std::string program, quoted_program(program_of(version), "publish"));
  return program + " publish";
}

messages::Wire wire_of(RosVersion version) {
  return version == RosVersion::ros1 ? messages::Wire::ros1 : messages::Wire::cdr;
}

Result<std::unique_ptr<ProgramMessages>> ProgramMessages::start(ProgramMessagesConfig config) {
  std::unique_ptr<ProgramMessages> started{new ProgramMessages{std::move(config)}};
  SACCADE_CHECK(started->launch());
  return started;
}

ProgramMessages::ProgramMessages(ProgramMessagesConfig config) : config_{std::move(config)} {}

Status ProgramMessages::launch() {
  SACCADE_TRY(process_, ExternalProcess::start({"publish", config_.command, {}, [this] { return gives_up_.load(); }}));
  try {
    writer_ = std::thread{[this] { write_all(); }};
  } catch (const std::system_error& e) {
    return Error{Errc::io_failure, std::string{"cannot start a thread: "} + e.what(), config_.command};
  }
  return {};
}

ProgramMessages::~ProgramMessages() {
  gives_up_ = true;
  {
    const std::lock_guard lock{mutex_};
    waiting_.clear();
    ends_ = true;
  }
  changed_.notify_all();
  if (writer_.joinable()) writer_.join();
}

Status ProgramMessages::add(std::string_view topic, const messages::MessageType& type, messages::Time /*time*/,
                            std::span<const std::byte> bytes) {
  Waiting message{std::string{topic}, piped(topic, type, config_.wire, bytes)};
  {
    const std::lock_guard lock{mutex_};
    if (failure_) return *failure_;
    std::erase_if(waiting_, [&](const Waiting& other) { return other.topic == message.topic; });
    waiting_.push_back(std::move(message));
  }
  changed_.notify_all();
  return {};
}

Status ProgramMessages::finish() {
  {
    std::unique_lock lock{mutex_};
    ends_ = true;
    changed_.notify_all();
    if (!changed_.wait_for(lock, config_.flush_limit, [this] { return written_; })) {
      gives_up_ = true;
      waiting_.clear();
    }
  }
  writer_.join();
  if (gives_up_) {
    return Error{Errc::io_failure,
                 "the last messages were not read within " + std::to_string(config_.flush_limit.count()) + " ms",
                 config_.command};
  }
  if (failure_) return *failure_;
  return process_->finish(config_.end_limit);
}

std::optional<ProgramMessages::Waiting> ProgramMessages::next() {
  std::unique_lock lock{mutex_};
  changed_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
  if (waiting_.empty()) return std::nullopt;
  Waiting message = std::move(waiting_.front());
  waiting_.pop_front();
  return message;
}

void ProgramMessages::write_all() {
  Status written;
  while (written.ok()) {
    const std::optional<Waiting> message = next();
    if (!message) break;
    written = process_->write_bytes({"publish", kLongestWrite_s}, message->bytes);
  }
  const std::lock_guard lock{mutex_};
  if (!written.ok()) failure_ = written.error();
  written_ = true;
  changed_.notify_all();
}

}  // namespace saccade
