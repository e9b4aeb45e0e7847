// SPDX-License-Identifier: Apache-2.0
#pragma once
// read_file, read_text_file: a whole file into memory, or a clear error. in_file: errors that say which file.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade {

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

}  // namespace saccade
