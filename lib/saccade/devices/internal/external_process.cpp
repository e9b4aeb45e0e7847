// SPDX-License-Identifier: Apache-2.0
#include "saccade/devices/internal/external_process.hpp"

#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <system_error>
#include <thread>

#include "saccade/io/files/text_scan.hpp"

namespace saccade {
namespace {

constexpr std::chrono::milliseconds kCloseGrace{1000};
constexpr std::chrono::milliseconds kTerminateGrace{500};
constexpr std::chrono::milliseconds kExitStatusWait{500};  // between the end of the output and that of the process
constexpr std::chrono::milliseconds kLastWordsWait{100};
constexpr std::size_t kQuotedBytes{80};

constexpr const char* kRule{"an answer is one line of JSON and the bytes it announces; messages belong on stderr"};

Error system_error(const std::string& what, int code) {
  return {Errc::io_failure, what + ": " + std::strerror(code), {}};
}

/// Keeps SIGPIPE from the thread while it writes into a pipe that nobody may read any more.
class NoSigpipe {
 public:
  NoSigpipe() {
    sigset_t pending;
    sigpending(&pending);
    was_pending_ = sigismember(&pending, SIGPIPE) == 1;
    sigemptyset(&sigpipe_);
    sigaddset(&sigpipe_, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &sigpipe_, &before_);
  }
  NoSigpipe(const NoSigpipe&) = delete;
  NoSigpipe& operator=(const NoSigpipe&) = delete;
  ~NoSigpipe() {
    const timespec at_once{0, 0};
    if (!was_pending_) {
      while (sigtimedwait(&sigpipe_, nullptr, &at_once) < 0 && errno == EINTR) {
      }
    }
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }

 private:
  sigset_t sigpipe_{};
  sigset_t before_{};
  bool was_pending_{false};
};

/// A child with the given standard streams, default signals and a process group of its own.
Result<pid_t> spawn(const std::string& command, int in, int out, int err) {
  posix_spawn_file_actions_t streams;
  posix_spawn_file_actions_init(&streams);
  posix_spawn_file_actions_adddup2(&streams, in, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&streams, out, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&streams, err, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t signals;
  sigfillset(&signals);
  posix_spawnattr_setsigdefault(&attributes, &signals);
  sigemptyset(&signals);
  posix_spawnattr_setsigmask(&attributes, &signals);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);

  std::string shell{"sh"};
  std::string option{"-c"};
  std::string text{"exec " + command};
  const std::array<char*, 4> arguments{shell.data(), option.data(), text.data(), nullptr};
  pid_t pid = -1;
  const int code = ::posix_spawn(&pid, "/bin/sh", &streams, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&streams);
  posix_spawnattr_destroy(&attributes);
  if (code != 0) return system_error("cannot start a process", code);
  return pid;
}

/// How a child ended; nullopt while it runs. It stays a zombie, so that its number remains its own.
std::optional<siginfo_t> end_of(pid_t pid) {
  siginfo_t info{};
  const int result = ::waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOHANG | WNOWAIT);
  if (result == 0 && info.si_pid == 0) return std::nullopt;
  if (result != 0) info = {};  // somebody else has cleared it away
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

Result<std::unique_ptr<ExternalProcess>> ExternalProcess::start(std::string role, std::string command) {
  const std::string who = role;
  if (command.find_first_not_of(" \t\n") == std::string::npos) {
    return Error{Errc::invalid_argument, "a command is needed", who};
  }
  SACCADE_TRY(Pipe in, Pipe::create());
  SACCADE_TRY(Pipe out, Pipe::create());
  SACCADE_TRY(Pipe errors, Pipe::create());
  SACCADE_TRY(Pipe stop, Pipe::create());
  SACCADE_TRY(const pid_t pid, spawn(command, in.read_end.get(), out.write_end.get(), errors.write_end.get()));
  in.write_end.make_nonblocking();
  out.read_end.make_nonblocking();
  errors.write_end.reset();
  try {
    return std::unique_ptr<ExternalProcess>{new ExternalProcess{std::move(role), std::move(command), pid,
                                                                std::move(in.write_end), std::move(out.read_end),
                                                                std::move(errors), std::move(stop)}};
  } catch (const std::system_error& e) {
    ::kill(-pid, SIGKILL);
    ::waitpid(pid, nullptr, 0);
    return Error{Errc::io_failure, std::string{"cannot start a thread: "} + e.what(), who};
  }
}

ExternalProcess::ExternalProcess(std::string role, std::string command, pid_t pid, Descriptor to, Descriptor from,
                                 Pipe errors, Pipe stop)
    : role_{std::move(role)},
      command_{std::move(command)},
      pid_{pid},
      to_{std::move(to)},
      from_{std::move(from)},
      errors_{std::move(errors.read_end), std::move(stop)} {}

ExternalProcess::~ExternalProcess() {
  to_.reset();
  if (!gone_within(kCloseGrace)) {
    ::kill(-pid_, SIGTERM);
    static_cast<void>(gone_within(kTerminateGrace));
  }
  // Until it is cleared away, running or not, the number of its group cannot be anybody else's.
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

ExternalProcess::Arrival ExternalProcess::receive(int longest_ms) {
  pollfd wait{from_.get(), POLLIN, 0};
  const int ready = ::poll(&wait, 1, longest_ms);
  if (ready == 0) return Arrival::late;
  std::array<char, std::size_t{1} << 16> chunk{};
  const ssize_t got = ready < 0 ? -1 : ::read(from_.get(), chunk.data(), chunk.size());
  if (got < 0 && (errno == EINTR || errno == EAGAIN)) return Arrival::data;  // none, but time may be left
  if (got <= 0) return Arrival::end;
  received_.append(chunk.data(), static_cast<std::size_t>(got));
  return Arrival::data;
}

Status ExternalProcess::nothing_unasked(const Request& request) {
  if (receive(0) == Arrival::end && received_.empty()) return ended("the answer to " + request.name());
  if (received_.empty()) return {};
  return fail(Errc::corrupt_data, "it sent, before it was asked for " + request.name() + ", '" +
                                      readable(received_, kQuotedBytes) + "'; " + kRule);
}

Status ExternalProcess::write_line(const Request& request, std::string_view line) {
  if (failure_) return *failure_;
  SACCADE_CHECK(nothing_unasked(request));
  const std::string text = std::string{line} + '\n';
  const NoSigpipe no_signal;
  for (std::size_t written = 0; written < text.size();) {
    const ssize_t put = ::write(to_.get(), text.data() + written, text.size() - written);
    if (put >= 0) {
      written += static_cast<std::size_t>(put);
    } else if (errno == EAGAIN) {
      pollfd wait{to_.get(), POLLOUT, 0};
      if (::poll(&wait, 1, request.left_ms()) == 0) return late(request, "it did not read the request");
    } else if (errno != EINTR) {
      return ended("the answer to " + request.name(), "input");
    }
  }
  return {};
}

Result<std::string> ExternalProcess::read_line(const Request& request) {
  if (failure_) return *failure_;
  const std::string answer = "the answer to " + request.name();
  std::size_t searched = 0;
  for (;;) {
    const std::size_t end = received_.find('\n', searched);
    if (end <= kMaxLineBytes) {  // npos is greater
      std::string line = received_.substr(0, end);
      received_.erase(0, end + 1);
      if (!line.empty() && line.back() == '\r') line.pop_back();
      has_answered_ = true;
      return line;
    }
    if (received_.size() > kMaxLineBytes) {
      return fail(Errc::corrupt_data, answer + " has no end of line within " + std::to_string(kMaxLineBytes) +
                                          " bytes; it begins '" + readable(received_, kQuotedBytes) + "'; " + kRule);
    }
    searched = received_.size();
    const Arrival arrival = receive(request.left_ms());
    if (arrival == Arrival::late) return late(request, "there is no answer");
    if (arrival == Arrival::end) {
      if (received_.empty()) return ended(answer);
      return ended("the end of " + answer + ", which begins '" + readable(received_, kQuotedBytes) + "'");
    }
  }
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
    const Arrival arrival = receive(request.left_ms());
    const std::string share = std::to_string(done) + " of the " + std::to_string(bytes.size()) + " bytes";
    if (arrival == Arrival::late) return late(request, "only " + share + " of the answer came");
    if (arrival == Arrival::end) return ended("all of the answer to " + request.name() + ": " + share + " came");
  }
}

Error ExternalProcess::late(const Request& request, const std::string& what) {
  const auto end = end_of(pid_);  // something that it has started may hold the pipes open
  std::ostringstream text;
  text << request.name() << " took longer than the " << request.limit_s() << " s allowed: " << what;
  text << (end ? "; the program itself " + in_words(*end)
               : "; see why it hangs, whether it flushes its output, or allow more time");
  return fail(Errc::io_failure, text.str());
}

Error ExternalProcess::ended(const std::string& missing, const char* stream) {
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
  return fail(error.code, "the answer to " + request.name() + " is wrong: " + error.to_string());
}

Error ExternalProcess::named(Errc code, std::string what) const {
  constexpr std::size_t kCommandBytes{120};
  return {code, std::move(what), role_ + " '" + readable(command_, kCommandBytes) + "'"};
}

Error ExternalProcess::fail(Errc code, const std::string& what) {
  const std::string words = last_lines(errors_.text(kLastWordsWait));
  failure_ = named(code, words.empty() ? what : what + "; its stderr ends: " + words);
  return *failure_;
}

}  // namespace saccade
