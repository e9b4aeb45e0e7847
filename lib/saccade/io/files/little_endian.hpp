// SPDX-License-Identifier: Apache-2.0
#pragma once
// append_value, ByteReader: numbers in binary files, least significant byte first.

#include <bit>
#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "saccade/core/result.hpp"

namespace saccade {

static_assert(std::endian::native == std::endian::little, "binary files are written in the machine's byte order");

template <class T>
void append_value(std::vector<std::byte>& out, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  const auto bytes = std::as_bytes(std::span{&value, 1});
  out.insert(out.end(), bytes.begin(), bytes.end());
}

/// Reader of borrowed bytes. Call has() first: reading past the end is a broken contract.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes, std::size_t offset = 0) : bytes_{bytes}, offset_{offset} {}

  [[nodiscard]] std::size_t offset() const { return offset_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - offset_; }
  [[nodiscard]] bool has(std::size_t count) const { return count <= left(); }

  template <class T>
  [[nodiscard]] T value() {
    static_assert(std::is_trivially_copyable_v<T>);
    T result;
    std::memcpy(&result, take(sizeof(T)).data(), sizeof(T));
    return result;
  }
  [[nodiscard]] std::span<const std::byte> take(std::size_t count) {
    SACCADE_EXPECTS(has(count));
    const auto taken = bytes_.subspan(offset_, count);
    offset_ += count;
    return taken;
  }

 private:
  std::span<const std::byte> bytes_;
  std::size_t offset_{0};
};

}  // namespace saccade
