// SPDX-License-Identifier: Apache-2.0
#pragma once
// Descriptor: owns a file descriptor. Pipe: both ends of one.

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "saccade/core/result.hpp"

namespace saccade {

/// Closes what it holds; −1 is none.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) : fd_{fd} {}
  Descriptor(Descriptor&& other) noexcept : fd_{std::exchange(other.fd_, -1)} {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    if (this != &other) {
      reset();
      fd_ = std::exchange(other.fd_, -1);
    }
    return *this;
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { reset(); }

  [[nodiscard]] int get() const { return fd_; }
  void reset() {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
  }
  /// Reads and writes return at once, done or not.
  void make_nonblocking() const { ::fcntl(fd_, F_SETFL, ::fcntl(fd_, F_GETFL) | O_NONBLOCK); }

 private:
  int fd_{-1};
};

/// What is written to one end is read from the other. No child inherits either.
struct Pipe {
  Descriptor read_end;
  Descriptor write_end;

  [[nodiscard]] static Result<Pipe> create() {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
      return Error{Errc::io_failure, std::string{"cannot make a pipe: "} + std::strerror(errno), {}};
    }
    return Pipe{Descriptor{ends[0]}, Descriptor{ends[1]}};
  }
};

}  // namespace saccade
