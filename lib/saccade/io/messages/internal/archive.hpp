// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reader and Writer: conversion of message values from and to bytes. One list of fields per message serves both, in
// both layouts.

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "saccade/io/messages/messages.hpp"

namespace saccade::messages::internal {

template <class T>
inline constexpr bool kIsScalar = std::is_arithmetic_v<T> || std::is_same_v<T, std::byte>;

/// Returns the padding of XCDR1: each scalar is aligned to its size, counted from the end of the header.
constexpr std::size_t padding(Wire wire, std::size_t offset, std::size_t size) {
  return wire == Wire::cdr ? (size - (offset - 4) % size) % size : 0;
}

/// Reader of values. After the first failure values stay unchanged, so a message needs only one check, at the end.
class Reader {
 public:
  static constexpr bool kReads = true;

  Reader(Wire wire, std::span<const std::byte> bytes) : wire_{wire}, bytes_{bytes} {
    if (wire == Wire::cdr) {
      failed_ = bytes.size() < 4;
      swapped_ = !failed_ && bytes[1] == std::byte{0};
      offset_ = 4;
    }
  }

  [[nodiscard]] Wire wire() const { return wire_; }
  [[nodiscard]] bool failed() const { return failed_; }

  template <class T>
  void scalar(T& value) {
    const std::byte* from = take(sizeof(T), sizeof(T));
    if (from == nullptr) return;
    std::array<std::byte, sizeof(T)> raw;
    std::copy_n(from, sizeof(T), raw.begin());
    if (swapped_) std::ranges::reverse(raw);
    std::memcpy(&value, raw.data(), sizeof(T));
  }
  void flag(bool& value) {
    std::uint8_t byte = value ? 1 : 0;
    scalar(byte);
    value = byte != 0;
  }
  void text(std::string& value) {
    std::uint32_t length = 0;
    scalar(length);
    const std::byte* from = take(length, 1);
    if (from == nullptr) return;
    const auto size = wire_ == Wire::cdr && length > 0 ? length - 1 : length;  // without the zero at its end
    value.assign(reinterpret_cast<const char*>(from), size);                   // NOLINT: bytes as characters
  }
  template <class T>
  void block(T* values, std::size_t count) {
    if (count == 0) return;
    const std::byte* from = take(count * sizeof(T), sizeof(T));
    if (from == nullptr) return;
    std::memcpy(values, from, count * sizeof(T));
    if (!swapped_ || sizeof(T) == 1) return;
    for (std::size_t i = 0; i < count; ++i) {
      auto* raw = reinterpret_cast<std::byte*>(values + i);  // NOLINT: bytes of a number
      std::reverse(raw, raw + sizeof(T));
    }
  }
  /// Returns the length of a sequence whose elements take at least `least` bytes each; 0 after a failure.
  [[nodiscard]] std::size_t length(std::size_t, std::size_t least) {
    std::uint32_t count = 0;
    scalar(count);
    if (!failed_ && count > (bytes_.size() - offset_) / least) failed_ = true;
    return failed_ ? 0 : count;
  }

 private:
  const std::byte* take(std::size_t count, std::size_t alignment) {
    if (failed_) return nullptr;
    const std::size_t at = offset_ + padding(wire_, offset_, alignment);
    if (at > bytes_.size() || count > bytes_.size() - at) {
      failed_ = true;
      return nullptr;
    }
    offset_ = at + count;
    return bytes_.data() + at;
  }

  Wire wire_;
  std::span<const std::byte> bytes_;
  std::size_t offset_{0};
  bool failed_{false};
  bool swapped_{false};  ///< most significant byte first
};

class Writer {
 public:
  static constexpr bool kReads = false;

  explicit Writer(Wire wire) : wire_{wire} {
    if (wire == Wire::cdr) bytes_ = {std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0}};
  }

  [[nodiscard]] Wire wire() const { return wire_; }
  [[nodiscard]] std::vector<std::byte> take() && { return std::move(bytes_); }

  template <class T>
  void scalar(const T& value) {
    block(&value, 1);
  }
  void flag(const bool& value) { scalar<std::uint8_t>(value ? 1 : 0); }
  void text(const std::string& value) {
    scalar(static_cast<std::uint32_t>(value.size() + (wire_ == Wire::cdr ? 1 : 0)));
    block(value.data(), value.size());
    if (wire_ == Wire::cdr) bytes_.push_back(std::byte{0});
  }
  template <class T>
  void block(const T* values, std::size_t count) {
    if (count == 0) return;
    const std::size_t at = bytes_.size() + padding(wire_, bytes_.size(), sizeof(T));
    bytes_.resize(at + count * sizeof(T));
    std::memcpy(bytes_.data() + at, values, count * sizeof(T));
  }
  std::size_t length(std::size_t count, std::size_t) {
    scalar(static_cast<std::uint32_t>(count));
    return count;
  }

 private:
  Wire wire_;
  std::vector<std::byte> bytes_;
};

}  // namespace saccade::messages::internal
