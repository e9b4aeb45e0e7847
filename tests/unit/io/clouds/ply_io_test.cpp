// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/clouds/ply_io.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "saccade/io/files/file_io.hpp"
#include "support/places.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;
using test::TempFolder;

Result<PlyFile> parse(std::string_view text) { return parse_ply(as_byte_span(text)); }

/// One element with every type, and lists of different lengths.
PlyFile every_type() {
  PlyElement element;
  element.name = "thing";
  element.table.add<std::int8_t>("i8", std::vector<std::int8_t>{-128, 0, 127});
  element.table.add<std::uint8_t>("u8", std::vector<std::uint8_t>{0, 7, 255});
  element.table.add<std::int16_t>("i16", std::vector<std::int16_t>{-32768, 1, 32767});
  element.table.add<std::uint16_t>("u16", std::vector<std::uint16_t>{0, 1, 65535});
  element.table.add<std::int32_t>("i32", std::vector<std::int32_t>{std::numeric_limits<std::int32_t>::min(), 0, 5});
  element.table.add<std::uint32_t>("u32", std::vector<std::uint32_t>{0, 5, 0xFFFFFFFFU});
  element.table.add<float>("f32", std::vector<float>{0.1F, -1e-30F, 3e38F});
  element.table.add<double>("f64", std::vector<double>{0.1, -1e-300, 1e300});
  PlyList list{"many", ColumnType::u16, {"many", ColumnType::f32, 1, {}}, {0, 0, 2, 3}};
  const std::vector<float> values{1.5F, 2.5F, -0.1F};
  const auto bytes = std::as_bytes(std::span{values});
  list.values.bytes.assign(bytes.begin(), bytes.end());
  element.lists.push_back(list);
  element.order = {0, 1, -1, 2, 3, 4, 5, 6, 7};
  return {{"a comment", ""}, {element}};
}

class PlyFormats : public testing::TestWithParam<PlyFormat> {};

TEST_P(PlyFormats, KeepEverything) {
  const TempFolder folder;
  const PlyFile written = every_type();
  const Status status = write_ply(folder / "x.ply", written, GetParam());
  ASSERT_TRUE(status) << status.error().to_string();
  const auto read = read_ply(folder / "x.ply");
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->comments, written.comments);
  ASSERT_EQ(read->elements.size(), 1U);
  const PlyElement& element = read->elements[0];
  EXPECT_EQ(element.order, written.elements[0].order);
  EXPECT_EQ(element.table, written.elements[0].table);
  ASSERT_EQ(element.lists.size(), 1U);
  EXPECT_EQ(element.lists[0].starts, written.elements[0].lists[0].starts);
  EXPECT_EQ(element.lists[0].values, written.elements[0].lists[0].values);
}

TEST_P(PlyFormats, EveryCutIsAnError) {
  const TempFolder folder;
  ASSERT_TRUE(write_ply(folder / "x.ply", every_type(), GetParam()));
  const auto bytes = read_file(folder / "x.ply");
  ASSERT_TRUE(bytes);
  // An ascii file may lose its last line end, and a cut number can be another number.
  const std::size_t last = bytes->size() - (GetParam() == PlyFormat::ascii ? 7 : 0);
  for (std::size_t size = 0; size < last; ++size) {
    const auto read = parse_ply(std::span{*bytes}.first(size));
    ASSERT_FALSE(read) << size << " of " << bytes->size();
    EXPECT_FALSE(read.error().context.empty());
  }
}

TEST_P(PlyFormats, MeshComesBack) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1.5F}};
  mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {1, 0, 0}};
  mesh.colors = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {9, 8, 7}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}};
  const TempFolder folder;
  ASSERT_TRUE(write_mesh(folder / "m.ply", mesh, GetParam()));
  const auto read = read_mesh(folder / "m.ply");
  ASSERT_TRUE(read) << read.error().to_string();
  EXPECT_EQ(read->vertices, mesh.vertices);
  EXPECT_EQ(read->normals, mesh.normals);
  EXPECT_EQ(read->colors, mesh.colors);
  EXPECT_EQ(read->triangles, mesh.triangles);
}

INSTANTIATE_TEST_SUITE_P(All, PlyFormats,
                         testing::Values(PlyFormat::ascii, PlyFormat::binary_little_endian,
                                         PlyFormat::binary_big_endian));

TEST(Ply, MeshHeaderIsTheOneThatViewersRead) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.colors.resize(3);
  mesh.triangles = {{0, 1, 2}};
  const TempFolder folder;
  ASSERT_TRUE(write_mesh(folder / "m.ply", mesh));
  const auto text = read_text_file(folder / "m.ply");
  ASSERT_TRUE(text);
  const std::string header =
      "ply\nformat binary_little_endian 1.0\ncomment made by Saccade; metres\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  EXPECT_EQ(text->substr(0, header.size()), header);
  EXPECT_EQ(text->size(), header.size() + 3 * (3 * 4 + 3) + 1 + 3 * 4);
}

TEST(Ply, WrongMeshesAreRefused) {
  const TempFolder folder;
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}};
  mesh.triangles = {{0, 0, 1}};
  EXPECT_EQ(write_mesh(folder / "m.ply", mesh).error().code, Errc::invalid_argument);
  mesh.triangles.clear();
  mesh.normals.resize(2);
  EXPECT_EQ(write_mesh(folder / "m.ply", mesh).error().code, Errc::invalid_argument);
  EXPECT_FALSE(fs::exists(folder / "m.ply"));
  ColumnTable table;
  table.add<std::int64_t>("big", std::vector<std::int64_t>{1});
  EXPECT_EQ(write_ply(folder / "m.ply", table).error().code, Errc::unsupported);
}

TEST(Ply, QuadsBecomeFans) {
  const auto file = parse(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
  ASSERT_TRUE(file) << file.error().to_string();
  const auto mesh = mesh_from_ply(*file);
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Ply, HostileFilesAreErrorsThatSayWhere) {
  const std::string head = "ply\nformat ascii 1.0\n";
  const std::string binary = "ply\nformat binary_little_endian 1.0\n";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "line 1"},
      {"plyx\n", "line 1"},
      {"ply\nend_header\n", "format"},
      {"ply\nformat ascii 2.0\nend_header\n", "2.0"},
      {head + "element vertex -1\nend_header\n", "line 3"},
      {head + "element vertex 99999999999999999999999\nend_header\n", "line 3"},
      {head + "property float x\nend_header\n", "before any element"},
      {head + "element v 1\nproperty quad x\nend_header\n", "unknown type"},
      {head + "element v 1\nproperty list float int x\nend_header\n", "fractional"},
      {head + "element v 5\nend_header\n", "no properties"},
      {head + "element v 1\nproperty uchar x\nend_header\n256\n", "line 6"},
      {head + "element v 1\nproperty uchar x\nend_header\n1.5\n", "line 6"},
      {head + "element v 2\nproperty float x\nend_header\n1\nx\n", "line 7"},
      {head + "element v 1\nproperty list int int x\nend_header\n-1\n", "negative"},
      {head + "element v 18446744073709551615\nproperty float x\nend_header\n1 2 3\n", "ends before"},
      {binary + "element v 4000000000\nproperty float x\nend_header\n1234", "ends before"},
      {binary + "element v 1\nproperty list uint double x\nend_header\n\xFF\xFF\xFF\xFF", "missing"},
      {head + "surprise\nend_header\n", "surprise"},
      {head + "element v 1\nproperty float x\n", "does not end"},
  };
  for (const auto& [text, message] : cases) {
    const auto read = parse(text);
    ASSERT_FALSE(read) << text;
    EXPECT_NE(read.error().to_string().find(message), std::string::npos) << text << "\n" << read.error().to_string();
  }
}

TEST(Ply, NanAndWindowsLineEndsAreRead) {
  const auto file =
      parse("ply\r\nformat ascii 1.0\r\nelement v 2\r\nproperty float x\r\nend_header\r\nnan\r\n-inf\r\n");
  ASSERT_TRUE(file) << file.error().to_string();
  EXPECT_TRUE(std::isnan(file->elements[0].table.columns[0].value(0)));
  EXPECT_EQ(file->elements[0].table.columns[0].value(1), -std::numeric_limits<double>::infinity());
}

TEST(Ply, RealMeshesAreRead) {
  const fs::path folder = test::shared_data() / "meshes_ycb";
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder;
  int meshes = 0;
  for (const auto& entry : fs::directory_iterator{folder}) {
    if (entry.path().extension() != ".ply") continue;
    const auto mesh = read_mesh(entry.path());
    ASSERT_TRUE(mesh) << mesh.error().to_string();
    ++meshes;
    EXPECT_GT(mesh->vertices.size(), 8000U);
    EXPECT_EQ(mesh->colors.size(), mesh->vertices.size());
    EXPECT_EQ(mesh->triangles.size(), 16384U) << entry.path();
  }
  EXPECT_EQ(meshes, 4);
}

}  // namespace
}  // namespace saccade
