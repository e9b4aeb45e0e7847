// SPDX-License-Identifier: Apache-2.0
#pragma once
// ProgramMessages: messages to a program that publishes them. RosVersion, publisher_command: the programs for ROS. The
// pipe's protocol is in docs/guides/processes.md.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "saccade/core/names.hpp"
#include "saccade/io/messages/message_sink.hpp"

namespace saccade {

class ExternalProcess;

enum class RosVersion { ros1, ros2 };
inline constexpr auto kRosVersionNames =
    make_names<RosVersion>({{RosVersion::ros1, "ros"}, {RosVersion::ros2, "ros2"}});

/// Returns the command of the program that publishes. Answers unavailable when it is neither beside this program nor in
/// PATH.
[[nodiscard]] Result<std::string> publisher_command(RosVersion version);
/// Returns the message layout of a version.
[[nodiscard]] messages::Wire wire_of(RosVersion version);

struct ProgramMessagesConfig {
  std::string command;  ///< command line for a shell
  messages::Wire wire{messages::Wire::cdr};
  std::chrono::milliseconds flush_limit{5000};  ///< limit for sending the queue at the end
  std::chrono::milliseconds end_limit{3000};    ///< limit for the program to end after that
};

/// Writes messages to a program's standard input from its own thread, so that a slow program does not delay the caller.
/// A waiting message is replaced by a later one on its topic.
class ProgramMessages final : public messages::MessageSink {
 public:
  /// Starts the program. Errors: those of starting a process.
  [[nodiscard]] static Result<std::unique_ptr<ProgramMessages>> start(ProgramMessagesConfig config);
  ProgramMessages(const ProgramMessages&) = delete;
  ProgramMessages& operator=(const ProgramMessages&) = delete;
  /// Ends the program. Queued messages are lost unless finish() was called.
  ~ProgramMessages() override;

  [[nodiscard]] messages::Wire wire() const override { return config_.wire; }
  /// Queues the message. Answers io_failure when the program has ended, quoting its last words on standard error.
  [[nodiscard]] Status add(std::string_view topic, const messages::MessageType& type, messages::Time time,
                           std::span<const std::byte> bytes) override;
  /// Waits until all is written and the program has ended, within the two limits. Answers io_failure when it did not
  /// read everything in time, or ended with an error.
  [[nodiscard]] Status finish() override;

 private:
  struct Waiting {
    std::string topic;
    std::vector<std::byte> bytes;  ///< including its head
  };

  explicit ProgramMessages(ProgramMessagesConfig config);
  [[nodiscard]] Status launch();
  void write_all();
  /// Returns the next message to write; nullopt at the end.
  [[nodiscard]] std::optional<Waiting> next();

  ProgramMessagesConfig config_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Waiting> waiting_;
  bool ends_{false};     ///< no more messages will come
  bool written_{false};  ///< the thread has written all, or failed
  std::optional<Error> failure_;
  std::atomic<bool> gives_up_{false};
  std::unique_ptr<ExternalProcess> process_;
  std::thread writer_;
};

}  // namespace saccade
