// SPDX-License-Identifier: Apache-2.0
#pragma once
// read_file, read_text_file: a whole file in memory, or a clear error. AtomicFile: a file that appears under its name
// only when it is complete. Descriptor, Pipe: owners of file descriptors.

#include <fcntl.h>
#include <unistd.h>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade {

/// Owner of a file descriptor, which it closes; −1 is none.
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
  /// Makes reads and writes return at once, done or not.
  void make_nonblocking() const { ::fcntl(fd_, F_SETFL, ::fcntl(fd_, F_GETFL) | O_NONBLOCK); }

 private:
  int fd_{-1};
};

/// Pipe: data written to one end is read from the other. No child inherits either end.
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

/// Default limit of a file that is read into memory.
constexpr std::uintmax_t kMaxFileBytes{std::uintmax_t{8} << 30U};

/// Reads all bytes of a file. Answers not_found, io_failure for a folder or a failing read, unsupported above
/// max_bytes; the error's context is the path.
[[nodiscard]] Result<std::vector<std::byte>> read_file(const std::filesystem::path& path,
                                                       std::uintmax_t max_bytes = kMaxFileBytes);
/// Reads a file as text.
[[nodiscard]] Result<std::string> read_text_file(const std::filesystem::path& path,
                                                 std::uintmax_t max_bytes = kMaxFileBytes);

/// Returns the error with the path in front of its context.
[[nodiscard]] Error in_file(Error error, const std::filesystem::path& path);
template <class T>
[[nodiscard]] Result<T> in_file(Result<T> result, const std::filesystem::path& path) {
  return result ? std::move(result) : Result<T>{in_file(result.error(), path)};
}

/// Views text as bytes, and bytes as text.
[[nodiscard]] std::span<const std::byte> as_byte_span(std::string_view text);
[[nodiscard]] std::string_view as_text(std::span<const std::byte> bytes);

/// File that replaces its destination atomically. It writes to a temporary file in the destination's folder; commit()
/// flushes it to the disk and renames it over the destination. Without a successful commit the temporary is removed and
/// the old file stays. One thread. Every error is an io_failure whose context is the destination (a full disk, a folder
/// that cannot be written, ...).
class AtomicFile {
 public:
  /// Answers invalid_argument when the destination exists and is not a regular file; a symbolic link is followed.
  [[nodiscard]] static Result<AtomicFile> create(const std::filesystem::path& destination);
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&& other) noexcept;
  ~AtomicFile();

  [[nodiscard]] Status write(std::span<const std::byte> bytes);
  [[nodiscard]] Status write(std::string_view text);
  /// Writes the bytes of trivially copyable values, in the machine's order.
  template <class T>
  [[nodiscard]] Status write_values(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    return write(std::as_bytes(values));
  }
  /// Commits the file. Call it once, at the end.
  [[nodiscard]] Status commit();
  /// Commits only if the destination does not exist by then; otherwise it stays, and the new file is removed.
  /// @return whether the new file is at the destination.
  [[nodiscard]] Result<bool> commit_new();

 private:
  AtomicFile() = default;
  [[nodiscard]] Status flush();
  [[nodiscard]] Status finish();
  [[nodiscard]] Status rename();
  [[nodiscard]] Error failure(const char* what) const;
  void discard() noexcept;

  int fd_{-1};
  std::filesystem::path shown_;        ///< as given by the caller, for messages
  std::filesystem::path destination_;  ///< links resolved
  std::filesystem::path temporary_;
  std::string buffer_;
};

/// Writes a whole file.
[[nodiscard]] Status write_file_atomically(const std::filesystem::path& destination, std::span<const std::byte> bytes);
[[nodiscard]] Status write_file_atomically(const std::filesystem::path& destination, std::string_view text);

}  // namespace saccade
