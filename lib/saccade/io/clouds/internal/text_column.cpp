// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/internal/text_column.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "saccade/io/files/text_scan.hpp"

namespace saccade {
namespace {

/// Returns the value of one unit in the last digit of a token.
double last_digit(std::string_view token) {
  std::size_t point = token.size();
  std::size_t end = 0;
  for (; end < token.size() && token[end] != 'e' && token[end] != 'E'; ++end) {
    if (token[end] == '.') point = end;
  }
  int power = 0;
  if (end < token.size()) power = parse_integer<int>(token.substr(end + 1)).value_or(0);
  if (point < end) power -= static_cast<int>(end - point - 1);
  constexpr std::array<double, 17> kPowers{1.0,  1e-1,  1e-2,  1e-3,  1e-4,  1e-5,  1e-6,  1e-7, 1e-8,
                                           1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15, 1e-16};
  if (power <= 0 && -power < static_cast<int>(kPowers.size())) return kPowers[static_cast<std::size_t>(-power)];
  return std::pow(10.0, power);
}

/// Tells whether a float keeps the token's digits.
bool float_says(std::string_view token, double value) {
  if (!std::isfinite(value)) return true;
  if (std::abs(value) > static_cast<double>(std::numeric_limits<float>::max())) return false;
  const double rounded = static_cast<float>(value);
  return rounded == value || std::abs(rounded - value) <= 0.5 * last_digit(token);
}

template <class T, class Source>
std::vector<std::byte> bytes_as(const std::vector<Source>& numbers) {
  std::vector<std::byte> bytes(numbers.size() * sizeof(T));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto number = static_cast<T>(numbers[i]);
    std::memcpy(&bytes[i * sizeof(T)], &number, sizeof(T));
  }
  return bytes;
}

template <class Source>
std::vector<std::byte> bytes_as(const std::vector<Source>& numbers, ColumnType type) {
  switch (type) {
    case ColumnType::u8: return bytes_as<std::uint8_t>(numbers);
    case ColumnType::u16: return bytes_as<std::uint16_t>(numbers);
    case ColumnType::i32: return bytes_as<std::int32_t>(numbers);
    case ColumnType::u32: return bytes_as<std::uint32_t>(numbers);
    case ColumnType::i64: return bytes_as<std::int64_t>(numbers);
    case ColumnType::f32: return bytes_as<float>(numbers);
    default: return bytes_as<double>(numbers);
  }
}

}  // namespace

void TextColumn::reserve(std::size_t rows) { whole_ ? wholes_.reserve(rows) : reals_.reserve(rows); }

bool TextColumn::append(std::string_view token) {
  if (whole_) {
    if (const auto number = parse_integer<std::int64_t>(token)) {
      wholes_.push_back(*number);
      return true;
    }
  }
  const auto value = parse_number(token);
  if (!value) return false;
  if (whole_) {
    fits_float_ = type(true) == ColumnType::f32;
    reals_.reserve(wholes_.capacity());
    reals_.assign(wholes_.begin(), wholes_.end());
    wholes_ = {};
    whole_ = false;
  }
  fits_float_ = fits_float_ && float_says(token, *value);
  reals_.push_back(*value);
  return true;
}

std::optional<std::pair<double, double>> TextColumn::whole_range() const {
  if (wholes_.empty() && reals_.empty()) return std::nullopt;
  if (whole_) {
    const auto [least, most] = std::minmax_element(wholes_.begin(), wholes_.end());
    return std::pair{static_cast<double>(*least), static_cast<double>(*most)};
  }
  if (!std::all_of(reals_.begin(), reals_.end(), [](double x) { return std::isfinite(x) && x == std::floor(x); })) {
    return std::nullopt;
  }
  const auto [least, most] = std::minmax_element(reals_.begin(), reals_.end());
  return std::pair{*least, *most};
}

ColumnType TextColumn::type(bool floating) const {
  if (!whole_) return fits_float_ ? ColumnType::f32 : ColumnType::f64;
  if (wholes_.empty()) return floating ? ColumnType::f32 : ColumnType::i32;
  const auto [at_least, at_most] = std::minmax_element(wholes_.begin(), wholes_.end());
  const std::int64_t least = *at_least;
  const std::int64_t most = *at_most;
  if (floating) {
    constexpr std::int64_t kExact{1 << 24};
    return least >= -kExact && most <= kExact ? ColumnType::f32 : ColumnType::f64;
  }
  if (least >= std::numeric_limits<std::int32_t>::min() && most <= std::numeric_limits<std::int32_t>::max()) {
    return ColumnType::i32;
  }
  return least >= 0 && most <= std::numeric_limits<std::uint32_t>::max() ? ColumnType::u32 : ColumnType::i64;
}

Column TextColumn::release(std::string name, ColumnType type) && {
  Column column{std::move(name), type, 1, whole_ ? bytes_as(wholes_, type) : bytes_as(reals_, type)};
  *this = {};
  return column;
}

}  // namespace saccade
