// SPDX-License-Identifier: Apache-2.0
// The Foxglove WebSocket protocol without a socket: what a client is told.
#include "server/foxglove/foxglove_client.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "server/access.hpp"
#include "server/foxglove_data.hpp"

namespace saccade::test {
namespace {

using nlohmann::json;
using server::FoxgloveChannel;
using server::FoxgloveClient;
using server::FoxgloveFrame;
using Data = FoxgloveData;

server::SharedFoxgloveMessage foxglove_message(std::uint64_t time_ns, std::string_view text) {
  server::FoxgloveMessage message{time_ns, {}};
  for (const char c : text) message.content.push_back(static_cast<std::byte>(c));
  return std::make_shared<const server::FoxgloveMessage>(std::move(message));
}

std::vector<FoxgloveChannel> two_channels() {
  return {{1, "/map", "a/msg/B", "int32 x\n", foxglove_message(7, "old map")}, {2, "/tf", "a/msg/C", "", nullptr}};
}

std::string bytes_of(const FoxgloveFrame& frame) {
  std::string bytes = frame.head;
  if (!frame.message) return bytes;
  for (const std::byte byte : frame.message->content) bytes += static_cast<char>(byte);
  return bytes;
}
std::optional<Data> next_data(FoxgloveClient& client) {
  const auto frame = client.next();
  return frame && !frame->is_text ? data_in(bytes_of(*frame)) : std::nullopt;
}
json next_text(FoxgloveClient& client) {
  const auto frame = client.next();
  return frame && frame->is_text ? json::parse(frame->head, nullptr, false) : json();
}
/// One that has read what it is greeted with.
FoxgloveClient greeted_client(const std::vector<FoxgloveChannel>& channels) {
  FoxgloveClient client{"session", channels};
  static_cast<void>(client.next());
  static_cast<void>(client.next());
  EXPECT_TRUE(client.is_idle());
  return client;
}

TEST(FoxgloveProtocol, BeginsWithTheServerAndItsChannels) {
  FoxgloveClient client{"session", two_channels()};
  const json info = next_text(client);
  EXPECT_EQ(info.at("op"), "serverInfo");
  EXPECT_EQ(info.at("name"), "saccade");
  EXPECT_EQ(info.at("capabilities"), json::array());
  EXPECT_EQ(info.at("sessionId"), "session");
  const json advertised = next_text(client);
  EXPECT_EQ(advertised.at("op"), "advertise");
  EXPECT_EQ(advertised.at("channels").size(), 2U);
  EXPECT_EQ(advertised.at("channels").at(0), (json{{"id", 1},
                                                   {"topic", "/map"},
                                                   {"encoding", "cdr"},
                                                   {"schemaName", "a/msg/B"},
                                                   {"schemaEncoding", "ros2msg"},
                                                   {"schema", "int32 x\n"}}));
  EXPECT_TRUE(client.is_idle());
}

TEST(FoxgloveProtocol, ASubscriberGetsTheNewestAtOnceAndThenWhatComes) {
  const auto channels = two_channels();
  FoxgloveClient client = greeted_client(channels);
  client.send(1, foxglove_message(8, "not asked for"));
  EXPECT_TRUE(client.is_idle());
  client.received(true, subscribe_text({{{"id", 70'000}, {"channelId", 1}}, {{"id", 4}, {"channelId", 2}}}), channels);
  EXPECT_EQ(next_data(client), (Data{70'000, 7, "old map"}));
  EXPECT_TRUE(client.is_idle()) << "nothing was sent to /tf";
  client.send(2, foxglove_message(1'795'852'238'175'269'365, "tf"));
  EXPECT_EQ(next_data(client), (Data{4, 1'795'852'238'175'269'365, "tf"}));
  client.received(true, R"({"op":"unsubscribe","subscriptionIds":[4]})", channels);
  client.send(2, foxglove_message(10, "tf"));
  EXPECT_TRUE(client.is_idle());
  client.received(true, subscribe_text({{{"id", 4}, {"channelId", 2}}}), channels);
  client.send(2, foxglove_message(11, "again"));
  EXPECT_EQ(next_data(client), (Data{4, 11, "again"}));
}

TEST(FoxgloveProtocol, ASlowClientHasOneMessageOfEachChannelWaiting) {
  const auto channels = two_channels();
  FoxgloveClient client = greeted_client(channels);
  client.received(true, subscribe_text({{{"id", 1}, {"channelId", 1}}, {{"id", 2}, {"channelId", 2}}}), channels);
  std::weak_ptr<const server::FoxgloveMessage> replaced;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const auto message = foxglove_message(i, "map " + std::to_string(i));
    if (i == 500) replaced = message;
    client.send(1, message);
    client.send(2, foxglove_message(i, "tf " + std::to_string(i)));
  }
  EXPECT_TRUE(replaced.expired());
  EXPECT_EQ(next_data(client), (Data{1, 999, "map 999"}));
  client.send(1, foxglove_message(1000, "map 1000"));
  EXPECT_EQ(next_data(client), (Data{2, 999, "tf 999"})) << "every channel has its turn";
  EXPECT_EQ(next_data(client), (Data{1, 1000, "map 1000"}));
  EXPECT_TRUE(client.is_idle());
}

TEST(FoxgloveProtocol, WhatIsWrongIsAnsweredByAStatus) {
  const auto channels = two_channels();
  FoxgloveClient client = greeted_client(channels);
  client.received(true, subscribe_text({{{"id", 1}, {"channelId", 2}}}), channels);
  const std::string deep(100'000, '[');
  for (const std::string& wrong : {std::string{},
                                   std::string{"rubbish"},
                                   std::string{"[]"},
                                   std::string{"{}"},
                                   std::string{R"({"op":1})"},
                                   std::string{"{\"op\":\"\xff\"}"},
                                   deep,
                                   std::string{R"({"op":"getParameters","parameterNames":[]})"},
                                   std::string{R"({"op":"subscribe"})"},
                                   std::string{R"({"op":"subscribe","subscriptions":{}})"},
                                   subscribe_text({1}),
                                   subscribe_text({{{"id", 2}}}),
                                   subscribe_text({{{"id", -1}, {"channelId", 1}}}),
                                   subscribe_text({{{"id", 5'000'000'000}, {"channelId", 1}}}),
                                   subscribe_text({{{"id", 2.5}, {"channelId", 1}}}),
                                   subscribe_text({{{"id", 2}, {"channelId", 3}}}),
                                   subscribe_text({{{"id", 2}, {"channelId", 2}}}),
                                   subscribe_text({{{"id", 1}, {"channelId", 1}}}),
                                   std::string{R"({"op":"unsubscribe","subscriptionIds":["1"]})"},
                                   std::string{R"({"op":"unsubscribe","subscriptionIds":[77]})"}}) {
    client.received(true, wrong, channels);
    const json status = next_text(client);
    ASSERT_TRUE(status.is_object()) << wrong.substr(0, 80);
    EXPECT_EQ(status.at("op"), "status");
    EXPECT_EQ(status.at("level"), wrong.find("77") == std::string::npos ? 2 : 1) << wrong.substr(0, 80);
    EXPECT_FALSE(status.at("message").get<std::string>().empty());
    EXPECT_TRUE(client.is_idle()) << wrong.substr(0, 80);
  }
  client.received(false, "\x01 binary", channels);
  EXPECT_EQ(next_text(client).at("op"), "status");
  client.received(true, subscribe_text({{{"id", 9}, {"channelId", 9}}, {{"id", 8}, {"channelId", 1}}}), channels);
  EXPECT_EQ(next_text(client).at("op"), "status") << "of the first";
  EXPECT_EQ(next_data(client), (Data{8, 7, "old map"})) << "the second is as good as alone";
  EXPECT_TRUE(client.is_idle() && client.may_read());
  for (int i = 0; i < 40; ++i) client.received(true, "rubbish", channels);
  EXPECT_FALSE(client.may_read());
}

TEST(FoxgloveProtocol, TheFirstKnownSubprotocolIsTaken) {
  EXPECT_EQ(server::foxglove_subprotocol("foxglove.websocket.v1"), "foxglove.websocket.v1");
  EXPECT_EQ(server::foxglove_subprotocol("other, foxglove.sdk.v1 ,foxglove.websocket.v1"), "foxglove.sdk.v1");
  for (const std::string_view wrong : {"", "foxglove", "foxglove.websocket.v2", "FOXGLOVE.SDK.V1", ",,", "x y"}) {
    EXPECT_EQ(server::foxglove_subprotocol(wrong), "") << wrong;
  }
}

TEST(FoxgloveProtocol, OriginsThatNeedNoToken) {
  for (const std::string_view good :
       {"https://app.foxglove.dev", "file://", "http://localhost:8080", "http://127.0.0.1", "http://[::1]:3000"}) {
    EXPECT_TRUE(server::is_foxglove_origin(good)) << good;
  }
  for (const std::string_view wrong :
       {"", "null", "http://app.foxglove.dev", "https://app.foxglove.dev.evil.example", "https://evil.example",
        "http://localhost.evil.example", "http://localhost@evil.example", "file:///tmp/x", "ftp://localhost"}) {
    EXPECT_FALSE(server::is_foxglove_origin(wrong)) << wrong;
  }
}

}  // namespace
}  // namespace saccade::test
