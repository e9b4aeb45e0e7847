// SPDX-License-Identifier: Apache-2.0
#include "saccade/core/executor.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "saccade/core/names.hpp"
#include "saccade/core/result.hpp"

namespace saccade {

struct Executor::Impl {
  Backend backend{Backend::sequential};
  std::size_t threads{1};
  std::unique_ptr<oneapi::tbb::global_control> allowance;  // more threads than cores were asked for
  mutable std::unique_ptr<oneapi::tbb::task_arena> arena;  // thread-safe by itself
};

namespace {

using Body = std::function<void(std::size_t, std::size_t)>;

void run_chunk(std::size_t chunk, std::size_t count, std::size_t grain, const Body& body) {
  const std::size_t begin = chunk * grain;
  body(begin, std::min(begin + grain, count));
}

void run_on_threads(std::size_t threads, std::size_t chunks, std::size_t count, std::size_t grain, const Body& body) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  auto work = [&] {
    for (std::size_t chunk = next++; chunk < chunks; chunk = next++) {
      try {
        run_chunk(chunk, count, grain, body);
      } catch (...) {
        const std::lock_guard lock{failure_mutex};
        if (!failure) failure = std::current_exception();
        next = chunks;
      }
    }
  };
  std::vector<std::thread> helpers;
  for (std::size_t i = 1; i < std::min(threads, chunks); ++i) helpers.emplace_back(work);
  work();
  for (std::thread& helper : helpers) helper.join();
  if (failure) std::rethrow_exception(failure);
}

/// Returns the number of cores that this process may run on. std::thread::hardware_concurrency counts all of the
/// machine.
std::size_t available_cores() { return static_cast<std::size_t>(oneapi::tbb::info::default_concurrency()); }

}  // namespace

Executor::Executor() : impl_{std::make_shared<Impl>()} {}
Executor::Executor(std::shared_ptr<const Impl> impl) : impl_{std::move(impl)} {}

Executor Executor::with_threads(std::size_t threads) {
#if defined(SACCADE_EXECUTOR_STD_THREAD)
  return with_threads(threads, Backend::std_thread);
#else
  return with_threads(threads, Backend::tbb);
#endif
}

Executor Executor::with_threads(std::size_t threads, Backend backend) {
  constexpr std::size_t kMostThreads{256};
  threads = threads == 0 ? available_cores() : std::min(threads, std::max(kMostThreads, available_cores()));
  if (backend == Backend::sequential || threads == 1) return Executor{};
  auto impl = std::make_shared<Impl>();
  impl->backend = backend;
  impl->threads = threads;
  if (backend == Backend::tbb) {
    using oneapi::tbb::global_control;
    constexpr auto kLimit = global_control::max_allowed_parallelism;
    if (threads > available_cores()) impl->allowance = std::make_unique<global_control>(kLimit, threads);
    // The arena is made at once and within the limit, because oneTBB prints a warning where an arena asks for more.
    const std::size_t slots = std::min(threads, global_control::active_value(kLimit));
    impl->arena = std::make_unique<oneapi::tbb::task_arena>(static_cast<int>(slots));
    impl->arena->initialize();
  }
  return Executor{std::move(impl)};
}

std::size_t Executor::threads() const { return impl_->threads; }
Executor::Backend Executor::backend() const { return impl_->backend; }

std::string_view Executor::backend_name() const {
  constexpr auto kNames = make_names<Backend>(
      {{Backend::sequential, "sequential"}, {Backend::tbb, "tbb"}, {Backend::std_thread, "std-thread"}});
  return kNames.of(impl_->backend);
}

void Executor::parallel_for(std::size_t count, std::size_t grain, const Body& body) const {
  SACCADE_EXPECTS(grain > 0);
  const std::size_t chunks = (count + grain - 1) / grain;
  if (chunks <= 1 || impl_->backend == Backend::sequential) {
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) run_chunk(chunk, count, grain, body);
  } else if (impl_->backend == Backend::tbb) {
    const auto run = [&] {
      oneapi::tbb::parallel_for(
          std::size_t{0}, chunks, [&](std::size_t chunk) { run_chunk(chunk, count, grain, body); },
          oneapi::tbb::simple_partitioner{});
    };
    // Isolated: while the caller waits for its last chunks, it must not run chunks of another loop. Their body might
    // want a lock that the caller holds, such as a map's.
    impl_->arena->execute([&] { oneapi::tbb::this_task_arena::isolate(run); });
  } else {
    run_on_threads(impl_->threads, chunks, count, grain, body);
  }
}

}  // namespace saccade
