// SPDX-License-Identifier: Apache-2.0
#pragma once
// spawn_shell: a child process that runs a line of shell. ProcessWatcher: ends a program whose caller has died.

#include <sys/types.h>

#include <string>

#include "saccade/core/result.hpp"
#include "saccade/io/files/file_io.hpp"

namespace saccade {

/// Runs /bin/sh -c LINE ARGUMENT with the given standard streams, default signals and a process group of its own.
[[nodiscard]] Result<pid_t> spawn_shell(const std::string& line, const std::string& argument, int in, int out, int err);

/// Process beside a program that survives the caller, even if that is killed. It then gives the program's group a
/// second to end by itself, half a second more after SIGTERM, and kills the rest.
class ProcessWatcher {
 public:
  [[nodiscard]] static Result<ProcessWatcher> start(pid_t group);
  ProcessWatcher(ProcessWatcher&&) noexcept = default;
  ProcessWatcher& operator=(ProcessWatcher&&) = delete;
  ProcessWatcher(const ProcessWatcher&) = delete;
  ProcessWatcher& operator=(const ProcessWatcher&) = delete;
  /// Dismisses the watcher. The program is not touched.
  ~ProcessWatcher();

 private:
  ProcessWatcher(pid_t pid, Descriptor to) : pid_{pid}, to_{std::move(to)} {}

  pid_t pid_;
  Descriptor to_;
};

}  // namespace saccade
