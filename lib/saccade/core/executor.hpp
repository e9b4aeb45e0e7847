// SPDX-License-Identifier: Apache-2.0
#pragma once
// Executor: parallel_for over an index range, on oneTBB, on plain threads, or in the calling thread.

#include <cstddef>
#include <functional>
#include <memory>
#include <string_view>

namespace saccade {

/// Runs loops. Passed into every function that can use several threads; cheap to copy. Thread-safe.
/// Work must not depend on which thread or in which order an index runs: then results are the same for every count.
///
/// All executors of a process share one set of oneTBB workers, at most one fewer than the number of cores. Each calling
/// thread works along: n threads that call at once, each with its own executor, keep at most n + cores − 1 threads
/// busy. An executor made for more threads than cores raises "cores" to its number while it lives (of several such
/// executors, the smallest number counts). A smaller tbb::global_control of the program lowers it.
/// Threads that share one executor share its workers, so one loop may wait for another's. A thread that must not wait,
/// such as the one that fuses, needs its own executor.
class Executor {
 public:
  enum class Backend { sequential, tbb, std_thread };

  /// Runs everything in the calling thread.
  Executor();

  /// Creates an executor for `threads` ≥ 1 threads, or for all cores that the process may run on where `threads` is 0.
  /// The number is limited to 256 and to the number of cores. One thread is sequential. The back end is oneTBB, except
  /// in builds for ThreadSanitizer (SACCADE_EXECUTOR_STD_THREAD), which does not understand Debian's oneTBB. std_thread
  /// starts new threads in every loop and shares none.
  [[nodiscard]] static Executor with_threads(std::size_t threads);
  [[nodiscard]] static Executor with_threads(std::size_t threads, Backend backend);

  /// Returns the number of threads asked for; fewer may run.
  [[nodiscard]] std::size_t threads() const;
  [[nodiscard]] Backend backend() const;
  [[nodiscard]] std::string_view backend_name() const;

  /// Calls body(begin, end) on disjoint sub-ranges that cover [0, count), each at most `grain` long and starting at a
  /// multiple of it, so chunk boundaries do not depend on the thread count. The first exception thrown is rethrown.
  void parallel_for(std::size_t count, std::size_t grain,
                    const std::function<void(std::size_t begin, std::size_t end)>& body) const;

 private:
  struct Impl;
  explicit Executor(std::shared_ptr<const Impl> impl);
  std::shared_ptr<const Impl> impl_;
};

}  // namespace saccade
