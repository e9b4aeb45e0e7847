// SPDX-License-Identifier: Apache-2.0
// Questions that no good page asks: each is refused, and the annotation stays as it was.
#include <cstdlib>
#include <limits>
#include <utility>

#include "annotation_server/annotation_desk.hpp"
#include "saccade/core/clock.hpp"

namespace saccade {
namespace {

using test::json;
using test::Page;

using AnnotationHostileTest = test::AnnotationDesk;

json action(json what) { return {{"type", "action"}, {"action", std::move(what)}}; }

json view_of(int width, int height) {
  return {{"size", {width, height}},
          {"fov_deg", 40},
          {"T_world_camera", {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}};
}

json brush(json line, const char* radius, double value) {
  return action({{"do", "paint"},
                 {"label", 1},
                 {"view", view_of(2000, 2000)},
                 {"brush", {{"line", std::move(line)}, {radius, value}}}});
}

std::vector<json> bad_actions() {
  json places = json::array();
  for (int i = 0; i < 65; ++i) places.push_back({0.0, 0.0, 0.95});
  json zigzag = json::array();
  json spot = json::array();
  for (int i = 0; i < 2000; ++i) zigzag.push_back({i % 2 * 1999, i});
  for (int i = 0; i < 9000; ++i) spot.push_back({1000, 1000});
  std::vector<json> bad;
  for (const json& points : std::vector<json>{{},
                                              {12'001},
                                              {-1},
                                              {0.5},
                                              {"0"},
                                              {nullptr},
                                              {4'294'967'295U},
                                              {4'294'967'296U},
                                              {1e300},
                                              {5, 5},
                                              {12'000},
                                              7,
                                              "all",
                                              json::object()}) {
    bad.push_back(action({{"do", "set"}, {"label", 1}, {"points", points}}));
    bad.push_back(action({{"do", "paint"}, {"label", 1}, {"points", points}}));
  }
  for (const json& label : std::vector<json>{0, -1, 1.5, "1", nullptr, 4'294'967'295U, 1e30, json::array()}) {
    bad.push_back(action({{"do", "set"}, {"label", label}, {"points", {1}}}));
    if (!label.is_string()) bad.push_back(action({{"do", "labels"}, {"labels", {{{"number", label}}}}}));
  }
  for (const json& cost : std::vector<json>{-1.0, 10.0, 1e300, "1", nullptr}) {
    bad.push_back(action({{"do", "set"}, {"label", 1}, {"points", {1}}, {"start_cost", cost}}));
  }
  for (const json& what : std::vector<json>{
           nullptr,
           1,
           "set",
           json::array(),
           json::object(),
           {{"do", "explode"}},
           {{"do", 1}},
           {{"do", "clear"}, {"client", 2}},
           {{"do", "undo"}, {"more", 1}},
           {{"do", "remove"}, {"points", {1}}},
           {{"do", "move"}, {"from", 1}, {"to", 2}},
           {{"do", "move"}, {"from", 1}},
           {{"do", "labels"}, {"labels", json::array()}},
           {{"do", "labels"}, {"labels", 1}},
           {{"do", "labels"}, {"labels", {{{"number", 1}, {"name", "a\nb"}}}}},
           {{"do", "labels"}, {"labels", {{{"number", 1}, {"name", std::string(300, 'a')}}}}},
           {{"do", "labels"}, {"labels", {{{"number", 1}}, {{"number", 1}}}}},
           {{"do", "set"}, {"label", 1}, {"at", {0, 0, 50}}},
           {{"do", "set"}, {"label", 1}, {"at", {0, 0}}},
           {{"do", "set"}, {"label", 1}, {"at", places}},
           {{"do", "paint"}, {"label", 1}, {"rectangle", {0, 0, 9, 9}}},
           {{"do", "paint"}, {"label", 1}, {"view", 1}, {"rectangle", {0, 0, 9, 9}}},
           {{"do", "paint"}, {"label", 1}, {"view", view_of(0, 9)}, {"rectangle", {0, 0, 9, 9}}},
           {{"do", "paint"}, {"label", 1}, {"view", view_of(8192, 8192)}, {"rectangle", {0, 0, 8192, 8192}}},
           {{"do", "paint"}, {"label", 1}, {"view", view_of(99, 99)}, {"rectangle", {-9, -9, -1, -1}}},
           {{"do", "paint"}, {"label", 1}, {"view", view_of(99, 99)}, {"lasso", {{0, 0}, {1, 1}}}},
           {{"do", "paint"}, {"label", 1}, {"view", view_of(99, 99)}, {"below_m", -1}, {"rectangle", {0, 0, 9, 9}}}}) {
    bad.push_back(action(what));
  }
  bad.push_back(brush(zigzag, "radius_m", 0.01));
  bad.push_back(brush(spot, "radius_px", 9000));
  bad.push_back(brush({{1, 1}}, "radius_px", 1e9));
  bad.push_back(brush({{1, 1}}, "radius_m", 0.0));
  bad.push_back({{"type", "action"}});
  bad.push_back({{"type", "action"}, {"action", {{"do", "clear"}}}, {"trees", "yes"}});
  bad.push_back({{"type", "action"}, {"action", {{"do", "clear"}}}, {"trees", true}});
  bad.push_back({{"type", "action"}, {"action", {{"do", "remove"}, {"points", {12'001}}}}, {"trees", true}});
  return bad;
}

std::vector<json> bad_questions() {
  std::vector<json> bad{{{"type", "hello"}, {"protocol", 1}, {"client", 5}},
                        {{"type", "explode"}},
                        {{"type", ""}},
                        {{"type", std::string(100'000, 'x')}},
                        {{"type", "answer"}}};
  for (const json& number : std::vector<json>{-1, 1.0, "0", nullptr, true, 99'999'999, 1e300,
                                              18'446'744'073'709'551'615U, json::array({0})}) {
    bad.push_back({{"type", "open"}, {"cloud", number}, {"budget", 10}});
    bad.push_back({{"type", "points"}, {"from", number}, {"count", 1}});
    bad.push_back({{"type", "points"}, {"from", 0}, {"count", number}});
    bad.push_back({{"type", "root"}, {"point", number}});
    bad.push_back({{"type", "tree"}, {"point", number}});
    if (number != 99'999'999) bad.push_back({{"type", "open"}, {"cloud", 0}, {"budget", number}});
  }
  bad.push_back({{"type", "open"}, {"cloud", 0}, {"budget", 0}});
  for (const char* type : {"open", "points", "root", "tree"}) bad.push_back({{"type", type}});
  for (json& one : bad_actions()) bad.push_back(std::move(one));
  return bad;
}

TEST_F(AnnotationHostileTest, BadQuestionsAreRefused) {
  Page page = this->page(1);
  Page witness = this->page(2);
  four_clicks(page);
  const auto labels = page.labels;
  std::size_t asked{0};
  double longest_ms{0.0};
  for (const json& question : bad_questions()) {
    const Stopwatch stopwatch;
    const auto answer = page.ask(question);
    longest_ms = std::max(longest_ms, stopwatch.elapsed_ms());
    ++asked;
    ASSERT_FALSE(answer.ok()) << question.dump().substr(0, 300);
    ASSERT_FALSE(answer.error().empty());
    ASSERT_FALSE(answer.head.at("error").at("message").get<std::string>().empty());
    ASSERT_LT(answer.head.dump().size(), 4000U);
  }
  EXPECT_GT(asked, 120U);
  EXPECT_LT(longest_ms, 10'000.0) << "each takes little";
  EXPECT_EQ(page.open().head.at("sequence"), 4);
  EXPECT_EQ(page.labels, labels);
  witness.listen();
  EXPECT_EQ(witness.notices["changes"].size(), 4U);
  EXPECT_TRUE(witness.act(set(5, 0)).ok());
}

TEST_F(AnnotationHostileTest, HelloComesFirst) {
  Page page = connect(1);
  for (const char* type : {"open", "points", "action", "root", "tree", "margins", "next_best_click", "save", "new"}) {
    EXPECT_EQ(page.ask({{"type", type}, {"cloud", 0}, {"budget", 1}}).error(), "invalid argument") << type;
  }
  EXPECT_EQ(page.ask({{"type", "hello"}, {"protocol", 2}, {"client", 1}}).error(), "unsupported");
  for (const json& client : std::vector<json>{0, -1, 1.5, "me", nullptr, 9'007'199'254'740'992U}) {
    EXPECT_EQ(page.ask({{"type", "hello"}, {"protocol", 1}, {"client", client}}).error(), "invalid argument");
  }
  EXPECT_EQ(page.ask({{"type", "hello"}, {"protocol", 1}}).error(), "invalid argument");
  EXPECT_EQ(page.open().error(), "invalid argument") << "a refused hello is none";
  EXPECT_TRUE(page.hello().ok());
  EXPECT_EQ(page.ask({{"type", "points"}, {"from", 0}, {"count", 1}}).error(), "invalid argument");
  EXPECT_TRUE(page.open().ok());
}

TEST_F(AnnotationHostileTest, WhatCannotBeReadEndsTheConnection) {
  const auto framed = [](const std::string& head) {
    std::string bytes(4, '\0');
    const auto length = static_cast<std::uint32_t>(head.size());
    std::memcpy(bytes.data(), &length, 4);
    bytes += head;
    bytes.resize((bytes.size() + 3) / 4 * 4);
    return bytes;
  };
  std::vector<std::string> bad{"",
                               "abc",
                               std::string("\xff\xff\xff\xff", 4),
                               framed("{"),
                               framed("[]"),
                               framed("{\"type\": \"hello\", \"request\": 1}") + "body",
                               framed("{\"type\": \"hello\"}"),
                               framed("{\"request\": 1}"),
                               framed("{\"type\": 1, \"request\": 1}"),
                               framed("{\"type\": \"hello\", \"request\": 0}"),
                               framed("{\"type\": \"hello\", \"request\": -1}"),
                               framed("{\"type\": \"\xff\", \"request\": 1}"),
                               framed("{\"type\": \"hello\", \"request\": 1, \"x\": 1e999}"),
                               framed(std::string(100'000, '['))};
  for (const std::string& bytes : bad) {
    Page page = connect(1);
    page.send_bytes(bytes);
    EXPECT_EQ(messages_->close_code(page.id()), 1007) << bytes.substr(0, 60);
    page.close();
    page.close();
    page.send_bytes(bytes);  // after its end
  }
  EXPECT_TRUE(page(2).act(set(1, kOnTable)).ok());
}

TEST_F(AnnotationHostileTest, ASessionDoesNotGrowForEver) {
  config_.most_session_bytes = 4000;
  start();
  Page page = this->page(1);
  int done{0};
  test::Received answer = page.act(set(1, kOnTable));
  for (; answer.ok() && done < 1000; ++done) answer = page.act(set(1 + done % 7, kOnBox1));
  EXPECT_EQ(answer.error(), "unavailable");
  EXPECT_GT(done, 10);
  EXPECT_EQ(page.act({{"do", "undo"}}).error(), "unavailable");
  EXPECT_TRUE(page.ask({{"type", "save"}}).ok());
  EXPECT_TRUE(page.ask({{"type", "new"}}).ok()) << "there is a way on";
  EXPECT_TRUE(page.act(set(1, kOnTable)).ok());
}

/// More under SACCADE_TEST_ACTIONS, say a million.
int action_count() {
  const char* const given = std::getenv("SACCADE_TEST_ACTIONS");
  return given == nullptr ? 1000 : std::atoi(given);
}

TEST_F(AnnotationHostileTest, ManyActionsAreKeptOneByOne) {
  const int actions = action_count();
  Page page = this->page(1);
  for (int i = 0; i < actions; ++i) {
    ASSERT_TRUE(page.act(i % 3 == 2 ? json{{"do", "undo"}} : set(1 + i % 7, (i * 37) % kNan)).ok());
    if (i % 100 == 0) page.notices.clear();
  }
  expect_up_to_date(page);
  stop();
  start();
  Page again = connect(1);
  again.hello();
  EXPECT_EQ(again.open().head.at("client_actions"), actions);
  EXPECT_EQ(again.labels, page.labels);
}

}  // namespace
}  // namespace saccade
