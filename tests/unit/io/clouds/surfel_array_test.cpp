// SPDX-License-Identifier: Apache-2.0
// Surfels as an array of NumPy: back to the bit, and errors for what is none.
#include "saccade/io/clouds/surfel_array.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>

#include "saccade/io/files/npy_io.hpp"

namespace saccade {
namespace {

SurfelMap random_surfels(std::size_t count) {
  std::mt19937 random{3};
  std::uniform_real_distribution<float> number{-3.0F, 3.0F};
  SurfelMap map;
  map.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto vector = [&] { return Eigen::Vector3f{number(random), number(random), number(random)}; };
    map.discs[i] = {vector(), std::abs(number(random)), vector(), std::abs(number(random))};
    map.colors[i] = {vector(), std::abs(number(random))};
  }
  return map;
}

bool same_bits(const SurfelMap& a, const SurfelMap& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() && (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0);
  };
  return same(a.discs, b.discs) && same(a.colors, b.colors);
}

TEST(SurfelArray, ComesBackToTheBit) {
  for (const std::size_t count : {0U, 1U, 1000U}) {
    const SurfelMap map = random_surfels(count);
    const auto back = decode_surfels(encode_surfels(map));
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_TRUE(same_bits(map, *back)) << count;
  }
}

TEST(SurfelArray, IsATableOfTwelveColumns) {
  const SurfelMap map = random_surfels(5);
  const auto table = parse_npy_table(encode_surfels(map));
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_EQ(table->columns.size(), 12U);
  EXPECT_EQ(table->rows, 5U);
}

TEST(SurfelArray, AnotherFileIsAnError) {
  const std::vector<std::byte> good = encode_surfels(random_surfels(3));
  for (std::size_t kept = 0; kept < good.size(); ++kept)
    EXPECT_FALSE(decode_surfels(std::span{good}.first(kept))) << kept;
  std::vector<std::byte> longer = good;
  longer.push_back({});
  EXPECT_FALSE(decode_surfels(longer));
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1.0F}) {
    SurfelMap map = random_surfels(3);
    map.discs[1].weight = bad;
    const auto refused = decode_surfels(encode_surfels(map));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, Errc::corrupt_data);
    EXPECT_NE(refused.error().message.find("row 1"), std::string::npos) << refused.error().message;
  }
  const auto other = [](std::string_view type, std::initializer_list<std::size_t> shape, std::size_t bytes) {
    const std::string header = npy_header(type, std::vector<std::size_t>{shape});
    std::vector<std::byte> file(header.size() + bytes);
    std::memcpy(file.data(), header.data(), header.size());
    return decode_surfels(file);
  };
  EXPECT_TRUE(other("<f4", {2, 12}, 96));
  EXPECT_FALSE(other("<f8", {2, 12}, 192));
  EXPECT_FALSE(other("<f4", {2, 11}, 88));
  EXPECT_FALSE(other("<f4", {24}, 96));
  EXPECT_FALSE(other("<f4", {std::size_t{1} << 62U, 12}, 96));
}

}  // namespace
}  // namespace saccade
