// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/pcd_io.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iostream>
#include <limits>
#include <random>

#include "saccade/io/clouds/internal/lzf.hpp"
#include "saccade/io/files/file_io.hpp"
#include "support/places.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using test::TempFolder;

PcdFile organised_cloud() {
  PcdFile file;
  file.width = 3;
  file.height = 2;
  file.viewpoint = {0.5, -1.0, 2.0, 0.0, 1.0, 0.0, 0.0};
  file.table.add<float>("x",
                        std::vector<float>{0.1F, -2.5F, 3e-30F, 4.0F, 5.0F, std::numeric_limits<float>::infinity()});
  file.table.add<std::uint8_t>("_", std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, 2);
  file.table.add<std::uint32_t>("rgba", std::vector<std::uint32_t>{0xFF00FF00U, 1, 2, 3, 4, 5});
  file.table.add<std::int16_t>("histogram", std::vector<std::int16_t>(18, -7), 3);
  file.table.add<double>("stamp", std::vector<double>{1e300, 0.1, 2, 3, 4, 5});
  file.table.add<std::int64_t>("id",
                               std::vector<std::int64_t>{std::numeric_limits<std::int64_t>::min(), 1, 2, 3, 4, 5});
  file.table.add<std::uint8_t>("_", std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6});
  return file;
}

class PcdFormats : public testing::TestWithParam<PcdFormat> {};

TEST_P(PcdFormats, KeepEverything) {
  const TempFolder folder;
  const PcdFile written = organised_cloud();
  const Status status = write_pcd(folder / "x.pcd", written, GetParam());
  ASSERT_TRUE(status) << status.error().to_string();
  const auto read = read_pcd(folder / "x.pcd");
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->table, written.table);
  EXPECT_EQ(read->width, 3U);
  EXPECT_EQ(read->height, 2U);
  EXPECT_EQ(read->viewpoint, written.viewpoint);
}

TEST_P(PcdFormats, EveryCutIsAnError) {
  const TempFolder folder;
  ASSERT_TRUE(write_pcd(folder / "x.pcd", organised_cloud(), GetParam()));
  const auto bytes = read_file(folder / "x.pcd");
  ASSERT_TRUE(bytes);
  // Without its last line end an ascii file is complete.
  const std::size_t last = bytes->size() - (GetParam() == PcdFormat::ascii ? 1 : 0);
  for (std::size_t size = 0; size < last; ++size) {
    const auto read = parse_pcd(std::span{*bytes}.first(size));
    ASSERT_FALSE(read) << size << " of " << bytes->size();
    EXPECT_FALSE(read.error().context.empty());
  }
}

INSTANTIATE_TEST_SUITE_P(All, PcdFormats,
                         testing::Values(PcdFormat::ascii, PcdFormat::binary, PcdFormat::binary_compressed));

TEST(Pcd, HostileFilesAreErrorsThatSayWhere) {
  const std::string fields = "VERSION 0.7\nFIELDS x y\nSIZE 4 4\nTYPE F F\nCOUNT 1 1\n";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "not a PCD"},
      {"hello\n", "line 1"},
      {"FIELDS x\nSIZE 4\nTYPE F\nWIDTH 1\n", "does not end"},
      {"FIELDS\nDATA ascii\n", "FIELDS"},
      {"FIELDS x y\nSIZE 4\nTYPE F F\nWIDTH 1\nDATA ascii\n1\n", "equally many"},
      {"FIELDS x\nSIZE 3\nTYPE F\nWIDTH 1\nDATA ascii\n1\n", "no such type"},
      {"FIELDS x\nSIZE 2\nTYPE F\nWIDTH 1\nDATA ascii\n1\n", "no such type"},
      {"FIELDS x\nSIZE 4\nTYPE F\nCOUNT 0\nWIDTH 1\nDATA ascii\n1\n", "COUNT"},
      {"FIELDS x\nSIZE 4\nTYPE F\nCOUNT 4000000000\nWIDTH 1\nDATA binary\n1234", "COUNT"},
      {"FIELDS x\nSIZE 4\nTYPE F\nWIDTH -1\nDATA ascii\n1\n", "line 4"},
      {"FIELDS x\nSIZE 4\nTYPE F\nDATA ascii\n1\n", "WIDTH"},
      {fields + "WIDTH 2\nHEIGHT 2\nPOINTS 3\nDATA ascii\n", "POINTS 3"},
      {fields + "WIDTH 1\nHEIGHT 1\nDATA zip\n", "zip"},
      {fields + "WIDTH 1\nVIEWPOINT 0 0 0\nDATA ascii\n", "VIEWPOINT"},
      {fields + "WIDTH 4294967295\nHEIGHT 4294967295\nDATA ascii\n1 2\n", "ends before"},
      {fields + "WIDTH 4294967295\nHEIGHT 4294967295\nDATA binary\n12345678", "ends before"},
      {fields + "WIDTH 4294967295\nHEIGHT 4294967295\nDATA binary_compressed\n12345678", "not of the size"},
      {fields + "WIDTH 2\nDATA ascii\n1 2\n3\n", "line 9"},
      {fields + "WIDTH 2\nDATA ascii\n1 2\n3 4 5\n", "too many"},
      {fields + "WIDTH 2\nDATA ascii\n1 2\n3 four\n", "'four'"},
  };
  for (const auto& [text, message] : cases) {
    const auto read = parse_pcd(as_byte_span(text));
    ASSERT_FALSE(read) << text;
    EXPECT_NE(read.error().to_string().find(message), std::string::npos) << text << "\n" << read.error().to_string();
  }
}

TEST(Pcd, WrongTablesAreRefused) {
  const TempFolder folder;
  PcdFile file = organised_cloud();
  file.width = 7;
  EXPECT_EQ(write_pcd(folder / "x.pcd", file).error().code, Errc::size_mismatch);
  file = organised_cloud();
  file.table.columns[0].bytes.pop_back();
  EXPECT_EQ(write_pcd(folder / "x.pcd", file).error().code, Errc::size_mismatch);
  file = organised_cloud();
  file.table.columns[0].name = "two words";
  EXPECT_EQ(write_pcd(folder / "x.pcd", file).error().code, Errc::invalid_argument);
  EXPECT_EQ(write_pcd(folder / "x.pcd", ColumnTable{}).error().code, Errc::invalid_argument);
  EXPECT_FALSE(fs::exists(folder / "x.pcd"));
}

TEST(Lzf, RoundTripsAndSurvivesDamage) {
  constexpr std::uint32_t kSeed{11};
  std::mt19937 random{kSeed};
  std::size_t damaged = 0;
  std::size_t cases = 0;
  for (int round = 0; round < 400; ++round) {
    std::vector<std::byte> data(random() % 3000);
    const unsigned alphabet = 1U + static_cast<unsigned>(random() % 255U);
    for (std::byte& b : data) b = static_cast<std::byte>(random() % alphabet);
    auto packed = lzf_compress(data);
    EXPECT_LE(packed.size(), data.size() + data.size() / 32 + 1);
    const auto back = lzf_decompress(packed, data.size());
    ASSERT_TRUE(back);
    EXPECT_EQ(*back, data);
    EXPECT_FALSE(lzf_decompress(packed, data.size() + 1));
    ++cases;
    if (packed.empty()) continue;
    packed[random() % packed.size()] ^= static_cast<std::byte>(1U + random() % 255U);
    const auto other = lzf_decompress(packed, data.size());
    if (!other || *other != data) ++damaged;
  }
  std::cout << "seed " << kSeed << ", cases " << cases << "\n";
  EXPECT_EQ(cases, 400U);
  EXPECT_GT(damaged, 300U);
}

TEST(Pcd, RealCloudsAreRead) {
  const fs::path data = test::shared_data();
  if (!fs::exists(data / "clouds")) GTEST_SKIP() << "no " << data / "clouds";
  std::size_t clouds = 0;
  for (const char* place : {"clouds", "mosd_labelled"}) {
    for (const auto& entry : fs::recursive_directory_iterator{data / place}) {
      if (entry.path().extension() != ".pcd") continue;
      const auto cloud = read_pcd(entry.path());
      ASSERT_TRUE(cloud) << cloud.error().to_string();
      ++clouds;
      const Column* z = cloud->table.find("z");
      ASSERT_NE(z, nullptr);
      std::size_t finite = 0;
      for (std::size_t i = 0; i < cloud->table.rows; ++i) finite += std::isfinite(z->value(i)) ? 1U : 0U;
      EXPECT_GT(finite, cloud->table.rows / 3) << entry.path();
      // What is written compressed is read back to the bit.
      const TempFolder folder;
      ASSERT_TRUE(write_pcd(folder / "again.pcd", *cloud, PcdFormat::binary_compressed));
      const auto again = read_pcd(folder / "again.pcd");
      ASSERT_TRUE(again);
      EXPECT_EQ(again->table, cloud->table);
    }
  }
  EXPECT_EQ(clouds, 19U);
}

TEST(Pcd, OrganisedRealCloudObeysItsCamera) {
  const fs::path path = test::shared_data() / "mosd_labelled/learn/learn0.pcd";
  if (!fs::exists(path)) GTEST_SKIP() << "no " << path;
  const auto cloud = read_pcd(path);
  ASSERT_TRUE(cloud);
  const Column* x = cloud->table.find("x");
  const Column* z = cloud->table.find("z");
  std::size_t checked = 0;
  for (std::size_t i = 0; i < cloud->table.rows; i += 97) {
    if (!std::isfinite(z->value(i))) continue;
    EXPECT_NEAR(525.0 * x->value(i) / z->value(i) + 319.5, static_cast<double>(i % cloud->width), 1e-2);
    ++checked;
  }
  EXPECT_GT(checked, 1000U);
}

}  // namespace
}  // namespace saccade
