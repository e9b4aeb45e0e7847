// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/internal/md5.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

namespace saccade {
namespace {

constexpr std::size_t kBlock{64};
using State = std::array<std::uint32_t, 4>;

/// RFC 1321, 3.4: T[i] is the whole part of 2³² · |sin(i + 1)|.
std::array<std::uint32_t, kBlock> sines() {
  std::array<std::uint32_t, kBlock> table{};
  for (std::size_t i = 0; i < kBlock; ++i) {
    table[i] = static_cast<std::uint32_t>(std::floor(0x1p32 * std::abs(std::sin(static_cast<double>(i + 1)))));
  }
  return table;
}

std::uint32_t word_at(std::span<const std::byte> bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) word |= std::to_integer<std::uint32_t>(bytes[at + i]) << (8 * i);
  return word;
}

void add_block(State& state, std::span<const std::byte> block) {
  static const std::array<std::uint32_t, kBlock> kSines = sines();
  constexpr std::array<std::array<int, 4>, 4> kTurns{
      {{7, 12, 17, 22}, {5, 9, 14, 20}, {4, 11, 16, 23}, {6, 10, 15, 21}}};
  auto [a, b, c, d] = state;
  for (std::uint32_t i = 0; i < kBlock; ++i) {
    const std::uint32_t round = i / 16;
    std::uint32_t mixed = 0;
    std::uint32_t word = 0;
    switch (round) {
      case 0: mixed = (b & c) | (~b & d), word = i; break;
      case 1: mixed = (d & b) | (~d & c), word = 5 * i + 1; break;
      case 2: mixed = b ^ c ^ d, word = 3 * i + 5; break;
      default: mixed = c ^ (b | ~d), word = 7 * i; break;
    }
    const std::uint32_t turned =
        std::rotl(a + mixed + kSines[i] + word_at(block, 4 * (word % 16)), kTurns[round][i % 4]);
    a = d;
    d = c;
    c = b;
    b += turned;
  }
  state[0] += a;
  state[1] += b;
  state[2] += c;
  state[3] += d;
}

}  // namespace

std::string md5_of(std::span<const std::byte> bytes) {
  State state{0x67452301U, 0xefcdab89U, 0x98badcfeU, 0x10325476U};
  const std::size_t whole = bytes.size() / kBlock * kBlock;
  for (std::size_t at = 0; at < whole; at += kBlock) add_block(state, bytes.subspan(at, kBlock));
  std::vector<std::byte> rest{bytes.begin() + static_cast<std::ptrdiff_t>(whole), bytes.end()};
  rest.push_back(std::byte{0x80});
  while (rest.size() % kBlock != kBlock - 8) rest.push_back(std::byte{0});
  const std::uint64_t bits = 8 * static_cast<std::uint64_t>(bytes.size());
  for (unsigned shift = 0; shift < 64; shift += 8) rest.push_back(static_cast<std::byte>((bits >> shift) & 0xffU));
  for (std::size_t at = 0; at < rest.size(); at += kBlock) add_block(state, std::span{rest}.subspan(at, kBlock));
  constexpr char kDigits[] = "0123456789abcdef";
  std::string digits;
  for (const std::uint32_t word : state) {
    for (unsigned shift = 0; shift < 32; shift += 8) {
      const std::uint32_t byte = (word >> shift) & 0xffU;
      digits += kDigits[byte >> 4U];
      digits += kDigits[byte & 0xfU];
    }
  }
  return digits;
}

}  // namespace saccade
