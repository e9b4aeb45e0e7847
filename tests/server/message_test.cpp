// SPDX-License-Identifier: Apache-2.0
// Messages of the WebSocket, well formed and not.
#include "server/message.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>

namespace saccade::test {
namespace {

using nlohmann::json;
using server::Message;

Message bytes_of(std::string_view head, std::string_view after = "") {
  const auto length = static_cast<std::uint32_t>(head.size());
  Message bytes(4);
  std::memcpy(bytes.data(), &length, 4);
  bytes.insert(bytes.end(), head.begin(), head.end());
  bytes.insert(bytes.end(), after.begin(), after.end());
  return bytes;
}

std::string nested(int depth) {
  std::string text{R"({"type":"a","request":1,"x":)"};
  for (int i = 1; i < depth; ++i) text += '[';
  for (int i = 1; i < depth; ++i) text += ']';
  return text + "}";
}

TEST(Message, WhatIsWrittenIsRead) {
  for (const std::string name : {"", "a", "ab", "abc", "ä\n"}) {
    const json head{{"type", "answer"}, {"request", 18446744073709551615ULL}, {"name", name}};
    server::MessageWriter writer{head};
    const std::array<float, 3> floats{1.5F, -2.0F, 3.25F};
    const std::array<std::uint32_t, 2> numbers{7, 4294967294U};
    writer.append(std::span<const float>{floats});
    writer.append(std::span<const std::uint32_t>{});
    writer.append(std::span<const std::uint32_t>{numbers});
    const server::SharedMessage message = std::move(writer).finish();
    const auto parsed = server::parse_message(*message);
    ASSERT_TRUE(parsed) << parsed.error().to_string();
    EXPECT_EQ(parsed->head, head);
    ASSERT_EQ(parsed->body.size(), sizeof floats + sizeof numbers);
    EXPECT_EQ((message->size() - parsed->body.size()) % 4, 0U);
    EXPECT_EQ(std::memcmp(parsed->body.data(), floats.data(), sizeof floats), 0);
    EXPECT_EQ(std::memcmp(parsed->body.data() + sizeof floats, numbers.data(), sizeof numbers), 0);
  }
}

TEST(Message, HeadsThatAreNotUtf8AreRepaired) {
  const auto message = server::refusal(3, Error{Errc::not_found, "no \xff", "a\xc3.pcd"});
  const auto parsed = server::parse_message(*message);
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->head["error"]["message"], "no \xef\xbf\xbd");
  EXPECT_EQ(parsed->head["error"]["code"], "not found");
  EXPECT_EQ(parsed->head["ok"], false);
  EXPECT_EQ(parsed->head["request"], 3);
}

TEST(Message, WhatIsNoMessageIsRefused) {
  using namespace std::string_literals;
  std::vector<Message> wrong{{}, {1}, {0, 0, 0}, {0, 0, 0, 0}, {1, 0, 0, 0}, {255, 255, 255, 255, '{', '}'}};
  for (const std::string& head : {""s,
                                  " "s,
                                  "1"s,
                                  "null"s,
                                  "[]"s,
                                  "\"a\""s,
                                  "{"s,
                                  "{}}"s,
                                  "{} {}"s,
                                  "{\"a\":}"s,
                                  "{'a':1}"s,
                                  "{\"a\":1,}"s,
                                  "{\"a\":NaN}"s,
                                  "{\"a\":1e999}"s,
                                  "{\"a\":01}"s,
                                  "{\"a\":\"\xff\"}"s,
                                  "{\"a\":\"\xed\xa0\x80\"}"s,
                                  "{\"a\":\"\xc0\x80\"}"s,
                                  "{\"\\ud800\":1}"s,
                                  "{\"a\":\"\n\"}"s,
                                  "{}\0"s,
                                  "{}\0{}"s,
                                  "\0{}"s,
                                  "/**/{}"s,
                                  nested(33),
                                  nested(100'000)}) {
    wrong.push_back(bytes_of(head));
  }
  wrong.push_back(bytes_of("{}", "x"));
  wrong.push_back(bytes_of("{}", std::string{"\0\1", 2}));
  for (std::size_t i = 0; i < wrong.size(); ++i) {
    const auto parsed = server::parse_message(wrong[i]);
    ASSERT_FALSE(parsed) << i;
    EXPECT_EQ(parsed.error().code, Errc::corrupt_data) << i;
    EXPECT_FALSE(server::parse_question(wrong[i])) << i;
  }
}

TEST(Message, EveryBeginningOfAMessageIsRefused) {
  const Message whole = bytes_of(R"({"type":"points","request":1,"from":0})");
  ASSERT_TRUE(server::parse_question(whole));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_FALSE(server::parse_message(std::span{whole}.first(size))) << size;
  }
}

TEST(Question, HasATypeAndARequest) {
  const auto question = server::parse_question(bytes_of(nested(32), std::string(1, '\0')));
  ASSERT_TRUE(question) << question.error().to_string();
  EXPECT_EQ(question->type, "a");
  EXPECT_EQ(question->request, 1U);
  EXPECT_EQ(server::answer_head(*question), json({{"type", "answer"}, {"request", 1}, {"ok", true}}));
  for (const std::string head :
       {"{}", R"({"type":"a"})", R"({"request":1})", R"({"type":1,"request":1})", R"({"type":"a","request":0})",
        R"({"type":"a","request":-1})", R"({"type":"a","request":1.5})", R"({"type":"a","request":"1"})",
        R"({"type":"a","request":18446744073709551616})", R"({"type":null,"request":1})"}) {
    const auto refused = server::parse_question(bytes_of(head));
    ASSERT_FALSE(refused) << head;
    EXPECT_EQ(refused.error().code, Errc::invalid_argument) << head;
  }
  const auto with_body = server::parse_question(bytes_of(R"({"type":"ab","request":1})", std::string(8, '\0')));
  ASSERT_FALSE(with_body);
  EXPECT_EQ(with_body.error().code, Errc::invalid_argument);
}

}  // namespace
}  // namespace saccade::test
