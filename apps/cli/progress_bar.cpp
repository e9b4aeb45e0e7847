// SPDX-License-Identifier: Apache-2.0
#include "progress_bar.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <iostream>

#include "exit_status.hpp"
#include "interrupt.hpp"

namespace saccade::cli {
namespace {

constexpr double kBarEvery_ms{50.0};
constexpr double kLineEvery_ms{2000.0};
constexpr std::size_t kBarWidth{30};

std::string count_text(std::size_t done, std::size_t total) {
  return total == 0 ? std::to_string(done) : std::to_string(done) + "/" + std::to_string(total);
}

}  // namespace

ProgressBar::ProgressBar(bool quiet, bool says) : quiet_{quiet}, says_{says}, terminal_{::isatty(STDERR_FILENO) == 1} {}

void ProgressBar::update(std::string_view stage, std::size_t done, std::size_t total) {
  if (quiet_) return;
  const std::lock_guard lock{mutex_};
  const bool new_stage = stage != stage_;
  const double now_ms = since_start_.elapsed_ms();
  const bool last = total != 0 && done == total;
  if (!new_stage && !last && now_ms - last_shown_ms_ < (terminal_ ? kBarEvery_ms : kLineEvery_ms)) return;
  stage_ = stage;
  last_shown_ms_ = now_ms;
  if (terminal_) {
    draw_bar(done, total);
  } else if (done > 0) {
    std::cerr << stage_ + ": " + count_text(done, total) + '\n' << std::flush;
  } else {
    std::cerr << stage_ + '\n' << std::flush;
  }
}

void ProgressBar::draw_bar(std::size_t done, std::size_t total) {
  std::string line{"\r\033[K" + stage_ + ' '};
  if (total != 0) {
    const std::size_t filled = kBarWidth * std::min(done, total) / total;
    line += '[' + std::string(filled, '=') + std::string(kBarWidth - filled, ' ') + "] ";
  }
  if (total != 0 || done != 0) line += count_text(done, total);
  std::cerr << line << std::flush;
  drawn_ = true;
}

void ProgressBar::wipe() {
  if (drawn_) std::cerr << "\r\033[K" << std::flush;
  drawn_ = false;
}

void ProgressBar::note(std::string_view line) {
  if (!quiet_) print_line(line);
}

void ProgressBar::warn(std::string_view line) { print_line(line); }

void ProgressBar::print_line(std::string_view line) {
  const std::lock_guard lock{mutex_};
  wipe();
  std::cerr << without_controls(line) + '\n' << std::flush;
}

std::optional<std::string> ProgressBar::ask(std::string_view question) {
  constexpr int kPoll_ms{100};
  finish();
  std::cerr << question << std::flush;
  std::string line;
  while (!interrupted()) {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (::poll(&input, 1, kPoll_ms) <= 0) continue;
    char c = 0;
    if (::read(STDIN_FILENO, &c, 1) != 1) return std::nullopt;
    if (c == '\n') return line;
    line.push_back(c);
  }
  return std::nullopt;
}

void ProgressBar::say(std::string_view line) {
  if (!says_) return note(line);
  const std::lock_guard lock{mutex_};
  wipe();
  std::cout << line << '\n' << std::flush;
}

void ProgressBar::finish() {
  const std::lock_guard lock{mutex_};
  wipe();
}

}  // namespace saccade::cli
