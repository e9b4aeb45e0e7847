// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/internal/lzf.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace saccade {
namespace {

// A control byte below 32 announces that many literals plus one. Any other is a back reference: its upper three bits
// hold the length minus two (7: the next byte is added), its lower five and the following byte the distance minus one.
constexpr std::size_t kMaxLiterals{32};
constexpr std::size_t kMaxDistance{8192};
constexpr std::size_t kMinMatch{3};
constexpr std::size_t kMaxMatch{264};

std::size_t hash_of(const std::byte* p) {
  const std::uint32_t word = (std::to_integer<std::uint32_t>(p[0]) << 16U) |
                             (std::to_integer<std::uint32_t>(p[1]) << 8U) | std::to_integer<std::uint32_t>(p[2]);
  return (word * 2654435761U) >> 18U;
}

void append_literals(std::span<const std::byte> literals, std::vector<std::byte>& out) {
  while (!literals.empty()) {
    const std::size_t run = std::min(literals.size(), kMaxLiterals);
    out.push_back(static_cast<std::byte>(run - 1));
    out.insert(out.end(), literals.begin(), literals.begin() + static_cast<std::ptrdiff_t>(run));
    literals = literals.subspan(run);
  }
}

void append_match(std::size_t length, std::size_t distance, std::vector<std::byte>& out) {
  const std::size_t coded = length - 2;
  const std::size_t high = (distance - 1) >> 8U;
  out.push_back(static_cast<std::byte>((std::min<std::size_t>(coded, 7) << 5U) | high));
  if (coded >= 7) out.push_back(static_cast<std::byte>(coded - 7));
  out.push_back(static_cast<std::byte>((distance - 1) & 0xFFU));
}

}  // namespace

std::optional<std::vector<std::byte>> lzf_decompress(std::span<const std::byte> packed, std::size_t size) {
  if (size / kLzfMaxExpansion > packed.size()) return std::nullopt;
  std::vector<std::byte> out(size);
  std::size_t at = 0;
  std::size_t i = 0;
  while (i < packed.size()) {
    const auto control = std::to_integer<std::size_t>(packed[i++]);
    if (control < kMaxLiterals) {
      const std::size_t run = control + 1;
      if (run > packed.size() - i || run > size - at) return std::nullopt;
      std::copy_n(&packed[i], run, &out[at]);
      i += run;
      at += run;
      continue;
    }
    std::size_t length = control >> 5U;
    if (packed.size() - i < (length == 7 ? 2U : 1U)) return std::nullopt;
    if (length == 7) length += std::to_integer<std::size_t>(packed[i++]);
    length += 2;
    const std::size_t distance = ((control & 0x1FU) << 8U) + std::to_integer<std::size_t>(packed[i++]) + 1;
    if (distance > at || length > size - at) return std::nullopt;
    for (std::size_t k = 0; k < length; ++k, ++at) out[at] = out[at - distance];  // the ranges may overlap
  }
  if (at != size) return std::nullopt;
  return out;
}

std::vector<std::byte> lzf_compress(std::span<const std::byte> data) {
  std::vector<std::byte> out;
  out.reserve(data.size() / 2 + 16);
  std::array<std::size_t, std::size_t{1} << 14U> last{};  // position + 1 of the last place with this hash
  std::size_t literals_begin = 0;
  std::size_t i = 0;
  while (i + kMinMatch <= data.size()) {
    std::size_t& slot = last[hash_of(&data[i])];
    const std::size_t candidate = slot;
    slot = i + 1;
    const std::size_t distance = candidate > 0 ? i - (candidate - 1) : 0;
    std::size_t length = 0;
    if (distance > 0 && distance <= kMaxDistance) {
      const std::size_t limit = std::min(kMaxMatch, data.size() - i);
      while (length < limit && data[i + length] == data[i + length - distance]) ++length;
    }
    if (length < kMinMatch) {
      ++i;
      continue;
    }
    append_literals(data.subspan(literals_begin, i - literals_begin), out);
    append_match(length, distance, out);
    i += length;
    literals_begin = i;
  }
  append_literals(data.subspan(literals_begin), out);
  return out;
}

}  // namespace saccade
