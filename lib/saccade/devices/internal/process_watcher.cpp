// SPDX-License-Identifier: Apache-2.0
#include "saccade/devices/internal/process_watcher.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "saccade/devices/internal/no_sigpipe.hpp"

namespace saccade {
namespace {

// The end of the input signals the end of the caller; an orderly caller sends a line first.
constexpr const char* kWatch{
    "read line && exit 0; sleep 1; kill -s TERM -- -$0 && sleep 0.5; kill -s KILL -- -$0; exit 0"};

}  // namespace

Result<pid_t> spawn_shell(const std::string& line, const std::string& argument, int in, int out, int err) {
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
  std::string text{line};
  std::string name{argument};
  const std::array<char*, 5> arguments{shell.data(), option.data(), text.data(), name.data(), nullptr};
  pid_t pid = -1;
  const int code = ::posix_spawn(&pid, "/bin/sh", &streams, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&streams);
  posix_spawnattr_destroy(&attributes);
  if (code != 0) return Error{Errc::io_failure, std::string{"cannot start a process: "} + std::strerror(code), {}};
  return pid;
}

Result<ProcessWatcher> ProcessWatcher::start(pid_t group) {
  SACCADE_TRY(Pipe pipe, Pipe::create());
  const Descriptor nowhere{::open("/dev/null", O_RDWR | O_CLOEXEC)};
  SACCADE_TRY(const pid_t pid,
              spawn_shell(kWatch, std::to_string(group), pipe.read_end.get(), nowhere.get(), nowhere.get()));
  return ProcessWatcher{pid, std::move(pipe.write_end)};
}

ProcessWatcher::~ProcessWatcher() {
  if (to_.get() < 0) return;  // moved from
  const NoSigpipe no_signal;
  static_cast<void>(::write(to_.get(), "\n", 1));
  to_.reset();
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

}  // namespace saccade
