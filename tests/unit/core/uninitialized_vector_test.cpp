// SPDX-License-Identifier: Apache-2.0
#include "saccade/core/uninitialized_vector.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>

namespace saccade {
namespace {

TEST(UninitializedVector, LeavesElementsAsTheMemoryWas) {
  UninitializedVector<std::uint32_t> numbers(1000);
  std::iota(numbers.begin(), numbers.end(), 7U);
  numbers.resize(10);
  numbers.resize(1000);  // in place: what was there is there
  EXPECT_EQ(numbers[999], 1006U);
}

TEST(UninitializedVector, IsAVectorOtherwise) {
  UninitializedVector<std::uint32_t> numbers;
  numbers.push_back(3);
  numbers.emplace_back(4U);
  numbers.resize(3, 5);
  EXPECT_EQ(numbers, (UninitializedVector<std::uint32_t>{3, 4, 5}));
}

TEST(UninitializedVector, BeginsWhereALineOfCacheDoes) {
  UninitializedVector<std::array<float, 8>> halves;
  for (std::size_t size = 1; size < 2000; size = size * 5 / 3 + 1) {
    halves.resize(size);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(halves.data()) % 64, 0U) << size;
  }
}

}  // namespace
}  // namespace saccade
