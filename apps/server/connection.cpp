// SPDX-License-Identifier: Apache-2.0
#include "server/connection.hpp"

#include <exception>
#include <utility>

namespace saccade::server {
namespace {

constexpr std::uint16_t kPolicyViolation{1008};
constexpr std::uint16_t kInternalError{1011};

}  // namespace

Connection::Connection(ConnectionId id, const ServerConfig& config, ServiceThread& thread, Service& service,
                       ConnectionSlot seat, std::function<void()> wake)
    : id_{id},
      config_{config},
      thread_{thread},
      service_{service},
      seat_{std::move(seat)},
      wake_{std::move(wake)},
      account_{thread} {}

void Connection::open() {
  thread_.post([self = shared_from_this()] {
    try {
      self->service_.opened(self->id_);
    } catch (const std::exception&) {
      self->close({kInternalError, "a bug in the program", true});
    }
  });
}

void Connection::ask(Message message) {
  const std::lock_guard lock{mutex_};
  if (closing_) return;
  asked_bytes_ += message.size();
  asked_.push_back(std::move(message));
  schedule();
}

bool Connection::woken() {
  const std::lock_guard lock{mutex_};
  wake_pending_ = false;
  return closing_ && closing_->urgent;
}

bool Connection::may_read() {
  const std::lock_guard lock{mutex_};
  waits_to_read_ = asks_too_much();
  return !waits_to_read_;
}

Connection::Next Connection::next() {
  const std::lock_guard lock{mutex_};
  if (!told_.empty() && !(closing_ && closing_->urgent)) {
    Next next{std::move(told_.front()), std::nullopt};
    told_.pop_front();
    under_way_bytes_ = next.message->size();
    return next;
  }
  if (closing_ && !closing_taken_) {
    closing_taken_ = true;
    return {nullptr, closing_};
  }
  return {};
}

void Connection::written() {
  const std::lock_guard lock{mutex_};
  told_bytes_ -= under_way_bytes_;
  under_way_bytes_ = 0;
  schedule();
}

void Connection::end() {
  const std::lock_guard lock{mutex_};
  ended_ = true;
  told_.clear();
  told_bytes_ = 0;
  under_way_bytes_ = 0;
  schedule();
}

void Connection::send(SharedMessage message) {
  const std::lock_guard lock{mutex_};
  if (ended_ || closing_) return;
  const std::size_t bytes = message->size();
  if (told_bytes_ > 0 && told_bytes_ + bytes > config_.max_waiting_bytes) {
    close_locked({kPolicyViolation, "reads too slowly", true});
    return;
  }
  told_bytes_ += bytes;
  told_.push_back(std::move(message));
  wake();
}

void Connection::close(Closing closing) {
  const std::lock_guard lock{mutex_};
  close_locked(std::move(closing));
}

void Connection::close_locked(Closing closing) {
  if (ended_ || (closing_ && !closing.urgent)) return;
  if (closing.urgent) {
    told_.clear();
    told_bytes_ = under_way_bytes_;
  }
  closing_ = std::move(closing);
  asked_.clear();
  asked_bytes_ = 0;
  wake();
}

bool Connection::asks_too_much() const {
  return asked_.size() >= config_.max_waiting_messages || asked_bytes_ > 2 * config_.max_message_bytes;
}

void Connection::schedule() {
  if (scheduled_ || end_told_) return;
  const bool has_work = ended_ || (!asked_.empty() && !reads_slowly());
  if (!has_work) return;
  scheduled_ = true;
  thread_.post(account_, [self = shared_from_this()] { self->serve_one(); });
}

void Connection::wake() {
  if (!std::exchange(wake_pending_, true)) wake_();
}

void Connection::serve_one() {
  Message message;
  bool is_end{false};
  {
    const std::lock_guard lock{mutex_};
    if (thread_.hurries()) {  // no client receives the answers any more
      asked_.clear();
      asked_bytes_ = 0;
    }
    if (asked_.empty()) {
      scheduled_ = false;
      if (!ended_) return;  // closed meanwhile
      is_end = end_told_ = true;
    } else {
      message = std::move(asked_.front());
      asked_.pop_front();
      asked_bytes_ -= message.size();
      if (waits_to_read_ && !asks_too_much()) wake();
    }
  }
  try {
    if (is_end) return service_.closed(id_);
    service_.received(id_, message);
  } catch (const std::exception&) {
    close({kInternalError, "a bug in the program", true});
  }
  const std::lock_guard lock{mutex_};
  scheduled_ = false;
  schedule();
}

}  // namespace saccade::server
