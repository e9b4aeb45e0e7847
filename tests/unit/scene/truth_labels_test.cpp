// SPDX-License-Identifier: Apache-2.0
#include "saccade/scene/internal/truth_labels.hpp"

#include <gtest/gtest.h>

#include "saccade/scene/scene.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

/// A magazine of 4 mm on a table, with a picture, a letter on it, and print.
Scene magazine_on_table() {
  Scene scene;
  scene.name = "magazine";
  scene.workspace = Box{Vector3d::Constant(-1.0), Vector3d::Constant(1.0)};
  SceneObject table;
  table.name = "table";
  table.shape = BoxShape{{1.0, 1.0, 0.1}};
  table.T_world_object.translation() = Vector3d{0.0, 0.0, -0.1};
  SceneObject magazine;
  magazine.name = "magazine";
  magazine.shape = BoxShape{{0.2, 0.3, 0.004}};
  magazine.color = {240, 240, 240};
  Patch picture;
  picture.center_m = {0.0, 0.05};
  picture.size_m = {0.1, 0.1};
  picture.color = {200, 30, 30};
  picture.segment = "picture";
  Patch letter = picture;
  letter.kind = Patch::Kind::glyph;
  letter.glyph = 'L';
  letter.size_m = {0.03, 0.05};
  letter.color = {10, 10, 200};
  letter.segment = "letter";
  Patch print;
  print.kind = Patch::Kind::print;
  print.center_m = {0.0, -0.08};
  print.size_m = {0.15, 0.08};
  magazine.patches = {picture, letter, print};
  scene.objects = {table, magazine};
  return scene;
}

std::string name_at(const TruthLabels& truth, const Vector3d& p, std::optional<Vector3d> normal = {}) {
  return truth.names()[truth.label(p, 0.03, normal)];
}

TEST(TruthLabels, KnowsWhatIsPaintedAndWhatLiesBeneath) {
  const RayScene scene = RayScene::build(magazine_on_table()).value();
  const TruthLabels truth = TruthLabels::build(scene).value();
  EXPECT_EQ(truth.names(), (std::vector<std::string>{"", "table", "magazine", "picture", "letter"}));
  for (const double off_m :
       {-0.006, -0.001, 0.003, 0.02}) {  // too low is under the table's top, and still the magazine's
    const double z = 0.004 + off_m;
    EXPECT_EQ(name_at(truth, {-0.04, 0.09, z}), "picture") << off_m;
    EXPECT_EQ(name_at(truth, {-0.01, 0.05, z}), "letter") << off_m;
    EXPECT_EQ(name_at(truth, {0.01, 0.05, z}), "picture") << off_m;  // right of the stem of the L
    EXPECT_EQ(name_at(truth, {0.01, -0.08, z}), "magazine") << off_m;
  }
  EXPECT_EQ(name_at(truth, {0.15, 0.0, 0.003}), "table");
  EXPECT_EQ(name_at(truth, {0.15, 0.0, 0.05}), "");
  EXPECT_EQ(name_at(truth, {0.15, 0.0, 0.003}, Vector3d{0.0, 0.0, -1.0}), "");
}

TEST(Paint, AgreesWithWhatIsSeen) {
  const RayScene scene = RayScene::build(magazine_on_table()).value();
  const TruthLabels truth = TruthLabels::build(scene).value();
  const SegmentTable segments{scene.scene()};
  std::size_t compared{0};
  for (int i = 0; i < 60; ++i) {
    for (int j = 0; j < 60; ++j) {
      const Vector3d from{-0.1475 + 0.005 * i, -0.1975 + 0.0069 * j, 1.0};
      const auto hit = scene.cast(from, -Vector3d::UnitZ());
      ASSERT_TRUE(hit);
      const Vector3d p = from - hit->t * Vector3d::UnitZ();
      const SceneObject& object = scene.scene().objects[hit->object];
      const Paint paint = paint_at(object, object.T_world_object.inverse() * p, hit->normal_world);
      EXPECT_EQ(segments.label(hit->object, paint), truth.label(p));
      ++compared;
    }
  }
  EXPECT_EQ(compared, 3600U);
}

TEST(Paint, RefusesBadPatches) {
  const auto why = [](const auto& change) {
    Scene scene = magazine_on_table();
    change(scene.objects[1].patches[1]);
    const Status good = scene.validate();
    return good.ok() ? std::string{} : good.error().message;
  };
  EXPECT_EQ(why([](Patch&) {}), "");
  EXPECT_EQ(why([](Patch& patch) { patch.glyph = '?'; }), "glyphs are the letters A to Z and the digits");
  EXPECT_EQ(why([](Patch& patch) { patch.segment.clear(); }), "a patch needs the name of its segment");
  EXPECT_NE(why([](Patch& patch) { patch.size_m.x() = 0.0; }), "");
}

}  // namespace
}  // namespace saccade
