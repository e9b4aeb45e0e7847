// SPDX-License-Identifier: Apache-2.0
// A cloud in tiles: a page has each point once, and hears of those that it holds.
#include "annotation_desk.hpp"
#include "saccade/io/clouds/cloud_io.hpp"

namespace saccade::test {
namespace {

constexpr std::size_t kSide{200};

class AnnotationTilesTest : public testing::Test {
 protected:
  AnnotationTilesTest() {
    ColumnTable table;
    table.rows = kSide * kSide;
    for (const char* name : {"x", "y", "z"}) {
      table.columns.push_back({name, ColumnType::f32, 1, std::vector<std::byte>(table.rows * sizeof(float))});
    }
    for (std::size_t i = 0; i < table.rows; ++i) {
      table.columns[0].set_value(i, 0.01 * static_cast<double>(i % kSide));
      table.columns[1].set_value(i, 0.01 * static_cast<double>(i / kSide));
    }
    EXPECT_TRUE(write_pcd(folder_ / "plane.pcd", table));
    server::AnnotationServiceConfig config;
    config.clouds.push_back({folder_ / "plane.pcd", folder_ / "plane.sacann", {}, folder_ / "labels.pcd", {}});
    config.start.tiles_above_points = 30'000;
    service_ = std::make_unique<server::AnnotationService>(config, messages_, [this](auto work) { work_.post(work); });
    page_ = std::make_unique<Page>(*service_, messages_, 1, 7);
    page_->hello();
  }
  Received open(std::size_t budget) {
    return page_->ask({{"type", "open"}, {"cloud", 0}, {"budget", budget}, {"tiles", true}});
  }

  TempFolder folder_;
  KeptMessages messages_;
  PostedWork work_;
  std::unique_ptr<server::AnnotationService> service_;
  std::unique_ptr<Page> page_;
};

TEST_F(AnnotationTilesTest, GiveEachPointOnceWithItsLabel) {
  const Received opened = open(1'000'000);
  ASSERT_TRUE(opened.ok());
  const std::size_t nodes = opened.head.at("cloud").at("tiles");
  ASSERT_GT(nodes, 1U);
  EXPECT_EQ(opened.head.at("cloud").at("shown"), 0);
  const Received octree = page_->ask({{"type", "octree"}});
  ASSERT_EQ(octree.head.at("count"), nodes);
  ASSERT_EQ(octree.body.size(), 28 * nodes);
  ASSERT_TRUE(page_->ask({{"type", "action"}, {"action", {{"do", "paint"}, {"label", 3}, {"points", {0, 5}}}}}).ok());
  std::vector<int> times(kSide * kSide, 0);
  for (std::size_t node = 0; node < nodes; ++node) {
    const Received tile = page_->ask({{"type", "tiles"}, {"nodes", {node}}});
    const std::size_t count = tile.head.at("count");
    ASSERT_EQ(count, octree.array<std::uint32_t>(28 * node + 20, 1).front());
    const auto points = tile.array<std::uint32_t>(12 * count, count);
    const auto labels = tile.array<std::uint32_t>(20 * count, count);
    for (std::size_t i = 0; i < count; ++i) {
      ++times[points[i]];
      EXPECT_EQ(labels[i], points[i] == 0 || points[i] == 5 ? 3U : 0U);
    }
  }
  EXPECT_EQ(std::count(times.begin(), times.end(), 1), static_cast<std::ptrdiff_t>(times.size()));
}

TEST_F(AnnotationTilesTest, ChangesNameThePointsThatAreHeld) {
  ASSERT_TRUE(open(1'000'000).ok());
  const Received root = page_->ask({{"type", "tiles"}, {"nodes", {0}}});
  const std::size_t count = root.head.at("count");
  const auto points = root.array<std::uint32_t>(12 * count, count);
  const auto other = page_->ask({{"type", "tiles"}, {"nodes", {1}}, {"drop", {1}}});
  const auto elsewhere = other.array<std::uint32_t>(12 * other.head.at("count").get<std::size_t>(), 1).front();
  const auto groups_after = [&](const json& question) {
    messages_.take(1);
    json ask = question;
    ask["request"] = 1'000;
    page_->send(server::MessageWriter{ask});
    for (const Received& message : messages_.take(1)) {
      if (message.head.at("type") == "changes") return message.head.at("groups");
    }
    return json{};
  };
  const json paint{{"type", "action"}, {"action", {{"do", "paint"}, {"label", 2}, {"points", {points[0], elsewhere}}}}};
  EXPECT_EQ(groups_after(paint), json::array({json::array({2, 2})}));
  ASSERT_TRUE(page_->ask({{"type", "tiles"}, {"drop", {1}}}).ok());
  const json again{{"type", "action"}, {"action", {{"do", "paint"}, {"label", 4}, {"points", {points[0], elsewhere}}}}};
  EXPECT_EQ(groups_after(again), json::array({json::array({4, 1})}));
}

TEST_F(AnnotationTilesTest, BadNodesAreRefused) {
  const std::size_t nodes = open(20'000).head.at("cloud").at("tiles");
  for (const json& bad : {json{nodes}, json{-1}, json{0, 0}, json{"0"}, json(0), json{0.5}}) {
    EXPECT_EQ(page_->ask({{"type", "tiles"}, {"nodes", bad}}).error(), "invalid argument") << bad;
    EXPECT_EQ(page_->ask({{"type", "tiles"}, {"drop", bad}}).error(), "invalid argument") << bad;
    EXPECT_EQ(page_->ask({{"type", "margins"}, {"nodes", bad}}).error(), "invalid argument") << bad;
  }
  json all = json::array();
  for (std::size_t node = 0; node < nodes; ++node) all.push_back(node);
  EXPECT_EQ(page_->ask({{"type", "tiles"}, {"nodes", all}}).error(), "invalid argument") << "more than the budget";
  EXPECT_EQ(page_->ask({{"type", "open"}, {"cloud", 0}, {"budget", 5}, {"tiles", 1}}).error(), "invalid argument");
  EXPECT_EQ(page_->open().head.at("cloud").at("shown"), kSide * kSide) << "without tiles as ever";
  EXPECT_EQ(page_->ask({{"type", "octree"}}).error(), "invalid argument");
}

}  // namespace
}  // namespace saccade::test
