// SPDX-License-Identifier: Apache-2.0
#pragma once
// ProgressBar: how far the work is, on standard error; a bar on a terminal, plain lines elsewhere.

#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "saccade/core/clock.hpp"

namespace saccade::cli {

/// Safe to call from several threads.
class ProgressBar {
 public:
  /// @param quiet  prints no progress and no notes
  /// @param says   results for people go to standard output as they come; false: that is for the JSON result, and they
  ///               are notes
  explicit ProgressBar(bool quiet, bool says = true);
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar() { finish(); }

  /// total 0: unknown.
  void update(std::string_view stage, std::size_t done, std::size_t total);
  /// A line of its own, such as a frame that was skipped.
  void note(std::string_view line);
  /// Says a line of the result before the end, such as that of a view.
  void say(std::string_view line);
  /// Says on standard error, also when quiet, that a part of the work has failed while the rest goes on.
  void warn(std::string_view line);
  /// Asks on standard error, also when quiet, and waits for a line from standard input. Returns nullopt at the end of
  /// the input, or when the user interrupts.
  [[nodiscard]] std::optional<std::string> ask(std::string_view question);
  /// Wipes the bar; lines stay.
  void finish();

 private:
  void draw_bar(std::size_t done, std::size_t total);
  void wipe();
  void print_line(std::string_view line);

  std::mutex mutex_;
  bool quiet_;
  bool says_;
  bool terminal_;
  bool drawn_{false};
  std::string stage_;
  Stopwatch since_start_;
  double last_shown_ms_{-1e9};
};

}  // namespace saccade::cli
