// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/files/value_io.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

#include "saccade/io/files/text_scan.hpp"

namespace saccade {
namespace {

template <class T>
bool append_as(std::string_view token, std::vector<std::byte>& out) {
  T value{};
  if constexpr (std::is_floating_point_v<T>) {
    const auto number = parse_number<T>(token);
    if (!number) return false;
    value = *number;
  } else if (const auto integer = parse_integer<T>(token)) {
    value = *integer;
  } else {
    // Some writers spell integers as "12.0".
    const auto number = parse_number(token);
    constexpr double kExact{9007199254740992.0};
    if (!number || *number != std::nearbyint(*number) || std::abs(*number) > kExact) return false;
    if (*number < static_cast<double>(std::numeric_limits<T>::min()) ||
        *number > static_cast<double>(std::numeric_limits<T>::max())) {
      return false;
    }
    value = static_cast<T>(*number);
  }
  const auto* bytes = reinterpret_cast<const std::byte*>(&value);
  out.insert(out.end(), bytes, bytes + sizeof(T));
  return true;
}

template <class T>
void append_text_of(const std::byte* source, std::string& out) {
  T value{};
  std::memcpy(&value, source, sizeof(T));
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  out.append(buffer.data(), end);
}

}  // namespace

bool append_token(std::string_view token, ColumnType type, std::vector<std::byte>& out) {
  switch (type) {
    case ColumnType::i8: return append_as<std::int8_t>(token, out);
    case ColumnType::u8: return append_as<std::uint8_t>(token, out);
    case ColumnType::i16: return append_as<std::int16_t>(token, out);
    case ColumnType::u16: return append_as<std::uint16_t>(token, out);
    case ColumnType::i32: return append_as<std::int32_t>(token, out);
    case ColumnType::u32: return append_as<std::uint32_t>(token, out);
    case ColumnType::i64: return append_as<std::int64_t>(token, out);
    case ColumnType::u64: return append_as<std::uint64_t>(token, out);
    case ColumnType::f32: return append_as<float>(token, out);
    case ColumnType::f64: return append_as<double>(token, out);
  }
  return false;
}

void append_text(const std::byte* value, ColumnType type, std::string& out) {
  switch (type) {
    case ColumnType::i8: return append_text_of<std::int8_t>(value, out);
    case ColumnType::u8: return append_text_of<std::uint8_t>(value, out);
    case ColumnType::i16: return append_text_of<std::int16_t>(value, out);
    case ColumnType::u16: return append_text_of<std::uint16_t>(value, out);
    case ColumnType::i32: return append_text_of<std::int32_t>(value, out);
    case ColumnType::u32: return append_text_of<std::uint32_t>(value, out);
    case ColumnType::i64: return append_text_of<std::int64_t>(value, out);
    case ColumnType::u64: return append_text_of<std::uint64_t>(value, out);
    case ColumnType::f32: return append_text_of<float>(value, out);
    case ColumnType::f64: return append_text_of<double>(value, out);
  }
}

void swap_bytes(std::byte* values, std::size_t bytes, std::size_t width) {
  for (std::size_t i = 0; i + width <= bytes; i += width) std::reverse(values + i, values + i + width);
}

}  // namespace saccade
