// SPDX-License-Identifier: Apache-2.0
#pragma once
// ExternalProcess: a program of the user's that is asked by lines over pipes; Request: one question and its time limit.

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

/// One question: its name in messages, and until when all of its answer must be there.
class Request {
 public:
  /// The time runs from here. Expects a valid time limit.
  Request(std::string name, double limit_s);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] double limit_s() const { return limit_s_; }
  /// Rounded up; 0 when the time is over.
  [[nodiscard]] int left_ms() const;

 private:
  std::string name_;
  double limit_s_;
  std::chrono::steady_clock::time_point end_;
};

/// invalid_argument unless it is positive and at most a day; `whose` is the context.
[[nodiscard]] Status validate_time_limit(double limit_s, const char* whose);

struct ProcessConfig {
  std::string role;  ///< what messages call it: "camera"
  std::string command;
  std::filesystem::path folder{};     ///< working directory; empty: the caller's
  std::function<bool()> cancelled{};  ///< asked while it is waited for; true: the answer under way gets 0.3 s more
};

/// Child process with pipes at its standard input and output, in a process group of its own, so that Ctrl-C reaches the
/// caller alone. Its standard error is drained all the time, and quoted when something goes wrong.
///
/// An error of write_line, read_line or read_bytes is final, for nobody knows what the next
/// byte would mean: every later call returns the same error. Errors are one line. One caller at a time. POSIX.
class ExternalProcess {
 public:
  /// The longest line that is read.
  static constexpr std::size_t kMaxLineBytes{std::size_t{1} << 16};

  /// Runs /bin/sh -c "exec COMMAND". A program that is not there shows at the first request.
  /// @return invalid_argument for an empty command; io_failure when the system gives no process, pipe or thread.
  [[nodiscard]] static Result<std::unique_ptr<ExternalProcess>> start(ProcessConfig config);
  ExternalProcess(const ExternalProcess&) = delete;
  ExternalProcess& operator=(const ExternalProcess&) = delete;
  /// Ends its input; after 1 s, SIGTERM to its group; after half a second more, SIGKILL; a program that hangs gets 0.15
  /// s each. Nothing of the group is left, and no zombie. ProcessWatcher does so for a caller that is killed.
  ~ExternalProcess();

  /// Writes a line, its end included. corrupt_data when the process has said something that nobody asked for.
  [[nodiscard]] Status write_line(const Request& request, std::string_view line);
  /// The next line of its output, without the end. io_failure: it ended, or time is over; cancelled; not_found: there
  /// is no such program; corrupt_data: no end within kMaxLineBytes.
  [[nodiscard]] Result<std::string> read_line(const Request& request);
  /// The next line if it comes within `longest`; nullopt: not yet. Errors: those of read_line, but for time.
  [[nodiscard]] Result<std::optional<std::string>> next_line(const Request& request, std::chrono::milliseconds longest);
  /// Writes a line although an answer is under way.
  [[nodiscard]] Status interject(const Request& request, std::string_view line);
  /// Exactly as many bytes as fit. io_failure as for read_line.
  [[nodiscard]] Status read_bytes(const Request& request, std::span<std::byte> bytes);

  /// Writes all bytes. Errors: those of write_line; what the program sends is not read.
  [[nodiscard]] Status write_bytes(const Request& request, std::span<const std::byte> bytes);
  /// Ends its input and waits for its end. io_failure: it goes on, or ends with another exit status than 0.
  [[nodiscard]] Status finish(std::chrono::milliseconds longest);

  /// write_line, then read_line.
  [[nodiscard]] Result<std::string> ask(const Request& request, std::string_view line);
  /// The error that an answer turned out to be, with the process named. unavailable: the process reports it itself and
  /// may be asked again. Any other: the answer made no sense; final.
  [[nodiscard]] Error refused(const Request& request, const Error& error);

  /// The error of a request whose time is over; final. `what` has not happened: "there is no answer".
  [[nodiscard]] Error late(const Request& request, const std::string& what);

  [[nodiscard]] pid_t pid() const { return pid_; }

 private:
  enum class Arrival { data, end, late };

  ExternalProcess(ProcessConfig config, pid_t pid, ProcessWatcher watcher, Descriptor to, Descriptor from, Pipe errors,
                  Pipe stop);
  [[nodiscard]] Arrival receive(const Request& request);
  [[nodiscard]] Arrival receive_at_once();
  /// Returns whether the pipe can be read, or written, before the request's time is over.
  [[nodiscard]] bool wait(pollfd pipe, const Request& request);
  [[nodiscard]] Status nothing_unasked(const Request& request);
  /// @param missing what does not come where the program has ended
  /// @param unread what has not happened where the time is over
  [[nodiscard]] Status write(const Request& request, std::span<const std::byte> bytes, const std::string& missing,
                             const char* unread);
  [[nodiscard]] bool gone_within(std::chrono::milliseconds longest) const;
  /// A line that has come; nullopt: none, or not all of it.
  [[nodiscard]] Result<std::optional<std::string>> take_line(const Request& request);
  [[nodiscard]] Error ended_before_line(const Request& request);
  /// @param missing what has not come: "the answer to hello"
  [[nodiscard]] Error ended(const std::string& missing, const char* stream = "output");
  [[nodiscard]] Error fail(Errc code, const std::string& what);
  [[nodiscard]] Error named(Errc code, std::string what) const;

  ProcessConfig config_;
  pid_t pid_;
  ProcessWatcher watcher_;
  Descriptor to_;
  Descriptor from_;
  PipeTail errors_;
  std::string received_;  ///< and not read yet
  bool has_answered_{false};
  bool hangs_{false};
  std::optional<std::chrono::steady_clock::time_point> cancelled_at_;  ///< during this request
  std::optional<Error> failure_;
};

}  // namespace saccade
