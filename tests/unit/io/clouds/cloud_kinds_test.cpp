// SPDX-License-Identifier: Apache-2.0
// Clouds as people bring them: arrays of NumPy, names that say nothing, decimal commas, coordinates of maps.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "saccade/io/clouds/cloud_io.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/npy_io.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

template <class T>
std::string bytes_of_values(const std::vector<T>& values) {
  return std::string{as_text(std::as_bytes(std::span{values}))};
}

std::string npy(const std::string& descr, const std::string& shape, bool fortran, const std::string& bytes) {
  std::string dict =
      "{'descr': " + descr + ", 'fortran_order': " + (fortran ? "True" : "False") + ", 'shape': " + shape + ", }";
  std::string file{"\x93NUMPY\x01"};
  file += '\0';
  file += static_cast<char>(dict.size() & 0xFFU);
  file += static_cast<char>(dict.size() >> 8U);
  return file + dict + bytes;
}

Result<CloudFile> read_as(const test::TempFolder& folder, const char* name, const std::string& content) {
  EXPECT_TRUE(write_file_atomically(folder / name, content));
  return read_cloud(folder / name);
}

TEST(NpyClouds, TablesOfEitherOrderAndTypeAreRead) {
  const test::TempFolder folder;
  const std::vector<double> rows{1, 2, 3, 4, 5, 6};
  const std::vector<float> columns{1, 4, 2, 5, 3, 6};
  for (const std::string& file :
       {npy("'<f8'", "(2, 3)", false, bytes_of_values(rows)), npy("'<f4'", "(2, 3)", true, bytes_of_values(columns))}) {
    const auto cloud = read_as(folder, "c.npy", file);
    ASSERT_TRUE(cloud) << cloud.error().to_string();
    const PointCloud points = cloud_from_fields(cloud->fields()).value();
    ASSERT_EQ(points.positions_m.size(), 2U);
    EXPECT_EQ(points.positions_m[1], (Eigen::Vector3f{4, 5, 6}));
  }
  std::string big = bytes_of_values(std::vector<std::uint16_t>{0x0100, 0x0200, 0x0300});
  EXPECT_EQ(read_as(folder, "big", npy("'>u2'", "(1, 3)", false, big))->fields().find("y")->value(0), 2.0);
}

TEST(NpyClouds, SixColumnsAreColorsOrNormals) {
  const test::TempFolder folder;
  const auto colors_of = [&](const std::vector<double>& rows) {
    return cloud_from_fields(read_as(folder, "c.npy", npy("'<f8'", "(2, 6)", false, bytes_of_values(rows)))->fields())
        .value();
  };
  const PointCloud bytes = colors_of({0, 0, 0, 255, 0, 51, 1, 1, 1, 0, 255, 0});
  ASSERT_EQ(bytes.colors.size(), 2U);
  EXPECT_TRUE(bytes.colors[0].isApprox(Eigen::Vector3f{1.0F, 0.0F, 0.2F}));
  const PointCloud shares = colors_of({0, 0, 0, 1.0, 0.0, 0.2, 1, 1, 1, 0.0, 0.5, 0.0});
  ASSERT_EQ(shares.colors.size(), 2U);
  EXPECT_TRUE(shares.colors[0].isApprox(Eigen::Vector3f{1.0F, 0.0F, 0.2F}));
  const PointCloud normals = colors_of({0, 0, 0, 0, 0, -1, 1, 1, 1, 0.6, 0.8, 0});
  EXPECT_TRUE(normals.colors.empty());
  ASSERT_EQ(normals.normals.size(), 2U);
  EXPECT_EQ(normals.normals[0], -Eigen::Vector3f::UnitZ());
  const PointCloud others = colors_of({0, 0, 0, 300, 0.5, -7, 1, 1, 1, 0, 0, 0});
  EXPECT_TRUE(others.colors.empty() && others.normals.empty());
}

TEST(NpyClouds, RecordsKeepTheirFields) {
  const test::TempFolder folder;
  std::string records;
  for (const float x : {1.5F, 2.5F}) {
    records += bytes_of_values(std::vector<float>{x, 0.25F, -1.0F});
    records += bytes_of_values(std::vector<std::uint8_t>{7});
  }
  const std::string type = "[('x', '<f4'), ('y', '<f4'), ('z', '<f4'), ('ring', '|u1')]";
  const auto cloud = read_as(folder, "c.npy", npy(type, "(2,)", false, records));
  ASSERT_TRUE(cloud) << cloud.error().to_string();
  EXPECT_EQ(cloud->fields().find("x")->value(1), 2.5);
  EXPECT_EQ(cloud->fields().find("ring")->value(1), 7.0);
  EXPECT_EQ(read_as(folder, "n.npy", npy("[('a', '<f4')]", "(1,)", false, "1234")).error().code, Errc::corrupt_data);
}

TEST(NpyClouds, NamesOfFieldsThatNoTableMayHaveAreChanged) {
  const test::TempFolder folder;
  const std::string type = "[('x', '<f4'), ('y', '<f4'), ('z', '<f4'), ('GPS time', '<f4'), ('', '<f4')]";
  const auto cloud =
      read_as(folder, "c.npy", npy(type, "(1,)", false, bytes_of_values(std::vector<float>{1, 2, 3, 4, 5})));
  ASSERT_TRUE(cloud) << cloud.error().to_string();
  EXPECT_TRUE(cloud->fields().validate());
  EXPECT_EQ(cloud->fields().find("GPS_time")->value(0), 4.0);
  EXPECT_EQ(cloud->fields().find("field5")->value(0), 5.0);
}

TEST(NpyClouds, OtherArraysAreErrorsThatSayWhatToDo) {
  const test::TempFolder folder;
  const std::string wide = bytes_of_values(std::vector<float>(3 * 2000));
  const auto transposed = read_as(folder, "t.npy", npy("'<f4'", "(3, 2000)", false, wide));
  EXPECT_EQ(transposed.error().code, Errc::unsupported);
  EXPECT_NE(transposed.error().message.find("transpose"), std::string::npos) << transposed.error().message;
  const std::string narrow = bytes_of_values(std::vector<float>(3 * 500));
  EXPECT_NE(read_as(folder, "t.npy", npy("'<f4'", "(3, 500)", false, narrow)).error().message.find("transpose"),
            std::string::npos);
  EXPECT_EQ(read_as(folder, "h.npy", npy("'<f2'", "(1, 3)", false, "123456")).error().code, Errc::unsupported);
  EXPECT_EQ(read_as(folder, "d.npy", npy("'<f4'", "(1, 2, 3)", false, std::string(24, 0))).error().code,
            Errc::unsupported);
  EXPECT_EQ(read_as(folder, "c.npy", npy("'<f4'", "(9, 3)", false, "1234")).error().code, Errc::corrupt_data);
}

TEST(CloudKinds, ContentDecidesAndNamesAreHints) {
  const test::TempFolder folder;
  for (const char* name : {"a.asc", "a.xyzn", "a.dat", "a", "a.PTS", "a.bin.txt"}) {
    const auto cloud = read_as(folder, name, "1 2 3\n4 5 6\n");
    ASSERT_TRUE(cloud) << name << ": " << cloud.error().to_string();
    EXPECT_EQ(cloud->fields().rows, 2U) << name;
  }
  EXPECT_EQ(read_as(folder, "named.dat", "# a table\nx,y,z\n1,2,3\n")->fields().rows, 1U);
  EXPECT_EQ(cloud_from_fields(read_as(folder, "n.xyzn", "0 0 0 0 0 -1\n1 1 1 0 0.6 0.8\n")->fields())->normals.size(),
            2U);
  EXPECT_EQ(cloud_from_fields(read_as(folder, "c.xyzrgb", "0 0 0 0.5 0 1\n1 1 1 0 0 0.25\n")->fields())->colors.size(),
            2U);
  const auto empty = read_as(folder, "empty.pcd", "");
  EXPECT_NE(empty.error().message.find("empty"), std::string::npos);
  std::string noise;
  for (unsigned i = 0, state = 1; i < 4096; ++i)
    noise += static_cast<char>((state = state * 1664525U + 1013904223U) >> 24U);
  EXPECT_EQ(read_as(folder, "noise.bin", noise).error().code, Errc::corrupt_data) << "no scan of KITTI";
  EXPECT_EQ(read_as(folder, "scan.bin", bytes_of_values(std::vector<float>{1, 2, 3, 0.5F}))->fields().rows, 1U);
  const auto e57 = read_as(folder, "s.e57", "ASTM-E57 and more");
  EXPECT_EQ(e57.error().code, Errc::unsupported);
  EXPECT_NE(e57.error().message.find("CloudCompare"), std::string::npos);
  EXPECT_EQ(read_as(folder, "words.txt", "neither numbers nor names\n").error().code, Errc::corrupt_data);
}

TEST(CloudKinds, FoldersListEveryKind) {
  const test::TempFolder folder;
  for (const char* name : {"a.asc", "b.LAS", "c.xyz", "d.txt"}) {
    ASSERT_TRUE(write_file_atomically(folder / name, "1 2 3\n"));
  }
  ASSERT_TRUE(write_file_atomically(folder / "labels.npy", npy("'<u4'", "(1,)", false, "1234")));
  ASSERT_TRUE(write_file_atomically(folder / "rows.npy", npy("'<f4'", "(0, 3)", false, "")));
  const std::vector<std::filesystem::path> found = list_clouds(folder.path()).value();
  ASSERT_EQ(found.size(), 5U) << "all but the labels";
  EXPECT_EQ(found.back().filename(), "rows.npy");
}

TEST(DecimalCommas, AreReadWhereNothingElseIsPossible) {
  const test::TempFolder folder;
  for (const char* text : {"0,5 -1,25 3\n1,5 2,0 4,5\n", "0,5;-1,25;3\n1,5;2,0;4,5\n",
                           "x\ty\tz\n0,5\t-1,25\t3\n1,5\t2\t4,5\n", "x;y;z\n0,5;-1,25;3\n1,5;2,0;4,5\n"}) {
    const auto cloud = read_as(folder, "c.txt", text);
    ASSERT_TRUE(cloud) << text << cloud.error().to_string();
    EXPECT_EQ(cloud->fields().find("x")->value(0), 0.5) << text;
    EXPECT_EQ(cloud->fields().find("y")->value(0), -1.25) << text;
    EXPECT_EQ(cloud->fields().find("z")->value(1), 4.5) << text;
  }
  EXPECT_EQ(read_as(folder, "late.txt", "0 0 0\n0,5 1 2\n")->fields().find("x")->value(1), 0.5)
      << "after whole numbers";
  const CloudFile cloud = read_as(folder, "c.txt", "0,5 -1,25 3\n").value();
  ASSERT_TRUE(write_labelled_text(folder / "l.csv", std::get<TextCloud>(cloud.file), std::vector<std::uint32_t>{7}));
  EXPECT_NE(read_text_file(folder / "l.csv")->find("0,5;-1,25;3;7"), std::string::npos)
      << "commas do not separate, too";
  EXPECT_EQ(read_cloud(folder / "l.csv")->fields().find("label")->value(0), 7.0);
  for (const char* text : {"0,024, 0,901, -0,036\n", "0,024,0,901,0,036\n"}) {
    const auto both = read_as(folder, "b.txt", text);
    ASSERT_FALSE(both) << text;
    EXPECT_NE(both.error().message.find("decimal commas"), std::string::npos) << both.error().message;
  }
  EXPECT_EQ(read_as(folder, "o.csv", "1,2,3\n4, 5, 6\n")->fields().rows, 2U) << "plain commas stay separators";
}

TEST(FarClouds, KeepDistancesOfTheirDoubles) {
  ColumnTable fields;
  std::vector<std::vector<double>> axes(3);
  for (int i = 0; i < 50; ++i) {
    axes[0].push_back(461234.5 + 0.001 * i);
    axes[1].push_back(5263456.25 - 0.002 * i);
    axes[2].push_back(i == 7 ? std::nan("") : 512.0);
  }
  for (std::size_t k = 0; k < 3; ++k) fields.add<double>(std::string(1, static_cast<char>('x' + k)), axes[k]);
  const PointCloud cloud = cloud_from_fields(fields).value();
  EXPECT_EQ(cloud.offset_m, (Eigen::Vector3d{461200.0, 5263500.0, 500.0}));
  for (std::size_t i = 0; i < 50; ++i) {
    if (i == 7) continue;
    const Eigen::Vector3d p{axes[0][i], axes[1][i], axes[2][i]};
    EXPECT_LT((cloud.positions_m[i].cast<double>() + cloud.offset_m - p).norm(), 5e-6) << i;
  }
  EXPECT_FALSE(cloud.positions_m[7].allFinite());
}

TEST(FarClouds, TheMedianDecides) {
  const auto offset_of = [](const std::vector<float>& x) {
    ColumnTable fields;
    for (const char* name : {"x", "y", "z"}) fields.add<float>(name, x);
    return cloud_from_fields(fields)->offset_m;
  };
  EXPECT_EQ(offset_of({0.0F, 999.0F}), Eigen::Vector3d::Zero());
  EXPECT_EQ(offset_of({-5000.0F, 0.0F, 4000.0F}), Eigen::Vector3d::Zero()) << "an offset would not help";
  EXPECT_EQ(offset_of({5060.0F, 5100.0F, 5140.0F}), Eigen::Vector3d::Constant(5100.0));
  EXPECT_EQ(offset_of({0.0F, 5060.0F, 5100.0F, 5140.0F, 9e9F}), Eigen::Vector3d::Constant(5100.0)) << "stray points";
  EXPECT_EQ(offset_of({3e30F, 3e30F}), Eigen::Vector3d::Zero()) << "damage, which an offset would hide";
  EXPECT_EQ(offset_of({}), Eigen::Vector3d::Zero());
  EXPECT_EQ(offset_of({std::nanf("")}), Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace saccade
