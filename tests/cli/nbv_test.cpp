// SPDX-License-Identifier: Apache-2.0
// saccade nbv, info and sample as a user runs them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <sstream>

#include "cli/run_program.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/io/frames/trajectory_io.hpp"
#include "saccade/io/maps/sacmap.hpp"
#include "saccade/views/view_gain.hpp"
#include "saccade/views/view_sphere.hpp"
#include "support/places.hpp"

namespace saccade::test {
namespace {

class Nbv : public ::testing::Test {
 protected:
  void SetUp() override {
    make_sample(folder_ / "frames", 8);
    const Outcome outcome =
        run_program(fuse(folder_ / "frames", folder_ / "run", {"--no-pictures", "--no-mesh", "--tracking", "forced"}));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  [[nodiscard]] fs::path map() const { return folder_ / "run" / "map.sacmap"; }
  [[nodiscard]] Arguments nbv(const Arguments& more) const {
    return Arguments{"nbv", map().string(), "--quiet", "--image-size", "160,120"} + more;
  }
  TempFolder folder_;
};

TEST_F(Nbv, RanksTheViewSphereAsTheLibraryDoes) {
  const std::string before = text_of(map());
  const Outcome outcome = run_program(nbv({"--poi", "0,0,0.05", "--radius", "0.15", "--forget", "--json", "-"}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json document = outcome.json();
  expect_envelope(document, "nbv");
  const nlohmann::json& result = document.at("result");
  EXPECT_EQ(result.at("candidates"), 960);
  EXPECT_EQ(result.at("evaluated"), 960);
  EXPECT_GT(result.at("rays_cast").get<int>(), 0);
  EXPECT_TRUE(result.at("ms").at("prepare").is_number());
  EXPECT_TRUE(result.at("ms").at("evaluate").is_number());
  ASSERT_EQ(result.at("views").size(), 10U);
  EXPECT_TRUE(text_of(map()) == before) << "the map file was changed";

  auto loaded = load_map(map());
  ASSERT_TRUE(loaded);
  TsdfMap forgotten{std::move(*loaded)};
  const Sphere region{{0, 0, 0.05}, 0.15};
  ASSERT_TRUE(forgotten.forget(region));
  const auto candidates = view_sphere(region.center);
  ASSERT_TRUE(candidates);
  GainConfig config;
  config.sensor = {160, 120, 131.25, 131.25, 79.5, 59.5, 0.5, 6.0};
  const auto gains = evaluate_views(forgotten.snapshot(), region, poses_of(*candidates), config, Executor{});
  ASSERT_TRUE(gains);
  std::uint64_t last = ~std::uint64_t{0};
  for (const nlohmann::json& view : result.at("views")) {
    const auto index = view.at("index").get<std::size_t>();
    EXPECT_EQ(view.at("gain").get<std::uint64_t>(), gains->gains.at(index));
    EXPECT_LE(view.at("gain").get<std::uint64_t>(), last);
    last = view.at("gain").get<std::uint64_t>();
    ASSERT_EQ(view.at("T_world_camera").size(), 4U);
    const Eigen::Matrix4d T = candidates->at(index).T_world_camera.matrix();
    for (int r = 0; r < 4; ++r) {
      for (int c = 0; c < 4; ++c) EXPECT_NEAR(view.at("T_world_camera").at(r).at(c).get<double>(), T(r, c), 1e-12);
    }
  }
  EXPECT_EQ(result.at("views").at(0).at("gain").get<std::uint64_t>(),
            *std::max_element(gains->gains.begin(), gains->gains.end()));
}

TEST_F(Nbv, PrintsATableAndDraws) {
  const Outcome outcome =
      run_program(nbv({"--poi", "0,0,0.05", "--forget", "--top", "3", "--out", (folder_ / "views").string()}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(outcome.out.starts_with("rank      gain  longitude  latitude   roll  position")) << outcome.out;
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 7) << outcome.out;
  EXPECT_NE(outcome.out.find(" other rolls of these positions"), std::string::npos) << outcome.out;
  EXPECT_EQ(names_in(folder_ / "views"), (std::vector<std::string>{"views.json", "views.png"}));
  const auto picture = read_color(folder_ / "views" / "views.png");
  ASSERT_TRUE(picture);
  EXPECT_GT(picture->width(), 300);
  const auto poses = read_poses(folder_ / "views" / "views.json");  // what nbv writes, nbv reads
  ASSERT_TRUE(poses);
  EXPECT_EQ(poses->size(), 3U);
}

TEST_F(Nbv, PrintsEachPositionOnceAndNoneWithoutGain) {
  const Outcome outcome = run_program(nbv({"--poi", "0,0,0.05", "--forget", "--all"}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::istringstream lines{outcome.out};
  std::set<std::string> positions;
  for (std::string line;
       std::getline(lines, line) && !line.starts_with("views left out: ") && !line.starts_with("gain: ");) {
    if (line.starts_with("rank")) continue;
    EXPECT_TRUE(positions.insert(line.substr(line.rfind("°  "))).second) << line;
    std::istringstream words{line};
    std::size_t rank{0};
    std::uint64_t gain{0};
    ASSERT_TRUE(words >> rank >> gain) << line;
    EXPECT_GT(gain, 0U) << line;
  }
  EXPECT_GT(positions.size(), 2U);
  EXPECT_LE(positions.size(), 109U);  // nine rings of twelve, and the pole
}

TEST_F(Nbv, DrawsAsManyViewsAsAreAskedFor) {
  const auto picture_of = [&](const char* top) {
    const fs::path out = folder_ / (std::string{"top-"} + top);
    EXPECT_EQ(run_program(nbv({"--poi", "0,0,0.05", "--forget", "--top", top, "--out", out.string()})).status, 0);
    return read_color(out / "views.png").value();
  };
  const auto frusta = [](const ColorImage& picture) {
    return std::count(picture.pixels().begin(), picture.pixels().end(), Rgb8{214, 28, 92});
  };
  EXPECT_GT(frusta(picture_of("8")), frusta(picture_of("1")) + 100);
}

TEST_F(Nbv, PosesFromAFileBoxesAndCounts) {
  const Arguments region{"--box", "-0.1,-0.1,0,0.1,0.1,0.2", "--forget", "--json", "-"};
  const Outcome sphere = run_program(nbv(region + Arguments{"--all"}));
  ASSERT_EQ(sphere.status, 0) << sphere.err;
  const nlohmann::json all = sphere.json().at("result").at("views");
  ASSERT_EQ(all.size(), 960U);
  const fs::path file = folder_.write("poses.json", nlohmann::json{all.at(5), all.at(0)}.dump());
  const Outcome listed = run_program(nbv(region + Arguments{"--poses", file.string()}));
  ASSERT_EQ(listed.status, 0) << listed.err;
  const nlohmann::json result = listed.json().at("result");
  EXPECT_EQ(result.at("candidates"), 2);
  EXPECT_EQ(result.at("views").at(0).at("gain"), all.at(0).at("gain"));
  EXPECT_EQ(result.at("views").at(1).at("gain"), all.at(5).at("gain"));
  const Outcome voxels = run_program(nbv(region + Arguments{"--count", "voxels"}));
  ASSERT_EQ(voxels.status, 0) << voxels.err;
  EXPECT_LT(voxels.json().at("result").at("views").at(0).at("gain"), all.at(0).at("gain"));
  const Outcome through = run_program(nbv(region + Arguments{"--unknown-outside", "transparent"}));
  ASSERT_EQ(through.status, 0) << through.err;
  EXPECT_GE(through.json().at("result").at("views").at(0).at("gain"), all.at(0).at("gain"));
  const Outcome tilted = run_program(nbv(region + Arguments{"--tilt", "5", "--distance", "0.7,0.9"}));
  ASSERT_EQ(tilted.status, 0) << tilted.err;
  EXPECT_EQ(tilted.json().at("result").at("candidates"), 1920);
}

TEST_F(Nbv, TheViewSphereTurnsWithWhatIsUp) {
  const auto views = [&](const std::string& up) {
    const Outcome outcome = run_program(nbv({"--poi", "0,0,0.05", "--forget", "--all", "--up", up, "--json", "-"}));
    EXPECT_TRUE(outcome.status == 0 || outcome.status == 5) << outcome.err;
    return outcome.json().at("result").at("views");
  };
  const nlohmann::json upright = views("0,0,1");
  const nlohmann::json twice = views("0,0,2");
  EXPECT_EQ(upright, twice);
  ASSERT_EQ(upright.size(), 960U);
  for (const nlohmann::json& view : views("0,-3,0")) {
    const double height_m = -view.at("T_world_camera").at(1).at(3).get<double>();
    EXPECT_NEAR(height_m, 0.8 * std::sin(view.at("latitude_rad").get<double>()), 1e-9);
  }
  expect_failure(run_program(nbv({"--poi", "0,0,0", "--up", "0,0,0"})), 2, "nbv", {"--up"});
}

TEST_F(Nbv, SaysWhenNothingCanBeSeen) {
  const Outcome outcome = run_program(nbv({"--poi", "40,40,40"}));
  EXPECT_EQ(outcome.status, 5);
  EXPECT_NE(outcome.err.find("every gain is 0"), std::string::npos) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);
}

TEST_F(Nbv, RefusesBadOptions) {
  expect_failure(run_program(nbv({})), 2, "nbv", {"--poi", "--box"});
  expect_failure(run_program(nbv({"--poi", "1,2"})), 2, "nbv", {"--poi", "3 numbers"});
  expect_failure(run_program(nbv({"--poi", "1,2,nan"})), 2, "nbv", {"--poi", "nan"});
  expect_failure(run_program(nbv({"--poi", "0,0,0", "--radius", "0"})), 2, "nbv", {"--radius", "positive"});
  expect_failure(run_program(nbv({"--poi", "0,0,0", "--radius", "-0.2"})), 2, "nbv", {"--radius", "positive"});
  expect_failure(run_program(nbv({"--poi", "0,0,0", "--distance", "0"})), 2, "nbv", {"--distance"});
  expect_failure(run_program(nbv({"--poi", "0,0,0", "--camera", "eye"})), 2, "nbv", {"--camera", "kinect-v1"});
  expect_failure(run_program(nbv({"--poi", "0,0,0", "--tilt", "-3"})), 2, "nbv", {"tilt"});
  expect_failure(run_program(nbv({"--box", "0,0,0,1,1,0"})), 2, "nbv", {"--box"});
  expect_failure(run_program(nbv({"--poi", "0,0,0", "--top", "0"})), 2, "nbv", {"--top"});
  expect_failure(run_program(nbv({"--poi", "0,0,0", "--top=-1"})), 2, "nbv", {"--top", "whole number", "'-1'"});
  expect_failure(run_program(nbv({"--poi", "0,0,0", "--out", ""})), 2, "nbv", {"--out", "empty"});
  expect_failure(run_program(nbv({"--poi", "0,0,0", "--image-size", "0,10"})), 2, "nbv", {"--image-size"});
}

TEST_F(Nbv, RefusesBadFiles) {
  const Arguments poi{"--poi", "0,0,0.05", "--quiet"};
  const auto nbv_of = [&](const fs::path& file, const Arguments& more = {}) {
    return run_program(Arguments{"nbv", file.string()} + poi + more);
  };
  expect_failure(nbv_of(folder_ / "none.sacmap"), 3, "nbv", {"none.sacmap"});
  expect_failure(nbv_of(folder_.write("other.sacmap", "something else")), 3, "nbv", {"not a Saccade map"});
  const std::string whole = text_of(map());
  expect_failure(nbv_of(folder_.write("cut.sacmap", whole.substr(0, whole.size() / 2))), 3, "nbv",
                 {"cut.sacmap", "byte"});
  std::string damaged = whole;
  damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 0x40);
  expect_failure(nbv_of(folder_.write("damaged.sacmap", damaged)), 3, "nbv", {"damaged.sacmap", "checksum"});
  expect_failure(nbv_of(map(), {"--poses", (folder_ / "none.txt").string()}), 3, "nbv", {"none.txt"});
  const fs::path mirror = folder_.write("mirror.txt", "1 0 0 0\n0 1 0 0\n0 0 -1 0\n0 0 0 1\n");
  expect_failure(nbv_of(map(), {"--poses", mirror.string()}), 3, "nbv", {"mirror.txt"});
  const fs::path nan = folder_.write("nan.txt", "1 0 0 nan\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  expect_failure(nbv_of(map(), {"--poses", nan.string()}), 3, "nbv", {"nan.txt"});
  const fs::path below_file = map() / "views";
  expect_failure(nbv_of(map(), {"--out", below_file.string()}), 3, "nbv", {below_file.string()});
}

TEST_F(Nbv, TheBackEndIsChosenOrItsLackIsSaid) {
  const Arguments region{"--poi", "0,0,0.05", "--forget", "--json", "-"};
  const Outcome on_cpu = run_program(nbv(region + Arguments{"--backend", "cpu"}));
  const Outcome automatic = run_program(nbv(region + Arguments{"--backend", "auto"}));
  ASSERT_EQ(automatic.status, 0) << automatic.err;
  EXPECT_EQ(automatic.json().at("result").at("views"), on_cpu.json().at("result").at("views"));
  const Outcome info = run_program({"info", "--json", "-"});
  const Outcome on_gpu = run_program(nbv(region + Arguments{"--backend", "cuda"}));
  if (info.json().at("result").at("backends").at("cuda")) {
    EXPECT_EQ(on_gpu.json().at("result").at("views"), on_cpu.json().at("result").at("views"));
    return;
  }
  const std::string why = info.json().at("result").at("cuda").at("absent_because");
  expect_failure(on_gpu, 4, "nbv", {why});
  EXPECT_NE(run_program({"info"}).out.find("absent: " + why), std::string::npos);
}

TEST_F(Nbv, InfoDescribesTheProgramTheMapAndTheRun) {
  const Outcome program = run_program({"info", "--json", "-"});
  ASSERT_EQ(program.status, 0) << program.err;
  expect_envelope(program.json(), "info");
  EXPECT_TRUE(program.json().at("result").at("backends").at("sequential"));
  const bool has_gpu = program.json().at("result").at("backends").at("cuda");
  EXPECT_EQ(program.json().at("result").at("cuda").contains("absent_because"), !has_gpu);
  EXPECT_NE(run_program({"info"}).out.find("eigen 3."), std::string::npos);
  const Outcome of_map = run_program({"info", map().string(), "--json", "-"});
  ASSERT_EQ(of_map.status, 0) << of_map.err;
  EXPECT_GT(of_map.json().at("result").at("map").at("occupied_voxels").get<int>(), 100);
  const Outcome of_run = run_program({"info", (folder_ / "run").string()});
  EXPECT_EQ(of_run.status, 0) << of_run.err;
  EXPECT_NE(of_run.out.find("10.00 mm"), std::string::npos) << of_run.out;
  const Outcome of_frames = run_program({"info", (folder_ / "frames").string(), "--json", "-"});
  ASSERT_EQ(of_frames.status, 0) << of_frames.err;
  EXPECT_EQ(of_frames.json().at("result").at("kind"), "frames");
  EXPECT_EQ(of_frames.json().at("result").at("frames").at("layout"), "seven-scenes");
}

TEST(Sample, IsSeededAndKeepsOtherFiles) {
  const TempFolder folder;
  const auto sample = [&](const std::string& name, const std::string& seed) {
    const Outcome outcome = run_program({"sample", "--out", (folder / name).string(), "--frames", "2", "--noise",
                                         "--seed", seed, "--image-size", "80,60", "--quiet"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return text_of(folder / name / "frame-000001.depth.png");
  };
  const std::string first = sample("a", "1");
  EXPECT_FALSE(first.empty());
  EXPECT_TRUE(first == sample("b", "1"));
  EXPECT_FALSE(first == sample("c", "2"));
  EXPECT_EQ(names_in(folder / "a").size(), 7U);
  folder.write("mine/notes.txt", "keep");
  expect_failure(run_program({"sample", "--out", (folder / "mine").string()}), 3, "sample", {"other files"});
  expect_failure(run_program({"sample", "--out", (folder / "d").string(), "--frames", "0"}), 2, "sample", {"--frames"});
}

TEST(Program, ResultsThatCannotBePrintedAreAFailure) {
  const std::string command = std::string{saccade_program()} + " info > /dev/full 2> /dev/null";
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 3);
}

TEST(Program, UsageErrorsAreOneLine) {
  const Outcome nothing = run_program({});
  EXPECT_EQ(nothing.status, 2);
  EXPECT_EQ(std::count(nothing.err.begin(), nothing.err.end(), '\n'), 1) << nothing.err;
  expect_failure(run_program({"fuse"}), 2, "fuse", {"see saccade fuse --help"});
  EXPECT_EQ(run_program({"dance"}).status, 2);
  EXPECT_EQ(run_program({"info", "--threads", "-1"}).status, 2);
  for (const std::string seed : {"--seed=-1", "--seed=1e3", "--seed=1.5", "--seed=18446744073709551616"}) {
    expect_failure(run_program({"info", seed}), 2, "info", {"--seed", "whole number"});
  }
  EXPECT_EQ(run_program({"info", "--seed=18446744073709551615"}).status, 0);
  expect_failure(run_program({"info", "--json", ""}), 2, "info", {"--json", "empty"});
  expect_failure(run_program({"info", ""}), 2, "info", {"subject", "empty"});
  expect_failure(run_program({"scene", "render", "", "--out", "x.png"}), 2, "scene", {"scene", "empty"});
  EXPECT_EQ(run_program({"--version"}).status, 0);
  const Outcome help = run_program({"--help"});
  EXPECT_EQ(help.status, 0);
  for (const char* part : {"fuse", "nbv", "info", "sample", "Exit status"}) {
    EXPECT_NE(help.out.find(part), std::string::npos) << part;
  }
}

}  // namespace
}  // namespace saccade::test
