// SPDX-License-Identifier: Apache-2.0
#include "saccade/report/html_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace saccade {
namespace {

constexpr std::string_view kReplacement{"\xEF\xBF\xBD"};
constexpr std::string_view kGap{"\xE2\x80\xAF"};    // narrow no-break space
constexpr std::string_view kMinus{"\xE2\x88\x92"};  // U+2212

unsigned byte_at(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
}

/// Length of the UTF-8 sequence at `i`, 0 where there is none: overlong forms, surrogates, U+FFFE, U+FFFF and what lies
/// beyond U+10FFFF are none.
std::size_t utf8_length(std::string_view text, std::size_t i) {
  const unsigned first = byte_at(text, i);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4) return 0;
  unsigned code = first & (0xFFU >> (length + 1));
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte_at(text, i + k) & 0xC0U) != 0x80U) return 0;
    code = code << 6U | (byte_at(text, i + k) & 0x3FU);
  }
  constexpr std::array<unsigned, 5> kSmallest{0, 0, 0x80, 0x800, 0x10000};
  const bool allowed = code >= kSmallest[length] && code <= 0x10FFFF && (code < 0xD800 || code > 0xDFFF) &&
                       code != 0xFFFE && code != 0xFFFF;
  return allowed ? length : 0;
}

std::string_view entity(char c) {
  switch (c) {
    case '&': return "&amp;";
    case '<': return "&lt;";
    case '>': return "&gt;";
    case '"': return "&quot;";
    case '\'': return "&#39;";
    default: return {};
  }
}

}  // namespace

std::string html_escaped(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text, i);
    const unsigned first = byte_at(text, i);
    const bool control = (first < 0x20 && first != '\t' && first != '\n') || first == 0x7F;
    const std::string_view named = entity(text[i]);
    if (length == 0 || control) {
      out += kReplacement;
    } else if (!named.empty()) {
      out += named;
    } else {
      out += text.substr(i, length);
    }
    i += std::max<std::size_t>(length, 1);
  }
  return out;
}

std::string relative_href(std::string_view name) {
  constexpr std::string_view kDigits{"0123456789ABCDEF"};
  std::string out;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string_view{"-._~/"}.find(c) != std::string_view::npos;
    const bool leading_slash = c == '/' && (out.empty() || out == "./");
    if (leading_slash) {
      out = "./";  // the file system's root or another host is not beside the page
    } else if (plain) {
      out += c;
    } else {
      out += {'%', kDigits[byte >> 4U], kDigits[byte & 15U]};
    }
  }
  return out;
}

std::string base64(std::span<const std::byte> bytes) {
  constexpr std::string_view kSymbols{"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"};
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    unsigned word{0};
    for (std::size_t k = 0; k < 3; ++k) word = word << 8U | (k < n ? std::to_integer<unsigned>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) out += k <= n ? kSymbols[(word >> (18 - 6 * k)) & 63U] : '=';
  }
  return out;
}

std::string grouped(std::uint64_t value) {
  const std::string digits = std::to_string(value);
  std::string out;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) out += kGap;
    out += digits[i];
  }
  return out;
}

std::string number_text(double value, int decimals) {
  constexpr double kLargest{1e15};  // beyond it doubles have no unit digit to speak of
  if (!std::isfinite(value)) return "\xE2\x80\x93";
  std::array<char, 64> buffer{};
  if (std::abs(value) > kLargest) {
    std::snprintf(buffer.data(), buffer.size(), "%.3g", value);
    return buffer.data();
  }
  std::snprintf(buffer.data(), buffer.size(), "%.*f", std::clamp(decimals, 0, 9), std::abs(value));
  const std::string plain = buffer.data();
  const std::size_t point = std::min(plain.find('.'), plain.size());
  std::string out = grouped(std::stoull(plain.substr(0, point))) + plain.substr(point);
  const bool zero = plain.find_first_of("123456789") == std::string::npos;
  return value < 0.0 && !zero ? std::string{kMinus} + out : out;
}

std::string duration_text(double ms) {
  constexpr double kMinute_ms{60000.0};
  const std::string gap{kGap};
  if (!std::isfinite(ms)) return number_text(ms, 0);
  if (ms < 0.005) return "0" + gap + "ms";
  if (ms < 9.95) return number_text(ms, ms < 0.995 ? 2 : 1) + gap + "ms";
  if (ms < 999.5) return number_text(ms, 0) + gap + "ms";
  if (ms < kMinute_ms - 50.0) return number_text(ms / 1000.0, ms < 9950.0 ? 2 : 1) + gap + "s";
  const auto seconds = static_cast<std::uint64_t>(std::llround(ms / 1000.0));
  return grouped(seconds / 60) + gap + "min " + std::to_string(seconds % 60) + gap + "s";
}

}  // namespace saccade
