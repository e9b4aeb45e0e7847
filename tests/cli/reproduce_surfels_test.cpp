// SPDX-License-Identifier: Apache-2.0
// saccade reproduce 4.1 to 4.3, fig-4.5 to fig-4.9, 4.10 and 4.11 as a user runs them, with few frames.
#include <gtest/gtest.h>

#include "cli/run_program.hpp"
#include "saccade/io/frames/image_io.hpp"
#include "support/effort.hpp"

namespace saccade::test {
namespace {

using nlohmann::json;

constexpr std::size_t kScenes{5};

json tables_of(const Outcome& outcome) {
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return outcome.json().at("result").at("tables");
}

TEST(ReproduceSurfels, ParametersStandBesideTheThesis) {
  const json table = tables_of(run_program({"reproduce", "4.2", "--quiet", "--json", "-"})).at(0);
  ASSERT_EQ(table.at("rows").size(), 14U);
  for (const json& row : table.at("rows")) EXPECT_EQ(row.at("thesis"), row.at("here")) << row;
  EXPECT_FALSE(table.contains("switches"));
}

/// Numbers are the thesis' either way; what it says in words is another with every switch.
TEST(ReproduceSurfels, ParametersAsPrintedNameEverySwitch) {
  const json table = tables_of(run_program({"reproduce", "4.2", "--as-printed", "--quiet", "--json", "-"})).at(0);
  for (const json& row : table.at("rows")) EXPECT_EQ(row.at("thesis"), row.at("here")) << row;
  ASSERT_EQ(table.at("switches").size(), 13U);
  for (const json& row : table.at("switches")) EXPECT_NE(row.at("as_printed"), row.at("default")) << row;
}

void expect_curve(const json& curve) {
  EXPECT_EQ(curve.at("points").size(), 32U);
  EXPECT_GT(curve.at("area").get<double>(), 0.0);
  double least{1.0};
  std::size_t before{static_cast<std::size_t>(-1)};
  for (const json& point : curve.at("points")) {
    least = std::min(least, point.at("bce").get<double>());
    EXPECT_LE(point.at("segments").get<std::size_t>(), before) << "a larger threshold joins more";
    before = point.at("segments").get<std::size_t>();
  }
  EXPECT_DOUBLE_EQ(curve.at("least_bce").get<double>(), least);
}

/// Two rows of tiles, and what is in sight there.
void expect_close_up(const json& figure, const fs::path& file) {
  const ColorImage picture = read_color(file).value();
  EXPECT_GT(picture.width(), 1100) << file;
  EXPECT_GT(picture.height(), 850) << file;
  ASSERT_EQ(figure.at("rows").size(), 2U) << file;
  for (const json& row : figure.at("rows")) {
    EXPECT_GT(row.at("surfels").get<int>(), 500) << file;
    EXPECT_GT(row.at("segments").get<int>(), 3) << file;
    EXPECT_LE(row.at("of_one_surfel"), row.at("segments")) << file;
    EXPECT_GT(row.at("bce").get<double>(), 0.0) << file;
  }
}

TEST(ReproduceSurfelsEvidence, ScenesErrorsAndCurvesOfAFewFrames) {
  if (kSanitized) GTEST_SKIP() << "five scenes take long under sanitizers";
  const TempFolder folder;
  const fs::path out = folder / "plots";
  const json tables =
      tables_of(run_program({"reproduce",    "4.1",     "4.3",     "4.10",     "4.11", "fig-4.5",       "fig-4.6",
                             "fig-4.7",      "fig-4.8", "fig-4.9", "--frames", "24",   "--image-width", "128",
                             "--placements", "2",       "--quiet", "--json",   "-",    "--out",         out.string()}));
  ASSERT_EQ(tables.size(), 9U);
  for (const json& row : tables.at(0).at("rows")) {
    EXPECT_EQ(row.at("frames"), 24);
    EXPECT_GT(row.at("points").get<int>(), 5000) << row;
    EXPECT_GT(row.at("labels").get<int>(), 50) << row;
    EXPECT_GE(row.at("thesis").at("frames").get<int>(), 1698);
  }
  std::size_t better{0};
  ASSERT_EQ(tables.at(1).at("rows").size(), kScenes);
  for (const json& row : tables.at(1).at("rows")) {
    for (const char* algorithm : {"flood_fill", "sv_lccp"}) {
      expect_curve(row.at(algorithm).at("not_enhanced"));
      expect_curve(row.at(algorithm).at("enhanced"));
    }
    const json& filled = row.at("flood_fill");
    if (filled.at("enhanced").at("least_bce") < filled.at("not_enhanced").at("least_bce")) ++better;
  }
  EXPECT_GE(better, 4U) << "so few frames show it already";
  for (const json& figure : {tables.at(2), tables.at(3)}) {
    ASSERT_EQ(figure.at("rows").size(), kScenes);
    for (const json& row : figure.at("rows")) expect_curve(row.at("true_colors"));
  }
  for (const json& row : tables.at(2).at("rows")) {  // flood fill finds things that have one colour each
    EXPECT_GT(row.at("true_colors").at("best_f"), row.at("enhanced").at("best_f")) << row.at("scene");
    EXPECT_LT(row.at("true_colors").at("least_bce"), row.at("enhanced").at("least_bce")) << row.at("scene");
  }
  const std::vector<std::string> plots = names_in(out);
  EXPECT_EQ(plots.size(), 2 * kScenes + 6);
  EXPECT_EQ(plots.front(), "fig-4-10-desk.svg");
  for (std::size_t i = 4; i < 8; ++i) expect_close_up(tables.at(i), out / ("fig-4-" + std::to_string(i + 1) + ".png"));
  const ColorImage positions = read_color(out / "fig-4-9.png").value();
  EXPECT_GT(positions.width(), 1100);
  for (const json& row : tables.at(8).at("rows")) {
    EXPECT_GT(row.at("surfels").get<int>(), 100);
    EXPECT_GT(row.at("background").get<double>(), 0.0);
    EXPECT_LT(row.at("background").get<double>(), 0.9);
  }
}

TEST(ReproduceSurfels, OneSceneAloneAsPrintedOrNot) {
  if (kSanitized) GTEST_SKIP() << "two scenes take long under sanitizers; the tests of surfels run the code";
  const Arguments quick{"--scene", "desk",    "--frames", "8", "--image-width", "96", "--placements",
                        "2",       "--quiet", "--json",   "-"};
  const json ours = tables_of(run_program(Arguments{"reproduce", "4.1", "4.3"} + quick));
  const json printed = tables_of(run_program(Arguments{"reproduce", "4.1", "4.3", "--as-printed"} + quick));
  for (const json& tables : {ours, printed}) {
    ASSERT_EQ(tables.at(0).at("rows").size(), 1U);
    EXPECT_EQ(tables.at(0).at("rows").at(0).at("scene"), "desk");
    EXPECT_EQ(tables.at(0).at("rows").at(0).at("thesis").at("labels"), 164) << "the third of the thesis'";
  }
  const auto curve = [](const json& tables, const char* cloud) {
    return tables.at(1).at("rows").at(0).at("flood_fill").at(cloud);
  };
  EXPECT_EQ(curve(ours, "not_enhanced"), curve(printed, "not_enhanced"));
  EXPECT_NE(curve(ours, "enhanced"), curve(printed, "enhanced"));
  const auto by_supervoxels = [](const json& tables) {
    return tables.at(1).at("rows").at(0).at("sv_lccp").at("not_enhanced");
  };
  EXPECT_NE(by_supervoxels(ours), by_supervoxels(printed)) << "PCL's rules";
  expect_failure(run_program({"reproduce", "4.1", "--scene", "table"}), 2, "reproduce", {"--scene", "workshop-1"});
}

/// Scenes that are done stay, in every table that was asked for.
TEST(ReproduceSurfels, AnInterruptionKeepsTheScenesThatAreDone) {
  if (kSanitized) GTEST_SKIP() << "a scene takes long under sanitizers";
  const TempFolder folder;
  const fs::path file = folder / "tables.json";
  RunningProgram program{{"reproduce", "4.1", "4.10", "4.gain", "--frames", "12", "--image-width", "128",
                          "--placements", "1", "--json", file.string()}};
  ASSERT_TRUE(program.wait_for("surfels of workshop-2")) << program.err();
  program.send(SIGINT);
  const Outcome outcome = program.finish();
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_NE(outcome.err.find("interrupted after 0 of 3 tables"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.out.find("Interrupted: without workshop-2, desk"), std::string::npos) << outcome.out;
  const json tables = json::parse(text_of(file), nullptr, false).at("result").at("tables");
  ASSERT_EQ(tables.size(), 2U) << "no scene of the third is done";
  for (const json& table : tables) {
    EXPECT_EQ(table.at("complete"), false);
    ASSERT_EQ(table.at("rows").size(), 1U);
    EXPECT_EQ(table.at("rows").at(0).at("scene"), "workshop-1");
  }
}

TEST(ReproduceSurfelsEvidence, ExposureCompensationWinsBackWhatGainCosts) {
  if (kSanitized) GTEST_SKIP() << "three trials take long under sanitizers";
  const json table = tables_of(run_program({"reproduce", "4.gain", "--scene", "magazines-2", "--frames", "24",
                                            "--image-width", "128", "--placements", "2", "--quiet", "--json", "-"}))
                         .at(0);
  ASSERT_EQ(table.at("rows").size(), 1U);
  for (const json& row : table.at("rows")) {
    EXPECT_GT(row.at("gains").at("max").get<double>() / row.at("gains").at("min").get<double>(), 1.05) << row;
    EXPECT_LT(row.at("gains").at("worst_error").get<double>(), 0.03) << row;
    for (const char* algorithm : {"flood_fill", "sv_lccp"}) {
      ASSERT_EQ(row.at(algorithm).size(), 4U);
      for (const json& figure : row.at(algorithm)) {
        EXPECT_GT(figure.at("compensated").get<double>(), 0.0) << figure;
        EXPECT_LE(figure.at("off").get<double>(), 1.0) << figure;
        EXPECT_NE(figure.at("not_enhanced").at("off"), figure.at("off")) << figure;
      }
    }
  }
}

TEST(ReproduceSurfels, OnlyScenesWithGainLoseByIt) {
  expect_failure(run_program({"reproduce", "4.gain", "--scene", "desk", "--quiet"}), 3, "reproduce",
                 {"desk", "magazines-1"});
}

}  // namespace
}  // namespace saccade::test
