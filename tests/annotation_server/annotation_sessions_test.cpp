// SPDX-License-Identifier: Apache-2.0
// Sessions behind the annotation service: their beginnings and ends, folders, large clouds, and disks that are full.
#include <fstream>

#include "annotation_server/annotation_desk.hpp"
#include "saccade/io/files/file_io.hpp"
#include "saccade/io/sessions/annotation_session.hpp"
#include "support/small_disk.hpp"

namespace saccade {
namespace {

using test::json;
using test::Page;
using test::Received;

class AnnotationSessionsTest : public test::AnnotationDesk {
 protected:
  void restart() {
    stop();
    start();
  }
  /// A folder of clouds.
  void serve_three() {
    write_cloud("second.pcd");
    write_cloud("third.pcd");
    config_.clouds = {served("table"), served("second"), served("third")};
    restart();
  }
  static constexpr const char* kNotReady{"unavailable"};
};

TEST_F(AnnotationSessionsTest, KeepsTheEarlierSessionWhenItBeginsAnew) {
  Page page = this->page(1);
  Page other = this->page(2);
  four_clicks(page);
  const std::string before = *read_text_file(folder_ / "table.sacann");
  folder_.write("table.sacann.1", "something else");
  const Received begun = page.ask({{"type", "new"}});
  ASSERT_TRUE(begun.ok()) << begun.head;
  EXPECT_EQ(begun.head.at("kept"), "table.sacann.2");
  EXPECT_EQ(*read_text_file(folder_ / "table.sacann.2"), before);
  EXPECT_EQ(*read_text_file(folder_ / "table.sacann.1"), "something else");
  EXPECT_EQ(begun.head.at("sequence"), 0);
  EXPECT_EQ(begun.head.at("client_actions"), 0);
  EXPECT_EQ(begun.head.at("cloud").at("shown"), kPoints - 1);
  page.take_in(begun);
  EXPECT_EQ(page.labelled_as(0), kPoints - 1);
  EXPECT_TRUE(page.control_points.empty());

  other.listen();
  ASSERT_EQ(other.notices["reset"].size(), 1U);
  EXPECT_TRUE(page.notices["reset"].empty());
  EXPECT_EQ(other.act(set(5, 0)).error(), "invalid argument") << "it was meant for what is no more";
  EXPECT_TRUE(other.open().ok());
  EXPECT_TRUE(other.act(set(5, kOnBox1)).ok());
  page.listen();
  EXPECT_EQ(page.labels, other.labels);
  EXPECT_EQ(read_journal(folder_ / "table.sacann")->actions.size(), 1U);
  EXPECT_EQ(page.ask({{"type", "new"}}).head.at("kept"), "table.sacann.3");
}

TEST_F(AnnotationSessionsTest, BeginsWithSeedsAndPresets) {
  std::ofstream labels{folder_ / "seeds.txt"};
  for (std::uint32_t point = 0; point < kPoints; ++point) {
    const std::uint32_t row = point / kColumns;
    const std::uint32_t column = point % kColumns;
    const bool box = row >= 30 && row < 70 && column % 40 >= 10 && column % 40 < 30;
    labels << (point == kNan ? 0 : box ? 2 + column / 40 : 1) << '\n';
  }
  labels.close();
  config_.clouds[0].seeds = folder_ / "seeds.txt";
  config_.start.presets = {{2, {"red", {255, 0, 0}, "box", 1}}, {9, {"nothing", {0, 0, 9}, "", 0}}};
  restart();
  Page page = this->page(1);
  EXPECT_GE(page.control_points.size(), 4U);
  EXPECT_NEAR(static_cast<double>(page.labelled_as(3)), 800.0, 40.0);
  EXPECT_EQ(page.rows.at(2).at("name"), "red");
  EXPECT_EQ(page.rows.at(9).at("defined"), true);
  EXPECT_EQ(page.act({{"do", "undo"}}).head.at("done"), false) << "a page takes back its own";
  EXPECT_TRUE(page.act({{"do", "labels"}, {"labels", {{{"number", 3}, {"name", "mine"}}}}}).ok());
  const auto sequence = read_journal(folder_ / "table.sacann")->actions.size();
  EXPECT_EQ(sequence, 6U) << "a label each, presets, mine";
  restart();
  Page again = this->page(1);
  EXPECT_EQ(again.labels, page.labels);
  EXPECT_EQ(again.rows, page.rows);
  EXPECT_EQ(read_journal(folder_ / "table.sacann")->actions.size(), sequence);
  EXPECT_TRUE(again.ask({{"type", "new"}}).ok());
  EXPECT_EQ(read_journal(folder_ / "table.sacann")->actions.size(), 1U) << "an empty annotation has its presets";
}

TEST_F(AnnotationSessionsTest, IsReadyLaterWhereTheGraphTakesLong) {
  config_.graph_at_once_points = 0;
  restart();
  Page page = connect(1);
  page.hello();
  const Received opened = page.open();
  ASSERT_EQ(opened.head.at("ready"), false);
  EXPECT_EQ(page.order.size(), kPoints - 1) << "points come before the graph";
  for (const char* type : {"margins", "next_best_click", "save", "new"}) {
    EXPECT_EQ(page.ask({{"type", type}}).error(), kNotReady) << type;
  }
  EXPECT_EQ(page.act(set(1, 0)).error(), kNotReady);
  EXPECT_EQ(page.ask({{"type", "root"}, {"point", 0}}).error(), kNotReady);
  EXPECT_EQ(get("pcd").status, 503);
  const auto wait = [&](Page& who) {
    while (who.notices["ready"].empty()) {
      ASSERT_TRUE(posted_->do_next());
      who.listen();
    }
  };
  wait(page);
  EXPECT_FALSE(page.notices["progress"].empty());
  four_clicks(page);
  EXPECT_EQ(page.labelled_as(2), 800U);

  restart();
  Page again = connect(1);
  again.hello();
  const Received later = again.open(0, 5000);
  EXPECT_EQ(later.head.at("ready"), false);
  EXPECT_EQ(later.head.at("client_actions"), 4) << "known before the labels are";
  EXPECT_EQ(later.head.at("sequence"), 4);
  EXPECT_EQ(again.labelled_as(0), 5000U);
  wait(again);
  const json& ready = again.notices["ready"].back().head;
  EXPECT_EQ(ready.at("client_actions"), 4);
  EXPECT_EQ(ready.at("can_undo"), true);
  EXPECT_EQ(ready.at("read_only"), nullptr);
  for (const auto& [point, label] : again.labels) ASSERT_EQ(label, page.labels.at(point));
  EXPECT_EQ(again.control_points, page.control_points);
  EXPECT_EQ(again.rows, page.rows);
  EXPECT_TRUE(again.act(set(5, 0)).ok());
  expect_up_to_date(again);

  restart();
  Page gone = connect(1);
  gone.hello();
  gone.open();
  restart();  // while the graph is built
}

TEST_F(AnnotationSessionsTest, ServesAFolder) {
  serve_three();
  Page first = page(1);
  Page second = page(2);
  EXPECT_EQ(first.ask({{"type", "open"}, {"cloud", 3}, {"budget", 1}}).error(), "invalid argument");
  four_clicks(first);
  EXPECT_EQ(second.open(1).head.at("cloud").at("name"), "second.pcd");
  first.listen();
  EXPECT_EQ(first.notices["people"].back().head.at("count"), 1);
  second.listen();
  const std::size_t changes = second.notices["changes"].size();
  EXPECT_TRUE(first.act({{"do", "undo"}}).ok());
  second.listen();
  EXPECT_EQ(second.notices["changes"].size(), changes) << "it has another cloud open";
  EXPECT_TRUE(second.act(set(7, kOnTable)).ok());
  EXPECT_EQ(second.open(0).head.at("sequence"), 5);
  EXPECT_EQ(second.labels, first.labels);
  EXPECT_EQ(second.open(1).head.at("sequence"), 1);
  EXPECT_EQ(second.open(2).head.at("sequence"), 0);
  EXPECT_EQ(read_journal(folder_ / "second.sacann")->actions.size(), 1U);
}

TEST_F(AnnotationSessionsTest, FewCloudsAreOpenAtATime) {
  serve_three();
  config_.most_open_points = 2 * kPoints;
  restart();
  const auto is_locked = [&](const char* name) {
    SessionSubject subject = read_journal(folder_ / name)->subject;
    const auto opened = AnnotationJournal::open_or_create(folder_ / name, subject);
    return !opened && opened.error().code == Errc::unavailable;
  };
  Page first = page(1);
  Page second = page(2);
  EXPECT_TRUE(second.open(1).ok());
  EXPECT_TRUE(second.open(2).ok()) << "the second one gives way";
  EXPECT_TRUE(is_locked("table.sacann"));
  EXPECT_FALSE(is_locked("second.sacann"));
  EXPECT_TRUE(is_locked("third.sacann"));
  Page third = connect(3);
  third.hello();
  EXPECT_EQ(third.open(1).error(), "unavailable") << "two are in use";
  EXPECT_TRUE(third.open(0).ok());
  first.close();
  third.close();
  EXPECT_TRUE(is_locked("table.sacann")) << "the last one stays";
  second.close();
  EXPECT_FALSE(is_locked("table.sacann"));
  EXPECT_TRUE(is_locked("third.sacann"));
}

TEST_F(AnnotationSessionsTest, ASessionIsOpenInOneProgramOnly) {
  const SessionSubject subject{"table.pcd", kPoints, 1, config_.start.graph};
  std::optional<AnnotationJournal::Opened> opened{
      *AnnotationJournal::open_or_create(folder_ / "table.sacann", subject)};
  Page page = connect(1);
  page.hello();
  EXPECT_EQ(page.open().error(), "unavailable");
  EXPECT_EQ(service_->prepare(0).error().code, Errc::unavailable);
  opened.reset();
  const Received refused = page.open();
  EXPECT_EQ(refused.error(), "invalid argument") << "it is of other positions";
  EXPECT_EQ(page.act(set(1, 0)).error(), "invalid argument") << "no cloud is open";
  std::filesystem::remove(folder_ / "table.sacann");
  EXPECT_TRUE(service_->prepare(0));
  EXPECT_TRUE(page.open().ok());
}

TEST_F(AnnotationSessionsTest, AGraphIsWhatItWasWhenTheSessionBegan) {
  page(1).close();
  config_.start.graph.max_path = 20.0;
  restart();
  EXPECT_TRUE(service_->prepare(0));
  Page page = this->page(1);
  EXPECT_EQ(page.open().head.at("cloud").at("graph").at("max_path"), 10.0);
  config_.start.checks = {[](const NeighbourhoodConfig& saved) -> std::optional<std::string> {
    return "not " + std::to_string(static_cast<int>(saved.max_path));
  }};
  restart();
  const Status refused = service_->prepare(0);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "not 10");
}

TEST_F(AnnotationSessionsTest, AFullDiskLeavesWhatCanBeRead) {
  Page page = this->page(1);
  Page other = this->page(2);
  four_clicks(page);
  other.listen();
  const auto labels = page.labels;
  {
    const test::SmallDisk disk{1};
    EXPECT_EQ(page.act(set(5, 0)).error(), "input/output failure");
    EXPECT_EQ(page.ask({{"type", "save"}}).error(), "input/output failure");
  }
  other.listen();
  ASSERT_EQ(other.notices["read_only"].size(), 1U);
  EXPECT_NE(other.notices["read_only"][0].head.at("why").get<std::string>().find("session"), std::string::npos);
  EXPECT_EQ(other.act(set(5, 0)).error(), "input/output failure") << "also when there is room again";
  EXPECT_EQ(other.ask({{"type", "new"}}).error(), "input/output failure");
  EXPECT_TRUE(page.ask({{"type", "save"}}).ok());
  Page third = connect(3);
  third.hello();
  EXPECT_TRUE(third.open().head.at("read_only").is_string());
  EXPECT_EQ(third.labels, labels);
  restart();
  Page again = this->page(1);
  EXPECT_EQ(again.labels, labels);
  EXPECT_TRUE(again.act(set(5, 0)).ok());
}

}  // namespace
}  // namespace saccade
