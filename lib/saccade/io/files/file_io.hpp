// SPDX-License-Identifier: Apache-2.0
#pragma once
// read_file, read_text_file: a whole file into memory, or a clear error; AtomicFile: a file that appears under its name
// only when it is complete; Descriptor, Pipe: owners of file descriptors.

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

/// Largest file read into memory at once, unless the caller says otherwise.
constexpr std::uintmax_t kMaxFileBytes{std::uintmax_t{8} << 30U};

/// All bytes of a file. not_found when it is not there, io_failure for a folder or a failing read, unsupported above
/// max_bytes; the error's context is the path.
[[nodiscard]] Result<std::vector<std::byte>> read_file(const std::filesystem::path& path,
                                                       std::uintmax_t max_bytes = kMaxFileBytes);
/// The same as text.
[[nodiscard]] Result<std::string> read_text_file(const std::filesystem::path& path,
                                                 std::uintmax_t max_bytes = kMaxFileBytes);

/// The same error with the path in front of its context.
[[nodiscard]] Error in_file(Error error, const std::filesystem::path& path);
template <class T>
[[nodiscard]] Result<T> in_file(Result<T> result, const std::filesystem::path& path) {
  return result ? std::move(result) : Result<T>{in_file(result.error(), path)};
}

/// Borrows text as bytes, and bytes as text.
[[nodiscard]] std::span<const std::byte> as_byte_span(std::string_view text);
[[nodiscard]] std::string_view as_text(std::span<const std::byte> bytes);

/// Writes into a temporary file in the destination's folder; commit() flushes it to the disk and renames it over the
/// destination. Without a successful commit the temporary is removed and what was there before stays. One thread.
/// Every error is an io_failure whose context is the destination (a full disk, a folder that cannot be written, ...).
class AtomicFile {
 public:
  /// invalid_argument when the destination exists and is no regular file; a symbolic link is followed.
  [[nodiscard]] static Result<AtomicFile> create(const std::filesystem::path& destination);
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&& other) noexcept;
  ~AtomicFile();

  [[nodiscard]] Status write(std::span<const std::byte> bytes);
  [[nodiscard]] Status write(std::string_view text);
  /// The bytes of trivially copyable values, in the machine's order.
  template <class T>
  [[nodiscard]] Status write_values(std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    return write(std::as_bytes(values));
  }
  /// To be called once, at the end.
  [[nodiscard]] Status commit();
  /// The same, but what is at the destination by now stays, and the file that was written goes.
  /// @return whether the destination is the file that was written.
  [[nodiscard]] Result<bool> commit_new();

 private:
  AtomicFile() = default;
  [[nodiscard]] Status flush();
  [[nodiscard]] Status finish();
  [[nodiscard]] Status rename();
  [[nodiscard]] Error failure(const char* what) const;
  void discard() noexcept;

  int fd_{-1};
  std::filesystem::path shown_;        ///< as the caller wrote it, for messages
  std::filesystem::path destination_;  ///< links resolved
  std::filesystem::path temporary_;
  std::string buffer_;
};

/// All of `bytes` at once.
[[nodiscard]] Status write_file_atomically(const std::filesystem::path& destination, std::span<const std::byte> bytes);
[[nodiscard]] Status write_file_atomically(const std::filesystem::path& destination, std::string_view text);

}  // namespace saccade
