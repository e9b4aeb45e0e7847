// SPDX-License-Identifier: Apache-2.0
// Clients of Foxglove on a server: who is let in, two at once, slow ones, and the end.
#include <nlohmann/json.hpp>

#include "server/foxglove/foxglove_hub.hpp"
#include "server/foxglove_data.hpp"
#include "server/served_page.hpp"

namespace saccade::test {
namespace {

using nlohmann::json;
using Seen = FoxgloveData;

constexpr const char* kFoxglove{"foxglove.websocket.v1"};

/// A server for Foxglove alone, on loopback.
class FoxgloveServer : public ::testing::Test {
 protected:
  static server::ServerConfig config() {
    server::ServerConfig made;
    made.token = kToken;
    made.foxglove_only = true;
    return made;
  }
  void SetUp() override { serve(config()); }
  void serve(server::ServerConfig made) {
    server_.reset();
    made.foxglove = hub_;
    auto begun = server::HttpServer::listen(made);
    ASSERT_TRUE(begun) << begun.error().to_string();
    server_ = std::move(*begun);
  }
  [[nodiscard]] std::string port() const { return ":" + std::to_string(server_->port()); }
  [[nodiscard]] Answer upgrade(RawClient& client, const std::string& more, const std::string& target = "/foxglove",
                               const std::string& host = "localhost") const {
    return client.ask("GET " + target + " HTTP/1.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nHost: " + host +
                      port() + "\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
                      more + "\r\n");
  }
  [[nodiscard]] int status_of(const std::string& more, const std::string& target = "/foxglove",
                              const std::string& host = "localhost") const {
    RawClient client{server_->port()};
    return upgrade(client, more, target, host).status;
  }
  static std::string offers(const std::string& subprotocols) {
    return "Sec-WebSocket-Protocol: " + subprotocols + "\r\n";
  }
  /// One that is connected and greeted.
  [[nodiscard]] RawClient connected(int receive_bytes = 0) const {
    RawClient client{server_->port(), receive_bytes};
    EXPECT_EQ(upgrade(client, offers(kFoxglove)).status, 101);
    EXPECT_EQ(text_from(client).at("op"), "serverInfo");
    EXPECT_EQ(text_from(client).at("op"), "advertise");
    return client;
  }
  static json text_from(RawClient& client) {
    const auto frame = client.read_message();
    if (!frame || frame->opcode != Opcode::text) return {{"op", "none"}};
    return json::parse(frame->payload, nullptr, false);
  }
  static std::optional<Seen> data_from(RawClient& client) {
    const auto frame = client.read_message();
    return frame && frame->opcode == Opcode::binary ? data_in(frame->payload) : std::nullopt;
  }
  void publish(const std::string& topic, std::uint32_t nanosec, const std::string& content) const {
    hub_->publish(topic, messages::type_of<messages::PointCloud2>(), {1, nanosec}, std::as_bytes(std::span{content}));
  }

  std::shared_ptr<server::FoxgloveHub> hub_ = std::make_shared<server::FoxgloveHub>();
  std::unique_ptr<server::HttpServer> server_;
};

TEST_F(FoxgloveServer, TwoClientsSeeWhatIsPublished) {
  publish("/map", 0, "map 0");
  RawClient early = connected();
  early.send(frame(Opcode::text, subscribe_text({{{"id", 5}, {"channelId", 1}}})));
  EXPECT_EQ(data_from(early), (Seen{5, 1'000'000'000, "map 0"})) << "what was there before it came";
  publish("/map", 1, "map 1");
  EXPECT_EQ(data_from(early), (Seen{5, 1'000'000'001, "map 1"}));
  RawClient late = connected();
  publish("/tf", 2, "tf");  // a channel that was not there when they came
  for (RawClient* client : {&early, &late}) {
    const json advertised = text_from(*client);
    EXPECT_EQ(advertised.at("op"), "advertise");
    EXPECT_EQ(advertised.at("channels").at(0).at("topic"), "/tf");
    EXPECT_EQ(advertised.at("channels").at(0).at("schemaName"), "sensor_msgs/msg/PointCloud2");
  }
  late.send(frame(Opcode::text, subscribe_text({{{"id", 1}, {"channelId", 2}}, {{"id", 2}, {"channelId", 1}}})));
  EXPECT_EQ(data_from(late), (Seen{1, 1'000'000'002, "tf"}));
  EXPECT_EQ(data_from(late), (Seen{2, 1'000'000'001, "map 1"}));
  early.reset();
  publish("/map", 3, "map 3");
  EXPECT_EQ(data_from(late), (Seen{2, 1'000'000'003, "map 3"})) << "that the other is gone does not matter";
  EXPECT_TRUE(hub_->wait_until_written(std::chrono::seconds{30}));
  server_.reset();
  EXPECT_EQ(late.read_close_code(), 1001);
}

TEST_F(FoxgloveServer, RubbishIsAnsweredAndTheConnectionStays) {
  publish("/map", 0, "map");
  RawClient client = connected();
  client.send(frame(Opcode::text, "rubbish"));
  EXPECT_EQ(text_from(client).at("op"), "status");
  client.send(frame(Opcode::binary, "rubbish"));
  EXPECT_EQ(text_from(client).at("op"), "status");
  for (int i = 0; i < 1000; ++i) client.send(frame(Opcode::text, R"({"op":"unsubscribe","subscriptionIds":[1]})"));
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(text_from(client).at("level"), 1) << i;
  client.send(frame(Opcode::text, subscribe_text({{{"id", 1}, {"channelId", 1}}})));
  EXPECT_EQ(data_from(client), (Seen{1, 1'000'000'000, "map"}));
  client.send(frame(static_cast<Opcode>(3), "reserved"));
  EXPECT_EQ(client.read_close_code(), 1002);
}

TEST_F(FoxgloveServer, AClientThatReadsNothingHoldsNothingUp) {
  constexpr int kMaps{kSanitized ? 40 : 200};
  constexpr std::size_t kMapMiB{kSanitized ? 1 : 4};
  publish("/map", 0, "");
  RawClient slow = connected(4096);
  slow.send(frame(Opcode::text, subscribe_text({{{"id", 1}, {"channelId", 1}}})));
  ASSERT_TRUE(data_from(slow));
  const std::string map(kMapMiB * kMiB, 'm');
  const double before_mib = resident_mib();
  for (std::uint32_t i = 1; i <= kMaps; ++i) publish("/map", i, map);
  EXPECT_LT(resident_mib() - before_mib, 60.0) << "of " << kMaps * kMapMiB << " MiB that were published";
  EXPECT_FALSE(hub_->wait_until_written(std::chrono::milliseconds{10}));
  std::optional<Seen> last;
  int count{0};
  do {
    last = data_from(slow);
    ++count;
    ASSERT_TRUE(last);
  } while (last->time_ns < 1'000'000'000 + kMaps);
  EXPECT_LT(count, kMaps / 2) << "most were replaced by newer ones";
  EXPECT_EQ(last->content, map);
  EXPECT_TRUE(hub_->wait_until_written(std::chrono::seconds{30}));
  publish("/map", kMaps + 1, map);
  const auto begin = std::chrono::steady_clock::now();
  server_.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds{5});
}

TEST_F(FoxgloveServer, TheHandshake) {
  RawClient client{server_->port()};
  const Answer both = upgrade(client, offers("foxglove.sdk.v1, foxglove.websocket.v1"));
  EXPECT_EQ(both.status, 101);
  EXPECT_NE(both.head.find("Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n"), std::string::npos) << both.head;
  EXPECT_EQ(status_of(offers(kFoxglove), "/"), 101);
  EXPECT_EQ(status_of(offers("x") + offers(kFoxglove), "/"), 101);
  EXPECT_EQ(status_of(offers("foxglove.websocket.v2")), 400);
  EXPECT_EQ(status_of(""), 400) << "none at all";
  RawClient plain{server_->port()};
  EXPECT_EQ(plain.get("/foxglove").status, 426);
  EXPECT_EQ(status_of(offers(kFoxglove), "/other"), 404);
  EXPECT_EQ(status_of(offers(kFoxglove), "/data/other"), 403);
  EXPECT_EQ(status_of(offers(kFoxglove), "/other?token=" + std::string{kToken}), 404);
}

TEST_F(FoxgloveServer, OnLoopbackForeignPagesAreRefused) {
  EXPECT_EQ(server_->foxglove_url(), "ws://localhost" + port() + "/foxglove");
  for (const char* good : {"https://app.foxglove.dev", "file://", "http://localhost:8080"}) {
    EXPECT_EQ(status_of(offers(kFoxglove) + "Origin: " + good + "\r\n"), 101) << good;
  }
  for (const char* wrong : {"https://evil.example", "null", "http://evil.example"}) {
    EXPECT_EQ(status_of(offers(kFoxglove) + "Origin: " + wrong + "\r\n"), 403) << wrong;
  }
  EXPECT_EQ(status_of(offers(kFoxglove), "/foxglove", "evil.example"), 403);
  const std::string with_token = "/foxglove?token=" + std::string{kToken};
  EXPECT_EQ(status_of(offers(kFoxglove) + "Origin: https://evil.example\r\n", with_token, "robot"), 101);
}

TEST_F(FoxgloveServer, BesideAPageTheTokenIsNeeded) {
  server::ServerConfig with_page = config();
  with_page.foxglove_only = false;
  serve(with_page);
  const std::string place = "/foxglove?token=" + std::string{kToken};
  EXPECT_EQ(server_->foxglove_url(), "ws://localhost" + port() + place);
  EXPECT_EQ(status_of(offers(kFoxglove)), 403);
  EXPECT_EQ(status_of(offers(kFoxglove), place + "x"), 403);
  EXPECT_EQ(status_of(offers(kFoxglove) + "Origin: https://app.foxglove.dev\r\n", place), 101);
  RawClient page{server_->port()};
  EXPECT_EQ(page.get("/").status, 200);
}

TEST_F(FoxgloveServer, NoMoreThanItsSeats) {
  server::ServerConfig small = config();
  small.max_connections = 2;
  serve(small);
  RawClient first = connected();
  const RawClient second = connected();
  EXPECT_EQ(status_of(offers(kFoxglove)), 503);
  first.reset();
  EXPECT_TRUE(eventually([this] { return status_of(offers(kFoxglove)) == 101; }));
}

TEST(FoxgloveSink, GivesReadersTimeForTheLastMessages) {
  const auto hub = std::make_shared<server::FoxgloveHub>();
  server::ServerConfig config;
  config.token = kToken;
  config.foxglove = hub;
  config.foxglove_only = true;
  auto begun = server::HttpServer::listen(config);
  ASSERT_TRUE(begun);
  const std::uint16_t port = (*begun)->port();
  auto sink = std::make_unique<server::FoxgloveSink>(hub, std::move(*begun));
  EXPECT_EQ(sink->wire(), messages::Wire::cdr);
  RawClient client{port};
  EXPECT_EQ(client
                .ask("GET / HTTP/1.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nHost: localhost\r\n"
                     "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
                     "Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n")
                .status,
            101);
  const std::string big((kSanitized ? 1 : 8) * kMiB, 'b');
  const auto& type = messages::type_of<messages::Image>();
  ASSERT_TRUE(sink->add("/image", type, {1, 0}, std::as_bytes(std::span{big})));
  for (bool advertised = false; !advertised;) {  // with what it is greeted with, or after it
    const auto text = client.read_message();
    ASSERT_TRUE(text);
    advertised = text->payload.find("/image") != std::string::npos;
  }
  client.send(frame(Opcode::text, subscribe_text({{{"id", 3}, {"channelId", 1}}})));
  ASSERT_TRUE(client.read_message());
  ASSERT_TRUE(sink->add("/image", type, {2, 0}, std::as_bytes(std::span{big})));
  std::thread end{[&sink] {
    EXPECT_TRUE(sink->finish());
    sink.reset();
  }};
  std::this_thread::sleep_for(std::chrono::milliseconds{50});
  const auto last = client.read_message();
  end.join();
  ASSERT_TRUE(last);
  ASSERT_EQ(last->opcode, Opcode::binary);
  EXPECT_EQ(data_in(last->payload)->time_ns, 2'000'000'000U);
  EXPECT_EQ(last->payload.size(), 13 + big.size());
}

}  // namespace
}  // namespace saccade::test
