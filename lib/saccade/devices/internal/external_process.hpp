// SPDX-License-Identifier: Apache-2.0
#pragma once
// ExternalProcess: a user's program that answers requests in lines over pipes. Request: one request and its time limit.

#include <poll.h>
#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "saccade/core/result.hpp"
#include "saccade/devices/internal/pipe_tail.hpp"
#include "saccade/devices/internal/process_watcher.hpp"
#include "saccade/io/files/file_io.hpp"

namespace saccade {

/// Request: its name in messages, and the time by which its whole answer must be there.
class Request {
 public:
  /// Starts the time limit. Expects a valid one.
  Request(std::string name, double limit_s);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] double limit_s() const { return limit_s_; }
  /// Returns the remaining time, rounded up; 0 when it is over.
  [[nodiscard]] int left_ms() const;

 private:
  std::string name_;
  double limit_s_;
  std::chrono::steady_clock::time_point end_;
};

/// Answers invalid_argument unless the limit is positive and at most a day; `whose` is the context.
[[nodiscard]] Status validate_time_limit(double limit_s, const char* whose);

struct ProcessConfig {
  std::string role;  ///< name in messages: "camera"
  std::string command;
  std::filesystem::path folder{};     ///< working directory; empty: the caller's
  std::function<bool()> cancelled{};  ///< polled while waiting; true: the current answer gets 0.3 s more
};

/// Child process with pipes at its standard input and output, in its own process group, so that Ctrl-C reaches only the
/// caller. Its standard error is drained continuously, and quoted in errors.
///
/// An error of write_line, read_line or read_bytes is final, because the meaning of the next byte is unknown: every
/// later call returns this error. Errors are one line. One caller at a time. POSIX.
class ExternalProcess {
 public:
  /// Longest line that is read.
  static constexpr std::size_t kMaxLineBytes{std::size_t{1} << 16};

  /// Runs /bin/sh -c "exec COMMAND". A missing program shows at the first request.
  /// @return invalid_argument for an empty command; io_failure when the system gives no process, pipe or thread.
  [[nodiscard]] static Result<std::unique_ptr<ExternalProcess>> start(ProcessConfig config);
  ExternalProcess(const ExternalProcess&) = delete;
  ExternalProcess& operator=(const ExternalProcess&) = delete;
  /// Closes its input; after 1 s, sends SIGTERM to its group; after half a second more, SIGKILL. A program that hangs
  /// gets 0.15 s each. Nothing of the group remains, and no zombie. ProcessWatcher does this for a caller that is
  /// killed.
  ~ExternalProcess();

  /// Writes a line and its end. Answers corrupt_data when the process has sent unrequested output.
  [[nodiscard]] Status write_line(const Request& request, std::string_view line);
  /// Returns the next line of its output, without the end. Answers io_failure when it ended or time is over; cancelled;
  /// not_found when the program does not exist; corrupt_data without an end within kMaxLineBytes.
  [[nodiscard]] Result<std::string> read_line(const Request& request);
  /// Returns the next line if it comes within `longest`; nullopt: not yet. Errors: those of read_line, except for time.
  [[nodiscard]] Result<std::optional<std::string>> next_line(const Request& request, std::chrono::milliseconds longest);
  /// Sets a line that is written at once, without waiting, when the process fails before the next request: the order to
  /// stop, for a program whose output ended or makes no sense. nullopt: none.
  void on_failure(std::optional<std::string> line) { last_line_ = std::move(line); }
  /// Writes a line while an answer is pending.
  [[nodiscard]] Status interject(const Request& request, std::string_view line);
  /// Reads exactly as many bytes as fit. Answers io_failure as read_line.
  [[nodiscard]] Status read_bytes(const Request& request, std::span<std::byte> bytes);

  /// Writes all bytes. Errors: those of write_line; output of the program is not read.
  [[nodiscard]] Status write_bytes(const Request& request, std::span<const std::byte> bytes);
  /// Closes its input and waits for its end. Answers io_failure when it continues, or ends with an exit status other
  /// than 0.
  [[nodiscard]] Status finish(std::chrono::milliseconds longest);

  /// Calls write_line, then read_line.
  [[nodiscard]] Result<std::string> ask(const Request& request, std::string_view line);
  /// Returns the error of an answer, with the process named. unavailable: the process reports it itself and may be
  /// asked again. Any other: the answer made no sense; final.
  [[nodiscard]] Error refused(const Request& request, const Error& error);

  /// Returns the error of a request whose time is over; final. `what` describes it: "there is no answer".
  [[nodiscard]] Error late(const Request& request, const std::string& what);

  [[nodiscard]] pid_t pid() const { return pid_; }

 private:
  enum class Arrival { data, end, late };

  ExternalProcess(ProcessConfig config, pid_t pid, ProcessWatcher watcher, Descriptor to, Descriptor from, Pipe errors,
                  Pipe stop);
  [[nodiscard]] Arrival receive(const Request& request);
  [[nodiscard]] Arrival receive_at_once();
  /// Tells whether the pipe can be read, or written, before the request's time is over.
  [[nodiscard]] bool wait(pollfd pipe, const Request& request);
  [[nodiscard]] Status nothing_unasked(const Request& request);
  /// @param missing what is missing if the program has ended
  /// @param unread what has not happened if the time is over
  [[nodiscard]] Status write(const Request& request, std::span<const std::byte> bytes, const std::string& missing,
                             const char* unread);
  [[nodiscard]] bool gone_within(std::chrono::milliseconds longest) const;
  /// Returns a line that has arrived; nullopt: none, or only part of it.
  [[nodiscard]] Result<std::optional<std::string>> take_line(const Request& request);
  [[nodiscard]] Error ended_before_line(const Request& request);
  /// @param missing what has not arrived: "the answer to hello"
  [[nodiscard]] Error ended(const std::string& missing, const char* stream = "output");
  void write_last_line();
  [[nodiscard]] Error fail(Errc code, const std::string& what);
  [[nodiscard]] Error named(Errc code, std::string what) const;

  ProcessConfig config_;
  pid_t pid_;
  ProcessWatcher watcher_;
  Descriptor to_;
  Descriptor from_;
  PipeTail errors_;
  std::string received_;  ///< and not yet returned
  bool has_answered_{false};
  bool hangs_{false};
  std::optional<std::chrono::steady_clock::time_point> cancelled_at_;  ///< during this request
  std::optional<std::string> last_line_;
  std::optional<Error> failure_;
};

}  // namespace saccade
