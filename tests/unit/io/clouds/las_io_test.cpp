// SPDX-License-Identifier: Apache-2.0
// LAS: every version and point format is read, classes are written back, and damaged headers are errors.
#include "saccade/io/clouds/las_io.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "saccade/io/clouds/cloud_io.hpp"
#include "saccade/io/clouds/label_io.hpp"
#include "saccade/io/files/file_io.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

constexpr std::array<std::size_t, 11> kRecordBytes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

template <class T>
void put(std::vector<std::byte>& bytes, std::size_t at, T value) {
  std::memcpy(&bytes[at], &value, sizeof(T));
}

/// Two points at (461234.5, 5263456.25, 512) and 1 m east of it, of classes 2 and 31, with five extra bytes each.
std::vector<std::byte> made_las(int minor, int format) {
  constexpr std::size_t kExtra{5};
  const std::size_t header = minor >= 4 ? 375 : (minor == 3 ? 235 : 227);
  const std::size_t begin = header + 54;  // after a record of variable length
  const std::size_t record = kRecordBytes[static_cast<std::size_t>(format)] + kExtra;
  std::vector<std::byte> file(begin + 2 * record);
  std::memcpy(file.data(), "LASF", 4);
  put(file, 24, std::uint8_t{1});
  put(file, 25, static_cast<std::uint8_t>(minor));
  put(file, 94, static_cast<std::uint16_t>(header));
  put(file, 96, static_cast<std::uint32_t>(begin));
  put(file, 100, std::uint32_t{1});
  put(file, 104, static_cast<std::uint8_t>(format));
  put(file, 105, static_cast<std::uint16_t>(record));
  put(file, 107, std::uint32_t{format < 6 ? 2U : 0U});
  if (minor >= 4) put(file, 247, std::uint64_t{2});
  const std::array<double, 3> offset{461000.0, 5263000.0, 500.0};
  for (std::size_t k = 0; k < 3; ++k) {
    put(file, 131 + 8 * k, 0.25);
    put(file, 155 + 8 * k, offset[k]);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t at = begin + i * record;
    put(file, at, static_cast<std::int32_t>(938 + 4 * i));
    put(file, at + 4, std::int32_t{1825});
    put(file, at + 8, std::int32_t{48});
    put(file, at + 12, std::uint16_t{700});
    put(file, at + (format < 6 ? 15 : 16), static_cast<std::uint8_t>((i == 0 ? 2 : 31) | (format < 6 ? 0x80 : 0)));
    if (format == 2) put(file, at + 20, std::array<std::uint16_t, 3>{65535, 256, 0});
    if (format == 7) put(file, at + 30, std::array<std::uint16_t, 3>{255, 128, 0});
    if (format == 8) put(file, at + 36, std::uint16_t{1234});
    if (format == 1) put(file, at + 20, 0.5);
    put(file, at + record - kExtra, std::array<char, kExtra>{'e', 'x', 't', 'r', 'a'});
  }
  return file;
}

TEST(Las, EveryVersionAndPointFormatIsRead) {
  for (int minor = 0; minor <= 4; ++minor) {
    for (int format = minor >= 4 ? 0 : 0; format <= (minor >= 4 ? 10 : (minor == 3 ? 5 : 3)); ++format) {
      const auto las = parse_las(made_las(minor, format));
      ASSERT_TRUE(las) << minor << ", " << format << ": " << las.error().to_string();
      ASSERT_EQ(las->table.rows, 2U);
      EXPECT_EQ(las->table.find("x")->value(1), 461235.5);
      EXPECT_EQ(las->table.find("y")->value(1), 5263456.25);
      EXPECT_EQ(las->table.find("z")->value(0), 512.0);
      EXPECT_EQ(las->table.find("intensity")->value(0), 700.0);
      EXPECT_EQ(las->table.find("classification")->values<std::uint8_t>(), (std::vector<std::uint8_t>{2, 31}));
      EXPECT_EQ(las->table.find("class_flags")->value(0), format < 6 ? 4.0 : 0.0);
      EXPECT_EQ(las->table.find("red") != nullptr,
                format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10);
      EXPECT_TRUE(las->table.validate());
    }
  }
  EXPECT_EQ(parse_las(made_las(2, 2))->table.find("red")->values<std::uint16_t>()[0], 65535);
  EXPECT_EQ(parse_las(made_las(4, 7))->table.find("green")->values<std::uint8_t>()[0], 128) << "8 bits in 16";
  EXPECT_EQ(parse_las(made_las(4, 8))->table.find("nir")->value(1), 1234.0);
  EXPECT_EQ(parse_las(made_las(2, 1))->table.find("gps_time")->value(1), 0.5);
}

TEST(Las, LabelsBecomeClassesAndNothingElseChanges) {
  const test::TempFolder folder;
  for (const int format : {2, 7}) {
    const std::vector<std::byte> file = made_las(4, format);
    ASSERT_TRUE(write_file_atomically(folder / "in.las", std::span<const std::byte>{file}));
    CloudFile cloud = read_cloud(folder / "in.las").value();
    EXPECT_EQ(read_labels(folder / "in.las", 2).value(), (std::vector<std::uint32_t>{2, 31})) << "its own classes";
    ASSERT_TRUE(write_labels(folder / "out.las", cloud, std::vector<std::uint32_t>{9, 0}));
    std::vector<std::byte> written = read_file(folder / "out.las").value();
    EXPECT_EQ(read_labels(folder / "out.las", 2).value(), (std::vector<std::uint32_t>{9, 0}));
    const std::size_t record = kRecordBytes[static_cast<std::size_t>(format)] + 5;
    std::size_t differing{0};
    for (std::size_t i = 0; i < file.size(); ++i) differing += file[i] == written[i] ? 0 : 1;
    EXPECT_EQ(differing, 2U) << "one byte per point";
    EXPECT_EQ(written.size(), 375 + 54 + 2 * record);
    const auto most = std::get<LasFile>(cloud.file).greatest_class();
    EXPECT_EQ(most, format == 2 ? 31U : 255U);
    const Status too_many = write_labels(folder / "many.las", cloud, std::vector<std::uint32_t>{most, most + 1});
    ASSERT_FALSE(too_many);
    EXPECT_EQ(too_many.error().code, Errc::unsupported);
    EXPECT_NE(too_many.error().to_string().find("point 1"), std::string::npos);
    ASSERT_TRUE(write_labels(folder / "out.ply", cloud, std::vector<std::uint32_t>{9, 0}));
    EXPECT_EQ(read_cloud(folder / "out.ply").value().fields().find("x")->value(1), 461235.5) << "doubles stay";
  }
  CloudFile other{PcdFile{}};
  other.fields().add<float>("x", std::vector<float>{0.0F});
  EXPECT_EQ(write_cloud(folder / "other.las", other).error().code, Errc::unsupported);
}

TEST(Las, DamagedAndCompressedFilesAreErrors) {
  const std::vector<std::byte> file = made_las(2, 2);
  for (std::size_t size = 0; size < file.size(); ++size) {
    EXPECT_EQ(parse_las({file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size)}).error().code,
              Errc::corrupt_data)
        << size;
  }
  const auto with = [&](std::size_t at, auto value) {
    std::vector<std::byte> changed = file;
    put(changed, at, value);
    return parse_las(std::move(changed));
  };
  const auto compressed = with(104, std::uint8_t{0x82});
  EXPECT_EQ(compressed.error().code, Errc::unsupported);
  EXPECT_NE(compressed.error().message.find("laszip"), std::string::npos);
  EXPECT_EQ(with(104, std::uint8_t{11}).error().code, Errc::unsupported);
  EXPECT_EQ(with(25, std::uint8_t{5}).error().code, Errc::unsupported);
  EXPECT_EQ(with(96, std::uint32_t{100}).error().code, Errc::corrupt_data);
  EXPECT_EQ(with(96, std::uint32_t{0xFFFFFFFF}).error().code, Errc::corrupt_data);
  EXPECT_EQ(with(105, std::uint16_t{25}).error().code, Errc::corrupt_data);
  EXPECT_EQ(with(107, std::uint32_t{0xFFFFFFFF}).error().code, Errc::corrupt_data);
  EXPECT_EQ(with(131, std::numeric_limits<double>::quiet_NaN()).error().code, Errc::corrupt_data);
}

}  // namespace
}  // namespace saccade
