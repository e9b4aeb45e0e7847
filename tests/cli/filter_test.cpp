// SPDX-License-Identifier: Apache-2.0
// saccade filter as a user runs it, on rendered frames of the size of a Kinect v2's and on what is none.
#include <gtest/gtest.h>

#include <map>

#include "cli/run_program.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/sensor/analytic_scene.hpp"
#include "saccade/sensor/kinect_v2_filter.hpp"
#include "saccade/sensor/mask.hpp"
#include "saccade/sensor/noise.hpp"
#include "support/depth_files.hpp"

namespace saccade::test {
namespace {

constexpr int kFrames{3};

class Filter : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "frames");
    const std::vector<Pose> T_world_camera = sample_trajectory(kFrames);
    for (int i = 0; i < kFrames; ++i) {
      const auto seen = render(sample_tabletop(), camera_, T_world_camera[static_cast<std::size_t>(i)]);
      ASSERT_TRUE(seen);
      ASSERT_TRUE(write_png16(frame(i), encode_depth(with_noise(seen->depth, DepthNoise{}), {})));
    }
  }
  [[nodiscard]] fs::path frames() const { return folder_ / "frames"; }
  [[nodiscard]] fs::path frame(int i) const { return frames() / name(i); }
  [[nodiscard]] static std::string name(int i) { return "depth-" + std::to_string(i) + ".png"; }
  [[nodiscard]] fs::path out() const { return folder_ / "out"; }
  [[nodiscard]] Arguments filter(const Arguments& more = {}) const {
    return Arguments{"filter", frames().string(), "--out", out().string(), "--quiet"} + more;
  }
  const PinholeCamera camera_{camera_preset("kinect-v2").value()};
  TempFolder folder_;
};

TEST_F(Filter, RemovesWhatTheLibraryRemoves) {
  const std::string untouched = text_of(frame(0));
  const Outcome outcome = run_program(filter({"--json", "-", "--pictures", "2"}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expect_envelope(outcome.json(), "filter");
  const nlohmann::json result = outcome.json().at("result");
  EXPECT_EQ(nlohmann::json::parse(text_of(out() / "filter.json")), outcome.json());
  EXPECT_EQ(result.at("frames"), kFrames);
  EXPECT_TRUE(result.at("ms_per_frame").at("median").is_number());
  const DepthFilter library = DepthFilter::create(camera_).value();
  std::size_t points{0};
  std::size_t shadow_points{0};
  std::size_t veil_points{0};
  for (int i = 0; i < kFrames; ++i) {
    DepthImage depth = decode_depth(read_png16(frame(i)).value(), {});
    FilteredDepth expected = library.filter(depth).value();
    clip_to_range(camera_, expected.depth);
    EXPECT_EQ(decode_depth(read_png16(out() / name(i)).value(), {}), expected.depth);
    clip_to_range(camera_, depth);
    std::map<FilteredPixel, std::size_t> within;  // points in the camera's range
    for (std::size_t p = 0; p < depth.size(); ++p) {
      if (depth.pixels()[p] > 0.0F) within[expected.pixels.pixels()[p]] += 1;
    }
    EXPECT_EQ(result.at("details").at(static_cast<std::size_t>(i)).at("shadow"), within[FilteredPixel::shadow_point]);
    for (const auto& [kind, count] : within) points += count;
    shadow_points += within[FilteredPixel::shadow_point];
    veil_points += within[FilteredPixel::veil_point];
  }
  EXPECT_EQ(result.at("points"), points);
  EXPECT_EQ(result.at("shadow"), shadow_points);
  EXPECT_EQ(result.at("veil"), veil_points);
  EXPECT_GT(shadow_points, 1000U);
  EXPECT_GT(veil_points, 100U);
  EXPECT_EQ(names_in(out() / "pictures"), (std::vector<std::string>{name(0), name(1)}));
  EXPECT_GE(read_color(out() / "pictures" / name(0)).value().width(), 3 * 512);
  EXPECT_EQ(text_of(frame(0)), untouched);
}

TEST_F(Filter, PrintsCountsForPeopleAndIsTheSameForEveryThreadCount) {
  const Outcome one = run_program(filter({"--threads", "1"}));
  ASSERT_EQ(one.status, 0) << one.err;
  for (const char* part : {"3 filtered, 0 left out", "shadow ", "veil ", " ms (median"}) {
    EXPECT_NE(one.out.find(part), std::string::npos) << part << one.out;
  }
  const std::string first = text_of(out() / name(0));
  ASSERT_EQ(run_program(filter({"--threads", "3"})).status, 0);  // into the folder of the earlier run
  EXPECT_TRUE(text_of(out() / name(0)) == first);
}

TEST_F(Filter, DoesOneStepAndTakesTheOtherSide) {
  const auto result_with = [&](const Arguments& more) {
    const Outcome outcome = run_program(filter({"--json", "-", "--pictures", "0"}) + more);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.json().at("result");
  };
  const nlohmann::json left = result_with({"--only", "shadow"});
  EXPECT_GT(left.at("shadow"), 0);
  EXPECT_EQ(left.at("veil"), 0);
  const nlohmann::json right = result_with({"--only", "shadow", "--emitter", "right"});
  EXPECT_EQ(right.at("emitter_side"), "right");
  EXPECT_NE(right.at("shadow"), left.at("shadow"));
  EXPECT_LT(result_with({"--only", "shadow", "--baseline", "0.04"}).at("shadow"), left.at("shadow"));
  const nlohmann::json veil = result_with({"--only", "veil"});
  EXPECT_EQ(veil.at("shadow"), 0);
  EXPECT_LT(result_with({"--only", "veil", "--veil-angle", "2"}).at("veil"), veil.at("veil"));
  EXPECT_GT(result_with({"--max-range", "0.9"}).at("out_of_range"), 10000);
  EXPECT_FALSE(fs::exists(out() / "pictures"));
}

TEST_F(Filter, HasTheMethodOfTheThesisToo) {
  const Outcome surface = run_program(filter({"--json", "-", "--pictures", "0"}));
  const Outcome thesis = run_program(filter({"--json", "-", "--pictures", "0", "--method", "thesis"}));
  ASSERT_EQ(thesis.status, 0) << thesis.err;
  EXPECT_EQ(surface.json().at("result").at("method"), "surface");
  EXPECT_EQ(thesis.json().at("result").at("method"), "thesis");
  const DepthFilter library = DepthFilter::create(camera_, {.method = DepthFilterMethod::thesis}).value();
  DepthImage expected = library.filter(decode_depth(read_png16(frame(0)).value(), {})).value().depth;
  clip_to_range(camera_, expected);
  EXPECT_EQ(decode_depth(read_png16(out() / name(0)).value(), {}), expected);
  EXPECT_GT(thesis.json().at("result").at("veil"), surface.json().at("result").at("veil"));
}

TEST_F(Filter, WhatIsTooNearThrowsItsShadow) {
  ASSERT_EQ(run_program(filter({"--pictures", "0", "--min-range", "0.9"})).status, 0);
  PinholeCamera farther = camera_;
  farther.min_range_m = 0.9;
  const DepthFilter library = DepthFilter::create(farther).value();
  const DepthImage whole = decode_depth(read_png16(frame(0)).value(), {});
  DepthImage expected = library.filter(whole).value().depth;
  clip_to_range(farther, expected);
  EXPECT_EQ(decode_depth(read_png16(out() / name(0)).value(), {}), expected);
  DepthImage clipped = whole;
  clip_to_range(farther, clipped);
  EXPECT_NE(library.filter(clipped).value().depth, expected);
}

TEST_F(Filter, NeverReplacesAFrameByAnotherName) {
  fs::create_directories(folder_ / "links");
  fs::create_symlink(frame(1), folder_ / "links" / name(1));
  expect_failure(
      run_program({"filter", (folder_ / "links").string(), "--out", frames().string(), "--quiet", "--force"}), 3,
      "filter", {"would replace the frames"});
}

TEST_F(Filter, LeavesNothingOfAnEarlierRun) {
  ASSERT_EQ(run_program(filter({"--pictures", "3"})).status, 0);
  std::ofstream{out() / "notes.txt"} << "mine";
  const Arguments one{"filter", frame(1).string(), "--out", out().string(), "--quiet", "--pictures", "0"};
  ASSERT_EQ(run_program(one).status, 0);
  EXPECT_EQ(names_in(out()),
            (std::vector<std::string>{name(1), "filter.json", "notes.txt", "pictures", "report.html"}));
  EXPECT_TRUE(names_in(out() / "pictures").empty());
}

TEST_F(Filter, LeavesOutWhatIsNoDepthImage) {
  ASSERT_TRUE(write_png(frames() / "color.png", ColorImage{512, 424}));
  std::ofstream{frames() / "broken.png"} << "no image";
  std::ofstream{frames() / "notes.txt"} << "no image";
  ASSERT_TRUE(write_png16(frames() / "small.png", Image16{320, 240, 1000}));
  const Outcome outcome = run_program(filter({"--json", "-"}));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.json().at("result").at("frames"), kFrames);
  EXPECT_EQ(outcome.json().at("result").at("left_out").size(), 3U);
  const auto of_file = [&](const char* file) {
    return run_program({"filter", (frames() / file).string(), "--out", (folder_ / "alone").string(), "--quiet"});
  };
  expect_failure(of_file("broken.png"), 3, "filter", {"broken.png"});
  expect_failure(of_file("color.png"), 3, "filter", {"color.png"});
  expect_failure(of_file("small.png"), 3, "filter", {"small.png", "320x240", "512x424", "--intrinsics"});
  expect_failure(of_file("missing.png"), 3, "filter", {"missing.png"});
  EXPECT_FALSE(fs::exists(folder_ / "alone"));
}

TEST_F(Filter, TakesDepthInOtherFormats) {
  ASSERT_EQ(run_program(filter()).status, 0);
  const Image16 expected = read_png16(out() / name(0)).value();
  const Image16 samples = read_png16(frame(0)).value();
  std::vector<float> metres;
  std::string big_endian;
  for (const std::uint16_t sample : samples.pixels()) {
    metres.push_back(static_cast<float>(sample) / 1000.0F);
    big_endian += {static_cast<char>(sample >> 8U), static_cast<char>(sample & 255U)};
  }
  const fs::path others = folder_ / "others";
  fs::create_directories(others);
  std::ofstream{others / "a.tif"} << make_tiff(512, 424, 32, 3, bytes_of_values(metres));
  std::ofstream{others / "b.npy"} << make_npy("<f4", "(424, 512)", bytes_of_values(metres));
  std::ofstream{others / "c.pgm"} << "P5 512 424 65535\n" << big_endian;
  const Arguments all{"filter", others.string(), "--out", out().string(), "--quiet", "--no-pictures", "--force"};
  ASSERT_EQ(run_program(all).status, 0);
  EXPECT_EQ(names_in(out()),
            (std::vector<std::string>{"a.png", "b.png", "c.png", "filter.json", "pictures", "report.html"}));
  for (const char* file : {"a.png", "b.png", "c.png"}) EXPECT_EQ(read_png16(out() / file).value(), expected) << file;
  fs::copy_file(others / "b.npy", others / "a.npy");
  expect_failure(run_program(all), 3, "filter", {"two of the frames have this name", "a.png"});
}

TEST_F(Filter, TakesImagesOfAnySizeWithIntrinsics) {
  ASSERT_TRUE(write_png16(folder_ / "small.png", Image16{320, 240, 65535}));
  Image16 samples{320, 240, 1000};
  samples(7, 9) = 65535;
  ASSERT_TRUE(write_png16(folder_ / "small.png", samples));
  const Outcome outcome = run_program({"filter", (folder_ / "small.png").string(), "--out", out().string(),
                                       "--intrinsics", "250,250,160,120", "--json", "-"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.json().at("result").at("points"), 320 * 240 - 1);
  EXPECT_EQ(read_png16(out() / "small.png").value(), samples);
}

TEST_F(Filter, NeverReplacesItsInput) {
  const Arguments onto_itself{"filter", frames().string(), "--out", frames().string(), "--force"};
  expect_failure(run_program(onto_itself), 3, "filter", {"would replace the frames"});
  expect_failure(run_program({"filter", frame(0).string(), frame(0).string(), "--out", out().string()}), 3, "filter",
                 {name(0), "two"});
  expect_failure(run_program({"filter", frames().string(), "--out", folder_.path().string()}), 3, "filter",
                 {"other files"});
  EXPECT_EQ(names_in(frames()).size(), static_cast<std::size_t>(kFrames));
}

TEST_F(Filter, SaysWhenThereIsNothingToFilter) {
  fs::create_directories(folder_ / "empty");
  expect_failure(run_program({"filter", (folder_ / "empty").string(), "--out", out().string()}), 3, "filter",
                 {"no depth images"});
  ASSERT_TRUE(write_png16(folder_ / "dark.png", Image16{512, 424}));
  expect_failure(run_program({"filter", (folder_ / "dark.png").string(), "--out", out().string(), "--quiet"}), 5,
                 "filter", {"--depth-scale"});
}

TEST_F(Filter, UsageErrorsAreOneLine) {
  expect_failure(run_program({"filter", frames().string()}), 2, "filter", {"--out"});
  expect_failure(run_program(filter({"--baseline", "-0.08"})), 2, "filter", {"--baseline"});
  expect_failure(run_program(filter({"--veil-angle", "90"})), 2, "filter", {"--veil-angle"});
  expect_failure(run_program(filter({"--method", "median"})), 2, "filter", {"--method", "surface or thesis"});
  expect_failure(run_program(filter({"--emitter", "above"})), 2, "filter", {"--emitter", "left or right"});
  expect_failure(run_program(filter({"--only", "both"})), 2, "filter", {"--only"});
  expect_failure(run_program(filter({"--depth-scale", "0"})), 2, "filter", {"--depth-scale"});
  expect_failure(run_program(filter({"--camera", "eye"})), 2, "filter", {"--camera"});
}

TEST_F(Filter, KeepsWhatIsDoneWhenInterrupted) {
  for (int i = kFrames; i < 400; ++i) fs::copy_file(frame(i % kFrames), frame(i));
  RunningProgram program{{"filter", frames().string(), "--out", out().string(), "--quiet"}};
  ASSERT_TRUE(wait_for_file(out() / name(1)));
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_NE(outcome.err.find("interrupted after "), std::string::npos) << outcome.err;
  const nlohmann::json result = nlohmann::json::parse(text_of(out() / "filter.json")).at("result");
  EXPECT_EQ(result.at("interrupted"), true);
  EXPECT_LT(result.at("frames"), 400);
  EXPECT_EQ(names_in(out()).size(), result.at("frames").get<std::size_t>() + 3);  // filter.json, pictures, report.html
}

TEST_F(Filter, TakesTheDepthImagesOfARecordingAndItsCamera) {
  const fs::path recording = folder_ / "recording";
  fs::create_directories(recording);
  for (int i = 0; i < 2; ++i) {
    const std::string stem = "frame-00000" + std::to_string(i);
    fs::copy_file(frame(i), recording / (stem + ".depth.png"));
    ASSERT_TRUE(write_png16(recording / (stem + ".label.png"), Image16{512, 424, 1000}));
    ASSERT_TRUE(write_png(recording / (stem + ".color.png"), ColorImage{512, 424}));
  }
  (void)folder_.write("recording/camera.json",
                      R"({"width": 512, "height": 424, "fx": 300, "fy": 300, "cx": 256, "cy": 212,
                          "min_range_m": 0.5, "max_range_m": 4.5})");
  const Outcome outcome = run_program({"filter", recording.string(), "--out", out().string(), "--no-pictures"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const char* part : {"layout seven-scenes", "2 depth images", "camera.json"}) {
    EXPECT_NE(outcome.err.find(part), std::string::npos) << part << outcome.err;
  }
  EXPECT_EQ(names_in(out()), (std::vector<std::string>{"filter.json", "frame-000000.depth.png",
                                                       "frame-000001.depth.png", "report.html"}));
  PinholeCamera wide = camera_;
  wide.fx = wide.fy = 300.0;
  wide.cx = 256.0;
  wide.cy = 212.0;
  wide.min_range_m = 0.5;
  wide.max_range_m = 4.5;
  DepthImage expected =
      DepthFilter::create(wide).value().filter(decode_depth(read_png16(frame(0)).value(), {})).value().depth;
  clip_to_range(wide, expected);
  EXPECT_EQ(decode_depth(read_png16(out() / "frame-000000.depth.png").value(), {}), expected);
}

TEST_F(Filter, SaysThatItIsForAKinect) {
  const fs::path file = folder_ / "other.png";
  ASSERT_TRUE(write_png16(file, Image16{640, 480, 1000}));
  const auto notes_with = [&](const Arguments& more) {
    const Outcome outcome = run_program(
        Arguments{"filter", file.string(), "--out", out().string(), "--no-pictures", "--camera", "kinect-v1"} + more);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.err;
  };
  EXPECT_NE(notes_with({}).find("640x480 pixels, a Kinect v2 512x424"), std::string::npos);
  EXPECT_EQ(notes_with({"--baseline", "0.075"}).find("Kinect v2"), std::string::npos);
}

TEST_F(Filter, LeavesOutLabelsColoursAndMasksByTheirNames) {
  for (const char* other : {"depth-0.label.png", "depth-0.color.png", "mask.png"}) {
    ASSERT_TRUE(write_png16(frames() / other, Image16{512, 424, 1000}));
  }
  const Outcome outcome = run_program({"filter", frames().string(), "--out", out().string(), "--no-pictures"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("3 images are left out: depth-0.color.png"), std::string::npos) << outcome.err;
  EXPECT_EQ(names_in(out()).size(), kFrames + 2U);  // filter.json, report.html
}

TEST_F(Filter, MayBeRunAgainAfterAFailure) {
  const std::string whole = text_of(frame(1));
  (void)folder_.write("frames/" + name(1), whole.substr(0, whole.size() / 2));
  const Arguments both{"filter",       frame(0).string(), frame(1).string(), "--out",
                       out().string(), "--quiet",         "--no-pictures"};
  expect_failure(run_program(both), 3, "filter", {name(1), "filtered before it (1 frame)"});
  EXPECT_EQ(nlohmann::json::parse(text_of(out() / "filter.json")).at("result").at("complete"), false);
  const Outcome info = run_program({"info", out().string()});
  EXPECT_NE(info.out.find("incomplete"), std::string::npos) << info.out << info.err;
  (void)folder_.write("frames/" + name(1), whole);
  const Outcome again = run_program(both);
  ASSERT_EQ(again.status, 0) << again.err;
  const nlohmann::json result = nlohmann::json::parse(text_of(out() / "filter.json")).at("result");
  EXPECT_EQ(result.at("complete"), true);
  EXPECT_TRUE(result.at("planned").empty());
  EXPECT_EQ(names_in(out()), (std::vector<std::string>{name(0), name(1), "filter.json", "report.html"}));
}

TEST_F(Filter, WarnsWhereNearlyAllIsOutOfRange) {
  Image16 samples{512, 424, 100};
  for (int v = 200; v < 220; ++v) std::fill_n(samples.row(v) + 240, 20, std::uint16_t{1000});
  ASSERT_TRUE(write_png16(folder_ / "tenths.png", samples));
  const Outcome outcome =
      run_program({"filter", (folder_ / "tenths.png").string(), "--out", out().string(), "--quiet"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("99.8 % of the measured pixels"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("--depth-scale"), std::string::npos) << outcome.err;
  EXPECT_EQ(run_program(filter({"--no-pictures", "--force"})).err, "");
}

TEST_F(Filter, WarnsOnceOfAPrincipalPointFarOutside) {
  const Outcome outcome = run_program(filter({"--intrinsics", "365,365,-5000,212", "--no-pictures"}));
  EXPECT_NE(outcome.err.find("the principal point lies 9.8 image widths outside"), std::string::npos) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
}

}  // namespace
}  // namespace saccade::test
