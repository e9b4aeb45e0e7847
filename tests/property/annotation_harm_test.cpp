// SPDX-License-Identifier: Apache-2.0
// On made pictures of a table with boxes, noisy in depth and colour, a correct click hardly ever does harm where
// borders are strong; as printed it often does.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <iostream>
#include <limits>
#include <random>

#include "saccade/annotate/simulated_annotator.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

constexpr int kColumns{160};
constexpr int kRows{120};
constexpr int kTables{8};
constexpr std::size_t kBoxes{4};
constexpr std::size_t kClicksPerLabel{6};
constexpr double kFall{0.05};

struct MadeTable {
  PointCloud cloud;
  std::vector<std::uint32_t> truth;
};

struct MadeBox {
  Eigen::Vector3f least_m, greatest_m, color;
};

/// Distance along a ray to an axis-parallel box; infinite where it misses.
float ray_to_box(const Eigen::Vector3f& from_m, const Eigen::Vector3f& along, const MadeBox& box) {
  const Eigen::Array3f a = (box.least_m - from_m).array() / along.array();
  const Eigen::Array3f b = (box.greatest_m - from_m).array() / along.array();
  const float enter = a.min(b).maxCoeff();
  const float leave = a.max(b).minCoeff();
  return enter > 0.0F && enter < leave ? enter : std::numeric_limits<float>::infinity();
}

/// A camera 0.7 m above a table and 0.9 m before its middle. Boxes have their own place, height and colour, one of them
/// nearly that of the table.
MadeTable made_table(std::uint32_t seed) {
  std::mt19937 random{seed};
  std::uniform_real_distribution<float> any{0.0F, 1.0F};
  std::normal_distribution<float> noise{0.0F, 1.0F};
  const Eigen::Vector3f from_m{0.0F, -0.9F, 0.7F};
  const Eigen::Vector3f table_color{0.55F, 0.45F, 0.35F};
  std::array<MadeBox, kBoxes> boxes;
  for (std::size_t i = 0; i < kBoxes; ++i) {
    const Eigen::Vector3f corner_m{-0.36F + 0.19F * static_cast<float>(i), -0.15F + 0.2F * any(random), 0.0F};
    boxes[i].least_m = corner_m;
    boxes[i].greatest_m =
        corner_m + Eigen::Vector3f{0.1F + 0.06F * any(random), 0.1F + 0.1F * any(random), 0.05F + 0.15F * any(random)};
    boxes[i].color = i == 0 ? Eigen::Vector3f{table_color + Eigen::Vector3f::Constant(0.05F)}
                            : Eigen::Vector3f{any(random), any(random), any(random)};
  }
  MadeTable made;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const float across = (static_cast<float>(column) - 0.5F * kColumns) / kColumns;
      const float down = (static_cast<float>(row) - 0.5F * kRows) / kColumns;
      const Eigen::Vector3f along = Eigen::Vector3f{across, 0.79F - 0.61F * down, -0.61F - 0.79F * down}.normalized();
      float distance_m = -from_m.z() / along.z();
      std::uint32_t label{1};
      Eigen::Vector3f color = table_color;
      for (std::size_t i = 0; i < kBoxes; ++i) {
        const float to_box_m = ray_to_box(from_m, along, boxes[i]);
        if (to_box_m >= distance_m) continue;
        distance_m = to_box_m;
        label = static_cast<std::uint32_t>(i) + 2;
        color = boxes[i].color;
      }
      made.cloud.positions_m.emplace_back(from_m + along * (distance_m + 0.001F * noise(random)));
      made.cloud.colors.emplace_back(color + Eigen::Vector3f{noise(random), noise(random), noise(random)} * 0.015F);
      made.truth.push_back(label);
    }
  }
  return made;
}

struct Harm {
  int tables{0};  ///< with a click that takes more than kFall off the mean IoU
  double at_two{0.0};
  double at_six{0.0};
};

void click_at(const MadeTable& made, bool strong_borders, Harm& harm) {
  NeighbourhoodConfig config;
  config.strong_borders = strong_borders;
  const auto graph = std::make_shared<const Neighbourhood>(
      Neighbourhood::build(made.cloud, config, Executor::with_threads(2)).value());
  SimulatedAnnotator annotator = SimulatedAnnotator::create(graph, made.cloud, made.truth).value();
  const std::size_t labels = kBoxes + 1;
  double before{0.0};
  bool falls{false};
  for (std::size_t click = 1; click <= kClicksPerLabel * labels; ++click) {
    if (const auto next = annotator.next()) {
      falls = falls || before - next->score.mean_iou > kFall;
      before = next->score.mean_iou;
    }
    if (click == 2 * labels) harm.at_two += before / kTables;
  }
  harm.at_six += before / kTables;
  harm.tables += falls ? 1 : 0;
}

TEST(AnnotationHarmProperty, ACorrectClickHardlyEverDoesHarmOnMadeTables) {
  if (test::kSanitized) GTEST_SKIP() << "takes long under sanitizers; the unit tests of click_start run the code";
  Harm strong, printed;
  for (std::uint32_t seed = 1; seed <= kTables; ++seed) {
    const MadeTable made = made_table(seed);
    click_at(made, true, strong);
    click_at(made, false, printed);
  }
  std::cout << kTables << " made tables; with a fall " << strong.tables << ", as printed " << printed.tables
            << "; mean IoU at two clicks per label " << strong.at_two << ", as printed " << printed.at_two
            << "; at six " << strong.at_six << ", as printed " << printed.at_six << "\n";
  EXPECT_LE(strong.tables, 1);
  EXPECT_GE(printed.tables, 1);
}

}  // namespace
}  // namespace saccade
