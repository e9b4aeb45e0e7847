// SPDX-License-Identifier: Apache-2.0
#pragma once
// ProgressBar: how far the work is, on standard error; a bar on a terminal, plain lines elsewhere.

#include <cstddef>
#include <mutex>
#include <string>
#include <string_view>

#include "saccade/core/clock.hpp"

namespace saccade::cli {

/// Safe to call from several threads.
class ProgressBar {
 public:
  /// quiet: prints nothing, notes included.
  explicit ProgressBar(bool quiet);
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar() { finish(); }

  /// total 0: unknown.
  void update(std::string_view stage, std::size_t done, std::size_t total);
  /// A line of its own, such as a frame that was skipped.
  void note(std::string_view line);
  /// Wipes the bar; lines stay.
  void finish();

 private:
  void draw_bar(std::size_t done, std::size_t total);
  void wipe();

  std::mutex mutex_;
  bool quiet_;
  bool terminal_;
  bool drawn_{false};
  std::string stage_;
  Stopwatch since_start_;
  double last_shown_ms_{-1e9};
};

}  // namespace saccade::cli
