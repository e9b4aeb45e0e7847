// SPDX-License-Identifier: Apache-2.0
#include "server/service_thread.hpp"

#include <utility>

namespace saccade::server {

void ServiceThread::post(std::function<void()> work) {
  {
    const std::lock_guard lock{mutex_};
    if (finished_) return;
    waiting_.push_back(std::move(work));
  }
  changed_.notify_one();
}

void ServiceThread::finish() {
  {
    const std::lock_guard lock{mutex_};
    finishing_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void ServiceThread::run() {
  for (;;) {
    std::function<void()> work;
    {
      std::unique_lock lock{mutex_};
      changed_.wait(lock, [this] { return finishing_ || !waiting_.empty(); });
      finished_ = waiting_.empty();
      if (finished_) return;
      work = std::move(waiting_.front());
      waiting_.pop_front();
    }
    work();
  }
}

}  // namespace saccade::server
