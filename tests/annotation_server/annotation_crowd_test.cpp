// SPDX-License-Identifier: Apache-2.0
// Connections that mean no good, as many as there may be, or as quick as they can. Results are printed, and
// held to generous bounds, as other work may be on the machine.
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <deque>
#include <fstream>
#include <iostream>

#include "annotation_server/served_annotation.hpp"
#include "saccade/core/clock.hpp"
#include "support/effort.hpp"

namespace saccade {
namespace {

using nlohmann::json;
using test::PageSocket;
using test::ServedAnnotation;

class AnnotationCrowdTest : public ::testing::Test {
 protected:
  static constexpr std::uint32_t kSide{test::kSanitized ? 100 : 547};  ///< with more than 300,000 points the graph
                                                                       ///< comes later
  static constexpr int kOthers{63};

  /// Makes square objects of 10 cm on a table, as a scan of KITTI.
  void SetUp() override {
    std::vector<float> scan;
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
      const std::uint32_t row = i / kSide;
      const std::uint32_t column = i % kSide;
      const bool thing = row / 25 % 2 == 1 && column / 25 % 2 == 1;
      const float z = thing ? 0.1F + 0.004F * static_cast<float>(row % 25) : 0.0F;
      scan.insert(scan.end(), {0.004F * static_cast<float>(column), 0.004F * static_cast<float>(row), z, 0.5F});
    }
    std::ofstream{folder_ / "many.bin", std::ios::binary}.write(
        reinterpret_cast<const char*>(scan.data()), static_cast<std::streamsize>(scan.size() * sizeof(float)));
  }

  /// Looks down on all of it, as large as views may be, and passes everything as often as brushes may.
  static json worst_brush() {
    constexpr int kWidth{test::kSanitized ? 960 : 7680};
    constexpr int kHeight{kWidth / 16 * 9};
    constexpr int kParts{119};
    json line = json::array();
    for (int i = 0; i < kParts; ++i) line.push_back({i % 2 * (kWidth - 1), i * kHeight / kParts});
    return {{"do", "remove"},
            {"view",
             {{"size", {kWidth, kHeight}},
              {"fov_deg", 60},
              {"T_world_camera", {{1, 0, 0, 1.1}, {0, -1, 0, 1.1}, {0, 0, -1, 3.0}, {0, 0, 0, 1}}}}},
            {"brush", {{"line", line}, {"radius_px", kWidth / 2}}}};
  }
  /// Every third labels much of the cloud and takes it back, the others draw. Each has four questions under way.
  static void flood(PageSocket& page, int number, std::atomic<int>& answered) {
    const auto next = [number](int i) -> json {
      if (number % 3 != 0) return {{"type", "action"}, {"action", worst_brush()}};
      if (i % 2 == 1) return {{"type", "action"}, {"action", {{"do", "undo"}}}};
      const std::uint32_t point = static_cast<std::uint32_t>(number * 4001 + i * 17) % (kSide * kSide);
      return {{"type", "action"}, {"action", {{"do", "set"}, {"label", 1 + number % 20}, {"points", {point}}}}};
    };
    int asked{0};
    while (asked < 4 && page.send(next(asked))) ++asked;
    while (const auto message = page.receive()) {
      if (message->value("type", "") != "answer") continue;
      ++answered;
      if (!page.send(next(asked++))) return;
    }
  }

  test::TempFolder folder_;
};

TEST_F(AnnotationCrowdTest, AGoodPageAmong63HostileOnes) {
  constexpr int kActions{3};
  constexpr int kAnswers{20};                                            ///< to the others, before the good page acts
  constexpr double kMostWork_ms{test::kSanitized ? 60'000.0 : 5'000.0};  // limit of the program's processor time, or
  constexpr double kMostBrushes{24.0};  // on a slow machine this many brushes of 63 that wait
  constexpr double kMost_ms{60'000.0};
  ServedAnnotation served{{"annotate", (folder_ / "many.bin").string(), "--no-browser"}};
  ASSERT_TRUE(served.is_served()) << served.program().err();
  PageSocket good = served.page(1000);
  ASSERT_EQ(good.open(0, 1000).at("ok"), true);
  const Stopwatch alone;
  ASSERT_EQ(good.ask({{"type", "action"}, {"action", worst_brush()}}).at("ok"), false);
  const double brush_ms = alone.elapsed_ms();

  std::atomic<int> answered{0};
  std::deque<PageSocket> pages;
  for (int i = 0; i < kOthers; ++i) {
    ASSERT_EQ(pages.emplace_back(served.page(static_cast<std::uint64_t>(i) + 1)).open(0, 1).at("ok"), true);
  }
  std::vector<std::thread> others;
  for (int i = 0; i < kOthers; ++i) {
    others.emplace_back([&page = pages[static_cast<std::size_t>(i)], i, &answered] { flood(page, i, answered); });
  }
  const Stopwatch stopwatch;
  while (answered < kAnswers && stopwatch.elapsed_ms() < 120'000.0) {
    std::this_thread::sleep_for(std::chrono::milliseconds{10});
  }
  const int before = answered;
  std::vector<double> ms;
  double longest_work_ms{0.0};
  for (int i = 0; i < kActions; ++i) {
    const Stopwatch waits;
    const double worked_ms = served.program().processor_ms();
    EXPECT_EQ(good.act({{"do", "set"}, {"label", 30 + i}, {"points", {i * 1000 + 7}}}).value("ok", false), true);
    ms.push_back(waits.elapsed_ms());
    longest_work_ms = std::max(longest_work_ms, served.program().processor_ms() - worked_ms);
    std::this_thread::sleep_for(std::chrono::milliseconds{200});
  }
  const int meanwhile = answered - before;
  served.program().send(SIGKILL);
  for (std::thread& other : others) other.join();
  std::sort(ms.begin(), ms.end());
  std::cout << "an action among " << kOthers << " hostile pages on " << kSide * kSide << " points, whose brush takes "
            << brush_ms << " ms: median " << ms[ms.size() / 2] << " ms, longest " << ms.back() << " ms (at most "
            << longest_work_ms << " ms of the program's work); " << meanwhile << " of theirs were answered meanwhile\n";
  EXPECT_GE(answered, kAnswers);
  EXPECT_GT(meanwhile, kActions / 2) << "they are served, too";
  EXPECT_GT(longest_work_ms, 0.0);
  EXPECT_LT(longest_work_ms, std::max(kMostWork_ms, kMostBrushes * brush_ms));
  EXPECT_LT(ms.back(), kMost_ms);
}

/// More under SACCADE_TEST_ACTIONS, say a million.
int flood_size() {
  const char* const given = std::getenv("SACCADE_TEST_ACTIONS");
  return given == nullptr ? 2000 : std::atoi(given);
}

/// Largest, MiB; 0 where it is not told.
double most_memory_mib(pid_t program) {
  std::ifstream status{"/proc/" + std::to_string(program) + "/status"};
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024.0;
  }
  return 0.0;
}

/// Eight pages send all they can for a minute, whether it is read or not; then the program is killed.
TEST_F(AnnotationCrowdTest, AMinuteOfActionsWithoutWaiting) {
  constexpr int kPages{8};
  constexpr double kMost_ms{60'000.0};
  constexpr std::uint64_t kFirst{1};
  const int each = flood_size() / kPages;
  folder_.write("few.xyz", "0 0 0\n0.1 0 0\n0 0.1 0\n0.1 0.1 0\n");
  const test::Arguments serve{"annotate", (folder_ / "few.xyz").string(), "--no-browser"};
  std::vector<int> acknowledged(kPages, 0);
  std::atomic<int> sent{0};
  {
    ServedAnnotation served{serve};
    ASSERT_TRUE(served.is_served()) << served.program().err();
    std::deque<PageSocket> pages;
    for (int i = 0; i < kPages; ++i) {
      ASSERT_EQ(pages.emplace_back(served.page(kFirst + static_cast<std::uint64_t>(i))).open(0, 1).at("ok"), true);
    }
    std::vector<std::thread> threads;
    std::atomic<int> all{0};
    for (std::size_t i = 0; i < kPages; ++i) {
      threads.emplace_back([&page = pages[i], &sent, each] {
        for (int k = 0; k < each; ++k, ++sent) {
          const json action{{"do", "set"}, {"label", 1 + k % 7}, {"points", {k % 4}}};
          if (!page.send({{"type", "action"}, {"action", action}})) return;
        }
      });
      threads.emplace_back([&page = pages[i], &count = acknowledged[i], &all] {
        while (const auto message = page.receive()) {
          if (message->value("type", "") != "answer") continue;
          EXPECT_TRUE(message->value("ok", false)) << message->dump();
          ++count;
          ++all;
        }
      });
    }
    const Stopwatch stopwatch;
    while (all < kPages * each && stopwatch.elapsed_ms() < kMost_ms) {
      std::this_thread::sleep_for(std::chrono::milliseconds{10});
    }
    const double took_ms = stopwatch.elapsed_ms();
    const double memory_mib = most_memory_mib(served.program().id());
    served.program().send(SIGKILL);
    for (std::thread& thread : threads) thread.join();
    std::cout << "of " << kPages * each << " actions " << sent << " were sent and " << all << " acknowledged in "
              << took_ms / 1000.0 << " s; at most " << memory_mib << " MiB\n";
    EXPECT_GT(all, 0);
    if (!test::kSanitized) {
      EXPECT_LT(memory_mib, 300.0);
    }
  }
  ServedAnnotation served{serve};
  ASSERT_TRUE(served.is_served()) << served.program().err();
  for (std::size_t i = 0; i < kPages; ++i) {
    PageSocket page = served.page(kFirst + i);
    const json opened = page.open();
    EXPECT_TRUE(opened.at("read_only").is_null());
    EXPECT_GE(opened.at("client_actions"), acknowledged[i]);
    EXPECT_LE(opened.at("client_actions"), each);
    EXPECT_TRUE(page.act({{"do", "set"}, {"label", 9}, {"points", {3}}}).value("ok", false));
  }
}

}  // namespace
}  // namespace saccade
