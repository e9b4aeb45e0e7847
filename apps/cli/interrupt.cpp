// SPDX-License-Identifier: Apache-2.0
#include "interrupt.hpp"

#include <signal.h>
#include <unistd.h>

#include <atomic>

namespace saccade::cli {
namespace {

// A signal handler has no argument to reach these by.
std::atomic<int> caught{0};
std::atomic<Progress*> cancels{nullptr};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<Progress*>::is_always_lock_free);

extern "C" void on_signal(int signal) {
  if (signal == SIGUSR2) {  // may come twice; another signal still ends the program at once
    int none{0};
    if (!caught.compare_exchange_strong(none, signal)) return;
  } else if (caught.exchange(signal) != 0) {
    ::_exit(128 + signal);
  }
  if (Progress* progress = cancels.load()) progress->request_cancel();
}

}  // namespace

void install_interrupt_handler() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGUSR2, &action, nullptr);
  struct sigaction hangup {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);  // nohup stays what it is
  signal(SIGPIPE, SIG_IGN);                                               // a closed pipe becomes an error of the write
  signal(SIGXFSZ, SIG_IGN);                                               // and so does a file beyond the size limit
}

int interrupt_signal() { return caught.load(); }
bool time_is_up() { return interrupt_signal() == SIGUSR2; }

CancelOnInterrupt::CancelOnInterrupt(Progress& progress) : earlier_{cancels.exchange(&progress)} {
  if (interrupted()) progress.request_cancel();
}

CancelOnInterrupt::~CancelOnInterrupt() {
  cancels.store(earlier_);
  if (earlier_ != nullptr && interrupted()) earlier_->request_cancel();
}

}  // namespace saccade::cli
