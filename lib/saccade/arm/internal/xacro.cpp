// SPDX-License-Identifier: Apache-2.0
#include "saccade/arm/internal/xacro.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "saccade/arm/internal/urdf_packages.hpp"
#include "saccade/core/names.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/text_scan.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using XacroClock = std::chrono::steady_clock;

constexpr std::size_t kMaxExpandedBytes{std::size_t{64} << 20U};
constexpr std::size_t kQuotedWords{4000};  ///< bytes of its messages that are kept
constexpr std::chrono::milliseconds kXacroSlice{50};

/// Returns the environment with ROS_PACKAGE_PATH set to the folders that are searched.
std::vector<std::string> environment_for(const UrdfConfig& config) {
  constexpr std::string_view kPaths{"ROS_PACKAGE_PATH="};
  std::vector<std::string> variables;
  for (char** variable = environ; variable != nullptr && *variable != nullptr; ++variable) {
    if (!std::string_view{*variable}.starts_with(kPaths)) variables.emplace_back(*variable);
  }
  const auto text = [](const fs::path& path) { return fs::absolute(path).string(); };
  variables.push_back(std::string{kPaths} + joined(package_search_paths(config), ":", text));
  return variables;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// Child process with its output and messages, in a process group of its own. Killed with its group at the end.
class XacroProcess {
 public:
  [[nodiscard]] static Result<XacroProcess> start(const fs::path& path, const UrdfConfig& config) {
    SACCADE_TRY(Pipe out, Pipe::create());
    SACCADE_TRY(Pipe errors, Pipe::create());
    const Descriptor nothing{::open("/dev/null", O_RDONLY | O_CLOEXEC)};
    posix_spawn_file_actions_t streams;
    posix_spawn_file_actions_init(&streams);
    posix_spawn_file_actions_adddup2(&streams, nothing.get(), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&streams, out.write_end.get(), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&streams, errors.write_end.get(), STDERR_FILENO);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t signals;
    sigfillset(&signals);
    posix_spawnattr_setsigdefault(&attributes, &signals);
    sigemptyset(&signals);
    posix_spawnattr_setsigmask(&attributes, &signals);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
    std::vector<std::string> arguments{"xacro", fs::absolute(path).string()};
    std::vector<std::string> variables = environment_for(config);
    pid_t pid{-1};
    const int code = ::posix_spawnp(&pid, "xacro", &streams, &attributes, pointers_to(arguments).data(),
                                    pointers_to(variables).data());
    posix_spawn_file_actions_destroy(&streams);
    posix_spawnattr_destroy(&attributes);
    if (code == ENOENT || code == EACCES)
      return Error{Errc::unavailable,
                   "is a xacro file, and there is no program xacro in PATH; where ROS is installed, run " +
                       xacro_command(path) + ", and give robot.urdf",
                   {}};
    if (code != 0) return Error{Errc::io_failure, std::string{"cannot start xacro: "} + std::strerror(code), {}};
    return XacroProcess{pid, std::move(out.read_end), std::move(errors.read_end)};
  }
  XacroProcess(XacroProcess&& other) noexcept
      : pid_{std::exchange(other.pid_, -1)}, out_{std::move(other.out_)}, errors_{std::move(other.errors_)} {}
  XacroProcess& operator=(XacroProcess&&) = delete;
  XacroProcess(const XacroProcess&) = delete;
  XacroProcess& operator=(const XacroProcess&) = delete;
  ~XacroProcess() {
    if (pid_ < 0) return;
    ::kill(-pid_, SIGKILL);
    while (!ended_ && ::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }

  /// Takes in what has arrived, waiting a little. Tells whether the process goes on.
  bool go_on() {
    std::array<pollfd, 2> pipes{pollfd{out_.get(), POLLIN, 0}, pollfd{errors_.get(), POLLIN, 0}};
    static_cast<void>(::poll(pipes.data(), pipes.size(), static_cast<int>(kXacroSlice.count())));
    if (pipes[0].revents != 0) take(out_, text_);
    if (pipes[1].revents != 0) take(errors_, words_);
    if (words_.size() > 2 * kQuotedWords) words_.erase(0, words_.size() - kQuotedWords);
    if (out_.get() >= 0) return true;
    const pid_t reaped = ::waitpid(pid_, &status_, WNOHANG);
    ended_ = reaped == pid_ || (reaped < 0 && errno == ECHILD);
    return !ended_;
  }
  /// Takes in the last words, once the process has ended.
  void finish() {
    errors_.make_nonblocking();
    while (take(errors_, words_)) {
    }
  }

  [[nodiscard]] std::string& text() { return text_; }
  [[nodiscard]] std::string words() const { return last_lines(words_); }
  /// Returns the exit status; 128 + signal for a process that a signal ended.
  [[nodiscard]] int status() const { return WIFSIGNALED(status_) ? 128 + WTERMSIG(status_) : WEXITSTATUS(status_); }

 private:
  XacroProcess(pid_t pid, Descriptor out, Descriptor errors)
      : pid_{pid}, out_{std::move(out)}, errors_{std::move(errors)} {}

  /// Reads once; false at the end, where the pipe is closed.
  static bool take(Descriptor& pipe, std::string& text) {
    constexpr std::size_t kChunk{1U << 16U};
    const std::size_t before = text.size();
    text.resize(before + kChunk);
    const ssize_t count = ::read(pipe.get(), text.data() + before, kChunk);
    text.resize(before + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    if (count > 0 || (count < 0 && errno == EINTR)) return true;
    pipe.reset();
    return false;
  }

  pid_t pid_;
  Descriptor out_;
  Descriptor errors_;
  std::string text_{};
  std::string words_{};
  int status_{0};
  bool ended_{false};
};

}  // namespace

bool has_xacro_elements(const std::string& text) {
  constexpr std::string_view kComment{"<!--"};
  constexpr std::string_view kElement{"<xacro:"};
  for (std::size_t i = text.find('<'); i != std::string::npos; i = text.find('<', i + 1)) {
    if (text.compare(i, kElement.size(), kElement) == 0) return true;
    if (text.compare(i, kComment.size(), kComment) != 0) continue;
    i = text.find("-->", i);
    if (i == std::string::npos) return false;
  }
  return false;
}

std::string xacro_command(const fs::path& path) {
  if (path.empty()) return "xacro FILE > robot.urdf";
  const std::string text = path.string();
  const auto plain = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           std::string_view{"_-./+:=@%,"}.find(c) != std::string_view::npos;
  };
  if (std::all_of(text.begin(), text.end(), plain)) return "xacro " + text + " > robot.urdf";
  std::string quoted;
  for (const char c : text) quoted += c == '\'' ? std::string{"'\\''"} : std::string{c};
  return "xacro '" + quoted + "' > robot.urdf";
}

Result<std::string> run_xacro(const fs::path& path, const UrdfConfig& config) {
  const auto fail = [](Errc code, const std::string& what) { return Error{code, what, {}}; };
  SACCADE_TRY(XacroProcess process, XacroProcess::start(path, config));
  const auto end = XacroClock::now() + std::chrono::duration_cast<XacroClock::duration>(
                                           std::chrono::duration<double>{config.xacro_timeout_s});
  while (process.go_on()) {
    if (config.cancelled && config.cancelled()) return fail(Errc::cancelled, "interrupted while xacro ran");
    if (process.text().size() > kMaxExpandedBytes)
      return fail(Errc::corrupt_data, "xacro writes more than 64 MiB; run " + xacro_command(path) + " to see what");
    if (XacroClock::now() < end) continue;
    std::ostringstream text;
    text << "xacro took longer than the " << config.xacro_timeout_s
         << " s allowed; run it by itself: " << xacro_command(path) << ", and give robot.urdf";
    return fail(Errc::io_failure, text.str());
  }
  process.finish();
  if (process.status() == 0 && !process.text().empty()) return std::move(process.text());
  const std::string words = process.words();
  return fail(Errc::corrupt_data,
              (process.status() == 0 ? "xacro wrote nothing"
                                     : "xacro failed with exit status " + std::to_string(process.status())) +
                  (words.empty() ? "" : ": " + words) + "; if it wants arguments, run " + xacro_command(path) +
                  " with them, and give robot.urdf");
}

}  // namespace saccade
