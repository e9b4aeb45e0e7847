// SPDX-License-Identifier: Apache-2.0
#pragma once
// png_header: what pages look at of a picture.

#include <algorithm>
#include <cstddef>
#include <vector>

namespace saccade::test {

/// The beginning of a PNG: all that the page looks at.
inline std::vector<std::byte> png_header(unsigned width, unsigned height, std::size_t size = 64) {
  std::vector<std::byte> png;
  for (const unsigned byte : {0x89U, 0x50U, 0x4EU, 0x47U, 0x0DU, 0x0AU, 0x1AU, 0x0AU, 0U, 0U, 0U, 13U}) {
    png.push_back(static_cast<std::byte>(byte));
  }
  for (const char c : {'I', 'H', 'D', 'R'}) png.push_back(static_cast<std::byte>(c));
  for (const unsigned edge : {width, height}) {
    for (const unsigned shift : {24U, 16U, 8U, 0U}) png.push_back(static_cast<std::byte>(edge >> shift));
  }
  png.resize(std::max(size, png.size()), std::byte{0x5A});
  return png;
}

}  // namespace saccade::test
