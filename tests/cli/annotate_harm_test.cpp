// SPDX-License-Identifier: Apache-2.0
// saccade annotate --simulate: a correct click does hardly any harm, and --as-printed is eq. 4.17 with Algorithm 8.
#include <iostream>

#include "cli/annotated_boxes.hpp"
#include "saccade/annotate/simulated_annotator.hpp"
#include "saccade/io/clouds/cloud_io.hpp"
#include "support/effort.hpp"
#include "support/places.hpp"

namespace saccade::test {
namespace {

constexpr double kFall{0.05};

/// Tells whether some click takes more than kFall off a cloud's mean IoU.
bool has_fall(const nlohmann::json& cloud) {
  double before{0.0};
  for (const nlohmann::json& click : cloud.at("clicks")) {
    const auto now = click.at("iou_mean").get<double>();
    if (before - now > kFall) return true;
    before = now;
  }
  return false;
}

class AnnotateHarm : public AnnotatedBoxes {};

TEST_F(AnnotateHarm, AsPrintedIsTheLibraryWithTheEquationAsItIs) {
  const Outcome outcome = run_program(Arguments{"--json", "-", "--quiet", "annotate", path("cloud.csv"), "--as-printed",
                                                "--simulate", path("cloud.txt"), "--clicks", "2"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const PointCloud cloud = cloud_from_fields(read_cloud(folder_ / "cloud.csv").value().fields()).value();
  const std::vector<std::uint32_t> truth = read_labels(folder_ / "cloud.txt", cloud.positions_m.size()).value();
  const auto graph =
      std::make_shared<const Neighbourhood>(Neighbourhood::build(cloud, NeighbourhoodConfig{}, Executor{}).value());
  SimulatedAnnotator annotator = SimulatedAnnotator::create(graph, cloud, truth).value();
  std::size_t compared{0};
  const nlohmann::json clicks = outcome.json().at("result").at("clicks");
  for (const nlohmann::json& click : clicks) {
    const auto next = annotator.next();
    ASSERT_TRUE(next.has_value());
    EXPECT_EQ(click.at("label"), next->label);
    EXPECT_EQ(click.at("iou_mean"), next->score.mean_iou);
    ++compared;
  }
  EXPECT_GE(compared, static_cast<std::size_t>(kLabels));
}

TEST_F(AnnotateHarm, ASessionKeepsWhetherItIsAsPrinted) {
  const std::string clicks = write("clicks.jsonl", four_clicks());
  const Arguments session{"--session", path("kept.sacann")};
  ASSERT_EQ(run_program(annotate(session + Arguments{"--script", clicks})).status, 0);
  expect_failure(run_program(annotate(session + Arguments{"--as-printed"})), 3, "annotate", {"--as-printed", "begun"});
  const Arguments printed{"--session", path("printed.sacann")};
  ASSERT_EQ(run_program(annotate(printed + Arguments{"--script", clicks, "--as-printed"})).status, 0);
  EXPECT_EQ(run_program(annotate(printed)).status, 0);
  EXPECT_EQ(run_program(annotate(printed + Arguments{"--as-printed"})).status, 0);
}

TEST(AnnotateHarmEvidence, ACorrectClickDoesHarmInOneRecordedCloudOfTwelve) {
  if (kSanitized) GTEST_SKIP() << "takes long under sanitizers; the tests of annotation run the code";
  const std::string clouds = (shared_data() / "mosd_labelled" / "learn").string();
  if (!fs::exists(clouds)) GTEST_SKIP() << "no " << clouds;
  const Outcome outcome =
      run_program({"--json", "-", "--quiet", "annotate", clouds, "--simulate", clouds, "--clicks", "6"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json result = outcome.json().at("result");
  ASSERT_EQ(result.at("clouds").size(), 12U);
  int falls{0};
  for (const nlohmann::json& cloud : result.at("clouds")) falls += has_fall(cloud) ? 1 : 0;
  const nlohmann::json& per_label = result.at("mean").at("per_label");
  std::cout << falls << " clouds with a fall; per label: " << per_label << "\n";
  EXPECT_LE(falls, 1);
  EXPECT_GE(per_label.at(0).at("iou_mean"), 0.73);
  EXPECT_GE(per_label.at(1).at("iou_mean"), 0.96);
  EXPECT_GE(per_label.at(2).at("iou_mean"), 0.975);
  EXPECT_GE(per_label.at(5).at("iou_mean"), 0.985);
}

}  // namespace
}  // namespace saccade::test
