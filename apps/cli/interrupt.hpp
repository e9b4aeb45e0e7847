// SPDX-License-Identifier: Apache-2.0
#pragma once
// Ctrl-C, SIGTERM, SIGHUP and SIGUSR2 (a scheduler's time limit is near): the first asks the work to stop and keep what
// it has, the second ends the program at once, unless it is SIGUSR2 again.

#include "saccade/core/progress.hpp"

namespace saccade::cli {

void install_interrupt_handler();

/// The signal that asked to stop; 0 without one.
[[nodiscard]] int interrupt_signal();
[[nodiscard]] inline bool interrupted() { return interrupt_signal() != 0; }
/// Tells whether the signal was that of a time limit.
[[nodiscard]] bool time_is_up();
/// 128 + signal.
[[nodiscard]] inline int interrupt_status() { return 128 + interrupt_signal(); }

/// While this lives, an interruption cancels the given progress. Of several, it cancels the one that was made last; an
/// earlier one is cancelled as soon as the later ones are gone. They are made and destroyed by one thread.
class CancelOnInterrupt {
 public:
  explicit CancelOnInterrupt(Progress& progress);
  CancelOnInterrupt(const CancelOnInterrupt&) = delete;
  CancelOnInterrupt& operator=(const CancelOnInterrupt&) = delete;
  ~CancelOnInterrupt();

 private:
  Progress* earlier_;
};

}  // namespace saccade::cli
