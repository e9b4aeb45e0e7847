// SPDX-License-Identifier: Apache-2.0
#include "saccade/annotate/internal/parallel_spread.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <memory>
#include <mutex>
#include <thread>

namespace saccade {
namespace {

using ReachedNodes = std::vector<PathBuckets::Reached>;

constexpr std::size_t kNodesAtOnce{64};
constexpr std::size_t kNodesAhead{6};
constexpr std::size_t kLengthsApart{2};  ///< buckets
constexpr std::size_t kEmptyQueue{std::numeric_limits<std::size_t>::max()};

/// State of one thread.
struct Worker {
  explicit Worker(PathBuckets buckets)
      : queue{std::move(buckets)}, nearest{queue.nearest_length().value_or(kEmptyQueue)} {}
  std::mutex mutex;  ///< guards the queue
  PathBuckets queue;
  std::atomic<std::size_t> nearest;  ///< shortest length in the queue
  ReachedNodes work;
  ReachedNodes found;
  std::vector<std::uint32_t> touched;
};

class ParallelSpread {
 public:
  ParallelSpread(const Neighbourhood& neighbourhood, std::span<PathReach> reaches, PathBuckets queue,
                 std::size_t threads)
      : neighbourhood_{neighbourhood}, reaches_{reaches}, nodes_left_{static_cast<std::int64_t>(queue.count())} {
    seats_.push_back(std::make_unique<Worker>(std::move(queue)));
    while (seats_.size() < threads) seats_.push_back(std::make_unique<Worker>(PathBuckets{neighbourhood}));
  }

  /// Runs a worker. The threads need not start together: the first begins, and does everything when no other comes.
  void run_worker() {
    const std::size_t seat = taken_seats_++;
    try {
      Worker& own = *seats_[seat];
      while (nodes_left_ > 0 && !failed_) {
        keep_found(own);
        take(own);
        if (own.work.empty()) std::this_thread::yield();
        go_through(own);
      }
    } catch (...) {
      failed_ = true;  // no thread waits for the nodes of this one
      throw;
    }
  }

  /// Returns the queue, empty and ready for use.
  PathBuckets finish(std::vector<std::uint32_t>& touched) && {
    for (const auto& seat : seats_) touched.insert(touched.end(), seat->touched.begin(), seat->touched.end());
    return std::move(seats_.front()->queue);
  }

 private:
  void keep_found(Worker& seat) {
    if (seat.found.empty()) return;
    const std::lock_guard lock{seat.mutex};
    for (const PathBuckets::Reached& found : seat.found) seat.queue.push(found.path, found.node);
    seat.found.clear();
    seat.nearest = seat.queue.nearest_length().value_or(kEmptyQueue);
  }

  /// Takes nodes from another queue where that is behind, as when its thread has no core to run on, and half of its
  /// nearest nodes when the own queue is empty.
  void take(Worker& own) {
    Worker* from = &own;
    for (const auto& seat : seats_) {
      if (seat->nearest < own.nearest - std::min(kLengthsApart, own.nearest.load()) && seat->nearest < from->nearest)
        from = seat.get();
    }
    const std::lock_guard lock{from->mutex};
    if (own.nearest == kEmptyQueue) {
      from->queue.take_half(own.work);
    } else {
      from->queue.take(kNodesAtOnce, own.work);
    }
    from->nearest = from->queue.nearest_length().value_or(kEmptyQueue);
  }

  void go_through(Worker& seat) {
    for (std::size_t i = 0; i < seat.work.size(); ++i) {
      if (i + kNodesAhead < seat.work.size()) fetch_edges(neighbourhood_, seat.work[i + kNodesAhead].node);
      const auto [path, node] = seat.work[i];
      const PathReach to_node = load_reach(reaches_[node]);
      if (path_of(to_node) != path) continue;  // a shorter path came in between
      seat.touched.push_back(node);
      for_nearer_neighbours(neighbourhood_, reaches_.data(), node, to_node, [&](std::uint32_t next, PathReach reach) {
        if (lower(next, reach)) seat.found.push_back({path_of(reach), next});
      });
    }
    nodes_left_ += static_cast<std::int64_t>(seat.found.size()) - static_cast<std::int64_t>(seat.work.size());
    seat.work.clear();
  }

  /// @return false where another thread was nearer.
  [[nodiscard]] bool lower(std::uint32_t node, PathReach reach) {
    const std::atomic_ref<PathReach> there{reaches_[node]};
    PathReach before = there.load(std::memory_order_relaxed);
    while (reach < before) {
      if (there.compare_exchange_weak(before, reach, std::memory_order_relaxed)) return true;
    }
    return false;
  }

  const Neighbourhood& neighbourhood_;
  std::span<PathReach> reaches_;
  std::vector<std::unique_ptr<Worker>> seats_;
  std::atomic<std::size_t> taken_seats_{0};
  std::atomic<std::int64_t> nodes_left_;  ///< in queues and being processed
  std::atomic<bool> failed_{false};
};

}  // namespace

void spread_in_parallel(const Neighbourhood& neighbourhood, std::span<PathReach> reaches, PathBuckets& queue,
                        const Executor& executor, std::vector<std::uint32_t>& touched) {
  ParallelSpread spread{neighbourhood, reaches, std::move(queue), executor.threads()};
  executor.parallel_for(executor.threads(), 1, [&](std::size_t, std::size_t) { spread.run_worker(); });
  queue = std::move(spread).finish(touched);
}

}  // namespace saccade
