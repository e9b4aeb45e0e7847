// SPDX-License-Identifier: Apache-2.0
#include "saccade/devices/internal/pipe_tail.hpp"

#include <poll.h>

namespace saccade {

PipeTail::PipeTail(Descriptor pipe, Pipe stop)
    : pipe_{std::move(pipe)}, stop_{std::move(stop)}, thread_{[this] { drain(); }} {}

PipeTail::~PipeTail() {
  stop_.write_end.reset();
  thread_.join();
}

void PipeTail::drain() {
  std::array<char, 4096> chunk{};
  for (;;) {
    std::array<pollfd, 2> waits{{{pipe_.get(), POLLIN, 0}, {stop_.read_end.get(), POLLIN, 0}}};
    if (::poll(waits.data(), waits.size(), -1) < 0 && errno != EINTR) break;
    if (waits[1].revents != 0) break;
    if (waits[0].revents == 0) continue;
    const ssize_t got = ::read(pipe_.get(), chunk.data(), chunk.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    const std::lock_guard lock{mutex_};
    text_.append(chunk.data(), static_cast<std::size_t>(got));
    if (text_.size() > kMaxBytes) text_.erase(0, text_.size() - kMaxBytes);
  }
  const std::lock_guard lock{mutex_};
  ended_ = true;
  at_end_.notify_all();
}

std::string PipeTail::text(std::chrono::milliseconds longest_wait) const {
  std::unique_lock lock{mutex_};
  at_end_.wait_for(lock, longest_wait, [this] { return ended_; });
  return text_;
}

}  // namespace saccade
