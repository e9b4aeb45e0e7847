// SPDX-License-Identifier: Apache-2.0
#pragma once
// count_threads, ThreadWatch: how many threads the operating system knows of in this process.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <thread>

namespace saccade::test {

[[nodiscard]] inline std::size_t count_threads() {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator{"/proc/self/task"}, {}));
}

/// Counts again and again, in a thread of its own, until stopped.
class ThreadWatch {
 public:
  ThreadWatch() : thread_{[this] { watch(); }} {}
  ThreadWatch(const ThreadWatch&) = delete;
  ThreadWatch& operator=(const ThreadWatch&) = delete;
  ~ThreadWatch() { stop(); }

  /// The largest count since the start, the watching thread not counted.
  std::size_t stop() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    return most_ - 1;
  }

 private:
  void watch() {
    while (!stop_) {
      most_ = std::max(most_, count_threads());
      std::this_thread::sleep_for(std::chrono::milliseconds{1});
    }
  }

  std::atomic<bool> stop_{false};
  std::size_t most_{1};
  std::thread thread_;
};

}  // namespace saccade::test
