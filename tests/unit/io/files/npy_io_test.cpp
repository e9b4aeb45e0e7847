// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/files/npy_io.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "saccade/io/files/file_io.hpp"

namespace saccade {
namespace {

/// A file with a header of our own words, as formats 1.0, 2.0 and so on have it.
std::string npy_file(const std::string& dict, std::string_view numbers, char version = 1) {
  std::string file{"\x93NUMPY"};
  file += version;
  file += '\0';
  for (std::size_t k = 0; k < (version == 1 ? 2U : 4U); ++k) file += static_cast<char>(dict.size() >> 8U * k & 0xFFU);
  return file + dict + std::string{numbers};
}

template <class T>
void expect_read(const char* type) {
  const std::vector<T> numbers{0, 1, std::numeric_limits<T>::min(), std::numeric_limits<T>::max()};
  const std::string bytes{as_text(std::as_bytes(std::span{numbers}))};
  const std::array<std::size_t, 1> shape{numbers.size()};
  for (const std::string& file :
       {npy_header(type, shape) + bytes,
        npy_file("{\"shape\":(4,),\"fortran_order\":True,\"descr\":\"" + std::string{type} + "\"}  \n", bytes, 2)}) {
    const auto column = parse_npy(as_byte_span(file));
    ASSERT_TRUE(column) << type << ": " << column.error().to_string();
    EXPECT_EQ(column->values<T>(), numbers) << type;
    for (std::size_t size = 0; size < file.size(); ++size) {
      const auto cut = parse_npy(as_byte_span(std::string_view{file}.substr(0, size)));
      ASSERT_FALSE(cut) << type << ", " << size;
      EXPECT_FALSE(cut.error().context.empty()) << type << ", " << size;
    }
    EXPECT_EQ(parse_npy(as_byte_span(file + "0")).error().code, Errc::corrupt_data);
  }
}

TEST(Npy, WholeNumbersOfEveryTypeAreRead) {
  expect_read<std::int8_t>("|i1");
  expect_read<std::uint8_t>("|u1");
  expect_read<std::int16_t>("<i2");
  expect_read<std::uint16_t>("<u2");
  expect_read<std::int32_t>("<i4");
  expect_read<std::uint32_t>("<u4");
  expect_read<std::int64_t>("<i8");
  expect_read<std::uint64_t>("=u8");
}

TEST(Npy, HeaderIsAsNumPyWritesIt) {
  const std::array<std::size_t, 1> row{5};
  const std::string header = npy_header("<u4", row);
  ASSERT_EQ(header.size(), 128U);
  EXPECT_EQ(header.substr(0, 10), (std::string{"\x93NUMPY\x01\x00\x76\x00", 10}));
  EXPECT_TRUE(header.substr(10).starts_with("{'descr': '<u4', 'fortran_order': False, 'shape': (5,), }  "));
  EXPECT_EQ(header.back(), '\n');
  const std::array<std::size_t, 2> plane{2, 3};
  EXPECT_NE(npy_header("|u1", plane).find("'shape': (2, 3), }"), std::string::npos);
}

TEST(Npy, OtherArraysAreErrors) {
  const std::string rest = ", 'fortran_order': False, 'shape': (1,), }";
  const std::vector<std::tuple<std::string, Errc, std::string>> cases{
      {"", Errc::corrupt_data, "not an array"},
      {"PK\x03\x04", Errc::corrupt_data, "not an array"},
      {npy_file("{'descr': '<f4'" + rest, "1234"), Errc::unsupported, "'<f4'"},
      {npy_file("{'descr': '>u4'" + rest, "1234"), Errc::unsupported, "'>u4'"},
      {npy_file("{'descr': '|b1'" + rest, "1"), Errc::unsupported, "'|b1'"},
      {npy_file("{'descr': [('a', '<u4')]" + rest, "1234"), Errc::unsupported, "several fields"},
      {npy_file("{'descr': '<u4', 'fortran_order': False, 'shape': (), }", "1234"), Errc::unsupported, "0 dimensions"},
      {npy_file("{'descr': '<u4', 'fortran_order': False, 'shape': (1, 1), }", "1234"), Errc::unsupported,
       "2 dimensions"},
      {npy_file("{'descr': '<u4'" + rest, "1234", 3), Errc::unsupported, "format 3.0"},
      {npy_file("{'descr': '<u4'" + rest, "123"), Errc::corrupt_data, "3 bytes follow"},
      {npy_file("{'descr': '<u4'" + rest, "12345678"), Errc::corrupt_data, "8 bytes follow"},
      {npy_file("{'descr': '<u8', 'fortran_order': False, 'shape': (2305843009213693953,), }", "12345678"),
       Errc::corrupt_data, "bytes follow"},
      {npy_file("{'descr': '<u4', 'fortran_order': False, 'shape': (99999999999999999999999,), }", "1234"),
       Errc::corrupt_data, "not a number"},
      {npy_file("{'descr': '<u4', 'fortran_order': False, 'shape': (-1,), }", "1234"), Errc::corrupt_data,
       "not a number"},
      {npy_file("{'descr': '<u4', 'fortran_order': 0, 'shape': (1,), }", "1234"), Errc::corrupt_data, "fortran_order"},
      {npy_file("{'descr': '<u4', 'color': 'red'" + rest, "1234"), Errc::corrupt_data, "'color'"},
      {npy_file("{'fortran_order': False, 'shape': (1,), }", "1234"), Errc::corrupt_data, "lacks the type"},
      {npy_file("{'descr': '<u4', 'fortran_order': False, }", "1234"), Errc::corrupt_data, "the shape"},
      {npy_file("{'descr': '<u4", "1234"), Errc::corrupt_data, "in quotes"},
      {npy_file("", "1234"), Errc::corrupt_data, "byte 10"},
  };
  for (const auto& [file, code, message] : cases) {
    const auto column = parse_npy(as_byte_span(file));
    ASSERT_FALSE(column) << file;
    EXPECT_EQ(column.error().code, code) << file << column.error().to_string();
    EXPECT_NE(column.error().to_string().find(message), std::string::npos) << file << column.error().to_string();
  }
}

}  // namespace
}  // namespace saccade
