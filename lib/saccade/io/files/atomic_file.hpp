// SPDX-License-Identifier: Apache-2.0
#pragma once
// AtomicFile: a file that appears under its name only when it is complete; write_file_atomically.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "saccade/core/result.hpp"

namespace saccade {

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
