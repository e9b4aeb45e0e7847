// SPDX-License-Identifier: Apache-2.0
// Clouds in text: what is taken from the lines, and that labels are added to them without touching a letter.
#include "saccade/io/clouds/text_cloud.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "saccade/io/clouds/cloud_io.hpp"
#include "saccade/io/files/file_io.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

Result<TextCloud> parse_lines(std::string_view text) {
  const auto bytes = as_byte_span(text);
  return parse_text_cloud({bytes.begin(), bytes.end()});
}

/// "x:f32 y:f32 z:f64 label:i32".
std::string columns_of(const ColumnTable& table) {
  std::string shown;
  for (const Column& column : table.columns) {
    shown.append(shown.empty() ? "" : " ").append(column.name).append(":").append(to_string(column.type));
  }
  return shown;
}

TEST(TextCloud, NamesAndTypesFollowFromTheLines) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"1 2 3\n", "x:f32 y:f32 z:f32"},
      {"0.1\t0.2\t0.3\r\n4 5 6\r\n", "x:f32 y:f32 z:f32"},
      {"  0.1,  0.2 ,0.3\n", "x:f32 y:f32 z:f32"},
      {"1;2;3;\n", "x:f32 y:f32 z:f32"},
      {"1 2 3 4\n", "x:f32 y:f32 z:f32 intensity:f32"},
      {"1 2 3 4 5\n", "x:f32 y:f32 z:f32 value3:i32 value4:i32"},
      {"1 2 3 0 128 255\n", "x:f32 y:f32 z:f32 r:u8 g:u8 b:u8"},
      {"1 2 3 0.0 128.0 255.0\n", "x:f32 y:f32 z:f32 r:u8 g:u8 b:u8"},
      {"1 2 3 0 128 256\n", "x:f32 y:f32 z:f32 value3:i32 value4:i32 value5:i32"},
      {"1 2 3 0 128 -1\n", "x:f32 y:f32 z:f32 value3:i32 value4:i32 value5:i32"},
      {"1 2 3 0.5 0.5 1\n", "x:f32 y:f32 z:f32 r:f32 g:f32 b:f32"},
      {"1 2 3 0.6 0 -0.8\n", "x:f32 y:f32 z:f32 nx:f32 ny:f32 nz:f32"},
      {"1 2 3 0.5 0 -0.8\n", "x:f32 y:f32 z:f32 value3:f32 value4:i32 value5:f32"},
      {"x y z r g b\n1 2 3 0 0.5 1\n", "x:f32 y:f32 z:f32 r:f32 g:f32 b:f32"},
      {"1 2 3 -20 0 128 255\n", "x:f32 y:f32 z:f32 intensity:f32 r:u8 g:u8 b:u8"},
      {"X,Y,Z,Quality\n1,2,3,4\n", "x:f32 y:f32 z:f32 Quality:i32"},
      {"\"x\";\"GPS time\";\"y\";\"z\"\n1;4000000000;2;3\n", "x:f32 GPS_time:u32 y:f32 z:f32"},
      {"x y z stamp\n1 2 3 1500000000123456789\n", "x:f32 y:f32 z:f32 stamp:i64"},
      {"x y z r g b\n1 2 3 0 1 65535\n", "x:f32 y:f32 z:f32 r:u16 g:u16 b:u16"},
      {"x y z r g b\n1 2 3 0.0 0.5 1.0\n", "x:f32 y:f32 z:f32 r:f32 g:f32 b:f32"},
      {"x y z r g b\n1 2 3 0.0 0.0 1.0\n", "x:f32 y:f32 z:f32 r:f32 g:f32 b:f32"},
      {"x y z red green blue\n1 2 3 0 0 1\n", "x:f32 y:f32 z:f32 red:u8 green:u8 blue:u8"},
      {"// made somewhere\n//X Y Z Nx Ny Nz\n2\n1 2 3 0 0 1\n1 2 3 1 0 0\n", "x:f32 y:f32 z:f32 nx:f32 ny:f32 nz:f32"},
      {"# x y z, as usual\n1 2 3\n", "x:f32 y:f32 z:f32"},
      {"\xEF\xBB\xBFx,y,z\n1,2,3\n", "x:f32 y:f32 z:f32"},
      {"1\n1 2 3\n", "x:f32 y:f32 z:f32"},
      {"1\nz y x\n1 2 3\n\n# the end\n", "z:f32 y:f32 x:f32"},
      {"4512345.678 16777217 nan\n", "x:f64 y:f64 z:f32"},
      {"0.123456791 -inf 1e-45\n", "x:f32 y:f32 z:f32"},
      {"0.1234567 0.12345678901 1e300\n", "x:f32 y:f64 z:f64"},
  };
  for (const auto& [text, columns] : cases) {
    const auto cloud = parse_lines(text);
    ASSERT_TRUE(cloud) << text << cloud.error().to_string();
    EXPECT_EQ(columns_of(cloud->table), columns) << text;
    EXPECT_TRUE(cloud->table.validate()) << text;
  }
}

TEST(TextCloud, KeepsEveryNumber) {
  const TextCloud cloud =
      parse_lines("x y z stamp mixed\n0.1 -2 4512345.678 1500000000123456789 7\nnan 3 1 -5 0.25\n").value();
  ASSERT_EQ(cloud.table.rows, 2U);
  EXPECT_EQ(cloud.table.columns[0].values<float>()[0], 0.1F);
  EXPECT_TRUE(std::isnan(cloud.table.columns[0].value(1)));
  EXPECT_EQ(cloud.table.columns[2].values<double>(), (std::vector<double>{4512345.678, 1.0}));
  EXPECT_EQ(cloud.table.columns[3].values<std::int64_t>(), (std::vector<std::int64_t>{1500000000123456789, -5}));
  EXPECT_EQ(cloud.table.columns[4].values<float>(), (std::vector<float>{7.0F, 0.25F}));
  EXPECT_EQ(cloud.header_line, 1U);
  EXPECT_EQ(cloud.first_row_line, 2U);
}

TEST(TextCloud, ColorsAreKnown) {
  for (const char* text : {"0 0 0 51 0 255\n", "x y z r g b\n0 0 0 0.2 0.0 1\n", "x y z r g b\n0 0 0 13107 0 65535\n",
                           "x,y,z,Red,Green,Blue\n0,0,0,51,0,255\n", "x y z rgb\n0 0 0 3342591\n"}) {
    const PointCloud cloud = cloud_from_fields(parse_lines(text).value().table).value();
    ASSERT_EQ(cloud.colors.size(), 1U) << text;
    EXPECT_TRUE(cloud.colors[0].isApprox(Eigen::Vector3f{0.2F, 0.0F, 1.0F})) << text << cloud.colors[0].transpose();
  }
}

TEST(TextCloud, HostileLinesAreErrorsThatSayWhere) {
  std::string wide(4000, '1');
  for (std::size_t i = 1; i < wide.size(); i += 2) wide[i] = ' ';
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "no points"},
      {"\n# only a comment\n", "holds no points"},
      {"5\n", "no points"},
      {"x y z\n", "no points"},
      {"1 2\n", "line 1"},
      {"hello world\n", "line 1"},
      {"x y\n1 2\n", "with x, y and z"},
      {"1 2 3\n4 5\n", "line 2: this row has 2 numbers where 3"},
      {"1 2 3\n4 5 6 7\n", "line 2: this row has 4 numbers where 3"},
      {"1 2 3\n4 five 6\n", "line 2: 'five' is not a number"},
      {"1,2,3\n4,,6\n", "line 2: a number is missing"},
      {"1.5;2;3\n1,5;2;3\n", "line 2: '1,5' is not a number"},
      {"1,5;2;3\n1.500;2;3\n", "line 2: '1.500' is not a number"},
      {"x y z\n1 2 3 4\n", "line 2: this row has 4 numbers where 3"},
      {"x y z i\n1 2 3\n", "line 2: this row has 3 numbers where 4"},
      {"3\n1 2 3\n4 5 6\n", "it holds 3 points, but it holds 2"},
      {"1\n1 2 3\n4 5 6\n", "it holds 1 points, but it holds 2"},
      {"1 2 3\nx y z\n", "line 2: 'x' is not a number"},
      {"1 2 0x10\n", "line 1"},
      {std::string{"1 2 3\n\0 5 6\n", 12}, "line 2"},
      {wide + "\n", "more than 1024 columns"},
  };
  for (const auto& [text, message] : cases) {
    const auto cloud = parse_lines(text);
    ASSERT_FALSE(cloud) << text;
    EXPECT_NE(cloud.error().to_string().find(message), std::string::npos) << text << cloud.error().to_string();
  }
}

TEST(TextCloud, LooksLikeOneOrNot) {
  for (const char* text :
       {"1 2 3\n", "# a\n\n1,2,3,4\n", "12\n1 2 3\n", "0\n", "12\n# a\nx y z\n", "X;Y;Z\n", "1 2 3\nbroken\n"}) {
    EXPECT_TRUE(looks_like_text_cloud(text)) << text;
  }
  for (const char* text : {"", "# x y z\n", "1 cup\n2 table\n", "Clouds of a table.\n", "0.5 0.25\n", "3\n3\n1\n"}) {
    EXPECT_FALSE(looks_like_text_cloud(text)) << text;
  }
}

TEST(TextCloud, LabelsAreAddedToLinesAsTheyWere) {
  struct Case {
    const char* text;
    const char* path;
    const char* written;
  };
  const std::vector<Case> cases{
      {"0.10 2 3\n 4 5  6.000 \n", "a.xyz", "# x y z label\n0.10 2 3 7\n4 5  6.000 4294967295\n"},
      {"# made here\n2\n1 2 3\n4 5 6\n", "a.txt", "# made here\n2\n# x y z label\n1 2 3 7\n4 5 6 4294967295\n"},
      {"X,Y,Z,\"a b\"\r\n1,2,3,9\r\n4,5,6,8\r\n", "a.csv", "X,Y,Z,\"a b\",label\n1,2,3,9,7\n4,5,6,8,4294967295\n"},
      {"X,Y,Z\n1, 2,3\n4,5,6\n", "a.xyz", "x y z label\n1 2 3 7\n4 5 6 4294967295\n"},
      {"\"x\",y,z,\"a b\"\n1,2,3,9\n4,5,6,8\n", "a.xyz", "x y z a_b label\n1 2 3 9 7\n4 5 6 8 4294967295\n"},
      {"x y  z\n1 2\t3\n4 5 6\n", "a.csv", "x,y,z,label\n1,2,3,7\n4,5,6,4294967295\n"},
      {"x;y;z;\n1;2;3;\n4;5;6;\n", "a.csv", "x;y;z;label\n1;2;3;7\n4;5;6;4294967295\n"},
      {"x\ty\tz\n1\t2\t3\n\n4\t5\t6", "a.txt", "x\ty\tz\tlabel\n1\t2\t3\t7\n\n4\t5\t6\t4294967295\n"},
      {"//X Y Z Label\n2\n1 2 3 1\n// between\n4 5 6 2\n", "a.xyz",
       "//X Y Z label_input label\n2\n1 2 3 1 7\n// between\n4 5 6 2 4294967295\n"},
      {"x,label,y,z,label_input\n1,2,3,4,5\n1,2,3,4,5\n", "a.csv",
       "x,label_input2,y,z,label_input,label\n1,2,3,4,5,7\n1,2,3,4,5,4294967295\n"},
  };
  const std::vector<std::uint32_t> labels{7, std::numeric_limits<std::uint32_t>::max()};
  const test::TempFolder folder;
  for (const Case& c : cases) {
    const TextCloud cloud = parse_lines(c.text).value();
    ASSERT_TRUE(write_labelled_text(folder / c.path, cloud, labels));
    EXPECT_EQ(read_text_file(folder / c.path).value(), c.written);
    const ColumnTable again = std::get<TextCloud>(read_cloud(folder / c.path).value().file).table;
    ASSERT_EQ(again.columns.size(), cloud.table.columns.size() + 1) << c.written;
    for (std::size_t i = 0; i < cloud.table.columns.size(); ++i) {
      EXPECT_EQ(again.columns[i].bytes, cloud.table.columns[i].bytes) << c.written;
    }
    EXPECT_EQ(again.find("label")->values<std::uint32_t>(), labels) << c.written;
  }
}

TEST(TextCloud, TablesAreWrittenAndReadBack) {
  ColumnTable table;
  table.add<float>("x", std::vector<float>{0.1F, std::nanf(""), 3e-30F});
  table.add<float>("y", std::vector<float>{1.0F, 2.0F, 3.5F});
  table.add<double>("z", std::vector<double>{4512345.678, 0.1, 1e-300});
  table.add<float>("rgb", std::vector<float>{std::bit_cast<float>(0xFFFF0080U), 0.0F, std::bit_cast<float>(0x00FF00U)});
  table.add<std::uint8_t>("_", std::vector<std::uint8_t>{1, 2, 3});
  table.add<std::int16_t>("bin", std::vector<std::int16_t>{1, -2, 3, -4, 5, -6}, 2);
  const test::TempFolder folder;
  for (const char* name : {"a.xyz", "a.csv", "a.txt"}) {
    ASSERT_TRUE(write_text_cloud(folder / name, table));
    const ColumnTable again = read_cloud(folder / name).value().fields();
    EXPECT_EQ(columns_of(again), "x:f32 y:f32 z:f64 rgb:u32 bin_0:i32 bin_1:i32") << name;
    EXPECT_EQ(again.columns[1], table.columns[1]);
    EXPECT_EQ(again.columns[2], table.columns[2]);
    EXPECT_EQ(again.find("rgb")->bytes, table.find("rgb")->bytes);
    EXPECT_EQ(again.find("bin_1")->values<std::int32_t>(), (std::vector<std::int32_t>{-2, -4, -6}));
    EXPECT_EQ(again.columns[0].value(0), table.columns[0].value(0));
    EXPECT_EQ(again.columns[0].value(2), table.columns[0].value(2));
  }
}

}  // namespace
}  // namespace saccade
