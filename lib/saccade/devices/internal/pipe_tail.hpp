// SPDX-License-Identifier: Apache-2.0
#pragma once
// PipeTail: drains a pipe in the background and keeps the end of what came.

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "saccade/io/files/file_io.hpp"

namespace saccade {

/// Whoever writes into the pipe never waits for a reader, however much it writes and whatever the program does
/// meanwhile. Methods may be called from any thread.
class PipeTail {
 public:
  /// Bytes that are kept.
  static constexpr std::size_t kMaxBytes{4096};

  /// @param stop any new pipe: closing it is how the background is told to end. Throws std::system_error where the
  ///             system gives no thread.
  PipeTail(Descriptor pipe, Pipe stop);
  PipeTail(const PipeTail&) = delete;
  PipeTail& operator=(const PipeTail&) = delete;
  /// Does not wait for the pipe's end.
  ~PipeTail();

  /// The last kMaxBytes, after waiting for the pipe's end, but no longer than given.
  [[nodiscard]] std::string text(std::chrono::milliseconds longest_wait) const;

 private:
  void drain();

  Descriptor pipe_;
  Pipe stop_;
  mutable std::mutex mutex_;
  mutable std::condition_variable at_end_;
  std::string text_;
  bool ended_{false};
  std::thread thread_;  // last: it uses all others
};

}  // namespace saccade
