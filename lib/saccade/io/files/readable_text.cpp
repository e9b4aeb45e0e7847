// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/files/text_scan.hpp"

namespace saccade {
namespace {

unsigned byte_at(std::string_view text, std::size_t i) { return static_cast<unsigned char>(text[i]); }

/// Returns the bytes of the UTF-8 character that a text begins with; 0 where there is none (The Unicode Standard, table
/// 3-7).
std::size_t utf8_length(std::string_view text) {
  const unsigned first = byte_at(text, 0);
  if (first < 0x80) return 1;
  const std::size_t length = first < 0xC2 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : first < 0xF5 ? 4 : 0;
  if (length == 0 || text.size() < length) return 0;
  const unsigned low = first == 0xE0 ? 0xA0 : first == 0xF0 ? 0x90 : 0x80;
  const unsigned high = first == 0xED ? 0x9F : first == 0xF4 ? 0x8F : 0xBF;
  if (byte_at(text, 1) < low || byte_at(text, 1) > high) return 0;
  for (std::size_t i = 2; i < length; ++i) {
    if (byte_at(text, i) < 0x80 || byte_at(text, i) > 0xBF) return 0;
  }
  return length;
}

/// Tells whether a character is U+0000 … U+001F, U+007F … U+009F.
bool is_control(std::string_view text, std::size_t length) {
  const unsigned first = byte_at(text, 0);
  return first < 0x20 || first == 0x7F || (length == 2 && first == 0xC2 && byte_at(text, 1) < 0xA0);
}

}  // namespace

std::string readable(std::string_view text, std::size_t max_bytes) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const std::size_t taken = length == 0 ? 1 : length;
    if (result.size() + taken > max_bytes) return result + "...";
    if (length == 0) {
      result.push_back('?');
    } else if (is_control(text, length)) {
      result.push_back(' ');
    } else {
      result.append(text.substr(0, length));
    }
    text.remove_prefix(taken);
  }
  return result;
}

std::string last_lines(std::string_view text) {
  constexpr std::size_t kLines{3};
  constexpr std::size_t kBytesPerLine{160};
  std::string result;
  for (std::size_t found = 0; found < kLines && !text.empty();) {
    const std::size_t begin = text.find_last_of("\r\n") + 1;  // npos + 1 is 0
    const std::string_view line = text.substr(begin);
    text = text.substr(0, begin == 0 ? 0 : begin - 1);
    if (line.find_first_not_of(" \t") == std::string_view::npos) continue;
    result = readable(line.substr(line.find_first_not_of(" \t")), kBytesPerLine) +
             (result.empty() ? std::string{} : " | " + result);
    ++found;
  }
  return result;
}

}  // namespace saccade
