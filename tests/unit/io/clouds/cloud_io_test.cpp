// SPDX-License-Identifier: Apache-2.0
// Clouds in PCD and PLY: what is read of them, and that nothing is lost where labels are added.
#include "saccade/io/clouds/cloud_io.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "saccade/io/files/file_io.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

const std::vector<std::uint32_t> kLabels{0, kUnlabelled, 1};

/// Three points with all that a file may hold besides.
ColumnTable made_fields() {
  const float quiet = std::bit_cast<float>(0x7FC12345U);  // a NaN of its own
  ColumnTable fields;
  fields.add<float>("x", std::vector<float>{1.0F, quiet, -3.0F});
  fields.add<float>("y", std::vector<float>{0.5F, quiet, 0.25F});
  fields.add<double>("z", std::vector<double>{1.5, std::nan(""), 2.5});
  fields.add<float>("rgb", std::vector<float>{std::bit_cast<float>(0xFF0080U), 0.0F, std::bit_cast<float>(0x00FF00U)});
  fields.add<float>("normal_x", std::vector<float>{0.0F, 0.0F, 1.0F});
  fields.add<float>("normal_y", std::vector<float>{0.0F, 0.0F, 0.0F});
  fields.add<float>("normal_z", std::vector<float>{1.0F, quiet, 0.0F});
  fields.add<std::uint16_t>("intensity", std::vector<std::uint16_t>{7, 8, 65535});
  fields.add<std::int8_t>("_", std::vector<std::int8_t>{1, 2, 3, 4, 5, 6}, 2);
  return fields;
}

TEST(CloudFields, BecomePositionsNormalsAndColors) {
  const PointCloud cloud = cloud_from_fields(made_fields()).value();
  ASSERT_EQ(cloud.positions_m.size(), 3U);
  EXPECT_EQ(cloud.positions_m[0], (Eigen::Vector3f{1.0F, 0.5F, 1.5F}));
  EXPECT_FALSE(cloud.positions_m[1].allFinite());
  EXPECT_EQ(cloud.normals[2], Eigen::Vector3f::UnitX());
  EXPECT_TRUE(cloud.colors[0].isApprox(Eigen::Vector3f{1.0F, 0.0F, 128.0F / 255.0F}));
  EXPECT_TRUE(cloud.validate());
  ColumnTable ply;
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) ply.add<double>(name, std::vector<double>{0.5});
  for (const char* name : {"red", "green", "blue"}) ply.add<std::uint8_t>(name, std::vector<std::uint8_t>{51});
  const PointCloud other = cloud_from_fields(ply).value();
  EXPECT_EQ(other.normals[0], Eigen::Vector3f::Constant(0.5F));
  EXPECT_TRUE(other.colors[0].isApprox(Eigen::Vector3f::Constant(0.2F)));
  ColumnTable flat;
  flat.add<float>("x", std::vector<float>{1.0F});
  EXPECT_EQ(cloud_from_fields(flat).error().code, Errc::corrupt_data);
}

TEST(CloudFields, LabelsAreWholeNumbers) {
  ColumnTable fields;
  fields.add<std::int32_t>("label", std::vector<std::int32_t>{5, 0, -1});
  EXPECT_EQ(labels_from_fields(fields).value(), (std::vector<std::uint32_t>{5, kUnlabelled, kUnlabelled}));
  fields.add<std::uint32_t>("kind", std::vector<std::uint32_t>{kUnlabelled, 1, 2});
  EXPECT_EQ(labels_from_fields(fields, "kind").value(), (std::vector<std::uint32_t>{kUnlabelled, 1, 2}));
  fields.add<float>("half", std::vector<float>{1.0F, 0.5F, 2.0F});
  EXPECT_EQ(labels_from_fields(fields, "half").error().code, Errc::corrupt_data);
  fields.add<double>("large", std::vector<double>{1.0, 1e10, 2.0});
  EXPECT_EQ(labels_from_fields(fields, "large").error().code, Errc::corrupt_data);
  fields.add<double>("none", std::vector<double>{1.0, std::nan(""), 2.0});
  EXPECT_EQ(labels_from_fields(fields, "none").error().code, Errc::corrupt_data);
  EXPECT_EQ(labels_from_fields(fields, "missing").error().code, Errc::not_found);
}

class CloudFormats : public ::testing::TestWithParam<PcdFormat> {};

TEST_P(CloudFormats, KeepEveryBitAndGainLabels) {
  const test::TempFolder folder;
  PcdFile organised{made_fields(), 3, 1, {1.0, 2.0, 3.0, 1.0, 0.0, 0.0, 0.0}};
  organised.height = 3;
  organised.width = 1;
  ASSERT_TRUE(write_pcd(folder / "in.pcd", organised, GetParam()));
  CloudFile cloud = read_cloud(folder / "in.pcd").value();
  const ColumnTable before = cloud.fields();
  EXPECT_EQ(add_labels(cloud, kLabels), "");
  ASSERT_TRUE(write_cloud(folder / "out.pcd", cloud));
  const PcdFile written = read_pcd(folder / "out.pcd").value();
  EXPECT_EQ(written.width, 1U);
  EXPECT_EQ(written.height, 3U);
  EXPECT_EQ(written.viewpoint, organised.viewpoint);
  ASSERT_EQ(written.table.columns.size(), before.columns.size() + 1);
  for (std::size_t i = 0; i < before.columns.size(); ++i) EXPECT_EQ(written.table.columns[i], before.columns[i]);
  EXPECT_EQ(written.table.find("label")->values<std::uint32_t>(), (std::vector<std::uint32_t>{1, 0, 2}));
}

INSTANTIATE_TEST_SUITE_P(All, CloudFormats,
                         ::testing::Values(PcdFormat::ascii, PcdFormat::binary, PcdFormat::binary_compressed));

TEST(CloudFiles, KeepAnEarlierLabelUnderAnotherName) {
  CloudFile cloud{PcdFile{made_fields(), 3, 1, {}}};
  cloud.fields().add<std::uint8_t>("label_input", std::vector<std::uint8_t>{9, 9, 9});
  cloud.fields().add<std::uint8_t>("label", std::vector<std::uint8_t>{20, 0, 30});
  EXPECT_EQ(add_labels(cloud, kLabels), "label_input2");
  EXPECT_EQ(cloud.fields().find("label_input2")->values<std::uint8_t>(), (std::vector<std::uint8_t>{20, 0, 30}));
  EXPECT_EQ(labels_from_fields(cloud.fields()).value(), (std::vector<std::uint32_t>{1, kUnlabelled, 2}));
  EXPECT_EQ(add_labels(cloud, kLabels), "label_input3");
}

TEST(CloudFiles, PlyKeepsItsFaces) {
  const test::TempFolder folder;
  TriangleMesh mesh;
  mesh.vertices = {{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}};
  mesh.colors.assign(3, Rgb8{10, 20, 30});
  mesh.triangles = {{0, 1, 2}};
  ASSERT_TRUE(write_mesh(folder / "in.ply", mesh, PlyFormat::ascii));
  CloudFile cloud = read_cloud(folder / "in.ply").value();
  add_labels(cloud, kLabels);
  ASSERT_TRUE(write_cloud(folder / "out.ply", cloud));
  ASSERT_TRUE(write_cloud(folder / "out.pcd", cloud));
  EXPECT_EQ(read_mesh(folder / "out.ply").value().triangles, mesh.triangles);
  for (const char* name : {"out.ply", "out.pcd"}) {
    const CloudFile written = read_cloud(folder / name).value();
    EXPECT_EQ(labels_from_fields(written.fields()).value(), (std::vector<std::uint32_t>{1, kUnlabelled, 2})) << name;
    EXPECT_EQ(written.fields().find("red")->values<std::uint8_t>(), (std::vector<std::uint8_t>{10, 10, 10})) << name;
  }
}

TEST(CloudFiles, ListsOfPointsAreNotDropped) {
  const test::TempFolder folder;
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
      "property list uchar float feature\nend_header\n1 2 3 2 0.5 0.25\n";
  const CloudFile cloud = read_cloud(folder.write("lists.ply", text)).value();
  EXPECT_TRUE(write_cloud(folder / "again.ply", cloud));
  const Status refused = write_cloud(folder / "again.pcd", cloud);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::unsupported);
  EXPECT_NE(refused.error().to_string().find("feature"), std::string::npos) << refused.error().to_string();
}

TEST(CloudFiles, OthersAreErrorsThatNameTheFile) {
  const test::TempFolder folder;
  for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
           {"text.pcd", "no cloud"},
           {"empty.pcd", ""},
           {"cut.pcd", "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\n"},
           {"faces.ply", "ply\nformat ascii 1.0\nelement face 0\nproperty int a\nend_header\n"},
           {"cut.ply", "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nend_header\n1\n"}}) {
    const auto read = read_cloud(folder.write(name, text));
    ASSERT_FALSE(read) << name;
    EXPECT_EQ(read.error().code, Errc::corrupt_data) << name;
    EXPECT_NE(read.error().to_string().find(name), std::string::npos) << read.error().to_string();
  }
  EXPECT_EQ(read_cloud(folder / "missing.pcd").error().code, Errc::not_found);
}

TEST(CloudFiles, AreToldBySuffixWhereTheirContentDoesNot) {
  const test::TempFolder folder;
  const std::vector<float> scan{0.1F, 0.2F, 0.3F, 0.4F, 1.0F, 2.0F, std::nanf(""), 0.0F};
  const std::string bytes{as_text(std::as_bytes(std::span{scan}))};
  const CloudFile kitti = read_cloud(folder.write("000000.bin", bytes)).value();
  EXPECT_EQ(kitti.fields().find("y")->values<float>(), (std::vector<float>{0.2F, 2.0F}));
  EXPECT_EQ(kitti.fields().find("intensity")->values<float>(), (std::vector<float>{0.4F, 0.0F}));
  EXPECT_EQ(cloud_from_fields(kitti.fields()).value().positions_m.size(), 2U);
  ASSERT_TRUE(write_cloud(folder / "again.pcd", kitti));
  EXPECT_EQ(read_pcd(folder / "again.pcd").value().table.find("x")->bytes, kitti.fields().find("x")->bytes);
  for (const std::string& wrong : {bytes.substr(1), bytes + "1234"}) {
    const auto read = read_cloud(folder.write("wrong.bin", wrong));
    ASSERT_FALSE(read) << wrong.size();
    EXPECT_EQ(read.error().code, Errc::corrupt_data);
    EXPECT_NE(read.error().to_string().find("wrong.bin: a scan of KITTI"), std::string::npos)
        << read.error().to_string();
  }
  EXPECT_EQ(read_cloud(folder.write("A.XYZ", "# no PCD\n1 2 3\n")).value().fields().rows, 1U);
  EXPECT_EQ(read_cloud(folder.write("a.pts", "1\n1 2 3 4 5 6 7\n")).value().fields().columns.size(), 7U);
  ASSERT_TRUE(write_pcd(folder / "pcd.txt", made_fields()));
  EXPECT_TRUE(std::holds_alternative<PcdFile>(read_cloud(folder / "pcd.txt").value().file));
  const auto broken = read_cloud(folder.write("broken.csv", "x,y,z\n1,2\n"));
  EXPECT_NE(broken.error().to_string().find("broken.csv, line 2"), std::string::npos) << broken.error().to_string();
}

TEST(CloudFiles, TextGainsLabelsAsAFieldToo) {
  const test::TempFolder folder;
  CloudFile cloud = read_cloud(folder.write("a.csv", "x,y,z,label\n1,2,3,4\n5,6,7,8\n9,10,11,12\n")).value();
  EXPECT_EQ(add_labels(cloud, kLabels), "label_input");
  for (const char* name : {"out.ply", "out.pcd", "out.csv"}) {
    ASSERT_TRUE(write_cloud(folder / name, cloud));
    const CloudFile written = read_cloud(folder / name).value();
    EXPECT_EQ(labels_from_fields(written.fields()).value(), (std::vector<std::uint32_t>{1, kUnlabelled, 2})) << name;
    EXPECT_EQ(written.fields().find("label_input")->value(2), 12.0) << name;
  }
}

TEST(CloudFolders, AreListedInOrder) {
  const test::TempFolder folder;
  EXPECT_EQ(list_clouds(folder.path()).error().code, Errc::not_found);
  EXPECT_EQ(list_clouds(folder / "missing").error().code, Errc::not_found);
  for (const char* name :
       {"b.pcd", "a.ply", "d.bin", "c.XYZ", "e.pts", ".hidden.pcd", "z.npy", "no/f.pcd", "g.pcd.tmp"}) {
    folder.write(name, "anything");
  }
  folder.write("names.txt", "1 cup\n2 table\n");
  folder.write("README.txt", "Clouds of a table.\n");
  folder.write("values.csv", "frame,seconds\n1,2\n");
  folder.write("h.txt", "1 2 3\nbroken\n");
  folder.write("i.csv", "X,Y,Z\n1,2,3\n");
  std::vector<std::string> names;
  const std::vector<std::filesystem::path> clouds = list_clouds(folder.path()).value();
  for (const auto& path : clouds) names.push_back(path.filename().string());
  EXPECT_EQ(names, (std::vector<std::string>{"a.ply", "b.pcd", "c.XYZ", "d.bin", "e.pts", "h.txt", "i.csv"}));
  EXPECT_EQ(list_clouds(folder / "a.ply").error().code, Errc::io_failure);
}

}  // namespace
}  // namespace saccade
