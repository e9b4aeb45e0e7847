// SPDX-License-Identifier: Apache-2.0
#pragma once
// BagFile: a file with random access. ByteWindow: bytes of a file or of memory, viewed piece by piece.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "saccade/core/result.hpp"
#include "saccade/core/uninitialized_vector.hpp"
#include "saccade/io/files/file_io.hpp"

namespace saccade::internal::io_bags {

/// Largest piece held in memory at once: a chunk, or a message.
constexpr std::uint64_t kMaxPieceBytes{std::uint64_t{512} << 20U};

class BagFile {
 public:
  [[nodiscard]] static Result<BagFile> open(const std::filesystem::path& path);
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Fills `out` from an offset. Returns the number of bytes read, fewer at the end of the file.
  [[nodiscard]] std::size_t read(std::uint64_t offset, std::span<std::byte> out) const;

 private:
  BagFile(Descriptor file, std::uint64_t size) : file_{std::move(file)}, size_{size} {}
  Descriptor file_;
  std::uint64_t size_{0};
};

/// Bytes from 0 to size(). The result of at() is valid until the next at().
class ByteWindow {
 public:
  explicit ByteWindow(std::span<const std::byte> memory) : memory_{memory}, size_{memory.size()} {}
  /// Creates a window, clipped to the file.
  ByteWindow(const BagFile& file, std::uint64_t begin, std::uint64_t size);
  /// Moves to another part of the file, reusing the memory. Expects a window of a file.
  void move_to(std::uint64_t begin, std::uint64_t size);

  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Returns `count` bytes, fewer where the window ends. Expects count ≤ kMaxPieceBytes.
  [[nodiscard]] std::span<const std::byte> at(std::uint64_t offset, std::size_t count);

 private:
  std::span<const std::byte> memory_;
  const BagFile* file_{nullptr};
  std::uint64_t begin_{0};
  std::uint64_t size_{0};
  UninitializedVector<std::byte> buffer_;  ///< part of the file
  std::uint64_t buffer_at_{0};
};

}  // namespace saccade::internal::io_bags
