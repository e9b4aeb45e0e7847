// SPDX-License-Identifier: Apache-2.0
// A sequence of clouds: labels that a page carries to the next one, and what they mean in all.
#include <filesystem>

#include "annotation_desk.hpp"

namespace saccade::test {
namespace {

class AnnotationSequence : public AnnotationDesk {
 protected:
  void SetUp() override {
    AnnotationDesk::SetUp();
    write_cloud("second.pcd");
    write_cloud("third.pcd");
    config_.clouds = {served("table"), served("second"), served("third")};
    config_.is_sequence = true;
    start();
  }
  static json define(std::uint32_t label, const std::string& name) {
    return {{"do", "labels"}, {"labels", {{{"number", label}, {"name", name}, {"color", "#102030"}}}}};
  }
  static Received carry(Page& page, json from) {
    return page.ask({{"type", "action"}, {"action", {{"do", "carry"}}}, {"from", std::move(from)}});
  }
};

TEST_F(AnnotationSequence, LabelsAreCarriedToTheNextCloud) {
  Page page = this->page(7);
  EXPECT_TRUE(connect(8).hello().head.at("sequence").get<bool>());
  four_clicks(page);
  const std::map<std::uint32_t, std::uint32_t> first = page.labels;
  ASSERT_TRUE(page.open(1).ok());
  ASSERT_EQ(page.labelled_as(0), kPoints - 1);
  ASSERT_TRUE(page.act({{"do", "paint"}, {"label", 9}, {"points", {0, 1}}}).ok());
  const Received carried = carry(page, 0);
  ASSERT_TRUE(carried.ok()) << carried.head.dump();
  EXPECT_EQ(carried.head.at("carried"), kPoints - 3);
  EXPECT_EQ(page.labelled_as(9), 2U);
  for (const auto& [point, label] : first) EXPECT_EQ(page.labels.at(point), point < 2 ? 9 : label);
  EXPECT_EQ(carry(page, 0).error(), "invalid argument") << "there is nothing more to carry";
  ASSERT_TRUE(page.act({{"do", "undo"}}).ok());
  EXPECT_EQ(page.labelled_as(0), kPoints - 3) << "it was one action";
  ASSERT_TRUE(page.act({{"do", "redo"}}).ok());

  // The program ends in the midst of it: what was acknowledged is there, and a cloud that is not open is read.
  stop();
  start();
  Page again = connect(7);
  again.hello();
  ASSERT_TRUE(again.open(2).ok());
  ASSERT_TRUE(carry(again, 1).ok());
  EXPECT_EQ(again.labelled_as(9), 2U);
  EXPECT_EQ(again.labelled_as(0), 0U);
  EXPECT_EQ(again.control_points.size(), 0U);
}

TEST_F(AnnotationSequence, PosesMoveTheLabels) {
  config_.clouds[1].T_world_cloud.translation().x() = 0.2;  // one box to the left is now where this one is
  start();
  Page page = this->page(7);
  four_clicks(page);
  ASSERT_TRUE(page.open(1).ok());
  ASSERT_TRUE(carry(page, 0).ok());
  EXPECT_EQ(page.labels.at(kOnBox1), 3U);
  EXPECT_EQ(page.labels.at(kOnBox2), 4U);
  EXPECT_EQ(page.labels.at(kOnBox3), 0U) << "beyond what the first cloud saw";
}

TEST_F(AnnotationSequence, LabelsMeanTheSameInAllClouds) {
  Page page = this->page(7);
  ASSERT_TRUE(page.act(define(2, "box")).ok());
  Page other = connect(8);
  other.hello();
  ASSERT_TRUE(other.open(1).ok());
  EXPECT_EQ(other.rows.at(2).at("name"), "box");
  EXPECT_EQ(other.rows.at(2).at("color"), "#102030");
  EXPECT_FALSE(other.ask({{"type", "name"}, {"name", "B"}}).head.contains("can_undo"));
  ASSERT_TRUE(page.act(define(2, "crate")).ok());
  other.listen();
  EXPECT_EQ(other.rows.at(2).at("name"), "crate") << "an open cloud hears of it";
  ASSERT_TRUE(other.act(define(3, "ball")).ok());
  page.listen();
  EXPECT_EQ(page.rows.at(3).at("name"), "ball");
  EXPECT_EQ(other.act({{"do", "undo"}}).head.at("done"), true);
  page.listen();
  EXPECT_FALSE(other.rows.contains(3));

  stop();
  start();
  Page third = connect(9);
  third.hello();
  ASSERT_TRUE(third.open(2).ok());
  EXPECT_EQ(third.rows.at(2).at("name"), "crate") << "from the sessions";
}

TEST_F(AnnotationSequence, WrongQuestionsAreRefused) {
  Page page = this->page(7);
  four_clicks(page);
  EXPECT_EQ(page.act({{"do", "carry"}}).error(), "invalid argument");
  EXPECT_EQ(carry(page, 0).error(), "invalid argument") << "from itself";
  for (const json& from : {json(3), json(-1), json("table.pcd"), json(nullptr)}) {
    EXPECT_EQ(carry(page, from).error(), "invalid argument") << from;
  }
  EXPECT_EQ(page.act({{"do", "clear"}, {"cloud", "second.pcd"}}).error(), "invalid argument");
  EXPECT_EQ(page.labelled_as(0), 0U);
  std::filesystem::remove(folder_ / "third.pcd");
  EXPECT_FALSE(carry(page, 2).ok());
  config_.is_sequence = false;
  start();
  Page plain = this->page(7);
  EXPECT_EQ(carry(plain, 1).error(), "invalid argument");
}

}  // namespace
}  // namespace saccade::test
