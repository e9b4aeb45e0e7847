// SPDX-License-Identifier: Apache-2.0
// saccade surfels as a user runs it: clouds, JSON, tracking, threads, what goes wrong, interrupting.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cli/run_program.hpp"
#include "saccade/io/clouds/cloud_io.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "saccade/sensor/srgb.hpp"

namespace saccade::test {
namespace {

class Surfels : public ::testing::Test {
 protected:
  void SetUp() override { make_sample(frames(), 12); }
  [[nodiscard]] fs::path frames() const { return folder_ / "frames"; }
  [[nodiscard]] Arguments surfels(const std::string& out, const Arguments& more = {}) const {
    return Arguments{"surfels", frames().string(), "--out", (folder_ / out).string(), "--quiet"} + more;
  }
  [[nodiscard]] nlohmann::json result(const std::string& out, const Arguments& more = {},
                                      const std::string& warning = "") const {
    const Outcome outcome = run_program(surfels(out, more + Arguments{"--json", "-"}));
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err.empty(), warning.empty()) << outcome.err;
    EXPECT_NE(outcome.err.find(warning), std::string::npos) << outcome.err;
    expect_envelope(outcome.json(), "surfels");
    return outcome.json().at("result");
  }
  [[nodiscard]] PointCloud cloud(const std::string& name) const {
    const CloudFile file = read_cloud(folder_ / name).value();
    for (const char* field : {"radius", "confidence"}) {
      const Column* column = file.fields().find(field);
      EXPECT_NE(column, nullptr) << field;
      for (std::size_t i = 0; column != nullptr && i < file.fields().rows; ++i) EXPECT_GT(column->value(i), 0.0);
    }
    return cloud_from_fields(file.fields()).value();
  }
  TempFolder folder_;
};

TEST_F(Surfels, BothGivesTheModesAndTheAverages) {
  const nlohmann::json both = result("cloud.ply", {"--mode-filter", "both", "--places", "modes"});
  EXPECT_EQ(both.at("frames"), 12);
  EXPECT_EQ(both.at("frames_without_color"), 0);
  EXPECT_EQ(both.at("mode_filter"), "both");
  EXPECT_EQ(both.at("tracking"), "forced");
  EXPECT_EQ(both.at("interrupted"), false);
  EXPECT_TRUE(both.at("skipped").empty());
  const auto surfels = both.at("surfels").get<std::size_t>();
  EXPECT_GT(surfels, 10000U);
  const nlohmann::json& ms = both.at("ms_per_frame");
  for (const char* phase : {"associate", "guided_filter", "integrate"}) {
    EXPECT_GT(ms.at(phase).at("median").get<double>(), 0.0) << phase;
    EXPECT_LT(ms.at(phase).at("median").get<double>(), ms.at("total").at("median").get<double>()) << phase;
  }
  EXPECT_GT(both.at("peak_rss_bytes").get<std::size_t>(), std::size_t{1} << 20U);
  EXPECT_LT(both.at("bytes_per_surfel").at("map").get<double>(), 60.0);
  EXPECT_EQ(names_in(folder_.path()), (std::vector<std::string>{"cloud.average.ply", "cloud.ply", "frames"}));
  EXPECT_EQ(both.at("average_out"), (folder_ / "cloud.average.ply").string());

  const auto written = both.at("written").get<std::size_t>();
  EXPECT_LE(written, surfels);
  EXPECT_GT(written, surfels / 2);
  const PointCloud modes = cloud("cloud.ply");
  const PointCloud averages = cloud("cloud.average.ply");
  ASSERT_EQ(modes.positions_m.size(), written);
  ASSERT_EQ(averages.positions_m.size(), written);
  ASSERT_EQ(modes.normals.size(), written);
  std::size_t other_color{0};
  for (std::size_t i = 0; i < written; ++i) {
    ASSERT_LT((modes.positions_m[i] - averages.positions_m[i]).norm(), 0.05F);
    ASSERT_EQ(modes.normals[i], averages.normals[i]);
    ASSERT_NEAR(modes.normals[i].norm(), 1.0F, 1e-4F);
    other_color += modes.colors[i] != averages.colors[i] ? 1U : 0U;
  }
  EXPECT_GT(other_color, surfels / 50);

  // One alone is what both give.
  EXPECT_EQ(result("on.ply", {"--places", "modes"}).at("surfels"), surfels);
  EXPECT_TRUE(text_of(folder_ / "on.ply") == text_of(folder_ / "cloud.ply"));
  EXPECT_EQ(result("off.ply", {"--mode-filter", "off"}).at("ms_per_frame").at("guided_filter").at("median"), 0.0);
  EXPECT_TRUE(text_of(folder_ / "off.ply") == text_of(folder_ / "cloud.average.ply"));
}

TEST_F(Surfels, WhatWasSeenTooLittleIsNotWritten) {
  const auto written = [&](const Arguments& least) {
    return result("cloud.ply", Arguments{"--mode-filter", "both"} + least);
  };
  const nlohmann::json all = written({"--min-confidence", "0"});
  EXPECT_EQ(all.at("written"), all.at("surfels"));
  const PointCloud whole = cloud("cloud.ply");
  EXPECT_EQ(whole.positions_m.size(), all.at("surfels").get<std::size_t>());

  const nlohmann::json some = written({"--min-confidence", "4"});
  EXPECT_EQ(some.at("surfels"), all.at("surfels"));
  EXPECT_EQ(some.at("min_confidence"), 4.0);
  const auto count = some.at("written").get<std::size_t>();
  EXPECT_LT(count, all.at("surfels").get<std::size_t>());
  EXPECT_GT(count, 1000U);
  for (const char* name : {"cloud.ply", "cloud.average.ply"}) {
    const CloudFile file = read_cloud(folder_ / name).value();
    ASSERT_EQ(file.fields().rows, count) << name;
    for (std::size_t i = 0; i < count; ++i) ASSERT_GE(file.fields().find("confidence")->value(i), 4.0);
  }
  EXPECT_DOUBLE_EQ(written({}).at("min_confidence").get<double>(), 0.05 * 12) << "a twentieth of few frames";

  fs::remove(folder_ / "cloud.ply");
  fs::remove(folder_ / "cloud.average.ply");
  expect_failure(run_program(surfels("cloud.ply", {"--min-confidence", "1000"})), 5, "surfels",
                 {"1000", "the greatest is", "--min-confidence", "nothing was written"});
  EXPECT_EQ(names_in(folder_.path()), std::vector<std::string>{"frames"});
}

TEST_F(Surfels, ThePictureShowsAveragesAndModesSideBySide) {
  const std::string picture = (folder_ / "cloud.png").string();
  EXPECT_EQ(result("cloud.ply", {"--picture", picture}).at("picture"), picture);
  const ColorImage one = read_color(picture).value();
  EXPECT_EQ(result("cloud.ply", {"--picture", picture, "--mode-filter", "both"}).at("picture"), picture);
  const ColorImage two = read_color(picture).value();
  EXPECT_EQ(two.height(), one.height());
  EXPECT_GT(two.width(), one.width() + 150);
  expect_failure(run_program(surfels("cloud.ply", {"--picture", "cloud.jpg"})), 2, "surfels", {"--picture", ".png"});
}

TEST_F(Surfels, PcdHoldsTheSame) {
  EXPECT_EQ(result("cloud.ply").at("frames"), 12);
  EXPECT_EQ(result("cloud.pcd").at("frames"), 12);
  const PointCloud ply = cloud("cloud.ply");
  const PointCloud pcd = cloud("cloud.pcd");
  ASSERT_GT(ply.positions_m.size(), 10000U);
  EXPECT_EQ(ply.positions_m, pcd.positions_m);
  EXPECT_EQ(ply.normals, pcd.normals);
  EXPECT_EQ(ply.colors, pcd.colors);
}

TEST_F(Surfels, ThreadsDoNotChangeTheCloud) {
  EXPECT_EQ(result("one.ply", {"--threads", "1"}).at("frames"), 12);
  EXPECT_EQ(result("four.ply", {"--threads", "4"}).at("frames"), 12);
  EXPECT_TRUE(text_of(folder_ / "one.ply") == text_of(folder_ / "four.ply"));
}

TEST_F(Surfels, TracksWhereThereAreNoPoses) {
  for (const std::string& name : names_in(frames())) {
    if (name.ends_with(".pose.txt")) fs::remove(frames() / name);
  }
  const nlohmann::json tracked = result("cloud.ply", {"--count", "5"});
  EXPECT_EQ(tracked.at("tracking"), "icp");
  EXPECT_EQ(tracked.at("frames"), 5);
  EXPECT_GT(tracked.at("surfels").get<int>(), 10000);
  expect_failure(run_program(surfels("cloud.ply", {"--tracking", "forced"})), 3, "surfels",
                 {"no camera poses", "--poses", "icp"});
}

TEST_F(Surfels, TheImageSigmaReachesTheWeights) {
  const auto confidence = [&](const char* sigma) {
    EXPECT_EQ(result("cloud.ply", {"--image-sigma", sigma}).at("image_sigma"), std::stod(sigma));
    const CloudFile file = read_cloud(folder_ / "cloud.ply").value();
    double sum{0.0};
    for (std::size_t i = 0; i < file.fields().rows; ++i) sum += file.fields().find("confidence")->value(i);
    return sum;
  };
  EXPECT_LT(confidence("0.1"), 0.6 * confidence("0.3"));
}

/// Averages and modes are at the same places unless those of the modes are asked for, which guided depths move.
TEST_F(Surfels, PlacesAreThoseOfTheAverage) {
  const auto xs = [&](const char* name) {
    const CloudFile file = read_cloud(folder_ / name).value();
    std::vector<double> values;
    for (std::size_t i = 0; i < file.fields().rows; ++i) values.push_back(file.fields().find("x")->value(i));
    return values;
  };
  const nlohmann::json average = result("cloud.ply", {"--mode-filter", "both"});
  EXPECT_EQ(average.at("places"), "average");
  EXPECT_EQ(average.at("ms_per_frame").at("guided_filter").at("median"), 0.0);
  EXPECT_EQ(xs("cloud.ply"), xs("cloud.average.ply"));
  const nlohmann::json modes = result("modes.ply", {"--places", "modes"});
  EXPECT_EQ(modes.at("places"), "modes");
  EXPECT_GT(modes.at("ms_per_frame").at("guided_filter").at("median"), 0.0);
  EXPECT_NE(xs("modes.ply"), xs("cloud.ply"));
}

/// With eq. 4.11 as printed some surfels are other than where their modes are densest.
TEST_F(Surfels, TheChoiceOfModesIsOurs) {
  EXPECT_EQ(result("sharpened.ply", {}).at("choice"), "sharpened");
  EXPECT_EQ(result("densest.ply", {"--choice", "densest"}).at("choice"), "densest");
  EXPECT_EQ(result("heaviest.ply", {"--choice", "heaviest", "--max-depth-change", "inf"}).at("choice"), "heaviest");
  EXPECT_EQ(result("places.ply", {"--choice", "heaviest"}).at("places"), "modes");
  EXPECT_NE(text_of(folder_ / "densest.ply"), text_of(folder_ / "heaviest.ply"));
  EXPECT_EQ(fs::file_size(folder_ / "densest.ply"), fs::file_size(folder_ / "heaviest.ply"));
}

/// Sample frames have one exposure; half of them darker are compensated.
TEST_F(Surfels, ExposureCompensationTellsTheGains) {
  EXPECT_TRUE(result("off.ply").at("exposure").is_null());
  const nlohmann::json even = result("even.ply", {"--exposure-compensation", "on"}).at("exposure");
  EXPECT_EQ(even.at("frames"), 12);
  EXPECT_EQ(even.at("not_estimated"), 1) << "the first";
  EXPECT_NEAR(even.at("min").get<double>(), 1.0, 0.05);
  EXPECT_NEAR(even.at("max").get<double>(), 1.0, 0.05);
  for (const std::string& name : names_in(frames())) {
    if (!name.ends_with("1.color.png") && !name.ends_with("6.color.png")) continue;
    ColorImage image = read_color(frames() / name).value();
    for (std::size_t i = 0; i < image.size(); ++i) {
      for (std::uint8_t& channel : image.data()[i]) {
        channel = static_cast<std::uint8_t>(
            std::lround(255.0 * srgb_of_linear(0.6 * linear_of_srgb(static_cast<double>(channel) / 255.0))));
      }
    }
    ASSERT_TRUE(write_png(frames() / name, image).ok());
  }
  const nlohmann::json on = result("on.ply", {"--exposure-compensation", "on"});
  EXPECT_NEAR(on.at("exposure").at("min").get<double>(), 0.6, 0.03);
  EXPECT_GT(on.at("ms_per_frame").at("exposure").at("median").get<double>(), 0.0);
  expect_failure(run_program(surfels("cloud.ply", {"--exposure-compensation", "auto"})), 2, "surfels",
                 {"--exposure-compensation", "auto"});
}

TEST_F(Surfels, WithoutColourTheFilterSaysWhatItNeeds) {
  for (const std::string& name : names_in(frames())) {
    if (name.ends_with(".color.png")) fs::remove(frames() / name);
  }
  expect_failure(run_program(surfels("cloud.ply")), 3, "surfels", {"no frame has a colour image", "--mode-filter off"});
  EXPECT_EQ(names_in(folder_.path()), std::vector<std::string>{"frames"});
  const nlohmann::json off = result("cloud.ply", {"--mode-filter", "off"});
  EXPECT_EQ(off.at("frames_without_color"), 12);
  EXPECT_TRUE(cloud("cloud.ply").colors.empty());
}

TEST_F(Surfels, WhatNoFrameWithColourSawIsNotBlack) {
  const auto without_color = [this](const auto& is_first) {
    for (const std::string& name : names_in(frames())) {
      if (name.ends_with(".color.png") && is_first(name)) fs::remove(frames() / name);
    }
  };
  without_color([](const std::string& name) { return name >= "frame-000001"; });
  const nlohmann::json some =
      result("some.ply", {"--mode-filter", "both"}, "11 of 12 depth images have no colour image");
  EXPECT_EQ(some.at("frames_without_color"), 11);
  EXPECT_GT(some.at("uncolored").get<std::size_t>(), 100U);
  for (const char* name : {"some.ply", "some.average.ply"}) {
    const PointCloud written = cloud(name);
    ASSERT_EQ(written.positions_m.size(), some.at("written").get<std::size_t>());
    ASSERT_EQ(written.colors.size(), written.positions_m.size());
    EXPECT_EQ(std::count(written.colors.begin(), written.colors.end(), Eigen::Vector3f::Zero()), 0) << name;
  }
  expect_failure(run_program(surfels("none.ply", {"--first", "1"})), 3, "surfels", {"no frame has a colour image"});
  EXPECT_FALSE(fs::exists(folder_ / "none.ply"));
  EXPECT_EQ(result("off.ply", {"--first", "1", "--mode-filter", "off"}, "no colour image").at("uncolored"), 0);
}

TEST_F(Surfels, WhatIsReadIsNotReplaced) {
  const fs::path depth = frames() / "frame-000000.depth.png";
  const fs::path mask = folder_ / "mask.png";
  fs::copy_file(depth, mask);
  const fs::path camera = folder_.write("camera.json", R"({"fx": 525, "fy": 525, "cx": 319.5, "cy": 239.5})");
  const std::string before = text_of(depth) + text_of(mask) + text_of(camera);
  const Arguments masked{"--mask", mask.string()};
  expect_failure(run_program(surfels("a.ply", {"--picture", depth.string()})), 3, "surfels", {"--picture"});
  expect_failure(run_program(surfels("a.ply", masked + Arguments{"--picture", mask.string()})), 3, "surfels",
                 {"--picture"});
  expect_failure(run_program(surfels("a.ply", {"--json", camera.string()})), 3, "surfels",
                 {"something other than a result"});
  EXPECT_TRUE(text_of(depth) + text_of(mask) + text_of(camera) == before);
  EXPECT_FALSE(fs::exists(folder_ / "a.ply"));
  for (int again = 0; again < 2; ++again) {  // its own are
    EXPECT_EQ(run_program(surfels("a.ply",
                                  {"--json", (folder_ / "a.json").string(), "--picture", (folder_ / "a.png").string()}))
                  .status,
              0);
  }
}

TEST_F(Surfels, WhatIsWrongIsSaidBeforeTheWork) {
  expect_failure(run_program(surfels("cloud.txt")), 2, "surfels", {"--out", ".ply or .pcd"});
  expect_failure(run_program(surfels("cloud.ply", {"--mode-filter", "some"})), 2, "surfels",
                 {"on, off or both", "some"});
  for (const char* sigma : {"0", "inf"}) {
    expect_failure(run_program(surfels("cloud.ply", {"--image-sigma", sigma})), 2, "surfels",
                   {"--image-sigma", "positive, and finite"});
  }
  expect_failure(run_program(surfels("cloud.ply", {"--max-modes", "33"})), 2, "surfels", {"--max-modes", "1 to 32"});
  expect_failure(run_program(surfels("cloud.ply", {"--choice", "best"})), 2, "surfels",
                 {"densest or heaviest", "best"});
  expect_failure(run_program(surfels("cloud.ply", {"--places", "here"})), 2, "surfels",
                 {"--places", "average or modes"});
  expect_failure(run_program(surfels("cloud.ply", {"--max-depth-change", "0"})), 2, "surfels", {"--max-depth-change"});
  expect_failure(run_program(surfels("cloud.ply", {"--min-confidence", "-1"})), 2, "surfels", {"--min-confidence"});
  expect_failure(run_program(surfels("nowhere/cloud.ply")), 3, "surfels", {"nowhere"});
  expect_failure(run_program(surfels("cloud.ply", {"--max-range", "0.2", "--min-range", "0.1"})), 5, "surfels",
                 {"--max-range", "nothing was written"});
  EXPECT_EQ(names_in(folder_.path()), std::vector<std::string>{"frames"});
}

TEST_F(Surfels, AsPrintedIsEveryStepOfTheThesis) {
  const nlohmann::json printed = result("printed.ply", {"--as-printed"});
  EXPECT_EQ(printed.at("as_printed"), true);
  EXPECT_EQ(printed.at("choice"), "heaviest");
  EXPECT_EQ(printed.at("places"), "modes");
  EXPECT_EQ(
      result("named.ply", {"--choice", "heaviest", "--places", "modes", "--max-depth-change", "inf"}).at("as_printed"),
      false);
  EXPECT_TRUE(text_of(folder_ / "printed.ply") == text_of(folder_ / "named.ply"));
  for (const Arguments& departure :
       {Arguments{"--choice", "densest"}, Arguments{"--places", "average"}, Arguments{"--max-depth-change", "0.001"}}) {
    EXPECT_EQ(result("other.ply", Arguments{"--as-printed"} + departure).at("frames"), 12);
    EXPECT_FALSE(text_of(folder_ / "other.ply") == text_of(folder_ / "printed.ply")) << departure.front();
  }
  expect_failure(run_program(surfels("cloud.ply", {"--as-printed", "--mode-filter", "off"})), 2, "surfels",
                 {"--as-printed", "--mode-filter off"});
}

TEST_F(Surfels, WhatWouldHaveNoEffectIsRefused) {
  for (const Arguments& option :
       {Arguments{"--max-modes", "4"}, Arguments{"--choice", "densest"}, Arguments{"--places", "average"}}) {
    expect_failure(run_program(surfels("cloud.ply", Arguments{"--mode-filter", "off"} + option)), 2, "surfels",
                   {option.front(), "--mode-filter off"});
  }
  expect_failure(run_program(surfels("cloud.ply", {"--max-depth-change", "0.02"})), 2, "surfels",
                 {"--max-depth-change", "--places modes"});
  EXPECT_TRUE(result("cloud.ply", {"--mode-filter", "off"}).at("choice").is_null());
}

/// A cloud of few of many frames is not what the user asked for, even where no script checks the counts.
TEST_F(Surfels, MostFramesLeftOutIsAWarning) {
  for (int i = 0; i < 7; ++i) {
    const std::string name = "frames/frame-" + std::to_string(1000005 + i).substr(1) + ".depth.png";
    if (i == 6) {
      const Outcome half = run_program(surfels("cloud.ply"));
      EXPECT_EQ(half.status, 0);
      EXPECT_EQ(half.err, "") << "six of twelve";
    }
    fs::remove(folder_ / name);
    folder_.write(name, "no image");
  }
  const Outcome most = run_program(surfels("cloud.ply"));
  EXPECT_EQ(most.status, 0);
  for (const char* part : {"warning: of 12 frames only 5", "0 are lost and 7 skipped", "frame-000005", "depth.png"}) {
    EXPECT_NE(most.err.find(part), std::string::npos) << part << ": " << most.err;
  }
}

TEST_F(Surfels, InterruptingKeepsWhatWasDone) {
  const auto name = [](int i) { return "frame-" + std::to_string(1000000 + i).substr(1); };
  for (int i = 12; i < 1200; ++i) {
    for (const char* kind : {".depth.png", ".color.png", ".pose.txt"}) {
      fs::create_symlink(frames() / (name(i % 12) + kind), frames() / (name(i) + kind));
    }
  }
  fs::remove(frames() / (name(3) + ".depth.png"));
  folder_.write("frames/" + name(3) + ".depth.png", "no image");
  RunningProgram program{{"surfels", frames().string(), "--out", (folder_ / "cloud.ply").string(), "--json",
                          (folder_ / "cloud.json").string()}};
  ASSERT_TRUE(program.wait_for(name(3) + ": skipped")) << program.err();
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_NE(outcome.err.find("interrupted after"), std::string::npos) << outcome.err;
  const nlohmann::json document = nlohmann::json::parse(text_of(folder_ / "cloud.json"), nullptr, false);
  expect_envelope(document, "surfels");
  EXPECT_EQ(document.at("result").at("interrupted"), true);
  EXPECT_GE(document.at("result").at("frames").get<int>(), 3);
  EXPECT_LT(document.at("result").at("frames").get<int>(), 1199);
  EXPECT_EQ(document.at("result").at("skipped").at(0).at("frame"), name(3));
  EXPECT_EQ(cloud("cloud.ply").positions_m.size(), document.at("result").at("written").get<std::size_t>());
  EXPECT_EQ(names_in(folder_.path()), (std::vector<std::string>{"cloud.json", "cloud.ply", "frames"}));
}

}  // namespace
}  // namespace saccade::test
