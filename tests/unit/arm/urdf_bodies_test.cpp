// SPDX-License-Identifier: Apache-2.0
// Bodies of a URDF's links: what stands in for missing ones, and lengths beyond sense.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "saccade/arm/arm_collision.hpp"
#include "saccade/arm/internal/convex_cover.hpp"
#include "saccade/arm/urdf.hpp"
#include "saccade/core/names.hpp"
#include "support/shared_arms.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

namespace fs = std::filesystem;

const std::string kTwoJoints{R"(<robot name="a"><link name="b"/><link name="c">C</link><link name="d">D</link>
<joint name="j" type="revolute"><parent link="b"/><child link="c"/><origin xyz="0 0 0.1"/><axis xyz="0 0 1"/>
  <limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
<joint name="k" type="prismatic"><parent link="c"/><child link="d"/><origin xyz="0 0 0.3"/><axis xyz="1 0 0"/>
  <limit lower="0" upper="0.5" velocity="1" effort="1"/></joint></robot>)"};

/// Square pyramid without its base, in millimetres along axis z, as a modeller writes it.
constexpr const char* kOpenDae{R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="millimeter" meter="0.001"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="15">100 100 0 -100 100 0 -100 -100 0 100 -100 0 0 0 300</float_array>
<technique_common><accessor source="#pa" count="5" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 4 1 2 4 2 3 4 3 0 4</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)"};

std::string body(const std::string& kind, const std::string& geometry) {
  return "<" + kind + "><geometry>" + geometry + "</geometry></" + kind + ">";
}
std::string collision(const std::string& geometry) { return body("collision", geometry); }
std::string mesh(const std::string& name, const std::string& scale = "") {
  return "<mesh filename=\"" + name + "\"" + (scale.empty() ? "" : " scale=\"" + scale + "\"") + "/>";
}

class UrdfBodiesTest : public testing::Test {
 protected:
  /// Reads an arm with these elements in its moving links.
  [[nodiscard]] Result<UrdfArm> read(const std::string& c, const std::string& d = "",
                                     const std::string& arm = kTwoJoints) const {
    return parse_urdf(test::replaced(test::replaced(arm, ">C<", ">" + c + "<"), ">D<", ">" + d + "<"), folder_.path());
  }
  /// Reads it, and expects that each part is said once.
  UrdfArm expect_said(const Result<UrdfArm>& arm, const std::vector<std::string>& parts) const {
    EXPECT_TRUE(arm) << arm.error().to_string();
    if (!arm) return find_robot("comau").value();
    for (const std::string& part : parts) {
      EXPECT_EQ(std::count_if(arm->choices.begin(), arm->choices.end(),
                              [&part](const std::string& choice) { return choice.find(part) != std::string::npos; }),
                1)
          << part << " in\n"
          << joined(arm->choices, "\n");
    }
    EXPECT_TRUE(std::equal(arm->choices.begin(), arm->choices.end(), arm->notes.begin()));
    return *arm;
  }
  void expect_error(const Result<UrdfArm>& arm, const std::string& part) const {
    ASSERT_FALSE(arm) << part;
    EXPECT_EQ(arm.error().code, Errc::corrupt_data);
    EXPECT_NE(arm.error().to_string().find(part), std::string::npos) << arm.error().to_string();
  }
  [[nodiscard]] std::string replaced(const std::string& what, const std::string& with) const {
    return test::replaced(kTwoJoints, what, with);
  }

  test::TempFolder folder_;
};

TEST_F(UrdfBodiesTest, VisualsStandInForMissingBodies) {
  folder_.write("cone.dae", kOpenDae);
  const std::string sphere = "<sphere radius=\"0.05\"/>";
  const UrdfArm arm =
      expect_said(read(body("visual", mesh("cone.dae")), body("visual", sphere) + body("visual", sphere)),
                  {"links without a collision body take their visual one, of meshes the convex hull: c, d"});
  ASSERT_EQ(arm.arm.links()[1].bodies.size(), 1U);
  ASSERT_EQ(arm.arm.links()[2].bodies.size(), 2U);
  EXPECT_EQ(kind_of(arm.arm.links()[2].bodies[0]), "sphere");
  const TriangleMesh& hull = std::get<MeshBody>(arm.arm.links()[1].bodies[0].shape).mesh;
  const Box around = bounds_of(hull);
  EXPECT_NEAR(around.max.z(), 0.3, 0.02) << "metres, and z up";
  EXPECT_NEAR(around.min.z(), 0.0, 0.02);
  EXPECT_NEAR(around.max.x(), 0.1, 0.01);
  EXPECT_TRUE(ArmCollision::create(arm.arm));

  const UrdfArm own = expect_said(read(body("visual", mesh("gone.dae")) + collision(sphere)), {});
  EXPECT_EQ(own.arm.links()[1].bodies.size(), 1U);
  EXPECT_EQ(joined(own.choices).find("visual"), std::string::npos) << "a link with a body needs no other";
}

TEST_F(UrdfBodiesTest, SaysWhatHasNoBody) {
  expect_said(read("", ""), {"no link has a collision or a visual body"});
  expect_said(
      read(body("visual", mesh("gone.dae")), body("visual", "<box size=\"1 1 0\"/>")),
      {"have a visual one that cannot be read, so nothing stands for them: link c, mesh gone.dae: there is no such "
       "file",
       "link d: its box has no volume", "no link has a collision or a visual body"});
}

TEST_F(UrdfBodiesTest, LengthsBeyondSenseNameTheirLink) {
  folder_.write("mm.obj", "v 0 0 0\nv 400 0 0\nv 0 90 0\nv 0 0 70\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  expect_error(
      read(collision(mesh("mm.obj"))),
      "link c: its mesh is 400 m across, and URDFs are in metres; if the file is in millimetres, give its mesh "
      "scale=\"0.001 0.001 0.001\"");
  expect_error(read(collision(mesh("mm.obj", "1000 1000 1000"))), "link c: its mesh is 400000 m across");
  expect_said(read(collision(mesh("mm.obj", "0.001 0.001 0.001"))), {});
  expect_said(read(collision(mesh("mm.obj", "0.000001 0.000001 0.000001"))),
              {"link c: its mesh is 0.4 mm across; is its file in metres already, and its scale too much?"});
  expect_said(read(body("visual", mesh("mm.obj"))), {"link c: its mesh is 400 m across"});
  expect_said(read(collision("<box size=\"300 20 30\"/>")),
              {"link c: its box is 300 m across; are these millimetres?"});
  expect_error(read(collision("<sphere radius=\"600\"/>")), "link c: its sphere is 1200 m across");
  expect_error(read(collision("<cylinder radius=\"1e300\" length=\"1e300\"/>")), "link c: its cylinder is ");
  expect_error(read(collision("<box size=\"1 nan 1\"/>")), "no URDF that can be read");
  expect_error(read(collision("<box size=\"1 1e999 1\"/>")), "Could not parse collision element for Link [c]");
  expect_error(read(collision(mesh("mm.obj", "1 nan 1"))), "Could not parse collision element for Link [c]");
  expect_error(read(body("visual", "<box size=\"1 x 1\"/>") + collision("<sphere radius=\"0.1\"/>")),
               "Could not parse visual element for Link [c]");
  folder_.write("far.obj", "v 0 0 0\nv 1e38 0 0\nv 0 -1e38 0\nf 1 2 3\n");
  expect_error(read(collision(mesh("far.obj"))), "link c");
  expect_error(read(collision(mesh("far.obj", "1e30 1e30 1e30"))), "link c");
}

TEST_F(UrdfBodiesTest, LengthsBeyondSenseNameTheirJoint) {
  expect_error(read("", "", replaced("xyz=\"0 0 0.3\"", "xyz=\"0 0 1001\"")),
               "joint k: its origin is farther away than 1 km");
  expect_error(read("", "", replaced("xyz=\"0 0 0.3\"", "xyz=\"0 0 nan\"")), "");
  expect_error(read("", "", replaced("xyz=\"0 0 0.3\"", "xyz=\"0 0 1e999\"")), "");
  expect_error(read("", "", replaced("xyz=\"0 0 0.3\"", "xyz=\"0 0 1\" rpy=\"inf 0 0\"")), "");
  expect_said(read("", "", replaced("xyz=\"0 0 0.3\"", "xyz=\"0 0 300\"")),
              {"joint k lies 300 m from the joint before it; URDFs are in metres: are these millimetres?"});
  expect_said(read("", "", replaced("xyz=\"0 0 0.1\"", "xyz=\"0 0 50\"")), {});
  expect_said(read("", "", replaced("xyz=\"0 0 0.3\"", "xyz=\"0 0 0.0003\"")), {"the joints lie within 0.3 mm"});
  expect_error(read("", "", replaced("upper=\"0.5\"", "upper=\"1001\"")), "joint k: its limits are beyond 1 km");
  expect_said(read("", "", replaced("upper=\"0.5\"", "upper=\"500\"")),
              {"joint k slides from 0 to 500; URDFs are in metres"});
  expect_error(read("", "", replaced("upper=\"2\"", "upper=\"1e16\"")),
               "joint j: its limits are beyond 1000 rad; a joint that turns without end is of the type continuous");
  expect_said(read("", "", replaced("lower=\"-2\" upper=\"2\"", "lower=\"-180\" upper=\"180\"")),
              {"joint j turns from -180 to 180; URDFs are in radians: are these degrees?"});
}

/// Expects a closed surface, oriented outwards, that encloses the points and has at most this share of volume more.
void expect_enclosed(const std::vector<Eigen::Vector3f>& points, double volume, double more) {
  const TriangleMesh cover = convex_cover(points);
  double covered{0.0};
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& [a, b, c] : cover.triangles) {
    const Eigen::Vector3d p = cover.vertices.at(a).cast<double>();
    const Eigen::Vector3d normal =
        (cover.vertices.at(b).cast<double>() - p).cross(cover.vertices.at(c).cast<double>() - p);
    covered += normal.dot(p) / 6.0;
    for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, a}}) ++edges[{from, to}];
    for (const Eigen::Vector3f& point : points) {
      ASSERT_LE(normal.normalized().dot(point.cast<double>() - p), 1e-5) << "not enclosed";
    }
  }
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1);
    ASSERT_EQ(edges.count({edge.second, edge.first}), 1U) << "not closed";
  }
  EXPECT_GE(covered, 0.999 * volume);
  EXPECT_LE(covered, (1.0 + more) * volume);
  EXPECT_LE(cover.triangles.size(), 500U);
}

TEST(ConvexCover, EnclosesWithLittleMore) {
  std::vector<Eigen::Vector3f> box, ball, tube, plate;
  for (int i = 0; i < 8; ++i)
    box.emplace_back(static_cast<float>(i & 1), 0.5F * static_cast<float>((i >> 1) & 1),
                     0.2F * static_cast<float>(i >> 2));
  constexpr int kRound{200};
  for (int i = 0; i < kRound; ++i) {
    const float turn = 2.0F * std::numbers::pi_v<float> * static_cast<float>(i) / kRound;
    for (const float z : {0.0F, 0.4F}) tube.emplace_back(3.0F + 0.05F * std::cos(turn), 0.05F * std::sin(turn), z);
    plate.emplace_back(std::cos(turn), std::sin(turn), 0.5F * std::cos(turn));
    for (int k = 0; k <= kRound; ++k) {
      const float tilt = std::numbers::pi_v<float> * static_cast<float>(k) / kRound;
      ball.emplace_back(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt));
    }
  }
  expect_enclosed(box, 0.1, 0.01);
  expect_enclosed(tube, 0.4 * std::numbers::pi * 0.0025 * 0.999, 0.1);
  expect_enclosed(ball, 4.0 / 3.0 * std::numbers::pi * 0.995, 0.12);
  expect_enclosed(plate, 4.0, 0.001);                    // a box around it
  expect_enclosed({{1, 1, 1}, {1, 1, 1}}, 1e-9, 0.001);  // a cube of a millimetre
  expect_enclosed({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, 8.0, 0.001);
}

}  // namespace
}  // namespace saccade
