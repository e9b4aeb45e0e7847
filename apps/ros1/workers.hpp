// SPDX-License-Identifier: Apache-2.0
#pragma once
// Workers: threads that answer requests and can be cancelled by name. C++17.

#include <atomic>
#include <functional>
#include <list>
#include <mutex>
#include <string>
#include <thread>

/// Threads with one task each; joined when they finish, or at the end of this object.
class Workers {
 public:
  ~Workers();
  /// Returns false where kMost threads are running already.
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
