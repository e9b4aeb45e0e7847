// SPDX-License-Identifier: Apache-2.0
#include "saccade/devices/internal/external_process.hpp"

#include <poll.h>
#include <signal.h>
#include <sys/wait.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <system_error>
#include <thread>

#include "saccade/devices/internal/no_sigpipe.hpp"
#include "saccade/io/files/text_scan.hpp"

namespace saccade {
namespace {

constexpr std::chrono::milliseconds kCloseGrace{1000};
constexpr std::chrono::milliseconds kTerminateGrace{500};
constexpr std::chrono::milliseconds kHurriedGrace{150};  // replaces both for a program that hangs
constexpr std::chrono::milliseconds kCancelGrace{300};   // for the pending answer
constexpr std::chrono::milliseconds kCancelSlice{20};
constexpr std::chrono::milliseconds kExitStatusWait{500};  // between the end of the output and that of the process
constexpr std::chrono::milliseconds kLastWordsWait{30};    // short, because an arm may be moving while a camera fails
constexpr std::size_t kQuotedBytes{80};

constexpr const char* kRule{"an answer is one line of JSON and the bytes it announces; messages belong on stderr"};

/// Returns how a child ended; nullopt while it runs. It stays a zombie, so that its number is not reused.
std::optional<siginfo_t> end_of(pid_t pid) {
  siginfo_t info{};
  const int result = ::waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOHANG | WNOWAIT);
  if (result == 0 && info.si_pid == 0) return std::nullopt;
  if (result != 0) info = {};  // another part of the process has reaped it
  return info;
}

bool has_exited(const siginfo_t& info, int status) { return info.si_code == CLD_EXITED && info.si_status == status; }

std::string in_words(const siginfo_t& info) {
  if (info.si_code == CLD_EXITED) return "ended with exit status " + std::to_string(info.si_status);
  if (info.si_code != CLD_KILLED && info.si_code != CLD_DUMPED) return "ended";
  return "was ended by signal " + std::to_string(info.si_status) + " (" + ::strsignal(info.si_status) + ")";
}

}  // namespace

Status validate_time_limit(double limit_s, const char* whose) {
  constexpr double kDay_s{86400.0};
  if (limit_s > 0.0 && limit_s <= kDay_s) return {};
  return Error{Errc::invalid_argument, "a time limit must be positive and at most a day", whose};
}

Request::Request(std::string name, double limit_s)
    : name_{std::move(name)},
      limit_s_{limit_s},
      end_{std::chrono::steady_clock::now() +
           std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>{limit_s})} {
  SACCADE_EXPECTS(validate_time_limit(limit_s, "").ok());
}

int Request::left_ms() const {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(end_ - std::chrono::steady_clock::now()).count();
  constexpr decltype(left) kLongest{std::numeric_limits<int>::max()};
  return static_cast<int>(std::clamp<decltype(kLongest)>(left, 0, kLongest));
}

Result<std::unique_ptr<ExternalProcess>> ExternalProcess::start(ProcessConfig config) {
  const std::string who = config.role;
  if (config.command.find_first_not_of(" \t\n") == std::string::npos) {
    return Error{Errc::invalid_argument, "a command is needed", who};
  }
  SACCADE_TRY(Pipe in, Pipe::create());
  SACCADE_TRY(Pipe out, Pipe::create());
  SACCADE_TRY(Pipe errors, Pipe::create());
  SACCADE_TRY(Pipe stop, Pipe::create());
  // The folder is passed as the shell's $0, so that it needs no quotes.
  const std::string line = (config.folder.empty() ? "exec " : "cd -- \"$0\" && exec ") + config.command;
  const std::string folder = config.folder.empty() ? "sh" : config.folder.string();
  SACCADE_TRY(const pid_t pid,
              spawn_shell(line, folder, in.read_end.get(), out.write_end.get(), errors.write_end.get()));
  in.write_end.make_nonblocking();
  out.read_end.make_nonblocking();
  errors.write_end.reset();
  auto watcher = ProcessWatcher::start(pid);
  if (!watcher) {
    ::kill(-pid, SIGKILL);
    ::waitpid(pid, nullptr, 0);
    return watcher.error();
  }
  try {
    return std::unique_ptr<ExternalProcess>{new ExternalProcess{std::move(config), pid, *std::move(watcher),
                                                                std::move(in.write_end), std::move(out.read_end),
                                                                std::move(errors), std::move(stop)}};
  } catch (const std::system_error& e) {
    ::kill(-pid, SIGKILL);
    ::waitpid(pid, nullptr, 0);
    return Error{Errc::io_failure, std::string{"cannot start a thread: "} + e.what(), who};
  }
}

ExternalProcess::ExternalProcess(ProcessConfig config, pid_t pid, ProcessWatcher watcher, Descriptor to,
                                 Descriptor from, Pipe errors, Pipe stop)
    : config_{std::move(config)},
      pid_{pid},
      watcher_{std::move(watcher)},
      to_{std::move(to)},
      from_{std::move(from)},
      errors_{std::move(errors.read_end), std::move(stop)} {}

ExternalProcess::~ExternalProcess() {
  to_.reset();
  if (!gone_within(hangs_ ? kHurriedGrace : kCloseGrace)) {
    ::kill(-pid_, SIGTERM);
    static_cast<void>(gone_within(hangs_ ? kHurriedGrace : kTerminateGrace));
  }
  // Until it is reaped, running or not, its number and that of its group are not reused.
  const auto end = end_of(pid_);
  if (!end || end->si_pid == pid_) ::kill(-pid_, SIGKILL);
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

bool ExternalProcess::gone_within(std::chrono::milliseconds longest) const {
  const auto until = std::chrono::steady_clock::now() + longest;
  while (!end_of(pid_)) {
    if (std::chrono::steady_clock::now() >= until) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds{2});
  }
  return true;
}

bool ExternalProcess::wait(pollfd pipe, const Request& request) {
  using std::chrono::milliseconds;
  for (;;) {
    if (!cancelled_at_ && config_.cancelled && config_.cancelled()) cancelled_at_ = std::chrono::steady_clock::now();
    milliseconds left{request.left_ms()};
    if (cancelled_at_) {
      const auto grace = *cancelled_at_ + kCancelGrace - std::chrono::steady_clock::now();
      left = std::clamp(std::chrono::ceil<milliseconds>(grace), milliseconds{0}, left);
    }
    const milliseconds slice = config_.cancelled ? std::min(left, kCancelSlice) : left;
    if (::poll(&pipe, 1, static_cast<int>(slice.count())) != 0) return true;
    if (slice == left) return false;
  }
}

ExternalProcess::Arrival ExternalProcess::receive(const Request& request) {
  return wait({from_.get(), POLLIN, 0}, request) ? receive_at_once() : Arrival::late;
}

ExternalProcess::Arrival ExternalProcess::receive_at_once() {
  std::array<char, std::size_t{1} << 16> chunk{};
  const ssize_t got = ::read(from_.get(), chunk.data(), chunk.size());
  if (got < 0 && (errno == EINTR || errno == EAGAIN)) return Arrival::data;  // no data, but time may be left
  if (got <= 0) return Arrival::end;
  received_.append(chunk.data(), static_cast<std::size_t>(got));
  return Arrival::data;
}

Status ExternalProcess::nothing_unasked(const Request& request) {
  if (receive_at_once() == Arrival::end && received_.empty()) return ended("the answer to " + request.name());
  if (received_.empty()) return {};
  return fail(Errc::corrupt_data, "it sent, before it was asked for " + request.name() + ", '" +
                                      readable(received_, kQuotedBytes) + "'; " + kRule);
}

Status ExternalProcess::write_line(const Request& request, std::string_view line) {
  if (failure_) return *failure_;
  cancelled_at_.reset();
  SACCADE_CHECK(nothing_unasked(request));
  return interject(request, line);
}

Status ExternalProcess::interject(const Request& request, std::string_view line) {
  if (failure_) return *failure_;
  const std::string text = std::string{line} + '\n';
  return write(request, std::as_bytes(std::span{text}), "the answer to " + request.name(),
               "it did not read the request");
}

Status ExternalProcess::write_bytes(const Request& request, std::span<const std::byte> bytes) {
  if (failure_) return *failure_;
  cancelled_at_.reset();
  return write(request, bytes, "the end of its input", "it did not read all of it");
}

Status ExternalProcess::write(const Request& request, std::span<const std::byte> bytes, const std::string& missing,
                              const char* unread) {
  const NoSigpipe no_signal;
  while (!bytes.empty()) {
    const ssize_t put = ::write(to_.get(), bytes.data(), bytes.size());
    if (put >= 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(put));
    } else if (errno == EAGAIN) {
      if (!wait({to_.get(), POLLOUT, 0}, request)) return late(request, unread);
    } else if (errno != EINTR) {
      return ended(missing, "input");
    }
  }
  return {};
}

Status ExternalProcess::finish(std::chrono::milliseconds longest) {
  if (failure_) return *failure_;
  to_.reset();
  if (!gone_within(longest)) {
    hangs_ = true;
    return fail(Errc::io_failure, "it goes on running after the end of its input");
  }
  const siginfo_t info = end_of(pid_).value_or(siginfo_t{});
  if (has_exited(info, 0)) return {};
  return fail(Errc::io_failure, "it " + in_words(info) + " after the end of its input");
}

Result<std::string> ExternalProcess::read_line(const Request& request) {
  if (failure_) return *failure_;
  for (;;) {
    SACCADE_TRY(std::optional<std::string> line, take_line(request));
    if (line) return *std::move(line);
    const Arrival arrival = receive(request);
    if (arrival == Arrival::late) return late(request, "there is no answer");
    if (arrival == Arrival::end) return ended_before_line(request);
  }
}

Result<std::optional<std::string>> ExternalProcess::next_line(const Request& request,
                                                              std::chrono::milliseconds longest) {
  if (failure_) return *failure_;
  SACCADE_TRY(std::optional<std::string> line, take_line(request));
  if (line) return line;
  pollfd pipe{from_.get(), POLLIN, 0};
  if (::poll(&pipe, 1, static_cast<int>(longest.count())) == 0) return std::optional<std::string>{};
  if (receive_at_once() == Arrival::end) return ended_before_line(request);
  return take_line(request);
}

Result<std::optional<std::string>> ExternalProcess::take_line(const Request& request) {
  const std::size_t end = received_.find('\n');
  if (end <= kMaxLineBytes) {  // npos is greater
    std::string line = received_.substr(0, end);
    received_.erase(0, end + 1);
    if (!line.empty() && line.back() == '\r') line.pop_back();
    has_answered_ = true;
    return std::optional{std::move(line)};
  }
  if (received_.size() <= kMaxLineBytes) return std::optional<std::string>{};
  return fail(Errc::corrupt_data, "the answer to " + request.name() + " has no end of line within " +
                                      std::to_string(kMaxLineBytes) + " bytes; it begins '" +
                                      readable(received_, kQuotedBytes) + "'; " + kRule);
}

Error ExternalProcess::ended_before_line(const Request& request) {
  const std::string answer = "the answer to " + request.name();
  if (received_.empty()) return ended(answer);
  return ended("the end of " + answer + ", which begins '" + readable(received_, kQuotedBytes) + "'");
}

Status ExternalProcess::read_bytes(const Request& request, std::span<std::byte> bytes) {
  if (failure_) return *failure_;
  std::size_t done = 0;
  for (;;) {
    const std::size_t taken = std::min(received_.size(), bytes.size() - done);
    std::copy_n(std::as_bytes(std::span{received_}).begin(), taken, bytes.begin() + static_cast<std::ptrdiff_t>(done));
    received_.erase(0, taken);
    done += taken;
    if (done == bytes.size()) return {};
    const Arrival arrival = receive(request);
    const std::string share = std::to_string(done) + " of the " + std::to_string(bytes.size()) + " bytes";
    if (arrival == Arrival::late) return late(request, "only " + share + " of the answer came");
    if (arrival == Arrival::end) return ended("all of the answer to " + request.name() + ": " + share + " came");
  }
}

Error ExternalProcess::late(const Request& request, const std::string& what) {
  hangs_ = true;
  if (cancelled_at_) return fail(Errc::cancelled, request.name() + " was cancelled: " + what);
  const auto end = end_of(pid_);  // a process that it started may hold the pipes open
  std::ostringstream text;
  text << request.name() << " took longer than the " << request.limit_s() << " s allowed: " << what;
  text << (end ? "; the program itself " + in_words(*end)
               : "; see why it hangs, whether it flushes its output, or allow more time");
  return fail(Errc::io_failure, text.str());
}

void ExternalProcess::write_last_line() {
  if (!last_line_) return;
  const NoSigpipe no_signal;
  const std::string text = *std::exchange(last_line_, std::nullopt) + '\n';
  static_cast<void>(!::write(to_.get(), text.data(), text.size()));  // it has failed already; the pipe never blocks
}

Error ExternalProcess::ended(const std::string& missing, const char* stream) {
  write_last_line();
  if (!gone_within(kExitStatusWait)) {
    return fail(Errc::io_failure,
                std::string{"it closed its "} + stream + " before " + missing + ", and goes on running");
  }
  const siginfo_t info = end_of(pid_).value_or(siginfo_t{});
  constexpr int kNoSuchProgram{127};
  if (!has_answered_ && has_exited(info, kNoSuchProgram)) {
    return fail(Errc::not_found, "there is no such program; check the command, and the folder it is run in");
  }
  return fail(Errc::io_failure, "it " + in_words(info) + " before " + missing + "; run it by itself to see why");
}

Result<std::string> ExternalProcess::ask(const Request& request, std::string_view line) {
  SACCADE_CHECK(write_line(request, line));
  return read_line(request);
}

Error ExternalProcess::refused(const Request& request, const Error& error) {
  if (error.code == Errc::unavailable) return named(error.code, request.name() + " failed: " + error.message);
  if (error.code == Errc::io_failure) return fail(error.code, request.name() + " failed: " + error.message);
  return fail(error.code, "the answer to " + request.name() + " is wrong: " + error.to_string());
}

Error ExternalProcess::named(Errc code, std::string what) const {
  constexpr std::size_t kCommandBytes{120};
  return {code, std::move(what), config_.role + " '" + readable(config_.command, kCommandBytes) + "'"};
}

Error ExternalProcess::fail(Errc code, const std::string& what) {
  write_last_line();
  const std::string words = last_lines(errors_.text(kLastWordsWait));
  failure_ = named(code, words.empty() ? what : what + "; its stderr ends: " + words);
  return *failure_;
}

}  // namespace saccade
