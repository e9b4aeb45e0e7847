// SPDX-License-Identifier: Apache-2.0
#include "server/service_thread.hpp"

#include <algorithm>
#include <utility>

namespace saccade::server {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::duration<double> kRemembered{0.5};

}  // namespace

ServiceThread::FairShare::FairShare(ServiceThread& thread) {
  const std::lock_guard lock{thread.mutex_};
  used_ = thread.most_;
}

void ServiceThread::post(std::function<void()> work) { wait_for({nullptr, std::move(work)}); }
void ServiceThread::post(FairShare& account, std::function<void()> work) { wait_for({&account, std::move(work)}); }

void ServiceThread::wait_for(Turn turn) {
  {
    const std::lock_guard lock{mutex_};
    if (finished_) return;
    if (turn.account == nullptr) {
      own_.push_back(std::move(turn));
    } else {
      turn.account->used_ = std::max(turn.account->used_, least_ - kRemembered);
      waiting_.push_back(std::move(turn));
    }
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

ServiceThread::Turn ServiceThread::next() {
  Turn turn;
  if (!own_.empty()) {
    turn = std::move(own_.front());
    own_.pop_front();
    return turn;
  }
  const auto least = std::min_element(waiting_.begin(), waiting_.end(), [](const Turn& a, const Turn& b) {
    return a.account->used_ < b.account->used_;  // at a tie the first, which waits longest
  });
  turn = std::move(*least);
  waiting_.erase(least);
  least_ = std::max(least_, turn.account->used_);
  return turn;
}

void ServiceThread::charge(FairShare& account, Used took) {
  const std::lock_guard lock{mutex_};
  account.used_ += std::min(took, kRemembered);
  most_ = std::max(most_, account.used_);
}

void ServiceThread::run() {
  for (;;) {
    Turn turn;
    {
      std::unique_lock lock{mutex_};
      changed_.wait(lock, [this] { return finishing_ || !own_.empty() || !waiting_.empty(); });
      finished_ = own_.empty() && waiting_.empty();
      if (finished_) return;
      turn = next();
    }
    const Clock::time_point begin = Clock::now();
    turn.work();
    if (turn.account != nullptr) charge(*turn.account, Clock::now() - begin);
  }
}

}  // namespace saccade::server
