// SPDX-License-Identifier: Apache-2.0
// How long the service takes for an action on 300,000 points: what the page's budget of 10 ms is about. Printed, and
// held to ten times as much, as other work may be on the machine.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <random>

#include "annotation_server/annotation_desk.hpp"
#include "saccade/core/clock.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

using test::json;
using test::Page;

class AnnotationSpeedTest : public test::AnnotationDesk {
 protected:
  static constexpr std::uint32_t kSide{548};
  static constexpr std::uint32_t kMany{kSide * kSide};
  static constexpr double kMost_ms{test::kSanitized ? 1000.0 : 100.0};

  /// Square things of 20 cm on a table of 2.2 m, as a scan of KITTI.
  void SetUp() override {
    std::vector<float> scan;
    for (std::uint32_t i = 0; i < kMany; ++i) {
      const std::uint32_t row = i / kSide;
      const std::uint32_t column = i % kSide;
      const bool thing = row / 25 % 2 == 1 && column / 25 % 2 == 1;
      const float z = thing ? 0.1F + 0.004F * static_cast<float>(row % 25) : 0.0F;
      scan.insert(scan.end(), {0.004F * static_cast<float>(column), 0.004F * static_cast<float>(row), z, 0.5F});
    }
    std::ofstream{folder_ / "many.bin", std::ios::binary}.write(
        reinterpret_cast<const char*>(scan.data()), static_cast<std::streamsize>(scan.size() * sizeof(float)));
    config_.clouds = {{folder_ / "many.bin", folder_ / "many.sacann", {}, folder_ / "out.label", {}}};
    config_.graph_at_once_points = kMany;
    start();
  }
};

TEST_F(AnnotationSpeedTest, OfAnActionOn300000Points) {
  constexpr int kActions{200};
  Page page = this->page(1);
  ASSERT_EQ(page.order.size(), kMany);
  const Page other = this->page(2);
  std::mt19937 random{1};
  std::vector<double> ms;
  std::size_t changed{0};
  for (int i = 0; i < kActions; ++i) {
    const json action =
        i % 4 == 3 ? json{{"do", "undo"}}
                   : set(1 + static_cast<std::uint32_t>(random() % 20), static_cast<std::uint32_t>(random() % kMany));
    const server::SharedMessage message =
        server::MessageWriter{json{{"type", "action"}, {"request", 1'000'000 + i}, {"action", action}}}.finish();
    const Stopwatch stopwatch;
    service_->received(page.id(), *message);
    ms.push_back(stopwatch.elapsed_ms());
    for (const test::Received& received : messages_->take(page.id())) {
      if (received.head.at("type") == "changes") changed += received.body.size() / 4;
    }
    messages_->take(other.id());
  }
  const double first_ms = ms.front();
  std::sort(ms.begin(), ms.end());
  const double median_ms = ms[ms.size() / 2];
  std::cout << "an action on " << kMany << " points, two pages: median " << median_ms << " ms, 90 % "
            << ms[ms.size() * 9 / 10] << " ms, the first " << first_ms << " ms; " << changed / kActions
            << " points changed on average\n";
  EXPECT_GT(changed, kMany);
  EXPECT_LT(median_ms, kMost_ms);
}

/// The worst there is: one control point labels two thirds of the cloud, and is taken back, again and again.
TEST_F(AnnotationSpeedTest, OfActionsThatLabelMostOf300000Points) {
  if (test::kSanitized) GTEST_SKIP() << "OfAnActionOn300000Points is enough under sanitizers";
  constexpr int kRounds{20};
  Page page = this->page(1);
  const Page other = this->page(2);
  std::mt19937 random{1};
  std::vector<double> set_ms;
  std::vector<double> undo_ms;
  std::size_t changed{0};
  for (int i = 0; i < 2 * kRounds; ++i) {
    const bool undo = i % 2 == 1;
    const json action = undo ? json{{"do", "undo"}} : set(1, static_cast<std::uint32_t>(random() % kMany));
    const server::SharedMessage message =
        server::MessageWriter{json{{"type", "action"}, {"request", 1'000'000 + i}, {"action", action}}}.finish();
    const Stopwatch stopwatch;
    service_->received(page.id(), *message);
    (undo ? undo_ms : set_ms).push_back(stopwatch.elapsed_ms());
    for (const test::Received& received : messages_->take(page.id())) {
      if (received.head.at("type") == "changes") changed += received.body.size() / 4;
    }
    messages_->take(other.id());
  }
  const double first_ms = set_ms.front();
  std::sort(set_ms.begin(), set_ms.end());
  std::sort(undo_ms.begin(), undo_ms.end());
  std::cout << "a first control point among " << kMany << " points, two pages: median " << set_ms[kRounds / 2]
            << " ms, the first " << first_ms << " ms; its undo " << undo_ms[kRounds / 2] << " ms\n";
  EXPECT_GT(changed, kRounds * kMany);
  EXPECT_LT(set_ms[kRounds / 2], kMost_ms);
  EXPECT_LT(undo_ms[kRounds / 2], kMost_ms);
}

}  // namespace
}  // namespace saccade
