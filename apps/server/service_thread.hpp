// SPDX-License-Identifier: Apache-2.0
#pragma once
// ServiceThread: performs work one after the other. FairShare: the time used by one of its clients.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <list>
#include <mutex>
#include <thread>

namespace saccade::server {

/// Thread with start-time fair queuing (Goyal, Vin and Cheng, 1997). The client that has used the thread least runs
/// next, so heavy clients never delay light ones. Differences of more than half a second are forgotten: a client that
/// was idle cannot block the others for longer, and no client waits longer for time that it used alone.
class ServiceThread {
 public:
  /// Account of a client. A new one starts level with the one that has used most, so reconnecting gains nothing. It
  /// must outlive its work.
  class FairShare {
   public:
    explicit FairShare(ServiceThread& thread);

   private:
    friend class ServiceThread;
    std::chrono::duration<double> used_{0};
  };

  ServiceThread() : thread_{[this] { run(); }} {}
  ServiceThread(const ServiceThread&) = delete;
  ServiceThread& operator=(const ServiceThread&) = delete;
  ~ServiceThread() { finish(); }

  /// Post work; any thread may call. `work` must not throw. After finish() it is dropped. Work without an account
  /// precedes work of accounts, in the order of calls; each account's own work keeps its order, too.
  void post(std::function<void()> work);
  void post(FairShare& account, std::function<void()> work);
  /// Announces finish(): running work should skip whatever it can. Any thread may call both.
  void hurry() { hurries_ = true; }
  [[nodiscard]] bool hurries() const { return hurries_; }
  /// Performs waiting work, and work posted by it, then ends.
  void finish();

 private:
  using Used = std::chrono::duration<double>;
  struct Turn {
    FairShare* account{nullptr};  ///< null: the program's own work
    std::function<void()> work;
  };

  void wait_for(Turn turn);
  [[nodiscard]] Turn next();  ///< requires the mutex and waiting work
  void charge(FairShare& account, Used took);
  void run();

  std::atomic<bool> hurries_{false};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Turn> own_;     ///< without an account
  std::list<Turn> waiting_;  ///< in the order of calls; usually one per account
  Used least_{0};            ///< smallest time used by the next: the virtual time
  Used most_{0};             ///< largest time used by any account
  bool finishing_{false};
  bool finished_{false};
  std::thread thread_;
};

}  // namespace saccade::server
