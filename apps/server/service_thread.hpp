// SPDX-License-Identifier: Apache-2.0
#pragma once
// ServiceThread: does one thing after the other.

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace saccade::server {

class ServiceThread {
 public:
  ServiceThread() : thread_{[this] { run(); }} {}
  ServiceThread(const ServiceThread&) = delete;
  ServiceThread& operator=(const ServiceThread&) = delete;
  ~ServiceThread() { finish(); }

  /// Any thread may call. `work` does not throw. After finish() it is not done.
  void post(std::function<void()> work);
  /// Says that finish() is near: whoever can leave work undone does. Any thread may call both.
  void hurry() { hurries_ = true; }
  [[nodiscard]] bool hurries() const { return hurries_; }
  /// Does what waits, and what that posts, then ends.
  void finish();

 private:
  void run();

  std::atomic<bool> hurries_{false};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  bool finishing_{false};
  bool finished_{false};
  std::thread thread_;
};

}  // namespace saccade::server
