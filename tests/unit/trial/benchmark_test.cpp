// SPDX-License-Identifier: Apache-2.0
#include "saccade/trial/benchmark.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <set>

#include "saccade/explore/planners.hpp"
#include "saccade/io/clouds/ply_io.hpp"
#include "saccade/trial/benchmark_objects.hpp"
#include "saccade/trial/internal/md5.hpp"
#include "saccade/trial/internal/stand_ins.hpp"
#include "support/temp_folder.hpp"

namespace saccade {
namespace {

using Eigen::Vector3d;

std::string md5_of_text(std::string_view text) { return md5_of(std::as_bytes(std::span{text})); }

Benchmark named_protocol(std::string_view name) {
  const auto benchmark = find_benchmark(name);
  EXPECT_TRUE(benchmark);
  return *benchmark;
}

TEST(Md5, HasTheDigestsOfRfc1321) {
  EXPECT_EQ(md5_of_text(""), "d41d8cd98f00b204e9800998ecf8427e");
  EXPECT_EQ(md5_of_text("abc"), "900150983cd24fb0d6963f7d28e17f72");
  EXPECT_EQ(md5_of_text("12345678901234567890123456789012345678901234567890123456789012345678901234567890"),
            "57edf4a22be3c955ac49da2e2107b67a");
}

TEST(Benchmark, HasFourProtocolsWhosePartsExist) {
  Planners planners = trial_planners();
  planners.add(one_shot(surface_planner()));
  std::set<std::string> names;
  for (const Benchmark& benchmark : benchmarks()) {
    EXPECT_TRUE(names.insert(benchmark.name).second);
    EXPECT_FALSE(benchmark.text.empty());
    EXPECT_TRUE(benchmark.camera.validate());
    ASSERT_FALSE(benchmark.strategies.empty());
    EXPECT_EQ(benchmark.strategies.front(), "surface");  // what stands beside published figures is our default
    for (const std::string& strategy : benchmark.strategies) EXPECT_TRUE(planners.find(strategy)) << strategy;
    for (const std::string& name : benchmark.stand_ins) EXPECT_TRUE(stand_in(name)) << name;
    for (const BenchmarkMesh& mesh : benchmark.meshes) EXPECT_EQ(mesh.md5.size(), 32U) << mesh.file;
    for (const PublishedFigure& figure : benchmark.published) {
      EXPECT_GT(figure.coverage, 0.0);
      EXPECT_LE(figure.coverage, 1.0);
      EXPECT_FALSE(figure.source.empty() || figure.object.empty() || figure.differs.empty());
    }
    EXPECT_NE(benchmark.published.empty(), benchmark.not_published.empty()) << benchmark.name;
  }
  EXPECT_EQ(names, (std::set<std::string>{"household", "one-shot", "tabletop-arm", "view-sphere"}));
  const auto unknown = find_benchmark("view-spere");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().message.find("view-sphere, one-shot, tabletop-arm, household"), std::string::npos);
}

TEST(Benchmark, ViewSphereFloatsItsObjectsAmongFiveThousandViews) {
  const Benchmark benchmark = named_protocol("view-sphere");
  const auto plan = plan_benchmark(benchmark, {});
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_EQ(plan->objects, ObjectSource::stand_ins);
  ASSERT_EQ(plan->scenes.size(), 3U);
  EXPECT_EQ(plan->run.exploration.max_views, 9);  // the first view is the tenth
  EXPECT_EQ(plan->run.exploration.oscillation_frames, 1);
  EXPECT_FALSE(plan->run.noise);
  EXPECT_TRUE(plan->run.validate());
  ASSERT_TRUE(plan->run.fixed_views);
  const std::vector<Pose>& views = *plan->run.fixed_views;
  ASSERT_EQ(views.size(), 5000U);
  EXPECT_LT((views.front().translation() - Vector3d{-0.25, 0.0, 0.0}).norm(), 1e-12);
  for (const Pose& view : views) {
    EXPECT_LE(view.translation().norm(), 0.4);
    EXPECT_GE(view.translation().cwiseAbs().maxCoeff(), 0.2);
    EXPECT_LT((view.linear().col(2) + view.translation().normalized()).norm(), 1e-9);  // looks at the middle
  }
  for (const Scene& scene : plan->scenes) {
    ASSERT_EQ(scene.scan.size(), 1U);
    EXPECT_EQ(scene.scan.front().matrix(), views.front().matrix());
    double farthest = 0.0;
    const auto meshes = true_meshes(scene);
    ASSERT_TRUE(meshes);
    for (const ObjectMesh& object : *meshes) {
      if (object.support) continue;
      for (const Eigen::Vector3f& p : object.mesh.vertices) farthest = std::max(farthest, p.cast<double>().norm());
    }
    EXPECT_NEAR(farthest, 0.1, 1e-6) << scene.name;
  }
}

TEST(Benchmark, OneShotPutsItsObjectsOnATableUnderAHemisphere) {
  const auto plan = plan_benchmark(named_protocol("one-shot"), {});
  ASSERT_TRUE(plan) << plan.error().message;
  ASSERT_EQ(plan->scenes.size(), 16U);  // four objects, each begun from four views
  std::set<std::string> names;
  for (const Scene& scene : plan->scenes) names.insert(scene.name);
  EXPECT_EQ(names.size(), 16U);
  EXPECT_EQ(names.count("figure@4"), 1U);
  const std::vector<Pose>& views = *plan->run.fixed_views;
  ASSERT_EQ(views.size(), 32U);
  double nearest = 1.0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    EXPECT_NEAR(views[i].translation().norm(), 0.4, 1e-12);
    EXPECT_GT(views[i].translation().z(), 0.0);
    for (std::size_t j = 0; j < i; ++j) {
      nearest = std::min(nearest, (views[i].translation() - views[j].translation()).norm());
    }
  }
  EXPECT_GT(nearest, 0.12);  // evenly: 32 caps of equal area are 0.2 m across
  for (const Scene& scene : plan->scenes) {
    double lowest = 1.0;
    double table = 1.0;
    const auto meshes = true_meshes(scene);
    ASSERT_TRUE(meshes);
    for (const ObjectMesh& object : *meshes) {
      const Box bounds = bounds_of(object.mesh);
      if (object.name == "floor") table = bounds.max.z();
      if (!object.support) lowest = std::min(lowest, bounds.min.z());
    }
    EXPECT_NEAR(lowest, table, 1e-6) << scene.name;
  }
}

TEST(Benchmark, ACameraThatFliesStaysAboveTheTable) {
  const auto plan = plan_benchmark(named_protocol("household"), {});
  ASSERT_TRUE(plan) << plan.error().message;
  for (const Scene& scene : plan->scenes) {
    const auto rays = RayScene::build(scene);
    ASSERT_TRUE(rays);
    const auto robot = flying_camera(*rays);
    ASSERT_TRUE(robot) << robot.error().message;
    FreeRobot camera = *robot;
    const double table_m = scene.workspace.min.z() + 0.03;
    for (const double height_m : {-1.0, -0.5, -0.1, 0.1, 0.5, 1.0}) {
      const Pose pose = look_at({-0.4, 0.2, table_m + height_m}, Vector3d::Zero());
      EXPECT_EQ(camera.move_to(pose)->has_value(), height_m > 0.0) << scene.name << ' ' << height_m;
    }
  }
}

TEST(Benchmark, TakesOnlyTheRightMeshes) {
  const test::TempFolder folder;
  const Benchmark benchmark = named_protocol("view-sphere");
  const auto none = plan_benchmark(benchmark, folder.path());
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Errc::not_found);
  EXPECT_NE(none.error().message.find("ArmadilloMesh.ply"), std::string::npos) << none.error().message;
  std::ofstream{folder / "ArmadilloMesh.ply"} << "abc";
  const auto wrong = plan_benchmark(benchmark, folder.path());
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().code, Errc::invalid_argument);
  EXPECT_NE(wrong.error().message.find("900150983cd24fb0d6963f7d28e17f72, not 9e68ff1b1cc914ed88cd84f6a8235021"),
            std::string::npos)
      << wrong.error().message;
  EXPECT_NE(wrong.error().message.find("Stanford 3D Scanning Repository"), std::string::npos);

  // A protocol of one's own file: it is read, turned upright and scaled.
  Benchmark own = benchmark;
  const std::string off{"OFF\n4 4 0\n0 0 0\n1 0 0\n0 2 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"};
  own.meshes = {{"Tip", "tip.ply", std::string(32, '0'), "nowhere", UpAxis::y},
                {"Tip", "tip.off", md5_of_text(off), "this test", UpAxis::y}};
  std::ofstream{folder / "tip.off"} << off;
  const auto read = plan_benchmark(own, folder.path());
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->objects, ObjectSource::published);
  ASSERT_EQ(read->scenes.size(), 1U);
  EXPECT_EQ(read->scenes.front().name, "tip");
  const auto meshes = true_meshes(read->scenes.front());
  const Box bounds = bounds_of(meshes->back().mesh);
  EXPECT_NEAR(bounds.max.z() - bounds.min.z(), 2.0 * (bounds.max.x() - bounds.min.x()), 1e-6);
}

TEST(Benchmark, TakesOneFileOfEachObjectAndSaysWhichPublishedFiguresAreOfIt) {
  const test::TempFolder folder;
  const std::string off{"OFF\n4 4 0\n0 0 0\n1 0 0\n0 2 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"};
  const std::string md5 = md5_of_text(off);
  const auto published = [](std::optional<std::string> object) {
    return PublishedFigure{"theirs", 4.0, 0.9, 2022, "a paper", "one object", "much", std::move(object)};
  };
  for (const char* protocol : {"view-sphere", "one-shot"}) {  // one scene for each object, and four
    Benchmark benchmark = named_protocol(protocol);
    benchmark.meshes = {{"Tip", "fine.off", md5, "this test"}, {"Tip", "coarse.off", md5, "this test"}};
    std::ofstream{folder / "coarse.off"} << off;
    const auto coarse = plan_benchmark(benchmark, folder.path());
    ASSERT_TRUE(coarse) << coarse.error().message;
    EXPECT_EQ(coarse->scenes.front().name, protocol == std::string{"one-shot"} ? "coarse@4" : "coarse");
    EXPECT_TRUE(has_same_object(benchmark, *coarse, published("Tip")));
    EXPECT_FALSE(has_same_object(benchmark, *coarse, published("Top")));
    EXPECT_FALSE(has_same_object(benchmark, *coarse, published(std::nullopt)));
    EXPECT_FALSE(has_same_object(benchmark, *plan_benchmark(benchmark, std::nullopt), published("Tip")));

    std::ofstream{folder / "fine.off"} << off;
    std::ofstream{folder / "top.off"} << off;
    const auto both = plan_benchmark(benchmark, folder.path());
    ASSERT_TRUE(both) << both.error().message;
    EXPECT_EQ(both->scenes.size(), coarse->scenes.size());
    EXPECT_TRUE(both->scenes.front().name.starts_with("fine"));
    benchmark.meshes.push_back({"Top", "top.off", md5, "this test"});
    const auto two = plan_benchmark(benchmark, folder.path());
    ASSERT_TRUE(two) << two.error().message;
    EXPECT_FALSE(has_same_object(benchmark, *two, published("Tip")));
    std::filesystem::remove(folder / "fine.off");
  }
}

TEST(Benchmark, TakesAnyMeshes) {
  const test::TempFolder folder;
  const auto tetrahedron = [](const char* unit) {
    return std::string{"OFF\n4 4 0\n0 0 0\n"} + unit + " 0 0\n0 2 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  };
  std::ofstream{folder / "tip.off"} << tetrahedron("1");
  std::ofstream{folder / "wide.off"} << tetrahedron("5");
  std::filesystem::create_directory(folder / "other");
  std::ofstream{folder / "other/tip.off"} << tetrahedron("1");
  const auto bounds_in = [](const Scene& scene) { return bounds_of(true_meshes(scene)->back().mesh); };
  const std::vector<std::filesystem::path> both{folder / "wide.off", folder / "tip.off"};

  // Scaled where the protocol scales, whatever --mesh-scale says.
  const auto scaled = plan_benchmark(named_protocol("view-sphere"), both, {1000.0, UpAxis::y});
  ASSERT_TRUE(scaled) << scaled.error().message;
  EXPECT_EQ(scaled->objects, ObjectSource::own);
  ASSERT_EQ(scaled->scenes.size(), 2U);
  EXPECT_EQ(scaled->scenes.front().name, "wide");
  EXPECT_EQ(scaled->scenes.back().name, "tip");
  const Box tip = bounds_in(scaled->scenes.back());
  EXPECT_NEAR(tip.max.z() - tip.min.z(), 2.0 * (tip.max.x() - tip.min.x()), 1e-6);

  // Files of one name are called after their folders, too.
  const std::vector<std::filesystem::path> tips{folder / "tip.off", folder / "other/tip.off"};
  const auto apart = plan_benchmark(named_protocol("view-sphere"), tips, MeshSceneConfig{});
  ASSERT_TRUE(apart) << apart.error().message;
  EXPECT_EQ(apart->scenes.back().name, "other-tip");
  EXPECT_EQ(apart->scenes.front().name, folder.path().filename().string() + "-tip");

  // In its own size on the table otherwise.
  const auto sized = plan_benchmark(named_protocol("household"), both, {0.05, {}});
  ASSERT_TRUE(sized) << sized.error().message;
  const Box wide = bounds_in(sized->scenes.front());
  EXPECT_NEAR(wide.max.x() - wide.min.x(), 0.25, 1e-6);
  EXPECT_NEAR(wide.max.z() - wide.min.z(), 0.05, 1e-6);

  const auto refused = [&](const char* protocol, std::vector<std::filesystem::path> files, const char* text) {
    const auto plan = plan_benchmark(named_protocol(protocol), files, MeshSceneConfig{});
    ASSERT_FALSE(plan) << text;
    EXPECT_EQ(plan.error().code, Errc::invalid_argument);
    EXPECT_NE(plan.error().message.find(text), std::string::npos) << plan.error().message;
  };
  refused("household", both, "--mesh-scale");
  refused("one-shot", {folder / "tip.off", folder / "tip.ply"}, "rename one");
  refused("tabletop-arm", both, "takes no meshes");
}

TEST(Benchmark, NamesOwnObjectsByTheFoldersThatTellThemApart) {
  using Names = std::vector<std::string>;
  const auto names = [](const std::vector<std::filesystem::path>& files) {
    const auto found = own_object_names(files);
    return found ? *found : Names{found.error().message};
  };
  EXPECT_EQ(names({"a/mug.stl", "b/bowl.ply"}), (Names{"mug", "bowl"}));
  EXPECT_EQ(names({"mug/n.stl", "x.stl", "bowl/n.stl"}), (Names{"mug-n", "x", "bowl-n"}));
  EXPECT_EQ(names({"mug/16k/n.stl", "bowl/16k/n.stl"}), (Names{"mug-n", "bowl-n"}));
  EXPECT_EQ(names({"a/x/n.stl", "a/y/n.stl", "b/x/n.stl"}), (Names{"a-x-n", "a-y-n", "b-x-n"}));
  EXPECT_EQ(names({"x/a/n.stl", "x/b/n.stl", "y/a-n.stl"}), (Names{"x-a-n", "x-b-n", "a-n"}));
  EXPECT_EQ(names({"a/n.stl", "a/n.ply"}), (Names{"the object of a/n.stl is called n, too; rename one of the files"}));
  EXPECT_EQ(names({"a/n.stl", "a/n.stl"}), (Names{"the object of a/n.stl is called n, too; rename one of the files"}));
}

TEST(Benchmark, CountsTheOuterSurfaceOfEachBodyOfAMesh) {
  const test::TempFolder folder;
  struct Cube {
    double edge_m;
    Eigen::Vector3f at;
    bool inside_out;
  };
  const auto share_of = [&](const std::vector<Cube>& cubes) {
    TriangleMesh all;
    for (const Cube& cube : cubes) {
      const auto offset = static_cast<std::uint32_t>(all.vertices.size());
      const TriangleMesh box = *tessellate(BoxShape{Vector3d::Constant(cube.edge_m)});
      for (const Eigen::Vector3f& p : box.vertices) all.vertices.emplace_back(p + cube.at);
      for (const auto& [a, b, c] : box.triangles) {
        all.triangles.push_back({a + offset, (cube.inside_out ? c : b) + offset, (cube.inside_out ? b : c) + offset});
      }
    }
    EXPECT_TRUE(write_mesh(folder / "cubes.ply", all));
    Benchmark benchmark = named_protocol("household");
    benchmark.on_table = false;
    benchmark.camera = {160, 120, 130.0, 130.0, 79.5, 59.5, 0.05, 2.0};
    benchmark.rule = CoverageRule{CoverageRule::Kind::distance, 0.012, 0.006};
    const std::vector<std::filesystem::path> files{folder / "cubes.ply"};
    const auto plan = plan_benchmark(benchmark, files, MeshSceneConfig{});
    EXPECT_TRUE(plan) << plan.error().message;
    std::vector<Pose> views;
    for (const double x : {-0.35, 0.0, 0.35}) {
      for (const double y : {-0.3, 0.3}) {
        for (const double z : {-0.3, 0.3}) views.push_back(look_at({x, y, z}, Vector3d::Zero()));
      }
    }
    const auto rays = RayScene::build(plan->scenes.front());
    const auto curves = measure_benchmark(benchmark, *rays, plan->run, std::vector<std::vector<Pose>>{views},
                                          Executor::with_threads(1));
    EXPECT_TRUE(curves) << curves.error().message;
    return curves->front().after.back().of_all;
  };
  const Eigen::Vector3f here = Eigen::Vector3f::Zero();
  const double whole = share_of({{0.1, here, false}});
  EXPECT_GT(whole, 0.98);
  EXPECT_GT(share_of({{0.1, here, false}, {0.1, {0.3F, 0.0F, 0.0F}, true}}), 0.98);
  EXPECT_GT(share_of({{0.1, here, false}, {0.1, {0.04F, 0.03F, 0.02F}, true}}), 0.95);  // overlapping
  for (const bool inside_out : {false, true}) {
    EXPECT_EQ(share_of({{0.1, here, false}, {0.06, {0.0F, 0.0F, 0.02F}, inside_out}}), whole);  // nested
  }
}

TEST(Benchmark, SaysWhyItsFolderOfMeshesCannotBeUsed) {
  const test::TempFolder folder;
  std::ofstream{folder / "file"} << "abc";
  for (const char* name : {"loop", "pipe"}) std::filesystem::create_directory(folder / name);
  std::filesystem::create_symlink("BunnyMesh.ply", folder / "loop/BunnyMesh.ply");  // leads to itself
  ASSERT_EQ(::mkfifo((folder / "pipe/BunnyMesh.ply").c_str(), 0600), 0);
  struct Case {
    std::filesystem::path objects;
    Errc code;
    const char* text;
    const char* place;
  };
  for (const Case& bad : {Case{folder / "nowhere", Errc::not_found, "no such folder", "nowhere"},
                          Case{folder / "file", Errc::invalid_argument, "is a file", "file"},
                          Case{folder / "loop", Errc::io_failure, "cannot be read", "BunnyMesh.ply"},
                          Case{folder / "pipe", Errc::invalid_argument, "not an ordinary file", "BunnyMesh.ply"}}) {
    const auto plan = plan_benchmark(named_protocol("view-sphere"), bad.objects);
    ASSERT_FALSE(plan) << bad.text;
    EXPECT_EQ(plan.error().code, bad.code) << bad.text;
    EXPECT_NE(plan.error().message.find(bad.text), std::string::npos) << plan.error().message;
    EXPECT_TRUE(plan.error().context.ends_with(bad.place)) << plan.error().context;
  }
}

TEST(Benchmark, ChoosesAmongItsViewsAndEndsAfterThem) {
  Benchmark benchmark = named_protocol("one-shot");
  benchmark.stand_ins = {"hare"};
  benchmark.starts = 1;
  benchmark.views_in_all = 4;
  benchmark.camera = {96, 72, 90.0, 90.0, 47.5, 35.5, 0.05, 2.0};
  benchmark.voxel_size_m = 0.012;
  benchmark.rule->spacing_m = 0.004;
  auto plan = plan_benchmark(benchmark, {});
  ASSERT_TRUE(plan);
  const Executor executor = Executor::with_threads(1);
  const auto rays = RayScene::build(plan->scenes.front());
  const auto truth = GroundTruth::build(*rays, 0.01, executor);
  ASSERT_TRUE(truth);
  for (const NamedPlanner& planner :
       {surface_planner(), one_shot(surface_planner()), *trial_planners().find("random")}) {
    plan->run.strategy = planner;
    const auto run = run_simulated(*truth, plan->run, executor);
    ASSERT_TRUE(run) << run.error().message;
    ASSERT_EQ(run->views.size(), 3U) << planner.name;
    std::vector<Pose> taken;
    for (const ViewRecord& view : run->views) {
      taken.push_back(view.T_world_camera);
      EXPECT_EQ(view.candidates, 32U) << planner.name;
      const auto is_it = [&](const Pose& pose) { return (pose.matrix() - view.T_world_camera.matrix()).norm() < 1e-9; };
      EXPECT_EQ(std::count_if(plan->run.fixed_views->begin(), plan->run.fixed_views->end(), is_it), 1) << planner.name;
    }
    const auto curves = measure_benchmark(benchmark, *rays, plan->run,
                                          std::vector<std::vector<Pose>>{taken, {taken.front()}}, executor);
    ASSERT_TRUE(curves) << curves.error().message;
    ASSERT_EQ(curves->size(), 2U);
    const BenchmarkCurve& whole = curves->front();
    const BenchmarkCurve& ended = curves->back();
    ASSERT_EQ(whole.after.size(), 4U);
    EXPECT_EQ(whole.taken, 4U);
    EXPECT_EQ(ended.taken, 2U);
    EXPECT_EQ(ended.after[3].of_all, whole.after[1].of_all);  // a run that ended goes on with its last shares
    for (std::size_t k = 1; k < 4; ++k) EXPECT_GE(whole.after[k].of_all, whole.after[k - 1].of_all);
    EXPECT_GT(whole.after[3].of_visible, whole.after[3].of_all);  // what stands on the table is never visible
  }
}

}  // namespace
}  // namespace saccade
