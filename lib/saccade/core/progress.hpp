// SPDX-License-Identifier: Apache-2.0
#pragma once
// Progress and cancellation of long work.

#include <atomic>
#include <cstddef>
#include <functional>
#include <string_view>

namespace saccade {

/// Progress of long work, which calls report(). The caller may call request_cancel() from any thread and from signal
/// handlers. A default-constructed Progress is silent and never cancels by itself.
class Progress {
 public:
  /// stage: the work in progress; done: finished units out of total (total 0: unknown). Called from the working thread.
  using Callback = std::function<void(std::string_view stage, std::size_t done, std::size_t total)>;

  Progress() = default;
  explicit Progress(Callback callback) : callback_{std::move(callback)} {}

  void report(std::string_view stage, std::size_t done, std::size_t total) const {
    if (callback_) callback_(stage, done, total);
  }
  void request_cancel() noexcept { cancelled_.store(true, std::memory_order_relaxed); }
  [[nodiscard]] bool cancelled() const noexcept { return cancelled_.load(std::memory_order_relaxed); }

 private:
  Callback callback_;
  std::atomic<bool> cancelled_{false};
};

}  // namespace saccade
