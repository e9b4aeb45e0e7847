// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/maps/sacmap.hpp"

#include <gtest/gtest.h>
#include <zstd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>

#include "analytic_map.hpp"
#include "saccade/io/files/crc32.hpp"
#include "saccade/io/maps/internal/sacmap_bricks.hpp"

namespace saccade {
namespace {

using Bytes = std::vector<std::byte>;
using test::map_of;

constexpr std::size_t kHeaderBytes{108};
constexpr std::size_t kSectorHeaderBytes{28};

TsdfConfig config_with_workspace() {
  TsdfConfig config;
  config.voxel_size_m = 0.01;
  config.workspace = Box{{-1.0, -1.5, -0.25}, {1.0, 1.5, 2.0}};
  return config;
}

void put(TsdfSnapshot& map, const Index3& brick, BrickRef ref) {
  Sector& sector = map.grid.writable(parent(brick));
  sector.bricks[static_cast<std::size_t>(child_index(brick))] = std::move(ref);
  sector.update_summary(child_index(brick), map.config.free_weight);
}

/// Every kind of brick, colours, unknown voxels among known ones, negative coordinates, several sectors.
TsdfSnapshot rich_map() {
  TsdfSnapshot map = map_of(
      config_with_workspace(), {{-20, -20, -20}, {21, 20, 20}},
      [](const Eigen::Vector3d& p) {
        return test::sphere_sdf(p, {0.02, 0.01, 0.0}, 0.1);
      },
      true);
  FreeBrick free;
  for (int i = 0; i < kBrickVoxels; ++i) free.set_weight(i, static_cast<std::uint16_t>(i % 6));
  put(map, {-9, 3, 40}, BrickRef::make(free));
  put(map, {200, 0, -70}, BrickRef::constant_free(3));
  put(map, {200, 1, -70}, BrickRef::constant_free(5));
  return map;
}

Bytes encoded(const TsdfSnapshot& map) { return encode_map(map).value(); }

/// A small map with one dense brick, whose content `edit` may spoil; encoded without the checks of save_map.
Bytes file_with_brick(const std::function<void(DenseBrick&)>& edit) {
  TsdfSnapshot map;
  map.config = config_with_workspace();
  BrickRef ref = BrickRef::make_dense();
  DenseBrick& dense = ref.writable_dense();
  dense.v[7] = -100;
  dense.w[7] = 3;
  put(map, {1, 2, 3}, ref);
  Bytes file = encoded(map);
  edit(map.grid.writable({0, 0, 0}).bricks[static_cast<std::size_t>(child_index({1, 2, 3}))].writable_dense());
  Bytes raw;
  sacmap::append_bricks(*map.grid.find({0, 0, 0}), raw);
  Bytes packed(ZSTD_compressBound(raw.size()));
  packed.resize(ZSTD_compress(packed.data(), packed.size(), raw.data(), raw.size(), 1));
  file.resize(kHeaderBytes + kSectorHeaderBytes);
  file.insert(file.end(), packed.begin(), packed.end());
  std::byte* sector = file.data() + kHeaderBytes;
  const std::array<std::uint32_t, 3> sizes{static_cast<std::uint32_t>(raw.size()),
                                           static_cast<std::uint32_t>(packed.size()), crc32(packed)};
  std::memcpy(sector + 12, sizes.data(), sizeof sizes);
  const std::uint32_t crc = crc32({sector, 24});
  std::memcpy(sector + 24, &crc, sizeof crc);
  return file;
}

/// Changes a number in the file's header and makes its checksum right again.
template <class T>
void patch_header(Bytes& file, std::size_t offset, T value) {
  std::memcpy(file.data() + offset, &value, sizeof value);
  const std::uint32_t crc = crc32(std::span{file}.first(kHeaderBytes - 4));
  std::memcpy(file.data() + kHeaderBytes - 4, &crc, sizeof crc);
}

template <class T>
void patch_first_sector(Bytes& file, std::size_t offset, T value) {
  std::byte* sector = file.data() + kHeaderBytes;
  std::memcpy(sector + offset, &value, sizeof value);
  const std::uint32_t crc = crc32({sector, kSectorHeaderBytes - 4});
  std::memcpy(sector + kSectorHeaderBytes - 4, &crc, sizeof crc);
}

void expect_corrupt(const Bytes& file, const std::string& words) {
  const auto map = decode_map(file);
  ASSERT_FALSE(map.ok()) << "should have failed: " << words;
  EXPECT_EQ(map.error().code, Errc::corrupt_data);
  EXPECT_NE(map.error().message.find(words), std::string::npos) << map.error().to_string();
}

TEST(Sacmap, LoadingGivesAnEqualGridAndSavingThatTheSameBytes) {
  const TsdfSnapshot map = rich_map();
  ASSERT_GT(map.grid.usage().dense_bricks, 20U);
  ASSERT_GT(map.grid.usage().free_bricks, 1U);
  ASSERT_GE(map.grid.usage().constant_free_bricks, 2U);
  const Bytes file = encoded(map);
  const TsdfSnapshot loaded = decode_map(file).value();
  EXPECT_TRUE(loaded.grid == map.grid);
  EXPECT_EQ(loaded.config.voxel_size_m, map.config.voxel_size_m);
  EXPECT_EQ(loaded.config.truncation_vox, map.config.truncation_vox);
  EXPECT_EQ(loaded.config.max_weight, map.config.max_weight);
  EXPECT_EQ(loaded.config.free_weight, map.config.free_weight);
  EXPECT_EQ(loaded.config.clearing_percent, map.config.clearing_percent);
  EXPECT_EQ(loaded.config.color, map.config.color);
  ASSERT_TRUE(loaded.config.workspace.has_value());
  EXPECT_EQ(loaded.config.workspace->min, map.config.workspace->min);
  EXPECT_EQ(loaded.config.workspace->max, map.config.workspace->max);
  EXPECT_EQ(encoded(loaded), file);
}

TEST(Sacmap, KeepsTheClearingShareWhereOlderMapsHadAZero) {
  constexpr std::size_t kOffset{15};
  TsdfSnapshot map = rich_map();
  Bytes file = encoded(map);
  EXPECT_EQ(file[kOffset], std::byte{0});
  EXPECT_EQ(decode_map(file).value().config.clearing_percent, 100);
  map.config.clearing_percent = 50;
  file = encoded(map);
  EXPECT_EQ(file[kOffset], std::byte{50});
  EXPECT_EQ(decode_map(file).value().config.clearing_percent, 50);
  for (const int wrong : {100, 101, 255}) {
    patch_header(file, kOffset, static_cast<std::uint8_t>(wrong));
    expect_corrupt(file, "clearing share");
  }
}

TEST(Sacmap, MasksAndSummariesAreRecomputed) {
  const TsdfSnapshot map = rich_map();
  const TsdfSnapshot loaded = decode_map(encoded(map)).value();
  for (const Index3& key : map.grid.sorted_sectors()) {
    const Sector& a = *map.grid.find(key);
    const Sector& b = *loaded.grid.find(key);
    EXPECT_EQ(a.has_unknown, b.has_unknown);
    EXPECT_EQ(a.has_occupied, b.has_occupied);
    EXPECT_EQ(a.saturated, b.saturated);
    for (std::size_t i = 0; i < kSectorBricks; ++i) {
      ASSERT_EQ(a.bricks[i].unknown_mask(), b.bricks[i].unknown_mask());
      ASSERT_EQ(a.bricks[i].occupied_mask(), b.bricks[i].occupied_mask());
    }
  }
}

TEST(Sacmap, EmptyMapAndMapWithoutWorkspaceSurvive) {
  TsdfSnapshot map;
  const TsdfSnapshot loaded = decode_map(encoded(map)).value();
  EXPECT_TRUE(loaded.grid.empty());
  EXPECT_FALSE(loaded.config.workspace.has_value());
}

TEST(Sacmap, SameBytesForEveryThreadCount) {
  TsdfSnapshot map = rich_map();
  for (int i = 0; i < 100; ++i)
    put(map, {8 * i, -64, 0}, BrickRef::constant_free(static_cast<std::uint16_t>(1 + i % 5)));
  const Bytes file = encoded(map);
  for (const std::size_t threads : {2U, 5U}) {
    const Executor executor = Executor::with_threads(threads, Executor::Backend::std_thread);
    EXPECT_EQ(encode_map(map, executor).value(), file);
    EXPECT_TRUE(decode_map(file, executor).value().grid == map.grid);
  }
}

TEST(Sacmap, EveryTruncationIsAnErrorThatSaysWhere) {
  const Bytes file = encoded(rich_map());
  std::size_t tried{0};
  for (std::size_t size = 0; size < file.size(); size += size < 300 ? 1 : 97) {
    const auto map = decode_map(std::span{file}.first(size));
    ASSERT_FALSE(map.ok()) << size;
    EXPECT_EQ(map.error().code, Errc::corrupt_data);
    if (size >= 8) {
      EXPECT_NE(map.error().message.find("at byte "), std::string::npos) << map.error().message;
    }
    ++tried;
  }
  EXPECT_GT(tried, 300U);
}

TEST(Sacmap, EveryChangedByteIsAnError) {
  const Bytes file = encoded(rich_map());
  const unsigned seed{7};
  std::mt19937 random{seed};
  std::size_t tried{0};
  for (std::size_t i = 0; i < file.size(); i += i < 200 ? 1 : 61) {
    Bytes changed = file;
    changed[i] ^= static_cast<std::byte>(1U << (random() % 8));
    ASSERT_FALSE(decode_map(changed).ok()) << "byte " << i;
    ++tried;
  }
  EXPECT_GT(tried, 300U);
}

TEST(Sacmap, TrailingBytesAreAnError) {
  Bytes file = encoded(rich_map());
  file.push_back(std::byte{0});
  expect_corrupt(file, "after the last sector");
}

TEST(Sacmap, OtherFilesAndNewerVersionsAreRefused) {
  expect_corrupt({}, "not a Saccade map");
  expect_corrupt(Bytes(1000, std::byte{'x'}), "not a Saccade map");
  Bytes newer = encoded(rich_map());
  newer[8] = std::byte{2};
  const auto map = decode_map(newer);
  ASSERT_FALSE(map.ok());
  EXPECT_EQ(map.error().code, Errc::unsupported);
}

TEST(Sacmap, HostileHeadersAreRefused) {
  const Bytes good = encoded(rich_map());
  const auto with = [&](std::size_t offset, auto value, const std::string& words) {
    Bytes file = good;
    patch_header(file, offset, value);
    expect_corrupt(file, words);
  };
  with(12, std::uint16_t{0}, "maximum weight");
  with(14, std::uint16_t{9}, "free-space weight");
  with(16, -1.0, "voxel size");
  with(24, 1e300, "truncation");
  with(32, std::numeric_limits<double>::quiet_NaN(), "workspace");
  with(80, std::uint32_t{2}, "flag");
  with(84, std::uint32_t{0}, "workspace");
  with(88, std::uint64_t{0}, "after the last sector");
  with(88, ~std::uint64_t{0}, "where a sector is due");
  with(96, std::uint64_t{1}, "number of bricks");
}

TEST(Sacmap, HostileSectorsAreRefused) {
  const Bytes good = encoded(rich_map());
  const auto with = [&](std::size_t offset, auto value, const std::string& words) {
    Bytes file = good;
    patch_first_sector(file, offset, value);
    expect_corrupt(file, words);
  };
  with(0, std::int32_t{(1 << 20) + 1}, "too far");
  with(8, std::numeric_limits<std::int32_t>::min(), "too far");
  with(8, std::int32_t{1 << 20}, "out of order");
  with(12, ~std::uint32_t{0}, "larger than a sector can be");
  with(12, std::uint32_t{17}, "decompressed");
  with(16, ~std::uint32_t{0}, "the file ends within");
  with(20, std::uint32_t{1}, "checksum");
}

TEST(Sacmap, BricksThatAreNotCanonicalAreRefused) {
  ASSERT_TRUE(decode_map(file_with_brick([](DenseBrick&) {})).ok());
  expect_corrupt(file_with_brick([](DenseBrick& d) { d.v[9] = 1; }), "never observed has a value");
  expect_corrupt(file_with_brick([](DenseBrick& d) { d.w[7] = 129; }), "maximum weight");
  expect_corrupt(file_with_brick([](DenseBrick& d) {
                   d.v[8] = kTsdfOne;
                   d.w[8] = 6;
                 }),
                 "free-space weight");
  expect_corrupt(file_with_brick([](DenseBrick& d) { d.v[7] = kTsdfOne; }), "without a surface");
  expect_corrupt(file_with_brick([](DenseBrick& d) { d.v[7] = -32768; }), "below -1");
  expect_corrupt(file_with_brick([](DenseBrick& d) {
                   d.v[7] = 0;
                   d.w[7] = 0;
                 }),
                 "without a surface");
  expect_corrupt(file_with_brick([](DenseBrick& d) {
                   d.colors = std::make_unique<BrickColors>();
                   (*d.colors)[1] = {1, 2, 3};
                 }),
                 "has a colour");
}

TEST(Sacmap, SavingRefusesWhatLoadingWould) {
  TsdfSnapshot map = rich_map();
  put(map, {0, 0, 90}, BrickRef::constant_free(7));
  const auto file = encode_map(map);
  ASSERT_FALSE(file.ok());
  EXPECT_EQ(file.error().code, Errc::invalid_argument);
  EXPECT_NE(file.error().context.find("sector (0, 0, 11)"), std::string::npos) << file.error().to_string();
}

class SacmapFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("saccade_sacmap_" + std::to_string(std::random_device{}()) + std::to_string(std::random_device{}()));
    std::filesystem::create_directory(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_;
};

TEST_F(SacmapFile, RoundTripsThroughTheDisk) {
  const TsdfSnapshot map = rich_map();
  const auto path = folder_ / "map.sacmap";
  ASSERT_TRUE(save_map(map, path).ok());
  EXPECT_EQ(std::filesystem::file_size(path), encoded(map).size());
  const auto loaded = load_map(path);
  ASSERT_TRUE(loaded.ok()) << loaded.error().to_string();
  EXPECT_TRUE(loaded->grid == map.grid);
}

TEST_F(SacmapFile, FailuresNameTheFileAndLeaveNothing) {
  const auto missing = load_map(folder_ / "none.sacmap");
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().code, Errc::not_found);
  EXPECT_NE(missing.error().to_string().find("none.sacmap"), std::string::npos);

  const auto cut = folder_ / "cut.sacmap";
  const Bytes file = encoded(rich_map());
  std::ofstream{cut, std::ios::binary}.write(reinterpret_cast<const char*>(file.data()), 1000);
  const auto loaded = load_map(cut);
  ASSERT_FALSE(loaded.ok());
  EXPECT_EQ(loaded.error().code, Errc::corrupt_data);
  EXPECT_NE(loaded.error().to_string().find("cut.sacmap"), std::string::npos);

  EXPECT_FALSE(save_map(rich_map(), folder_ / "no" / "such" / "folder.sacmap").ok());
  TsdfSnapshot bad = rich_map();
  put(bad, {0, 0, 90}, BrickRef::constant_free(7));
  EXPECT_FALSE(save_map(bad, folder_ / "bad.sacmap").ok());
  std::size_t files{0};
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator{folder_}) ++files;
  EXPECT_EQ(files, 1U) << "only cut.sacmap";
}

}  // namespace
}  // namespace saccade
