// SPDX-License-Identifier: Apache-2.0
#pragma once
// ServiceThread: does one thing after the other. Account: what one of those who share it has used.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <list>
#include <mutex>
#include <thread>

namespace saccade::server {

/// Whoever has used the thread least is next, as in start-time fair queuing (Goyal, Vin and Cheng, 1997): many who ask
/// much make nobody wait who asks little. Between two accounts no more than half a second is remembered: whoever was
/// idle does not hold up the others for longer, and nobody waits longer for what it used alone.
class ServiceThread {
 public:
  /// A new one begins as the one that has used most: to leave and come back gains nothing. It outlives its work.
  class Account {
   public:
    explicit Account(ServiceThread& thread);

   private:
    friend class ServiceThread;
    std::chrono::duration<double> used_{0};
  };

  ServiceThread() : thread_{[this] { run(); }} {}
  ServiceThread(const ServiceThread&) = delete;
  ServiceThread& operator=(const ServiceThread&) = delete;
  ~ServiceThread() { finish(); }

  /// Any thread may call both. `work` does not throw. After finish() it is not done. That of no account goes before
  /// that of accounts, in the order of calls; so does that of one account.
  void post(std::function<void()> work);
  void post(Account& account, std::function<void()> work);
  /// Says that finish() is near: whoever can leave work undone does. Any thread may call both.
  void hurry() { hurries_ = true; }
  [[nodiscard]] bool hurries() const { return hurries_; }
  /// Does what waits, and what that posts, then ends.
  void finish();

 private:
  using Used = std::chrono::duration<double>;
  struct Turn {
    Account* account{nullptr};  ///< none: of the program itself
    std::function<void()> work;
  };

  void wait_for(Turn turn);
  [[nodiscard]] Turn next();  ///< with the mutex held; something waits
  void charge(Account& account, Used took);
  void run();

  std::atomic<bool> hurries_{false};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Turn> own_;     ///< of no account
  std::list<Turn> waiting_;  ///< in the order of calls; one of each account, as a rule
  Used least_{0};            ///< what the next has used, at least: the virtual time
  Used most_{0};             ///< what any account has used
  bool finishing_{false};
  bool finished_{false};
  std::thread thread_;
};

}  // namespace saccade::server
