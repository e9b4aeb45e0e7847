// SPDX-License-Identifier: Apache-2.0
#include "workers.hpp"

#include <ros/console.h>

Workers::~Workers() {
  cancel_all();
  for (Worker& worker : workers_) worker.thread.join();
}

bool Workers::start(std::function<void(const std::atomic<bool>&)> work, const std::string& name) {
  const std::scoped_lock lock{mutex_};
  workers_.remove_if([](Worker& worker) {
    if (!worker.done) return false;
    worker.thread.join();
    return true;
  });
  if (workers_.size() >= kMost) return false;
  Worker& worker = workers_.emplace_back();
  worker.name = name;
  worker.thread = std::thread{[&worker, work = std::move(work)] {
    try {
      work(worker.cancelled);
    } catch (const std::exception& error) {
      ROS_ERROR("%s: %s", worker.name.c_str(), error.what());
    }
    worker.done = true;
  }};
  return true;
}

void Workers::cancel(const std::string& name) {
  const std::scoped_lock lock{mutex_};
  for (Worker& worker : workers_) {
    if (worker.name == name) worker.cancelled = true;
  }
}

void Workers::cancel_all() {
  const std::scoped_lock lock{mutex_};
  for (Worker& worker : workers_) worker.cancelled = true;
}
