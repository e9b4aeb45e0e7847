// SPDX-License-Identifier: Apache-2.0
#pragma once
// Workers: threads that answer requests, each of which can be cancelled by its name. C++17.

#include <atomic>
#include <functional>
#include <list>
#include <mutex>
#include <string>
#include <thread>

/// Threads that work on one thing each; joined when they are done, or when this ends.
class Workers {
 public:
  ~Workers();
  /// Returns false where kMost are at work already.
  static constexpr std::size_t kMost{16};
  bool start(std::function<void(const std::atomic<bool>& cancelled)> work, const std::string& name);
  void cancel(const std::string& name);
  void cancel_all();

 private:
  struct Worker {
    std::string name;
    std::atomic<bool> cancelled{false};
    std::atomic<bool> done{false};
    std::thread thread;
  };
  std::mutex mutex_;
  std::list<Worker> workers_;
};
