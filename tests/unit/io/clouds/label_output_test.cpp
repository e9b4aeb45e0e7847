// SPDX-License-Identifier: Apache-2.0
// Labels of points into files of every format, with the cloud untouched, and back.
#include "saccade/io/clouds/label_io.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "saccade/io/files/file_io.hpp"
#include "saccade/io/files/json_io.hpp"
#include "support/places.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;

const std::vector<std::uint32_t> kNumbers{0, 7, 4294967295U, 1};
const std::vector<std::uint32_t> kSmallNumbers{0, 7, 65535, 7};

/// Four points, organised, with a label and other fields.
PcdFile made_pcd() {
  PcdFile file;
  file.width = 2;
  file.height = 2;
  file.viewpoint = {0.5, -1.0, 2.0, 0.0, 1.0, 0.0, 0.0};
  file.table.add<float>("x", std::vector<float>{0.1F, std::nanf(""), -3.0F, 1e-30F});
  file.table.add<float>("y", std::vector<float>{1.0F, std::nanf(""), 2.0F, 3.0F});
  file.table.add<double>("z", std::vector<double>{0.1, std::nan(""), 4512345.678, 3.0});
  file.table.add<std::uint8_t>("label", std::vector<std::uint8_t>{20, 0, 30, 1});
  file.table.add<std::uint16_t>("quality", std::vector<std::uint16_t>{7, 8, 65535, 0});
  return file;
}

/// Every column as it was but for its name, and label as the last.
void expect_untouched(const ColumnTable& written, const ColumnTable& before, const std::vector<std::uint32_t>& labels) {
  ASSERT_EQ(written.columns.size(), before.columns.size() + 1);
  for (std::size_t i = 0; i < before.columns.size(); ++i) {
    const Column& column = before.columns[i];
    EXPECT_EQ(written.columns[i].name, column.name == "label" ? "label_input" : column.name);
    EXPECT_EQ(written.columns[i].type, column.type) << column.name;
    EXPECT_EQ(written.columns[i].bytes, column.bytes) << column.name;
  }
  EXPECT_EQ(written.columns.back().name, "label");
  EXPECT_EQ(written.columns.back().values<std::uint32_t>(), labels);
}

class LabelsInPcd : public ::testing::TestWithParam<PcdFormat> {};

TEST_P(LabelsInPcd, KeepEncodingAndEveryBit) {
  const test::TempFolder folder;
  ASSERT_TRUE(write_pcd(folder / "in.pcd", made_pcd(), GetParam()));
  const CloudFile cloud = read_cloud(folder / "in.pcd").value();
  const ColumnTable before = cloud.fields();
  ASSERT_TRUE(write_labels(folder / "out.pcd", cloud, kNumbers));
  const PcdFile written = read_pcd(folder / "out.pcd").value();
  expect_untouched(written.table, before, kNumbers);
  EXPECT_EQ(written.format, GetParam());
  EXPECT_EQ(written.width, 2U);
  EXPECT_EQ(written.height, 2U);
  EXPECT_EQ(written.viewpoint, made_pcd().viewpoint);
  EXPECT_EQ(read_labels(folder / "out.pcd", 4).value(), kNumbers);
  EXPECT_EQ(read_labels(folder / "in.pcd", 4).value(), (std::vector<std::uint32_t>{20, 0, 30, 1}));
}

INSTANTIATE_TEST_SUITE_P(All, LabelsInPcd,
                         ::testing::Values(PcdFormat::ascii, PcdFormat::binary, PcdFormat::binary_compressed));

class LabelsInPly : public ::testing::TestWithParam<PlyFormat> {};

TEST_P(LabelsInPly, KeepListsCommentsAndOrder) {
  const test::TempFolder folder;
  const std::string text =
      "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 2\nproperty float x\n"
      "property list uchar float feature\nproperty float y\nproperty double z\nproperty uchar label\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "1 2 0.5 0.25 2 3 4\n5 0 6 7 8\n3 0 1 0\n";
  const PlyFile ascii = read_ply(folder.write("ascii.ply", text)).value();
  ASSERT_TRUE(write_ply(folder / "in.ply", ascii, GetParam()));
  const CloudFile cloud = read_cloud(folder / "in.ply").value();
  const std::vector<std::uint32_t> labels{9, 4294967295U};
  ASSERT_TRUE(write_labels(folder / "out.ply", cloud, labels));
  const PlyFile written = read_ply(folder / "out.ply").value();
  EXPECT_EQ(written.format, GetParam());
  EXPECT_EQ(written.comments, ascii.comments);
  const PlyElement& vertices = *written.find("vertex");
  expect_untouched(vertices.table, ascii.find("vertex")->table, labels);
  EXPECT_EQ(vertices.order, (std::vector<int>{0, -1, 1, 2, 3, 4}));
  EXPECT_EQ(vertices.lists[0].values, ascii.find("vertex")->lists[0].values);
  EXPECT_EQ(written.find("face")->lists[0].values, ascii.find("face")->lists[0].values);
  EXPECT_EQ(read_labels(folder / "out.ply", 2).value(), labels);
  EXPECT_EQ(write_labels(folder / "out.pcd", cloud, labels).error().code, Errc::unsupported);
  EXPECT_EQ(write_labels(folder / "out.xyz", cloud, labels).error().code, Errc::unsupported);
  EXPECT_FALSE(fs::exists(folder / "out.pcd") || fs::exists(folder / "out.xyz"));
}

INSTANTIATE_TEST_SUITE_P(All, LabelsInPly,
                         ::testing::Values(PlyFormat::ascii, PlyFormat::binary_little_endian,
                                           PlyFormat::binary_big_endian));

TEST(Labels, OfEveryCloudGoIntoEveryFormatAndBack) {
  const test::TempFolder folder;
  const std::vector<float> scan{0.1F, 0.2F, 0.3F, 0.4F, 1.0F, 2.0F, 3.0F, 0.0F,
                                0.5F, 0.6F, 0.7F, 1.0F, 4.0F, 5.0F, 6.0F, 0.5F};
  folder.write("scan.bin", as_text(std::as_bytes(std::span{scan})));
  folder.write("cloud.csv", "X,Y,Z\n0.1,2,3\n4,5,6\n7,8,9\n1,1,1\n");
  ASSERT_TRUE(write_pcd(folder / "cloud.pcd", made_pcd()));
  ASSERT_TRUE(write_ply(folder / "cloud.ply", made_pcd().table));
  std::size_t pairs = 0;
  for (const char* from : {"scan.bin", "cloud.csv", "cloud.pcd", "cloud.ply"}) {
    const CloudFile cloud = read_cloud(folder / from).value();
    for (const char* to : {"out.pcd", "out.ply", "out.xyz", "out.txt", "out.csv", "out.npy", "out.label"}) {
      const std::vector<std::uint32_t>& labels = std::string_view{to} == "out.label" ? kSmallNumbers : kNumbers;
      const Status written = write_labels(folder / to, cloud, labels);
      ASSERT_TRUE(written) << from << " " << to << " " << written.error().to_string();
      EXPECT_EQ(read_labels(folder / to, 4).value(), labels) << from << " " << to;
      EXPECT_EQ(read_labels(folder / to, 5).error().code, Errc::size_mismatch) << to;
      ++pairs;
      if (std::string_view{to} == "out.npy" || std::string_view{to} == "out.label") continue;
      const CloudFile again = read_cloud(folder / to).value();
      for (const Column& column : cloud.fields().columns) {
        const Column* kept = again.fields().find(column.name == "label" ? "label_input" : column.name);
        ASSERT_NE(kept, nullptr) << from << " " << to << " " << column.name;
        for (std::size_t i = 0; i < 4; ++i) {
          const double value = column.value(i);
          EXPECT_TRUE(kept->value(i) == value || (std::isnan(value) && std::isnan(kept->value(i))))
              << from << " " << to << " " << column.name << " " << i;
        }
      }
    }
  }
  EXPECT_EQ(pairs, 28U);
}

TEST(Labels, OfSemanticKittiAreClassAndInstance) {
  const test::TempFolder folder;
  const CloudFile cloud{made_pcd()};
  const std::vector<NamedLabel> names{{7, "left car", "car", 2, {}, 1},
                                      {3, "right car", "car", 1, {}, 1},
                                      {70000, "road", "40", 0, {}, 1},
                                      {5, "cup", "", 0, {}, 1}};
  const std::vector<std::uint32_t> labels{7, 3, 70000, 5};
  ASSERT_TRUE(write_labels(folder / "a.label", cloud, labels, names));
  EXPECT_EQ(read_labels(folder / "a.label", 4).value(), (std::vector<std::uint32_t>{3 + 2 * 65536, 3 + 65536, 40, 5}));
  const std::vector<NamedLabel> many{{7, "", "", 65536, {}, 0}};
  const Status large = write_labels(folder / "b.label", cloud, kSmallNumbers, many);
  ASSERT_FALSE(large);
  EXPECT_NE(large.error().to_string().find("label 7"), std::string::npos) << large.error().to_string();
  EXPECT_EQ(write_labels(folder / "b.label", cloud, kSmallNumbers, many).error().code, Errc::invalid_argument);
  EXPECT_FALSE(fs::exists(folder / "b.label"));
  // Numbers that were read without names come back, with their instances.
  ASSERT_TRUE(write_labels(folder / "c.label", cloud, kNumbers));
  EXPECT_EQ(read_labels(folder / "c.label", 4).value(), (std::vector<std::uint32_t>{kNumbers.begin(), kNumbers.end()}));
}

TEST(Labels, OfAPtsWithItsCountComeBack) {
  const test::TempFolder folder;
  const fs::path file = folder.write("a.txt", "# x y z i label\n2\n0 0 0 5 7\n1 0 0 5 0\n");
  EXPECT_EQ(read_labels(file, 2).value(), (std::vector<std::uint32_t>{7, 0}));
}

TEST(Labels, ThatCannotBeWrittenAreErrors) {
  const test::TempFolder folder;
  const CloudFile cloud{made_pcd()};
  EXPECT_EQ(write_labels(folder / "a.npy", cloud, std::vector<std::uint32_t>{1}).error().code, Errc::size_mismatch);
  EXPECT_EQ(write_labels(folder / "a.obj", cloud, kNumbers).error().code, Errc::invalid_argument);
  for (const char* name : {"a.pcd", "a.ply", "a.xyz", "a.npy", "a.label"}) {
    EXPECT_EQ(write_labels(folder.path() / "missing" / name, cloud, kSmallNumbers).error().code, Errc::io_failure);
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(Labels, ThatCannotBeReadAreErrorsThatSayWhere) {
  const test::TempFolder folder;
  const std::vector<std::tuple<std::string, std::string, std::string>> cases{
      {"a.txt", "1\n2\n-3\n", "label -3 is negative"},
      {"b.txt", "1\n2\n-3\n", "point 2"},
      {"c.txt", "1\ntwo\n", "line 2: 'two'"},
      {"d.txt", "1\n2.5\n", "line 2"},
      {"e.txt", "1\n2 3\n", "line 2: one label"},
      {"f.txt", "4294967296\n", "below 2^32"},
      {"g.csv", "x,y,z\n1,2,3\n", "no field label"},
      {"h.csv", "x,y,z,label\n1,2,3,-7\n", "label -7 is negative"},
      {"i.label", "12345", "4 bytes"},
      {"j.npy", "12345", "NumPy"},
      {"k.pcd", "VERSION 0.7\nFIELDS x label\nSIZE 4 4\nTYPE F I\nWIDTH 2\nDATA ascii\n1 5\n2 -5\n", "point 1"},
      {"l.pcd", "VERSION 0.7\nFIELDS x label\nSIZE 4 4\nTYPE F F\nWIDTH 1\nDATA ascii\n1 nan\n", "not an integer"},
      {"m.pcd", "VERSION 0.7\nFIELDS x label\nSIZE 4 4\nTYPE F F\nCOUNT 1 2\nWIDTH 1\nDATA ascii\n1 1 1\n",
       "no field label"},
  };
  for (const auto& [name, content, message] : cases) {
    const auto labels = read_labels(folder.write(name, content), 3);
    ASSERT_FALSE(labels) << name;
    EXPECT_NE(labels.error().to_string().find(message), std::string::npos) << labels.error().to_string();
    EXPECT_NE(labels.error().to_string().find(name), std::string::npos) << labels.error().to_string();
  }
  EXPECT_EQ(read_labels(folder / "missing.npy", 3).error().code, Errc::not_found);
}

TEST(Labels, MayStandOnePerLine) {
  const test::TempFolder folder;
  for (const char* content :
       {"1\n0\n3\n", "# made here\nlabel\n1\n\n0\n3", "1.0\r\n0.0\r\n3.000000000000000000e+00\r\n"}) {
    EXPECT_EQ(read_labels(folder.write("a.txt", content), 3).value(), (std::vector<std::uint32_t>{1, 0, 3})) << content;
  }
}

TEST(Labels, AreExplainedInTextAndJson) {
  const test::TempFolder folder;
  const std::vector<NamedLabel> names{{1, "cup of \"tea\"", "cup", 3, {255, 0, 10}, 120}, {70000, "", "", 0, {}, 0}};
  ASSERT_TRUE(write_label_names_text(folder / "names.txt", names));
  EXPECT_EQ(read_text_file(folder / "names.txt").value(), "1 cup of \"tea\"\n70000 \n");
  ASSERT_TRUE(write_label_names_json(folder / "names.json", names));
  const nlohmann::json json = read_json(folder / "names.json").value();
  EXPECT_EQ(json["schema"], "saccade-labels-1");
  EXPECT_EQ(json["labels"][0], nlohmann::json({{"number", 1},
                                               {"name", "cup of \"tea\""},
                                               {"class", "cup"},
                                               {"instance", 3},
                                               {"color", "#ff000a"},
                                               {"points", 120}}));
  EXPECT_EQ(json["labels"].size(), 2U);
  const std::vector<NamedLabel> broken{{1, "two\nlines", "", 0, {}, 0}};
  EXPECT_EQ(write_label_names_text(folder / "broken.txt", broken).error().code, Errc::invalid_argument);
}

TEST(Labels, LeaveRealCloudsUntouched) {
  const fs::path data = test::shared_data();
  const std::vector<fs::path> paths{data / "clouds/example.pcd", data / "mosd_labelled/learn/learn0.pcd"};
  for (const fs::path& path : paths) {
    if (!fs::exists(path)) GTEST_SKIP() << "no " << path;
    const PcdFile before = read_pcd(path).value();
    std::vector<std::uint32_t> labels(before.table.rows);
    for (std::size_t i = 0; i < labels.size(); ++i) labels[i] = static_cast<std::uint32_t>(i % 13);
    const test::TempFolder folder;
    ASSERT_TRUE(write_labels(folder / "out.pcd", read_cloud(path).value(), labels));
    const PcdFile written = read_pcd(folder / "out.pcd").value();
    expect_untouched(written.table, before.table, labels);
    EXPECT_EQ(written.format, before.format);
    EXPECT_EQ(written.width, before.width);
    EXPECT_EQ(written.height, before.height);
    ASSERT_TRUE(write_labels(folder / "out.csv", read_cloud(path).value(), labels));
    EXPECT_EQ(read_labels(folder / "out.csv", labels.size()).value(), labels);
  }
}

}  // namespace
}  // namespace saccade
