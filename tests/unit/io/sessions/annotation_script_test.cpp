// SPDX-License-Identifier: Apache-2.0
#include "saccade/io/sessions/annotation_script.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "saccade/annotate/selection.hpp"
#include "support/annotated_cloud.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

using Indices = std::vector<std::uint32_t>;

/// The one action of a script of one line, or a failure.
ScriptedAction scripted_action(const std::string& line) {
  const auto script = parse_annotation_script(line);
  EXPECT_TRUE(script) << line << ": " << script.error().to_string();
  if (!script || script->size() != 1) return {};
  return script->front();
}

std::string script_error(const std::string& text) {
  const auto script = parse_annotation_script(text);
  if (script) return "";
  EXPECT_EQ(script.error().code, Errc::corrupt_data);
  return script.error().to_string();
}

/// The patchy cloud of the annotation tests with an annotation, seen from 0.3 m above.
struct ScriptedCloud {
  PointCloud cloud{test::patchy_cloud(20)};
  Annotation annotation{test::graph_of(cloud)};

  [[nodiscard]] Result<AnnotationAction> resolve(const std::string& line) const {
    return resolve_action(scripted_action(line), cloud.positions_m, annotation, 7, Executor{});
  }
  void apply(const std::string& line) {
    auto action = resolve(line);
    ASSERT_TRUE(action) << action.error().to_string();
    ASSERT_TRUE(annotation.validate(*action));
    annotation.apply(std::move(*action));
  }
};

constexpr const char* kFromAbove{
    R"("view": {"T_world_camera": [[1,0,0,0.1],[0,-1,0,0.1],[0,0,-1,0.3],[0,0,0,1]], "fov_deg": 60, "size": [400, 400], "point_size_px": 12})"};

TEST(AnnotationScript, EveryKindOfActionIsRead) {
  const auto script = parse_annotation_script(
      "\xEF\xBB\xBF# boxes\n"
      "\n"
      "{\"do\": \"set\", \"label\": 3, \"points\": [4, 1], \"start_cost\": 0.25, \"client\": 9}\r\n"
      "  {\"do\": \"remove\", \"at\": [1, 2.5, -3], \"within_m\": 0.5}\n"
      "{\"do\": \"move\", \"from\": 4, \"to\": [0, 0, 1]}\n"
      "{\"do\": \"paint\", \"label\": 0, \"at\": [[1, 2, 3], [4, 5, 6]]}\n"
      "{\"do\": \"labels\", \"labels\": [{\"number\": 2, \"name\": \"cup\", \"color\": \"#0a0B0c\"}]}\n"
      "  # the end\n"
      "{\"do\": \"clear\"}\n{\"do\": \"undo\", \"client\": 18446744073709551615}\n{\"do\": \"redo\"}");
  ASSERT_TRUE(script) << script.error().to_string();
  ASSERT_EQ(script->size(), 8U);
  const ScriptedAction& set = script->at(0);
  EXPECT_EQ(set.line, 3U);
  EXPECT_EQ(set.client, 9U);
  EXPECT_EQ(set.change, (AnnotationChange{SetControlPoints{{}, 3, 0.25}}));
  EXPECT_EQ(set.points, (std::vector<ScriptedPoint>{4U, 1U}));
  const ScriptedAction& remove = script->at(1);
  EXPECT_EQ(remove.client, std::nullopt);
  EXPECT_EQ(remove.within_m, 0.5);
  EXPECT_EQ(remove.points, (std::vector<ScriptedPoint>{Eigen::Vector3d{1, 2.5, -3}}));
  EXPECT_EQ(script->at(2).points, (std::vector<ScriptedPoint>{4U, Eigen::Vector3d{0, 0, 1}}));
  EXPECT_EQ(script->at(3).points.size(), 2U);
  EXPECT_EQ(script->at(4).change, (AnnotationChange{DefineLabels{{{2, {"cup", {10, 11, 12}, "", 0}}}}}));
  EXPECT_EQ(script->at(5).change, AnnotationChange{ClearAnnotation{}});
  EXPECT_EQ(script->at(6).client, std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(script->at(7).change, AnnotationChange{RedoAction{}});
  EXPECT_EQ(script->at(7).line, 11U);
  EXPECT_TRUE(parse_annotation_script("")->empty());
}

TEST(AnnotationScript, SelectionsAreRead) {
  const std::string view{R"("view": {"clip_world": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]], "size": [100, 50]})"};
  const auto script = parse_annotation_script(
      R"({"do": "paint", "label": 1, )" + view + R"(, "rectangle": [1, 2, 30, 40], "below_m": "any"})" + "\n" +
      R"({"do": "remove", "lasso": [[0, 0], [9, 0], [9, 9]], "below_m": 0.02})" + "\n" +
      R"({"do": "paint", "label": 2, "brush": {"line": [[5, 5]], "radius_px": 4}})" + "\n" +
      R"({"do": "paint", "label": 2, "brush": {"line": [[5, 5], [6, 7]], "radius_m": 0.1}})" + "\n" +
      R"({"do": "paint", "label": 2, "polyline": [[0, 0], [9, 0], [9, 9]]})");
  ASSERT_TRUE(script) << script.error().to_string();
  for (const ScriptedAction& action : *script) {  // the view counts for the lines after it, too
    ASSERT_TRUE(action.selection);
    EXPECT_EQ(action.selection->view.width, 100);
    EXPECT_EQ(action.selection->view.clip_world, Eigen::Matrix4d::Identity());
  }
  EXPECT_EQ(std::get<ScreenRectangle>(script->at(0).selection->shape).opposite, ScreenPoint(30, 40));
  EXPECT_EQ(script->at(0).selection->below_m, kAnyDepth_m);
  EXPECT_EQ(std::get<ScreenPolygon>(script->at(1).selection->shape).corners.size(), 3U);
  EXPECT_EQ(script->at(1).selection->below_m, 0.02);
  EXPECT_EQ(std::get<ScreenStroke>(script->at(2).selection->shape).radius_px, 4.0);
  EXPECT_EQ(script->at(2).selection->below_m, kOnSurface_m);
  EXPECT_EQ(script->at(3).selection->radius_m, 0.1);
  EXPECT_FALSE(script->at(4).selection->radius_m);
}

TEST(AnnotationScript, ACameraSeesAsACameraDoes) {
  const ScriptedAction action = scripted_action(
      R"({"do": "paint", "label": 1, "rectangle": [0, 0, 1, 1], "view": {"size": [640, 480], "fov_deg": 90,)"
      R"("T_world_camera": [[0,0,1,1],[-1,0,0,2],[0,-1,0,3],[0,0,0,1]]}})");
  ASSERT_TRUE(action.selection);
  const ScreenProjection project{action.selection->view};
  // x right, y down, z forward: 2 m ahead, 1 m to the right, 0.5 m down, in a picture whose focal length is 240 px
  const ScreenPosition seen = project(Eigen::Vector3f{1.0F + 2.0F, 2.0F - 1.0F, 3.0F - 0.5F});
  EXPECT_NEAR(seen.u_px, 320 + 120, 1e-9);
  EXPECT_NEAR(seen.v_px, 240 + 60, 1e-9);
  EXPECT_NEAR(seen.depth_m, 2.0, 1e-6);
  EXPECT_FALSE(project(Eigen::Vector3f{0.5F, 2.0F, 3.0F}).in_view());  // behind
  EXPECT_TRUE(project(Eigen::Vector3f{1000.0F, 2.0F, 3.0F}).in_view());
}

TEST(AnnotationScript, MistakesAreToldWithTheLine) {
  const auto expect_error = [](const std::string& line, const std::string& part) {
    const std::string error = script_error("# one\n{\"do\": \"clear\"}\n" + line);
    EXPECT_TRUE(error.starts_with("line 3: ")) << line << "\n" << error;
    EXPECT_NE(error.find(part), std::string::npos) << line << "\n" << error;
  };
  expect_error("set 4", "not valid JSON");
  expect_error("{\"do\": \"set\"", "not valid JSON");
  expect_error("{\"do\": \"set\", \"label\": 1e999, \"points\": [1]}", "not valid JSON");
  expect_error(std::string(100'000, '['), "not valid JSON");
  expect_error("[]", "an action is an object");
  expect_error("{}", "needs the key do");
  expect_error(R"({"do": 3})", "do is a word");
  expect_error(R"({"do": "draw"})", "unknown action 'draw'; there are set");
  expect_error(R"({"do": "undo", "client": -1})", "client is a whole number");
  expect_error(R"({"do": "undo", "label": 1})", "unknown key 'label'");
  expect_error(R"({"do": "set", "points": [1]})", "needs the key label");
  expect_error(R"({"do": "set", "label": 1})", "say which points");
  expect_error(R"({"do": "set", "label": 1, "points": []})", "say which points");
  expect_error(R"({"do": "set", "label": 1, "points": 4})", "points is a list of indices");
  expect_error(R"({"do": "set", "label": 1, "points": [4.5]})", "each of points is a whole number");
  expect_error(R"({"do": "set", "label": 1, "points": [4294967296]})", "each of points is a whole number");
  expect_error(R"({"do": "set", "label": "cup", "points": [4]})", "label is a whole number");
  expect_error(R"({"do": "set", "label": 1, "at": [1, 2]})", "at is a list of 3 numbers");
  expect_error(R"({"do": "set", "label": 1, "at": [[1, 2, 3], 4]})", "each place of at");
  expect_error(R"({"do": "set", "label": 1, "at": [1, 2, null]})", "each number of at is a number");
  expect_error(R"({"do": "set", "label": 1, "at": [1, 2, 3], "within_m": 0})", "within_m is positive");
  expect_error(R"({"do": "set", "label": 1, "rectangle": [1, 2, 3, 4]})", "say which points");
  expect_error(R"({"do": "move", "from": 4})", "needs the key to");
  expect_error(R"({"do": "move", "from": "cup", "to": 4})", "from is the index of a point, or a place");
  expect_error(R"({"do": "labels", "labels": [{"number": 0}]})", "within 1 and");
  expect_error(R"({"do": "labels", "labels": 7})", "a list of at least one label");
  expect_error(R"({"do": "paint", "label": 1, "rectangle": [1, 2, 3, 4]})", "a selection needs a view");
  expect_error(R"({"do": "paint", "label": 1, "points": [1], "below_m": 1})", "below_m goes with");
  const auto with_view = [&](const std::string& rest, const std::string& part) {
    expect_error(std::string{R"({"do": "paint", "label": 1, )"} + kFromAbove + rest + "}", part);
  };
  with_view("", "say which points");
  with_view(R"(, "rectangle": [1, 2, 3])", "rectangle is a list of 4 numbers");
  with_view(R"(, "rectangle": [1, 2, 3, 4], "lasso": [])", "not several");
  with_view(R"(, "rectangle": [1, 2, 3, 4], "points": [1])", "not both");
  with_view(R"(, "rectangle": [1, 2, 3, 4], "below_m": -1)", "below_m is \"any\" or");
  with_view(R"(, "lasso": [[1, 2], [3, 4]])", "three corners");
  with_view(R"(, "brush": {"line": [[1, 2]]})", "either radius_px or radius_m");
  with_view(R"(, "brush": {"line": [[1, 2]], "radius_px": 0})", "radius");
  with_view(R"(, "brush": {"line": [[1, 2]], "radius_m": 0.1}, "below_m": 0)", "says nothing more");
  const auto view = [&](const std::string& keys, const std::string& part) {
    expect_error(R"({"do": "paint", "label": 1, "rectangle": [1, 2, 3, 4], "view": )" + keys + "}", part);
  };
  view("7", "a view is an object");
  view("{}", "needs the key size");
  view(R"({"size": [100, 50]})", "needs the key T_world_camera");
  view(R"({"size": [100, 50.5], "clip_world": 1})", "whole pixels");
  view(R"({"size": [1e300, 50], "clip_world": 1})", "whole pixels");
  view(R"({"size": [100, 50], "clip_world": [[1, 0, 0, 0]]})", "four rows");
  view(R"({"size": [100, 50], "clip_world": [[0,0,0,0],[0,0,0,0],[0,0,0,0],[0,0,0,0]]})", "not a perspective");
  view(R"({"size": [100, 0], "clip_world": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]})", "1 to 8192");
  view(R"({"size": [100, 50], "T_world_camera": 1, "fov_deg": 60})", "T_world_camera: ");
  view(R"({"size": [9, 9], "T_world_camera": [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]], "fov_deg": 180})",
       "less than 180");
}

TEST(AnnotationScript, PlacesMeanTheNearestPoint) {
  ScriptedCloud scripted;
  const auto set = scripted.resolve(R"({"do": "set", "label": 2, "at": [[0.051, 0.03, 0], [0.05, 0.031, 0]]})");
  ASSERT_TRUE(set) << set.error().to_string();
  EXPECT_EQ(*set, (AnnotationAction{7, SetControlPoints{{3 * 20 + 5}, 2}}));  // both mean the same one
  const auto far = scripted.resolve(R"({"do": "set", "label": 2, "at": [0.05, 0.03, 0.2]})");
  ASSERT_FALSE(far);
  EXPECT_NE(far.error().to_string().find("line 1: no point within 0.05 m of (0.05, 0.03, 0.2); the nearest, "),
            std::string::npos)
      << far.error().to_string();
  EXPECT_TRUE(scripted.resolve(R"({"do": "set", "label": 2, "at": [0.05, 0.03, 0.2], "within_m": 0.3})"));

  // What is removed or moved is the nearest control point, though other points are nearer.
  EXPECT_NE(scripted.resolve(R"({"do": "remove", "at": [0, 0, 0]})").error().message.find("none at all"),
            std::string::npos);
  scripted.apply(R"({"do": "set", "label": 1, "points": [0, 399]})");
  EXPECT_EQ(scripted.resolve(R"({"do": "remove", "at": [0.02, 0, 0]})")->change,
            AnnotationChange{RemoveControlPoints{{0}}});
  EXPECT_EQ(scripted.resolve(R"({"do": "move", "from": [0.02, 0, 0], "to": [0.02, 0, 0]})")->change,
            (AnnotationChange{MoveControlPoint{0, 2}}));
  EXPECT_FALSE(scripted.resolve(R"({"do": "remove", "at": [0.1, 0.1, 0]})"));
}

TEST(AnnotationScript, SelectionsSelectAsTheToolsDo) {
  ScriptedCloud scripted;
  const std::string paint = std::string{R"({"do": "paint", "label": 2, )"} + kFromAbove;
  const SelectionView view = scripted_action(paint + R"(, "rectangle": [0, 0, 1, 1]})").selection->view;
  const auto& positions_m = scripted.cloud.positions_m;
  const auto points_of = [&](const std::string& line) -> Indices {
    const auto action = scripted.resolve(line);
    EXPECT_TRUE(action) << action.error().to_string();
    return action ? std::get<PaintPoints>(action->change).points : Indices{};
  };
  const Indices left = *select_points(positions_m, view, ScreenRectangle{{0, 0}, {200, 400}}, 0.0, Executor{});
  ASSERT_GT(left.size(), 100U);
  EXPECT_EQ(points_of(paint + R"(, "rectangle": [0, 0, 200, 400]})"), left);
  const std::vector<ScreenPoint> line{{100, 100}, {200, 100}};
  EXPECT_EQ(points_of(paint + R"(, "brush": {"line": [[100, 100], [200, 100]], "radius_m": 0.02}})"),
            *select_around(positions_m, view, line, 0.02, Executor{}));
  EXPECT_NE(scripted.resolve(paint + R"(, "rectangle": [0, 0, 1, 1]})").error().message.find("nothing is selected"),
            std::string::npos);

  const std::string remove = std::string{R"({"do": "remove", )"} + kFromAbove + R"(, "rectangle": [0, 0, 200, 400]})";
  EXPECT_NE(scripted.resolve(remove).error().message.find("no control point"), std::string::npos);
  scripted.apply(R"({"do": "set", "label": 1, "points": [0, 19, 40]})");
  EXPECT_EQ(std::get<RemoveControlPoints>(scripted.resolve(remove)->change).points, (Indices{0, 40}));
}

TEST(AnnotationScript, WhatTheCloudRefusesIsSaidBeforeAnythingIsDone) {
  const auto error_of = [](const std::string& line) {
    const auto script = parse_annotation_script("\n" + line);
    EXPECT_TRUE(script) << line;
    const Status status = check_script(*script, 100, 1.0);
    return status ? std::string{} : status.error().to_string();
  };
  EXPECT_EQ(error_of(R"({"do": "set", "label": 1, "points": [99]})"), "");
  EXPECT_EQ(error_of(R"({"do": "set", "label": 1, "points": [100]})"),
            "line 2: point 100 is not one of the cloud's 100");
  EXPECT_EQ(error_of(R"({"do": "set", "label": 1, "at": [1, 2, 3]})"), "");
  EXPECT_NE(error_of(R"({"do": "set", "label": 0, "at": [1, 2, 3]})").find("line 2: labels are 1 to"),
            std::string::npos);
  EXPECT_NE(error_of(R"({"do": "set", "label": 1, "points": [1], "start_cost": 1})").find("start cost"),
            std::string::npos);
  EXPECT_EQ(error_of(R"({"do": "move", "from": [1, 2, 3], "to": 99})"), "");
  EXPECT_NE(error_of(R"({"do": "move", "from": [1, 2, 3], "to": 100})").find("point 100"), std::string::npos);
  EXPECT_NE(error_of(R"({"do": "move", "from": 4, "to": 4})").find("to where it is"), std::string::npos);
  EXPECT_NE(error_of(R"({"do": "paint", "label": 4294967295, "points": [1]})").find("labels are"), std::string::npos);
  EXPECT_EQ(error_of(R"({"do": "undo"})"), "");
}

TEST(AnnotationScript, FilesAreNamedInErrors) {
  const test::TempFolder folder;
  EXPECT_EQ(read_annotation_script(folder / "none").error().code, Errc::not_found);
  const auto path = folder.write("a.jsonl", "\n{\"do\": \"draw\"}");
  EXPECT_EQ(read_annotation_script(path).error().context, path.string() + ", line 2");
}

}  // namespace
}  // namespace saccade
