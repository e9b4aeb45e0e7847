// SPDX-License-Identifier: Apache-2.0
// The annotation service as its pages see it.
#include "server/annotate/annotation_service.hpp"

#include <array>
#include <fstream>

#include "annotation_server/annotation_desk.hpp"
#include "saccade/io/clouds/label_io.hpp"
#include "saccade/io/files/file_io.hpp"

namespace saccade {
namespace {

using test::json;
using test::Page;
using test::Received;

using AnnotationServiceTest = test::AnnotationDesk;

TEST_F(AnnotationServiceTest, SaysWhatThereIs) {
  Page page = connect(7);
  const json head = page.hello().head;
  EXPECT_EQ(head.at("protocol"), 1);
  EXPECT_EQ(head.at("version"), "1.2.3");
  EXPECT_EQ(head.at("mode"), "annotate");
  EXPECT_EQ(head.at("title"), "table.pcd");
  ASSERT_EQ(head.at("colors").size(), 256U);
  EXPECT_EQ(head.at("current"), 0);
  ASSERT_EQ(head.at("clouds").size(), 1U);
  EXPECT_EQ(head.at("clouds")[0].at("name"), "table.pcd");
  EXPECT_GT(head.at("clouds")[0].at("bytes"), 100'000);
  EXPECT_EQ(head.at("clouds")[0].at("begun"), false);

  const json opened = page.open().head;
  EXPECT_EQ(opened.at("ready"), true);
  EXPECT_EQ(opened.at("sequence"), 0);
  EXPECT_EQ(opened.at("client_actions"), 0);
  EXPECT_EQ(opened.at("read_only"), nullptr);
  const json& cloud = opened.at("cloud");
  EXPECT_EQ(cloud.at("points"), kPoints);
  EXPECT_EQ(cloud.at("finite"), kPoints - 1);
  EXPECT_EQ(cloud.at("shown"), kPoints - 1);
  EXPECT_NEAR(cloud.at("bounds")[0], -0.3, 1e-6);
  EXPECT_NEAR(cloud.at("bounds")[5], 1.0, 1e-6);
  EXPECT_NEAR(cloud.at("spacing_m"), 0.005, 5e-4);
  EXPECT_EQ(cloud.at("has_colors"), true);
  EXPECT_EQ(cloud.at("up"), json({0.0, -1.0, 0.0})) << "it is as a camera sees it";
  EXPECT_EQ(cloud.at("graph").at("max_path"), 10.0);
  EXPECT_EQ(page.notices["people"].back().head.at("count"), 1);
  EXPECT_FALSE(page.notices["progress"].empty());
  EXPECT_EQ(Page{connect(8)}.hello().head.at("clouds")[0].at("begun"), true);
  page.act(set(3, kOnTable));
  EXPECT_EQ(page.rows.at(3).at("color"), head.at("colors")[2]);
}

TEST_F(AnnotationServiceTest, GivesPointsAsTheyAreInTheFile) {
  Page page = this->page(1);
  EXPECT_EQ(std::set<std::uint32_t>(page.order.begin(), page.order.end()).size(), kPoints - 1);
  EXPECT_FALSE(page.labels.contains(kNan));
  const Received points = page.ask({{"type", "points"}, {"from", 11'990}, {"count", 100}});
  ASSERT_EQ(points.head.at("count"), 10) << "no more are left";
  const auto positions_m = points.array<float>(0, 30);
  const auto indices = points.array<std::uint32_t>(120, 10);
  const auto colors = points.array<std::uint8_t>(160, 40);
  for (std::size_t i = 0; i < 10; ++i) {
    const int row = static_cast<int>(indices[i]) / kColumns;
    const int column = static_cast<int>(indices[i]) % kColumns;
    EXPECT_NEAR(positions_m[3 * i], 0.005 * (column - 60), 1e-6);
    EXPECT_NEAR(positions_m[3 * i + 1], 0.005 * (row - 50), 1e-6);
    EXPECT_EQ(colors[4 * i], positions_m[3 * i + 2] < 0.97F ? 30 : 200);
    EXPECT_EQ(colors[4 * i + 2], 90);
    EXPECT_EQ(colors[4 * i + 3], 255);
  }
}

TEST_F(AnnotationServiceTest, AcceptsWholeSegments) {
  std::string numbers;
  for (std::uint32_t point = 0; point < kPoints; ++point) numbers += point / kColumns < 50 ? "1\n" : "7\n";
  folder_.write("segments.txt", numbers);
  config_.clouds[0].segments = folder_ / "segments.txt";
  start();
  Page page = this->page(1);
  const Received segments = page.ask({{"type", "segments"}, {"from", 0}, {"count", 100}});
  ASSERT_EQ(segments.head.at("count"), 100);
  const auto points = segments.array<std::uint32_t>(0, 100);
  const auto of_points = segments.array<std::uint32_t>(400, 100);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(of_points[i], points[i] / kColumns < 50 ? 1U : 7U);
  const json accept{{"do", "paint"}, {"label", 4}, {"points", {60 * kColumns}}, {"segments", true}};
  EXPECT_TRUE(page.act(accept).ok());
  EXPECT_EQ(page.labelled_as(4), 6000U) << "without the point that is not finite";
  EXPECT_EQ(page.act({{"do", "undo"}}).head.at("client_actions"), 2) << "one action";
  EXPECT_EQ(page.labelled_as(4), 0U);
  config_.clouds[0].segments.clear();
  start();
  Page other = this->page(2);
  EXPECT_EQ(other.open().head.at("cloud").at("has_segments"), false);
  EXPECT_EQ(other.ask({{"type", "segments"}, {"from", 0}, {"count", 1}}).error(), "not found");
  EXPECT_EQ(other.act(accept).error(), "invalid argument");
}

/// All of the cloud, from the origin.
json view() {
  return {{"size", {400, 300}},
          {"fov_deg", 40},
          {"point_size_px", 8},
          {"T_world_camera", {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}};
}

TEST_F(AnnotationServiceTest, AnnotatesAWholeCloud) {
  Page page = this->page(1);
  four_clicks(page);
  EXPECT_EQ(page.labelled_as(2), 800U);
  EXPECT_EQ(page.labelled_as(3), 800U);
  EXPECT_EQ(page.labelled_as(4), 800U);
  EXPECT_EQ(page.labelled_as(1), 9600U);
  EXPECT_EQ(page.control_points.size(), 4U);
  EXPECT_EQ(page.rows.at(2).at("points"), 800);
  EXPECT_EQ(page.rows.at(2).at("control_points"), 1);
  EXPECT_EQ(page.rows.at(2).at("defined"), false);
  expect_up_to_date(page);

  const Received named =
      page.act({{"do", "labels"}, {"labels", {{{"number", 2}, {"name", "bo\"x"}, {"color", "#ff8000"}}}}});
  EXPECT_EQ(named.head.at("sequence"), 5);
  EXPECT_EQ(page.rows.at(2).at("name"), "bo\"x");
  EXPECT_EQ(page.rows.at(2).at("color"), "#ff8000");
  EXPECT_TRUE(page.act({{"do", "move"}, {"from", kOnBox1}, {"to", kOnBox1 + 2}}).ok());
  EXPECT_TRUE(page.control_points.contains(kOnBox1 + 2));
  EXPECT_TRUE(page.act({{"do", "paint"}, {"label", 5}, {"points", {0, 1, 2}}}).ok());
  EXPECT_EQ(page.labelled_as(5), 3U);
  EXPECT_TRUE(page.act({{"do", "set"}, {"label", 1}, {"at", {-0.299, -0.2501, 1.0}}, {"start_cost", 2.5}}).ok());
  EXPECT_EQ(page.control_points.at(0), (std::pair<std::uint32_t, float>{1, 2.5F}));
  EXPECT_TRUE(page.act({{"do", "paint"}, {"label", 6}, {"rectangle", {200, 150, 220, 170}}, {"view", view()}}).ok());
  EXPECT_GT(page.labelled_as(6), 50U);
  expect_up_to_date(page);

  const std::map<std::uint32_t, std::uint32_t> before = page.labels;
  for (int i = 0; i < 9; ++i) EXPECT_EQ(page.act({{"do", "undo"}}).head.at("done"), true);
  const Received last = page.act({{"do", "undo"}});
  EXPECT_TRUE(last.ok());
  EXPECT_EQ(last.head.at("done"), false);
  EXPECT_EQ(last.head.at("can_undo"), false);
  EXPECT_EQ(last.head.at("sequence"), 18) << "what did nothing does not count";
  EXPECT_TRUE(page.rows.empty());
  EXPECT_EQ(page.labelled_as(0), kPoints - 1);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(page.act({{"do", "redo"}}).head.at("done"), true);
  EXPECT_TRUE(page.labels == before);
  expect_up_to_date(page);
}

TEST_F(AnnotationServiceTest, SelectsNothingThatThePageHides) {
  Page page = this->page(1);
  four_clicks(page);
  const auto paint = [&](const json& hidden) {
    const json action{{"do", "paint"}, {"label", 6}, {"rectangle", {0, 0, 400, 300}}, {"view", view()}};
    return page.ask({{"type", "action"}, {"action", action}, {"hidden", hidden}});
  };
  for (const json& wrong : {json(1), json{-1}, json{1.5}, json{4294967295U}, json{"1"}}) {
    EXPECT_EQ(paint(wrong).error(), "invalid argument") << wrong;
  }
  EXPECT_EQ(paint({0, 1, 2, 3, 4}).error(), "invalid argument") << "there is nothing else";
  EXPECT_TRUE(paint({4, 1, 1}).ok());
  EXPECT_EQ(page.labelled_as(1), 9600U);
  EXPECT_EQ(page.labelled_as(4), 800U);
  EXPECT_EQ(page.labelled_as(6), 1600U);
  EXPECT_TRUE(paint(json::array()).ok());
  EXPECT_EQ(page.labelled_as(4), 0U);
  EXPECT_GT(page.labelled_as(6), 9000U);
  expect_up_to_date(page);
}

TEST_F(AnnotationServiceTest, TakesAwayTheTreesThatPointsAreIn) {
  Page page = this->page(1);
  four_clicks(page);
  const auto remove = [&](const json& action, bool trees) {
    return page.ask({{"type", "action"}, {"action", action}, {"trees", trees}});
  };
  EXPECT_EQ(remove({{"do", "remove"}, {"points", {kOnBox1 + 3}}}, false).error(), "invalid argument");
  EXPECT_TRUE(remove({{"do", "remove"}, {"points", {kOnBox1 + 3, kOnBox1 + 4, kOnBox2 + 3}}}, true).ok());
  EXPECT_EQ(page.control_points.size(), 2U);
  EXPECT_EQ(page.labelled_as(2), 0U);
  EXPECT_EQ(page.labelled_as(3), 0U);
  EXPECT_TRUE(remove({{"do", "remove"}, {"at", {0.2, 0.02, 0.95}}}, true).ok());
  EXPECT_FALSE(page.control_points.contains(kOnBox3));
  EXPECT_EQ(remove(set(2, kOnBox1), true).error(), "invalid argument");
  EXPECT_EQ(page.ask({{"type", "action"}, {"action", set(2, kOnBox1)}, {"trees", 1}}).error(), "invalid argument");
  expect_up_to_date(page);

  const json root = page.ask({{"type", "root"}, {"point", kOnTable + 1}}).head;
  EXPECT_EQ(root.at("control_point"), kOnTable);
  EXPECT_EQ(root.at("label"), 1);
  EXPECT_EQ(root.at("painted"), 0);
  EXPECT_EQ(page.ask({{"type", "root"}, {"point", kNan}}).head.at("control_point"), nullptr);
  const Received tree = page.ask({{"type", "tree"}, {"point", kOnTable + 1}});
  EXPECT_EQ(tree.head.at("count"), page.labelled_as(1));
  for (const std::uint32_t point : tree.array<std::uint32_t>(0, tree.head.at("count"))) {
    ASSERT_EQ(page.labels.at(point), 1U);
  }
  EXPECT_EQ(page.ask({{"type", "tree"}, {"point", kNan}}).head.at("count"), 0);
}

TEST_F(AnnotationServiceTest, ShowsWhereItIsInDoubt) {
  Page page = this->page(1);
  EXPECT_EQ(page.ask({{"type", "margins"}}).head.at("count"), kPoints - 1);
  four_clicks(page);
  const Received margins = page.ask({{"type", "margins"}});
  ASSERT_EQ(margins.body.size(), page.order.size());
  std::set<std::uint8_t> values;
  for (std::size_t i = 0; i < page.order.size(); ++i) {
    if (page.order[i] == kOnTable) {
      EXPECT_EQ(margins.body[i], 255);
    }
    values.insert(margins.body[i]);
  }
  EXPECT_GT(values.size(), 2U);
  const json best = page.ask({{"type", "next_best_click"}}).head;
  ASSERT_TRUE(best.at("point").is_number_unsigned());
  EXPECT_TRUE(page.labels.contains(best.at("point")));
  EXPECT_EQ(best.at("position").size(), 3U);
  EXPECT_EQ(best.at("label"), page.labels.at(best.at("point")));
  EXPECT_GT(best.at("gain"), 0.0);
}

TEST_F(AnnotationServiceTest, PagesSeeEachOther) {
  Page first = page(1);
  Page second = page(2);
  first.listen();
  EXPECT_EQ(first.notices["people"].back().head.at("count"), 2);
  EXPECT_TRUE(first.act(set(1, kOnTable)).ok());
  EXPECT_TRUE(second.act(set(2, kOnBox1)).ok());
  first.listen();
  EXPECT_TRUE(first.labels == second.labels);
  EXPECT_EQ(first.control_points, second.control_points);
  EXPECT_EQ(first.rows, second.rows);
  EXPECT_EQ(second.labelled_as(2), 800U);
  const json& seen = first.notices["changes"].back().head;
  EXPECT_EQ(seen.at("client"), 2);
  EXPECT_EQ(seen.at("sequence"), 2);
  EXPECT_EQ(seen.at("can_undo"), true);

  // Everyone takes back what is their own.
  EXPECT_EQ(first.act({{"do", "undo"}}).head.at("can_undo"), false);
  second.listen();
  EXPECT_EQ(second.notices["changes"].back().head.at("can_undo"), true);
  EXPECT_EQ(second.notices["changes"].back().head.at("can_redo"), false);
  EXPECT_EQ(first.labelled_as(2), 800U);
  EXPECT_FALSE(first.control_points.contains(kOnTable));
  EXPECT_EQ(first.act({{"do", "undo"}}).head.at("done"), false);
  EXPECT_EQ(second.act({{"do", "undo"}}).head.at("done"), true);
  EXPECT_EQ(second.labelled_as(0), kPoints - 1);
  EXPECT_EQ(first.act({{"do", "redo"}}).head.at("client_actions"), 3);
  second.listen();
  EXPECT_TRUE(first.labels == second.labels);

  second.close();
  first.listen();
  EXPECT_EQ(first.notices["people"].back().head.at("count"), 1);
}

TEST_F(AnnotationServiceTest, APageThatShowsPartSeesPart) {
  constexpr std::size_t kBudget{1200};
  Page whole = page(1);
  Page part = page(2, kBudget);
  ASSERT_EQ(part.order.size(), kBudget);
  EXPECT_EQ(std::vector(whole.order.begin(), whole.order.begin() + kBudget), part.order);
  std::map<std::uint32_t, std::size_t> in_cell;  // points in 12 equal parts of the table
  for (const std::uint32_t point : part.order) ++in_cell[point / kColumns / 25 * 3 + point % kColumns / 40];
  ASSERT_EQ(in_cell.size(), 12U);
  for (const auto& [cell, count] : in_cell) EXPECT_NEAR(static_cast<double>(count), 100.0, 40.0) << "cell " << cell;

  four_clicks(whole);
  part.listen();  // that only points which are shown change, the page checks
  EXPECT_EQ(part.labels.size(), kBudget);
  EXPECT_EQ(part.rows, whole.rows) << "counts are of all points";
  EXPECT_FALSE(part.labels.contains(kOnBox1)) << "a control point that the page has not as a point";
  ASSERT_EQ(part.places.size(), 4U);
  const std::array<float, 3> on_box_1 = part.places.at(kOnBox1);
  EXPECT_NEAR(on_box_1[0], 0.005 * (20 - 60), 1e-6);
  EXPECT_NEAR(on_box_1[1], 0.0, 1e-6);
  EXPECT_NEAR(on_box_1[2], 0.95, 1e-6);
  for (const auto& [point, label] : part.labels) ASSERT_EQ(label, whole.labels.at(point));
  EXPECT_EQ(part.ask({{"type", "margins"}}).body.size(), kBudget);
  EXPECT_EQ(part.ask({{"type", "tree"}, {"point", kOnBox1}}).head.at("count"), part.labelled_as(2));
  expect_up_to_date(part);

  config_.most_shown_points = 500;
  stop();
  start();
  EXPECT_EQ(page(1).order.size(), 500U);
}

TEST_F(AnnotationServiceTest, NothingIsLostBetweenTwoRuns) {
  Page page = this->page(1);
  Page other = this->page(2);
  four_clicks(page);
  EXPECT_TRUE(other.act(set(5, 0)).ok());
  EXPECT_TRUE(page.act({{"do", "undo"}}).ok());
  other.listen();
  const auto labels = page.labels;
  // The program is killed within a write: the end of its journal is no whole record.
  stop();
  std::ofstream{folder_ / "table.sacann", std::ios::app | std::ios::binary} << "torn";
  start();
  Page again = connect(1);
  EXPECT_EQ(again.hello().head.at("clouds")[0].at("begun"), true);
  const json opened = again.open().head;
  EXPECT_EQ(opened.at("client_actions"), 5) << "four clicks and an undo";
  EXPECT_EQ(opened.at("sequence"), 6);
  EXPECT_EQ(opened.at("can_redo"), true);
  EXPECT_TRUE(again.labels == labels);
  EXPECT_EQ(again.act({{"do", "redo"}}).head.at("client_actions"), 6);
  Page second = connect(2);
  second.hello();
  EXPECT_EQ(second.open().head.at("client_actions"), 1);
  EXPECT_EQ(second.act({{"do", "undo"}}).head.at("done"), true);
  Page third = connect(3);
  third.hello();
  EXPECT_EQ(third.open().head.at("client_actions"), 0);
}

TEST_F(AnnotationServiceTest, WritesLabels) {
  Page page = this->page(1);
  four_clicks(page);
  EXPECT_TRUE(page.act({{"do", "labels"}, {"labels", {{{"number", 2}, {"name", "red box"}}}}}).ok());
  const Received saved = page.ask({{"type", "save"}});
  ASSERT_TRUE(saved.ok()) << saved.head;
  EXPECT_EQ(saved.head.at("files"),
            json({(folder_ / "table_labels.pcd").string(), (folder_ / "table_labels.names.json").string()}));
  const auto expect_labels = [&](const std::filesystem::path& file) {
    const auto labels = read_labels(file, kPoints);
    ASSERT_TRUE(labels) << labels.error().to_string();
    for (std::uint32_t point = 0; point < kNan; ++point) ASSERT_EQ((*labels)[point], page.labels.at(point));
    EXPECT_EQ((*labels)[kNan], 0U);
  };
  expect_labels(folder_ / "table_labels.pcd");
  const json names = json::parse(*read_text_file(folder_ / "table_labels.names.json"));
  EXPECT_EQ(names.at("labels")[1].at("name"), "red box");
  EXPECT_EQ(names.at("labels")[1].at("points"), 800);

  for (const std::string format : {"pcd", "ply", "txt", "csv", "label", "npy"}) {
    const server::HttpAnswer file = get(format);
    ASSERT_EQ(file.status, 200) << format << ": " << std::string(file.body.begin(), file.body.end());
    EXPECT_EQ(file.file_name, "table_labels." + format);
    expect_labels(folder_.write("got." + format, std::string(file.body.begin(), file.body.end())));
  }
  const server::HttpAnswer text = get("names.txt");
  EXPECT_NE(std::string(text.body.begin(), text.body.end()).find("2 red box\n"), std::string::npos);
  EXPECT_EQ(json::parse(get("names.json").body), names);
  for (const std::string format : {"", "exe", "../pcd", "pcd/../../x", "PCD"}) EXPECT_EQ(get(format).status, 400);
  for (const std::string cloud : {"", "1", "-1", "0x", "99999999999999999999", " 0"}) {
    EXPECT_EQ(get("pcd", cloud).status, 400) << cloud;
  }
  EXPECT_EQ(service_->get({"../table.pcd", {}}).status, 404);
}

}  // namespace
}  // namespace saccade
