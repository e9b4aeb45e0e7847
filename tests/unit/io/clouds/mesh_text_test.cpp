// SPDX-License-Identifier: Apache-2.0
// Our own readers of STL, OBJ and OFF, and faces of many corners.
#include "saccade/io/clouds/internal/mesh_text.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

#include "saccade/io/clouds/any_mesh.hpp"
#include "saccade/io/clouds/internal/split_polygon.hpp"
#include "support/temp_folder.hpp"
#include "unit/io/clouds/mesh_files.hpp"

namespace saccade {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Parse = Result<TriangleMesh> (*)(std::string_view);

/// Corners of all triangles in order, whatever their indices.
std::vector<Eigen::Vector3f> corners_of(const TriangleMesh& mesh) {
  std::vector<Eigen::Vector3f> corners;
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) corners.push_back(mesh.vertices[corner]);
  }
  return corners;
}

double area_of(const TriangleMesh& mesh) {
  double area{0.0};
  for (const auto& [a, b, c] : mesh.triangles) {
    area += 0.5 * (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm();
  }
  return area;
}

TEST(MeshText, TheSameShapeComesFromEveryFormat) {
  const TriangleMesh ball = test::made_ball(12);
  const std::vector<Eigen::Vector3f> expected = corners_of(ball);
  const std::vector<std::pair<Parse, std::string>> files{{parse_stl, test::stl_text(ball)},
                                                         {parse_stl, test::stl_binary(ball, "solid ball")},
                                                         {parse_obj, test::obj_text(ball)},
                                                         {parse_off, test::off_text(ball)}};
  for (const auto& [parse, file] : files) {
    const auto mesh = parse(file);
    ASSERT_TRUE(mesh) << mesh.error().to_string();
    EXPECT_EQ(corners_of(*mesh), expected) << file.substr(0, 20);
    EXPECT_EQ(mesh->vertices.size(), ball.vertices.size()) << file.substr(0, 20);
  }
}

TEST(MeshText, FilesAreToldByTheirSuffix) {
  const test::TempFolder folder;
  const TriangleMesh ball = test::made_ball(6);
  for (const auto& [name, file] : {std::pair{"a.STL", test::stl_text(ball)}, std::pair{"a.obj", test::obj_text(ball)},
                                   std::pair{"a.Off", test::off_text(ball)}}) {
    const auto mesh = read_any_mesh(folder.write(name, file));
    ASSERT_TRUE(mesh) << mesh.error().to_string();
    EXPECT_EQ(corners_of(*mesh), corners_of(ball)) << name;
  }
}

TEST(MeshText, VerticesOfNoTriangleAreLeftOut) {
  const test::TempFolder folder;
  const auto mesh = read_any_mesh(folder.write(
      "a.obj", "v 9 9 9 1 1 1\nv 0 0 0 1 0 0\nv 8 8 8 1 1 1\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nl 1 3\nf 2 4 5\n"));
  ASSERT_TRUE(mesh) << mesh.error().to_string();
  EXPECT_EQ(mesh->vertices, (std::vector<Eigen::Vector3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh->colors, (std::vector<Rgb8>{{255, 0, 0}, {0, 255, 0}, {0, 0, 255}}));
  EXPECT_EQ(mesh->triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(MeshText, WhatProgramsWriteIsRead) {
  struct Case {
    const char* what;
    Parse parse;
    std::string file;
    std::size_t vertices;
    std::size_t triangles;
  };
  const std::string facet{
      "FACET NORMAL 0 0 1\n OUTER LOOP\n VERTEX 0 0 0\n vertex 1 0 0\r\n vertex 0 1e0 -0\n end loop\nendfacet\n"};
  const std::string points{"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"};
  for (const Case& c : {
           Case{"capitals, two solids", parse_stl,
                "solid a b\n" + facet + "endsolid a b\n\nSOLID\n" + facet + "ENDSOLID\n", 3, 2},
           Case{"indices from the end", parse_obj, points + "f -4 -3 -2\nf -4 -2 -1\n", 4, 2},
           Case{"textures and normals", parse_obj,
                points + "vt 0 0\nvn 0 0 1\nf 1/1 2/1 3/1\nf 1//1 3//1 4//1\nf 1/1/1 2/1/1 4/1/1\n", 4, 3},
           Case{"lines that go on", parse_obj, points + "f 1 \\\n2 3\\\n 4\n", 4, 2},
           Case{"groups, materials, lines", parse_obj,
                "mtllib a.mtl\no a\n" + points + "usemtl b\ns off\ng c\nl 1 2\np 3\nf 1 2 3 4 # quad\n", 4, 2},
           Case{"weights", parse_obj, "v 0 0 0 1\nv 1 0 0 1.0\nv 0 1 0 1\nf 1 2 3", 3, 1},
           Case{"comments in an OFF", parse_off,
                "# by hand\nOFF # header\n\n3 1 0\n0 0 0 # a\n1 0 0\n0 1 0\n3 0 1 2 1.0 0 0\n\n", 3, 1},
           Case{"ModelNet", parse_off, "OFF3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", 3, 1},
           Case{"no header", parse_off, "3 1\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", 3, 1},
           Case{"colours and normals", parse_off,
                "CNOFF\n3 1 3\n0 0 0 0 0 1 255 0 0 255\n1 0 0 0 0 1 255 0 0 255\n0 1 0 0 0 1 255 0 0 255\n3 0 1 2\n", 3,
                1},
           Case{"edges among faces", parse_off, "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 0 1\n4 0 1 2 3\n", 4, 2},
       }) {
    const auto mesh = c.parse(c.file);
    ASSERT_TRUE(mesh) << c.what << ": " << mesh.error().to_string();
    EXPECT_EQ(mesh->vertices.size(), c.vertices) << c.what;
    EXPECT_EQ(mesh->triangles.size(), c.triangles) << c.what;
    EXPECT_TRUE(mesh->colors.empty()) << c.what;
  }
}

TEST(MeshText, ColoursOfObjAreKeptWhereEveryVertexHasThem) {
  const std::string face{"f 1 2 3\n"};
  const auto colored = parse_obj("v 0 0 0 1 0.5 0\nv 1 0 0 2 0 -1\nv 0 1 0 0 0 1\n" + face);
  ASSERT_TRUE(colored);
  EXPECT_EQ(colored->colors, (std::vector<Rgb8>{{255, 128, 0}, {255, 0, 0}, {0, 0, 255}}));
  const auto partly = parse_obj("v 0 0 0 1 0.5 0\nv 1 0 0\nv 0 1 0 0 0 1\n" + face);
  ASSERT_TRUE(partly);
  EXPECT_TRUE(partly->colors.empty());
}

TEST(MeshText, WhatIsWrongIsNamedWithItsPlace) {
  const TriangleMesh ball = test::made_ball(6);
  const std::string binary = test::stl_binary(ball, "made");
  std::string endless = binary;
  endless.replace(84 + 12, 4, std::string{"\0\0\x80\x7F", 4});  // infinity
  const std::string points{"v 0 0 0\nv 1 0 0\nv 1 1 0\n"};
  struct Case {
    Parse parse;
    std::string file;
    const char* message;
  };
  for (const Case& c : {
           Case{parse_stl, "", "neither a text"},
           Case{parse_stl, std::string(100, '\xFF'), "states 4294967295 triangles, but the file ends after 0"},
           Case{parse_stl, binary.substr(0, binary.size() - 1), "but the file ends after"},
           Case{parse_stl, endless, "triangle 0 has a coordinate that is not finite"},
           Case{parse_stl, "solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n",
                "line 6: a loop of 2 vertices"},
           Case{parse_stl, "solid\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nvertex 1 1 1\n",
                "line 5: a loop of more than three"},
           Case{parse_stl, "solid\nfacet\nouter loop\nvertex 0 0 nan\n", "line 4: a vertex is three finite numbers"},
           Case{parse_stl, "solid a\n", "line 1: the file ends before \"endsolid\""},
           Case{parse_stl, "solid a\nsolid b\n", "line 2: \"solid\" within a solid"},
           Case{parse_stl, "solid a\nendsolid a\n", "no triangles"},
           Case{parse_stl, "solid a\nhello\n", "line 2: 'hello' is no word of an STL"},
           Case{parse_obj, points + "f 1 2 4\n", "line 4: the face names vertex 4, and 3 stand before it"},
           Case{parse_obj, points + "f 1 2 -4\n", "line 4: the face names vertex -4"},
           Case{parse_obj, points + "f 0 1 2\n", "line 4: the face names vertex 0"},
           Case{parse_obj, points + "f 1 2 three\n", "line 4: 'three' is no vertex"},
           Case{parse_obj, "v 0 0\n", "line 1: a vertex of fewer than three numbers"},
           Case{parse_obj, "v 0 0 0,5\n", "line 1: '0,5' is not a finite number"},
           Case{parse_obj, points, "no triangles"},
           Case{parse_obj, points + "cstype bezier\nsurf 0 1 0 1 1 2 3\n", "free-form"},
           Case{parse_off, "", "empty"},
           Case{parse_off, "OFF\n", "ends before the numbers of vertices and faces"},
           Case{parse_off, "OFF BINARY\n", "binary OFF"},
           Case{parse_off, "4OFF\n1 1 1\n", "three dimensions"},
           Case{parse_off, "XOFF\n1 1 1\n", "line 1: no header of an OFF"},
           Case{parse_off, "OFF\n4294967295 4294967295 0\n0 0 0\n", "ends after 1 of 4294967295 vertices"},
           Case{parse_off, "OFF\n1 2 0\n0 0 0\n3 0 0 0\n", "ends after 1 of 2 faces"},
           Case{parse_off, "OFF\n1 1 0\n0 0 0\n3 0 0 1\n", "line 4: the face names vertex 1 of 1"},
           Case{parse_off, "OFF\n1 1 0\n0 0 0\n4294967295 0 0 0\n", "line 4: a face of 4294967295 corners names 3"},
           Case{parse_off, "OFF\n1 1 0\n0 0 0\n3 0 0 0\n3 0 0 0\n", "line 5: lines follow the last of 1 faces"},
       }) {
    const auto mesh = c.parse(c.file);
    ASSERT_FALSE(mesh) << c.message;
    EXPECT_NE(mesh.error().to_string().find(c.message), std::string::npos) << mesh.error().to_string();
  }
}

TEST(MeshText, AnyNumberOfRepeatedFacesTakesLinearTime) {
  std::string file{"v 0 0 0\nv 1 0 0\nv 0 1 0\n"};
  constexpr std::size_t kFaces{200'000};
  for (std::size_t i = 0; i < kFaces; ++i) file += "f 1 2 3\n";
  const auto mesh = parse_obj(file);
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->triangles.size(), kFaces);
}

/// Corners of a face in the plane, turned out of it.
std::vector<Eigen::Vector3f> turned(const std::vector<Eigen::Vector2f>& outline) {
  const Eigen::AngleAxisf turn{1.1F, Eigen::Vector3f{1, 2, -1}.normalized()};
  std::vector<Eigen::Vector3f> corners;
  for (const Eigen::Vector2f& p : outline)
    corners.push_back(turn * Eigen::Vector3f{p.x(), p.y(), 0} + Eigen::Vector3f{5, -3, 2});
  return corners;
}

std::vector<std::uint32_t> all_of(std::size_t n) {
  std::vector<std::uint32_t> corners(n);
  for (std::size_t i = 0; i < n; ++i) corners[i] = static_cast<std::uint32_t>(i);
  return corners;
}

/// Teeth of a comb: height 1 on every other corner, and a back of depth 1.
std::vector<Eigen::Vector2f> comb(std::size_t teeth) {
  std::vector<Eigen::Vector2f> outline{{0, -1}, {static_cast<float>(2 * teeth), -1}};
  for (std::size_t i = 2 * teeth + 1; i-- > 0;) outline.emplace_back(static_cast<float>(i), i % 2 == 0 ? 0.0F : 1.0F);
  return outline;
}

TEST(SplitPolygon, KeepsTheAreaAndTheSideOfFacesThatAreNotConvex) {
  struct Case {
    std::vector<Eigen::Vector2f> outline;
    double area;
  };
  for (Case c :
       {Case{{{0, 0}, {2, 0}, {2, 2}, {0, 2}}, 4.0}, Case{{{0, 0}, {2, 0}, {0.5F, 0.5F}, {0, 2}}, 1.0},  // an arrow
        Case{{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {0, 2}}, 4.0}, Case{comb(7), 14.0 + 7.0},
        Case{comb(400), 800.0 + 400.0}, Case{{{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 0.5F}, {0, 1}}, 1.5}}) {
    for (const bool clockwise : {false, true}) {
      if (clockwise) std::reverse(c.outline.begin(), c.outline.end());
      TriangleMesh mesh;
      mesh.vertices = turned(c.outline);
      ASSERT_TRUE(split_polygon(mesh.vertices, all_of(c.outline.size()), mesh.triangles));
      EXPECT_EQ(mesh.triangles.size(), c.outline.size() - 2);
      EXPECT_NEAR(area_of(mesh), c.area, 1e-4 * c.area) << c.outline.size();
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();  // equal sides add up, opposite ones cancel
      for (const auto& [a, b, d] : mesh.triangles) {
        sum += 0.5F * (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[d] - mesh.vertices[a]);
      }
      EXPECT_NEAR(sum.norm(), c.area, 1e-3 * c.area) << c.outline.size();
    }
  }
}

TEST(SplitPolygon, EndsOnFacesThatAreNone) {
  std::vector<Triangle> triangles;
  const std::vector<Eigen::Vector3f> star = turned({{0, 1}, {0.6F, -0.8F}, {-1, 0.3F}, {1, 0.3F}, {-0.6F, -0.8F}});
  EXPECT_TRUE(split_polygon(star, all_of(5), triangles));
  const std::vector<Eigen::Vector3f> bow = turned({{0, 0}, {1, 1}, {1, 0}, {0, 1}});
  EXPECT_TRUE(split_polygon(bow, all_of(4), triangles));
  const std::vector<Eigen::Vector3f> point(9, Eigen::Vector3f::Ones());
  EXPECT_TRUE(split_polygon(point, all_of(9), triangles));
  EXPECT_EQ(triangles.size(), 3U + 2U + 7U);
  triangles.clear();
  EXPECT_TRUE(split_polygon(point, all_of(2), triangles));
  const std::vector<Eigen::Vector3f> large = turned(comb(kMostConcaveCorners));
  EXPECT_FALSE(split_polygon(large, all_of(large.size()), triangles));
  EXPECT_TRUE(triangles.empty());
}

}  // namespace
}  // namespace saccade
