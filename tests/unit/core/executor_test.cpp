// SPDX-License-Identifier: Apache-2.0
// parallel_for on every back end; how many threads run when several call at once; what a waiting thread does.
#include "saccade/core/executor.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "support/parallel_backend.hpp"
#include "support/thread_watch.hpp"

namespace saccade {
namespace {

constexpr bool kOnTbb{test::kParallelBackend == Executor::Backend::tbb};

void sleep_ms(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds{ms}); }

/// Threads in the bodies of loops: now, and at most so far.
class Busy {
 public:
  void work(int ms) {
    const int now = ++now_;
    int most = most_;
    while (most < now && !most_.compare_exchange_weak(most, now)) {
    }
    sleep_ms(ms);
    --now_;
  }
  [[nodiscard]] std::size_t most() const { return static_cast<std::size_t>(most_.load()); }

 private:
  std::atomic<int> now_{0};
  std::atomic<int> most_{0};
};

std::size_t cores() {
  cpu_set_t mask;
  EXPECT_EQ(::sched_getaffinity(0, sizeof(mask), &mask), 0);
  return static_cast<std::size_t>(CPU_COUNT(&mask));
}

constexpr const char* kRunsAgain{"SACCADE_TEST_RUNS_AGAIN"};

/// Tells whether this process is one that run_again() started.
bool runs_again() { return std::getenv(kRunsAgain) != nullptr; }

/// Runs the current test in a process of its own, after `prepare` was called in it. Returns its exit status, or -1
/// where it did not exit; 0 where exactly this test ran and passed.
template <class Prepare>
int run_again(const Prepare& prepare) {
  const testing::TestInfo* const info = testing::UnitTest::GetInstance()->current_test_info();
  const std::string filter = std::string{"--gtest_filter="} + info->test_suite_name() + "." + info->name();
  const pid_t child = ::fork();
  if (child == 0) {
    prepare();
    ::setenv(kRunsAgain, "1", 1);
    ::unsetenv("GTEST_TOTAL_SHARDS");  // a shard without this test would pass
    ::unsetenv("GTEST_SHARD_INDEX");
    ::execl("/proc/self/exe", "unit_core", filter.c_str(), nullptr);
    ::_exit(127);
  }
  int status{0};
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// Calls body(i) for i < count, each in a thread of its own.
template <class Body>
void in_threads(std::size_t count, const Body& body) {
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < count; ++i) threads.emplace_back([&body, i] { body(i); });
  for (std::thread& thread : threads) thread.join();
}

TEST(Executor, CoversTheRangeOnceInChunksThatDoNotDependOnTheThreads) {
  int loops{0};
  for (const Executor::Backend backend :
       {Executor::Backend::sequential, test::kParallelBackend, Executor::Backend::std_thread}) {
    for (const std::size_t threads : {1U, 2U, 7U}) {
      const Executor executor = Executor::with_threads(threads, backend);
      for (const std::size_t count : {0U, 1U, 8U, 100U, 1001U}) {
        for (const std::size_t grain : {1U, 7U, 2000U}) {
          std::vector<std::atomic<int>> visits(count);
          std::atomic<int> odd_chunks{0};
          executor.parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
            if (begin % grain != 0 || end != std::min(begin + grain, count)) ++odd_chunks;
            for (std::size_t i = begin; i < end; ++i) ++visits[i];
          });
          EXPECT_EQ(odd_chunks, 0);
          for (const std::atomic<int>& n : visits) ASSERT_EQ(n, 1);
          ++loops;
        }
      }
    }
  }
  EXPECT_EQ(loops, 135);
}

TEST(Executor, AbsurdNumbersOfThreadsAreCut) {
  for (const std::size_t threads : {std::size_t{1000000000}, std::numeric_limits<std::size_t>::max()}) {
    const Executor executor = Executor::with_threads(threads, test::kParallelBackend);
    EXPECT_EQ(executor.threads(), std::max<std::size_t>(256, cores()));
    std::atomic<int> ran{0};
    executor.parallel_for(100, 1, [&](std::size_t, std::size_t) { ++ran; });
    EXPECT_EQ(ran, 100);
  }
}

TEST(Executor, RethrowsWhatABodyThrows) {
  for (const Executor& executor : {Executor{}, Executor::with_threads(3, test::kParallelBackend)}) {
    const auto loop = [&] {
      executor.parallel_for(100, 1, [](std::size_t begin, std::size_t) {
        if (begin == 57) throw std::runtime_error{"57"};
      });
    };
    EXPECT_THROW(loop(), std::runtime_error);
  }
}

TEST(Executor, CallersAtOnceShareTheCores) {
  if (!kOnTbb) GTEST_SKIP() << "std::thread shares no threads";
  if (!runs_again()) {  // workers that earlier tests asked for may still be starting, and would count
    EXPECT_EQ(run_again([] {}), 0);
    return;
  }
  constexpr std::size_t kCallers{4};
  const std::size_t before = test::count_threads();
  Busy busy;
  test::ThreadWatch watch;
  in_threads(kCallers, [&](std::size_t) {
    const Executor mine = Executor::with_threads(0);
    for (int i = 0; i < 5; ++i) mine.parallel_for(50, 1, [&](std::size_t, std::size_t) { busy.work(1); });
  });
  EXPECT_LE(busy.most(), kCallers + cores() - 1);
  EXPECT_GE(busy.most(), std::min(kCallers, cores()));
  EXPECT_LE(watch.stop(), before + kCallers + cores() - 1);
}

TEST(Executor, CallersThatShareAnExecutorShareItsThreads) {
  if (!kOnTbb) GTEST_SKIP() << "std::thread shares no threads";
  const Executor shared = Executor::with_threads(2);
  Busy busy;
  std::atomic<int> ran{0};
  in_threads(5, [&](std::size_t) {
    shared.parallel_for(40, 1, [&](std::size_t, std::size_t) {
      busy.work(1);
      ++ran;
    });
  });
  EXPECT_LE(busy.most(), 2U);
  EXPECT_EQ(ran, 200);
}

TEST(Executor, MoreThreadsThanCoresRunAsLongAsTheyAreAskedFor) {
  if (!kOnTbb) GTEST_SKIP() << "std::thread shares no threads";
  using oneapi::tbb::global_control;
  const auto limit = [] { return global_control::active_value(global_control::max_allowed_parallelism); };
  const auto busiest = [](const Executor& executor, std::size_t expected) {
    Busy busy;
    for (int i = 0; i < 50 && busy.most() < expected; ++i) {  // workers may take their time to wake up
      executor.parallel_for(50, 1, [&](std::size_t, std::size_t) { busy.work(1); });
    }
    return busy.most();
  };
  testing::internal::CaptureStderr();
  const std::size_t usual = limit();
  const std::size_t many = cores() + 3;
  {
    const Executor executor = Executor::with_threads(many);
    EXPECT_EQ(busiest(executor, many), many);
    {
      const Executor more = Executor::with_threads(many + 5);
      EXPECT_EQ(more.threads(), many + 5);
      EXPECT_EQ(limit(), many) << "the smallest holds";
      EXPECT_LE(busiest(more, many), many);
    }
    const Executor copy = executor;  // NOLINT(performance-unnecessary-copy-initialization): it is the copy's life
    EXPECT_EQ(limit(), many);
  }
  EXPECT_EQ(limit(), usual);
  {
    const global_control program{global_control::max_allowed_parallelism, 1};
    const Executor executor = Executor::with_threads(many);
    EXPECT_EQ(limit(), 1U) << "the program's own limit stands";
    EXPECT_EQ(busiest(executor, 1), 1U);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "oneTBB warns";
}

TEST(Executor, AThreadThatWaitsRunsNoOtherLoop) {
  // The first caller holds a lock while it loops, as TsdfMap::integrate does; the second's bodies take it, as
  // TsdfMap::snapshot does. A first caller that helped the second while it waits would lock twice.
  const Executor shared = Executor::with_threads(2, test::kParallelBackend);
  constexpr int kRounds{20};
  std::mutex held;
  std::atomic<std::thread::id> holder{};
  std::atomic<int> helped{0};
  std::atomic<int> ran{0};
  for (int round = 0; round < kRounds; ++round) {
    in_threads(2, [&](std::size_t caller) {
      if (caller == 0) {
        const std::lock_guard lock{held};
        holder = std::this_thread::get_id();
        shared.parallel_for(4, 1, [&](std::size_t begin, std::size_t) { sleep_ms(begin == 3 ? 6 : 1); });
        holder = std::thread::id{};
      } else {
        sleep_ms(1);
        shared.parallel_for(20, 1, [&](std::size_t, std::size_t) {
          ++ran;
          if (holder.load() == std::this_thread::get_id()) {
            ++helped;
            return;
          }
          const std::lock_guard lock{held};
        });
      }
    });
  }
  EXPECT_EQ(helped, 0);
  EXPECT_EQ(ran, kRounds * 20);
}

TEST(Executor, AllCoresAreThoseThatTheProcessMayUse) {
  EXPECT_EQ(Executor::with_threads(0).threads(), cores());
  if (runs_again()) {
    EXPECT_EQ(cores(), 1U);
    return;
  }
  const int status = run_again([] {
    cpu_set_t mask;
    ::sched_getaffinity(0, sizeof(mask), &mask);
    int first{0};
    while (!CPU_ISSET(first, &mask)) ++first;
    CPU_ZERO(&mask);
    CPU_SET(first, &mask);
    ::sched_setaffinity(0, sizeof(mask), &mask);
  });
  EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace saccade
