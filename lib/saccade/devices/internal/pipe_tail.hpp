// SPDX-License-Identifier: Apache-2.0
#pragma once
// PipeTail: drains a pipe in the background and keeps the end of its content.

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "saccade/io/files/file_io.hpp"

namespace saccade {

/// Drain of a pipe: its writer never waits for a reader, however much it writes and whatever this program does
/// meanwhile. Methods may be called from any thread.
class PipeTail {
 public:
  /// Number of bytes kept.
  static constexpr std::size_t kMaxBytes{4096};

  /// @param stop any new pipe: closing it ends the background thread. Throws std::system_error where the system
  /// provides no thread.
  PipeTail(Descriptor pipe, Pipe stop);
  PipeTail(const PipeTail&) = delete;
  PipeTail& operator=(const PipeTail&) = delete;
  /// Does not wait for the end of the pipe.
  ~PipeTail();

  /// Returns the last kMaxBytes, after waiting for the end of the pipe, but no longer than given.
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
